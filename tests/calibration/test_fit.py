"""The fit against a general optimiser, exact data, and chance."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation
from weighing_files import draw_weighing

from contactbench.pipeline.calibration import GravityModel, PoseNoise
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    GRAVITY,
    UNKNOWN,
    Fit,
    maximise,
    parameter_covariance,
    prediction_jacobian,
    two_stage,
)
from contactbench.pipeline.calibration.observability import observe
from contactbench.pipeline.calibration.poses import Stack, stack
from contactbench.pipeline.calibration.reml import NoisePrior, fit_with_noise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.loads import draw_load, weigh

NOTHING = np.zeros(6)


def rng_of(seed: int) -> np.random.Generator:
    return np.random.default_rng([seed, 11])


def exact(truth: GravityModel, R_WS: np.ndarray) -> Stack:
    moments = np.linspace(0, 1, len(R_WS))
    return Stack(np.ascontiguousarray(R_WS.swapaxes(1, 2)), truth.predict(R_WS), moments)


def unknown(poses: Stack, least: np.ndarray = NOTHING, kept: float = 1.0) -> tuple[Fit, PoseNoise]:
    """Fit poses of exact orientations whose noise nobody gave."""
    noisy = fit_with_noise(poses, NoisePrior(None, least, 0.0, guessed=False), kept=kept)
    return noisy.fit, noisy.noise


def predicted(theta: np.ndarray, poses: Stack) -> np.ndarray:
    return GravityModel.from_vector(theta, np.zeros((12, 12))).predict(poses.R_SW.swapaxes(1, 2))


def by_general_optimiser(poses: Stack, sigmas: np.ndarray, start: np.ndarray) -> np.ndarray:
    def residuals(theta: np.ndarray) -> np.ndarray:
        return ((poses.wrenches - predicted(theta, poses)) / sigmas).ravel()

    found = least_squares(residuals, start, method="lm", x_scale=UNKNOWN, xtol=1e-15, ftol=1e-15, gtol=1e-15)
    return found.x


# ---- exact data --------------------------------------------------------------------------------


@given(st.integers(0, 10_000), st.integers(3, 12), st.sampled_from([0.0, 10.0, 500.0]))
@settings(max_examples=25, deadline=None)
def test_exact_readings_give_the_exact_parameters(seed, count, bias):
    rng = rng_of(seed)
    load, R_WS = draw_load(rng), Rotation.random(count, rng).as_matrix()
    off = rng.uniform(-bias, bias, 3)
    truth = GravityModel(load.gravity_W + [0.5, -0.3, 0], off, load.centre_of_mass_S, off / 50)
    poses = exact(truth, R_WS)
    assume(observe(poses.R_SW, truth.gravity_W).condition < 30)
    fit = maximise(poses, PoseNoise(1e-6, 1e-8).sigmas, two_stage(poses))
    assert np.abs(fit.theta - truth.vector).max() < 1e-10
    rough = maximise(poses, PoseNoise(0.05, 0.002).sigmas, two_stage(poses))
    assert (np.abs(rough.theta - truth.vector) / np.sqrt(np.diag(rough.covariance))).max() < 1e-4


def test_least_squares_starts_within_a_thousandth():
    rng = rng_of(1)
    truth, R_WS = draw_load(rng, (1.0, 1.0)), Rotation.random(8, rng).as_matrix()
    start = two_stage(exact(truth, R_WS))
    assert np.abs(start - truth.vector).max() < 1e-3
    # Spun about the vertical there is no telling: nothing is made up for what is not seen.
    spun = Rotation.from_rotvec(np.outer(np.arange(5), [0, 0, 1.0])).as_matrix()
    blind = two_stage(exact(truth, spun))
    assert abs(blind[2]) < 1e-6
    assert np.isfinite(blind).all()


# ---- the maximum -------------------------------------------------------------------------------


@pytest.mark.parametrize("noise", [PoseNoise(0.1, 0.003), PoseNoise([0.05, 0.1, 0.4], [0.004, 0.001, 0.002])])
@pytest.mark.parametrize("count", [3, 4, 12])
def test_the_maximum_is_that_of_a_general_optimiser(noise, count):
    rng = rng_of(count)
    poses = stack(
        weigh(draw_load(rng, (0.2, 0.5)), Rotation.random(count, rng).as_matrix(), noise, rng).poses
    )
    fit = maximise(poses, noise.sigmas, two_stage(poses))
    best = by_general_optimiser(poses, noise.sigmas, fit.theta)
    sigmas = np.sqrt(np.diag(fit.covariance))
    assert (np.abs(fit.theta - best) / sigmas).max() < 1e-3
    cost = np.sum(((poses.wrenches - predicted(best, poses)) / noise.sigmas) ** 2)
    assert fit.cost == pytest.approx(cost, rel=1e-6)


def test_a_noisy_axis_counts_less():
    """Twelve poses, one axis of force a hundred times noisier: the others must not suffer."""
    rng = rng_of(3)
    noise = PoseNoise([0.01, 0.01, 1.0], 10.0)
    off = []
    for _ in range(20):
        weighing = weigh(draw_load(rng), Rotation.random(12, rng).as_matrix(), noise, rng)
        poses = stack(weighing.poses)
        fit = maximise(poses, noise.sigmas, two_stage(poses))
        off.append((fit.theta - weighing.truth.vector)[GRAVITY] / np.sqrt(np.diag(fit.covariance))[GRAVITY])
        assert np.sqrt(np.diag(fit.covariance))[GRAVITY].max() < 0.012
    assert np.sqrt(np.mean(np.square(off))) == pytest.approx(1.0, abs=0.25)


def test_torques_help_to_find_the_weight():
    rng = rng_of(4)
    noise = PoseNoise(0.3, 0.0005)
    first, both = [], []
    for _ in range(30):
        weighing = weigh(draw_load(rng, (0.5, 0.5)), Rotation.random(8, rng).as_matrix(), noise, rng)
        poses = stack(weighing.poses)
        start = two_stage(poses)
        first.append((start - weighing.truth.vector)[GRAVITY])
        both.append((maximise(poses, noise.sigmas, start).theta - weighing.truth.vector)[GRAVITY])
    assert np.std(both) < 0.8 * np.std(first)


def test_the_covariance_is_the_inverse_of_the_information():
    rng = rng_of(5)
    weighing = draw_weighing(rng, poses=(9, 9))
    poses, sigmas = stack(weighing.poses), weighing.noise.sigmas
    fit = maximise(poses, sigmas, two_stage(poses))
    J = (prediction_jacobian(poses.R_SW, fit.theta) / sigmas[:, None]).reshape(-1, 12)
    scale = np.sqrt(np.diag(fit.covariance))
    assert np.abs((fit.covariance - np.linalg.inv(J.T @ J)) / np.outer(scale, scale)).max() < 1e-6
    assert np.allclose(fit.residuals * sigmas, poses.wrenches - predicted(fit.theta, poses))


def test_what_is_not_seen_is_stated_as_unknown():
    """Poses spun about the vertical tell nothing of the weight along it, and all of what lies across it."""
    rng = rng_of(6)
    spun = Rotation.from_rotvec(np.outer(np.linspace(0, 5, 6), [0, 0, 1.0])).as_matrix()
    noise = PoseNoise(0.05, 0.002)
    poses = stack(weigh(draw_load(rng), spun, noise, rng).poses)
    fit = maximise(poses, noise.sigmas, two_stage(poses))
    sigmas = np.sqrt(np.diag(fit.covariance))
    # Weight and bias share the open direction, so each has about 1/sqrt(2) of its width.
    assert sigmas[2] == pytest.approx(UNKNOWN[0] / np.sqrt(2), rel=0.05)
    assert sigmas[5] == pytest.approx(UNKNOWN[0] / np.sqrt(2), rel=0.05)
    assert sigmas[[0, 1]].max() < 0.1
    assert np.allclose(np.sqrt(np.diag(parameter_covariance(np.zeros((3, 6, 12))))), UNKNOWN)


def test_held_parameters_stay_and_are_called_unknown():
    weighing = draw_weighing(rng_of(7), poses=(8, 8))
    poses = stack(weighing.poses)
    free = np.ones(12, dtype=bool)
    free[CENTRE_OF_MASS] = False
    start = np.where(free, two_stage(poses), 0.0)
    fit = maximise(poses, weighing.noise.sigmas, start, free)
    assert np.array_equal(fit.theta[CENTRE_OF_MASS], np.zeros(3))
    assert np.allclose(np.sqrt(np.diag(fit.covariance))[CENTRE_OF_MASS], UNKNOWN[CENTRE_OF_MASS])
    assert np.abs(fit.theta[GRAVITY] - weighing.truth.gravity_W).max() < 1.0


# ---- noise that is not known -------------------------------------------------------------------


def test_estimated_noise_scatters_as_its_degrees_of_freedom_say():
    rng = rng_of(8)
    squares, freedoms, counted = np.zeros(2), np.zeros(2), 0
    for _ in range(60):
        weighing = draw_weighing(rng, poses=(4, 10))
        poses = stack(weighing.poses)
        _, noise = unknown(poses)
        assert noise.estimated
        counted += 6 * len(poses) - 12
        ratio = noise.sigmas[[0, 3]] / weighing.noise.sigmas[[0, 3]]
        squares += ratio**2 * noise.freedom
        freedoms += noise.freedom
    chance = 3.5 * np.sqrt(2 / freedoms)
    assert (np.abs(squares / freedoms - 1) < chance).all()
    assert freedoms.sum() == pytest.approx(counted, rel=0.05)
    assert chance.max() < 0.2


def test_poses_kept_for_being_near_do_not_make_the_noise_look_small():
    rng = rng_of(9)
    ratios = []
    for _ in range(3):
        noise = PoseNoise(0.1, 0.003)
        weighing = weigh(draw_load(rng), Rotation.random(200, rng).as_matrix(), noise, rng)
        poses = stack(weighing.poses)
        off = (poses.wrenches - predicted(weighing.truth.vector, poses)) / noise.sigmas
        near = np.argsort((off**2).sum(axis=1))[:140]
        naive, aware = (unknown(poses.take(near), kept=kept)[1].sigmas[0] / 0.1 for kept in (1.0, 0.7))
        assert naive < 0.9
        ratios.append(aware)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.04)


def test_noise_is_at_least_what_the_samples_say():
    weighing = draw_weighing(rng_of(10), poses=(8, 8), force_noise=(0.01, 0.01), torque_noise=(0.001, 0.001))
    least = np.array([1.0, 2.0, 3.0, 1e-9, 1e-9, 0.5])
    _, noise = unknown(stack(weighing.poses), least)
    assert np.array_equal(noise.sigmas[[0, 1, 2, 5]], least[[0, 1, 2, 5]])
    assert 3e-4 < noise.sigmas[3] < 3e-3
    assert noise.sigmas[3] == noise.sigmas[4]


@pytest.mark.parametrize("count", [3, 8])
def test_data_without_noise_fit_with_noise_unknown(count):
    rng = rng_of(12)
    truth, R_WS = draw_load(rng, (1, 1)), Rotation.random(count, rng).as_matrix()
    fit, noise = unknown(exact(truth, R_WS))
    assert np.abs(fit.theta - truth.vector).max() < 1e-10
    assert 0 < noise.sigmas.max() < 1e-5


@pytest.mark.parametrize(
    "value", [0.0, -0.1, np.nan, np.inf, [0.1, 0.1], [0.1, 0.0, 0.1], [0.1, np.nan, 0.1], np.ones((3, 3))]
)
def test_noise_that_is_none_is_refused(value):
    with pytest.raises(InputError, match=r"PoseNoise\.force"):
        PoseNoise(value, 0.002)
    with pytest.raises(InputError, match=r"PoseNoise\.torque"):
        PoseNoise(0.05, value)


def test_noise_of_one_number_holds_for_three_axes():
    assert PoseNoise(0.1, [1, 2, 3]).sigmas.tolist() == [0.1, 0.1, 0.1, 1, 2, 3]
    assert PoseNoise(0.1, 0.2).freedom == (np.inf, np.inf)
