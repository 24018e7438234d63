"""How a session computes a calibration, and the poses that it is made from."""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import datetime
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from contactbench.pipeline.calibration.parameters import Number, PoseParameters, Three, check_roles
from contactbench.pipeline.session.errors import SessionError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from contactbench.pipeline.calibration import ContactTask, PoseNoise, PoseSample
    from contactbench.pipeline.calibration.files.capture_file import Captured

FEWEST_POSES = 3

# Of a recording's own clock, which may have run for years.
Moment = Annotated[float, Field(ge=-1e15, le=1e15, allow_inf_nan=False)]


class CapturesParameters(PoseParameters):
    """As the options of ``contactbench calibrate captures``; the delay in seconds."""

    endings = (".csv",)

    delay: Number | Literal["auto"] | None = None
    leave_out: tuple[Moment, ...] = ()  # s, on the recording's clock: captures in which one lies are left out
    partial: bool = False  # More poses will follow in another recording: fewer than three do


def captures(
    inputs: Mapping[str, Path],
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

    given = CapturesParameters.checked(parameters)
    check_roles(inputs, ("recording",), ("calibration", "earlier", "robot_poses"))
    recording = inputs["recording"]
    model = load_calibration(inputs["calibration"]).model if "calibration" in inputs else None
    found = capture_poses(
        recording,
        given.convention(),
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
        why = "".join(f" {each.start:.1f} to {each.stop:.1f} s: {each.reason}" for each in found.rejected[:3])
        left = f", {len(given.leave_out)} left out" if given.leave_out else ""
        needs = (
            f"a calibration needs {FEWEST_POSES}" if fewest == FEWEST_POSES else "there is nothing to keep"
        )
        raise SessionError(
            f"{recording.name}: {len(poses)} still poses{left}, {needs}: hold more of them still for some seconds.{why}"
        )
    return {given.name: encode_poses(poses, given.name)}


def _earlier(file: Path) -> tuple[PoseSample, ...]:
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
        replace(pose, name=f"pose {number} at {pose.name.partition(' at ')[2]}")
        for number, pose in enumerate(kept, before + 1)
    )


class CalibrationParameters(PoseParameters):
    """As the options of ``contactbench calibrate fit``."""

    estimate_mount: bool = False
    noise_force: Number | None = None
    noise_torque: Number | None = None
    orientation_noise: Number | None = None  # 1 sigma about each axis, degrees; None: estimated
    down: Three = (0.0, 0.0, -1.0)  # Where gravity points in W; its length does not matter
    tip: Three = (0.0, 0.0, 100.0)
    contact_force: Number = 10.0

    @property
    def noise(self) -> PoseNoise | None:
        """Of a pose's mean; None: it is estimated from the poses."""
        from contactbench.pipeline.calibration import PoseNoise

        force, torque = self.noise_force, self.noise_torque
        return None if force is None or torque is None else PoseNoise(force, torque)

    @property
    def task(self) -> ContactTask:
        """The touches that the calibration is for."""
        import numpy as np

        from contactbench.pipeline.calibration import ContactTask

        tip = np.array(self.tip) / 1000
        return ContactTask(tip, np.array([0.0, 0.0, -1.0 if tip[2] < 0 else 1.0]), self.contact_force)

    @property
    def assumed(self) -> dict[str, Any]:
        """What `calibrate` and `estimate_mount` are told beside the poses."""
        degrees = self.orientation_noise
        return {
            "noise": self.noise,
            "orientation_sigma": None if degrees is None else math.radians(degrees),
            "down_W": self.down,
            "task": self.task,
        }


def calibration(
    inputs: Mapping[str, Path], parameters: Mapping[str, Any], created: str | None
) -> dict[str, bytes]:
    """Calibrate from ``poses``: the bytes that ``contactbench calibrate fit`` writes at that time."""
    from contactbench.pipeline.calibration import calibrate
    from contactbench.pipeline.calibration.diagnosis.diagnose import RawOrientations
    from contactbench.pipeline.calibration.files.calibration_file import Mount, encode_calibration
    from contactbench.pipeline.calibration.files.capture_file import is_recording
    from contactbench.pipeline.calibration.files.pose_csv import is_recorded_table, read_poses
    from contactbench.pipeline.calibration.mount import estimate_mount

    given = CalibrationParameters.checked(parameters)
    if given.mount is not None and given.estimate_mount:
        raise SessionError("mount and estimate_mount contradict each other: give one.")
    check_roles(inputs, ("poses",))
    poses = inputs["poses"]
    if is_recording(poses) or is_recorded_table(poses):
        raise SessionError(
            f"{poses.name} is a recording, not a table of still poses: add it with --kind recording, and compute"
            " captures from it first."
        )
    if (given.noise_force is None) != (given.noise_torque is None):
        raise SessionError("noise_force, noise_torque: give both or none.")
    R_ES = given.R_ES
    table = read_poses(poses, given.convention(), R_ES=R_ES)
    mount = None if R_ES is None else Mount.of(R_ES.T)
    if given.estimate_mount:
        mounted = estimate_mount(table.poses, **given.assumed)
        found, mount = mounted.calibration, Mount.of(mounted.R_SE, mounted.rotation_covariance)
    else:
        found = calibrate(table.poses, raw=RawOrientations(table.raw, table.convention), **given.assumed)
    time = None if created is None else datetime.fromisoformat(created)
    return {given.name: encode_calibration(found, given.name, source=poses, created=time, mount=mount)}
