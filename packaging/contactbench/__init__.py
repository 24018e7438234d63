"""Calibrate, verify and export intrinsic contact sensing for medical robot probes."""

from typing import Any

__version__: str


def __getattr__(name: str) -> Any:
    if name != "__version__":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib.metadata import version  # not at every start: it takes as long as half of the command line

    return version("contactbench")
