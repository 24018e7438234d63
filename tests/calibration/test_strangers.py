"""Files on which the product was wrong once, each for a whole kind: what it says of them, with nothing told beside."""

from pathlib import Path

import pytest

from contactbench.pipeline.calibration import Level, calibrate
from contactbench.pipeline.calibration.files.pose_csv import read_poses

FAULTS = Path(__file__).parents[2].parent / "shared" / "data" / "faults" / "cal"


@pytest.mark.skipif(not FAULTS.is_dir(), reason=f"the files are not at {FAULTS}")
@pytest.mark.parametrize(
    ("name", "level", "key", "words"),
    [
        ("right", Level.GOOD, "plain", "No action needed"),
        ("both-in-base", Level.REFUSE, "wrench_in_base", "axes of the robot's base"),
        ("tcp-in-base", Level.REFUSE, "wrench_in_base", "axes of the robot's base"),
        ("crosstalk", Level.USABLE, "crosstalk", "have the sensor recalibrated"),
        (
            "overcompensated",
            Level.REFUSE,
            "payload_subtracted",
            "from: forces and torques with the wrong sign",
        ),
        ("lbf-lbfin", Level.REFUSE, None, "lbf·in"),
        ("unit-N_lbfin", Level.REFUSE, None, "lbf·in"),
        ("unit-N_kgfcm", Level.REFUSE, None, "kgf·cm"),
        ("unit-N_Nmm_noise-in-Nm", Level.REFUSE, "torque_Nmm", "N·mm"),
        ("unit-kN_Nm", Level.REFUSE, "force_kN", "kN"),
        ("unit-kgf_Nm", Level.REFUSE, None, "kgf"),
    ],
)
def test_a_file_that_was_judged_wrongly_is_judged_rightly(name, level, key, words):
    calibration = calibrate(read_poses(FAULTS / f"{name}.csv").poses)
    assert calibration.verdict.level is level
    assert key is None or calibration.causes[0].key == key
    assert any(words in reason for reason in calibration.verdict.reasons)
    assert name != "crosstalk" or not any("by -1" in reason for reason in calibration.verdict.reasons)
