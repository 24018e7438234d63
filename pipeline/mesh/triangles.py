"""Plain geometry and connectivity of triangle arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray


_MIXER = np.uint64(0x9E3779B97F4A7C15)


def cross_products(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """Twice the area vector of each facet, (m, 3), in the square of the vertices' unit."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    return np.cross(b - a, c - a)


def vertex_normals(
    area_vectors: NDArray[np.float64], faces: NDArray[np.int32], count: int
) -> NDArray[np.float64]:
    """
    Return unit normals of vertices, (count, 3): of the sum of their facets' area vectors (Gouraud 1971).

    Parameters
    ----------
    area_vectors : (m, 3)
        Normals of the facets times their areas, in any unit.
    count : int
        Of the vertices; one without a facet gets zeros.
    """
    normals = np.zeros((count, 3))
    for corner in range(3):
        np.add.at(normals, faces[:, corner], area_vectors)
    unit: NDArray[np.float64] = normals / np.maximum(
        np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny
    )
    return unit


def six_volumes(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], label: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Return six times the signed volume of each labelled part, as seen from one vertex of the mesh, (parts,)."""
    corners = vertices[faces] - vertices[faces[0, 0]]
    six = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    return np.bincount(label, six).astype(np.float64)


def first_alike(rows: NDArray[np.float64] | NDArray[np.int32]) -> NDArray[np.int64]:
    """
    For each row the first one that is equal to it, itself where it is new.

    Parameters
    ----------
    rows : (n, k)
        Finite numbers.

    Returns
    -------
    (n,) int64
    """
    wide = np.float64 if np.issubdtype(rows.dtype, np.floating) else np.int64
    bits = np.ascontiguousarray(rows.astype(wide) + 0).view(np.uint64)  # + 0: no negative zero
    mixed = np.zeros(len(rows), dtype=np.uint64)
    for column in bits.T:
        mixed = (mixed ^ column) * _MIXER
        mixed ^= mixed >> np.uint64(29)
    # Sorting whole rows takes ten times as long as sorting a number for each.
    _, first, number = np.unique(mixed, return_index=True, return_inverse=True)
    if not np.array_equal(rows[first[number]], rows):  # two rows by chance with the same number
        _, first, number = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    return np.asarray(first[number.reshape(-1)], dtype=np.int64)


def twins(faces: NDArray[np.int32]) -> NDArray[np.int64]:
    """
    For each half-edge the opposite one, -1 where there is none or more than one.

    Half-edge ``3 f + k`` of facet f runs from its corner k to corner k + 1.

    Returns
    -------
    (3 m,) int64
    """
    start = faces.ravel().astype(np.int64)
    end = np.roll(faces, -1, axis=1).ravel().astype(np.int64)
    count = int(faces.max()) + 1
    forward, backward = start * count + end, end * count + start
    order = np.argsort(forward, kind="stable")
    run = forward[order]
    left = np.searchsorted(run, backward, side="left")
    single = np.searchsorted(run, backward, side="right") - left == 1
    # A half-edge that occurs twice has no twin either, or the answer would not be mutual.
    own = np.searchsorted(run, forward, side="right") - np.searchsorted(run, forward, side="left")
    found = np.full(len(start), -1, dtype=np.int64)
    pick = single & (own == 1)
    found[pick] = order[left[pick]]
    return found


def parts(faces: NDArray[np.int32], keep: NDArray[np.bool_], twin: NDArray[np.int64]) -> NDArray[np.int64]:
    """Label facets of `keep` that hang together over edges, 0, 1, ...; -1 elsewhere; (m,)."""
    a = np.flatnonzero(twin >= 0)
    pairs = np.column_stack((a // 3, twin[a] // 3))
    pairs = pairs[keep[pairs].all(axis=1)]
    m = len(faces)
    graph = coo_array((np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1])), shape=(m, m))
    _, label = connected_components(graph, directed=False)
    out = np.full(m, -1, dtype=np.int64)
    out[keep] = np.unique(label[keep], return_inverse=True)[1]
    return out


def join(
    surfaces: Sequence[tuple[NDArray[np.float64], NDArray[np.int32]]],
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Put surfaces into one pair of arrays, (n, 3) and (m, 3), one after the other."""
    first = np.cumsum([0] + [len(vertices) for vertices, _ in surfaces[:-1]])
    vertices = np.concatenate([vertices for vertices, _ in surfaces])
    faces = [faces + start for (_, faces), start in zip(surfaces, first, strict=True)]
    return vertices, np.concatenate(faces).astype(np.int32)


def directions(count: int) -> NDArray[np.float64]:
    """Spread unit vectors evenly over the sphere, (count, 3): a Fibonacci lattice, along which no CAD edge runs."""
    i = np.arange(count) + 0.5
    height = 1 - 2 * i / count
    radius = np.sqrt(1 - height**2)
    turn = np.pi * (1 + np.sqrt(5)) * i
    return np.column_stack((radius * np.cos(turn), radius * np.sin(turn), height))
