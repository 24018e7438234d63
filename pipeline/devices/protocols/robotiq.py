"""
Robotiq FT 300 and FT 300-S, the stream on their serial line.

A frame of 16 bytes: 20 4E, six int16 (little endian; 0.01 N and 0.001 N·m), CRC-16/MODBUS of all before
itself. There is no count, so lost frames show only as a gap in time.

In random bytes a false frame comes once in 2^32 bytes.
"""

from __future__ import annotations

import struct

from contactbench.pipeline.devices.protocols.checksums import crc16_modbus
from contactbench.pipeline.devices.protocols.commands import Command, check_rate
from contactbench.pipeline.devices.protocols.parser import Counters
from contactbench.pipeline.devices.protocols.scanner import FrameScanner
from contactbench.pipeline.devices.sample import WrenchSample

FRAME_BYTES = 16
RATE = 100.0
_FRAME = struct.Struct("<2x6h2x")
_FORCE_SCALE, _TORQUE_SCALE = 100.0, 1000.0

# Modbus: slave 9, write one register (410) with 0x0200, "stream".
_START = bytes.fromhex("09 10 01 9A 00 01 02 02 00 CD CA")
_STARTED = bytes.fromhex("09 10 01 9A 00 01 21 52")
# Half a second of these at 19200 baud is what the manual asks for.
_STOP = b"\xff" * 50
# They take 26 ms on the line; a request begins after 3.5 characters of silence, and converters add some time.
_SETTLE_S = 0.1


class RobotiqParser:
    """`SensorParser` for the FT 300's stream."""

    def __init__(self) -> None:
        self._scanner = FrameScanner(b"\x20\x4e", FRAME_BYTES, _intact)

    @property
    def counters(self) -> Counters:
        """As `SensorParser`."""
        scanner = self._scanner
        return Counters(
            frames=scanner.frames,
            bad_checksums=scanner.bad_checksums,
            skipped_bytes=scanner.skipped_bytes,
        )

    @property
    def pending(self) -> int:
        """As `SensorParser`."""
        return self._scanner.pending

    def feed(self, data: bytes, time: float) -> list[WrenchSample]:
        """As `SensorParser`."""
        return [_read(frame, time) for frame in self._scanner.push(data)]

    def reset(self) -> None:
        """As `SensorParser`."""
        self._scanner.reset()


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


def _read(frame: bytes, time: float) -> WrenchSample:
    fx, fy, fz, mx, my, mz = _FRAME.unpack(frame)
    return WrenchSample(
        time,
        (fx / _FORCE_SCALE, fy / _FORCE_SCALE, fz / _FORCE_SCALE),
        (mx / _TORQUE_SCALE, my / _TORQUE_SCALE, mz / _TORQUE_SCALE),
    )
