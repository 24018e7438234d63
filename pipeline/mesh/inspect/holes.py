"""The rims of a surface's holes: how many, how long, how wide, and seams that only look closed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree
from scipy.spatial.distance import pdist

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.mesh.health import EdgeTable

# Rims are measured one by one from the longest on; a mesh whose facets do not share vertices has a million.
LISTED = 100

# Up to here the widest diameter is the greatest of all distances; above, of the extents along fixed directions.
_EXACT = 500
_FAN = 200

# Two rims this close, as a share of the size, are one seam that was not sewn: 0.015 mm on a probe of 150 mm.
_SEAM = 1e-4


@dataclass(frozen=True)
class Hole:
    """
    One connected rim: edges of one facet only that hang together. Two rims that touch in a vertex are one.

    Attributes
    ----------
    edges : int
        Edges of the rim.
    perimeter_m : float
        Their length together.
    widest_m : float
        Greatest distance between two of its vertices; of a rim of more than 500 vertices at most 1 % too small.
    centre_m : (3,) tuple of float
        Mean of the rim's vertices.
    """

    edges: int
    perimeter_m: float
    widest_m: float
    centre_m: tuple[float, float, float]


def find_holes(vertices: npt.NDArray[np.float64], edges: EdgeTable) -> tuple[int, float, tuple[Hole, ...]]:
    """
    Group the edges of one facet only into rims.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres.
    edges : EdgeTable
        Of the mesh.

    Returns
    -------
    count : int
        Rims.
    perimeter_m : float
        All together.
    holes : tuple of Hole
        The 100 with the longest rims, widest first.
    """
    open_edge = edges.uses == 1
    if not open_edge.any():
        return 0, 0.0, ()
    low, high = edges.low[open_edge], edges.high[open_edge]
    points = np.unique(np.concatenate((low, high)))
    rows, columns = np.searchsorted(points, low), np.searchsorted(points, high)
    links = np.ones(len(rows), dtype=np.int8)
    graph = coo_array((links, (rows, columns)), shape=(len(points), len(points)))
    count, label = connected_components(graph, directed=False)
    length = np.linalg.norm(vertices[low] - vertices[high], axis=1)
    rim = label[rows]
    perimeter = np.bincount(rim, length, minlength=count)
    uses = np.bincount(rim, minlength=count)
    holes = []
    # Ties in length are common in CAD parts: the number of the rim keeps the order the same every time.
    for which in np.lexsort((np.arange(count), -perimeter))[:LISTED]:
        corners = vertices[points[label == which]]
        x, y, z = corners.mean(axis=0).tolist()
        holes.append(Hole(int(uses[which]), float(perimeter[which]), _widest(corners), (x, y, z)))
    holes.sort(key=lambda hole: -hole.widest_m)
    return count, float(length.sum()), tuple(holes)


def count_seam_vertices(vertices: npt.NDArray[np.float64], edges: EdgeTable) -> int:
    """
    Count the vertices of rims that have a vertex of a rim beside them, closer than 1e-4 of the size.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    edges : EdgeTable
        Of the mesh.

    Returns
    -------
    int
        Above 0 where facets that meet do not share their vertices, so that a closed skin counts as open.
    """
    open_edge = edges.uses == 1
    rim = np.unique(np.concatenate((edges.low[open_edge], edges.high[open_edge])))
    if len(rim) < 2:
        return 0
    used = vertices[np.concatenate((edges.low, edges.high))]
    size = float(np.ptp(used, axis=0).max())
    tree = cKDTree(vertices[rim])
    pairs = tree.query(vertices[rim], k=[2], distance_upper_bound=_SEAM * size)
    return int(np.count_nonzero(np.isfinite(pairs[0])))


def _widest(corners: npt.NDArray[np.float64]) -> float:
    if len(corners) <= _EXACT:
        return float(pdist(corners).max())
    turn = np.arange(_FAN) * np.pi * (3 - np.sqrt(5))
    height = (np.arange(_FAN) + 0.5) / _FAN
    radius = np.sqrt(1 - height**2)
    directions = np.stack((radius * np.cos(turn), radius * np.sin(turn), height))
    return float(np.ptp(corners @ directions, axis=0).max())


# ---- facets by shape: slivers, edge lengths, and facets that stand back to back or vertices on one spot ----


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
