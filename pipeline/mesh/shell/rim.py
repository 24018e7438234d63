"""From the rough border of a cavity to the lip of the housing itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import gaussian_filter1d, median_filter
from scipy.spatial import cKDTree

from contactbench.pipeline.mesh.shell.openings import Opening, describe

if TYPE_CHECKING:
    from numpy.typing import NDArray

# The lip is where the housing turns into the mouth: the furthest point outwards and this much inwards.
# Leaning inwards finds the inner edge of a flat lip; on a round lip it is the angle at which the patch
# leaves the housing.
_LEAN = np.tan(np.radians(20.0))
_POINTS = 240
_FEWEST = 8


def find_lip(
    opening: Opening, vertices: NDArray[np.float64], faces: NDArray[np.int32], reach: float
) -> Opening:
    """
    Move the rim of an opening onto the edge of the surface that it was roughly found on.

    Parameters
    ----------
    opening : Opening
        Found on a coarse wrap.
    vertices : (n, 3) float64
        Of the surface itself, metres.
    faces : (m, 3) int32
    reach : float
        How far the rim may be from the lip, metres.

    Returns
    -------
    Opening
        With a rim of evenly spaced points.
    """
    rim = resample(opening.rim, _POINTS)
    step = opening.perimeter / _POINTS
    edges = _edge_points(vertices, faces, rim, 2 * reach, step / 2)
    if len(edges) == 0:
        return opening
    tree = cKDTree(edges)
    # Each search starts nearer to the lip than the one before: it needs less smoothing, which rounds
    # corners, and a shorter reach.
    for far in (reach, reach / 2, reach / 3, reach / 4):
        rim = resample(rim, _POINTS)
        rim = gaussian_filter1d(rim, far / (2 * step), axis=0, mode="wrap")
        rim = without_loops(_climb(rim, opening.axes[2], edges, tree, far), opening)
    rim = resample(rim, _POINTS)
    bottom = opening.centre - opening.depth * opening.axes[2]
    return describe(rim, bottom[None])


def resample(loop: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """Place `count` points at equal distances along a closed polyline (k, 3)."""
    closed = np.vstack((loop, loop[:1]))
    along = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))))
    wanted = np.linspace(0, along[-1], count, endpoint=False)
    return np.column_stack([np.interp(wanted, along, closed[:, axis]) for axis in range(3)])


def crossings(flat: NDArray[np.float64]) -> NDArray[np.int64]:
    """
    Find where a closed polygon crosses itself, by its first two coordinates.

    Parameters
    ----------
    flat : (k, 2 or more) float64

    Returns
    -------
    (c, 2) int64
        Pairs of sides, the lower first; side i runs from point i to the next.
    """
    a, b = flat[:, :2], np.roll(flat[:, :2], -1, axis=0)

    def side(p: NDArray[np.float64], q: NDArray[np.float64], r: NDArray[np.float64]) -> NDArray[np.float64]:
        u, v = q - p, r - p
        return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])

    A, B = a[:, None], b[:, None]
    crossing = (side(A, B, a) * side(A, B, b) < 0) & (side(a, b, A) * side(a, b, B) < 0)
    return np.argwhere(np.triu(crossing))


def without_loops(rim: NDArray[np.float64], opening: Opening) -> NDArray[np.float64]:
    """Cut off what a rim (k, 3) runs round between crossing itself seen from outside, the shorter way each time."""
    while len(found := crossings(opening.to_plane(rim))) and len(rim) > _FEWEST:
        first, second = found[0]
        inner = np.arange(first + 1, second + 1)
        outer = np.delete(np.arange(len(rim)), inner)
        rim = rim[inner if len(outer) < len(inner) else outer]
    return rim


def _climb(
    rim: NDArray[np.float64],
    outwards: NDArray[np.float64],
    edges: NDArray[np.float64],
    tree: cKDTree,
    reach: float,
) -> NDArray[np.float64]:
    # Over a few points either way: where two neighbours have changed places it must not turn about.
    span = max(1, round(0.6 * reach * len(rim) / np.linalg.norm(np.diff(rim, axis=0), axis=1).sum()))
    tangent = np.roll(rim, -span, axis=0) - np.roll(rim, span, axis=0)
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), np.finfo(float).tiny)
    up = outwards - (tangent @ outwards)[:, None] * tangent
    up /= np.maximum(np.linalg.norm(up, axis=1, keepdims=True), np.finfo(float).tiny)
    inwards = np.cross(up, tangent)  # the rim runs anticlockwise seen from outside
    move = np.zeros((len(rim), 3))
    for i, near in enumerate(tree.query_ball_point(rim, reach)):
        offset = edges[near] - rim[i]
        beside = np.abs(offset @ tangent[i]) < reach / 3
        if beside.any():
            offset = offset[beside]
            best = offset[np.argmax(offset @ (up[i] + _LEAN * inwards[i]))]
            move[i] = best - (best @ tangent[i]) * tangent[i]
    # A neighbour that found another edge is outvoted.
    return rim + median_filter(move, size=(9, 1), mode="wrap")


def _edge_points(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    rim: NDArray[np.float64],
    reach: float,
    step: float,
) -> NDArray[np.float64]:
    """Points along the edges near the rim: what stands out furthest on a polyhedron is an edge."""
    low, high = rim.min(axis=0) - reach, rim.max(axis=0) + reach
    corners = vertices[faces]
    near = ((corners.max(axis=1) >= low) & (corners.min(axis=1) <= high)).all(axis=1)
    pairs = np.sort(np.concatenate([faces[near][:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
    pairs = np.unique(pairs, axis=0)
    a, b = vertices[pairs[:, 0]], vertices[pairs[:, 1]]
    pieces = np.ceil(np.linalg.norm(b - a, axis=1) / step).astype(int) + 1
    which = np.repeat(np.arange(len(pairs)), pieces + 1)
    place = np.arange(len(which)) - np.repeat(np.cumsum(pieces + 1) - (pieces + 1), pieces + 1)
    share = (place / pieces[which])[:, None]
    points: NDArray[np.float64] = (1 - share) * a[which] + share * b[which]
    points = points[((points >= low) & (points <= high)).all(axis=1)]
    if len(points) == 0:
        return points
    close, _ = cKDTree(rim).query(points, distance_upper_bound=reach)
    return points[np.isfinite(close)]
