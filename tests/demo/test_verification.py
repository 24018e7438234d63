from __future__ import annotations

import csv
import hashlib
import json
import shutil
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.demo import bench, verification
from contactbench.pipeline.demo.tape import DemoTool, draw_tool
from contactbench.pipeline.demo.verification import CheckResult, check
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.recording import read_recording

if TYPE_CHECKING:
    from pathlib import Path

    from contactbench.pipeline import demo

MARKERS, SEED = 15, 3
NEEDED = ("touches.mcap", "calibration.json", "probe.ply", "probe.json")
GOOD = CheckResult(15, 30, (), 0.1, 0.3, (), None, 3000, 2990, 30, 0.1, 0.2)


@pytest.fixture
def tool() -> DemoTool:
    return draw_tool(bench._chance(SEED, "convex", 0))


@pytest.fixture
def folder(benched: demo.DemoReport, tmp_path: Path) -> Path:
    for name in NEEDED:
        if (file := benched.out / "convex" / name).exists():  # without pymeshlab a probe has no history
            shutil.copy(file, tmp_path)
    return tmp_path


@pytest.fixture
def no_report(monkeypatch: pytest.MonkeyPatch) -> None:
    """Most tests are about the bundle: drawing the report takes most of the time."""
    monkeypatch.setattr(verification, "report", lambda *_: {"report.html": b"<!doctype html>"})


def test_the_demo_ends_with_a_bundle_that_is_verified(benched: demo.DemoReport) -> None:
    folder = benched.out / "convex"
    result = benched.probes[0].checked
    assert result is not None
    assert result.verified
    assert (result.markers, result.touches, result.rejected) == (MARKERS, 2 * MARKERS, ())
    assert (
        result.samples
        == result.located
        == len(read_recording(folder / "touches.mcap").wrenches["/wrench"].times)
    )
    model = RuntimeConfig.load(folder / "runtime").model
    assert model.verified
    assert model.verification is not None
    assert 1e3 * model.verification.mean_error_m == pytest.approx(result.mean_mm)
    assert (model.sensor.model, model.sensor.rate_Hz) == ("virtual, paper-like", 200)
    assert model.noise.force_N == pytest.approx([0.05] * 3, rel=0.01)
    assert {source.role: source.sha256 for source in model.provenance.sources} == {
        role: hashlib.sha256((folder / name).read_bytes()).hexdigest()
        for role, name in (
            ("calibration", "calibration.json"),
            ("probe", "probe.ply"),
            ("verification", "verification.json"),
        )
    }
    assert (folder / "runtime" / "report.html").read_bytes() == (folder / "report.html").read_bytes()
    said = " ".join(benched.sentences())
    assert f"convex: verified on {MARKERS} markers: mean 0.1" in said
    assert "passed (30 touches); the bundle is intact; it located 3,000 of 3,000 samples" in said
    assert benched.to_json()["probes"][0]["checked"]["verified"] is True


def test_markers_are_the_points_that_were_pressed(benched: demo.DemoReport) -> None:
    with (benched.out / "convex" / "markers.csv").open(newline="") as stream:
        marked = {row["name"]: [float(row[f"{axis}_mm"]) for axis in "xyz"] for row in csv.DictReader(stream)}
    with (benched.out / "convex" / "truth.csv").open(newline="") as stream:
        for row in csv.DictReader(stream):
            point = [1e3 * float(row[axis]) for axis in "xyz"]
            assert np.linalg.norm(np.subtract(point, marked[row["marker"]])) < 0.5


def test_the_bundle_finds_the_verified_points_and_the_true_ones(benched: demo.DemoReport) -> None:
    folder = benched.out / "convex"
    lines = map(json.loads, (folder / "contacts.jsonl").read_text(encoding="utf-8").splitlines())
    contacts = {round(200 * line["time"]): line for line in lines}
    verified = json.loads((folder / "verification.json").read_text(encoding="utf-8"))
    apart = [
        np.linalg.norm(
            1e3 * np.array(contacts[round(200 * touch["time_s"])]["point_S_m"]) - touch["point_mm"]
        )
        for touch in verified["touches"]
    ]
    result = benched.probes[0].checked
    assert result is not None
    assert result.apart_mm == pytest.approx(np.mean(apart))
    assert max(apart) < 0.5
    with (folder / "truth.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    errors = [
        np.subtract(contacts[round(200 * float(row["t"]))]["point_S_m"], [float(row[axis]) for axis in "xyz"])
        for row in rows
    ]
    assert 1e3 * np.linalg.norm(errors, axis=1).mean() < 0.3


def test_with_a_given_time_every_byte_is_the_same(
    folder: Path, tool: DemoTool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    names = (*verification.WRITTEN, *(f"runtime/{name}" for name in verification.KNOWN))
    runs = []
    for _ in range(2):
        assert check(folder, "convex", tool).verified
        runs.append({name: (folder / name).read_bytes() for name in names})
    assert runs[0] == runs[1]
    assert RuntimeConfig.load(folder / "runtime").model.provenance.created == "2023-11-14T22:13:20Z"


# ---- what must fail ----------------------------------------------------------------------------


@pytest.mark.usefixtures("no_report")
def test_contacts_that_are_off_make_no_bundle(
    folder: Path, tool: DemoTool, monkeypatch: pytest.MonkeyPatch, benched: demo.DemoReport
) -> None:
    shutil.copytree(benched.out / "convex" / "runtime", folder / "runtime")
    honest = verification.markers
    monkeypatch.setattr(verification, "markers", lambda name: honest(name) + [0.0012, 0.0012, 0.0])
    result = check(folder, "convex", tool)
    assert not result.verified
    assert any("the mean error is" in reason for reason in result.failed)
    assert "verification FAILED on" in result.sentence("convex")
    assert "no bundle was made" in result.sentence("convex")
    assert not list(folder.glob("runtime/*"))  # nor is there that of another run
    assert not (folder / "contacts.jsonl").exists()
    assert not replace(benched, probes=(replace(benched.probes[0], checked=result),)).verified


@pytest.mark.usefixtures("no_report")
def test_markers_off_the_probe_are_a_finding(
    folder: Path, tool: DemoTool, monkeypatch: pytest.MonkeyPatch
) -> None:
    honest = verification.markers
    monkeypatch.setattr(verification, "markers", lambda name: honest(name) + [0.0, 0.0, 0.02])
    result = check(folder, "convex", tool)
    assert not result.verified
    assert "verification FAILED on 0 markers" in result.sentence("convex")


@pytest.mark.usefixtures("no_report")
def test_rejected_touches_are_listed(folder: Path, tool: DemoTool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verification, "WINDOW_N", (8.0, 9.5))
    result = check(folder, "convex", tool)
    assert result.rejected
    assert result.touches + len(result.rejected) == 2 * MARKERS
    assert "(force out of window)" in result.sentence("convex")
    assert f"rejected: {result.rejected[0]}" in result.sentence("convex")


@pytest.mark.usefixtures("no_report")
def test_a_bundle_that_is_changed_on_its_way_is_refused(
    folder: Path, tool: DemoTool, monkeypatch: pytest.MonkeyPatch
) -> None:
    honest = RuntimeConfig.write

    def damaged(config: RuntimeConfig, path: Path) -> None:
        honest(config, path)
        mesh = bytearray((path / "probe.ply").read_bytes())
        mesh[-1] ^= 1
        (path / "probe.ply").write_bytes(mesh)

    monkeypatch.setattr(RuntimeConfig, "write", damaged)
    result = check(folder, "convex", tool)
    assert not result.verified
    assert "FAILED, the bundle was refused" in result.sentence("convex")
    assert "probe.ply was changed: its hash does not match" in result.sentence("convex")


@pytest.mark.usefixtures("no_report")
def test_a_refused_calibration_is_not_exported(
    folder: Path, tool: DemoTool, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> Any:
        raise verification.UnverifiedError(("The calibration was refused: too few poses.",))

    monkeypatch.setattr(verification, "export_from_files", refuse)
    result = check(folder, "convex", tool)
    assert result.refused == "The calibration was refused: too few poses."
    assert not result.verified


def test_a_bundle_that_locates_elsewhere_fails() -> None:
    assert GOOD.verified
    for change in ({"apart_mm": 0.21}, {"compared": 15}, {"apart_mm": None, "compared": 0}):
        wrong = replace(GOOD, **change)
        assert not wrong.verified
        assert "FAILED" in wrong.sentence("convex")


def test_what_cannot_be_removed_is_named(tmp_path: Path) -> None:
    (tmp_path / "report.html").mkdir()
    with pytest.raises(InputError, match=r"report\.html: it cannot be removed"):
        verification.clear(tmp_path)


def test_clearing_leaves_what_is_not_ours(tmp_path: Path) -> None:
    (tmp_path / "runtime").mkdir()
    for name in ("runtime/planes.csv", "runtime/notes.txt", "markers.csv", "mine.csv"):
        (tmp_path / name).write_text("x", encoding="utf-8")
    verification.clear(tmp_path)
    left = {str(file.relative_to(tmp_path)) for file in tmp_path.rglob("*") if file.is_file()}
    assert left == {"runtime/notes.txt", "mine.csv"}
