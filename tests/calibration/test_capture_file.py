"""From a recording as it comes, with hum, rounding, spikes, gaps and knocks, to a calibration."""

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from calibration.streams import Recording, stream
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from pipeline import cli
from pipeline.calibration import Level, calibrate
from pipeline.calibration.files.capture_file import capture_file
from pipeline.calibration.stillness import find_captures
from pipeline.contact.wrench_csv import WrenchFileError
from pipeline.demo.files import write_csv

COLUMNS = ("t", "fx", "fy", "fz", "mx", "my", "mz", "qw", "qx", "qy", "qz")


@pytest.fixture(scope="module")
def recording() -> Recording:
    return stream(5, poses=8, hum=0.3, quantised=True, spikes=0.001, missing=0.05, bumps=0.2, vertical=0.0)


@pytest.fixture(scope="module")
def file(recording: Recording, tmp_path_factory: pytest.TempPathFactory) -> Path:
    quaternions = np.roll(Rotation.from_matrix(recording.R_WS).as_quat(), 1, axis=1)
    out = tmp_path_factory.mktemp("recording") / "recording.csv"
    write_csv(out, COLUMNS, np.column_stack([recording.t, recording.wrenches, quaternions]).tolist())
    return out


def invoke(*arguments: object) -> Any:
    return CliRunner().invoke(cli.app, list(map(str, arguments)))


def test_the_poses_lead_to_the_load(recording: Recording, file: Path) -> None:
    found = capture_file(file)
    assert len(found.poses) >= 7
    assert found.rows == len(recording.t)
    calibration = calibrate(found.poses)
    assert calibration.verdict.level == Level.GOOD
    off = calibration.model.vector - recording.model.vector
    off[3:6] -= recording.drift.mean(axis=0)[:3]  # what drifts is the bias
    off[9:] -= recording.drift.mean(axis=0)[3:]
    assert np.abs(off[:3]).max() < 0.03
    assert np.abs(off[6:9]).max() < 0.0005


def test_a_file_gives_what_the_arrays_give(recording: Recording, file: Path) -> None:
    from_file = capture_file(file).report
    from_arrays = find_captures(recording.t, recording.wrenches, R_WS=recording.R_WS)
    assert len(from_file.captures) == len(from_arrays.captures)
    for one, other in zip(from_file.captures, from_arrays.captures, strict=True):
        assert (one.start_index, one.stop_index) == (other.start_index, other.stop_index)
        np.testing.assert_allclose(one.mean, other.mean, rtol=0, atol=1e-12)


def test_the_command_writes_poses_that_calibrate_reads(file: Path, tmp_path: Path) -> None:
    poses, out = tmp_path / "poses.csv", tmp_path / "c.json"
    result = invoke("captures", file, "--out", poses, "--json")
    assert result.exit_code == 0
    assert len(json.loads(result.stdout)["poses"]) == len(capture_file(file).poses)
    assert invoke("calibrate", poses, "--out", out).exit_code == 0
    again = invoke("captures", file, "--out", tmp_path / "again.csv", "--calibration", out)
    assert again.exit_code == 0


def test_a_recording_that_never_stands_still(file: Path, tmp_path: Path) -> None:
    rows = file.read_text().splitlines()
    short = tmp_path / "short.csv"
    short.write_text("\n".join(rows[:120]) + "\n")
    result = invoke("captures", short, "--out", tmp_path / "p.csv")
    assert result.exit_code == 1
    assert not (tmp_path / "p.csv").exists()


def test_wrong_rows_are_named(file: Path) -> None:
    rows = file.read_text().splitlines()
    rows[7] = rows[7].rsplit(",", 1)[0] + ",7.0"
    with pytest.raises(WrenchFileError, match=r"line 8: the quaternion has length"):
        capture_file(io.BytesIO("\n".join(rows).encode() + b"\n"))
    rows[7] = rows[6]
    rows[8] = rows[8].replace(rows[8].split(",")[0], "-1", 1)
    with pytest.raises(ValueError, match=r"backwards|increase|before"):
        capture_file(io.BytesIO("\n".join(rows).encode() + b"\n"))
