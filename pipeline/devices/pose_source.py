"""Poses that are typed or read from a CSV file, and where the flange was, is, or is about to be."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline import kernel
from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.sample import FlangeSample
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.tables import TableError, TableReader, TableRows, Wording, read_table

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from contactbench.pipeline.devices.stream import SourceStream
    from contactbench.pipeline.devices.url import DeviceAddress
    from contactbench.pipeline.robot import Robot

LONGEST_GAP_S = 0.25
Track = Callable[[float], Iterator[FlangeSample]]

_QUATERNION, _POSITION = ("qw", "qx", "qy", "qz"), ("x", "y", "z")
_UNIT = 0.02  # a quaternion written with two digits is this far from unit length
_FARTHEST_M = 1e3  # beyond, it is no position in metres
_LONGEST_S = 1e9  # as far as times still have a tenth of a microsecond
_MOST_ROWS = 2_000_000
_SLICE_S = 0.02  # poses of this time are given together, as a line would


class PacedPoses:
    """
    The source of one stream: a track of poses from the moment of its start, on the host's monotonic clock.

    Parameters
    ----------
    track : callable
        Gets the time of the start, s, and returns the poses with their times, oldest first; it may be endless.
    """

    stepwise = False

    def __init__(self, track: Track) -> None:
        self._track = track
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def time(self) -> float:
        """As `Source`."""
        return time.monotonic()

    def join(self, stream: SourceStream[FlangeSample]) -> None:
        """Begin, in a thread of its own."""
        self._thread = threading.Thread(
            target=self._run, args=(stream,), name=str(stream.address), daemon=True
        )
        self._thread.start()

    def leave(self, _stream: SourceStream[FlangeSample]) -> None:
        """End it."""
        self._stopping.set()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()

    def step(self, count: int) -> int:
        """Give nothing: it does not go by steps."""
        del count
        return 0

    def _run(self, stream: SourceStream[FlangeSample]) -> None:
        batch: list[FlangeSample] = []
        for pose in self._track(time.monotonic()):
            if batch and pose.time - batch[0].time > _SLICE_S:
                self._pass(stream, batch)
                batch = []
            if self._stopping.is_set():
                return
            batch.append(pose)
        self._pass(stream, batch)
        if not self._stopping.is_set():
            stream.end()

    def _pass(self, stream: SourceStream[FlangeSample], batch: list[FlangeSample]) -> None:
        # None before its time, and none later than a slice after it.
        wait = batch[-1].time - time.monotonic()
        if not self._stopping.wait(min(max(0.0, wait), threading.TIMEOUT_MAX)):
            stream.take(batch)


class PoseTrackError(TableError):
    """A file of poses that cannot be replayed: names the file, the line, and the remedy."""


def still_track(address: DeviceAddress) -> Track:
    """
    Return the track of a pose that was typed: the same one at the address's rate, without end.

    Raises
    ------
    AddressError
        There is no such robot, or its joints cannot be like that.
    InputError
        MuJoCo, which joints need, is not installed.
    """
    R_BE, p_BE_B, joints = _typed(address)
    period = 1.0 / (address.rate or 10.0)

    def track(start: float) -> Iterator[FlangeSample]:
        # Multiplied, not added up: rounding would let it drift.
        return (FlangeSample(start + index * period, R_BE, p_BE_B, joints) for index in count())

    return track


def file_track(address: DeviceAddress) -> Track:
    """
    Return the track of a CSV file with a header: t (s) and the flange E in the base B.

    It is qw, qx, qy, qz (scalar first, v_B = R v_E) and, where known, x, y, z (m); or, if the address names a robot,
    j1, j2, ... (degrees). Other columns are ignored.

    Raises
    ------
    PoseTrackError
        The file cannot be used; names the line and the remedy.
    AddressError
        There is no such robot.
    InputError
        MuJoCo, which joints need, is not installed.
    """
    robot = None if address.robot is None else _robot(address)
    names = _QUATERNION if robot is None else tuple(f"j{n + 1}" for n in range(len(robot.lower)))
    wording = Wording(
        header=",".join(("t", *names)),
        rows="poses",
        meaning=message(
            "time in s and the flange pose in the robot's base as a quaternion; joints, in degrees,"
            " need ?robot=NAME"
        ),
        error=PoseTrackError,
    )
    table = _Table(names, _POSITION if robot is None else ())
    rows = read_table(Path(address.path), table, wording, row_limit=_MOST_ROWS, lab=True)
    times = _times(table.reader, rows)
    values = np.column_stack([rows.column(name) for name in names])
    if robot is not None:
        return _joint_track(robot, np.radians(values), times / (address.speed or 1.0))
    positions = _positions(table.reader, rows)
    return _quaternion_track(_unit(table.reader, rows, values), positions, times / (address.speed or 1.0))


# ---- typed -------------------------------------------------------------------------------------


def _typed(
    address: DeviceAddress,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | None]:
    from scipy.spatial.transform import Rotation  # a third of a second to import

    nowhere = np.full(3, np.nan)
    if address.rpy_degrees is not None:
        # Lower case: about fixed axes, one after the other.
        return Rotation.from_euler("xyz", address.rpy_degrees, degrees=True).as_matrix(), nowhere, None
    if address.quaternion is not None:
        return Rotation.from_quat(address.quaternion, scalar_first=True).as_matrix(), nowhere, None
    robot = _robot(address)
    joints = np.radians(address.joints_degrees or ())
    try:
        robot.check_joints(joints)
    except InputError as error:
        raise AddressError(f"address {arg(str(address))!r}: joints: {arg(error)}") from error
    return *robot.flange_pose(joints), joints


def _robot(address: DeviceAddress) -> Robot:
    from contactbench.pipeline.robot import Robot as Known

    try:
        return Known.named(address.robot or "")
    except InputError as error:
        raise AddressError(f"address {arg(str(address))!r}: robot: {arg(error)}") from error


# ---- from a file -------------------------------------------------------------------------------


class _Table:
    """Chooses the columns, and keeps the reader, which words errors."""

    reader: TableReader

    def __init__(self, names: tuple[str, ...], position: tuple[str, ...]) -> None:
        self._names, self._position = names, position

    def __call__(self, reader: TableReader) -> None:
        self.reader = reader
        there = [name in reader.names for name in self._position]
        if any(there) and not all(there):
            raise reader.error(
                message("a position needs all of x, y, z: add the missing columns, or rename the others."), 1
            )
        reader.select(("t", *self._names), optional=self._position, allow_nan=self._position)


def _times(reader: TableReader, rows: TableRows) -> NDArray[np.float64]:
    """Return (n,) times since the first, s."""
    times: NDArray[np.float64] = rows.column("t") - rows.column("t")[0]
    wrong = np.append(False, np.diff(times) < 0) | ~(np.abs(times) <= _LONGEST_S)
    if wrong.any():
        what = message("column t runs backwards or jumps far: sort the rows by time, and write seconds.")
        raise reader.error(what, int(rows.lines[int(np.argmax(wrong))]))
    return times


def _unit(reader: TableReader, rows: TableRows, quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    with np.errstate(over="ignore"):  # what overflows is not of length 1
        sizes = np.linalg.norm(quaternions, axis=1)
    wrong = ~(np.abs(sizes - 1) <= _UNIT)
    if wrong.any():
        row = int(np.argmax(wrong))
        what = message(
            f"the quaternion has length {arg(sizes[row]):.3g} instead of 1: check the columns qw, qx, qy, qz."
        )
        raise reader.error(what, int(rows.lines[row]))
    return np.asarray(quaternions / sizes[:, None])


def _positions(reader: TableReader, rows: TableRows) -> NDArray[np.float64]:
    if _POSITION[0] not in rows.columns:
        return np.full((len(rows.lines), 3), np.nan)
    positions = np.column_stack([rows.column(name) for name in _POSITION])
    wrong = (np.abs(positions) > _FARTHEST_M).any(axis=1)
    if wrong.any():
        what = message(f"a position is more than {arg(_FARTHEST_M):g} m away: write x, y, z in metres.")
        raise reader.error(what, int(rows.lines[int(np.argmax(wrong))]))
    return positions


def _quaternion_track(
    quaternions: NDArray[np.float64], positions: NDArray[np.float64], times: NDArray[np.float64]
) -> Track:
    from scipy.spatial.transform import Rotation

    R_BE = Rotation.from_quat(quaternions[:, [1, 2, 3, 0]]).as_matrix()

    def track(start: float) -> Iterator[FlangeSample]:
        for moment, R, p in zip(times.tolist(), R_BE, positions, strict=True):
            yield FlangeSample(start + moment, R, p)

    return track


def _joint_track(robot: Robot, joints: NDArray[np.float64], times: NDArray[np.float64]) -> Track:
    robot.flange_pose(joints[0])  # says at once where MuJoCo is missing

    def track(start: float) -> Iterator[FlangeSample]:
        for moment, q in zip(times.tolist(), joints, strict=True):
            yield FlangeSample(start + moment, *robot.flange_pose(q), q)

    return track


"""Between two poses: beyond, nothing is interpolated."""
LONGEST_AHEAD_S = 0.15
"""After the last pose: so far it is carried on by the last twist. Poses of 10 Hz with jitter cover every sample."""

_KEPT = 512
_IDENTITY, _ORTHOGONAL = np.eye(3), 1e-3


def poses_at(
    moments: NDArray[np.float64],
    R: NDArray[np.float64],
    p: NDArray[np.float64],
    times: NDArray[np.float64],
    *,
    longest_gap: float = LONGEST_GAP_S,
    longest_ahead: float = LONGEST_AHEAD_S,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Return the poses at some times, by the rule of the runtime (``pose_track.hpp``), to the last bit.

    Between two poses: the shortest turn and a straight line. After the last one, or in a longer gap: carried on by the
    last twist.

    Parameters
    ----------
    moments : (n,)
        Times of the poses, s. Of those that do not increase, the later ones in the array are left out.
    R : (n, 3, 3)
    p : (n, 3)
        m; NaN where it is not known.
    times : (m,)
        s.
    longest_gap, longest_ahead : float
        s.

    Returns
    -------
    R : (m, 3, 3)
    p : (m, 3)
        NaN where there is none.
    """
    usable = np.isfinite(moments) & np.isfinite(R).all(axis=(1, 2))
    latest = np.maximum.accumulate(np.where(usable, moments, -np.inf))
    usable &= np.r_[True, moments[1:] > latest[:-1]] if len(moments) else usable
    if not usable.all():
        moments, R, p = moments[usable], R[usable], p[usable]
    return kernel.poses_at(
        np.ascontiguousarray(moments, dtype=np.float64),
        np.ascontiguousarray(R, dtype=np.float64),
        np.ascontiguousarray(p, dtype=np.float64),
        np.ascontiguousarray(times, dtype=np.float64),
        longest_gap,
        longest_ahead,
    )


class PoseTrack:
    """
    The newest poses of the flange, asked for the sensor's orientation at any time among them.

    Poses may come in one thread and be asked for in another.

    Parameters
    ----------
    R_ES : (3, 3)
        How the sensor is mounted on the flange.
    """

    def __init__(self, R_ES: NDArray[np.float64]) -> None:
        self._R_ES = R_ES
        self._poses: deque[tuple[float, NDArray[np.float64]]] = deque(maxlen=_KEPT)
        self._lock = threading.Lock()

    @property
    def newest(self) -> float:
        """Time of the newest pose, s; minus infinity before the first."""
        with self._lock:
            return self._poses[-1][0] if self._poses else -np.inf

    def add(self, samples: Iterable[FlangeSample]) -> None:
        """Take poses, oldest first; one that is no rotation is left out."""
        with self._lock:
            for sample in samples:
                R = np.asarray(sample.R_BE, dtype=np.float64)
                if not (np.abs(R.T @ R - _IDENTITY) <= _ORTHOGONAL).all() or np.linalg.det(R) < 0:
                    continue
                if self._poses and sample.time < self._poses[-1][0] - LONGEST_GAP_S:
                    self._poses.clear()  # the clock was set back
                if not self._poses or sample.time > self._poses[-1][0]:
                    self._poses.append((sample.time, R))

    def at(self, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return R_WS (n, 3, 3) at times (n,), s; NaN where none is near enough."""
        with self._lock:
            poses = tuple(self._poses)
        if not poses or not len(times):
            return np.full((len(times), 3, 3), np.nan)
        # Only those around the samples: handing over hundreds of matrices for each block would cost more than all else.
        moments = np.array([time for time, _ in poses])
        first = max(int(np.searchsorted(moments, times.min() - LONGEST_GAP_S)) - 1, 0)
        last = min(int(np.searchsorted(moments, times.max())) + 2, len(moments))
        nowhere = np.full((last - first, 3), np.nan)
        R_WE, _ = poses_at(moments[first:last], np.array([R for _, R in poses[first:last]]), nowhere, times)
        return R_WE @ self._R_ES
