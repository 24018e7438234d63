"""The model's error: measured where it was put in, neither invented nor averaged away."""

import json
from dataclasses import asdict, replace

import numpy as np
import pytest
from benchmarks.verification import bench, draw_presses, sensor_noise, true_markers
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.report.report_file import parse_verification
from contactbench.pipeline.verification.causes import TouchEvidence, across
from contactbench.pipeline.verification.model_error import LEAST, measure_model_error, model_error_words

SETS, REPEATS = 20, 3
FORCE, TORQUE = 0.05, 0.001  # the default
# Calibrated well: 5 mN and 0.2 mN·m of bias, 5 mN of weight.
COVARIANCE = np.diag(np.repeat([0.005, 0.005, 0.001, 2e-4], 3) ** 2)
MODEL = GravityModel([0, 0, -5.0], np.zeros(3), [0, 0, 0.05], np.zeros(3), COVARIANCE)


def pulls(how, rng, markers):
    """(n, 6) of unit variance: each touch its own, one for each marker, one for all, or half and half."""
    own, by_marker, one = (rng.standard_normal((n, 6)) for n in (len(markers), markers.max() + 1, 1))
    return {"own": own, "marker": by_marker[markers], "one": one + 0 * own, "half": (own + one) / np.sqrt(2)}[
        how
    ]


def touches(times, how, seed, *, markers=17, repeats=REPEATS):
    """Evidence of touches whose wrenches are off by so many times the default."""
    rng = np.random.default_rng([seed, 11])
    points, normals = (each[:markers] for each in true_markers())
    names = np.repeat(np.arange(len(points)), repeats)
    points, normals = points[names], normals[names]
    hit = points + np.einsum("ni,nij->nj", rng.normal(0.0, 3e-4, (len(names), 2)), across(normals))
    noise = sensor_noise().covariance / 50
    wrenches = draw_presses(hit, normals, rng)
    wrenches += times * np.repeat([FORCE, TORQUE], 3) * pulls(how, rng, names)
    wrenches += rng.multivariate_normal(np.zeros(6), noise, len(names))
    R_WS = Rotation.random(len(names), random_state=seed).as_matrix()
    theta = rng.multivariate_normal(MODEL.vector, COVARIANCE)
    wrenches += GravityModel.from_vector(theta, COVARIANCE).predict(R_WS) - MODEL.predict(R_WS)
    zero = np.zeros(len(names))
    return TouchEvidence(
        zero[:, None] + np.zeros(3), names, points, normals, zero, wrenches, R_WS, zero, noise, MODEL.vector
    )


def measured(times, how, sets=SETS, **kind):
    """Return fields of estimates, (sets,) each, times the default; the draws as they are."""
    found = [asdict(measure_model_error(touches(times, how, seed, **kind), MODEL)) for seed in range(sets)]
    units = {"N": FORCE, "Nm": TORQUE, "draws": 1.0}
    return {name: np.array([each[name] for each in found]) / units[name.rsplit("_")[-1]] for name in found[0]}


@pytest.mark.parametrize(
    ("times", "how", "middle", "spread"),
    [
        (0.4, "own", 0.15, 0.5),
        (1.0, "own", 0.1, 0.25),
        (4.0, "own", 0.1, 0.25),
        (1.0, "marker", 0.15, 0.35),
        # One draw tells less than many.
        (1.0, "half", 0.35, 0.6),
        (0.4, "one", 0.35, 0.8),
        (1.0, "one", 0.35, 0.8),
        (4.0, "one", 0.35, 0.8),
    ],
)
def test_what_was_put_in_is_measured_and_the_bound_holds(times, how, middle, spread):
    found = measured(times, how)
    # Of 20 bounds that hold in 95 of 100 cases, four fail in one of 60.
    assert np.sum(found["most_force_N"] >= times) >= SETS - 3
    assert np.sum(found["most_torque_Nm"] >= times) >= SETS - 3
    assert np.sum(found["force_N"] >= times) >= 0.6 * SETS
    assert np.median(found["likely_force_N"]) == pytest.approx(times, rel=middle)
    assert np.quantile(np.abs(np.log(found["likely_force_N"] / times)), 0.8) < spread


def test_none_is_made_of_noise_calibration_and_placement():
    found = measured(0.0, "own")
    assert np.sum(np.isclose(found["force_N"], LEAST)) >= SETS - 2
    assert np.sum(found["most_force_N"] < 0.8) >= SETS - 2
    assert np.median(found["torque_Nm"]) < 0.7


def test_touches_that_are_off_alike_count_as_one_and_widen_the_bound():
    own, by_marker, one = (measured(2.0, how, 8) for how in ("own", "marker", "one"))
    assert np.median(own["draws"]) > 35
    assert 8 < np.median(by_marker["draws"]) < 20
    assert np.median(one["draws"]) < 1.5
    widths = [np.median(each["most_force_N"] / each["likely_force_N"]) for each in (own, by_marker, one)]
    assert widths[0] < widths[1] < widths[2]
    assert widths[2] > 2
    # Ten touches for each marker instead of three know no more of a pull that is always the same.
    more = measured(2.0, "one", 8, repeats=10)
    assert np.median(more["most_force_N"] / more["likely_force_N"]) > 0.9 * widths[2]


def test_a_torque_that_markers_at_one_lever_arm_do_not_tell_keeps_the_ratio():
    found = measured(4.0, "own", 8, markers=6)
    ratio = found["likely_torque_Nm"] / found["likely_force_N"]
    assert np.all((ratio > 1 / 3) & (ratio < 3))


def test_few_markers_measure_nothing_and_it_is_said():
    assert measure_model_error(touches(1.0, "own", 0, markers=5), MODEL) is None
    words = model_error_words(None)
    assert "not measured" in words
    assert "0.05 N, 1.0 mN·m are assumed" in words
    assert "at least 6 markers" in words


def test_words_say_how_much_and_what_to_do_only_where_it_is_much():
    found = measure_model_error(touches(1.0, "own", 0), MODEL)
    usual, much = (replace(found, force_N=size, torque_Nm=1.2e-3) for size in (0.06, 0.2))
    assert model_error_words(usual).startswith("Model error: 0.06 N, 1.2 mN·m (95 % upper limit ")
    assert model_error_words(usual).endswith("No action needed.")
    assert "cable" in model_error_words(much).split("allows for it.")[1]


def test_a_verification_carries_it_and_an_older_file_does_without():
    made = bench(None, np.random.default_rng(5)).verified()
    # Nothing is left out of the bench's model.
    assert made.model_error.force_N == pytest.approx(LEAST * FORCE)
    content = made.to_json()
    assert content["model_error"] == asdict(made.model_error)
    assert parse_verification(made.to_bytes(), "v.json").model_error == made.model_error
    del content["model_error"]
    assert parse_verification(json.dumps(content).encode(), "v.json").model_error is None
