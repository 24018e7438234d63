"""From the rough border of a cavity to the lip of the housing itself.

Mouths of cavities: where a probe's housing lets a line of action in.

A cavity is found by the light that reaches it: on the outside of a body nearly the whole half-space is free,
in a cavity little of it is, and hardly anything lies between. The border of a dark part is a mouth's rim.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import gaussian_filter1d, median_filter
from scipy.spatial import cKDTree

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.shell.exposure import exposure
from contactbench.pipeline.mesh.triangles import cross_products, parts, twins

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

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


# ---- mouths of cavities: where a probe's housing lets a line of action in ------------------------


# A facet that sees less of its half-space lies in a cavity. The inner edge of a right angle sees 0.5.
DARK = 0.45

# ... and of a cavity a tenth at least sees less than this. A shallow pan hovers about DARK and falls into pieces
# that are each deep for their width.
_DEEP = 0.25

# A dent shallower than this share of its width is part of the shape: what enters it meets the outside.
_SHALLOW = 0.3


@dataclass(frozen=True, eq=False)
class Opening:
    """
    A mouth in the outer surface, and the frame in which it is flat.

    Attributes
    ----------
    rim : (k, 3) float64
        Closed polyline, without repeating its first point, anticlockwise seen from outside; metres.
    centre : (3,) float64
        Mean of the rim, metres.
    axes : (3, 3) float64
        Rows: along the length, along the width, and outwards.
    length, width : float
        Extents of the rim, metres.
    depth : float
        From the rim's plane to the deepest point of the cavity, metres.
    area : float
        Of the rim's outline in its plane, m².
    """

    rim: NDArray[np.float64]
    centre: NDArray[np.float64]
    axes: NDArray[np.float64]
    length: float
    width: float
    depth: float
    area: float

    def to_plane(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates along length, width and outwards from the centre, (k, 3), metres."""
        return (points - self.centre) @ self.axes.T

    def from_plane(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Invert `to_plane`."""
        return points @ self.axes + self.centre

    @property
    def is_dent(self) -> bool:
        """Whether it is so shallow that it is part of the shape."""
        return self.depth < _SHALLOW * self.width

    @property
    def perimeter(self) -> float:
        """Length of the rim, metres."""
        return float(np.linalg.norm(np.roll(self.rim, -1, axis=0) - self.rim, axis=1).sum())

    @property
    def sentence(self) -> str:
        """The opening in words."""
        size = message(
            f"{arg(1e3 * self.length):.1f} x {arg(1e3 * self.width):.1f} mm, {arg(1e3 * self.depth):.1f} mm deep"
        )
        x, y, z = 1e3 * self.centre
        return message(f"an opening of {arg(size)}, at ({arg(x):.1f}, {arg(y):.1f}, {arg(z):.1f}) mm")


def find_openings(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    *,
    smallest: float,
    tick: Callable[[float], None] | None = None,
) -> tuple[Opening, ...]:
    """
    Find the mouths of the cavities of a closed, outward surface, largest first; dents are not cavities.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres.
    faces : (m, 3) int32
        Closed and 2-manifold.
    smallest : float
        Width of mouth below which it does not count, metres.
    tick : callable, optional
        Told the share that is done; may raise to stop.
    """
    dark, twin, light = _dark(vertices, faces, tick)
    cavity = parts(faces, dark, twin)
    found = []
    for number in range(int(cavity.max(initial=-1)) + 1):
        inside = cavity == number
        if np.quantile(light[inside], 0.1) > _DEEP:
            continue
        bottom = vertices[np.unique(faces[inside])]
        for loop in _loops(faces, inside, twin):
            opening = describe(vertices[loop], bottom)
            if opening.width >= smallest and not opening.is_dent:
                found.append(opening)
    return tuple(sorted(found, key=lambda opening: -opening.area))


def describe(rim: NDArray[np.float64], bottom: NDArray[np.float64]) -> Opening:
    """Give a rim (k, 3) its frame and sizes; `bottom` (b, 3) are points of the cavity behind it; metres."""
    centre = rim.mean(axis=0)
    axes = np.linalg.svd(rim - centre, full_matrices=False)[2]
    outwards = axes[2] if np.mean((bottom - centre) @ axes[2]) < 0 else -axes[2]
    axes = np.vstack((axes[0], np.cross(outwards, axes[0]), outwards))
    flat = (rim - centre) @ axes.T
    area = shoelace(flat)
    if area < 0:
        rim, area = rim[::-1].copy(), -area
    length, width = np.ptp(flat[:, :2], axis=0)
    depth = float(np.max(-(bottom - centre) @ outwards, initial=0.0))
    return Opening(rim, centre, axes, float(length), float(width), depth, area)


def shoelace(flat: NDArray[np.float64]) -> float:
    """Signed area of a polygon's first two coordinates, positive anticlockwise."""
    x, y = flat[:, 0], flat[:, 1]
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def _dark(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], tick: Callable[[float], None] | None
) -> tuple[NDArray[np.bool_], NDArray[np.int64], NDArray[np.float64]]:
    """Mark the facets in cavities, specks removed, (m,), and give the half-edges' twins and the light, (m,)."""
    twin = twins(faces)
    light = exposure(vertices, faces, tick=tick)
    dark = light < DARK
    around = np.where(twin >= 0, twin // 3, np.arange(len(twin)) // 3).reshape(-1, 3)
    for _ in range(4):  # a facet follows two of its three neighbours
        dark = dark[around].sum(axis=1) + dark > 1.5
    # What is bright but cut off from the largest bright part is the lit floor of a cavity.
    bright = parts(faces, ~dark, twin)
    if bright.max() > 0:
        areas = np.linalg.norm(cross_products(vertices, faces), axis=1)
        largest = np.argmax(np.bincount(bright[bright >= 0], areas[bright >= 0]))
        dark |= bright != largest
    return dark, twin, light


def _loops(
    faces: NDArray[np.int32], inside: NDArray[np.bool_], twin: NDArray[np.int64]
) -> Iterator[NDArray[np.int64]]:
    """Walk round each border of the facets `inside`; yields vertex numbers."""
    half = np.flatnonzero(np.repeat(inside, 3) & ~inside[twin // 3])
    left = set(half.tolist())
    while left:
        start = here = min(left)
        loop = []
        while True:
            left.discard(here)
            loop.append(int(faces[here // 3, here % 3]))
            here = _following(here)
            while inside[twin[here] // 3]:  # turn about the end of the half-edge up to the next border
                here = _following(int(twin[here]))
            if here == start:
                break
        yield np.array(loop)


def _following(half_edge: int) -> int:
    return half_edge - half_edge % 3 + (half_edge + 1) % 3
