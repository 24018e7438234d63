"""Flange poses out of ROS 2 messages: from transforms, poses, or joints."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pipeline.robot import Robot

Pose = tuple["NDArray[np.float64]", "NDArray[np.float64]"]

_MOST_FRAMES = 1000
_UNIT = 1e-3  # how far from 1 the norm of a quaternion may be


class Frames:
    """
    The latest transforms between frames, and the pose of one in another.

    Parameters
    ----------
    base, flange : str
        Names of the frames, without a leading slash.
    """

    def __init__(self, base: str, flange: str) -> None:
        self._base, self._flange = base, flange
        self._parents: dict[str, tuple[str, Pose]] = {}

    def update(self, message: Any) -> bool:
        """
        Take in a TFMessage; tell whether anything in it is between base and flange.

        Raises
        ------
        ValueError
            A transform in it is none.
        """
        changed = set()
        for item in message.transforms:
            parent, child = item.header.frame_id.lstrip("/"), item.child_frame_id.lstrip("/")
            if child in self._parents or len(self._parents) < _MOST_FRAMES:
                self._parents[child] = parent, pose(item.transform.translation, item.transform.rotation)
                changed.add(child)
        return any(frame in changed for frame in self._chain())

    def pose(self) -> Pose | None:
        """Return R_BE and p_BE_B; None while the frames are not connected."""
        chain = self._chain()
        if not chain or self._parents[chain[-1]][0] != self._base:
            return None
        R, p = np.eye(3), np.zeros(3)
        for frame in chain:
            R_parent, p_parent = self._parents[frame][1]
            R, p = R_parent @ R, p_parent + R_parent @ p
        return R, p

    def _chain(self) -> list[str]:
        """Return the frames from the flange up to the one below the base, or as far as it goes."""
        chain: list[str] = []
        frame = self._flange
        while frame != self._base and frame in self._parents and len(chain) < _MOST_FRAMES:
            chain.append(frame)
            frame = self._parents[frame][0]
        return chain


def pose(position: Any, orientation: Any) -> Pose:
    """
    Return R and p of a position and a quaternion with fields x, y, z (w).

    Raises
    ------
    ValueError
        The quaternion is none, or the position is not finite.
    """
    p = np.array([position.x, position.y, position.z])
    quaternion = np.array([orientation.x, orientation.y, orientation.z, orientation.w])
    if not np.isfinite(p).all() or not abs(np.linalg.norm(np.clip(quaternion, -2, 2)) - 1) < _UNIT:
        raise ValueError("it is no pose")
    return Rotation.from_quat(quaternion).as_matrix(), p


def joint_pose(message: Any, robot: Robot) -> tuple[Pose, NDArray[np.float64]]:
    """
    Return the flange's pose by the joints of a JointState, and these joints in the robot's order.

    Joints are found by the robot's names for them; failing that, by the numbers at the end of their names.

    Raises
    ------
    ValueError
        They are not those of the robot, or not finite.
    """
    wanted = [joint.name for joint in robot.description.joints]
    angles = dict(zip(message.name, message.position, strict=False))
    if not set(wanted) <= set(angles):
        numbered = {_last_number(name): angle for name, angle in angles.items()}
        numbers = list(range(1, len(wanted) + 1))
        if len(angles) != len(wanted) or sorted(numbered) != numbers:
            raise ValueError(f"its joints are not the {len(wanted)} of the robot")
        angles = {name: numbered[number] for name, number in zip(wanted, numbers, strict=True)}
    q = np.array([angles[name] for name in wanted])
    if not np.isfinite(q).all():
        raise ValueError("a joint angle is not finite")
    return robot.flange_pose(q), q


def _last_number(name: str) -> int:
    found = re.search(r"(\d{1,4})\D*$", name[-64:])
    return int(found[1]) if found else -1
