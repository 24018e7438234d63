"""What a line's faults make of a frame; no clock and no line in here, so that the same seed gives the same bytes."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.emulate.script import Fault

if TYPE_CHECKING:
    from contactbench.pipeline.devices.emulate.models.model import Model
    from contactbench.pipeline.devices.emulate.script import FaultEvent, Script

_AT_ONCE = 3
_MOST_GARBAGE = 40


@dataclass(frozen=True, slots=True)
class Emission:
    """What goes on the line at one moment.

    Attributes
    ----------
    pieces : tuple of bytes
        Each written by itself.
    intact : bool
        The frame is whole and right, and goes out now or with one of the next.
    fault : Fault or None
        Of the line, that acted on it.
    away : FaultEvent or None
        After the pieces the line breaks, until this is over.
    """

    pieces: tuple[bytes, ...]
    intact: bool = True
    fault: Fault | None = None
    away: FaultEvent | None = None


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
            pieces = self._released() if len(self._held) >= _AT_ONCE else ()
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
