"""
The journal's bytes: records one after the other, each complete in itself and bound to the one before.

A record is a header of 48 bytes, little endian, and its payload, canonical JSON in ASCII:

======  =====  ==========================================================
offset  bytes  meaning
======  =====  ==========================================================
0       4      magic, ``93 43 42 4A``; its first byte is in no ASCII text
4       4      length of the payload, unsigned
8       4      CRC-32 of the payload
12      32     SHA-256 over the hash of the record before, then the payload
44      4      CRC-32 of the 44 bytes above
48      n      payload
======  =====  ==========================================================

The header has a checksum of its own because of the end of the file: with a length that can be trusted, a record
that was cut off by a crash is told from one that was whole and is damaged. Only the former was never
acknowledged, so only it may be dropped without asking.
"""

from __future__ import annotations

import hashlib
import json
import struct
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.session.errors import JournalError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

MAGIC = b"\x93CBJ"
LONGEST_PAYLOAD = 2**20
GENESIS = bytes(32)  # what comes before the first record

HEADER = struct.Struct("<4sII32sI")
_UNSIGNED_HEADER = struct.Struct("<4sII32s")


@dataclass(frozen=True)
class JournalFrame:
    """One record as it lies in the file."""

    offset: int  # Where it begins, bytes
    payload: bytes
    chain: bytes  # Its hash, 32 bytes

    @property
    def end(self) -> int:
        """Where the next record begins."""
        return self.offset + HEADER.size + len(self.payload)


@dataclass(frozen=True)
class Scan:
    """What a journal holds."""

    frames: tuple[JournalFrame, ...]  # The whole and correctly chained records from the start
    end: int  # Where the last of them ends, bytes
    torn: str = ""  # What is said of a record at the end that was never finished; empty if there is none
    damage: str = ""  # What is said of damage that no crash explains; empty if there is none
    last: bool = False  # The damage is at the end: no whole record follows it

    @property
    def chain(self) -> bytes:
        """The hash that the next record is bound to."""
        return self.frames[-1].chain if self.frames else GENESIS


def canonical(value: Mapping[str, Any]) -> bytes:
    """
    Write JSON in the one way that hashes are made of: sorted keys, no spaces, ASCII.

    Raises
    ------
    JournalError
        It holds what JSON cannot (NaN, infinity, other objects).
    """
    try:
        return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False).encode("ascii")
    except (ValueError, TypeError, RecursionError) as error:
        raise JournalError(
            f"this cannot be written to a journal ({arg(error)}): give finite numbers, texts or lists."
        ) from error


def encode(payload: bytes, before: bytes) -> bytes:
    """
    Return the bytes of a record that follows the one with the hash `before`.

    Raises
    ------
    JournalError
        The payload is empty or too long.
    """
    if not 0 < len(payload) <= LONGEST_PAYLOAD:
        raise JournalError(
            f"a record of {arg(len(payload))} bytes is too large; the limit is {arg(LONGEST_PAYLOAD)}: put"
            " large data into a file."
        )
    head = _UNSIGNED_HEADER.pack(MAGIC, len(payload), zlib.crc32(payload), chained(before, payload))
    return head + struct.pack("<I", zlib.crc32(head)) + payload


def encode_all(payloads: Iterable[bytes]) -> bytes:
    """Return the bytes of a whole journal."""
    parts, before = [], GENESIS
    for payload in payloads:
        parts.append(encode(payload, before))
        before = chained(before, payload)
    return b"".join(parts)


def chained(before: bytes, payload: bytes) -> bytes:
    """Return the hash of a record, 32 bytes."""
    return hashlib.sha256(before + payload).digest()


def scan(data: bytes) -> Scan:
    """Read all records; stops at the first that is unfinished, damaged or out of the chain."""
    frames: list[JournalFrame] = []
    before, at = GENESIS, 0
    while at < len(data):
        frame = whole(data, at)
        if frame is None:
            return _stopped(data, at, frames)
        if chained(before, frame.payload) != frame.chain:
            damage = message(
                f"record {arg(len(frames) + 1)} at byte {arg(at)} does not follow the one before: records were removed,"
                " inserted or changed"
            )
            return Scan(tuple(frames), at, damage=damage)
        frames.append(frame)
        before, at = frame.chain, frame.end
    return Scan(tuple(frames), at)


def whole(data: bytes, at: int) -> JournalFrame | None:
    """Return the record that begins here, if it is whole and both checksums hold."""
    length = _length(data, at)
    if length is None:
        return None
    begin = at + HEADER.size
    payload = data[begin : begin + length]
    _, _, checksum, chain, _ = HEADER.unpack_from(data, at)
    if len(payload) != length or zlib.crc32(payload) != checksum:
        return None
    return JournalFrame(at, payload, chain)


def _length(data: bytes, at: int) -> int | None:
    """Return the length that a header states, if the header holds."""
    if len(data) - at < HEADER.size:
        return None
    magic, length, _, _, checksum = HEADER.unpack_from(data, at)
    sound = magic == MAGIC and zlib.crc32(data[at : at + _UNSIGNED_HEADER.size]) == checksum
    return length if sound and 0 < length <= LONGEST_PAYLOAD else None


def _stopped(data: bytes, at: int, frames: list[JournalFrame]) -> Scan:
    where = message(f"record {arg(len(frames) + 1)} at byte {arg(at)}")
    follows = next_whole(data, at + 1)
    if follows is None and unfinished(data, at):
        left = len(data) - at
        return Scan(
            tuple(frames),
            at,
            torn=message(f"{arg(where)} was never finished (only {arg(left)} bytes of it exist)"),
        )
    what = message(f"{arg(where)} is damaged: its checksum is wrong")
    if follows is not None:
        what += message(f"; intact records follow from byte {arg(follows)}")
    return Scan(tuple(frames), at, damage=what, last=follows is None)


def unfinished(data: bytes, at: int) -> bool:
    """Tell whether a crash explains what is left: less than a record, or blocks that were never written.

    A file system may make a file longer before it writes the data: then it ends in zeros. No record does.
    """
    length = _length(data, at)
    if len(data) - at < HEADER.size:
        return True
    if length is not None and len(data) < at + HEADER.size + length:
        return not _is_json(data[at + HEADER.size :])
    return data[-1] == 0 and (length is not None or not any(data[at:]))


def _is_json(data: bytes) -> bool:
    """Tell whether it has an end: the beginning of a payload is no JSON, one that lost bytes in its middle may be."""
    try:
        json.loads(data)
    except (ValueError, RecursionError):
        return False
    return True


def next_whole(data: bytes, at: int) -> int | None:
    """Return where the first whole record at or behind a byte begins."""
    while (at := data.find(MAGIC, at)) >= 0:
        if whole(data, at) is not None:
            return at
        at += 1
    return None
