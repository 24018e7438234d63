"""Devices at work: a line, a parser and the commands between them, kept running and watched."""

from contactbench.pipeline.devices.drive.driver import SensorDriver, driver_for
from contactbench.pipeline.devices.drive.health import Health, State
from contactbench.pipeline.devices.drive.kept import KeptStream
from contactbench.pipeline.devices.drive.poses import ElfinPoses, UrPoses, poses_from
from contactbench.pipeline.devices.drive.rezero import Rezero, RezeroDetector
from contactbench.pipeline.devices.drive.stream import SensorStream
from contactbench.pipeline.devices.drive.watch import Watch

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
