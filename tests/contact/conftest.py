"""Solvers and real probes for the contact tests."""

import warnings

import numpy as np
import pytest
from contact_cases import REAL_PROBES, bundled

from contactbench import assets
from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.mesh import MeshWarning, Probe, load_probe


@pytest.fixture(scope="session", params=assets.PROBE_NAMES)
def bundled_solver(request) -> ContactSolver:
    return ContactSolver(bundled(request.param, 1000))


@pytest.fixture(scope="session", params=["convex-c5-2.stl", "linear-l14-5.stl"])
def real_probe(request) -> Probe:
    path = REAL_PROBES / request.param
    if not path.exists():
        pytest.skip(f"the real probe mesh {path.name} lies outside this repository and is not here")
    mount = np.eye(4)
    # The files put the origin at the lens and the handle along -y: hang them on a sensor behind the handle.
    mount[:3, :3] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
    mount[:3, 3] = [0, 0, 0.16]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)
        return load_probe(path, units="mm", mount=mount)
