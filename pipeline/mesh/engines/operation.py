"""Which operations there are, and which library does each."""

from __future__ import annotations

from enum import StrEnum


class Library(StrEnum):
    """A mesh library, each with a child process of its own."""

    MESHLAB = "meshlab"
    CGAL = "cgal"

    @property
    def install(self) -> str:
        """The command that installs it."""
        return "pip install 'contactbench[meshlab]'"


class Operation(StrEnum):
    """What an engine can do; the typed functions of this package say what each takes and gives."""

    ALPHA_WRAP = "alpha wrap"
    CLOSE_HOLES = "close holes"
    SELF_INTERSECTIONS = "self-intersections"
    CUT = "cut along crossings"
    ORIENT = "orient facets"

    @property
    def library(self) -> Library:
        """The library that does it."""
        return Library.CGAL if self is Operation.CUT else Library.MESHLAB
