"""Calibrate, verify and export intrinsic contact sensing for medical robot probes: `contactbench.pipeline.api`."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from contactbench.pipeline.api import *  # noqa: F403 - what `__getattr__` gives

__version__: str

_PARTS = ("app", "assets", "pipeline", "widgets")


def __getattr__(name: str) -> Any:
    # Neither at every start: the command line needs but a part of it.
    if name == "__version__":
        from importlib.metadata import version

        return version("contactbench")
    if (
        name.startswith("_")
        or name in _PARTS
        or name not in (api := import_module("contactbench.pipeline.api")).__all__
    ):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(api, name)


def __dir__() -> list[str]:
    return [*globals(), *import_module("contactbench.pipeline.api").__all__]
