"""What a controller needs to know of what carries the probe."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class Arm(Protocol):
    """
    A chain of n joints from the base B to the flange E; `contactbench.pipeline.robot.Robot` is one.

    Joint values are rad, or m for one that slides; B stands upright and is taken as the world W.
    """

    @property
    def lower(self) -> NDArray[np.float64]:
        """(n,) lower limits."""

    @property
    def upper(self) -> NDArray[np.float64]:
        """(n,) upper limits."""

    @property
    def velocity_limits(self) -> NDArray[np.float64]:
        """(n,) largest speeds, per s."""

    @property
    def acceleration_limits(self) -> NDArray[np.float64]:
        """(n,) largest accelerations, per s²."""

    def flange_pose(self, q: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return R_BE (3, 3) and p_BE_B (3,), m."""

    def flange_jacobian(self, q: ArrayLike) -> NDArray[np.float64]:
        """Return J (6, n): velocity of E's origin, then angular velocity, both in B, per joint speed."""


class CartesianMount:
    """
    Three slides along B's axes, then three hinges about the moved x, y and z axes, as in `PlatformScene`.

    Parameters
    ----------
    R_0 : (3, 3), optional
        Orientation of the flange with all hinges at 0; left out, it points down, its x along B's.
    reach : float
        m to either side of the origin.
    turn : float
        rad to either side; below a quarter turn, where the hinges lock.
    fastest, hardest : (2,) of float
        Largest speed and acceleration of a slide (m/s, m/s²) and of a hinge (rad/s, rad/s²).
    """

    def __init__(
        self,
        R_0: NDArray[np.float64] | None = None,
        *,
        reach: float = 1.0,
        turn: float = 1.2,
        fastest: tuple[float, float] = (0.25, np.pi / 2),
        hardest: tuple[float, float] = (5.0, 30.0),
    ) -> None:
        self._R_0 = np.diag([1.0, -1.0, -1.0]) if R_0 is None else np.array(R_0, dtype=np.float64)
        self._upper = np.repeat([reach, turn], 3)
        self._fastest, self._hardest = np.repeat(fastest, 3), np.repeat(hardest, 3)

    @property
    def lower(self) -> NDArray[np.float64]:
        """(6,) lower limits, m and rad."""
        return -self._upper

    @property
    def upper(self) -> NDArray[np.float64]:
        """(6,) upper limits, m and rad."""
        return self._upper

    @property
    def velocity_limits(self) -> NDArray[np.float64]:
        """(6,) largest speeds, m/s and rad/s."""
        return self._fastest

    @property
    def acceleration_limits(self) -> NDArray[np.float64]:
        """(6,) largest accelerations, m/s² and rad/s²."""
        return self._hardest

    def flange_pose(self, q: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return R_BE (3, 3) and p_BE_B (3,), m."""
        values = np.asarray(q, dtype=np.float64)
        x, y, z = (_turn(axis, angle) for axis, angle in enumerate(values[3:].tolist()))
        return x @ y @ z @ self._R_0, values[:3].copy()

    def flange_jacobian(self, q: ArrayLike) -> NDArray[np.float64]:
        """Return J (6, 6)."""
        values = np.asarray(q, dtype=np.float64)
        x, y = _turn(0, float(values[3])), _turn(1, float(values[4]))
        J = np.zeros((6, 6))
        J[:3, :3] = np.eye(3)
        J[3, 3] = 1.0
        J[3:, 4] = x[:, 1]
        J[3:, 5] = (x @ y)[:, 2]
        return J


def _turn(axis: int, angle: float) -> NDArray[np.float64]:
    c, s = np.cos(angle), np.sin(angle)
    R = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[i, i] = R[j, j] = c
    R[i, j], R[j, i] = -s, s
    return R
