"""An alignment: where the mesh's frame P lies in the sensor frame S, how that was found, and how surely."""

from __future__ import annotations

import json
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from pydantic_core import from_json as parse_json
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.preparation.alignment.errors import AlignmentError
from contactbench.pipeline.preparation.alignment.rigid import (
    apply,
    check_numbers,
    check_transform,
    make_transform,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

SCHEMA, VERSION = "contactbench.alignment", 1
_REMEDY = message("use the file that contactbench wrote, or align again.")
_LARGEST_FILE = 2**20


class AlignmentMethod(StrEnum):
    """How an alignment was found."""

    TYPED = "typed"
    POINTS = "points"
    FRAME = "frame"
    FLANGE = "flange"
    AXES = "axes"
    TOUCHES = "touches"


@dataclass(frozen=True, eq=False)
class Alignment:
    """
    Where the mesh lies in the sensor frame: ``p_S = T_SP @ p_P``.

    Attributes
    ----------
    T_SP : (4, 4) float64
        Rigid, translation in metres; read-only.
    method : AlignmentMethod
    how : tuple of str
        How it was made, in sentences.
    warnings : tuple of str
        What to be careful about, in sentences.
    covariance : (6, 6) float64 or None
        Of the error that is left: shift of the point `about_S` (m), then rotation vector (rad), both in S:
        the true place of a point p is ``c + exp([w]x)(p - c) + d`` for ``c = about_S``. None if unknown.
    about_S : (3,) float64 or None
        The point that the covariance is about, m in S; there with a covariance.
    residual_m : float or None
        Root mean square of what the method's own input leaves unexplained, m.

    Raises
    ------
    AlignmentError
        The transform is not rigid, the covariance is none, or one of it and its point is missing.
    """

    T_SP: Floats
    method: AlignmentMethod
    how: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    covariance: Floats | None = None
    about_S: Floats | None = None
    residual_m: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "T_SP", check_transform(self.T_SP))
        object.__setattr__(self, "method", AlignmentMethod(self.method))
        if (self.covariance is None) != (self.about_S is None):
            raise AlignmentError("covariance, about_S: give both or neither.")
        if self.covariance is not None and self.about_S is not None:
            object.__setattr__(self, "covariance", _check_covariance(self.covariance))
            object.__setattr__(self, "about_S", _frozen(check_numbers(self.about_S, (3,), "about_S")))
        if self.residual_m is not None and not 0 <= self.residual_m < np.inf:
            raise AlignmentError(f"residual_m: {arg(self.residual_m)} is not a length of at least 0 m.")

    @property
    def R_SP(self) -> Floats:
        """(3, 3) rotation from P to S."""
        return self.T_SP[:3, :3]

    @property
    def p_SP_S(self) -> Floats:
        """(3,) origin of P in S, m."""
        return self.T_SP[:3, 3]

    @property
    def sigmas_mm(self) -> Floats | None:
        """(3,) standard deviations of the shift of `about_S` along x, y, z of S, mm."""
        return None if self.covariance is None else 1e3 * np.sqrt(np.diag(self.covariance)[:3])

    @property
    def sigmas_deg(self) -> Floats | None:
        """(3,) standard deviations of the rotation about x, y, z of S, degrees."""
        return None if self.covariance is None else np.degrees(np.sqrt(np.diag(self.covariance)[3:]))

    def place(self, probe_P: Probe) -> Probe:
        """
        Return the probe in S.

        Parameters
        ----------
        probe_P : Probe
            With vertices in P, metres. Regions, marks and name are kept.

        Raises
        ------
        MeshError
            A facet loses its area to rounding, because the mesh lies far from its origin.
        """
        moved = apply(self.T_SP, probe_P.vertices)
        return Probe.from_arrays(
            moved,
            probe_P.faces,
            probe_P.region,
            invented=probe_P.invented,
            name=probe_P.name,
            check_size=False,
            untouchable=probe_P.untouchable,
        )

    def to_json(self) -> str:
        """Return the alignment as JSON text, for `from_json`; every number round-trips exactly."""
        content = {
            "schema": SCHEMA,
            "version": VERSION,
            "method": self.method.value,
            "T_SP_m": self.T_SP.tolist(),
            "how": list(self.how),
            "warnings": list(self.warnings),
            "about_S_m": None if self.about_S is None else self.about_S.tolist(),
            "covariance": None if self.covariance is None else self.covariance.tolist(),
            "residual_m": None if self.residual_m is None else float(self.residual_m),
        }
        return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def from_json(data: str | bytes, name: str = "alignment") -> Alignment:
    """
    Read what `Alignment.to_json` wrote.

    Parameters
    ----------
    data : str or bytes
    name : str
        What messages call it, such as the file's name.

    Raises
    ------
    AlignmentError
        No JSON, of another kind or version, over 1 MiB, or a field is missing, unknown, of the wrong type, or
        no rigid transform or covariance.
    """
    if len(data) > _LARGEST_FILE:
        raise AlignmentError(
            f"{arg(name)}: this is over 1 MiB, too much for an alignment: choose the right file."
        )
    try:
        content = parse_json(data)
    except (ValueError, UnicodeEncodeError) as error:
        raise AlignmentError(
            f"{arg(name)}: not valid JSON ({arg(error)}): choose an alignment file."
        ) from None
    _check_kind(content, name)
    try:
        document = _Document.model_validate_json(data)
    except ValidationError as error:
        fault = error.errors(include_url=False, include_context=False, include_input=False)[0]
        where = ".".join(str(part)[:60] for part in fault["loc"]).encode("ascii", "backslashreplace").decode()
        raise AlignmentError(f"{arg(name)}: {arg(where)}: {arg(fault['msg'])}: {arg(_REMEDY)}") from None
    try:
        return Alignment(
            np.array(document.T_SP_m),
            document.method,
            tuple(document.how),
            tuple(document.warnings),
            None if document.covariance is None else np.array(document.covariance),
            None if document.about_S_m is None else np.array(document.about_S_m),
            document.residual_m,
        )
    except AlignmentError as error:
        raise AlignmentError(f"{arg(name)}: {arg(error)}") from error


_Number = Annotated[float, Field(ge=-1e12, le=1e12)]
_Three = Annotated[list[_Number], Field(min_length=3, max_length=3)]
_Four = Annotated[list[_Number], Field(min_length=4, max_length=4)]
_Six = Annotated[list[_Number], Field(min_length=6, max_length=6)]
_Sentence = Annotated[str, Field(max_length=2000)]
_Sentences = Annotated[list[_Sentence], Field(max_length=200)]


class _Document(BaseModel):
    """A whole file: every field named, of its own type, finite."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    schema_: Literal["contactbench.alignment"] = Field(alias="schema")
    version: Literal[1]
    method: AlignmentMethod
    T_SP_m: Annotated[list[_Four], Field(min_length=4, max_length=4)]
    how: _Sentences
    warnings: _Sentences
    about_S_m: _Three | None
    covariance: Annotated[list[_Six], Field(min_length=6, max_length=6)] | None
    residual_m: Annotated[float, Field(ge=0, le=1e12)] | None


def _check_kind(content: Any, name: str) -> None:
    schema = content.get("schema") if isinstance(content, dict) else None
    if schema != SCHEMA:
        found = (
            message(f"the schema is {arg(ascii(schema[:60]))}")
            if isinstance(schema, str)
            else message("the schema is missing")
        )
        raise AlignmentError(
            f"{arg(name)}: {arg(found)}; expected {arg(SCHEMA)!r}: choose an alignment file."
        )
    version = content.get("version")
    if isinstance(version, int) and not isinstance(version, bool) and version > VERSION:
        raise AlignmentError(
            f"{arg(name)}: written by a newer contactbench (version above {arg(VERSION)}): update contactbench."
        )


def _check_covariance(values: ArrayLike) -> Floats:
    C = check_numbers(values, (6, 6), "covariance")
    # Metres and radians have the same order here, so one scale serves.
    size = float(np.abs(C).max())
    if np.abs(C - C.T).max() > 1e-9 * size or np.linalg.eigvalsh(C)[0] < -1e-9 * size:
        raise AlignmentError("covariance: it is not symmetric with no negative eigenvalue: align again.")
    return _frozen(0.5 * (C + C.T))


def _frozen(array: Floats) -> Floats:
    array.flags.writeable = False
    return array


# ---- an alignment from typed numbers: a translation in millimetres and a rotation by angles or a matrix ----


_LARGEST_ANGLE = 360.0
# An eighth of a turn in radians: angles that are whole multiples of it are suspicious as degrees.
_EIGHTH, _TYPED = np.pi / 4, 2e-3


def from_angles(xyz_mm: ArrayLike, rxyz_deg: ArrayLike) -> Alignment:
    """
    Align by rotations about the fixed axes x, then y, then z of S: ``R_SP = Rz Ry Rx``.

    Parameters
    ----------
    xyz_mm : (3,) array_like
        Origin of P in S, mm.
    rxyz_deg : (3,) array_like
        Angles about x, y and z, degrees, each within ±360.

    Raises
    ------
    AlignmentError
        A number is not finite, an angle is beyond a full turn, or the translation is 10 m or longer.
    """
    angles = check_numbers(rxyz_deg, (3,), "rotation")
    if np.abs(angles).max() > _LARGEST_ANGLE:
        raise AlignmentError(
            f"rotation: {arg(angles.tolist())} goes beyond ±360: give degrees about the fixed axes x, y, z."
        )
    R_SP = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()  # lower case: fixed axes
    x, y, z = angles
    warnings: tuple[str, ...] = ()
    turned = np.abs(angles[angles != 0])
    eighths = _EIGHTH * np.clip(np.round(turned / _EIGHTH), 1, 8)
    if len(turned) and (np.abs(turned - eighths) < _TYPED).all():
        sentence = message("The angles look like radians. If they are, convert them to degrees.")
        warnings = (sentence,)
    how = message(f"turned by {arg(x):g}°, {arg(y):g}° and {arg(z):g}° about the fixed axes x, y and z")
    return _typed(R_SP, xyz_mm, how, warnings)


def from_transform(T_SP: ArrayLike) -> Alignment:
    """
    Align by a whole transform (4, 4), its translation in metres.

    Raises
    ------
    AlignmentError
        Not rigid within 1e-6, mirroring, transposed, not finite, or 10 m away or further.
    """
    T = check_transform(T_SP)
    return _typed(T[:3, :3], 1e3 * T[:3, 3], message("turned by the matrix given"))


def _typed(R_SP: Floats, xyz_mm: ArrayLike, how: str, warnings: tuple[str, ...] = ()) -> Alignment:
    p = check_numbers(xyz_mm, (3,), "translation")
    x, y, z = p
    sentence = message(
        f"Typed: the mesh's origin at ({arg(x):g}, {arg(y):g}, {arg(z):g}) mm in the sensor frame, the mesh {arg(how)}."
    )
    return Alignment(make_transform(R_SP, p / 1e3), AlignmentMethod.TYPED, (sentence,), warnings)
