"""Any arm from a file: the same flange as MuJoCo's own, limits, names, and files that are no arm."""

import os

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.suggest import by_robot
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
    for q in np.random.default_rng(1).uniform(-2, 2, (20, 6)):
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


def test_a_joint_that_does_not_turn_makes_no_earlier_link_the_flange(file):
    slide = '<joint name="mount" type="fixed"><parent link="flange"/>'
    assert slide in URDF
    for kind in ("prismatic", "planar"):
        moved = URDF.replace(slide, slide.replace("fixed", kind))
        with pytest.raises(
            InputError, match=r"between the base and tool0 there are .* joints that do not turn"
        ):
            Robot.named(file(moved, f"{kind}.urdf"))
        assert len(Robot.named(file(moved, f"{kind}.urdf") + "@flange").lower) == 6
    nameless = MJCF.replace(
        '<site name="attachment_site" pos="0 0 0.1" euler="0 30 0"/>',
        '<body name="z"><joint type="slide"/></body>',
    )
    with pytest.raises(InputError, match="Name it"):
        Robot.named(file(nameless, "slide.xml"))


LIMITS = 'lower="-2.5" upper="2"'


@pytest.mark.parametrize(
    ("limits", "part"),
    [
        ('lower="2" upper="-2"', "joint pan: its limits are 2 to -2"),
        ('lower="1" upper="1"', "joint pan: its limits are 1 to 1"),
        ("", "joint pan: its limits are 0 to 0"),
        ('lower="-180" upper="180"', "joint pan: .* if they are degrees, give them in radians"),
        ('lower="nan" upper="2"', "<limit> has lower='nan': every number must be finite"),
    ],
)
def test_limits_that_cannot_be_are_refused_with_the_joint_s_name(file, limits, part, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=part):
        Robot.named(file(URDF.replace(LIMITS, limits, 1)))
    assert not (tmp_path / "MUJOCO_LOG.TXT").exists()


def test_limits_in_degrees_of_an_mjcf_in_radians_are_refused(file):
    with pytest.raises(InputError, match=r"two\.xml: joint a: .* if they are degrees"):
        Robot.named(file(MJCF.replace('angle="degree"', 'angle="radian"'), "two.xml"))


@pytest.mark.parametrize(
    "coupling",
    [
        '<joint joint1="b" joint2="a"/>',
        '<joint joint1="b"/>',
        '<connect body1="lower" body2="base" anchor="0 0 0"/>',
    ],
)
def test_coupled_joints_of_the_arm_are_refused(file, coupling):
    def coupled(inner):
        return MJCF.replace("<actuator>", f"<equality>{inner}</equality><actuator>")

    with pytest.raises(InputError, match=r": (b|lower) is coupled to another"):
        Robot.named(file(coupled(coupling), "two.xml"))
    assert Robot.named(file(coupled(coupling.replace("/>", ' active="false"/>')), "free.xml"))


def test_a_mimicking_joint_is_refused_in_the_arm_and_not_in_its_gripper(file):
    mimic = '<mimic joint="pan"/></joint>'
    before, after = URDF.split('<joint name="elbow"')
    with pytest.raises(InputError, match=": elbow is coupled"):
        Robot.named(file(before + '<joint name="elbow"' + after.replace("</joint>", mimic, 1)))
    before, after = URDF.split('<joint name="grip"')
    assert (
        len(
            Robot.named(
                file(before + '<joint name="grip"' + after.replace("</joint>", mimic, 1), "g.urdf")
            ).lower
        )
        == 6
    )


def test_numbers_are_finite_and_positions_in_metres(file):
    with pytest.raises(InputError, match="<axis> has xyz='nan 0 1': every number must be finite"):
        Robot.named(file(URDF.replace('<axis xyz="0 0 1"/>', '<axis xyz="nan 0 1"/>')))
    with pytest.raises(InputError, match="more than 100 m"):
        Robot.named(file(URDF.replace('xyz="0.4 0 0"', 'xyz="400 0 0"')))
    with pytest.raises(InputError):
        Robot.named(file(URDF.replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0 0"/>'), "zero.urdf"))


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-32"])
def test_a_document_type_cannot_hide_in_an_encoding(tmp_path, encoding):
    path = tmp_path / "a.urdf"
    path.write_bytes('<!DOCTYPE r [<!ENTITY a "b">]><robot name="&a;"/>'.encode(encoding))
    with pytest.raises(InputError, match="it is not UTF-8 text"):
        Robot.named(str(path))


def test_a_pipe_is_no_robot(tmp_path):
    os.mkfifo(tmp_path / "a.urdf")
    with pytest.raises(InputError, match="it is no file"):
        Robot.named(str(tmp_path / "a.urdf"))


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
        (
            "many.xml",
            '<mujoco><worldbody><replicate count="9999999"><body/></replicate></worldbody></mujoco>',
            "multiplies bodies",
        ),
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
