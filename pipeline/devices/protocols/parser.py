"""What all sensor parsers have in common."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.devices.protocols.commands import Command
    from contactbench.pipeline.devices.protocols.scanner import FrameScanner


Sample = TypeVar("Sample", bound="WrenchSample | FlangeSample")

ASSUMED_RATE_HZ = 100.0  # of a sensor that is asked for none; a silence is judged by it


class ProtocolError(InputError):
    """A request that a protocol cannot carry, or a reply that refuses one: names the remedy."""


@dataclass(frozen=True, slots=True)
class Counters:
    """
    What a parser has seen since it was made.

    Every byte is in a frame, skipped, or still waiting for the rest of its frame.
    """

    frames: int = 0  # frames with the right header, length and checksum, duplicates included
    # places that began like a frame and failed the check: damaged frames, and header bytes by chance
    bad_checksums: int = 0
    skipped_bytes: int = 0  # bytes outside every frame
    lost: int = 0  # samples missing by the device's own count or, for Bota, by its clock
    # frames repeated byte for byte, or overtaken by later ones: dropped, never given again as new
    duplicates: int = 0
    wraps: int = 0  # times the device's count or clock went through zero
    # times the count or clock went anywhere else: the device was restarted, or its clock was set
    restarts: int = 0
    bad_numbers: int = 0  # single sequence numbers that fitted neither what came before nor what came after
    invalid: int = 0  # samples with a number that is not finite; they carry `Status.INVALID`


class Parser(ABC, Generic[Sample]):
    """Turns the bytes of one device into samples."""

    pending = 0
    """Bytes that wait for the rest of their frame; always fewer than one frame."""

    @property
    @abstractmethod
    def counters(self) -> Counters:
        """A snapshot of what was seen so far."""

    @abstractmethod
    def feed(self, data: bytes, time: float) -> list[Sample]:
        """
        Take bytes as they arrive, cut anywhere; for a datagram protocol, one whole datagram.

        Parameters
        ----------
        data : bytes
            Any bytes: what is not a frame is skipped and counted, never an error.
        time : float
            When the last of them arrived, seconds of the host's monotonic clock.

        Returns
        -------
        list of samples
            One per intact frame that ends in these bytes, oldest first.
        """

    def begin(self) -> None:
        """Begin: the line was opened, or nothing useful came for long."""

    def reset(self) -> None:
        """Forget half a frame, after the line was lost. Counters and numbering go on."""

    def troubles(self) -> dict[str, str]:
        """Return what the parser knows to be wrong now, by kind."""
        return {}


class SensorParser(Parser["WrenchSample"]):
    """Turns the bytes of one sensor into wrenches."""


class FrameParser(SensorParser):
    """
    A parser of frames of one length.

    Parameters
    ----------
    scanner : FrameScanner
    """

    repeats = False
    """Whether two frames in a row may be equal: they have neither number nor time."""

    def __init__(self, scanner: FrameScanner) -> None:
        self._scanner = scanner
        self._last_frame = b""
        self._duplicates = self._invalid = 0

    @property
    def counters(self) -> Counters:
        """A snapshot of what was seen so far."""
        scanner = self._scanner
        return Counters(
            frames=scanner.frames,
            bad_checksums=scanner.bad_checksums,
            skipped_bytes=scanner.skipped_bytes,
            duplicates=self._duplicates,
            invalid=self._invalid,
            **self._counted(),
        )

    @property
    def pending(self) -> int:  # type: ignore[override]
        """Bytes that wait for the rest of their frame."""
        return self._scanner.pending

    def feed(self, data: bytes, time: float) -> list[WrenchSample]:
        """As `SensorParser`."""
        samples: list[WrenchSample] = []
        for frame in self._frames(data):
            if frame == self._last_frame and not self.repeats:
                self._duplicates += 1
                continue
            self._last_frame = frame
            samples += self._read(frame, time)
        return samples

    def reset(self) -> None:
        """As `SensorParser`."""
        self._scanner.reset()

    def _frames(self, data: bytes) -> list[bytes]:
        return self._scanner.push(data)

    def _counted(self) -> dict[str, int]:
        """Return what the frames' own numbers or times tell, by the names of `Counters`."""
        return {}

    @abstractmethod
    def _read(self, frame: bytes, time: float) -> list[WrenchSample]:
        """Return the samples of one frame, oldest first."""


@dataclass(frozen=True, eq=False)
class SensorDriver:
    """One sensor's way to stream."""

    parser: SensorParser
    # What is sent, and nothing else ever is.
    start: tuple[Command, ...]
    stop: tuple[Command, ...]
    rate: float  # samples a second that it should give, Hz
    rate_known: bool = True  # False: the sensor has a rate of its own, and `rate` is a guess
    limits: tuple[float, float] | None = None  # range of each channel, N and N·m, where the protocol tells it
    # Asks the device, before it is started, what its samples need; returns what is wrong, or nothing.
    prepare: Callable[[], str] | None = None
    # Returns what is wrong, by kind, as far as the parser knows.
    troubles: Callable[[], dict[str, str]] | None = None


def finite_status(numbers: Sequence[float]) -> Status:
    """Return OK, or INVALID if any number is NaN or infinite."""
    return Status.OK if all(map(math.isfinite, numbers)) else Status.INVALID
