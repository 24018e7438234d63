"""Errors in numbers: summaries, bias and scatter apart, and how sure they are."""

from collections.abc import Hashable, Sequence

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.verification.figures import Interval, Intervals, Summary, Vector

FEWEST = 5  # groups of touches
_BLOCK = 1 << 21  # numbers at a time


def summarise(name: str, errors: NDArray[np.float64]) -> Summary:
    """Return the figures of errors (n, 3), m in S; n at least 1."""
    mm = 1e3 * errors
    sizes = np.linalg.norm(mm, axis=1)
    one = len(mm) < 2
    return Summary(
        name=name,
        touches=len(mm),
        mean_mm=float(sizes.mean()),
        sd_mm=None if one else float(sizes.std(ddof=1)),
        max_mm=float(sizes.max()),
        p95_mm=float(np.percentile(sizes, 95)),
        rms_mm=float(np.sqrt(np.mean(sizes**2))),
        bias_mm=vector(mm.mean(axis=0)),
        scatter_mm=None if one else float(np.sqrt(_scatter2(mm))),
    )


def summarise_by(
    keys: Sequence[Hashable], names: Sequence[str], errors: NDArray[np.float64]
) -> tuple[Summary, ...]:
    """Return the figures of the errors (n, 3) with each key, in the order in which `names` first have them."""
    groups: dict[str, list[int]] = {name: [] for name in names}
    for row, key in enumerate(keys):
        groups[str(key)].append(row)
    return tuple(summarise(name, errors[rows]) for name, rows in groups.items() if rows)


def intervals(
    errors: NDArray[np.float64],
    *,
    groups: Sequence[Hashable] | NDArray[np.intp] | None = None,
    level: float = 0.95,
    resamples: int = 2000,
    seed: int = 0,
) -> Intervals | None:
    """
    Return studentised bootstrap intervals of errors (n, 3), m; None: fewer than `FEWEST` groups.

    Touches of one marker share how far its place is off, so whole markers are drawn, not touches: `groups` says which
    belong together (None: each by itself). Drawn as if they were independent, five touches of each marker would give
    intervals of the bias that hold the truth in 58 % of cases. Percentiles of the bare figures would be too narrow for
    the few markers that there are; studentised ones (Efron & Tibshirani 1993, 12.5; Davison & Hinkley 1997, 3.8) do
    not suffer that. The scatter is taken as a logarithm, because its error is not symmetric.
    """
    sums = _sums(1e3 * errors, groups)
    if len(sums) < FEWEST:
        return None
    rng = np.random.default_rng(seed)
    drawn: list[NDArray[np.float64]] = []
    values = _figures(sums[None])[0]
    rows = max(1, _BLOCK // (8 * len(sums)))
    for begin in range(0, resamples, rows):
        count = min(rows, resamples - begin)
        drawn.append(_studentised(sums[rng.integers(0, len(sums), (count, len(sums)))], values))
    t = np.concatenate(drawn)
    low, high = 0.5 * (1 - level), 0.5 * (1 + level)
    middle, spread = values[:5], values[5:]
    bias_reach = float(np.quantile(np.abs(t[:, 1:4]).max(axis=1), level)) * spread[1:4]
    mean = _interval(middle[0], spread[0], t[:, 0], low, high)
    log = _interval(middle[4], spread[4], t[:, 4], low, high)
    bias = [(float(b - r), float(b + r)) for b, r in zip(middle[1:4], bias_reach, strict=True)]
    return Intervals(
        level=level,
        resamples=resamples,
        seed=seed,
        mean_mm=(max(mean[0], 0.0), mean[1]),
        scatter_mm=(_root(log[0]), _root(log[1])),
        bias_mm=(bias[0], bias[1], bias[2]),
    )


def vector(values: NDArray[np.float64]) -> Vector:
    """Return three numbers as plain ones."""
    x, y, z = values.tolist()
    return (x, y, z)


def _scatter2(mm: NDArray[np.float64]) -> NDArray[np.float64]:
    away = mm - mm.mean(axis=-2, keepdims=True)
    return np.asarray((away**2).sum(axis=(-2, -1)) / (mm.shape[-2] - 1))


def _sums(
    mm: NDArray[np.float64], groups: Sequence[Hashable] | NDArray[np.intp] | None
) -> NDArray[np.float64]:
    """Return (g, 6) of each group: number of touches, sums of their lengths, of their vectors, of their squares."""
    squares = (mm**2).sum(axis=1)
    touches = np.column_stack([np.ones(len(mm)), np.sqrt(squares), mm, squares])
    if groups is None:
        return touches
    order: dict[Hashable, int] = {}
    rows = [order.setdefault(key, len(order)) for key in groups]
    sums = np.zeros((len(order), 6))
    np.add.at(sums, rows, touches)
    return sums


def _figures(sums: NDArray[np.float64]) -> NDArray[np.float64]:
    """
    Return (b, 10) of groups' sums (b, g, 6): mean |e|, bias x y z, log of squared scatter, the standard errors of each.

    All are ratios of sums over groups, so what a group adds to one, less its share of the number, tells how it varies.
    """
    tiny = 1e-12  # touches that are all alike have no scatter; its logarithm should exist all the same
    number, total = sums[..., :1], sums[..., 0].sum(axis=1)[:, None]
    means = sums[..., 1:5].sum(axis=1) / total
    bias = means[:, None, 1:]
    squares = sums[..., 5] - 2 * (sums[..., 2:5] * bias).sum(axis=2) + number[..., 0] * (bias**2).sum(axis=2)
    around = np.maximum(squares, 0.0).sum(axis=1)[:, None]
    average = around / total + tiny
    log = np.log(around / np.maximum(total - 1, 1) + tiny)
    parts = np.concatenate(
        [
            sums[..., 1:5] - number * means[:, None, :],
            (squares[..., None] - number * average[:, None]) / average[:, None],
        ],
        axis=2,
    )
    count = sums.shape[1]
    errors = np.sqrt(count / (count - 1) * (parts**2).sum(axis=1)) / total
    return np.concatenate([means, log, errors + tiny], axis=1)


def _studentised(sums: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    figures = _figures(sums)
    return np.asarray((figures[:, :5] - values[:5]) / figures[:, 5:])


def _interval(
    value: np.float64, spread: np.float64, t: NDArray[np.float64], low: float, high: float
) -> Interval:
    below, above = np.quantile(t, [low, high])
    return (float(value - above * spread), float(value - below * spread))


def _root(log: float) -> float:
    """Return the root of a square whose logarithm this is; a handful of touches that are alike may say anything."""
    return float(np.exp(np.clip(log / 2, -30.0, 10.0)))
