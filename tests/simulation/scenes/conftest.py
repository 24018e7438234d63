"""The probe that all scenes are tried with."""

import pytest

from contactbench import assets
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation.scenes.physics import TrueSurface


@pytest.fixture(scope="package")
def truth() -> TrueSurface:
    """The T-shape, finely meshed."""
    vertices, faces = assets.make("t-shape", 20_000)
    return TrueSurface(Probe.from_arrays(vertices, faces, name="t-shape"))
