"""A soft pad: its pressures are what it is pressed with, and its torsion arm that of theory."""

import numpy as np
import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.simulation.reality import Pad
from contactbench.pipeline.simulation.scenes import TrueSurface

_UP = np.array([0.0, 0.0, 1.0])
_FRICTION = 0.4


def _flat() -> TrueSurface:
    x = 0.1
    vertices = np.array([[sx * x, sy * x, z] for z in (0.0, -0.02) for sx in (-1, 1) for sy in (-1, 1)])
    faces = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
             [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]  # fmt: skip
    return TrueSurface(Probe.from_arrays(vertices, np.array(faces)))


def test_a_straight_pad_presses_its_centre_with_what_it_is_given() -> None:
    point = np.array([0.01, -0.02, 0.0])
    press = Pad(_flat(), 0.015).press(point, _UP, np.array([0.0, 0.0, -9.0]))
    np.testing.assert_allclose(press.contact[:3], [0, 0, -9], atol=1e-9)
    np.testing.assert_allclose(press.contact[3:], np.cross(point, [0, 0, -9]), atol=9 * 2e-4)
    np.testing.assert_allclose(press.centre_of_pressure, point, atol=2e-4)


@pytest.mark.parametrize(("twist", "share"), [(1.0, 1.0), (-1.0, -1.0), (0.5, 0.5)])
def test_a_pad_that_twists_has_the_torsion_arm_of_theory(twist: float, share: float) -> None:
    """Two thirds of friction times radius, for even pressure (Howe and Cutkosky 1996)."""
    press = Pad(_flat(), 0.015, twist=twist).press(np.zeros(3), _UP, np.array([0.0, 0.0, -9.0]))
    assert press.contact[5] / 9 == pytest.approx(-share * 2 / 3 * _FRICTION * 0.015, rel=0.03)


def test_what_pulls_along_the_surface_leaves_less_for_a_twist_and_slips_beyond_friction() -> None:
    pad = Pad(_flat(), 0.015, twist=1.0)
    half = pad.press(np.zeros(3), _UP, np.array([0.2 * 9, 0.0, -9.0]))
    assert half.contact[0] == pytest.approx(1.8)
    assert half.contact[5] / 9 == pytest.approx(-np.sqrt(0.75) * 2 / 3 * _FRICTION * 0.015, rel=0.03)
    slips = pad.press(np.zeros(3), _UP, np.array([9.0, 0.0, -9.0]))
    assert slips.contact[0] == pytest.approx(_FRICTION * 9)
    assert slips.contact[5] == pytest.approx(0.0, abs=1e-6)


def test_a_pad_askew_presses_beside_its_centre() -> None:
    """By theta R² / 4 d for one that touches all over, d the depth in the middle."""
    radius, degrees = 0.015, 3.0
    press = Pad(_flat(), radius, lean=degrees).press(np.zeros(3), _UP, np.array([0.0, 0.0, -9.0]))
    depth = 9.0 / (3e6 * np.pi * radius**2)
    expected = np.tan(np.radians(degrees)) * radius**2 / (4 * depth)
    assert np.linalg.norm(press.centre_of_pressure) == pytest.approx(expected, rel=0.05)
    assert len(press.places) == len(press.pressures)
    assert press.pressures.sum() == pytest.approx(9.0)


def test_a_pad_that_pulls_or_meets_nothing_is_refused() -> None:
    pad = Pad(_flat(), 0.015)
    with pytest.raises(InputError, match="soft pad"):
        pad.press(np.zeros(3), _UP, np.array([0.0, 0.0, 9.0]))
    with pytest.raises(InputError, match="soft pad"):
        pad.press(np.array([1.0, 0.0, 0.0]), _UP, np.array([0.0, 0.0, -9.0]))
