"""Probe surfaces: from a mesh file or arrays to a checked, unchangeable `Probe` in the sensor frame S."""

from contactbench.pipeline.errors import MeshError, MeshWarning
from contactbench.pipeline.mesh.load import load_probe
from contactbench.pipeline.mesh.probe import MeshHealth, Probe
from contactbench.pipeline.mesh.sidecar import save_probe

__all__ = ["MeshError", "MeshHealth", "MeshWarning", "Probe", "load_probe", "save_probe"]
