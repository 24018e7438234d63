"""Touches of marked points: where the mesh says they are, and what the sensor felt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact.wrench_csv import CHANNELS
from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.preparation.alignment.alignment import AlignmentError, check_numbers
from contactbench.pipeline.tables import TableError, TableReader, Wording, read_table

if TYPE_CHECKING:
    from pathlib import Path
    from typing import BinaryIO

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.mesh import Probe

    Floats = NDArray[np.float64]

_SMALLEST_FORCE_N = 0.5
_LARGEST_M = 10.0
# Further from the surface, a marker is not on this mesh, or not in its unit; nearer, it is worth a word.
_OFF_MESH_M, _NEAR_MESH_M = 0.010, 0.001
_NORMAL_AGREES = np.cos(np.radians(60.0))


@dataclass(frozen=True, eq=False)
class MarkerTouches:
    """
    Touches of points that are known on the mesh.

    Raises
    ------
    AlignmentError
        Fewer than three touches, a wrong shape, a number that is not finite, a force under 0.5 N, a
        normal without length.
    """

    points_P: Floats  # (n, 3) the markers in the mesh's frame, m
    # (n, 6) Fx Fy Fz Mx My Mz in S, N and N·m about the sensor origin: what the tissue does to the
    # probe, compensated for gravity and bias
    wrenches: Floats
    normals_P: Floats | None = None  # (n, 3) outward unit normals there; None: those of the mesh
    names: tuple[str, ...] = ()  # for people; numbered from 1 when left out

    def __post_init__(self) -> None:
        points = check_numbers(self.points_P, (-1, 3), "points_P")
        wrenches = check_numbers(self.wrenches, (-1, 6), "wrenches")
        names = tuple(self.names) or tuple(f"touch {row + 1}" for row in range(len(points)))
        if len({len(points), len(wrenches), len(names)}) > 1:
            raise AlignmentError(
                f"{arg(len(points))} points, {arg(len(wrenches))} wrenches and {arg(len(names))} names: give"
                " one of each per touch."
            )
        if len(points) < 3:
            raise AlignmentError(
                f"{arg(len(points))} touches cannot show a mount: touch at least three markers."
            )
        _check_sizes(points, wrenches, names)
        object.__setattr__(self, "points_P", points)
        object.__setattr__(self, "wrenches", wrenches)
        object.__setattr__(self, "names", names)
        if self.normals_P is not None:
            object.__setattr__(self, "normals_P", _unit(self.normals_P, names))

    def __len__(self) -> int:
        return len(self.points_P)


def put_on_mesh(touches: MarkerTouches, probe_P: Probe) -> tuple[Floats, Floats, tuple[str, ...]]:
    """
    Move each marker to the nearest point of the mesh, and take the normal there if none was given.

    Returns
    -------
    points, normals : (n, 3) float64
        The nearest points of the surface, m, and the outward unit normals there.
    warnings : tuple of str
        About markers that lie off the surface, or whose normal disagrees with it.

    Raises
    ------
    AlignmentError
        A marker is over 10 mm from the surface: another mesh, frame or unit.
    """
    index = SurfaceIndex(probe_P.vertices, probe_P.faces)
    distance, face, foot = index.closest(np.ascontiguousarray(touches.points_P))
    worst = int(np.argmax(distance))
    if distance[worst] > _OFF_MESH_M:
        raise AlignmentError(
            f"{arg(touches.names[worst])}: the marker is {arg(1e3 * distance[worst]):.1f} mm from the mesh."
            " Give the markers in millimetres in the mesh's own frame, and the mesh they were"
            " measured on."
        )
    warnings = [
        message(
            f"{arg(name)}: the marker is {arg(1e3 * d):.1f} mm from the mesh; the nearest point of the mesh is used."
        )
        for name, d in zip(touches.names, distance, strict=True)
        if d > _NEAR_MESH_M
    ]
    normals: Floats = probe_P.normals[face]
    if touches.normals_P is not None:
        agree = np.einsum("ij,ij->i", normals, touches.normals_P)
        warnings += [
            message(
                f"{arg(name)}: the given normal is {arg(np.degrees(np.arccos(np.clip(a, -1, 1)))):.0f}° from the"
                " mesh normal there. Check its sign and the marker."
            )
            for name, a in zip(touches.names, agree, strict=True)
            if a < _NORMAL_AGREES
        ]
        normals = touches.normals_P
    return np.asarray(foot), normals, tuple(warnings)


def _check_sizes(points: Floats, wrenches: Floats, names: tuple[str, ...]) -> None:
    force = np.linalg.norm(wrenches[:, :3], axis=1)
    weak = int(np.argmin(force))
    if force[weak] < _SMALLEST_FORCE_N:
        raise AlignmentError(
            f"{arg(names[weak])}: the force is {arg(force[weak]):.3g} N, below {arg(_SMALLEST_FORCE_N):g} N, so"
            " it is not a touch. Remove the row, or press with 8 to 10 N."
        )
    far = int(np.argmax(np.abs(points).max(axis=1)))
    if np.abs(points[far]).max() > _LARGEST_M:
        raise AlignmentError(
            f"{arg(names[far])}: the marker is over 10 m away: give metres in the mesh's frame."
        )


def _unit(values: ArrayLike, names: tuple[str, ...]) -> Floats:
    normals = check_numbers(values, (len(names), 3), "normals_P")
    length = np.linalg.norm(normals, axis=1)
    short = int(np.argmin(length))
    if length[short] < 1e-9:
        raise AlignmentError(
            f"{arg(names[short])}: the normal has zero length: leave out all normals, or correct it."
        )
    unit: Floats = normals / length[:, None]
    return unit


# ---- touches of marked points from CSV -----------------------------------------------------------


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
