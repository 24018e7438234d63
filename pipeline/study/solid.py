"""A body whose facets are known to long double, and presses of it: the truth that stability is judged by."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.mesh import Probe

Float = NDArray[np.float64]
Long = NDArray[np.longdouble]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class SolidBody:
    """A closed triangle mesh in S, m."""

    vertices: Float  # (n, 3) m
    faces: Ints  # (m, 3) counter-clockwise seen from outside

    @cached_property
    def corners(self) -> Long:
        """(m, 3, 3) the corners of each facet, m."""
        return np.asarray(self.vertices.astype(np.longdouble)[self.faces])

    @cached_property
    def areas(self) -> Long:
        """(m, 3) normals, each as long as twice its facet's area, m²."""
        return cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])

    @cached_property
    def normals(self) -> Long:
        """(m, 3) outward unit normals."""
        return np.asarray(self.areas / np.sqrt(dot(self.areas, self.areas))[:, None])

    def probe(self, faces: ArrayLike | None = None) -> Probe:
        """Return the mesh as a probe of any size, or these `faces` over the same vertices."""
        return Probe.from_arrays(self.vertices, self.faces if faces is None else faces, check_size=False)


@dataclass(frozen=True, eq=False)
class Drawn:
    """Wrenches and where they were made to touch."""

    wrenches: Float  # (n, 6) N and N·m, S
    points: Float  # (n, 3) m, S

    def __len__(self) -> int:
        return len(self.points)

    def take(self, rows: Bools | Ints | slice) -> Drawn:
        """Return some of the rows."""
        return Drawn(self.wrenches[rows], self.points[rows])


def press(
    points: ArrayLike,
    normals: ArrayLike,
    rng: np.random.Generator,
    *,
    angle: tuple[float, float] | Float = (0.0, 60.0),
    arm: ArrayLike = 0.0003,
    pitch: ArrayLike | None = None,
) -> Drawn:
    """Press on points (n, 3), m, with outward normals (n, 3), by 8 to 10 N.

    Parameters
    ----------
    angle : (low, high) or (n,)
        Friction angle, degrees, in a random direction.
    arm : float or (n,)
        Standard deviation of the local torque over the force, m.
    pitch : float or (n,), optional
        Torque about the axis over the force, M·F / |F|², m; its sign is random. Takes the place of `arm`.
    """
    p, n = np.asarray(points, np.longdouble), np.asarray(normals, np.longdouble)
    count = len(p)
    side = cross(n, rng.standard_normal((count, 3)).astype(np.longdouble))
    side /= np.sqrt(dot(side, side))[:, None]
    degrees = rng.uniform(angle[0], angle[1], count) if isinstance(angle, tuple) else np.resize(angle, count)
    theta = np.radians(degrees.astype(np.longdouble))[:, None]
    size = rng.uniform(8.0, 10.0, count)[:, None]
    force = (size * (np.sin(theta) * side - np.cos(theta) * n)).astype(np.float64).astype(np.longdouble)
    if pitch is None:
        k = np.asarray(arm) * rng.standard_normal(count) * size[:, 0]
    else:
        k = np.asarray(pitch) * rng.choice([-1.0, 1.0], count) * dot(force, force) / dot(n, force)
    moment = cross(p, force) + np.asarray(k, np.longdouble)[:, None] * n
    return Drawn(np.hstack([force, moment]).astype(np.float64), p.astype(np.float64))


def cross(a: Long, b: Long) -> Long:
    """Return cross products of rows."""
    return np.asarray(np.cross(a, b))


def dot(a: Long, b: Long) -> Long:
    """Return inner products of rows."""
    return np.asarray(np.einsum("...i,...i->...", a, b))
