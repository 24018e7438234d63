"""Candidates for a calibration: near, spread, inside, clear, and the same every time."""

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import ELFIN3, Clearance, ClearanceCheck

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
