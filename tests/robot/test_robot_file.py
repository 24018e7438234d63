"""Any arm from a file: the same flange as MuJoCo's own, limits, names, and files that are no arm."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.reachable import by_robot
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.robot.robot_file import names_file

mujoco = pytest.importorskip("mujoco", reason="robots' files are read by MuJoCo (extra sim)")

LINKS = "".join(
    f"""
  <link name="l{n}">
    <inertial><mass value="{3 - 0.4 * n}"/>
      <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://arm/l{n}.dae"/></geometry></visual>
    <collision><geometry><mesh filename="package://arm/l{n}.stl"/></geometry></collision>
  </link>"""
    for n in range(1, 7)
)


def joint(number, kind, parent, child, xyz, rpy, axis):
    limit = "" if kind == "continuous" else '<limit lower="-2.5" upper="2" effort="50" velocity="1.5"/>'
    return f"""
  <joint name="{number}" type="{kind}">
    <parent link="{parent}"/><child link="{child}"/>
    <origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{limit}
  </joint>"""


URDF = f"""<?xml version="1.0"?>
<robot name="arm">
  <link name="base_link"/>{LINKS}<link name="tool0"/><link name="flange"/><link name="finger"/>
  {joint("pan", "revolute", "base_link", "l1", "0 0 0.3", "0 0 0.4", "0 0 1")}
  {joint("lift", "revolute", "l1", "l2", "0 0.1 0", "1.2 0 0", "0 1 0")}
  {joint("elbow", "revolute", "l2", "l3", "0.4 0 0", "0 0.3 0", "0 -1 0")}
  {joint("w1", "revolute", "l3", "l4", "0.35 0 0.02", "0 0 0", "0.6 0 0.8")}
  {joint("w2", "continuous", "l4", "l5", "0 0.09 0", "0 0 0.5", "1 0 0")}
  {joint("w3", "revolute", "l5", "l6", "0.05 0 0.09", "0 0 0", "0 0 -1")}
  <joint name="fixed" type="fixed"><parent link="l6"/><child link="flange"/>
    <origin xyz="0 0 0.08" rpy="0 -1.5708 0"/></joint>
  <joint name="mount" type="fixed"><parent link="flange"/><child link="tool0"/>
    <origin xyz="0.01 0 0" rpy="0 1.5708 0.3"/></joint>
  <joint name="grip" type="prismatic"><parent link="l6"/><child link="finger"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.04" effort="10" velocity="0.1"/></joint>
</robot>
"""
MJCF = """<mujoco model="two">
  <compiler angle="degree" meshdir="assets"/>
  <asset><mesh name="m" file="missing.obj"/></asset>
  <default><joint axis="0 1 0" range="-90 120" limited="true"/></default>
  <worldbody>
    <body name="base" pos="0 0 0.1" euler="0 0 90">
      <body name="upper" pos="0 0 0.2"><joint name="a" pos="0.05 0 0"/><geom type="mesh" mesh="m"/>
        <body name="lower" pos="0.3 0 0"><joint name="b" axis="0 0 1"/>
          <geom type="sphere" size="0.1"/><site name="attachment_site" pos="0 0 0.1" euler="0 30 0"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator><motor joint="a"/></actuator>
</mujoco>
"""


@pytest.fixture
def file(tmp_path):
    def write(text, name="arm.urdf"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return str(path)

    return write


def urdf_flange(q):
    """Return the pose of tool0 by the URDF's own rules, joint by joint."""
    chain = [
        ("0 0 0.3", "0 0 0.4", "0 0 1"), ("0 0.1 0", "1.2 0 0", "0 1 0"), ("0.4 0 0", "0 0.3 0", "0 -1 0"),
        ("0.35 0 0.02", "0 0 0", "0.6 0 0.8"), ("0 0.09 0", "0 0 0.5", "1 0 0"), ("0.05 0 0.09", "0 0 0", "0 0 -1"),
        ("0 0 0.08", "0 -1.5708 0", None), ("0.01 0 0", "0 1.5708 0.3", None),
    ]  # fmt: skip
    R, p = Rotation.identity(), np.zeros(3)
    for (xyz, rpy, axis), angle in zip(chain, [*q, 0.0, 0.0], strict=True):
        p = p + R.apply(np.fromstring(xyz, sep=" "))
        R = R * Rotation.from_euler("xyz", np.fromstring(rpy, sep=" "))
        if axis is not None:
            R = R * Rotation.from_rotvec(angle * np.fromstring(axis, sep=" "))
    return R.as_matrix(), p


def test_the_flange_of_a_urdf_is_where_its_joints_take_it(file):
    robot = Robot.named(file(URDF))
    assert robot.description.name == "arm@tool0"
    rng = np.random.default_rng(1)
    for q in rng.uniform(-2, 2, (20, 6)):
        R_BE, p_BE_B = robot.flange_pose(q)
        R, p = urdf_flange(q)
        assert pytest.approx(R, abs=1e-9) == R_BE
        assert p_BE_B == pytest.approx(p, abs=1e-9)


def test_limits_speeds_and_masses_are_the_file_s(file):
    robot = Robot.named(file(URDF))
    assert [each.name for each in robot.description.joints] == ["pan", "lift", "elbow", "w1", "w2", "w3"]
    assert robot.lower == pytest.approx([-2.5, -2.5, -2.5, -2.5, -2 * np.pi, -2.5])
    assert robot.upper[0] == 2.0
    assert robot.velocity_limits == pytest.approx([1.5, 1.5, 1.5, 1.5, 1.0, 1.5])
    assert robot.description.joints[0].child_mass == pytest.approx(2.6)
    assert robot.description.joints[0].effort == 50.0


def test_a_frame_may_be_named(file):
    path = file(URDF)
    R_tool, p_tool = Robot.named(path).flange_pose(np.zeros(6))
    R, p = Robot.named(f"{path}@flange").flange_pose(np.zeros(6))
    turned = Rotation.from_euler("xyz", [0, 1.5708, 0.3]).as_matrix()
    assert R_tool == pytest.approx(R @ turned, abs=1e-9)
    assert p_tool == pytest.approx(p + R @ [0.01, 0, 0], abs=1e-9)
    with pytest.raises(InputError, match=r"no frame 'hand'\. Possible: flange, l1, .*tool0"):
        Robot.named(f"{path}@hand")
    with pytest.raises(InputError, match="joints that do not turn"):
        Robot.named(f"{path}@finger")


def test_several_frames_at_the_end_are_not_guessed(file):
    nameless = URDF.replace("tool0", "probe").replace('"flange"', '"plate"')
    with pytest.raises(InputError, match=r"Name it: arm\.urdf@FRAME, with one of l6, plate, probe\."):
        Robot.named(file(nameless))


def test_mjcf_with_its_defaults_degrees_and_site(file):
    robot = Robot.named(file(MJCF, "two.xml"))
    assert robot.lower == pytest.approx(np.radians([-90, -90]))
    model = mujoco.MjModel.from_xml_string(
        MJCF.replace('<asset><mesh name="m" file="missing.obj"/></asset>', "").replace(
            '<geom type="mesh" mesh="m"/>', '<geom type="sphere" size="0.1"/>'
        )
    )
    data = mujoco.MjData(model)
    for q in np.random.default_rng(2).uniform(-1.5, 1.5, (10, 2)):
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        R_BE, p_BE_B = robot.flange_pose(q)
        assert pytest.approx(data.site("attachment_site").xmat.reshape(3, 3), abs=1e-9) == R_BE
        assert p_BE_B == pytest.approx(data.site("attachment_site").xpos, abs=1e-9)


def test_poses_are_planned_for_an_arm_of_a_file(file):
    robot = Robot.named(file(URDF))
    reachable = by_robot(robot, np.array([0.2, -0.9, 0.8, 0.3, 0.4, 0.1]), count=40)
    assert len(reachable) >= 12
    assert robot.within_limits(reachable.joints).all()


@pytest.mark.parametrize(
    ("name", "text", "part"),
    [
        ("a.urdf", "", "not XML"),
        ("a.urdf", "<html/>", "begins with <html>"),
        ("a.urdf", '<!DOCTYPE r [<!ENTITY a "b">]><robot name="&a;"/>', "document type"),
        ("a.urdf", '<robot name="a"><link name="b"/></robot>', "no joint that turns"),
        ("a.urdf", '<robot name="a"><link/></robot>', "a link has no name"),
        ("a.urdf", '<robot name="a"><joint name="j" type="revolute"/></robot>', "MuJoCo can read"),
        ("a.xml", '<mujoco><include file="b.xml"/></mujoco>', "includes other files"),
        ("a.xml", "<mujoco><worldbody><body/></worldbody></mujoco>", "no joint that turns"),
        ("a.xacro", "<robot/>", "run xacro first"),
        ("deep.xml", f"<mujoco>{'<body>' * 20_000}{'</body>' * 20_000}</mujoco>", "MuJoCo can read"),
    ],
    ids=lambda value: value[:20],
)
def test_what_is_no_arm_is_refused_by_name(file, name, text, part):
    with pytest.raises(InputError, match=part) as failed:
        Robot.named(file(text, name))
    assert name in str(failed.value)


def test_a_file_that_is_not_there_and_one_that_has_changed(file):
    with pytest.raises(InputError, match="No such file"):
        Robot.named("/nowhere/arm.urdf")
    assert len(Robot.named(file(URDF)).lower) == 6
    assert len(Robot.named(file(MJCF, "arm.xml")).lower) == 2
    assert names_file("C:/robots/ur5e.URDF@tool0")
    assert not names_file("elfin3")
