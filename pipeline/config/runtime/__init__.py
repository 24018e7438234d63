"""The config that a robot's runtime loads: its schema, its bundle, its checks."""

from contactbench.pipeline.config.runtime.build import Filters, RobotNames, build_config
from contactbench.pipeline.config.runtime.config import RuntimeConfig
from contactbench.pipeline.config.runtime.model import RuntimeModel
from contactbench.pipeline.errors import ConfigError, RateUnknownError, UnverifiedError

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
