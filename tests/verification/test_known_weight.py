"""A known weight finds what no residual can: scale, unit, sign, swapped channels."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from weighing_files import TRUTH, planned

from contactbench.pipeline.calibration import GravityModel, PoseNoise, PoseSample, calibrate
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.simulation.loads import weigh
from contactbench.pipeline.verification.known_check import CheckOutcome
from contactbench.pipeline.verification.known_weight import WeightParameters, check_weight

G = 9.80665
MEAN = PoseNoise(0.01, 0.0004)  # of a mean over a still pose
SAMPLE = 0.05  # N, of one sample; 200 of them are a second
TILTS = Rotation.from_euler("xyz", [[0, 0, 0], [80, 0, 0], [50, 40, 0]], degrees=True).as_matrix()


def wrong(force=1.0, torque=1.0):
    """Return what a sensor with a mistake makes of wrenches: forces and torques times matrices or numbers."""
    T = np.zeros((6, 6))
    T[:3, :3], T[3:, 3:] = (np.eye(3) * each if np.ndim(each) == 0 else each for each in (force, torque))
    return T


def readings(
    R_WS, rng, *, mass=0.0, at=(0.03, 0.02, 0.1), T=None, zero=0.0, sd=SAMPLE, count=400, scatter=True
):
    """Return still poses with a mass on a string, on a point of the tool, as the sensor reads them."""
    T = np.eye(6) if T is None else T
    poses = []
    for R in np.atleast_3d(R_WS).reshape(-1, 3, 3):
        f = R.T @ np.array([0, 0, -G * mass])
        w = TRUTH.predict(R) + np.concatenate([f, np.cross(at, f)]) + zero
        noise = np.repeat([sd, sd * 0.04], 3) / np.sqrt(count)
        w = T @ (w + rng.standard_normal(6) * noise)
        sds = (np.full(3, sd), np.full(3, sd * 0.04)) if scatter else (None, None)
        poses.append(PoseSample(R, w[:3], w[3:], count if scatter else 1, *sds))
    return poses


@cache
def _calibrated(T):
    poses = []
    for pose in weigh(TRUTH, planned(10), MEAN, np.random.default_rng(0)).poses:
        w = np.reshape(T, (6, 6)) @ np.concatenate([pose.force, pose.torque])
        poses.append(replace(pose, force=w[:3], torque=w[3:]))
    return calibrate(poses)


def calibrated(T=None):
    return _calibrated(tuple((np.eye(6) if T is None else T).ravel()))


def check(T=None, seed=1, mass=1.0, R=TILTS[:1], calibration=None, given=None, **more):
    """Check a sensor that had the mistake T also while it was calibrated."""
    rng = np.random.default_rng(seed)
    calibration = calibration or calibrated(T)
    settings = {key: more.pop(key) for key in ("gravity", "limit", "reach", "mass_sigma") if key in more}
    return check_weight(
        calibration,
        readings(R, rng, T=T, **more),
        readings(R, rng, mass=mass, T=T, **more),
        mass if given is None else given,
        **{"mass_sigma": 0.0005, **settings},
    )


def test_a_right_sensor_passes_and_says_how_sure_that_is():
    found = [check(seed=seed) for seed in range(100)]
    assert sum(each.passed for each in found) >= 97
    assert not any(each.outcome is CheckOutcome.FAILED for each in found)
    pulls = [(each.measured - 1.0) / each.measured_sigma for each in found]
    assert 0.3 < np.std(pulls) < 1.2  # samples count as correlated: the sigma is rather too large
    assert found[0].axes == ("z",)
    assert "hardly loaded fx, fy" in found[0].sentence
    assert found[0].lever == pytest.approx(np.hypot(0.03, 0.02), abs=0.003)


@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_a_scale_error_of_one_percent_is_found_with_a_kilogram(factor):
    found = [check(wrong(factor, factor), seed=seed) for seed in range(60)]
    assert sum(each.outcome is CheckOutcome.FAILED for each in found) >= 57
    assert not any(each.passed for each in found)
    word = "too much" if factor > 1 else "too little"
    assert all(
        word in each.sentence and "multiply its forces" in each.sentence for each in found if each.reasons
    )
    assert np.mean([each.scale for each in found]) == pytest.approx(factor, abs=5e-4)


def test_an_error_within_half_the_limit_is_not_called_one():
    assert all(check(wrong(1.004, 1.004), seed=seed).passed for seed in range(20))


def test_it_does_not_pass_when_it_cannot_tell_and_says_what_would():
    rng = np.random.default_rng(3)
    loud = check_weight(
        replace(calibrated(), noise=PoseNoise(0.05, 0.002)),
        readings(TILTS[:1], rng, scatter=False),
        readings(TILTS[:1], rng, mass=1.0, scatter=False),
        1.0,
    )
    assert loud.outcome is CheckOutcome.UNDECIDED
    assert not loud.passed
    assert "inconclusive" in loud.sentence
    assert "or more, hold still for longer" in loud.sentence
    rough = check(mass_sigma=0.02)
    assert rough.outcome is CheckOutcome.UNDECIDED
    assert "Use a weight known to better than 2 %" in rough.sentence
    narrow = check(limit=0.002, mass_sigma=1e-5)
    assert narrow.outcome is CheckOutcome.UNDECIDED
    assert "local gravity" in narrow.sentence


def test_a_short_loud_reading_is_as_unsure_as_it_says():
    found = [check(sd=1.0, count=10, seed=seed) for seed in range(20)]
    assert all(each.measured_sigma > 0.05 for each in found)
    assert not any(each.passed for each in found)


def test_a_certificate_of_gravity_makes_a_narrow_limit_possible():
    assert check(limit=0.004, gravity=G, count=40_000, mass_sigma=1e-5).passed


@pytest.mark.parametrize(
    ("T", "words"),
    [
        (wrong(1 / 9.80665, 1 / 9.80665), "in kgf"),
        (wrong(1 / 4.448222, 1 / 4.448222), "in lbf"),
        (wrong(9.80665, 9.80665), "once too often"),
        (wrong(1000.0, 1000.0), "in mN"),
        (wrong(1.0, 1000.0), "in N·mm"),
        (wrong(1.0, 100.0), "N·cm"),
        (wrong(-1.0, -1.0), "wrong sign"),
    ],
)
def test_the_usual_units_and_signs_are_named(T, words):
    found = check(T)
    assert found.outcome is CheckOutcome.FAILED
    assert words in found.sentence


def test_swapped_readings_are_told_from_a_wrong_sign():
    rng = np.random.default_rng(0)
    found = check_weight(calibrated(), readings(TILTS[:1], rng, mass=1.0), readings(TILTS[:1], rng), 1.0)
    assert found.outcome is CheckOutcome.FAILED
    assert "swapped" in found.sentence


def test_mass_in_pounds_and_in_grams():
    assert "in pounds" in check(mass=0.45359237, given=1.0).sentence
    assert "in grams" in check(given=999.0).sentence


def test_no_weight_at_all():
    rng = np.random.default_rng(0)
    found = check_weight(calibrated(), readings(TILTS[:1], rng), readings(TILTS[:1], rng), 1.0)
    assert found.outcome is CheckOutcome.FAILED
    assert "do not show" in found.sentence


def swapped(a, b):
    P = np.eye(3)
    P[[a, b]] = P[[b, a]]
    return P


@pytest.mark.parametrize(
    ("force", "words"),
    [
        (swapped(0, 1), "fx and fy are swapped"),
        (swapped(1, 2), "fy and fz are swapped"),
        (np.diag([1.0, -1.0, 1.0]), "fy has the wrong sign"),
    ],
)
def test_channels_that_differ_from_those_of_the_calibration_are_named(force, words):
    found = check(wrong(force), R=TILTS, calibration=calibrated())
    assert found.outcome is CheckOutcome.FAILED
    assert words in found.sentence


def test_all_channels_are_tested_by_three_tilts():
    found = check(R=TILTS)
    assert found.passed
    assert found.axes == ("x", "y", "z")
    one = check(wrong(np.diag([1.0, 1.05, 1.0])), R=TILTS, calibration=calibrated())
    assert one.outcome is CheckOutcome.FAILED


def test_readings_that_do_not_agree_are_told():
    rng = np.random.default_rng(0)
    loaded = [
        *readings(TILTS[:1], rng, mass=1.0),
        *readings(TILTS[:1], rng, mass=1.02),
        *readings(TILTS[:1], rng, mass=0.98),
    ]
    found = check_weight(calibrated(), readings(TILTS[:1], rng), loaded, 1.0)
    assert abs(found.scale - 1) < 0.005
    assert found.outcome is CheckOutcome.FAILED
    assert "differ between poses" in found.sentence


def test_a_twisted_torque_is_no_hanging_weight():
    found = check(wrong(1.0, np.diag([1.0, -1.0, 1.0])), R=TILTS, calibration=calibrated())
    assert found.outcome is CheckOutcome.FAILED
    assert "Torque channels are swapped" in found.sentence


def test_a_moved_zero_does_no_harm_but_is_told():
    found = check(zero=np.array([0.8, 0, -0.5, 0.6, 0, 0.2]))
    assert found.passed
    assert found.lever == pytest.approx(np.hypot(0.03, 0.02), abs=0.003)
    assert "its zero moved" in found.sentence


def test_down_is_where_the_calibration_says():
    flipped = GravityModel(-TRUTH.gravity_W, TRUTH.force_bias, TRUTH.centre_of_mass_S, TRUTH.torque_bias)
    rng = np.random.default_rng(2)
    weighing = weigh(flipped, planned(10), MEAN, rng)
    ceiling = calibrate(weighing.poses, down_W=(0.0, 0.0, 1.0))

    def hung(mass):
        f = np.array([0, 0, G * mass])
        w = flipped.predict(np.eye(3)) + np.concatenate([f, np.cross([0.03, 0, 0.1], f)])
        w += rng.standard_normal(6) * np.repeat([0.0025, 0.0001], 3)
        return [PoseSample(np.eye(3), w[:3], w[3:], 400, np.full(3, SAMPLE), np.full(3, 0.002))]

    assert check_weight(ceiling, hung(0.0), hung(1.0), 1.0).passed


@pytest.mark.parametrize(
    ("wrongly", "words"),
    [
        ({"mass": 0.0}, "above 0"),
        ({"mass": float("nan")}, "above 0"),
        ({"mass_sigma": 2.0}, "a smaller uncertainty"),
        ({"gravity": 1.6}, "between 9.7"),
        ({"unloaded": []}, "unloaded: there are no still readings"),
        ({"loaded": []}, "loaded: there are no still readings"),
    ],
)
def test_wrong_input_is_said(wrongly, words):
    rng = np.random.default_rng(0)
    good = {"unloaded": readings(TILTS[:1], rng), "loaded": readings(TILTS[:1], rng, mass=1.0), "mass": 1.0}
    given = {**good, **wrongly}
    with pytest.raises(InputError, match=words):
        check_weight(calibrated(), given.pop("unloaded"), given.pop("loaded"), given.pop("mass"), **given)


@pytest.mark.parametrize("name", ["weight.txt", "../weight.json", "a/b.json"])
def test_the_file_must_be_json_in_the_folder(name):
    with pytest.raises(InputError, match="json"):
        WeightParameters.checked({"name": name, "mass": 1.0})


def test_parameters_that_nobody_knows_are_named():
    with pytest.raises(InputError, match="parameter weight"):
        WeightParameters.checked({"name": "w.json", "mass": 1.0, "weight": 2.0})
