"""Recordings as CSV and NPZ."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recording.recording_cases import ABOUT, record, wrench_samples
from scipy.spatial.transform import Rotation
from weighing_files import columns

from contactbench.pipeline.contact.wrench_csv import WrenchReader
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.recording import (
    DeviceInfo,
    RecordingError,
    RecordingInfo,
    RecordingWriter,
    read_recording,
)
from contactbench.pipeline.recording.convert import LONGEST_GAP, poses_at, write_csv, write_npz


def test_wrenches_are_read_by_the_rest_of_the_program_bit_for_bit(tmp_path: Path) -> None:
    found = read_recording(record(tmp_path / "r.mcap", 300, 0))
    assert write_csv(tmp_path / "r.csv", tmp_path / "r.mcap").left_out == ()
    with (tmp_path / "r.csv").open("rb") as stream:
        blocks = list(WrenchReader(stream, "r.csv", timed=True))
    track = found.wrenches["/wrench"]
    np.testing.assert_array_equal(np.vstack([rows.wrenches for rows in blocks]), track.wrenches)
    np.testing.assert_array_equal(np.concatenate([rows.t for rows in blocks]), track.times)
    cells = columns(tmp_path / "r.csv")
    assert list(cells) == ["t", "fx", "fy", "fz", "mx", "my", "mz", "status", "sequence", "temperature"]
    assert cells["sequence"][:3] == ["0", "1", "2"]


def test_poses_stand_beside_the_wrenches(tmp_path: Path) -> None:
    about = replace(ABOUT, devices=())
    axis, speed = np.array([0.6, 0.0, 0.8]), 0.7
    with RecordingWriter(tmp_path / "r.mcap", about) as writer:
        for number in range(101):
            moment = number / 100
            R = Rotation.from_rotvec(axis * speed * moment).as_matrix()
            if not 40 < number < 70:
                writer.flange(FlangeSample(1000 + moment, R, np.array([moment, 0.0, 1.0])))
        for sample in wrench_samples(240):
            writer.wrench(sample)
    (said,) = write_csv(tmp_path / "r.csv", tmp_path / "r.mcap").left_out
    cells = columns(tmp_path / "r.csv")
    t = np.array(cells["t"], float) - 1000
    assert said == f"{240 - len(t)} readings left out: no pose within {LONGEST_GAP} s."
    assert ((t <= 0.4) | (t >= 0.7)).all()
    assert t.max() == 1.0
    assert len(t) == 81 + 61
    quaternions = np.array([cells[name] for name in ("qx", "qy", "qz", "qw")], float).T
    np.testing.assert_allclose(
        Rotation.from_quat(quaternions).as_rotvec(), axis * speed * t[:, None], atol=1e-9
    )
    np.testing.assert_allclose(np.array(cells["px"], float), t, atol=1e-9)


def test_readings_that_are_no_measurements_are_left_out(tmp_path: Path) -> None:
    good = wrench_samples(6)
    states = [Status.OK, Status.LATE, Status.OVERRANGE, Status.INVALID, Status.RAW, Status.ERROR]
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        for sample, status in zip(good, states, strict=True):
            writer.wrench(replace(sample, status=status))
        writer.wrench(WrenchSample(1001.0, (np.nan, 0.0, 0.0), (0.0, 0.0, 0.0)))
    (said,) = write_csv(tmp_path / "r.csv", tmp_path / "r.mcap").left_out
    assert said.startswith("5 readings left out")
    cells = columns(tmp_path / "r.csv")
    assert cells["status"] == ["0", "8"]
    assert "sequence" not in cells


def test_the_poses_alone(tmp_path: Path) -> None:
    found = read_recording(record(tmp_path / "r.mcap", 1, 20))
    write_csv(tmp_path / "r.csv", tmp_path / "r.mcap", "/flange")
    cells = columns(tmp_path / "r.csv")
    names = ["t", "qw", "qx", "qy", "qz", "px", "py", "pz", "j1", "j2", "j3", "j4", "j5", "j6"]
    assert list(cells) == names
    track = found.flanges["/flange"]
    np.testing.assert_array_equal(np.array(cells["px"], float), track.p_BE_B[:, 0])
    np.testing.assert_allclose(np.radians(np.array(cells["j6"], float)), track.joints[:, 5], rtol=1e-12)


def test_npz_has_everything_and_needs_no_pickle(tmp_path: Path) -> None:
    found = read_recording(record(tmp_path / "r.mcap"))
    write_npz(tmp_path / "r.npz", tmp_path / "r.mcap")
    with np.load(tmp_path / "r.npz", allow_pickle=False) as stored:
        for number, track in enumerate((*found.wrenches.values(), *found.flanges.values())):
            for name, values in vars(track).items():
                np.testing.assert_array_equal(stored[f"{number}/{name}"], values, strict=True)
        told = {name: json.loads(stored[name].tobytes()) for name in ("topics", "about", "events")}
    assert told["topics"] == [*found.wrenches, *found.flanges]
    assert told["about"]["devices"][0]["serial"] == "SN 1"
    assert told["events"][0] == {"time": 1000.0, "name": "start", "fields": {"who": "A. B.", "n": 1}}
    write_npz(tmp_path / "one.npz", tmp_path / "r.mcap", "/flange")
    with np.load(tmp_path / "one.npz", allow_pickle=False) as stored:
        assert json.loads(stored["topics"].tobytes()) == ["/flange"]


def test_topics_that_are_not_clear(tmp_path: Path) -> None:
    about = RecordingInfo(0, 0.0, (DeviceInfo("wrench", "/a", "x"), DeviceInfo("wrench", "/b", "y")))
    with RecordingWriter(tmp_path / "r.mcap", about) as writer:
        writer.wrench(WrenchSample(1.0, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0)), "/a")
        writer.wrench(WrenchSample(1.0, (9.0, 2.0, 3.0), (0.0, 0.0, 0.0)), "/b")
    file = tmp_path / "r.mcap"
    with pytest.raises(RecordingError, match=r"several topics of that kind: /a, /b\. Choose one: --topic"):
        write_csv(tmp_path / "r.csv", file)
    with pytest.raises(RecordingError, match="no samples on /c; it has: /a, /b"):
        write_csv(tmp_path / "r.csv", file, "/c")
    write_csv(tmp_path / "r.csv", file, "/b")
    assert columns(tmp_path / "r.csv")["fx"] == ["9.0"]


def test_nothing_to_write_leaves_what_is_there(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        writer.wrench(replace(wrench_samples(1)[0], status=Status.INVALID))
    file = tmp_path / "r.mcap"
    (tmp_path / "r.csv").write_text("mine", encoding="utf-8")
    with pytest.raises(RecordingError, match="no reading of /wrench is usable"):
        write_csv(tmp_path / "r.csv", file)
    assert (tmp_path / "r.csv").read_text(encoding="utf-8") == "mine"
    with pytest.raises(RecordingError, match="cannot be written"):
        write_npz(tmp_path / "missing" / "r.npz", file)
    with RecordingWriter(tmp_path / "e.mcap", ABOUT):
        pass
    with pytest.raises(RecordingError, match="contains no samples"):
        write_csv(tmp_path / "r.csv", tmp_path / "e.mcap")


def test_a_single_pose_or_a_repeated_moment_makes_no_pose_up(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        for _ in range(3):
            writer.flange(FlangeSample(1000.0, np.eye(3), np.zeros(3)))
    track = read_recording(tmp_path / "r.mcap").flanges["/flange"]
    poses, there = poses_at(track, np.array([1000.0, 1001.0]))
    assert there.tolist() == [True, False]
    assert np.isnan(poses[1]).all()


def test_counts_keep_all_their_digits(tmp_path: Path) -> None:
    counts = [2**63 - 1, 2**53 + 1, 0]
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        for sample, count in zip(wrench_samples(3), counts, strict=True):
            writer.wrench(replace(sample, sequence=count))
    write_csv(tmp_path / "r.csv", tmp_path / "r.mcap")
    assert [int(cell) for cell in columns(tmp_path / "r.csv")["sequence"]] == counts


def test_unknown_positions_are_empty_cells(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        for number in range(2):
            writer.flange(FlangeSample(1000.0 + number, np.eye(3), np.array([np.nan, 0.5, np.nan])))
    write_csv(tmp_path / "r.csv", tmp_path / "r.mcap")
    cells = columns(tmp_path / "r.csv")
    assert (cells["px"], cells["py"], cells["qw"]) == (["", ""], ["0.5", "0.5"], ["1.0", "1.0"])
