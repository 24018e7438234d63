"""Sensors at work: a line, a parser and the commands between them, kept running and watched."""

from pipeline.devices.drive.driver import SensorDriver, driver_for
from pipeline.devices.drive.health import Health, State
from pipeline.devices.drive.stream import SensorStream

__all__ = ["Health", "SensorDriver", "SensorStream", "State", "driver_for"]
