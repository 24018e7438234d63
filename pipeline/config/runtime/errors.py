"""What the runtime config raises."""

from contactbench.pipeline.errors import InputError, join, message


class ConfigError(InputError):
    """A runtime config that cannot be made, written or trusted: names the file, the field, and the remedy."""


class RateUnknownError(ConfigError):
    """Nobody has said how many readings a second the sensor is set to."""


class UnverifiedError(ConfigError):
    """
    An export that is refused because nobody has shown that its contacts are right.

    Attributes
    ----------
    reasons : tuple of str
        Each in a sentence.
    """

    def __init__(self, reasons: tuple[str, ...]) -> None:
        super().__init__(
            message("the config is not verified and was not written: ")
            + join(" ", reasons)
            + message(" Correct that, or export it as unverified, for trials without a person.")
        )
        self.reasons = reasons
