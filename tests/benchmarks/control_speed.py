"""How long a step of motion control takes, and how much faster than real time the closed loop is simulated."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.control.loop import run_loop
from contactbench.pipeline.control.settings import ControlSettings, Variant
from contactbench.pipeline.control.states import ControlState
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.marker_touches import check_bundled
from contactbench.pipeline.simulation.scenes import PlatformMotion, Tissue
from contactbench.pipeline.study.gain_trials import SCENES, foundation_of, make_rig
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.control.loop import Loop
    from contactbench.pipeline.control.states import ControlCommand
    from contactbench.pipeline.study.gain_trials import SceneName

MOST_MS, LEAST_TIMES = 1.0, 2.0
_BEGIN_S, _PERIOD_S, _TURN = 4.0, 2.0, float(np.radians(10.0))
_SKIPPED = 25  # steps until caches are filled


def run(
    scene: str = "arm",
    probe: str = "convex",
    *,
    seconds: float = 30.0,
    seed: int = 0,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> StudyReport:
    """
    Run the closed loop on the quickest motion, and time it.

    A step is what a controller does within a period: readings compensated and located, state machine, admittance and
    inverse kinematics; without the simulation of arm, tissue and sensor, which the second figure is of.
    """
    world = next((each for each in SCENES if each == scene), None)
    if world is None:
        raise InputError(f"there is no scene {scene!r}: choose one of {', '.join(SCENES)}.")
    check_bundled([probe])
    if not 5 <= seconds <= 600:
        raise InputError(f"{seconds:g} s: give 5 to 600.")
    figures = []
    for variant in Variant:
        figures += _timed(world, probe, variant, seconds, seed, progress)
    told: dict[str, object] = {"scene": scene, "probe": probe, "seconds": seconds, "seed": seed}
    return StudyReport("study control-speed", told, tuple(figures), (_NOTE,))


def _timed(
    scene: SceneName,
    probe: str,
    variant: Variant,
    seconds: float,
    seed: int,
    progress: Callable[[int, int], None],
) -> list[Figure]:
    settings = replace(ControlSettings.for_probe(foundation_of(probe)), variant=variant)
    motion = PlatformMotion.along("ry", _TURN, _PERIOD_S, _BEGIN_S)
    rig = make_rig(scene, probe, settings, seed, tissue=Tissue(friction=0.1), motion=motion)
    told = round(seconds)

    def watch(_command: ControlCommand, loop: Loop) -> None:
        if loop.scene.time % 1.0 < settings.period:
            progress(min(round(loop.scene.time), told), told)

    wall, own = time.perf_counter(), time.process_time()
    trace = run_loop(rig.scene, rig.controller, rig.sensor, seconds, watch=watch)
    wall, own = time.perf_counter() - wall, time.process_time() - own
    done = float(trace.time[-1])
    steps, worked = 1e3 * trace.step_s[_SKIPPED:], 1e3 * trace.step_cpu_s[_SKIPPED:]
    subject = f"{scene}, {variant}"
    return [
        Figure(subject, "control step, median", float(np.median(steps)), "ms"),
        Figure(subject, "control step, 99th percentile", float(np.percentile(steps, 99)), "ms", most=MOST_MS),
        Figure(subject, "... of the processor's time alone", float(np.percentile(worked, 99)), "ms"),
        Figure(subject, "scene and controller, times real time", done / wall, least=LEAST_TIMES),
        Figure(subject, "... by processor time alone", done / own),
        Figure(subject, "time in track", 100 * float(trace.was(ControlState.TRACK).mean()), "%"),
    ]


_NOTE = (
    "A step is everything from raw readings to the joints' set-points; the sensor gives 200 readings a second, and"
    " set-points are due every 20 ms. Times are those of this machine as busy as it was; where processor time says much"
    " less, something else ran."
)
