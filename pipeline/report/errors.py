"""What is wrong with a report's input."""

from contactbench.pipeline.errors import InputError


class ReportError(InputError):
    """No report can be made; the message says why and what to do."""
