"""A probe on a phantom that moves: force and angle kept by every method, plain and aware of the motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial, wraps
from itertools import pairwise, product
from math import nan, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.reproduce.mixes import tilt_bound
from benchmarks.trials import canvas, in_processes, rms

from contactbench.pipeline.control.loop import arm_of, run_loop
from contactbench.pipeline.control.settings import USUAL_MODULUS, ControlSettings, Variant
from contactbench.pipeline.control.states import ControlState
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.simulation.scenes.platform import AXES, PlatformMotion, Tissue, TissueCylinder
from contactbench.pipeline.study.gain_trials import SCENES, SceneName, foundation_of, make_rig
from contactbench.pipeline.study.pages import png
from contactbench.pipeline.study.report import Cell as Value
from contactbench.pipeline.study.report import Figure, FigureVerdict, Sheet, StudyReport, short

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from contactbench.pipeline.control.loop import Trace
    from contactbench.pipeline.simulation.scenes.platform import MovedScene

START_S = 4.0  # by then it tracks: half a second in the air, touch, ramp, one small press
FORCE_N = 7.0
VERTICAL, IN_PLANE, OUT_OF_PLANE = "vertical", "in plane", "out of plane"
# The paper's Eq. 11: 10 mm or 10 degrees.
MOTIONS = {VERTICAL: ("z", 0.010), IN_PLANE: ("ry", np.radians(10)), OUT_OF_PLANE: ("rx", np.radians(10))}
# Across the direction in which a tilt moves the contact: a force along it moves the wrench's axis where a tilt would.
_ASIDE = {VERTICAL: "x", IN_PLANE: "y", OUT_OF_PLANE: "x"}
PERIODS_S = (10.0, 5.0, 2.0)
METHODS = ("contactbench", "algorithm1", "wrench_axis", "iterative")
_MOVING_S = 10.0


@dataclass(frozen=True)
class Phantom:
    """What is pressed on, and how it slides and twists under the probe while it makes its motion."""

    friction: float
    slide: float = 0.0  # m, to either side
    twist: float = 0.0  # rad, to either side, about the phantom's normal
    cylinder: TissueCylinder | None = None

    @property
    def tissue(self) -> Tissue:
        """Its tissue."""
        return Tissue(friction=self.friction, cylinder=self.cylinder)

    def moved(self, motion: str, period: float) -> PlatformMotion:
        """Return one of `MOTIONS`, with what comes on top."""
        axis, size = MOTIONS[motion]
        whole = np.zeros(6)
        whole[[AXES.index(axis), AXES.index("rz")]] = size, self.twist
        whole[AXES.index(_ASIDE[motion])] = self.slide
        return PlatformMotion(whole, period, START_S)


# The paper's, and two on which a contact has a torque about its normal: dry skin that slides and twists, and a limb.
PHANTOMS = {
    "flat": Phantom(0.1),
    "twisting": Phantom(0.6, slide=0.005, twist=np.radians(20)),
    "curved": Phantom(0.6, slide=0.005, cylinder=TissueCylinder(0.1, np.radians(45))),
}


@dataclass(frozen=True)
class Cell:
    """One run."""

    scene: SceneName  # {"platform", "arm"}
    probe: str
    method: str
    variant: Variant
    motion: str  # A key of `MOTIONS`
    period: float  # Of the motion, s
    seed: int  # Of load, biases, calibration and noise
    phantom: str = "flat"  # A key of `PHANTOMS`
    quick: bool = False  # One period only, with coarser physics

    @property
    def seconds(self) -> float:
        """How long the platform moves: whole periods, two of them and 10 s at least."""
        periods = 1 if self.quick else max(round(_MOVING_S / self.period), 2)
        return periods * self.period


@dataclass(frozen=True)
class Outcome:
    """What is measured while the platform moves, from its first moment on."""

    cell: Cell
    followed: float  # Share of the time in which it tracked
    force: tuple[float, float, float]  # (least, mean, largest). True, along the probe's axis, N.
    # (mean, SD). Of the absolute angle error in the plane of the motion - for a vertical one in plane - and
    # in the other one, degrees.
    angle: tuple[float, float]
    # (mean, SD). Of the absolute angle error in the plane of the motion - for a vertical one in plane - and
    # in the other one, degrees.
    other: tuple[float, float]
    whole: float  # Mean whole angle between axis and normal, degrees
    first: float  # Largest force before the platform moves, N
    lost: int  # How often the probe left the phantom after its first touch, until the end
    place: float  # Root mean square distance from sensed to true contact, mm
    # Root mean square of the true contact's torque about its own normal, N·mm, and of how far that moves
    # the wrench's axis from the contact, mm
    torsion: tuple[float, float]
    speed: float  # Largest share of a joint's speed limit that a set-point asked for
    held: float  # Share of the time in which the arm's limits cut what was wanted
    ended: str  # What happened before the end, if it did not follow


def run_cell(cell: Cell, settings: ControlSettings | None = None) -> tuple[Outcome, Trace]:
    """Run one."""
    phantom = PHANTOMS[cell.phantom]
    base = settings or ControlSettings.for_probe(foundation_of(cell.probe), desired_force=FORCE_N)
    rig = make_rig(
        cell.scene,
        cell.probe,
        replace(base, variant=cell.variant),
        cell.seed,
        method=cell.method,
        tissue=phantom.tissue,
        motion=phantom.moved(cell.motion, cell.period),
        coarse=cell.quick,
    )
    trace = run_loop(rig.scene, rig.controller, rig.sensor, START_S + cell.seconds)
    return outcome_of(cell, trace, rig.scene), trace


def outcome_of(cell: Cell, trace: Trace, scene: MovedScene) -> Outcome:
    """Sum up a run."""
    moving = trace.between(START_S)
    limits = arm_of(scene).velocity_limits
    period = float(np.median(np.diff(trace.time)))
    speeds = np.abs(np.diff(trace.joints, axis=0)) / period / limits
    first = trace.between(0.0, START_S - 1.5 * period)  # the last one may end in the jump in speed
    touched = np.flatnonzero(trace.force > 1.0)
    away = trace.force[touched[0] :] < 0.05 if len(touched) else np.zeros(1, dtype=np.bool_)
    # A run that ended itself early did not follow for the rest; where its periods begin does not matter.
    missing = max(round(cell.seconds / period) - len(moving) - 1, 0)
    followed = float(moving.was(ControlState.TRACK).sum()) / max(len(moving) + missing, 1)
    if not len(moving):
        nothing = (float("nan"), float("nan"))
        moved: dict[str, Any] = {"force": (*nothing, float("nan")), "angle": nothing, "other": nothing}
        moved |= {"whole": float("nan"), "place": float("nan"), "torsion": nothing, "held": float("nan")}
    else:
        moved = _moving(cell, moving)
    return Outcome(
        cell=cell,
        followed=followed,
        first=float(first.peak.max()),
        lost=int(np.count_nonzero(np.diff(away.astype(int)) == 1)),
        speed=float(speeds.max()),
        ended="" if followed > 0.999 else " ".join(f"{each.reason}" for each in trace.changes[2:]),
        **moved,
    )


def _moving(cell: Cell, moving: Trace) -> dict[str, Any]:
    errors = np.degrees(np.abs(moving.angles))
    mine = 1 if cell.motion == OUT_OF_PLANE else 0
    off = moving.offset - moving.place
    return {
        "force": (float(moving.force.min()), float(moving.force.mean()), float(moving.force.max())),
        "angle": (float(errors[:, mine].mean()), float(errors[:, mine].std())),
        "other": (float(errors[:, 1 - mine].mean()), float(errors[:, 1 - mine].std())),
        "whole": float(np.degrees(moving.tilt).mean()),
        "place": rms(1e3 * np.linalg.norm(off, axis=1)),
        "torsion": (rms(1e3 * moving.torsion), rms(1e3 * moving.shift)),
        "held": float((moving.share < 0.999).mean()),
    }


def run_cells(
    cells: Sequence[Cell],
    traced: Callable[[Cell], bool],
    *,
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
    settings: ControlSettings | None = None,
) -> tuple[list[Outcome], dict[Cell, Trace]]:
    """Run many: the results do not depend on how many processes share them."""
    outcomes: dict[Cell, Outcome] = {}
    traces: dict[Cell, Trace] = {}
    for outcome, trace in in_processes(partial(_run, settings), [(c, traced(c)) for c in cells], workers):
        outcomes[outcome.cell] = outcome
        if trace is not None:
            traces[outcome.cell] = trace
        progress(len(outcomes), len(cells))
    return [outcomes[cell] for cell in cells], traces


def _run(settings: ControlSettings | None, job: tuple[Cell, bool]) -> tuple[Outcome, Trace | None]:
    cell, traced = job
    outcome, trace = run_cell(cell, settings)
    return outcome, trace if traced else None


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


# ---- tables and pictures of the dynamic experiments, the paper's figures beside ours -------------


# Degrees at each period, in plane and out of plane; None: the robot could not follow.
_PLACES = [(motion, period) for period in PERIODS_S for motion in (IN_PLANE, OUT_OF_PLANE)]
TABLE_1: dict[str, dict[tuple[str, float], float | None]] = {
    name: dict(zip(_PLACES, degrees, strict=True))
    for name, degrees in (
        ("proposed method", (1.26, 1.55, 3.97, 4.65, None, None)),
        ("human, with eyes", (0.62, 0.83, 1.24, 1.78, 2.87, 3.96)),
        ("human, by touch", (1.34, 1.98, 2.69, 3.86, 3.89, 4.62)),
    )
}
# (method, motion, period s) -> mean and SD, degrees; None: could not follow.
TABLE_2: dict[tuple[str, str, float], tuple[float, float] | None] = {
    (method, *place): value
    for method, values in (
        ("contactbench", ((1.53, 1.47), (1.87, 1.38), (3.34, 2.53), (3.74, 2.28))),
        ("iterative", ((3.35, 2.54), (2.73, 1.40), (5.37, 4.15), (5.15, 3.89))),
        ("wrench_axis", ((2.27, 1.72), (2.68, 1.87), (4.43, 3.23), None)),
    )
    for place, value in zip(_PLACES[:4], values, strict=True)
}
# At T = 10 s, N.
FORCES = {VERTICAL: (5.23, 8.83), IN_PLANE: (6.04, 8.26), OUT_OF_PLANE: (5.46, 8.48)}

DIFFERENCES = (
    (
        "The paper's phantom is real, of a stiffness that it does not give; ours is a bed of springs of 3e6 N/m³ (2"
        " N/mm for the convex probe at 7 N), flat, without waves, slow creep or tissue that moves sideways. With it a"
        " contact has next to no torque about its own normal."
    ),
    (
        "The paper says neither its gains nor its noise. Ours are 6/s for force and angle, which gives its force range"
        " and angle errors of the same size; the noise (0.05 N, 1.4 N·mm a reading) is inferred from its scatter."
    ),
    (
        "Gravity and bias are taken off by a calibration from eight poses of a virtual sensor, and the rest of the"
        " bias in the air before the touch, for half a second: the paper tells only of the first."
    ),
    (
        "Errors are those between the probe's true axis and the phantom's true normal at the same instant, in the"
        " plane of the motion, from the platform's first moment on. The paper aligns two clocks and takes the axis from"
        " the robot's joint angles: bending of its arm and a clock's offset are in its figures, not in ours."
    ),
    (
        "The platform begins with a jump in speed, as Eq. 11 does: the first moments are in all means and ranges, which"
        " makes them larger than those of steady motion."
    ),
    (
        "The scene `platform` has a stiff mount in place of an arm; `arm` has an Elfin3 with a servo of 60 rad/s and"
        " its limits of speed, acceleration and torque, but without friction and bending."
    ),
    (
        "The phantom `flat` is the paper's, with gel (friction 0.1). `twisting` is dry skin (0.6) that slides by 5 mm"
        " and spins by 20 degrees to either side with the motion; `curved` is a dry cylinder of 100 mm radius, 45"
        " degrees askew, that slides by 5 mm. On both the paper has no figures."
    ),
    "Everything is computed within the sampling instant: no method pays for the time that it takes.",
)


_CROSS = "not followed"
_FOLLOWED = 0.999
_PAPER_ORDER = ("contactbench", "wrench_axis", "iterative")


def grouped(outcomes: Sequence[Outcome]) -> dict[tuple[str, str, str, float, str], list[Outcome]]:
    """Return the seeds of each (variant, phantom, motion, period, method), in the order they came."""
    groups: dict[tuple[str, str, str, float, str], list[Outcome]] = {}
    for outcome in outcomes:
        cell = outcome.cell
        place = (str(cell.variant), cell.phantom, cell.motion, cell.period, cell.method)
        groups.setdefault(place, []).append(outcome)
    return groups


def table_one(outcomes: Sequence[Outcome]) -> Sheet:
    """Return mean angle errors of our method, and the paper's of its method and of humans."""
    groups = grouped(outcomes)
    periods = sorted({o.cell.period for o in outcomes}, reverse=True)
    places = [(motion, period) for period in periods for motion in (IN_PLANE, OUT_OF_PLANE)]
    first = outcomes[0].cell.method
    rows: list[tuple[Value, ...]] = [
        (
            f"{first}, {variant}, {phantom}",
            *(_angle(groups.get((variant, phantom, motion, period, first))) for motion, period in places),
        )
        for variant, phantom in dict.fromkeys((str(o.cell.variant), o.cell.phantom) for o in outcomes)
    ]
    for name, told in TABLE_1.items():
        rows.append((f"paper: {name}", *(_printed(told, place) for place in places)))
    columns = tuple(f"T={period:g} s {motion} deg" for motion, period in places)
    return Sheet("table-1", "Table I: mean absolute angle error", ("who", *columns), tuple(rows))


def table_two(outcomes: Sequence[Outcome]) -> Sheet:
    """Return angle and force of all methods, over the seeds, and the paper's."""
    rows: list[tuple[Value, ...]] = []
    for (variant, phantom, motion, period, method), mine in grouped(outcomes).items():
        flat = phantom == "flat"
        printed = TABLE_2.get((method, motion, period), (nan, nan)) if flat else (nan, nan)
        forces = FORCES.get(motion) if flat and (method, period) == ("contactbench", 10.0) else None
        angles = [o.angle[0] for o in mine]
        rows.append(
            (
                phantom,
                variant,
                f"{period:g}",
                motion,
                method,
                len(mine),
                _angle(mine),
                f"{short(min(angles))} to {short(max(angles))}",
                float(np.mean([o.angle[1] for o in mine])),
                *((_CROSS, nan) if printed is None else printed),
                min(o.force[0] for o in mine),
                max(o.force[2] for o in mine),
                *((nan, nan) if forces is None else forces),
                float(np.mean([o.other[0] for o in mine])),
                float(np.mean([o.place for o in mine])),
                float(np.mean([o.torsion[0] for o in mine])),
            )
        )
    columns = (
        "phantom", "variant", "T s", "motion", "method", "seeds", "error deg", "over seeds", "SD", "paper deg",
        "paper SD", "least N", "largest N", "paper least", "paper largest", "other axis deg", "place mm", "torsion Nmm",
    )  # fmt: skip
    return Sheet("table-2", "Table II: all methods with the same gains and seeds", columns, tuple(rows))


def runs(outcomes: Sequence[Outcome]) -> Sheet:
    """Return every run."""
    rows = tuple(
        (
            o.cell.phantom, str(o.cell.variant), o.cell.period, o.cell.motion, o.cell.method, o.cell.seed, o.followed,
            *o.force, *o.angle, *o.other, o.whole, o.first, o.lost, o.place, *o.torsion, o.speed, o.held, o.ended,
        )
        for o in outcomes
    )  # fmt: skip
    columns = (
        "phantom", "variant", "T s", "motion", "method", "seed", "followed", "least N", "mean N", "largest N",
        "error deg", "SD deg", "other axis deg", "other SD deg", "whole angle deg", "largest before N", "lost",
        "place mm", "torsion Nmm", "axis shift mm", "joint speed", "limited", "why not followed",
    )  # fmt: skip
    return Sheet("runs", "Every run", columns, rows, shown=False)


def order_notes(outcomes: Sequence[Outcome]) -> list[str]:
    """Say whether the methods come in the paper's order on one phantom, and why not."""
    methods = list(dict.fromkeys(o.cell.method for o in outcomes))
    if not set(_PAPER_ORDER) <= set(methods):
        return []
    groups, phantom = grouped(outcomes), outcomes[0].cell.phantom
    said = []
    for variant in dict.fromkeys(str(o.cell.variant) for o in outcomes):
        kept, apart, cases = 0, 0, 0
        for motion in (IN_PLANE, OUT_OF_PLANE):
            for period in sorted({o.cell.period for o in outcomes if o.cell.motion == motion}):
                found = {m: groups[variant, phantom, motion, period, m] for m in _PAPER_ORDER}
                cases += 1
                means = [float(np.mean([o.angle[0] for o in found[m]])) for m in _PAPER_ORDER]
                kept += all(a < b for a, b in pairwise(means))
                apart += any(_differs(found[_PAPER_ORDER[0]], found[m]) for m in _PAPER_ORDER[1:])
        said.append(
            f"{phantom}, {variant}: the paper's order ({' before '.join(_PAPER_ORDER)}) holds in {kept} of {cases}"
            f" cases; in {apart} does another method differ from the first by more than three standard errors of the"
            " paired seeds."
        )
    return [*said, f"{phantom}: {_why_equal(outcomes, methods)}"]


def _why_equal(outcomes: Sequence[Outcome], methods: Sequence[str]) -> str:
    """Say what a contact of this scene leaves methods to differ by."""
    place = {m: float(np.nanmean([o.place for o in outcomes if o.cell.method == m])) for m in methods}
    listed = ", ".join(f"{m} {short(value)} mm" for m, value in place.items())
    torsion, shift = np.nanmean([o.torsion for o in outcomes], axis=0).tolist()
    press = foundation_of(outcomes[0].cell.probe).at(FORCE_N, USUAL_MODULUS)
    within, across = (float(np.degrees(1e-3 * shift / gain)) for gain in (press.gain_x, press.gain_y))
    lost = (
        "less than one degree: the order cannot come from it here. A soft phantom that does not spin hardly twists a"
        " probe; the paper's differences must come from what this scene leaves out: time that a method takes, a surface"
        " that is fitted worse, or tissue that twists the probe, as the phantom `twisting` does."
        if max(within, across) < 1
        else "enough to tell methods apart that neglect it."
    )
    return (
        f"From sensed to true contact (RMS): {listed}. The true contact's torque about its own normal is"
        f" {short(torsion)} N·mm (RMS). It moves the wrench's axis by {short(shift)} mm, which a place alone would take"
        f" for {short(within)} degrees of tilt in plane and {short(across)} out of plane: {lost} The aware variant"
        " takes its tilt from where the force leans, too, which is the same for every method."
    )


def _angle(mine: Sequence[Outcome] | None) -> Value:
    if not mine:
        return nan
    if min(o.followed for o in mine) < _FOLLOWED:
        return _CROSS
    return float(np.mean([o.angle[0] for o in mine]))


def _printed(told: dict[tuple[str, float], float | None], place: tuple[str, float]) -> Value:
    value = told.get(place, nan)
    return _CROSS if value is None else value


def _differs(one: Sequence[Outcome], other: Sequence[Outcome]) -> bool:
    apart = np.array([b.angle[0] - a.angle[0] for a, b in zip(one, other, strict=True)])
    if len(apart) < 2:
        return bool(abs(apart[0]) > 0.1 * one[0].angle[0])
    return bool(abs(apart.mean()) > 3 * apart.std(ddof=1) / sqrt(len(apart)))


_COLOURS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
_BARS = ("#0072b2", "#56b4e9", "#e69f00", "#009e73")
_PHANTOM, _BAND = "#303030", "#b0b0b0"


def draw_course(traces: Mapping[Cell, Trace]) -> bytes:
    """Draw force, and height or angle, against time for the slowest motion, as a PNG image."""
    made = [motion for motion in MOTIONS if any(cell.motion == motion for cell in traces)]
    figure = canvas(14, 1 + 3 * len(made))
    panels = figure.subplots(len(made), 2, sharex=True, squeeze=False)
    slowest = max(cell.period for cell in traces)
    for row, motion in zip(panels, made, strict=True):
        shown = {c: t for c, t in traces.items() if (c.motion, c.period) == (motion, slowest)}
        column = list(MOTIONS).index(motion)
        unit, what = ("mm", "height") if column == 0 else ("deg", "angle")
        for number, (cell, trace) in enumerate(shown.items()):
            seen = trace.between(START_S - 1)
            time, name = seen.time - START_S, f"{cell.phantom}, {cell.variant}"
            colour = _COLOURS[number % len(_COLOURS)]
            row[0].plot(time, seen.force, color=colour, lw=1, label=name)
            if number == 0:
                row[1].plot(time, _path(seen.phantom, column), color=_PHANTOM, lw=1.5, label="phantom")
            row[1].plot(time, _path(seen.probe, column), color=colour, lw=1, label=f"probe, {name}")
        low, high = FORCES[motion]
        if slowest == 10.0:
            row[0].axhspan(low, high, color=_BAND, alpha=0.3, label="paper's range")
        row[0].set(title=f"{motion}, T = {slowest:g} s", ylabel="force, N")
        row[1].set(title=f"{what} of phantom and probe", ylabel=unit)
        for panel in row:
            panel.legend(fontsize=8)
            panel.grid(alpha=0.3)
    for panel in panels[-1]:
        panel.set_xlabel("s since the platform began to move")
    return png(figure)


def draw_methods(outcomes: Sequence[Outcome]) -> bytes:
    """Draw mean angle errors of all methods, with their scatter over the seeds, as a PNG image."""
    figure = canvas(14, 5)
    panels = figure.subplots(1, 2, sharey=True)
    periods = sorted({o.cell.period for o in outcomes}, reverse=True)
    methods = list(dict.fromkeys(o.cell.method for o in outcomes))
    variants = list(dict.fromkeys(str(o.cell.variant) for o in outcomes))
    width = 0.8 / (len(methods) * len(variants))
    places = list(dict.fromkeys((o.cell.phantom, T) for o in outcomes for T in periods))
    groups = grouped(outcomes)
    for panel, motion in zip(panels, (IN_PLANE, OUT_OF_PLANE), strict=True):
        for k, (variant, method) in enumerate((v, m) for v in variants for m in methods):
            cells = [groups.get((variant, phantom, motion, T, method), []) for phantom, T in places]
            found = [[o.angle[0] for o in cell] or [nan] for cell in cells]
            panel.bar(
                np.arange(len(places)) + (k + 0.5) * width - 0.4,
                [np.mean(each) for each in found],
                width,
                yerr=[np.std(each) for each in found],
                color=_BARS[methods.index(method) % len(_BARS)],
                hatch="//" if variant == "plain" else None,
                label=f"{method}, {variant}",
            )
        panel.set_xticks(range(len(places)), [f"{phantom}, T = {T:g} s" for phantom, T in places])
        panel.set(title=motion, ylabel="mean absolute angle error, deg")
        panel.grid(axis="y", alpha=0.3)
    panels[1].legend(fontsize=8)
    return png(figure)


def _path(body: Any, column: int) -> Any:
    return 1e3 * (body[:, 0] - body[0, 0]) if column == 0 else np.degrees(body[:, column])
