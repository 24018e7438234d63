"""Verification in new poses: its p-value against its own distribution, its figures against formulas."""

import json
from dataclasses import replace

import numpy as np
import pytest
from calibration.streams import MODEL
from scipy.spatial.transform import Rotation
from scipy.stats import kstest

from contactbench.pipeline.calibration import (
    ContactTask,
    GravityModel,
    Level,
    Limits,
    PoseNoise,
    PoseSample,
    calibrate,
)
from contactbench.pipeline.calibration.verify import verify_still
from contactbench.pipeline.errors import InputError

SIGMA = np.repeat([0.01, 3e-4], 3)


def poses(rng, number, model=MODEL, sigma=SIGMA, offset=0.0, **fields):
    samples = []
    for R in Rotation.random(number, rng=rng).as_matrix():
        w = model.predict(R) + sigma * rng.standard_normal(6) + offset
        samples.append(PoseSample(R, w[:3], w[3:], **fields))
    return samples


def calibrated(rng, number=8, *, known=True):
    noise = PoseNoise(SIGMA[:3], SIGMA[3:]) if known else None
    return calibrate(poses(rng, number), noise, orientation_sigma=0.0)


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("count", [1, 5])
def test_p_values_are_uniform(known, count):
    p = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        p.append(verify_still(calibrated(rng, known=known), poses(rng, count)).p_value)
    assert kstest(p, "uniform").pvalue > 1e-3
    assert (np.array(p) < 0.05).mean() < 0.1


def test_the_contact_error_is_as_predicted():
    ratios = []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        verification = verify_still(calibrated(rng), poses(rng, 10))
        ratios.append(verification.contact_rms / verification.predicted_contact_error)
    assert np.sqrt(np.mean(np.square(ratios))) == pytest.approx(1.0, abs=0.15)


def test_a_good_calibration_passes():
    rng = np.random.default_rng(0)
    verification = verify_still(calibrated(rng), poses(rng, 5))
    assert verification.passed
    assert verification.verdict.level is Level.GOOD
    assert "the limit for good is 0.5 mm rms. No action needed." in verification.verdict.reasons[0]
    assert verification.freedom == 30
    assert verification.deviates.shape == (5,)
    assert verification.contact_errors.shape == (5, len(ContactTask().forces))


def test_figures_are_what_they_say():
    rng = np.random.default_rng(1)
    calibration = calibrated(rng)
    samples = poses(rng, 4)
    task = ContactTask(point=[0, 0, 0.2], force=5.0, friction=0.0)
    verification = verify_still(calibration, samples, task=task)
    read = np.array([np.concatenate([pose.force, pose.torque]) for pose in samples])
    residuals = read - calibration.model.predict(np.array([pose.R_WS for pose in samples]))
    assert verification.residuals == pytest.approx(residuals, abs=1e-12)
    assert verification.force_rms == pytest.approx(np.sqrt((residuals[:, :3] ** 2).sum() / 4))
    assert verification.torque_rms == pytest.approx(np.sqrt((residuals[:, 3:] ** 2).sum() / 4))
    # A force along the normal at lever l: the contact moves by |(M - p x F) across| / |F|.
    across = residuals[:, 3:] - np.cross(task.point, residuals[:, :3])
    moved = np.linalg.norm(across[:, :2], axis=1) / task.force
    assert verification.contact_errors[:, 0] == pytest.approx(moved, rel=1e-9)
    assert verification.contact_worst == pytest.approx(moved.max(), rel=1e-9)
    assert verification.contact_rms == pytest.approx(np.sqrt((moved**2).mean()), rel=1e-9)
    first = calibration.model.wrench_covariance(samples[0].R_WS) + np.diag(SIGMA**2)
    square = residuals[0] @ np.linalg.solve(first, residuals[0])
    assert verification.deviates[0] == pytest.approx(np.sqrt(square))


def test_drift_is_told_but_passes_while_small():
    rng = np.random.default_rng(2)
    calibration = calibrated(rng)
    verification = verify_still(calibration, poses(rng, 5, offset=np.array([0, 0, 0, 0.006, 0, 0])))
    assert verification.passed
    assert verification.verdict.level is Level.USABLE
    assert verification.p_value < 1e-3
    assert any("drift since the calibration" in reason for reason in verification.verdict.reasons)
    assert any("would be good" in reason for reason in verification.verdict.reasons)


def test_another_tool_is_refused():
    rng = np.random.default_rng(3)
    heavier = GravityModel(
        MODEL.gravity_W * 1.1,
        MODEL.force_bias,
        MODEL.torque_bias * 0 + MODEL.centre_of_mass_S,
        MODEL.torque_bias,
    )
    verification = verify_still(calibrated(rng), poses(rng, 5, model=heavier))
    assert not verification.passed
    assert "is refused" in verification.verdict.reasons[0]
    assert verify_still(calibrated(rng), poses(rng, 5, model=heavier), limits=Limits(0.1, 0.2)).passed


def test_one_bumped_pose_is_named():
    rng = np.random.default_rng(4)
    calibration = calibrated(rng)
    samples = poses(rng, 5)
    bumped = replace(samples[2], torque=samples[2].torque + [0.006, 0, 0], name="the third")
    verification = verify_still(calibration, [*samples[:2], bumped, *samples[3:]])
    assert verification.names[verification.worst] == "the third"
    assert "the third" in " ".join(verification.verdict.reasons)


def test_few_poses_say_so():
    rng = np.random.default_rng(5)
    verification = verify_still(calibrated(rng), poses(rng, 1))
    assert verification.passed
    assert "1 pose says" in " ".join(verification.verdict.reasons)


def test_poses_that_were_averaged_for_less_have_more_noise():
    rng = np.random.default_rng(6)
    calibration = calibrated(rng)
    rough = poses(rng, 5, sigma=5 * SIGMA, count=4, force_sd=10 * SIGMA[:3], torque_sd=10 * SIGMA[3:])
    assert verify_still(calibration, rough).p_value > 1e-3
    assert verify_still(calibration, [replace(pose, count=400) for pose in rough]).p_value < 1e-3


def test_json_carries_all_figures():
    rng = np.random.default_rng(7)
    verification = verify_still(calibrated(rng), poses(rng, 3))
    facts = json.loads(json.dumps(verification.to_json(), allow_nan=False))
    assert facts["passed"] is True
    assert facts["contact_good_mm"] == 0.5
    assert facts["contact_rms_mm"] == pytest.approx(1e3 * verification.contact_rms)
    assert facts["p_value"] == verification.p_value
    assert [pose["name"] for pose in facts["poses"]] == ["pose 1", "pose 2", "pose 3"]
    assert facts["poses"][0]["residual_force_N"] == verification.residuals[0, :3].tolist()


def test_wrong_input():
    rng = np.random.default_rng(8)
    calibration = calibrated(rng)
    with pytest.raises(InputError, match="no poses"):
        verify_still(calibration, [])
    with pytest.raises(InputError, match="pose 2 was used for the calibration"):
        verify_still(calibration, [poses(rng, 1)[0], calibration.poses[0]])
