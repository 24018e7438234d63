"""Surfaces to paint on."""

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph


def as_probe(mesh: trimesh.Trimesh) -> Probe:
    return Probe.from_arrays(mesh.vertices, mesh.faces)


def centroids(probe: Probe) -> np.ndarray:
    return probe.vertices[probe.faces].mean(axis=1)


@pytest.fixture(scope="session")
def ball() -> FacetGraph:
    """A sphere of radius 50 mm and 5,120 facets of about 4 mm."""
    return FacetGraph(as_probe(trimesh.creation.icosphere(4, radius=0.05)))


@pytest.fixture(scope="session")
def plate() -> FacetGraph:
    """A plate of 60 x 40 x 1 mm and 12,288 facets: a thin wall."""
    mesh = trimesh.creation.box(extents=(0.06, 0.04, 0.001))
    for _ in range(5):
        mesh = mesh.subdivide()
    return FacetGraph(as_probe(mesh))


@pytest.fixture(scope="session")
def cube() -> FacetGraph:
    """A cube of 40 mm with 12 * 64 facets: six flat sides and sharp edges."""
    mesh = trimesh.creation.box(extents=(0.04, 0.04, 0.04))
    for _ in range(3):
        mesh = mesh.subdivide()
    return FacetGraph(as_probe(mesh))


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(7)
