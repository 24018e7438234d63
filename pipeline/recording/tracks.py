"""What was recorded on one topic, as arrays."""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline import kernel
from contactbench.pipeline.devices.sample import FROZEN_CHANCE, Status, WrenchSample
from contactbench.pipeline.tables.decimals import floats_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.devices.sample import FlangeSample
    from contactbench.pipeline.recording.messages import WrenchCells

_TOGETHER = 4096  # samples whose numbers are read at once
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


class WrenchColumns:
    """Collect samples in columns: an hour at 1 kHz fits where 3.6 million objects would not."""

    def __init__(self) -> None:
        self._numbers = array("d")
        self._counts = array("q")
        self._cells: list[WrenchCells] = []

    def add_cells(self, cells: WrenchCells) -> None:
        """Append a sample, see `wrench_cells`; they are read thousands at a time."""
        self._cells.append(cells)
        if len(self._cells) == _TOGETHER:
            self._read_cells()

    def add(self, sample: WrenchSample) -> None:
        """Append a sample."""
        self._read_cells()
        self._numbers.extend((sample.time, _or_nan(sample.device_time), _or_nan(sample.temperature)))
        self._numbers.extend((_or_nan(sample.arrival), *sample.force, *sample.torque))
        self._counts.extend((-1 if sample.sequence is None else sample.sequence, sample.status))

    def _read_cells(self) -> None:
        if not self._cells:
            return
        time, *wrench, status, sequence, device_time, temperature, arrival = zip(*self._cells, strict=True)
        self._cells.clear()
        numbers = [_numbers(column) for column in (time, device_time, temperature, arrival, *wrench)]
        self._numbers.frombytes(np.column_stack(numbers).tobytes())
        counts = [[-1 if cell is None else int(cell) for cell in column] for column in (sequence, status)]
        self._counts.frombytes(np.column_stack(counts).astype(np.int64).tobytes())

    def track(self) -> WrenchTrack:
        """Return the samples so far."""
        self._read_cells()
        numbers = np.array(self._numbers).reshape(-1, 10)
        counts = np.array(self._counts).reshape(-1, 2)
        return WrenchTrack(
            times=numbers[:, 0].copy(),
            wrenches=numbers[:, 4:].copy(),
            sequence=counts[:, 0].copy(),
            status=counts[:, 1].copy(),
            device_time=numbers[:, 1].copy(),
            temperature=numbers[:, 2].copy(),
            arrivals=numbers[:, 3].copy(),
        )


class FlangeColumns:
    """Collect poses in columns; where samples differ in the number of joints, the missing ones are NaN."""

    def __init__(self) -> None:
        self._numbers = array("d")
        self._joints = array("d")
        self._joint_counts = array("q")

    def add(self, sample: FlangeSample) -> None:
        """Append a pose."""
        self._numbers.extend((sample.time, _or_nan(sample.device_time), _or_nan(sample.arrival)))
        self._numbers.extend(sample.p_BE_B.tolist())
        self._numbers.extend(sample.R_BE.ravel().tolist())
        joints = [] if sample.joints is None else sample.joints.tolist()
        self._joints.extend(joints)
        self._joint_counts.append(len(joints))

    def track(self) -> FlangeTrack:
        """Return the poses so far."""
        numbers = np.array(self._numbers).reshape(-1, 15)
        counts = np.array(self._joint_counts)
        joints = np.full((len(numbers), counts.max(initial=0)), np.nan)
        joints[np.arange(joints.shape[1]) < counts[:, None]] = self._joints
        return FlangeTrack(
            times=numbers[:, 0].copy(),
            R_BE=numbers[:, 6:].reshape(-1, 3, 3),
            p_BE_B=numbers[:, 3:6].copy(),
            joints=joints,
            device_time=numbers[:, 1].copy(),
            arrivals=numbers[:, 2].copy(),
        )


def _numbers(cells: Sequence[bytes | None]) -> NDArray[np.float64]:
    """Read cells (n,) as numbers; NaN where there is none."""
    if not any(cells):
        return np.full(len(cells), np.nan)
    return floats_of([cell or b"" for cell in cells])


def _or_nan(value: float | None) -> float:
    return np.nan if value is None else value


def _or_none(value: np.float64) -> float | None:
    return None if np.isnan(value) else float(value)
