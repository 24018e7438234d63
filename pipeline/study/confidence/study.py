"""Every case, on every probe, with several seeds: figures with their spread, and what each must keep."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.assets import PROBE_NAMES
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.confidence import cases
from contactbench.pipeline.study.stability import check, title_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from rich.table import Table

    from contactbench.pipeline.study.confidence.cases import Bools, Float, Measured

KIND = "confidence"
PARTS = {
    "fin": "Touches on the edge of a thin fin, 5 to 10 N",
    "region": "The lens declared as the region, touches anywhere above the flange",
    "pull": "Presses of the lens, 7 N, and a pull at the tool's side that the wrench's model leaves out",
    "two touches": "Two touches more than 20 mm apart, the stronger 8 to 10 N",
    "one touch": "Single touches, 8 to 10 N, up to 30 degrees",
    "reliability": "Stated confidence against how often the point is right",
    "ellipse": "True points in the 95 % ellipse",
    "error": "Error of all answers, beside the wrench axis",
    "pruning": "The pruned search against every facet one by one",
}
STATED, RIGHT = "stated", "right"
_BINS = np.array([*np.linspace(0.0, 0.9, 10), 0.99, 1.0])
_WITHIN = 0.02  # of the stated confidence
_PRUNED_FACETS = 500
_FEW = 20  # answers: a bin of fewer says nothing


@dataclass(frozen=True)
class Sizes:
    """How much is tried."""

    # touches, seeds: of each figure, and repetitions of it
    touches: int = 10_000
    seeds: int = 5
    facets: int = 2_000  # of the meshes, where they do not vary
    ellipse_facets: tuple[int, ...] = (500, 1_000, 2_000, 20_000)
    pruned: int = 100_000  # wrenches of a probe that are compared with every facet one by one


QUICK = Sizes(touches=400, seeds=2, facets=1_000, ellipse_facets=(500, 2_000), pruned=1_000)


@dataclass(frozen=True)
class Row:
    """One figure."""

    part: str  # a key of :data:`PARTS`
    # probe, case, figure, unit: in words
    probe: str
    case: str
    figure: str
    unit: str
    tries: int  # touches of one seed; for the reliability, answers
    # value, low, high: mean, least and most of the seeds; for what is right, the share and its 95 %
    # interval
    value: float
    low: float
    high: float
    # at_least, at_most: what the mean must keep
    at_least: float | None = None
    at_most: float | None = None
    stated: float | None = None  # confidence, mean of the bin

    @property
    def met(self) -> bool:
        """Whether the bounds are kept; a bin of the reliability breaks its own only if chance cannot have done it."""
        best, worst = (self.high, self.low) if self.stated is not None else (self.value, self.value)
        low = self.at_least is None or best >= self.at_least
        return bool(low and (self.at_most is None or worst <= self.at_most))


@dataclass(frozen=True)
class ConfidenceReport:
    """Every figure."""

    names: tuple[str, ...]  # probes
    sizes: Sizes
    seed: int
    rows: tuple[Row, ...]

    @property
    def passed(self) -> bool:
        """Whether every bound was kept."""
        return all(row.met for row in self.rows)

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        return {
            "passed": self.passed,
            "probes": [title_of(name) for name in self.names],
            "seed": self.seed,
            **asdict(self.sizes),
            "rows": [asdict(row) | {"met": row.met} for row in self.rows],
        }

    def tables(self) -> list[Table]:
        """Build what missed its bound for a terminal."""
        from rich.table import Table

        from contactbench.pipeline.study.confidence.page import bound, figure

        judged = [row for row in self.rows if bound(row)]
        missed = [row for row in judged if not row.met]
        built = Table(
            title=f"Bounds missed, {self.sizes.touches:,} touches x {self.sizes.seeds}, seed {self.seed}"
        )
        built.caption = (
            f"{len(judged) - len(missed)} of {len(judged)} bounds kept; --out or --json gives every figure"
        )
        for heading in ("probe", "case", "figure", "measured", "bound"):
            built.add_column(heading)
        for row in missed:
            built.add_row(row.probe, row.case, row.figure, figure(row), bound(row), style="red")
        return [built]


def run(
    names: Sequence[str] = PROBE_NAMES,
    sizes: Sizes | None = None,
    *,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> ConfidenceReport:
    """
    Measure every case.

    Parameters
    ----------
    names : sequence of str
        Bundled probes, or prepared files in S: those have no declared lens, and are their own truth.
    seed : int
        At least 0.
    progress : callable
        Told in words what is being measured.

    Raises
    ------
    InputError
        A probe cannot be read, or the seed is negative.
    """
    if seed < 0:
        raise InputError(f"seed: {seed} is negative: give at least 0.")
    check(names)
    sizes, rows = sizes or Sizes(), list[Row]()
    for part, measure in _MEASURES.items():
        progress(PARTS[part])
        rows += measure(tuple(names), sizes, seed)
    return ConfidenceReport(tuple(names), sizes, seed, tuple(rows))


# ---- the parts -----------------------------------------------------------------------------------------


def _fin(_: Sequence[str], sizes: Sizes, seed: int) -> Iterator[Row]:
    for i, thickness in enumerate(cases.FINS_M):
        for j, (said, noise) in enumerate(cases.NOISES.items()):
            measured = [
                cases.fin(thickness, noise, sizes.touches, rng) for rng in _chances(sizes, seed, i, j)
            ]
            case = f"{1e3 * thickness:g} mm, {said} noise"
            yield from _rows(
                "fin", "capsule", case, sizes, measured, {"sure and over 10 mm off": (None, 0.1)}
            )


def _region(names: Sequence[str], sizes: Sizes, seed: int) -> Iterator[Row]:
    for i, name in enumerate(_bundled(names)):
        measured = [cases.region(name, sizes.facets, sizes.touches, rng) for rng in _chances(sizes, seed, i)]
        bounds = {"sure, of these over 5 mm off": (None, 0.1)}
        yield from _rows("region", name, "8 to 10 N", sizes, measured, bounds)


def _pull(names: Sequence[str], sizes: Sizes, seed: int) -> Iterator[Row]:
    for i, name in enumerate(_bundled(names)):
        for said, noise in cases.NOISES.items():
            for region in (False, True):
                for pull in cases.PULLS_N:
                    measured = [
                        cases.pulled(name, sizes.facets, noise, pull, sizes.touches, rng, region=region)
                        for rng in _chances(sizes, seed, i)
                    ]
                    case = f"{pull:g} N, {said} noise, {'lens declared' if region else 'no region'}"
                    # A pull of ten times the model's error is shown, not judged.
                    wrong = {"sure and over 10 mm off": (None, 0.1)} if pull == min(cases.PULLS_N) else {}
                    yield from _rows("pull", name, case, sizes, measured, wrong)


def _two(names: Sequence[str], sizes: Sizes, seed: int) -> Iterator[Row]:
    for i, name in enumerate(names):
        measured = [cases.two(name, sizes.facets, sizes.touches, rng) for rng in _chances(sizes, seed, i)]
        bounds = {"sure and over 5 mm from both": (None, 15.0)}
        yield from _rows("two touches", name, "forces 1:1 to 1:3", sizes, measured, bounds)


def _one(names: Sequence[str], sizes: Sizes, seed: int) -> Iterator[Row]:
    for i, name in enumerate(names):
        for said, noise in cases.NOISES.items():
            for torsion in cases.TORSIONS_M:
                measured = [
                    cases.single(name, sizes.facets, noise, torsion, sizes.touches, rng)
                    for rng in _chances(sizes, seed, i)
                ]
                # Of a file nobody knows how often one wrench has several answers.
                judged = name in PROBE_NAMES and torsion == min(cases.TORSIONS_M)
                bounds = {"sure": (95.0 if name == "t-shape" else 98.0, None)} if judged else {}
                case = f"torsion {1e3 * torsion:g} mm, {said} noise"
                yield from _rows("one touch", name, case, sizes, measured, bounds)


def _reliability(names: Sequence[str], sizes: Sizes, seed: int) -> Iterator[Row]:
    for i, name in enumerate(names):
        for region in (False, True) if name in PROBE_NAMES else (False,):
            pairs = [
                cases.reliability(name, sizes.facets, sizes.touches, rng, region=region)
                for rng in _chances(sizes, seed, i)
            ]
            stated, right = (np.concatenate(parts) for parts in zip(*pairs, strict=True))
            yield from bins(title_of(name), "lens declared" if region else "no region", stated, right)


def bins(probe: str, case: str, stated: Float, right: Bools) -> Iterator[Row]:
    """Compare stated confidence (n,) with what was right (n,): by its tenths, the last one split at 0.99."""
    from scipy.stats import binomtest

    where = np.clip(np.digitize(stated, _BINS) - 1, 0, len(_BINS) - 2)
    for i, (low, high) in enumerate(pairwise(_BINS)):
        own = where == i
        count, hits = int(own.sum()), int(right[own].sum())
        if not count:
            continue
        mean, interval = (
            100.0 * float(stated[own].mean()),
            binomtest(hits, count).proportion_ci(method="wilson"),
        )
        least: float | None = None
        most: float | None = None
        if low >= 0.99:
            least = 99.0
        elif count >= _FEW:
            least, most = mean - 100 * _WITHIN, mean + 100 * _WITHIN
        figure = f"{RIGHT}, where {low:g} to {high:g} is {STATED}"
        sure = (100.0 * hits / count, 100.0 * interval.low, 100.0 * interval.high)
        yield Row("reliability", probe, case, figure, "%", count, *sure, least, most, mean)


def _ellipse(names: Sequence[str], sizes: Sizes, seed: int) -> Iterator[Row]:
    for i, name in enumerate(names):
        for facets in sizes.ellipse_facets:
            for said, noise in cases.NOISES.items():
                for torsion in cases.TORSIONS_M:
                    for drift in (True, False):
                        measured = [
                            cases.ellipse(name, facets, noise, torsion, sizes.touches, rng, drift=drift)
                            for rng in _chances(sizes, seed, i)
                        ]
                        error = "with the model's error" if drift else "without"
                        case = f"{facets:,} facets, torsion {1e3 * torsion:g} mm, {said} noise, {error}"
                        # Without it the ellipse, which allows for it, holds more.
                        bounds = {"inside": (92.0, 98.0)} if drift else {}
                        yield from _rows("ellipse", name, case, sizes, measured, bounds)


def _error(names: Sequence[str], sizes: Sizes, seed: int) -> Iterator[Row]:
    for i, name in enumerate(names):
        for torsion in cases.TORSIONS_M:
            for force in cases.FORCES_N:
                measured = [
                    cases.errors(name, sizes.facets, force, torsion, sizes.touches, rng)
                    for rng in _chances(sizes, seed, i)
                ]
                case = f"{force[0]:g} to {force[1]:g} N, torsion {1e3 * torsion:g} mm"
                yield from _rows("error", name, case, sizes, measured, {})


def _pruning(names: Sequence[str], sizes: Sizes, seed: int) -> Iterator[Row]:
    for i, name in enumerate(names):
        found = cases.pruning(name, _PRUNED_FACETS, sizes.pruned, np.random.default_rng((seed, i)))
        differ = (float(found),) * 3
        case, figure = f"{_PRUNED_FACETS} facets", "answers that differ"
        yield Row("pruning", title_of(name), case, figure, "", sizes.pruned, *differ, at_most=0.0)


_MEASURES: dict[str, Callable[[Sequence[str], Sizes, int], Iterable[Row]]] = {
    "fin": _fin,
    "region": _region,
    "pull": _pull,
    "two touches": _two,
    "one touch": _one,
    "reliability": _reliability,
    "ellipse": _ellipse,
    "error": _error,
    "pruning": _pruning,
}


def _rows(
    part: str,
    name: str,
    case: str,
    sizes: Sizes,
    measured: Sequence[Measured],
    bounds: Mapping[str, tuple[float | None, float | None]],
) -> Iterator[Row]:
    """Sum up what several seeds gave: shares as %."""
    for figure in measured[0]:
        length = figure.endswith("mean")
        values = np.array([one[figure] for one in measured]) * (1.0 if length else 100.0)
        middle = (float(values.mean()), float(values.min()), float(values.max()))
        unit = "mm" if length else "%"
        yield Row(
            part,
            title_of(name),
            case,
            figure,
            unit,
            sizes.touches,
            *middle,
            *bounds.get(figure, (None, None)),
        )


def _chances(sizes: Sizes, seed: int, *place: int) -> Iterator[np.random.Generator]:
    return (np.random.default_rng((seed, *place, i)) for i in range(sizes.seeds))


def _bundled(names: Sequence[str]) -> list[str]:
    """Return the probes whose lens is known."""
    return [name for name in names if name in PROBE_NAMES]
