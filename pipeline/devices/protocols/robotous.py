"""
Robotous RFT series on a serial line.

A frame of 19 bytes: 55, a data field of 16 bytes, the sum of the field modulo 256, AA. The field: 0B, six int16 (big
endian; counts, see below), a byte of overload (bit 5 is fx, bit 0 mz), two unused. Source: Robotous, "RFT Series
Installation and Operation Manual" 1.1, section 3; the maker's sample code (RFT_IF_PACKET 1.2) for the byte order. A
count is 1/50 N and, by model, 1/2000 or 1/1000 N·m. There is no count of frames.

The stream's own rate (200 Hz when new) is a setting that stays, and so is never sent; nor is the bias.

In random bytes a false frame comes once in 2^32 bytes.
"""

import struct
from collections.abc import Mapping
from typing import ClassVar

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.faults import FrameMoment, SensorReading, Six
from contactbench.pipeline.devices.options import Option, number
from contactbench.pipeline.devices.protocols.checksums import sum8
from contactbench.pipeline.devices.protocols.commands import Command
from contactbench.pipeline.devices.protocols.device_model import SENSOR_FAULTS, Model
from contactbench.pipeline.devices.protocols.parser import FrameParser, SensorDriver
from contactbench.pipeline.devices.protocols.scanner import FrameScanner
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import message

FRAME_BYTES = 19
RATE = 200.0
PER_NEWTON, PER_NEWTON_METRE = 50.0, 2000.0
_FRAME = struct.Struct(">2x6hB4x")
_BEGIN, _END = b"\x55", b"\xaa"
_STREAM, _HALT = 0x0B, 0x0C
_LARGEST = 32_767


class RobotousParser(FrameParser):
    """
    For the RFT's stream.

    Parameters
    ----------
    per_newton, per_newton_metre : float
        Counts, by the model's data sheet.
    """

    repeats = True

    def __init__(self, per_newton: float = PER_NEWTON, per_newton_metre: float = PER_NEWTON_METRE) -> None:
        super().__init__(FrameScanner(_BEGIN + bytes([_STREAM]), FRAME_BYTES, _intact))
        self._force, self._torque = per_newton, per_newton_metre

    def _read(self, frame: bytes, time: float) -> list[WrenchSample]:
        fx, fy, fz, mx, my, mz, overload = _FRAME.unpack(frame)
        force = (fx / self._force, fy / self._force, fz / self._force)
        torque = (mx / self._torque, my / self._torque, mz / self._torque)
        return [WrenchSample(time, force, torque, status=Status.OVERRANGE if overload & 0x3F else Status.OK)]


def _intact(frame: bytes) -> bool:
    return frame.endswith(_END) and sum8(frame[1:-2]) == frame[-2]


def _command(kind: int) -> bytes:
    field = bytes([kind]) + bytes(7)
    return _BEGIN + field + bytes([sum8(field)]) + _END


# ---- emulated: an RFT ----------------------------------------------------------------------------


def robotous_frame(values: Six, *, overload: int = 0) -> bytes:
    """Return one frame: N, N·m, the byte of overload."""
    scales = (PER_NEWTON,) * 3 + (PER_NEWTON_METRE,) * 3
    counts = [max(-_LARGEST - 1, min(_LARGEST, round(v * k))) for v, k in zip(values, scales, strict=True)]
    field = struct.pack(">B6hB2x", _STREAM, *counts, overload)
    return _BEGIN + field + bytes([sum8(field)]) + _END


class RobotousModel(Model):
    """An RFT."""

    name = "robotous"
    own_rate = RATE
    faults = SENSOR_FAULTS
    trap: ClassVar[Six | None] = (0x550B / PER_NEWTON,) * 3 + (0x550B / PER_NEWTON_METRE,) * 3
    full_scale: ClassVar[Six | None] = (150.0, 150.0, 200.0, 4.0, 4.0, 4.0)

    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:  # noqa: ARG002 - it has no count
        """Return one frame."""
        return robotous_frame(reading.values, overload=0x3F if reading.saturated else 0)

    def damaged(self, frame: bytes) -> bytes:
        """Return the frame with a wrong checksum."""
        return frame[:-2] + bytes([frame[-2] ^ 0x5A]) + _END

    def _step(self) -> list[bytes]:
        return self._told_to_stream(_command(_STREAM), _command(_HALT))


class RobotousDriver(Driver):
    """An RFT."""

    scheme, title = "robotous", "Robotous RFT"
    ways = (Way(Carrier.SERIAL, baud=115_200, frame=FRAME_BYTES),)
    options: ClassVar[Mapping[str, Option]] = {
        "cpf": Option("Counts per N, by the data sheet.", number(message("counts per N")), PER_NEWTON),
        "cpt": Option(
            "Counts per N·m, by the data sheet: 2000 or 1000.",
            number(message("counts per N·m")),
            PER_NEWTON_METRE,
        ),
    }
    emulated = RobotousModel
    usb_words = ("robotous",)

    def sensor(self, address: DeviceAddress) -> SensorDriver:
        """As `Driver`; the sensor streams at the rate that it is set to."""
        cpf, cpt = address.options["cpf"], address.options["cpt"]
        return SensorDriver(
            RobotousParser(cpf, cpt),
            (Command(_command(_STREAM)),),
            (Command(_command(_HALT)),),
            address.rate or RATE,
            rate_known=address.rate is not None,
            limits=(_LARGEST / cpf, _LARGEST / cpt),
        )
