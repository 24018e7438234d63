"""Simulated weighings hold what they promise: their physics, their noise, their bumps, their seed."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from weighing_files import draw_noise, draw_weighing

from contactbench.pipeline.calibration import GravityModel, PoseNoise
from contactbench.pipeline.calibration.model import STANDARD_GRAVITY, cross_matrix
from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.simulation.loads import Weighing, bump, draw_load, weigh


def off(weighing: Weighing) -> np.ndarray:
    """(n, 6) read minus true."""
    arrays = stack(weighing.poses)
    return arrays.wrenches - weighing.truth.predict(arrays.R_SW.swapaxes(1, 2))


def test_loads_are_within_their_ranges(rng):
    loads = [draw_load(rng, (0.3, 0.7)) for _ in range(300)]
    masses = np.array([load.mass for load in loads])
    assert 0.3 <= masses.min() < 0.32
    assert 0.68 < masses.max() <= 0.7
    assert all(load.gravity_W[2] == pytest.approx(-load.mass * STANDARD_GRAVITY) for load in loads)
    assert not np.array([load.gravity_W[:2] for load in loads]).any()
    centres = np.array([load.centre_of_mass_S for load in loads])
    assert centres[:, 2].min() >= 0.02
    assert centres[:, 2].max() <= 0.15
    assert np.abs(centres[:, :2]).max() <= 0.02
    for bias, most in (("force_bias", 10), ("torque_bias", 0.5)):
        drawn = np.abs([getattr(load, bias) for load in loads])
        assert 0.95 * most < drawn.max() <= most


def test_noise_is_within_its_range(rng):
    drawn = [draw_noise(rng, (0.02, 0.2), (0.001, 0.01)).sigmas for _ in range(300)]
    forces, torques = np.array(drawn)[:, 0], np.array(drawn)[:, 3]
    assert 0.02 <= forces.min() < 0.025
    assert 0.195 < forces.max() <= 0.2
    assert 0.001 <= torques.min() < 0.0012
    assert torques.max() <= 0.01
    assert abs(np.corrcoef(forces, torques)[0, 1]) < 0.2


def test_readings_have_the_noise_that_was_given(rng):
    noise = PoseNoise([0.1, 0.2, 0.3], [0.01, 0.02, 0.03])
    truth = draw_load(rng)
    weighing = weigh(truth, Rotation.random(10_000, rng).as_matrix(), noise, rng)
    scaled = off(weighing) / noise.sigmas
    assert np.abs(scaled.mean(axis=0)).max() < 0.04
    assert np.abs(np.cov(scaled.T) - np.eye(6)).max() < 0.06
    assert (np.abs(scaled) < 2).mean() == pytest.approx(0.9545, abs=0.005)
    assert weighing.truth is truth
    assert weighing.noise is noise
    assert not weighing.bumped.any()


def test_drawn_weighings_span_what_they_should(rng):
    drawn = [draw_weighing(rng, poses=(4, 6), mass=(1, 1)) for _ in range(60)]
    assert {len(weighing.poses) for weighing in drawn} == {4, 5, 6}
    assert all(weighing.truth.mass == pytest.approx(1) for weighing in drawn)
    R_WS = np.concatenate([[pose.R_WS for pose in weighing.poses] for weighing in drawn])
    assert np.abs(R_WS.mean(axis=0)).max() < 0.12  # no orientation is preferred


def test_half_of_the_bumps_push_and_half_only_turn(rng):
    plain = weigh(draw_load(rng), Rotation.random(1_000, rng).as_matrix(), PoseNoise(1e-9, 1e-9), rng)
    bumped = bump(plain, 0.4, rng, force=(2.0, 20.0))
    assert bumped.bumped.sum() == 400
    assert bumped.truth is plain.truth
    left = off(bumped)
    assert np.abs(left[~bumped.bumped]).max() < 1e-6
    F, M = left[bumped.bumped, :3], left[bumped.bumped, 3:]
    size = np.linalg.norm(F, axis=1)
    pushed = size > 1e-6
    assert 150 < pushed.sum() < 250
    assert 2 <= size[pushed].min() < 2.5
    assert 19.5 < size[pushed].max() <= 20
    assert np.abs(F[pushed].mean(axis=0)).max() < 2.5  # from all sides
    # A push at the tool: M = lever x F, the lever 130 to 170 mm along z and 150 mm on average.
    assert np.abs(np.einsum("ij,ij->i", F[pushed], M[pushed])).max() < 1e-5
    assert (np.linalg.norm(M[pushed], axis=1) / size[pushed]).max() < 0.173
    lever = np.linalg.lstsq(-cross_matrix(F[pushed]).reshape(-1, 3), M[pushed].ravel(), rcond=None)[0]
    assert np.allclose(lever, [0, 0, 0.15], atol=0.005)
    turned = np.linalg.norm(M[~pushed], axis=1)
    assert turned.min() + 1e-6 >= 0.1
    assert turned.max() <= 1.0 + 1e-6


def test_bumps_add_up_and_leave_the_original_alone(rng):
    plain = draw_weighing(rng, poses=(10, 10))
    before = stack(plain.poses).wrenches.copy()
    once = bump(plain, 0.2, rng)
    twice = bump(once, 0.3, rng)
    assert once.bumped.sum() == 2
    assert (twice.bumped | once.bumped).sum() == twice.bumped.sum() <= 5
    assert not plain.bumped.any()
    assert np.array_equal(stack(plain.poses).wrenches, before)
    assert not bump(plain, 0.0, rng).bumped.any()
    assert bump(plain, 1.0, rng).bumped.all()


def test_same_seed_same_bytes():
    def drawn(seed: int) -> bytes:
        rng = np.random.default_rng(seed)
        weighing = bump(draw_weighing(rng), 0.3, rng)
        return stack(weighing.poses).wrenches.tobytes() + weighing.bumped.tobytes()

    assert drawn(5) == drawn(5)
    assert drawn(5) != drawn(6)


def test_readings_follow_the_model_that_calibration_assumes():
    """By hand: 1 kg, 100 mm along z, the sensor's x axis down."""
    truth = GravityModel([0, 0, -STANDARD_GRAVITY], [1, 2, 3], [0, 0, 0.1], [0.1, 0.2, 0.3])
    R_WS = np.array([[[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]]])
    [pose] = weigh(truth, R_WS, PoseNoise(1e-12, 1e-12), np.random.default_rng(0)).poses
    assert np.allclose(pose.force, [1 + 9.80665, 2, 3], atol=1e-9)
    assert np.allclose(pose.torque, [0.1, 0.2 + 0.980665, 0.3], atol=1e-9)
