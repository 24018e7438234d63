"""
Surfaces across an opening: invented, because the file says nothing about what closes it.

A patch is a height over the plane of the rim, so it never folds.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.spatial import ConvexHull, Delaunay, QhullError, cKDTree

from contactbench.pipeline.errors import arg
from contactbench.pipeline.mesh.errors import MeshError
from contactbench.pipeline.mesh.shell.rim import crossings, shoelace

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.mesh.shell.rim import Opening

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
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
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
    rim = opening.to_plane(opening.rim)
    _refuse_crossing(rim, opening)
    height = _HEIGHTS[closing](rim)
    flat = np.vstack((rim[:, :2], _inner_points(rim, spacing)))
    z = np.concatenate((rim[:, 2], height(flat[len(rim) :])))
    faces = Delaunay(flat).simplices.astype(np.int32)
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


def _with_collar(
    rim: NDArray[np.float64],
    points: NDArray[np.float64],
    faces: NDArray[np.int32],
    width: float,
    leans: tuple[float, ...],
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
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


def _fair(rim: NDArray[np.float64]) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    scale = np.ptp(rim[:, 0])
    spline = RBFInterpolator(
        rim[:, :2] / scale, rim[:, 2] / scale, kernel="thin_plate_spline", smoothing=1e-9
    )
    return lambda flat: np.asarray(scale * spline(flat / scale), dtype=np.float64)


def _ruled(rim: NDArray[np.float64]) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    first, last = int(np.argmin(rim[:, 0])), int(np.argmax(rim[:, 0]))
    turned = np.roll(rim, -first, axis=0)
    split = (last - first) % len(rim)
    sides = (turned[: split + 1], np.vstack((turned[split:], turned[:1]))[::-1])

    def height(flat: NDArray[np.float64]) -> NDArray[np.float64]:
        (v0, h0), (v1, h1) = (_along(side, flat[:, 0]) for side in sides)
        share = np.clip((flat[:, 1] - v0) / np.where(np.abs(v1 - v0) > 1e-12, v1 - v0, 1.0), 0, 1)
        return h0 + share * (h1 - h0)

    return height


def _along(side: NDArray[np.float64], u: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    # Where the rim turns back, as at a rounded corner, the furthest u so far stands for it.
    place = np.maximum.accumulate(side[:, 0]) + 1e-12 * np.arange(len(side))
    return np.interp(u, place, side[:, 1]), np.interp(u, place, side[:, 2])


def _hull(rim: NDArray[np.float64]) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    if np.ptp(rim[:, 2]) < _FLAT * np.ptp(rim[:, 0]):
        return lambda flat: np.full(len(flat), rim[:, 2].mean())
    try:
        equations = ConvexHull(rim).equations
    except QhullError:  # within rounding of a plane
        a, b, c = np.linalg.lstsq(np.column_stack((rim[:, :2], np.ones(len(rim)))), rim[:, 2])[0]
        return lambda flat: flat @ np.array([a, b]) + c
    top = equations[equations[:, 2] > 1e-9]
    # The top of a hull is the lowest of the planes of its upward facets.
    return lambda flat: np.min(-(flat @ top[:, :2].T + top[:, 3]) / top[:, 2], axis=1)


_HEIGHTS = {Closing.FAIR: _fair, Closing.RULED: _ruled, Closing.HULL: _hull}


def _inner_points(rim: NDArray[np.float64], spacing: float) -> NDArray[np.float64]:
    """Points of a triangular lattice inside the rim, but not so near to it that slivers arise."""
    low, high = rim[:, :2].min(axis=0), rim[:, :2].max(axis=0)
    rows = np.arange(low[1] + spacing / 2, high[1], spacing * np.sqrt(3) / 2)
    columns = np.arange(low[0], high[0] + spacing, spacing)
    x, y = np.meshgrid(columns, rows)
    x[1::2] += spacing / 2
    points: NDArray[np.float64] = np.column_stack((x.ravel(), y.ravel()))
    points = points[_inside(rim, points)]
    if len(points) == 0:
        return points
    # A point a few times denser than the lattice stands for the rim: every pair at once would take gigabytes.
    steps = np.linspace(0, 1, 8, endpoint=False)[:, None, None]
    along = (1 - steps) * rim[:, :2] + steps * np.roll(rim[:, :2], -1, axis=0)
    distance, _ = cKDTree(along.reshape(-1, 2)).query(points)
    apart: NDArray[np.float64] = points[distance > spacing / 3]
    return apart


def _inside(polygon: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Tell which points lie in a polygon: a ray to the right crosses it an odd number of times."""
    a, b = polygon[:, :2], np.roll(polygon[:, :2], -1, axis=0)
    inside = np.zeros(len(points), dtype=bool)
    x, y = points[:, 0], points[:, 1]
    for (ax, ay), (bx, by) in zip(a, b, strict=True):
        spans = (ay > y) != (by > y)
        inside ^= spans & (x < (bx - ax) * (y - ay) / (by - ay if by != ay else 1.0) + ax)
    return inside


def _refuse_crossing(rim: NDArray[np.float64], opening: Opening) -> None:
    if len(crossings(rim)) or shoelace(rim) <= 0:
        raise MeshError(
            f"{arg(opening.sentence)} has a rim that crosses itself and cannot be closed automatically:"
            " close it in the CAD program, or leave it open (closing 'open')."
        )
