"""How fast is a touch beside a ray query of the best ray tracers, on the same meshes, in one run?

Ray tracers are measured where they are there, and named where not: `pip install contactbench[rivals]` (embreex,
trimesh, Open3D, which wants the system's libusb-1.0), `pip install fcpw`, and `--bvh DIR` for a checkout of
https://github.com/madmann91/bvh (version 2), which g++ compiles, as it does the kernel's headers. `--facets
1000,5000000` takes other sizes; five million need 8 GB and some minutes.
"""

from __future__ import annotations

import tempfile
import time
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from benchmarks.rays import page
from benchmarks.rays.contenders import (
    ALL,
    BATCH,
    BVH,
    EMBREEX,
    FIRST,
    HEADERS,
    OPEN3D,
    OURS,
    PAIR,
    SINGLE,
    Contender,
    Field,
    Questions,
    every_hit,
)
from benchmarks.rays.memory import bytes_per_facet
from slides import draw_slide

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.contact.methods import EmbreeAxis
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation import add_noise, draw_touches
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.study.report import Figure, StudyReport
from contactbench.pipeline.study.sweep.cell import bound_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.simulation import Touches

    Key = tuple[str, str, str]
    Float = NDArray[np.float64]

SIZES = (500, 1_000, 2_000, 20_000, 100_000, 1_000_000)
_TOGETHER, _ALONE = 4_096, 200  # rows of a batch; calls one at a time, in each round
_FEWEST = 2 * _TOGETHER
# Targets: time over a rival's at the sizes that are judged, and what must hold on large meshes.
_JUDGED, _LARGE = (2_000, 20_000, 100_000), (100_000, 1_000_000)
_OVER_ALL, _OVER_FIRST, _SPEED_UP = 1.2, 3.0, 1.8
_COLD_TAIL, _TRACKING_TAIL, _GROWTH, _BYTES = 3.0, 4.0, 2.5, 110.0


class Clocked(NamedTuple):
    """What a touch or ray took, µs."""

    taken: float  # what is compared: processor time of the thread that computes, for two threads by the wall
    wall: float
    work: float  # processor time of all threads


@dataclass(frozen=True, eq=False)
class OnMesh:
    """Everybody on one mesh, and what was measured."""

    facets: int  # as asked for
    asked: Questions
    contenders: list[Contender]
    clocks: dict[Key, list[Clocked]] = field(default_factory=lambda: defaultdict(list))  # one for each round
    # page.COLD, page.TRACKING -> for each round (touches,) ns of single solves by the wall, the same touches each time
    solves: dict[str, list[Float]] = field(default_factory=lambda: defaultdict(list))

    def taken(self, key: Key) -> Float:
        """What is compared (rounds,), µs a touch or ray."""
        return np.array([each.taken for each in self.clocks[key]])

    def walls(self, key: Key) -> Float:
        """The same by the wall."""
        return np.array([each.wall for each in self.clocks[key]])

    def works(self, key: Key) -> Float:
        """The same, processor time of all threads."""
        return np.array([each.work for each in self.clocks[key]])

    def medians(self, name: str) -> Float:
        """Median solve of each round (rounds,), ns."""
        return np.asarray(np.median(self.solves[name], axis=1))

    def tails(self, name: str) -> Float:
        """99th percentile over median of each round (rounds,)."""
        return np.asarray(np.percentile(self.solves[name], 99, axis=1) / self.medians(name))

    def own_tail(self, name: str) -> float:
        """The same of the touches themselves: each by its median over the rounds, so that interrupts do not count."""
        each = np.median(self.solves[name], axis=0)
        return float(np.percentile(each, 99) / np.median(each))


def run(
    facets: Sequence[int] = SIZES,
    *,
    probe: str = "t-shape",
    touches: int = 20_000,
    rounds: int = 15,
    bvh: Path | None = None,
    seed: int = 0,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure everybody who is there."""
    check_bundled([probe])
    if min(facets, default=0) < 300 or max(facets) > 10_000_000:
        raise InputError("--facets: give 300 to 10,000,000.")
    if touches < _FEWEST:
        raise InputError(f"--touches {touches}: give at least {_FEWEST:,}.")
    if rounds < 2:
        raise InputError(f"--rounds {rounds}: give at least 2.")
    rng, noise, surface = np.random.default_rng(seed), WrenchNoise(), assets.surface(probe)
    truth = draw_touches(surface, touches, rng, above=0.02)
    wrenches = add_noise(truth.wrenches, noise, rng)
    stream = add_noise(draw_slide(surface, touches, rng).wrenches, noise, rng)
    with tempfile.TemporaryDirectory(prefix="contactbench-rays-") as folder:
        there = Field(Path(folder), bvh)
        measured = []
        for count in facets:
            progress(f"everybody on {count:,} facets")
            solver = ContactSolver(Probe.from_arrays(*assets.make(probe, count)), noise)
            asked = Questions.of(solver, wrenches, stream)
            measured.append(OnMesh(count, asked, list(there.contenders(asked))))
        # All sizes in turn, so that what else the machine does falls on all. The first round warms everything up.
        for done in range(-1, rounds):
            progress(f"round {done + 1} of {rounds}")
            for mesh in measured:
                _round(mesh, done)
    progress(f"memory of {max(facets):,} facets")
    size = bytes_per_facet(probe, max(facets))
    figures = [*_ratios(measured), *_threads(measured), *_evenness(measured), *_memory(max(facets), size)]
    settings = {"probe": probe, "touches": f"{touches:,}", "rounds": rounds, "seed": seed}
    errors = {mesh.facets: _errors(mesh.asked, truth) for mesh in measured}
    return page.report(settings, measured, errors, tuple(figures), there.absent)


def _round(mesh: OnMesh, done: int) -> None:
    asked = mesh.asked
    clocked = {each.key: _timed(each, done + 1, len(asked.wrenches)) for each in mesh.contenders}
    cold = asked.solver.time_each(asked.wrenches[:_TOGETHER])
    tracking = asked.solver.time_tracking(asked.stream[:_TOGETHER])
    if done >= 0:
        for key, each in clocked.items():
            mesh.clocks[key].append(each)
        mesh.solves[page.COLD].append(cold)
        mesh.solves[page.TRACKING].append(tracking)


def _timed(contender: Contender, turn: int, rows: int) -> Clocked:
    count = _ALONE if contender.calls == SINGLE else _TOGETHER
    start = turn * count % (rows - count)  # new places in each round
    ask = contender.ready(slice(start, start + count))
    clocks = time.thread_time, time.perf_counter, time.process_time
    begun = [clock() for clock in clocks]
    ask()
    own, wall, work = (1e6 / count * (clock() - begin) for clock, begin in zip(clocks, begun, strict=True))
    return Clocked(work if contender.own_threads else wall if contender.calls == PAIR else own, wall, work)


def _errors(asked: Questions, truth: Touches) -> page.Errors:
    bound = np.sqrt(bound_of(truth, np.sqrt(np.diag(asked.solver.noise.covariance))))
    batch = asked.solver.locate_batch(asked.wrenches)
    ours, sure = _off(batch.points, truth.points), batch.accepted
    found = {page.OURS_ALL: (ours, bound), page.OURS_SURE: (ours[sure], bound[sure])}
    try:
        embree = EmbreeAxis(asked.solver)
    except InputError:
        return page.Errors(found, float("nan"))  # who is absent is told already
    found[page.RAY_FIRST] = _off(embree.locate_batch(asked.wrenches).points, truth.points), bound
    rays, far = every_hit(embree, *asked.rays)
    origins, directions = (each[rays].astype(np.float64) for each in asked.rays)
    points = origins + far[:, None] * directions + asked.axis.centre
    best = np.full(len(truth), np.inf)
    np.minimum.at(best, rays, _off(points, truth.points[rays]))
    found[page.RAY_BEST] = best, bound
    return page.Errors(found, len(rays) / len(truth))


def _off(points: Float, true: Float) -> Float:
    return np.nan_to_num(np.linalg.norm(points - true, axis=1), nan=np.inf)


def _ratios(measured: list[OnMesh]) -> list[Figure]:
    rivals = (
        (BVH, ALL, _OVER_ALL),
        (OPEN3D, ALL, None),
        (OPEN3D, FIRST, _OVER_FIRST),
        (EMBREEX, FIRST, _OVER_FIRST),
    )
    figures = []
    for mesh in measured:
        ours = mesh.taken((OURS, "", BATCH))
        for name, query, most in rivals:
            key = name, query, BATCH
            if key in mesh.clocks and mesh.facets in _JUDGED:
                title = f"batch, one thread: a touch over {name}, {query}"
                figures.append(_figure(mesh.facets, title, ours / mesh.taken(key), most=most))
    return figures


def _threads(measured: list[OnMesh]) -> list[Figure]:
    figures = []
    for mesh in measured:
        for name, query in ((OURS, ""), (HEADERS, ""), (OPEN3D, FIRST), (BVH, ALL)):
            if (name, query, PAIR) not in mesh.clocks or mesh.facets not in _JUDGED:
                continue
            alone, both = (name, query, BATCH), (name, query, PAIR)
            one, two = mesh.walls(alone), mesh.walls(both)
            title = f"two threads, times one: {name} {query}".rstrip()
            least = _SPEED_UP if name == OURS else None
            best = float(one.min() / two.min())
            figures.append(_figure(mesh.facets, title, one / two, measured=best, least=least))
            if name == OURS:
                free = 2 * mesh.works(alone) / mesh.works(both)
                figures.append(_figure(mesh.facets, f"{title}, if both had a core of their own", free))
    return figures


def _evenness(measured: list[OnMesh]) -> list[Figure]:
    figures = []
    for name, most in ((page.COLD, _COLD_TAIL), (page.TRACKING, _TRACKING_TAIL)):
        title = f"single solves, {name}: 99th percentile over median"
        for mesh in measured:
            if mesh.facets in _LARGE:
                of, measured_so = f"{mesh.facets:,} facets", f"{title}, as each round measured it"
                figures.append(Figure(of, title, mesh.own_tail(name), most=most))
                figures.append(_figure(mesh.facets, measured_so, mesh.tails(name)))
        by_size = {mesh.facets: mesh.medians(name) for mesh in measured}
        if 1_000 in by_size and 1_000_000 in by_size:
            grown = by_size[1_000_000] / by_size[1_000]
            title = f"single solves, {name}: median over that of 1,000 facets"
            figures.append(_figure(1_000_000, title, grown, most=_GROWTH))
    return figures


def _memory(facets: int, size: float) -> list[Figure]:
    if not np.isfinite(size):
        return []
    most = _BYTES if facets >= 100_000 else None
    return [Figure(f"{facets:,} facets", "memory of a model, a facet", size, "B", most=most)]


def _figure(
    facets: int,
    name: str,
    values: Float,
    *,
    measured: float | None = None,
    least: float | None = None,
    most: float | None = None,
) -> Figure:
    headline = float(np.median(values)) if measured is None else measured
    return Figure.of(f"{facets:,} facets", name, values, measured=headline, least=least, most=most)
