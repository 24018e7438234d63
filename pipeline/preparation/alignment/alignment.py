"""An alignment: where the mesh's frame P lies in the sensor frame S, how that was found, and how surely."""

import json
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from pydantic_core import from_json as parse_json

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.files import File, not_of_kind, read_bytes
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats

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


def load_alignment(file: File) -> Alignment:
    """Read an alignment that was saved; AlignmentError as `from_json`, or where it cannot be read."""
    return from_json(read_bytes(file, _LARGEST_FILE, AlignmentError), file.name)


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
    if why := not_of_kind(content, SCHEMA, VERSION, message("an alignment file")):
        raise AlignmentError(f"{arg(name)}: {arg(why)}")
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


# ---- an alignment from typed numbers -------------------------------------------------------------


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
    # Lower case: fixed axes.
    R_SP = scipy.spatial.transform.Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
    x, y, z = angles
    warnings: tuple[str, ...] = ()
    turned = np.abs(angles[angles != 0])
    eighths = _EIGHTH * np.clip(np.round(turned / _EIGHTH), 1, 8)
    if len(turned) and (np.abs(turned - eighths) < _TYPED).all():
        warnings = (message("The angles look like radians. If they are, convert them to degrees."),)
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


# ---- rigid transforms: checked at the door, moved by small steps, and applied --------------------


_TOLERANCE, _ROUNDING = 1e-6, 1e-14
# Numbers beyond this overflow when squared, and are no rotation.
_ABSURD = 1e3
FARTHEST_M = 10.0


def check_transform(values: ArrayLike, name: str = "T_SP") -> Floats:
    """
    Copy a rigid transform to (4, 4) float64, or say why it is none.

    Parameters
    ----------
    values : (4, 4) array_like
        Rotation and translation in metres; the last row is 0 0 0 1.
    name : str
        What messages call it.

    Returns
    -------
    (4, 4) float64
        Read-only, its rotation made orthogonal to rounding.

    Raises
    ------
    AlignmentError
        Wrong shape, not finite, transposed, scaling, shearing, mirroring, or 10 m away or further.
    """
    T = check_numbers(values, (4, 4), name)
    if np.abs(T[3] - (0, 0, 0, 1)).max() > _TOLERANCE:
        transposed = message(" It looks transposed.") if np.abs(T[:3, 3]).max() == 0 else ""
        raise AlignmentError(
            f"{arg(name)}: the last row is {arg(T[3].tolist())}, not [0, 0, 0, 1].{arg(transposed)} Write"
            " the translation in the last column."
        )
    return make_transform(check_rotation(T[:3, :3], name), T[:3, 3], name)


def check_rotation(values: ArrayLike, name: str = "R_SP") -> Floats:
    """
    Copy a rotation matrix to (3, 3) float64, or say why it is none.

    Raises
    ------
    AlignmentError
        Wrong shape, not finite, scaling, shearing or mirroring.
    """
    R = check_numbers(values, (3, 3), name)
    off = np.inf if np.abs(R).max() > _ABSURD else float(np.abs(R.T @ R - np.eye(3)).max())
    if off > _TOLERANCE:
        raise AlignmentError(
            f"{arg(name)}: the 3 x 3 part is not a rotation within 1e-6: it scales or shears. Convert lengths when the"
            " mesh is read, and write rotations with at least seven digits."
        )
    if np.linalg.det(R) < 0:
        raise AlignmentError(
            f"{arg(name)}: the 3 x 3 part mirrors (determinant -1): one axis has the wrong sign, or the frame is"
            " left-handed."
        )
    # What is a rotation to rounding keeps its bits: a file that is read and written stays the same.
    return R if off <= _ROUNDING else nearest_rotation(R)


def make_transform(R_SP: ArrayLike, p_SP_S: ArrayLike, name: str = "T_SP") -> Floats:
    """
    Join a rotation and a translation in metres to (4, 4), read-only.

    Raises
    ------
    AlignmentError
        The translation is not finite, or 10 m long or longer.
    """
    p = check_numbers(p_SP_S, (3,), f"{name}, translation")
    if np.abs(p).max() >= FARTHEST_M or np.linalg.norm(p) >= FARTHEST_M:
        millimetres = ", ".join(f"{1e3 * value:.6g}" for value in p)
        raise AlignmentError(
            f"{arg(name)}: the translation ({arg(millimetres)}) mm is {arg(FARTHEST_M):g} m or longer, too long"
            " for a mount. Check its unit."
        )
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R_SP, p
    T.flags.writeable = False
    return T


def check_numbers(values: ArrayLike, shape: tuple[int, ...], name: str) -> Floats:
    """
    Copy numbers to a float64 array of a shape; -1 stands for any length of at least one.

    Raises
    ------
    AlignmentError
        Not numbers, another shape, or not finite.
    """
    try:
        array = np.array(values, dtype=np.float64)
    except (ValueError, TypeError) as error:
        raise AlignmentError(
            f"{arg(name)}: these are not numbers ({arg(error)}): give shape {arg(shape)}."
        ) from error
    pairs = zip(array.shape, shape, strict=False)
    if array.ndim != len(shape) or any(
        found != wanted and (wanted != -1 or not found) for found, wanted in pairs
    ):
        wanted_shape = str(shape).replace("-1", "n")
        raise AlignmentError(
            f"{arg(name)}: the shape is {arg(array.shape)}: give {arg(wanted_shape)} numbers."
        )
    if not np.isfinite(array).all():
        row = np.argwhere(~np.isfinite(array))[0].tolist()
        raise AlignmentError(f"{arg(name)}: the value at {arg(row)} is not finite: correct or remove it.")
    return array


def nearest_rotation(matrix: Floats) -> Floats:
    """Return the rotation (3, 3) nearest to a matrix of positive determinant."""
    u, _, vt = np.linalg.svd(matrix)
    R: Floats = u @ vt
    return R


def apply(T: Floats, points: Floats) -> Floats:
    """Return points (n, 3) moved by T (4, 4)."""
    moved: Floats = points @ T[:3, :3].T + T[:3, 3]
    return moved


def step(T: Floats, about: Floats, delta: Floats) -> Floats:
    """
    Move a transform by a small rigid motion: ``p' = c + exp([w]x)(p - c) + d``.

    Parameters
    ----------
    T : (4, 4)
    about : (3,)
        The point c that the motion turns about, in T's target frame, m.
    delta : (..., 6)
        Shift d, m, then rotation vector w, rad, in the target frame; one step or several.

    Returns
    -------
    (..., 4, 4)
    """
    R = _turn(delta[..., 3:])
    moved = np.zeros((*delta.shape[:-1], 4, 4))
    moved[..., :3, :3] = R @ T[:3, :3]
    moved[..., :3, 3] = about + R @ (T[:3, 3] - about) + delta[..., :3]
    moved[..., 3, 3] = 1.0
    return moved


def difference(T: Floats, T_from: Floats, about: Floats) -> Floats:
    """Return the (6,) motion with ``step(T_from, about, motion) == T``."""
    R = T[:3, :3] @ T_from[:3, :3].T
    shift = T[:3, 3] - about - R @ (T_from[:3, 3] - about)
    return np.concatenate([shift, scipy.spatial.transform.Rotation.from_matrix(R).as_rotvec()])


def across(normals: Floats) -> Floats:
    """Return two unit tangents (n, 2, 3) for each unit normal (n, 3); right-handed with it."""
    helper = np.eye(3)[np.argmin(np.abs(normals), axis=1)]
    first = np.cross(helper, normals)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, np.cross(normals, first)], axis=1)


def turn_between(a: Floats, b: Floats) -> Floats:
    """Return the smallest rotation (3, 3) that takes unit vector a to unit vector b."""
    axis, cosine = np.cross(a, b), float(a @ b)
    sine = float(np.linalg.norm(axis))
    if sine < 1e-12:
        if cosine > 0:
            return np.eye(3)
        return _turn(np.pi * across(a[None])[0, 0])
    return _turn(axis * (np.arctan2(sine, cosine) / sine))


def _turn(vectors: Floats) -> Floats:
    """Return the rotations (..., 3, 3) by rotation vectors (..., 3), rad."""
    return np.asarray(scipy.spatial.transform.Rotation.from_rotvec(vectors).as_matrix())


# ---- what the alignment package raises -----------------------------------------------------------


class AlignmentError(InputError):
    """Input from which no mount can be found: says what is wrong, where, and the remedy."""
