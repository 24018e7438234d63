"""From a recording of a sensor and a robot, in whichever way it is written, to the still poses in it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from contactbench.pipeline.calibration.files.capture_file import Captured, Capturing, capture_file
from contactbench.pipeline.calibration.files.pose_csv import (
    PoseTable,
    is_recorded_table,
    read_poses,
    sensor_orientations,
)
from contactbench.pipeline.calibration.files.track_tables import read_flange_track, read_wrench_track
from contactbench.pipeline.calibration.orientation import Convention
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.recording import RecordingError, read_recording
from contactbench.pipeline.recording.convert import LONGEST_GAP, poses_at
from contactbench.pipeline.recording.delay import estimate_delay

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import BinaryIO

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration.model import GravityModel
    from contactbench.pipeline.calibration.stillness import StillnessSettings
    from contactbench.pipeline.recording import FlangeTrack, Recording, WrenchTrack

_MAGIC = b"\x89MCAP0\r\n"
_BLOCK_ROWS = 20_000
_LONGEST_DELAY_S = 10.0

Delay = float | Literal["auto"] | None


def is_recording(source: Path | BinaryIO) -> bool:
    """Tell whether a file is an MCAP recording, by how it begins."""
    if not isinstance(source, Path):
        return False
    try:
        with source.open("rb") as stream:
            return stream.read(len(_MAGIC)) == _MAGIC
    except (OSError, ValueError):  # who reads it as a table says so better
        return False


def capture_any(
    source: Path | BinaryIO,
    convention: Convention | None = None,
    *,
    robot_poses: Path | None = None,
    R_ES: ArrayLike | None = None,
    settings: StillnessSettings | None = None,
    model: GravityModel | None = None,
    delay: Delay = None,
    progress: Callable[[int, int], None] | None = None,
) -> Captured:
    """
    Find where a recording stands still, in whichever way it is written; see `capture_file`, `capture_recording`.

    Raises
    ------
    InputError
        Also where what was given does not go together: a convention or a table of the robot beside an MCAP file, which
        has orientations, and a delay beside a table that has them in its rows.
    """
    mcap = is_recording(source)
    if mcap and (convention is not None or robot_poses is not None):
        raise InputError(
            f"{source}: a recording says itself how its orientations are written, and has the robot's: leave the"
            " convention out, and the robot's table."
        )
    if mcap or robot_poses is not None:
        return capture_recording(
            source,
            convention,
            robot_poses=robot_poses,
            R_ES=R_ES,
            settings=settings,
            model=model,
            delay=delay,
            progress=progress,
        )
    if delay is not None:
        raise InputError(
            f"{source}: a table has wrench and pose in one row: a delay needs a recording, .mcap, or the robot's poses"
            " as a table of their own."
        )
    return capture_file(source, convention, R_ES=R_ES, settings=settings, model=model, progress=progress)


def capture_recording(
    source: Path | BinaryIO,
    convention: Convention | None = None,
    *,
    robot_poses: Path | None = None,
    R_ES: ArrayLike | None = None,
    settings: StillnessSettings | None = None,
    model: GravityModel | None = None,
    delay: Delay = None,
    progress: Callable[[int, int], None] | None = None,
) -> Captured:
    """
    Find where a sensor stood still while a robot held it, and average it there.

    Sensor and robot have times of their own: the flange's orientation is interpolated to each wrench, never
    extrapolated, nor across a gap of more than 0.25 s. The poses of an MCAP file are those of the table that
    ``contactbench recording convert`` makes. The robot's base B is taken as W.

    Parameters
    ----------
    source : path or binary file
        An MCAP file of one sensor and one robot; with `robot_poses`, the sensor's table, see `read_wrench_track`.
    convention : Convention, optional
        How the orientations in `robot_poses` are written.
    robot_poses : path, optional
        The robot's table, see `read_flange_track`.
    R_ES : array_like (3, 3), optional
        Orientation of the sensor in the flange.
    settings : StillnessSettings, optional
    model : GravityModel, optional
        A preliminary calibration, to see steady touches.
    delay : float or "auto", optional
        How much later a wrench is heard than its pose, s. An estimate that is doubtful is not applied, and the
        warnings say so; see `contactbench.pipeline.recording.delay`.
    progress : callable, optional
        Gets the bytes read so far, and those in the file.

    Raises
    ------
    RecordingError
        It is not of one sensor and one robot, has no poses beside the wrenches, or its motion does not show the
        delay.
    WrenchFileError
        A table cannot be used; the message names file, line and column.
    InputError
        R_ES is no rotation, or the delay no time.
    """
    if robot_poses is None:
        recording = read_recording(Path(str(source)), progress)
        wrenches, poses = _only(source, recording)
        said = list(recording.warnings)
    else:
        wrenches = read_wrench_track(source, progress)
        poses = read_flange_track(robot_poses, convention, progress)
        said = []
        _check_overlap(source, robot_poses, wrenches, poses)
    seconds = _delay(source, wrenches, poses, delay, said)
    quaternions, there = poses_at(poses, wrenches.times - seconds)
    kept = _kept(source, wrenches, there, said)
    R_WS = sensor_orientations(quaternions[kept, :4], Convention(), R_ES)
    times, readings = wrenches.times[kept], wrenches.wrenches[kept]
    work = Capturing(settings, model)
    for begin in range(0, len(times), _BLOCK_ROWS):
        rows = slice(begin, begin + _BLOCK_ROWS)
        work.update(times[rows], readings[rows], R_WS[rows])
    return work.finish(tuple(said), None if delay is None else seconds)


def read_any_poses(
    source: Path,
    convention: Convention | None = None,
    *,
    robot_poses: Path | None = None,
    R_ES: ArrayLike | None = None,
    delay: Delay = None,
    progress: Callable[[int, int], None] | None = None,
) -> PoseTable:
    """
    Read poses from a CSV file, or find them in a recording; see `read_poses`, `capture_any`.

    A table of samples, by its column t, is a recording too. The lines of poses that were found are their numbers; the
    stretches that gave none are among the warnings.

    Raises
    ------
    InputError
        As those two, or the recording stands still nowhere.
    """
    if not (robot_poses is not None or is_recording(source) or is_recorded_table(source)):
        if delay is not None:
            raise InputError(f"{source}: a table of still poses has no delay: leave it out.")
        return read_poses(source, convention, R_ES=R_ES)
    found = capture_any(
        source, convention, robot_poses=robot_poses, R_ES=R_ES, delay=delay, progress=progress
    )
    warnings = (*found.warnings, *found.left_out)
    if not found.poses:
        raise RecordingError(
            f"{source}: this is a recording that stands still nowhere: hold each pose for some seconds, touching"
            f" nothing. {' '.join(warnings)}".rstrip()
        )
    quaternions = _quaternions(np.array([pose.R_WS for pose in found.poses]))
    note = f"{source} is a recording: {len(found.poses)} still poses found in {found.rows:,} readings."
    return PoseTable(
        found.poses, quaternions, Convention(), None, np.arange(1, len(found.poses) + 1), warnings, (note,)
    )


def _quaternions(R: NDArray[np.float64]) -> NDArray[np.float64]:
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(R).as_quat(canonical=True)[:, [3, 0, 1, 2]]


def _only(source: Path | BinaryIO, recording: Recording) -> tuple[WrenchTrack, FlangeTrack]:
    if len(recording.wrenches) != 1 or len(recording.flanges) != 1:
        raise RecordingError(
            f"{source}: there are {len(recording.wrenches)} sensors and {len(recording.flanges)} robots in it: record"
            " one of each, the robot with --pose."
        )
    (wrenches,), (poses,) = recording.wrenches.values(), recording.flanges.values()
    return wrenches, poses


def _check_overlap(
    source: Path | BinaryIO, robot_poses: Path, wrenches: WrenchTrack, poses: FlangeTrack
) -> None:
    """Refuse tables whose times have nothing in common: two clocks, which no delay brings together."""
    (one, two), (three, four) = wrenches.times[[0, -1]], poses.times[[0, -1]]
    if two < three - _LONGEST_DELAY_S or four < one - _LONGEST_DELAY_S:
        raise RecordingError(
            f"{source}: column t runs from {one:.10g} to {two:.10g} s, that of {robot_poses} from {three:.10g} to"
            f" {four:.10g} s: nothing was recorded at the same time. Write both with one clock, in s."
        )


def _delay(
    source: Path | BinaryIO, wrenches: WrenchTrack, poses: FlangeTrack, delay: Delay, said: list[str]
) -> float:
    if delay == "auto":
        estimate = estimate_delay(wrenches, poses)
        if estimate.seconds is None:
            raise RecordingError(f"{source}: {estimate.sentence} Or give the delay in seconds.")
        seconds, sentence = estimate.usable
        said.append(sentence)
        return seconds
    seconds = 0.0 if delay is None else float(delay)
    if not abs(seconds) <= _LONGEST_DELAY_S:
        raise InputError(f"a delay of {seconds:g} s is none: give at most {_LONGEST_DELAY_S:g} s, or auto.")
    return seconds


def _kept(
    source: Path | BinaryIO, wrenches: WrenchTrack, there: NDArray[np.bool_], said: list[str]
) -> NDArray[np.bool_]:
    usable = wrenches.usable
    if bad := int(np.count_nonzero(~usable)):
        said.append(f"{bad:,} readings are left out: empty, frozen, or no good by what the device says.")
    if lost := int(np.count_nonzero(usable & ~there)):
        said.append(f"{lost:,} readings are left out: no pose within {LONGEST_GAP} s beside them.")
    kept: NDArray[np.bool_] = usable & there
    if not kept.any():
        raise RecordingError(f"{source}: no wrench with a pose beside it is left. {' '.join(said)}")
    return kept
