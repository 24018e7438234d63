"""Flange poses against the manufacturer's chain written three other ways, Jacobians against differences."""

from concurrent.futures import ThreadPoolExecutor
from math import pi

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import ELFIN3, Clearance, ClearanceCheck, Joint, Robot, RobotDescription
from contactbench.pipeline.robot.clearance import Capsule
from contactbench.pipeline.robot.robot_file import mjcf

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


# ---- candidates for a calibration: near, spread, inside, clear, and the same every time ----------


pytest.importorskip("mujoco")

# J4, J5 and J6 of what an x86-64 machine drew.
FIRST_TWO = (
    (0.8464232276465875, -1.1556706969053712, -2.836783622074317),
    (-2.2435767723534124, 0.517662636427962, -1.600783622074317),
)

START = np.array([0.2, -0.1, pi / 2, 0, 1.2, 0.3])


def test_only_the_wrist_moves_unless_asked(elfin):
    Q = elfin.candidate_joints(START, count=100)
    assert Q.shape == (100, 6)
    np.testing.assert_array_equal(Q[:, :3], np.broadcast_to(START[:3], (100, 3)))
    moved = elfin.candidate_joints(START, count=100, wrist_only=False, arm_reach=0.3)
    assert (np.ptp(moved, axis=0) > 0.4).all()
    assert np.abs(moved - START)[:, :3].max() <= 0.3


@settings(max_examples=25, deadline=None)
@given(
    start=st.tuples(*(st.floats(joint.lower, joint.upper) for joint in ELFIN3.joints)),
    seed=st.integers(0, 2**32),
    wrist_only=st.booleans(),
    margin=st.floats(0, 0.5),
    wrist_reach=st.floats(0.01, 7),
)
def test_candidates_keep_limits_reach_and_clearance(elfin, start, seed, wrist_only, margin, wrist_reach):
    options = {"seed": seed, "wrist_only": wrist_only, "margin": margin, "wrist_reach": wrist_reach}
    clearance = Clearance(z_min=-0.2)
    try:
        Q = elfin.candidate_joints(start, count=10, clearance=clearance, **options)
    except InputError as error:
        assert "is clear; too close:" in str(error)  # noqa: PT017  (a start may be hopeless)
        return
    assert 1 <= len(Q) <= 10
    moving = np.array([not wrist_only] * 3 + [True] * 3)
    low, high = elfin.lower + margin - 1e-12, elfin.upper - margin + 1e-12
    assert (np.clip(Q, low, high) == Q)[:, moving].all()
    assert (np.abs(Q - start)[:, 3:] <= wrist_reach + margin + 1e-12).all()
    check = ClearanceCheck(ELFIN3, clearance)
    assert [check.conflict(q, moving=moving) for q in Q] == [None] * len(Q)


def test_the_same_seed_gives_the_same_set_and_more_only_append(elfin):
    few, many = elfin.candidate_joints(START, count=8), elfin.candidate_joints(START, count=300)
    np.testing.assert_array_equal(few, many[:8])
    assert np.abs(elfin.candidate_joints(START, count=8, seed=1) - few).max() > 0.1
    drawn = elfin.candidate_joints(START, count=8, seed=np.random.default_rng(0))
    np.testing.assert_array_equal(drawn, few)


def test_the_set_is_the_same_on_every_machine(elfin):
    first = elfin.candidate_joints(np.zeros(6), count=2)
    np.testing.assert_allclose(first[:, 3:], FIRST_TWO, rtol=0, atol=1e-12)


def test_a_few_candidates_turn_gravity_every_way(elfin):
    Q = elfin.candidate_joints(START, count=32)
    down_E = -elfin.flange_rotations(Q)[:, 2]  # rows: the downward unit vector of B, in E
    # Of a perfectly even set every singular value would be sqrt(32 / 3) = 3.3.
    assert np.linalg.svd(down_E, compute_uv=False).min() > 2.0
    octants = {tuple(signs) for signs in np.sign(down_E).astype(int).tolist()}
    assert len(octants) == 8


def test_a_start_beside_its_limit_is_pulled_in(elfin):
    Q = elfin.candidate_joints([0, 0, 1.5, 0, 0, 3.135], count=5, wrist_reach=0.02, margin=0.1)
    assert (Q[:, 5] <= 3.04 + 1e-12).all()
    assert (Q[:, 5] >= 3.02 - 1e-12).all()


def test_where_nothing_is_clear_the_reason_is_given(elfin):
    with pytest.raises(InputError, match=r"none of 1024 .* too close: forearm to floor \(1024 of 1024\)"):
        elfin.candidate_joints(START, count=32, clearance=Clearance(z_min=1.0))


def test_links_that_stay_are_no_obstacle_to_the_wrist(elfin):
    # The shoulder lies below this bed, but the wrist above it does not touch it.
    clearance = Clearance(z_min=0.25, p_ET_E=(0, 0, 0.1))
    start = [0, -0.3, 1.4, 0, 0.8, 0]
    assert ClearanceCheck(ELFIN3, clearance).conflict(start) == "upper arm to floor"
    assert len(elfin.candidate_joints(start, count=20, clearance=clearance)) == 20
    with pytest.raises(InputError, match="upper arm to floor"):
        elfin.candidate_joints(start, wrist_only=False, clearance=clearance)


def test_where_little_is_clear_fewer_come(elfin):
    # Straight down the tool would pierce the table; only the corners of what the wrist may do lift it enough.
    down, clearance = [0, 0, pi / 2, 0, pi / 2, 0], Clearance(p_ET_E=(0, 0, 0.265))
    assert 1 <= len(elfin.candidate_joints(down, count=400, wrist_reach=0.3, clearance=clearance)) < 400


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"q_start": [0, 3, 0, 0, 0, 0]}, "q_start: joint J2"),
        ({"count": 0}, "count"),
        ({"wrist_reach": 0.0}, "wrist_reach"),
        ({"arm_reach": np.nan}, "arm_reach"),
        ({"margin": -0.1}, "margin"),
        ({"margin": 3.0}, "no range"),
    ],
)
def test_unusable_options_are_refused(elfin, options, message):
    with pytest.raises(InputError, match=message):
        elfin.candidate_joints(**{"q_start": START, **options})


# ---- conflicts against hand-made poses and against distances found by brute force ----------------


pytest.importorskip("mujoco")

DOWN = np.array([0, 0, pi / 2, 0, pi / 2, 0])  # the flange 303.5 mm above the table, looking down
NO_FLOOR = -np.inf
inside = st.tuples(*(st.floats(joint.lower, joint.upper) for joint in ELFIN3.joints)).map(np.array)


def check(**options) -> ClearanceCheck:
    return ClearanceCheck(ELFIN3, Clearance(**options))


def test_standing_up_and_looking_down_are_clear():
    assert check().conflict(np.zeros(6)) is None
    assert check().conflict(DOWN) is None


@pytest.mark.parametrize("radius", [0.03, 0.05])
@pytest.mark.parametrize("z_min", [-0.1, 0.0, 0.05])
def test_the_floor_counts_from_the_tip(radius, z_min):
    length = 0.3035 - z_min - radius - 0.02
    options = {"tool_radius": radius, "z_min": z_min}
    assert check(p_ET_E=(0, 0, length - 1e-9), **options).conflict(DOWN) is None
    assert check(p_ET_E=(0, 0, length + 1e-9), **options).conflict(DOWN) == "tool to floor"


def test_without_tool_or_floor_less_is_in_the_way():
    sunk = [0, 2.0, 0, 0, 0, 0]  # forward and down: the whole arm lies below the table
    assert check(p_ET_E=(0, 0, 0)).conflict(sunk) == "elbow to floor"
    assert check(p_ET_E=(0, 0, 0), z_min=NO_FLOOR).conflict(sunk) is None


def test_a_long_tool_folded_back_meets_the_forearm():
    folded = [0, 0, 0, 0, 2.3, 0]
    assert check(p_ET_E=(-0.1, -0.1, 0.2)).conflict(folded) == "tool to forearm"
    assert check(p_ET_E=(0, 0, 0)).conflict(folded) is None


def test_gaps_that_no_joint_changes_are_not_watched():
    sunk = [0, 2.0, 0, 0, 0, 0]
    assert check().conflict(sunk, moving=[0, 0, 0, 1, 1, 1]) == "forearm to floor"
    assert check(p_ET_E=(0, 0, 0)).conflict(sunk, moving=[0, 0, 0, 0, 0, 0]) is None
    # J1 swings the whole arm over the floor, but nothing on the arm comes nearer to anything else on it.
    folded = [0, 0, 0, 0, 2.56, 0]
    assert check().conflict(folded) == "hand to elbow"
    assert check().conflict(folded, moving=[1, 0, 0, 0, 0, 0]) is None
    assert check().path_conflict(folded, [1, 0, 0, 0, 2.56, 0]) is None


def test_the_tool_is_fixed_to_the_flange():
    # A tool sideways along -x of E points forward when the arm looks down: it misses the table.
    assert check(p_ET_E=(0, 0, 0.4)).conflict(DOWN) == "tool to floor"
    assert check(p_ET_E=(-0.4, 0, 0)).conflict(DOWN) is None


def brute_gap(poses, distance_of: Clearance) -> float:
    """Smallest gap between capsules that may touch, from points along their axes."""
    tip = np.add(ELFIN3.flange_xyz, distance_of.p_ET_E)
    capsules = [*ELFIN3.capsules, Capsule("tool", 6, ELFIN3.flange_xyz, tuple(tip), distance_of.tool_radius)]
    s = np.linspace(0, 1, 201)[:, None]
    axes = []
    for capsule in capsules:
        points = (1 - s) * capsule.start_xyz + s * capsule.end_xyz
        axes.append(points @ poses[capsule.body][:3, :3].T + poses[capsule.body][:3, 3])
    gaps = [np.inf]
    for i, a in enumerate(capsules):
        for j, b in enumerate(capsules[:i]):
            if abs(a.body - b.body) > 1 and (b.name, a.name) not in ELFIN3.never_touch:
                apart = np.linalg.norm(axes[i][:, None] - axes[j], axis=-1).min()
                gaps.append(apart - a.radius - b.radius)
        if a.body > 0:
            gaps.append(axes[i][:, 2].min() - a.radius - distance_of.z_min)
    return min(gaps)


@settings(max_examples=60, deadline=None)
@given(q=inside, z_min=st.sampled_from([-1e3, 0.0]))
def test_conflicts_are_those_of_brute_force(link_poses, q, z_min):
    clearance = Clearance(z_min=z_min, p_ET_E=(0.03, 0, 0.2))
    gap = brute_gap(link_poses(ELFIN3, q), clearance)
    assume(abs(gap - clearance.distance) > 1e-4)  # what the points miss
    assert (ClearanceCheck(ELFIN3, clearance).conflict(q) is None) == (gap > clearance.distance)


def test_a_way_between_clear_ends_may_not_be_clear():
    long_tool = check(p_ET_E=(0, 0, 0.3))
    left, right = DOWN + [0, 0, 0, -0.8, 0, 0], DOWN + [0, 0, 0, 0.8, 0, 0]
    assert long_tool.conflict(left) is None
    assert long_tool.conflict(right) is None
    assert long_tool.path_conflict(left, right) == "tool to floor"
    assert check().path_conflict(left, right) is None
    assert long_tool.path_conflict(left, left) is None


@settings(max_examples=30, deadline=None)
@given(a=inside, b=inside)
def test_a_clear_way_stays_clear_between_the_samples(a, b):
    # A sample every 0.02 rad with gaps of 20 mm: in between, at least 20 mm - 0.01 rad x 1.2 m = 8 mm remain.
    coarse, fine = check(distance=0.02, z_min=-0.3), check(distance=0.008, z_min=-0.3)
    if coarse.path_conflict(a, b) is None:
        assert fine.path_conflict(a, b, step=0.005) is None


def test_unusable_questions_are_refused():
    with pytest.raises(InputError, match="finite"):
        check().conflict([np.nan] * 6)
    with pytest.raises(InputError, match="finite"):
        check().path_conflict(np.zeros(6), [np.inf] * 6)
    with pytest.raises(InputError, match="moving"):
        check().conflict(np.zeros(6), moving=[True])
    with pytest.raises(InputError, match="step"):
        check().path_conflict(np.zeros(6), np.ones(6), step=0)
