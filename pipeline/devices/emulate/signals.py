"""What an emulated device measures, as a function of time, and what faults make of it."""

from __future__ import annotations

import bisect
import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.emulate.script import EmulatorError, Fault, Script

if TYPE_CHECKING:
    from collections.abc import Sequence

Six = tuple[float, float, float, float, float, float]
Signal = Callable[[float], Six]
"""Time in s -> force (N) and torque (N·m) in the sensor frame, or six joint angles (rad)."""

SYNTHETIC: Six = (1.0, -2.0, 3.5, 0.1, -0.2, 0.05)
"""A wrench for tests: N, N·m."""
ROOM = 25.0
_DRIFT_PER_DEGREE: Six = (0.05, -0.03, 0.1, 0.001, -0.002, 0.0005)


@dataclass(frozen=True, slots=True)
class Reading:
    """What the device believes to measure.

    Attributes
    ----------
    values : six floats
        As a `Signal` gives them, with the faults applied.
    temperature : float
        Degrees Celsius.
    saturated : bool
        At the limit.
    """

    values: Six
    temperature: float = ROOM
    saturated: bool = False


@dataclass(frozen=True, slots=True)
class Moment:
    """Where a frame is in its stream.

    Attributes
    ----------
    number : int
        From 0 since the device last came up.
    clock : float
        The device's, s, jumps included.
    jump : float
        How far the clock has leapt so far, s.
    """

    number: int
    clock: float
    jump: float = 0.0


def constant(values: Six) -> Signal:
    """Return a signal that stays."""
    return lambda _: values


def sine(amplitude: Six, frequency: float = 1.0, offset: Six = (0.0,) * 6) -> Signal:
    """Return a signal that swings, each channel a sixth of a period later than the one before; Hz."""

    def at(time: float) -> Six:
        phase = 2 * math.pi * frequency * time
        return _six(
            [
                o + a * math.sin(phase - k * math.pi / 3)
                for k, (o, a) in enumerate(zip(offset, amplitude, strict=True))
            ]
        )

    return at


def recorded(times: Sequence[float], rows: Sequence[Sequence[float]]) -> Signal:
    """Return a recording as a signal: the last row at or before each time, from the start again at its end.

    Parameters
    ----------
    times : (n,) s, increasing
    rows : (n, 6)

    Raises
    ------
    EmulatorError
        There are no rows, or times that do not increase.
    """
    if len(times) != len(rows) or len(times) < 2 or any(b <= a for a, b in itertools.pairwise(times)):
        raise EmulatorError("recording: it needs two or more rows of six numbers, at times that increase.")
    values = [_six(row) for row in rows]
    span = (times[-1] - times[0]) * len(times) / (len(times) - 1)  # the last row lasts as long as the others
    return lambda time: values[bisect.bisect_right(times, times[0] + time % span) - 1]


def _six(row: Sequence[float]) -> Six:
    if len(row) != 6:
        raise EmulatorError(f"signal: {len(row)} numbers: give six.")
    return (row[0], row[1], row[2], row[3], row[4], row[5])


class Truth:
    """A signal with a script's faults of value and clock.

    Parameters
    ----------
    signal : callable
    script : Script
    trap : six floats or None
        A reading that holds the start of a frame.
    full_scale : six floats or None
        The limit of the device.

    Attributes
    ----------
    signal : callable
        May be replaced while it runs.
    """

    def __init__(self, signal: Signal, script: Script, trap: Six | None, full_scale: Six | None) -> None:
        self.signal = signal
        self._script = script
        self._trap = trap
        self._full_scale = full_scale

    def reading(self, time: float) -> Reading:
        """Return what the device believes to measure at `time`, s after it first streamed."""
        for event in self._script.active(time, Fault.STUCK):
            return self.reading(math.nextafter(event.start, -math.inf))
        reading = self._drifted(time)
        zeros = self._script.begun(time, Fault.REZERO)
        if zeros:  # the last one counts: it took away what was there then
            zero = self._drifted(zeros[-1].start).values
            reading = replace(
                reading, values=_six([v - z for v, z in zip(reading.values, zero, strict=True)])
            )
        if self._trap and self._script.active(time, Fault.HEADER):
            reading = replace(reading, values=self._trap)
        if self._full_scale and self._script.active(time, Fault.SATURATION):
            return replace(reading, values=self._full_scale, saturated=True)
        return reading

    def moment(self, time: float, number: int) -> Moment:
        """Return where the frame of that number is, at `time`."""
        jump = sum(event.amount for event in self._script.begun(time, Fault.CLOCK_JUMP))
        return Moment(number, time + jump, jump)

    def rate_factor(self, time: float) -> float:
        """Return what the rate is multiplied by."""
        return math.prod(event.amount for event in self._script.active(time, Fault.WRONG_RATE))

    def _drifted(self, time: float) -> Reading:
        warmer = sum(
            event.amount * min(1.0, (time - event.start) / event.duration)
            for event in self._script.begun(time, Fault.DRIFT)
        )
        values = zip(self.signal(time), _DRIFT_PER_DEGREE, strict=True)
        return Reading(_six([value + warmer * slope for value, slope in values]), ROOM + warmer)
