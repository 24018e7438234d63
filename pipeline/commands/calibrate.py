"""``contactbench calibrate ...``: bias, weight and centre of mass."""

from __future__ import annotations

import io
import sys
from csv import writer
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.commands.check import check_app
from contactbench.pipeline.commands.options import (
    RobotPosesOption,
    SensorAtOption,
    SensorBodyOption,
    SerialOption,
    doubt_degrees,
    payload_told,
    refuse_overwriting,
    serials_of,
    written,
)
from contactbench.pipeline.console import (
    Bar,
    Noun,
    answer,
    as_json,
    output_is_data,
    say,
    say_all,
    show_tables,
    warn,
)
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.knobs import knob
from contactbench.pipeline.parameter_options import numbers
from contactbench.pipeline.settings import (
    CalibrationSettings,
    CapturesSettings,
    DelaySettings,
    DownSettings,
    JointsSettings,
    MountSettings,
    NoiseSettings,
    PosesSettings,
    ReportSettings,
    TaskSettings,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray
    from rich.table import Table

    from contactbench.pipeline.calibration import Calibration, GravityModel
    from contactbench.pipeline.calibration.diagnosis.diagnose import Diagnosis
    from contactbench.pipeline.calibration.files.pose_csv import PoseTable
    from contactbench.pipeline.calibration.mount import MountCalibration
    from contactbench.pipeline.calibration.suggest import PosePlan, Reachable


_HOUR = 3600.0  # s
_UNKNOWN_SHARE = 0.1  # of what a parameter could be if no pose said anything of it; as in the report
_WORTH_A_WORD = 0.2  # probability from which a cause is told
_STYLES = {"good": "green", "usable": "yellow", "refuse": "red"}


calibrate_app = Noun("Find a sensor's bias, and the weight and centre of mass of its load, from still poses.")
calibrate_app.add_typer(check_app, name="check")

PosesArgument = Annotated[
    Path,
    typer.Argument(
        metavar="POSES",
        help="CSV file of still, contact-free poses, or a recording of them; see calibrate fit.",
    ),
]
CalibrationArgument = Annotated[
    Path, typer.Argument(metavar="CALIBRATION", help="File written by contactbench calibrate fit.")
]


@calibrate_app.command(
    example=(
        "calibrate fit poses.csv --euler xyz --out calibration.json --report calibration.html",
        "calibrate fit wrenches.csv --robot-poses robot.csv --delay auto --out calibration.json",
    )
)
def fit(
    poses: PosesArgument,
    /,
    out: Path,
    given: CalibrationSettings,
    heard: DelaySettings,
    said_of: ReportSettings,
    report: Path | None = None,
    serial: SerialOption = None,
    robot_poses: RobotPosesOption = None,
    sensor_at: SensorAtOption = None,
    sensor_body: SensorBodyOption = None,
) -> None:
    """Calibrate bias, weight and centre of mass from still, contact-free poses.

    POSES has one row per pose: fx,fy,fz,mx,my,mz, the mean raw reading (N, N·m about the sensor
    origin, sensor frame S), and the orientation of the sensor in the world as qw,qx,qy,qz, or in the
    form set by the options. Optional columns: name, t, count, sfx,sfy,sfz,smx,smy,smz (standard deviations of
    single samples), temperature. At least three poses with different tilts are needed; with eight, bumped ones
    can be named. With t (s), a drift of the sensor during the session is found.

    POSES may be a recording instead, MCAP or CSV with the column t: its still poses are found as by
    contactbench calibrate captures. With --robot-poses, sensor and robot may be in two separate CSV files.

    With --sensor-at, and a mount, the report has the robot's payload in the words of its controller, unless the
    calibration must not be used or leaves it too unsure.

    Exit code 1: the calibration must not be used; the reasons and remedies are printed. The file is written
    anyway, so that calibrate next can suggest a pose.

    Parameters
    ----------
    out
        Calibration file to write, JSON.
    report
        Also write a report for people: .html, or .pdf on A4.
    """
    for file in (out, report):
        refuse_overwriting(file, [each for each in (poses, robot_poses) if each is not None])
    if report is not None and report.suffix.lower() not in (".html", ".pdf"):
        raise typer.BadParameter(f"--report {report}: name a file that ends in .html or .pdf.")
    R_ES, serials = given.R_ES, serials_of(serial)
    if sensor_at is not None and (report is None or (R_ES is None and not given.estimate_mount)):
        raise typer.BadParameter("--sensor-at needs --report, and --mount or --estimate-mount.")
    if sensor_body is not None and sensor_at is None:
        raise typer.BadParameter("--sensor-body needs --sensor-at.")
    from contactbench.pipeline.calibration.assumptions import assumed, fitted
    from contactbench.pipeline.calibration.files.calibration_file import (
        SourceFile,
        creation_time,
        save_calibration,
    )

    assumed(given)  # refuses half a noise before poses are looked for
    table = _poses(poses, given, R_ES, robot_poses, heard)
    calibration, mounted, mount = fitted(table, given)
    created = creation_time()
    source = SourceFile.of(poses)
    doubt_degrees(given.mount)
    payload = None
    if sensor_at is not None and mount is not None:
        payload = payload_told(calibration.model, mount.R_SE.T, sensor_at, sensor_body)
    save_calibration(calibration, out, source=source, created=created, mount=mount)
    if report:
        from contactbench.pipeline.calibration.report.page import unusable, write_report
        from contactbench.pipeline.page.details import ReportDetails

        details = ReportDetails(**said_of.model_dump(), serials=serials)
        if payload is not None and (why := unusable(calibration, payload)):
            say(f"{report}: {why}", "yellow")
        write_report(calibration, report, source=source, created=created, details=details, payload=payload)
    _show(calibration, mounted)
    answer(_facts(calibration, mounted, out, report, table), good=calibration.verdict.level != "refuse")


def _poses(
    file: Path, given: PosesSettings, R_ES: Any, robot_poses: Path | None, heard: DelaySettings
) -> PoseTable:
    """Read poses or find them in a recording, and tell how, with what was left out."""
    convention = written(given)
    from contactbench.pipeline.calibration.files.capture_file import read_any_poses

    with Bar("looking for still poses") as bar:
        table = read_any_poses(
            file, convention, robot_poses=robot_poses, R_ES=R_ES, delay=heard.delay, progress=bar
        )
    say_all(table.notes)
    warn(table.warnings)
    return table


def _facts(
    calibration: Calibration,
    mounted: MountCalibration | None,
    out: Path,
    report: Path | None,
    table: PoseTable,
) -> dict[str, Any]:
    import math

    from contactbench.pipeline.calibration import PARAMETERS

    values = dict(zip(PARAMETERS, calibration.model.vector.tolist(), strict=True))
    condition = calibration.condition
    return {
        "out": str(out),
        "report": None if report is None else str(report),
        "verdict": calibration.verdict.level.value,
        "reasons": list(calibration.verdict.reasons),
        "contact_error_mm": 1e3 * calibration.contact_error,
        "mass_kg": calibration.mass,
        "mass_sigma_kg": calibration.model.mass_sigma,
        "parameters": values,
        "sigmas": calibration.sigmas,
        "poses": len(calibration.poses),
        "rejected": [vars(rejection) for rejection in calibration.rejected],
        "rank": calibration.rank,
        "condition": condition if math.isfinite(condition) else None,
        "null_directions": list(calibration.null_directions),
        "noise_force_N": calibration.noise.sigmas[:3].tolist(),
        "noise_torque_Nm": calibration.noise.sigmas[3:].tolist(),
        "noise_estimated": calibration.noise.estimated,
        "noise_factor": list(calibration.noise_factor),
        "orientation_noise_deg": math.degrees(calibration.noise.orientation),
        "down_W": calibration.down_W.tolist(),
        "causes": [
            {"key": cause.key, "odds": cause.odds, "sentence": cause.sentence} for cause in calibration.causes
        ],
        "offsets": calibration.offsets.tolist(),
        "drift_per_hour": _hourly(calibration.drift_rate),
        "drift_per_hour_sigma": _hourly(calibration.drift_rate_sigma),
        "model_error_mm": 1e3 * calibration.model_error,
        "R_SE": None if mounted is None else mounted.R_SE.tolist(),
        "R_SE_sigma_deg": None if mounted is None else mounted.rotation_sigma_deg,
        "notes": list(table.notes),
        "warnings": list(table.warnings),
    }


def _hourly(rate: NDArray[np.float64] | None) -> list[float] | None:
    """Return a rate (6,) in N and N·m an hour."""
    return None if rate is None else (_HOUR * rate).tolist()


def _show(calibration: Calibration, mounted: MountCalibration | None) -> None:
    level = calibration.verdict.level.value
    show_tables(_table(calibration))
    for rejection in calibration.rejected:
        say(f"{rejection.name} is left out: {rejection.reason}", "yellow")
    if mounted is not None and mounted.mounting:
        say(mounted.mounting)
    say(f"{level.upper()}: {calibration.verdict.reasons[0]}", _STYLES[level])
    say_all(calibration.verdict.reasons[1:])
    known = " ".join(calibration.verdict.reasons)
    for cause in calibration.causes:
        if cause.key != "plain" and cause.odds > _WORTH_A_WORD and cause.sentence not in known:
            say(f"Possible, with a probability of {100 * cause.odds:.0f} %: {cause.sentence}")


def _table(calibration: Calibration) -> Table:
    import numpy as np
    from rich.table import Table

    from contactbench.pipeline.calibration.model import UNKNOWN
    from contactbench.pipeline.calibration.orientation import with_sigma

    table = Table(box=None)
    for heading in ("", "x", "y", "z", "unit"):
        table.add_column(heading, justify="left" if heading in {"", "unit"} else "right")
    values, sigmas = calibration.model.vector, list(calibration.sigmas.values())
    # A drift or a re-zero was taken out: the biases are those of the session's end.
    when = " at the end" if calibration.offsets.any() else ""
    rows = (
        ("gravity (W)", 0, 1.0, "N"),
        (f"force bias{when}", 3, 1.0, "N"),
        ("centre of mass (S)", 6, 1e3, "mm"),
        (f"torque bias{when}", 9, 1e3, "mN·m"),
    )
    mass = _trusted(calibration.mass, calibration.model.mass_sigma, UNKNOWN[0] / 9.80665)
    table.add_row("mass", mass, "", "", "kg")
    for name, first, scale, unit in rows:
        cells = [
            _trusted(scale * values[k], scale * sigmas[k], scale * UNKNOWN[k])
            for k in range(first, first + 3)
        ]
        table.add_row(name, *cells, unit)
    rate, sigma = _hourly(calibration.drift_rate), _hourly(calibration.drift_rate_sigma)
    if rate is not None and sigma is not None:
        for name, first, scale, unit in (("force drift", 0, 1.0, "N/h"), ("torque drift", 3, 1e3, "mN·m/h")):
            cells = [
                " ± ".join(with_sigma(scale * rate[k], scale * sigma[k])) for k in range(first, first + 3)
            ]
            table.add_row(name, *cells, unit)
    table.add_row("orientation noise", f"{np.degrees(calibration.noise.orientation):.2g}", "", "", "°")
    return table


def _trusted(value: float, sigma: float, unknown: float) -> str:
    """Write a value with its uncertainty, or that nobody knows."""
    from contactbench.pipeline.calibration.orientation import with_sigma

    return "unknown" if sigma > _UNKNOWN_SHARE * unknown else " ± ".join(with_sigma(value, sigma))


@calibrate_app.command(
    example=("calibrate diagnose poses.csv --euler xyz --mass 0.62 --noise-force 0.05 --noise-torque 0.002")
)
def diagnose(
    poses: PosesArgument,
    /,
    given: CapturesSettings,
    known: NoiseSettings,
    world: DownSettings,
    robot_poses: RobotPosesOption = None,
    mass: float | None = None,
    tool_length: float = 300.0,
) -> None:
    """Check whether poses follow the conventions set by the options, or which mistake explains them.

    Tries transposed rotations, other Euler orders, degrees and radians, N·mm, kgf, pounds, reversed
    signs, swapped channels, shifted rows, another frame, a turned sensor and a re-zero half way; prints how
    probable each is, and whether none of them explains the poses; changes nothing. The noise, if known, and
    the load's weighed mass make it much more certain.

    Exit code 1: something differs from what the options declare.

    Parameters
    ----------
    mass
        Mass of the complete load on the sensor, kg.
    tool_length
        Distance from the sensor to the tip, mm.
    """
    from contactbench.pipeline.calibration.assumptions import pose_noise
    from contactbench.pipeline.calibration.diagnosis.diagnose import RawOrientations
    from contactbench.pipeline.calibration.diagnosis.diagnose import diagnose as run
    from contactbench.pipeline.calibration.diagnosis.prior import Prior

    noise, sigma = pose_noise(known), known.orientation_sigma
    if sigma is not None:
        if noise is None:
            raise typer.BadParameter(
                "--orientation-noise: give --noise-force and --noise-torque too. Without them the"
                " poses only show the total noise."
            )
        noise = replace(noise, orientation=sigma)
    prior = Prior(down_W=world.down_W, mass=mass, tool_length=tool_length / 1000)
    table = _poses(poses, given, given.R_ES, robot_poses, given)
    raw = RawOrientations(table.raw, table.convention)
    found = run(table.poses, noise, prior=prior, raw=raw)
    _show_diagnosis(found)
    answer(
        {**found.to_json(), "notes": list(table.notes), "warnings": list(table.warnings)},
        good=found.consistent,
    )


def _show_diagnosis(found: Diagnosis) -> None:
    from rich.table import Table

    table = Table(box=None)
    for heading in ("reading", "residual", "mass", "probability"):
        table.add_column(heading, justify="left" if heading == "reading" else "right")
    for finding in found.ranking[:6]:
        share = f"{100 * found.odds[finding.hypothesis]:.1f} %"
        table.add_row(finding.title, f"{finding.residual:.2g} sigma", f"{finding.mass:.2f} kg", share)
    table.add_row("none of these", "", "", f"{100 * found.odds['none']:.1f} %")
    show_tables(table)
    say(found.sentence, "green" if found.consistent else "yellow")
    say_all(found.not_testable)


@check_app.command(example="calibrate check still calibration.json held-out.csv --euler xyz")
def still(
    calibration: CalibrationArgument,
    poses: PosesArgument,
    given: CapturesSettings,
    robot_poses: RobotPosesOption = None,
) -> None:
    """Check a calibration on held-out, still, contact-free poses.

    POSES has the format of calibrate fit. Exit code 1: the residuals are too large for contact sensing, or
    larger than the calibration's uncertainty and the noise explain.
    """
    from contactbench.pipeline.calibration.verify import verify_still

    fitted, R_ES = _calibration(calibration, given)
    table = _poses(poses, given, R_ES, robot_poses, given)
    found = verify_still(fitted, table.poses)
    for sentence in found.verdict.reasons:
        say(sentence, "" if found.passed else "red")
    answer(
        {**found.to_json(), "notes": list(table.notes), "warnings": list(table.warnings)}, good=found.passed
    )


@calibrate_app.command(
    example="calibrate compensate calibration.json recording.csv --euler xyz --out wrenches.csv"
)
def compensate(
    calibration: CalibrationArgument,
    recording: Path,
    /,
    out: Path,
    given: PosesSettings,
    world: DownSettings,
    allow_nan: bool = False,
) -> None:
    """Subtract bias and weight from every reading of a recording.

    CALIBRATION may also be the YAML file of ft_tools_ros2 or force_torque_tools; --down is for that one only.
    RECORDING has the columns t,fx,fy,fz,mx,my,mz (raw readings, N, N·m, sensor frame S) and the
    orientation at the same time, written as for calibrate fit; - is standard input. The output has
    t,fx,fy,fz,mx,my,mz, the force and torque of the tissue on the probe, ready for contactbench locate. It
    is written completely or not at all.

    Parameters
    ----------
    recording
        CSV file, or - for standard input.
    out
        CSV file to write, or - for standard output.
    allow_nan
        Pass NaN, infinity and empty cells through.
    """
    dash = Path("-")
    if out == dash:
        output_is_data()
    if as_json() and out == dash:
        raise typer.BadParameter("--json and --out - both use standard output: give a file name.")
    refuse_overwriting(out, [calibration])
    convention = written(given)
    from contactbench.pipeline.calibration.files.compensate_file import compensate_file

    fitted: Calibration | GravityModel
    foreign = calibration.suffix.lower() in (".yaml", ".yml")
    if foreign:
        from contactbench.pipeline.config.consumers import read_ft_calib

        fitted, R_ES = read_ft_calib(calibration, world.down_W), given.R_ES
    elif world != DownSettings():
        raise typer.BadParameter(f"--down is for a YAML file of ROS: {calibration} has its own.")
    else:
        fitted, R_ES = _calibration(calibration, given)
    with Bar("compensating") as bar:
        summary = compensate_file(
            fitted,
            sys.stdin.buffer if recording == dash else recording,
            sys.stdout.buffer if out == dash else out,
            convention,
            allow_nan=allow_nan,
            R_ES=R_ES,
            progress=bar,
        )
    warn(summary.warnings)
    left = (
        f"The calibration leaves up to {summary.sigma_force_N:.2g} N and"
        f" {1e3 * summary.sigma_torque_Nm:.2g} mN·m (1 sigma) in them."
    )
    if foreign:
        left = f"How uncertain they are is unknown: {calibration} does not say."
    say(f"{summary.rows:,} readings compensated, {summary.rows_per_second:,.0f} per second. {left}")
    answer({"out": str(out), **summary.facts()})


@calibrate_app.command(example="calibrate export calibration.json --out ft_calib.yaml")
def export(calibration: CalibrationArgument, /, out: Path, sensor_frame: str = "ft_sensor") -> None:
    """Write a calibration for ROS: one YAML file that ft_tools_ros2 and force_torque_tools load.

    calibrate compensate reads it, and those that these two write. Exit code 1: the calibration must not be used, and
    nothing is written.

    Parameters
    ----------
    out
        YAML file to write.
    sensor_frame
        Name of the sensor's frame in the robot description.
    """
    refuse_overwriting(out, [calibration])
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration
    from contactbench.pipeline.config.consumers import ft_calib_yaml, ft_tools_yaml

    fitted = load_calibration(calibration)
    good = fitted.verdict.level != "refuse"
    if good:
        text = ft_calib_yaml(fitted.model, com_frame=sensor_frame, down_W=fitted.down_W)
        write_file(out, (text + ft_tools_yaml(fitted.model)).encode("ascii"))
    say_all(fitted.verdict.reasons, "" if good else "red")
    answer({"out": str(out) if good else None, "mass_kg": fitted.mass}, good=good)


def _calibration(file: Path, given: MountSettings) -> tuple[Calibration, Any]:
    """Return a calibration, and R_ES: as the option says, or as it was estimated with the calibration."""
    from contactbench.pipeline.calibration.files.calibration_file import load_record

    record = load_record(file)
    if given.mount is not None:
        return record.calibration, given.R_ES
    return record.calibration, None if record.mount is None else record.mount.R_SE.T


_FEWEST_POSES = 3


class ReachSettings(JointsSettings, MountSettings):
    """Which poses can be taken: what a robot reaches from where it is, or anything by hand."""

    joints: str | None = knob(None, "Current joints of the robot, degrees.", metavar="J1,...,J6")
    all_joints: bool = knob(False, "Move the arm as well as the wrist: longer moves.")
    tool_length: float = knob(200.0, "Distance from the flange to the tip of the tool, mm.")
    floor: float = knob(0.0, "Height above the base's foot that no part may go below, mm.")
    max_tilt: float = knob(180.0, "Without a robot: largest tilt of the sensor from down, degrees.")

    def choice(self, down_W: ArrayLike) -> Reachable:
        """Return the poses to choose from; by hand, tilts are counted from `down_W`.

        Raises
        ------
        typer.BadParameter
            Of --robot and --joints only one was given.
        """
        import numpy as np

        from contactbench.pipeline.calibration.suggest import by_hand, by_robot

        if (self.robot is None) != (self.joints is None):
            raise typer.BadParameter("Give both --robot and --joints: the robot, and its current joints.")
        if self.robot is None or self.joints is None:
            return by_hand(max_tilt=np.radians(self.max_tilt), down_W=down_W)
        from contactbench.pipeline.robot import Clearance, Robot

        arm = Robot.named(self.robot)
        q_now = np.radians(numbers(self.joints, len(arm.lower), "--joints"))
        clearance = Clearance((0.0, 0.0, self.tool_length / 1000), z_min=self.floor / 1000)
        return by_robot(
            arm, q_now, R_ES=self.R_ES, wrist_only=not self.all_joints, clearance=clearance, down_W=down_W
        )


@calibrate_app.command(
    "next", example=("calibrate next calibration.json --robot elfin3 --joints 0,-17,69,0,52,0")
)
def next_pose(calibration: CalibrationArgument, reach: ReachSettings) -> None:
    """Suggest the pose that would improve a calibration most, and predict by how much.

    Poses are judged by the error at the contact, not by the parameters. With --robot and --joints, only poses
    within the joint limits and clear of the robot and the floor are suggested; of nearly equal ones, the nearest.
    """
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration
    from contactbench.pipeline.calibration.suggest import suggest_pose
    from contactbench.pipeline.recording.convert import quaternions

    fitted = load_calibration(calibration)
    suggestion = suggest_pose(fitted, reach.choice(fitted.down_W))
    say(suggestion.sentence)
    answer(
        {
            "sentence": suggestion.sentence,
            "quaternion_WS": quaternions(suggestion.R_WS[None])[0].tolist(),
            "joints_deg": _degrees(suggestion.joints),
            "contact_error_before_mm": 1e3 * suggestion.error_before,
            "contact_error_after_mm": 1e3 * suggestion.error_after,
        }
    )


@calibrate_app.command(
    "plan", example=("calibrate plan 6 --robot elfin3 --joints 0,-17,69,0,52,0 --out plan.csv")
)
def plan_poses(
    count: int,
    /,
    out: Path,
    reach: ReachSettings,
    touched: TaskSettings,
    world: DownSettings,
    mass: float = 0.5,
    noise_force: float = 0.05,
    noise_torque: float = 0.002,
) -> None:
    """Plan COUNT poses that together leave the least error at the contact.

    Writes a CSV file with the orientation of the sensor, the joints in degrees if there is a robot, and
    the predicted share of the calibration in the contact error after each pose.

    Parameters
    ----------
    count
        Number of poses, at least 3.
    out
        CSV file to write.
    mass
        Approximate mass of the load on the sensor, kg.
    noise_force
        Standard deviation of a pose's mean force, N.
    noise_torque
        The same for its torque, N·m.
    """
    import numpy as np

    from contactbench.pipeline.calibration import PoseNoise
    from contactbench.pipeline.calibration.assumptions import contact_task
    from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
    from contactbench.pipeline.calibration.suggest import USUAL_LOAD
    from contactbench.pipeline.calibration.suggest import plan_poses as plan

    if not 0 < mass < 1000:
        raise InputError(
            f"--mass: {mass} kg is not the mass of a tool; give the approximate mass of the load on"
            " the sensor"
        )
    down_W = world.down_W
    choice = reach.choice(down_W)
    load = replace(USUAL_LOAD, gravity_W=mass * STANDARD_GRAVITY * np.array(down_W))
    task = replace(contact_task(touched), down_W=np.array(down_W))
    noise = PoseNoise(noise_force, noise_torque)
    with Bar("planning", counted=True) as bar:
        planned = plan(count, choice, load=load, noise=noise, task=task, progress=bar)
    turns = _write(out, planned)
    warn(planned.warnings)
    say(
        f"{count} poses: the calibration will add about {1e3 * planned.error:.2g} mm (1 sigma) to a contact point."
    )
    answer(
        {
            "out": str(out),
            "quaternions_WS": turns,
            "joints_deg": _degrees(planned.joints),
            "contact_error_mm": (1e3 * planned.errors).tolist(),
            "warnings": list(planned.warnings),
        }
    )


@calibrate_app.command(
    example=(
        "calibrate captures recording.mcap --delay auto --out poses.csv",
        "calibrate captures wrenches.csv --robot-poses robot.csv --delay auto --out poses.csv",
    )
)
def captures(
    recording: Path,
    /,
    out: Path,
    given: CapturesSettings,
    calibration: Path | None = None,
    robot_poses: RobotPosesOption = None,
) -> None:
    """Find the still poses in a recording, and write them for calibrate fit.

    RECORDING is written by contactbench record start from a sensor and a robot, or is a table with the columns
    t,fx,fy,fz,mx,my,mz (s, raw readings, N, N·m, sensor frame S) and the orientation at the same time,
    written as for calibrate fit; - is a table on standard input. With --robot-poses the orientation is in a
    second table, with its own times on the same clock. Poses are then interpolated to the wrenches,
    never across more than 0.25 s. Captures that were bumped or did not settle are left out, with the
    reason. A preliminary calibration also shows steady touches.

    fit, diagnose and check still accept all of these too and find the poses themselves.

    Exit code 1: fewer than three poses were found.

    Parameters
    ----------
    recording
        MCAP or CSV file, or - for standard input.
    out
        CSV file of poses to write.
    calibration
        Preliminary calibration, to detect steady touches.
    """
    refuse_overwriting(out, [file for file in (recording, calibration, robot_poses) if file is not None])
    convention = written(given)
    from contactbench.pipeline.calibration.files.calibration_file import load_calibration
    from contactbench.pipeline.calibration.files.capture_file import capture_poses
    from contactbench.pipeline.calibration.files.pose_csv import write_poses

    model = None if calibration is None else load_calibration(calibration).model
    with Bar("looking for still poses") as bar:
        found = capture_poses(
            sys.stdin.buffer if recording == Path("-") else recording,
            convention,
            R_ES=given.R_ES,
            robot_poses=robot_poses,
            model=model,
            delay=given.delay,
            progress=bar,
        )
    warn(found.warnings)
    enough = len(found.poses) >= _FEWEST_POSES
    if enough:
        write_poses(out, found.poses)
    say_all(found.left_out, "yellow")
    say(f"{len(found.poses)} still poses in {found.rows:,} readings.", "" if enough else "red")
    answer(
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
        },
        good=enough,
    )


@calibrate_app.command(example="calibrate columns recording.csv")
def columns(table: Path, /) -> None:
    """Show how a table would be read: its header, its separators, and what each column means.

    Tables of Excel, MATLAB, LabVIEW, TwinCAT, Motive, PlotJuggler and the ATI DAQ program are known, with units in the
    header, decimal commas and lines above the header. Times that are not in s are told with the unit that they look
    like.

    Exit code 1: no rows of numbers are found, or t is not in s.

    Parameters
    ----------
    table
        CSV file, or another table of text.
    """
    from contactbench.pipeline.calibration.files.pose_csv import check_unit
    from contactbench.pipeline.tables import TableReader, Wording
    from contactbench.pipeline.tables.files import open_table
    from contactbench.pipeline.tables.layouts import LabTable

    with open_table(table, lab=True) as (stream, name, _):
        layout = stream.layout if isinstance(stream, LabTable) else None
        if layout is None:
            raise InputError(
                f"{table}: no rows of numbers below a header: choose a table of readings or poses."
            )
        separator = {"\t": "tabs", ";": "semicolons"}.get(layout.separator, "commas")
        mark = "comma" if layout.decimal == "," else "point"
        say(
            f"{layout.encoding}, cells separated by {separator}, decimal {mark}; names in line {layout.header}, rows"
            f" from line {layout.first}."
        )
        for given, column in zip(layout.names, layout.columns, strict=True):
            scale = layout.scales.get(column)
            say(
                f"{given or '(no name)'}: {column or 'not used'}{'' if scale is None else f', times {scale:.7g}'}"
            )
        fault = None
        if "t" in layout.columns:
            reader = TableReader(stream, name, Wording("t"))
            try:
                reader.select(("t", *layout.unknown), allow_nan=("t",), leave_out=())
                check_unit(reader, next(iter(reader)).numbers[:, 0])
            except InputError as error:
                fault = str(error)
                say(fault, "yellow")
    answer({**vars(layout), "fault": fault}, good=not fault)


def _write(out: Path, planned: PosePlan) -> list[list[float]]:
    """Write planned poses; return their quaternions, scalar first."""
    from contactbench.pipeline.recording.convert import quaternions

    turns: list[list[float]] = quaternions(planned.R_WS).tolist()
    text = io.StringIO()
    rows = writer(text, lineterminator="\n")
    names = (
        [f"j{number}" for number in range(1, planned.joints.shape[1] + 1)]
        if planned.joints is not None
        else []
    )
    rows.writerow(["name", "qw", "qx", "qy", "qz", *names, "contact_error_mm"])
    joints: Any = _degrees(planned.joints) or [[]] * len(planned.R_WS)
    for number, (quaternion, angles, error) in enumerate(
        zip(turns, joints, planned.errors.tolist(), strict=True), 1
    ):
        rows.writerow([f"pose {number}", *map(repr, quaternion), *map(repr, angles), repr(1e3 * error)])
    write_file(out, text.getvalue().encode())
    return turns


def _degrees(joints: NDArray[np.float64] | None) -> Any:
    import numpy as np

    return None if joints is None else np.degrees(joints).tolist()
