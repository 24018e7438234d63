"""The delay between a sensor and a robot, from motion."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactbench.pipeline.recording import FlangeTrack, RecordingError, WrenchTrack
from contactbench.pipeline.recording.delay import Delay, estimate_delay

G = np.array([0.0, 0.0, -5.0])
R_SE = Rotation.from_euler("xyz", [10, -20, 75], degrees=True)


def turning(times, angle=40.0):
    """R_BE at times: a slow turn about two axes."""
    a = np.radians(angle) * np.sin(2 * np.pi * 0.2 * times)
    b = np.radians(angle) * np.sin(2 * np.pi * 0.13 * times + 1)
    return Rotation.from_euler("xyz", np.column_stack((a, b, 0 * a)))


def tracks(delay, noise=0.05, seconds=20.0, angle=40.0, seed=0, start=100.0):
    rng = np.random.default_rng(seed)
    heard = np.arange(0, seconds, 1 / 200) + start
    forces = R_SE.apply(turning(heard - delay, angle).inv().apply(G)) + [1.0, -2.0, 3.0]
    wrenches = np.column_stack((forces + rng.normal(0, noise, forces.shape), np.zeros((len(heard), 3))))
    n = len(heard)
    none = np.full(n, np.nan)
    force = WrenchTrack(heard, wrenches, np.arange(n), np.zeros(n, dtype=np.int64), none, none, none)
    said = np.arange(-1, seconds + 1, 1 / 50) + start
    R_BE = turning(said, angle).as_matrix()
    none = np.full(len(said), np.nan)
    pose = FlangeTrack(said, R_BE, np.full((len(said), 3), np.nan), np.zeros((len(said), 0)), none, none)
    return force, pose


@pytest.mark.parametrize("delay", [-0.08, 0.0, 0.0123, 0.2])
def test_the_delay_is_found_within_its_sigma(delay):
    found = estimate_delay(*tracks(delay))
    assert found.sigma < 0.002
    assert abs(found.seconds - delay) < max(4 * found.sigma, 2e-4)


@pytest.mark.parametrize(
    ("delay", "words"),
    [
        (0.0123, "ms later than the robot."),
        (0.0, "no delay is applied"),
        (-0.02, "publishes its poses late. The delay is not applied. To apply it anyway"),
        (0.2, "use one clock, and that this robot holds the sensor. The delay is not applied."),
    ],
)
def test_a_delay_is_used_where_it_can_be_trusted(delay, words):
    found = estimate_delay(*tracks(delay))
    seconds, sentence = found.usable
    assert words in sentence
    assert seconds == (found.seconds if delay == 0.0123 else 0.0)


def test_a_delay_of_unknown_or_large_sigma_is_not_used():
    assert Delay(0.02, None, "Late.").usable[0] == 0.0
    assert Delay(0.02, 0.0067, "Late.").usable[0] == 0.0
    assert Delay(0.02, 0.0066, "Late.").usable == (0.02, "Late.")
    assert Delay(None, None, "No.").usable[0] == 0.0


def test_the_sigma_is_honest():
    off = []
    for seed in range(16):
        found = estimate_delay(*tracks(0.05, noise=0.1, seconds=8.0, seed=seed))
        off.append((found.seconds - 0.05) / found.sigma)
    # Slerp between poses 20 ms apart adds a ripple to what noise alone would do: 1.5 was measured over 24.
    assert 0.7 < np.std(off) < 2.0
    assert abs(np.mean(off)) < 1.0


def test_a_large_bias_moves_nothing_where_the_flange_turns_about_one_axis():
    rng = np.random.default_rng(3)
    force, pose = tracks(0.05)

    def turned(times):
        return Rotation.from_rotvec(np.outer(np.sin(1.3 * times), [np.radians(20.0), 0.0, 0.0]))

    shaken = turned(pose.times) * Rotation.from_rotvec(1e-4 * rng.normal(size=(len(pose.times), 3)))
    forces = turned(force.times - 0.05).inv().apply([0.0, 0.0, -2.0]) + rng.normal(
        0, 0.01, (len(force.times), 3)
    )

    def found(bias):
        wrenches = np.column_stack((forces + bias, force.wrenches[:, 3:]))
        return estimate_delay(replace(force, wrenches=wrenches), replace(pose, R_BE=shaken.as_matrix()))

    without, told = found(0.0), found(1e5)
    assert abs(without.seconds - 0.05) < 4 * without.sigma
    assert told.seconds == pytest.approx(without.seconds, abs=0.01 * without.sigma)
    assert told.sigma == pytest.approx(without.sigma, rel=0.01)


def test_a_robot_that_stands_still_shows_nothing():
    found = estimate_delay(*tracks(0.05, angle=1.0))
    assert found.seconds is None
    assert "hardly turned" in found.sentence


def test_another_robot_is_noticed():
    force, _ = tracks(0.05)
    _, pose = tracks(0.05, angle=40.0)
    shuffled = replace(pose, R_BE=Rotation.random(len(pose.times), random_state=0).as_matrix())
    found = estimate_delay(force, shuffled)
    assert found.seconds is None
    assert "check that this robot" in found.sentence


def test_too_little_is_refused():
    force, pose = tracks(0.0, seconds=0.3)
    late = replace(pose, times=pose.times + 50)
    with pytest.raises(RecordingError, match="record both for longer"):
        estimate_delay(force, late)


def thinned(pose, kept):
    return FlangeTrack(*(values[kept] for values in vars(pose).values()))


def test_a_sensor_and_a_robot_on_one_grid():
    force, _ = tracks(0.05, start=0.0)
    both = np.arange(0, 20, 0.01)
    pose = FlangeTrack(
        both,
        turning(both).as_matrix(),
        np.zeros((len(both), 3)),
        np.zeros((len(both), 0)),
        np.full(len(both), np.nan),
        np.full(len(both), np.nan),
    )
    assert abs(estimate_delay(force, pose).seconds - 0.05) < 1e-3


@pytest.mark.parametrize("gap", [0.26, 0.27, 0.35, 0.6, 2.0])
def test_rows_beside_a_gap_are_left_out_at_every_shift(gap):
    force, pose = tracks(0.05)
    found = estimate_delay(force, thinned(pose, ~((pose.times > 108) & (pose.times < 108 + gap))))
    assert abs(found.seconds - 0.05) < max(4 * found.sigma, 2e-4)
    assert not found.doubt


def test_a_touch_makes_the_delay_doubtful():
    force, pose = tracks(0.05)
    assert not estimate_delay(force, pose).doubt
    force.wrenches[(force.times > 108) & (force.times < 109), 0] += 20.0
    found = estimate_delay(force, pose)
    assert "something was touched" in found.doubt
    assert found.doubt in found.sentence
