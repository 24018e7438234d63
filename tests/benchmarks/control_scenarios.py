"""What a patient does to a controller: ribs, a cough, a bubble, a frozen sensor, late poses; on each probe."""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmarks.faulty_line import FaultKind, FaultyLine, ScriptedFault
from benchmarks.trials import in_processes

from contactbench import assets
from contactbench.pipeline.control.loop import run_loop
from contactbench.pipeline.control.settings import ControlSettings, Variant
from contactbench.pipeline.control.states import ControlState
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.scenes.physics import PhysicsError
from contactbench.pipeline.simulation.scenes.platform import Tissue, TissueCourse
from contactbench.pipeline.study.gain_trials import SCENES, foundation_of, make_rig
from contactbench.pipeline.study.report import Figure, Sheet, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.control.loop import Trace
    from contactbench.pipeline.study.gain_trials import SceneName

EVENT_S, SETTLED_S, LAST_S = 4.0, 1.0, 4.0  # when it begins, how long it may take, how long it is watched
FORCE_N, STRAYED_N, WORD_S = 7.0, 2.0, 0.5
_SWING_S = 0.4  # of a window: a swing of the force loop has 2 to 8 Hz
_STOP_S = 2.0  # within which it must have gone back, once it was told to
_RIB_S = 0.3
_USUAL = Tissue(friction=0.1)


@dataclass(frozen=True, eq=False)
class Path:
    """A motion of the platform through given poses, each way as smooth as a raised cosine."""

    times: tuple[float, ...]  # s
    poses: NDArray[np.float64]  # (n, 6) m and rad

    def at(self, time: float) -> NDArray[np.float64]:
        """Return position and angles, (6,), at a time, s."""
        k = int(np.clip(np.searchsorted(self.times, time) - 1, 0, len(self.times) - 2))
        share = np.clip((time - self.times[k]) / (self.times[k + 1] - self.times[k]), 0.0, 1.0)
        smooth = (1 - np.cos(np.pi * share)) / 2
        return np.asarray(self.poses[k] + smooth * (self.poses[k + 1] - self.poses[k]))

    def speed(self, time: float) -> NDArray[np.float64]:
        """Return how fast they change, (6,), m/s and rad/s."""
        return (self.at(time + 1e-5) - self.at(time - 1e-5)) / 2e-5


def _along(axis: str, *points: tuple[float, float]) -> Path:
    """Return a path along one axis of the platform, through (s after the event, m)."""
    poses = np.zeros((len(points), 6))
    poses[:, ("x", "y", "z").index(axis)] = [size for _, size in points]
    return Path(tuple(EVENT_S + after for after, _ in points), poses)


def _course(*points: tuple[float, float]) -> TissueCourse:
    """Return a course through (s after the event, factor)."""
    return TissueCourse(tuple(EVENT_S + after for after, _ in points), tuple(factor for _, factor in points))


@dataclass(frozen=True, eq=False)
class Scenario:
    """
    One of them, and what it must end with.

    `follows`: how far the force may be off a second after the event, and swing, N; without, it is enough that it never
    comes too near to the limit, and ends safe once it is told to.
    """

    name: str
    tissue: Tissue = _USUAL
    motion: Path | None = None
    faults: tuple[ScriptedFault, ...] = ()
    poses_late: float = 0.0  # s
    follows: float | None = None
    least: int = 0  # how many changes of state must be told after the event


def _rib(factor: float) -> Tissue:
    return replace(_USUAL, course=_course((0.0, 1.0), (_RIB_S, factor)))


_RIBS = ((0.0, 1.0), (0.3, 6.0), (0.8, 6.0), (1.1, 1.0), (1.6, 1.0), (1.9, 6.0), (2.4, 6.0), (2.7, 1.0))
SCENARIOS = {
    each.name: each
    for each in (
        Scenario("rib x3", _rib(3.0), follows=0.3),
        Scenario("rib x6", _rib(6.0), follows=0.3),
        Scenario("rib x12", _rib(12.0), follows=0.5),
        Scenario(
            "sliding over ribs",
            replace(_USUAL, course=_course(*_RIBS)),
            _along("x", (0.0, 0.0), (3.0, 0.06)),
        ),
        Scenario("creep", replace(_USUAL, course=_course((0.0, 1.0), (4.0, 0.4))), follows=0.3),
        Scenario("edge", replace(_USUAL, half_size=0.05), _along("x", (0.0, 0.0), (3.0, 0.12))),
        Scenario("bubble", replace(_USUAL, course=_course((0.0, 1.0), (0.02, 1e-3), (0.4, 1e-3), (0.42, 1.0)))),
        Scenario("cough", motion=_along("z", (0.0, 0.0), (0.5, 0.02), (1.0, 0.0))),
        Scenario("sensor frozen in the press", faults=(ScriptedFault(FaultKind.STUCK, 1.9, np.inf),), least=1),
        Scenario("poses 100 ms late", motion=_along("z", (0.0, 0.0), (1.0, 0.01), (2.0, 0.0)), poses_late=0.1, least=1),
    )
}  # fmt: skip


@dataclass(frozen=True)
class Course:
    """What came of one scenario."""

    scene: str
    scenario: str
    probe: str
    seed: int
    peak: float  # largest |F| of the true contact from a period before the event on, N
    limit: float  # N
    off: float  # largest distance of the force's mean over a window from the wanted one, from a second on, N
    swing: (
        float  # largest lasting swing from then on: the least of the half ranges of three windows in a row, N
    )
    tracked: float  # share of the time from then on in which it tracked
    ended: str  # state when it was told to end
    safe: bool  # whether it ended away from the tissue, then
    told: str  # what its changes of state from the event on said
    silent: float  # longest time that it tracked with a force off by 2 N and no word of it, s


def run_scenario(
    name: str,
    probe: str,
    seed: int,
    *,
    scene: SceneName = "platform",
    variant: Variant = Variant.AWARE,
    coarse: bool = True,
    settings: ControlSettings | None = None,
) -> tuple[Course, Trace | None]:
    """Run one; without a trace, the physics came apart."""
    given = SCENARIOS[name]
    settings = settings or replace(ControlSettings.for_probe(foundation_of(probe)), variant=variant)
    rig = make_rig(scene, probe, settings, seed, tissue=given.tissue, motion=given.motion, coarse=coarse)
    stop = EVENT_S + LAST_S
    try:
        trace = run_loop(
            rig.scene,
            rig.controller,
            rig.sensor,
            stop + _STOP_S,
            line=FaultyLine(given.faults).carry if given.faults else None,
            poses_late=given.poses_late,
            stop_after=stop,
        )
    except PhysicsError:
        nothing = float("nan")
        return Course(scene, name, probe, seed, nothing, settings.max_force, nothing, nothing, 0.0, "physics",
                      safe=False, told="", silent=nothing), None  # fmt: skip
    return course_of(given, scene, probe, seed, trace, settings), trace


def course_of(
    given: Scenario, scene: str, probe: str, seed: int, trace: Trace, settings: ControlSettings
) -> Course:
    """Sum up a run."""
    begin = 0.0 if given.poses_late else min([EVENT_S, *(fault.start for fault in given.faults)])
    stop = EVENT_S + LAST_S
    event, settled = trace.between(begin - 0.02), trace.between(EVENT_S + SETTLED_S, stop)
    before = trace.between(0.0, stop)
    width = round(_SWING_S / settings.period)
    windows = [settled.force[k : k + width] for k in range(0, len(settled) - width + 1, width)]
    ranges = [float(np.ptp(each)) / 2 for each in windows]
    means = [abs(float(each.mean()) - settings.desired_force) for each in windows]
    lasting = [min(ranges[k : k + 3]) for k in range(max(len(ranges) - 2, 0))]
    return Course(
        scene,
        given.name,
        probe,
        seed,
        peak=float(event.peak.max()) if len(event) else float("nan"),
        limit=settings.max_force,
        off=max(means, default=float("nan")),
        swing=max(lasting, default=float("nan")),
        tracked=float(settled.was(ControlState.TRACK).mean()) if len(settled) else 0.0,
        ended=str(before.ended),
        safe=trace.ended is ControlState.SAFE and float(trace.force[-1]) == 0.0,
        told="; ".join(f"{each.after}: {each.reason}" for each in trace.changes if begin <= each.time < stop),
        silent=_silent(trace.between(begin, stop), settings.desired_force),
    )


def _silent(trace: Trace, wanted: float) -> float:
    """Return for how long at most the force was off by 2 N while it tracked, and nothing was said, s."""
    said = [(each.time, each.reason.startswith(("swinging", "degraded"))) for each in trace.changes]
    strays = trace.was(ControlState.TRACK) & (abs(trace.force - wanted) > STRAYED_N)
    most = since = 0.0
    for time, stray, step in zip(
        trace.time, strays, np.diff(trace.time, prepend=trace.time[:1]), strict=True
    ):
        spoken = [word for at, word in said if at <= time][-1:] == [True]
        since = since + step if stray and not spoken else 0.0
        most = max(most, since)
    return most


def run(
    probes: Sequence[str] = assets.PROBE_NAMES,
    *,
    scenarios: Sequence[str] = tuple(SCENARIOS),
    seeds: int = 5,
    first_seed: int = 0,
    scenes: Sequence[str] = ("arm", "platform"),
    variant: str = "aware",
    fine: bool = False,
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> StudyReport:
    """
    Run all scenarios on each probe with some seeds, and judge what must hold.

    Parameters
    ----------
    fine : bool
        Physics with a step of 1 ms and all places, which takes three times as long.
    """
    for kind, given, known in (
        ("scene", scenes, SCENES),
        ("probe", probes, assets.PROBE_NAMES),
        ("scenario", scenarios, SCENARIOS),
    ):
        if strange := [each for each in given if each not in known]:
            raise InputError(f"there is no {kind} {strange[0]!r}: choose among {', '.join(known)}.")
    if variant not in set(map(str, Variant)):
        raise InputError(f"there is no variant {variant!r}: choose one of {', '.join(map(str, Variant))}.")
    if not 1 <= seeds <= 1000:
        raise InputError(f"{seeds} seeds: give 1 to 1,000.")
    numbers = range(first_seed, first_seed + seeds)
    jobs = [
        (name, probe, seed, scene) for scene, name, probe, seed in product(scenes, scenarios, probes, numbers)
    ]
    courses: list[Course] = []
    for course in in_processes(partial(_course_alone, Variant(variant), not fine), jobs, workers):
        courses.append(course)
        progress(len(courses), len(jobs))
    told = {
        "probes": ", ".join(probes),
        "seeds": seeds,
        "first seed": first_seed,
        "scenes": ", ".join(scenes),
    }
    told |= {"on": f"{date.today():%Y-%m-%d}", "variant": variant}
    return report_of(courses, told | {"fine": fine})


def _course_alone(variant: Variant, coarse: bool, job: tuple[str, str, int, SceneName]) -> Course:
    return run_scenario(*job[:3], scene=job[3], variant=variant, coarse=coarse)[0]


def report_of(courses: Sequence[Course], settings: dict[str, Any]) -> StudyReport:
    """Judge all: no force over 80 % of the limit, safe ends, and on a rib the force that is wanted."""
    figures = []
    for scene, (name, given) in product(SCENES, SCENARIOS.items()):
        mine = [each for each in courses if (each.scene, each.scenario) == (scene, name)]
        if not mine:
            continue
        subject = f"{scene}, {name}"
        for what, found, unit, most in (
            ("largest force, of the limit", [100 * e.peak / e.limit for e in mine], "%", 80.0),
            ("force off after 1 s", [e.off for e in mine], "N", given.follows),
            ("lasting swing", [e.swing for e in mine], "N", given.follows),
            ("off without a word", [e.silent for e in mine], "s", WORD_S),
        ):
            figures.append(Figure.of(subject, what, found, unit, most=most, judged="worst"))
        for what, share, least in (
            ("tracked after 1 s", [e.tracked for e in mine], None),
            ("ended safe", [e.safe for e in mine], 100.0),
            ("told a change of state", [len(e.told) > 0 for e in mine], 100.0 if given.least else None),
        ):
            figures.append(Figure(subject, what, 100 * float(np.mean(share)), "%", least))
    rows = tuple(
        (e.scene, e.scenario, e.probe, e.seed, e.peak, e.off, e.swing, 100 * e.tracked, e.ended, e.told)
        for e in courses
    )
    columns = ("scene", "scenario", "probe", "seed", "peak N", "off N", "swing N", "tracked %", "end", "told")
    worst = {row[:3]: row for row in sorted(rows, key=lambda row: (np.nan_to_num(row[5] + row[6]), row[4]))}
    shown = tuple(worst[key] for key in dict.fromkeys(row[:3] for row in rows))
    sheets = (
        Sheet("worst", "The seed that was off and swung most, on each probe", columns, shown),
        Sheet("courses", "What came of each", columns, rows, shown=False),
    )
    return StudyReport("benchmark control-scenarios", settings, tuple(figures), sheets=sheets)
