"""Mounts that are known, and touches of probes that hang on them."""

from dataclasses import dataclass

import numpy as np
import pytest
from contact_cases import bundled
from scipy.spatial.transform import Rotation

from contactbench import assets
from contactbench.pipeline.contact import WrenchNoise
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.preparation.alignment.touches.fit import MarkerTouches
from contactbench.pipeline.simulation.touches import add_noise, draw_touches

NOISE = WrenchNoise(0.05, 0.002)


def rigid(rng, shift: float, degrees: float) -> np.ndarray:
    """A transform of that shift, m, and angle, in a random direction about a random axis."""
    p, axis = (v / np.linalg.norm(v) for v in rng.standard_normal((2, 3)))
    T = np.eye(4)
    T[:3, :3] = Rotation.from_rotvec(np.radians(degrees) * axis).as_matrix()
    T[:3, 3] = shift * p
    return T


def moved(T: np.ndarray, points: np.ndarray) -> np.ndarray:
    return points @ T[:3, :3].T + T[:3, 3]


@dataclass
class Bench:
    """A probe whose mount is known, and touches of it."""

    probe_P: Probe
    touches: MarkerTouches
    T_true: np.ndarray
    T_before: np.ndarray

    def error(self, T: np.ndarray) -> tuple[float, float]:
        """Largest distance between where T and the truth put a vertex, m, and the angle between them, degrees."""
        far = moved(T, self.probe_P.vertices) - moved(self.T_true, self.probe_P.vertices)
        R = T[:3, :3] @ self.T_true[:3, :3].T
        return float(np.linalg.norm(far, axis=1).max()), float(
            np.degrees(Rotation.from_matrix(R).magnitude())
        )


def make_bench(
    name: str,
    seed: int,
    *,
    count: int = 15,
    placement: float = 0.0003,
    noise: WrenchNoise | None = NOISE,
    off: tuple[float, float] = (0.002, 1.5),
    facets: int = 1000,
    **options,
) -> Bench:
    rng = np.random.default_rng(seed)
    surface, probe = assets.surface(name), bundled(name, facets)
    drawn = draw_touches(surface, count, rng, **{"above": 0.03, **options})
    wrenches = drawn.wrenches if noise is None else add_noise(drawn.wrenches, noise, rng)
    slip = placement * rng.standard_normal((count, 3))
    slip -= np.sum(slip * drawn.normals, axis=1, keepdims=True) * drawn.normals
    markers_S = surface.project(drawn.points + slip)[0] if placement else drawn.points
    T_true = rigid(rng, 0.05, 40.0)
    back = np.linalg.inv(T_true)
    return Bench(
        Probe.from_arrays(moved(back, probe.vertices), probe.faces, name=name),
        MarkerTouches(moved(back, markers_S), wrenches),
        T_true,
        rigid(rng, *off) @ T_true,
    )


@pytest.fixture(scope="session")
def bench():
    return make_bench


@pytest.fixture(scope="session")
def random_rigid():
    return rigid


@pytest.fixture(scope="session")
def move():
    return moved
