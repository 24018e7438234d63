"""Checksums against their published check values, and against bit-by-bit references."""

from __future__ import annotations

import zlib

from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.devices.protocols.checksums import crc16_modbus, crc16_x25, sum8

_CHECK = b"123456789"


def reflected_crc(data: bytes, polynomial: int, start: int) -> int:
    crc = start
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (polynomial if crc & 1 else 0)
    return crc


def test_published_check_values() -> None:
    assert crc16_x25(_CHECK) == 0x906E
    assert crc16_modbus(_CHECK) == 0x4B37
    assert zlib.crc32(_CHECK) == 0xCBF43926
    assert sum8(_CHECK) == 0xDD


@given(st.binary(max_size=64))
def test_tables_agree_with_bit_by_bit_division(data: bytes) -> None:
    assert crc16_x25(data) == reflected_crc(data, 0x8408, 0xFFFF) ^ 0xFFFF
    assert crc16_modbus(data) == reflected_crc(data, 0xA001, 0xFFFF)
    assert sum8(data) == sum(data) % 256
