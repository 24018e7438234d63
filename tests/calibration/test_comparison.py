"""What explains the poses: causes told from one another on sets drawn by a generator that knows no estimator."""

from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks import wrong_models as wrong
from scipy.integrate import quad

from contactbench.pipeline.calibration import Level, calibrate, nuisance
from contactbench.pipeline.calibration.causes import _rezero
from contactbench.pipeline.calibration.mount import estimate_mount
from contactbench.pipeline.calibration.poses import stack
from contactbench.pipeline.calibration.reml import NoisePrior, fit_with_noise, over_unknowns

SETS = 12


def drawn(seed: int, fault=None, **options) -> tuple[wrong.Session, np.random.Generator]:
    rng = np.random.default_rng([seed, 61])
    session = wrong.draw(rng, **options)
    return (session if fault is None else fault(session, rng)), rng


def inside(calibration, session) -> bool:
    error = calibration.model.vector - session.truth
    return bool(error @ np.linalg.solve(calibration.covariance, error) < calibration.ellipsoid(0.95))


def believed(calibration) -> str:
    return next(cause.key for cause in calibration.causes if cause.believed)


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize(("fault", "key"), [(wrong.drift, "drift"), (wrong.rezero, "rezero")])
def test_a_changing_bias_is_told_and_the_bias_is_that_of_the_end(fault, key, known):
    told, covered = 0, 0
    for seed in range(SETS):
        session, _ = drawn(seed, fault, poses=(10, 14))
        found = calibrate(session.poses(), session.noise() if known else None)
        told += believed(found) == key
        covered += inside(found, session)
        assert found.verdict.level is not Level.GOOD
        assert not found.offsets[np.argmax(session.times)].any()
    assert told >= SETS - 1
    assert covered >= SETS - 2


def test_the_drift_has_its_rate_and_the_re_zero_its_pose():
    session, _ = drawn(3, wrong.drift, poses=(12, 12))
    found = calibrate(session.poses(), session.noise())
    assert found.drift_rate is not None
    hours = np.ptp(session.times) / 3600
    grown = np.linalg.norm(found.drift_rate[:3]) * 3600 * hours
    assert grown == pytest.approx(0.3, rel=0.3)
    assert f"{np.linalg.norm(found.drift_rate[:3]) * 3600:.2g} N" in found.causes[0].sentence
    untimed = calibrate(session.poses(timed=False), session.noise())
    assert believed(untimed) == "drift"
    assert untimed.drift_rate is None
    session, rng = drawn(4, poses=(12, 12))
    session = wrong.rezero(session, rng, before=7)
    found = calibrate(session.poses(), session.noise())
    assert "before pose 8," in found.causes[0].sentence


def test_clean_sets_accuse_nobody():
    for seed in range(SETS):
        for known in (True, False):
            session, _ = drawn(seed)
            found = calibrate(session.poses(), session.noise() if known else None)
            assert believed(found) == "plain"
            assert not found.rejected


@pytest.mark.parametrize("degrees", [0.05, 0.2, 0.6])
def test_orientations_that_scatter_bump_no_pose(degrees):
    covered, estimates = 0, []
    for seed in range(SETS):
        session, _ = drawn(seed, orientation_deg=degrees, mass=(2, 5), poses=(14, 20))
        found = calibrate(session.poses(), session.noise())
        assert not found.rejected
        covered += inside(found, session)
        estimates.append(np.degrees(found.noise.orientation))
    assert covered >= SETS - 2
    assert np.median(estimates) == pytest.approx(degrees, rel=0.4)


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_noise_given_wrong_is_doubted_and_costs_no_pose(factor):
    covered = 0
    for seed in range(SETS):
        session, _ = drawn(seed, poses=(10, 14))
        found = calibrate(session.poses(), session.noise(factor))
        assert found.noise_factor == pytest.approx((1 / factor, 1 / factor), rel=0.6)
        assert not found.rejected
        covered += inside(found, session)
        assert (found.verdict.level is Level.GOOD) == (factor > 1)
    assert covered >= SETS - 2


def test_a_turned_mount_is_proposed_with_what_it_would_gain_and_never_good():
    for seed in range(SETS):
        session, _ = drawn(seed, lambda s, rng: wrong.turned_mount(s, rng, deg=3.0), mass=(1, 5))
        found = calibrate(session.poses(), session.noise())
        assert found.verdict.level is not Level.GOOD
        assert found.model_error > 0.0003
        sentence = next(cause.sentence for cause in found.causes if cause.key == "mount")
        assert "--estimate-mount" in sentence


def test_a_cable_beside_a_good_calibration_is_never_good():
    for seed in range(SETS):
        session, _ = drawn(seed, lambda s, rng: wrong.spring(s, rng, force=1.0), poses=(12, 20))
        assert calibrate(session.poses(), session.noise()).verdict.level is not Level.GOOD


def test_a_drift_is_seen_with_the_mount_unknown_too():
    session, _ = drawn(5, wrong.drift, poses=(14, 14), mass=(2, 2))
    found = estimate_mount(session.poses(), session.noise()).calibration
    assert believed(found) == "drift"
    error = found.model.force_bias - session.truth[3:6]
    assert np.abs(error / np.sqrt(np.diag(found.covariance)[3:6])).max() < 4


@pytest.mark.parametrize("down", [(0, 0, 1), (1, 0, 0), (0, -1, 0), (0.6, 0, -0.8)])
def test_robots_that_do_not_stand_upright_are_good_once_it_is_said(down):
    for seed in range(4):
        session, _ = drawn(seed, down_W=np.array(down, dtype=float))
        said = calibrate(session.poses(), session.noise(), down_W=down)
        assert said.verdict.level is Level.GOOD
        if down != (0.6, 0, -0.8):  # a lean that a base may have by accident is absorbed
            unsaid = calibrate(session.poses(), session.noise())
            assert unsaid.verdict.level is Level.REFUSE


def test_a_zero_that_jumps_before_the_last_pose_is_not_good():
    for seed in range(6):
        session, rng = drawn(seed, poses=(9, 12))
        session = wrong.rezero(session, rng, force=1.0, torque=0.05, before=len(session) - 1)
        found = calibrate(session.poses(), session.noise())
        assert found.verdict.level is not Level.GOOD
        assert any("the last one, disagrees" in reason for reason in found.verdict.reasons)


# ---- the pieces ----------------------------------------------------------------------------------


def test_unknowns_of_any_size_are_integrated():
    found, known = np.array([0.3]), np.array([[40.0]])
    sizes = 4.0 ** -np.arange(8.0)

    def density(x: float, size: float) -> float:
        return float(np.exp(-20 * (x - 0.3) ** 2 - 0.5 * (x / size) ** 2) / np.sqrt(2 * np.pi) / size)

    ends = np.minimum(3, 12 * sizes)
    each = [
        quad(density, -end, end, args=(size,), limit=200)[0] for size, end in zip(sizes, ends, strict=True)
    ]
    assert over_unknowns(found, known) == pytest.approx(np.log(np.mean(each)), rel=1e-6)


def test_restricted_likelihood_is_unbiased_for_few_poses():
    ratios = []
    for seed in range(25):
        session, _ = drawn(seed, poses=(6, 6))
        prior = NoisePrior(None, np.zeros(6), 0.0, guessed=False)
        noisy = fit_with_noise(stack(session.poses()), prior)
        ratios.append((noisy.noise.sigmas / session.sigmas)[[0, 3]] ** 2)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.25)  # a plain maximum would make it 0.67


@pytest.mark.parametrize(("second", "names"), [(0.12, "pose 3 or pose 6,"), (0.08, "pose 3,")])
def test_a_re_zero_names_every_pose_that_is_a_tenth_as_likely(second, names):
    session, _ = drawn(5, poses=(8, 8))
    poses = session.poses()
    arrays = stack(poses)
    tried = [SimpleNamespace(key=nuisance.REZERO, moment=arrays.moments[at]) for at in (5, 2)]
    added = SimpleNamespace(fit=SimpleNamespace(added={None: np.ones((8, 6))}))
    compared = SimpleNamespace(candidates=tried, probabilities=np.array([second, 1 - second]), poses=arrays)
    sentence = _rezero(SimpleNamespace(noisy=added, moment=arrays.moments[2]), poses, compared)
    assert f"before {names}" in sentence
