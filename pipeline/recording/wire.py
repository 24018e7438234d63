"""MCAP records as bytes: the few that recordings need, and their numbers."""

import struct
from collections.abc import Mapping
from enum import IntEnum

from contactbench.pipeline.errors import arg, message

MAGIC = b"\x89MCAP0\r\n"
PREFIX = struct.Struct("<BQ")  # opcode, length of what follows
MESSAGE_HEAD = struct.Struct("<HIQQ")  # channel, sequence, log time, publish time


class Opcode(IntEnum):
    """Kinds of records, as the MCAP specification numbers them."""

    HEADER = 1
    FOOTER = 2
    SCHEMA = 3
    CHANNEL = 4
    MESSAGE = 5
    CHUNK = 6
    MESSAGE_INDEX = 7
    CHUNK_INDEX = 8
    STATISTICS = 11
    METADATA = 12
    METADATA_INDEX = 13
    SUMMARY_OFFSET = 14
    DATA_END = 15


def record(opcode: Opcode, payload: bytes) -> bytes:
    """Return a whole record."""
    return PREFIX.pack(opcode, len(payload)) + payload


def text(value: str) -> bytes:
    """Return a string as MCAP stores it; what is no text, in the name of a file, as an escape."""
    data = value.encode("utf-8", "backslashreplace")
    return struct.pack("<I", len(data)) + data


def mapping(values: Mapping[str, str]) -> bytes:
    """Return a map of strings as MCAP stores it."""
    data = b"".join(text(key) + text(value) for key, value in values.items())
    return struct.pack("<I", len(data)) + data


class Cursor:
    """
    Take fields off the front of a record, and never more than there is.

    Parameters
    ----------
    data : bytes
        What follows a record's length.

    Raises
    ------
    ValueError
        By every method: the field reaches past the end, or is not UTF-8.
    """

    def __init__(self, data: bytes) -> None:
        self._data = memoryview(data)
        self._at = 0

    @property
    def left(self) -> int:
        """Bytes not taken yet."""
        return len(self._data) - self._at

    def take(self, length: int) -> bytes:
        """Return the next `length` bytes."""
        if length > self.left:
            raise ValueError(message(f"a field of {arg(length):,} bytes in {arg(self.left):,} that are left"))
        begin, self._at = self._at, self._at + length
        return bytes(self._data[begin : self._at])

    def number(self, size: int) -> int:
        """Return an unsigned number of `size` bytes."""
        return int.from_bytes(self.take(size), "little")

    def text(self) -> str:
        """Return a string."""
        return self.take(self.number(4)).decode()

    def mapping(self) -> dict[str, str]:
        """Return a map of strings."""
        inner = Cursor(self.take(self.number(4)))
        values = {}
        while inner.left:
            key = inner.text()
            values[key] = inner.text()
        return values
