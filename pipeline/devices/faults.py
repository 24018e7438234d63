"""What an emulated device measures as a function of time, and what goes wrong with it and its line, by a script."""

from __future__ import annotations

import bisect
import itertools
import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from random import Random
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError, arg

if TYPE_CHECKING:
    from contactbench.pipeline.devices.protocols.device_model import Model


class EmulatorError(InputError):
    """An emulator that cannot be made as asked."""


class Fault(StrEnum):
    """What goes wrong. A fault lasts for its duration, unless it says otherwise."""

    SPLIT = "split"
    """Each frame comes in pieces."""
    MERGED = "merged"
    """Three frames come at once."""
    GARBAGE = "garbage"
    """Random bytes between the frames."""
    BAD_CHECKSUM = "bad-checksum"
    """Each frame is damaged; where there is no checksum, in its length, number or answer."""
    HEADER = "header"
    """The readings are such that the start of a frame occurs inside them."""
    STALL = "stall"
    """Nothing is sent, while the device goes on counting."""
    DISCONNECT = "disconnect"
    """The line breaks in the middle of a frame; the device is back, freshly started, at the end."""
    RECONNECT = "reconnect"
    """The same between two frames."""
    WRONG_RATE = "wrong-rate"
    """The rate is multiplied by the size (0.5)."""
    CLOCK_JUMP = "clock-jump"
    """The device's clock or number of frames leaps by the size (1 s), for good."""
    SATURATION = "saturation"
    """The readings are at the limit of the device."""
    STUCK = "stuck"
    """The readings stay as they are."""
    DRIFT = "drift"
    """The sensor warms up by the size (10 degrees), and its zero moves with it, for good."""
    REZERO = "rezero"
    """The reading at the start becomes the zero, for good."""


_DEFAULT_SIZE = {Fault.WRONG_RATE: 0.5, Fault.CLOCK_JUMP: 1.0, Fault.DRIFT: 10.0}
_FORM = re.compile(
    r"(?P<fault>[a-z-]+)@(?P<start>[0-9.]+)(?:\+(?P<duration>[0-9.]+))?(?:x(?P<size>-?[0-9.]+))?"
)


@dataclass(frozen=True)
class FaultEvent:
    """One fault."""

    start: float  # seconds after the device first streams
    fault: Fault
    duration: float = 1.0  # seconds, positive
    size: float | None = None  # what `Fault` says of it; of no meaning elsewhere

    def __post_init__(self) -> None:
        if not (0 <= self.start < math.inf and 0 < self.duration < math.inf):
            raise EmulatorError(
                f"fault {arg(self.fault)}: start {arg(self.start)} s, duration {arg(self.duration)} s: give"
                " a start of 0 or more and a positive duration."
            )
        if self.size is None:
            object.__setattr__(self, "size", _DEFAULT_SIZE.get(self.fault, 1.0))
        if not math.isfinite(self.amount) or (self.fault is Fault.WRONG_RATE and self.amount <= 0):
            raise EmulatorError(
                f"fault {arg(self.fault)}: size {arg(self.size)}: give a finite number, positive for a rate."
            )

    @classmethod
    def parse(cls, text: str) -> FaultEvent:
        """Read ``fault@start+duration`` with an optional ``xsize``: ``stall@2+0.5``, ``wrong-rate@1+2x0.5``.

        Raises
        ------
        EmulatorError
        """
        found = _FORM.fullmatch(text)
        names = ", ".join(fault.value for fault in Fault)
        if not found or found["fault"] not in list(Fault):
            raise EmulatorError(
                f"fault {arg(text)!r}: write it as NAME@START+DURATION in s, such as stall@2+0.5. Names: {arg(names)}."
            )
        try:
            start, duration = float(found["start"]), float(found["duration"] or 1)
            size = float(found["size"]) if found["size"] else None
        except ValueError as error:
            raise EmulatorError(
                f"fault {arg(text)!r}: {arg(error)}. Write the numbers as in stall@2+0.5."
            ) from error
        return cls(start, Fault(found["fault"]), duration, size)

    @property
    def stop(self) -> float:
        """When it ends, s."""
        return self.start + self.duration

    @property
    def amount(self) -> float:
        """The size, default included."""
        return 1.0 if self.size is None else self.size

    def active(self, time: float) -> bool:
        """Tell whether `time` is within it."""
        return self.start <= time < self.stop


class Script:
    """Faults in the order of their start.

    Parameters
    ----------
    events : iterable
        `FaultEvent` or ``(start, fault, duration)`` or ``(start, fault, duration, size)``, times in s.

    Examples
    --------
    >>> Script([(2.0, Fault.STALL, 0.5)]).active(2.1)[0].stop
    2.5
    """

    def __init__(
        self,
        events: Iterable[FaultEvent | tuple[float, Fault, float] | tuple[float, Fault, float, float]] = (),
    ) -> None:
        made = [event if isinstance(event, FaultEvent) else FaultEvent(*event) for event in events]
        self.events = tuple(sorted(made, key=lambda event: event.start))

    def active(self, time: float, *faults: Fault) -> list[FaultEvent]:
        """Return the events that go on at `time`, of these faults or of all."""
        return [
            event for event in self.events if event.active(time) and (not faults or event.fault in faults)
        ]

    def begun(self, time: float, fault: Fault) -> list[FaultEvent]:
        """Return the events of one fault that have started by `time`, also those that are over."""
        return [event for event in self.events if event.fault is fault and event.start <= time]

    def check(self, possible: frozenset[Fault], device: str) -> None:
        """Refuse faults that a device cannot have.

        Raises
        ------
        EmulatorError
        """
        for event in self.events:
            if event.fault not in possible:
                names = ", ".join(sorted(possible))
                raise EmulatorError(
                    f"fault {arg(event.fault)}: not available for {arg(device)}. Choose from {arg(names)}."
                )


# ---- what is measured, and what faults make of it ------------------------------------------------

Six = tuple[float, float, float, float, float, float]
Signal = Callable[[float], Six]
"""Time in s -> force (N) and torque (N·m) in the sensor frame, or six joint angles (rad)."""

SYNTHETIC: Six = (1.0, -2.0, 3.5, 0.1, -0.2, 0.05)
"""A wrench for tests: N, N·m."""
ROOM = 25.0
_DRIFT_PER_DEGREE: Six = (0.05, -0.03, 0.1, 0.001, -0.002, 0.0005)


@dataclass(frozen=True, slots=True)
class SensorReading:
    """What the device believes to measure."""

    values: Six  # as a `Signal` gives them, with the faults applied
    temperature: float = ROOM  # degrees Celsius
    saturated: bool = False  # at the limit


@dataclass(frozen=True, slots=True)
class FrameMoment:
    """Where a frame is in its stream."""

    number: int  # from 0 since the device last came up
    clock: float  # the device's, s, jumps included
    jump: float = 0.0  # how far the clock has leapt so far, s


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
        raise EmulatorError("recording: two or more rows of six numbers with increasing times are needed.")
    values = [_six(row) for row in rows]
    span = (times[-1] - times[0]) * len(times) / (len(times) - 1)  # the last row lasts as long as the others
    return lambda time: values[bisect.bisect_right(times, times[0] + time % span) - 1]


def _six(row: Sequence[float]) -> Six:
    if len(row) != 6:
        raise EmulatorError(f"signal: {arg(len(row))} numbers were given: give six.")
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

    def reading(self, time: float) -> SensorReading:
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

    def moment(self, time: float, number: int) -> FrameMoment:
        """Return where the frame of that number is, at `time`."""
        jump = sum(event.amount for event in self._script.begun(time, Fault.CLOCK_JUMP))
        return FrameMoment(number, time + jump, jump)

    def rate_factor(self, time: float) -> float:
        """Return what the rate is multiplied by."""
        return math.prod(event.amount for event in self._script.active(time, Fault.WRONG_RATE))

    def _drifted(self, time: float) -> SensorReading:
        warmer = sum(
            event.amount * min(1.0, (time - event.start) / event.duration)
            for event in self._script.begun(time, Fault.DRIFT)
        )
        values = zip(self.signal(time), _DRIFT_PER_DEGREE, strict=True)
        return SensorReading(_six([value + warmer * slope for value, slope in values]), ROOM + warmer)


# ---- what a line's faults make of a frame: no clock and no line, so that a seed gives the same bytes

_MERGED = 3
_MOST_GARBAGE = 40


@dataclass(frozen=True, slots=True)
class Emission:
    """What goes on the line at one moment."""

    pieces: tuple[bytes, ...]  # each written by itself
    intact: bool = True  # the frame is whole and right, and goes out now or with one of the next
    fault: Fault | None = None  # of the line, that acted on it
    away: FaultEvent | None = None  # after the pieces the line breaks, until this is over


class Mangler:
    """The faults of one device's line.

    Parameters
    ----------
    model : Model
        Knows what a damaged frame of it is.
    script : Script
    seed : int
    datagrams : bool
        Pieces do not join on the way: a split frame is a broken one, and merged ones come in a burst.
    """

    def __init__(self, model: Model, script: Script, seed: int, *, datagrams: bool) -> None:
        self._model = model
        self._script = script
        self._seed = seed
        self._datagrams = datagrams
        self._held: list[bytes] = []
        self._used: set[int] = set()

    def mangle(self, frame: bytes, time: float, count: int) -> Emission:
        """Return what to send for a frame of `time`, s after the first; `count` of them came before."""
        away = self._break(time)
        if away is not None:
            held = self._released()
            if away.fault is Fault.DISCONNECT:
                return Emission((*held, frame[: max(1, len(frame) // 2)]), False, away.fault, away)
            return Emission(held, False, away.fault, away)
        active = self._script.active(time)
        events = [event.fault for event in active]
        if Fault.STALL in events:
            return Emission(self._released(), False, Fault.STALL)
        random = Random(f"{self._seed}:{count}")  # noqa: S311 - the same faults again, not secrets
        intact, fault = True, None
        if Fault.BAD_CHECKSUM in events:
            frame, intact, fault = self._model.damaged(frame), False, Fault.BAD_CHECKSUM
        if Fault.MERGED in events:
            self._held.append(frame)
            pieces = self._released() if len(self._held) >= _MERGED else ()
            return Emission(pieces, intact, fault or Fault.MERGED)
        pieces = (*self._released(), frame)
        if Fault.GARBAGE in events:
            garbage, fault = self._garbage(random, len(frame)), fault or Fault.GARBAGE
            pieces = (*pieces[:-1], garbage, frame)
        if Fault.SPLIT in events:
            pieces = (*pieces[:-1], *_split(frame, random))
            intact, fault = intact and not self._datagrams, fault or Fault.SPLIT
        return Emission(pieces, intact, fault)

    def restart(self) -> None:
        """Forget what was held back."""
        self._held.clear()

    def _break(self, time: float) -> FaultEvent | None:
        for number, event in enumerate(self._script.events):
            due = event.fault in (Fault.DISCONNECT, Fault.RECONNECT) and event.start <= time
            if due and number not in self._used:
                self._used.add(number)
                return event
        return None

    def _released(self) -> tuple[bytes, ...]:
        held, self._held = self._held, []
        if not held or self._datagrams:
            return tuple(held)
        return (b"".join(held),)

    def _garbage(self, random: Random, frame_size: int) -> bytes:
        size = random.randint(1, _MOST_GARBAGE)
        if (
            self._datagrams and size == frame_size
        ):  # of the right size it would be a frame: UDP has no checksum here
            size += 1
        return random.randbytes(size)


def _split(frame: bytes, random: Random) -> list[bytes]:
    """Cut a frame in two to four pieces; one of a single byte cannot be cut."""
    if len(frame) < 2:
        return [frame]
    cuts = sorted(random.sample(range(1, len(frame)), min(len(frame) - 1, random.randint(1, 3))))
    return [frame[a:b] for a, b in zip([0, *cuts], [*cuts, len(frame)], strict=True)]
