"""The fit against a general optimiser, exact data, and chance."""

import re

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation
from weighing_files import draw_noise, draw_weighing

from contactbench.pipeline.calibration import GravityModel, PoseNoise, calibrate
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    GRAVITY,
    UNKNOWN,
    Fit,
    cross_matrix,
    maximise,
    parameter_covariance,
    two_stage,
)
from contactbench.pipeline.calibration.observability import WEAK, observe
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
    assert np.abs(two_stage(exact(truth, R_WS)) - truth.vector).max() < 1e-3
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
    fit = maximise(poses, weighing.noise.sigmas, np.where(free, two_stage(poses), 0.0), free)
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


# ---- ranks, conditions and words against the equations they summarise ----------------------------


DOWN = np.array([0.0, 0.0, -1.0])


def turns(*rotvecs: tuple[float, float, float]) -> np.ndarray:
    """R_WS, by rotation vectors in degrees."""
    return Rotation.from_rotvec(np.array(rotvecs, dtype=float), degrees=True).as_matrix()


def seen(R_WS: np.ndarray, gravity_W: np.ndarray = DOWN, **more):
    return observe(R_WS.swapaxes(1, 2), gravity_W, **more)


def directly(R_WS: np.ndarray) -> tuple[int, float, int, float]:
    """Rank and condition of [R | 1] and of [-[R g]x | 1], stacked, for a load of 1 N."""
    answers = []
    R_SW = R_WS.swapaxes(1, 2)
    for blocks in (R_SW, -cross_matrix(R_SW @ DOWN)):
        rows = np.concatenate([blocks, np.broadcast_to(np.eye(3), blocks.shape)], axis=2).reshape(-1, 6)
        values = np.linalg.svd(rows / np.sqrt(len(R_WS)), compute_uv=False)
        rank = int((values > 2e-3).sum())
        answers += [rank, values[0] / values[-1] if rank == 6 else np.inf]
    return tuple(answers)


FACES = turns((0, 0, 0), (180, 0, 0), (90, 0, 0), (-90, 0, 0), (0, 90, 0), (0, -90, 0))
REFERENCE = {
    "two poses": (turns((0, 0, 0), (50, 20, 0)), 5, 5, np.inf, np.inf),
    "four tilted about one axis": (turns((0, 0, 0), (30, 0, 0), (60, 0, 0), (90, 0, 0)), 5, 6, np.inf, None),
    "four spun about the vertical": (
        turns((0, 0, 0), (0, 0, 90), (0, 0, 180), (0, 0, -90)),
        5,
        3,
        np.inf,
        np.inf,
    ),
    "three poses": (turns((0, 0, 0), (90, 0, 0), (0, 90, 0)), 6, 6, 3.6, 2.5),
    "six faces": (FACES, 6, 6, 2.2, 1.2),
    "one pose four times": (turns(*[(20, 30, 40)] * 4), 3, 3, np.inf, np.inf),
}


@pytest.mark.parametrize("name", REFERENCE)
def test_reference_sets(name):
    R_WS, force_rank, torque_rank, force_condition, torque_condition = REFERENCE[name]
    sight = seen(R_WS)
    assert (sight.force_rank, sight.torque_rank) == (force_rank, torque_rank)
    assert sight.rank == force_rank + torque_rank
    assert sight.force_condition == pytest.approx(force_condition, abs=0.05)
    if torque_condition is not None:
        assert sight.torque_condition == pytest.approx(torque_condition, abs=0.05)
    assert sight.condition == max(sight.force_condition, sight.torque_condition)
    assert bool(sight.null_directions) == (sight.rank < 12)


def test_four_poses_within_ten_degrees_are_weak():
    conditions = []
    for seed in range(25):
        rng = np.random.default_rng(seed)
        sight = seen(turns(*rng.uniform(-10, 10, (4, 3))) @ Rotation.random(None, rng).as_matrix())
        assert (sight.force_rank, sight.torque_rank) == (6, 6)
        assert sight.condition > WEAK
        assert "of one another" in sight.weak
        conditions.append(sight.condition)
    # It depends on the draw: 16 is the best there can be, the usual one is some 40.
    assert 16 < np.min(conditions) < 27 < np.median(conditions) < 60
    corners = seen(turns((10, 0, 0), (-10, 0, 0), (0, 10, 0), (0, -10, 0)))
    assert corners.condition == pytest.approx(16.2, abs=0.05)


@given(st.integers(0, 10_000), st.integers(2, 12), st.floats(0.05, 3))
@settings(max_examples=50, deadline=None)
def test_ranks_and_conditions_are_those_of_the_stacked_equations(seed, count, spread):
    rng = np.random.default_rng(seed)
    axes = spread * rng.standard_normal((count, 3))
    R_WS = (Rotation.from_rotvec(axes) * Rotation.random(None, rng)).as_matrix()
    sight = seen(R_WS)
    expected = directly(R_WS)
    found = (sight.force_rank, sight.force_condition, sight.torque_rank, sight.torque_condition)
    assert found == pytest.approx(expected, rel=1e-6)


@given(st.integers(0, 10_000))
@settings(max_examples=30, deadline=None)
def test_frames_loads_and_repetitions_do_not_matter(seed):
    rng = np.random.default_rng(seed)
    R_WS = Rotation.random(5, rng).as_matrix()
    turned = Rotation.random(None, rng).as_matrix()
    sight = seen(R_WS)
    for other in (
        seen(R_WS @ turned),
        seen(turned @ R_WS, turned @ DOWN),
        seen(R_WS, 1e-3 * DOWN),
        seen(np.tile(R_WS, (40, 1, 1))),
        seen(R_WS[::-1]),
    ):
        assert (other.force_rank, other.torque_rank) == (sight.force_rank, sight.torque_rank)
        assert other.force_condition == pytest.approx(sight.force_condition, rel=1e-6)
        assert other.torque_condition == pytest.approx(sight.torque_condition, rel=1e-6)


# ---- words -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("R_WS", "words"),
    [
        (turns((0, 0, 0), (0, 0, 90), (0, 0, 200)), "same tilt"),
        (turns((0, 0, 0), (0, 0, 90), (0, 0, 200)) @ turns((40, 20, 0))[0], "same tilt"),
        (turns((0, 0, 0), (60, 0, 0), (120, 0, 0)), r"one horizontal axis \(bearing 0°"),
        (turns((0, 0, 0), (0, 60, 0), (0, -120, 0)), r"one horizontal axis \(bearing 90°"),
        (turns((0, 0, 0), (-60, 60, 0), (-99, 99, 0)), r"one horizontal axis \(bearing 135°"),
        (turns((0, 0, 0), (60, 0, 60), (99, 0, 99)), r"one axis \(-?0\.71, -?0\.00, -?0\.71 in the world\)"),
        (turns(*[(0, 40, 0)] * 5), "same orientation"),
    ],
)
def test_words_for_forces_name_the_axis(R_WS, words):
    first, *_ = seen(R_WS).null_directions
    assert re.search(words, first)


def test_poses_that_wobble_are_as_alike_as_the_sensor_can_tell():
    wobble = turns((0.02, 0, 0), (0, 0.03, 0), (-0.03, 0, 0))
    sight = seen(wobble @ turns((0, 0, 0), (0, 0, 90), (0, 0, 200)))
    assert sight.force_rank == 5
    assert "same tilt" in sight.null_directions[0]


def test_words_for_torques():
    assert "same direction in the sensor" in " ".join(
        seen(REFERENCE["four spun about the vertical"][0]).null_directions
    )
    assert "only two directions" in " ".join(seen(turns((0, 0, 0), (80, 0, 0))).null_directions)


def test_a_load_that_is_not_felt_shows_no_centre_of_mass():
    sight = seen(FACES, weighs=False)
    assert (sight.rank, sight.torque_rank) == (9, 3)
    assert not sight.weighs
    assert any("feels no weight" in words for words in sight.null_directions)


@pytest.mark.parametrize("angle", [1.5, 4.5, 17.2, 28.7])
def test_poses_too_much_alike_are_told_how_much(angle):
    half = angle / 2
    sight = seen(turns((half, 0, 0), (-half, 0, 0), (0, half, 0), (0, 0, half / 2)))
    assert f"within about {np.ceil(angle):.0f}° of one another" in " ".join(
        [sight.weak, *sight.null_directions]
    )


def test_poses_well_apart_are_not_called_alike():
    assert seen(FACES).weak == ""
    # Nearly one axis: badly determined, but not for being alike.
    nearly = seen(turns((0, 0, 0), (40, 0, 0), (80, 0, 0), (120, 2, 0)))
    assert nearly.condition > WEAK
    assert nearly.weak == ""


def test_weak_poses_without_full_rank_are_undetermined():
    sight = seen(turns((0, 0, 0), (5, 0, 0), (10, 0, 0)))
    assert sight.rank < 12
    assert sight.weak == ""
    assert "of one another" in sight.null_directions[0]


# ---- as a calibration sees it ------------------------------------------------------------------


def test_spun_poses_hide_the_centre_of_mass_from_a_calibration():
    rng = np.random.default_rng(1)
    spun = Rotation.from_rotvec(np.outer(np.linspace(0, 5, 8), [0, 0, 1.0])) * Rotation.from_rotvec(
        [0.5, 0.2, 0]
    )
    noise = PoseNoise(0.05, 0.002)
    sight = calibrate(weigh(draw_load(rng, (1, 1)), spun.as_matrix(), noise, rng).poses, noise).observability
    assert (sight.force_rank, sight.torque_rank) == (5, 3)
    assert any("centre of mass" in words for words in sight.null_directions)


@pytest.mark.parametrize("tilt", [0.3, 0.7])
def test_a_weight_hidden_by_the_poses_is_not_called_none(tilt):
    """A hand that turns a probe about the vertical tilts it by some tenths of a degree."""
    silent = 0
    for seed in range(8):
        rng = np.random.default_rng(seed)
        spins = Rotation.from_rotvec(np.outer(rng.uniform(0, 2 * np.pi, 8), [0, 0, 1.0]))
        wobble = Rotation.from_rotvec(np.radians(tilt) * rng.standard_normal((8, 3)))
        noise = draw_noise(rng)
        calibration = calibrate(
            weigh(draw_load(rng, (0.5, 2)), (spins * wobble).as_matrix(), noise, rng).poses, noise
        )
        silent += "feels no weight" in " ".join(calibration.verdict.reasons)
    assert silent == 0
