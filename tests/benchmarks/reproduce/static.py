"""The static experiments: markers touched at three angles, one marker at six forces, and where errors come from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from benchmarks.reproduce import static_sheets as sheets
from benchmarks.reproduce.attribution import attribute, explain
from benchmarks.reproduce.forces import MARKER, by_force, force_errors
from benchmarks.reproduce.judging import judged
from benchmarks.reproduce.left_out import effects
from benchmarks.reproduce.locating import locate_all
from benchmarks.reproduce.static_plot import draw
from benchmarks.reproduce.static_sheets import PAPER_PROBE

from contactbench import assets
from contactbench.pipeline.durable import make_folder
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.study.marker_touches import press_markers
from contactbench.pipeline.study.paper_setup import POSES, draw_bench
from contactbench.pipeline.study.sheets import write_bytes, write_text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from benchmarks.reproduce.attribution import Attributed, Explained
    from benchmarks.reproduce.forces import ForceErrors
    from benchmarks.reproduce.left_out import Effect
    from benchmarks.reproduce.locating import ProbeResult
    from numpy.typing import NDArray

    from contactbench.pipeline.study.report import Report
    from contactbench.pipeline.study.sheets import Sheet

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

    differences = sheets.DIFFERENCES

    @property
    def summaries(self) -> tuple[Sheet, ...]:
        """What is shown in a terminal."""
        return (*self.sheets, self.times)

    @property
    def sheets(self) -> tuple[Sheet, ...]:
        """Every table that is the same for the same seed."""
        return (
            sheets.errors_sheet(self.probes),
            sheets.markers_sheet(self.probes),
            sheets.forces_sheet(self.probes[0].name, self.forces),
            sheets.force_errors_sheet(self.force_errors),
            sheets.causes_sheet(self.attributed, self.explained),
            sheets.effects_sheet(self.effects),
        )

    @property
    def times(self) -> Sheet:
        """Compiled times: another run gives others."""
        return sheets.times_sheet(self.probes)

    @property
    def report(self) -> Report:
        """What is judged."""
        return judged(self.probes, self.attributed, self.explained, self.settings)

    def markdown(self) -> str:
        """Write everything but the times."""
        parts = [self.report.markdown(), *(sheet.markdown() for sheet in self.sheets)]
        differs = "\n".join(f"- {sentence}" for sentence in sheets.DIFFERENCES)
        return "\n".join(["# The paper's static experiments", "", *parts, "## What differs", "", differs, ""])

    def to_json(self) -> dict[str, Any]:
        """Return plain data for ``--json``."""
        tables = {sheet.name: sheet.to_json() for sheet in (*self.sheets, self.times)}
        return {**self.report.to_json(), **tables, "differences": list(sheets.DIFFERENCES)}

    def write(self, out: Path) -> None:
        """Write static.md, static.png and a CSV file per table in a folder."""
        make_folder(out)
        for sheet in (*self.sheets, self.times):
            write_text(out / f"{sheet.name}.csv", sheet.csv())
        write_text(out / "static.md", self.markdown())
        write_bytes(out / "static.png", draw(self))


def run(
    probes: Sequence[str] = PROBES,
    *,
    seeds: int = 20,
    touches: int = 3,
    facets: int = FACETS,
    most_markers: int | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> StaticResult:
    """Repeat the static experiments on the virtual bench."""
    names = _checked(probes, seeds, touches, facets, most_markers)
    places = {name: markers(name)[:most_markers] for name in names}
    steps = _Steps(sum(map(len, places.values())) + 3 + seeds, progress)
    benches = []
    for seed in range(seeds):
        benches.append(draw_bench(seed))
        steps.next()
    results = []
    for name in names:
        touched = press_markers(name, places[name], seeds, touches, steps.next)
        results.append(locate_all(name, facets, touched, benches))
    first, touched = names[0], results[0].touched
    forces = by_force(first, facets, places[first][MARKER - 1], benches, _KEY_FORCES)
    steps.next()
    rising = force_errors(first, places[first], benches, _KEY_RISING)
    steps.next()
    causes = attribute(first, facets, touched, benches)
    explained = explain(first, facets, touched, benches[0]) if first == PAPER_PROBE else None
    tried = [number for number in _TRIED_MARKERS if number < len(places[first])]
    changed = effects(first, places[first][tried], benches[0])
    steps.next()
    settings = {
        "probes": ", ".join(names),
        "seeds": seeds,
        "touches": touches,
        "facets": facets,
        "poses": POSES,
    }
    return StaticResult(settings, results, forces, rising, causes, explained, changed)


class _Steps:
    """Counts what is done."""

    def __init__(self, total: int, progress: Callable[[int, int], None]) -> None:
        self._done, self._total, self._progress = 0, total, progress

    def next(self) -> None:
        self._done += 1
        self._progress(self._done, self._total)


def _checked(
    probes: Sequence[str], seeds: int, touches: int, facets: int, most_markers: int | None
) -> list[str]:
    unknown = [name for name in probes if name not in assets.PROBE_NAMES]
    if unknown or not probes:
        raise InputError(
            f"there is no probe {', '.join(unknown)!r}: choose from {', '.join(assets.PROBE_NAMES)}."
        )
    for what, count, least, most in (
        ("seeds", seeds, 1, 1_000),
        ("touches", touches, 1, 1_000),
        ("facets", facets, _FEWEST_FACETS, _MOST_FACETS),
        ("markers", MARKER if most_markers is None else most_markers, MARKER, 1_000),
    ):
        if not least <= count <= most:
            raise InputError(f"{count} {what}: give a number from {least} to {most:,}.")
    return sorted(set(probes), key=PROBES.index)  # in one order: it must not change what is found
