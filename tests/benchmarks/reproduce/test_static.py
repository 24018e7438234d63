"""The static experiments in small: nearest to what noise allows, the same twice, and honest about causes."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.reproduce import attribution, static
from benchmarks.reproduce.locating import OURS
from benchmarks.reproduce.static import StaticResult

from contactbench.pipeline.contact import Reason
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.virtual.markers import markers
from contactbench.pipeline.study.marker_touches import (
    ACROSS,
    ANGLES,
    IN_PLANE,
    PERPENDICULAR,
    held,
    press_markers,
)
from contactbench.pipeline.study.paper_setup import draw_bench, read_touches


@pytest.fixture(scope="module")
def result() -> StaticResult:
    return static.run(("t-shape",), seeds=1, touches=1, most_markers=3)


def test_errors_are_those_of_noise(result: StaticResult) -> None:
    errors = result.probes[0].errors
    for angle in ANGLES:
        assert errors[angle, OURS].answered == 1
        assert errors[angle, OURS].over_bound < 2
    assert errors[PERPENDICULAR, OURS].mean < 0.6
    # Less of the force points inwards: the bound itself grows, by about 1.15 on a flat face.
    assert 1.1 < errors[IN_PLANE, OURS].bound / errors[PERPENDICULAR, OURS].bound < 1.25
    assert 1.1 < errors[ACROSS, OURS].bound / errors[PERPENDICULAR, OURS].bound < 1.25


def test_touches_are_what_was_asked_for(result: StaticResult) -> None:
    touched = result.probes[0].touched
    size = np.linalg.norm(touched.contacts[:, :3], axis=1)
    assert ((size > 7.99) & (size < 10.01)).all()
    inward = -np.sum(touched.contacts[:, :3] * touched.normals, axis=1) / size
    expected = [tilt for tilt, _ in ANGLES.values()]
    np.testing.assert_allclose(np.degrees(np.arccos(np.minimum(inward, 1))), np.tile(expected, 3), atol=0.2)
    up_W = np.einsum("nij,nj->ni", touched.R_WS, touched.contacts[:, :3]) / size[:, None]
    np.testing.assert_allclose(up_W, np.tile([0, 0, 1], (len(touched), 1)), atol=1e-9)


def test_errors_shrink_with_force(result: StaticResult) -> None:
    upright = {one.force: one.errors for one in result.forces if one.angle == PERPENDICULAR}
    assert upright[1.0].mean > 5 * upright[20.0].mean
    assert upright[1.0].bound == pytest.approx(20 * upright[20.0].bound, rel=0.05)
    assert (result.force_errors < 0.1).all()


def test_each_cause_adds_what_it_must(result: StaticResult) -> None:
    by_cause = {one.cause: one for one in result.attributed}
    off = by_cause["markers 0.5 mm off"]
    # Half a millimetre in a direction of its own adds half a millimetre in quadrature, whatever the angle.
    assert np.allclose(off.added, 0.5, atol=0.3)
    mount = next(one for one in result.attributed if one.cause.startswith("mount"))
    assert min(mount.ratios[1:]) > 1.2  # it is the side force that turns the probe
    assert result.explained.means[0] == pytest.approx(0.9, abs=0.1)


def test_a_mount_that_yields_moves_the_contact_by_lever_and_torque() -> None:
    touched = press_markers("t-shape", markers("t-shape")[2:3], 1, 1)
    turned = attribution._yielding(touched, 1 / 100.0)
    moved = np.cross(touched.contacts[:, 3:] / 100.0, touched.points)
    expected = touched.contacts[:, 3:] + np.cross(moved, touched.contacts[:, :3])
    np.testing.assert_allclose(turned.contacts[:, 3:], expected, atol=5e-4)
    np.testing.assert_array_equal(turned.contacts[:, :3], touched.contacts[:, :3])


def test_readings_lose_weight_and_bias() -> None:
    bench = draw_bench(3)
    contact = np.array([[1.0, 0.0, -9.0, 0.05, 0.3, 0.001]])
    # The filter leaves a fifth of the noise, and the calibration is better than that.
    many = np.tile(contact, (400, 1))
    read = read_touches(bench, many, np.tile(held(contact[0]), (400, 1, 1)), 0)
    sigmas = np.sqrt(np.diag(bench.filtered_noise.covariance))
    np.testing.assert_allclose(read.std(axis=0), sigmas, rtol=0.15)
    np.testing.assert_allclose(read.mean(axis=0), contact[0], atol=5e-2)
    assert bench.calibration.mass == pytest.approx(bench.truth.mass, abs=0.005)


def test_the_scene_leaves_out_less_than_a_twentieth_of_a_millimetre(result: StaticResult) -> None:
    assert max(one.most for one in result.effects) < 0.05
    assert max(one.most_located for one in result.effects) < 0.05


def test_touches_in_doubt_are_told(result: StaticResult) -> None:
    probe = result.probes[0]
    mine = probe.located[OURS]
    reasons = mine.reasons.copy()
    row = int(np.flatnonzero(probe.touched.angles == 2)[1])
    reasons[row] = Reason.AMBIGUOUS
    doubtful = replace(probe, located={**probe.located, OURS: replace(mine, reasons=reasons)})
    report = replace(result, probes=[doubtful]).report
    assert any("1 touches (marker 2) are called ambiguous" in note for note in report.notes)
    assert not any("ambiguous" in note for note in result.report.notes)


def test_files_are_the_same_twice(
    result: StaticResult, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The slowest part; its scenes are tested for this by themselves.
    monkeypatch.setattr(static, "effects", lambda *_: result.effects)
    again = static.run(("t-shape",), seeds=1, touches=1, most_markers=3)
    result.write(tmp_path / "a")
    again.write(tmp_path / "b")
    names = {file.name for file in (tmp_path / "a").iterdir()}
    assert {"static.md", "static.png", "errors.csv", "causes.csv", "times.csv", "left_out.csv"} <= names
    for name in names - {"times.csv", "static.png"}:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    with (tmp_path / "a" / "errors.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert {row["method"] for row in rows} >= {"contactbench", "algorithm1", "iterative", "scan"}
    assert (tmp_path / "a" / "static.png").read_bytes()[:4] == b"\x89PNG"
    json.dumps(result.to_json(), allow_nan=False)


def test_the_command_ends_with_1_when_a_target_is_missed(
    result: StaticResult, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, benchmark
) -> None:
    monkeypatch.setattr(static, "run", lambda *_args, **_options: result)
    monkeypatch.setattr("benchmarks.reproduce.judging.MOST_PERPENDICULAR_MM", 0.001)
    done = benchmark("reproduce-static", "--write", tmp_path / "out", "--json")
    assert done.exit_code == 1
    told = json.loads(done.stdout)
    assert not told["passed"]
    assert told["errors"][0]["probe"] == "t-shape"


@pytest.mark.parametrize(
    "options",
    [("--probes", "pear"), ("--seeds", "0"), ("--touches", "0"), ("--facets", "10"), ("--most-markers", "2")],
)
def test_wrong_options_are_named(options: tuple[str, str], tmp_path: Path, benchmark) -> None:
    done = benchmark("reproduce-static", "--write", tmp_path / "x", *options)
    assert done.exit_code == 2
    assert options[1] in done.stderr
    assert not (tmp_path / "x").exists()


def test_a_file_in_the_way_is_named(result: StaticResult, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("x", encoding="utf-8")
    with pytest.raises(InputError, match="taken"):
        result.write(tmp_path / "taken")
