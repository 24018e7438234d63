"""The config that a robot's runtime loads: its schema, its bundle, its checks."""

from pipeline.config.runtime.build import Filters, RobotNames, build_config
from pipeline.config.runtime.config import RuntimeConfig
from pipeline.config.runtime.errors import ConfigError, RateUnknownError, UnverifiedError
from pipeline.config.runtime.model import RuntimeModel

__all__ = [
    "ConfigError",
    "Filters",
    "RateUnknownError",
    "RobotNames",
    "RuntimeConfig",
    "RuntimeModel",
    "UnverifiedError",
    "build_config",
]
