"""Bags of ROS 1 and ROS 2, however they are stored, as messages in the order in which they were recorded.

MCAP files and bags of ROS 1 are read up to the damage, and SQLite files by their rows: a reader that sorts by time
would hide a clock that was set back.
"""

from __future__ import annotations

import re
import sqlite3
import struct
from collections.abc import Iterator
from contextlib import closing
from functools import partial
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import BinaryIO

import zstandard

from contactbench.pipeline.errors import RecordingError, arg, join, message
from contactbench.pipeline.files import Progress, unheard
from contactbench.pipeline.recording.stream import (
    LARGEST_CHUNK,
    Channel,
    McapMessage,
    McapStream,
    Warnings,
    decompressed,
    open_file,
)
from contactbench.pipeline.recording.wire import MAGIC

_ZSTD, _SQLITE, _ROS1 = b"\x28\xb5\x2f\xfd", b"SQLite format 3\0", b"#ROSBAG V2.0"
_ENDINGS = (".mcap", ".db3", ".bag", ".zstd")
_MOST_TIMES, _ROOM = 100, 2**28  # that a packed file may grow by, and bytes that any may have
_DAMAGE = (EOFError, LookupError, OSError, ValueError, struct.error)
_TOPICS = "SELECT id, name, serialization_format, type FROM topics"
_ROWS = "SELECT topic_id, timestamp, data FROM messages ORDER BY id"


class Bag:
    """
    A bag that can be gone through several times; to be used in a ``with`` statement.

    Parameters
    ----------
    path : path
        An MCAP or SQLite file, either also packed with zstd; a folder of them with its metadata.yaml; a bag of ROS 1.

    Raises
    ------
    RecordingError
        There is no such file or folder, or it cannot be unpacked.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._scratch = TemporaryDirectory(prefix="contactbench-")
        try:
            self._files = [self._unpacked(file) for file in _files(path)]
        except BaseException:
            self._scratch.cleanup()
            raise

    def __enter__(self) -> Bag:
        return self

    def __exit__(self, *_: object) -> None:
        self._scratch.cleanup()

    def messages(self, warnings: Warnings, progress: Progress = unheard) -> Iterator[McapMessage]:
        """
        Yield the messages, those of each topic in the order in which they were recorded.

        Parameters
        ----------
        warnings : Warnings
            Gets what is damaged.
        progress : callable, optional
            Gets the bytes read so far, and those in the bag.

        Raises
        ------
        RecordingError
            A file cannot be read, or is no bag.
        """
        whole, before = sum(file.stat().st_size for file in self._files), 0
        unpack = zstandard.ZstdDecompressor().decompress

        def tell(read: int, _: int) -> None:
            progress(before + read, whole)

        for file in self._files:
            for each in _of_file(file, warnings, tell):
                if not each.data.startswith(_ZSTD):  # no message begins so
                    yield each
                    continue
                try:
                    yield each._replace(data=unpack(each.data, max_output_size=LARGEST_CHUNK))
                except zstandard.ZstdError as error:
                    warnings.add(
                        message(f"A message on {arg(each.channel.topic[:80])!r} was left out ({arg(error)}).")
                    )
            before += file.stat().st_size
            tell(0, 0)

    def _unpacked(self, file: Path) -> Path:
        if not _begins(file, _ZSTD):
            return file
        out = Path(self._scratch.name) / file.stem
        room = _ROOM + _MOST_TIMES * file.stat().st_size
        try:
            with open_file(file) as packed, out.open("wb") as stream:
                for block in zstandard.ZstdDecompressor().read_to_iter(packed):
                    room -= stream.write(block)
                    if room < 0:
                        raise RecordingError(
                            f"{arg(file)}: it unpacks to far more than a bag: choose another."
                        )
        except (zstandard.ZstdError, OSError) as error:
            raise RecordingError(
                f"{arg(file)}: it cannot be unpacked ({arg(error)}): run zstd -d on it."
            ) from error
        if not any(_begins(out, magic) for magic in (MAGIC, _SQLITE, _ROS1)):
            raise RecordingError(f"{arg(file)}: there is no bag in it: choose another.")
        return out


def _files(path: Path) -> list[Path]:
    if not path.is_dir():
        return [path]
    found = sorted(
        (file for file in path.iterdir() if file.suffix in _ENDINGS),
        key=lambda file: [
            int(part) if part.isdigit() else part for part in re.split(r"(\d{1,9})", file.name)
        ],
    )
    if len(found) > 1 and not (path / "metadata.yaml").exists():
        listed = join(", ", [file.name for file in found[:10]])
        raise RecordingError(
            f"{arg(path)}: this folder has no metadata.yaml, so it is no bag: choose a file in it: {arg(listed)}."
        )
    if not found:
        raise RecordingError(
            f"{arg(path)}: there is no bag in this folder: choose one with .mcap or .db3 files."
        )
    return found


def _begins(file: Path, magic: bytes) -> bool:
    with open_file(file) as stream:
        return stream.read(len(magic)) == magic


def _of_file(file: Path, warnings: Warnings, progress: Progress) -> Iterator[McapMessage]:
    if _begins(file, _SQLITE):
        yield from _of_sqlite(file, warnings)
        return
    if _begins(file, _ROS1):
        yield from _of_ros1(file, warnings, progress)
        return
    stream = McapStream(file, progress, warnings)
    with closing(stream):
        yield from (each for each in stream if isinstance(each, McapMessage))


def _cut_off(file: Path, error: Exception) -> str:
    return message(f"{arg(file.name)} is damaged ({arg(error)}): everything up to there was read.")


def _of_sqlite(file: Path, warnings: Warnings) -> Iterator[McapMessage]:
    # Messages of a recorder that was killed may still be in the log beside the file, which `immutable` ignores.
    how = "mode=ro" if file.with_name(f"{file.name}-wal").exists() else "mode=ro&immutable=1"
    try:
        with closing(sqlite3.connect(f"{file.resolve().as_uri()}?{how}", uri=True)) as database:
            channels = {number: Channel(*texts) for number, *texts in database.execute(_TOPICS)}
            for number, time, data in database.execute(_ROWS):
                channel = channels.get(number)
                if channel is not None and type(time) is int and type(data) is bytes:
                    yield McapMessage(channel, time, data)
                elif channel is not None:
                    name = channel.topic[:80]
                    warnings.add(message(f"A row on {arg(name)!r} is no message and was left out."))
    except sqlite3.Error as error:
        warnings.add(_cut_off(file, error))


_U32, _TIME = struct.Struct("<I"), struct.Struct("<II")
_MESSAGE, _BAG, _CHUNK, _CONNECTION = b"\2", b"\3", b"\5", b"\7"
_Record = tuple[dict[bytes, bytes], bytes]


def _of_ros1(file: Path, warnings: Warnings, progress: Progress) -> Iterator[McapMessage]:
    """Read the records in their order; the index, which a recorder that was killed does not write, is not needed."""
    size, channels = file.stat().st_size, dict[bytes, Channel]()
    try:
        with open_file(file) as stream:
            stream.readline()
            for fields, data in _records(stream):
                progress(stream.tell(), size)
                if fields[b"op"] == _BAG and not any(fields[b"index_pos"]):
                    warnings.add(message(f"{arg(file.name)} was not closed: its end may be missing."))
                if fields[b"op"] != _CHUNK:
                    yield from _meaning(fields, data, channels)
                    continue
                (whole,) = _U32.unpack(fields[b"size"])
                content = decompressed(fields[b"compression"].decode(), data, min(whole, LARGEST_CHUNK))
                for record in _records(BytesIO(content)):
                    yield from _meaning(*record, channels)
                if len(content) < whole:
                    raise EOFError(message("half a chunk"))
    except _DAMAGE as error:
        warnings.add(_cut_off(file, error))


def _records(stream: BinaryIO) -> Iterator[_Record]:
    while head := stream.read(4):
        fields = _fields(_exactly(stream, *_U32.unpack(head.ljust(4))))
        (length,) = _U32.unpack(_exactly(stream, 4))
        if length > LARGEST_CHUNK:
            raise ValueError(message(f"a record of {arg(length):,} bytes"))
        # Of a chunk, what is there is good.
        yield fields, (stream.read if fields[b"op"] == _CHUNK else partial(_exactly, stream))(length)


def _exactly(stream: BinaryIO, size: int) -> bytes:
    data = stream.read(min(size, LARGEST_CHUNK))
    if len(data) < size:
        raise EOFError(message("half a record"))
    return data


def _fields(header: bytes) -> dict[bytes, bytes]:
    fields, at = {}, 0
    while at < len(header):
        (length,) = _U32.unpack_from(header, at)
        name, _, value = header[at + 4 : at + 4 + length].partition(b"=")
        fields[name], at = value, at + 4 + length
    return fields


def _meaning(
    fields: dict[bytes, bytes], data: bytes, channels: dict[bytes, Channel]
) -> Iterator[McapMessage]:
    if fields[b"op"] == _CONNECTION:
        kind = _fields(data)[b"type"].decode()
        channels[fields[b"conn"]] = Channel(fields[b"topic"].decode(), "ros1", kind)
    elif fields[b"op"] == _MESSAGE:
        seconds, rest = _TIME.unpack(fields[b"time"])
        yield McapMessage(channels[fields[b"conn"]], seconds * 10**9 + rest, data)
