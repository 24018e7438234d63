"""What every emulated device has: a state, answers to commands, and frames."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar

from pipeline.devices.emulate.script import EmulatorError, Fault

if TYPE_CHECKING:
    from collections.abc import Callable

    from pipeline.devices.emulate.signals import Moment, Reading, Six

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


class Model(ABC):
    """A device without its line.

    Parameters
    ----------
    rate : float or None
        Frames per second until a command changes it; None: the device's own.

    Attributes
    ----------
    streaming : bool
    rate : float
        Frames per second while streaming.
    commands : list of bytes
        What it was told and obeyed, in order.
    refused : list of bytes
        What it was told and must not be told: settings that stay, zeroing, motion, and what it does not know.
    faults : frozenset of Fault
        That it can have.
    trap, full_scale : six floats or None
        A reading that holds the start of a frame; the largest one.
    asked_only : bool
        It sends answers only, never by itself.
    """

    name: ClassVar[str]
    own_rate: ClassVar[float]
    faults: ClassVar[frozenset[Fault]] = SENSOR_FAULTS
    trap: ClassVar[Six | None] = None
    full_scale: ClassVar[Six | None] = None
    asked_only: ClassVar[bool] = False

    def __init__(self, rate: float | None = None) -> None:
        if rate is not None and not 0.01 <= rate <= 100_000:
            raise EmulatorError(f"rate {rate}: give a number of frames per second from 0.01 to 100000.")
        self.commands: list[bytes] = []
        self.refused: list[bytes] = []
        self.first_rate = rate or self.own_rate
        self.rate = self.first_rate
        self.streaming = False
        self.answer: Callable[[], tuple[Reading, Moment]] | None = None
        self._pending = b""

    def restart(self) -> None:
        """Come up again, as after power was lost or a new connection: nothing is streamed."""
        self.streaming = False
        self.rate = self.first_rate
        self._pending = b""

    def greeting(self) -> bytes:
        """Return what it says by itself when it has come up."""
        return b""

    def feed(self, data: bytes) -> list[bytes]:
        """Take what the host sent, in any pieces, and return the answers."""
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

    @abstractmethod
    def _step(self) -> list[bytes]:
        """Take at most one command off `_pending`, and return the answers; take none while it is not whole."""

    @abstractmethod
    def frame(self, reading: Reading, moment: Moment) -> bytes:
        """Return one frame."""

    def damaged(self, frame: bytes) -> bytes:
        """Return the frame with a wrong checksum."""
        return frame[:-1] + bytes([frame[-1] ^ 0x5A])

    def _take(self, count: int) -> bytes:
        taken, self._pending = self._pending[:count], self._pending[count:]
        return taken

    def _obey(self, command: bytes) -> None:
        self.commands.append(command)

    def _refuse(self, command: bytes) -> None:
        self.refused.append(command)

    def _now(self) -> tuple[Reading, Moment]:
        if self.answer is None:
            raise EmulatorError(f"{self.name}: it is asked before it runs: start the emulator first.")
        return self.answer()
