"""What the ways to compute results share: the name of the result, their inputs, and how files are told apart."""

from collections.abc import Collection, Mapping
from typing import Any, ClassVar, Self

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.files import File
from contactbench.pipeline.knobs import Settings


class Parameters(Settings):
    """Parameters of a computation: settings, and the name of the result."""

    endings: ClassVar[tuple[str, ...]] = (".json",)  # Of the file that the result is

    name: str  # Of the result: of the file that it is, too

    @classmethod
    def checked(cls, values: Mapping[str, Any]) -> Self:
        """Return parameters; InputError, with the first that is wrong."""
        given = super().checked(values)
        if not given.name.endswith(cls.endings) or "/" in given.name or "\\" in given.name:
            raise InputError(
                f"{arg(given.name)}: the name of a result of this kind must end in {arg(' or '.join(cls.endings))}."
            )
        return given


def check_roles(inputs: Mapping[str, File], needed: Collection[str], optional: Collection[str] = ()) -> None:
    """InputError if an input that is needed is missing, or there are strangers."""
    if not set(needed) <= set(inputs) <= {*needed, *optional}:
        may = message(f", optionally also {arg(', '.join(optional))}") if optional else ""
        raise InputError(
            f"inputs: {arg(', '.join(needed))} are needed{arg(may)}; {arg(', '.join(inputs) or 'none')} are given."
        )


def sha256_of(file: File) -> str:
    """Return the SHA-256 of a file, 64 hexadecimal digits; InputError if it cannot be read."""
    import hashlib

    try:
        with file.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except (OSError, ValueError) as error:
        raise InputError(f"{arg(file)}: the file cannot be read ({arg(error)}): check the path.") from error
