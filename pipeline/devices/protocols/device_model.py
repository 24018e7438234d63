"""What every emulated device has: a state, answers to commands, and frames."""

import math
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterable
from enum import StrEnum
from typing import ClassVar

from contactbench.pipeline.devices.faults import (
    SYNTHETIC,
    EmulatorError,
    Fault,
    FrameMoment,
    SensorReading,
    Six,
)
from contactbench.pipeline.errors import arg

WIRE_FAULTS = frozenset(
    {
        Fault.SPLIT,
        Fault.MERGED,
        Fault.GARBAGE,
        Fault.BAD_CHECKSUM,
        Fault.STALL,
        Fault.DISCONNECT,
        Fault.RECONNECT,
        Fault.STUCK,
    }
)
SENSOR_FAULTS = WIRE_FAULTS | {Fault.HEADER, Fault.WRONG_RATE, Fault.SATURATION, Fault.DRIFT, Fault.REZERO}
_LONGEST_COMMAND = 4096
_KEPT = 1000
JOINTS: Six = (0.3, -0.4, 1.1, 0.5, -0.7, 0.9)
"""Where an emulated robot stands unless it is told otherwise, rad."""


class Quirk(StrEnum):
    """What some devices of a kind do and others do not. A device has none unless it is told so."""

    OLDER = "older"
    """SRI: the rate is set by SMPR, SMPF is an error. Elfin: ReadActPos gives 12 numbers, not 24. UR: the
    controller does not know the variables tcp_offset and ft_raw_wrench."""
    CRC32_ONLY = "crc32-only"
    """SRI: frames end with a CRC-32; DCKMD=SUM is an error."""
    CRC32_SILENTLY = "crc32-silently"
    """SRI: frames end with a CRC-32; DCKMD=SUM is acknowledged and ignored."""
    ANSWERS_START = "answers-start"
    """SRI: AT+GSD is answered before the first frame."""
    FORGIVING = "forgiving"
    """SRI, Robotiq: commands are taken without the pause that the real devices need."""


class Model(ABC):
    """A device without its line.

    Parameters
    ----------
    rate : float or None
        Frames per second until a command changes it; None: the device's own.
    quirks : iterable of Quirk

    Raises
    ------
    EmulatorError
        The rate is not possible, or the device cannot have a quirk.

    Attributes
    ----------
    streaming : bool
    rate : float
        Frames per second while streaming.
    commands : deque of bytes
        What it was told and obeyed, in order: the last 1000.
    refused : deque of bytes
        What it was told and must not be told: settings that stay, zeroing, motion, what it does not know, and
        what comes too soon after a command. The last 1000.
    obeyed_count, refused_count : int
        How many there were in all.
    faults : frozenset of Fault
        That it can have.
    trap, full_scale : six floats or None
        A reading that holds the start of a frame; the largest one.
    rest, swing, swing_hz
        What it measures unless it is told otherwise, and how a signal to look at swings about that.
    asked_only : bool
        It sends answers only, never by itself.
    possible_quirks : frozenset of Quirk
    busy : float
        How long it is deaf before it answers, s.
    """

    name: ClassVar[str]
    rest: ClassVar[Six] = SYNTHETIC
    swing: ClassVar[Six] = (5.0, 5.0, 5.0, 0.2, 0.2, 0.2)
    swing_hz: ClassVar[float] = 0.5
    own_rate: ClassVar[float]
    faults: ClassVar[frozenset[Fault]] = SENSOR_FAULTS
    trap: ClassVar[Six | None] = None
    full_scale: ClassVar[Six | None] = None
    asked_only: ClassVar[bool] = False
    possible_quirks: ClassVar[frozenset[Quirk]] = frozenset()

    def __init__(self, rate: float | None = None, quirks: Iterable[Quirk | str] = ()) -> None:
        if rate is not None and not 0.01 <= rate <= 100_000:
            raise EmulatorError(f"rate {arg(rate)}: give a number of frames per second from 0.01 to 100000.")
        self.quirks = self._checked(quirks)
        self.commands: deque[bytes] = deque(maxlen=_KEPT)
        self.refused: deque[bytes] = deque(maxlen=_KEPT)
        self.obeyed_count = self.refused_count = 0
        self.busy = 0.0
        self.first_rate = rate or self.own_rate
        self.rate = self.first_rate
        self.streaming = False
        self.answer: Callable[[], tuple[SensorReading, FrameMoment]] | None = None
        self._pending = b""

    def restart(self) -> None:
        """Come up again, as after power was lost or a new connection: nothing is streamed."""
        self.streaming = False
        self.rate = self.first_rate
        self._pending = b""

    def greeting(self) -> bytes:
        """Return what it says by itself when it has come up."""
        return b""

    def feed(self, data: bytes, silence: float = math.inf) -> list[bytes]:  # noqa: ARG002 - for those that need it
        """Take what the host sent, in any pieces, and return the answers.

        Parameters
        ----------
        data : bytes
        silence : float
            How long the host had sent nothing before these bytes came, s.
        """
        self._pending += data
        answers: list[bytes] = []
        while True:
            before = len(self._pending)
            answers += self._step()
            if len(self._pending) == before:
                break
        if len(self._pending) > _LONGEST_COMMAND:
            self._refuse(self._take(len(self._pending)))
        return answers

    def too_soon(self, data: bytes) -> None:
        """Take what the host sent while the device was busy, to no effect."""
        if data:
            self._refuse(data)

    @abstractmethod
    def _step(self) -> list[bytes]:
        """Take at most one command off `_pending`, and return the answers; take none while it is not whole."""

    @abstractmethod
    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:
        """Return one frame."""

    def damaged(self, frame: bytes) -> bytes:
        """Return the frame with a wrong checksum."""
        return frame[:-1] + bytes([frame[-1] ^ 0x5A])

    def _take(self, count: int) -> bytes:
        taken, self._pending = self._pending[:count], self._pending[count:]
        return taken

    def _told_to_stream(self, start: bytes, stop: bytes) -> list[bytes]:
        """Take one of two commands of the same length, which begin and end the stream and are not answered."""
        if len(self._pending) < len(start):
            return []
        command = self._take(len(start))
        if command not in (start, stop):
            self._refuse(command + self._take(len(self._pending)))
            return []
        self.streaming = command == start
        self._obey(command)
        return []

    def _obey(self, command: bytes) -> None:
        self.commands.append(command)
        self.obeyed_count += 1  # last: who waits for the count in another thread finds the command

    def _refuse(self, command: bytes) -> None:
        self.refused.append(command)
        self.refused_count += 1

    def _checked(self, quirks: Iterable[Quirk | str]) -> frozenset[Quirk]:
        named = frozenset(quirks)
        for quirk in named - self.possible_quirks:
            there = ", ".join(sorted(self.possible_quirks)) or "none"
            raise EmulatorError(
                f"quirk {arg(str(quirk))!r}: not available for {arg(self.name)}. Choose from: {arg(there)}."
            )
        return frozenset(map(Quirk, named))

    def _now(self) -> tuple[SensorReading, FrameMoment]:
        if self.answer is None:
            raise EmulatorError(f"{arg(self.name)}: not running yet: start the emulator first.")
        return self.answer()
