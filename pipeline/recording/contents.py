"""What is in a recording of any length: its topics, how often they were heard and how late, and what is wrong."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.devices.sample import Status
from contactbench.pipeline.recording.messages import Event
from contactbench.pipeline.recording.reader import FlangeTrack, RecordingReader, Repeats, WrenchTrack
from contactbench.pipeline.recording.spill import Spill, Table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from numpy.typing import NDArray

    from contactbench.pipeline.recording.messages import RecordingInfo

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
        What is missing or damaged: sentences.
    complete : bool
        The recording was closed, and the file is whole.
    """

    info: RecordingInfo
    topics: tuple[dict[str, Any], ...]
    events: int
    warnings: tuple[str, ...]
    complete: bool


def read_contents(path: Path, progress: Callable[[int, int], None] | None = None) -> Contents:
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
    events = 0
    with Spill() as spill, RecordingReader(path, progress) as reader:
        wrenches: defaultdict[str, _Wrenches] = defaultdict(lambda: _Wrenches(spill))
        flanges: defaultdict[str, _Flanges] = defaultdict(lambda: _Flanges(spill))
        for topic, block in reader.blocks():
            if isinstance(block, Event):
                events += 1
            elif isinstance(block, WrenchTrack):
                wrenches[topic].add(block)
            else:
                flanges[topic].add(block)
        topics = (
            *({"topic": topic, "kind": "wrench", **counts.facts()} for topic, counts in wrenches.items()),
            *({"topic": topic, "kind": "flange", **counts.facts()} for topic, counts in flanges.items()),
        )
        return Contents(reader.info, topics, events, tuple(reader.warnings), reader.complete)


class _Samples:
    """Counts samples of either kind."""

    def __init__(self, spill: Spill) -> None:
        self._count = self._late = 0
        self._first, self._last = np.inf, -np.inf
        self._latencies = Table(spill)

    def count(self, track: WrenchTrack | FlangeTrack) -> None:
        """Count those of a block."""
        self._count += len(track.times)
        self._first = min(self._first, float(track.times.min()))
        self._last = max(self._last, float(track.times.max()))
        latencies = (track.arrivals - track.times)[np.isfinite(track.arrivals)]
        self._late += int(np.count_nonzero(latencies > LATE_S))
        if len(latencies):
            self._latencies.add({"s": latencies})

    def counted(self) -> dict[str, Any]:
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


class _Wrenches:
    def __init__(self, spill: Spill) -> None:
        self._samples, self._repeats = _Samples(spill), Repeats()
        self._sequence: NDArray[np.int64] = np.empty(0, dtype=np.int64)  # the last one, once there is one
        self._lost = self._unusable = self._frozen = 0
        self._flags: Counter[Status] = Counter()

    def add(self, track: WrenchTrack) -> None:
        self._samples.count(track)
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
            **self._samples.counted(),
            "lost": self._lost,
            "unusable": self._unusable,
            "frozen": self._frozen,
            "flags": {str(flag.name).lower(): self._flags[flag] for flag in Status if self._flags[flag]},
        }


class _Flanges:
    def __init__(self, spill: Spill) -> None:
        self._samples, self._joints = _Samples(spill), 0

    def add(self, track: FlangeTrack) -> None:
        self._samples.count(track)
        self._joints = max(self._joints, track.joints.shape[1])

    def facts(self) -> dict[str, Any]:
        return {**self._samples.counted(), "joints": self._joints}


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
