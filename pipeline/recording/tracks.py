"""What was recorded on one topic, as arrays."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, fields
from functools import cached_property
from itertools import repeat
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np

from contactbench.pipeline import kernel
from contactbench.pipeline.devices.sample import FROZEN_CHANCE, Status, WrenchSample
from contactbench.pipeline.tables.decimals import floats_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.devices.sample import FlangeSample
    from contactbench.pipeline.recording.messages import WrenchCells

_USABLE = Status.LATE  # everything else says that a reading is no measurement, or that its time is a guess


@dataclass(frozen=True, eq=False)
class WrenchTrack:
    """
    The wrenches of one sensor; n samples, as given.

    Attributes
    ----------
    times : (n,) float64
        When they were measured, on the samples' clock, s.
    wrenches : (n, 6) float64
        Fx Fy Fz Mx My Mz in S, N and N·m about the sensor's origin.
    sequence : (n,) int64
        The device's count; -1: it has none.
    status : (n,) int64
        Flags of `Status`.
    device_time : (n,) float64
        The device's clock, s; NaN: it has none.
    temperature : (n,) float64
        °C; NaN: unknown.
    arrivals : (n,) float64
        When they arrived, on the samples' clock, s; NaN: unknown.
    """

    times: NDArray[np.float64]
    wrenches: NDArray[np.float64]
    sequence: NDArray[np.int64]
    status: NDArray[np.int64]
    device_time: NDArray[np.float64]
    temperature: NDArray[np.float64]
    arrivals: NDArray[np.float64]

    @cached_property
    def frozen(self) -> NDArray[np.bool_]:
        """(n,) the reading is part of a run that repeats beyond chance: the sensor hung."""
        return kernel.frozen(np.ascontiguousarray(self.wrenches), FROZEN_CHANCE)

    @cached_property
    def usable(self) -> NDArray[np.bool_]:
        """(n,) healthy: finite, not frozen, and nothing is reported but lateness."""
        reported = (self.status & ~int(_USABLE)) != 0
        usable: NDArray[np.bool_] = ~reported & np.isfinite(self.wrenches).all(axis=1) & ~self.frozen
        return usable

    def samples(self) -> Iterator[WrenchSample]:
        """Yield the samples one by one."""
        for row in range(len(self.times)):
            fx, fy, fz, mx, my, mz = self.wrenches[row].tolist()
            sequence = int(self.sequence[row])
            yield WrenchSample(
                float(self.times[row]),
                (fx, fy, fz),
                (mx, my, mz),
                None if sequence < 0 else sequence,
                Status(int(self.status[row])),
                _or_none(self.device_time[row]),
                _or_none(self.temperature[row]),
                _or_none(self.arrivals[row]),
            )


@dataclass(frozen=True, eq=False)
class FlangeTrack:
    """
    The poses of one flange E in its base B; n samples, as given.

    Attributes
    ----------
    times : (n,) float64
        When they were measured, on the samples' clock, s.
    R_BE : (n, 3, 3) float64
    p_BE_B : (n, 3) float64
        m; NaN: unknown.
    joints : (n, k) float64
        rad; NaN: unknown. k = 0 where no sample has any.
    device_time : (n,) float64
        The controller's clock, s; NaN: it has none.
    arrivals : (n,) float64
        When they arrived, on the samples' clock, s; NaN: unknown.
    """

    times: NDArray[np.float64]
    R_BE: NDArray[np.float64]
    p_BE_B: NDArray[np.float64]
    joints: NDArray[np.float64]
    device_time: NDArray[np.float64]
    arrivals: NDArray[np.float64]


Track = TypeVar("Track", WrenchTrack, FlangeTrack)


def wrench_track(samples: Sequence[WrenchCells]) -> WrenchTrack:
    """Read the numbers of samples (n,) together, n > 0: one by one would take several times as long."""
    times, *wrench, status, sequence, device_time, temperature, arrivals = zip(*samples, strict=True)
    return WrenchTrack(
        times=_numbers(times),
        wrenches=np.column_stack([_numbers(cells) for cells in wrench]),
        sequence=_counts(sequence),
        status=_counts(status),
        device_time=_numbers(device_time),
        temperature=_numbers(temperature),
        arrivals=_numbers(arrivals),
    )


def flange_track(samples: Sequence[FlangeSample]) -> FlangeTrack:
    """Put poses (n,) in columns, n > 0; where they differ in the number of joints, the missing ones are NaN."""
    known = [() if sample.joints is None else sample.joints for sample in samples]
    joints = np.full((len(samples), max(map(len, known))), np.nan)
    for row, angles in enumerate(known):
        joints[row, : len(angles)] = angles
    return FlangeTrack(
        times=np.array([sample.time for sample in samples]),
        R_BE=np.array([sample.R_BE for sample in samples]),
        p_BE_B=np.array([sample.p_BE_B for sample in samples]),
        joints=joints,
        device_time=np.array([_or_nan(sample.device_time) for sample in samples]),
        arrivals=np.array([_or_nan(sample.arrival) for sample in samples]),
    )


class Whole(Generic[Track]):
    """A track that grows by blocks and is in memory once."""

    def __init__(self, kind: Callable[..., Track]) -> None:
        self._kind: Callable[..., Track] = kind
        self._columns: defaultdict[str, bytearray] = defaultdict(bytearray)
        self._forms: dict[str, tuple[np.dtype[Any], tuple[int, ...]]] = {}
        self._count = 0

    def add(self, block: Track) -> None:
        """Append the samples of a block."""
        columns = columns_of(block)
        if "joints" in columns:
            columns["joints"] = self._as_wide(columns["joints"])
        for name, values in columns.items():
            self._forms[name] = values.dtype, values.shape[1:]
            # Where there is no room left, the system moves the pages and copies nothing.
            self._columns[name] += values.tobytes()
        self._count += len(block.times)

    def track(self) -> Track:
        """Return the samples; no more can be added then."""
        return self._kind(**{name: self._array(name) for name in self._columns})

    def _array(self, name: str) -> NDArray[Any]:
        kind, shape = self._forms[name]
        return np.frombuffer(self._columns[name], kind).reshape(self._count, *shape)

    def _as_wide(self, joints: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return joints in as many columns as the widest so far; those so far become as wide as these."""
        width = self._forms["joints"][1][0] if self._count else 0
        if joints.shape[1] > width and self._count:
            self._columns["joints"] = bytearray(padded(self._array("joints"), joints.shape[1]).tobytes())
        return padded(joints, max(width, joints.shape[1]))


class Repeats:
    """
    Tell the frozen readings of a track that comes in blocks: `frozen` of a block alone knows nothing of the others.

    What led to a run that is told frozen was frozen, too: readings of a run that is not decided are held back.
    """

    def __init__(self) -> None:
        self._detector = kernel.FrozenDetector()
        self._held: WrenchTrack | None = None

    def add(self, block: WrenchTrack) -> WrenchTrack:
        """Return the readings that are decided, perhaps none: their `frozen` and `usable` are those of the whole."""
        told = np.fromiter(
            map(self._detector.see, block.wrenches.tolist(), repeat(FROZEN_CHANCE)), dtype=bool
        )
        if self._held is not None:
            told = np.concatenate((np.zeros(len(self._held.times), dtype=bool), told))
            block = joined(self._held, block)
        begins = np.flatnonzero(np.r_[True, (block.wrenches[1:] != block.wrenches[:-1]).any(axis=1)])
        frozen = np.repeat(np.logical_or.reduceat(told, begins), np.diff(np.r_[begins, len(told)]))
        decided = len(told) if told[-1] else int(begins[-1])
        self._held = None if told[-1] else part(block, slice(decided, None))
        return _known(part(block, slice(decided)), frozen[:decided])

    def end(self) -> Iterator[WrenchTrack]:
        """Yield what was held back: nothing decided that it is frozen."""
        if self._held is not None:
            yield _known(self._held, np.zeros(len(self._held.times), dtype=bool))


def columns_of(track: WrenchTrack | FlangeTrack) -> dict[str, NDArray[Any]]:
    """Return the arrays of a track by name."""
    return {field.name: getattr(track, field.name) for field in fields(track)}


def part(track: Track, rows: slice) -> Track:
    """Return some of the samples."""
    return type(track)(**{name: values[rows] for name, values in columns_of(track).items()})


def joined(first: Track, second: Track) -> Track:
    """Return the samples of one track, then those of the other."""
    one, other = columns_of(first), columns_of(second)
    if "joints" in one:
        width = max(one["joints"].shape[1], other["joints"].shape[1])
        one["joints"], other["joints"] = padded(one["joints"], width), padded(other["joints"], width)
    return type(first)(**{name: np.concatenate((one[name], other[name])) for name in one})


def _known(track: WrenchTrack, frozen: NDArray[np.bool_]) -> WrenchTrack:
    vars(track)["frozen"] = frozen  # where the property would put it
    return track


def padded(joints: NDArray[np.float64], width: int) -> NDArray[np.float64]:
    """Return joints (n, k) in so many columns; NaN in the new ones."""
    return np.pad(joints, ((0, 0), (0, width - joints.shape[1])), constant_values=np.nan)


def _numbers(cells: Sequence[bytes | None]) -> NDArray[np.float64]:
    """Read cells (n,) as numbers; NaN where there is none."""
    if not any(cells):
        return np.full(len(cells), np.nan)
    return floats_of([cell or b"" for cell in cells])


def _counts(cells: Sequence[bytes | None]) -> NDArray[np.int64]:
    """Read cells (n,) as counts; -1 where there is none."""
    return np.array([-1 if cell is None else int(cell) for cell in cells], dtype=np.int64)


def _or_nan(value: float | None) -> float:
    return np.nan if value is None else value


def _or_none(value: np.float64) -> float | None:
    return None if np.isnan(value) else float(value)
