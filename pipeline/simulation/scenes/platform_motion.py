"""How a platform moves what lies on it: one sine along or about each axis, as the paper's Eq. 11."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError, arg

_INSTANT_S = 1e-9  # times of a scene are sums of its steps
AXES = ("x", "y", "z", "rx", "ry", "rz")


@dataclass(frozen=True, eq=False)
class PlatformMotion:
    """
    A sine along and about the axes of the platform P, z up; the turns are about the middle of the phantom's top.

    Attributes
    ----------
    amplitude : (6,)
        m along x, y, z, then rad about x, y, z.
    period : float
        s.
    start : float
        Until then it rests, s; then it begins with a jump in speed, as the paper's.
    ease : float
        For so long after the start the amplitude grows to its full size, s; 0: at once.
    """

    amplitude: NDArray[np.float64]
    period: float
    start: float = 0.0
    ease: float = 0.0

    def __post_init__(self) -> None:
        amplitude = np.array(self.amplitude, dtype=np.float64)
        if amplitude.shape != (6,) or not np.isfinite(amplitude).all():
            raise InputError(
                f"platform: amplitude {arg(self.amplitude)}: give six finite numbers, m and rad."
            )
        if not (0 < self.period < 1e6 and 0 <= self.start < 1e6 and 0 <= self.ease < 1e6):
            raise InputError(
                f"platform: period {arg(self.period)} s, start {arg(self.start)} s, ease {arg(self.ease)} s:"
                " the period must be positive, the others 0 or more."
            )
        object.__setattr__(self, "amplitude", amplitude)

    @classmethod
    def along(cls, axis: str, size: float, period: float, start: float = 0.0) -> PlatformMotion:
        """
        Move along or about one axis.

        Parameters
        ----------
        size : float
            m or rad.
        period, start : float
            s.

        Raises
        ------
        InputError
            There is no such axis.
        """
        if axis not in AXES:
            raise InputError(f"platform: axis {arg(axis)!r}: give one of {arg(', '.join(AXES))}.")
        return cls(size * np.eye(6)[AXES.index(axis)], period, start)

    def at(self, time: float) -> NDArray[np.float64]:
        """Return position and angles, (6,), at a time, s."""
        since = max(time - self.start, 0.0)
        share = 1.0 if self.ease == 0 else min(since / self.ease, 1.0)
        return np.asarray(self.amplitude * (share * math.sin(2 * math.pi * since / self.period)))

    def speed(self, time: float) -> NDArray[np.float64]:
        """Return how fast they change, (6,), m/s and rad/s; where that jumps, the mean of both sides."""
        since, turn = time - self.start, 2 * math.pi / self.period
        if since < -_INSTANT_S:
            return np.zeros(6)
        if since >= self.ease - _INSTANT_S:
            share = 1.0 if since > _INSTANT_S or self.ease > 0 else 0.5
            return np.asarray(self.amplitude * (share * turn * math.cos(turn * since)))
        growing = math.sin(turn * since) + turn * since * math.cos(turn * since)
        return np.asarray(self.amplitude * (growing / self.ease))
