"""What the ladder package raises."""

from contactbench.pipeline.errors import InputError


class LadderError(InputError):
    """A ladder that cannot be measured as asked: says what is wrong, where, and the remedy."""
