"""Steps of painting outlive the window, byte for byte, and only with the regions that they led to."""

from __future__ import annotations

import numpy as np
import pytest

from contactbench.pipeline.mesh.regions import RegionError, RegionModel, RegionSet
from contactbench.pipeline.workbench.regions_session import (
    REGION_STEPS_FILE,
    read_region_steps,
    write_region_steps,
)

SHA = "a" * 64


@pytest.fixture
def painted():
    """Regions of 50 facets after six steps, the last two of which were taken back."""
    model = RegionModel(RegionSet.empty(50))
    for name in ("Lens", "Grip"):
        model.add(name)
    model.assign(np.arange(0, 20), 1)
    model.assign(np.arange(10, 30), 2)
    model.move(2, 1)  # renumbers all
    model.remove(1)
    model.undo()
    model.undo()
    return model


def labels(model):
    return model.labels.tolist(), model.regions


def every(model, step):
    """Go as far as it goes, and return what there is on the way."""
    found = []
    while step(model):
        found.append(labels(model))
    return found


def test_kept_and_read_they_undo_and_redo_the_same(painted, tmp_path):
    write_region_steps(tmp_path, painted.steps, SHA)
    again = RegionModel(painted.snapshot())
    again.put_steps(read_region_steps(tmp_path, SHA))
    assert (again.undo_key, again.redo_key) == (painted.undo_key, painted.redo_key)
    for step in (RegionModel.redo, RegionModel.undo, RegionModel.redo):
        expected = every(painted, step)
        assert expected
        assert every(again, step) == expected


def test_with_other_regions_there_are_none(painted, tmp_path):
    write_region_steps(tmp_path, painted.steps, SHA)
    assert read_region_steps(tmp_path, "b" * 64).done == ()
    assert read_region_steps(tmp_path / "elsewhere", SHA).done == ()


@pytest.mark.parametrize("keep", [0.0, 0.3, 0.9])
def test_a_damaged_file_holds_none(painted, tmp_path, keep):
    write_region_steps(tmp_path, painted.steps, SHA)
    file = tmp_path / REGION_STEPS_FILE
    content = file.read_bytes()
    file.write_bytes(content[: round(keep * len(content))])
    assert read_region_steps(tmp_path, SHA).done == ()


def test_steps_of_another_mesh_are_refused(painted):
    small = RegionModel(RegionSet(painted.regions, painted.labels[:25].copy()))
    with pytest.raises(RegionError, match="does not belong"):
        small.put_steps(painted.steps)
    assert not small.undo()


def test_too_many_lose_the_oldest(painted, tmp_path, monkeypatch):
    monkeypatch.setattr("contactbench.pipeline.workbench.regions_session._MOST", 2)
    write_region_steps(tmp_path, painted.steps, SHA)
    assert [each.key for each in read_region_steps(tmp_path, SHA).done] == [
        each.key for each in painted.steps.done[-2:]
    ]
