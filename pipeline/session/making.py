"""What the ways to compute results share: their parameters, their inputs, and where they write."""

from __future__ import annotations

import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session.errors import SessionError
from contactbench.pipeline.settings import Settings, Three

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from contactbench.pipeline.session.state import State

_P = TypeVar("_P", bound=Settings)

PREFIX = "contactbench-"  # of temporary folders


class Parameters(Settings):
    """Parameters of a computation; ``name`` is that of the result."""

    name: str


def read_parameters(kind: type[_P], parameters: Mapping[str, Any]) -> _P:
    """Return parameters of that kind; SessionError, with the first that is wrong."""
    try:
        return kind.checked(parameters)
    except InputError as error:
        raise SessionError(str(error)) from error


def check_roles(inputs: Mapping[str, Path], needed: str, *optional: str) -> Path:
    """Return the input that is needed; SessionError if it is missing, or there are strangers."""
    if needed not in inputs or not set(inputs) <= {needed, *optional}:
        may = "".join(f", and perhaps {role}" for role in optional)
        raise SessionError(f"inputs: {needed} is needed{may}; there are {', '.join(inputs) or 'none'}.")
    return inputs[needed]


def mount_of(state: State) -> Three | None:
    """
    Return how a session says that its sensor is mounted, degrees about the fixed axes x, y, z; None: it does not.

    Raises
    ------
    SessionError
        What it says is not three angles.
    """
    given = state.setting("devices.mount")
    if given is None:
        return None
    try:
        angles: Three = TypeAdapter(Three).validate_python(given)
    except ValidationError:
        raise SessionError(
            "devices.mount: give three angles, degrees about the fixed axes x, y, z: set it anew."
        ) from None
    return angles


@contextmanager
def folder_for(name: str, suffix: str) -> Iterator[Path]:
    """Give a place for a file of this name that is gone afterwards."""
    if Path(name).name != name or not name.endswith(suffix):
        raise SessionError(f"{name}: a result of this kind is a file whose name ends in {suffix}.")
    with tempfile.TemporaryDirectory(prefix=PREFIX) as scratch:
        yield Path(scratch) / name
