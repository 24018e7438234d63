import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.control.settings import USUAL_MODULUS, Foundation
from contactbench.pipeline.control.surface import TissueSurface
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
