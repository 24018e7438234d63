"""From the rough border of a cavity to the lip of the housing itself.

Mouths of cavities: where a probe's housing lets a line of action in.

A cavity is found by the light that reaches it: on the outside of a body nearly the whole half-space is free,
in a cavity little of it is, and hardly anything lies between. The border of a dark part is a mouth's rim.

Surfaces across an opening: invented, because the file says nothing about what closes it.

A patch is a height over the plane of the rim, so it never folds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import scipy

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Surface
from contactbench.pipeline.mesh.shell.exposure import exposure
from contactbench.pipeline.mesh.triangles import cross_products, parts, twins

# The lip is where the housing turns into the mouth: the furthest point outwards and this much inwards.
# Leaning inwards finds the inner edge of a flat lip; on a round lip it is the angle at which the patch
# leaves the housing.
_LEAN = np.tan(np.radians(20.0))
_POINTS = 240
_FEWEST = 8


def find_lip(opening: Opening, vertices: Floats, faces: Ints, reach: float) -> Opening:
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
    tree = scipy.spatial.cKDTree(edges)
    # Each search starts nearer to the lip than the one before: it needs less smoothing, which rounds
    # corners, and a shorter reach.
    for far in (reach, reach / 2, reach / 3, reach / 4):
        rim = resample(rim, _POINTS)
        rim = scipy.ndimage.gaussian_filter1d(rim, far / (2 * step), axis=0, mode="wrap")
        rim = without_loops(_climb(rim, opening.axes[2], edges, tree, far), opening)
    rim = resample(rim, _POINTS)
    bottom = opening.centre - opening.depth * opening.axes[2]
    return describe(rim, bottom[None])


def resample(loop: Floats, count: int) -> Floats:
    """Place `count` points at equal distances along a closed polyline (k, 3)."""
    closed = np.vstack((loop, loop[:1]))
    along = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))))
    wanted = np.linspace(0, along[-1], count, endpoint=False)
    return np.column_stack([np.interp(wanted, along, closed[:, axis]) for axis in range(3)])


def crossings(flat: Floats) -> Longs:
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

    def side(p: Floats, q: Floats, r: Floats) -> Floats:
        u, v = q - p, r - p
        return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])

    A, B = a[:, None], b[:, None]
    crossing = (side(A, B, a) * side(A, B, b) < 0) & (side(a, b, A) * side(a, b, B) < 0)
    return np.argwhere(np.triu(crossing))


def without_loops(rim: Floats, opening: Opening) -> Floats:
    """Cut off what a rim (k, 3) runs round between crossing itself seen from outside, the shorter way each time."""
    while len(found := crossings(opening.to_plane(rim))) and len(rim) > _FEWEST:
        first, second = found[0]
        inner = np.arange(first + 1, second + 1)
        outer = np.delete(np.arange(len(rim)), inner)
        rim = rim[inner if len(outer) < len(inner) else outer]
    return rim


def _climb(rim: Floats, outwards: Floats, edges: Floats, tree: scipy.spatial.cKDTree, reach: float) -> Floats:
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
    return rim + scipy.ndimage.median_filter(move, size=(9, 1), mode="wrap")


def _edge_points(vertices: Floats, faces: Ints, rim: Floats, reach: float, step: float) -> Floats:
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
    points: Floats = (1 - share) * a[which] + share * b[which]
    points = points[((points >= low) & (points <= high)).all(axis=1)]
    if len(points) == 0:
        return points
    close, _ = scipy.spatial.cKDTree(rim).query(points, distance_upper_bound=reach)
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

    rim: Floats
    centre: Floats
    axes: Floats
    length: float
    width: float
    depth: float
    area: float

    def to_plane(self, points: Floats) -> Floats:
        """Coordinates along length, width and outwards from the centre, (k, 3), metres."""
        return (points - self.centre) @ self.axes.T

    def from_plane(self, points: Floats) -> Floats:
        """Invert `to_plane`."""
        return points @ self.axes + self.centre

    @property
    def is_dent(self) -> bool:
        """Whether it is so shallow that it is part of the shape."""
        return self.depth < _SHALLOW * self.width

    @property
    def crosses_itself(self) -> bool:
        """Whether its rim does, seen from outside."""
        rim = self.to_plane(self.rim)
        return bool(len(crossings(rim)) or shoelace(rim) <= 0)

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
    vertices: Floats, faces: Ints, *, smallest: float, tick: Callable[[float], None] | None = None
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


def describe(rim: Floats, bottom: Floats) -> Opening:
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


def shoelace(flat: Floats) -> float:
    """Signed area of a polygon's first two coordinates, positive anticlockwise."""
    x, y = flat[:, 0], flat[:, 1]
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def _dark(vertices: Floats, faces: Ints, tick: Callable[[float], None] | None) -> tuple[Mask, Longs, Floats]:
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


def _loops(faces: Ints, inside: Mask, twin: Longs) -> Iterator[Longs]:
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


# ---- surfaces across an opening: invented, because the file says nothing about what closes it ----


_LONG = 2.0  # a mouth longer than this many times its width has two long rims
_FLAT = 1e-9  # of the length
_SUNK = 0.02  # of the spacing: some hundredths of a millimetre


class Closing(StrEnum):
    """How to close an opening."""

    AUTO = "auto"
    FAIR = "fair"
    RULED = "ruled"
    HULL = "hull"
    OPEN = "open"


def choose(opening: Opening) -> Closing:
    """Straight lines between two long rims, otherwise a fair surface."""
    return Closing.RULED if opening.length >= _LONG * opening.width else Closing.FAIR


def make_patch(
    opening: Opening,
    closing: Closing,
    spacing: float,
    collar: float = 0.0,
    leans: tuple[float, ...] = (30.0, 70.0),
) -> Surface:
    """
    Make the surface that closes an opening.

    Parameters
    ----------
    opening : Opening
    closing : Closing
        FAIR: the surface of least bending through the rim (thin-plate spline). RULED: straight lines across
        the width, between the two long rims. HULL: the lowest surface without a dent that the rim allows.
    spacing : float
        Between vertices, metres.
    collar : float
        Width of strips round the patch that lead away from it, metres: where the rim misses the lip by less, one of
        them cuts into the wall beside it. What sticks out is for the caller to cut off.
    leans : tuple of float
        How far each strip leans below the plane of the mouth, degrees.

    Returns
    -------
    vertices : (n, 3) float64
        Metres, the rim first.
    faces : (m, 3) int32
        Counter-clockwise seen from outside.

    Raises
    ------
    MeshError
        The rim crosses itself seen from outside.
    """
    closing = choose(opening) if closing is Closing.AUTO else closing
    if opening.crosses_itself:
        raise MeshError(
            f"{arg(opening.sentence)} has a rim that crosses itself and cannot be closed automatically:"
            " close it in the CAD program, or leave it open (closing 'open')."
        )
    rim = opening.to_plane(opening.rim)
    height = _HEIGHTS[closing](rim)
    flat = np.vstack((rim[:, :2], _inner_points(rim, spacing)))
    z = np.concatenate((rim[:, 2], height(flat[len(rim) :])))
    faces = scipy.spatial.Delaunay(flat).simplices.astype(np.int32)
    faces = faces[_inside(rim, flat[faces].mean(axis=1))]
    corners = flat[faces]
    (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    turn = ux * vy - uy * vx
    faces = faces[np.abs(turn) > _FLAT * opening.length**2 * 1e-3]
    turn = turn[np.abs(turn) > _FLAT * opening.length**2 * 1e-3]
    faces[turn < 0] = faces[turn < 0][:, ::-1]
    points = np.column_stack((flat, z))
    if collar > 0:
        # A little below a flat lip, not in its plane: what lies in one plane but for rounding crosses without end.
        sunk = np.array([0.0, 0.0, _SUNK * spacing])
        points, faces = _with_collar(rim - sunk, points - sunk, faces, collar, leans)
    return opening.from_plane(points), faces


def _with_collar(rim: Floats, points: Floats, faces: Ints, width: float, leans: tuple[float, ...]) -> Surface:
    """Add the strips, in the frame of the opening; the rim is the first of the points, anticlockwise."""
    along = np.roll(rim[:, :2], -1, axis=0) - np.roll(rim[:, :2], 1, axis=0)
    out = np.column_stack((along[:, 1], -along[:, 0]))
    out /= np.maximum(np.linalg.norm(out, axis=1, keepdims=True), np.finfo(float).tiny)
    here = np.arange(len(rim))
    after = np.roll(here, -1)
    rings, strips, first = [points], [faces], len(points)
    for lean in np.radians(leans):
        rings.append(rim + width * np.column_stack((np.cos(lean) * out, np.full(len(rim), -np.sin(lean)))))
        strips.append(np.column_stack((after, here, first + here)))
        strips.append(np.column_stack((after, first + here, first + after)))
        first += len(rim)
    return np.vstack(rings), np.concatenate(strips).astype(np.int32)


def _fair(rim: Floats) -> Callable[[Floats], Floats]:
    scale = np.ptp(rim[:, 0])
    spline = scipy.interpolate.RBFInterpolator(
        rim[:, :2] / scale, rim[:, 2] / scale, kernel="thin_plate_spline", smoothing=1e-9
    )
    return lambda flat: np.asarray(scale * spline(flat / scale), dtype=np.float64)


def _ruled(rim: Floats) -> Callable[[Floats], Floats]:
    first, last = int(np.argmin(rim[:, 0])), int(np.argmax(rim[:, 0]))
    turned = np.roll(rim, -first, axis=0)
    split = (last - first) % len(rim)
    sides = (turned[: split + 1], np.vstack((turned[split:], turned[:1]))[::-1])

    def height(flat: Floats) -> Floats:
        (v0, h0), (v1, h1) = (_along(side, flat[:, 0]) for side in sides)
        share = np.clip((flat[:, 1] - v0) / np.where(np.abs(v1 - v0) > 1e-12, v1 - v0, 1.0), 0, 1)
        return h0 + share * (h1 - h0)

    return height


def _along(side: Floats, u: Floats) -> tuple[Floats, ...]:
    # Where the rim turns back, as at a rounded corner, the furthest u so far stands for it.
    place = np.maximum.accumulate(side[:, 0]) + 1e-12 * np.arange(len(side))
    return np.interp(u, place, side[:, 1]), np.interp(u, place, side[:, 2])


def _hull(rim: Floats) -> Callable[[Floats], Floats]:
    if np.ptp(rim[:, 2]) < _FLAT * np.ptp(rim[:, 0]):
        return lambda flat: np.full(len(flat), rim[:, 2].mean())
    try:
        equations = scipy.spatial.ConvexHull(rim).equations
    except scipy.spatial.QhullError:  # within rounding of a plane
        a, b, c = np.linalg.lstsq(np.column_stack((rim[:, :2], np.ones(len(rim)))), rim[:, 2])[0]
        return lambda flat: flat @ np.array([a, b]) + c
    top = equations[equations[:, 2] > 1e-9]
    # The top of a hull is the lowest of the planes of its upward facets.
    return lambda flat: np.min(-(flat @ top[:, :2].T + top[:, 3]) / top[:, 2], axis=1)


_HEIGHTS = {Closing.FAIR: _fair, Closing.RULED: _ruled, Closing.HULL: _hull}


def _inner_points(rim: Floats, spacing: float) -> Floats:
    """Points of a triangular lattice inside the rim, but not so near to it that slivers arise."""
    low, high = rim[:, :2].min(axis=0), rim[:, :2].max(axis=0)
    rows = np.arange(low[1] + spacing / 2, high[1], spacing * np.sqrt(3) / 2)
    columns = np.arange(low[0], high[0] + spacing, spacing)
    x, y = np.meshgrid(columns, rows)
    x[1::2] += spacing / 2
    points: Floats = np.column_stack((x.ravel(), y.ravel()))
    points = points[_inside(rim, points)]
    if len(points) == 0:
        return points
    # A point a few times denser than the lattice stands for the rim: every pair at once would take gigabytes.
    steps = np.linspace(0, 1, 8, endpoint=False)[:, None, None]
    along = (1 - steps) * rim[:, :2] + steps * np.roll(rim[:, :2], -1, axis=0)
    distance, _ = scipy.spatial.cKDTree(along.reshape(-1, 2)).query(points)
    apart: Floats = points[distance > spacing / 3]
    return apart


def _inside(polygon: Floats, points: Floats) -> Mask:
    """Tell which points lie in a polygon: a ray to the right crosses it an odd number of times."""
    a, b = polygon[:, :2], np.roll(polygon[:, :2], -1, axis=0)
    inside = np.zeros(len(points), dtype=bool)
    x, y = points[:, 0], points[:, 1]
    for (ax, ay), (bx, by) in zip(a, b, strict=True):
        spans = (ay > y) != (by > y)
        inside ^= spans & (x < (bx - ax) * (y - ay) / (by - ay if by != ay else 1.0) + ax)
    return inside
