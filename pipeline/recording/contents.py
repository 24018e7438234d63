"""What is in a recording of any length: its topics, how often they were heard and how late, and what is wrong."""

from __future__ import annotations

import math
import tempfile
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.devices.sample import Status
from contactbench.pipeline.errors import RecordingError, arg, message
from contactbench.pipeline.files import Progress, unheard
from contactbench.pipeline.recording.messages import RecordingInfo
from contactbench.pipeline.recording.reader import FlangeTrack, RecordingReader, Repeats, Track, WrenchTrack

LATE_S = 0.1
_DIGIT = 16  # bits


@dataclass(frozen=True)
class Contents:
    """
    What is in a recording.

    Attributes
    ----------
    info : RecordingInfo
    topics : tuple of dict
        Of each topic with samples, those of wrenches first: its name, kind, samples, seconds, rate (Hz), median and
        99th percentile of the latency (s), how many were late; of wrenches those that are lost, unusable and frozen,
        and the flags; of poses the joints. None: not known.
    events : int
    warnings : tuple of str
        What is missing or damaged, and where the clock was set: sentences.
    complete : bool
        The recording was closed, and the file is whole.
    """

    info: RecordingInfo
    topics: tuple[dict[str, Any], ...]
    events: int
    warnings: tuple[str, ...]
    complete: bool


def read_contents(path: Path, progress: Progress = unheard) -> Contents:
    """
    Look through a recording; of more than two million samples the latencies go through the temporary folder.

    Parameters
    ----------
    path : path
    progress : callable, optional
        Gets the bytes read so far, and those in the file.

    Raises
    ------
    RecordingError
        The file cannot be read, or is no recording of contactbench; or the temporary folder is full.
    """
    with Spill() as spill, RecordingReader(path, progress) as reader:
        wrenches: defaultdict[str, _Wrenches] = defaultdict(lambda: _Wrenches(spill))
        flanges: defaultdict[str, _Flanges] = defaultdict(lambda: _Flanges(spill))
        events = reader.gather(
            lambda topic, block: wrenches[topic].add(block),
            lambda topic, block: flanges[topic].add(block),
            lambda _event: None,
        )
        topics = (
            *({"topic": topic, "kind": "wrench", **counts.facts()} for topic, counts in wrenches.items()),
            *({"topic": topic, "kind": "flange", **counts.facts()} for topic, counts in flanges.items()),
        )
        return Contents(reader.info, topics, events, tuple(reader.warnings), reader.complete)


class _Samples(Generic[Track]):
    """Counts samples of either kind."""

    def __init__(self, spill: Spill) -> None:
        self._count = self._late = 0
        self._first, self._last = np.inf, -np.inf
        self._latencies = Table(spill)

    def add(self, track: Track) -> None:
        """Count those of a block."""
        self._count += len(track.times)
        self._first = min(self._first, float(track.times.min()))
        self._last = max(self._last, float(track.times.max()))
        latencies = (track.arrivals - track.times)[np.isfinite(track.arrivals)]
        self._late += int(np.count_nonzero(latencies > LATE_S))
        if len(latencies):
            self._latencies.add({"s": latencies})

    def facts(self) -> dict[str, Any]:
        """Return what was counted."""
        seconds = self._last - self._first
        median, p99 = (percentile(self._latencies, "s", share) for share in (50, 99))
        return {
            "samples": self._count,
            "seconds": seconds,
            "rate": (self._count - 1) / seconds if seconds > 1e-9 else None,
            "latency_median": median,
            "latency_p99": p99,
            "late": self._late,
        }


class _Wrenches(_Samples[WrenchTrack]):
    def __init__(self, spill: Spill) -> None:
        super().__init__(spill)
        self._repeats = Repeats()
        self._sequence: NDArray[np.int64] = np.empty(0, dtype=np.int64)  # the last one, once there is one
        self._lost = self._unusable = self._frozen = 0
        self._flags: Counter[Status] = Counter()

    def add(self, track: WrenchTrack) -> None:
        super().add(track)
        sequence = np.concatenate((self._sequence, track.sequence[track.sequence >= 0]))
        self._lost += sum(step - 1 for step in np.diff(sequence).tolist() if step > 1)
        self._sequence = sequence[-1:]
        self._flags.update({flag: int(np.count_nonzero(track.status & flag)) for flag in Status})
        self._judge(self._repeats.add(track))

    def _judge(self, track: WrenchTrack) -> None:
        self._unusable += int(np.count_nonzero(~track.usable))
        self._frozen += int(np.count_nonzero(track.frozen))

    def facts(self) -> dict[str, Any]:
        for track in self._repeats.end():
            self._judge(track)
        return {
            **super().facts(),
            "lost": self._lost,
            "unusable": self._unusable,
            "frozen": self._frozen,
            "flags": {str(flag.name).lower(): self._flags[flag] for flag in Status if self._flags[flag]},
        }


class _Flanges(_Samples[FlangeTrack]):
    _joints = 0

    def add(self, track: FlangeTrack) -> None:
        super().add(track)
        self._joints = max(self._joints, track.joints.shape[1])

    def facts(self) -> dict[str, Any]:
        return {**super().facts(), "joints": self._joints}


def percentile(table: Table, column: str, share: float) -> float | None:
    """Return a percentile of a column of finite numbers, to the bit that of `numpy.percentile`; None if it is empty."""
    count, *_ = table.shapes.get(column, (0,))
    if not count:
        return None
    place = share / 100 * (count - 1)
    below = int(place)
    ends = [_ranked(lambda: table.column(column), rank) for rank in (below, min(below + 1, count - 1))]
    return float(np.quantile(ends, place - below))


def _ranked(blocks: Callable[[], Iterable[NDArray[np.float64]]], rank: int) -> float:
    """Return the number that would stand at `rank` if all were sorted: digit by digit, the highest first."""
    found = np.uint64(0)
    for shift in range(64 - _DIGIT, -1, -_DIGIT):
        counts = np.zeros(2**_DIGIT, dtype=np.int64)
        for block in blocks():
            digits = _in_order(block) >> np.uint64(shift)
            if shift + _DIGIT < 64:
                digits = digits[digits >> np.uint64(_DIGIT) == found]
            counts += np.bincount((digits & np.uint64(2**_DIGIT - 1)).astype(np.int64), minlength=2**_DIGIT)
        ends = np.cumsum(counts)
        digit = int(np.searchsorted(ends, rank, side="right"))
        rank -= int(ends[digit] - counts[digit])
        found = found << np.uint64(_DIGIT) | np.uint64(digit)
    bits = found ^ (_SIGN if found & _SIGN else ~np.uint64(0))
    return float(np.array(bits).view(np.float64))


_SIGN = np.uint64(2**63)


def _in_order(values: NDArray[np.float64]) -> NDArray[np.uint64]:
    """Return integers (n,) that are in the same order as floats."""
    bits = values.view(np.uint64)
    return np.where(bits & _SIGN, ~bits, bits | _SIGN)


# ---- what does not fit into memory, put aside on a disk ------------------------------------------


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

    def __exit__(self, *_: object) -> None:
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
