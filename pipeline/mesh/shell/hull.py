"""
The outer hull of a soup of facets: those that border the outside, to the digit.

The facets cut space into cells. Where facets meet at an edge, the side of one and the side of the next round the edge
border the same cell; sides that hang together like that border one cell, and the cell is the outside when light
reaches it. A facet with the outside on one side only is part of the hull, whichever way it was turned; inner walls,
repeats and enclosed parts are not, and neither is a sheet with the outside on both its sides.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh.health import edge_table
from contactbench.pipeline.mesh.triangles import cross_products, directions

if TYPE_CHECKING:
    from numpy.typing import NDArray

_GLANCES, _RAYS = 24, 128  # facets looked at a cell, and rays from each
_LIFT = 1e-6  # of the size: rays start so far in front of their facet
_HALVINGS = 4
_SLIPPED = 3  # rays that may find a way between two facets by rounding


@dataclass(frozen=True, eq=False)
class Hull:
    """
    The facets that border the outside.

    Attributes
    ----------
    vertices : (n, 3) float64
        Those of the soup; one that several sheets of the hull meet in occurs once for each.
    faces : (m, 3) int32
        Outward. Each edge belongs to two facets where the soup has no hole.
    born : (m,) int64
        The facet of the soup that each is.
    turned : (m,) bool
        Turned over against it.
    sheets : (k,) int64
        Facets of the soup with the outside on both sides.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]
    born: NDArray[np.int64]
    turned: NDArray[np.bool_]
    sheets: NDArray[np.int64]


def outer_hull(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> Hull:
    """
    Find the facets that border the outside.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
        Any orientation. No facet may cross another or touch it but at shared vertices and edges; facets have area,
        and no two have the same corners.

    Returns
    -------
    Hull
    """
    m = len(faces)
    ring = _Rings(vertices, faces)
    # Round an edge, the side of a facet that looks ahead borders the same cell as the next one's that looks back.
    ahead = np.where(ring.forward, 0, m) + ring.facet
    back = np.where(ring.forward, m, 0) + ring.facet
    cell = _labels(ahead, back[ring.next], 2 * m)
    outside = _lit(vertices, faces, cell)[cell].reshape(2, m)
    kept = np.flatnonzero(outside[0] != outside[1])
    turned = outside[1][kept]
    hull = faces[kept]
    hull[turned] = hull[turned][:, ::-1]
    sheets = np.flatnonzero(outside[0] & outside[1])
    if len(hull) == 0:
        return Hull(vertices[:0], hull, kept, turned, sheets)
    points, triangles, of = apart(vertices, hull)
    return Hull(points, triangles, kept[of], turned[of], sheets)


def apart(
    vertices: NDArray[np.float64], faces: NDArray[np.int32]
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]]:
    """
    Give sheets that only meet along an edge or in a vertex vertices of their own, so that the surface is 2-manifold.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
        Consistently oriented.

    Returns
    -------
    vertices : (k, 3) float64
        Every corner stays where it is; vertices that no facet uses are left out.
    faces : (l, 3) int32
        The same facets; some are halved, where sheets meet in an edge whose ends they share anyway.
    of : (l,) int64
        The facet that each is, or is a half of.
    """
    of = np.arange(len(faces))
    for _ in range(_HALVINGS):
        vertices, faces, pairs = _unshared(vertices, faces)
        uses = edge_table(faces, len(vertices)).uses
        if uses.max() <= 2:
            break
        vertices, faces, half = _halved(vertices, faces, pairs)
        of = of[half]
    return vertices, faces, of


def _halved(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    pairs: tuple[NDArray[np.int64], NDArray[np.int64]],
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]]:
    """Halve pairs of facets at an edge that others share, each pair at a vertex of its own; one edge a facet."""
    start, end = faces.ravel().astype(np.int64), np.roll(faces, -1, axis=1).ravel().astype(np.int64)
    key = np.minimum(start, end) * len(vertices) + np.maximum(start, end)
    _, number, uses = np.unique(key, return_inverse=True, return_counts=True)
    crowded = uses[number.reshape(-1)] > 2
    whole = np.ones(len(faces), dtype=bool)
    new: list[NDArray[np.float64]] = []
    halves: list[tuple[int, int, int]] = []
    of: list[int] = []
    for one, other in zip(*pairs, strict=True):
        if crowded[one] and whole[one // 3] and whole[other // 3]:
            middle = len(vertices) + len(new)
            new.append((vertices[start[one]] + vertices[end[one]]) / 2)
            for half in (one, other):
                facet = half // 3
                whole[facet] = False
                third = int(start[_end(_end(half))])
                halves += [
                    (int(start[half]), middle, third),
                    (middle, int(end[half]), third),
                ]
                of += [facet, facet]
    kept = np.flatnonzero(whole)
    return (
        np.concatenate((vertices, np.array(new).reshape(-1, 3))),
        np.concatenate((faces[whole], np.array(halves, dtype=np.int32).reshape(-1, 3))),
        np.concatenate((kept, np.array(of, dtype=np.int64))),
    )


def _unshared(
    vertices: NDArray[np.float64], faces: NDArray[np.int32]
) -> tuple[NDArray[np.float64], NDArray[np.int32], tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Give each sheet vertices of its own; gives the pairs of half-edges that hang together, too."""
    m = len(faces)
    ring = _Rings(vertices, faces)
    # Sheets are paired across their inner side, which a facet whose half-edge runs backwards has ahead of it.
    one, other = ring.inner_pairs()
    ends, starts = _end(one), _end(other)
    corner = _labels(np.concatenate((one, ends)), np.concatenate((starts, other)), 3 * m)
    # Corners of one vertex that nothing joins are different vertices now; the order of the old ones is kept.
    old = faces.ravel().astype(np.int64)
    _, first, number = np.unique(corner, return_index=True, return_inverse=True)
    order = np.argsort(old[first], kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    points = vertices[old[first][order]]
    return points, rank[number.reshape(-1)].reshape(-1, 3).astype(np.int32), (one, other)


class _Rings:
    """
    The half-edges of facets in cyclic order round each edge, by rising angle seen along it from low to high vertex.

    Attributes
    ----------
    half, facet : (3 m,) int64
        Half-edge ``3 f + k`` runs from corner k of facet f to the next.
    forward : (3 m,) bool
        It runs from the lower vertex number to the higher; then the facet's front looks ahead, to greater angles.
    next : (3 m,) int64
        The position of the next half-edge round the same edge; its own where it is alone.
    rings : (e, 2) int64
        Where each edge's half-edges begin, and how many there are.
    """

    def __init__(self, vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> None:
        start = faces.ravel().astype(np.int64)
        end = np.roll(faces, -1, axis=1).ravel().astype(np.int64)
        low, high = np.minimum(start, end), np.maximum(start, end)
        key = low * len(vertices) + high
        order = np.argsort(key, kind="stable")
        first = np.flatnonzero(np.diff(key[order], prepend=-1))
        uses = np.diff(first, append=len(order))
        crowded = np.repeat(uses > 2, uses)
        if crowded.any():
            half = order[crowded]
            angle = _angles(vertices, low[half], high[half], faces.ravel()[_end(_end(half))])
            # Facets that lie on each other, as far as rounding can tell, are ordered so that a thin wedge is solid.
            order[crowded] = half[np.lexsort(((start == low)[half], angle, key[half]))]
        self.half = order
        self.facet = order // 3
        self.forward = (start == low)[order]
        self.next = np.arange(len(order)) + 1
        self.next[first + uses - 1] = first
        self.rings = np.column_stack((first, uses))

    def inner_pairs(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Half-edges that bound one solid wedge: one that runs backwards, and the next that runs forward, (k,) each."""
        after = np.where(~self.forward & self.forward[self.next], self.next, -1)
        done = after >= 0
        done[after[done]] = True
        # Facets that lie on each other within rounding may be in the wrong order: pair them like brackets.
        for first, uses in self.rings[~np.logical_and.reduceat(done, self.rings[:, 0])].tolist():
            opened: list[int] = []
            after[first : first + uses] = -1
            for place in 2 * [*range(first, first + uses)]:
                if not self.forward[place]:
                    opened.append(place)
                elif opened:
                    last = opened.pop()
                    if after[last] < 0 and place not in after[first : first + uses]:
                        after[last] = place
        here = np.flatnonzero(after >= 0)
        return self.half[here], self.half[after[here]]


def _angles(
    vertices: NDArray[np.float64],
    low: NDArray[np.int64],
    high: NDArray[np.int64],
    opposite: NDArray[np.int32],
) -> NDArray[np.float64]:
    """Directions of facets about their edges, radians from a direction that is the same for all facets of an edge."""
    axis = vertices[high] - vertices[low]
    axis /= np.maximum(np.linalg.norm(axis, axis=1, keepdims=True), np.finfo(float).tiny)
    reach = vertices[opposite] - vertices[low]
    u = np.eye(3)[np.argmin(np.abs(axis), axis=1)]
    u = u - np.einsum("ij,ij->i", u, axis)[:, None] * axis
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    v = np.cross(axis, u)
    return np.asarray(np.arctan2(np.einsum("ij,ij->i", reach, v), np.einsum("ij,ij->i", reach, u)))


def _lit(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], cell: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Tell which cells light reaches from far away, (cells,)."""
    m, count = len(faces), int(cell.max()) + 1
    cross = cross_products(vertices, faces)
    twice = np.linalg.norm(cross, axis=1)
    size = float(np.ptp(vertices[faces.ravel()], axis=0).max())
    # The largest facets of each cell, and others taken at even steps through those that are left.
    area = np.concatenate((twice, twice))
    order = np.lexsort((-area, cell))
    first = np.flatnonzero(np.diff(cell[order], prepend=-1))
    members = np.diff(first, append=len(order))
    looks = np.minimum(members, _GLANCES)
    place = np.arange(int(looks.sum())) - np.repeat(np.cumsum(looks) - looks, looks)
    many, number = np.repeat(members, looks), np.repeat(looks, looks)
    half = number // 2
    spread = half + (place - half) * (many - half) // np.maximum(number - half, 1)
    pick = order[np.repeat(first, looks) + np.where(place < half, place, spread)]
    facet, sign = pick % m, np.where(pick < m, 1.0, -1.0)
    normal = sign[:, None] * cross[facet] / np.maximum(twice[facet], np.finfo(float).tiny)[:, None]
    origins = vertices[faces[facet]].mean(axis=1) + _LIFT * size * normal
    index = SurfaceIndex(vertices, faces)
    free = np.zeros(count, dtype=np.int64)
    for direction in directions(_RAYS):
        front = np.flatnonzero(normal @ direction > 0.05)
        escaped = index.escapes(origins[front], np.tile(direction, (len(front), 1)))
        np.add.at(free, cell[pick[front[escaped]]], 1)
    return free > np.minimum(_SLIPPED, np.bincount(cell[pick], minlength=count))


def _end(half: NDArray[np.int64]) -> NDArray[np.int64]:
    """Give the half-edge that follows in the same facet: it starts where this one ends."""
    return half - half % 3 + (half + 1) % 3


def _labels(a: NDArray[np.int64], b: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    graph = coo_array((np.ones(len(a), dtype=np.int8), (a, b)), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    return np.asarray(label, dtype=np.int64)
