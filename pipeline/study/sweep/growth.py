"""What a table of results says: how figures grow with the mesh, who is on the front, where mesh error matters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

Row = dict[str, Any]
TIME, ERROR = "python_median_ns", "rms_mm"
_MATTERS = 1.01


def merged(rows: Iterable[Row], by: Sequence[str]) -> list[Row]:
    """
    Return one row for each combination of `by`: errors as root mean squares, times as medians, shares as means.

    Rows that failed are left out.
    """
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        if not row.get("failed"):
            groups.setdefault(tuple(row[name] for name in by), []).append(row)
    return [dict(zip(by, key, strict=True)) | _summary(group) for key, group in groups.items()]


def _summary(group: list[Row]) -> Row:
    def values(name: str) -> NDArray[np.float64]:
        found = np.array([row.get(name, np.nan) for row in group], dtype=np.float64)
        return found[np.isfinite(found)]

    def of(name: str, what: Any) -> float:
        some = values(name)
        return float(what(some)) if len(some) else float("nan")

    def rms(x: NDArray[np.float64]) -> float:
        return float(np.sqrt(np.mean(x * x)))

    square = values("mean_mm") ** 2 + values("sd_mm") ** 2
    bound, sure = values("bound_mm"), values("rms_sure_mm")
    return {
        "cells": len(group),
        "facets_found": of("facets_found", np.median),
        "mean_mm": of("mean_mm", np.mean),
        ERROR: float(np.sqrt(square.mean())) if len(square) else float("nan"),
        "p95_mm": of("p95_mm", np.median),
        "max_mm": of("max_mm", np.max),
        "rms_sure_mm": of("rms_sure_mm", rms),
        "bound_mm": of("bound_mm", rms),
        "over_bound": rms(sure) / rms(bound) if len(sure) and len(bound) and rms(bound) > 0 else float("nan"),
        "answered": of("answered", np.mean),
        "sure": of("sure", np.mean),
        **{
            name: of(name, np.median)
            for name in ("compiled_median_ns", "compiled_p99_ns", TIME, "python_p99_ns")
        },
    }


def front(rows: Sequence[Row], time: str = TIME, error: str = ERROR) -> list[Row]:
    """Return the rows that no other beats in both time and error, the fastest first."""
    known = [row for row in rows if np.isfinite(row[time]) and np.isfinite(row[error])]
    best: list[Row] = []
    for row in sorted(known, key=lambda row: (row[time], row[error])):
        if not best or row[error] < best[-1][error]:
            best.append(row)
    return best


def beaten(
    row: Row, rivals: Iterable[Row], time: str = TIME, error: str = ERROR, margin: float = 1.02
) -> list[Row]:
    """Return the rivals that are both faster and more accurate, each by more than a margin: below it is chance."""
    return [each for each in rivals if each[time] * margin < row[time] and each[error] * margin < row[error]]


def knee(rows: Sequence[Row], time: str = TIME, error: str = ERROR) -> Row | None:
    """Return the row of a front where going on costs more than it buys: farthest from the line between its ends."""
    line = front(rows, time, error)
    if len(line) < 3:
        return line[-1] if line else None
    x = np.log([row[time] for row in line])
    y = np.log([max(row[error], 1e-9) for row in line])
    x, y = (x - x[0]) / (x[-1] - x[0]), (y - y[-1]) / (y[0] - y[-1])
    return line[int(np.argmax(1 - x - y))]


@dataclass(frozen=True)
class Power:
    """
    A figure that grows as a power of the facets: figure = scale * facets ** exponent.

    Attributes
    ----------
    exponent, sigma : float
        With its standard error.
    scale : float
    count : int
        Of the points it is fitted to.
    """

    exponent: float
    sigma: float
    scale: float
    count: int


def power(facets: Sequence[float], figures: Sequence[float]) -> Power | None:
    """Fit a power; None with fewer than three points that are positive."""
    x, y = np.array(facets, dtype=np.float64), np.array(figures, dtype=np.float64)
    kept = np.isfinite(y) & (y > 0) & (x > 0)
    if kept.sum() < 3:
        return None
    A = np.column_stack([np.log(x[kept]), np.ones(kept.sum())])
    found, *_ = np.linalg.lstsq(A, np.log(y[kept]), rcond=None)
    left = np.log(y[kept]) - A @ found
    variance = float(left @ left) / max(kept.sum() - 2, 1)
    sigma = float(np.sqrt(variance * np.linalg.inv(A.T @ A)[0, 0]))
    return Power(float(found[0]), sigma, float(np.exp(found[1])), int(kept.sum()))


def enough_facets(rows: Sequence[Row]) -> float | None:
    """
    Return the facets from which on the mesh adds less than 1 % to the noise bound; None: never within the rows.

    Parameters
    ----------
    rows : sequence
        One method, one probe, one force: by facets.
    """
    ordered = sorted(rows, key=lambda row: row["facets_found"])
    ratios = np.array([row["over_bound"] for row in ordered])
    ok = ratios <= _MATTERS
    if not ok.size or not ok[-1]:
        return None
    last_bad = np.flatnonzero(~ok)
    return float(ordered[0 if not len(last_bad) else int(last_bad[-1]) + 1]["facets_found"])
