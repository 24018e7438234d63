"""next-pose and plan-poses."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from terminal import invoke, said
from weighing_files import NOISE, TRUTH, spun, write_euler

from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.simulation.loads import weigh

ARM = ("--robot", "elfin3", "--joints", "0,-17,69,0,52,0")


@pytest.fixture
def blind(tmp_path: Path) -> Path:
    file = write_euler(tmp_path / "s.csv", spun())
    assert invoke("calibrate", "fit", file, "--euler", "xyz", "--out", tmp_path / "s.json").exit_code == 1
    return tmp_path / "s.json"


def test_the_next_pose_of_a_blind_set_tilts(blind: Path) -> None:
    result = invoke("calibrate", "next", blind, "--json")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    w, x, y, z = found["quaternion_WS"]
    down_S = -Rotation.from_quat([x, y, z, w]).as_matrix()[2]
    before = -spun().poses[0].R_WS[2]
    assert np.degrees(np.arccos(down_S @ before)) > 30
    assert found["joints_deg"] is None
    assert found["contact_error_after_mm"] < found["contact_error_before_mm"]
    assert said(result).startswith("Next: ")


def test_the_next_pose_of_a_robot_is_within_its_limits(blind: Path) -> None:
    found = json.loads(invoke("calibrate", "next", blind, *ARM, "--json").stdout)
    joints = np.radians(found["joints_deg"])
    assert Robot.named("elfin3").within_limits(joints)
    np.testing.assert_allclose(np.degrees(joints[:3]), [0, -17, 69])  # only the wrist moves


def test_a_plan_leads_to_the_error_that_it_predicts(tmp_path: Path) -> None:
    out = tmp_path / "plan.csv"
    result = invoke("calibrate", "plan", 6, *ARM, "--out", out, "--json")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    text = out.read_text(encoding="utf-8").splitlines()
    assert text[0] == "name,qw,qx,qy,qz,j1,j2,j3,j4,j5,j6,contact_error_mm"
    assert len(text) == 7
    cells = np.array([[float(cell) for cell in row.split(",")[1:]] for row in text[1:]])
    R_WS = Rotation.from_quat(np.roll(cells[:, :4], -1, axis=1)).as_matrix()
    np.testing.assert_allclose(
        Robot.named("elfin3").flange_rotations(np.radians(cells[:, 4:10])), R_WS, atol=1e-9
    )
    weighing = weigh(TRUTH, R_WS, NOISE, np.random.default_rng(0))
    measured = 1e3 * calibrate(weighing.poses, NOISE).contact_error
    assert measured == pytest.approx(found["contact_error_mm"][-1], rel=0.15)


@pytest.mark.parametrize("down", ["0,0,-1", "0,0,1", "3,0,0"])
def test_plans_and_tilts_count_from_down(tmp_path: Path, down: str) -> None:
    result = invoke(
        "calibrate", "plan", 6, "--max-tilt", 40, "--down", down, "--out", tmp_path / "plan.csv", "--json"
    )
    found = json.loads(result.stdout)
    R_WS = Rotation.from_quat(np.roll(found["quaternions_WS"], -1, axis=1)).as_matrix()
    direction = np.array(list(map(float, down.split(","))))
    tilts = np.degrees(np.arccos(R_WS[:, :, 2] @ direction / np.linalg.norm(direction)))
    assert tilts.max() < 40.1
    assert tilts.max() > 20
    hanging = replace(TRUTH, gravity_W=TRUTH.mass * STANDARD_GRAVITY * direction / np.linalg.norm(direction))
    poses = weigh(hanging, R_WS, NOISE, np.random.default_rng(0)).poses
    measured = 1e3 * calibrate(poses, NOISE, orientation_sigma=0.0, down_W=direction).contact_error
    assert measured == pytest.approx(found["contact_error_mm"][-1], rel=0.25)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((2,), "a plan has 3 to 60 poses"),
        ((6, "--robot", "elfin3"), "Give both --robot and --joints"),
        ((6, "--robot", "kuka", "--joints", "0,0,0,0,0,0"), "known: elfin3"),
        ((6, "--robot", "elfin3", "--joints", "0,0,0,0,200,0"), "outside its limits"),
        ((6, "--robot", "elfin3", "--joints", "0,0"), "--joints needs 6"),
        ((6, "--max-tilt", 0), "largest tilt"),
        ((6, "--mass", 0), "not the mass of a tool"),
        ((6, "--down", "0,0,0"), "has no direction"),
    ],
)
def test_wrong_arguments(tmp_path: Path, arguments: tuple[object, ...], message: str) -> None:
    result = invoke("calibrate", "plan", *arguments, "--out", tmp_path / "p.csv")
    assert result.exit_code == 2
    assert message in said(result)
    assert not (tmp_path / "p.csv").exists()


def test_a_plan_has_as_many_joints_as_the_arm_of_a_file(tmp_path: Path) -> None:
    arm, out = tmp_path / "arm.xml", tmp_path / "plan.csv"
    bodies, ends = "", ""
    for number, axis in enumerate(("0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0", "0 0 1")):
        bodies += f'<body pos="0 0 0.2"><joint name="a{number}" axis="{axis}" range="-2 2" limited="true"/>'
        ends += "</body>"
    arm.write_text(
        f'<mujoco><compiler angle="radian"/><worldbody>{bodies}<site name="attachment_site"/>{ends}'
        "</worldbody></mujoco>"
    )
    joints = "0,20,40,0,30,0,0"
    result = invoke("calibrate", "plan", 6, "--robot", arm, "--joints", joints, "--out", out)
    assert result.exit_code == 0, said(result)
    header, *rows = out.read_text(encoding="utf-8").splitlines()
    assert header == "name,qw,qx,qy,qz,j1,j2,j3,j4,j5,j6,j7,contact_error_mm"
    cells = np.array([[float(cell) for cell in row.split(",")[1:]] for row in rows])
    R_WS = Rotation.from_quat(np.roll(cells[:, :4], -1, axis=1)).as_matrix()
    found = Robot.named(str(arm)).flange_rotations(np.radians(cells[:, 4:11]))
    np.testing.assert_allclose(found, R_WS, atol=1e-9)
