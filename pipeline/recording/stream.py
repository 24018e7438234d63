"""Any MCAP file as a stream of messages; no length or count in it is trusted."""

import bz2
import os
import stat
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO, NamedTuple

import zstandard

from contactbench.pipeline.errors import RecordingError, arg, message
from contactbench.pipeline.files import File, Progress, unheard
from contactbench.pipeline.recording.wire import MAGIC, MESSAGE_HEAD, PREFIX, Cursor, Opcode

# Bags with pictures have chunks of many MiB; our own are under 2.
LARGEST_CHUNK = 256 * 2**20
_LARGEST_OTHER = 16 * 2**20
_BLOCK = 2**20
_MOST_WARNINGS = 20

_WANTED = {
    Opcode.HEADER: _LARGEST_OTHER,
    Opcode.SCHEMA: _LARGEST_OTHER,
    Opcode.CHANNEL: _LARGEST_OTHER,
    Opcode.METADATA: _LARGEST_OTHER,
    Opcode.DATA_END: _LARGEST_OTHER,
    Opcode.MESSAGE: LARGEST_CHUNK,
    Opcode.CHUNK: LARGEST_CHUNK,
}


@dataclass(frozen=True, slots=True)
class Channel:
    """A topic, and how its messages are written."""

    topic: str
    encoding: str
    schema_name: str


class McapMessage(NamedTuple):
    """What was published on a topic; log time in ns."""

    channel: Channel
    log_time: int
    data: bytes


@dataclass(frozen=True, slots=True)
class Metadata:
    """A named map of strings."""

    name: str
    values: dict[str, str]


class Warnings(list[str]):
    """Sentences about damage, of which nobody reads more than twenty."""

    def add(self, sentence: str) -> None:
        """Keep a sentence, unless there are many already."""
        if len(self) < _MOST_WARNINGS:
            self.append(sentence)
        elif len(self) == _MOST_WARNINGS:
            self.append(message("More of it is damaged in the same way."))


class McapStream:
    """
    Iterate over the messages and metadata of an MCAP file, once, in the order of the file.

    A file that is cut off gives what is in its whole chunks; a damaged chunk is left out. Both are said in
    `warnings`.

    Parameters
    ----------
    path : path
    progress : callable, optional
        Gets the bytes read so far, and those in the file.
    warnings : Warnings, optional
        Those of the whole that the file is a part of.

    Raises
    ------
    RecordingError
        The file cannot be opened or read, or is no MCAP file.
    """

    def __init__(self, path: File, progress: Progress = unheard, warnings: Warnings | None = None) -> None:
        self._path = path
        self._progress = progress
        self._file = open_file(path)
        try:
            self._size = os.fstat(self._file.fileno()).st_size
            self._at, self._crc, self._crc_before = 0, 0, 0
            self._check_magic()
        except BaseException:
            self._file.close()
            raise
        self._schemas: dict[int, str] = {}
        self._channels: dict[int, Channel] = {}
        self.warnings = Warnings() if warnings is None else warnings
        self.warn = self.warnings.add
        self.complete = False

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __iter__(self) -> Iterator[McapMessage | Metadata]:
        """Yield messages and metadata until the end of the data, or of what is left of it."""
        while True:
            found = self._next_record()
            if found is None:
                return
            begin, opcode, payload = found
            if opcode == Opcode.DATA_END:
                self._end(payload)
                return
            try:
                yield from self._meaning(opcode, payload)
            except ValueError as error:
                self.warn(
                    message(f"The data at byte {arg(begin):,} are damaged and were left out ({arg(error)}).")
                )

    def _check_magic(self) -> None:
        if self._read(len(MAGIC)) != MAGIC:
            raise RecordingError(f"{arg(self._path)}: not an MCAP file: choose a recording or a ROS 2 bag.")

    def _next_record(self) -> tuple[int, int, bytes] | None:
        """Return where the next record that matters is, its opcode and payload; None at the end of what can be read."""
        while True:
            begin, self._crc_before = self._at, self._crc
            head = self._read(PREFIX.size)
            opcode, length = PREFIX.unpack(head) if len(head) == PREFIX.size else (0, self._size)
            if length > self._size - self._at or opcode == Opcode.FOOTER:
                self._cut_off(begin)
                return None
            limit = _WANTED.get(opcode, -1)
            if length <= limit:
                return begin, opcode, self._read(length)
            if limit >= 0:
                self.warn(
                    message(
                        f"The data at byte {arg(begin):,} are too long ({arg(length):,} bytes) and were left out."
                    )
                )
            self._skip(length)

    def _meaning(self, opcode: int, payload: bytes) -> Iterator[McapMessage | Metadata]:
        if opcode == Opcode.CHUNK:
            yield from self._chunk(payload)
        elif opcode == Opcode.METADATA:
            cursor = Cursor(payload)
            yield Metadata(cursor.text(), cursor.mapping())
        elif opcode == Opcode.MESSAGE:
            yield self._message(payload, 0, len(payload))
        else:
            self._describe(opcode, payload)

    def _chunk(self, payload: bytes) -> Iterator[McapMessage]:
        data = _unpacked(Cursor(payload))
        at = 0
        while at < len(data):
            if len(data) - at < PREFIX.size:
                raise ValueError(message("half a record"))
            opcode, length = PREFIX.unpack_from(data, at)
            at += PREFIX.size
            if length > len(data) - at:
                raise ValueError(message("half a record"))
            if opcode == Opcode.MESSAGE:
                yield self._message(data, at, at + length)
            else:
                self._describe(opcode, data[at : at + length])
            at += length

    def _message(self, data: bytes, begin: int, end: int) -> McapMessage:
        if end - begin < MESSAGE_HEAD.size:
            raise ValueError(message("half a message"))
        number, _, log_time, _ = MESSAGE_HEAD.unpack_from(data, begin)
        if number not in self._channels:
            raise ValueError(message(f"a message on channel {arg(number)}, which is not described"))
        return McapMessage(self._channels[number], log_time, data[begin + MESSAGE_HEAD.size : end])

    def _describe(self, opcode: int, payload: bytes) -> None:
        cursor = Cursor(payload)
        if opcode == Opcode.SCHEMA:
            number, name, _encoding = cursor.number(2), cursor.text(), cursor.text()
            self._schemas.setdefault(number, name)
        elif opcode == Opcode.CHANNEL:
            number, schema = cursor.number(2), cursor.number(2)
            topic, encoding = cursor.text(), cursor.text()
            self._channels.setdefault(number, Channel(topic, encoding, self._schemas.get(schema, "")))

    def _end(self, payload: bytes) -> None:
        expected = int.from_bytes(payload[:4], "little")
        if expected and expected != self._crc_before:
            self.warn(message("The file was changed after it was written: its checksum does not match."))
        try:
            self._file.seek(-len(MAGIC), os.SEEK_END)
            self.complete = self._file.read(len(MAGIC)) == MAGIC
        except OSError as error:
            raise self._unreadable(error) from error
        if not self.complete:
            self.warn(
                message("The file is cut off after its last sample: only the table of contents is missing.")
            )

    def _cut_off(self, begin: int) -> None:
        self.warn(
            message(
                f"The file is cut off or damaged at byte {arg(begin):,} of {arg(self._size):,}: everything up to"
                " there was read."
            )
        )

    def _read(self, length: int) -> bytes:
        try:
            data = self._file.read(length)
        except OSError as error:
            raise self._unreadable(error) from error
        self._crc = zlib.crc32(data, self._crc)
        self._at += len(data)
        self._progress(self._at, self._size)
        return data

    def _skip(self, length: int) -> None:
        while length > 0:
            block = self._read(min(length, _BLOCK))
            if not block:
                return
            length -= len(block)

    def _unreadable(self, error: OSError) -> RecordingError:
        return RecordingError(
            f"{arg(self._path)}: the file cannot be read ({arg(error)}): copy it to another disk."
        )


def _unpacked(cursor: Cursor) -> bytes:
    cursor.take(16)  # first and last time
    size, checksum = cursor.number(8), cursor.number(4)
    compression = cursor.text()
    packed = cursor.take(cursor.number(8))
    if size > LARGEST_CHUNK:
        raise ValueError(message(f"a chunk of {arg(size):,} bytes"))
    data = decompressed(compression, packed, size)
    if len(data) != size or (checksum and zlib.crc32(data) != checksum):
        raise ValueError(message("its checksum does not match"))
    return data


def decompressed(compression: str, packed: bytes, size: int) -> bytes:
    """Return what is in a chunk, at most `size` bytes; ValueError: it is damaged, or packed in an unknown way."""
    if compression in ("", "none"):
        return packed
    if compression == "bz2":
        return bz2.BZ2Decompressor().decompress(packed, max_length=size)
    if compression == "zstd":
        try:
            # A frame says itself how large it will be, and is believed: so ask before.
            if zstandard.frame_content_size(packed) > size:
                raise ValueError(message("a chunk that is larger than it says"))
            return zstandard.ZstdDecompressor().decompress(packed, max_output_size=size)
        except zstandard.ZstdError as error:
            raise ValueError(message(f"it cannot be unpacked: {arg(error)}")) from error
    if compression == "lz4":
        from lz4 import frame  # type: ignore[import-untyped]

        try:
            data: bytes = frame.LZ4FrameDecompressor().decompress(packed, max_length=size)
        except (RuntimeError, EOFError) as error:
            raise ValueError(message(f"it cannot be unpacked: {arg(error)}")) from error
        return data
    raise ValueError(message(f"it is packed as {arg(compression[:20])!r}, which is unknown"))


def open_file(path: File) -> BinaryIO:
    """Open a file for reading; RecordingError: there is none, or it is a pipe or a folder."""
    try:
        # A pipe would be waited for until somebody writes to it.
        mode = path.stat().st_mode
        if stat.S_ISREG(mode):
            return path.open("rb")
    except FileNotFoundError:
        raise RecordingError(f"{arg(path)}: there is no such file: check the path.") from None
    except (OSError, ValueError) as error:  # ValueError: a path that no file system can hold
        raise RecordingError(
            f"{arg(path)}: the file cannot be opened ({arg(error)}): check its permissions."
        ) from error
    if stat.S_ISDIR(mode):
        raise RecordingError(f"{arg(path)}: this is a folder: choose an MCAP file inside it.")
    raise RecordingError(f"{arg(path)}: this is a pipe or a device, not a file: copy it to a file first.")
