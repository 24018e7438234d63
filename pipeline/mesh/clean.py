"""Make one connected surface of triangles that each bring their own vertices, the same way every time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

if TYPE_CHECKING:
    import numpy.typing as npt


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
