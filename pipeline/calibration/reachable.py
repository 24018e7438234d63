"""Orientations to choose calibration poses from: anything by hand, or what a robot reaches."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.model import DOWN_W, upright
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.robot import Clearance, ClearanceCheck

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.robot import Robot

_PLASTIC = 1.324717957244746  # the real root of x³ = x + 1


@dataclass(frozen=True, eq=False)
class Reachable:
    """Orientations that can be taken."""

    R_WS: NDArray[np.float64]  # (k, 3, 3)
    # (k,) what it takes to get there from where the robot is: s for a robot, rad turned by hand
    travel: NDArray[np.float64]
    joints: NDArray[np.float64] | None = None  # (k, 6) the robot's joints that give them, rad
    robot: Robot | None = None
    start: NDArray[np.float64] | None = None  # (6,) where the robot is, rad
    check: ClearanceCheck | None = None  # Says what a move would hit
    down_W: ArrayLike = DOWN_W  # (3,) where gravity points in W

    def __len__(self) -> int:
        return len(self.R_WS)

    def between(self, chosen: Sequence[int]) -> NDArray[np.float64]:
        """Return the travel (n, n) from each of the `chosen` candidates to each other: s or rad."""
        if self.robot is not None and self.joints is not None:
            joints = self.joints[chosen]
            return self.robot.travel(joints[:, None], joints[None])
        R = self.R_WS[chosen]
        traces = np.einsum("iab,jab->ij", R, R)
        angles: NDArray[np.float64] = np.arccos(np.clip((traces - 1) / 2, -1, 1))
        return angles

    def obstacle(self, first: int | None, last: int) -> str | None:
        """Say what is in the way of a straight joint move to candidate `last`, from the start if first is None."""
        if self.check is None or self.joints is None or self.start is None:
            return None
        return self.check.path_conflict(
            self.start if first is None else self.joints[first], self.joints[last]
        )

    def joint_vector(self, index: int) -> NDArray[np.float64] | None:
        """Return the joints (6,) of a candidate, rad, if a robot takes it."""
        return None if self.joints is None else self.joints[index]


def by_hand(
    count: int = 300,
    *,
    max_tilt: float = np.pi,
    R_WS_now: NDArray[np.float64] | None = None,
    down_W: ArrayLike = DOWN_W,
) -> Reachable:
    """Return orientations spread evenly over all that a free sensor can take.

    Parameters
    ----------
    count : int
        How many, at least 12.
    max_tilt : float
        Largest angle between the sensor's z axis and straight down, rad.
    R_WS_now : (3, 3), optional
        Where the sensor is; without it no orientation is nearer than another.
    down_W : (3,)
        Where gravity points in W.

    Raises
    ------
    InputError
        A value is out of its range.
    """
    if count < 12:
        raise InputError(f"{arg(count)} orientations are too few to choose from: give at least 12")
    if not 0 < max_tilt <= np.pi:
        raise InputError(
            f"the largest tilt must be above 0° and at most 180°, not {arg(np.degrees(max_tilt)):.4g}°"
        )
    # Even in area: equal steps of the cosine. Powers of the plastic number keep bearings and yaws apart.
    step = np.arange(count)
    cosine = 1 - (step + 0.5) / count * (1 - np.cos(max_tilt))
    tilt, bearing, yaw = np.arccos(cosine), 2 * np.pi * step / _PLASTIC, 2 * np.pi * step / _PLASTIC**2
    axis = np.column_stack([np.cos(bearing), np.sin(bearing), np.zeros(count)])
    down = Rotation.from_rotvec([np.pi, 0.0, 0.0])
    spin = Rotation.from_rotvec(np.column_stack([np.zeros((count, 2)), yaw]))
    turned = (
        Rotation.from_matrix(upright(down_W).T) * Rotation.from_rotvec(tilt[:, None] * axis) * down * spin
    )
    travel = np.zeros(count)
    if R_WS_now is not None:
        travel = np.asarray((Rotation.from_matrix(R_WS_now).inv() * turned).magnitude())
    return Reachable(turned.as_matrix(), travel, down_W=down_W)


def by_robot(
    robot: Robot,
    q_now: NDArray[np.float64],
    *,
    R_ES: NDArray[np.float64] | None = None,
    R_WB: NDArray[np.float64] | None = None,
    count: int = 300,
    wrist_only: bool = True,
    clearance: Clearance | None = None,
    seed: int = 0,
    down_W: ArrayLike = DOWN_W,
) -> Reachable:
    """Return orientations that a robot reaches within its joint limits, clear of itself and the floor.

    Parameters
    ----------
    robot : Robot
    q_now : (6,)
        Its joints now, rad.
    R_ES : (3, 3), optional
        Orientation of the sensor on the flange; left out: the same.
    R_WB : (3, 3), optional
        Orientation of the base in the world; left out: upright.
    count : int
        How many to look for; fewer may be found.
    wrist_only : bool
        Only the wrist joints move: short moves that keep the tool where it is.
    clearance : Clearance, optional
        Tool and floor to keep clear of.
    seed : int
        Of the choice.
    down_W : (3,)
        Where gravity points in W.

    Raises
    ------
    InputError
        The joints are out of their limits, or nothing is reachable.
    """
    joints = robot.candidate_joints(q_now, count=count, seed=seed, wrist_only=wrist_only, clearance=clearance)
    R_WS = robot.flange_rotations(joints)
    if R_ES is not None:
        R_WS = R_WS @ R_ES
    if R_WB is not None:
        R_WS = R_WB @ R_WS
    check = ClearanceCheck(robot.description, clearance or Clearance())
    start = np.array(q_now, dtype=np.float64)
    return Reachable(R_WS, robot.travel(start, joints), joints, robot, start, check, down_W)


def describe(R_WS: NDArray[np.float64], down_W: ArrayLike = DOWN_W) -> str:
    """Return in words how the sensor stands: where its z axis points, and which side is down.

    Parameters
    ----------
    R_WS : (3, 3)
    down_W : (3,)
        Where gravity points in W.
    """
    R_WS = upright(down_W) @ R_WS
    z_W = R_WS[:, 2]
    tilt = float(np.degrees(np.arccos(np.clip(-z_W[2], -1, 1))))
    down_S = -R_WS[2]
    side = int(np.argmax(np.abs(down_S)))
    name = f"{'-' if down_S[side] < 0 else '+'}{'xyz'[side]}"
    lean = float(np.degrees(np.arccos(np.clip(np.abs(down_S[side]), -1, 1))))
    lowest = message(f"the {arg(name)} axis lowest ({arg(lean):.0f}° from straight down)")
    if tilt < 1:
        return message("sensor z straight down")
    if tilt > 179:
        return message("sensor z straight up")
    bearing = np.degrees(np.arctan2(z_W[1], z_W[0])) % 360
    return message(
        f"sensor z {arg(tilt):.0f}° from straight down, bearing {arg(bearing):.0f}° from the world's x axis;"
        f" {arg(lowest)}"
    )
