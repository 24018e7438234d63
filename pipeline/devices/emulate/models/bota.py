"""Bota sensors on a serial line: one-letter commands without line ends, frames with clock and temperature."""

from __future__ import annotations

import re
import struct
from typing import TYPE_CHECKING, ClassVar

from contactbench.pipeline.devices.emulate.checksums import crc16_x25
from contactbench.pipeline.devices.emulate.models.model import SENSOR_FAULTS, Model, Quirk
from contactbench.pipeline.devices.emulate.script import Fault

if TYPE_CHECKING:
    from collections.abc import Iterable

    from contactbench.pipeline.devices.emulate.signals import Moment, Reading, Six

_TRAP = struct.unpack("<f", b"\xaa\x00\x00\xaa")[0]
_TICK_S = 0.00001953125  # of the sinc filter
_OVERRANGE = 2
_WHOLE = re.compile(rb"C|R|c,\d,\d,\d,\d|f,\d{2,4},\d,\d,\d")
_BEGUN = re.compile(rb"c(,(\d(,(\d(,(\d,?)?)?)?)?)?)?|f(,(\d{1,4}(,(\d(,(\d,?)?)?)?)?)?)?")
_BAUD_CODE = b"4"  # 460800 bit/s


def bota_frame(values: Six, *, status: int = 0, microseconds: int = 0, temperature: float = 25.0) -> bytes:
    """Return one frame: N, N·m, the status word, the clock modulo 2**32, degrees Celsius."""
    body = struct.pack("<H6fIf", status, *values, microseconds % 2**32, temperature)
    return b"\xaa" + body + struct.pack("<H", crc16_x25(body))


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

    def frame(self, reading: Reading, moment: Moment) -> bytes:
        """Return one frame."""
        return bota_frame(
            reading.values,
            status=_OVERRANGE if reading.saturated else 0,
            microseconds=round(moment.clock * 1e6),
            temperature=reading.temperature,
        )

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
