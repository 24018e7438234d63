"""Make one connected surface of triangles that each bring their own vertices, and of those without area none."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from contactbench.pipeline.mesh.probe import degenerate_facets

if TYPE_CHECKING:
    import numpy.typing as npt

# A row of flat facets side by side takes one round for each.
_ROUNDS = 8


def merge_vertices(
    vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32], tolerance: float
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]:
    """
    Merge vertices that coincide and leave out those that no facet uses.

    Vertices closer than the tolerance become one, the one that comes first; the order of the others stays.
    A chain of vertices each within the tolerance of the next becomes one as well.

    Parameters
    ----------
    vertices : (n, 3) float64
        Finite.
    faces : (m, 3) int32
        Indices in range.
    tolerance : float
        Above 0, in the vertices' unit.

    Returns
    -------
    vertices : (k, 3) float64
        A subset of the rows given, in their order.
    faces : (m, 3) int32
        The same facets; one whose corners merged now uses a vertex twice.
    """
    vertices, faces = _used(vertices, faces)
    first = _first_in_cell(vertices, tolerance / 2)
    kept = np.flatnonzero(first == np.arange(len(first)))
    # One vertex per cell bounds the pairs: a file with all its points on one spot cannot fill the memory.
    pairs = cKDTree(vertices[kept]).query_pairs(tolerance, output_type="ndarray")
    if len(pairs):
        graph = coo_array((np.ones(len(pairs), dtype=np.int8), pairs.T), shape=(len(kept), len(kept)))
        _, label = connected_components(graph, directed=False)
        _, lowest = np.unique(label, return_index=True)
        root = np.arange(len(first))
        root[kept] = kept[lowest[label]]
        first = root[first]
    return _used(vertices, first[faces])


def _first_in_cell(vertices: npt.NDArray[np.float64], cell: float) -> npt.NDArray[np.int64]:
    """For each vertex the first one in the same cubic cell; its diagonal is shorter than two cells."""
    x, y, z = np.floor((vertices - vertices.min(axis=0)) / cell).astype(np.int64).T
    order = np.lexsort((z, y, x))
    new = np.ones(len(order), dtype=bool)
    new[1:] = np.any([np.diff(axis[order]) != 0 for axis in (x, y, z)], axis=0)
    # lexsort is stable: the first of each run is the one that came first in the file.
    first = np.empty(len(order), dtype=np.int64)
    first[order] = order[new][np.cumsum(new) - 1]
    return first


def _used(
    vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32] | npt.NDArray[np.int64]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]:
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    number = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return vertices[used], number[faces]


def flip_flat_facets(
    vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32]
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int64]]:
    """
    Divide facets where a facet without area lies on their edge, so that leaving it out opens no seam.

    Where a row of facets is finer than the row beside it, some programs fill the seam with facets whose middle
    corner lies on the opposite edge. Such a facet and its neighbour across that edge become the two facets that the
    neighbour makes with the middle corner: the same surface, with the seam closed. Others stay as they are.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
        Indices in range.

    Returns
    -------
    faces : (m, 3) int32
        Rows that were flipped are changed in place of the old ones.
    origin : (m,) int64
        The facet given of whose surface each one is now.
    """
    faces, origin = faces.copy(), np.arange(len(faces))
    for _ in range(_ROUNDS):
        flat = np.flatnonzero(degenerate_facets(vertices, faces))
        changed = len(flat) > 0 and _flip(vertices, faces, origin, flat)
        if not changed:
            break
    return faces, origin


def _flip(
    vertices: npt.NDArray[np.float64],
    faces: npt.NDArray[np.int32],
    origin: npt.NDArray[np.int64],
    flat: npt.NDArray[np.int64],
) -> bool:
    """Flip, in place, flat facets no two of which have a facet in common; tell whether any was."""
    count = np.int64(len(vertices))
    ends = np.roll(faces, -1, axis=1).astype(np.int64)
    # Edge k of a facet goes from corner k to the next.
    key = (faces * count + ends).ravel()
    order = np.argsort(key, kind="stable")
    ordered = key[order]

    def times(wanted: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
        return np.searchsorted(ordered, wanted, "right") - np.searchsorted(ordered, wanted, "left")

    corners = faces[flat].astype(np.int64)
    sides = vertices[np.roll(corners, -1, axis=1)] - vertices[corners]
    longest = np.argmax(np.einsum("ijk,ijk->ij", sides, sides), axis=1)
    # The longest edge goes from b to a, with the middle corner m opposite.
    b, a, m = (corners[np.arange(len(flat)), (longest + k) % 3] for k in range(3))
    one = (times(b * count + a) == 1) & (times(a * count + b) == 1)
    flat, a, b, m = flat[one], a[one], b[one], m[one]
    beside = order[np.searchsorted(ordered, a * count + b)]
    neighbour, at = beside // 3, beside % 3
    c = faces[neighbour, (at + 2) % 3].astype(np.int64)
    new = np.stack((np.column_stack((a, m, c)), np.column_stack((m, b, c))), axis=1).astype(np.int32)
    sound = (
        ~degenerate_facets(vertices, new.reshape(-1, 3)).reshape(-1, 2).any(axis=1)
        if len(new)
        else np.zeros(0, bool)
    )
    # An edge that is there already would get a third facet.
    sound &= (times(m * count + c) == 0) & (times(c * count + m) == 0)
    flat, neighbour, new = flat[sound], neighbour[sound], new[sound]
    # One flip at a time for each facet: the first that asks.
    asked = np.column_stack((flat, neighbour)).ravel()
    _, first = np.unique(asked, return_index=True)
    mine = np.zeros(len(asked), dtype=bool)
    mine[first] = True
    free = mine.reshape(-1, 2).all(axis=1)
    flat, neighbour, new = flat[free], neighbour[free], new[free]
    faces[flat], faces[neighbour] = new[:, 0], new[:, 1]
    origin[flat] = origin[neighbour]
    return len(flat) > 0
