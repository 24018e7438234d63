"""The budget of a calibration: it adds up to the number by which the calibration is judged."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from weighing_files import weighed

from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.budget import BudgetSource as Source
from contactbench.pipeline.calibration.budget import calibration_budget, combined_mm
from contactbench.pipeline.calibration.mount import estimate_mount


@pytest.fixture(scope="module")
def poses():
    return weighed().poses


@pytest.fixture(scope="module")
def calibration(poses):
    return calibrate(poses)


def by_source(calibration):
    return {row.source: row for row in calibration_budget(calibration)}


def test_the_rows_add_up_to_the_contact_error(calibration):
    assert combined_mm(calibration_budget(calibration)) == pytest.approx(
        1e3 * calibration.contact_error, rel=1e-9
    )
    found = by_source(calibration)
    assert found[Source.MOUNT].kind == ""  # it was known: there is no remainder to hide an error in
    assert found[Source.MOUNT].variance_mm2 == 0
    for row in found.values():
        if row.standard is not None:
            assert row.contribution_mm == pytest.approx(row.standard * row.sensitivity, rel=1e-9)


def test_a_wider_bias_shows_in_its_row(calibration):
    wider = calibration.covariance.copy()
    wider[3:6] *= 100
    wider[:, 3:6] *= 100
    error = calibration.task.calibration_error(calibration.model.vector, wider)
    biased = replace(calibration, model=replace(calibration.model, covariance=wider), contact_error=error)
    found = by_source(biased)
    assert max(found.values(), key=lambda row: row.contribution_mm).source is Source.FORCE_BIAS
    assert combined_mm(found.values()) == pytest.approx(1e3 * error, rel=1e-9)


def test_what_the_model_leaves_out_is_a_row(calibration):
    error = float(np.hypot(calibration.contact_error, 3e-4))
    found = by_source(replace(calibration, model_error=3e-4, contact_error=error))
    assert found[Source.MODEL].contribution_mm == pytest.approx(0.3)
    assert combined_mm(found.values()) == pytest.approx(1e3 * error, rel=1e-9)


def test_a_mount_that_was_estimated_is_a_row(poses):
    turn = Rotation.from_euler("xyz", [10, -5, 40], degrees=True).as_matrix()
    mounted = estimate_mount([replace(pose, R_WS=pose.R_WS @ turn) for pose in poses]).calibration
    found = by_source(mounted)
    assert found[Source.MOUNT].kind == "A"
    assert found[Source.MOUNT].variance_mm2 != 0
    assert combined_mm(found.values()) == pytest.approx(1e3 * mounted.contact_error, rel=1e-9)
