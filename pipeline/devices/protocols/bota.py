"""
Bota Systems force/torque sensors on a serial line (SensONE, Rokubi, MiniONE).

A frame of 37 bytes, little endian: AA, status (uint16), six float32 (N and N·m), time (uint32, µs),
temperature (float32, °C), CRC-16/X-25 of all between AA and itself.

The public sources of this frame have no fields of the inertial unit that some models carry.

In random bytes a false frame comes once in 2^24 bytes, because the header is a single byte.
"""

import math
import re
import struct
from collections.abc import Iterable
from typing import ClassVar

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.faults import Fault, FrameMoment, SensorReading, Six
from contactbench.pipeline.devices.protocols.checksums import crc16_x25
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
from contactbench.pipeline.devices.protocols.sequence import DeviceClock
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import arg

FRAME_BYTES = 37
_FRAME = struct.Struct("<xH6fIfH")
_CRC_AT = 35

_FLAGS = {1: Status.LATE, 2: Status.OVERRANGE, 4: Status.INVALID, 8: Status.RAW}
_KNOWN_BITS = sum(_FLAGS)

# The sensor averages over a number of readings, each this long, s; that sets its rate.
_READING = 1.953125e-5
_FEWEST_READINGS, _MOST_READINGS = 51, 512
LOWEST_RATE, HIGHEST_RATE = (1 / (_READING * n) for n in (_MOST_READINGS, _FEWEST_READINGS))

_BAUD_CODES = {9600: 0, 57600: 1, 115200: 2, 230400: 3, 460800: 4}
DEFAULT_BAUD = 460800


class BotaParser(FrameParser):
    """
    For Bota's binary frames.

    There is no sample count. With the rate given, `lost` is estimated from the sensor's clock.

    Parameters
    ----------
    rate_hz : float, optional
        What the sensor was told to stream at.

    Raises
    ------
    ProtocolError
        The rate is not finite or not positive.
    """

    def __init__(self, rate_hz: float | None = None) -> None:
        if rate_hz is not None and not (math.isfinite(rate_hz) and rate_hz > 0):
            raise ProtocolError(f"Bota: the rate must be finite and above 0 Hz, not {arg(rate_hz)!r}.")
        self._rate = rate_hz
        super().__init__(FrameScanner(b"\xaa", FRAME_BYTES, _intact))
        self._clock = DeviceClock(32, 1e-6)
        self._lost = 0

    def _counted(self) -> dict[str, int]:
        return {"lost": self._lost, "wraps": self._clock.wraps, "restarts": self._clock.jumps}

    def _read(self, frame: bytes, time: float) -> list[WrenchSample]:
        bits, fx, fy, fz, mx, my, mz, ticks, temperature, _ = _FRAME.unpack(frame)
        not_finite = finite_status((fx, fy, fz, mx, my, mz, temperature))
        self._invalid += not_finite is not Status.OK
        device_time = self._clock.read(ticks, time)
        if self._rate is not None:
            self._lost += max(round(self._clock.step * self._rate) - 1, 0)
        sample = WrenchSample(
            time,
            (fx, fy, fz),
            (mx, my, mz),
            status=_status(bits) | not_finite,
            device_time=device_time,
            temperature=temperature if math.isfinite(temperature) else None,
        )
        return [sample]


def start_commands(rate_hz: float, *, baud: int = DEFAULT_BAUD) -> tuple[Command, ...]:
    """
    Return what makes the sensor stream: configure, binary frames, rate, run.

    After power-up the sensor prints text ending in "App Init"; wait for it, or for silence, first.

    Parameters
    ----------
    rate_hz : float
        100 to 1004 Hz; the sensor takes the nearest of its own (an average over 51 to 512 readings).
    baud : int
        Of the line, which the configuration repeats so that it stays.

    Raises
    ------
    ProtocolError
        The sensor or the line cannot do that rate, or the sensor has no such baud rate.
    """
    check_rate("Bota", rate_hz, LOWEST_RATE, HIGHEST_RATE)
    if baud not in _BAUD_CODES:
        known = ", ".join(map(str, _BAUD_CODES))
        raise ProtocolError(
            f"Bota: {arg(baud)} is not a baud rate of the sensor: choose one of {arg(known)}."
        )
    check_line("Bota", rate_hz, baud, FRAME_BYTES)
    readings = round(1 / (rate_hz * _READING))
    return (
        *stop_commands(),
        Command(f"c,0,1,0,{_BAUD_CODES[baud]}".encode(), b"r,0,c,0"),
        Command(f"f,{readings},0,0,1".encode(), b"r,0,f,0"),
        Command(b"R", b"r,0,R,0"),
    )


def stop_commands() -> tuple[Command, ...]:
    """Return what ends the stream: the sensor waits for its configuration."""
    return (Command(b"C", b"r,0,C,0"),)


def _intact(frame: bytes) -> bool:
    return crc16_x25(frame[1:_CRC_AT]) == int.from_bytes(frame[_CRC_AT:], "little")


def _status(bits: int) -> Status:
    status = Status.OK
    if bits == 0:
        return status
    for bit, flag in _FLAGS.items():
        if bits & bit:
            status |= flag
    return status | Status.ERROR if bits & ~_KNOWN_BITS else status


# ---- emulated: a SensONE or Rokubi ---------------------------------------------------------------

_TRAP = struct.unpack("<f", b"\xaa\x00\x00\xaa")[0]
_TICK_S = 0.00001953125  # of the sinc filter
_OVERRANGE = 2
_WHOLE = re.compile(rb"C|R|c,\d,\d,\d,\d|f,\d{2,4},\d,\d,\d")
_BEGUN = re.compile(rb"c(,(\d(,(\d(,(\d,?)?)?)?)?)?)?|f(,(\d{1,4}(,(\d(,(\d,?)?)?)?)?)?)?")
_BAUD_CODE = b"4"  # 460800 bit/s


class BotaModel(Model):
    """A SensONE or Rokubi."""

    name = "bota"
    own_rate = 200.0
    faults = SENSOR_FAULTS | {Fault.CLOCK_JUMP}
    trap: ClassVar[Six | None] = (_TRAP,) * 6
    full_scale: ClassVar[Six | None] = (500.0, 500.0, 1000.0, 15.0, 15.0, 10.0)

    def __init__(self, rate: float | None = None, quirks: Iterable[Quirk | str] = ()) -> None:
        super().__init__(rate, quirks)
        self._configuring = False

    def restart(self) -> None:
        """Come up again."""
        super().restart()
        self._configuring = False

    def greeting(self) -> bytes:
        """Return the last line of what it prints while it starts."""
        return b"App Init\r\n"

    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:
        """Return one frame: the status word, N, N·m, the clock modulo 2**32, degrees Celsius."""
        status = _OVERRANGE if reading.saturated else 0
        microseconds = round(moment.clock * 1e6) % 2**32
        body = struct.pack("<H6fIf", status, *reading.values, microseconds, reading.temperature)
        return b"\xaa" + body + struct.pack("<H", crc16_x25(body))

    def _step(self) -> list[bytes]:
        if self._pending[:1] in (b"\r", b"\n"):
            self._take(1)
            return []
        found = _WHOLE.match(self._pending)
        if found:
            return self._told(self._take(found.end()))
        if self._pending and not _BEGUN.fullmatch(self._pending):
            self._refuse(self._take(len(self._pending)))
        return []

    def _told(self, command: bytes) -> list[bytes]:
        letter = command[:1]
        if letter == b"C":
            self.streaming, self._configuring = False, True
        elif not self._allowed(command):
            self._refuse(command)
            return []
        elif letter == b"f":
            self.rate = 1 / (int(command.split(b",")[1]) * _TICK_S)
        elif letter == b"R":
            self.streaming, self._configuring = True, False
        self._obey(command)
        return [b"r,0," + letter + b",0\r\n"]

    def _allowed(self, command: bytes) -> bool:
        """Tell whether it is in the right state, and would not change the form of frames or the line's speed."""
        if not self._configuring:
            return False
        fields = command.split(b",")
        if fields[0] == b"c":
            return fields[3:] == [b"0", _BAUD_CODE]
        return fields[0] == b"R" or int(fields[1]) > 0


class BotaDriver(Driver):
    """A SensONE, Rokubi or MiniONE."""

    scheme, title = "bota", "Bota"
    ways = (Way(Carrier.SERIAL, baud=DEFAULT_BAUD, frame=FRAME_BYTES),)
    rate = 200.0
    emulated = BotaModel
    usb_words = ("bota", "rokubi", "sensone", "minione")

    def sensor(self, address: DeviceAddress) -> SensorDriver:
        """As `Driver`."""
        rate = address.rate or ASSUMED_RATE_HZ
        start = start_commands(rate, baud=address.baud or DEFAULT_BAUD)
        return SensorDriver(BotaParser(rate), start, stop_commands(), rate)
