"""Open edges: seams that were not sewn are sewn, and the holes that remain are walked round."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from contactbench.pipeline.mesh.health import edge_table
from contactbench.pipeline.mesh.triangles import cross_products, first_alike

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Soup = tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]]

# Vertices nearer than this share of the size are one.
ROUNDING = 1e-8
_PART = 0.3  # of the shortest edge at a vertex


def distinct(vertices: NDArray[np.float64], faces: NDArray[np.int32], born: NDArray[np.int64]) -> Soup:
    """
    Merge vertices that are the same to the last bit; leave out facets without area, and repeats however turned.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
    born : (m,) int64
        What each facet is a piece of.

    Returns
    -------
    vertices, faces, born
    """
    faces = first_alike(vertices)[faces].astype(np.int32)
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    vertices, faces = vertices[used], (np.cumsum(used) - 1)[faces].astype(np.int32)
    area = np.linalg.norm(cross_products(vertices, faces), axis=1)
    apart = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    faces, born = faces[apart & (area > 0)], born[apart & (area > 0)]
    once = first_alike(np.sort(faces, axis=1)) == np.arange(len(faces))
    return vertices, faces[once], born[once]


def sew(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], born: NDArray[np.int64], tolerance: float
) -> Soup:
    """
    Join open edges that lie beside each other: their vertices become one, or split the edge that they lie on.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
    born : (m,) int64
        What each facet is a piece of.
    tolerance : float
        How far vertices of open edges may move, in the vertices' unit.

    Returns
    -------
    vertices, faces, born
    """
    rims = open_edges(faces, len(vertices))
    if len(rims) == 0:
        return vertices, faces, born
    rim = np.unique(rims)
    reach = _reach(vertices, faces, rim, tolerance)
    # Each takes the place of the first that is near it; chains are not followed, so that nothing moves further.
    root = np.arange(len(vertices))
    for one, near in zip(
        rim, cKDTree(vertices[rim]).query_ball_point(vertices[rim], reach[rim]), strict=True
    ):
        if root[one] == one:
            others = rim[near]
            others = others[(others > one) & (root[others] == others)]
            close = np.linalg.norm(vertices[others] - vertices[one], axis=1) <= reach[others]
            root[others[close]] = one
    faces = root[faces].astype(np.int32)
    vertices, faces, born = distinct(vertices, faces, born)
    return _split(vertices, faces, born, tolerance)


def _split(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], born: NDArray[np.int64], tolerance: float
) -> Soup:
    """Split facets at vertices of open edges that lie on their own open edge."""
    rims = open_edges(faces, len(vertices))
    rim = np.unique(rims)
    if len(rim) == 0:
        return vertices, faces, born
    reach = _reach(vertices, faces, rim, tolerance)
    a, b = vertices[rims[:, 0]], vertices[rims[:, 1]]
    length = np.linalg.norm(b - a, axis=1)
    around = cKDTree(vertices[rim]).query_ball_point((a + b) / 2, length / 2)
    on: dict[tuple[int, int], list[int]] = {}
    for edge, near in enumerate(around):
        found = rim[near]
        found = found[(found != rims[edge, 0]) & (found != rims[edge, 1])]
        along = (vertices[found] - a[edge]) @ (b[edge] - a[edge]) / length[edge] ** 2
        off = np.linalg.norm(vertices[found] - a[edge] - along[:, None] * (b[edge] - a[edge]), axis=1)
        inner = (off <= reach[found]) & (along > 0) & (along < 1)
        if inner.any():
            order = np.argsort(along[inner])
            on[int(rims[edge, 0]), int(rims[edge, 1])] = found[inner][order].tolist()
    if not on:
        return vertices, faces, born
    whole = np.ones(len(faces), dtype=bool)
    pieces: list[list[int]] = []
    of: list[int] = []
    rim_vertex = np.zeros(len(vertices), dtype=bool)
    rim_vertex[rims] = True
    for facet in np.flatnonzero(rim_vertex[faces].sum(axis=1) > 1).tolist():
        corners = faces[facet].tolist()
        for k in range(3):
            start, end, third = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
            chain = on.get((min(start, end), max(start, end)), [])
            if chain and third not in chain:
                chain = chain if start < end else chain[::-1]
                stops = [start, *chain, end]
                pieces += [[one, two, third] for one, two in pairwise(stops)]
                of += [int(born[facet])] * (len(stops) - 1)
                whole[facet] = False
                break  # its other open edges are split in the next call
    new = np.concatenate((faces[whole], np.array(pieces, dtype=np.int32).reshape(-1, 3)))
    again = distinct(vertices, new, np.concatenate((born[whole], np.array(of, dtype=np.int64))))
    return _split(*again, tolerance) if len(again[1]) > len(faces) else again


def _reach(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], rim: NDArray[np.int64], tolerance: float
) -> NDArray[np.float64]:
    """How far each vertex of the rim may move: not so far that a facet at it would fold, but for what is rounding."""
    at_rim = np.zeros(len(vertices), dtype=bool)
    at_rim[rim] = True
    faces = faces[at_rim[faces].any(axis=1)]
    sides = np.linalg.norm(vertices[np.roll(faces, -1, axis=1)] - vertices[faces], axis=2)
    reach = np.full(len(vertices), tolerance)
    for k in range(3):
        np.minimum.at(reach, faces[:, k], _PART * np.minimum(sides[:, k], sides[:, k - 1]))
    least = min(tolerance, ROUNDING * float(np.ptp(vertices, axis=0).max()))
    return np.asarray(np.maximum(reach, least))


def open_edges(faces: NDArray[np.int32], vertex_count: int) -> NDArray[np.int64]:
    """List the edges of one facet only, (k, 2), the lower vertex first."""
    edges = edge_table(faces, vertex_count)
    return np.asarray(np.column_stack((edges.low, edges.high))[edges.uses == 1])


def holes(faces: NDArray[np.int32], vertex_count: int) -> list[NDArray[np.int64]]:
    """
    Walk round the open edges.

    Returns
    -------
    list of (k,) int64
        Vertices of each hole's rim in order, none twice; open edges that form no closed line are left out.
    """
    beside: dict[int, list[int]] = {}
    for a, b in open_edges(faces, vertex_count).tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    found: list[NDArray[np.int64]] = []
    for start in sorted(beside):
        path = [start]
        place = {start: 0}
        while path:
            here = path[-1]
            if not beside[here]:  # a dead end
                del place[path.pop()]
                continue
            there = beside[here].pop()
            beside[there].remove(here)
            if there in place:
                loop = path[place[there] :]
                for vertex in loop[1:]:
                    del place[vertex]
                del path[place[there] + 1 :]
                if len(loop) > 2:
                    found.append(np.array(loop, dtype=np.int64))
            else:
                place[there] = len(path)
                path.append(there)
    return found
