"""Files on which the product was wrong once, each for a whole kind: what it says of them, with nothing told beside."""

from pathlib import Path

import pytest

from contactbench.pipeline.calibration import Level, calibrate
from contactbench.pipeline.calibration.files.pose_csv import read_poses

FAULTS = Path(__file__).parents[2].parent / "shared" / "data" / "faults" / "cal"
pytestmark = pytest.mark.skipif(not FAULTS.is_dir(), reason=f"the files are not at {FAULTS}")


def read(name):
    return calibrate(read_poses(FAULTS / f"{name}.csv").poses)


def test_right_data_are_good():
    assert read("right").verdict.level is Level.GOOD


@pytest.mark.parametrize("name", ["both-in-base", "tcp-in-base"])
def test_a_wrench_along_the_axes_of_the_base_is_named(name):
    assert read(name).causes[0].key == "wrench_in_base"
    assert read(name).causes[0].odds > 0.95


def test_crosstalk_is_named_with_what_verification_should_show():
    calibration = read("crosstalk")
    assert calibration.causes[0].key == "crosstalk"
    assert calibration.verdict.level is not Level.GOOD
    assert not any("-1" in reason for reason in calibration.verdict.reasons)


def test_a_controller_that_subtracts_a_payload_is_the_first_of_the_guesses():
    first = read("overcompensated").causes[0]
    assert first.key == "payload_subtracted"
    assert first.odds < 0.8
    assert "Cannot be distinguished from: forces and torques with the wrong sign" in first.sentence


@pytest.mark.parametrize(
    ("name", "units"),
    [
        ("lbf-lbfin", "lbf"),
        ("unit-N_lbfin", "lbf·in"),
        ("unit-N_kgfcm", "kgf·cm"),
        ("unit-N_Nmm_noise-in-Nm", "N·mm"),
        ("unit-kN_Nm", "kN"),
        ("unit-kgf_Nm", "kgf"),
    ],
)
def test_a_centre_of_mass_where_no_tool_is_is_refused_and_the_unit_named(name, units):
    calibration = read(name)
    assert calibration.verdict.level is Level.REFUSE
    assert any("where no tool is" in reason for reason in calibration.verdict.reasons)
    assert any(units in reason for reason in calibration.verdict.reasons)
