"""What is known about a mesh before it is trusted: sizes, defects, hidden walls, in words and in numbers."""

from contactbench.pipeline.mesh.inspect.run import Inspection, inspect
from contactbench.pipeline.mesh.inspect.words import MeshFinding

__all__ = ["Inspection", "MeshFinding", "inspect"]
