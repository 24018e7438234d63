"""Limits, travel times, descriptions that make no sense, and life without MuJoCo."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import (
    ELFIN3,
    ROBOTS,
    Capsule,
    Clearance,
    ClearanceCheck,
    Joint,
    Robot,
    RobotDescription,
)

ROBOT = Robot(ELFIN3)
inside = st.tuples(*(st.floats(joint.lower, joint.upper) for joint in ELFIN3.joints)).map(np.array)


def test_known_robots_are_found_by_name():
    assert Robot.named("elfin3").description is ELFIN3 is ROBOTS["elfin3"]
    with pytest.raises(InputError, match="'elfin33'; known: elfin3"):
        Robot.named("elfin33")


def test_limits_are_those_of_the_data_and_read_only():
    np.testing.assert_array_equal(ROBOT.lower, [-3.14, -2.35, -2.61, -3.14, -2.56, -3.14])
    np.testing.assert_array_equal(ROBOT.upper, -ROBOT.lower)
    np.testing.assert_array_equal(ROBOT.velocity_limits, [1.57, 1.27, 1.57, 1.57, 1.57, 1.57])
    np.testing.assert_array_equal(ROBOT.acceleration_limits, [12.56] * 6)
    for each in (ROBOT.lower, ROBOT.acceleration_limits):
        with pytest.raises(ValueError, match="read-only"):
            each[0] = 0


def test_an_acceleration_that_is_not_known_is_no_limit():
    unknown = replace(_J, acceleration=np.inf)
    assert (
        Robot(replace(ELFIN3, joints=(unknown,), capsules=(), never_touch=())).acceleration_limits == np.inf
    )


def test_the_inertia_of_a_link_is_symmetric_and_about_its_centre_of_mass():
    joint = ELFIN3.joints[3]
    np.testing.assert_array_equal(joint.inertia_matrix, joint.inertia_matrix.T)
    np.testing.assert_allclose(np.diag(joint.inertia_matrix), [7.169e-3, 5.863e-3, 2.296e-3])
    assert joint.inertia_matrix[1, 2] == pytest.approx(2.083e-3)
    # Nothing known: a ball of 0.1 m.
    ball = replace(joint, inertia=None).inertia_matrix
    np.testing.assert_allclose(ball, 0.4 * joint.child_mass * 0.01 * np.eye(3))


@given(q=inside)
def test_angles_inside_pass(q):
    assert ROBOT.within_limits(q)
    np.testing.assert_array_equal(ROBOT.check_joints(q), q)


@given(q=inside, i=st.integers(0, 5), beyond=st.floats(1e-9, 3), up=st.booleans())
def test_one_joint_outside_is_named_with_value_and_limits(q, i, beyond, up):
    q[i] = ROBOT.upper[i] + beyond if up else ROBOT.lower[i] - beyond
    assert not ROBOT.within_limits(q)
    with pytest.raises(InputError) as caught:
        ROBOT.check_joints(q, "poses.csv, line 3")
    message = str(caught.value)
    assert message.startswith(
        f"poses.csv, line 3: joint J{i + 1} is at {q[i]:.4f} rad ({np.degrees(q[i]):.2f}°)"
    )
    assert f"{ROBOT.lower[i]:.4f} .. {ROBOT.upper[i]:.4f} rad" in message
    assert f"{np.degrees(ROBOT.lower[i]):.2f}° .. {np.degrees(ROBOT.upper[i]):.2f}°" in message


def test_degrees_are_suspected():
    with pytest.raises(InputError, match="check whether these are degrees"):
        ROBOT.check_joints([0, 0, 90, 0, 90, 0])


def test_a_margin_narrows_or_widens():
    assert ROBOT.within_limits(ROBOT.upper)
    assert not ROBOT.within_limits(ROBOT.upper, margin=0.01)
    assert ROBOT.within_limits([np.pi, 0, 0, 0, 0, 0], margin=-0.01)
    assert ROBOT.within_limits([[ROBOT.upper, ROBOT.upper + 1]]).tolist() == [[True, False]]


@pytest.mark.parametrize("bad", [[0] * 5, 1.0, [0, 0, 0, 0, 0, np.nan]])
def test_unusable_angles_are_refused(bad):
    with pytest.raises(InputError, match="line 7: joint angles"):
        ROBOT.check_joints(bad, "line 7")
    with pytest.raises(InputError, match="joint angles"):
        ROBOT.within_limits(bad)
    with pytest.raises(InputError, match="joint angles"):
        ROBOT.travel(bad, np.zeros(6))


def test_the_slowest_joint_decides_the_travel_time():
    assert ROBOT.travel(np.zeros(6), [1.57, 0, 0, 0, 0, 0]) == pytest.approx(1.0)
    assert ROBOT.travel(np.zeros(6), [1.57, 1.57, 0, 0, 0, 0]) == pytest.approx(1.57 / 1.27)
    assert ROBOT.travel(np.zeros((3, 1, 6)), np.ones((4, 6))).shape == (3, 4)
    with pytest.raises(InputError, match="broadcast"):
        ROBOT.travel(np.zeros((3, 6)), np.zeros((2, 6)))


@given(a=inside, b=inside, c=inside)
def test_travel_is_a_metric(a, b, c):
    assert ROBOT.travel(a, a) == 0
    assert ROBOT.travel(a, b) == ROBOT.travel(b, a)
    assert ROBOT.travel(a, c) <= ROBOT.travel(a, b) + ROBOT.travel(b, c) + 1e-12


_J = ELFIN3.joints[0]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: replace(_J, lower=1.0, upper=1.0), "joint J1: limits"),
        (lambda: replace(_J, upper=np.nan), "joint J1: limits"),
        (lambda: replace(_J, velocity=0.0), "velocity must be finite and above 0"),
        (lambda: replace(_J, child_mass=-1.0), "child_mass"),
        (lambda: replace(_J, effort=np.inf), "effort"),
        (lambda: replace(_J, acceleration=np.nan), "acceleration must be above 0"),
        (lambda: replace(_J, acceleration=0.0), "acceleration must be above 0"),
        (lambda: replace(_J, centre_xyz=(0, 0, np.nan)), "centre_xyz must be three finite numbers"),
        (lambda: replace(_J, inertia=(1, 1, 1)), "inertia must be six"),
        (lambda: replace(_J, inertia=(1, 1, 3, 0, 0, 0)), "physically impossible"),
        (lambda: replace(_J, inertia=(1, 1, 1, 2, 0, 0)), "physically impossible"),
        (lambda: replace(_J, origin_xyz=(0, 0)), "origin_xyz must be three finite numbers"),
        (lambda: Capsule("rod", 1, (0, 0, 1), (0, 0, 1), 0.1), "must differ"),
        (lambda: Capsule("rod", 1, (0, 0, 0), (0, 0, 1), 0.0), "radius"),
        (lambda: RobotDescription("none", (), (0, 0, 0)), "at least one joint"),
        (lambda: RobotDescription("twins", (_J, _J), (0, 0, 0)), "J1 is given twice"),
        (lambda: replace(ELFIN3, capsules=(Capsule("rod", 7, (0, 0, 0), (0, 0, 1), 0.1),)), "body 7"),
        (lambda: replace(ELFIN3, capsules=(Capsule("tool", 6, (0, 0, 0), (0, 0, 1), 0.1),)), "tool"),
        (lambda: replace(ELFIN3, never_touch=(("base", "nose"),)), "nose"),
        (lambda: Clearance(p_ET_E=(0, 0, np.nan)), "p_ET_E"),
        (lambda: Clearance(tool_radius=0.0), "tool_radius"),
        (lambda: Clearance(z_min=np.nan), "z_min"),
        (lambda: Clearance(distance=-0.01), "distance"),
        (lambda: ClearanceCheck(replace(ELFIN3, capsules=(), never_touch=()), Clearance()), "no capsules"),
    ],
)
def test_impossible_data_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_joints_of_any_kind_of_number_are_taken():
    assert Joint("J", (0, 0, 0), (0, 0, 0), np.float32(-1), 1, 1, 1, 1).lower == -1


def test_without_mujoco_the_remedy_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    robot = Robot(ELFIN3)
    assert robot.within_limits(np.zeros(6))
    for call in (
        lambda: robot.flange_pose(np.zeros(6)),
        lambda: robot.flange_rotations(np.zeros((2, 6))),
        lambda: robot.flange_jacobian(np.zeros(6)),
        lambda: robot.candidate_joints(np.zeros(6)),
    ):
        with pytest.raises(InputError, match=r"MuJoCo.*pip install 'contactbench\[sim\]'"):
            call()


def test_importing_the_package_leaves_mujoco_alone():
    code = (
        "import sys, contactbench.pipeline.robot as r; r.Robot.named('elfin3').travel([0] * 6, [1] * 6); "
        "sys.exit('mujoco' in sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
