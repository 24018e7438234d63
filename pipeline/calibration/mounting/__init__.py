"""Gravity calibration when nobody knows how the sensor is turned on the flange."""

from contactbench.pipeline.calibration.mounting.mount import MountCalibration, estimate_mount

__all__ = ["MountCalibration", "estimate_mount"]
