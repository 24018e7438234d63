"""What all sensor parsers have in common."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

from contactbench.pipeline.devices.sample import Status
from contactbench.pipeline.errors import InputError, arg

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample

# A start bit, eight data bits and a stop bit (8N1).
_BITS_PER_BYTE = 10


@dataclass(frozen=True, slots=True)
class Command:
    """One command to a device."""

    data: bytes  # what to write
    # what the device's answer contains when it agrees; None where no answer comes, or none is known
    reply: bytes | None = None
    # seconds that must pass before the next command; what comes meanwhile belongs to the time before
    settle: float = 0.0
    refusal: bytes | None = None  # what the device's answer, a line of text, contains when it does not agree
    instead: Command | None = None  # what to send when it does not agree

    def answered(self, heard: bytes) -> bool | None:
        """Tell from all that came since whether the device agreed; None: it has not said yet."""
        if self.reply is None:
            return True
        start = heard.find(self.reply)
        if self.refusal is None:
            return True if start >= 0 else None
        refused = heard.find(self.refusal)
        if refused >= 0:
            return False
        # The refusal may be the end of a line that begins like agreement.
        return True if start >= 0 and b"\n" in heard[start:] else None


def highest_rate(baud: int, frame_bytes: int) -> float:
    """
    Return the frames per second that a serial line (8N1) can carry.

    Parameters
    ----------
    baud : int
        Bits per second.
    frame_bytes : int
        Length of a frame.
    """
    return baud / _BITS_PER_BYTE / frame_bytes


def check_rate(device: str, rate_hz: float, low: float, high: float) -> float:
    """
    Return a sample rate that the device has.

    Raises
    ------
    ProtocolError
        It is not finite or outside low .. high, Hz.
    """
    if not (math.isfinite(rate_hz) and low <= rate_hz <= high):
        raise ProtocolError(
            f"{arg(device)}: the rate must be between {arg(low):g} and {arg(high):g} Hz, not {arg(rate_hz):g}."
        )
    return rate_hz


def check_line(device: str, rate_hz: float, baud: int | None, frame_bytes: int) -> None:
    """
    Refuse a rate that the serial line cannot carry; `baud` None means that there is no serial line.

    Raises
    ------
    ProtocolError
        The baud rate is not positive, or too low.
    """
    if baud is None:
        return
    if baud <= 0:
        raise ProtocolError(f"{arg(device)}: the baud rate must be above 0, not {arg(baud)}.")
    ceiling = highest_rate(baud, frame_bytes)
    if rate_hz > ceiling:
        raise ProtocolError(
            f"{arg(device)}: {arg(rate_hz):g} Hz is too fast for {arg(baud)} baud, which carries"
            f" {arg(math.floor(ceiling))} frames of {arg(frame_bytes)} bytes per second: lower the rate or"
            " raise the baud rate."
        )


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


# ---- frames of one fixed length, found in a stream of bytes --------------------------------------


# Larger input is taken in pieces, so that the buffer stays this small whatever is handed in.
_PIECE = 4096


class FrameScanner:
    """
    Finds frames by header and checksum; what is not a frame is skipped and counted.

    After a failed check it moves on by one byte only: header bytes also occur inside numbers, and a jump by
    a whole frame from such a place would lose the intact frame that begins behind it.

    Parameters
    ----------
    header : bytes
        The fixed bytes that each frame begins with.
    length : int
        Of a whole frame, header and checksum included.
    intact : callable
        Tells from a whole frame whether its checksum is right.
    """

    def __init__(self, header: bytes, length: int, intact: Callable[[bytes], bool]) -> None:
        self._header = header
        self._length = length
        self._intact = intact
        self._buffer = bytearray()
        self.frames = 0
        self.bad_checksums = 0
        self.skipped_bytes = 0

    @property
    def pending(self) -> int:
        """Bytes in the buffer: fewer than a frame."""
        return len(self._buffer)

    def push(self, data: bytes) -> list[bytes]:
        """Take bytes; return the whole frames that end in them, oldest first."""
        found: list[bytes] = []
        for start in range(0, len(data), _PIECE):
            self._buffer += data[start : start + _PIECE]
            self._scan(found)
        return found

    def reset(self) -> None:
        """Drop what waits for the rest of its frame."""
        self.skipped_bytes += len(self._buffer)
        self._buffer.clear()

    def _scan(self, found: list[bytes]) -> None:
        buffer, length = self._buffer, self._length
        position = 0
        while True:
            start = self._next_header(position)
            self.skipped_bytes += start - position
            position = start
            if start + length > len(buffer):
                break
            frame = bytes(buffer[start : start + length])
            if self._intact(frame):
                self.frames += 1
                found.append(frame)
                position += length
            else:
                self.bad_checksums += 1
                self.skipped_bytes += 1
                position += 1
        del buffer[:position]

    def _next_header(self, position: int) -> int:
        """Return where a header begins, or may begin once more bytes are there."""
        start = self._buffer.find(self._header, position)
        if start >= 0:
            return start
        return max(position, len(self._buffer) - len(self._header) + 1)
