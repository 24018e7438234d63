import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.control.inverse import CartesianMount, MotionLimit, solve_step, tip_jacobian
from contactbench.pipeline.control.upright import pressing, turn_of

LEVER = np.array([0.01, -0.02, -0.14])


def numeric(arm, q, place_E):
    """Velocity of a place that E carries and of its frame, by differences."""

    def pose(values):
        R, p = arm.flange_pose(values)
        return R, p + R @ place_E

    columns = []
    for axis in np.eye(len(q)):
        (R1, p1), (R0, p0) = pose(q + 1e-6 * axis), pose(q - 1e-6 * axis)
        columns.append(np.r_[(p1 - p0) / 2e-6, Rotation.from_matrix(R1 @ R0.T).as_rotvec() / 2e-6])
    return np.array(columns).T


def test_the_mount_is_the_scenes():
    arm = CartesianMount()
    q = np.array([0.1, -0.2, 0.3, 0.2, -0.3, 0.4])
    R, p = arm.flange_pose(q)
    np.testing.assert_allclose(
        R, Rotation.from_euler("XYZ", q[3:]).as_matrix() @ np.diag([1, -1, -1]), atol=1e-15
    )
    np.testing.assert_array_equal(p, q[:3])


def test_the_jacobian_of_a_tip_is_that_of_differences():
    arm, q = CartesianMount(), np.array([0.1, -0.2, 0.3, 0.2, -0.3, 0.4])
    place = np.array([0.01, 0.02, 0.14])
    R, _ = arm.flange_pose(q)
    found = tip_jacobian(arm.flange_jacobian(q), R @ place)
    np.testing.assert_allclose(found, numeric(arm, q, place), atol=1e-8)


def test_a_step_turns_about_the_tip():
    arm, q = CartesianMount(), np.array([0.0, 0.0, 0.2, 0.0, 0.0, 0.0])
    place = np.array([0.0, 0.0, 0.14])
    R, p = arm.flange_pose(q)
    step = solve_step(arm, q, R @ place, np.array([0, 0, 0, 0.0, 0.8, 0.0]), 0.02)
    R1, p1 = arm.flange_pose(step.q)
    # From where the arm stands at the beginning it would be drawn back by 18 um.
    np.testing.assert_allclose(p1 + R1 @ place, p + R @ place, atol=1e-7)
    np.testing.assert_allclose(Rotation.from_matrix(R1 @ R.T).as_rotvec(), [0, 0.016, 0], atol=1e-9)
    assert (step.share, step.held, step.joint) == (1.0, (), None)


def test_too_fast_is_cut_and_keeps_its_direction():
    arm, q = CartesianMount(), np.zeros(6)
    step = solve_step(arm, q, LEVER, np.array([1.0, 0.5, 0, 0, 0, 0]), 0.02)
    np.testing.assert_allclose(step.q[:2], [0.005, 0.0025])
    assert (step.share, step.held) == (pytest.approx(0.25), (MotionLimit.SPEED,))


def test_accelerations_leave_the_servo_some():
    arm = CartesianMount(hardest=(1.0, 10.0))
    step = solve_step(arm, np.zeros(6), np.zeros(3), np.array([0.2, 0, 0, 0, 0, 0]), 0.02, np.zeros(6))
    assert step.q[0] == pytest.approx(0.6 * 1.0 * 0.02**2)


def test_a_limit_stops_before_it_and_lets_back():
    arm = CartesianMount(reach=0.1)
    q = np.array([0.079, 0, 0, 0, 0, 0])
    out = solve_step(arm, q, np.zeros(3), np.array([0.2, 0, 0, 0, 0, 0]), 0.02)
    assert out.q[0] == pytest.approx(0.08)
    assert (out.held, out.joint) == ((MotionLimit.LIMIT,), 0)
    beyond = np.array([0.09, 0, 0, 0, 0, 0])
    assert solve_step(arm, beyond, np.zeros(3), np.array([0.2, 0, 0, 0, 0, 0]), 0.02).q[0] == 0.09
    assert solve_step(arm, beyond, np.zeros(3), np.array([-0.2, 0, 0, 0, 0, 0]), 0.02).q[0] < 0.09


def test_a_singularity_damps_and_is_said():
    class Flat(CartesianMount):
        def flange_jacobian(self, q):
            J = super().flange_jacobian(q)
            J[5, 5] = 0.001  # hardly turns about z
            return J

    wanted = np.array([0, 0, 0, 0, 0, 1.0])
    step = solve_step(Flat(), np.zeros(6), np.zeros(3), wanted, 0.02)
    assert MotionLimit.SINGULAR in step.held
    assert abs(step.q[5]) < 0.02
    assert step.smallest == pytest.approx(0.001)


def test_which_error_turns_which_axis():
    up = np.array([0.0, 0.0, 1.0])
    np.testing.assert_array_equal(turn_of(np.array([0.01, 0, 0]), up), [0, 0.01, 0])
    np.testing.assert_array_equal(turn_of(np.array([0, 0.01, 0]), up), [-0.01, 0, 0])
    rng = np.random.default_rng(0)
    for _ in range(20):
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        e = np.cross(n, rng.normal(size=3))
        # A small turn moves the place of the contact away from the tissue, which lies along n.
        assert np.cross(turn_of(e, n), e) @ n < 0
        np.testing.assert_allclose(turn_of(e, n), np.cross(n, e), atol=1e-15)
    assert pressing(np.array([1.0, 2.0, -7.0]), up) == 7.0
