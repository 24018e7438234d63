"""A sensor and a robot that were recorded into two tables, as the tracks that an MCAP file has."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.files.capture_file import in_order
from contactbench.pipeline.calibration.files.pose_csv import find_convention
from contactbench.pipeline.calibration.orientation import Convention, RowError, rotations
from contactbench.pipeline.contact.wrench_csv import CHANNELS, WrenchFileError
from contactbench.pipeline.recording import FlangeTrack, WrenchTrack
from contactbench.pipeline.tables import TableReader, Wording, open_table

if TYPE_CHECKING:
    from pathlib import Path
    from typing import BinaryIO

    from numpy.typing import NDArray

Progress = Callable[[int, int], None] | None


def read_wrench_track(source: Path | BinaryIO, progress: Progress = None) -> WrenchTrack:
    """
    Read the wrenches of a sensor from a table.

    Parameters
    ----------
    source : path or binary file
        Columns t (s), fx, fy, fz, mx, my, mz (raw readings, S, N and N·m); others are ignored. Empty cells are
        readings that are not used.
    progress : callable, optional
        Called after each block with the bytes read and the size of the source (0 if that is unknown).

    Raises
    ------
    WrenchFileError
        The table cannot be used; the message names file, line and column.
    """
    header = ",".join(("t", *CHANNELS))
    blocks = []
    with open_table(source, WrenchFileError) as (stream, name, size):
        reader = TableReader(stream, name, Wording(header, rows="readings", error=WrenchFileError))
        reader.select(("t", *CHANNELS), allow_nan=CHANNELS)
        for rows in in_order(reader):
            blocks.append(rows.numbers)
            if progress is not None:
                progress(reader.bytes_read, size)
    numbers = np.concatenate(blocks)
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
    file: Path, convention: Convention | None = None, progress: Progress = None
) -> FlangeTrack:
    """
    Read the orientations of a flange from a table.

    Parameters
    ----------
    file : path
        Columns t, s on the sensor's clock, and those of the orientation; others are ignored.
    convention : Convention, optional
        How orientations are written. Left out: quaternions, if there are no others beside them.
    progress : callable, optional
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
    with open_table(file, WrenchFileError) as (stream, name, size):
        reader = TableReader(stream, name, Wording(header, rows="poses", error=WrenchFileError))
        convention = find_convention(reader, convention)
        reader.select(("t", *convention.columns))
        for rows in in_order(reader):
            try:
                matrices.append(rotations(rows.numbers[:, 1:], convention))
            except RowError as error:
                raise reader.error(error.what, int(rows.lines[error.row])) from None
            times.append(rows.numbers[:, 0])
            if progress is not None:
                progress(reader.bytes_read, size)
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
