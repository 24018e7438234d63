"""What goes wrong with recordings."""

from contactbench.pipeline.errors import InputError


class RecordingError(InputError):
    """A recording that cannot be written or read: names the file, what is wrong, and the remedy."""


class SampleError(RecordingError):
    """One sample or event that cannot be recorded; the recording goes on without it."""
