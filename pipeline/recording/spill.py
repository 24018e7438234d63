"""What does not fit into memory, put aside on a disk."""

from __future__ import annotations

import math
import tempfile
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.recording.errors import RecordingError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path
    from types import TracebackType

    from numpy.typing import NDArray

IN_MEMORY = 2**24  # bytes that need no disk

_Layout = tuple[tuple[str, np.dtype[Any], tuple[int, ...]], ...]  # names, types and shapes of arrays


class Spill:
    """
    A file for tables that are written block by block, and read so as often as wanted.

    Parameters
    ----------
    folder : path, optional
        Where it is; it has no name there, and is gone with the program. Left out: the system's temporary folder.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder
        where = None if folder is None else str(folder)
        self._file = tempfile.SpooledTemporaryFile(IN_MEMORY, dir=where)  # noqa: SIM115
        self._end = 0

    def __enter__(self) -> Spill:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        # What a full disk did not take is tried once more, and is needed by no one.
        with suppress(OSError):
            self._file.close()

    def write(self, data: bytes) -> int:
        """Append bytes; return where they are. RecordingError: the disk is full, or the like."""
        place = self._end
        with self._told():
            self._file.seek(place)
            self._file.write(data)
        self._end += len(data)
        return place

    def read(self, place: int, size: int) -> bytes:
        """Return so many bytes from some place on."""
        with self._told():
            self._file.seek(place)
            return self._file.read(size)

    @contextmanager
    def _told(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise RecordingError(
                f"{arg(self._folder or message('the temporary folder'))}: readings cannot be put aside there"
                f" ({arg(error)}): free disk space, or choose a folder on another disk."
            ) from error


class Table:
    """Arrays (n, ...) with names that are in a spill and grow together."""

    def __init__(self, spill: Spill) -> None:
        self._spill = spill
        self._blocks: list[tuple[int, _Layout]] = []
        self._layouts: dict[_Layout, _Layout] = {}  # there are few: each is kept once
        self.shapes: dict[str, tuple[int, ...]] = {}  # of the whole; as wide as the widest block

    def add(self, columns: Mapping[str, NDArray[Any]]) -> None:
        """Append rows."""
        layout = tuple((name, values.dtype, values.shape) for name, values in columns.items())
        place = self._spill.write(b"".join(values.tobytes() for values in columns.values()))
        self._blocks.append((place, self._layouts.setdefault(layout, layout)))
        for name, _, (count, *wide) in layout:
            rows, *widest = self.shapes.get(name, (0, *wide))
            self.shapes[name] = (rows + count, *map(max, wide, widest))

    def blocks(self, begin: int = 0) -> Iterator[dict[str, NDArray[Any]]]:
        """Yield the rows as they were added, from one of the blocks on."""
        for place, layout in self._blocks[begin:]:
            yield dict(self._columns(place, layout))

    def column(self, only: str) -> Iterator[NDArray[Any]]:
        """Yield one of the arrays as it was added."""
        for place, layout in self._blocks:
            yield from (values for _, values in self._columns(place, layout, only))

    def _columns(
        self, place: int, layout: _Layout, only: str | None = None
    ) -> Iterator[tuple[str, NDArray[Any]]]:
        for name, kind, shape in layout:
            size = kind.itemsize * math.prod(shape)
            if only in (None, name):
                yield name, np.frombuffer(self._spill.read(place, size), dtype=kind).reshape(shape)
            place += size
