"""Plain geometry and connectivity of triangle arrays."""

from collections.abc import Sequence

import numpy as np
import scipy  # of which a part is loaded when it is asked for: together they take half a second

from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Surface
from contactbench.pipeline.mesh.probe import connected, degenerate_facets

_MIXER = np.uint64(0x9E3779B97F4A7C15)


def cross_products(vertices: Floats, faces: Ints) -> Floats:
    """Twice the area vector of each facet, (m, 3), in the square of the vertices' unit."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    return np.cross(b - a, c - a)


def vertex_normals(area_vectors: Floats, faces: Ints, count: int) -> Floats:
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
    unit: Floats = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    return unit


def six_volumes(vertices: Floats, faces: Ints, label: Longs) -> Floats:
    """Return six times the signed volume of each labelled part, as seen from one vertex of the mesh, (parts,)."""
    corners = vertices[faces] - vertices[faces[0, 0]]
    six = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    return np.bincount(label, six).astype(np.float64)


def first_alike(rows: Floats | Ints) -> Longs:
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


def twins(faces: Ints) -> Longs:
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


def parts(faces: Ints, keep: Mask, twin: Longs) -> Longs:
    """Label facets of `keep` that hang together over edges, 0, 1, ...; -1 elsewhere; (m,)."""
    a = np.flatnonzero(twin >= 0)
    pairs = np.column_stack((a // 3, twin[a] // 3))
    pairs = pairs[keep[pairs].all(axis=1)]
    label = connected(len(faces), *pairs.T)
    out = np.full(len(faces), -1, dtype=np.int64)
    out[keep] = np.unique(label[keep], return_inverse=True)[1]
    return out


def join(surfaces: Sequence[Surface]) -> Surface:
    """Put surfaces into one pair of arrays, (n, 3) and (m, 3), one after the other."""
    first = np.cumsum([0] + [len(vertices) for vertices, _ in surfaces[:-1]])
    vertices = np.concatenate([vertices for vertices, _ in surfaces])
    faces = [faces + start for (_, faces), start in zip(surfaces, first, strict=True)]
    return vertices, np.concatenate(faces).astype(np.int32)


def directions(count: int) -> Floats:
    """Spread unit vectors evenly over the sphere, (count, 3): a Fibonacci lattice, along which no CAD edge runs."""
    i = np.arange(count) + 0.5
    height = 1 - 2 * i / count
    radius = np.sqrt(1 - height**2)
    turn = np.pi * (1 + np.sqrt(5)) * i
    return np.column_stack((radius * np.cos(turn), radius * np.sin(turn), height))


# ---- make one connected surface of triangles that each bring their own vertices ------------------


# A row of flat facets side by side takes one round for each.
_ROUNDS = 8


def merge_vertices(vertices: Floats, faces: Ints, tolerance: float) -> Surface:
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
    vertices, faces = only_used(vertices, faces)
    first = _first_in_cell(vertices, tolerance / 2)
    kept = np.flatnonzero(first == np.arange(len(first)))
    if not _any_near(vertices[kept], tolerance):
        return only_used(vertices, first[faces])
    # One vertex per cell bounds the pairs: a file with all its points on one spot cannot fill the memory.
    pairs = scipy.spatial.cKDTree(vertices[kept]).query_pairs(tolerance, output_type="ndarray")
    if len(pairs):
        label = connected(len(kept), *pairs.T)
        _, lowest = np.unique(label, return_index=True)
        root = np.arange(len(first))
        root[kept] = kept[lowest[label]]
        first = root[first]
    return only_used(vertices, first[faces])


def _any_near(vertices: Floats, tolerance: float) -> bool:
    """Tell whether two may be within the tolerance: both then lie in one cell of one of eight shifted grids."""
    shifts = tolerance * np.array(list(np.ndindex(2, 2, 2)))
    first = (_first_in_cell(vertices, 2 * tolerance, shift) for shift in shifts)
    return any((each != np.arange(len(vertices))).any() for each in first)


def _first_in_cell(vertices: Floats, cell: float, shift: Floats | float = 0.0) -> Longs:
    """For each vertex the first one in the same cubic cell; its diagonal is shorter than two cells."""
    return first_alike(np.floor((vertices - vertices.min(axis=0) + shift) / cell).astype(np.int64))


def only_used(vertices: Floats, faces: Ints | Longs) -> Surface:
    """Leave out vertices that no facet uses; the order of the others stays."""
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    number = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return vertices[used], number[faces]


def flip_flat_facets(vertices: Floats, faces: Ints) -> tuple[Ints, Longs]:
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


def _flip(vertices: Floats, faces: Ints, origin: Longs, flat: Longs) -> bool:
    """Flip, in place, flat facets no two of which have a facet in common; tell whether any was."""
    count = np.int64(len(vertices))
    ends = np.roll(faces, -1, axis=1).astype(np.int64)
    # Edge k of a facet goes from corner k to the next.
    key = (faces * count + ends).ravel()
    order = np.argsort(key, kind="stable")
    ordered = key[order]

    def times(wanted: Longs) -> Longs:
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
