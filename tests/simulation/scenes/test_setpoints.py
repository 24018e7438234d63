"""What a servo makes of set-points: through each of them, within its limits, and to a stop when none comes."""

import numpy as np
import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.scenes.setpoints import SetPoints

_PERIOD = 0.02
_FASTEST, _HARDEST = np.array([1.5, 0.25]), np.array([12.0, 5.0])


def _servo() -> SetPoints:
    return SetPoints(np.zeros(2), _FASTEST, _HARDEST, _PERIOD)


def _driven(
    servo: SetPoints, points: np.ndarray, after: float = 0.0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return fine times, places and speeds while a set-point is given every period."""
    times, states = [], []
    for k in range(len(points)):
        servo.give(k * _PERIOD, points[k])
        more = after if k == len(points) - 1 else 0.0
        for time in np.arange(0, _PERIOD + more - 1e-12, _PERIOD / 40):
            times.append(k * _PERIOD + time)
            states.append(servo.state(times[-1]))
    return np.array(times), np.array([s[0] for s in states]), np.array([s[1] for s in states])


def test_it_goes_through_every_set_point_within_its_limits() -> None:
    servo = _servo()
    wanted = np.column_stack([0.1 * np.sin(3 * np.arange(100) * _PERIOD), 0.01 * np.arange(100) * _PERIOD])
    wanted[:, 0] -= wanted[0, 0]
    for k in range(1, 100):
        servo.give((k - 1) * _PERIOD, wanted[k])
        if k > 5:  # the jump in speed at the beginning takes some periods
            np.testing.assert_allclose(servo.at(k * _PERIOD), wanted[k], atol=1e-12)


def test_speed_is_the_derivative_of_place_and_neither_jumps() -> None:
    rng = np.random.default_rng(0)
    times, places, speeds = _driven(_servo(), np.cumsum(rng.normal(0, 0.01, (60, 2)), axis=0), after=0.3)
    differences = np.diff(places, axis=0) / np.diff(times)[:, None]
    np.testing.assert_allclose(differences, (speeds[1:] + speeds[:-1]) / 2, atol=2e-3)
    # The cubic's hardest is four times the limit.
    assert (np.abs(np.diff(speeds, axis=0)) <= 4.001 * _HARDEST * np.diff(times)[:, None] + 1e-12).all()


def test_speed_and_its_change_from_one_set_point_to_the_next_stay_within_the_limits() -> None:
    rng = np.random.default_rng(1)
    _, _, speeds = _driven(_servo(), rng.uniform(-1, 1, (80, 2)))
    assert (np.abs(speeds).max(axis=0) <= _FASTEST * (1 + 1e-9)).all()
    assert (np.abs(speeds).max(axis=0) > 0.5 * _FASTEST).all()  # the set-points were far enough to try it
    ends = speeds[::40]
    assert (np.abs(np.diff(ends, axis=0)).max(axis=0) <= _HARDEST * _PERIOD * (1 + 1e-9)).all()


def test_a_set_point_out_of_reach_is_gone_to_at_full_speed() -> None:
    _, places, speeds = _driven(_servo(), np.tile([1.0, -1.0], (30, 1)))
    np.testing.assert_allclose(speeds[-1], [1.5, -0.25], rtol=1e-3)
    assert 0.5 < places[-1, 0] < 1.0


def test_when_none_comes_it_brakes_as_hard_as_it_can_and_stays() -> None:
    servo = _servo()
    _, places, speeds = _driven(servo, np.tile([1.0, -1.0], (10, 1)), after=0.5)
    assert np.abs(np.diff(speeds[400:], axis=0)).max(axis=0) == pytest.approx(
        _HARDEST * _PERIOD / 40, rel=1e-6
    )
    assert not speeds[-1].any()
    np.testing.assert_array_equal(servo.at(10.0), places[-1])


@pytest.mark.parametrize("bad", [[np.nan, 0.0], [np.inf, 0.0], [0.0], [[0.0, 0.0]]])
def test_a_set_point_that_is_none_is_refused_and_changes_nothing(bad: list[float]) -> None:
    servo = _servo()
    servo.give(0.0, np.array([0.001, 0.0]))
    with pytest.raises(InputError, match="give 2 finite numbers"):
        servo.give(_PERIOD, np.array(bad))
    np.testing.assert_allclose(servo.at(0.02), [0.001, 0.0])


@pytest.mark.parametrize(
    "change", [{"period": 0.0}, {"fastest": np.zeros(2)}, {"hardest": np.array([1.0, np.nan])}]
)
def test_limits_that_are_none_are_refused(change: dict) -> None:
    given = {"start": np.zeros(2), "fastest": _FASTEST, "hardest": _HARDEST, "period": _PERIOD} | change
    with pytest.raises(InputError, match="give positive numbers"):
        SetPoints(**given)
