import numpy as np
import pytest

from pipeline.devices.bursts import spread_bursts


def test_what_came_together_lies_between_what_came_before_and_its_arrival():
    times = np.array([0.0, 0.016, 0.016, 0.016, 0.016, 0.020])
    assert spread_bursts(times) == pytest.approx([0.0, 0.004, 0.008, 0.012, 0.016, 0.020])


def test_after_a_silence_they_are_a_sample_apart():
    assert spread_bursts(np.array([0.0, 1.0, 1.0])) == pytest.approx([0.0, 0.995, 1.0])


def test_the_first_burst_is_as_dense_as_those_that_follow():
    times = np.repeat([0.008, 0.016, 0.024], 8)
    assert spread_bursts(times) == pytest.approx(np.arange(1, 25) / 1000)
    assert spread_bursts(np.array([1.0, 1.0])) == pytest.approx([0.995, 1.0])


def test_it_goes_on_from_the_block_before():
    assert spread_bursts(np.array([0.02, 0.02]), before=0.01) == pytest.approx([0.015, 0.02])


def test_single_samples_and_a_clock_that_goes_back_stay_as_they_are():
    times = np.array([0.0, 0.3, 0.1, 0.4])
    assert spread_bursts(times) is times
    back = np.array([0.5, 0.2, 0.2, 0.6])
    assert spread_bursts(back).tolist() == back.tolist()
    assert spread_bursts(np.array([])).tolist() == []


def test_drawn_bursts_never_go_back():
    rng = np.random.default_rng(0)
    for _ in range(100):
        times = np.repeat(np.cumsum(rng.uniform(1e-4, 0.1, 50)), rng.integers(1, 20, 50))
        found = spread_bursts(times)
        assert (np.diff(found) > 0).all()
        assert (found <= times).all()
