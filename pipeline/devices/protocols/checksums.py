"""The checksums of the wire protocols."""

import binascii

_REFLECTED = bytes(int(f"{byte:08b}"[::-1], 2) for byte in range(256))


def sum8(data: bytes) -> int:
    """Return the sum of the bytes modulo 256."""
    return sum(data) & 0xFF


def crc16_x25(data: bytes) -> int:
    """
    Return CRC-16/X-25: polynomial 0x1021 reflected, start 0xFFFF, output inverted.

    The check value, of b"123456789", is 0x906E.
    """
    # The standard library has the same polynomial unreflected, in C: mirror what goes in and what comes out.
    crc = binascii.crc_hqx(data.translate(_REFLECTED), 0xFFFF)
    return (_REFLECTED[crc & 0xFF] << 8 | _REFLECTED[crc >> 8]) ^ 0xFFFF


def _modbus_entry(byte: int) -> int:
    for _ in range(8):
        byte = byte >> 1 ^ (0xA001 if byte & 1 else 0)
    return byte


_MODBUS = tuple(_modbus_entry(byte) for byte in range(256))


def crc16_modbus(data: bytes) -> int:
    """
    Return CRC-16/MODBUS: polynomial 0x8005 reflected, start 0xFFFF.

    The check value, of b"123456789", is 0x4B37.
    """
    crc = 0xFFFF
    for byte in data:
        crc = crc >> 8 ^ _MODBUS[(crc ^ byte) & 0xFF]
    return crc


def _ecma_entry(byte: int) -> int:
    crc = byte << 56
    for _ in range(8):
        crc = (crc << 1 ^ (0x42F0E1EBA9EA3693 if crc >> 63 else 0)) & 0xFFFF_FFFF_FFFF_FFFF
    return crc


_ECMA = tuple(map(_ecma_entry, range(256)))


def crc64_ecma(data: bytes) -> int:
    """
    Return CRC-64/ECMA-182: polynomial 0x42F0E1EBA9EA3693, start 0.

    The check value, of b"123456789", is 0x6C40DF5F0B497347.
    """
    crc = 0
    for byte in data:
        crc = (crc & 0x00FF_FFFF_FFFF_FFFF) << 8 ^ _ECMA[crc >> 56 ^ byte]
    return crc
