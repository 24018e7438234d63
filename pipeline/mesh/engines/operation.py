"""Which operations there are, and which library does each."""

from __future__ import annotations

from enum import StrEnum


class Library(StrEnum):
    """A mesh library, each with a child process of its own."""

    FAST_SIMPLIFICATION = "fast-simplification"
    MESHLAB = "meshlab"

    @property
    def install(self) -> str:
        """The command that installs it."""
        target = "'contactbench[meshlab]'" if self is Library.MESHLAB else "fast-simplification"
        return f"pip install {target}"


class Operation(StrEnum):
    """What an engine can do; the typed functions of this package say what each takes and gives."""

    ALPHA_WRAP = "alpha wrap"
    CLOSE_HOLES = "close holes"
    SELF_INTERSECTIONS = "self-intersections"
    ORIENT = "orient facets"
    QUADRIC = "quadric simplification"
    FAST_QUADRIC = "fast quadric simplification"

    @property
    def library(self) -> Library:
        """The library that does it."""
        return Library.FAST_SIMPLIFICATION if self is Operation.FAST_QUADRIC else Library.MESHLAB
