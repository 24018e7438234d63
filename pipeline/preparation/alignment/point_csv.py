"""Matching points from CSV: a point of the mesh and its place in the sensor frame, a row each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.errors import message
from contactbench.pipeline.preparation.alignment.errors import AlignmentError
from contactbench.pipeline.tables import TableError, TableReader, Wording, read_table

if TYPE_CHECKING:
    from pathlib import Path
    from typing import BinaryIO

    import numpy as np
    from numpy.typing import NDArray

COLUMNS = ("px", "py", "pz", "sx", "sy", "sz")
_MOST = 10_000


class PointFileError(TableError, AlignmentError):
    """A file of points that cannot be used: names the file, the line, and the remedy."""


_WORDING = Wording(
    header=",".join(COLUMNS),
    rows="points",
    meaning=message("a point in the mesh's frame and the same point in the sensor frame S, mm"),
    not_finite=message("remove the row, or measure the point again."),
    error=PointFileError,
)


def read_points(source: Path | BinaryIO) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Read matching points.

    Parameters
    ----------
    source : path or binary file
        CSV with the columns px,py,pz (mm, in P) and sx,sy,sz (mm, in S), in any order; others are ignored.

    Returns
    -------
    points_P, points_S : (n, 3) float64
        Metres.

    Raises
    ------
    PointFileError
        The file is missing, too long, not a table, or holds numbers that are not finite.
    """

    def select(reader: TableReader) -> None:
        reader.select(COLUMNS)

    rows = read_table(source, select, _WORDING, row_limit=_MOST)
    return rows.numbers[:, :3] / 1e3, rows.numbers[:, 3:6] / 1e3
