"""What is known about a mesh before it is trusted: sizes, defects, hidden walls, in words and in numbers."""

from pipeline.mesh.inspect.report import Finding, Inspection
from pipeline.mesh.inspect.run import inspect, inspect_arrays

__all__ = ["Finding", "Inspection", "inspect", "inspect_arrays"]
