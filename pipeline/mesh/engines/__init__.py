"""
The mesh libraries, each in a child process: what they break stays there.

pymeshlab carries its own Qt, it and the CGAL half of libigl are GPL-3, and both end the process on some meshes. Here a
crash is an `EngineError`.
"""

from contactbench.pipeline.mesh.engines.errors import Cancelled, EngineError
from contactbench.pipeline.mesh.engines.operation import Library, Operation
from contactbench.pipeline.mesh.engines.operations import (
    Control,
    alpha_wrap,
    close_holes,
    cut_along_crossings,
    orient_facets,
    self_intersections,
)
from contactbench.pipeline.mesh.engines.run import engine_pid, run, stop_engines

__all__ = [
    "Cancelled",
    "Control",
    "EngineError",
    "Library",
    "Operation",
    "alpha_wrap",
    "close_holes",
    "cut_along_crossings",
    "engine_pid",
    "orient_facets",
    "run",
    "self_intersections",
    "stop_engines",
]
