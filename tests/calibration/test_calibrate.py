"""A calibration as a whole: right, honest about how right, and plain about what is wrong."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from scipy.stats import chi2
from weighing_files import LOAD, NOISE, draw_weighing

from contactbench.pipeline.calibration import (
    PARAMETERS,
    Calibration,
    ContactTask,
    GravityModel,
    Level,
    Limits,
    PoseError,
    PoseNoise,
    PoseSample,
    calibrate,
)
from contactbench.pipeline.calibration.model import UNKNOWN, prediction_jacobian
from contactbench.pipeline.calibration.orientation import plain
from contactbench.pipeline.calibration.poses import named, stack
from contactbench.pipeline.calibration.verdict import _off_down, judge
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.loads import draw_load, weigh

EXACT = PoseNoise(1e-12, 1e-12)
VERTICAL = np.array([0.0, 0.0, 1.0])


def held(count: int, seed: int = 0, load: GravityModel = LOAD, noise: PoseNoise = NOISE) -> list[PoseSample]:
    rng = np.random.default_rng([seed, 31])
    return list(weigh(load, Rotation.random(count, rng).as_matrix(), noise, rng).poses)


def posed(R_WS: np.ndarray, load: GravityModel = LOAD, noise: PoseNoise = NOISE) -> list[PoseSample]:
    return list(weigh(load, R_WS, noise, np.random.default_rng(32)).poses)


def spun(count: int = 8) -> np.ndarray:
    return Rotation.from_rotvec(np.outer(np.linspace(0, 5, count), VERTICAL)).as_matrix()


def close(degrees: float, count: int = 12) -> np.ndarray:
    axes = np.random.default_rng(33).standard_normal((count, 3))
    axes *= np.radians(degrees) / np.linalg.norm(axes, axis=1)[:, None]
    return Rotation.from_rotvec(axes).as_matrix()


def said(calibration: Calibration) -> str:
    return " ".join(calibration.verdict.reasons)


def off(calibration: Calibration, truth: GravityModel = LOAD) -> np.ndarray:
    """Errors of the parameters, in stated standard deviations."""
    return np.abs(calibration.model.vector - truth.vector) / np.sqrt(np.diag(calibration.covariance))


# ---- right -------------------------------------------------------------------------------------


@given(st.integers(0, 10_000), st.integers(3, 10))
@settings(max_examples=15, deadline=None)
def test_exact_poses_are_recovered_to_rounding(seed, count):
    rng = np.random.default_rng([seed, 34])
    truth = draw_load(rng)
    poses = weigh(truth, Rotation.random(count, rng).as_matrix(), EXACT, rng).poses
    found = calibrate(poses, NOISE)
    assume(found.condition < 30)
    assert off(found, truth).max() < 1e-3  # of what noise would leave
    assert np.abs(found.model.vector - truth.vector).max() < 1e-6
    assert not found.rejected
    assert found.mass == pytest.approx(truth.mass, abs=1e-7)
    unknown = calibrate(poses)
    assert np.abs(unknown.model.vector - truth.vector).max() < 1e-8
    assert unknown.noise.estimated
    assert 0 < unknown.contact_error < 5e-5


def test_a_bias_of_500_N_and_a_tilted_base_are_absorbed():
    tilted = GravityModel([2.0, -1.0, -5.5], [500, -480, 300], [0.01, 0, 0.06], [20, -15, 8])
    calibration = calibrate(held(8, load=tilted), NOISE)
    assert off(calibration, tilted).max() < 4.5
    assert calibration.verdict.level == Level.GOOD
    assert np.linalg.norm(calibration.gravity_W - tilted.gravity_W) < 0.1


def test_noise_may_differ_from_axis_to_axis():
    noise = PoseNoise([0.01, 0.05, 0.5], np.array([0.001, 0.004, 0.002]))
    calibration = calibrate(held(12, load=LOAD, noise=noise), noise)
    assert off(calibration).max() < 4.5
    assert calibration.scatter == pytest.approx(1, abs=0.6)
    sigmas = calibration.sigmas
    assert sigmas["force_bias_z"] > 3 * sigmas["force_bias_x"]


@pytest.mark.parametrize("noise", [1e-9, 1e-3, 10.0, 1e3])
def test_noise_of_any_size(noise):
    both = PoseNoise(noise, noise / 10)
    calibration = calibrate(held(8, noise=both), both)
    assert (0.1 if noise > 1e-6 else 0) < calibration.scatter < 1.8
    assert np.isfinite(calibration.covariance).all()
    assert calibration.verdict.level == (Level.GOOD if noise < 0.01 else Level.REFUSE)
    if noise < 20:  # beyond, the stated width stops at what a parameter may be at all
        assert off(calibration).max() < 4.5


@pytest.mark.parametrize("noise", [NOISE, None], ids=["noise known", "noise estimated"])
def test_two_hundred_poses(noise):
    calibration = calibrate(held(200), noise)
    assert off(calibration).max() < 4.5
    assert calibration.verdict.level == Level.GOOD
    assert len(calibration.rejected) <= 1


@given(st.integers(0, 10_000))
@settings(max_examples=6, deadline=None)
def test_frames_and_order_do_not_matter(seed):
    rng = np.random.default_rng([seed, 35])
    weighing = draw_weighing(rng, poses=(6, 10))
    poses, noise = weighing.poses, weighing.noise
    plain = calibrate(poses, noise)
    Q = Rotation.random(None, rng).as_matrix()
    scale = np.sqrt(np.diag(plain.covariance))
    order = rng.permutation(len(poses))
    shuffled = calibrate([poses[i] for i in order], noise)
    assert (np.abs(shuffled.model.vector - plain.model.vector) / scale).max() < 1e-4
    assert np.array_equal(shuffled.kept, plain.kept[order])
    # The world turned: only gravity turns with it.
    world = calibrate([replace(pose, R_WS=Q @ pose.R_WS) for pose in poses], noise)
    assert np.allclose(world.gravity_W, Q @ plain.gravity_W, atol=1e-4 * scale[0])
    assert (np.abs(world.model.vector - plain.model.vector) / scale)[3:].max() < 1e-3
    assert world.rank == plain.rank
    # The sensor turned on its flange: everything in S turns with it.
    turned = [
        replace(pose, R_WS=pose.R_WS @ Q, force=Q.T @ pose.force, torque=Q.T @ pose.torque) for pose in poses
    ]
    sensor = calibrate(turned, noise)
    assert np.allclose(sensor.gravity_W, plain.gravity_W, atol=1e-3 * scale[0])
    assert np.allclose(Q @ sensor.force_bias, plain.force_bias, atol=1e-3 * scale[3])
    assert np.allclose(Q @ sensor.centre_of_mass_S, plain.centre_of_mass_S, atol=1e-3 * scale[6:9].max())
    assert np.allclose(Q @ sensor.torque_bias, plain.torque_bias, atol=1e-3 * scale[9])


def test_the_kind_of_numbers_does_not_matter():
    poses = held(8)
    coarse = [
        PoseSample(*(np.asarray(value, dtype=np.float32) for value in (pose.R_WS, pose.force, pose.torque)))
        for pose in poses
    ]
    plain, rounded = calibrate(poses, NOISE), calibrate(coarse, NOISE)
    assert np.abs(plain.model.vector - rounded.model.vector).max() < 1e-5
    again = calibrate(tuple(poses), NOISE)
    assert np.array_equal(plain.model.vector, again.model.vector)
    assert np.array_equal(plain.covariance, again.covariance)


# ---- honest ------------------------------------------------------------------------------------


def test_the_covariance_is_the_cramer_rao_bound():
    weighing = draw_weighing(np.random.default_rng(36), poses=(9, 9))
    calibration = calibrate(weighing.poses, weighing.noise, orientation_sigma=0.0)
    assert calibration.plausible
    J = prediction_jacobian(stack(weighing.poses).R_SW, calibration.model.vector)
    rows = (J / weighing.noise.sigmas[:, None]).reshape(-1, 12)
    bound = np.linalg.inv(rows.T @ rows)
    scale = np.sqrt(np.diag(bound))
    assert np.abs((calibration.covariance - bound) / np.outer(scale, scale)).max() < 1e-6
    assert calibration.sigmas == pytest.approx(dict(zip(PARAMETERS, scale, strict=True)), rel=1e-6)


@pytest.mark.parametrize("known", [True, False])
def test_errors_have_the_size_that_is_stated(known):
    """Root mean square of 1 in stated sigmas, and 95 % of the truths inside the 95 % ellipsoid."""
    rng = np.random.default_rng([known, 37])
    squares, inside, tries = np.zeros(12), 0, 70 if known else 40
    for _ in range(tries):
        weighing = draw_weighing(rng, poses=(5, 12))
        calibration = calibrate(weighing.poses, weighing.noise if known else None)
        error = calibration.model.vector - weighing.truth.vector
        squares += error**2 / np.diag(calibration.covariance)
        inside += error @ np.linalg.solve(calibration.covariance, error) < calibration.ellipsoid(0.95)
    ratios = np.sqrt(squares / tries)
    assert ratios.mean() == pytest.approx(1.0 if known else 1.07, abs=0.15)
    assert ratios.max() < 1.5
    assert 0.95 - 3.3 * np.sqrt(0.05 * 0.95 / tries) <= inside / tries


def test_the_contact_error_is_that_of_the_task():
    poses = held(8)
    task = ContactTask(point=np.array([0, 0, 0.2]), force=5.0)
    usual, long = calibrate(poses, NOISE), calibrate(poses, NOISE, task=task)
    assert long.task is task
    assert long.contact_error == task.calibration_error(long.model.vector, long.covariance)
    assert long.contact_error > 2 * usual.contact_error
    assert np.array_equal(long.model.vector, usual.model.vector)


def test_residuals_are_read_minus_predicted():
    poses = held(8)
    poses[2] = replace(poses[2], force=poses[2].force + [7, 0, 0])
    calibration = calibrate(poses, NOISE)
    for pose, residual in zip(poses, calibration.residuals, strict=True):
        left = calibration.model.compensate(pose.R_WS, [*pose.force, *pose.torque])
        assert np.allclose(residual, left, atol=1e-9)
    assert calibration.kept.tolist() == [True, True, False] + 5 * [True]
    assert calibration.poses == tuple(poses)


def implausible() -> Calibration:
    """Noise that is a third larger than stated: too little to reject a pose, too much for chance."""
    for seed in range(50):
        calibration = calibrate(held(14, seed), PoseNoise(0.05 / 1.5, 0.002 / 1.5))
        if not calibration.rejected and not calibration.plausible:
            return calibration
    raise AssertionError


def test_noise_that_is_doubted_is_taken_from_the_poses():
    calibration = implausible()
    given = np.repeat([0.05 / 1.5, 0.002 / 1.5], 3)
    assert calibration.noise_factor == pytest.approx((1.5, 1.5), rel=0.3)
    assert np.allclose(calibration.noise.sigmas, given * np.repeat(calibration.noise_factor, 3))
    assert np.isfinite(calibration.noise.freedom).all()
    assert calibration.ellipsoid(0.95) > calibrate(calibration.poses, NOISE, orientation_sigma=0.0).ellipsoid(
        0.95
    )


def test_noise_given_ten_times_too_large_is_said_and_costs_no_trust():
    poses = held(10)
    large, right = calibrate(poses, PoseNoise(0.5, 0.02)), calibrate(poses, NOISE)
    assert large.noise_factor == pytest.approx((0.1, 0.1), rel=0.5)
    assert large.contact_error == pytest.approx(right.contact_error, rel=0.5)
    assert large.verdict.level == Level.GOOD
    assert "what the specified noise explains" in said(large)


def test_noise_given_too_small_for_torques_alone_costs_trust():
    rng = np.random.default_rng(3)
    poses = weigh(LOAD, Rotation.random(24, rng).as_matrix(), NOISE, rng).poses
    calibration = calibrate(poses, PoseNoise(0.05, 0.002 / 2.5))
    assert calibration.noise_factor == pytest.approx((1, 2.5), rel=0.3)
    assert calibration.verdict.level == Level.USABLE


def test_the_scatter_within_poses_is_a_floor():
    poses = [replace(pose, count=25, force_sd=[1.0, 2.0, 3.0], torque_sd=[0.1, 0.2, 0.3]) for pose in held(8)]
    noise = calibrate(poses).noise
    assert noise.estimated
    assert np.allclose(noise.sigmas, [0.2, 0.4, 0.6, 0.02, 0.04, 0.06])
    quiet = [replace(pose, count=10_000, force_sd=[0.1] * 3, torque_sd=[0.01] * 3) for pose in poses]
    assert np.allclose(calibrate(quiet).noise.sigmas, calibrate(held(8)).noise.sigmas, rtol=1e-9)
    # Noise that was given is believed, whatever the samples say.
    assert np.array_equal(calibrate(poses, NOISE).noise.sigmas, NOISE.sigmas)


@pytest.mark.parametrize("probability", [0.5, 0.95, 0.999])
def test_the_ellipsoid_of_known_noise_is_chi_square(probability):
    assert calibrate(held(6), NOISE).ellipsoid(probability) == pytest.approx(chi2.ppf(probability, 12))


@pytest.mark.parametrize("count", [5, 8, 40])
def test_the_ellipsoid_of_estimated_noise_is_the_quantile_of_two_f_variables(count):
    calibration = calibrate(held(count))
    rng = np.random.default_rng(38)
    freedom = calibration.noise.freedom
    sums = sum(rng.chisquare(6, 400_000) / (rng.chisquare(f, 400_000) / f) for f in freedom)
    for probability in (0.5, 0.95):
        assert calibration.ellipsoid(probability) == pytest.approx(np.quantile(sums, probability), rel=0.03)
    assert calibration.ellipsoid() > chi2.ppf(0.95, 12)


# ---- a load that is not felt -------------------------------------------------------------------


@pytest.mark.parametrize("noise", [NOISE, None], ids=["noise known", "noise estimated"])
def test_without_a_load_the_centre_of_mass_is_unknown(noise):
    nothing = GravityModel([0, 0, 0], [5, -3, 2], [0, 0, 0], [0.1, 0.2, 0.3])
    calibration = calibrate(held(12, load=nothing), noise)
    assert not calibration.observability.weighs
    assert np.array_equal(calibration.centre_of_mass_S, np.zeros(3))
    assert calibration.sigmas["centre_of_mass_S_x"] == pytest.approx(UNKNOWN[6])
    assert np.abs(calibration.force_bias - [5, -3, 2]).max() < 0.1
    assert "feels no weight" in said(calibration)
    assert calibration.verdict.level != Level.GOOD


def test_a_sensor_that_reads_the_same_everywhere():
    poses = [replace(pose, force=np.full(3, 500.0), torque=np.full(3, 7.0)) for pose in held(8)]
    for noise in (NOISE, None):
        calibration = calibrate(poses, noise)
        assert np.allclose(calibration.force_bias, 500)
        assert calibration.mass < 1e-9
        assert "the sensor is not responding" in said(calibration)


# ---- the verdict -------------------------------------------------------------------------------


def verdict_of(calibration: Calibration) -> tuple[Level, str]:
    return calibration.verdict.level, said(calibration)


def test_good_says_why():
    calibration = calibrate(held(10), NOISE)
    assert verdict_of(calibration)[0] == Level.GOOD
    assert f"{plain(1e3 * calibration.contact_error)} mm (1 sigma)" in said(calibration)
    assert "the limit for good is 0.5 mm. No action needed." in said(calibration)


def test_gravity_that_points_up_is_refused():
    turned_over = [replace(pose, force=-pose.force, torque=-pose.torque) for pose in held(10)]
    level, words = verdict_of(calibrate(turned_over, NOISE))
    assert level == Level.REFUSE
    assert "away from down" in words
    assert "contactbench calibrate diagnose" in words


@pytest.mark.parametrize(("sigma_N", "degrees"), [(0.4, 70.0), (0.5, 0.0)])
def test_gravity_is_off_down_only_where_two_sigmas_do_not_bring_it_back(sigma_N, degrees):
    """6 N at 70° from down are 2.05 N along it; a base tilted by 60° leaves 3 N."""
    calibration = calibrate(held(10), NOISE)
    slanted = 6 * np.array([np.sin(np.radians(70)), 0, -np.cos(np.radians(70))])
    findings = SimpleNamespace(
        gravity_W=slanted, down_W=-VERTICAL, covariance=sigma_N**2 * np.eye(len(calibration.covariance))
    )
    assert _off_down(findings) == pytest.approx(degrees)


@pytest.mark.parametrize(("factor", "level"), [(4.9, Level.GOOD), (6.0, Level.REFUSE)])
def test_residuals_that_no_cause_explains_are_refused_from_five_times_the_noise(factor, level):
    findings = replace(calibrate(held(10), NOISE), noise_factor=(factor, factor), causes=())
    verdict = judge(findings, True, Limits())
    assert verdict.level is level
    assert ("residuals are 6 times what" in " ".join(verdict.reasons)) == (level is Level.REFUSE)


@pytest.mark.parametrize(
    ("R_WS", "words"),
    [
        (spun(), "same tilt"),
        (spun() @ Rotation.from_rotvec([0.5, 0.7, 0]).as_matrix(), "same tilt"),
        (Rotation.from_rotvec(np.outer(np.linspace(0, 2, 8), [0, 1, 0])).as_matrix(), "bearing 90°"),
        (np.tile(np.eye(3), (8, 1, 1)), "same orientation"),
        (close(3), "of one another"),
    ],
)
@pytest.mark.parametrize("noise", [NOISE, None], ids=["noise known", "noise estimated"])
def test_poses_that_leave_something_open_are_refused_in_words(R_WS, words, noise):
    calibration = calibrate(posed(R_WS), noise)
    level, reasons = verdict_of(calibration)
    assert level == Level.REFUSE
    assert words in reasons
    assert "away from down" not in reasons
    assert off(calibration).max() < 5


def test_too_large_an_error_is_refused_with_a_remedy():
    noisy = PoseNoise(0.5, 0.02)
    calibration = calibrate(held(5, noise=noisy), noisy)
    level, words = verdict_of(calibration)
    assert level == Level.REFUSE
    assert "more than 1.5 mm is refused" in words
    assert "Take more poses tilted about two axes" in words
    weak = calibrate(posed(close(9)), NOISE)
    assert weak.verdict.level == Level.REFUSE
    assert "more than 1.5 mm is refused" in said(weak)
    assert "of one another" in said(weak)


def test_weak_poses_that_are_good_enough_are_usable():
    accurate = PoseNoise(1e-4, 1e-5)
    level, words = verdict_of(calibrate(posed(close(9), noise=accurate), accurate))
    assert level == Level.USABLE
    assert "of one another" in words


def test_few_poses_are_usable_and_told():
    level, words = verdict_of(calibrate(held(4), PoseNoise(0.05, 0.002)))
    assert level == Level.USABLE
    assert "With 4 poses, none can be checked" in words


def test_wrong_noise_is_told():
    calibration = implausible()
    level, words = verdict_of(calibration)
    assert level == Level.USABLE
    assert f"The residuals are {plain(calibration.noise_factor[0])} times (forces) and" in words


def test_leaving_out_many_of_few_is_told():
    poses = held(7, noise=PoseNoise(0.01, 0.0005))
    poses[3] = replace(poses[3], force=poses[3].force + [5, 5, 0])
    level, words = verdict_of(calibrate(poses, PoseNoise(0.01, 0.0005)))
    assert level == Level.USABLE
    assert "Left out: " in words
    assert "Retake it, to have 8 poses or more." in words
    more = held(8, noise=PoseNoise(0.01, 0.0005))
    more[3] = replace(more[3], force=more[3].force + [5, 5, 0])
    assert calibrate(more, PoseNoise(0.01, 0.0005)).verdict.level == Level.GOOD


def test_the_limits_decide():
    poses = held(10)
    error = calibrate(poses, NOISE).contact_error

    def level(good: float, usable: float) -> Level:
        return calibrate(poses, NOISE, limits=Limits(good * error, usable * error)).verdict.level

    assert level(1.001, 9) == Level.GOOD
    assert level(0.999, 9) == Level.USABLE
    assert level(0.999, 1.001) == Level.USABLE
    assert level(0.5, 0.999) == Level.REFUSE
    assert "would be good" in said(calibrate(poses, NOISE, limits=Limits(0.5 * error, 2 * error)))


@pytest.mark.parametrize("count", [0, 1, 2])
def test_fewer_than_three_poses_are_no_calibration(count):
    with pytest.raises(PoseError, match=f"^{count} poses are too few. Twelve unknowns need at least three"):
        calibrate(held(5)[:count])


# ---- beyond all sense --------------------------------------------------------------------------


def test_what_is_not_seen_stays_unknown_without_noise():
    for count in (4, 60):
        tiny = PoseNoise(1e-9, 1e-9)
        assert off(calibrate(posed(spun(count), noise=tiny), tiny)).max() < 5
        assert off(calibrate(posed(spun(count), noise=EXACT))).max() < 5


# ---- poses ---------------------------------------------------------------------------------------


ANGLES = st.floats(-10, 10, allow_subnormal=False)
NAN, INF = float("nan"), float("inf")


def pose(R_WS=None, force=(1.0, 2.0, 3.0), torque=(0.1, 0.2, 0.3), **more) -> PoseSample:
    return PoseSample(np.eye(3) if R_WS is None else R_WS, force, torque, **more)


@given(st.tuples(ANGLES, ANGLES, ANGLES))
@settings(max_examples=40, deadline=None)
def test_a_rotation_typed_with_four_digits_becomes_the_nearest_rotation(rotvec):
    R = Rotation.from_rotvec(rotvec).as_matrix()
    taken = pose(np.round(R, 4)).R_WS
    assert np.abs(taken @ taken.T - np.eye(3)).max() < 1e-14
    assert np.linalg.det(taken) > 0
    assert np.abs(taken - R).max() < 1e-4
    assert np.abs(pose(R).R_WS - R).max() < 1e-14


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"R_WS": np.diag([1.0, 1.0, -1.0])}, "reflection"),
        ({"R_WS": -np.eye(3)}, "reflection"),
        ({"R_WS": np.diag([1.0, 1.0, -1.0004])}, "reflection"),
        ({"R_WS": 1.002 * np.eye(3)}, "not a rotation"),
        ({"R_WS": [[1, 0.01, 0], [0, 1, 0], [0, 0, 1]]}, "not a rotation"),
        ({"R_WS": np.zeros((3, 3))}, "not a rotation"),
        ({"R_WS": np.eye(2)}, r"shape \(2, 2\)"),
        ({"R_WS": np.full((3, 3), NAN)}, "finite"),
        ({"R_WS": [[INF, 0, 0], [0, 1, 0], [0, 0, 1]]}, "finite"),
        ({"force": [1, 2]}, "force needs three numbers, N"),
        ({"force": 5.0}, "force needs three numbers"),
        ({"force": [1, NAN, 2]}, "force is"),
        ({"torque": [1, INF, 2]}, "torque is"),
        ({"torque": [[1, 2, 3]]}, "torque needs three numbers, N·m"),
        ({"force": [0, 0, 1.01e5]}, "below 100000 N"),
        ({"torque": [0, -1.01e5, 0]}, "below 100000 N·m"),
        ({"force_sd": [0.1, -0.1, 0.1]}, "force_sd is negative"),
        ({"torque_sd": [0.1, NAN, 0.1]}, "torque_sd is"),
        ({"torque_sd": 0.1}, "torque_sd needs three numbers"),
        ({"count": 0}, "at least one sample"),
        ({"count": -3}, "at least one sample"),
        ({"temperature": NAN}, "temperature is nan"),
        ({"time": INF}, "time is inf"),
    ],
)
def test_what_cannot_be_used_is_refused_by_name(wrong, said):
    with pytest.raises(PoseError, match=said) as refusal:
        pose(**wrong, name="upside down")
    assert str(refusal.value).startswith("upside down: ")
    with pytest.raises(InputError, match=r"^pose: "):
        pose(**wrong)


@pytest.mark.parametrize("kind", [np.float64, np.float32, np.int64, list])
def test_any_numbers_are_taken_and_kept_apart_from_the_caller(kind):
    values = [3, -4, 5]
    given_force = list(values) if kind is list else np.array(values, dtype=kind)
    taken = pose(np.eye(3, dtype=int), given_force)
    assert taken.force.dtype == taken.R_WS.dtype == np.float64
    given_force[0] = 100
    assert taken.force.tolist() == values


def test_a_pose_cannot_be_changed():
    readonly = np.array([1.0, 2.0, 3.0])
    readonly.flags.writeable = False
    taken = pose(force=readonly, force_sd=readonly, torque_sd=readonly)
    for field in ("R_WS", "force", "torque", "force_sd", "torque_sd"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(taken, field)[0] = 7
    with pytest.raises(AttributeError):
        taken.count = 2


def test_arrays_hold_the_transposes_and_force_before_torque():
    rotations = Rotation.from_rotvec([[0.1, 0.2, 0.3], [1, 0, 0], [0, 0, 2]]).as_matrix()
    poses = [
        pose(R, [i, 10 + i, 20 + i], [30 + i, 40 + i, 50 + i]) for i, R in enumerate(rotations.astype(float))
    ]
    arrays = stack(poses)
    assert len(arrays) == 3
    for i, R in enumerate(rotations):
        assert np.allclose(arrays.R_SW[i], R.T, atol=1e-15)
        assert arrays.wrenches[i].tolist() == [i, 10 + i, 20 + i, 30 + i, 40 + i, 50 + i]
    assert np.array_equal(np.hstack([arrays.F, arrays.M]), arrays.wrenches)
    for chosen in (np.array([True, False, True]), np.array([0, 2])):
        some = arrays.take(chosen)
        assert np.array_equal(some.R_SW, arrays.R_SW[[0, 2]])
        assert np.array_equal(some.wrenches, arrays.wrenches[[0, 2]])


def test_a_pose_without_a_name_is_called_by_its_number():
    assert [named([pose(), pose(name="left")], i) for i in (0, 1)] == ["pose 1", "left"]
