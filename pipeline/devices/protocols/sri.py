"""
Sunrise Instruments (SRI) M8128 and M8126 interface boxes, on a serial line or TCP.

A frame is AA 55, the length of what follows it (uint16, big endian, without itself), a packet number
(uint16, big endian), N points of six float32 (little endian; N and N·m), and a checksum of the points
alone: their sum modulo 256, or their CRC-32.

In random bytes a false frame comes once in 2^40 bytes (sum) or 2^64 (CRC-32). In a frame with several
damaged points the sum misses one case in 256; neither covers the packet number.
"""

import re
import struct
import zlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.faults import Fault, FrameMoment, SensorReading, Six
from contactbench.pipeline.devices.protocols.checksums import sum8
from contactbench.pipeline.devices.protocols.commands import Command, check_line, check_rate
from contactbench.pipeline.devices.protocols.device_model import SENSOR_FAULTS, Model, Quirk
from contactbench.pipeline.devices.protocols.parser import (
    ASSUMED_RATE_HZ,
    FrameParser,
    ProtocolError,
    SensorDriver,
    finite_status,
)
from contactbench.pipeline.devices.protocols.scanner import FrameScanner
from contactbench.pipeline.devices.protocols.sequence import SequenceCounter
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import arg, message

_SYNC = b"\xaa\x55"
_POINTS_AT = 6
_POINT = struct.Struct("<6f")
_NUMBER = struct.Struct(">H")

MOST_POINTS = 64
LOWEST_RATE, HIGHEST_RATE = 1.0, 4000.0
# What was on its way when the box stopped, through a converter that sends every 16 ms.
_SETTLE_S = 0.1


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

    Raises
    ------
    ProtocolError
        `points` is not between 1 and `MOST_POINTS`.
    """

    trailer: Trailer = Trailer.SUM
    points: int = 1  # samples per frame

    def __post_init__(self) -> None:
        if not 1 <= self.points <= MOST_POINTS:
            raise ProtocolError(
                f"SRI: points per packet must be between 1 and {arg(MOST_POINTS)}, not {arg(self.points)}."
            )

    @property
    def package_length(self) -> int:
        """What the length field holds."""
        return _NUMBER.size + _POINT.size * self.points + self.trailer.size

    @property
    def frame_bytes(self) -> int:
        """Length of a whole frame."""
        return 4 + self.package_length


class SriParser(FrameParser):
    """
    For the M8128.

    All points of a packet have the arrival time of its last byte. Text, such as the answer to a command, is
    skipped wherever it stands.

    Parameters
    ----------
    layout : Layout
        Which frames to accept; others are skipped.
    either_trailer : bool
        Accept frames with the other checksum instead if one of those comes first, also after each `reset`: some
        boxes do not let it be chosen.
    """

    def __init__(self, layout: Layout | None = None, *, either_trailer: bool = False) -> None:
        self._layout = layout or Layout()
        super().__init__(_scanner_for(self._layout))
        self._either = either_trailer
        self._other: FrameScanner | None = None  # until the first frame
        self._try_other()
        self._sequence = SequenceCounter(16)
        self._points = slice(_POINTS_AT, _POINTS_AT + _POINT.size * self._layout.points)

    def _counted(self) -> dict[str, int]:
        return self._sequence.counted() | {"lost": self._sequence.lost * self._layout.points}

    @property
    def trailer(self) -> Trailer:
        """What frames are taken to end with."""
        return self._layout.trailer

    def reset(self) -> None:
        """As `SensorParser`."""
        super().reset()
        self._try_other()

    def _frames(self, data: bytes) -> list[bytes]:
        frames = self._scanner.push(data)
        if self._other is None:
            return frames
        if frames:
            self._other = None
        elif others := self._other.push(data):
            self._layout, self._scanner, self._other = _opposite(self._layout), self._other, None
            return others
        return frames

    def _try_other(self) -> None:
        if self._either:
            self._other = _scanner_for(_opposite(self._layout))
            known = self._scanner
            self._other.frames, self._other.bad_checksums = known.frames, known.bad_checksums
            self._other.skipped_bytes = known.skipped_bytes

    def _read(self, frame: bytes, time: float) -> list[WrenchSample]:
        (raw,) = _NUMBER.unpack_from(frame, 4)
        number = self._sequence.number(raw)
        samples: list[WrenchSample] = []
        if number is None:
            return samples
        first = number * self._layout.points
        for offset, point in enumerate(_POINT.iter_unpack(frame[self._points])):
            status = finite_status(point)
            self._invalid += status is not Status.OK
            fx, fy, fz, mx, my, mz = point
            samples.append(WrenchSample(time, (fx, fy, fz), (mx, my, mz), first + offset, status))
        return samples


def start_commands(
    rate_hz: float, *, trailer: Trailer = Trailer.SUM, baud: int | None = None, older_firmware: bool = False
) -> tuple[Command, ...]:
    """
    Return what makes the box stream: stop, rate, checksum, go.

    The first stops a stream that may still run, and lets the line settle.

    Parameters
    ----------
    rate_hz : float
        Rounded to whole Hz.
    trailer : Trailer
        The checksum to ask for.
    baud : int, optional
        Of the serial line; None for TCP.
    older_firmware : bool
        Older boxes know the rate's command by another name, which is `instead` of the usual one.

    Raises
    ------
    ProtocolError
        The box or the line cannot do that rate.
    """
    rate = round(check_rate("SRI", rate_hz, LOWEST_RATE, HIGHEST_RATE))
    check_line("SRI", rate, baud, Layout(trailer).frame_bytes)
    older = _setting("SMPR", str(rate))
    return (
        *stop_commands(),
        older if older_firmware else _setting("SMPF", str(rate), older),
        _setting("DCKMD", trailer.value),
        Command(b"AT+GSD\r\n"),  # some boxes answer, some do not
    )


def stop_commands() -> tuple[Command, ...]:
    """Return what ends the stream."""
    return (Command(b"AT+GSD=STOP\r\n", settle=_SETTLE_S),)


def _setting(name: str, value: str, instead: Command | None = None) -> Command:
    data, reply = f"AT+{name}={value}\r\n".encode(), f"ACK+{name}=".encode()
    return Command(data, reply, refusal=b"ERROR", instead=instead)


def _opposite(layout: Layout) -> Layout:
    return Layout(Trailer.CRC32 if layout.trailer is Trailer.SUM else Trailer.SUM, layout.points)


def _scanner_for(layout: Layout) -> FrameScanner:
    header = _SYNC + _NUMBER.pack(layout.package_length)
    return FrameScanner(header, layout.frame_bytes, _check_for(layout))


def _check_for(layout: Layout) -> Callable[[bytes], bool]:
    end = layout.frame_bytes - layout.trailer.size

    def sum_fits(frame: bytes) -> bool:
        return sum8(frame[_POINTS_AT:end]) == frame[end]

    def crc_fits(frame: bytes) -> bool:
        return zlib.crc32(frame[_POINTS_AT:end]) == int.from_bytes(frame[end:], "little")

    return sum_fits if layout.trailer is Trailer.SUM else crc_fits


def _troubles(parser: SriParser) -> dict[str, str]:
    if parser.trailer is Trailer.SUM:
        return {}
    return {
        "trailer": message(
            "The device did not accept AT+DCKMD=SUM: its frames end with a CRC-32, which is checked instead."
        )
    }


# ---- emulated: an M8128 box ----------------------------------------------------------------------

_TRAP = struct.unpack("<f", b"\xaa\x55\x00\x1b")[0]  # header and length, a float of 1e-22
_CHANNELS = re.compile(rb"\(A01,A02,A03,A04,A05,A06\);E;1;\(WMA:\d+\)")
_BUSY_S = 0.002


def sri_frame(values: Six, number: int, *, crc32: bool = False) -> bytes:
    """Return one frame of one point.

    Parameters
    ----------
    values : six floats
        N, N·m.
    number : int
        Of the package, taken modulo 65536.
    crc32 : bool
        A CRC-32 ends it, not a sum.
    """
    data = struct.pack("<6f", *values)
    trailer = struct.pack("<I", zlib.crc32(data)) if crc32 else bytes([sum(data) % 256])
    return struct.pack(">HHH", 0xAA55, 2 + len(data) + len(trailer), number % 65_536) + data + trailer


class SriModel(Model):
    """An M8128 box, which takes one command at a time: what comes before its answer is lost."""

    name = "sri"
    own_rate = 200.0
    faults = SENSOR_FAULTS | {Fault.CLOCK_JUMP}
    trap: ClassVar[Six | None] = (_TRAP,) * 6
    read_only = (b"EIP", b"ETPT", b"AMPZ", b"CHNAPG", b"EXMV", b"DCPCU", b"DCPM", b"UARTCFG")
    full_scale: ClassVar[Six | None] = (150.0, 150.0, 300.0, 15.0, 15.0, 15.0)
    possible_quirks: ClassVar[frozenset[Quirk]] = frozenset(
        {Quirk.OLDER, Quirk.CRC32_ONLY, Quirk.CRC32_SILENTLY, Quirk.ANSWERS_START, Quirk.FORGIVING}
    )

    def __init__(self, rate: float | None = None, quirks: Iterable[Quirk | str] = ()) -> None:
        super().__init__(rate, quirks)
        self._never_sum = bool(self.quirks & {Quirk.CRC32_ONLY, Quirk.CRC32_SILENTLY})
        self._crc32 = self._never_sum
        self.busy = 0.0 if Quirk.FORGIVING in self.quirks else _BUSY_S

    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:
        """Return one frame; a jump of the clock is one of the package number."""
        return sri_frame(reading.values, moment.number + round(moment.jump * self.rate), crc32=self._crc32)

    def _step(self) -> list[bytes]:
        line, end, _ = self._pending.partition(b"\r\n")
        if not end:
            return []
        command = self._take(len(line) + 2)
        if self._pending and Quirk.FORGIVING not in self.quirks:
            self.too_soon(self._take(len(self._pending)))
        found = re.fullmatch(rb"AT\+([A-Z0-9]+)(?:=(.*))?", line)
        if not found:
            self._refuse(command)
            return [b"ERROR\r\n"]
        name, value = found[1], found[2] or b""
        answer = self._query(name) if value == b"?" else self._told(name, value)
        if answer is None:
            self._refuse(command)
            return [b"ACK+" + name + b"=ERROR$ERROR\r\n"]
        self._obey(command)
        return [answer] if answer else []

    @property
    def _rate_name(self) -> bytes:
        return b"SMPR" if Quirk.OLDER in self.quirks else b"SMPF"

    def _query(self, name: bytes) -> bytes | None:
        known = {self._rate_name: b"%d" % self.rate, b"DCKMD": b"CRC32" if self._crc32 else b"SUM"}
        if name in known:
            return _acknowledged(name, known[name])
        return _acknowledged(name, b"0") if name in self.read_only else None

    def _told(self, name: bytes, value: bytes) -> bytes | None:
        """Obey, and return the answer, empty for none; None: not obeyed."""
        if name == b"GSD":
            return self._go(value)
        if name == b"GOD" and not value:
            return self.frame(*self._now())
        if name == self._rate_name and value.isdigit() and 0 < int(value) <= 4000:
            self.rate = float(value)
        elif name == b"DCKMD" and value in (b"SUM", b"CRC32"):
            if value == b"SUM" and Quirk.CRC32_ONLY in self.quirks:
                return None
            self._crc32 = value == b"CRC32" or self._never_sum
        elif not (name == b"SGDM" and _CHANNELS.fullmatch(value)):
            return None
        return _acknowledged(name, value)

    def _go(self, value: bytes) -> bytes | None:
        if value not in (b"", b"STOP"):
            return None
        self.streaming = not value
        if self.streaming:
            return b"ACK+GSD=OK\r\n" if Quirk.ANSWERS_START in self.quirks else b""
        return _acknowledged(b"GSD", value)


def _acknowledged(name: bytes, value: bytes) -> bytes:
    return b"ACK+" + name + b"=" + value + b"$OK\r\n"


class SriDriver(Driver):
    """An M8128 or M8126 box."""

    scheme, title = "sri", "SRI"
    ways = (Way(Carrier.SERIAL, baud=115_200, frame=Layout().frame_bytes), Way(Carrier.TCP, port=4008))
    rate = 200.0
    emulated = SriModel
    usb_words = ("sunrise", "m8128", "m8126", "sri ")

    def sensor(self, address: DeviceAddress) -> SensorDriver:
        """As `Driver`."""
        rate = address.rate or ASSUMED_RATE_HZ
        start = start_commands(rate, baud=address.baud)
        parser = SriParser(either_trailer=True)
        return SensorDriver(parser, start, stop_commands(), rate, troubles=lambda: _troubles(parser))
