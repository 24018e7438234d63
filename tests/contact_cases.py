"""Probes and wrenches that several tests draw on."""

from functools import cache
from pathlib import Path

import numpy as np

from contactbench import assets
from contactbench.pipeline.mesh import Probe

REAL_PROBES = Path(__file__).parents[1].parent / "shared" / "data" / "probes"


@cache
def bundled(name: str, facets: int, *, regions: bool = False) -> Probe:
    vertices, faces = assets.make(name, facets)
    region = assets.contact_region(name, vertices, faces) if regions else None
    return Probe.from_arrays(vertices, faces, region, name=name)


@cache
def ball(facets: int = 1280, radius: float = 0.03, height: float = 0.1) -> Probe:
    import trimesh

    mesh = trimesh.creation.icosphere({320: 2, 1280: 3, 5120: 4}[facets])
    return Probe.from_arrays(
        radius * np.asarray(mesh.vertices) + [0, 0, height], np.asarray(mesh.faces), name="ball"
    )


def random_wrenches(
    probe: Probe, count: int, rng: np.random.Generator, *, pitch: float, angle: float
) -> np.ndarray:
    """Touches of random facets: friction angles up to `angle` degrees, pitches up to `pitch` metres."""
    chosen = rng.integers(len(probe.faces), size=count)
    weights = rng.dirichlet([1, 1, 1], size=count)
    points = np.einsum("ij,ijk->ik", weights, probe.vertices[probe.faces[chosen]])
    normals = probe.normals[chosen]
    tangents = np.cross(normals, rng.standard_normal((count, 3)))
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    theta = np.radians(rng.uniform(0, angle, count))[:, None]
    forces = rng.uniform(1, 20, count)[:, None] * (np.sin(theta) * tangents - np.cos(theta) * normals)
    # k n contributes k (n . F) / |F|^2 to the pitch.
    k = rng.uniform(-pitch, pitch, count) * np.linalg.norm(forces, axis=1) / np.cos(theta[:, 0])
    return np.hstack([forces, np.cross(points, forces) + k[:, None] * normals])
