"""What the mesh engines raise."""

from contactbench.pipeline.errors import InputError


class EngineError(InputError):
    """A mesh library that is missing, refused the mesh, or died on it: names the library and the remedy."""


class Cancelled(Exception):  # noqa: N818 -- not an error: the caller asked for it
    """The caller cancelled the work; the engine that did it was stopped and nothing was changed."""


class WireError(Exception):
    """Bytes on the pipe that are no message; within the package only."""
