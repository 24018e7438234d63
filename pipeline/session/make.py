"""How a session computes poses, a calibration from them, and a probe."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from contactbench.pipeline.calibration.parameters import Parameters, check_roles
from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.mesh.monitor import NOBODY, Monitor
from contactbench.pipeline.session.journal import SessionError
from contactbench.pipeline.settings import CalibrationSettings, CapturesSettings, ProbeSettings

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from contactbench.pipeline.calibration import PoseSample
    from contactbench.pipeline.calibration.files.capture_file import Captured
    from contactbench.pipeline.files import File

FEWEST_POSES = 3

# Of a recording's own clock, which may have run for years.
Moment = Annotated[float, Field(ge=-1e15, le=1e15, allow_inf_nan=False)]


class CapturesParameters(CapturesSettings, Parameters):
    """As the options of ``contactbench calibrate captures``."""

    endings = (".csv",)

    leave_out: tuple[Moment, ...] = ()  # s, on the recording's clock: captures in which one lies are left out
    partial: bool = False  # More poses will follow in another recording: fewer than three do


def captures(
    inputs: Mapping[str, File],
    parameters: Mapping[str, Any],
    _created: str | None,
    *,
    tell: Callable[[str], None] | None = None,
) -> dict[str, bytes]:
    """
    Find the still poses of ``recording``: the bytes that ``contactbench calibrate captures`` writes.

    Where the robot was recorded into a table of its own, that is ``robot_poses``. Those of ``earlier``, a table of the
    same run before it was interrupted, come first. `tell` gets what was noticed and left out, sentence by sentence.
    """
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration
    from contactbench.pipeline.calibration.files.capture_file import capture_poses
    from contactbench.pipeline.calibration.files.pose_csv import encode_poses
    from contactbench.pipeline.calibration.orientation import convention_of

    given = CapturesParameters.checked(parameters)
    check_roles(inputs, ("recording",), ("calibration", "earlier", "robot_poses"))
    recording = inputs["recording"]
    model = load_calibration(inputs["calibration"]).model if "calibration" in inputs else None
    found = capture_poses(
        recording,
        convention_of(given),
        robot_poses=inputs.get("robot_poses"),
        R_ES=given.R_ES,
        model=model,
        delay=given.delay,
    )
    if tell is not None:
        for sentence in (*found.warnings, *found.left_out):
            tell(sentence)
    before = _earlier(inputs["earlier"]) if "earlier" in inputs else ()
    poses = (*before, *_chosen(found, given.leave_out, len(before)))
    fewest = 1 if given.partial else FEWEST_POSES
    if len(poses) < fewest:
        why = join(
            "",
            (
                message(f" {arg(each.start):.1f} to {arg(each.stop):.1f} s: {arg(each.reason)}")
                for each in found.rejected[:3]
            ),
        )
        left = message(f", {arg(len(given.leave_out))} left out") if given.leave_out else ""
        needs = (
            message(f"a calibration needs {arg(FEWEST_POSES)}")
            if fewest == FEWEST_POSES
            else message("there is nothing to keep")
        )
        raise SessionError(
            f"{arg(recording.name)}: {arg(len(poses))} still poses{arg(left)}, {arg(needs)}: hold more poses still for"
            f" a few seconds.{arg(why)}"
        )
    return {given.name: encode_poses(poses, given.name)}


def _earlier(file: File) -> tuple[PoseSample, ...]:
    from contactbench.pipeline.calibration.files.pose_csv import read_poses

    # Their times are on another recording's clock.
    return tuple(replace(pose, time=None) for pose in read_poses(file).poses)


def _chosen(found: Captured, leave_out: tuple[float, ...], before: int) -> tuple[PoseSample, ...]:
    """Return the poses in which none of those moments lies, numbered from the ones before on."""
    spans = [(capture.start, capture.stop) for capture in found.captures]
    kept = [
        pose
        for pose, (start, stop) in zip(found.poses, spans, strict=True)
        if not any(start <= moment <= stop for moment in leave_out)
    ]
    if not leave_out and not before:
        return tuple(kept)
    return tuple(
        replace(pose, name=message(f"pose {arg(number)} at {arg(pose.name.partition(' at ')[2])}"))
        for number, pose in enumerate(kept, before + 1)
    )


class CalibrationParameters(CalibrationSettings, Parameters):
    """As the options of ``contactbench calibrate fit``."""


def calibration(
    inputs: Mapping[str, File], parameters: Mapping[str, Any], created: str | None
) -> dict[str, bytes]:
    """Calibrate from ``poses``: the bytes that ``contactbench calibrate fit`` writes at that time."""
    from contactbench.pipeline.calibration.assumptions import fitted
    from contactbench.pipeline.calibration.files.calibration_file import encode_calibration
    from contactbench.pipeline.calibration.files.capture_file import is_recording
    from contactbench.pipeline.calibration.files.pose_csv import is_recorded_table, read_poses
    from contactbench.pipeline.calibration.orientation import convention_of

    given = CalibrationParameters.checked(parameters)
    check_roles(inputs, ("poses",))
    poses = inputs["poses"]
    if is_recording(poses) or is_recorded_table(poses):
        raise SessionError(
            f"{arg(poses.name)} is a recording, not a table of still poses: add it with --kind recording, and compute"
            " captures from it first."
        )
    found, _, mount = fitted(read_poses(poses, convention_of(given), R_ES=given.R_ES), given)
    time = None if created is None else datetime.fromisoformat(created)
    return {given.name: encode_calibration(found, given.name, source=poses, created=time, mount=mount)}


class ProbeParameters(ProbeSettings, Parameters):
    """As the options of ``contactbench probe prepare``."""

    endings = (".ply",)


def probe(
    inputs: Mapping[str, File],
    parameters: Mapping[str, Any],
    _created: str | None,
    *,
    monitor: Monitor = NOBODY,
    remember: bool = False,
) -> dict[str, bytes]:
    """
    Prepare a probe from ``mesh``: the bytes that ``contactbench probe prepare`` writes.

    ``alignment`` and ``regions`` may be left out. See `contactbench.pipeline.preparation.prepare.prepared`.
    """
    from contactbench.pipeline.mesh.sidecar import encode_probe_file
    from contactbench.pipeline.preparation.prepare import prepared

    check_roles(inputs, ("mesh",), ("alignment", "regions"))
    given = ProbeParameters.checked(parameters)
    done = prepared(inputs, given, monitor=monitor, remember=remember)
    return encode_probe_file(done.content, given.name)
