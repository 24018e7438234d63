import numpy as np
import pytest

from contactbench.pipeline.control.surface import Follower

DT = 0.02


def fed(follower, values):
    for value in values:
        follower.update(np.atleast_1d(value), DT)
    return follower


def test_what_speeds_up_steadily_is_followed_without_lag():
    t = DT * np.arange(200)
    follower = fed(Follower([12.0]), 0.3 + 0.2 * t + 0.5 * 0.4 * t**2)
    assert follower.speed()[0] == pytest.approx(0.2 + 0.4 * t[-1], rel=1e-9)
    assert follower.speed(0.05)[0] == pytest.approx(0.2 + 0.4 * (t[-1] + 0.05), rel=1e-9)
    later = t[-1] + 0.05
    assert follower.value(0.05)[0] == pytest.approx(0.3 + 0.2 * later + 0.2 * later**2, rel=1e-9)


def test_a_kink_is_followed_without_swinging():
    t = DT * np.arange(150)
    follower, speeds = Follower([12.0]), []
    for value in np.maximum(t - 1.0, 0.0):
        follower.update(np.array([value]), DT)
        speeds.append(follower.speed()[0])
    assert speeds[-1] == pytest.approx(1.0, abs=1e-3)
    # The poles are real; what goes over is the price of no lag, and it does so once.
    assert max(speeds) < 1.5
    assert min(speeds[80:]) > 0.95


def test_noise_is_held_back_more_by_a_lower_bandwidth():
    noise = np.random.default_rng(0).normal(0, 1e-3, 2000)
    spread = []
    for bandwidth in (5.0, 20.0):
        follower, speeds = Follower([bandwidth]), []
        for value in noise:
            follower.update(np.array([value]), DT)
            speeds.append(follower.speed()[0])
        spread.append(np.std(speeds[100:]))
    assert spread[0] < spread[1] / 4


def test_without_a_value_the_speed_fades_and_reset_forgets():
    follower = fed(Follower([12.0, 3.0]), [[0.1 * k, 0.1 * k] for k in range(50)])
    assert follower.speed()[0] == pytest.approx(5.0, rel=1e-2)
    for _ in range(50):
        follower.update(None, DT)
    assert abs(follower.speed()[0]) < 1e-3 < abs(follower.speed()[1])
    follower.reset()
    assert not follower.running
    assert follower.value() is None
    follower.update(None, DT)
    assert not follower.running
