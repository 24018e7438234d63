"""
Mouths of cavities: where a probe's housing lets a line of action in.

A cavity is found by the light that reaches it: on the outside of a body nearly the whole half-space is free,
in a cavity little of it is, and hardly anything lies between. The border of a dark part is a mouth's rim.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.shell.exposure import exposure
from contactbench.pipeline.mesh.triangles import cross_products, parts, twins

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

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
