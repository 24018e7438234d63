import json
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import terminal
from weighing_files import columns

from contactbench.pipeline import demo
from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.files.calibration_file import load_calibration
from contactbench.pipeline.calibration.files.pose_csv import read_poses
from contactbench.pipeline.contact import ContactSolver, WrenchNoise
from contactbench.pipeline.contact.methods import METHODS
from contactbench.pipeline.demo import bench, compare, gravity, housing, picture, tape
from contactbench.pipeline.demo.bench import LIMIT
from contactbench.pipeline.demo.tutorial import write_tutorial
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import load_probe
from contactbench.pipeline.mesh.engines import EngineError

TOUCHES = 40
CSV_FILES = ("recording.csv", "wrenches.csv", "truth.csv", "contacts.csv")


invoke = partial(terminal.invoke, "demo")


# ---- files ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", demo.PROBE_NAMES)
def test_files_of_a_probe_parse(done: demo.DemoReport, name: str) -> None:
    folder = done.out / name
    probe = load_probe(folder / "probe.ply", units="m")
    assert 1_900 <= len(probe.faces) <= 2_100
    assert 0 < np.count_nonzero(probe.region) < len(probe.faces)
    wrenches, truth, contacts = (columns(folder / "drawn" / file) for file in CSV_FILES[1:])
    assert list(wrenches) == ["t", "fx", "fy", "fz", "mx", "my", "mz"]
    assert list(truth) == ["t", "x", "y", "z", "nx", "ny", "nz", "k", "where"]
    assert wrenches["t"] == truth["t"] == contacts["t"]
    assert np.allclose(np.diff(np.array(wrenches["t"], dtype=float)), 1 / 200)
    assert [truth["where"].count(part) for part in ("face", "head")] == [28, 12]


def test_contacts_agree_with_the_reported_errors(done: demo.DemoReport) -> None:
    for result in done.probes:
        contacts = columns(done.out / result.probe / "drawn" / "contacts.csv")
        truth = columns(done.out / result.probe / "drawn" / "truth.csv")
        sure = np.isin(contacts["reason"], ["ok", "vertex", "by_region"])
        at = [np.array([table[axis] for axis in "xyz"])[:, sure].astype(float) for table in (contacts, truth)]
        error = 1e3 * np.linalg.norm(at[0] - at[1], axis=0)
        ours = bench.ours(result.drawn)
        assert (ours.mean_mm, ours.max_mm) == (pytest.approx(error.mean()), pytest.approx(error.max()))


def test_every_method_on_every_part(done: demo.DemoReport) -> None:
    table = columns(done.out / "errors.csv")
    skipped = {note.split()[0] for note in done.notes if "is left out" in note}
    present = [name for name in METHODS if name not in skipped]
    assert len(table["method"]) == len(demo.PROBE_NAMES) * len(present) * 3
    assert set(table["method"]) == set(present)
    assert set(table["kind"]) == {"drawn"}
    assert set(table["where"]) == {"all", "face", "head"}
    assert all(0 <= float(share) <= 1 for share in table["answered"] + table["ambiguous"])
    lines = (done.out / "errors.md").read_text(encoding="utf-8").splitlines()
    assert sum(line.startswith(demo.PROBE_NAMES, 2) for line in lines) == len(table["method"])


def test_errors_are_measured_over_settled_touches_only() -> None:
    class Answers:
        reasons = np.array([0, 1, 2, 5], dtype=np.uint8)  # ok, vertex, ambiguous, off_surface
        accepted = np.array([True, True, False, False])
        points = np.array([[0.001, 0, 0], [0, 0.003, 0], [1, 1, 1], [np.nan] * 3])

    answers: Any = Answers()
    covariances = np.broadcast_to(np.diag([2e-6, 3e-6, 0]), (4, 3, 3))
    row = compare._errors("x", "all", answers, covariances, np.zeros((4, 3)), np.arange(4), None)
    assert (row.mean_mm, row.max_mm) == (pytest.approx(2), pytest.approx(3))
    assert row.bound_mm == pytest.approx(np.sqrt(5))
    assert row.over_bound == pytest.approx(1)  # rms: the root of (1 + 9) / 2
    assert (row.answered, row.ambiguous) == (0.75, 0.25)
    nothing = compare._errors("x", "all", answers, covariances, np.zeros((4, 3)), np.array([2, 3]), None)
    assert (nothing.mean_mm, nothing.bound_mm, nothing.over_bound) == (None, None, None)


@pytest.mark.usefixtures("undrawn", "no_bench")
def test_a_probe_alone_is_the_same_and_another_seed_is_not(done: demo.DemoReport, tmp_path: Path) -> None:
    demo.run(tmp_path, ["convex"], TOUCHES, 3)
    for file in ("probe.ply", "poses.csv", "calibration.json", *(f"drawn/{each}" for each in CSV_FILES)):
        assert (tmp_path / "convex" / file).read_bytes() == (done.out / "convex" / file).read_bytes()
    again = (tmp_path / "errors.csv").read_text(encoding="utf-8").splitlines()
    assert set(again) < set((done.out / "errors.csv").read_text(encoding="utf-8").splitlines())
    demo.run(tmp_path, ["convex"], TOUCHES, 4)
    assert (tmp_path / "convex" / "drawn" / "wrenches.csv").read_bytes() != (
        done.out / "convex" / "drawn" / "wrenches.csv"
    ).read_bytes()


# ---- mesh ----------------------------------------------------------------------------------------


def test_the_mesh_is_prepared_from_a_hollow_housing(done: demo.DemoReport) -> None:
    pytest.importorskip("pymeshlab", reason="the outer shell is wrapped by pymeshlab (extra 'meshlab')")
    for result in done.probes:
        assert result.mesh is not None
        assert result.mesh.verified
        assert result.mesh.openings == 1
        assert result.mesh.deviation_mm < 0.2
        assert 0 < result.mesh.invented_share < 0.06
        given = load_probe(done.out / result.probe / "housing.stl", "mm")
        assert len(given.faces) == result.mesh.facets_before
        made = load_probe(done.out / result.probe / "probe.ply", "m")
        assert made.health.sentences == ()
        assert made.bounds[0, 2] < 0.01  # the invented facets lie at the flange, where nothing is touched
        assert made.vertices[made.faces[made.invented]][:, :, 2].max() < 0.02
        history = json.loads((done.out / result.probe / "probe.json").read_text(encoding="utf-8"))["history"]
        assert [step["step"] for step in history] == ["import", "shell", "align", "region", "simplify"]
        assert any(sentence.startswith(f"{result.probe}: a hollow housing") for sentence in done.sentences())


@pytest.mark.usefixtures("undrawn", "no_bench")
def test_without_pymeshlab_the_design_stands_in(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def missing(*_: Any, **__: Any) -> Any:
        raise EngineError("pymeshlab is not installed: pip install 'contactbench[meshlab]'.")

    monkeypatch.setattr(housing, "shell_step", missing)
    monkeypatch.setattr(bench, "prepare_probe", housing.prepare_probe)
    found = demo.run(tmp_path, ["linear"], TOUCHES, 0)
    assert found.verified
    assert found.probes[0].mesh is None
    assert any("pip install 'contactbench[meshlab]'" in note for note in found.notes)
    assert load_probe(tmp_path / "linear" / "probe.ply", "m").region.any()


def test_a_mesh_that_is_not_the_design_fails(done: demo.DemoReport) -> None:
    result = done.probes[0]
    assert result.mesh is not None
    for change in ({"deviation_mm": 0.3}, {"closed": False}, {"openings": 0}):
        mesh = replace(result.mesh, **change)
        assert not replace(result, mesh=mesh).verified
        assert mesh.sentence("linear").endswith("FAILED: it differs from the design.")


# ---- verdict -------------------------------------------------------------------------------------


def test_verified_means_within_the_noise(done: demo.DemoReport) -> None:
    assert done.verified
    for result in done.probes:
        drawn = bench.ours(result.drawn).mean_mm
        assert drawn is not None
        assert 0.3 < drawn < 2.0


@pytest.mark.usefixtures("undrawn", "no_bench")
def test_a_sensor_worse_than_assumed_fails(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(tape.DemoTool, "noise", lambda *_: WrenchNoise(0.01, 0.0003))
    result = invoke("--out", tmp_path, "--probe", "convex", "--touches", TOUCHES, "--json")
    assert result.exit_code == 1
    found = json.loads(result.stdout)
    assert found["verified"] is False
    ours = found["probes"][0]["drawn"][0]
    assert ours["mean_mm"] > LIMIT * ours["bound_mm"]
    assert "convex: mean error" in result.output
    assert "FAILED" in result.output


@pytest.mark.usefixtures("undrawn", "no_bench")
def test_a_calibration_that_is_off_fails(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    honest = gravity.calibrate

    def wrong(poses: Any) -> Any:
        return honest([replace(pose, torque=1.1 * pose.torque) for pose in poses])

    monkeypatch.setattr(gravity, "calibrate", wrong)
    found = demo.run(tmp_path, ["convex"], TOUCHES, 3)
    assert not found.verified
    assert "FAILED: the error exceeds its stated uncertainty" in " ".join(found.sentences())


def test_the_bumped_pose_is_named_and_the_mass_is_right(done: demo.DemoReport) -> None:
    for result in done.probes:
        weighed = result.gravity
        assert len(weighed.bumped) == 1
        assert weighed.named == weighed.bumped
        assert abs(weighed.mass - weighed.true_mass) < 4 * weighed.mass_sigma < 0.01
        assert weighed.contact_error_mm < 0.5
        loaded = load_calibration(done.out / result.probe / "calibration.json")
        assert loaded.mass == weighed.mass


@pytest.mark.usefixtures("undrawn", "no_bench")
def test_a_missing_method_is_left_out_with_a_sentence(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def absent(*_: object) -> Any:
        raise InputError("the wrench_axis method needs Embree: pip install 'contactbench[rivals]'")

    monkeypatch.setitem(METHODS, "wrench_axis", absent)
    found = demo.run(tmp_path, ["linear"], TOUCHES, 0)
    assert any("wrench_axis is left out: the wrench_axis method needs Embree" in note for note in found.notes)
    assert "wrench_axis" not in (tmp_path / "errors.csv").read_text(encoding="utf-8")


# ---- command -------------------------------------------------------------------------------------


@pytest.mark.usefixtures("undrawn", "no_bench")
def test_json_is_one_object(tmp_path: Path) -> None:
    result = invoke("--out", tmp_path, "--probe", "linear", "--touches", TOUCHES, "--json")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert found["verified"] is True
    assert found["picture"] == str(tmp_path / "contacts.png")
    assert [entry["probe"] for entry in found["probes"]] == ["linear"]
    assert "× bound" in result.output


@pytest.mark.usefixtures("undrawn", "no_bench")
def test_people_get_the_table_and_sentences(tmp_path: Path) -> None:
    result = invoke("--out", tmp_path, "--probe", "linear", "--touches", TOUCHES)
    assert result.exit_code == 0
    assert "contactbench" in result.stdout
    assert "linear: mean error" in result.output
    assert f"The files are in {tmp_path}." in " ".join(result.output.split())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--probe", "phased"), "there is no probe 'phased': choose one of linear, convex, t-shape"),
        (("--touches", 9), "give at least 10"),
        (("--seed", -1), "the seed must be at least 0, not -1"),
    ],
)
def test_wrong_arguments(tmp_path: Path, arguments: tuple[object, ...], message: str) -> None:
    result = invoke("--out", tmp_path / "out", *arguments)
    assert result.exit_code == 2
    assert message in " ".join(result.output.split())
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("below", ["", "deeper"])
def test_out_that_is_a_file(tmp_path: Path, below: str) -> None:
    (tmp_path / "taken").write_text("mine", encoding="utf-8")
    out = tmp_path / "taken" / below
    result = invoke("--out", out, "--json")
    assert result.exit_code == 2
    error = json.loads(result.stdout)["error"]
    assert error == f"{out}: {tmp_path / 'taken'} is a file: choose another name for the folder."
    assert (tmp_path / "taken").read_text(encoding="utf-8") == "mine"


@pytest.mark.usefixtures("undrawn", "no_bench")
def test_a_folder_in_the_place_of_a_file(tmp_path: Path) -> None:
    (tmp_path / "linear" / "drawn" / "truth.csv").mkdir(parents=True)
    with pytest.raises(InputError, match=r"truth\.csv: the file cannot be written"):
        demo.run(tmp_path, ["linear"], TOUCHES, 0)
    assert not list(tmp_path.rglob("*.tmp"))


# ---- picture -------------------------------------------------------------------------------------


@pytest.mark.usefixtures("no_bench")
def test_picture_is_drawn(tmp_path: Path) -> None:
    image_module = pytest.importorskip("PIL.Image", reason="reading the picture needs Pillow")
    found = demo.run(tmp_path, ["linear", "t-shape"], TOUCHES, 0)
    assert found.picture == tmp_path / "contacts.png"
    with image_module.open(found.picture) as image:
        pixels = np.asarray(image.convert("RGB"), dtype=float)
    assert pixels.shape == (800, 1200, 3)
    for half in (pixels[:, :600], pixels[:, 600:]):
        assert half.std() > 20
        assert np.median(half) == 255


def test_shown_contacts_are_settled_seen_and_apart(done: demo.DemoReport) -> None:
    folder = done.out / "t-shape"
    solver = ContactSolver(load_probe(folder / "probe.ply", units="m"))
    _, wrenches = compare.read_wrenches(folder / "drawn" / "wrenches.csv")
    batch = solver.locate_batch(wrenches)
    rows = picture._choose(picture.LocatedProbe("t-shape", batch, batch.points, 1.0))
    view = picture._close("t-shape")
    assert 5 < len(rows) <= 25
    assert batch.accepted[rows].all()
    assert (batch.normals[rows] @ view.toward > 0).all()
    at = 1e3 * view.project(batch.points[rows])
    gaps = np.linalg.norm(at[:, None] - at, axis=2) + 1e9 * np.eye(len(at))
    assert gaps.min() > 3.0


# ---- sample data that a tutorial is followed with ------------------------------------------------


def test_every_file_is_there_and_the_readme_names_it(tutorial):
    said = (tutorial.folder / "README.md").read_text("utf-8")
    assert sorted(file.name for file in tutorial.folder.iterdir()) == sorted([*tutorial.files, "README.md"])
    assert all(f"`{name}`" in said for name in tutorial.files)
    assert f"--place {tutorial.place} " in said


def test_calibrating_finds_the_truth_and_the_pose_that_was_bumped(tutorial):
    truth = json.loads((tutorial.folder / "truth.json").read_text("utf-8"))
    found = calibrate(read_poses(tutorial.folder / "poses.csv").poses)
    assert [rejection.name for rejection in found.rejected] == truth["bumped_poses"]
    assert abs(found.mass - truth["mass_kg"]) < 4 * found.model.mass_sigma
    assert np.linalg.norm(found.model.force_bias - truth["force_bias_N"]) < 0.1


def test_the_same_seed_gives_the_same_bytes(tutorial, tmp_path):
    again = write_tutorial(tmp_path / "again", seed=2)
    for name in tutorial.files:
        assert (again.folder / name).read_bytes() == (tutorial.folder / name).read_bytes(), name


def test_a_folder_that_is_not_empty_stays_as_it_is(tmp_path):
    (tmp_path / "mine.txt").write_text("keep")
    with pytest.raises(InputError, match="the folder is not empty: name a new one, or empty it"):
        write_tutorial(tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == ["mine.txt"]
    with pytest.raises(InputError, match="--seed -1: give a number of 0 or more"):
        write_tutorial(tmp_path / "new", seed=-1)
    assert not (tmp_path / "new").exists()
