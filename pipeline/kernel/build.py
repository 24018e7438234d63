"""Of which source, and how, the compiled kernel was built."""

import json
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path


@dataclass(frozen=True)
class Build:
    """
    What the build wrote beside the kernel.

    Attributes
    ----------
    commit : str
        Of the source, with ``+`` behind it where files had been changed; empty: built without Git, as from an sdist.
    kind : str
        CMake's build type, such as Release; empty: not known.
    """

    commit: str = ""
    kind: str = ""

    def __str__(self) -> str:
        if not self.kind:
            return "unknown build"
        return f"{self.kind} build of {self.commit or 'an unknown commit'}"


def build() -> Build:
    """Return how the kernel was built, as far as it is known."""
    beside = import_module("contactbench.pipeline.kernel._cpu").__file__
    try:
        told = json.loads(Path(str(beside)).with_name("build.json").read_text("utf-8"))
        return Build(str(told["commit"]), str(told["kind"]))
    except (OSError, ValueError, KeyError, TypeError):  # a kernel that was built by hand has none
        return Build()
