"""What the ways to compute results share: their parameters, their inputs, and where they write."""

from __future__ import annotations

import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from contactbench.pipeline.session.errors import SessionError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.session.state import State

_P = TypeVar("_P", bound=BaseModel)

PREFIX = "contactbench-"  # of temporary folders

# Kilometres and whole turns are mistakes, and squares of much more overflow.
Number = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]
Three = tuple[Number, Number, Number]


class Parameters(BaseModel):
    """Parameters of a computation; ``name`` is that of the result."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str


def read_parameters(kind: type[_P], parameters: Mapping[str, Any]) -> _P:
    """Return parameters of that kind; SessionError, with the first that is wrong."""
    try:
        return kind.model_validate(dict(parameters))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise SessionError(f"parameter {where}: {first['msg']}: correct it.") from error


def check_roles(inputs: Mapping[str, Path], needed: str, *optional: str) -> Path:
    """Return the input that is needed; SessionError if it is missing, or there are strangers."""
    if needed not in inputs or not set(inputs) <= {needed, *optional}:
        may = "".join(f", and perhaps {role}" for role in optional)
        raise SessionError(f"inputs: {needed} is needed{may}; there are {', '.join(inputs) or 'none'}.")
    return inputs[needed]


def mount_rotation(degrees: Three | None) -> NDArray[np.float64] | None:
    """Return R_ES (3, 3) of angles about the fixed axes x, y, z; None stays None."""
    from scipy.spatial.transform import Rotation

    if degrees is None:
        return None
    R: NDArray[np.float64] = Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()
    return R


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


def metres(millimetres: float | None) -> float | None:
    """Return a length in metres; None stays None."""
    return None if millimetres is None else millimetres / 1000


@contextmanager
def folder_for(name: str, suffix: str) -> Iterator[Path]:
    """Give a place for a file of this name that is gone afterwards."""
    if Path(name).name != name or not name.endswith(suffix):
        raise SessionError(f"{name}: a result of this kind is a file whose name ends in {suffix}.")
    with tempfile.TemporaryDirectory(prefix=PREFIX) as scratch:
        yield Path(scratch) / name
