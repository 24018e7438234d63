"""A session with a probe to paint on: a ball of radius 50 mm, its centre 80 mm above the sensor."""

import shutil
from pathlib import Path

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.recompute import compute, newest_inputs
from contactbench.pipeline.workbench.desk import Desk

CENTRE, RADIUS = np.array([0.0, 0.0, 0.08]), 0.05
PARAMETERS = {"units": "mm", "facets": 300, "mount": [0, 0, 80, 0, 0, 0]}


def ball_shell(fineness: int = 3) -> ProbeFile:
    """20 * 4^fineness facets, without any session."""
    mesh = trimesh.creation.icosphere(fineness, radius=RADIUS)
    probe = Probe.from_arrays(mesh.vertices + CENTRE, mesh.faces)
    return ProbeFile(probe, RegionSet.empty(len(probe.faces)), "S")


def make_session(folder: Path) -> Path:
    """Of 1,280 facets, before there are fewer."""
    mesh = folder / "ball.stl"
    trimesh.creation.icosphere(3, radius=1000 * RADIUS).export(mesh)
    with Session.create(folder / "session") as session:
        session.add_input(mesh, "mesh")
        compute(session, "probe", "probe.ply", newest_inputs(session.state, "probe"), PARAMETERS)
    return folder / "session"


@pytest.fixture
def folder(to_paint, tmp_path):
    """A copy of it to change."""
    return shutil.copytree(to_paint, tmp_path / "session")


@pytest.fixture
def desk(folder):
    made = Desk(Session.open(folder))
    yield made
    made.close()
