"""The uncertainty budget: its rows add up, and to what the program says elsewhere of the same errors."""

import json
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.verification import bench

from contactbench.pipeline.calibration.budget import BudgetSource as Source
from contactbench.pipeline.calibration.budget import combined_mm
from contactbench.pipeline.report.report_file import parse_verification
from contactbench.pipeline.verification.model_error import PLACEMENT_M
from contactbench.pipeline.verification.verify import verify

READINGS = (Source.NOISE_FORCE, Source.NOISE_TORQUE)
FITTED = (Source.FORCE_BIAS, Source.TORQUE_BIAS, Source.MASS, Source.CENTRE_OF_MASS, Source.CORRELATION)


def covariance(seed=0):
    """Of a calibration of about 0.02 N, 0.5 mm and 1 mN·m whose parameters are correlated."""
    sizes = np.repeat([0.02, 0.02, 5e-4, 1e-3], 3)
    mixed = np.random.default_rng(seed).normal(size=(12, 14))
    return sizes[:, None] * (mixed @ mixed.T / 14) * sizes


@pytest.fixture(scope="module")
def given():
    found = bench(None, np.random.default_rng(5))
    return replace(found, model=replace(found.model, covariance=covariance()))


def verified(given, **more):
    return verify(given.probe, given.model, given.markers, given.recording, **more)


@pytest.fixture(scope="module")
def found(given):
    return verified(given, mesh_deviation=4e-5)


def rows(verification):
    return {row.source: row for row in verification.budget}


def test_noise_and_calibration_are_what_was_predicted_of_each_touch(found):
    predicted = [touch.predicted_mm**2 for touch in found.touches if touch.accepted]
    part = sum(rows(found)[source].variance_mm2 for source in (*READINGS, *FITTED))
    assert part == pytest.approx(np.mean(predicted), rel=1e-9)
    assert found.overall.rms_mm / np.sqrt(part) == pytest.approx(found.ratio, rel=1e-9)


def test_contributions_are_uncertainty_times_sensitivity_and_add_up(found):
    for row in found.budget:
        if row.standard is not None:
            assert row.contribution_mm == pytest.approx(row.standard * row.sensitivity, rel=1e-9)
    squares = sum(np.sign(row.contribution_mm) * row.contribution_mm**2 for row in found.budget)
    assert found.combined_mm == pytest.approx(np.sqrt(squares), rel=1e-12)
    assert rows(found)[Source.CORRELATION].variance_mm2 != 0


def test_the_models_error_is_the_one_that_a_bundle_allows_for(found):
    assert rows(found)[Source.MODEL_FORCE].standard == pytest.approx(found.model_error.force_N, rel=1e-9)
    assert rows(found)[Source.MODEL_TORQUE].standard == pytest.approx(
        1e3 * found.model_error.torque_Nm, rel=1e-9
    )
    markers = rows(found)[Source.MARKERS]
    assert markers.standard == pytest.approx(1e3 * PLACEMENT_M, rel=1e-9)
    assert markers.sensitivity == pytest.approx(np.sqrt(2), rel=1e-9)  # two directions along the surface


def test_each_cause_changes_its_own_row(given, found):
    wider = covariance()
    wider[3:6] *= 3
    wider[:, 3:6] *= 3
    changed = rows(
        verified(replace(given, model=replace(given.model, covariance=wider)), mesh_deviation=8e-5)
    )
    before = rows(found)
    assert changed[Source.FORCE_BIAS].contribution_mm == pytest.approx(
        3 * before[Source.FORCE_BIAS].contribution_mm, rel=1e-9
    )
    assert changed[Source.MESH].contribution_mm == pytest.approx(
        2 * before[Source.MESH].contribution_mm, rel=1e-9
    )
    for source in (*READINGS, Source.TORQUE_BIAS, Source.MASS, Source.CENTRE_OF_MASS, Source.MARKERS):
        assert changed[source] == before[source]


def test_a_mesh_that_says_nothing_has_no_part(given, found):
    silent = verified(given)
    assert rows(silent)[Source.MESH].kind == ""
    assert silent.combined_mm**2 == pytest.approx(
        found.combined_mm**2 - rows(found)[Source.MESH].variance_mm2, rel=1e-9
    )


def test_a_budget_is_kept_with_its_verification_and_files_of_before_have_none(found):
    again = parse_verification(found.to_bytes(), "v.json")
    assert again.budget == found.budget
    assert combined_mm(again.budget) == found.combined_mm
    data = json.loads(found.to_bytes())
    del data["budget"]
    old = parse_verification(json.dumps(data).encode(), "v.json")
    assert old.budget == ()
    assert old.combined_mm is None
