"""Frames to try the parsers with: intact ones, and how often chance makes a false one."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactbench.pipeline.devices.protocols import bota, robotiq
from contactbench.pipeline.devices.protocols.bota import BotaParser
from contactbench.pipeline.devices.protocols.checksums import crc16_modbus, crc16_x25, sum8
from contactbench.pipeline.devices.protocols.rdt import ATI_TYPICAL, RECORD_BYTES, RdtParser
from contactbench.pipeline.devices.protocols.robotiq import RobotiqParser
from contactbench.pipeline.devices.protocols.sri import Layout, SriParser, Trailer

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.devices.protocols.parser import SensorParser

_LAYOUTS = {Trailer.SUM: Layout(Trailer.SUM), Trailer.CRC32: Layout(Trailer.CRC32)}


@dataclass(frozen=True, slots=True)
class Subject:
    """One sensor protocol under trial."""

    parser: Callable[[], SensorParser]  # Makes a fresh parser
    # Makes an intact frame from its number and 24 bytes of payload (Robotiq takes the first 12)
    frame: Callable[[int, bytes], bytes]
    frame_bytes: int  # Length of a frame, and where in it the payload begins
    payload_at: int  # Length of a frame, and where in it the payload begins
    payload_bytes: int
    # A false frame begins at one place in 2 to this power of random bytes; None without a checksum
    false_bits: int | None


def _sri(number: int, payload: bytes, trailer: Trailer) -> bytes:
    head = struct.pack(">HHH", 0xAA55, _LAYOUTS[trailer].package_length, number & 0xFFFF)
    if trailer is Trailer.SUM:
        return head + payload + bytes([sum8(payload)])
    return head + payload + struct.pack("<I", zlib.crc32(payload))


def _sri_sum(number: int, payload: bytes) -> bytes:
    return _sri(number, payload, Trailer.SUM)


def _sri_crc(number: int, payload: bytes) -> bytes:
    return _sri(number, payload, Trailer.CRC32)


def _bota(number: int, payload: bytes) -> bytes:
    body = bytes(2) + payload + struct.pack("<If", number * 1000 & 0xFFFFFFFF, 31.5)
    return b"\xaa" + body + struct.pack("<H", crc16_x25(body))


def _robotiq(number: int, payload: bytes) -> bytes:  # noqa: ARG001 (the protocol has no number)
    body = b"\x20\x4e" + payload[:12]
    return body + struct.pack("<H", crc16_modbus(body))


def _rdt(number: int, payload: bytes) -> bytes:
    return struct.pack(">3I", number & 0xFFFFFFFF, number & 0xFFFFFFFF, 0) + payload


SUBJECTS = {
    "sri": Subject(SriParser, _sri_sum, frame_bytes=31, payload_at=6, payload_bytes=24, false_bits=40),
    "sri-crc32": Subject(
        lambda: SriParser(_LAYOUTS[Trailer.CRC32]),
        _sri_crc,
        frame_bytes=34,
        payload_at=6,
        payload_bytes=24,
        false_bits=64,
    ),
    "bota": Subject(
        BotaParser, _bota, frame_bytes=bota.FRAME_BYTES, payload_at=3, payload_bytes=24, false_bits=24
    ),
    "robotiq": Subject(
        RobotiqParser,
        _robotiq,
        frame_bytes=robotiq.FRAME_BYTES,
        payload_at=2,
        payload_bytes=12,
        false_bits=32,
    ),
    "rdt": Subject(
        lambda: RdtParser(ATI_TYPICAL),
        _rdt,
        frame_bytes=RECORD_BYTES,
        payload_at=12,
        payload_bytes=24,
        false_bits=None,
    ),
}
