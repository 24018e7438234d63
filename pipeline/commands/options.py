"""Options that several commands share, and what they mean."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from contactbench.pipeline.console import Bar, say
from contactbench.pipeline.parameter_options import numbers

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.calibration import GravityModel
    from contactbench.pipeline.calibration.orientation import Convention
    from contactbench.pipeline.calibration.payload import Payload
    from contactbench.pipeline.mesh.monitor import Monitor
    from contactbench.pipeline.settings import OrientationSettings

CalibrationOption = Annotated[Path, typer.Option(help="File written by contactbench calibrate fit.")]
ProbeOption = Annotated[Path, typer.Option(help="The probe, aligned with the sensor.")]
RobotPosesOption = Annotated[
    Path | None,
    typer.Option(
        "--robot-poses",
        metavar="FILE",
        help="Separate CSV recording of the robot: t (s, on the sensor's clock) and the orientation."
        " The first table then needs only t,fx,fy,fz,mx,my,mz.",
    ),
]

SerialOption = Annotated[
    list[str] | None,
    typer.Option(
        "--serial", metavar="DEVICE=NUMBER", help="A serial number, for the report; may be repeated."
    ),
]

_SENSOR_AT = typer.Option(
    "--sensor-at",
    metavar="X,Y,Z",
    help="The sensor's origin in the flange's frame, mm: for the robot's payload.",
)
SensorAtArgument = Annotated[str, _SENSOR_AT]
SensorAtOption = Annotated[str | None, _SENSOR_AT]

SensorBodyOption = Annotated[
    str | None,
    typer.Option(
        "--sensor-body",
        metavar="KG,X,Y,Z",
        help="Mass of the sensor with its adapters, kg, and its centre of mass in the flange's frame, mm: the"
        " sensor does not feel it [nothing].",
    ),
]

_ALMOST = 0.01  # of a quarter turn, as 1.57 is

PatchOption = Annotated[
    str | None,
    typer.Option(
        "--patch",
        metavar="flat|RX,RY",
        help="The touched object is soft, so the point is a centre of pressure; also report the middle"
        " of the patch, its tilt and how the force is shared. flat, or the radii of the tissue"
        " along S's x and y, mm, 0 for flat.",
    ),
]


def doubt_degrees(angles: Sequence[float] | None) -> None:
    """Ask on stderr whether angles of --mount are radians: quarter turns, as far as they are not 0."""
    quarter = math.pi / 2
    turned = [abs(each) / quarter for each in angles or () if each]
    if turned and all(1 <= round(each) <= 4 and abs(each / round(each) - 1) <= _ALMOST for each in turned):
        say("Is --mount in radians? Degrees are expected: 90 for a quarter turn.", "yellow")


def doubt_metres(place: Sequence[float] | None) -> None:
    """Ask on stderr whether a --place is in metres: nobody mounts a probe less than a millimetre from its sensor."""
    if place is not None and 0 < max(map(abs, place[:3])) < 1:
        say("Is --place in metres? Millimetres are expected: 150 for 15 cm.", "yellow")


def payload_told(model: GravityModel, R_ES: Any, sensor_at: str, sensor_body: str | None) -> Payload:
    """
    Return what hangs on the flange, by these options; InputError or typer.BadParameter.

    Parameters
    ----------
    model : GravityModel
    R_ES : (3, 3)
        Orientation of the sensor on the flange.
    sensor_at, sensor_body : str
        As they were given; without a body the caller is told that there is none in it.
    """
    from contactbench.pipeline.calibration.payload import payload_in_mm

    at = numbers(sensor_at, 3, "--sensor-at")
    body = (0.0, 0.0, 0.0, 0.0) if sensor_body is None else numbers(sensor_body, 4, "--sensor-body")
    made = payload_in_mm(model, R_ES, at, body)
    if sensor_body is None:
        say(
            "The sensor's own body and its adapters are not in it: give --sensor-body, unless the robot counts them as"
            " part of its arm.",
            "yellow",
        )
    return made


def serials_of(pairs: Sequence[str] | None) -> dict[str, str]:
    """Return serial numbers by device; typer.BadParameter if one is not written as DEVICE=NUMBER."""
    split = [pair.partition("=") for pair in pairs or ()]
    if not all(device and number for device, _, number in split):
        raise typer.BadParameter('--serial needs DEVICE=NUMBER, such as "M8128=SN 7".')
    return {device: number for device, _, number in split}


def written(given: OrientationSettings) -> Convention | None:
    """Return how orientations are written; None: as quaternions, if that is what there is.

    Raises
    ------
    InputError
        The options contradict one another.
    """
    robot = getattr(given, "robot", None)
    if given.radians and not (given.euler or given.rotation_vector or robot):
        raise typer.BadParameter("--radians needs angles: use it with --euler, --rotation-vector or --robot.")
    from contactbench.pipeline.calibration.orientation import convention_of

    found = convention_of(given)
    axes = (given.euler or "").lower()
    if axes != "xyz" and set(axes) == set("xyz") and len(axes) == 3:
        first, second, third = tuple(axes)
        say(
            f"warning: --euler {given.euler}: column rx is read as the angle about {first}, ry about {second}, rz"
            f" about {third}. If the columns are named after the axes, rename them: rx is the first angle.",
            "yellow",
        )
    return found


def refuse_overwriting(out: Path | None, inputs: Sequence[Path]) -> None:
    """Refuse an output that is one of the inputs.

    Raises
    ------
    typer.BadParameter
        It is.
    """
    for given in inputs:
        if out is not None and out.exists() and given.exists() and out.samefile(given):
            raise typer.BadParameter(f"{out} is also an input: choose another name for the output.")


def shown(bar: Bar) -> Monitor:
    """Let a bar show the share that is done."""
    from contactbench.pipeline.mesh.monitor import Monitor

    return Monitor(lambda share: bar(round(1000 * share), 1000))
