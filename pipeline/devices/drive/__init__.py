"""Devices at work: a line, a parser and the commands between them, kept running and watched."""

from pipeline.devices.drive.driver import SensorDriver, driver_for
from pipeline.devices.drive.health import Health, State
from pipeline.devices.drive.kept import KeptStream
from pipeline.devices.drive.poses import ElfinPoses, UrPoses, poses_from
from pipeline.devices.drive.rezero import Rezero, RezeroDetector
from pipeline.devices.drive.stream import SensorStream
from pipeline.devices.drive.watch import Watch

__all__ = [
    "ElfinPoses",
    "Health",
    "KeptStream",
    "Rezero",
    "RezeroDetector",
    "SensorDriver",
    "SensorStream",
    "State",
    "UrPoses",
    "Watch",
    "driver_for",
    "poses_from",
]
