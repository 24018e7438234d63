"""From a recording of a robot that goes from pose to pose to the still poses in it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.calibration.files.pose_csv import (
    PoseTable,
    check_unit,
    find_convention,
    is_recorded_table,
    orientations_in,
    read_poses,
    sensor_orientations,
)
from contactbench.pipeline.calibration.model import GravityModel
from contactbench.pipeline.calibration.orientation import Convention
from contactbench.pipeline.calibration.poses import PoseSample
from contactbench.pipeline.calibration.stillness import Capture, Rejected, StillnessDetector, StillState
from contactbench.pipeline.calibration.stillness.captures import angle
from contactbench.pipeline.contact.wrench_csv import CHANNELS, WrenchFileError
from contactbench.pipeline.devices.pose_source import LONGEST_GAP_S
from contactbench.pipeline.errors import InputError, arg, join, message
from contactbench.pipeline.files import File, Progress, unheard
from contactbench.pipeline.recording import FlangeTrack, RecordingError, WrenchTrack, read_recording
from contactbench.pipeline.recording.clock_steps import ClockSteps
from contactbench.pipeline.recording.convert import poses_at, quaternions
from contactbench.pipeline.recording.delay import estimate_delay
from contactbench.pipeline.recording.wire import MAGIC
from contactbench.pipeline.tables import TableReader, TableRows, Wording, open_table

_BLOCK_ROWS = 65_536
_LONGEST_DELAY_S = 10.0
_MOST_STEPS = 9  # of a clock; a table with more is in no order

Delay = float | Literal["auto"] | None


def is_recording(source: File | BinaryIO) -> bool:
    """Tell whether a file is an MCAP recording, by how it begins."""
    if not isinstance(source, File):
        return False
    try:
        with source.open("rb") as stream:
            return stream.read(len(MAGIC)) == MAGIC
    except (OSError, ValueError):  # who reads it as a table says so better
        return False


def capture_poses(
    source: File | BinaryIO,
    convention: Convention | None = None,
    *,
    robot_poses: File | None = None,
    R_ES: ArrayLike | None = None,
    model: GravityModel | None = None,
    delay: Delay = None,
    progress: Progress = unheard,
) -> Captured:
    """
    Find where a sensor stood still while a robot held it, and average it there.

    Parameters
    ----------
    source : path or binary file
        An MCAP file of one sensor and one robot. Or a table: columns t (s), fx, fy, fz, mx, my, mz (raw readings, S, N
        and N·m) and those of the orientation at the same time, unless there are `robot_poses`; read in blocks; empty
        cells are missing samples.
    convention : Convention, optional
        How orientations in a table are written. Left out: quaternions, if there are no others beside them.
    robot_poses : path, optional
        The robot's own table, see `read_flange_track`.
    R_ES : array_like (3, 3), optional
        Orientation of the sensor in the flange, where orientations or joints are those of the flange E.
    model : GravityModel, optional
        A preliminary calibration, to see steady touches.
    delay : float or "auto", optional
        How much later a wrench is heard than its pose, s. An estimate that is doubtful is not applied, and the
        warnings say so; see `contactbench.pipeline.recording.delay`. Not for a table with poses in its rows.
    progress : callable, optional
        Gets the bytes read so far, and those in the file (0 if that is unknown).

    Raises
    ------
    WrenchFileError
        A table cannot be used; the message names file, line and column.
    RecordingError
        It is not of one sensor and one robot, has no poses beside the wrenches, or its motion does not show the delay.
    InputError
        What was given does not go together, R_ES is no rotation, the delay no time, or there is no such robot.
    """
    mcap = is_recording(source)
    if mcap and (convention is not None or robot_poses is not None):
        raise InputError(
            f"{arg(source)}: a recording states its own orientation convention and contains the robot's"
            " poses: leave out the convention and the robot's table."
        )
    work = Capturing(model)
    if mcap or robot_poses is not None:
        return _of_two(source, convention, robot_poses, R_ES, work, delay, progress)
    if delay is not None:
        raise InputError(
            f"{arg(source)}: a table has wrench and pose in one row, so a delay has no meaning: use a"
            " recording (.mcap), or a separate table of robot poses."
        )
    found = _of_table(source, convention, R_ES, work, progress)
    if found is None and isinstance(source, File):  # a table that was merged by time
        return _of_two(source, convention, source, R_ES, work, None, progress)
    if found is None:
        raise WrenchFileError(
            "standard input: readings and orientations are in different rows: save the table, and give the file."
        )
    return found


def _of_two(
    source: File | BinaryIO,
    convention: Convention | None,
    robot_poses: File | None,
    R_ES: ArrayLike | None,
    work: Capturing,
    delay: Delay,
    progress: Progress,
) -> Captured:
    """
    Capture where sensor and robot have times of their own.

    The flange's orientation is interpolated to each wrench, never extrapolated, nor across a gap of more than 0.25 s.
    The poses of an MCAP file are those of the table that ``contactbench record convert`` makes. The robot's base B is
    taken as W.
    """
    steps = ClockSteps()
    if robot_poses is None:
        assert isinstance(source, File)  # noqa: S101 - a stream is no recording
        recording = read_recording(source, progress)
        wrenches, poses = recording.pair(source)
        said = list(recording.warnings)
    else:
        said = []
        wrenches = read_wrench_track(source, progress, steps, said)
        poses = read_flange_track(robot_poses, convention, progress, steps, said)
        _check_overlap(source, robot_poses, wrenches, poses)
    if steps.apart():
        raise RecordingError(
            f"{arg(source)}: the clock was set back for one of the two only, so their times do not belong"
            " together: cut both before the step."
        )
    said.extend(steps.told())
    seconds = _delay(source, wrenches, poses, delay, said)
    bad = lost = kept = 0
    for begin in range(0, len(wrenches.times), _BLOCK_ROWS):
        rows = slice(begin, begin + _BLOCK_ROWS)
        usable = wrenches.usable[rows]
        quaternions, there = poses_at(poses, wrenches.times[rows] - seconds)
        good = usable & there
        bad += int(np.count_nonzero(~usable))
        lost += int(np.count_nonzero(usable & ~there))
        kept += int(np.count_nonzero(good))
        if good.any():
            R_WS = sensor_orientations(quaternions[good, :4], Convention(), R_ES)
            work.update(wrenches.times[rows][good], wrenches.wrenches[rows][good], R_WS)
    if bad:
        said.append(
            message(f"{arg(bad):,} readings left out: empty, frozen, or flagged as bad by the device.")
        )
    if lost:
        said.append(message(f"{arg(lost):,} readings left out: no pose within {arg(LONGEST_GAP_S)} s."))
    if not kept:
        raise RecordingError(
            f"{arg(source)}: no reading has a pose close enough in time. {arg(join(' ', said))}"
        )
    return work.finish(tuple(said), None if delay is None else seconds)


def read_any_poses(
    source: File,
    convention: Convention | None = None,
    *,
    robot_poses: File | None = None,
    R_ES: ArrayLike | None = None,
    delay: Delay = None,
    progress: Progress = unheard,
) -> PoseTable:
    """
    Read poses from a CSV file, or find them in a recording; see `read_poses`, `capture_poses`.

    A table of samples, by its column t, is a recording too. The lines of poses that were found are their numbers; the
    stretches that gave none are among the warnings.

    Raises
    ------
    InputError
        As those two, or the recording stands still nowhere.
    """
    if not (robot_poses is not None or is_recording(source) or is_recorded_table(source)):
        if delay is not None:
            raise InputError(f"{arg(source)}: a table of still poses has no delay: leave it out.")
        return read_poses(source, convention, R_ES=R_ES)
    found = capture_poses(
        source, convention, robot_poses=robot_poses, R_ES=R_ES, delay=delay, progress=progress
    )
    warnings = (*found.warnings, *found.left_out)
    if not found.poses:
        raise RecordingError(
            message(
                f"{arg(source)}: the recording contains no still pose: hold each pose for a few seconds"
                f" without touching anything. {arg(join(' ', warnings))}"
            ).strip()
        )
    raw = quaternions(np.array([pose.R_WS for pose in found.poses]))
    note = message(
        f"{arg(source)} is a recording: {arg(len(found.poses))} still poses found in {arg(found.rows):,} readings."
    )
    return PoseTable(
        found.poses, raw, Convention(), None, np.arange(1, len(found.poses) + 1), warnings, (note,)
    )


def _check_overlap(
    source: File | BinaryIO, robot_poses: File, wrenches: WrenchTrack, poses: FlangeTrack
) -> None:
    """Refuse tables whose times have nothing in common: two clocks, which no delay brings together."""
    (one, two), (three, four) = wrenches.times[[0, -1]], poses.times[[0, -1]]
    if two < three - _LONGEST_DELAY_S or four < one - _LONGEST_DELAY_S:
        raise RecordingError(
            f"{arg(source)}: column t runs from {arg(one):.10g} to {arg(two):.10g} s, that of {arg(robot_poses)} from"
            f" {arg(three):.10g} to {arg(four):.10g} s: they do not overlap. Write both with the same clock,"
            " in s."
        )


def _delay(
    source: File | BinaryIO, wrenches: WrenchTrack, poses: FlangeTrack, delay: Delay, said: list[str]
) -> float:
    if delay == "auto":
        estimate = estimate_delay(wrenches, poses)
        if estimate.seconds is None:
            raise RecordingError(f"{arg(source)}: {arg(estimate.sentence)} Or give the delay in seconds.")
        seconds, sentence = estimate.usable
        said.append(sentence)
        return seconds
    seconds = 0.0 if delay is None else float(delay)
    if not abs(seconds) <= _LONGEST_DELAY_S:
        raise InputError(
            f"a delay of {arg(seconds):g} s is out of range: give at most {arg(_LONGEST_DELAY_S):g} s, or auto."
        )
    return seconds


# A shorter stop was hardly meant for a pose. Between two looks a robot that moves has turned.
_SHORTEST_STOP_S, _LOOK_S = 0.7, 0.05
_HEADER = message("t,fx,fy,fz,mx,my,mz and the orientation")


@dataclass(frozen=True, eq=False)
class Captured:
    """The still poses of a recording."""

    poses: tuple[PoseSample, ...]  # For `calibrate`; their names say when they were taken
    captures: tuple[Capture, ...]  # The same, as the detector found them
    rejected: tuple[Rejected, ...]  # What was refused, and why, in order
    rows: int  # Of the recording
    warnings: tuple[str, ...] = ()  # What was noticed, in sentences
    delay: float | None = None  # That was asked for or estimated, s; see `capture_poses`

    @property
    def left_out(self) -> tuple[str, ...]:
        """The stretches that gave no pose, with the reasons: sentences."""
        return tuple(
            message(f"left out, {arg(each.start):.1f} to {arg(each.stop):.1f} s: {arg(each.reason)}")
            for each in self.rejected
        )


def _of_table(
    source: File | BinaryIO,
    convention: Convention | None,
    R_ES: ArrayLike | None,
    work: Capturing,
    progress: Progress,
) -> Captured | None:
    """Capture from the rows of one table; None: none of the first has both a reading and an orientation."""
    with open_table(source, WrenchFileError, lab=True) as (stream, name, size):
        reader = TableReader(stream, name, Wording(_HEADER, rows="readings", error=WrenchFileError))
        convention = find_convention(reader, convention)
        if "t" in reader.names and not set(convention.columns) & set(reader.names):
            what = message(
                f"there is no orientation ({arg(', '.join(convention.columns))}) beside the readings:"
                " add it, or give the robot's poses as a separate table, --robot-poses FILE."
            )
            raise reader.error(what, 1)
        wanted = ("t", *CHANNELS, *convention.columns)
        reader.select(wanted, allow_nan=wanted, leave_out=("t", *convention.columns))
        steps, some = ClockSteps(), False
        for rows in in_order(reader, steps, "t", progress, size):
            if not some and not np.isfinite(rows.numbers[:, 1 : 1 + len(CHANNELS)]).all(axis=1).any():
                return None
            some = True
            R_WS = orientations_in(reader, rows, rows.numbers[:, 1 + len(CHANNELS) :], convention, R_ES)
            work.update(rows.numbers[:, 0], rows.numbers[:, 1 : 1 + len(CHANNELS)], R_WS)
    return work.finish((*steps.told(), *reader.left_out()))


class Capturing:
    """
    Finds the still poses of a recording, block by block, and every stop of the robot that gave none.

    Parameters
    ----------
    model : GravityModel, optional
        A preliminary calibration, to see steady touches.
    """

    def __init__(self, model: GravityModel | None = None) -> None:
        self._detector = StillnessDetector(None, None, model)
        self._rows = 0
        self._looked_at = -np.inf
        self._first: tuple[int, float, NDArray[np.float64]] | None = None  # of the stop: row, time, R_WS
        self._last = (0, 0.0)
        self._span = np.inf, -np.inf
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
        self._span = min(self._span[0], float(times[0])), float(times[-1])
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
        poses = tuple(
            capture.to_pose(name=message(f"pose {arg(number)} at {arg(capture.start):.1f} s"))
            for number, capture in enumerate(captures, 1)
        )
        refused = tuple(sorted((*rejected, *unused), key=lambda each: each.start))
        span = self._span[1] - self._span[0]
        if not captures and 0 < span < self._detector.shortest_stop:
            short = message(
                f"By their times the {arg(self._rows):,} readings span {arg(span):.3g} s, too short for a still pose:"
                " times must be in s. If they are in minutes, name the column t_min."
            )
            warnings = (*warnings, short)
        return Captured(poses, tuple(captures), refused, self._rows, warnings, delay)

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
        needed = self._detector.shortest_stop
        reason = message(
            "the robot stood still, but the reading did not settle: vibration, a moving cable, or a hand"
        )
        if stop - start < needed:
            reason = message(
                f"the robot stood for only {arg(stop - start):.1f} s; {arg(needed):.1f} s after settling are needed"
            )
        return Rejected(first, last, start, stop, StillState.MOVING, reason)


def in_order(
    reader: TableReader, steps: ClockSteps, topic: str, progress: Progress = unheard, size: int = 0
) -> Iterator[TableRows]:
    """
    Yield the blocks of a table whose first column is the time, s; in order also where the clock was set back.

    Parameters
    ----------
    reader : TableReader
    steps : ClockSteps
        Those of all tables with this clock.
    topic : str
        What `steps` calls this table.
    progress : callable, optional
        Called after each block with the bytes read and the size.
    size : int
        Of the table, in bytes; 0 if that is unknown.

    Raises
    ------
    InputError
        As the reader's wording has it: time runs backwards again and again, or is not in s.
    """
    latest, last = -np.inf, np.nan
    steps.begin(topic)
    for rows in reader:
        if np.isnan(last):  # the first block
            check_unit(reader, rows.numbers[:, 0])
        given = rows.numbers[:, 0].copy()
        rows.numbers[:, 0] = times = steps.all_at(topic, given)
        before = np.concatenate(([latest], times[:-1]))
        if (times < before).any() or len(steps.steps) > _MOST_STEPS:
            change = np.diff(given, prepend=last)
            row = int(np.nanargmin(change))
            what = message(
                f"column t runs backwards, from {arg(given[row] - change[row]):.10g} to {arg(given[row]):.10g} s:"
                " sort the rows by time, or cut the table where the clock was set back."
            )
            raise reader.error(what, int(rows.lines[row]))
        latest, last = float(times[-1]), float(given[-1])
        yield rows
        progress(reader.bytes_read, size)


def read_wrench_track(
    source: File | BinaryIO, progress: Progress, steps: ClockSteps, said: list[str]
) -> WrenchTrack:
    """
    Read the wrenches of a sensor from a table.

    Parameters
    ----------
    source : path or binary file
        Columns t (s), fx, fy, fz, mx, my, mz (raw readings, S, N and N·m); others are ignored. Empty cells are
        readings that are not used.
    progress : callable, optional
        See `in_order`.
    steps : ClockSteps
        Gets when the clock was set.
    said : list of str
        Gets how many rows were left out, and why.

    Raises
    ------
    WrenchFileError
        The table cannot be used; the message names file, line and column.
    """
    header = ",".join(("t", *CHANNELS))
    with open_table(source, WrenchFileError, lab=True) as (stream, name, size):
        reader = TableReader(stream, name, Wording(header, rows="readings", error=WrenchFileError))
        reader.select(("t", *CHANNELS), allow_nan=CHANNELS, leave_out=("t",))
        numbers = np.concatenate([rows.numbers for rows in in_order(reader, steps, "wrench", progress, size)])
        said.extend(reader.left_out())
    unknown, none = np.full(len(numbers), np.nan), np.zeros(len(numbers), dtype=np.int64)
    return WrenchTrack(
        times=numbers[:, 0].copy(),
        wrenches=numbers[:, 1:].copy(),
        sequence=none - 1,
        status=none,
        device_time=unknown,
        temperature=unknown,
        arrivals=unknown,
    )


def read_flange_track(
    file: File, convention: Convention | None, progress: Progress, steps: ClockSteps, said: list[str]
) -> FlangeTrack:
    """
    Read the orientations of a flange from a table.

    Parameters
    ----------
    file : path
        Columns t, s on the sensor's clock, and those of the orientation; others are ignored.
    convention : Convention, optional
        How orientations are written. Left out: quaternions, if there are no others beside them.
    progress, steps, said
        As for `read_wrench_track`.

    Raises
    ------
    WrenchFileError
        The table cannot be used; the message names file, line and column.
    InputError
        There is no such robot.
    """
    header = ",".join(("t", *(convention or Convention()).columns))
    times: list[NDArray[np.float64]] = []
    matrices: list[NDArray[np.float64]] = []
    with open_table(file, WrenchFileError, lab=True) as (stream, name, size):
        reader = TableReader(stream, name, Wording(header, rows="poses", error=WrenchFileError))
        convention = find_convention(reader, convention)
        reader.select(("t", *convention.columns), leave_out=("t", *convention.columns))
        for rows in in_order(reader, steps, "flange", progress, size):
            matrices.append(orientations_in(reader, rows, rows.numbers[:, 1:], convention, None))
            times.append(rows.numbers[:, 0])
        said.extend(reader.left_out())
    R_BE = np.concatenate(matrices)
    unknown = np.full(len(R_BE), np.nan)
    return FlangeTrack(
        times=np.concatenate(times),
        R_BE=R_BE,
        p_BE_B=np.full((len(R_BE), 3), np.nan),
        joints=np.empty((len(R_BE), 0)),
        device_time=unknown,
        arrivals=unknown,
    )
