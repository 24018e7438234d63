"""Calibrate, verify and export intrinsic contact sensing for medical robot probes."""

from importlib.metadata import version

__version__ = version("contactbench")
