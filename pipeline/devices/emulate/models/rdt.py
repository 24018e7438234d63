"""RDT over UDP: ATI Net F/T and OnRobot, which differ in scale and in two commands."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING, ClassVar

from contactbench.pipeline.devices.emulate.models.model import SENSOR_FAULTS, Model, Quirk
from contactbench.pipeline.devices.emulate.script import EmulatorError, Fault
from contactbench.pipeline.devices.url import PROFILES

if TYPE_CHECKING:
    from collections.abc import Iterable

    from contactbench.pipeline.devices.emulate.signals import Moment, Reading, Six

_MAGIC, _REQUEST = 0x1234, 8
_STOP, _START, _FILTER, _SPEED = 0x0000, 0x0002, 0x0081, 0x0082
_SATURATED = 0x8000_0002
_INT32 = 2**31


def rdt_record(
    values: Six, scale: tuple[float, float], *, sequence: int = 1, ft_sequence: int = 1, status: int = 0
) -> bytes:
    """Return one record of 36 bytes.

    Parameters
    ----------
    values : six floats
        N, N·m.
    scale : (counts per N, counts per N·m)
    sequence, ft_sequence : int
        Of the record and of the sensor's clock, modulo 2**32.
    status : int
        0: no error.
    """
    factors = (scale[0],) * 3 + (scale[1],) * 3
    counts = [max(-_INT32, min(_INT32 - 1, round(v * k))) for v, k in zip(values, factors, strict=True)]
    return struct.pack(">3I6i", sequence % 2**32, ft_sequence % 2**32, status, *counts)


class RdtModel(Model):
    """A box that speaks RDT.

    Parameters
    ----------
    rate : float or None
    profile : str
        "ati" or "onrobot".
    """

    name = "rdt"
    own_rate = 500.0
    faults = (SENSOR_FAULTS - {Fault.HEADER}) | {Fault.CLOCK_JUMP}
    full_scale: ClassVar[Six | None] = (150.0, 150.0, 300.0, 15.0, 15.0, 15.0)

    def __init__(
        self, rate: float | None = None, profile: str = "ati", quirks: Iterable[Quirk | str] = ()
    ) -> None:
        super().__init__(rate, quirks)
        if profile not in PROFILES:
            raise EmulatorError(f"profile {profile!r}: choose one of {', '.join(PROFILES)}.")
        self.scale = PROFILES[profile]
        self._onrobot = profile == "onrobot"
        self._left: int | None = None

    def feed(self, data: bytes, silence: float = math.inf) -> list[bytes]:  # noqa: ARG002 - datagrams stay apart
        """Take one datagram; there are no answers but the records."""
        if len(data) != _REQUEST or data[:2] != _MAGIC.to_bytes(2, "big"):
            self._refuse(data)
            return []
        command, count = struct.unpack(">HI", data[2:])
        if command == _START:
            self.streaming, self._left = True, count or None
        elif command == _STOP:
            self.streaming = False
        elif self._onrobot and command == _SPEED and count:
            self.rate = 1000 / count
        elif not (self._onrobot and command == _FILTER):
            self._refuse(data)
            return []
        self._obey(data)
        return []

    def frame(self, reading: Reading, moment: Moment) -> bytes:
        """Return one record; it stops by itself after as many as were asked for."""
        if self._left is not None:
            self._left -= 1
            self.streaming = self._left > 0
        return rdt_record(
            reading.values,
            self.scale,
            sequence=moment.number + 1,
            ft_sequence=moment.number + 1 + round(moment.jump * self.rate),
            status=_SATURATED if reading.saturated else 0,
        )

    def damaged(self, frame: bytes) -> bytes:
        """Return the record cut short by a byte: it has no checksum of its own."""
        return frame[:-1]

    def _step(self) -> list[bytes]:
        return []
