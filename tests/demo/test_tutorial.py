"""Sample data that a tutorial is followed with."""

from __future__ import annotations

import json

import numpy as np
import pytest

from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.files.pose_csv import read_poses
from contactbench.pipeline.demo.tutorial import write_tutorial
from contactbench.pipeline.errors import InputError


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    pytest.importorskip("mujoco", reason="the virtual bench needs MuJoCo (extra sim)")
    return write_tutorial(tmp_path_factory.mktemp("data") / "sample", seed=2)


def test_every_file_is_there_and_the_readme_names_it(data):
    said = (data.folder / "README.md").read_text("utf-8")
    assert sorted(file.name for file in data.folder.iterdir()) == sorted([*data.files, "README.md"])
    assert all(f"`{name}`" in said for name in data.files)
    assert f"--place {data.place} " in said


def test_calibrating_finds_the_truth_and_the_pose_that_was_bumped(data):
    truth = json.loads((data.folder / "truth.json").read_text("utf-8"))
    found = calibrate(read_poses(data.folder / "poses.csv").poses)
    assert [rejection.name for rejection in found.rejected] == truth["bumped_poses"]
    assert abs(found.mass - truth["mass_kg"]) < 4 * found.model.mass_sigma
    assert np.linalg.norm(found.model.force_bias - truth["force_bias_N"]) < 0.1


def test_the_same_seed_gives_the_same_bytes(data, tmp_path):
    again = write_tutorial(tmp_path / "again", seed=2)
    for name in data.files:
        assert (again.folder / name).read_bytes() == (data.folder / name).read_bytes(), name


def test_a_folder_that_is_not_empty_stays_as_it_is(tmp_path):
    (tmp_path / "mine.txt").write_text("keep")
    with pytest.raises(InputError, match="the folder is not empty: name a new one, or empty it"):
        write_tutorial(tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == ["mine.txt"]
    with pytest.raises(InputError, match="--seed -1: give a number of 0 or more"):
        write_tutorial(tmp_path / "new", seed=-1)
    assert not (tmp_path / "new").exists()
