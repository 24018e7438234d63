"""calibrate, diagnose, verify-still and compensate, as a person at a terminal uses them."""

import csv
import html
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from terminal import invoke, said
from weighing_files import NOISE, TRUTH, spun, weighed, write_euler, write_quaternions

from contactbench.pipeline.calibration.files.calibration_file import load_calibration, load_record
from contactbench.pipeline.calibration.payload import payload_of
from contactbench.pipeline.settings import RobotMaker
from contactbench.pipeline.simulation.loads import bump, weigh

EULER = ("--euler", "xyz")


@pytest.fixture(autouse=True)
def fixed_date(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")


@pytest.fixture
def poses(tmp_path: Path) -> Path:
    return write_euler(tmp_path / "poses.csv", weighed())


@pytest.fixture
def calibration(tmp_path: Path, poses: Path) -> Path:
    assert invoke("calibrate", "fit", poses, *EULER, "--out", tmp_path / "c.json").exit_code == 0
    return tmp_path / "c.json"


# ---- calibrate -----------------------------------------------------------------------------------


def test_a_good_calibration(tmp_path: Path, poses: Path) -> None:
    result = invoke("calibrate", "fit", poses, *EULER, "--out", tmp_path / "c.json", "--json")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert found["verdict"] == "good"
    assert abs(found["mass_kg"] - TRUTH.mass) < 4 * found["mass_sigma_kg"] < 0.02
    assert found["rank"] == 12
    assert found["rejected"] == []
    assert found["noise_estimated"] is True
    assert "GOOD: The calibration adds up to" in said(result)
    assert load_calibration(tmp_path / "c.json").mass == found["mass_kg"]


def test_quaternions_need_no_option(tmp_path: Path, calibration: Path) -> None:
    file = write_quaternions(tmp_path / "q.csv", weighed())
    assert invoke("calibrate", "fit", file, "--out", tmp_path / "q.json").exit_code == 0
    assert load_calibration(tmp_path / "q.json").mass == pytest.approx(
        load_calibration(calibration).mass, rel=1e-9
    )


def test_the_bumped_pose_is_named(tmp_path: Path) -> None:
    weighing = bump(weighed(), 1 / 9, np.random.default_rng(0))
    file = write_euler(tmp_path / "b.csv", weighing)
    noise = ("--noise-force", NOISE.force, "--noise-torque", NOISE.torque)
    result = invoke("calibrate", "fit", file, *EULER, "--out", tmp_path / "b.json", *noise, "--json")
    name = f"pose {1 + int(np.flatnonzero(weighing.bumped)[0])}"
    assert [rejection["name"] for rejection in json.loads(result.stdout)["rejected"]] == [name]
    assert f"{name} is left out: " in said(result)


def timed(file: Path, weighing: Any, offsets: np.ndarray) -> Path:
    """Write poses 30 s apart, with offsets (n, 6) in the readings, N and N·m."""
    moved = [
        replace(pose, force=pose.force + offset[:3], torque=pose.torque + offset[3:])
        for pose, offset in zip(weighing.poses, offsets, strict=True)
    ]
    return write_euler(file, replace(weighing, poses=tuple(moved)))


def test_a_drift_is_told_with_its_rate_and_the_bias_at_the_end(tmp_path: Path) -> None:
    weighing = weighed(12)
    share = np.linspace(-1, 0, 12)[:, None]
    drift = np.array([0.5, 0.0, 0.0, 0.0, 0.015, 0.0])
    file = timed(tmp_path / "drift.csv", weighing, share * drift)
    result = invoke("calibrate", "fit", file, *EULER, "--out", tmp_path / "d.json", "--json")
    facts = json.loads(result.stdout)
    assert facts["causes"][0]["key"] == "drift"
    assert facts["causes"][0]["sentence"] in said(result)
    assert 0.9 < facts["causes"][0]["odds"] <= 1
    hours = 10.0 * 11 / 3600  # as the file has the times
    rates, sigmas = np.array(facts["drift_per_hour"]), np.array(facts["drift_per_hour_sigma"])
    assert (np.abs(rates - drift / hours) < 4 * sigmas).all()
    assert sigmas[0] < 0.2 * rates[0]
    offsets = np.array(facts["offsets"])
    np.testing.assert_allclose(offsets[-1], 0, atol=1e-12)
    assert offsets[0, 0] == pytest.approx(-0.5, abs=0.15)
    assert facts["parameters"]["force_bias_x"] == pytest.approx(TRUTH.force_bias[0], abs=0.2)
    assert "force bias at the end" in said(result)
    assert "N/h" in said(result)


def test_what_is_plain_needs_no_words(tmp_path: Path, poses: Path) -> None:
    result = invoke("calibrate", "fit", poses, *EULER, "--out", tmp_path / "c.json", "--json")
    facts = json.loads(result.stdout)
    assert facts["causes"][0]["key"] == "plain"
    assert facts["causes"][0]["sentence"] not in " ".join(result.stderr.split())
    assert facts["drift_per_hour"] is facts["drift_per_hour_sigma"] is None
    assert not np.any(facts["offsets"])
    assert facts["noise_factor"] == [1.0, 1.0]
    assert facts["down_W"] == [0.0, 0.0, -1.0]
    assert "force bias " in said(result)
    assert "at the end" not in said(result)


@pytest.mark.parametrize(
    ("option", "degrees"), [("hand", 0.5), ("tracker", 0.2), ("robot", 0.05), ("0.3", 0.3), ("0", 0.0)]
)
def test_the_noise_of_the_orientations(tmp_path: Path, poses: Path, option: str, degrees: float) -> None:
    options = ("--noise-force", NOISE.force, "--noise-torque", NOISE.torque, "--orientation-noise", option)
    result = invoke("calibrate", "fit", poses, *EULER, *options, "--out", tmp_path / "c.json", "--json")
    assert json.loads(result.stdout)["orientation_noise_deg"] == pytest.approx(degrees)
    assert f"orientation noise {degrees:.2g} " in said(result)


@pytest.mark.parametrize("down", [(0, 0, 1), (1, 0, 0), (0, -3, 4)])
def test_a_robot_that_hangs(tmp_path: Path, down: tuple[int, int, int]) -> None:
    turn = Rotation.align_vectors([down], [[0.0, 0.0, -1.0]])[0].as_matrix()
    weighing = weighed()
    turned = tuple(replace(pose, R_WS=turn @ pose.R_WS) for pose in weighing.poses)
    file = write_quaternions(tmp_path / "ceiling.csv", replace(weighing, poses=turned))
    said_down = ("--down", ",".join(map(str, down)))
    out = tmp_path / "c.json"
    assert invoke("calibrate", "fit", file, "--out", out).exit_code == 1
    result = invoke("calibrate", "fit", file, *said_down, "--out", out, "--json")
    assert result.exit_code == 0
    facts = json.loads(result.stdout)
    assert facts["verdict"] == "good"
    np.testing.assert_allclose(facts["down_W"], down / np.linalg.norm(down), atol=1e-15)
    noise = ("--noise-force", NOISE.force, "--noise-torque", NOISE.torque)
    assert invoke("calibrate", "diagnose", file, *said_down, *noise).exit_code == 0


def test_blind_poses_are_refused_in_words_and_numbers_withheld(tmp_path: Path) -> None:
    file = write_euler(tmp_path / "s.csv", spun())
    result = invoke("calibrate", "fit", file, *EULER, "--out", tmp_path / "s.json")
    assert result.exit_code == 1
    assert "REFUSE: Every pose has the same tilt" in said(result)
    assert "mass unknown" in said(result)
    assert load_calibration(tmp_path / "s.json").verdict.level == "refuse"


def test_the_unknown_mount_is_found(tmp_path: Path) -> None:
    R_ES = Rotation.from_euler("z", 30, degrees=True).as_matrix()
    weighing = weighed(12)
    R_WE = np.array([pose.R_WS @ R_ES.T for pose in weighing.poses])
    file = tmp_path / "flange.csv"
    with file.open("w", newline="") as stream:
        rows = csv.writer(stream)
        rows.writerow(["fx", "fy", "fz", "mx", "my", "mz", "rx", "ry", "rz"])
        for pose, angles in zip(weighing.poses, Rotation.from_matrix(R_WE).as_rotvec(), strict=True):
            rows.writerow([*pose.force, *pose.torque, *angles])
    written = ("--rotation-vector", "--radians")
    result = invoke(
        "calibrate", "fit", file, *written, "--estimate-mount", "--out", tmp_path / "m.json", "--json"
    )
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    angle = np.degrees(np.linalg.norm(Rotation.from_matrix(np.array(found["R_SE"]) @ R_ES).as_rotvec()))
    assert angle < 4 * found["R_SE_sigma_deg"] < 4
    mount = load_record(tmp_path / "m.json").mount
    assert mount is not None
    np.testing.assert_allclose(mount.R_SE, found["R_SE"], atol=1e-12)
    # The same rotation given by hand leads to the same load, and compensate uses the one that was found.
    assert (
        invoke(
            "calibrate", "fit", file, *written, "--mount", "0,0,30", "--out", tmp_path / "k.json"
        ).exit_code
        == 0
    )
    kept = load_record(tmp_path / "k.json").mount
    assert kept is not None
    assert not kept.covariance.any()
    np.testing.assert_allclose(kept.R_SE, Rotation.from_euler("z", -30, degrees=True).as_matrix(), atol=1e-12)
    known = load_calibration(tmp_path / "k.json")
    assert known.mass == pytest.approx(found["mass_kg"], abs=4 * found["mass_sigma_kg"])
    with file.open() as stream:
        text = stream.read().replace("fx,", "t,fx,", 1).splitlines()
    recording = tmp_path / "recording.csv"
    recording.write_text(
        "\n".join([text[0], *(f"{i},{row}" for i, row in enumerate(text[1:]))]) + "\n", encoding="utf-8"
    )
    assert (
        invoke(
            "calibrate", "compensate", tmp_path / "m.json", recording, *written, "--out", tmp_path / "w.csv"
        ).exit_code
        == 0
    )
    rows = np.loadtxt(tmp_path / "w.csv", delimiter=",", skiprows=1)
    assert np.abs(rows[:, 1:4]).max() < 0.25


def test_same_input_same_bytes_and_a_report(tmp_path: Path, poses: Path) -> None:
    for name in ("a", "b"):
        out, report = tmp_path / f"{name}.json", tmp_path / f"{name}.html"
        assert invoke("calibrate", "fit", poses, *EULER, "--out", out, "--report", report).exit_code == 0
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()
    assert "Gravity calibration" in (tmp_path / "a.html").read_text(encoding="utf-8")


def test_a_report_has_the_robots_payload_where_the_sensor_s_place_is_known(
    tmp_path: Path, poses: Path
) -> None:
    fit = ("calibrate", "fit", poses, *EULER, "--out", tmp_path / "c.json", "--report", tmp_path / "r.html")
    assert invoke(*fit, "--mount", "0,0,0").exit_code == 0
    assert "payload" not in (tmp_path / "r.html").read_text("utf-8")
    where = ("--sensor-at", "1,2,40")
    result = invoke(*fit, "--mount", "0,0,90", *where)
    assert "own body and its adapters are not in it" in said(result)
    # Of a flange on which the sensor is turned: the payload is turned by it.
    turn = Rotation.from_euler("z", -90, degrees=True).as_matrix()
    weighing = weighed()
    turned = tuple(replace(pose, R_WS=pose.R_WS @ turn) for pose in weighing.poses)
    write_euler(poses, replace(weighing, poses=turned))
    result = invoke(*fit, "--mount", "0,0,90", *where, "--sensor-body", "0.3,0,0,20")
    assert result.exit_code == 0
    assert "not in it" not in said(result)
    record = load_record(tmp_path / "c.json")
    assert record.mount is not None
    told = payload_of(
        record.calibration.model, record.mount.R_SE.T, [0.001, 0.002, 0.04], 0.3, [0.0, 0.0, 0.02]
    )
    page = html.unescape((tmp_path / "r.html").read_text("utf-8")).replace("\N{NO-BREAK SPACE}", " ")
    for maker in RobotMaker:
        assert f"<code>{told.text(maker)}</code>" in page
    assert "nothing touching the tool" in page


def test_a_report_of_a_refused_or_unsure_calibration_has_no_line_to_copy(
    tmp_path: Path, poses: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fit = ("calibrate", "fit", poses, *EULER, "--out", tmp_path / "c.json", "--report", tmp_path / "r.html")
    where = ("--mount", "0,0,0", "--sensor-at", "0,0,40", "--sensor-body", "0.3,0,0,20")
    blind = write_euler(tmp_path / "blind.csv", spun())
    result = invoke("calibrate", "fit", blind, *fit[3:], *where)
    assert result.exit_code == 1
    assert "No payload for the robot: the calibration is refused." in said(result)
    page = html.unescape((tmp_path / "r.html").read_text("utf-8"))
    assert "the calibration is refused" in page
    assert "set_target_payload" not in page
    assert "tload" not in page
    monkeypatch.setattr("contactbench.pipeline.calibration.payload._LARGEST_SHARE", 0.0)
    assert "it is too unsure" in said(invoke(*fit, *where))
    assert "set_target_payload" not in (tmp_path / "r.html").read_text("utf-8")


def test_a_mount_that_looks_like_radians_is_asked_about(tmp_path: Path, poses: Path) -> None:
    fit = ("calibrate", "fit", poses, *EULER, "--out", tmp_path / "c.json", "--mount")
    for mount, asked in (
        ("0,0,1.5708", True),
        ("3.14,0,-1.57", True),
        ("6.2832,0,0", True),
        ("0,0,0", False),
        ("0,0,90", False),
        ("0,1,1.5708", False),
        ("0,0,0.01", False),
        ("0,0,7.854", False),
    ):
        assert ("--mount in radians?" in said(invoke(*fit, mount))) is asked, mount


@pytest.mark.parametrize(
    "wrong",
    [("--sensor-at", "0,0,40"), ("--mount", "0,0,0", "--sensor-body", "0.3,0,0,20"), ("--sensor-at", "a")],
)
def test_a_payload_without_mount_or_place_is_refused(
    tmp_path: Path, poses: Path, wrong: tuple[str, ...]
) -> None:
    fit = ("calibrate", "fit", poses, *EULER, "--out", tmp_path / "c.json", "--report", tmp_path / "r.html")
    result = invoke(*fit, *wrong)
    assert result.exit_code == 2
    assert "--sensor-" in said(result)


def test_a_report_says_who_and_with_which_sensor(tmp_path: Path, poses: Path) -> None:
    report = tmp_path / "r.html"
    given = ("--operator=A. Lovelace", "--certificate=DKD-7", "--due=2031-01-31", "--serial=M8128=SN 7")
    fit = ("calibrate", "fit", poses, *EULER, "--out", tmp_path / "c.json", "--report")
    assert invoke(*fit, report, *given).exit_code == 0
    page = report.read_text(encoding="utf-8")
    for words in ("A. Lovelace", "DKD-7", "2031-01-31", "M8128: SN 7"):
        assert f"<bdi>{words}</bdi>" in page
    for wrong, message in (
        ((tmp_path / "r.txt",), "name a file that ends in .html or .pdf"),
        ((report, "--due", "soon"), "--due: give a date as 2027-03-31"),
        ((report, "--serial", "7"), "--serial needs DEVICE=NUMBER"),
    ):
        refused = invoke(*fit, *wrong)
        assert refused.exit_code == 2
        assert message in said(refused)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ((), "pass --euler ORDER"),
        (("--euler", "xxz"), "give three axes"),
        (("--euler", "xyz", "--rotation-vector"), "contradict"),
        (("--radians",), "--radians needs angles"),
        ((*EULER, "--noise-force", 0.05), "neither"),
        ((*EULER, "--noise-force", -1, "--noise-torque", 1), "finite numbers above 0"),
        ((*EULER, "--tip", "0,0"), "--tip needs 3 finite numbers"),
        ((*EULER, "--mount", "0,0,1", "--estimate-mount"), "contradict"),
        (("--robot", "kuka"), "known: elfin3"),
        ((*EULER, "--orientation-noise", "much"), "give degrees, at least 0, or one of robot, tracker, hand"),
        ((*EULER, "--orientation-noise", "-1"), "give degrees, at least 0"),
        ((*EULER, "--orientation-noise", "nan"), "give degrees, at least 0"),
        ((*EULER, "--down", "0,0,0"), "that are not all 0"),
        ((*EULER, "--down", "0,0"), "--down needs 3 finite numbers"),
        ((*EULER, "--down", "0,nan,1"), "--down needs 3 finite numbers"),
        ((*EULER, "--delay", "auto"), "a table of still poses has no delay"),
        ((*EULER, "--delay", "soon"), "give seconds, or auto"),
    ],
)
def test_wrong_options(tmp_path: Path, poses: Path, options: tuple[object, ...], message: str) -> None:
    result = invoke("calibrate", "fit", poses, *options, "--out", tmp_path / "c.json")
    assert result.exit_code == 2
    assert message in said(result)
    assert not (tmp_path / "c.json").exists()


def test_the_poses_are_not_overwritten(poses: Path) -> None:
    before = poses.read_bytes()
    assert invoke("calibrate", "fit", poses, *EULER, "--out", poses).exit_code == 2
    assert poses.read_bytes() == before


def test_a_wrong_file_leaves_the_earlier_calibration(poses: Path, calibration: Path) -> None:
    before = calibration.read_bytes()
    poses.write_text(
        poses.read_text(encoding="utf-8").replace("\n10.0,", "\nten,").replace("fy", "fyy"), encoding="utf-8"
    )
    result = invoke("calibrate", "fit", poses, *EULER, "--out", calibration, "--json")
    assert result.exit_code == 2
    assert "column fy missing" in json.loads(result.stdout)["error"]
    assert calibration.read_bytes() == before


def test_columns_that_are_not_named_after_their_axes_are_pointed_out(tmp_path: Path) -> None:
    file = write_euler(tmp_path / "zyx.csv", weighed(), "ZYX")
    result = invoke("calibrate", "fit", file, "--euler", "ZYX", "--out", tmp_path / "z.json")
    assert result.exit_code == 0
    assert "column rx is read as the angle about z" in said(result)
    plain = write_euler(tmp_path / "xyz.csv", weighed())
    assert "column rx" not in said(invoke("calibrate", "fit", plain, *EULER, "--out", tmp_path / "x.json"))


# ---- diagnose ------------------------------------------------------------------------------------


def test_transposed_orientations_are_recognised_and_the_remedy_works(tmp_path: Path) -> None:
    file = write_euler(tmp_path / "t.csv", weighed(), transposed=True)
    noise = ("--noise-force", NOISE.force, "--noise-torque", NOISE.torque)
    result = invoke("calibrate", "diagnose", file, *EULER, *noise, "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout)["consistent"] is False
    assert "Pass --inverse" in said(result)
    assert invoke("calibrate", "diagnose", file, *EULER, *noise, "--inverse").exit_code == 0
    assert invoke("calibrate", "fit", file, *EULER, "--inverse", "--out", tmp_path / "t.json").exit_code == 0


def test_orientation_noise_goes_with_the_noise(poses: Path) -> None:
    result = invoke("calibrate", "diagnose", poses, *EULER, "--orientation-noise", "tracker")
    assert result.exit_code == 2
    assert "give --noise-force and --noise-torque too" in said(result)


# ---- verify-still --------------------------------------------------------------------------------


def test_held_out_poses_verify(tmp_path: Path, calibration: Path) -> None:
    rng = np.random.default_rng(7)
    weighing = weigh(TRUTH, Rotation.random(6, rng).as_matrix(), NOISE, rng)
    held_out = write_euler(tmp_path / "held.csv", weighing)
    result = invoke("calibrate", "check", "still", calibration, held_out, *EULER, "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["passed"] is True


def test_another_tool_does_not_verify(tmp_path: Path, calibration: Path) -> None:
    rng = np.random.default_rng(7)
    heavier = type(TRUTH)(1.1 * TRUTH.gravity_W, TRUTH.force_bias, TRUTH.centre_of_mass_S, TRUTH.torque_bias)
    held_out = write_euler(
        tmp_path / "held.csv", weigh(heavier, Rotation.random(6, rng).as_matrix(), NOISE, rng)
    )
    assert invoke("calibrate", "check", "still", calibration, held_out, *EULER).exit_code == 1


# ---- compensate ----------------------------------------------------------------------------------


def test_what_is_left_of_an_untouched_recording_is_noise(tmp_path: Path, calibration: Path) -> None:
    rng = np.random.default_rng(5)
    recording = write_euler(
        tmp_path / "r.csv", weigh(TRUTH, Rotation.random(400, rng).as_matrix(), NOISE, rng)
    )
    out = tmp_path / "w.csv"
    result = invoke("calibrate", "compensate", calibration, recording, *EULER, "--out", out, "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["rows"] == 400
    left = np.loadtxt(out, delimiter=",", skiprows=1)[:, 1:]
    np.testing.assert_allclose(left[:, :3].std(axis=0), NOISE.force, rtol=0.15)
    np.testing.assert_allclose(left[:, 3:].std(axis=0), NOISE.torque, rtol=0.35)


def test_a_file_for_ros_compensates_as_its_calibration_does(
    tmp_path: Path, calibration: Path, poses: Path
) -> None:
    ros, out = tmp_path / "ft_calib.yaml", tmp_path / "w.csv"
    assert invoke("calibrate", "export", calibration, "--out", ros).exit_code == 0
    written = []
    for file, *more in ((calibration,), (ros,), (ros, "--down", "0,0,1")):
        result = invoke("calibrate", "compensate", file, poses, *EULER, *more, "--out", out)
        assert result.exit_code == 0
        assert ("uncertain they are is unknown" in said(result)) == (file == ros)
        written.append(np.loadtxt(out, delimiter=",", skiprows=1))
    np.testing.assert_allclose(written[1], written[0], atol=0.05)  # gravity is taken as vertical
    assert np.abs(written[2] - written[0]).max() > 9
    assert (
        invoke("calibrate", "compensate", calibration, poses, "--down", "0,0,1", "--out", out).exit_code == 2
    )


def test_a_refused_calibration_is_used_with_a_warning(tmp_path: Path, poses: Path) -> None:
    invoke("calibrate", "fit", write_euler(tmp_path / "s.csv", spun()), *EULER, "--out", tmp_path / "s.json")
    assert invoke("calibrate", "export", tmp_path / "s.json", "--out", tmp_path / "s.yaml").exit_code == 1
    assert not (tmp_path / "s.yaml").exists()
    result = invoke(
        "calibrate", "compensate", tmp_path / "s.json", poses, *EULER, "--out", tmp_path / "w.csv"
    )
    assert result.exit_code == 0
    assert "warning:" in said(result)


def test_json_and_dash_contradict(calibration: Path, poses: Path) -> None:
    result = invoke("calibrate", "compensate", calibration, poses, *EULER, "--out", "-", "--json")
    assert result.exit_code == 2


def test_a_tampered_calibration_is_refused(tmp_path: Path, calibration: Path, poses: Path) -> None:
    calibration.write_text(
        calibration.read_text(encoding="utf-8").replace('"mass_kg": 0.6', '"mass_kg": 1.6'), encoding="utf-8"
    )
    result = invoke("calibrate", "compensate", calibration, poses, *EULER, "--out", tmp_path / "w.csv")
    assert result.exit_code == 2
    assert not (tmp_path / "w.csv").exists()
