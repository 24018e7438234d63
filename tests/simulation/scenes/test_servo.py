"""The position servo of an arm: what it asks of the joints, and what the controller reads."""

import numpy as np
import pytest

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.simulation.scenes.setpoints import JointServo, ServoSettings

_STEP, _PERIOD = 0.001, 0.02
ROBOT = Robot.named("elfin3")
_START = np.array([0.1, 0.2, 1.5, -0.1, 1.2, 0.3])


def _driven(servo: JointServo, set_points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return places, speeds and accelerations of joints that do what the servo asks."""
    q, speed, rows = _START.copy(), np.zeros(6), []
    for k in range(len(set_points) * 20):
        if k % 20 == 0:
            servo.command(k * _STEP, set_points[k // 20])
        asked = servo.acceleration(k * _STEP, q, speed)
        speed = speed + _STEP * asked
        q = q + _STEP * speed
        rows.append((q, speed, asked))
    return tuple(np.array(each) for each in zip(*rows, strict=True))  # type: ignore[return-value]


def _servo(**settings: float) -> JointServo:
    return JointServo(ROBOT, _START, ServoSettings(**settings), _STEP)  # type: ignore[arg-type]


def test_it_follows_a_slow_motion_closely() -> None:
    times = np.arange(1, 151) * _PERIOD  # each is where to be when the next is given
    wanted = _START + 0.1 * np.sin(2 * np.pi * times / 2.0)[:, None] * np.ones(6)
    q, _, _ = _driven(_servo(), wanted)
    # It lags by acceleration / bandwidth², 1 rad/s² / (60 rad/s)² at most, after the jump in speed.
    assert np.abs(q[19::20][50:] - wanted[50:]).max() < 4e-4


def test_it_never_passes_the_limits_of_the_arm_however_it_is_commanded() -> None:
    wanted = _START + np.random.default_rng(0).uniform(-0.8, 0.8, (100, 6))
    wanted[50:] = _START + np.array([1, -1, 1, -1, 1, -1])
    _, speeds, asked = _driven(_servo(), wanted)
    assert (np.abs(speeds).max(axis=0) <= ROBOT.velocity_limits * (1 + 1e-9)).all()
    assert (np.abs(asked).max(axis=0) <= ROBOT.acceleration_limits * (1 + 1e-9)).all()
    assert (np.abs(asked).max(axis=0) > 0.99 * ROBOT.acceleration_limits).all()
    assert np.abs(speeds).max() > 1.2


def test_it_comes_to_rest_at_a_far_set_point() -> None:
    wanted = np.tile(_START + 0.7, (150, 1))
    q, speeds, _ = _driven(_servo(), wanted)
    np.testing.assert_allclose(q[-1], wanted[-1], atol=1e-4)
    assert np.abs(speeds[-1]).max() < 1e-3


def test_a_lasting_push_is_met_wholly() -> None:
    servo = _servo()
    q, speed = _START.copy(), np.zeros(6)
    off = []
    for k in range(500):
        speed = speed + _STEP * (servo.acceleration(k * _STEP, q, speed) + 5.0)
        q = q + _STEP * speed
        off.append(q[0] - _START[0])
    assert 5e-5 < max(off) < 5.0 / (2 * 120.0**2)
    assert abs(off[-1]) < 1e-7


def test_asked_twice_it_answers_the_same() -> None:
    answers = []
    for times in (1, 3):
        servo = _servo()
        servo.command(0.0, _START + 0.001)
        for k in range(10):
            for _ in range(times):
                asked = servo.acceleration(k * _STEP, _START + 1e-4, np.zeros(6))
        answers.append(asked)
    np.testing.assert_array_equal(*answers)


def test_a_slower_loop_lags_more() -> None:
    wanted = _START + 0.1 * np.sin(np.arange(1, 101) * 0.1)[:, None] * np.ones(6)
    lags = [
        np.abs(_driven(_servo(bandwidth=w), wanted)[0][19::20][30:] - wanted[30:]).max() for w in (30.0, 90.0)
    ]
    assert lags[0] > 4 * lags[1]


def test_encoders_round_to_their_counts() -> None:
    servo = _servo(counts=1000)
    count = 2 * np.pi / 1000
    read = servo.read(_START)
    np.testing.assert_allclose(read / count, np.round(read / count), atol=1e-9)
    assert 0 < np.abs(read - _START).max() <= count / 2


def test_set_points_beyond_a_limit_or_not_finite_are_refused() -> None:
    servo = _servo()
    with pytest.raises(InputError, match=r"set-point: joint J3 is at 2\.7"):
        servo.command(0.0, np.array([0, 0, 2.7, 0, 0, 0]))
    with pytest.raises(InputError, match="set-point: joint angles must be finite"):
        servo.command(0.0, np.full(6, np.nan))


@pytest.mark.parametrize(
    "settings", [{"period": 0.0}, {"bandwidth": np.nan}, {"stiffness": 0.0}, {"counts": -1}]
)
def test_settings_that_are_none_are_refused(settings: dict) -> None:
    with pytest.raises(InputError, match="servo: period, bandwidth, stiffness and counts"):
        ServoSettings(**settings)
