"""Whether the force swings: its half-waves, and how much slower the force loop should be."""

from __future__ import annotations

import math

_SLOW_S = 0.3  # time constant of the mean that a swing is around
_HALF_WAVE_S = (0.015, 0.26)  # of a loop that swings; tissue that moves is slower
_SEEN = 0.05  # of the wanted force: a half-wave of less is no swing
_GROWN = 0.35  # of the wanted force: a half-wave of more is one that a lower gain did not stop
_LOWERED = 0.65  # by each half-wave from the second on
_LEAST = 0.1  # of the gain
_HALVES = 4  # such half-waves one after the other, after which it should stand still
_ALONE_S = 0.45  # after which the next half-wave is the first of another swing
_QUIET_S, _BACK_S = 0.8, 2.0  # how long it must be quiet, and time constant of the way back


class Swing:
    """
    Watches the force error for half-waves one after the other, and lowers the gain before they grow.

    An unstable admittance loop shows itself by an alternating force; its detection and the gain that follows it are
    those of Dimeas and Aspragathos (2016), Online stability in human-robot cooperation with admittance control, IEEE
    Trans. Haptics 9(2), with amplitudes between zero crossings in place of a spectrum: they are known after half a
    period.

    Parameters
    ----------
    wanted : float
        Force, N: what is much is a share of it.

    Attributes
    ----------
    share : float
        Of the force loop's gain that is left, 0.1 to 1.
    beyond : bool
        Whether the swing is beyond what a lower gain stops.
    amplitude : float
        Of the newest half-wave, N.
    """

    def __init__(self, wanted: float) -> None:
        self._wanted = wanted
        self.share = 1.0
        self.reset()

    def reset(self) -> None:
        """Begin a new watch; the share that is left stays."""
        self.beyond, self.amplitude = False, 0.0
        self._mean: float | None = None
        self._sign, self._most, self._length = 0.0, 0.0, 0.0
        self._halves = self._large = 0
        self._quiet = 0.0  # s since a half-wave of a swing ended

    @property
    def seen(self) -> bool:
        """Whether it swings: two half-waves one after the other."""
        return self._halves > 1

    def take(self, error: float, dt: float) -> None:
        """Take the force error of a period of dt, N and s."""
        if self._mean is None:
            self._mean = error
        self._mean += (1 - math.exp(-dt / _SLOW_S)) * (error - self._mean)
        off = error - self._mean
        self._length += dt
        self._quiet += dt
        if off * self._sign < 0 or self._sign == 0:
            self._half()
            self._sign, self._most, self._length = math.copysign(1.0, off), 0.0, 0.0
        self._most = max(self._most, abs(off))
        if self._quiet > _ALONE_S:
            self._halves = self._large = 0
        if self._quiet > _QUIET_S:
            self.share += (1 - math.exp(-dt / _BACK_S)) * (1 - self.share)

    def explained(self, factor: float) -> None:
        """Take off what a stiffness that is so many times larger than was believed explains: the gain stays."""
        self.share = min(max(factor, 1.0) * self.share, 1.0)

    def _half(self) -> None:
        """Judge the half-wave that is over."""
        low, high = _HALF_WAVE_S
        if not (low <= self._length <= high and self._most > _SEEN * self._wanted):
            return
        self.amplitude, self._quiet = self._most, 0.0
        self._halves += 1
        self._large = self._large + 1 if self._most > _GROWN * self._wanted else 0
        if self._halves > 1:
            self.share = max(_LEAST, _LOWERED * self.share)
        self.beyond = self._large >= _HALVES
