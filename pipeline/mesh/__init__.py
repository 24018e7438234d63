"""Probe surfaces: from a mesh file or arrays to a checked, unchangeable `Probe` in the sensor frame S."""

from pipeline.mesh.errors import MeshError, MeshWarning
from pipeline.mesh.health import MeshHealth
from pipeline.mesh.load import load_probe
from pipeline.mesh.probe import Probe
from pipeline.mesh.save import save_probe

__all__ = ["MeshError", "MeshHealth", "MeshWarning", "Probe", "load_probe", "save_probe"]
