"""Flange poses against the manufacturer's chain written three other ways, Jacobians against differences."""

from concurrent.futures import ThreadPoolExecutor
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import ELFIN3, Joint, Robot, RobotDescription
from contactbench.pipeline.robot.model import mjcf

mujoco = pytest.importorskip("mujoco")

_TURN = 2 * pi
joints = st.lists(st.floats(-_TURN, _TURN), min_size=6, max_size=6).map(np.array)

# offset, d, a, alpha of each joint; standard convention.
_DENAVIT_HARTENBERG = (
    (0, 0.1925, 0, pi / 2),
    (pi / 2, 0, 0.266, pi),
    (pi / 2, 0, 0, pi / 2),
    (0, 0.324, 0, -pi / 2),
    (0, 0, 0, pi / 2),
    (0, 0.155, 0, 0),
)

# Axis and a point on it, m, of each joint in the zero pose.
_SCREWS = (
    ((0, 0, 1), (0, 0, 0.1925)),
    ((0, -1, 0), (0, 0, 0.1925)),
    ((0, 1, 0), (0, 0, 0.4585)),
    ((0, 0, 1), (0, 0, 0.4585)),
    ((0, 1, 0), (0, 0, 0.7825)),
    ((0, 0, 1), (0, 0, 0.7825)),
)


def denavit_hartenberg(q) -> np.ndarray:
    X = np.eye(4)
    for angle, (offset, d, a, alpha) in zip(q, _DENAVIT_HARTENBERG, strict=True):
        c, s, ca, sa = np.cos(angle + offset), np.sin(angle + offset), np.cos(alpha), np.sin(alpha)
        X = X @ np.array(
            [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
        )
    return X


@pytest.mark.parametrize(
    ("q", "p_BE_B", "R_BE"),
    [
        ((0, 0, 0, 0, 0, 0), (0, 0, 0.9375), np.eye(3)),
        ((0, 0, pi / 2, 0, pi / 2, 0), (0.324, 0, 0.3035), np.diag([-1, 1, -1])),
        (
            (0.3, -0.4, 1.1, 0.5, -0.7, 0.9),
            (0.528910, 0.113500, 0.556217),
            [
                [0.113915, -0.612884, 0.781919],
                [0.993402, 0.080768, -0.081418],
                [-0.013254, 0.786034, 0.618041],
            ],
        ),
        ((0, pi / 6, 0, 0, 0, 0), (-0.3725, 0, 0.837689), None),
        ((0, 0, pi / 6, 0, 0, 0), (0.2395, 0, 0.873326), None),
        ((0, 0, 0, 0, pi / 6, 0), (0.0775, 0, 0.916734), None),
    ],
)
def test_elfin3_stands_where_it_should(elfin, q, p_BE_B, R_BE):
    R, p = elfin.flange_pose(q)
    np.testing.assert_allclose(p, p_BE_B, rtol=0, atol=6e-7)
    if R_BE is not None:
        np.testing.assert_allclose(R, R_BE, rtol=0, atol=6e-7)


@given(q=joints)
def test_flange_follows_denavit_and_hartenberg(elfin, q):
    R_BE, p_BE_B = elfin.flange_pose(q)
    X_BE = denavit_hartenberg(q)
    np.testing.assert_allclose(R_BE, X_BE[:3, :3], rtol=0, atol=1e-12)
    np.testing.assert_allclose(p_BE_B, X_BE[:3, 3], rtol=0, atol=1e-12)


@given(q=joints)
def test_flange_follows_the_description(elfin, link_poses, q):
    R_BE, p_BE_B = elfin.flange_pose(q)
    X_BE = link_poses(ELFIN3, q)[-1]
    np.testing.assert_allclose(R_BE, X_BE[:3, :3], rtol=0, atol=1e-12)
    np.testing.assert_allclose(p_BE_B, X_BE[:3, 3], rtol=0, atol=1e-12)


@given(q=joints)
def test_orientations_are_rotations(elfin, q):
    R_BE, _ = elfin.flange_pose(q)
    np.testing.assert_allclose(R_BE @ R_BE.T, np.eye(3), rtol=0, atol=1e-14)
    assert np.linalg.det(R_BE) == pytest.approx(1, abs=1e-14)


@given(Q=st.lists(joints, max_size=5))
def test_a_batch_repeats_single_poses_to_the_bit(elfin, Q):
    R_BE = elfin.flange_rotations(np.reshape(Q, (-1, 6)))
    assert R_BE.shape == (len(Q), 3, 3)
    for R, q in zip(R_BE, Q, strict=True):
        np.testing.assert_array_equal(R, elfin.flange_pose(q)[0])


def test_results_are_copies(elfin):
    R_BE, p_BE_B = elfin.flange_pose(np.zeros(6))
    elfin.flange_pose(np.ones(6))
    np.testing.assert_allclose(R_BE, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(p_BE_B, [0, 0, 0.9375], atol=1e-15)


def test_jacobian_in_the_zero_pose_is_the_screws(elfin):
    expected = [np.hstack([np.cross(w, np.subtract([0, 0, 0.9375], p)), w]) for w, p in _SCREWS]
    np.testing.assert_allclose(elfin.flange_jacobian(np.zeros(6)), np.transpose(expected), rtol=0, atol=1e-14)


@given(q=joints)
def test_jacobian_is_the_derivative_of_the_pose(elfin, q):
    J, h = elfin.flange_jacobian(q), 1e-6
    R_BE, _ = elfin.flange_pose(q)
    for i in range(6):
        step = h * np.eye(6)[i]
        (R_after, p_after), (R_before, p_before) = elfin.flange_pose(q + step), elfin.flange_pose(q - step)
        turning = (R_after - R_before) / (2 * h) @ R_BE.T
        np.testing.assert_allclose(J[:3, i], (p_after - p_before) / (2 * h), rtol=0, atol=2e-9)
        np.testing.assert_allclose(J[3:, i], [turning[2, 1], turning[0, 2], turning[1, 0]], rtol=0, atol=2e-9)


@given(q=joints)
def test_wrist_joints_leave_the_wrist_centre_alone(elfin, q):
    J = elfin.flange_jacobian(q)
    R_BE, _ = elfin.flange_pose(q)
    # The centre of the spherical wrist lies 155 mm behind the flange.
    v = J[:3, 3:] + np.cross(J[3:, 3:].T, -0.155 * R_BE[:, 2]).T
    np.testing.assert_allclose(v, 0, atol=1e-14)


def test_threads_share_a_robot(elfin):
    Q = np.random.default_rng(5).uniform(elfin.lower, elfin.upper, (400, 6))
    expected = [elfin.flange_pose(q) for q in Q]
    with ThreadPoolExecutor(8) as pool:
        for (R, p), (R_BE, p_BE_B) in zip(pool.map(elfin.flange_pose, Q, chunksize=1), expected, strict=True):
            np.testing.assert_array_equal(R, R_BE)
            np.testing.assert_array_equal(p, p_BE_B)


def test_the_model_keeps_every_bit_of_the_data():
    model = mujoco.MjModel.from_xml_string(mjcf(ELFIN3))
    np.testing.assert_array_equal(model.body_pos[1:], [joint.origin_xyz for joint in ELFIN3.joints])
    np.testing.assert_allclose(np.linalg.norm(model.body_quat, axis=1), 1, rtol=0, atol=3e-16)
    np.testing.assert_array_equal(model.body_mass[1:], [joint.child_mass for joint in ELFIN3.joints])


def test_other_arms_have_other_numbers_of_joints(link_poses):
    # Seven joints, a name that XML would trip over, and a flange that is turned as well as moved.
    arm = RobotDescription(
        name='seven <&"> joints',
        joints=tuple(
            Joint(f"J{i}", (0.01 * i, 0.1, -0.2), (0.3 * i, -1.0, 0.2), -3, 3, 1, 50, 2) for i in range(7)
        ),
        flange_xyz=(0.1, 0.02, 0.003),
        flange_rpy=(0.4, -0.5, 2.6),
    )
    robot, q = Robot(arm), np.linspace(-2, 2, 7)
    R_BE, p_BE_B = robot.flange_pose(q)
    X_BE = link_poses(arm, q)[-1]
    np.testing.assert_allclose(R_BE, X_BE[:3, :3], rtol=0, atol=1e-12)
    np.testing.assert_allclose(p_BE_B, X_BE[:3, 3], rtol=0, atol=1e-12)
    assert robot.flange_jacobian(q).shape == (6, 7)


@pytest.mark.parametrize("bad", [np.zeros(5), np.zeros((1, 6)), 0.0, [0, 0, 0, 0, 0, np.nan], [np.inf] * 6])
def test_unusable_angles_are_refused(elfin, bad):
    with pytest.raises(InputError, match="joint angles"):
        elfin.flange_pose(bad)
    with pytest.raises(InputError, match="joint angles"):
        elfin.flange_jacobian(bad)


def test_a_batch_needs_two_axes(elfin):
    with pytest.raises(InputError, match=r"shape \(m, 6\), not \(6,\)"):
        elfin.flange_rotations(np.zeros(6))
