"""Which faults an emulated device has, and when."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable


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
    """One fault.

    Attributes
    ----------
    start : float
        Seconds after the device first streams.
    fault : Fault
    duration : float
        Seconds, positive.
    size : float
        What `Fault` says of it; of no meaning elsewhere.
    """

    start: float
    fault: Fault
    duration: float = 1.0
    size: float | None = None

    def __post_init__(self) -> None:
        if not (0 <= self.start < math.inf and 0 < self.duration < math.inf):
            raise EmulatorError(
                f"fault {self.fault}: start {self.start} s, duration {self.duration} s: give a start of 0 or more"
                " and a positive duration."
            )
        if self.size is None:
            object.__setattr__(self, "size", _DEFAULT_SIZE.get(self.fault, 1.0))
        if not math.isfinite(self.amount) or (self.fault is Fault.WRONG_RATE and self.amount <= 0):
            raise EmulatorError(
                f"fault {self.fault}: size {self.size}: give a finite number, positive for a rate."
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
                f"fault {text!r}: write NAME@START+DURATION in s, such as stall@2+0.5; names: {names}."
            )
        try:
            start, duration = float(found["start"]), float(found["duration"] or 1)
            size = float(found["size"]) if found["size"] else None
        except ValueError as error:
            raise EmulatorError(f"fault {text!r}: {error}: write the numbers as in stall@2+0.5.") from error
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
                raise EmulatorError(f"fault {event.fault}: {device} cannot have it: choose from {names}.")
