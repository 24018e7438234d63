"""The least that makes a mesh sound: facets turned, dropped or left as they are, never moved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order

from pipeline.mesh.health import label_parts, measure_health
from pipeline.mesh.shell.exposure import exposure
from pipeline.mesh.triangles import cross_products

if TYPE_CHECKING:
    from numpy.typing import NDArray

_HIDDEN = 1e-3  # a part of which less than this is exposed, at best, lies inside another
_LOOKS = 64


def repair(
    vertices: NDArray[np.float64], faces: NDArray[np.int32]
) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """
    Drop repeated facets and hidden parts, and turn facets until all face outwards, as far as that helps.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32

    Returns
    -------
    kept : (k,) int64
        Facets that remain, ascending; all of them where the mesh cannot be mended like this.
    turned : (m,) bool
        Facets to turn over, of all.
    """
    kept = _without_repeats(faces)
    turned = np.zeros(len(faces), dtype=bool)
    flip, closed = _consistent(faces[kept])
    if not closed:
        return np.arange(len(faces)), turned
    turned[kept] = flip
    label = label_parts(faces[kept], len(vertices))
    oriented = turn(faces, turned)
    for number in range(label.max() + 1):
        part = kept[label == number]
        corners = vertices[oriented[part]]
        volume = np.einsum("ij,ij->", corners[:, 0] - corners[0, 0], cross_products(vertices, oriented[part]))
        if volume < 0:
            turned[part] = ~turned[part]
    oriented = turn(faces, turned)
    if label.max() > 0:
        seen = exposure(vertices, oriented[kept], count=_LOOKS)
        best = np.array([seen[label == number].max() for number in range(label.max() + 1)])
        kept = kept[best[label] > _HIDDEN]
    return kept, turned


def turn(faces: NDArray[np.int32], turned: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Copy the facets, with those of `turned` the other way round."""
    out = faces.copy()
    out[turned] = out[turned][:, ::-1]
    return out


def is_sound(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> bool:
    """Tell whether the facets form one closed surface that faces outwards."""
    return not measure_health(vertices, faces).sentences


def _without_repeats(faces: NDArray[np.int32]) -> NDArray[np.int64]:
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return np.sort(first)


def _consistent(faces: NDArray[np.int32]) -> tuple[NDArray[np.bool_], bool]:
    """Which facets to turn for neighbours to agree, (m,), and whether every edge has just two facets."""
    m = len(faces)
    start, end = faces.T.ravel().astype(np.int64), np.roll(faces, -1, axis=1).T.ravel().astype(np.int64)
    count = int(faces.max()) + 1
    key = np.minimum(start, end) * count + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    if len(order) % 2 or (np.diff(key[order])[::2] != 0).any() or (np.diff(key[order])[1::2] == 0).any():
        return np.zeros(m, dtype=bool), False
    a, b = order[::2], order[1::2]
    # The facets of an edge agree when they run along it in opposite directions.
    agree = (start[a] < end[a]) != (start[b] < end[b])
    rows, columns = a % m, b % m
    graph = coo_array((np.where(agree, 1, 2), (rows, columns)), shape=(m, m)).tocsr()
    flip = np.zeros(m, dtype=bool)
    seen = np.zeros(m, dtype=bool)
    differ = dict(zip(zip(rows.tolist(), columns.tolist(), strict=True), (~agree).tolist(), strict=True))
    for root in range(m):
        if seen[root]:
            continue
        walk, before = breadth_first_order(graph, root, directed=False)
        seen[walk] = True
        for facet in walk[1:].tolist():
            parent = int(before[facet])
            other = differ.get((parent, facet), differ.get((facet, parent), False))
            flip[facet] = flip[parent] ^ other
    return flip, True
