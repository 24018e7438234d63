"""One contact that slides over a whole probe."""

import numpy as np

from contactbench.assets import Surface
from contactbench.pipeline.simulation import Touches


def draw_slide(
    surface: Surface,
    count: int,
    rng: np.random.Generator,
    *,
    force: tuple[float, float] = (2.0, 15.0),
    angle: float = 30.0,
    torsion_arm: float = 0.0003,
    legs: int | None = None,
    lifted: float = 0.02,
) -> Touches:
    """Draw one stream: a contact that slides over the whole probe, leg by leg, now and then lifted.

    Parameters
    ----------
    surface, count, rng, torsion_arm
        As in `draw_touches`.
    force : (low, high)
        |F|, N; drifts between the two.
    angle : float
        Largest friction angle, degrees; its size and direction drift.
    legs : int, optional
        Straight legs in the surface's parameters. Default one per 2000 samples: 10 s at 200 Hz, some 10 mm/s.
    lifted : float
        Share of the samples at which the probe is in the air (zero wrench), in runs of 20.
    """
    legs = legs or max(1, count // 2000)
    at = np.linspace(0.0, legs, count)
    _, _, phi, t = surface.sample(legs + 1, rng)
    phi = np.unwrap(phi)
    knots = np.arange(legs + 1)
    path = (np.interp(at, knots, phi), np.interp(at, knots, t))
    points, normals = surface.points(*path), surface.normals(*path)
    heading = _drift(rng, count, legs)[:, None]
    reference = np.where(np.abs(normals[:, :1]) < 0.8, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    first = np.cross(normals, reference)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    tangent = np.cos(7 * heading) * first + np.sin(7 * heading) * np.cross(normals, first)
    theta = np.radians(angle) * np.abs(_drift(rng, count, legs))[:, None]
    size = np.interp(np.abs(_drift(rng, count, legs)), [0, 1], force)[:, None]
    size[np.repeat(rng.random(count // 20 + 1) < lifted, 20)[:count]] = 0.0
    forces = size * (np.sin(theta) * tangent - np.cos(theta) * normals)
    torques = torsion_arm * _drift(rng, count, legs) * size[:, 0]
    moments = np.cross(points, forces) + torques[:, None] * normals
    return Touches(points, normals, torques, theta[:, 0], np.hstack([forces, moments]))


def _drift(rng: np.random.Generator, count: int, legs: int) -> np.ndarray:
    """Return (count,) values that wander smoothly within [-1, 1]."""
    knots = rng.uniform(-1.0, 1.0, legs + 2)
    return np.interp(np.linspace(0.0, legs + 1, count), np.arange(legs + 2), knots)
