"""
Kunwei KWR75 series on RS-422 or its USB converter.

A frame of 28 bytes: 48 AA, six float32 (little endian; kg and kg·m, that is kgf and kgf·m), 0D 0A. Source: Kunwei,
"KWR75 Series - RS422 Communication, Six Axis Force Sensors User Manual" (21.6.75.11.4LA), sections 4.6 and 4.7, which
has the frame of the tests. There is neither count nor checksum: a damaged number that is still a possible one is not
seen. The manual has no Ethernet version; 47 AA 0D 0A, which zeroes it, is never sent.

In random bytes a false frame comes once in 2^32 bytes.
"""

import struct
from typing import ClassVar

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.faults import Fault, FrameMoment, SensorReading, Six
from contactbench.pipeline.devices.protocols.commands import Command, check_line, check_rate
from contactbench.pipeline.devices.protocols.device_model import SENSOR_FAULTS, Model
from contactbench.pipeline.devices.protocols.parser import FrameParser, SensorDriver
from contactbench.pipeline.devices.protocols.scanner import FrameScanner
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.units import FORCES, TORQUES

FRAME_BYTES = 28
RATE = 1000.0
BAUD = 460_800
_FRAME = struct.Struct("<2x6f2x")
_HEADER, _END = b"\x48\xaa", b"\x0d\x0a"
_START, _STOP = b"\x48\xaa\x0d\x0a", b"\x43\xaa\x0d\x0a"
_NEWTON, _NEWTON_METRE = FORCES["kgf"], TORQUES["kgfm"]
_ABSURD = 1e4  # kg or kg·m: ten times the largest sensor


class KunweiParser(FrameParser):
    """For the KWR75's stream."""

    repeats = True

    def __init__(self) -> None:
        super().__init__(FrameScanner(_HEADER, FRAME_BYTES, _intact))

    def _read(self, frame: bytes, time: float) -> list[WrenchSample]:
        fx, fy, fz, mx, my, mz = _FRAME.unpack(frame)
        force = (fx * _NEWTON, fy * _NEWTON, fz * _NEWTON)
        return [WrenchSample(time, force, (mx * _NEWTON_METRE, my * _NEWTON_METRE, mz * _NEWTON_METRE))]


def _intact(frame: bytes) -> bool:
    return frame.endswith(_END) and all(abs(value) < _ABSURD for value in _FRAME.unpack(frame))


# ---- emulated: a KWR75 ---------------------------------------------------------------------------


def kunwei_frame(values: Six) -> bytes:
    """Return one frame: N, N·m."""
    scales = (_NEWTON,) * 3 + (_NEWTON_METRE,) * 3
    return _HEADER + struct.pack("<6f", *(v / k for v, k in zip(values, scales, strict=True))) + _END


class KunweiModel(Model):
    """A KWR75."""

    name = "kunwei"
    own_rate = RATE
    faults = SENSOR_FAULTS - {Fault.SATURATION}
    # 48 AA as the beginning of a float.
    trap: ClassVar[Six | None] = tuple(
        struct.unpack("<f", _HEADER + b"\x0d\x41")[0] * k for k in (_NEWTON,) * 3 + (_NEWTON_METRE,) * 3
    )

    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:  # noqa: ARG002 - it has no count
        """Return one frame."""
        return kunwei_frame(reading.values)

    def damaged(self, frame: bytes) -> bytes:
        """Return the frame with another end: it has no checksum."""
        return frame[:-1] + b"\x00"

    def _step(self) -> list[bytes]:
        return self._told_to_stream(_START, _STOP)


class KunweiDriver(Driver):
    """A KWR75."""

    scheme, title = "kunwei", "Kunwei KWR75"
    ways = (Way(Carrier.SERIAL, baud=BAUD, frame=FRAME_BYTES),)
    rate = RATE
    emulated = KunweiModel
    usb_words = ("kunwei",)

    def sensor(self, address: DeviceAddress) -> SensorDriver:
        """As `Driver`."""
        rate = check_rate("Kunwei", address.rate or RATE, 1.0, RATE)
        check_line("Kunwei", rate, address.baud, FRAME_BYTES)
        return SensorDriver(KunweiParser(), (Command(_START),), (Command(_STOP),), rate)
