"""
Robotiq FT 300 and FT 300-S, the stream on their serial line.

A frame of 16 bytes: 20 4E, six int16 (little endian; 0.01 N and 0.001 N·m), CRC-16/MODBUS of all before
itself. There is no count, so lost frames show only as a gap in time.

In random bytes a false frame comes once in 2^32 bytes.
"""

import math
import struct
from collections.abc import Iterable
from typing import ClassVar

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.faults import FrameMoment, SensorReading, Six
from contactbench.pipeline.devices.protocols.checksums import crc16_modbus
from contactbench.pipeline.devices.protocols.commands import Command, check_rate
from contactbench.pipeline.devices.protocols.device_model import Model, Quirk
from contactbench.pipeline.devices.protocols.parser import FrameParser, SensorDriver
from contactbench.pipeline.devices.protocols.scanner import FrameScanner
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.devices.url import DeviceAddress

FRAME_BYTES = 16
RATE = 100.0
_FRAME = struct.Struct("<2x6h2x")
_FORCE_SCALE, _TORQUE_SCALE = 100.0, 1000.0
_LIMITS = (327.67, 32.767)  # what its 16 bits hold: there it stops counting

# Modbus: slave 9, write one register (410) with 0x0200, "stream".
_START = bytes.fromhex("09 10 01 9A 00 01 02 02 00 CD CA")
_STARTED = bytes.fromhex("09 10 01 9A 00 01 21 52")
# Half a second of these at 19200 baud is what the manual asks for.
_STOP = b"\xff" * 50
# They take 26 ms on the line; a request begins after 3.5 characters of silence, and converters add some time.
_SETTLE_S = 0.1


class RobotiqParser(FrameParser):
    """For the FT 300's stream."""

    repeats = True

    def __init__(self) -> None:
        super().__init__(FrameScanner(b"\x20\x4e", FRAME_BYTES, _intact))

    def _read(self, frame: bytes, time: float) -> list[WrenchSample]:
        fx, fy, fz, mx, my, mz = _FRAME.unpack(frame)
        force = (fx / _FORCE_SCALE, fy / _FORCE_SCALE, fz / _FORCE_SCALE)
        torque = (mx / _TORQUE_SCALE, my / _TORQUE_SCALE, mz / _TORQUE_SCALE)
        return [WrenchSample(time, force, torque)]


def start_commands(rate_hz: float = RATE) -> tuple[Command, ...]:
    """
    Return what makes the sensor stream: stop, in case it streams already, and go.

    The first lets the line settle: a streaming sensor does not answer, nor one that heard no silence before.

    Raises
    ------
    ProtocolError
        The rate is not 100 Hz, the only one there is.
    """
    check_rate("Robotiq", rate_hz, RATE, RATE)
    return (*stop_commands(), Command(_START, _STARTED))


def stop_commands() -> tuple[Command, ...]:
    """Return what ends the stream."""
    return (Command(_STOP, settle=_SETTLE_S),)


def _intact(frame: bytes) -> bool:
    return crc16_modbus(frame[:-2]) == int.from_bytes(frame[-2:], "little")


# ---- emulated: an FT 300 -------------------------------------------------------------------------

_SLAVE, _READ, _WRITE = 9, 3, 16
_SCALE = (100, 100, 100, 1000, 1000, 1000)
_STOP_BYTES = 20
"""How many 0xFF in a row end the stream; hosts send more."""
_BAUD = 19_200
_SILENCE_S = 3.5 * 10 / _BAUD
"""What ends whatever was on the line and lets a Modbus request begin, 8N1."""
_TRAP = (200.0, 200.0, 200.0, 20.0, 20.0, 20.0)  # 20000 counts each: 0x4E20, the header


def robotiq_frame(values: Six) -> bytes:
    """Return one frame: N in hundredths, N·m in thousandths, cut to what 16 bits hold."""
    counts = [max(-32_768, min(32_767, round(value * k))) for value, k in zip(values, _SCALE, strict=True)]
    return _with_crc(b"\x20\x4e" + struct.pack("<6h", *counts))


def _with_crc(data: bytes) -> bytes:
    return data + struct.pack("<H", crc16_modbus(data))


class RobotiqModel(Model):
    """An FT 300; its rate of 100 Hz cannot be set from outside.

    A request that follows the bytes of a stop without 3.5 characters of silence is a part of them, and lost.
    """

    name = "robotiq"
    own_rate = 100.0
    trap: ClassVar[Six | None] = _TRAP
    full_scale: ClassVar[Six | None] = (327.67, 327.67, 327.67, 32.767, 32.767, 32.767)

    possible_quirks: ClassVar[frozenset[Quirk]] = frozenset({Quirk.FORGIVING})

    def __init__(self, rate: float | None = None, quirks: Iterable[Quirk | str] = ()) -> None:
        super().__init__(rate, quirks)
        self._stopping = False

    def restart(self) -> None:
        """As `Model`."""
        super().restart()
        self._stopping = False

    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:  # noqa: ARG002 - it has no clock
        """Return one frame."""
        return robotiq_frame(reading.values)

    def feed(self, data: bytes, silence: float = math.inf) -> list[bytes]:
        """As `Model`."""
        if silence >= _SILENCE_S and self._stopping and data[:1] != b"\xff":
            self._stopping = False
            self._pending = b""  # the last bytes of the stop, too few for another one
        return super().feed(data, silence)

    def _step(self) -> list[bytes]:
        if self._stopping and self._pending.lstrip(b"\xff"):
            self.too_soon(self._take(len(self._pending)))
            return []
        if self._pending[:1] == b"\xff":
            return self._stop()
        size = self._size()
        if size is None or len(self._pending) < size:
            return []
        request = self._take(size)
        body = request[:-2]
        if len(request) < 4 or _with_crc(body) != request:
            self._refuse(request)
            return []
        return self._told(request, body)

    def _stop(self) -> list[bytes]:
        count = len(self._pending) - len(self._pending.lstrip(b"\xff"))
        if count >= _STOP_BYTES:
            self.streaming = False
            self._stopping = Quirk.FORGIVING not in self.quirks
            self._obey(self._take(count))
        elif count < len(self._pending):  # too few, and something follows: noise
            self._refuse(self._take(count))
        return []

    def _size(self) -> int | None:
        """Return how long the request at the front is; None: not yet known."""
        if len(self._pending) < 2:
            return None
        if self._pending[0] != _SLAVE or self._pending[1] not in (_READ, _WRITE):
            return len(self._pending)
        if self._pending[1] == _READ:
            return 8
        return 9 + self._pending[6] if len(self._pending) > 6 else None

    def _told(self, request: bytes, body: bytes) -> list[bytes]:
        if request == _START:
            self._obey(request)
            self.streaming = True
            return [_STARTED]
        count = int.from_bytes(body[4:6], "big")
        if body[:2] == bytes([_SLAVE, _READ]) and 1 <= count <= 125:
            self._obey(request)
            return [_with_crc(bytes([_SLAVE, _READ, 2 * count]) + bytes(2 * count))]
        self._refuse(request)
        return [_with_crc(bytes([_SLAVE, body[1] | 0x80, 1]))]


class RobotiqDriver(Driver):
    """An FT 300 or FT 300-S."""

    scheme, title = "robotiq", "Robotiq FT 300"
    ways = (Way(Carrier.SERIAL, baud=19_200, frame=FRAME_BYTES),)
    rate = RATE
    emulated = RobotiqModel
    usb_words = ("robotiq", "ft300", "ft 300")

    def sensor(self, address: DeviceAddress) -> SensorDriver:
        """As `Driver`."""
        rate = address.rate or RATE
        return SensorDriver(RobotiqParser(), start_commands(rate), stop_commands(), rate, limits=_LIMITS)
