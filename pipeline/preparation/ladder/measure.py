"""Measure a ladder: simplify to each count, compare the contacts, and time the solvers side by side."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.kernel import Algorithm1
from contactbench.pipeline.mesh import MeshError, Probe, save_probe
from contactbench.pipeline.mesh.engines import NOBODY, Monitor
from contactbench.pipeline.mesh.simplify import Count, simplify
from contactbench.pipeline.preparation.ladder.compare import ContactReference, ExpectedTouches, LadderError
from contactbench.pipeline.preparation.ladder.ladder import Goal, Ladder, Rung, Speed, recommend
from contactbench.pipeline.timing import time_batches

DEFAULT_FACETS = (250, 500, 1_000, 2_000, 5_000, 10_000, 20_000)

_ROUNDS, _OURS = 20, 200

# The literal loop takes some 50 ns a facet: 20 solves a round up to 20,000 facets, fewer beyond.
_LOOP, _LOOP_FACETS, _LOOP_FEWEST = 20, 400_000, 4

# A rung nearer to the full mesh than this says nothing new.
_DISTINCT = 1.05

# Of the progress: the rest is timing.
_SIMPLIFYING = 0.6


def measure_ladder(
    probe: Probe,
    expected: ExpectedTouches | None = None,
    facets: Sequence[int] = DEFAULT_FACETS,
    *,
    goal: Goal | None = None,
    region_ratio: float = 1.0,
    monitor: Monitor = NOBODY,
) -> Ladder:
    """
    Measure what fewer facets cost and save.

    Parameters
    ----------
    probe : Probe
        The full mesh, in S; its priority regions are what is judged, and the whole of it when it has none.
    expected : ExpectedTouches, optional
        The noise, forces and friction that it will feel.
    facets : sequence of int
        Counts to try, at least 4 each. Those above the probe's, or within 5 % of it, are left out; the full mesh is
        always the last rung.
    goal : Goal, optional
        What simplification may cost, for the recommendation.
    region_ratio : float
        As for `simplify`.
    monitor : Monitor
        Told a share that never falls.

    Returns
    -------
    Ladder

    Raises
    ------
    LadderError
        No counts, or the full mesh settles too few touches.
    MeshError
        A count under 4, or a bad ratio.
    Cancelled
        The caller cancelled.
    """
    expected, goal = expected or ExpectedTouches(), goal or Goal()
    counts = _counts(facets, len(probe.faces))
    reference = ContactReference(probe, expected)
    rungs: list[Rung] = []
    notes: list[str] = []
    for number, count in enumerate(counts):
        start, end = (_SIMPLIFYING * each / (len(counts) + 1) for each in (number, number + 1))
        try:
            made = simplify(probe, Count(count), region_ratio=region_ratio, monitor=monitor.part(start, end))
        except MeshError as error:
            notes.append(message(f"The rung of {arg(count):,} facets is missing: {arg(error)}"))
            continue
        deviation = made.deviation
        rungs.append(_rung(made.probe, reference, count, deviation.hausdorff, deviation.rms, made.engine))
    rungs.append(_rung(probe, reference, len(probe.faces), 0.0, 0.0, "none"))
    rungs = _timed(_without_twins(rungs), reference, monitor.part(_SIMPLIFYING, 1.0))
    return Ladder(probe.name, expected, goal, tuple(rungs), recommend(rungs, goal), tuple(notes))


def _counts(facets: Sequence[int], full: int) -> list[int]:
    if not facets:
        raise LadderError("a ladder needs rungs: give at least one number of facets.")
    for count in facets:
        Count(count)  # refuses one that is too small before anything is done
    return sorted({count for count in facets if count * _DISTINCT <= full})


def _without_twins(rungs: Sequence[Rung]) -> list[Rung]:
    """Drop a rung whose engine stopped at the same count as another's: the first was asked for less."""
    found: dict[int, Rung] = {}
    for rung in rungs:
        found.setdefault(rung.facets, rung)
    return sorted(found.values(), key=lambda rung: rung.facets)


def _rung(
    probe: Probe, reference: ContactReference, asked: int, hausdorff: float, rms: float, engine: str
) -> Rung:
    return Rung(
        probe=probe,
        asked=asked,
        engine=engine,
        hausdorff=hausdorff,
        rms=rms,
        file_bytes=_file_bytes(probe),
        errors=reference.compare(probe),
        speed=None,
    )


def _file_bytes(probe: Probe) -> int:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "probe.ply"
        save_probe(probe, file)
        return file.stat().st_size


def _timed(rungs: Sequence[Rung], reference: ContactReference, monitor: Monitor) -> list[Rung]:
    """Time all rungs in one run, so that what slows the machine slows them all."""
    expected, wrenches = reference.expected, reference.wrenches
    timers = {}
    for number, rung in enumerate(rungs):
        solver = ContactSolver(rung.probe, expected.noise, expected.gates)
        loop = min(_LOOP, max(_LOOP_FEWEST, _LOOP_FACETS // rung.facets))
        timers[number, "algorithm1"] = (Algorithm1(solver).time_each, wrenches, loop)
        timers[number, "contactbench"] = (solver.time_each, wrenches, _OURS)
    monitor.tell(0.0)
    taken = time_batches(timers, rounds=_ROUNDS, after_round=lambda done: monitor.tell(done / _ROUNDS))
    monitor.tell(1.0)
    return [
        replace(rung, speed=Speed(taken[number, "algorithm1"], taken[number, "contactbench"]))
        for number, rung in enumerate(rungs)
    ]
