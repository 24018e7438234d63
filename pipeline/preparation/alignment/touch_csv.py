"""Touches of marked points from CSV: a marker in the mesh's frame and the wrench felt there, a row each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactbench.pipeline.contact.wrench_csv import CHANNELS
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.preparation.alignment.errors import AlignmentError
from contactbench.pipeline.preparation.alignment.touches.marker import MarkerTouches
from contactbench.pipeline.tables import TableError, TableReader, Wording, read_table

if TYPE_CHECKING:
    from pathlib import Path
    from typing import BinaryIO

POINT = ("px", "py", "pz")
NORMAL = ("nx", "ny", "nz")
NAME = "marker"
_MOST = 10_000


class TouchFileError(TableError, AlignmentError):
    """A file of touches that cannot be used: names the file, the line, and the remedy."""


_WORDING = Wording(
    header=",".join((*POINT, *CHANNELS)),
    rows="touches",
    meaning=message(
        "markers in mm in the mesh's frame, forces in N and torques in N·m in the sensor frame S; nx,ny,nz (the"
        " outward normal) and marker (a name) may be added"
    ),
    not_finite=message("remove the row, or touch the marker again."),
    text=message("the name of a marker"),
    error=TouchFileError,
)


def read_touches(source: Path | BinaryIO) -> MarkerTouches:
    """
    Read touches of marked points.

    Parameters
    ----------
    source : path or binary file
        CSV with the columns px,py,pz (mm, in P) and fx,fy,fz,mx,my,mz (N and N·m, in S, compensated), and
        optionally nx,ny,nz (in P) and marker. Other columns are ignored.

    Returns
    -------
    MarkerTouches
        In metres; named by the marker, or by the line of the file.

    Raises
    ------
    TouchFileError
        The file is missing, too long, not a table, has some of nx,ny,nz only, or holds touches that cannot be
        used.
    """
    readers: list[TableReader] = []

    def select(reader: TableReader) -> None:
        some = [column for column in NORMAL if column in reader.names]
        if some and len(some) < 3:
            raise reader.error(
                message(f"only {arg(', '.join(some))} of nx,ny,nz is given: give all three, or none."), 1
            )
        reader.select((*POINT, *CHANNELS), optional=NORMAL, text=NAME if NAME in reader.names else None)
        readers.append(reader)

    rows = read_table(source, select, _WORDING, row_limit=_MOST)
    lines = rows.lines.tolist()
    cells = [""] * len(lines) if rows.text is None else [_name(cell) for cell in rows.text.tolist()]
    names = [
        f"{cell} (line {line})" if cell else f"line {line}" for cell, line in zip(cells, lines, strict=True)
    ]
    normals = rows.numbers[:, 9:12] if len(rows.columns) == 12 else None
    try:
        return MarkerTouches(rows.numbers[:, :3] / 1e3, rows.numbers[:, 3:9], normals, tuple(names))
    except AlignmentError as error:
        raise readers[0].error(str(error)) from error


def _name(cell: bytes) -> str:
    """Return a name without quotes and control characters."""
    text = cell.decode(errors="replace").strip().strip('"').strip()
    return "".join(letter for letter in text if letter.isprintable())
