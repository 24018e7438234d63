"""
The mesh libraries, each in a child process: what they break stays there.

fast-simplification holds the interpreter while it works and has state that all threads share; pymeshlab
carries its own Qt and is GPL-3; both end the process on some meshes. Here a crash is an `EngineError`.
"""

from pipeline.mesh.engines.errors import Cancelled, EngineError
from pipeline.mesh.engines.operation import Library, Operation
from pipeline.mesh.engines.operations import (
    Control,
    alpha_wrap,
    close_holes,
    fast_quadric,
    orient_facets,
    quadric,
    self_intersections,
)
from pipeline.mesh.engines.run import engine_pid, run, stop_engines

__all__ = [
    "Cancelled",
    "Control",
    "EngineError",
    "Library",
    "Operation",
    "alpha_wrap",
    "close_holes",
    "engine_pid",
    "fast_quadric",
    "orient_facets",
    "quadric",
    "run",
    "self_intersections",
    "stop_engines",
]
