"""How long a mouse event of the brush keeps the window: the stroke, the colours of what changed, the list."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter_ns
from typing import TYPE_CHECKING

import numpy as np

from contactbench import assets
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.colours import facet_colours
from contactbench.pipeline.mesh.regions import Brush, RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile
from contactbench.pipeline.study.report import Figure, StudyReport
from contactbench.pipeline.timing import Timing
from contactbench.pipeline.workbench.regions import RegionsWork

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

LIMIT_MS = 33.0  # from the mouse event to what is seen: two frames at 60 Hz; the model is a part of it
DEFAULT_RADII = (0.003, 0.01, 0.03)
_STEP = 0.002  # m between two events: a hand at 0.1 m/s, a mouse at 50 Hz


@dataclass(frozen=True)
class BrushRow:
    """One width of the brush."""

    radius_mm: float
    events: int
    changed: float  # Facets that changed with an event, on average
    event: Timing  # The stroke goes on, and the colours of what changed are there, ns
    whole: Timing  # The same, where all facets are coloured anew instead, ns
    finish: Timing  # The end of a stroke: its step, and the areas of the list, ns

    def figures(self) -> list[Figure]:
        """99 of 100 events leave at least half of the limit to drawing."""
        brush = f"brush of {self.radius_mm:g} mm"
        return [
            Figure(brush, "an event", self.event.median / 1e6, "ms", worst=self.event.p99 / 1e6,
                   most=LIMIT_MS / 2, judged="worst"),
            Figure(brush, "facets that change with an event", self.changed),
            Figure(brush, "colouring all takes so many times as long", self.whole.median / self.event.median),
            Figure(brush, "end of a stroke", self.finish.median / 1e6, "ms"),
        ]  # fmt: skip


def run(
    probe: str = "t-shape",
    facets: int = 100_000,
    *,
    radii: Sequence[float] = DEFAULT_RADII,
    strokes: int = 20,
    events: int = 30,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Draw strokes over a bundled probe, and time each event."""
    if probe not in assets.PROBE_NAMES:
        raise InputError(
            f"there is no bundled probe {probe!r}; choose one of {', '.join(assets.PROBE_NAMES)}"
        )
    if min(strokes, events) < 1 or not radii:
        raise InputError("there is nothing to measure: give at least one radius, stroke and event.")
    body = Probe.from_arrays(*assets.make(probe, facets), name=probe)
    work = RegionsWork(ProbeFile(body, RegionSet.empty(len(body.faces)), "S"))
    for _ in range(3):
        work.step(lambda model: model.add())
    rng = np.random.default_rng(seed)
    rows = []
    for radius in radii:
        progress(f"a brush of {1000 * radius:g} mm")
        rows.append(_row(work, radius, [_path(work, events, rng) for _ in range(strokes)]))
    figures = tuple(figure for row in rows for figure in row.figures())
    return StudyReport("Painting", {"probe": probe, "facets": len(body.faces), "seed": seed}, figures)


Picks = list[tuple[int, "NDArray[np.float64]"]]


def _path(work: RegionsWork, events: int, rng: np.random.Generator) -> Picks:
    """Return picks along the surface, from a random facet in a random direction."""
    start = work.graph.centroids[rng.integers(work.graph.facet_count)]
    direction = rng.normal(size=3)
    direction *= _STEP / np.linalg.norm(direction)
    faces, points = work.graph.pick(start + np.arange(events)[:, None] * direction)
    return list(zip(faces.tolist(), points, strict=True))


def _row(work: RegionsWork, radius: float, paths: list[Picks]) -> BrushRow:
    taken: dict[str, list[float]] = {"event": [], "whole": [], "finish": []}
    changed = []
    # Both ways in turn: what slows the machine slows both.
    for number, path in enumerate((paths[0], *(each for one in paths for each in (one, one)))):
        whole = number % 2 == 0
        work.begin(Brush(radius), 1 + number % 3)
        for face, point in path:
            before = perf_counter_ns()
            faces = work.extend(face, point)
            _seen = _all_colours(work) if whole else work.colours[faces]
            after = perf_counter_ns()
            if number:  # the first warms up
                taken["whole" if whole else "event"].append(after - before)
                changed.append(len(faces))
        before = perf_counter_ns()
        work.finish()
        work.rows()
        taken["finish"].append(perf_counter_ns() - before)
        work.undo()
    event, whole_time, finish = (Timing.of(np.array(ns)) for ns in taken.values())
    return BrushRow(1000 * radius, len(taken["event"]), float(np.mean(changed)), event, whole_time, finish)


def _all_colours(work: RegionsWork) -> NDArray[np.uint8]:
    listed = [region.colour for region in work.model.regions]
    return facet_colours(work.model.labels, work.probe.invented, listed)
