"""What a person says of a calibration beside the poses, as `calibrate` and `estimate_mount` take it."""

from typing import Any

import numpy as np

from contactbench.pipeline.calibration import ContactTask, PoseNoise
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.settings import CalibrationSettings, NoiseSettings, TaskSettings


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
