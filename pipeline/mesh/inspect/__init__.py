"""What is known about a mesh before it is trusted: sizes, defects, hidden walls, in words and in numbers."""

from contactbench.pipeline.mesh.inspect.report import Finding, Inspection
from contactbench.pipeline.mesh.inspect.run import inspect, inspect_arrays

__all__ = ["Finding", "Inspection", "inspect", "inspect_arrays"]
