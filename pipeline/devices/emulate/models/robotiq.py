"""Robotiq FT 300: a Modbus slave that streams small frames once a register is set."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING, ClassVar

from contactbench.pipeline.devices.emulate.checksums import crc16_modbus
from contactbench.pipeline.devices.emulate.models.model import Model, Quirk

if TYPE_CHECKING:
    from collections.abc import Iterable

    from contactbench.pipeline.devices.emulate.signals import Moment, Reading, Six

_SLAVE, _READ, _WRITE = 9, 3, 16
_START = bytes.fromhex("09 10 01 9A 00 01 02 02 00")
_STARTED = bytes.fromhex("09 10 01 9A 00 01")
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

    def frame(self, reading: Reading, moment: Moment) -> bytes:  # noqa: ARG002 - it has no clock
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
        if body == _START:
            self._obey(request)
            self.streaming = True
            return [_with_crc(_STARTED)]
        count = int.from_bytes(body[4:6], "big")
        if body[:2] == bytes([_SLAVE, _READ]) and 1 <= count <= 125:
            self._obey(request)
            return [_with_crc(bytes([_SLAVE, _READ, 2 * count]) + bytes(2 * count))]
        self._refuse(request)
        return [_with_crc(bytes([_SLAVE, body[1] | 0x80, 1]))]
