"""Bags of ROS 1 and ROS 2, however they are stored, as messages in the order in which they were recorded.

MCAP files are read up to the damage, and SQLite files by their rows: a reader that sorts by time would hide a clock
that was set back.
"""

from __future__ import annotations

import re
import sqlite3
import struct
from contextlib import closing
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import zstandard

from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.recording.errors import RecordingError
from contactbench.pipeline.recording.stream import (
    LARGEST_CHUNK,
    Channel,
    McapMessage,
    McapStream,
    Warnings,
    open_file,
)
from contactbench.pipeline.recording.wire import MAGIC

if TYPE_CHECKING:
    from collections.abc import Iterator

    from contactbench.pipeline.files import Progress

_ZSTD, _SQLITE, _ROS1 = b"\x28\xb5\x2f\xfd", b"SQLite format 3\0", b"#ROSBAG V2.0"
_ENDINGS = (".mcap", ".db3", ".bag", ".zstd")
_MOST_TIMES, _ROOM = 100, 2**28  # that a packed file may grow by, and bytes that any may have
# What rosbags lets through where a bag is damaged.
_OF_ROSBAGS = (AssertionError, EOFError, LookupError, OSError, RuntimeError, ValueError, struct.error)
_ROWS = (
    "SELECT name, type, serialization_format, timestamp, data"
    " FROM messages JOIN topics ON topic_id = topics.id ORDER BY messages.id"
)


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

    def messages(self, warnings: Warnings, progress: Progress | None = None) -> Iterator[McapMessage]:
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
            if progress is not None:
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


def _of_file(file: Path, warnings: Warnings, progress: Progress | None) -> Iterator[McapMessage]:
    if _begins(file, _SQLITE):
        yield from _of_sqlite(file, warnings)
        return
    if _begins(file, _ROS1):
        yield from _of_ros1(file, warnings)
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
            channels: dict[tuple[str, str, str], Channel] = {}
            for topic, kind, encoding, time, data in database.execute(_ROWS):
                if not isinstance(time, int) or not isinstance(data, bytes):
                    warnings.add(message(f"A row on {arg(topic[:80])!r} is no message and was left out."))
                    continue
                key = topic, kind, encoding
                yield McapMessage(channels.setdefault(key, Channel(topic, encoding, kind, "")), time, data)
    except sqlite3.Error as error:
        warnings.add(_cut_off(file, error))


def _of_ros1(file: Path, warnings: Warnings) -> Iterator[McapMessage]:
    from rosbags.rosbag1 import Reader, ReaderError

    try:
        with Reader(file) as bag:
            # The reader merges topics by time; a topic by itself comes in the order in which it was recorded.
            bag.indexes = {
                number: sorted(entries, key=lambda entry: (entry.chunk_pos, entry.offset))
                for number, entries in bag.indexes.items()
            }
            for each, time, data in bag.messages():
                yield McapMessage(Channel(each.topic, "ros1", each.msgtype, ""), time, data)
    except (ReaderError, *_OF_ROSBAGS) as error:
        warnings.add(_cut_off(file, error))
