"""The runtime in Python: raw samples of a sensor and of a robot in, contacts out, sample by sample."""

from pipeline.config.runtime.runtime_of import make_runtime
from pipeline.runtime.engine import Engine
from pipeline.runtime.errors import OutputError, RunError
from pipeline.runtime.lines import Answer
from pipeline.runtime.outlet import Outlet
from pipeline.runtime.run import Run

__all__ = ["Answer", "Engine", "Outlet", "OutputError", "Run", "RunError", "make_runtime"]
