"""Flange poses from the numbers of a line: a position with an orientation, or the joints of a robot."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.protocols.line_layout import POSITION, QUATERNION, TURN, Layout
from contactbench.pipeline.devices.sample import FlangeSample, Status
from contactbench.pipeline.errors import InputError, arg, message

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.devices.protocols.line import Made, Numbers

    Turned = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | None]

_FARTHEST_M = 1e3
_UNIT = 0.02  # a quaternion written with two digits is this far from unit length
_TURN = 2 * math.pi + 0.01  # no controller tells more than a turn, but it rounds
_BEYOND = 0.02  # an arm that stands at a limit tells a bit more than that, rad


def pose_maker(layout: Layout) -> Made[FlangeSample]:
    """
    Return what makes a pose from a line's numbers.

    Raises
    ------
    InputError
        There is no such robot, or MuJoCo is not installed.
    """
    turned = _by_joints(layout) if layout.joints else _by_rotation(layout)

    def made(numbers: Numbers, time: float, status: Status, device_time: float | None) -> FlangeSample | str:
        pose = turned(numbers)
        if isinstance(pose, str):
            return pose
        if status is not Status.OK:
            return ""
        R_BE, p_BE_B, joints = pose
        return FlangeSample(time, R_BE, p_BE_B, joints, device_time)

    return made


def _unit_doubt(layout: Layout) -> str:
    return (
        message("check the option angle of the address")
        if layout.angle_declared
        else message("if they are degrees, set the option angle of the address to deg")
    )


def _by_rotation(layout: Layout) -> Callable[[Numbers], Turned | str]:
    import numpy as np
    from scipy.spatial.transform import Rotation  # a third of a second to import

    positioned = layout.roles.issuperset(POSITION)
    too_far = message(f"their angles are more than one turn in radians: {arg(_unit_doubt(layout))}")

    def turned(numbers: Numbers) -> Turned | str:
        position = np.array([numbers[role] if positioned else math.nan for role in POSITION])
        if (np.abs(position) > _FARTHEST_M).any():
            return ""
        if layout.rotation is None:
            w, x, y, z = (numbers[role] for role in QUATERNION)
            if not abs(math.sqrt(w * w + x * x + y * y + z * z) - 1) <= _UNIT:
                return ""
            rotation = Rotation.from_quat([x, y, z, w])
        else:
            turn = [numbers[role] for role in TURN]
            largest = math.hypot(*turn) if layout.rotation == "vector" else max(map(abs, turn))
            if largest > _TURN:
                return too_far
            # Lower case: about the fixed axes, one after the other.
            rotation = (
                Rotation.from_rotvec(turn)
                if layout.rotation == "vector"
                else Rotation.from_euler("xyz", turn)
            )
        return rotation.as_matrix(), position, None

    return turned


def _by_joints(layout: Layout) -> Callable[[Numbers], Turned | str]:
    import numpy as np

    from contactbench.pipeline.robot import Robot

    robot = Robot.named(layout.robot or "")
    if len(layout.joints) != len(robot.lower):
        raise InputError(
            f"robot {arg(robot.description.name)}: it has {arg(len(robot.lower))} joints, and the lines have"
            f" {arg(len(layout.joints))}: declare q1 to q{arg(len(robot.lower))}."
        )
    robot.flange_pose(np.zeros(len(robot.lower)))  # says at once where MuJoCo is missing

    beyond = message(
        f"their joints are beyond the limits of {arg(robot.description.name)}: {arg(_unit_doubt(layout))}"
    )

    def turned(numbers: Numbers) -> Turned | str:
        joints = np.array([numbers[role] for role in layout.joints])
        if (joints < robot.lower - _BEYOND).any() or (joints > robot.upper + _BEYOND).any():
            return beyond
        try:
            return *robot.flange_pose(joints), joints
        except InputError:
            return ""

    return turned
