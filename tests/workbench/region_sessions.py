"""A session with a probe to paint on: a ball of radius 50 mm, its centre 80 mm above the sensor."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions import RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.recompute import compute, newest_inputs
from contactbench.pipeline.workbench.desk import Desk

if TYPE_CHECKING:
    from pathlib import Path

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


_made: list[Path] = []


@pytest.fixture(scope="session")
def made_session(tmp_path_factory):
    if not _made:  # one for all modules that import this fixture: each would make its own
        _made.append(make_session(tmp_path_factory.mktemp("regions")))
    return _made[0]


@pytest.fixture
def folder(made_session, tmp_path):
    """A copy of it to change."""
    return shutil.copytree(made_session, tmp_path / "session")


@pytest.fixture
def desk(folder):
    made = Desk(Session.open(folder))
    yield made
    made.close()
