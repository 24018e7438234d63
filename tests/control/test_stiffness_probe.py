import numpy as np
import pytest

from contactbench.pipeline.control.stiffness import StiffnessProbe


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
    assert not probe.begun
    probe.begin(0.0)
    for k in range(5):
        probe.take(0.02 * k, 1e-5 * k, 7.0)
    assert probe.stiffness() is None
