"""From a recording of a sensor and a robot, an MCAP file, to the still poses in it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from pipeline.calibration.files.capture_file import Captured, capture_file, captured
from pipeline.calibration.files.pose_csv import PoseTable, read_poses, sensor_orientations
from pipeline.calibration.orientation import Convention
from pipeline.calibration.stillness import StillnessDetector, StillnessSettings
from pipeline.errors import InputError
from pipeline.recording import RecordingError, read_recording
from pipeline.recording.convert import LONGEST_GAP, poses_at
from pipeline.recording.delay import estimate_delay

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import BinaryIO

    from numpy.typing import ArrayLike, NDArray

    from pipeline.calibration.model import GravityModel
    from pipeline.recording import FlangeTrack, Recording, WrenchTrack

_MAGIC = b"\x89MCAP0\r\n"
_BLOCK_ROWS = 20_000
_LONGEST_DELAY_S = 10.0

Delay = float | Literal["auto"] | None


def is_recording(source: Path | BinaryIO) -> bool:
    """Tell whether a file is a recording, by how it begins."""
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
        Also for a convention beside an MCAP file, which has orientations, and a delay beside a CSV file.
    """
    if is_recording(source) and isinstance(source, Path):
        if convention is not None:
            raise InputError(
                f"{source}: a recording says itself how its orientations are written: leave the convention out."
            )
        return capture_recording(
            source, R_ES=R_ES, settings=settings, model=model, delay=delay, progress=progress
        )
    if delay is not None:
        raise InputError(
            f"{source}: a table has wrench and pose in one row: a delay needs a recording, .mcap."
        )
    return capture_file(source, convention, R_ES=R_ES, settings=settings, model=model, progress=progress)


def capture_recording(
    file: Path,
    *,
    R_ES: ArrayLike | None = None,
    settings: StillnessSettings | None = None,
    model: GravityModel | None = None,
    delay: Delay = None,
    progress: Callable[[int, int], None] | None = None,
) -> Captured:
    """
    Find where a recording stands still, and average it there.

    The poses are those of the table that ``contactbench recording convert`` makes: the flange's orientation is
    interpolated to each wrench, never extrapolated, nor across a gap of more than 0.25 s. The base B must stand
    upright, for it is taken as W.

    Parameters
    ----------
    file : path
        One sensor and one robot.
    R_ES : array_like (3, 3), optional
        Orientation of the sensor in the flange.
    settings : StillnessSettings, optional
    model : GravityModel, optional
        A preliminary calibration, to see steady touches.
    delay : float or "auto", optional
        How much later a wrench is heard than its pose, s; see `estimate_delay`.
    progress : callable, optional
        Gets the bytes read so far, and those in the file.

    Raises
    ------
    RecordingError
        It is no recording, not of one sensor and one robot, has no poses beside the wrenches, or its motion does
        not show the delay.
    InputError
        R_ES is no rotation, or the delay no time.
    """
    recording = read_recording(file, progress)
    wrenches, poses = _only(file, recording)
    said = list(recording.warnings)
    seconds = _delay(file, wrenches, poses, delay, said)
    quaternions, there = poses_at(poses, wrenches.times - seconds)
    kept = _kept(file, wrenches, there, said)
    R_WS = sensor_orientations(quaternions[kept, :4], Convention(), R_ES)
    times, readings = wrenches.times[kept], wrenches.wrenches[kept]
    detector = StillnessDetector(None, settings, model)
    for begin in range(0, len(times), _BLOCK_ROWS):
        rows = slice(begin, begin + _BLOCK_ROWS)
        detector.update_block(times[rows], readings[rows], R_WS[rows])
    return captured(detector, len(times), tuple(said), None if delay is None else seconds)


def read_any_poses(
    source: Path | BinaryIO, convention: Convention | None = None, *, R_ES: ArrayLike | None = None
) -> PoseTable:
    """
    Read poses from a CSV file, or find them in a recording; see `read_poses`, `capture_recording`.

    The lines of poses that were found are their numbers; what was left out is among the warnings.
    """
    if not is_recording(source):
        return read_poses(source, convention, R_ES=R_ES)
    found = capture_any(source, convention, R_ES=R_ES)
    left_out = (
        f"left out, {each.start:.1f} to {each.stop:.1f} s: {each.reason}" for each in found.report.rejected
    )
    warnings = (*found.warnings, *left_out)
    if not found.poses:
        raise RecordingError(
            f"{source}: it stands still nowhere: hold each pose for some seconds, touching nothing."
            f" {' '.join(warnings)}"
        )
    quaternions = _quaternions(np.array([pose.R_WS for pose in found.poses]))
    return PoseTable(
        found.poses, quaternions, Convention(), None, np.arange(1, len(found.poses) + 1), warnings
    )


def _quaternions(R: NDArray[np.float64]) -> NDArray[np.float64]:
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(R).as_quat(canonical=True)[:, [3, 0, 1, 2]]


def _only(file: Path, recording: Recording) -> tuple[WrenchTrack, FlangeTrack]:
    if len(recording.wrenches) != 1 or len(recording.flanges) != 1:
        raise RecordingError(
            f"{file}: there are {len(recording.wrenches)} sensors and {len(recording.flanges)} robots in it: record one"
            " of each, the robot with --pose."
        )
    (wrenches,), (poses,) = recording.wrenches.values(), recording.flanges.values()
    return wrenches, poses


def _delay(file: Path, wrenches: WrenchTrack, poses: FlangeTrack, delay: Delay, said: list[str]) -> float:
    if delay == "auto":
        estimate = estimate_delay(wrenches, poses)
        if estimate.seconds is None:
            raise RecordingError(f"{file}: {estimate.sentence} Or give the delay in seconds.")
        said.append(estimate.sentence)
        return estimate.seconds
    seconds = 0.0 if delay is None else float(delay)
    if not abs(seconds) <= _LONGEST_DELAY_S:
        raise InputError(f"a delay of {seconds:g} s is none: give at most {_LONGEST_DELAY_S:g} s, or auto.")
    return seconds


def _kept(file: Path, wrenches: WrenchTrack, there: NDArray[np.bool_], said: list[str]) -> NDArray[np.bool_]:
    usable = wrenches.usable
    if bad := int(np.count_nonzero(~usable)):
        said.append(f"{bad:,} readings are left out: the device says they are no good.")
    if lost := int(np.count_nonzero(usable & ~there)):
        said.append(f"{lost:,} readings are left out: no pose within {LONGEST_GAP} s beside them.")
    kept: NDArray[np.bool_] = usable & there
    if not kept.any():
        raise RecordingError(f"{file}: no wrench with a pose beside it is left. {' '.join(said)}")
    return kept
