"""The suspicion of a re-zero, from made-up readings."""

import math

import numpy as np
import pytest
from benchmarks.faults import rezero_figures
from hypothesis import given, settings
from hypothesis import strategies as st

from contactbench.pipeline.devices.emulate import swinging
from contactbench.pipeline.devices.readings import RezeroDetector
from contactbench.pipeline.devices.sample import WrenchSample

WEIGHT = np.array([1.0, -2.0, 4.5, 0.12, -0.2, 0.05])
RATE = 100.0


def suspected(rows, rate=RATE, start=0.0, gaps=()):
    detector, found, time = RezeroDetector(), [], start
    for number, row in enumerate(rows):
        time += 1 / rate + dict(gaps).get(number, 0.0)
        result = detector.feed(WrenchSample(time, tuple(row[:3]), tuple(row[3:])))
        if result:
            found.append((number, result))
    return found


def noise(rows, seed=0):
    return np.random.default_rng(seed).normal(size=(rows, 6)) * ([0.05] * 3 + [0.002] * 3)


def test_a_step_from_rest_to_rest_at_zero_is_suspected_once_and_in_words():
    rows = WEIGHT + noise(200)
    rows[100:] -= WEIGHT
    ((number, result),) = suspected(rows)
    assert number <= 100 + 12  # a tenth of a second
    assert result.force == pytest.approx(5.0, abs=0.1)
    assert "may have been re-zeroed" in str(result)
    assert "5.0 N" in str(result)


@pytest.mark.parametrize("share", [0.5, 0.8, 1.2, 2.0])
def test_a_step_to_elsewhere_is_a_load(share):
    rows = WEIGHT + noise(200)
    rows[100:] -= share * WEIGHT
    assert suspected(rows) == []


def test_a_load_taken_off_over_some_samples_is_a_load():
    rows = WEIGHT * np.concatenate([np.ones(100), np.linspace(1, 0, 4), np.zeros(96)])[:, None] + noise(200)
    assert suspected(rows) == []


def test_what_rings_is_a_load():
    rows = WEIGHT + noise(200)
    rows[100:] -= WEIGHT
    rows[100:, 2] += 2.0 * np.sin(1.3 * np.arange(100)) * np.exp(-np.arange(100) / 10)
    assert suspected(rows) == []


def test_a_sensor_that_was_at_zero_may_return_there():
    rows = noise(300)
    rows[100:200] += WEIGHT
    assert suspected(rows) == []


def test_a_short_gap_hides_no_re_zero_and_a_long_one_makes_none():
    rows = WEIGHT + noise(200)
    rows[100:] -= WEIGHT
    assert len(suspected(rows, gaps=[(100, 0.3)])) == 1
    assert suspected(rows, gaps=[(100, 5.0)]) == []


def test_numbers_that_are_none_are_no_readings():
    rows = WEIGHT + noise(200)
    rows[100:] -= WEIGHT
    rows[50] = math.nan
    rows[90, 1] = math.inf
    assert len(suspected(rows)) <= 1


def test_ordinary_motion_of_a_minute_is_never_suspected():
    signal = swinging("sri")
    assert suspected([signal(k / 200) for k in range(12_000)], rate=200.0) == []


def test_re_zeros_are_suspected_and_touches_are_not():
    caught, false = rezero_figures(60, seed=5)
    assert caught.measured >= 0.95
    assert false.measured == 0


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.tuples(st.floats(0, 3, allow_nan=False), *[st.floats(width=32)] * 6), min_size=1, max_size=60)
)
def test_any_readings_are_survived(rows):
    detector, time = RezeroDetector(), 0.0
    for step, fx, fy, fz, mx, my, mz in rows:
        time += step
        detector.feed(WrenchSample(time, (fx, fy, fz), (mx, my, mz)))
