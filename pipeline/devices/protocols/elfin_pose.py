"""Which half of an Elfin's position is joints, found out from the arm's kinematics; and the flange from it.

Software versions disagree on the order of joints and pose. The joints must lead to the pose by the forward
kinematics, so one reading settles the order, the convention of the angles, and whether the active tool
frame is turned against the flange.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.protocols.elfin import ElfinError
from contactbench.pipeline.devices.sample import FlangeSample
from contactbench.pipeline.errors import arg, join, message

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.robot import Robot

_NUMBERS = 12
_MILLIMETRE = 1e-3
_ABSURD = 1e6  # mm or degrees

# Angles are printed to a thousandth of a degree or so; a wrong order is off by tens of degrees.
ROTATION_TOLERANCE_DEG = 0.5
# No probe or tool reaches further from the flange, m.
LONGEST_TOOL = 0.6


class FieldOrder(Enum):
    """What comes first in the controller's answer; the value is where the joints begin."""

    JOINTS_FIRST = 0
    POSE_FIRST = 6


@dataclass(frozen=True, slots=True)
class OrderFit:
    """How well joints and pose agree under one order."""

    order: FieldOrder
    rotation_deg: float  # angle between the flange by kinematics and the controller's pose, degrees
    tool: tuple[float, float, float]  # origin of the controller's tool frame in the flange frame E, m

    @property
    def good(self) -> bool:
        """Whether the tool frame is parallel to the flange, and no further away than a tool can be."""
        return (
            self.rotation_deg <= ROTATION_TOLERANCE_DEG and float(np.linalg.norm(self.tool)) <= LONGEST_TOOL
        )


def resolve_order(numbers: Sequence[float], robot: Robot) -> OrderFit:
    """
    Find the order of joints and pose.

    Parameters
    ----------
    numbers : 12 floats
        As the controller gives them: degrees, mm.
    robot : Robot
        The arm.

    Raises
    ------
    ElfinError
        Neither order fits, or both do.
    InputError
        The arm's kinematics cannot be computed.
    """
    fits = [fit_order(numbers, order, robot) for order in FieldOrder]
    good = [fit for fit in fits if fit.good]
    if len(good) == 1:
        return good[0]
    if good:
        raise ElfinError("Elfin: joints and pose look the same here. Move the arm and try again.")
    found = join(
        message(" and "),
        (
            message(
                f"{arg(fit.rotation_deg):.1f}° and {arg(np.linalg.norm(fit.tool) * 1e3):.0f} mm"
                f" ({arg(fit.order.name.lower())})"
            )
            for fit in fits
        ),
    )
    raise ElfinError(
        f"Elfin: joints and pose do not match: the tool frame is {arg(found)} from the flange of"
        f" {arg(robot.description.name)}. Choose a tool frame without rotation, and check the robot"
        " model."
    )


def fit_order(numbers: Sequence[float], order: FieldOrder, robot: Robot) -> OrderFit:
    """Compare joints and pose under one order; parameters and errors as `resolve_order`."""
    joints, position, R_BT = _split(numbers, order)
    R_BE, p_BE_B = robot.flange_pose(joints)
    off = Rotation.from_matrix(R_BE.T @ R_BT).magnitude()
    x, y, z = R_BE.T @ (position - p_BE_B)
    return OrderFit(order, float(np.degrees(off)), (float(x), float(y), float(z)))


def flange_sample(numbers: Sequence[float], order: FieldOrder, time: float, robot: Robot) -> FlangeSample:
    """
    Make a sample from the controller's 12 numbers: the flange follows from the joints alone.

    Parameters
    ----------
    numbers : 12 floats
        Degrees, mm.
    order : FieldOrder
        As `resolve_order` found it.
    time : float
        When the robot was there, seconds of the host's monotonic clock.
    robot : Robot
        The arm.

    Raises
    ------
    ElfinError
        There are not 12 finite numbers.
    InputError
        The arm's kinematics cannot be computed.
    """
    joints, _, _ = _split(numbers, order)
    return FlangeSample(time, *robot.flange_pose(joints), joints)


def _split(
    numbers: Sequence[float], order: FieldOrder
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return joints (6,) rad, position (3,) m and orientation (3, 3) of the tool frame T in the base B."""
    values = np.asarray(numbers, dtype=np.float64)
    # NaN fails the comparison too.
    if values.shape != (_NUMBERS,) or not (np.abs(values) < _ABSURD).all():
        raise ElfinError(f"Elfin: {arg(tuple(numbers))!r} are not six angles and a pose: reconnect.")
    joints, pose = values[:6], values[6:]
    if order is FieldOrder.POSE_FIRST:
        joints, pose = pose, joints
    # Lower case: turns about the fixed axes, R = Rz Ry Rx.
    R_BT = Rotation.from_euler("xyz", pose[3:], degrees=True).as_matrix()
    return np.radians(joints), pose[:3] * _MILLIMETRE, R_BT
