"""Devices at work: a line, a parser and the commands between them, kept running and watched."""

from pipeline.devices.drive.driver import SensorDriver, driver_for
from pipeline.devices.drive.health import Health, State
from pipeline.devices.drive.kept import KeptStream
from pipeline.devices.drive.poses import ElfinPoses, UrPoses, poses_from
from pipeline.devices.drive.stream import SensorStream

__all__ = [
    "ElfinPoses",
    "Health",
    "KeptStream",
    "SensorDriver",
    "SensorStream",
    "State",
    "UrPoses",
    "driver_for",
    "poses_from",
]
