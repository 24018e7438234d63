"""Options that several commands share, and what they mean."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from contactbench.pipeline.console import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration import ContactTask, PoseNoise
    from contactbench.pipeline.calibration.orientation import Convention
    from contactbench.pipeline.calibration.reachable import Reachable

EulerOption = Annotated[
    str | None,
    typer.Option(
        "--euler",
        metavar="ORDER",
        help="Orientation is rx,ry,rz: angles about these axes, in the order of the columns; xyz: fixed axes,"
        " ZYX: axes that turn along.",
    ),
]
VectorOption = Annotated[
    bool, typer.Option("--rotation-vector", help="Orientation is rx,ry,rz: axis times angle.")
]
RadiansOption = Annotated[bool, typer.Option("--radians", help="Angles are in rad, not degrees.")]
InverseOption = Annotated[
    bool, typer.Option("--inverse", help="Orientations turn world into sensor components (R_SW).")
]
RobotOption = Annotated[
    str | None,
    typer.Option(
        "--robot", metavar="NAME", help="Orientation is that of a robot's flange, by joints j1..j6: elfin3."
    ),
]
MountOption = Annotated[
    str | None,
    typer.Option(
        "--mount",
        metavar="RX,RY,RZ",
        help="Orientations are those of the flange, and the sensor is turned on it by these angles about the"
        " fixed axes x, then y, then z of the flange, degrees.",
    ),
]
NoiseForceOption = Annotated[
    float | None,
    typer.Option(
        "--noise-force", help="Standard deviation of a pose's mean force, N [estimated from the poses]."
    ),
]
NoiseTorqueOption = Annotated[
    float | None,
    typer.Option("--noise-torque", help="The same of its torque, N·m; both or none."),
]
OrientationNoiseOption = Annotated[
    str | None,
    typer.Option(
        "--orientation-noise",
        metavar="DEGREES|robot|tracker|hand",
        help="How well the orientations are known, 1 sigma about each axis: degrees, or what gives them (robot 0.05,"
        " tracker 0.2, hand 0.5) [estimated from the poses].",
    ),
]
DownOption = Annotated[
    str,
    typer.Option(
        "--down",
        metavar="X,Y,Z",
        help="Where gravity points in the world frame of the orientations, of any length; 0,0,1 for a robot that hangs"
        " from the ceiling and gives its poses in its base's frame.",
    ),
]
RobotPosesOption = Annotated[
    Path | None,
    typer.Option(
        "--robot-poses",
        metavar="FILE",
        help="The robot's own recording, CSV: t (s, on the sensor's clock) and the orientation. The first table then"
        " needs t,fx,fy,fz,mx,my,mz only.",
    ),
]
DelayOption = Annotated[
    str | None,
    typer.Option(
        metavar="SECONDS|auto",
        help="How much later a wrench is heard than its pose in a recording of both; auto: as the motion in it shows. A"
        " doubtful estimate is told and not applied [0].",
    ),
]
TipOption = Annotated[
    str | None,
    typer.Option(
        "--tip", metavar="X,Y,Z", help="Where the probe will be touched, mm in the sensor frame [0,0,100]."
    ),
]
ForceOption = Annotated[float, typer.Option("--contact-force", help="Force of those touches, N.")]
TiltOption = Annotated[
    float, typer.Option("--max-tilt", help="Without a robot: largest tilt of the sensor from down, degrees.")
]
JointsOption = Annotated[
    str | None, typer.Option("--joints", metavar="J1,...,J6", help="Where the robot is now, degrees.")
]
AllJointsOption = Annotated[
    bool, typer.Option("--all-joints", help="Move the arm too, not only the wrist: longer moves.")
]
ToolOption = Annotated[
    float, typer.Option("--tool-length", help="From the flange to the tip of what it carries, mm.")
]
FloorOption = Annotated[
    float, typer.Option("--floor", help="Height above the base's foot that nothing may go below, mm.")
]


def numbers(text: str, count: int, option: str) -> list[float]:
    """Return `count` finite numbers from an option's comma separated text.

    Raises
    ------
    typer.BadParameter
        There are others.
    """
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not all(math.isfinite(value) for value in values):
        raise typer.BadParameter(f"{option} needs {count} finite numbers separated by commas, not {text!r}.")
    return values


def convention(
    euler: str | None, vector: bool, robot: str | None, *, radians: bool, inverse: bool
) -> Convention | None:
    """Return how orientations are written; None: as quaternions, if that is what there is.

    Raises
    ------
    typer.BadParameter
        The options contradict one another.
    """
    from contactbench.pipeline.calibration.orientation import Convention, Kind

    chosen = [
        name
        for name, given in (("--euler", euler), ("--rotation-vector", vector), ("--robot", robot))
        if given
    ]
    if len(chosen) > 1:
        raise typer.BadParameter(f"{' and '.join(chosen)} contradict each other: give one.")
    if radians and not chosen:
        raise typer.BadParameter(
            "--radians is about angles: it goes with --euler, --rotation-vector or --robot."
        )
    if euler:
        axes = euler.lower()
        if axes != "xyz" and set(axes) == set("xyz") and len(axes) == 3:
            first, second, third = tuple(axes)
            say(
                f"warning: --euler {euler}: column rx is read as the angle about {first}, ry about {second}, rz"
                f" about {third}. If the columns are named after the axes, rename them: rx is the first angle.",
                "yellow",
            )
        return Convention(Kind.EULER, order=euler, degrees=not radians, inverse=inverse)
    if vector:
        return Convention(Kind.ROTATION_VECTOR, degrees=not radians, inverse=inverse)
    if robot:
        from contactbench.pipeline.robot import Robot

        Robot.named(robot)  # an unknown name is said before the file is read
        return Convention(Kind.JOINTS, degrees=not radians, robot=robot, inverse=inverse)
    return Convention(inverse=True) if inverse else None


def mount_rotation(text: str | None) -> NDArray[np.float64] | None:
    """Return R_ES (3, 3) of ``--mount``, if it was given."""
    if text is None:
        return None
    from scipy.spatial.transform import Rotation

    return Rotation.from_euler("xyz", numbers(text, 3, "--mount"), degrees=True).as_matrix()


def orientation_sigma(text: str | None) -> float | None:
    """Return ``--orientation-noise`` in rad; None: nobody said it.

    Raises
    ------
    typer.BadParameter
        It is no angle, and nothing that is known to give orientations.
    """
    if text is None:
        return None
    from contactbench.pipeline.calibration.orientation import ORIENTATION_NOISE_DEG

    if text in ORIENTATION_NOISE_DEG:
        return math.radians(ORIENTATION_NOISE_DEG[text])
    try:
        degrees = float(text)
    except ValueError:
        degrees = math.nan
    if not 0 <= degrees < 180:
        raise typer.BadParameter(
            f"--orientation-noise {text}: give degrees, at least 0, or one of {', '.join(ORIENTATION_NOISE_DEG)}."
        )
    return math.radians(degrees)


def down_direction(text: str) -> tuple[float, float, float]:
    """Return ``--down`` as a unit vector in W.

    Raises
    ------
    typer.BadParameter
        It has no direction.
    """
    x, y, z = numbers(text, 3, "--down")
    length = math.hypot(x, y, z)
    if not 0 < length < math.inf:
        raise typer.BadParameter(
            f"--down {text} has no direction: give where gravity points, such as 0,0,-1."
        )
    return x / length, y / length, z / length


def delay_seconds(text: str | None) -> float | Literal["auto"] | None:
    """Return ``--delay``, s.

    Raises
    ------
    typer.BadParameter
        It is neither a number nor ``auto``.
    """
    if text is None or text == "auto":
        return "auto" if text else None
    try:
        return float(text)
    except ValueError:
        raise typer.BadParameter(f"--delay {text}: give seconds, or auto.") from None


def pose_noise(force: float | None, torque: float | None) -> PoseNoise | None:
    """Return the noise that was given, or None.

    Raises
    ------
    typer.BadParameter
        Only one of the two was given.
    """
    if force is None and torque is None:
        return None
    if force is None or torque is None:
        raise typer.BadParameter("--noise-force and --noise-torque: give both or none.")
    from contactbench.pipeline.calibration import PoseNoise

    return PoseNoise(force, torque)


def contact_task(tip: str | None, force: float) -> ContactTask:
    """Return the touches that ``--tip`` and ``--contact-force`` describe; their normal is that of the tip.

    The probe is taken to be touched at its end: the normal points from the sensor along z, to the side on
    which the tip lies.
    """
    import numpy as np

    from contactbench.pipeline.calibration import ContactTask

    point = np.array([0.0, 0.0, 100.0] if tip is None else numbers(tip, 3, "--tip")) / 1000
    normal = np.array([0.0, 0.0, -1.0 if point[2] < 0 else 1.0])
    return ContactTask(point, normal, force)


def reachable(
    robot: str | None,
    joints: str | None,
    mount: str | None,
    *,
    max_tilt: float,
    all_joints: bool,
    tool_length: float,
    floor: float,
    down_W: ArrayLike = (0.0, 0.0, -1.0),
) -> Reachable:
    """Return the poses to choose from: what the robot reaches from where it is, or anything by hand.

    By hand, tilts are counted from `down_W`.

    Raises
    ------
    typer.BadParameter
        Of --robot and --joints only one was given.
    """
    import numpy as np

    from contactbench.pipeline.calibration.reachable import by_hand, by_robot

    if (robot is None) != (joints is None):
        raise typer.BadParameter("--robot and --joints go together: which robot, and where it is now.")
    if robot is None or joints is None:
        return by_hand(max_tilt=np.radians(max_tilt), down_W=down_W)
    from contactbench.pipeline.robot import Clearance, Robot

    arm = Robot.named(robot)
    q_now = np.radians(numbers(joints, len(arm.lower), "--joints"))
    clearance = Clearance((0.0, 0.0, tool_length / 1000), z_min=floor / 1000)
    return by_robot(
        arm, q_now, R_ES=mount_rotation(mount), wrist_only=not all_joints, clearance=clearance, down_W=down_W
    )


def refuse_overwriting(out: Path | None, inputs: Sequence[Path]) -> None:
    """Refuse an output that is one of the inputs.

    Raises
    ------
    typer.BadParameter
        It is.
    """
    for given in inputs:
        if out is not None and out.exists() and given.exists() and out.samefile(given):
            raise typer.BadParameter(f"{out} is an input too: choose another name for what is written.")
