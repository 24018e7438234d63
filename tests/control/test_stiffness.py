"""The stiffness that is followed: what the small press shows, and what does not spoil it."""

import numpy as np
import pytest

from contactbench.pipeline.control.stiffness import StiffnessTrack

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
    said = followed(6000.0, 2000.0, 0.7, tissue=tissue)
    assert said[-1] == pytest.approx(6000.0, rel=0.3)
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
