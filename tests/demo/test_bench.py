from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from weighing_files import columns

from contactbench.pipeline import demo
from contactbench.pipeline.calibration.files.capture_file import capture_poses
from contactbench.pipeline.demo import bench
from contactbench.pipeline.recording import read_recording

TOUCHES, MARKERS = 40, 15
CHANNELS = ("fx", "fy", "fz", "mx", "my", "mz")
TRACES = (
    "gravity.mcap",
    "poses.csv",
    "touches.mcap",
    "recording.csv",
    "wrenches.csv",
    "touches.csv",
    "truth.csv",
)
# All but the report and what names its hash: they know when they were made.
CHECKED = (
    "markers.csv",
    "verification.json",
    "contacts.jsonl",
    "runtime/probe.ply",
    "runtime/planes.csv",
    "runtime/ros2.yaml",
    "runtime/ft_calib.yaml",
)


def numbers(table: dict[str, list[str]], names: tuple[str, ...]) -> np.ndarray:
    return np.array([table[name] for name in names], dtype=float)


def test_touches_are_as_asked_for(benched: demo.DemoReport) -> None:
    folder = benched.out / "convex"
    truth, touches, contacts = (columns(folder / f"{file}.csv") for file in ("truth", "touches", "contacts"))
    assert truth["t"] == touches["t"] == contacts["t"]
    assert truth["marker"] == [str(number) for number in range(1, MARKERS + 1) for _ in range(2)]
    assert truth["tilt"] == ["0.0", "30.0"] * MARKERS
    force, normal = numbers(truth, CHANNELS[:3]), numbers(truth, ("nx", "ny", "nz"))
    size = np.linalg.norm(force, axis=0)
    assert ((size > 7.99) & (size < 10.01)).all()
    angle = np.degrees(np.arccos(np.clip(-(force * normal).sum(axis=0) / size, -1, 1)))
    assert np.abs(angle - np.tile([0.0, 30.0], MARKERS)).max() < 2  # facets, and a tip that rolled a little
    recording = read_recording(folder / "touches.mcap")
    (wrenches,), (flange,) = recording.wrenches.values(), recording.flanges.values()
    rows = 2 * MARKERS * 100  # half a second each
    assert len(wrenches.times) == len(flange.times) == len(columns(folder / "recording.csv")["t"]) == rows


def test_filtering_leaves_a_fifth_of_the_noise(benched: demo.DemoReport) -> None:
    folder = benched.out / "convex"
    truth, touches, raw = (columns(folder / f"{file}.csv") for file in ("truth", "touches", "wrenches"))
    rows = [raw["t"].index(time) for time in truth["t"]]
    true = numbers(truth, CHANNELS)
    before, after = numbers(raw, CHANNELS)[:, rows] - true, numbers(touches, CHANNELS) - true
    assert before[:3].std() == pytest.approx(0.05, rel=0.3)
    assert after[:3].std() == pytest.approx(0.19 * 0.05, rel=0.4)


def test_the_calibration_comes_out_of_the_recording(benched: demo.DemoReport) -> None:
    (result,) = benched.probes
    found = capture_poses(benched.out / "convex" / "gravity.mcap")
    assert len(found.poses) == result.gravity.poses == 9
    assert [pose.name for pose in found.poses] == columns(benched.out / "convex" / "poses.csv")["name"]
    assert len(result.gravity.bumped) == 1
    assert result.gravity.named == result.gravity.bumped
    assert abs(result.gravity.mass - result.gravity.true_mass) < 4 * result.gravity.mass_sigma


def test_markers_are_located_within_the_noise(benched: demo.DemoReport) -> None:
    (result,) = benched.probes
    ours, drawn = bench.ours(result.touched), bench.ours(result.drawn)
    assert benched.verified
    assert ours.touches == 2 * MARKERS
    assert ours.mean_mm is not None
    assert drawn.mean_mm is not None
    assert 0.05 < ours.mean_mm < 0.3 < drawn.mean_mm
    contacts, truth = (columns(benched.out / "convex" / f"{file}.csv") for file in ("contacts", "truth"))
    error = 1e3 * np.linalg.norm(numbers(contacts, ("x", "y", "z")) - numbers(truth, ("x", "y", "z")), axis=0)
    assert ours.mean_mm == pytest.approx(error.mean())
    kinds = columns(benched.out / "errors.csv")
    assert {*zip(kinds["kind"], kinds["where"], strict=True)} == {
        *(("markers", where) for where in ("all", "0°", "30°")),
        *(("drawn", where) for where in ("all", "face", "head")),
    }
    assert "virtual bench, with each probe (convex)" in benched.sentences()[0]


@pytest.mark.usefixtures("undrawn")
def test_same_seed_same_bytes(benched: demo.DemoReport, tmp_path: Path) -> None:
    (tmp_path / "convex").mkdir()
    for file in ("truth.csv", "gravity.mcap"):
        (tmp_path / "convex" / file).write_text("old", encoding="utf-8")
    demo.run(tmp_path, ["convex"], TOUCHES, 3)
    for name in (*TRACES, *CHECKED, "contacts.csv", "calibration.json", "drawn/contacts.csv"):
        assert (tmp_path / "convex" / name).read_bytes() == (benched.out / "convex" / name).read_bytes(), name
    assert (tmp_path / "errors.csv").read_bytes() == (benched.out / "errors.csv").read_bytes()
    assert not list(tmp_path.rglob("*.tmp"))


@pytest.mark.usefixtures("undrawn", "no_bench")
def test_without_physics_it_is_said_and_done_by_formula(tmp_path: Path) -> None:
    (tmp_path / "convex").mkdir()
    for name in ("touches.mcap", "verification.json", "runtime/contactbench.json"):
        (tmp_path / "convex" / name).parent.mkdir(exist_ok=True)
        (tmp_path / "convex" / name).write_text("of another run", encoding="utf-8")
    found = demo.run(tmp_path, ["convex"], TOUCHES, 3)
    assert found.verified
    assert found.probes[0].touched == ()
    assert found.probes[0].checked is None
    assert "No marker was pressed, so there is no verification and no bundle" in found.notes[0]
    assert "pip install 'contactbench[sim]'" in found.notes[0]
    assert "virtual bench, with each probe" not in found.sentences()[0]
    for name in ("*.mcap", "verification.json", "contactbench.json"):
        assert not list(tmp_path.rglob(name))
    assert found.table().row_count > 0


def test_markers_that_are_far_off_fail(benched: demo.DemoReport) -> None:
    result = benched.probes[0]
    wrong = replace(bench.ours(result.drawn), mean_mm=1.0, bound_mm=0.4)
    failed = replace(benched, probes=(replace(result, touched=(wrong,)),))
    assert not failed.verified
    assert "FAILED: even the mean is more than 1.5 times the 0.40 mm" in " ".join(failed.sentences())
