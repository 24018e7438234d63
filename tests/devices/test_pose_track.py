import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from contactbench.pipeline.devices.pose_source import LONGEST_AHEAD_S, LONGEST_GAP_S, poses_at

TIMES = 0.1 * np.arange(21)
TURNS = Rotation.from_rotvec(np.column_stack([0.35 * TIMES, 0.1 * np.sin(TIMES), -0.2 * TIMES]))
PLACES = np.column_stack([TIMES, TIMES**2, 0 * TIMES])


def at(times):
    return poses_at(TIMES, TURNS.as_matrix(), PLACES, np.asarray(times, dtype=float))


def test_between_two_poses_it_is_slerp_and_a_straight_line():
    times = np.linspace(0, 2, 317)
    R, p = at(times)
    assert np.abs(R - Slerp(TIMES, TURNS)(times).as_matrix()).max() < 1e-14
    assert p[:, 1] == pytest.approx(np.interp(times, TIMES, PLACES[:, 1]), abs=1e-14)


def test_after_the_last_one_it_goes_on_by_the_last_twist():
    ahead = 0.9 * LONGEST_AHEAD_S
    twist = (TURNS[-2].inv() * TURNS[-1]).as_rotvec() / 0.1
    R, p = at([2.0 + ahead, 2.0 + 1.1 * LONGEST_AHEAD_S])
    assert pytest.approx((TURNS[-1] * Rotation.from_rotvec(ahead * twist)).as_matrix(), abs=1e-14) == R[0]
    assert p[0] == pytest.approx(PLACES[-1] + ahead * (PLACES[-1] - PLACES[-2]) / 0.1)
    assert np.isnan(R[1]).all()
    assert np.isnan(p[1]).all()


def test_nothing_is_made_up_before_the_first_one_or_in_a_long_gap():
    keep = (TIMES < 0.55) | (TIMES > 0.55 + 2 * LONGEST_GAP_S)
    R, _ = poses_at(
        TIMES[keep],
        TURNS.as_matrix()[keep],
        PLACES[keep],
        np.array([-0.01, 0.8, np.nan, 1.5]),
        longest_ahead=0.0,
    )
    assert np.isfinite(R[:, 0, 0]).tolist() == [False, False, False, True]


def test_what_does_not_increase_or_is_no_number_is_left_out():
    moments, R = TIMES.copy(), TURNS.as_matrix().copy()
    moments[5], moments[9], R[12, 1, 1] = 0.2, np.inf, np.nan
    found, _ = poses_at(moments, R, PLACES, np.array([0.5, 0.9, 1.2]))
    keep = [0, 1, 2, 3, 4, 6, 7, 8, 10, 11, 13, *range(14, 21)]
    expected = Slerp(TIMES[keep], TURNS[keep])([0.5, 0.9, 1.2]).as_matrix()
    assert pytest.approx(expected, abs=1e-14) == found


def test_no_poses_at_all():
    R, p = poses_at(np.empty(0), np.empty((0, 3, 3)), np.empty((0, 3)), np.array([1.0]))
    assert np.isnan(R).all()
    assert np.isnan(p).all()
