"""The tracker against biases that are known: alarms, delays, touches, a new zero; and the temperature fit."""

from functools import cache

import numpy as np
import pytest
from calibration.streams import MODEL
from scipy.spatial.transform import Rotation

from pipeline.calibration import Calibration, GravityModel, PoseNoise, PoseSample, calibrate
from pipeline.calibration.drift import BiasTracker, temperature_coefficient
from pipeline.calibration.model import prediction_jacobian
from pipeline.errors import InputError

SIGMA = np.repeat([0.01, 3e-4], 3)
MINUTE = 60.0


@cache
def calibrated(seed: int, poses: int = 8) -> Calibration:
    rng = np.random.default_rng(seed)
    samples = []
    for R in Rotation.random(poses, rng=rng).as_matrix():
        w = MODEL.predict(R) + SIGMA * rng.standard_normal(6)
        samples.append(PoseSample(R, w[:3], w[3:]))
    return calibrate(samples, PoseNoise(SIGMA[:3], SIGMA[3:]))


def follow(seed, bias=lambda _: np.zeros(6), moments=60, touched=lambda _: False, turn=True, **options):
    """Track one moment a minute; return the tracker, its states, and which moments were touched."""
    rng = np.random.default_rng(10_000 + seed)
    tracker = BiasTracker(calibrated(seed).model, **options)
    states, touches = [], []
    R = np.eye(3)
    for i in range(moments):
        if turn:
            R = Rotation.random(rng=rng).as_matrix()
        wrench = MODEL.predict(R) + bias(i * MINUTE) + SIGMA * rng.standard_normal(6)
        touches.append(touched(i))
        if touches[-1]:
            force = rng.uniform(0.5, 10) * Rotation.random(rng=rng).apply([1, 0, 0])
            wrench += np.concatenate([force, np.cross([0, 0, 0.1], force)])
        states.append(tracker.update(i * MINUTE, R, wrench, SIGMA))
    return tracker, states, touches


def true_change(seed, bias):
    """What must be added to the calibrated biases to have the true ones."""
    model = calibrated(seed).model
    return np.concatenate([MODEL.force_bias - model.force_bias, MODEL.torque_bias - model.torque_bias]) + bias


def step(size, seed, at=10 * MINUTE):
    direction = np.random.default_rng(seed).standard_normal(3)
    change = np.concatenate([size * direction / np.linalg.norm(direction), np.zeros(3)])
    return lambda t: change * (t >= at)


# ---- alarms ----------------------------------------------------------------------------------------


def test_false_alarms_are_as_rare_as_asked():
    sigmas, alarms = [], 0
    for seed in range(60):
        _, states, _ = follow(seed, moments=40, false_alarm=0.01)
        sigmas += [state.sigmas for state in states]
        alarms += sum(state.warning is not None for state in states)
    # Moments after one calibration share its error: 60 calibrations are the sample.
    assert alarms / len(sigmas) < 0.03
    assert (np.array(sigmas) > 1.96).mean() == pytest.approx(0.05, abs=0.03)


@pytest.mark.parametrize(("size", "most"), [(0.06, 4), (0.12, 1)])
def test_a_step_is_noticed(size, most):
    delays = []
    for seed in range(20):
        _, states, _ = follow(seed, step(size, seed), moments=30)
        warned = [i for i, state in enumerate(states) if state.warning and i >= 10]
        delays.append(warned[0] - 9 if warned else 99)
    assert np.quantile(delays, 0.9) <= most


def test_slow_drift_is_followed_and_told():
    rate = np.array([0.1, 0, 0, 0, 2e-3, 0]) / (10 * MINUTE)
    tracker, states, _ = follow(3, lambda t: rate * t)
    assert all(state.used for state in states)
    last = states[-1]
    assert last.warning is not None
    assert "The bias has moved by 0.59 N" in last.warning or "0.6" in last.warning
    assert "mm" in last.warning
    assert last.contact_shift == pytest.approx(5e-3, rel=0.5)
    corrected = tracker.corrected_model()
    assert corrected.force_bias == pytest.approx(MODEL.force_bias + rate[:3] * last.time, abs=0.04)
    assert tracker.model is calibrated(3).model  # never applied silently


def test_the_covariance_is_that_of_the_errors():
    squares, model_squares = [], []
    walk = np.repeat([0.003, 1e-4], 3)
    for seed in range(60):
        rng = np.random.default_rng(seed)
        path = np.cumsum(walk * np.sqrt(MINUTE) * rng.standard_normal((30, 6)), axis=0)
        tracker, states, _ = follow(seed, lambda t, path=path: path[int(t / MINUTE)], moments=30)
        off = states[-1].bias_change - true_change(seed, path[-1])
        squares.append(off @ np.linalg.solve(states[-1].covariance, off))
        model = tracker.corrected_model()
        truth = MODEL.vector.copy()
        truth[3:6] += path[-1][:3]
        truth[9:] += path[-1][3:]
        off = model.vector - truth
        model_squares.append(off @ np.linalg.solve(model.covariance, off))
    assert np.mean(squares) == pytest.approx(6, abs=1.8)  # 4 sigma of the mean of 60
    assert np.mean(model_squares) == pytest.approx(12, abs=2.6)


def test_averaging_does_not_lessen_the_calibrations_error():
    tracker, states, _ = follow(1, moments=200, turn=False, random_walk=(1e-9, 1e-11), age=0.0)
    # In one orientation the reading as a whole is seen ever better; which part of it is bias only as well as
    # the calibration tells it from weight.
    C = calibrated(1).model.covariance
    J = prediction_jacobian(np.eye(3)[None], calibrated(1).model.vector)[0]
    biases = np.eye(12)[[3, 4, 5, 9, 10, 11]]
    shared = biases @ C @ J.T
    left = biases @ C @ biases.T - shared @ np.linalg.solve(J @ C @ J.T + np.diag(SIGMA**2) / 200, shared.T)
    ratio = np.diag(states[-1].covariance) / np.diag(left)
    assert (ratio > 0.99).all()
    assert (ratio < 1.3).all()  # gravity is not estimated, which costs a little
    assert (np.diag(left) > 3 * SIGMA**2 / 200)[:3].all()
    corrected = np.diag(tracker.corrected_model().wrench_covariance(np.eye(3)))
    assert (corrected < np.diag(calibrated(1).model.wrench_covariance(np.eye(3)))).all()


def test_a_model_without_covariance_works():
    tracker = BiasTracker(GravityModel(*np.split(MODEL.vector, 4)), age=0.0)
    state = tracker.update(0.0, np.eye(3), MODEL.predict(np.eye(3)) + 0.5 * SIGMA, SIGMA)
    assert state.used
    assert state.warning is None
    assert np.isfinite(state.sigmas)


# ---- touches and a new zero ------------------------------------------------------------------------


def test_touches_are_not_used():
    used = clean = 0
    for seed in range(20):
        chosen = np.random.default_rng(seed).random(40) < 0.2
        _, states, touches = follow(seed, moments=40, touched=lambda i, chosen=chosen: chosen[i])
        for state, touched in zip(states, touches, strict=True):
            used += touched and state.used
            clean += not touched and not state.used
            if touched:
                assert "not used" in state.warning
    assert (used, clean) == (0, 0)


def test_a_new_zero_is_named():
    for seed in range(10):
        offset = np.random.default_rng(seed).normal(0, np.repeat([3.0, 0.1], 3))
        tracker, states, _ = follow(seed, lambda t, offset=offset: offset * (t >= 600), moments=25)
        assert not any(state.rezeroed for state in states[:14])
        assert all(state.rezeroed for state in states[14:])  # the fifth moment in a row
        assert "re-zeroed" in states[-1].warning
        assert "recalibrate" in states[-1].warning
        off = states[-1].bias_change - true_change(seed, offset)
        assert off @ np.linalg.solve(states[-1].covariance, off) < 25
        assert tracker.corrected_model().force_bias == pytest.approx(MODEL.force_bias + offset[:3], abs=0.05)


def test_the_same_offset_in_one_orientation_may_be_a_touch():
    offset = np.array([0, 0, -2.0, 0, 0, 0])
    _, states, _ = follow(0, lambda t: offset * (t >= 600), moments=20, turn=False)
    assert not any(state.used for state in states[10:])
    assert not states[-1].rezeroed
    assert "Turn the wrist" in states[-1].warning


def test_what_hangs_from_the_probe_is_no_new_zero():
    tracker = BiasTracker(calibrated(0).model)
    rng = np.random.default_rng(0)
    for i, R in enumerate(Rotation.random(12, rng=rng).as_matrix()):
        hanging = R.T @ [0, 0, -2.0]
        wrench = MODEL.predict(R) + np.concatenate([hanging, np.cross([0, 0, 0.1], hanging)])
        state = tracker.update(i * MINUTE, R, wrench, SIGMA)
        assert not state.used
        assert not state.rezeroed


# ---- temperature -----------------------------------------------------------------------------------


def warm(seed, temperatures, times, drift=0.0):
    rng = np.random.default_rng(seed)
    truth = np.repeat([0.02, 5e-4], 3) * rng.standard_normal(6)
    noise = SIGMA * rng.standard_normal((len(times), 6))
    return truth, (temperatures - 25)[:, None] * truth + drift * times[:, None] + noise


TIMES = np.linspace(0, 3600, 30)


@pytest.mark.parametrize("drift", [0.0, 1e-5])
@pytest.mark.parametrize("course", [5 * np.sin(TIMES / 500), 10 * (1 - np.exp(-TIMES / 900))])
def test_the_coefficient_is_as_sure_as_it_says(course, drift):
    errors = []
    for seed in range(100):
        truth, residuals = warm(seed, 25 + course, TIMES, drift)
        fit = temperature_coefficient(25 + course, residuals, SIGMA, TIMES)
        errors.append((fit.coefficient - truth) / fit.sigma)
    assert np.sqrt(np.mean(np.square(errors))) == pytest.approx(1.0, abs=0.12)
    assert (np.abs(errors) < 1.96).mean() == pytest.approx(0.95, abs=0.03)


def test_without_times_the_fit_is_a_straight_line():
    T = 25 + 5 * np.sin(TIMES)
    truth, residuals = warm(0, T, TIMES)
    fit = temperature_coefficient(T, residuals, SIGMA)
    assert fit.coefficient == pytest.approx(np.polyfit(T, residuals, 1)[0], rel=1e-6)
    assert fit.sigma == pytest.approx(SIGMA / np.sqrt(((T - T.mean()) ** 2).sum()))
    assert fit.significance == pytest.approx(np.abs(fit.coefficient) / fit.sigma)
    assert (fit.drift, fit.time_correlation) == (None, None)
    assert "N/K" in fit.sentence
    assert truth == pytest.approx(fit.coefficient, abs=4 * fit.sigma.max())


def test_warm_up_alone_is_said_to_look_like_drift():
    T = 25 + 10 * (1 - np.exp(-TIMES / 1200))
    _, residuals = warm(0, T, TIMES)
    fit = temperature_coefficient(T, residuals, SIGMA, TIMES)
    assert fit.time_correlation > 0.9
    assert "look alike" in fit.sentence
    line = temperature_coefficient(25 + TIMES / 360, residuals, SIGMA, TIMES)
    assert line.refusal is not None
    assert "cool" in line.refusal
    assert np.isnan(line.coefficient).all()


def test_scatter_widens_the_sigmas():
    T = 25 + 5 * np.sin(TIMES)
    _, residuals = warm(0, T, TIMES)
    fit = temperature_coefficient(T, residuals, SIGMA / 4)
    assert (fit.scatter > 5).all()
    right = temperature_coefficient(T, residuals, SIGMA)
    assert fit.sigma == pytest.approx(right.sigma, rel=0.5)


def test_refusals():
    small = temperature_coefficient(25 + 0.01 * np.arange(30), np.zeros((30, 6)), SIGMA)
    assert "0.3 K only" in small.refusal
    few = temperature_coefficient([20, 30], np.zeros((2, 6)), SIGMA)
    assert "2 moments" in few.refusal
    assert few.sentence == few.refusal
    none = temperature_coefficient(20 + 5 * np.sin(np.arange(30)), np.zeros((30, 6)), (0.01, 3e-4))
    assert "No axis" in none.sentence


def test_the_tracker_knows_its_temperatures():
    tracker = BiasTracker(calibrated(0).model)
    with pytest.raises(InputError, match="0 moments"):
        tracker.temperature_coefficient()
    truth = np.repeat([0.02, 5e-4], 3)
    rng = np.random.default_rng(0)
    for t in TIMES:
        T = 25 + 5 * np.sin(t / 600)
        R = Rotation.random(rng=rng).as_matrix()
        wrench = MODEL.predict(R) + (T - 25) * truth + SIGMA * rng.standard_normal(6)
        assert tracker.update(t, R, wrench, PoseNoise(SIGMA[:3], SIGMA[3:]), T).used
    fit = tracker.temperature_coefficient()
    assert np.abs(fit.coefficient - truth).max() < 5 * fit.sigma.max()


# ---- wrong input -----------------------------------------------------------------------------------


def test_wrong_input():
    model = calibrated(0).model
    for wrong in ({"random_walk": (1.0,)}, {"age": -1.0}, {"false_alarm": 0.0}, {"confirm": 1}):
        with pytest.raises(InputError, match=next(iter(wrong))):
            BiasTracker(model, **wrong)
    tracker = BiasTracker(model)
    with pytest.raises(InputError, match="R_WS"):
        tracker.update(0.0, np.eye(4), np.zeros(6), SIGMA)
    with pytest.raises(InputError, match="noise"):
        tracker.update(0.0, np.eye(3), MODEL.predict(np.eye(3)), np.zeros(6))
    tracker.update(10.0, np.eye(3), MODEL.predict(np.eye(3)), SIGMA)
    with pytest.raises(InputError, match="backwards"):
        tracker.update(9.0, np.eye(3), MODEL.predict(np.eye(3)), SIGMA)
    with pytest.raises(InputError, match="do not fit"):
        temperature_coefficient([20, 30], np.zeros((3, 6)), SIGMA)
    with pytest.raises(InputError, match="not finite"):
        temperature_coefficient([20, np.nan, 30], np.zeros((3, 6)), SIGMA)
    with pytest.raises(InputError, match="sigma"):
        temperature_coefficient([20, 25, 30], np.zeros((3, 6)), -SIGMA)
