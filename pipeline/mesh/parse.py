"""
The one place that calls trimesh, and the bare mesh that every file format ends as.

trimesh reads generously: of a file that is cut short or garbled it may return a part, or numbers that are not
there. So each format's module (`stl`, `obj`, `ply`) checks the structure of the bytes first and hands trimesh
only the geometry, in a form with one reading; `parse` then compares the number of facets.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pipeline.mesh.errors import MeshError

if TYPE_CHECKING:
    import numpy.typing as npt

# What trimesh's STL, OBJ and PLY readers raise on content they cannot use: numpy's conversion and reshape
# errors, missing fields, indices beyond an array, and counts too large for a C integer.
UNREADABLE = (ValueError, TypeError, KeyError, IndexError, OverflowError)

# No two parts can match the same text, so that a megabyte of digits or spaces costs no more than a megabyte.
NUMBER = rb"[+-]?(?:(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?|(?i:nan|inf(?:inity)?))"


@dataclass(frozen=True, eq=False)
class RawMesh:
    """
    What a file holds, unchecked beyond its structure.

    Attributes
    ----------
    vertices : (n, 3) float64
        In the file's unit and frame P.
    faces : (m, 3) int64
        May be out of range.
    region : (m,) int64 or None
        Priority per facet, where the file holds one.
    settled : bool
        Written by `save_probe`: merged and cleaned already, to be taken as it is.
    """

    vertices: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int64]
    region: npt.NDArray[np.int64] | None = None
    settled: bool = False


def run_trimesh(data: bytes, file_type: str) -> Any:
    """
    Read bytes with trimesh, without its processing and without any file they may refer to.

    Raises
    ------
    MeshError
        trimesh cannot use them.
    """
    # Costs 0.6 s, which a command that reads no mesh should not pay.
    import trimesh

    try:
        # A signalling NaN warns when it is converted; it is refused, with its row, like every other NaN.
        with np.errstate(invalid="ignore"):
            return trimesh.load_mesh(
                io.BytesIO(data), file_type=file_type, process=False, maintain_order=True, skip_materials=True
            )
    except UNREADABLE as error:
        raise MeshError(
            f"this is not a readable {file_type.upper()} file ({error}). It may be damaged or cut short:"
            " export it again, with triangles only."
        ) from error


def parse(data: bytes, file_type: str, facet_count: int) -> RawMesh:
    """
    Read bytes that hold triangles only, and insist on their number.

    Raises
    ------
    MeshError
        trimesh cannot use them, or found another number of facets.
    """
    mesh = run_trimesh(data, file_type)
    faces = np.asarray(mesh.faces, dtype=np.int64)
    if faces.shape != (facet_count, 3):
        raise MeshError(
            f"{len(faces)} of {facet_count} facets could be read: the file is damaged, export it again."
        )
    return RawMesh(np.asarray(mesh.vertices, dtype=np.float64), faces)
