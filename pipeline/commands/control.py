"""``contactbench bench control ...``: motion control by touch, in simulation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from contactbench.pipeline.console import (
    Bar,
    Noun,
    answer,
    as_json,
    ended_by_signals,
    output_is_data,
    print_json,
    say,
    say_all,
    show_tables,
)
from contactbench.pipeline.control.frames import BEGIN, END, FRAME, beginning_of, frame_of, line_of
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.settings import MountSettings, PhantomSettings

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.control.loop import Loop, Trace
    from contactbench.pipeline.control.settings import Variant
    from contactbench.pipeline.control.states import ControlCommand
    from contactbench.pipeline.simulation.scenes.platform import PlatformMotion


class FrameWriter:
    """
    Writes them, until nobody reads them any more.

    Parameters
    ----------
    robot : str
        Its address.
    """

    def __init__(self, robot: str) -> None:
        self._robot = robot
        self._begun = self._gone = False

    def take(self, command: ControlCommand, loop: Loop) -> bool:
        """Write a period; returns whether somebody still reads."""
        if not self._begun:
            self._begun = True
            self._write(line_of(BEGIN, beginning_of(loop, self._robot)))
        if not self._gone:
            self._write(line_of(FRAME, frame_of(command, loop)))
        return not self._gone

    def end(self, facts: dict[str, Any]) -> None:
        """Write what came of it."""
        if not self._gone:
            self._write(line_of(END, facts))

    def _write(self, line: str) -> None:
        try:
            typer.echo(line, nl=False)
        except OSError:
            self._gone = True


control_app = Noun(
    "Motion control by touch, in simulation: tune it for a probe, run a bundle on a virtual robot."
)

_NOT_GOOD_ENOUGH = 1
_BEGIN_S = 4.0  # by then it tracks
_END_S = 5.0  # it may take that long to go back
_AXES = {"none": None, "vertical": "z", "in-plane": "ry", "out-of-plane": "rx"}


def _variant_of(text: str) -> Variant:
    from contactbench.pipeline.control.settings import Variant

    try:
        return Variant(text)
    except ValueError:
        raise InputError(f"--variant {text!r}: give {' or '.join(Variant)}.") from None


@control_app.command(example="bench control tune --probe convex --stiffness 2000 --out gains")
def tune(
    probe: str = "convex",
    stiffness: float | None = None,
    scene: str = "platform",
    variant: str = "plain",
    force: float = 7.0,
    gain_margin: float = 2.0,
    phase_margin: float = 30.0,
    spread: float = 5.0,
    seed: int = 0,
    out: Path = Path("control-gains"),
) -> None:
    """Choose the highest gains for a probe that keep the wanted margins on softer and stiffer tissue.

    The analysed loop includes the averaged readings, the delay of a period, the servo's path, and the real
    controller; the gains are then tried in simulation. Writes gains.json for `bundle export
    --settings`, tables and a plot of the margins. Exit code 1: a simulated trial oscillated, or lost the
    tissue.

    Parameters
    ----------
    probe
        Bundled probe: linear, convex or t-shape.
    stiffness
        Stiffness of the usual tissue at the wanted force, N/m [soft tissue].
    scene : platform|arm
        Robot for the trials.
    variant : plain|aware
        Variant that the gains are for.
    force
        Wanted force, N.
    gain_margin
        Factor by which each loop gain may still grow.
    phase_margin
        Degrees.
    spread
        Factor by which tissue may be softer or stiffer.
    seed
        Seed of load, calibration and noise in the trials.
    out : DIR
        Folder to write.
    """
    import math

    from contactbench.pipeline.control.margins import WantedMargins
    from contactbench.pipeline.study.gain_trials import run as study

    chosen = _variant_of(variant)
    with Bar("trying gains", counted=True) as bar:
        result = study(
            probe,
            stiffness=stiffness,
            scene=scene,
            variant=chosen,
            force=force,
            wanted=WantedMargins(gain_margin, math.radians(phase_margin), spread),
            seed=seed,
            progress=bar,
        )
    result.write(out)
    if as_json():
        print_json(result.to_json())
    else:
        show_tables(*(sheet.table() for sheet in result.report.sheets), result.report.table())
    say(f"Written to {out}: gains.json is for `bundle export --settings`.")
    if not result.report.passed:
        raise typer.Exit(_NOT_GOOD_ENOUGH)


@control_app.command(
    example=("bench control run runtime.zip --robot virtual://arm --motion vertical --out trace.csv")
)
def run(
    bundle: Path,
    /,
    robot: str,
    turned: MountSettings,
    phantom: PhantomSettings,
    seconds: float = 15.0,
    method: str = "contactbench",
    stiffness: float | None = None,
    friction: float = 0.1,
    seed: int = 0,
    real_time: bool = False,
    unverified: bool = False,
    frames: bool = False,
    out: Path | None = None,
) -> None:
    """Run a bundle's controller on a virtual robot over a moving phantom.

    The robot approaches, makes contact, tracks, and retracts at the end.

    Everything comes from the bundle: probe, calibration, noise, gates, gains, limits. Motion is never
    sent to a real robot. Ctrl-C makes it retract and end. Exit code 1: the force exceeded the limit, the
    controller gave up, or it did not end in a safe state; 2: the bundle or the robot is refused.

    Parameters
    ----------
    bundle
        Folder or zip file of a runtime config.
    robot : ADDRESS
        virtual://arm or virtual://platform.
    seconds
        Time until it retracts, s.
    method
        Method that locates contacts.
    stiffness
        Stiffness of the phantom at the wanted force, N/m [soft tissue].
    friction
        Coefficient of friction of the phantom.
    seed
        Seed of noise and of the calibration error.
    real_time
        Run no faster than real time.
    unverified
        Accept a bundle that is not verified.
    frames
        Write each period as a line of JSON on standard output while running.
    out : FILE
        CSV file of the run to write.
    """
    from contactbench.pipeline.config.runtime import RuntimeConfig
    from contactbench.pipeline.config.runtime.mounts import mount_of_angles
    from contactbench.pipeline.control.loop import run_loop
    from contactbench.pipeline.control.settings import Variant
    from contactbench.pipeline.control.virtual import check_address, virtual_robot
    from contactbench.pipeline.runtime.run import check_runnable

    check_address(robot)
    if not 1 <= seconds <= 3000:
        raise InputError(f"--seconds {seconds:g}: give 1 to 3000.")
    if frames and as_json():
        raise InputError(
            "--frames and --json cannot be combined: the last line of --frames is what --json prints."
        )
    config = RuntimeConfig.load(bundle)
    check_runnable(config, unverified=unverified)
    made = virtual_robot(
        config,
        robot,
        variant=None if phantom.variant is None else Variant(phantom.variant),
        method=method,
        motion=_motion(phantom),
        stiffness=stiffness,
        friction=friction,
        quaternion_ES=mount_of_angles(turned.mount),
        seed=seed,
    )
    if frames:
        output_is_data()
    show = FrameWriter(robot) if frames else None
    with ended_by_signals() as ended:

        def watch(command: ControlCommand, loop: Loop) -> None:
            if show is not None and not show.take(command, loop):
                ended.asked = True  # who watched has gone
            if command.change is not None:
                change = command.change
                say(f"{change.time:7.2f} s  {change.before} -> {change.after}: {change.reason}")
            if ended.asked:
                loop.controller.stop()

        paced = _paced(watch) if real_time else watch
        trace = run_loop(
            made.scene, made.controller, made.sensor, seconds + _END_S, stop_after=seconds, watch=paced
        )
    if out is not None:
        write_file(out, trace.csv().encode())
    facts = _facts(config, trace)
    _tell(facts)
    if show is not None:
        show.end(facts)
    answer(facts, good=not facts["faults"])


def _motion(given: PhantomSettings) -> PlatformMotion | None:
    import math

    from contactbench.pipeline.simulation.scenes.platform import PlatformMotion

    axis = _AXES[given.motion]
    if axis is None:
        return None
    size = given.size / 1000 if axis == "z" else math.radians(given.size)
    return PlatformMotion.along(axis, size, given.period, _BEGIN_S)


def _paced(watch: Callable[[ControlCommand, Loop], None]) -> Callable[[ControlCommand, Loop], None]:
    """Hold the loop back to the clock."""
    import time

    begin = time.monotonic()

    def paced(command: ControlCommand, loop: Loop) -> None:
        watch(command, loop)
        time.sleep(max(begin + loop.scene.time - time.monotonic(), 0.0))

    return paced


def _facts(config: RuntimeConfig, trace: Trace) -> dict[str, Any]:
    import numpy as np

    from contactbench.pipeline.control.states import ControlState

    limit = config.model.limits.max_force_N
    tracking = trace.was(ControlState.TRACK)
    faults = []
    if (peak := float(trace.peak.max())) > limit:
        faults.append(f"the force reached {peak:.1f} N, over the limit of {limit:g} N.")
    if trace.ended is not ControlState.SAFE:
        faults.append(f"it ended in the unsafe state {trace.ended}.")
    back = [each for each in trace.changes if each.after is ControlState.RETRACT]
    if back and "stopped" not in back[0].reason:
        faults.append(f"it gave up after {back[0].time:.1f} s: {back[0].reason}")
    elif not tracking.any():
        faults.append("it never started tracking.")
    degrees = np.degrees(np.abs(trace.angles[tracking]))
    force = trace.force[tracking]
    return {
        "seconds": float(trace.time[-1]),
        "tracked_s": float(tracking.sum() * (trace.time[1] - trace.time[0])) if len(trace) > 1 else 0.0,
        "force_N": [float(force.min()), float(force.max())] if len(force) else None,
        "peak_N": peak,
        "limit_N": limit,
        "angle_error_deg": [float(each) for each in degrees.mean(axis=0)] if len(force) else None,
        "step_p99_ms": float(1e3 * np.percentile(trace.step_s, 99)),
        "ended": str(trace.ended),
        "states": [
            {"time_s": c.time, "from": str(c.before), "to": str(c.after), "reason": c.reason}
            for c in trace.changes
        ],
        "faults": faults,
    }


def _tell(facts: dict[str, Any]) -> None:
    if facts["force_N"]:
        low, high = facts["force_N"]
        within, out = facts["angle_error_deg"]
        say(
            f"Tracked for {facts['tracked_s']:.1f} s: {low:.2f} to {high:.2f} N, mean angle error {within:.2f} degrees"
            f" in plane, {out:.2f} out of plane; largest force {facts['peak_N']:.1f} N of {facts['limit_N']:g} N."
        )
    say(f"Ended {facts['ended']} after {facts['seconds']:.1f} s.")
    say_all((f"Fault: {fault}" for fault in facts["faults"]), "red")
