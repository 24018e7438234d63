"""How much of the sky each facet sees: what lies outside, in a cavity, or hidden altogether."""

from collections.abc import Callable

import numpy as np

from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh.arrays import Floats, Ints
from contactbench.pipeline.mesh.triangles import cross_products, directions

DIRECTIONS = 256

# Rays this close to a facet's plane say little and are easily stopped by rounding.
_GRAZING = 0.02
# Rays start this share of the size above their facet, so that it does not stop them itself.
LIFT = 1e-5


def exposure(
    vertices: Floats,
    faces: Ints,
    among: SurfaceIndex | None = None,
    *,
    count: int = DIRECTIONS,
    tick: Callable[[float], None] | None = None,
) -> Floats:
    """
    Share of the half-space in front of each facet from which light reaches it, weighted by the cosine.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit, any frame.
    faces : (m, 3) int32
        Counter-clockwise seen from the side that is asked about.
    among : SurfaceIndex, optional
        What throws shadows; the facets themselves when left out.
    count : int
        Directions over the whole sphere.
    tick : callable, optional
        Told the share that is done, 0 to 1; may raise to stop.

    Returns
    -------
    (m,) float64
        1 on a convex body, 1/2 along the inner edge of a right angle, 0 where no light comes.
    """
    index = SurfaceIndex(vertices, faces) if among is None else among
    cross = cross_products(vertices, faces)
    normals = cross / np.maximum(np.linalg.norm(cross, axis=1, keepdims=True), np.finfo(float).tiny)
    size = float(np.ptp(vertices[faces.ravel()], axis=0).max())
    return exposure_at(vertices[faces].mean(axis=1), normals, index, LIFT * size, count=count, tick=tick)


def exposure_at(
    points: Floats,
    normals: Floats,
    index: SurfaceIndex,
    lift: float,
    *,
    count: int = DIRECTIONS,
    tick: Callable[[float], None] | None = None,
) -> Floats:
    """
    Do the same for points (k, 3), with unit normals (k, 3) towards the side asked about; rays start `lift` above them.

    Returns
    -------
    (k,) float64
    """
    origins = points + lift * normals
    seen, whole = np.zeros(len(points)), np.zeros(len(points))
    for number, direction in enumerate(directions(count)):
        cosine = normals @ direction
        front = np.flatnonzero(cosine > _GRAZING)
        free = index.escapes(origins[front], np.tile(direction, (len(front), 1)))
        seen[front] += cosine[front] * free
        whole[front] += cosine[front]
        if tick is not None:
            tick((number + 1) / count)
    return seen / np.maximum(whole, np.finfo(float).tiny)
