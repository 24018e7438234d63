"""Gravity calibration: from still, contact-free poses to bias, weight and centre of mass, with uncertainty."""

from contactbench.pipeline.calibration.calibrate import Calibration, calibrate
from contactbench.pipeline.calibration.model import PARAMETERS, GravityModel, PoseNoise
from contactbench.pipeline.calibration.poses import PoseError, PoseSample
from contactbench.pipeline.calibration.suggest import ContactTask
from contactbench.pipeline.calibration.verdict import Level, Limits, Verdict

__all__ = [
    "PARAMETERS",
    "Calibration",
    "ContactTask",
    "GravityModel",
    "Level",
    "Limits",
    "PoseError",
    "PoseNoise",
    "PoseSample",
    "Verdict",
    "calibrate",
]
