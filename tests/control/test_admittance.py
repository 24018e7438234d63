import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from contactbench.pipeline.control.inverse import Admittance
from contactbench.pipeline.errors import InputError

sizes = st.floats(0.05, 50.0)


@given(sizes, sizes, st.one_of(st.just(0.0), sizes), st.floats(-5, 5), st.floats(0.005, 0.5))
def test_it_is_the_solution_of_its_equation(mass, damping, stiffness, error, dt):
    axis = Admittance(mass, damping, stiffness)
    axis.speed, axis.path = 0.3, 0.1
    steps = [axis.step(error, dt) for _ in range(3)]
    exact = solve_ivp(
        lambda _, y: [y[1], (error - damping * y[1] - stiffness * y[0]) / mass],
        (0, 3 * dt), [0.1, 0.3], rtol=1e-10, atol=1e-12, method="DOP853",
    ).y[:, -1]  # fmt: skip
    assert axis.path == pytest.approx(exact[0], rel=1e-6, abs=1e-8)
    assert axis.speed == pytest.approx(exact[1], rel=1e-6, abs=1e-8)
    assert sum(steps) * dt == pytest.approx(axis.path - 0.1, rel=1e-9, abs=1e-12)


def test_a_step_that_is_far_too_long_ends_where_it_must():
    assert Admittance(0.1, 100.0).step(7.0, 1000.0) == pytest.approx(0.07, rel=1e-4)
    sprung = Admittance(0.1, 100.0, 50.0)
    sprung.step(7.0, 1e6)
    assert (sprung.path, sprung.speed) == (pytest.approx(0.14), pytest.approx(0.0, abs=1e-12))


def test_critical_damping_is_no_hole():
    near, at = Admittance(1.0, 2.0 * (1 + 1e-5), 1.0), Admittance(1.0, 2.0, 1.0)
    assert near.step(1.0, 0.7) == pytest.approx(at.step(1.0, 0.7), rel=1e-4)


@pytest.mark.parametrize("wrong", [(0, 1, 0), (1, -1, 0), (1, 1, -1), (np.nan, 1, 0), (1, np.inf, 0)])
def test_what_cannot_be_is_refused(wrong):
    with pytest.raises(InputError, match="admittance"):
        Admittance(*wrong)


@pytest.mark.parametrize("wrong", [(np.nan, 0.02), (1.0, 0.0), (1.0, np.inf)])
def test_an_error_that_is_no_number_moves_nothing(wrong):
    axis = Admittance(1.0, 1.0)
    with pytest.raises(InputError, match="finite"):
        axis.step(*wrong)
    assert (axis.speed, axis.path) == (0.0, 0.0)


@pytest.mark.parametrize("stiffness", [0.0, 400.0])
def test_what_a_limit_left_out_does_not_wind_up(stiffness):
    free, held = (Admittance(10.0, 300.0, stiffness) for _ in range(2))
    for _ in range(100):
        free.step(50.0, 0.02)
        held.hold_back(0.1, 0.02, held.step(50.0, 0.02))
    assert abs(held.path) < 0.2 * abs(free.path)
    # Once the error turns, it turns at once.
    assert held.step(-50.0, 0.02) < 0


def test_all_that_was_done_is_kept():
    one, other = Admittance(10.0, 300.0), Admittance(10.0, 300.0)
    for _ in range(10):
        one.step(5.0, 0.02)
        other.hold_back(1.0, 0.02, other.step(5.0, 0.02))
    assert (one.path, one.speed) == (other.path, other.speed)
