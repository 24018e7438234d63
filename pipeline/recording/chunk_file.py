"""An MCAP file that grows by whole chunks, so that a crash costs at most the last one.

The schemas and channels stand before the first chunk: whatever is cut off later, the rest can be read.
"""

import os
import struct
import zlib
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import zstandard

from contactbench.pipeline.durable import sync_folder
from contactbench.pipeline.errors import RecordingError, arg
from contactbench.pipeline.recording.wire import MAGIC, MESSAGE_HEAD, Opcode, mapping, record, text

_FASTEST = 1  # JSON shrinks to a sixth at any level


class ChunkFile:
    """
    Write an MCAP file: one system call per chunk, a summary at the end.

    Not thread-safe. After a failure the file ends with its last whole chunk and takes nothing more.

    Parameters
    ----------
    path : path
        Must not exist: recordings are never written over.
    library : str
        Who writes.

    Raises
    ------
    RecordingError
        By every method: the file exists, or cannot be written.
    """

    def __init__(self, path: Path, library: str) -> None:
        self._path = path
        self._file: int | None = _create(path)
        self._size = 0
        self._crc = 0
        self._chunk = bytearray()
        self._index: dict[int, bytearray] = {}
        self._span = self._chunk_span = _EMPTY
        self._counts: dict[int, int] = {}
        self._groups: dict[Opcode, bytearray] = {}
        self._tally: dict[Opcode, int] = {}
        self._pack = zstandard.ZstdCompressor(level=_FASTEST)
        try:
            self._append(MAGIC + record(Opcode.HEADER, text("") + text(library)))
        except BaseException:
            self.discard()
            raise

    @property
    def pending(self) -> int:
        """Bytes of messages that are not in the file yet."""
        return len(self._chunk)

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Append a metadata record."""
        data = record(Opcode.METADATA, text(name) + mapping(values))
        place = struct.pack("<QQ", self._size, len(data))
        self._append(data)
        self._summarise(Opcode.METADATA_INDEX, place + text(name))

    def add_schema(self, name: str, schema: bytes) -> int:
        """Append a JSON schema; return its number."""
        number = self._tally.get(Opcode.SCHEMA, 0) + 1
        payload = struct.pack("<H", number) + text(name) + text("jsonschema")
        payload += struct.pack("<I", len(schema)) + schema
        self._append(record(Opcode.SCHEMA, payload))
        self._summarise(Opcode.SCHEMA, payload)
        return number

    def add_channel(self, topic: str, schema: int) -> int:
        """Append a channel of JSON messages; return its number."""
        number = self._tally.get(Opcode.CHANNEL, 0) + 1
        payload = struct.pack("<HH", number, schema) + text(topic) + text("json") + mapping({})
        self._append(record(Opcode.CHANNEL, payload))
        self._summarise(Opcode.CHANNEL, payload)
        self._counts[number] = 0
        return number

    def add_message(self, channel: int, log_time: int, data: bytes) -> None:
        """Put a message into the chunk that is being filled; `log_time` in ns."""
        if self._file is None:
            raise RecordingError(f"{arg(self._path)}: the recording is closed: start a new one.")
        count = self._counts[channel]
        place = struct.pack("<QQ", log_time, len(self._chunk))
        self._index.setdefault(channel, bytearray()).extend(place)
        head = MESSAGE_HEAD.pack(channel, count & 0xFFFFFFFF, log_time, log_time)
        self._chunk += record(Opcode.MESSAGE, head + data)
        self._counts[channel] = count + 1
        self._chunk_span = _widened(self._chunk_span, log_time)

    def finish_chunk(self) -> None:
        """Bring what is pending to the operating system: it survives the end of this process."""
        if not self._chunk:
            return
        packed = self._pack.compress(bytes(self._chunk))
        begin, end = self._chunk_span
        sizes = struct.pack("<QQQI", begin, end, len(self._chunk), zlib.crc32(self._chunk))
        chunk = record(Opcode.CHUNK, sizes + text("zstd") + struct.pack("<Q", len(packed)) + packed)
        places, offsets = bytearray(), bytearray()
        for channel, entries in self._index.items():
            offsets += struct.pack("<HQ", channel, self._size + len(chunk) + len(places))
            payload = struct.pack("<HI", channel, len(entries)) + entries
            places += record(Opcode.MESSAGE_INDEX, payload)
        summary = struct.pack("<QQQQI", begin, end, self._size, len(chunk), len(offsets)) + offsets
        summary += struct.pack("<Q", len(places)) + text("zstd")
        summary += struct.pack("<QQ", len(packed), len(self._chunk))
        self._append(chunk + places)
        self._summarise(Opcode.CHUNK_INDEX, summary)
        self._span = _widened(_widened(self._span, begin), end)
        self._chunk, self._index, self._chunk_span = bytearray(), {}, _EMPTY

    def sync(self) -> None:
        """Bring the file to the disk: what is in it survives a power cut."""
        if self._file is None:
            return
        try:
            os.fsync(self._file)
        except OSError as error:
            self._fail(error)

    def finish(self) -> None:
        """Write what is pending and the summary, and close the file."""
        if self._file is None:
            return
        try:
            self.finish_chunk()
            self._append(record(Opcode.DATA_END, struct.pack("<I", self._crc)))
            self._append(self._summary())
            self.sync()
        finally:
            self.abandon()

    def abandon(self) -> None:
        """Close the file as it is."""
        if self._file is not None:
            os.close(self._file)
            self._file = None

    def discard(self) -> None:
        """Close the file and take it away: an empty one would bar the name from the next try."""
        self.abandon()
        with suppress(OSError):
            self._path.unlink()

    def _append(self, data: bytes | bytearray) -> None:
        if self._file is None:
            raise RecordingError(f"{arg(self._path)}: the recording is closed: start a new one.")
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[os.write(self._file, rest) :]
        except OSError as error:
            with suppress(OSError):  # a reader stops at the half record as well
                os.ftruncate(self._file, self._size)
            self._fail(error)
        self._size += len(data)
        self._crc = zlib.crc32(data, self._crc)

    def _fail(self, error: OSError) -> None:
        self.abandon()
        raise RecordingError(
            f"{arg(self._path)}: the recording stopped, but its content stays readable ({arg(error)}): free"
            " disk space or choose another disk, and start a new one."
        ) from error

    def _summarise(self, opcode: Opcode, payload: bytes) -> None:
        self._groups.setdefault(opcode, bytearray()).extend(record(opcode, payload))
        self._tally[opcode] = self._tally.get(opcode, 0) + 1

    def _summary(self) -> bytes:
        self._summarise(Opcode.STATISTICS, self._statistics())
        begin, data, offsets = self._size, bytearray(), bytearray()
        for opcode, group in self._groups.items():
            place = struct.pack("<BQQ", opcode, begin + len(data), len(group))
            offsets += record(Opcode.SUMMARY_OFFSET, place)
            data += group
        footer = struct.pack("<QQ", begin, begin + len(data))
        head = record(Opcode.FOOTER, footer + bytes(4))[:-4]
        data += offsets + head
        return bytes(data) + struct.pack("<I", zlib.crc32(data)) + MAGIC

    def _statistics(self) -> bytes:
        counted = [self._tally.get(key, 0) for key in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.METADATA_INDEX)]
        schemas, channels, metadata = counted
        chunks = self._tally.get(Opcode.CHUNK_INDEX, 0)
        begin, end = self._span if self._span != _EMPTY else (0, 0)
        counts = b"".join(struct.pack("<HQ", *item) for item in self._counts.items())
        total = sum(self._counts.values())
        head = struct.pack("<QHIIIIQQ", total, schemas, channels, 0, metadata, chunks, begin, end)
        return head + struct.pack("<I", len(counts)) + counts


_EMPTY = (2**64 - 1, 0)


def _widened(span: tuple[int, int], time: int) -> tuple[int, int]:
    return min(span[0], time), max(span[1], time)


def _create(path: Path) -> int:
    try:
        file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    except FileExistsError:
        raise RecordingError(f"{arg(path)}: this file already exists: choose another name.") from None
    except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
        raise RecordingError(
            f"{arg(path)}: the recording cannot be started ({arg(error)}): choose a folder that exists and is writable."
        ) from error
    try:
        sync_folder(path.parent)
    except OSError as error:
        os.close(file)
        path.unlink(missing_ok=True)
        raise RecordingError(
            f"{arg(path)}: the recording cannot be started ({arg(error)}): choose another disk."
        ) from error
    return file
