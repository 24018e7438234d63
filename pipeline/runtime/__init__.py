"""The runtime in Python: raw samples of a sensor and of a robot in, contacts out, sample by sample."""

from contactbench.pipeline.config.runtime.values import make_runtime
from contactbench.pipeline.errors import OutputError, RunError
from contactbench.pipeline.runtime.lines import Answer
from contactbench.pipeline.runtime.outlet import Outlet
from contactbench.pipeline.runtime.run import Engine, Run

__all__ = ["Answer", "Engine", "Outlet", "OutputError", "Run", "RunError", "make_runtime"]
