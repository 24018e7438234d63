"""What the alignment package raises."""

from contactbench.pipeline.errors import InputError


class AlignmentError(InputError):
    """Input from which no mount can be found: says what is wrong, where, and the remedy."""
