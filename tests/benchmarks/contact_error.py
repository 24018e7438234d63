"""Contacts end to end: touches of the original's surface, located on what was made of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe

from .stranger import sample

if TYPE_CHECKING:
    import numpy.typing as npt

    from .shapes import Shape
    from .solids import Mesh

    Floats = npt.NDArray[np.float64]
    Bools = npt.NDArray[np.bool_]

ASTRAY_MM = 10.0
_FORCE_N, _STEEPEST_DEG, _TORSION_M = (8.0, 10.0), 30.0, 0.0003
_LIFT = 1e-5  # off the surface, as a share of the size, so that a line does not meet where it begins
_HEIGHT_MM = 60.0  # of the body's lowest point over the sensor
_SKY = 64  # directions that a point of a file without a known outside is looked at from
_OPEN_SKY = 0.5  # the share of them that it must see


@dataclass(frozen=True, eq=False)
class Touches:
    """Points (n, 3) and outward normals (n, 3) in the file's frame, mm; forces (n, 3), N; torques (n,), N·m."""

    points: Floats
    normals: Floats
    forces: Floats
    torques: Floats


@dataclass(frozen=True)
class ContactError:
    """What answers are worth."""

    # Root mean square error of the sure answers that are not astray, over that of the noise bound
    over_bound: float
    p95: float  # Of the errors of all sure answers, mm
    sure: float  # Share of the touches that are answered without doubt
    astray: float  # Share of the touches whose answer is sure and more than 10 mm off


def draw_touches(shape: Shape, count: int, *, seed: int = 0) -> Touches:
    """Draw touches, evenly by area, that come along a line which meets nothing else outside the body."""
    rng = np.random.default_rng(seed)
    blocking = SurfaceIndex(*_arrays(shape.solid or shape.outside))
    lift = _LIFT * shape.outside.size
    kept: list[tuple[Floats, Floats, Floats]] = []
    for _ in range(50):
        points, facet = sample(shape.outside, 2 * count, rng)
        normals = shape.outside.crosses[facet]
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        if not shape.known:
            points, normals = _in_the_open(points, normals, blocking, lift, rng)
        across = rng.standard_normal(points.shape)
        across -= np.sum(across * normals, axis=1, keepdims=True) * normals
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        angle = np.radians(rng.uniform(0, _STEEPEST_DEG, len(points)))[:, None]
        way = np.cos(angle) * normals + np.sin(angle) * across
        free = blocking.escapes(points + lift * normals, way)
        kept.append((points[free], normals[free], -way[free]))
        if sum(len(each[0]) for each in kept) >= count:
            break
    points, normals, ways = (np.concatenate(parts)[:count] for parts in zip(*kept, strict=True))
    size = rng.uniform(*_FORCE_N, len(points))
    return Touches(
        points, normals, ways * size[:, None], _TORSION_M * rng.standard_normal(len(points)) * size
    )


def visible_points(shape: Shape, count: int, *, seed: int = 2) -> Floats:
    """Draw points (at most count, 3) of the surface that can be touched, mm."""
    rng = np.random.default_rng(seed)
    points, facet = sample(shape.outside, count, rng)
    if shape.known:
        return points
    normals = shape.outside.crosses[facet]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    blocking = SurfaceIndex(*_arrays(shape.outside))
    return _in_the_open(points, normals, blocking, _LIFT * shape.outside.size, rng)[0]


def _in_the_open(
    points: Floats, normals: Floats, blocking: SurfaceIndex, lift: float, rng: np.random.Generator
) -> tuple[Floats, Floats]:
    """Keep points that see much of the sky from one side, which is the outside."""
    seen = []
    for side in (1, -1):
        out = side * normals
        share = np.zeros(len(points))
        for _ in range(_SKY):
            way = rng.standard_normal(points.shape)
            way = out + way / np.linalg.norm(way, axis=1, keepdims=True)  # cosine-weighted
            share += blocking.escapes(points + lift * out, way / np.linalg.norm(way, axis=1, keepdims=True))
        seen.append(share / _SKY)
    best = np.argmax(seen, axis=0)
    keep = np.max(seen, axis=0) >= _OPEN_SKY
    return points[keep], (np.where(best == 0, 1.0, -1.0)[:, None] * normals)[keep]


def locate(mesh: Mesh, touches: Touches, reference: Mesh, *, seed: int | None = 1) -> ContactError:
    """Locate touches on a mesh; without a seed the sensor has no noise."""
    corners = reference.corners.reshape(-1, 3)
    low, high = corners.min(axis=0), corners.max(axis=0)
    shift = np.array([*(-0.5 * (low + high)[:2]), _HEIGHT_MM - low[2]])
    noise = WrenchNoise()
    probe = Probe.from_arrays(1e-3 * (mesh.vertices + shift), mesh.faces)
    truth = 1e-3 * (touches.points + shift)
    torque = np.cross(truth, touches.forces) + touches.torques[:, None] * touches.normals
    clean = np.hstack([touches.forces, torque])
    sigmas = np.sqrt(np.diag(noise.covariance))
    wrenches = clean
    if seed is not None:
        wrenches = clean + sigmas * np.random.default_rng(seed).standard_normal(clean.shape)
    batch = ContactSolver(probe, noise).locate_batch(wrenches)
    error = 1e3 * np.linalg.norm(batch.points - truth, axis=1)
    sure = np.array(batch.accepted) & np.isfinite(error)
    astray = sure & (np.nan_to_num(error) > ASTRAY_MM)
    near = sure & ~astray
    bound = 1e6 * _bound(truth, touches, sigmas)
    return ContactError(
        over_bound=float(np.sqrt(np.mean(error[near] ** 2) / np.mean(bound[near]))) if near.any() else np.nan,
        p95=float(np.percentile(error[sure], 95)) if sure.any() else np.nan,
        sure=float(sure.mean()),
        astray=float(astray.mean()),
    )


def _bound(points: Floats, touches: Touches, sigmas: Floats) -> Floats:
    """Return the variance (n,), m², of the best unbiased point on the plane of the touch (Cramér-Rao)."""
    n, along = touches.normals, np.einsum("nd,nd->n", touches.normals, touches.forces)[:, None]
    variance = np.zeros(len(points))
    for axis, e in enumerate(np.eye(3)):
        for sigma, moment in ((sigmas[axis], np.cross(points, e)), (sigmas[3 + axis], e)):
            # A torque off by `moment` moves the point within the plane by n x moment / (n . F).
            moved = np.cross(n, moment) / along
            variance += sigma**2 * np.einsum("nd,nd->n", moved, moved)
    return variance


def distances(points: Floats, mesh: Mesh) -> Floats:
    """Return how far points are from a mesh, (n,), mm."""
    distance, _, _ = SurfaceIndex(*_arrays(mesh)).closest(np.ascontiguousarray(points))
    return np.asarray(distance)


def _arrays(mesh: Mesh) -> tuple[Floats, npt.NDArray[np.int32]]:
    """Give the facets that have an area: what else a file holds cannot be touched."""
    faces = mesh.faces[mesh.areas > 0]
    return np.ascontiguousarray(mesh.vertices), np.ascontiguousarray(faces, np.int32)
