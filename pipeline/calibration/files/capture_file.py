"""From a recording of a robot that goes from pose to pose to the still poses in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from pipeline.calibration.files.pose_csv import find_convention, sensor_orientations
from pipeline.calibration.orientation import RowError
from pipeline.calibration.stillness import CaptureReport, StillnessDetector, StillnessSettings
from pipeline.contact.wrench_csv import CHANNELS, WrenchFileError
from pipeline.tables import TableReader, Wording, open_table

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from typing import BinaryIO

    from numpy.typing import ArrayLike

    from pipeline.calibration.model import GravityModel
    from pipeline.calibration.orientation import Convention
    from pipeline.calibration.poses import PoseSample

_HEADER = "t,fx,fy,fz,mx,my,mz and the orientation"


@dataclass(frozen=True, eq=False)
class Captured:
    """The still poses of a recording.

    Attributes
    ----------
    poses : tuple of PoseSample
        For `calibrate`; their names say when they were taken.
    report : CaptureReport
        With what was refused, and why.
    rows : int
        Of the recording.
    warnings : tuple of str
        What was noticed, in sentences.
    delay : float or None
        That was asked for or estimated, s; see `capture_recording`.
    """

    poses: tuple[PoseSample, ...]
    report: CaptureReport
    rows: int
    warnings: tuple[str, ...] = ()
    delay: float | None = None


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
    detector = StillnessDetector(None, settings, model)
    rows_read = 0
    with open_table(source, WrenchFileError) as (stream, name, size):
        reader = TableReader(stream, name, Wording(_HEADER, rows="readings", error=WrenchFileError))
        convention = find_convention(reader, convention)
        reader.select(("t", *CHANNELS, *convention.columns), allow_nan=CHANNELS)
        for rows in reader:
            values = rows.numbers[:, 1 + len(CHANNELS) :]
            try:
                R_WS = sensor_orientations(values, convention, R_ES)
            except RowError as error:
                raise reader.error(error.what, int(rows.lines[error.row])) from None
            detector.update_block(rows.numbers[:, 0], rows.numbers[:, 1 : 1 + len(CHANNELS)], R_WS)
            rows_read += len(rows.numbers)
            if progress is not None:
                progress(reader.bytes_read, size)
    return captured(detector, rows_read)


def captured(
    detector: StillnessDetector, rows: int, warnings: tuple[str, ...] = (), delay: float | None = None
) -> Captured:
    """Return what a detector found in a recording that has ended."""
    detector.finish()
    report = CaptureReport(tuple(detector.captures), tuple(detector.rejected))
    poses = tuple(
        capture.to_pose(name=f"pose {number} at {capture.start:.1f} s")
        for number, capture in enumerate(report.captures, 1)
    )
    return Captured(poses, report, rows, warnings, delay)
