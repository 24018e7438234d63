"""Two real probes from a public catalogue: hollow at the lens, triangulated by CAD, as they come."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from contactbench.pipeline.mesh import MeshWarning, load_probe, save_probe


def test_loads_with_one_warning(real_file):
    with pytest.warns(MeshWarning) as caught:
        probe = load_probe(real_file)
    assert len(caught) == 1
    assert 0.1 < probe.size < 0.15
    assert not probe.health.watertight
    np.testing.assert_allclose(np.linalg.norm(probe.normals, axis=1), 1)
    if real_file.name.startswith("linear"):
        assert probe.health.dropped_facets == 8
        assert not probe.health.winding_consistent
        assert "surface is open" in str(caught[0].message)
    else:
        assert probe.health.dropped_facets == 0
        assert probe.health.winding_consistent


def test_agrees_with_trimesh(real_file):
    with pytest.warns(MeshWarning):
        probe = load_probe(real_file)
    theirs = trimesh.load_mesh(real_file)
    assert len(probe.vertices) == len(theirs.vertices)
    assert probe.areas.sum() == pytest.approx(theirs.area * 1e-6, rel=1e-6)
    np.testing.assert_allclose(probe.bounds, theirs.bounds / 1000, rtol=1e-6)
    assert probe.health.winding_consistent == theirs.is_winding_consistent


def test_round_trip(real_file, tmp_path):
    with pytest.warns(MeshWarning):
        probe = load_probe(real_file)
    painted = probe.with_region(np.arange(len(probe.faces)) % 5)
    save_probe(painted, tmp_path / "probe.ply")
    with pytest.warns(MeshWarning):
        again = load_probe(tmp_path / "probe.ply", units="m")
    for field in ("vertices", "faces", "region"):
        assert getattr(again, field).tobytes() == getattr(painted, field).tobytes()
