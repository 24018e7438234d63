"""Parameters of what a session computes and a command runs, as plain values: lengths in mm, angles in degrees."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.orientation import Convention

# Kilometres and whole turns are mistakes, and squares of much more overflow.
Number = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, le=1e6, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, le=1e6, allow_inf_nan=False)]
Three = tuple[Number, Number, Number]


class Parameters(BaseModel):
    """Parameters of a computation."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    endings: ClassVar[tuple[str, ...]] = (".json",)  # Of the file that the result is

    name: str  # Of the result: of the file that it is, too

    @classmethod
    def checked(cls, values: Mapping[str, Any]) -> Self:
        """Return parameters; InputError, with the first that is wrong."""
        try:
            given = cls.model_validate(dict(values))
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            where = ".".join(map(str, first["loc"]))
            raise InputError(f"parameter {where}: {first['msg']}: correct it.") from error
        if not given.name.endswith(cls.endings) or "/" in given.name or "\\" in given.name:
            raise InputError(
                f"{given.name}: a result of this kind is a file whose name ends in {' or '.join(cls.endings)}."
            )
        return given


class PoseParameters(Parameters):
    """How orientations in a table are written, and the sensor's in the flange: as the options of the commands."""

    euler: str | None = None
    rotation_vector: bool = False
    robot: str | None = None
    radians: bool = False
    inverse: bool = False
    mount: Three | None = None  # Angles of the sensor on the flange about the fixed axes x, y, z, degrees

    def convention(self) -> Convention | None:
        """Return how orientations are written; None: as the columns say. InputError: the parameters contradict."""
        from contactbench.pipeline.calibration.orientation import convention_of

        return convention_of(
            self.euler, self.rotation_vector, self.robot, radians=self.radians, inverse=self.inverse
        )

    @property
    def R_ES(self) -> NDArray[np.float64] | None:
        """(3, 3) orientation of the sensor on the flange; None: nobody said."""
        return mount_rotation(self.mount)


def mount_rotation(degrees: Three | None) -> NDArray[np.float64] | None:
    """Return R_ES (3, 3) of angles about the fixed axes x, y, z; None stays None."""
    from scipy.spatial.transform import Rotation

    if degrees is None:
        return None
    R: NDArray[np.float64] = Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()
    return R


def check_roles(inputs: Mapping[str, Path], needed: Collection[str], optional: Collection[str] = ()) -> None:
    """InputError if an input that is needed is missing, or there are strangers."""
    if not set(needed) <= set(inputs) <= {*needed, *optional}:
        may = f", and perhaps {', '.join(optional)}" if optional else ""
        raise InputError(
            f"inputs: {', '.join(needed)} are needed{may}; there are {', '.join(inputs) or 'none'}."
        )


def sha256_of(file: Path) -> str:
    """Return the SHA-256 of a file, 64 hexadecimal digits; InputError if it cannot be read."""
    import hashlib

    try:
        with file.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except (OSError, ValueError) as error:
        raise InputError(f"{file}: the file cannot be read ({error}): check the path.") from error
