"""Facets too thin to have a normal, as cutting leaves them: joined to what lies beside them."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Unpack

import numpy as np
import scipy

from contactbench.pipeline.kernel import SurfaceIndex, crossings
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Soup
from contactbench.pipeline.mesh.engines import Control, cut_along_crossings
from contactbench.pipeline.mesh.probe import degenerate_facets, edge_table
from contactbench.pipeline.mesh.soundness import CROSSING, OVERLAP
from contactbench.pipeline.mesh.triangles import cross_products, first_alike, only_used

_STEEP = 0.5  # cosine: a facet with a normal may not turn further


def without_slivers(vertices: Floats, faces: Ints, slivers: Longs, width: float) -> tuple[Ints, Longs]:
    """
    Join slivers to their neighbours: one of their edges shrinks to a point.

    Parameters
    ----------
    vertices : (n, 3) float64
        They stay where they are; some are not used any longer.
    faces : (m, 3) int32
        Closed, 2-manifold and consistently oriented, and so is the result.
    slivers : (k,) int64
        Facets to join. Those that cannot be joined without turning a wider facet are left as they are.
    width : float
        Only what is lower is joined, and the surface moves by no more; in the vertices' unit.

    Returns
    -------
    faces : (l, 3) int32
    of : (l,) int64
        The facet that each was.
    """
    faces = faces.copy()
    left = np.ones(len(faces), dtype=bool)
    for facet in slivers.tolist():
        if left[facet] and _height(vertices, faces[[facet]])[0] <= width:
            for a, b in _by_length(vertices, faces[facet]):
                if _shrunk(vertices, faces, left, a, b, width):
                    break
    return faces[left], np.flatnonzero(left)


def _by_length(vertices: Floats, corners: Ints) -> Iterator[tuple[int, int]]:
    """Give the edges, shortest first, each in both directions."""
    ends = np.column_stack((corners, np.roll(corners, -1)))
    length = np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1)
    for a, b in ends[np.argsort(length)].tolist():
        yield a, b
        yield b, a


def _shrunk(vertices: Floats, faces: Ints, left: Mask, gone: int, stays: int, width: float) -> bool:
    """Move a vertex onto its neighbour, unless the surface would meet itself or a wider facet turn; tell whether."""
    round_one, round_other = (
        np.flatnonzero(left & (faces == vertex).any(axis=1)) for vertex in (gone, stays)
    )
    between = np.intersect1d(round_one, round_other)
    shared = np.intersect1d(faces[round_one], faces[round_other])
    # Both ends and the two vertices across the edge: one more, and the surface would meet itself.
    if len(between) != 2 or len(shared) != 4:
        return False
    moved = np.setdiff1d(round_one, between)
    after = np.where(faces[moved] == gone, stays, faces[moved]).astype(np.int32)
    if _spoils(vertices, faces[moved], after, width):
        return False
    if SurfaceIndex(vertices, after).closest(vertices[[gone]])[0][0] > width:
        return False
    before = faces[moved]
    met = _meeting(vertices, faces, left, moved)
    faces[moved] = after
    left[between] = False
    if _meeting(vertices, faces, left, moved) > met:
        faces[moved] = before
        left[between] = True
        return False
    return True


def _meeting(vertices: Floats, faces: Ints, left: Mask, some: Longs) -> int:
    """Count the pairs of facets round some that cross or lie on each other."""
    corners = vertices[faces[some]].reshape(-1, 3)
    spread = np.stack([vertices[faces[:, corner]] for corner in range(3)])
    near = ((spread.max(axis=0) >= corners.min(axis=0)) & (spread.min(axis=0) <= corners.max(axis=0))).all(
        axis=1
    )
    return int(crossings(vertices, np.ascontiguousarray(faces[left & near]))[2][[CROSSING, OVERLAP]].sum())


def _spoils(vertices: Floats, before: Ints, after: Ints, width: float) -> bool:
    """Tell whether a facet loses its area, or one that is wider turns."""
    old, new = cross_products(vertices, before), cross_products(vertices, after)
    sizes = np.linalg.norm(old, axis=1) * np.linalg.norm(new, axis=1)
    turns = np.einsum("ij,ij->i", old, new) < _STEEP * sizes
    return bool((degenerate_facets(vertices, after) | (turns & (_height(vertices, before) > width))).any())


def _height(vertices: Floats, faces: Ints) -> Floats:
    corners = vertices[faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    return np.asarray(np.linalg.norm(cross_products(vertices, faces), axis=1) / longest)


# ---- cut facets along the lines where they cross or touch, until none crosses another ------------


# New vertices are rounded, and pieces beside them may cross again by the last bits.
_ROUNDS = 12
# Of the size. As fine as double precision allows: coarser, and thin facets of real files are moved across others.
_GRID = 2.0**-42
_WIDER = 8.0  # times the needles that are left out, where a round brings nothing
_SAME = 1e-11  # of the size: new vertices nearer than this are one
_WORSE = 3.0  # times the pairs that were left: it will not end
_MOST = 10.0  # times the facets that cutting may make of what it was given


@dataclass(frozen=True, eq=False)
class Cut:
    """
    Facets that meet at shared vertices and edges only.

    Attributes
    ----------
    vertices : (n, 3) float64
        Those of facets that met others were rounded by 1e-12 of the size; the others are as they were.
    faces : (m, 3) int32
        With area, none twice.
    born : (m,) int64
        The facet given that each is, or is a piece of.
    left : int
        Pairs of facets that still cross; 0 nearly always.
    bodies : int
        How many closed bodies were united; 0 where facets were cut one by one.
    """

    vertices: Floats
    faces: Ints
    born: Longs
    left: int
    bodies: int = 0


def cut_crossings(vertices: Floats, faces: Ints, **control: Unpack[Control]) -> Cut:
    """
    Cut facets along the lines where they cross or touch. A facet that meets no other in this way is left as it is.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
    **control
        See `contactbench.pipeline.mesh.engines.child.run`.

    Returns
    -------
    Cut

    Raises
    ------
    EngineError, Cancelled
        See `contactbench.pipeline.mesh.engines.child.run`.
    """
    size = float(np.ptp(vertices, axis=0).max())
    grid = 2.0 ** np.ceil(np.log2(size * _GRID))
    state = distinct(vertices, faces, np.arange(len(faces)))
    best = Cut(*state, left=-1)
    most = _MOST * max(len(faces), 1000)
    width = _SAME * size
    for _ in range(_ROUNDS):
        vertices, faces, born = state
        if best.left >= 0 and len(faces) > most:
            break
        pairs, _, counts, _ = crossings(vertices, faces)
        left = int(counts.sum())
        if best.left < 0 or left < best.left:
            best = Cut(vertices, faces, born, left)
        else:  # what is left are needles as low as the grid is wide, and what they meet
            width *= _WIDER
        if left == 0 or left > _WORSE * best.left:
            break
        met = np.unique(pairs)
        # All that meets something lies on the grid, or what is rounded would cross what is not.
        corners = np.unique(faces[met])
        vertices = vertices.copy()
        vertices[corners] = np.rint(vertices[corners] / grid) * grid
        local = np.searchsorted(corners, faces[met]).astype(
            np.int32
        )  # the engine looks at every vertex it is given
        points, pieces, of = cut_along_crossings(vertices[corners], local, **control)
        points = np.rint(points / grid) * grid
        whole = np.ones(len(faces), dtype=bool)
        whole[met] = False
        state = sew(
            *distinct(
                np.concatenate((vertices, points)),
                np.concatenate((faces[whole], pieces + np.int32(len(vertices)))),
                np.concatenate((born[whole], born[met[of]])),
            ),
            _SAME * size,
        )
        if width > _SAME * size:
            state = _without_needles(*state, width)
    return best


# ---- open edges ----------------------------------------------------------------------------------


# Vertices nearer than this share of the size are one.
ROUNDING = 1e-8
_PART = 0.3  # of the shortest edge at a vertex


def distinct(vertices: Floats, faces: Ints, born: Longs) -> Soup:
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
    vertices, faces = only_used(vertices, first_alike(vertices)[faces])
    area = np.linalg.norm(cross_products(vertices, faces), axis=1)
    apart = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    faces, born = faces[apart & (area > 0)], born[apart & (area > 0)]
    once = first_alike(np.sort(faces, axis=1)) == np.arange(len(faces))
    return vertices, faces[once], born[once]


def sew(vertices: Floats, faces: Ints, born: Longs, tolerance: float) -> Soup:
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
    vertices, faces, born = distinct(vertices, _joined(vertices, faces, np.unique(rims), tolerance), born)
    return _split(vertices, faces, born, tolerance)


def _joined(vertices: Floats, faces: Ints, rim: Longs, tolerance: float) -> Ints:
    """Make vertices that are near each other one; returns the facets (m, 3)."""
    reach = _reach(vertices, faces, rim, tolerance)
    # Each takes the place of the first that is near it; chains are not followed, so that nothing moves further.
    root = np.arange(len(vertices))
    for one, near in zip(
        rim, scipy.spatial.cKDTree(vertices[rim]).query_ball_point(vertices[rim], reach[rim]), strict=True
    ):
        if root[one] == one:
            others = rim[near]
            others = others[(others > one) & (root[others] == others)]
            close = np.linalg.norm(vertices[others] - vertices[one], axis=1) <= reach[others]
            root[others[close]] = one
    return root[faces].astype(np.int32)


def _split(vertices: Floats, faces: Ints, born: Longs, tolerance: float) -> Soup:
    """Split facets at vertices of open edges that lie on their own open edge."""
    rims = open_edges(faces, len(vertices))
    again = _split_at(vertices, faces, born, _on_edges(vertices, faces, rims, tolerance))
    return _split(*again, tolerance) if len(again[1]) > len(faces) else again


def _split_at(vertices: Floats, faces: Ints, born: Longs, on: dict[tuple[int, int], list[int]]) -> Soup:
    """Split facets at the vertices on their edges; one whose own third vertex is on its edge is gone."""
    if not on:
        return vertices, faces, born
    near = np.zeros(len(vertices), dtype=bool)
    near[list(on)] = True
    whole = np.ones(len(faces), dtype=bool)
    new: list[list[int]] = []
    of: list[int] = []
    for facet in np.flatnonzero(near[faces].sum(axis=1) > 1).tolist():
        corners = faces[facet].tolist()
        pieces = [corners]
        for start, end in ((corners[0], corners[1]), (corners[1], corners[2]), (corners[2], corners[0])):
            chain = on.get((min(start, end), max(start, end)), [])
            piece = next((each for each in pieces if start in each and end in each), None)
            if chain and piece is not None:
                third = next(each for each in piece if each not in (start, end))
                stops = [start, *(chain if start < end else chain[::-1]), end]
                pieces.remove(piece)
                pieces += [[one, two, third] for one, two in pairwise(stops) if third not in chain]
                whole[facet] = False
        if not whole[facet]:
            new += pieces
            of += [int(born[facet])] * len(pieces)
    split = np.array(new, dtype=np.int32).reshape(-1, 3)
    born = np.concatenate((born[whole], np.array(of, dtype=np.int64)))
    return distinct(vertices, np.concatenate((faces[whole], split)), born)


def _on_edges(
    vertices: Floats, faces: Ints, rims: Longs, tolerance: float
) -> dict[tuple[int, int], list[int]]:
    """Find the ends of edges (k, 2) that lie on others of them; for each of those, in the order from its lower end."""
    on: dict[tuple[int, int], list[int]] = {}
    rim = np.unique(rims)
    if len(rim) == 0:
        return on
    reach = _reach(vertices, faces, rim, tolerance)
    a, b = vertices[rims[:, 0]], vertices[rims[:, 1]]
    length = np.linalg.norm(b - a, axis=1)
    around = scipy.spatial.cKDTree(vertices[rim]).query_ball_point((a + b) / 2, length / 2)
    for edge, near in enumerate(around):
        found = rim[near]
        found = found[(found != rims[edge, 0]) & (found != rims[edge, 1])]
        along = (vertices[found] - a[edge]) @ (b[edge] - a[edge]) / length[edge] ** 2
        off = np.linalg.norm(vertices[found] - a[edge] - along[:, None] * (b[edge] - a[edge]), axis=1)
        # Nearer to an end than to the edge, it would make no shorter edges.
        inner = (off <= reach[found]) & (np.minimum(along, 1 - along) * length[edge] > off)
        if inner.any():
            order = np.argsort(along[inner])
            on[int(rims[edge, 0]), int(rims[edge, 1])] = found[inner][order].tolist()
    return on


def _without_needles(vertices: Floats, faces: Ints, born: Longs, width: float) -> Soup:
    """Leave out facets lower than a width: their vertices become one, or split the edge that they lie on."""
    rim = np.unique(faces[_height(vertices, faces) < width]).astype(np.int64)
    vertices, faces, born = distinct(vertices, _joined(vertices, faces, rim, width), born)
    thin = np.sort(faces[_height(vertices, faces) < width], axis=1).astype(np.int64)
    edges = np.unique(np.vstack((thin[:, :2], thin[:, 1:], thin[:, ::2])), axis=0)
    return _split_at(vertices, faces, born, _on_edges(vertices, faces, edges, width))


def _reach(vertices: Floats, faces: Ints, rim: Longs, tolerance: float) -> Floats:
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


def open_edges(faces: Ints, vertex_count: int) -> Longs:
    """List the edges of one facet only, (k, 2), the lower vertex first."""
    edges = edge_table(faces, vertex_count)
    return np.asarray(np.column_stack((edges.low, edges.high))[edges.uses == 1])


def holes(faces: Ints, vertex_count: int) -> list[Longs]:
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
    found: list[Longs] = []
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
