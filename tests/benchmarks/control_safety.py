"""Random starts, tissues, motions and sensor faults: whether the force keeps its limit, and it ends safe."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.faulty_line import FaultKind, FaultyLine, ScriptedFault
from benchmarks.trials import in_processes

from contactbench import assets
from contactbench.pipeline.control.loop import run_loop
from contactbench.pipeline.control.settings import USUAL_MODULUS, ControlSettings, Variant
from contactbench.pipeline.control.states import ControlState
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.scenes.physics import PhysicsError
from contactbench.pipeline.simulation.scenes.platform import PlatformMotion, Tissue, TissueCourse
from contactbench.pipeline.study.gain_trials import SCENES, foundation_of, make_rig
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.study.gain_trials import SceneName

SPREAD = 5.0  # softest and stiffest tissue, as multiples of the usual one
OVER = 1.2  # of the limit, that is never passed
_STOP_S, _END_S = 6.0, 12.0  # it is told to end, and has ended
_TILT, _GAP_M = np.radians(10.0), (0.001, 0.01)
_PERIOD_S = (2.0, 10.0)
_JUMP_N, _JUMP_NM = 8.0, 0.4
_SPIKE_N, _SPIKE_NM = 60.0, 3.0
_NONE = "none"
_SWUNG_DEG = 20.0


class Placed(PlatformMotion):
    """A platform that is turned from the beginning, and then moves as any."""

    placed: NDArray[np.float64]

    @classmethod
    def at_pose(cls, motion: PlatformMotion, placed: NDArray[np.float64]) -> Placed:
        """Turn and shift a motion by (6,), m and rad."""
        made = cls(motion.amplitude, motion.period, motion.start, motion.ease)
        object.__setattr__(made, "placed", placed)
        return made

    def at(self, time: float) -> NDArray[np.float64]:
        """Return position and angles, (6,), at a time, s."""
        return np.asarray(super().at(time) + self.placed)


@dataclass(frozen=True)
class Start:
    """One random start."""

    number: int  # Which seed it was drawn from
    probe: str
    variant: Variant
    stiffness: float  # Multiple of the usual modulus
    friction: float  # m
    gap: float  # m
    tilt: tuple[float, float]  # Of the phantom, rad
    axis: str  # Of the platform's motion
    size: float  # m or rad, s, s
    period: float  # m or rad, s, s
    begin: float  # m or rad, s, s
    faults: tuple[ScriptedFault, ...]
    course: TissueCourse | None = None  # how the tissue changes
    scene: SceneName = "platform"

    @property
    def fault(self) -> str:
        """The kind of its fault, or "none"."""
        return str(self.faults[0].kind) if self.faults else _NONE


@dataclass(frozen=True)
class End:
    """What came of it."""

    start: Start
    peak: float  # Largest |F| of the true contact, N
    limit: float  # N
    ended: str  # The last state; "physics" if the scene came apart
    tracked: bool  # Whether it ever tracked
    force: float  # True force at the end, N
    # Largest angle between axis and normal from a second after it began to track, degrees; NaN if it never
    # did
    tilt: float

    @property
    def swung(self) -> bool:
        """Whether it turned further from the tissue than it ever stood at the beginning: its loops were not stable."""
        return self.tilt > _SWUNG_DEG

    @property
    def safe(self) -> bool:
        """Whether it stands still, away from the tissue, and never pressed too hard."""
        return self.ended == ControlState.SAFE and self.peak <= OVER * self.limit


def draw(number: int, seed: int = 0, *, changing: bool = False) -> Start:
    """Draw a start; the same numbers give the same one, but for the tissue, which may change."""
    rng = np.random.default_rng([seed, number])
    axis = str(rng.choice(["z", "rx", "ry"]))
    most = 0.010 if axis == "z" else _TILT
    kinds = [None, *FaultKind]
    kind = kinds[number % len(kinds)]  # as many of each
    x, y = rng.uniform(-_TILT, _TILT, 2).tolist()
    return Start(
        number=number,
        probe=str(rng.choice(assets.PROBE_NAMES)),
        variant=Variant(rng.choice([str(each) for each in Variant])),
        stiffness=float(np.exp(rng.uniform(-np.log(SPREAD), np.log(SPREAD)))),
        friction=float(rng.uniform(0.0, 0.6)),
        gap=float(rng.uniform(*_GAP_M)),
        tilt=(x, y),
        axis=axis,
        size=float(rng.uniform(0.0, most)),
        period=float(rng.uniform(*_PERIOD_S)),
        begin=float(rng.uniform(0.0, _STOP_S)),
        faults=() if kind is None else (_fault(kind, rng),),
        course=_course(np.random.default_rng([seed, number, 1])) if changing else None,
    )


def _course(rng: np.random.Generator) -> TissueCourse:
    """Draw one to three changes, each to between a sixth and twelve times what it was at first."""
    begins = np.sort(rng.uniform(0.5, _STOP_S, int(rng.integers(1, 4))))
    times, factors = [0.0], [1.0]
    for begin in begins.tolist():
        start = max(begin, times[-1] + 0.05)
        times += [start, start + float(rng.uniform(0.1, 0.6))]
        factors += [factors[-1], float(np.exp(rng.uniform(np.log(1 / 6), np.log(12.0))))]
    return TissueCourse(tuple(times), tuple(factors))


def _fault(kind: FaultKind, rng: np.random.Generator) -> ScriptedFault:
    start = float(rng.uniform(0.3, _STOP_S))
    most = (_SPIKE_N, _SPIKE_NM) if kind is FaultKind.SPIKE else (_JUMP_N, _JUMP_NM)
    wrench = rng.uniform(-1, 1, 6) * np.repeat(most, 3)
    match kind:
        case FaultKind.SPIKE:
            seconds = float(rng.choice([0.0, 0.012, 0.05]))
        case FaultKind.BIAS_JUMP:
            seconds = float("inf")
        case _:
            seconds = float(rng.choice([0.02, 0.1, 1.0, np.inf]))
    given = wrench if kind in (FaultKind.SPIKE, FaultKind.BIAS_JUMP) else np.zeros(6)
    return ScriptedFault(kind, start, seconds, tuple(given.tolist()))


def run_start(start: Start) -> End:
    """Run one: it is told to end after 6 s, and must have ended after 12."""
    settings = replace(ControlSettings.for_probe(foundation_of(start.probe)), variant=start.variant)
    motion = PlatformMotion.along(start.axis, start.size, start.period, start.begin)
    modulus = start.stiffness * USUAL_MODULUS
    rig = make_rig(
        start.scene,
        start.probe,
        settings,
        start.number,
        tissue=Tissue(modulus, modulus / 60, start.friction, course=start.course),
        motion=Placed.at_pose(motion, np.array([0.0, 0.0, 0.0, *start.tilt, 0.0])),
        gap=start.gap,
        coarse=True,
    )
    try:
        trace = run_loop(
            rig.scene,
            rig.controller,
            rig.sensor,
            _END_S,
            line=FaultyLine(start.faults).carry,
            stop_after=_STOP_S,
        )
    except PhysicsError:
        nothing = float("nan")
        return End(start, nothing, settings.max_force, "physics", tracked=False, force=nothing, tilt=nothing)
    tracking = trace.was(ControlState.TRACK)
    tracked = bool(tracking.any())
    began = float(trace.time[tracking][0]) if tracked else 0.0
    later = trace.tilt[tracking & (trace.time > began + 1.0)]
    tilt = float(np.degrees(later.max())) if len(later) else float("nan")
    return End(
        start,
        float(trace.peak.max()),
        settings.max_force,
        str(trace.ended),
        tracked=tracked,
        force=float(trace.force[-1]),
        tilt=tilt,
    )


def run(
    runs: int = 1_000,
    *,
    seed: int = 0,
    changing: bool = False,
    scene: SceneName = "platform",
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> StudyReport:
    """
    Run many random starts, a fifth with each kind of fault and a fifth with none.

    Parameters
    ----------
    changing : bool
        Whether the tissue becomes stiffer or softer meanwhile, by up to twelve times within some tenths of a second.
    """
    if not 1 <= runs <= 1_000_000:
        raise InputError(f"{runs} runs: give 1 to 1,000,000.")
    if scene not in SCENES:
        raise InputError(f"there is no scene {scene!r}: choose among {', '.join(SCENES)}.")
    starts = [replace(draw(number, seed, changing=changing), scene=scene) for number in range(runs)]
    ends = []
    for end in in_processes(run_start, starts, workers):
        ends.append(end)
        progress(len(ends), runs)
    ends.sort(key=lambda end: end.start.number)
    return report_of(ends, {"runs": runs, "seed": seed, "changing": changing, "scene": scene})


def report_of(ends: list[End], settings: dict[str, object]) -> StudyReport:
    """Judge all ends: no force 20 % over its limit, nor without a fault over 80 % of it, and each in a safe state."""
    figures = []
    for fault in (_NONE, *map(str, FaultKind)):
        mine = [end for end in ends if end.start.fault == fault]
        if not mine:
            continue
        safe = 100 * float(np.mean([e.ended == ControlState.SAFE for e in mine]))
        over, most = [100 * end.peak / end.limit for end in mine], 80.0 if fault == _NONE else 100 * OVER
        figures += [
            Figure.of(fault, "largest force, of the limit", over, "%", most=most, judged="worst"),
            Figure(fault, "ended safe", safe, "%", 100),
            Figure(fault, "had tracked before", 100 * float(np.mean([end.tracked for end in mine])), "%"),
        ]
    for variant in Variant:
        good = [e for e in ends if e.start.fault == _NONE and e.tracked and e.start.variant is variant]
        if good:
            name = f"turned over {_SWUNG_DEG:g} degrees off while tracking, {variant}"
            swung = 100 * float(np.mean([end.swung for end in good]))
            # The plain one is the paper's: on a narrow face a place says next to nothing of a tilt, and `max_tilt` is
            # what ends it.
            most = 0.0 if variant is Variant.AWARE else None
            figures.append(Figure(_NONE, name, swung, "%", most=most))
    bad = [end for end in ends if not end.safe or (end.swung and end.start.fault == _NONE)]
    counts = ", ".join(f"{name} {count}" for name, count in Counter(e.ended for e in ends).items())
    notes = [f"Ends: {counts}."]
    notes += [f"Not safe, or swung: {end}." for end in bad[:10]]
    notes.append(
        f"A bias jump of b moves the true force by b and no controller with this one sensor can see it; up to"
        f" {_JUMP_N:g} N and {_JUMP_NM:g} N·m an axis were drawn."
    )
    return StudyReport("study control-safety", dict(settings), tuple(figures), tuple(notes))
