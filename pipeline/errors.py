"""The one base class of every error that wrong input causes."""


class InputError(ValueError):
    """Input that cannot be used: the message names where it is wrong and the remedy.

    Commands turn it into exit code 2. Modules derive their own error from it
    when a caller may want to tell them apart.
    """
