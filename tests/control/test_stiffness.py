"""The stiffness that is followed: what the small press shows, and what does not spoil it."""

import numpy as np
import pytest

from contactbench.pipeline.control.stiffness import StiffnessProbe, StiffnessTrack, Swing

DT = 0.02


def followed(true, known, seconds=0.7, *, tissue=lambda _: 0.0, noise=0.025, doubt=True, seed=0):
    """Press tissue of a stiffness (a function of time), which moves; return what is believed, at each step."""
    rng, track = np.random.default_rng(seed), StiffnessTrack()
    way, said = 0.0, []
    if doubt:
        track.doubt()
    for k in range(round(seconds / DT)):
        speed = track.asking(known, DT)
        way += speed * DT
        height = tissue(DT * k)

        force = 7.0 + true * (way + height) + rng.normal(0, noise)
        known = track.take(DT * k, way, force, known)
        said.append(known)
    return np.array(said)


@pytest.mark.parametrize("factor", [1 / 6, 1 / 3, 1.0, 3.0, 6.0, 12.0])
def test_it_finds_another_stiffness_in_less_than_a_second(factor):
    assert followed(factor * 2000.0, 2000.0)[-1] == pytest.approx(factor * 2000.0, rel=0.25)


def test_without_a_doubt_nothing_moves_and_what_was_known_stays():
    assert (followed(12_000.0, 2000.0, doubt=False) == 2000.0).all()
    track = StiffnessTrack()
    track.doubt()
    speeds = [track.asking(2000.0, DT) for _ in range(60)]
    assert max(map(abs, speeds[:30])) > 1e-3
    assert speeds[-20:] == [0.0] * 20
    # In and out: it ends near where it began.
    assert abs(sum(speeds) * DT) <= 0.2 / 2000.0 + 1e-12


@pytest.mark.parametrize(
    "tissue",
    [
        # What is left of a motion that the probe goes after.
        lambda t: 0.002 * t,
        lambda t: 0.001 * np.sin(2 * np.pi * t / 2.0),
        lambda t: 0.001 * (1 - np.cos(2 * np.pi * t)),
    ],
)
def test_tissue_that_moves_does_not_spoil_it(tissue):
    assert followed(6000.0, 2000.0, 0.7, tissue=tissue)[-1] == pytest.approx(6000.0, rel=0.3)
    steady = followed(2000.0, 2000.0, 0.7, tissue=tissue)
    assert 1300.0 < steady.min() <= steady.max() < 3000.0


def test_a_period_changes_it_by_no_more_than_a_third():
    said = followed(200_000.0, 2000.0)
    assert np.abs(np.diff(np.log(said))).max() <= 0.3 + 1e-9


def test_noise_alone_says_nothing():
    track, rng = StiffnessTrack(), np.random.default_rng(0)
    track.doubt()
    said = [track.take(DT * k, 1e-7 * rng.normal(), 7 + 0.025 * rng.normal(), 2000.0) for k in range(200)]
    assert said == [2000.0] * 200


def test_readings_that_are_missing_leave_a_gap():
    track, known, way = StiffnessTrack(), 2000.0, 0.0
    track.doubt()
    for k in range(35):
        way += track.asking(known, DT) * DT
        if k % 5 != 3:
            known = track.take(DT * k, way, 7 + 8000.0 * way, known)
    assert known == pytest.approx(8000.0, rel=0.1)


# ---- what is a swing of the force loop, and what is only tissue that moves -----------------------


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


# ----  --------------------------------------------------------------------------------------------


def pressed(stiffness, *, noise=0.02, drift=0.0, seed=0):
    rng, probe = np.random.default_rng(seed), StiffnessProbe(1.5e-4)
    probe.begin(10.0)
    s, now = 0.0, 10.0
    while not probe.over(now):
        s += probe.speed(now) * 0.02
        now += 0.02
        surface = drift * (now - 10.0) ** 2
        probe.take(now, s, 7.0 + stiffness * (s - surface) + rng.normal(0, noise))
    assert abs(s) < 5e-5, "it ends where it began"
    return probe.stiffness()


@pytest.mark.parametrize("stiffness", [600.0, 2200.0, 20_000.0])
@pytest.mark.parametrize("drift", [0.0, 0.002])
def test_it_finds_the_stiffness_even_if_the_tissue_moves(stiffness, drift):
    found, error = pressed(stiffness, drift=drift)
    assert found == pytest.approx(stiffness, abs=4 * error + 0.02 * stiffness)
    assert error < 0.25 * stiffness


def test_noise_alone_tells_nothing():
    assert pressed(10.0) is None


def test_too_few_readings_tell_nothing():
    probe = StiffnessProbe(1e-4)
    assert probe.speed(3.0) == 0.0
    probe.take(0.0, 0.0, 7.0)
    assert probe.began is None
    probe.begin(0.0)
    for k in range(5):
        probe.take(0.02 * k, 1e-5 * k, 7.0)
    assert probe.stiffness() is None
