"""A calibration in the words of those who use it: each consumer's names, units, frames and signs."""

from contactbench.pipeline.config.consumers import ft_calib_yaml, ft_tools_yaml, read_ft_calib, ros2_yaml
from contactbench.pipeline.config.vertical import VerticalResidual, vertical_residual

__all__ = [
    "VerticalResidual",
    "ft_calib_yaml",
    "ft_tools_yaml",
    "read_ft_calib",
    "ros2_yaml",
    "vertical_residual",
]
