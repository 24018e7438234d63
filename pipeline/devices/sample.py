"""What devices give: a wrench or a pose, and when."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntFlag
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Status(IntFlag):
    """What is wrong with a sample; the same flags for every protocol. All but CLOCK come from the device."""

    OK = 0
    OVERRANGE = 1
    """A channel is at its limit."""
    INVALID = 2
    """The device says that the numbers are not measurements."""
    RAW = 4
    """The numbers are not calibrated by the device."""
    LATE = 8
    """The device could not keep its rate."""
    ERROR = 16
    """Any other error that the device reports."""
    CLOCK = 32
    """Its time is a guess: the device's count or clock has just leapt."""


FROZEN_CHANCE = 1e-10
"""A run of equal readings that chance gives so rarely says that a sensor hangs; how often they repeat is learned."""


@dataclass(frozen=True, slots=True)
class WrenchSample:
    """
    One reading of a force/torque sensor, as the device gives it: neither compensated nor filtered.

    Attributes
    ----------
    time : float
        When it was measured, seconds of the host's monotonic clock; a parser, which cannot know, gives the arrival.
    force : (fx, fy, fz)
        Sensor frame S, N.
    torque : (mx, my, mz)
        About the sensor's origin, in S, N·m.
    sequence : int or None
        The device's own count, unwrapped: gaps in it are lost samples. None where the protocol has none.
    status : Status
    device_time : float or None
        The device's own clock, seconds from any start, unwrapped; None where the protocol has none.
    temperature : float or None
        Of the sensor, degrees Celsius; None where the protocol has none.
    arrival : float or None
        When its last byte arrived, on the clock of `time`; None: the same as `time`.
    """

    time: float
    force: tuple[float, float, float]
    torque: tuple[float, float, float]
    sequence: int | None = None
    status: Status = Status.OK
    device_time: float | None = None
    temperature: float | None = None
    arrival: float | None = None

    @property
    def arrived(self) -> float:
        """`arrival`, or `time` where there is none."""
        return self.time if self.arrival is None else self.arrival


@dataclass(frozen=True, eq=False, slots=True)
class FlangeSample:
    """
    Where a robot's flange E is in its base B.

    Attributes
    ----------
    time : float
        As for a wrench.
    R_BE : (3, 3) float64
        Turns components in E into components in B.
    p_BE_B : (3,) float64
        Position of the flange's origin, m; NaN where the source knows orientations only.
    joints : (n,) float64 or None
        Joint angles, rad, where the source knows them.
    device_time : float or None
        The controller's clock, seconds from any start.
    arrival : float or None
        As for a wrench.
    """

    time: float
    R_BE: NDArray[np.float64]
    p_BE_B: NDArray[np.float64]
    joints: NDArray[np.float64] | None = None
    device_time: float | None = None
    arrival: float | None = None

    @property
    def arrived(self) -> float:
        """`arrival`, or `time` where there is none."""
        return self.time if self.arrival is None else self.arrival
