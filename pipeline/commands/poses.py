"""``contactbench next-pose, plan-poses, captures``: where to hold the sensor, and where it was held."""

from __future__ import annotations

import io
import sys
from csv import writer
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.gravity import CalibrationArgument
from contactbench.pipeline.commands.options import (
    AllJointsOption,
    DelayOption,
    DownOption,
    EulerOption,
    FloorOption,
    ForceOption,
    InverseOption,
    JointsOption,
    MountOption,
    RadiansOption,
    RobotOption,
    RobotPosesOption,
    TiltOption,
    TipOption,
    ToolOption,
    VectorOption,
    contact_task,
    convention,
    delay_seconds,
    down_direction,
    mount_rotation,
    reachable,
    refuse_overwriting,
)
from contactbench.pipeline.console import Bar, JsonOption, print_json, say
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.suggest import Plan

_FEWEST_POSES = 3

poses_app = typer.Typer(rich_markup_mode=None)


@poses_app.command(
    "next-pose",
    help=(
        "Say which pose would improve a calibration most, and by how much, before it is taken.\n\n"
        "Judged by the error at the contact, not by the parameters. With --robot and --joints only poses"
        " within its joint limits, clear of itself and the floor; nearer ones of those that are nearly as good."
    ),
    epilog="Example: contactbench next-pose calibration.json --robot elfin3 --joints 0,-17,69,0,52,0",
)
def next_pose(
    calibration: CalibrationArgument,
    robot: RobotOption = None,
    joints: JointsOption = None,
    mount: MountOption = None,
    all_joints: AllJointsOption = False,
    tool_length: ToolOption = 200.0,
    floor: FloorOption = 0.0,
    max_tilt: TiltOption = 180.0,
    as_json: JsonOption = False,
) -> None:
    """Say which pose would improve a calibration most."""
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration
    from contactbench.pipeline.calibration.suggest import suggest_pose

    fitted = load_calibration(calibration)
    choice = reachable(
        robot,
        joints,
        mount,
        max_tilt=max_tilt,
        all_joints=all_joints,
        tool_length=tool_length,
        floor=floor,
        down_W=fitted.down_W,
    )
    suggestion = suggest_pose(fitted, choice)
    say(suggestion.sentence)
    if as_json:
        print_json(
            {
                "sentence": suggestion.sentence,
                "quaternion_WS": _quaternions(suggestion.R_WS[None])[0].tolist(),
                "joints_deg": _degrees(suggestion.joints),
                "contact_error_before_mm": 1e3 * suggestion.error_before,
                "contact_error_after_mm": 1e3 * suggestion.error_after,
            }
        )


@poses_app.command(
    "plan-poses",
    help=(
        "Plan COUNT poses that together leave the least error at the contact.\n\n"
        "Writes a CSV file with the orientation of the sensor, the joints in degrees if there is a robot, and"
        " the predicted share of the calibration in the contact error after each pose."
    ),
    epilog="Example: contactbench plan-poses 6 --robot elfin3 --joints 0,-17,69,0,52,0 --out plan.csv",
)
def plan_poses(
    count: Annotated[int, typer.Argument(metavar="COUNT", help="How many, at least 3.")],
    out: Annotated[Path, typer.Option(help="CSV file to write.")],
    robot: RobotOption = None,
    joints: JointsOption = None,
    mount: MountOption = None,
    all_joints: AllJointsOption = False,
    tool_length: ToolOption = 200.0,
    floor: FloorOption = 0.0,
    max_tilt: TiltOption = 180.0,
    tip: TipOption = None,
    contact_force: ForceOption = 10.0,
    mass: Annotated[float, typer.Option(help="About what hangs on the sensor, kg.")] = 0.5,
    noise_force: Annotated[float, typer.Option(help="Standard deviation of a pose's mean force, N.")] = 0.05,
    noise_torque: Annotated[float, typer.Option(help="The same of its torque, N·m.")] = 0.002,
    down: DownOption = "0,0,-1",
    as_json: JsonOption = False,
) -> None:
    """Plan poses that together leave the least error at the contact."""
    import numpy as np

    from contactbench.pipeline.calibration import PoseNoise
    from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
    from contactbench.pipeline.calibration.suggest import USUAL_LOAD
    from contactbench.pipeline.calibration.suggest import plan_poses as plan

    if not 0 < mass < 1000:
        raise InputError(f"--mass: {mass} kg is no mass of a tool; give what hangs on the sensor, about")
    down_W = down_direction(down)
    choice = reachable(
        robot,
        joints,
        mount,
        max_tilt=max_tilt,
        all_joints=all_joints,
        tool_length=tool_length,
        floor=floor,
        down_W=down_W,
    )
    load = replace(USUAL_LOAD, gravity_W=mass * STANDARD_GRAVITY * np.array(down_W))
    task = replace(contact_task(tip, contact_force), down_W=np.array(down_W))
    noise = PoseNoise(noise_force, noise_torque)
    with Bar("planning", counted=True) as bar:
        planned = plan(count, choice, load=load, noise=noise, task=task, progress=bar)
    _write(out, planned)
    for sentence in planned.warnings:
        say(f"warning: {sentence}", "yellow")
    say(
        f"{count} poses: the calibration will add about {1e3 * planned.error:.2g} mm (1 sigma) to a contact point."
    )
    if as_json:
        print_json(
            {
                "out": str(out),
                "quaternions_WS": _quaternions(planned.R_WS).tolist(),
                "joints_deg": _degrees(planned.joints),
                "contact_error_mm": (1e3 * planned.errors).tolist(),
                "warnings": list(planned.warnings),
            }
        )


@poses_app.command(
    help=(
        "Find in a recording where the sensor stood still, and write the poses for calibrate.\n\n"
        "RECORDING is what contactbench record wrote of a sensor and a robot, or a table with the columns"
        " t,fx,fy,fz,mx,my,mz (s, raw readings, N, N·m, sensor frame S) and the orientation at the same time, written"
        " as for calibrate; - is a table on standard input. With --robot-poses the orientation is in a second table,"
        " with times of its own on the same clock. Poses are then interpolated to the wrenches, never across more"
        " than 0.25 s. Captures that were bumped or did not settle are left out, with the reason. A preliminary"
        " calibration also shows steady touches.\n\n"
        "calibrate, diagnose and verify-still take all of these as well, and do this by themselves.\n\n"
        "Exit code 1: fewer than three poses were found."
    ),
    epilog=(
        "Example: contactbench captures recording.mcap --delay auto --out poses.csv\n\n"
        "Example: contactbench captures wrenches.csv --robot-poses robot.csv --delay auto --out poses.csv"
    ),
)
def captures(
    recording: Annotated[
        Path, typer.Argument(metavar="RECORDING", help="MCAP or CSV file, or - for standard input.")
    ],
    out: Annotated[Path, typer.Option(help="CSV file of poses to write.")],
    calibration: Annotated[
        Path | None, typer.Option(help="Preliminary calibration, to see steady touches.")
    ] = None,
    euler: EulerOption = None,
    rotation_vector: VectorOption = False,
    radians: RadiansOption = False,
    inverse: InverseOption = False,
    robot: RobotOption = None,
    mount: MountOption = None,
    robot_poses: RobotPosesOption = None,
    delay: DelayOption = None,
    as_json: JsonOption = False,
) -> None:
    """Find in a recording where the sensor stood still."""
    refuse_overwriting(out, [file for file in (recording, calibration, robot_poses) if file is not None])
    written_as = convention(euler, rotation_vector, robot, radians=radians, inverse=inverse)
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration
    from contactbench.pipeline.calibration.files.capture_file import capture_any
    from contactbench.pipeline.calibration.files.pose_csv import write_poses

    model = None if calibration is None else load_calibration(calibration).model
    with Bar("looking for still poses") as bar:
        found = capture_any(
            sys.stdin.buffer if recording == Path("-") else recording,
            written_as,
            R_ES=mount_rotation(mount),
            robot_poses=robot_poses,
            model=model,
            delay=delay_seconds(delay),
            progress=bar,
        )
    for sentence in found.warnings:
        say(f"warning: {sentence}", "yellow")
    enough = len(found.poses) >= _FEWEST_POSES
    if enough:
        write_poses(out, found.poses)
    for sentence in found.left_out:
        say(sentence, "yellow")
    say(f"{len(found.poses)} still poses in {found.rows:,} readings.", "" if enough else "red")
    if as_json:
        print_json(
            {
                "out": str(out) if enough else None,
                "delay_s": found.delay,
                "warnings": list(found.warnings),
                "poses": [
                    {"name": pose.name, "start": capture.start, "stop": capture.stop, "count": capture.count}
                    for pose, capture in zip(found.poses, found.captures, strict=True)
                ],
                "rejected": [
                    {"start": refused.start, "stop": refused.stop, "reason": refused.reason}
                    for refused in found.rejected
                ],
            }
        )
    if not enough:
        raise typer.Exit(1)


def _write(out: Path, planned: Plan) -> None:
    from contactbench.pipeline.durable import write_durably

    text = io.StringIO()
    rows = writer(text, lineterminator="\n")
    names = [f"j{number}" for number in range(1, 7)] if planned.joints is not None else []
    rows.writerow(["name", "qw", "qx", "qy", "qz", *names, "contact_error_mm"])
    joints: Any = _degrees(planned.joints) or [[]] * len(planned.R_WS)
    for number, (quaternion, angles, error) in enumerate(
        zip(_quaternions(planned.R_WS).tolist(), joints, planned.errors.tolist(), strict=True), 1
    ):
        rows.writerow([f"pose {number}", *map(repr, quaternion), *map(repr, angles), repr(1e3 * error)])
    try:
        write_durably(out, text.getvalue().encode())
    except (OSError, ValueError) as error:
        raise InputError(f"{out}: the plan cannot be written ({error}): choose another --out") from error


def _quaternions(R_WS: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return unit quaternions (n, 4), scalar first and not negative."""
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(R_WS).as_quat(canonical=True)[:, [3, 0, 1, 2]]


def _degrees(joints: NDArray[np.float64] | None) -> Any:
    import numpy as np

    return None if joints is None else np.degrees(joints).tolist()
