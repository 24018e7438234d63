"""Gravity calibration: from still, contact-free poses to bias, weight and centre of mass, with uncertainty."""

from pipeline.calibration.calibrate import Calibration, calibrate
from pipeline.calibration.contact_error import ContactTask
from pipeline.calibration.fit import PoseNoise
from pipeline.calibration.model import PARAMETERS, GravityModel
from pipeline.calibration.poses import PoseError, PoseSample
from pipeline.calibration.verdict import Level, Limits, Verdict

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
