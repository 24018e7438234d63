"""How a platform moves."""

import numpy as np
import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.scenes import PlatformMotion
from contactbench.pipeline.simulation.scenes.platform import AXES


@pytest.mark.parametrize("axis", AXES)
def test_it_rests_and_then_goes_as_a_sine_along_or_about_one_axis(axis: str) -> None:
    motion = PlatformMotion.along(axis, 0.01, 2.0, start=1.0)
    assert not motion.at(0.99).any()
    for time, share in ((1.5, 1.0), (2.0, 0.0), (2.5, -1.0)):
        wanted = 0.01 * share * np.eye(6)[AXES.index(axis)]
        np.testing.assert_allclose(motion.at(time), wanted, atol=1e-15)


def test_its_speed_is_the_derivative() -> None:
    motion = PlatformMotion(np.arange(1.0, 7.0) * 1e-3, 3.0, 0.5)
    np.testing.assert_allclose(
        motion.speed(1.1), 2 * np.pi / 3 * np.cos(0.4 * np.pi) * motion.amplitude, rtol=1e-6
    )
    assert not motion.speed(0.4).any()


def test_it_can_begin_gently() -> None:
    motion = PlatformMotion(np.eye(6)[2] * 0.01, 2.0, start=1.0, ease=2.0)
    assert motion.at(1.5)[2] == pytest.approx(0.0025)
    assert motion.at(5.5)[2] == pytest.approx(0.01)
    assert motion.speed(1.001)[2] < 1e-3 * motion.speed(5.0)[2] + 2e-4


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((np.zeros(5), 2.0), "six finite numbers"),
        ((np.full(6, np.nan), 2.0), "six finite numbers"),
        ((np.zeros(6), 0.0), "period"),
        ((np.zeros(6), np.nan), "period"),
        ((np.zeros(6), 2.0, -1.0), "start"),
        ((np.zeros(6), 2.0, 0.0, -1.0), "ease"),
    ],
)
def test_motions_that_are_none_are_refused(values: tuple, message: str) -> None:
    with pytest.raises(InputError, match=message):
        PlatformMotion(*values)


def test_an_axis_that_is_none_is_refused() -> None:
    with pytest.raises(InputError, match="give one of x, y, z"):
        PlatformMotion.along("up", 0.01, 2.0)
