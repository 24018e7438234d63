import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.control.settings import USUAL_MODULUS, Foundation
from contactbench.pipeline.control.surface import Follower, TissueSurface
from contactbench.pipeline.simulation.marker_touches import model_of

DT = 0.02
DOWN = np.diag([1.0, -1.0, -1.0])
QUIET = (1e-4, 1e-6)


@pytest.fixture(scope="module")
def foundation():
    return Foundation(model_of("convex", 2000))


def surface_of(foundation):
    return TissueSurface(foundation, (20.0, 15.0, 15.0))


def seen(foundation, force, tilt, gain_error=1.0):
    """Offset and lean of tissue that is tilted by so much (about S's x and y)."""
    press = foundation.at(force, USUAL_MODULUS)
    offset = (gain_error * press.gain_x * tilt[1], -gain_error * press.gain_y * tilt[0])
    return offset, tilt


def test_tissue_that_goes_up_is_led_whatever_the_probe_does(foundation):
    rng, surface = np.random.default_rng(0), surface_of(foundation)
    tip, height = 0.0, 0.0
    for _ in range(150):
        height += 0.02 * DT
        tip = height - foundation.at(7.0, USUAL_MODULUS).depth + rng.normal(0, 2e-4)
        force = 7.0 + foundation.at(7.0, USUAL_MODULUS).stiffness * (
            height - foundation.at(7.0, USUAL_MODULUS).depth - tip
        )
        surface.update(DT, np.array([0, 0, tip]), DOWN, force, (0.0, 0.0), (0.0, 0.0), QUIET)
    # Inward is down: tissue that comes up goes against it.
    assert surface.speed_along(DOWN[:, 2], 0.0) == pytest.approx(-0.02, abs=2e-3)


@pytest.mark.parametrize("axis", [0, 1])
def test_tissue_that_turns_is_led_whatever_the_probe_does(foundation, axis):
    rng, surface = np.random.default_rng(1), surface_of(foundation)
    speed, tissue, probe = 0.3, 0.0, 0.0
    for _ in range(60):
        tissue += speed * DT
        probe = tissue + rng.normal(0, 0.01)
        R = DOWN @ Rotation.from_rotvec(probe * np.eye(3)[axis]).as_matrix()
        tilt = [0.0, 0.0]
        tilt[axis] = tissue - probe
        offset, lean = seen(foundation, 7.0, tilt)
        surface.update(DT, np.zeros(3), R, 7.0, offset, lean, QUIET)
        assert surface.tilt[axis] == pytest.approx(tilt[axis], abs=3e-3)
    wanted = DOWN @ (speed * np.eye(3)[axis])
    np.testing.assert_allclose(surface.turning(0.0), wanted, atol=0.02)


def test_it_begins_anew_when_the_tissue_was_left(foundation):
    surface = surface_of(foundation)
    assert surface.speed_along(DOWN[:, 2], 0.1) == 0.0
    np.testing.assert_array_equal(surface.turning(0.1), np.zeros(3))
    for k in range(20):
        surface.update(DT, np.array([0, 0, 1e-3 * k]), DOWN, 7.0, (1e-4 * k, 0), (0, 1e-2 * k), QUIET)
    assert surface.speed_along(DOWN[:, 2], 0.0) != 0.0
    surface.forget()
    assert (surface.speed_along(DOWN[:, 2], 0.0), surface.tilt) == (0.0, (0.0, 0.0))


def test_without_a_place_it_turns_less_and_less(foundation):
    surface = surface_of(foundation)
    for k in range(40):
        offset, lean = seen(foundation, 7.0, (0.0, 0.004 * k))
        surface.update(DT, np.zeros(3), DOWN, 7.0, offset, lean, QUIET)
    before = np.linalg.norm(surface.turning(0.0))
    for _ in range(25):
        surface.update(DT, np.zeros(3), DOWN, 7.0, None, (0.0, 0.0), QUIET)
    assert surface.tilt == (0.0, 0.0)
    assert np.linalg.norm(surface.turning(0.0)) < 0.1 * before


def test_another_stiffness_is_no_motion(foundation):
    surface = surface_of(foundation)
    for _ in range(10):
        surface.update(DT, np.zeros(3), DOWN, 7.0, (0, 0), (0, 0), QUIET)
    surface.learn(7.0, foundation.at(7.0, 1e7).stiffness)
    assert surface.modulus == pytest.approx(1e7, rel=0.1)
    for _ in range(3):
        surface.update(DT, np.zeros(3), DOWN, 7.0, (0, 0), (0, 0), QUIET)
        assert abs(surface.speed_along(DOWN[:, 2], 0.0)) < 1e-12


def test_what_no_tissue_is_is_not_learned(foundation):
    surface = surface_of(foundation)
    surface.learn(7.0, 1e9)
    assert surface.modulus <= 20 * USUAL_MODULUS
    surface.learn(7.0, 1.0)
    assert surface.modulus >= USUAL_MODULUS / 20


# ----  --------------------------------------------------------------------------------------------


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
