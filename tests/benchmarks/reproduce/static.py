"""The static experiments: markers touched at three angles, one marker at six forces, and where errors come from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import wraps
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.marker_touches import ACROSS, ANGLES, IN_PLANE, PERPENDICULAR, press_markers
from benchmarks.reproduce import static_tables as tables
from benchmarks.reproduce.located import (
    FINE,
    LITERAL,
    MARKER,
    OURS,
    attribute,
    by_force,
    distances_mm,
    effects,
    explain,
    force_errors,
    locate_all,
)
from benchmarks.reproduce.static_tables import PAPER_PROBE
from benchmarks.trials import rms

from contactbench.pipeline.contact import Reason
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.study.gain_trials import POSES, draw_sensor
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from benchmarks.reproduce.located import Attributed, Effect, Explained, ForceErrors, ProbeResult
    from numpy.typing import NDArray

    from contactbench.pipeline.study.report import StudyReport

PROBES = ("t-shape", "linear", "convex")
FACETS = 2_000
_FEWEST_FACETS, _MOST_FACETS = 200, 20_000
_KEY_FORCES, _KEY_RISING = 100, 200
_TRIED_MARKERS = (2, 7, 11)  # for what the scene leaves out: the middle of the face, a side, a rounded corner


@dataclass(frozen=True, eq=False)
class StaticResult:
    """All that was measured."""

    settings: dict[str, Any]
    probes: list[ProbeResult]
    forces: list[ForceErrors]  # At one marker of the first probe
    force_errors: NDArray[Any]  # (n, 3). N, by marker of the first probe, and angle.
    attributed: list[Attributed]
    # What would give the paper's figures; None for another probe than its T-shape
    explained: Explained | None
    effects: list[Effect]


def measure(
    probes: Sequence[str] = PROBES,
    *,
    seeds: int = 20,
    seed: int = 0,
    touches: int = 3,
    facets: int = FACETS,
    most_markers: int | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> StaticResult:
    """Repeat the static experiments on the virtual bench."""
    names = _checked(probes, seeds, seed, touches, facets, most_markers)
    places = {name: markers(name)[:most_markers] for name in names}
    total, count = sum(map(len, places.values())) + 3 + seeds, iter(range(1, 1_000_000))

    def step() -> None:
        progress(next(count), total)

    benches = []
    numbers = range(seed, seed + seeds)
    for number in numbers:
        benches.append(draw_sensor(number))
        step()
    results = []
    for name in names:
        touched = press_markers(name, places[name], numbers, touches, step)
        results.append(locate_all(name, facets, touched, benches))
    first, touched = names[0], results[0].touched
    forces = by_force(first, facets, places[first][MARKER - 1], benches, _KEY_FORCES)
    step()
    rising = force_errors(first, places[first], benches, _KEY_RISING)
    step()
    causes = attribute(first, facets, touched, benches)
    explained = explain(first, facets, touched, benches[0]) if first == PAPER_PROBE else None
    tried = [number for number in _TRIED_MARKERS if number < len(places[first])]
    changed = effects(first, places[first][tried], benches[0])
    step()
    settings = {
        "probes": ", ".join(names),
        "seeds": seeds,
        "first seed": seed,
        "touches": touches,
        "facets": facets,
        "poses": POSES,
    }
    return StaticResult(settings, results, forces, rising, causes, explained, changed)


def _checked(
    probes: Sequence[str], seeds: int, seed: int, touches: int, facets: int, most_markers: int | None
) -> list[str]:
    names = check_bundled(probes)
    for what, count, least, most in (
        ("seeds", seeds, 1, 1_000),
        ("as the first seed", seed, 0, 1_000_000),
        ("touches", touches, 1, 1_000),
        ("facets", facets, _FEWEST_FACETS, _MOST_FACETS),
        ("markers", MARKER if most_markers is None else most_markers, MARKER, 1_000),
    ):
        if not least <= count <= most:
            raise InputError(f"{count} {what}: give a number from {least} to {most:,}.")
    return sorted(names, key=PROBES.index)  # in one order: it must not change what is found


MOST_PERPENDICULAR_MM = 0.6
MOST_RATIO = 1.2
LEAST_SURE = 95.0  # %
_NEGLIGIBLE_MM = 0.05
_TYPICAL_NM = 9.0 * 0.5 * 0.13  # of 9 N at 30 degrees, 130 mm from the sensor


@wraps(measure)  # a benchmark's options are its arguments
def run(*given: Any, **settings: Any) -> StudyReport:
    """Repeat the static experiments on the virtual bench, and compare with the paper's."""
    return report_of(measure(*given, **settings))


def report_of(result: StaticResult) -> StudyReport:
    """Compare with the targets, and say in sentences where errors come from."""
    figures, notes = judged(result.probes, result.attributed, result.explained)
    sheets = (
        tables.errors_sheet(result.probes),
        tables.markers_sheet(result.probes),
        tables.forces_sheet(result.probes[0].name, result.forces),
        tables.force_errors_sheet(result.force_errors),
        tables.causes_sheet(result.attributed, result.explained),
        tables.effects_sheet(result.effects),
        tables.times_sheet(result.probes),
    )
    return StudyReport(
        "reproduce static", result.settings, figures, notes, sheets, differences=tables.DIFFERENCES
    )


def judged(
    probes: Sequence[ProbeResult], attributed: Sequence[Attributed], explained: Explained | None
) -> tuple[tuple[Figure, ...], tuple[str, ...]]:
    """Return the figures with their targets, and sentences."""
    figures, notes = [], []
    for result in probes:
        mine = _Judged(result)
        figures.extend(mine.figures())
        notes.extend(mine.missed())
        notes.extend(_doubtful(result, angle) for angle in ANGLES if _ambiguous(result, angle).any())
        notes.extend(result.notes)
    notes.extend((_mesh_share(probes[0].name, attributed), _explanation(attributed)))
    if explained is not None:
        notes.append(_mount(explained))
    return tuple(figures), tuple(dict.fromkeys(notes))


class _Judged:
    """The figures of one probe: over all touches, with the spread and the worst of the seeds."""

    def __init__(self, result: ProbeResult) -> None:
        self._result, self._touched, self._mine = result, result.touched, result.located[OURS]
        self._error = distances_mm(self._mine.points, self._touched.points)

    def figures(self) -> list[Figure]:
        found = [
            self._figure(
                f"{PERPENDICULAR}, mean", self._mean(PERPENDICULAR), "mm", most=MOST_PERPENDICULAR_MM
            ),
            self._figure(f"{PERPENDICULAR}, error over bound", self._over_bound(PERPENDICULAR)),
            self._figure(
                "answered without doubt",
                lambda rows: 100 * float(self._mine.settled[rows].mean()),
                "%",
                least=LEAST_SURE,
            ),
            self._figure(
                "answered without doubt only because of the region",
                lambda rows: 100 * float((self._mine.reasons[rows] == Reason.BY_REGION).mean()),
                "%",
            ),
        ]
        for angle in (IN_PLANE, ACROSS):
            name = f"{angle} over {PERPENDICULAR}"
            found.append(self._figure(f"{name}, mm", self._ratio(self._mean, angle), most=MOST_RATIO))
            found.append(self._figure(f"{name}, noise and geometry alone", self._ratio(self._bound, angle)))
            over = self._ratio(self._over_bound, angle)
            found.append(self._figure(f"{name}, error over bound", over, most=MOST_RATIO))
        found.extend(self._rests(angle) for angle in ANGLES)
        return found

    def missed(self) -> list[str]:
        """Tell which ratios of millimetres are over the target, and what of that no method could help."""
        rows = np.ones(len(self._touched), dtype=np.bool_)
        found = []
        for angle in (IN_PLANE, ACROSS):
            ratio, alone = self._ratio(self._mean, angle)(rows), self._ratio(self._bound, angle)(rows)
            if ratio > MOST_RATIO:
                found.append(
                    f"{self._result.name}, {angle}: {ratio:.2f} times the perpendicular millimetres, over the target"
                    f" of {MOST_RATIO:g}; noise and geometry alone give {alone:.2f} times, because less of the force"
                    " points inwards."
                )
        return found

    def _figure(
        self,
        name: str,
        value: Callable[[NDArray[np.bool_]], float],
        unit: str = "",
        *,
        least: float | None = None,
        most: float | None = None,
    ) -> Figure:
        """Take a value over all touches, and over those of each seed."""
        seeds = self._touched.seeds
        whole = value(np.ones(len(seeds), dtype=np.bool_))
        each = [value(seeds == seed) for seed in np.unique(seeds)]
        return Figure.of(self._result.name, name, each, unit, measured=whole, least=least, most=most)

    def _rows(self, angle: str, rows: NDArray[np.bool_]) -> NDArray[np.bool_]:
        at = self._touched.angles == list(ANGLES).index(angle)
        return np.asarray(at & rows & self._mine.answered)

    def _mean(self, angle: str) -> Callable[[NDArray[np.bool_]], float]:
        def value(rows: NDArray[np.bool_]) -> float:
            error = self._error[self._rows(angle, rows)]
            return float(error.mean()) if len(error) else nan

        return value

    def _bound(self, angle: str) -> Callable[[NDArray[np.bool_]], float]:
        return lambda rows: 1e3 * rms(self._result.bounds[self._rows(angle, rows)])

    def _over_bound(self, angle: str) -> Callable[[NDArray[np.bool_]], float]:
        bound = self._bound(angle)
        return lambda rows: rms(self._error[self._rows(angle, rows)]) / bound(rows)

    @staticmethod
    def _ratio(
        of: Callable[[str], Callable[[NDArray[np.bool_]], float]], angle: str
    ) -> Callable[[NDArray[np.bool_]], float]:
        return lambda rows: of(angle)(rows) / of(PERPENDICULAR)(rows)

    def _rests(self, angle: str) -> Figure:
        """Tell how far from its marker the tip comes to rest: the mean, and the largest as the worst."""
        at = self._touched.angles == list(ANGLES).index(angle)
        off = 1e3 * distances_mm(self._touched.points[at], self._touched.targets[at])
        name = f"{angle}, tip rests off its marker"
        return Figure(self._result.name, name, float(off.mean()), "µm", worst=float(off.max()))


def _explanation(attributed: Sequence[Attributed]) -> str:
    alone = [one for one in attributed[1:-1] if one.cause != FINE]
    grown = [
        one.cause
        for one in alone
        if max(one.added[1:]) > MOST_RATIO * max(one.added[0], 0.0) + _NEGLIGIBLE_MM
    ]
    return (
        f"Of the causes tried, these add more at an angle than perpendicular: {', '.join(grown) or 'none'}."
    )


def _ambiguous(result: ProbeResult, angle: str) -> NDArray[np.bool_]:
    at = result.touched.angles == list(ANGLES).index(angle)
    return np.asarray(at & (result.located[OURS].reasons == Reason.AMBIGUOUS))


def _doubtful(result: ProbeResult, angle: str) -> str:
    """Tell of touches for which another place is as likely."""
    rows = _ambiguous(result, angle)
    off = {
        method: distances_mm(result.located[method].points[rows], result.touched.points[rows])
        for method in (OURS, LITERAL)
    }
    mean = {method: float(each[np.isfinite(each)].mean()) for method, each in off.items()}
    numbers = ", ".join(map(str, np.unique(result.touched.markers[rows]).tolist()))
    return (
        f"{result.name}, {angle}: {int(rows.sum())} touches (marker {numbers}) are called ambiguous; the means hold"
        f" the first answer, which is {mean[OURS]:.1f} mm off there. {LITERAL}, which gives no warning, is"
        f" {mean[LITERAL]:.1f} mm off."
    )


def _mesh_share(name: str, attributed: Sequence[Attributed]) -> str:
    here, fine = attributed[0], next(one for one in attributed if one.cause == FINE)
    return (
        f"{name}: what is over the bound is the mesh: to the marker the RMS is {here.rms[0]:.2f} mm here and"
        f" {fine.rms[0]:.2f} mm on the {fine.cause} (perpendicular)."
    )


def _mount(explained: Explained) -> str:
    degrees = float(np.degrees(_TYPICAL_NM / explained.stiffness))
    return (
        f"Markers {explained.reference_mm:.2f} mm off and a mount of {explained.stiffness:.0f} N·m/rad, which yields"
        f" by {degrees:.1f} degrees to 9 N at 30 degrees, give means of"
        f" {', '.join(f'{mean:.2f}' for mean in explained.means)} mm where the paper has 0.9, 1.6, 2.0: so"
        " much would have to give if nothing else did. The paper's figures do not tell which it was."
    )
