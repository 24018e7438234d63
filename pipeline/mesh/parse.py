"""
What the readers share: the bare mesh that every format ends as, numbers in text, polygons, and the limits.

A reader checks the structure of the bytes before it takes numbers from them, and holds no more than a small
multiple of the file in memory: numbers go to compact arrays as they are read, and counting stops at a limit.
"""

from __future__ import annotations

from array import array
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pipeline.mesh.errors import MeshError

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from pipeline.mesh.units import Units

# Four times what the whole chain is meant for. A polygon of a text file turns two bytes into a facet, so the
# file's size alone does not bound the memory that its facets take.
LARGEST_FACETS = 4_000_000

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
    invented : (m,) int64 or None
        1 for facets that the original did not hold, where the file says so.
    stated : {"mm", "m", "cm", "in"} or None
        The unit of the numbers, of a format that must state it.
    untouchable : tuple of int
        Regions that nothing can touch, where the file says so.
    """

    vertices: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int64]
    region: npt.NDArray[np.int64] | None = None
    settled: bool = False
    invented: npt.NDArray[np.int64] | None = None
    stated: Units | None = None
    untouchable: tuple[int, ...] = ()


class Triangles:
    """
    The polygons of a text, as fans of triangles, each with the line it stands on.

    Parameters
    ----------
    kind : str
        The format's name, for messages.
    """

    def __init__(self, kind: str) -> None:
        self._kind = kind
        self._corners = array("q")
        self._lines = array("q")

    def add(self, polygon: Sequence[int], line: int) -> None:
        """
        Add one polygon of three or more vertices, counted from 0.

        Raises
        ------
        MeshError
            There are too many facets now.
        """
        self._corners.extend(fan(polygon))
        self._lines.extend([line] * (len(polygon) - 2))
        refuse_too_many(len(self._lines))

    def finish(self, vertex_count: int) -> npt.NDArray[np.int64]:
        """
        Give the (m, 3) triangles, all of whose vertices are there.

        Raises
        ------
        MeshError
            No facets, or one refers to a vertex that the file does not have; the message names its line.
        """
        if not self._lines:
            raise MeshError(
                f"the {self._kind} text holds no facets: export the part again, as a surface of triangles."
            )
        triangles = np.frombuffer(self._corners, dtype=np.int64).reshape(-1, 3)
        missing = ((triangles < 0) | (triangles >= vertex_count)).any(axis=1)
        if missing.any():
            raise MeshError(
                f"line {self._lines[int(np.argmax(missing))]} of the {self._kind} text is a facet that refers"
                f" to a vertex that is not there (the file has {vertex_count}): it is damaged or cut short,"
                " export it again."
            )
        return triangles


def fan(polygon: Sequence[int]) -> list[int]:
    """Split a polygon of three or more vertices into triangles about its first, three numbers for each."""
    flat = [polygon[0]] * (3 * (len(polygon) - 2))
    flat[1::3], flat[2::3] = polygon[1:-1], polygon[2:]
    return flat


def points(coordinates: array[float]) -> npt.NDArray[np.float64]:
    """View a flat array of coordinates as (n, 3) points, without a copy."""
    return np.frombuffer(coordinates, dtype=np.float64).reshape(-1, 3)


def refuse_too_many(facet_count: int) -> None:
    """
    Refuse a number of facets whose arrays could fill the memory.

    Raises
    ------
    MeshError
        More than four million.
    """
    if facet_count > LARGEST_FACETS:
        raise MeshError(
            f"the file holds more than {LARGEST_FACETS} facets: export the part with fewer, a tolerance of"
            " 0.01 mm is finer than any probe needs."
        )
