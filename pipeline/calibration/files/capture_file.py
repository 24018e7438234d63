"""From a recording of a robot that goes from pose to pose to the still poses in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.files.pose_csv import find_convention, sensor_orientations
from contactbench.pipeline.calibration.orientation import RowError
from contactbench.pipeline.calibration.stillness import (
    CaptureReport,
    Rejected,
    StillnessDetector,
    StillnessSettings,
    StillState,
)
from contactbench.pipeline.calibration.stillness.checks import angle
from contactbench.pipeline.contact.wrench_csv import CHANNELS, WrenchFileError
from contactbench.pipeline.tables import TableReader, TableRows, Wording, open_table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path
    from typing import BinaryIO

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration.model import GravityModel
    from contactbench.pipeline.calibration.orientation import Convention
    from contactbench.pipeline.calibration.poses import PoseSample

# A shorter stop was hardly meant for a pose. Between two looks a robot that moves has turned.
_SHORTEST_STOP_S, _LOOK_S = 0.7, 0.05
_HEADER = "t,fx,fy,fz,mx,my,mz and the orientation"


@dataclass(frozen=True, eq=False)
class Captured:
    """The still poses of a recording."""

    poses: tuple[PoseSample, ...]  # For `calibrate`; their names say when they were taken
    report: CaptureReport  # With what was refused, and why
    rows: int  # Of the recording
    warnings: tuple[str, ...] = ()  # What was noticed, in sentences
    delay: float | None = None  # That was asked for or estimated, s; see `capture_recording`

    @property
    def left_out(self) -> tuple[str, ...]:
        """The stretches that gave no pose, with the reasons: sentences."""
        return tuple(
            f"left out, {each.start:.1f} to {each.stop:.1f} s: {each.reason}" for each in self.report.rejected
        )


def capture_file(
    source: Path | BinaryIO,
    convention: Convention | None = None,
    *,
    R_ES: ArrayLike | None = None,
    settings: StillnessSettings | None = None,
    model: GravityModel | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Captured:
    """Find where a recording stands still, and average it there.

    Parameters
    ----------
    source : path or binary file
        Columns t (s), fx, fy, fz, mx, my, mz (raw readings, S, N and N·m) and those of the orientation at the
        same time. Read in blocks; empty cells are missing samples.
    convention : Convention, optional
        How orientations are written. Left out: quaternions, if there are no others beside them.
    R_ES : array_like (3, 3), optional
        Orientation of the sensor in the flange, where orientations or joints are those of the flange E.
    settings : StillnessSettings, optional
    model : GravityModel, optional
        A preliminary calibration, to see steady touches.
    progress : callable, optional
        Called after each block with the bytes read and the size of the source (0 if that is unknown).

    Raises
    ------
    WrenchFileError
        The source cannot be used; the message names file, line and column.
    InputError
        R_ES is no rotation, or there is no such robot.
    """
    work = Capturing(settings, model)
    with open_table(source, WrenchFileError) as (stream, name, size):
        reader = TableReader(stream, name, Wording(_HEADER, rows="readings", error=WrenchFileError))
        convention = find_convention(reader, convention)
        if "t" in reader.names and not set(convention.columns) & set(reader.names):
            raise reader.error(
                f"there is no orientation ({', '.join(convention.columns)}) beside the readings: add it, or give the"
                " robot's poses as a table of their own, --robot-poses FILE.",
                1,
            )
        reader.select(("t", *CHANNELS, *convention.columns), allow_nan=CHANNELS)
        for rows in in_order(reader):
            values = rows.numbers[:, 1 + len(CHANNELS) :]
            try:
                R_WS = sensor_orientations(values, convention, R_ES)
            except RowError as error:
                raise reader.error(error.what, int(rows.lines[error.row])) from None
            work.update(rows.numbers[:, 0], rows.numbers[:, 1 : 1 + len(CHANNELS)], R_WS)
            if progress is not None:
                progress(reader.bytes_read, size)
    return work.finish()


class Capturing:
    """
    Finds the still poses of a recording, block by block, and every stop of the robot that gave none.

    Parameters
    ----------
    settings : StillnessSettings, optional
    model : GravityModel, optional
        A preliminary calibration, to see steady touches.
    """

    def __init__(self, settings: StillnessSettings | None = None, model: GravityModel | None = None) -> None:
        self._detector = StillnessDetector(None, settings, model)
        self._rows = 0
        self._looked_at = -np.inf
        self._first: tuple[int, float, NDArray[np.float64]] | None = None  # of the stop: row, time, R_WS
        self._last = (0, 0.0)
        self._stops: list[tuple[int, int, float, float]] = []

    def update(
        self, times: NDArray[np.float64], wrenches: NDArray[np.float64], R_WS: NDArray[np.float64]
    ) -> None:
        """Take rows: times (n,), s, in order; wrenches (n, 6), N and N·m; R_WS (n, 3, 3)."""
        self._detector.update_block(times, wrenches, R_WS)
        row = int(np.searchsorted(times, self._looked_at + _LOOK_S))
        while row < len(times):
            self._look(self._rows + row, float(times[row]), R_WS[row])
            row = max(int(np.searchsorted(times, times[row] + _LOOK_S)), row + 1)
        self._rows += len(times)

    def finish(self, warnings: tuple[str, ...] = (), delay: float | None = None) -> Captured:
        """Return what was found, once all rows are there."""
        self._detector.finish()
        self._end_stop()
        captures, rejected = self._detector.captures, self._detector.rejected
        told = [(each.start, each.stop) for each in captures]
        told += [(each.start, each.stop) for each in rejected]
        unused = [
            self._unused(*stop)
            for stop in self._stops
            if not any(start < stop[3] and end > stop[2] for start, end in told)
        ]
        report = CaptureReport(
            tuple(captures), tuple(sorted((*rejected, *unused), key=lambda each: each.start))
        )
        poses = tuple(
            capture.to_pose(name=f"pose {number} at {capture.start:.1f} s")
            for number, capture in enumerate(captures, 1)
        )
        return Captured(poses, report, self._rows, warnings, delay)

    def _look(self, row: int, time: float, R_WS: NDArray[np.float64]) -> None:
        self._looked_at = time
        if self._first is None or angle(self._first[2], R_WS) > self._detector.settings.rotation:
            self._end_stop()
            self._first = (row, time, R_WS)
        self._last = (row, time)

    def _end_stop(self) -> None:
        if self._first is not None and self._last[1] - self._first[1] > _SHORTEST_STOP_S:
            self._stops.append((self._first[0], self._last[0] + 1, self._first[1], self._last[1]))
        self._first = None

    def _unused(self, first: int, last: int, start: float, stop: float) -> Rejected:
        settings = self._detector.settings
        needed = settings.window / 2 + settings.min_duration
        reason = (
            f"the robot stood for {stop - start:.1f} s only, and it takes {needed:.1f} s after all has settled"
            if stop - start < needed
            else "the robot stood, but the reading did not come to rest: vibration, a cable that moves, or a hand"
        )
        return Rejected(first, last, start, stop, StillState.MOVING, reason)


def in_order(reader: TableReader) -> Iterator[TableRows]:
    """
    Yield the blocks of a table whose first column is the time, s.

    Raises
    ------
    InputError
        As the reader's wording has it: time runs backwards.
    """
    latest = -np.inf
    for rows in reader:
        times = rows.numbers[:, 0]
        before = np.concatenate(([latest], times[:-1]))
        if (times < before).any():
            row = int(np.argmax(times < before))
            raise reader.error(
                f"column t runs backwards, from {before[row]:.10g} to {times[row]:.10g} s: sort the rows by time, or"
                " cut the table where the clock was set back.",
                int(rows.lines[row]),
            )
        latest = float(times[-1])
        yield rows
