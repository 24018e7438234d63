"""A ball to work on, and engines that do not outlive the tests."""

from collections.abc import Iterator

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import engines
from contactbench.pipeline.mesh.engines.child import _CHILDREN


@pytest.fixture(scope="session")
def ball() -> tuple[np.ndarray, np.ndarray]:
    """A closed mesh of 1,280 facets, radius 50."""
    mesh = trimesh.creation.icosphere(3, radius=50.0)
    return np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)


@pytest.fixture(scope="package", autouse=True)
def _stop() -> Iterator[None]:
    yield
    engines.stop_engines()
    assert not any(child.pid for child in _CHILDREN.values())
