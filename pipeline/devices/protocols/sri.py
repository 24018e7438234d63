"""
Sunrise Instruments (SRI) M8128 and M8126 interface boxes, on a serial line or TCP.

A frame is AA 55, the length of what follows it (uint16, big endian, without itself), a packet number
(uint16, big endian), N points of six float32 (little endian; N and N·m), and a checksum of the points
alone: their sum modulo 256, or their CRC-32.

In random bytes a false frame comes once in 2^40 bytes (sum) or 2^64 (CRC-32). In a frame with several
damaged points the sum misses one case in 256; neither covers the packet number.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from pipeline.devices.protocols.checksums import sum8
from pipeline.devices.protocols.commands import Command, check_line, check_rate
from pipeline.devices.protocols.parser import Counters, ProtocolError, finite_status
from pipeline.devices.protocols.scanner import FrameScanner
from pipeline.devices.protocols.sequence import SequenceCounter
from pipeline.devices.sample import Status, WrenchSample

if TYPE_CHECKING:
    from collections.abc import Callable

_SYNC = b"\xaa\x55"
_POINTS_AT = 6
_POINT = struct.Struct("<6f")
_NUMBER = struct.Struct(">H")

MOST_POINTS = 64
LOWEST_RATE, HIGHEST_RATE = 1.0, 4000.0


class Trailer(Enum):
    """What a frame ends with; the value is the argument of the command that chooses it."""

    SUM = "SUM"
    CRC32 = "CRC32"

    @property
    def size(self) -> int:
        """Bytes."""
        return 1 if self is Trailer.SUM else 4


@dataclass(frozen=True)
class Layout:
    """
    Which frames a box sends.

    Attributes
    ----------
    trailer : Trailer
    points : int
        Samples per frame.

    Raises
    ------
    ProtocolError
        `points` is not between 1 and `MOST_POINTS`.
    """

    trailer: Trailer = Trailer.SUM
    points: int = 1

    def __post_init__(self) -> None:
        if not 1 <= self.points <= MOST_POINTS:
            raise ProtocolError(
                f"SRI: points per packet must be between 1 and {MOST_POINTS}, not {self.points}."
            )

    @property
    def package_length(self) -> int:
        """What the length field holds."""
        return _NUMBER.size + _POINT.size * self.points + self.trailer.size

    @property
    def frame_bytes(self) -> int:
        """Length of a whole frame."""
        return 4 + self.package_length


class SriParser:
    """
    `SensorParser` for the M8128.

    All points of a packet have the arrival time of its last byte. Text, such as the answer to a command, is
    skipped wherever it stands.

    Parameters
    ----------
    layout : Layout
        Which frames to accept; others are skipped.
    """

    def __init__(self, layout: Layout | None = None) -> None:
        self._layout = layout or Layout()
        length = self._layout.frame_bytes
        header = _SYNC + _NUMBER.pack(self._layout.package_length)
        self._scanner = FrameScanner(header, length, _check_for(self._layout))
        self._sequence = SequenceCounter(16)
        self._points = slice(_POINTS_AT, _POINTS_AT + _POINT.size * self._layout.points)
        self._last_frame = b""
        self._duplicates = 0
        self._invalid = 0

    @property
    def counters(self) -> Counters:
        """As `SensorParser`."""
        scanner, sequence = self._scanner, self._sequence
        return Counters(
            frames=scanner.frames,
            bad_checksums=scanner.bad_checksums,
            skipped_bytes=scanner.skipped_bytes,
            lost=sequence.lost * self._layout.points,
            duplicates=self._duplicates,
            wraps=sequence.wraps,
            restarts=sequence.restarts,
            bad_numbers=sequence.bad_numbers,
            invalid=self._invalid,
        )

    @property
    def pending(self) -> int:
        """As `SensorParser`."""
        return self._scanner.pending

    def feed(self, data: bytes, time: float) -> list[WrenchSample]:
        """As `SensorParser`."""
        samples: list[WrenchSample] = []
        for frame in self._scanner.push(data):
            self._read(frame, time, samples)
        return samples

    def reset(self) -> None:
        """As `SensorParser`."""
        self._scanner.reset()

    def _read(self, frame: bytes, time: float, samples: list[WrenchSample]) -> None:
        if frame == self._last_frame:
            self._duplicates += 1
            return
        self._last_frame = frame
        (raw,) = _NUMBER.unpack_from(frame, 4)
        number = self._sequence.number(raw)
        if number is None:
            return
        first = number * self._layout.points
        for offset, point in enumerate(_POINT.iter_unpack(frame[self._points])):
            status = finite_status(point)
            self._invalid += status is not Status.OK
            fx, fy, fz, mx, my, mz = point
            samples.append(WrenchSample(time, (fx, fy, fz), (mx, my, mz), first + offset, status))


def start_commands(
    rate_hz: float, *, trailer: Trailer = Trailer.SUM, baud: int | None = None, older_firmware: bool = False
) -> tuple[Command, ...]:
    """
    Return what makes the box stream: stop, rate, checksum, go.

    Drain the line after the first, which stops a stream that may still run.

    Parameters
    ----------
    rate_hz : float
        Rounded to whole Hz.
    trailer : Trailer
        The checksum to ask for.
    baud : int, optional
        Of the serial line; None for TCP.
    older_firmware : bool
        Older boxes know the rate's command by another name; try this when the first gets no answer.

    Raises
    ------
    ProtocolError
        The box or the line cannot do that rate.
    """
    rate = round(check_rate("SRI", rate_hz, LOWEST_RATE, HIGHEST_RATE))
    check_line("SRI", rate, baud, Layout(trailer).frame_bytes)
    name = "SMPR" if older_firmware else "SMPF"
    return (
        *stop_commands(),
        Command(f"AT+{name}={rate}\r\n".encode(), f"ACK+{name}=".encode()),
        Command(f"AT+DCKMD={trailer.value}\r\n".encode(), b"ACK+DCKMD="),
        Command(b"AT+GSD\r\n"),  # some boxes answer, some do not
    )


def stop_commands() -> tuple[Command, ...]:
    """Return what ends the stream."""
    return (Command(b"AT+GSD=STOP\r\n"),)


def _check_for(layout: Layout) -> Callable[[bytes], bool]:
    end = layout.frame_bytes - layout.trailer.size

    def sum_fits(frame: bytes) -> bool:
        return sum8(frame[_POINTS_AT:end]) == frame[end]

    def crc_fits(frame: bytes) -> bool:
        return zlib.crc32(frame[_POINTS_AT:end]) == int.from_bytes(frame[end:], "little")

    return sum_fits if layout.trailer is Trailer.SUM else crc_fits
