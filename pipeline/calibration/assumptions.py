"""What a person says of a calibration beside the poses, and the calibration that follows from both."""

from typing import Any

import numpy as np

from contactbench.pipeline.calibration import Calibration, ContactTask, PoseNoise, calibrate
from contactbench.pipeline.calibration.diagnosis.diagnose import RawOrientations
from contactbench.pipeline.calibration.files.calibration_file import Mount
from contactbench.pipeline.calibration.files.pose_csv import PoseTable
from contactbench.pipeline.calibration.mount import MountCalibration, estimate_mount
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.settings import CalibrationSettings, NoiseSettings, TaskSettings


def fitted(
    table: PoseTable, given: CalibrationSettings
) -> tuple[Calibration, MountCalibration | None, Mount | None]:
    """Calibrate from poses; return what was found, with the mount where that was asked for, and the mount to keep."""
    said = assumed(given)
    if given.estimate_mount:
        mounted = estimate_mount(table.poses, **said)
        return mounted.calibration, mounted, Mount.of(mounted.R_SE, mounted.rotation_covariance)
    found = calibrate(table.poses, raw=RawOrientations(table.raw, table.convention), **said)
    return found, None, None if given.R_ES is None else Mount.of(given.R_ES.T)


def assumed(given: CalibrationSettings) -> dict[str, Any]:
    """Return all of it, by the names of the parameters; InputError where half of it is missing."""
    return {
        "noise": pose_noise(given),
        "orientation_sigma": given.orientation_sigma,
        "down_W": given.down,
        "task": contact_task(given),
    }


def pose_noise(given: NoiseSettings) -> PoseNoise | None:
    """Return the noise of a pose's mean; None: it is estimated from the poses. InputError where one is missing."""
    force, torque = given.noise_force, given.noise_torque
    if (force is None) != (torque is None):
        raise InputError("Give both --noise-force and --noise-torque, or neither.")
    return None if force is None or torque is None else PoseNoise(force, torque)


def contact_task(given: TaskSettings) -> ContactTask:
    """Return the touches; the probe is touched at its end: the normal points along z, to the side of the tip."""
    tip = np.array(given.tip) / 1000
    return ContactTask(tip, np.array([0.0, 0.0, -1.0 if tip[2] < 0 else 1.0]), given.contact_force)
