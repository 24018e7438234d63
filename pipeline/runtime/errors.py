"""What the runtime raises."""

from __future__ import annotations

from contactbench.pipeline.errors import InputError


class RunError(InputError):
    """A bundle that must not be run, or an option that cannot be: says which, and the remedy."""


class OutputError(InputError):
    """Contacts that cannot be published: names where to, and the remedy."""


class ReaderGoneError(OutputError):
    """Whoever read the contacts has closed the pipe."""
