"""How late poses are, from how far the arm is behind what it was sent."""

import numpy as np
import pytest

from contactbench.pipeline.control.controller import PoseLag

DT = 0.02


@pytest.mark.parametrize("late", [0, 1, 5])
def test_it_says_by_how_much_they_are_late(late):
    times = DT * np.arange(200)
    sent = 0.005 * np.sin(2 * np.pi * times / 2)
    told = np.concatenate([np.full(late, sent[0]), sent])[: len(sent)]
    told = told + np.random.default_rng(0).normal(0, 1e-5, len(told))
    lag = PoseLag()
    for k in range(1, len(sent)):
        lag.take((sent[k] - sent[k - 1]) / DT, (told[k] - told[k - 1]) / DT, sent[k] - told[k], DT)
    assert lag.seconds == pytest.approx(late * DT, abs=0.01)


def test_who_stands_still_says_nothing():
    lag = PoseLag()
    for _ in range(500):
        lag.take(1e-4, 1e-4, 1e-3, DT)
    assert lag.seconds == 0.0


def test_an_arm_that_does_not_move_is_not_late():
    lag = PoseLag()
    for k in range(100):
        lag.take(0.01, 0.0, 0.01 * k * DT, DT)
    assert lag.seconds == 0.0
