"""Facets by shape: slivers, edge lengths, and facets that stand back to back or vertices on one spot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.mesh.health import EdgeTable

# Below it the normal of a facet from a float32 file is uncertain by degrees once the facet is small.
SLIVER_DEG = 1.0


@dataclass(frozen=True)
class Slivers:
    """
    Facets much longer than they are high.

    Attributes
    ----------
    count : int
        With an angle under 1 degree.
    smallest_angle_deg : float
        Of all facets.
    worst_aspect : float
        Greatest ratio of the longest edge to the height over it; 1.15 in an equilateral facet.
    """

    count: int
    smallest_angle_deg: float
    worst_aspect: float


@dataclass(frozen=True)
class EdgeLengths:
    """Lengths of all edges, each counted once, in metres."""

    shortest_m: float
    median_m: float
    mean_m: float
    longest_m: float


def measure_slivers(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32]) -> Slivers:
    """
    Measure the facets' angles and aspect ratios.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
        With an area.
    """
    corners = vertices[faces]
    sides = np.roll(corners, -1, axis=1) - corners
    square = np.sort(np.einsum("ijk,ijk->ij", sides, sides), axis=1)
    double_area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    # The smallest angle lies between the two longest sides.
    sine = double_area / np.sqrt(square[:, 1] * square[:, 2])
    angle = np.degrees(np.arcsin(np.minimum(sine, 1.0)))
    return Slivers(
        int(np.count_nonzero(angle < SLIVER_DEG)),
        float(angle.min()),
        float((square[:, 2] / double_area).max()),
    )


def measure_edges(vertices: npt.NDArray[np.float64], edges: EdgeTable) -> EdgeLengths:
    """
    Measure the edges of a mesh.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres.
    edges : EdgeTable
        Of the mesh.
    """
    length = np.linalg.norm(vertices[edges.low] - vertices[edges.high], axis=1)
    return EdgeLengths(
        float(length.min()), float(np.median(length)), float(length.mean()), float(length.max())
    )


@dataclass(frozen=True, eq=False)
class Repeats:
    """
    Facets with the same three vertices.

    Attributes
    ----------
    surplus : (m,) bool
        Beyond the first with these vertices.
    both_sides : (m,) bool
        There is one with these vertices for each side: they stand back to back.
    """

    surplus: npt.NDArray[np.bool_]
    both_sides: npt.NDArray[np.bool_]


def find_repeats(faces: npt.NDArray[np.int32]) -> Repeats:
    """
    Find facets with the same three vertices, whichever way they are wound.

    Parameters
    ----------
    faces : (m, 3) int32
        Indices, none twice in a row.
    """
    a, b, c = np.sort(faces, axis=1).T
    order = np.lexsort((c, b, a))
    same = np.logical_and.reduce([np.diff(axis[order]) == 0 for axis in (a, b, c)])
    group = np.empty(len(faces), dtype=np.int64)
    group[order] = np.concatenate(([0], np.cumsum(~same)))
    surplus = np.zeros(len(faces), dtype=np.bool_)
    surplus[order[1:][same]] = True
    # From the lowest vertex on a facet runs up to the middle one, or to the highest.
    ascending = np.take_along_axis(faces, (np.argmin(faces, axis=1)[:, None] + 1) % 3, axis=1)[:, 0] == b
    one, other = (np.bincount(group[side], minlength=len(faces)) for side in (ascending, ~ascending))
    return Repeats(surplus, ((one > 0) & (other > 0))[group])


def count_coincident(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32]) -> int:
    """
    Count used vertices beyond the first on exactly the same spot.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
        Indices in range.
    """
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    x, y, z = vertices[used].T
    order = np.lexsort((z, y, x))
    same = [np.diff(axis[order]) == 0 for axis in (x, y, z)]
    return int(np.count_nonzero(same[0] & same[1] & same[2]))
