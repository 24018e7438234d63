"""Where something that moves smoothly will be: position, speed and acceleration from noisy positions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


class Follower:
    """
    A critically damped filter of third order: an error of the speed or the acceleration dies out, without swinging.

    The three poles lie at exp(-bandwidth dt), as in a fading-memory filter; a value that moves with a steady
    acceleration is followed without lag.

    Parameters
    ----------
    bandwidth : array_like (k,)
        1/s, for each component.
    """

    def __init__(self, bandwidth: ArrayLike) -> None:
        self._bandwidth = np.array(bandwidth, dtype=np.float64)
        self._share = 1.0
        self._x: NDArray[np.float64] | None = None
        self._v = self._a = np.zeros_like(self._bandwidth)

    @property
    def running(self) -> bool:
        """Whether there was a value yet."""
        return self._x is not None

    def reset(self) -> None:
        """Forget everything."""
        self._x = None
        self._v = self._a = np.zeros_like(self._bandwidth)

    def update(self, value: NDArray[np.float64] | None, dt: float) -> None:
        """Go on by dt (s) and take a value (k,); None: there is none, and the speed fades out."""
        if self._x is None:
            self._x = None if value is None else value.copy()
            return
        x = self._x + self._v * dt + 0.5 * self._a * dt * dt
        v = self._v + self._a * dt
        if value is None:
            fade = np.exp(-self._share * self._bandwidth * dt)
            self._x, self._v, self._a = x, v * fade, self._a * fade * fade
            return
        r = np.exp(-self._share * self._bandwidth * dt)
        error = value - x
        self._x = x + (1 - r**3) * error
        self._v = v + 1.5 * (1 - r) ** 2 * (1 + r) / dt * error
        self._a = self._a + (1 - r) ** 3 / dt**2 * error

    def shift(self, by: NDArray[np.float64], share: float) -> None:
        """Take the value for one that is off by (k,), at the same speed; go on with a share of the bandwidth."""
        self._share = share
        if self._x is not None:
            self._x = self._x + by

    def speed(self, lead: float = 0.0) -> NDArray[np.float64]:
        """Return the speed (k,) in `lead` s from the newest value."""
        return np.asarray(self._v + self._a * lead)

    def value(self, lead: float = 0.0) -> NDArray[np.float64] | None:
        """Return the value (k,) then; None before there was one."""
        return None if self._x is None else self._x + self._v * lead + 0.5 * self._a * lead * lead
