"""calibrate check weight and calibrate check touch, as a person at a terminal and a session use them."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.verification import mesh
from scipy.spatial.transform import Rotation
from terminal import invoke, said
from weighing_files import TRUTH, spun, weighed, write_quaternions

from contactbench.pipeline.calibration.files.pose_csv import write_poses
from contactbench.pipeline.calibration.poses import PoseSample
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import save_probe
from contactbench.pipeline.session import Session

G, RATE = 9.80665, 200
SAMPLE = np.repeat([0.05, 0.002], 3)
TILTED = Rotation.from_euler("xyz", [[170, 0, 0], [100, 10, 0], [150, 60, 0]], degrees=True).as_matrix()


@pytest.fixture(autouse=True)
def fixed_date(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("check")
    poses = write_quaternions(folder / "poses.csv", weighed())
    assert invoke("calibrate", "fit", poses, "--out", folder / "c.json").exit_code == 0
    save_probe(mesh(2_000), folder / "probe.ply")
    hung(folder / "empty.csv", 0.0)
    hung(folder / "hung.csv", 3.0)
    hung(folder / "short.csv", 2.91)
    pressed(folder / "press.csv")
    pressed(folder / "reversed.csv", torque=-1.0)
    return folder


def hung(file: Path, mass: float) -> None:
    rng = np.random.default_rng(round(100 * mass))
    poses = []
    for R in TILTED:
        f = R.T @ [0, 0, -G * mass]
        w = TRUTH.predict(R) + np.concatenate([f, np.cross([0.02, 0, 0.1], f)])
        w += rng.standard_normal(6) * SAMPLE / 20
        poses.append(PoseSample(R, w[:3], w[3:], 400, SAMPLE[:3], SAMPLE[3:]))
    write_poses(file, poses)


def side() -> tuple[Any, Any]:
    _, faces, feet = SurfaceIndex(mesh(2_000).vertices, mesh(2_000).faces).closest(
        np.array([[0.03, 0.008, 0.2]])
    )
    return feet[0], mesh(2_000).normals[faces[0]]


def pressed(file: Path, torque: float = 1.0) -> None:
    """Write raw readings of a press; `torque`: what the sensor multiplies a touch's torque by."""
    rng = np.random.default_rng(0)
    point, normal = side()
    size = np.concatenate([np.zeros(RATE), np.linspace(0, 10, 20), np.full(RATE, 10.0), np.zeros(RATE // 2)])
    f = -size[:, None] * normal
    w = np.hstack([f, torque * np.cross(point, f)]) + TRUTH.predict(TILTED[0])
    w += rng.standard_normal(w.shape) * SAMPLE
    q = np.roll(Rotation.from_matrix(TILTED[0]).as_quat(), 1)
    table = np.column_stack([np.arange(len(w)) / RATE, w, np.tile(q, (len(w), 1))])
    np.savetxt(file, table, delimiter=",", header="t,fx,fy,fz,mx,my,mz,qw,qx,qy,qz", comments="")


def weigh(folder: Path, *more: object, loaded: str = "hung.csv") -> Any:
    files = (
        "--calibration",
        folder / "c.json",
        "--unloaded",
        folder / "empty.csv",
        "--loaded",
        folder / loaded,
    )
    return invoke("calibrate", "check", "weight", *files, "--mass", 3.0, "--mass-sigma", 0.0005, *more)


def press(folder: Path, *more: object, recording: str = "press.csv") -> Any:
    point = ",".join(f"{1e3 * each:.3f}" for each in side()[0])
    files = ("--calibration", folder / "c.json", "--probe", folder / "probe.ply", folder / recording)
    where = () if "--markers" in more or "--point" in more else ("--point", point)
    return invoke("calibrate", "check", "touch", *files, *where, *more)


# ---- weight --------------------------------------------------------------------------------------


def test_a_right_weight_passes_and_is_written(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "known_weight.json"
    result = weigh(folder, "--certificate", "DKD-7", "--out", out, "--json")
    assert result.exit_code == 0, said(result)
    content = json.loads(out.read_bytes())
    assert {**content, "out": str(out)} == json.loads(result.stdout)
    assert (content["schema"], content["version"]) == ("contactbench.known_weight", 1)
    assert content["certificate"] == "DKD-7"
    assert content["created"] == "2023-11-14T22:13:20Z"
    assert content["measured_kg"] == pytest.approx(3.0, abs=4 * content["measured_sigma_kg"])
    assert content["axes"] == ["x", "y", "z"]
    assert content["readings"] == {"unloaded": 3, "loaded": 3}
    assert len(content["calibration_sha256"]) == 64
    assert "PASSED: The sensor reads" in said(result)


def test_three_percent_less_fails(folder: Path) -> None:
    result = weigh(folder, "--json", loaded="short.csv")
    assert result.exit_code == 1
    assert json.loads(result.stdout)["outcome"] == "failed"
    assert "3.0 ± 0.2 % too little" in said(result)


def test_an_unknown_weight_cannot_tell(folder: Path) -> None:
    result = weigh(folder, "--mass-sigma", 0.15)
    assert result.exit_code == 1
    assert "UNDECIDED: The check is inconclusive." in said(result)


def test_a_refused_calibration_is_said(folder: Path, tmp_path: Path) -> None:
    blind = write_quaternions(tmp_path / "few.csv", spun())
    assert invoke("calibrate", "fit", blind, "--out", tmp_path / "few.json").exit_code == 1
    result = weigh(folder, "--calibration", tmp_path / "few.json")
    assert result.exit_code == 1
    assert "The calibration was refused" in said(result)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (("--mass", -1), "--mass: Input should be greater than 0"),
        (("--gravity", 1.62), "gravity 1.62"),
        (("--calibration", "missing.json"), "missing.json"),
        (("--unloaded", "missing.csv"), "missing.csv"),
        (("--euler", "xyz"), "rx"),
        (("--euler", "xyz", "--rotation-vector"), "contradict each other"),
        (("--mount", "1,2"), "--mount needs 3"),
        (("--out", "weight.txt"), "must end in .json"),
    ],
)
def test_wrong_input_of_a_weight_ends_with_2_and_a_remedy(folder: Path, more: Any, words: str) -> None:
    result = weigh(folder, *more)
    assert result.exit_code == 2
    assert words in said(result)


def test_an_input_is_not_overwritten(folder: Path) -> None:
    result = weigh(folder, "--out", folder / "c.json")
    assert result.exit_code == 2
    assert "is also an input" in said(result)


# ---- touch ---------------------------------------------------------------------------------------


def test_a_right_touch_passes_and_is_written(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "known_touch.json"
    result = press(folder, "--out", out, "--json")
    assert result.exit_code == 0, said(result)
    content = json.loads(out.read_bytes())
    assert (content["schema"], content["version"]) == ("contactbench.known_touch", 1)
    assert content["error_m"] < 0.002
    assert np.linalg.norm(np.subtract(content["located_S_m"], content["point_S_m"])) == pytest.approx(
        content["error_m"]
    )
    assert {len(content[name]) for name in ("calibration_sha256", "probe_sha256")} == {64}


def test_a_reversed_torque_fails_and_is_named(folder: Path) -> None:
    result = press(folder, recording="reversed.csv")
    assert result.exit_code == 1
    assert "Likely cause: the torques have the wrong sign." in said(result)


def test_the_point_of_a_marker(folder: Path, tmp_path: Path) -> None:
    x, y, z = (1e3 * side()[0]).tolist()
    (tmp_path / "m.csv").write_text(f"name,x_mm,y_mm,z_mm\nA,0,0,0\nB,{x},{y},{z}\n", encoding="utf-8")
    assert press(folder, "--markers", tmp_path / "m.csv", "--marker", "B").exit_code == 0
    result = press(folder, "--markers", tmp_path / "m.csv", "--marker", "C")
    assert result.exit_code == 2
    assert "no marker C; the file has A, B" in said(result)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (("--point", "0,0"), "--point needs 3"),
        (("--point", "0,0,9000"), "the point"),
        (("--point", "0,0,0", "--marker", "B"), "give the pressed point"),
        (("--limit", 0), "--limit: Input should be greater than 0"),
        (("--probe", "missing.ply"), "missing.ply"),
    ],
)
def test_wrong_input_of_a_touch_ends_with_2_and_a_remedy(folder: Path, more: Any, words: str) -> None:
    result = press(folder, *more)
    assert result.exit_code == 2
    assert words in said(result)


# ---- in a session --------------------------------------------------------------------------------


def test_a_session_keeps_both_and_knows_when_they_are_stale(folder: Path, tmp_path: Path) -> None:
    session = tmp_path / "s"
    assert invoke("session", "new", session).exit_code == 0
    for file, kind in (
        ("poses.csv", "poses"),
        ("empty.csv", "unloaded"),
        ("hung.csv", "loaded"),
        ("press.csv", "touch"),
        ("probe.ply", "probe"),
    ):
        assert invoke("session", "add", session, folder / file, "--kind", kind).exit_code == 0
    point = json.dumps((1e3 * side()[0]).tolist())
    made = (
        ("calibration", "calibration.json"),
        ("known_weight", "known_weight.json", "--set", "mass=3.0"),
        ("known_touch", "known_touch.json", "--set", f"point={point}"),
    )
    for each in made:
        result = invoke("session", "compute", session, *each)
        assert result.exit_code == 0, said(result)
    kinds = ("known_weight", "known_touch")
    with Session.open(session, write=False) as opened:
        assert not any(opened.stale().values())
        for kind in kinds:
            result = opened.state.current_results[kind, f"{kind}.json"]
            content = json.loads((session / result.file.path).read_bytes())
            assert content["passed"] is True
            calibration = opened.state.current_results["calibration", "calibration.json"]
            assert content["calibration_sha256"] == calibration.file.sha256
    replayed = invoke("session", "replay", session)
    assert replayed.exit_code == 0, said(replayed)
    assert invoke("session", "compute", session, *made[0], "--set", "tip=[0,0,150]").exit_code == 0
    with Session.open(session, write=False) as opened:
        stale = opened.stale()
        assert all(stale[kind, f"{kind}.json"] for kind in kinds)


def test_a_session_says_what_is_missing(tmp_path: Path) -> None:
    assert invoke("session", "new", tmp_path / "s").exit_code == 0
    result = invoke(
        "session", "compute", tmp_path / "s", "known_weight", "known_weight.json", "--set", "mass=1"
    )
    assert result.exit_code == 2
    assert "this session has no calibration" in said(result)
