"""The tool's own inertia in a reading: what speeds up feels a force that no contact made."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.control.axes import cross

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration import GravityModel

_PLACES = 3


class Inertia:
    """
    What the acceleration of the centre of mass adds to a reading, from where the arm was at the last steps.

    A quick turn about a tip that is 80 mm away from the centre of mass (0.45 kg) at 10 rad/s² takes 0.36 N: at 7 N
    that looks like a contact 7 mm away, and a controller that turns by it shakes itself. The torque that turns the tool
    itself, 7 mN·m then, is that of a ball: a gravity calibration knows no moments of inertia.

    Parameters
    ----------
    gravity : GravityModel
        Mass and centre of mass.
    gyration : float
        Radius of gyration about the centre of mass, m; 0: that torque is left out.
    """

    def __init__(self, gravity: GravityModel, gyration: float = 0.0) -> None:
        self._mass = float(gravity.mass)
        self._moment = self._mass * gyration**2
        self._centre_S = np.array(gravity.centre_of_mass_S)
        self._places: deque[NDArray[np.float64]] = deque(maxlen=_PLACES)
        self._turns: deque[NDArray[np.float64]] = deque(maxlen=_PLACES)

    def moved(self, R_BS: NDArray[np.float64], p_BS_B: NDArray[np.float64]) -> None:
        """Take where the sensor is now; once a period."""
        self._places.append(p_BS_B + R_BS @ self._centre_S)
        self._turns.append(R_BS)

    def wrench(self, R_BS: NDArray[np.float64], period: float) -> NDArray[np.float64]:
        """
        Return what to add to a reading that is the mean over the last period, (6,) in S.

        A servo that goes smoothly through its set-points has, at each, the mean speed of the period before, so that
        the mean acceleration of a period is the second difference of the places at its end and the two before.
        """
        if len(self._places) < _PLACES:
            return np.zeros(6)
        a, b, c = self._places
        force = self._mass * (R_BS.T @ ((c - 2 * b + a) / period**2))
        first, second = (_turn(*pair) for pair in ((self._turns[0], self._turns[1]), (self._turns[1], R_BS)))
        torque = self._moment * (R_BS.T @ ((second - first) / period**2))
        return np.concatenate([force, cross(self._centre_S, force) + torque])


def _turn(R_a: NDArray[np.float64], R_b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the small turn (3,) from one orientation to the next, rad, in B: R_b = (1 + [w]x) R_a."""
    D = R_b @ R_a.T
    return np.array([D[2, 1] - D[1, 2], D[0, 2] - D[2, 0], D[1, 0] - D[0, 1]]) / 2
