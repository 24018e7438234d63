"""Touches of a surface that is known exactly, and the wrenches a perfect or a real sensor reads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.contact import WrenchNoise

Float = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Touches:
    """Truth and noise-free wrenches, one row a touch.

    Attributes
    ----------
    points : (n, 3) S, m, on the true surface
    normals : (n, 3) S, outward, of the true surface
    torques : (n,) local torque k about the normal, N·m
    angles : (n,) between -F and the normal, rad
    wrenches : (n, 6) Fx Fy Fz Mx My Mz in S, N and N·m, what the tissue does to the probe
    """

    points: Float
    normals: Float
    torques: Float
    angles: Float
    wrenches: Float

    def __len__(self) -> int:
        return len(self.points)


class Sampled(Protocol):
    """Anything that gives random points of itself, evenly by area, with the normals there."""

    def sample(self, count: int, rng: np.random.Generator) -> Sequence[Float]:
        """Give points (count, 3), m, outward normals (count, 3), and perhaps more."""
        ...


def draw_touches(
    surface: Sampled,
    count: int,
    rng: np.random.Generator,
    *,
    force: tuple[float, float] = (8.0, 10.0),
    angle: tuple[float, float] = (0.0, 30.0),
    torsion_arm: float = 0.0003,
    above: float = 0.0,
    facing: float = -1.0,
) -> Touches:
    """Draw touches spread evenly over a surface.

    Parameters
    ----------
    surface : Sampled
        The true surface, S, metres.
    count : int
        How many.
    rng : numpy.random.Generator
        Source of chance.
    force : (low, high)
        |F|, N, uniform. Default as in the paper's static experiments.
    angle : (low, high)
        Friction angle, degrees, uniform, in a uniformly random direction.
    torsion_arm : float
        Standard deviation of k / |F|, m. Default 0.3 mm: torsional friction 0.3 of a 1.5 mm contact patch.
    above : float
        Only points with z above this, m: keep clear of the flange.
    facing : float
        Only points whose normal has at least this z component: 0.7 keeps the acoustic face.
    """
    points = np.empty((0, 3))
    normals = np.empty((0, 3))
    while len(points) < count:
        p, n, *_ = surface.sample(2 * count, rng)
        keep = (p[:, 2] > above) & (n[:, 2] >= facing)
        points, normals = np.vstack([points, p[keep]]), np.vstack([normals, n[keep]])
    points, normals = points[:count], normals[:count]
    tangent = _tangents(normals, rng)
    theta = np.radians(rng.uniform(*angle, count))[:, None]
    size = rng.uniform(*force, count)[:, None]
    forces = size * (np.sin(theta) * tangent - np.cos(theta) * normals)
    torques = torsion_arm * rng.standard_normal(count) * size[:, 0]
    moments = np.cross(points, forces) + torques[:, None] * normals
    return Touches(points, normals, torques, theta[:, 0], np.hstack([forces, moments]))


def add_noise(wrenches: Float, noise: WrenchNoise, rng: np.random.Generator) -> Float:
    """Return (n, 6) wrenches with Gaussian noise of the given covariance added."""
    # An eigenvalue may be zero, where a Cholesky factor would fail.
    values, vectors = np.linalg.eigh(noise.covariance)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    return np.asarray(wrenches + rng.standard_normal(wrenches.shape) @ root.T)


def _tangents(normals: Float, rng: np.random.Generator) -> Float:
    random = rng.standard_normal(normals.shape)
    flat = random - np.sum(random * normals, axis=1, keepdims=True) * normals
    return np.asarray(flat / np.linalg.norm(flat, axis=1, keepdims=True))
