"""What a sensor still reads in the air, after gravity: taken off before the first touch."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_MOST_N, _MOST_NM = 0.35, 0.03  # a calibration leaves less; more may be a touch, which must not be taken off


class Tare:
    """
    The mean of compensated readings while nothing touches.

    What a calibration leaves, 0.05 N and 2 mN·m, moves the contact at 7 N by 1.3 mm on a probe of 140 mm: eleven
    degrees of tilt on a narrow face. One second in the air leaves a twentieth of it.

    Parameters
    ----------
    seconds : float
        How long it takes; 0: nothing is taken off.

    Attributes
    ----------
    wrench : (6,)
        What to take off, S, N and N·m; 0 until it is done.
    over : bool
        Whether it is done, or was given up.
    """

    def __init__(self, seconds: float) -> None:
        self._left = seconds
        self._sum = np.zeros(6)
        self._count = 0
        self.wrench = np.zeros(6)
        self.over = seconds <= 0
        self.done = False

    def take(self, wrench: NDArray[np.float64], count: int, dt: float) -> None:
        """Take the mean wrench (6,) of `count` samples of a period of dt (s)."""
        if self.over:
            return
        self._sum += count * wrench
        self._count += count
        self._left -= dt
        if self._left > 1e-9:
            return
        self.over = True
        mean = self._sum / self._count
        self.done = bool((np.abs(mean[:3]) < _MOST_N).all() and (np.abs(mean[3:]) < _MOST_NM).all())
        if self.done:
            self.wrench = mean
