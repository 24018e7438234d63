"""
The mesh libraries, each in a child process: what they break stays there.

pymeshlab carries its own Qt, it and the CGAL half of libigl are GPL-3, and both end the process on some meshes. Here a
crash is an `EngineError`.
"""

from contactbench.pipeline.mesh.engines.child import start_engine, stop_engines
from contactbench.pipeline.mesh.engines.libraries import EngineError, Operation
from contactbench.pipeline.mesh.engines.operations import Control, alpha_wrap, cut_along_crossings
from contactbench.pipeline.mesh.monitor import NOBODY, Cancelled, Monitor

__all__ = [
    "NOBODY",
    "Cancelled",
    "Control",
    "EngineError",
    "Monitor",
    "Operation",
    "alpha_wrap",
    "cut_along_crossings",
    "start_engine",
    "stop_engines",
]
