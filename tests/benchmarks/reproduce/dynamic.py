"""A probe on a phantom that moves: force and angle kept by every method, plain and aware of the motion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import wraps
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.reproduce.dynamic_cells import (
    FORCE_N,
    METHODS,
    MOTIONS,
    PERIODS_S,
    PHANTOMS,
    VERTICAL,
    Cell,
    Outcome,
    run_cells,
)
from benchmarks.reproduce.dynamic_tables import (
    DIFFERENCES,
    draw_course,
    draw_methods,
    grouped,
    order_notes,
    runs,
    table_one,
    table_two,
)
from benchmarks.reproduce.tilt_bound import tilt_bound

from contactbench.pipeline.control.settings import USUAL_MODULUS, ControlSettings, Variant
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.study.gain_trials import SCENES, foundation_of
from contactbench.pipeline.study.report import Figure, FigureVerdict, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.control.loop import Trace
    from contactbench.pipeline.study.gain_trials import SceneName

OURS = "contactbench"
MOST_DEGREES = {10.0: 0.8, 5.0: 1.8, 2.0: 4.0}
FORCE_RANGE_N = (6.5, 7.5)
_FIRST_N = 1.15 * FORCE_N  # an overshoot of more than this is the beginning of an oscillation
_MOST_SEEDS = 100


@dataclass(frozen=True, eq=False)
class DynamicResult:
    """All that was measured."""

    settings: dict[str, Any]
    outcomes: tuple[Outcome, ...]
    traces: dict[Cell, Trace]  # Of the first seed and our method
    # (out of plane, in plane). Standard deviation of the tilt that one period of readings leaves, degrees.
    bound: tuple[float, float]


def measure(
    probe: str = "convex",
    *,
    scene: str = "platform",
    variants: Sequence[Variant] = tuple(Variant),
    methods: Sequence[str] = METHODS,
    periods: Sequence[float] = PERIODS_S,
    motions: Sequence[str] = tuple(MOTIONS),
    phantoms: Sequence[str] = ("flat",),
    seeds: int = 5,
    seed: int = 0,
    quick: bool = False,
    workers: int | None = None,
    settings: ControlSettings | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> DynamicResult:
    """Track a moving phantom with every method, the same gains and seeds for all."""
    variants = [Variant(each) for each in variants]
    chosen = _checked(probe, scene, variants, methods, periods, seeds, seed)
    for kind, given, known in (("motion", motions, MOTIONS), ("phantom", phantoms, PHANTOMS)):
        if not given or not set(given) <= set(known):
            raise InputError(f"{kind} {', '.join(given)!r}: choose among {', '.join(known)}.")
    cells = [
        Cell(chosen, probe, method, variant, motion, float(period), number, phantom, quick)
        for phantom, variant, period, motion, method, number in product(
            phantoms, variants, periods, motions, methods, range(seed, seed + seeds)
        )
    ]
    outcomes, traces = run_cells(
        cells,
        lambda cell: cell.seed == seed and cell.method == methods[0],
        workers=workers,
        progress=progress,
        settings=settings,
    )
    base = settings or ControlSettings.for_probe(foundation_of(probe), desired_force=FORCE_N)
    about_x, about_y = np.degrees(tilt_bound(base, foundation_of(probe), USUAL_MODULUS)).tolist()
    told = {"scene": scene, "probe": probe, "phantoms": ", ".join(phantoms), "seeds": seeds}
    told |= {"first seed": seed, "quick": quick}
    return DynamicResult(told, tuple(outcomes), traces, (about_x, about_y))


def _checked(
    probe: str,
    scene: str,
    variants: Sequence[Variant],
    methods: Sequence[str],
    periods: Sequence[float],
    seeds: int,
    seed: int,
) -> SceneName:
    check_bundled([probe])
    chosen: SceneName | None = next((each for each in SCENES if each == scene), None)
    if chosen is None:
        raise InputError(f"there is no scene {scene!r}: choose one of {', '.join(SCENES)}.")
    if strange := [name for name in methods if name not in METHODS]:
        raise InputError(f"there is no method {strange[0]!r}: choose among {', '.join(METHODS)}.")
    if not variants or not methods or not periods or not all(0.5 <= each <= 60 for each in periods):
        raise InputError("give at least one variant, one method, and periods from 0.5 to 60 s.")
    if not 1 <= seeds <= _MOST_SEEDS or seed < 0:
        raise InputError(f"{seeds} seeds from {seed} on: give 1 to {_MOST_SEEDS} seeds, from 0 on.")
    return chosen


def _judged(phantom: str, motion: str, period: float, mine: list[Outcome]) -> list[Figure]:
    """Return our figures on one phantom; the targets are those of the paper's, which is flat."""
    subject = f"{phantom}, T = {period:g} s, {motion}"
    flat = phantom == "flat"
    found = [Figure.of(subject, "followed", [100 * o.followed for o in mine], "%", least=100, judged="worst")]
    if motion != VERTICAL:
        name = "mean angle error in the plane of motion"
        found.append(
            Figure.of(
                subject,
                name,
                [o.angle[0] for o in mine],
                "deg",
                most=MOST_DEGREES.get(period) if flat else None,
            )
        )
    low, high = FORCE_RANGE_N if flat and period >= PERIODS_S[0] else (None, None)
    found.append(
        Figure.of(subject, "least force", [o.force[0] for o in mine], "N", least=low, judged="worst")
    )
    found.append(
        Figure.of(subject, "largest force", [o.force[2] for o in mine], "N", most=high, judged="worst")
    )
    return found


@wraps(measure)  # a benchmark's options are its arguments
def run(*given: Any, **settings: Any) -> StudyReport:
    """Track a moving phantom with every method, and judge ours."""
    return report_of(measure(*given, **settings))


def report_of(result: DynamicResult) -> StudyReport:
    """What is judged: our method, aware of the motion - or plain, if only that was run."""
    variant = Variant.AWARE if _of(result, Variant.AWARE) else Variant.PLAIN
    figures = [
        figure
        for (_, phantom, motion, period, _), mine in grouped(_of(result, variant)).items()
        for figure in _judged(phantom, motion, period, mine)
    ]
    mine = _of(result, variant)
    figures.append(Figure.of("all", "largest force before the motion", [o.first for o in mine], "N",
                             most=_FIRST_N, judged="worst"))  # fmt: skip
    figures.append(Figure.of("all", "times that the phantom was lost", [o.lost for o in mine], most=0,
                             judged="worst"))  # fmt: skip
    figures.append(Figure.of("all", "largest share of a joint's speed limit", [100 * o.speed for o in mine],
                             "%", most=100.0, judged="worst"))  # fmt: skip
    for axis, value in zip(("out of plane", "in plane"), result.bound, strict=True):
        figures.append(
            Figure("bound", f"tilt that one period of readings leaves unknown, {axis}", value, "deg")
        )
    notes = [f"Judged: {OURS}, {variant}.", *_missed(result, figures)]
    for phantom in dict.fromkeys(o.cell.phantom for o in result.outcomes):
        notes += order_notes([o for o in result.outcomes if o.cell.phantom == phantom])
    files = {"course.png": draw_course(result.traces), "methods.png": draw_methods(result.outcomes)}
    for cell, trace in result.traces.items():
        name = f"traces/{cell.phantom}-{cell.variant}-{cell.motion.replace(' ', '-')}-{cell.period:g}s.csv"
        files[name] = trace.csv().encode()
    sheets = (table_one(result.outcomes), table_two(result.outcomes), runs(result.outcomes))
    return StudyReport(
        "reproduce dynamic", result.settings, tuple(figures), tuple(notes), sheets, files, DIFFERENCES
    )


def _of(result: DynamicResult, variant: Variant) -> list[Outcome]:
    return [o for o in result.outcomes if (o.cell.method, o.cell.variant) == (OURS, variant)]


def _missed(result: DynamicResult, figures: Sequence[Figure]) -> list[str]:
    """Say what stands behind targets that are missed."""
    missed = [each for each in figures if each.verdict is not FigureVerdict.MET]
    if not missed:
        return []
    out, within = result.bound
    fastest = max(o.speed for o in result.outcomes)
    names = ", ".join(f"{each.subject}: {each.name}" for each in missed)
    bound = (
        f"Missed or open: {names}. What bounds them: with 0.05 N and 1.4 N·mm a reading and friction, one period"
        f" of readings leaves the tilt unknown by {out:.1f} degrees out of plane, {within:.1f} in plane;"
        " readings are 10 ms old on average when they are acted on, and the set-point holds for 20 ms."
        f" The joints were asked for at most {100 * fastest:.0f} % of their speed."
    )
    return [bound]
