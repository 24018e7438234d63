"""Checksums as the devices compute them, written without tables: an emulator is to be read, not fast."""


def crc16_modbus(data: bytes) -> int:
    """Return CRC-16/MODBUS: polynomial 0x8005 reflected, start 0xFFFF; of "123456789" 0x4B37."""
    return _reflected(data, 0xA001)


def crc16_x25(data: bytes) -> int:
    """Return CRC-16/X-25: polynomial 0x1021 reflected, start and final 0xFFFF; of "123456789" 0x906E."""
    return _reflected(data, 0x8408) ^ 0xFFFF


def _reflected(data: bytes, polynomial: int) -> int:
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ polynomial if crc & 1 else crc >> 1
    return crc
