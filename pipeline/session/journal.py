"""The journal file: read by anyone, appended to by one, every record on the disk before it is acknowledged.

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
import os
import stat
import struct
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contactbench.pipeline.errors import CUT_OFF, SALVAGE, InputError, arg, message

JOURNAL = "journal"
LARGEST = 256 * 2**20
_BINARY = getattr(os, "O_BINARY", 0)


def read_journal(folder: Path) -> bytes:
    """
    Return the journal's bytes as they are now.

    Raises
    ------
    SessionError
        There is none, it cannot be read, or it is far too large.
    """
    file = folder / JOURNAL
    try:
        # A pipe would be waited for; a link leads out of the session.
        if not stat.S_ISREG(file.lstat().st_mode):
            raise JournalError(f"{arg(file)}: not a regular file: choose a session folder.")
        with file.open("rb") as stream:
            data = stream.read(LARGEST + 1)
    except FileNotFoundError:
        raise SessionError(
            f"{arg(folder)}: this folder is not a session: check the path, or create a new one."
        ) from None
    except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
        if isinstance(error, SessionError):
            raise
        raise SessionError(
            f"{arg(file)}: the journal cannot be read ({arg(error)}): choose a session folder."
        ) from error
    if len(data) > LARGEST:
        raise SessionError(f"{arg(file)}: larger than {arg(LARGEST >> 20)} MiB: start a new session.")
    return data


def refuse_damage(folder: Path, found: Scan) -> None:
    """Raise JournalError for damage that no crash explains."""
    if found.damage:
        remedy = CUT_OFF if found.last else SALVAGE
        raise JournalError(f"{arg(folder / JOURNAL)}: {arg(found.damage)}: {arg(remedy)}.")
    if not found.frames:
        raise JournalError(
            f"{arg(folder / JOURNAL)}: no intact record: restore the session from an archive or a backup."
        )


class JournalWriter:
    """
    Appends records. Whoever has one holds the session's lock.

    A write that fails is taken back, and the writer refuses all that follows until `mend`: after a failed fsync
    nobody knows what the disk holds, and only reading it again tells.

    Parameters
    ----------
    folder : path
        Of the session.
    found : Scan
        What the journal holds; behind it the file is cut.
    """

    def __init__(self, folder: Path, found: Scan) -> None:
        self._file = folder / JOURNAL
        self._end, self._chain = found.end, found.chain
        self.broken = self._foreign = False  # Whether a write has failed, and nothing was mended since
        self._open()

    def _open(self) -> None:
        try:
            self._descriptor = os.open(
                self._file, os.O_RDWR | os.O_APPEND | _BINARY | getattr(os, "O_NOFOLLOW", 0)
            )
        except OSError as error:
            raise SessionError(
                f"{arg(self._file)}: the journal cannot be written ({arg(error)}): check the permissions."
            ) from error
        try:
            if os.fstat(self._descriptor).st_size != self._end:
                os.ftruncate(self._descriptor, self._end)
                os.fsync(self._descriptor)
        except OSError as error:
            self.close()
            raise SessionError(
                f"{arg(self._file)}: the unfinished record cannot be cut off ({arg(error)})."
            ) from error

    def mend(self) -> None:
        """
        Go on after a write that failed: read again what was acknowledged, and cut off what may lie behind it.

        Raises
        ------
        SessionError
            The journal is not what was acknowledged, or the disk still fails; all that follows stays refused.
        """
        if self._foreign:
            raise self._changed()
        data = read_journal(self._file.parent)
        found = scan(data[: self._end])
        if found.end != self._end or found.chain != self._chain:
            self._foreign = True
            raise self._changed()
        self.close()
        self._open()
        self.broken = False

    def append(self, payload: bytes) -> bytes:
        """
        Put a record on the disk; return its hash once it is there.

        Raises
        ------
        SessionError
            It is not there, or nobody knows: see `mend`. What was acknowledged before is there.
        """
        if self._descriptor < 0 or self.broken:
            raise SessionError(f"{arg(self._file)}: closed, or an earlier write failed: reload the session.")
        self._refuse_others()
        data = encode(payload, self._chain)
        if self._end + len(data) > LARGEST:
            raise SessionError(
                f"{arg(self._file)}: the journal is full ({arg(LARGEST >> 20)} MiB): start a new session."
            )
        try:
            write_all(self._descriptor, data)
            os.fsync(self._descriptor)
        except BaseException as error:
            self._take_back()
            if not isinstance(error, OSError):
                raise
            raise SessionError(
                f"{arg(self._file)}: the action was not recorded ({arg(error)}): free disk space or check"
                " the disk, then repeat it. Everything recorded before is safe."
            ) from error
        self._chain = chained(self._chain, payload)
        self._end += len(data)
        return self._chain

    def _refuse_others(self) -> None:
        """Whatever locks say: a record goes only behind the one that it is bound to."""
        try:
            mine, there = os.fstat(self._descriptor), self._file.lstat()
            same = os.path.samestat(mine, there) and mine.st_size == self._end
        except OSError:
            same = False
        if not same:
            self.broken = self._foreign = True
            raise self._changed()

    def _changed(self) -> SessionError:
        return SessionError(
            f"{arg(self._file)}: another program changed the journal, so the action was not recorded:"
            " reload the session."
        )

    def _take_back(self) -> None:
        self.broken = True
        try:
            os.ftruncate(self._descriptor, self._end)
            os.fsync(self._descriptor)
        except OSError:  # what is left is whole, or a torn tail: reading tells
            return

    def close(self) -> None:
        """Close the file; a second time does nothing."""
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1


def write_all(descriptor: int, data: bytes) -> None:
    """Write all of it: one call may write a part."""
    rest = memoryview(data)
    while rest:
        rest = rest[os.write(descriptor, rest) :]


# ---- the journal's bytes -------------------------------------------------------------------------


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


# ---- what the session raises ---------------------------------------------------------------------


class SessionError(InputError):
    """A session that cannot be used as asked: names what is wrong, where, and the remedy."""


class JournalError(SessionError):
    """A journal with damage that is not a torn tail, or with records that cannot be."""


class SchemaError(SessionError):
    """A session of a newer version, or of an older one that nothing here can migrate."""


class SessionLockedError(SessionError):
    """Another process writes this session."""


class SessionReadOnlyError(SessionError):
    """A session that this user or this disk does not let anybody write; it can be read."""


class ArchiveError(SessionError):
    """A zip file that holds no session, or one that must not be unpacked."""
