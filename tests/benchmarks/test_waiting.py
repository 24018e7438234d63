"""The benchmark of waiting measures what it says, on little."""

import pytest
from benchmarks.waiting import run

from contactbench import assets
from contactbench.pipeline.mesh import Probe, save_probe


def test_waiting(tmp_path):
    pytest.importorskip("pymeshlab", reason="the rival is pymeshlab's alpha wrap (extra 'meshlab')")
    save_probe(Probe.from_arrays(*assets.make("linear", 2_500), name="linear"), tmp_path / "mesh.ply")
    told = []
    report = run(tmp_path / "mesh.ply", contacts=2_000, samples=500, progress=told.append)
    figures = {(figure.subject, figure.name): figure.measured for figure in report.figures}
    assert len(told) == 4
    assert figures["mesh.ply prepared", "again it is the same to the byte"] == 1.0
    assert all(value > 0 for value in figures.values())
    assert len(figures) == 11
