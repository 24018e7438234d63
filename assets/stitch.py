"""Strips of triangles between neighbouring rings of different vertex counts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

_PASSES = 12


def shift(ring: Ints, rings: int) -> Ints:
    """Half steps by which a ring's vertices are turned: every other ring, never the last."""
    return np.where(ring == rings - 1, 0, ring % 2)


@dataclass
class Strips:
    """All triangles between rings, in walking order around each strip.

    Each triangle advances by one vertex on the lower or on the upper ring of its strip; ``lower`` and
    ``upper`` are where the walk stands before it does.
    """

    strip: Ints
    """(m,) index of the lower ring."""
    place: Ints
    """(m,) position in the walk around the strip."""
    climbs: Mask
    """(m,) whether the triangle advances on the upper ring."""
    lower: Ints
    """(m,) vertex number within the lower ring."""
    upper: Ints
    """(m,) vertex number within the upper ring."""


def join(counts: Ints) -> Strips:
    """Stitch rings, all by one closed formula.

    An edge of one ring is joined to that vertex of the other in whose share of the turn the edge's middle
    lies. Everything is integer arithmetic on half steps, so that no two edges cross by rounding.

    Parameters
    ----------
    counts : (k,) integer array
        Vertices on each ring; 1 is a single point and has no edges.

    Returns
    -------
    Strips
        The triangles, strip after strip.
    """
    rings = len(counts)
    turned = shift(np.arange(rings), rings)
    edges = np.where(counts == 1, 0, counts)
    strip_a, i = _enumerate(edges[:-1])
    strip_b, j = _enumerate(edges[1:])
    na, nb, oa, ob = (part[strip_a] for part in (counts[:-1], counts[1:], turned[:-1], turned[1:]))
    met_b = -((-((2 * i + oa + 1) * nb - (ob + 1) * na)) // (2 * na))
    rank_a = i + np.where(nb == 1, 0, met_b)
    na, nb, oa, ob = (part[strip_b] for part in (counts[:-1], counts[1:], turned[:-1], turned[1:]))
    met_a = ((2 * j + ob + 1) * na - (oa + 1) * nb) // (2 * nb) + 1
    rank_b = j + np.where(na == 1, 0, met_a)
    strip = np.concatenate([strip_a, strip_b])
    size = (edges[:-1] + edges[1:])[strip]
    place = np.concatenate([rank_a, rank_b]) % size
    # Each strip's places are a permutation of its triangles, so sorting is only a scatter.
    start = np.concatenate([[0], np.cumsum(edges[:-1] + edges[1:])])[strip]
    order = np.empty_like(strip)
    order[start + place] = np.arange(len(strip))
    lower = np.concatenate([i, met_a]) % counts[:-1][strip]
    upper = np.concatenate([met_b, j]) % counts[1:][strip]
    climbs = np.arange(len(strip)) >= len(strip_a)
    return Strips(strip[order], place[order], climbs[order], lower[order], upper[order])


def improve(strips: Strips, loops: Array, counts: Ints) -> None:
    """Exchange diagonals between neighbouring triangles of a strip, in place, until they are Delaunay.

    Parameters
    ----------
    strips : Strips
        Changed in place.
    loops : (n, 3) array
        Vertices ring after ring [m].
    counts : (k,) integer array
        Vertices on each ring.
    """
    start = np.concatenate([[0], np.cumsum(counts)])
    pairs = np.flatnonzero(strips.strip[:-1] == strips.strip[1:])
    quiet = 0
    for turn in range(2 * _PASSES):
        first = pairs[(strips.place[pairs] + turn) % 2 == 0]
        first = first[strips.climbs[first] != strips.climbs[first + 1]]
        poor = first[_is_poor(strips, first, loops, start, counts)]
        quiet = quiet + 1 if len(poor) == 0 else 0
        if quiet == 2:
            break
        _exchange(strips, poor, counts)


def triangles(strips: Strips, counts: Ints) -> Ints:
    """Return the vertex numbers (m, 3) of all triangles, counter-clockwise seen from outside."""
    start = np.concatenate([[0], np.cumsum(counts)])
    a0, a1, b0, b1 = _quad(strips, np.arange(len(strips.strip)), start, counts)
    return np.stack([a0, np.where(strips.climbs, b1, a1), b0], axis=-1)


def _enumerate(sizes: Ints) -> tuple[Ints, Ints]:
    """Group number and number within the group, for groups of given sizes."""
    group = np.repeat(np.arange(len(sizes)), sizes)
    return group, np.arange(len(group)) - np.repeat(np.cumsum(sizes) - sizes, sizes)


def _quad(strips: Strips, which: Ints, start: Ints, counts: Ints) -> tuple[Ints, Ints, Ints, Ints]:
    """Vertex numbers of where the walk stands on both rings, and of the next vertex on each."""
    s, i, j = strips.strip[which], strips.lower[which], strips.upper[which]
    low, high = start[s], start[s + 1]
    return low + i, low + (i + 1) % counts[s], high + j, high + (j + 1) % counts[s + 1]


def _is_poor(strips: Strips, first: Ints, loops: Array, start: Ints, counts: Ints) -> Mask:
    """Tell where the angles opposite a diagonal sum to more than half a turn."""
    a0, a1, b0, b1 = (loops[v] for v in _quad(strips, first, start, counts))
    climbs = strips.climbs[first][:, None]
    # Climbing first puts the diagonal between a0 and b1, otherwise it is between a1 and b0.
    p, q = np.where(climbs, a0, a1), np.where(climbs, b1, b0)
    r, s = np.where(climbs, b0, a0), np.where(climbs, a1, b1)
    return _cotangent(p - r, q - r) + _cotangent(p - s, q - s) < -1e-9


def _cotangent(u: Array, v: Array) -> Array:
    area = np.linalg.norm(np.cross(u, v), axis=-1)
    return np.asarray(np.einsum("ij,ij->i", u, v) / np.maximum(area, 1e-30))


def _exchange(strips: Strips, first: Ints, counts: Ints) -> None:
    """Swap the order of two steps of the walk: the one that came second now starts from the first's place."""
    climbs = strips.climbs[first]
    s = strips.strip[first]
    strips.climbs[first], strips.climbs[first + 1] = ~climbs, climbs
    strips.lower[first + 1] = (strips.lower[first] + climbs) % counts[s]
    strips.upper[first + 1] = (strips.upper[first] + ~climbs) % counts[s + 1]
