"""The outline of a plane patch of facets: its outer loop, the circle through it, and the area inside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.preparation.alignment.errors import AlignmentError
from contactbench.pipeline.preparation.alignment.rigid import across

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_STEPS = 20
_ROUND, _GAP = 0.02, float(np.radians(44.0))


@dataclass(frozen=True, eq=False)
class Rim:
    """The outer outline of a patch."""

    vertices: NDArray[np.int64]  # (k,) vertex indices around it
    # circle_centre, area_centre: (3,) centre of the fitted circle, and of the area inside the outline,
    # on the plane, m
    circle_centre: Floats
    area_centre: Floats
    # radius, radius_rms: of the circle, and how far the outline's vertices are from it, m
    radius: float
    radius_rms: float
    largest_gap: float  # largest angle between neighbouring vertices, seen from the circle's centre, rad

    @property
    def round(self) -> bool:
        """Whether the vertices lie on the circle within 2 % of its radius, and all around it.

        The corners of every rectangle lie on a circle too: they are 45 degrees apart or more.
        """
        return self.radius_rms <= _ROUND * self.radius and self.largest_gap < _GAP


def find_rim(vertices: Floats, faces: NDArray[np.int32], middle: Floats, normal: Floats) -> Rim:
    """
    Find the longest outline of a patch.

    Parameters
    ----------
    vertices : (n, 3)
        In metres.
    faces : (m, 3)
        The facets of the patch.
    middle, normal : (3,)
        A point and the unit normal of the patch's plane.

    Raises
    ------
    AlignmentError
        The patch has no outline.
    """
    loops = _loops(faces)
    if not loops:
        raise AlignmentError("The patch has no rim: it is a closed surface. Pick a facet of a plane face.")
    axes = across(normal[None])[0]
    flat = [(vertices[loop] - middle) @ axes.T for loop in loops]
    longest = max(range(len(flat)), key=lambda row: _length(flat[row]))
    points = flat[longest]
    centre, radius, rms = _circle(points)
    angles = np.sort(np.arctan2(points[:, 1] - centre[1], points[:, 0] - centre[0]))
    gap = float(np.diff(angles, append=angles[0] + 2 * np.pi).max())
    area_centre = middle + _area_centre(points) @ axes
    return Rim(loops[longest], middle + centre @ axes, area_centre, radius, rms, gap)


def _loops(faces: NDArray[np.int32]) -> list[NDArray[np.int64]]:
    """Chain the edges that belong to one facet only."""
    edges = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).astype(np.int64)
    keys = np.sort(edges, axis=1)
    _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
    ahead: dict[int, list[int]] = {}
    for a, b in edges[first[count == 1]].tolist():
        ahead.setdefault(a, []).append(b)
    loops = []
    while ahead:
        start = next(iter(ahead))
        loop = [start]
        while loop[-1] in ahead:
            after = ahead[loop[-1]]
            vertex = after.pop()
            if not after:
                del ahead[loop[-1]]
            if vertex == start:
                break
            loop.append(vertex)
        if len(loop) > 2:
            loops.append(np.array(loop, dtype=np.int64))
    return loops


def _length(points: Floats) -> float:
    return float(np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).sum())


def _circle(points: Floats) -> tuple[Floats, float, float]:
    """Fit a circle to a closed outline (k, 2): first in squares (Kasa), then in distances."""
    # A vertex stands for half of each edge beside it, or unevenly meshed rims would pull the centre.
    sides = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    weight = np.sqrt(0.5 * (sides + np.roll(sides, 1)))
    design = np.column_stack([2 * points, np.ones(len(points))])
    square = (points**2).sum(axis=1)
    x, y, c = np.linalg.lstsq(design * weight[:, None], square * weight, rcond=None)[0]
    centre, radius = np.array([x, y]), float(np.sqrt(max(c + x * x + y * y, 0.0)))
    for _ in range(_STEPS):
        out = points - centre
        distance = np.maximum(np.linalg.norm(out, axis=1), 1e-12)
        J = np.column_stack([out / distance[:, None], np.ones(len(points))])
        dx, dy, dr = np.linalg.lstsq(J * weight[:, None], (distance - radius) * weight, rcond=None)[0]
        centre, radius = centre + (dx, dy), radius + float(dr)
    left = np.linalg.norm(points - centre, axis=1) - radius
    return centre, radius, float(np.sqrt(np.average(left**2, weights=weight**2)))


def _area_centre(points: Floats) -> Floats:
    following = np.roll(points, -1, axis=0)
    twice = points[:, 0] * following[:, 1] - points[:, 1] * following[:, 0]
    area = float(twice.sum())
    if abs(area) < 1e-15:
        return np.asarray(points.mean(axis=0))
    centre: Floats = ((points + following) * twice[:, None]).sum(axis=0) / (3 * area)
    return centre
