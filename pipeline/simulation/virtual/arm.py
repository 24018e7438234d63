"""Joint angles with which an arm's flange stands as the bench's wrist does: the last three joints do it alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import Robot

if TYPE_CHECKING:
    from numpy.typing import NDArray

# The forearm level to the front, to both sides, and rising: what one cannot reach, behind its own wrist or at the end
# of a joint, another can.
_ARMS = (
    (0.0, 0.0, np.pi / 2),
    (np.pi / 2, 0.0, np.pi / 2),
    (-np.pi / 2, 0.0, np.pi / 2),
    (0.4, -0.3, 0.6),
)


class WristArm:
    """
    An Elfin3 whose first three joints stay as long as its wrist reaches what is asked for.

    Its last three axes meet in a point and are z, y, z of a turn, so the angles follow without a search.

    Raises
    ------
    InputError
        MuJoCo is missing.
    """

    def __init__(self) -> None:
        self._robot = Robot.named("elfin3")
        straight = np.array([[*arm, 0.0, 0.0, 0.0] for arm in _ARMS])
        self._forearms = self._robot.flange_rotations(straight)
        self._arm = 0
        self._joints = straight[0]

    def joints(self, R_BE: NDArray[np.float64]) -> NDArray[np.float64]:
        """
        Return the six joint angles, rad, near the ones before.

        Raises
        ------
        InputError
            No posture reaches the orientation.
        """
        for arm in [self._arm, *range(len(_ARMS))]:
            found = [q for q in self._wrists(arm, R_BE) if self._robot.within_limits(q)]
            if found:
                self._arm = arm
                self._joints = min(found, key=lambda q: float(np.abs(q - self._joints).sum()))
                return np.array(self._joints)
        raise InputError("the arm's wrist does not reach that orientation: turn the bench another way.")

    def _wrists(self, arm: int, R_BE: NDArray[np.float64]) -> list[NDArray[np.float64]]:
        """Return both ways to stand so."""
        R = self._forearms[arm].T @ R_BE
        # In line with the forearm any first angle will do: the present one, so that nothing leaps.
        in_line = np.hypot(R[0, 2], R[1, 2]) < 1e-9
        first = self._joints[3] if in_line else np.arctan2(R[1, 2], R[0, 2])
        ways = []
        for q4 in (first, first - np.copysign(np.pi, first)):
            c, s = np.cos(q4), np.sin(q4)
            rest = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ R
            q5, q6 = np.arctan2(rest[0, 2], rest[2, 2]), np.arctan2(rest[1, 0], rest[1, 1])
            ways.append(np.array([*_ARMS[arm], q4, q5, q6]))
        return ways
