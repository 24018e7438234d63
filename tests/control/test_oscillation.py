"""What is a swing of the force loop, and what is only tissue that moves."""

import numpy as np
import pytest

from contactbench.pipeline.control.stiffness import Swing

DT = 0.02


def fed(error, seconds, swing=None):
    swing = swing or Swing(7.0)
    for k in range(round(seconds / DT)):
        swing.take(error(DT * k), DT)
    return swing


def wave(amplitude, hertz):
    return lambda t: amplitude * np.sin(2 * np.pi * hertz * t)


@pytest.mark.parametrize("hertz", [2.5, 4.0, 7.0])
def test_a_swing_lowers_the_gain_within_three_half_waves(hertz):
    swing = fed(wave(1.0, hertz), 1.6 / hertz + DT)
    assert swing.seen
    assert swing.share <= 0.65
    assert not swing.beyond
    assert swing.amplitude == pytest.approx(1.0, rel=0.3)


@pytest.mark.parametrize(
    "error",
    [
        wave(0.2, 5.0),  # the small press that asks for the stiffness
        wave(3.0, 0.5),  # tissue that heaves in two seconds
        lambda t: 3.0 * np.exp(-t / 0.1),  # one blow
        lambda t: float(np.random.default_rng(round(t / DT)).normal(0, 0.05)),
    ],
)
def test_what_is_no_swing_leaves_the_gain(error):
    swing = fed(error, 4.0)
    assert swing.share == 1.0
    assert not swing.beyond


def test_a_large_swing_that_goes_on_is_beyond_a_lower_gain():
    assert not fed(wave(4.0, 3.0), 0.5).beyond
    assert fed(wave(4.0, 3.0), 1.2).beyond
    assert not fed(wave(1.5, 3.0), 4.0).beyond


def test_a_gain_that_was_lowered_comes_back_when_it_is_quiet():
    swing = fed(wave(1.5, 4.0), 2.0)
    assert swing.share == pytest.approx(0.1)
    fed(lambda _: 0.0, 0.7, swing)
    assert swing.share < 0.15
    fed(lambda _: 0.0, 8.0, swing)
    assert swing.share > 0.9


def test_a_reset_watches_anew_with_the_gain_that_is_left():
    swing = fed(wave(4.0, 3.0), 1.5)
    share = swing.share
    swing.reset()
    assert (swing.beyond, swing.seen, swing.share) == (False, False, share)


def test_what_the_stiffness_explains_is_given_back_and_no_more():
    swing = fed(wave(1.0, 4.0), 0.5)
    share = swing.share
    swing.explained(0.3)
    assert swing.share == share
    swing.explained(1.2)
    assert swing.share == pytest.approx(1.2 * share)
    swing.explained(100.0)
    assert swing.share == 1.0
