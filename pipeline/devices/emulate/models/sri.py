"""SRI M8128 interface box: ASCII commands, frames of little-endian floats with a sum or a CRC-32."""

from __future__ import annotations

import re
import struct
import zlib
from typing import TYPE_CHECKING, ClassVar

from contactbench.pipeline.devices.emulate.models.model import SENSOR_FAULTS, Model, Quirk
from contactbench.pipeline.devices.emulate.script import Fault

if TYPE_CHECKING:
    from collections.abc import Iterable

    from contactbench.pipeline.devices.emulate.signals import Moment, Reading, Six

_TRAP = struct.unpack("<f", b"\xaa\x55\x00\x1b")[0]  # header and length, a float of 1e-22
_CHANNELS = re.compile(rb"\(A01,A02,A03,A04,A05,A06\);E;1;\(WMA:\d+\)")
_BUSY_S = 0.002
_READ_ONLY = (b"EIP", b"ETPT", b"AMPZ", b"CHNAPG", b"EXMV", b"DCPCU", b"DCPM", b"UARTCFG")


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
    full_scale: ClassVar[Six | None] = (150.0, 150.0, 300.0, 15.0, 15.0, 15.0)
    possible_quirks: ClassVar[frozenset[Quirk]] = frozenset(
        {Quirk.OLDER, Quirk.CRC32_ONLY, Quirk.CRC32_SILENTLY, Quirk.ANSWERS_START, Quirk.FORGIVING}
    )

    def __init__(self, rate: float | None = None, quirks: Iterable[Quirk | str] = ()) -> None:
        super().__init__(rate, quirks)
        self._never_sum = bool(self.quirks & {Quirk.CRC32_ONLY, Quirk.CRC32_SILENTLY})
        self._crc32 = self._never_sum
        self.busy = 0.0 if Quirk.FORGIVING in self.quirks else _BUSY_S

    def frame(self, reading: Reading, moment: Moment) -> bytes:
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
        known = {
            self._rate_name: b"%d" % self.rate,
            b"DCKMD": b"CRC32" if self._crc32 else b"SUM",
        }
        if name in known:
            return _acknowledged(name, known[name])
        return _acknowledged(name, b"0") if name in _READ_ONLY else None

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
