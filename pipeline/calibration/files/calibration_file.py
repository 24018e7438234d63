"""Calibrations as JSON files: everything the report and the next pose need, and nothing that runs.

What is loaded is checked twice: its shape by a strict schema, then its sense. A bit that flipped in a
parameter, or a number that was edited, no longer fits the poses and residuals beside it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, fields
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, GetCoreSchemaHandler, PlainSerializer, ValidationError
from pydantic_core import core_schema, from_json
from scipy.spatial.transform import Rotation

from contactbench import __version__
from contactbench.pipeline.calibration.calibrate import Calibration, direction
from contactbench.pipeline.calibration.comparison import Cause
from contactbench.pipeline.calibration.model import PARAMETERS, STANDARD_GRAVITY, GravityModel, PoseNoise
from contactbench.pipeline.calibration.observability import Observability
from contactbench.pipeline.calibration.parameters import sha256_of
from contactbench.pipeline.calibration.poses import PoseSample
from contactbench.pipeline.calibration.suggest import ContactTask
from contactbench.pipeline.calibration.verdict import Rejection, Verdict
from contactbench.pipeline.durable import write_file
from contactbench.pipeline.errors import InputError, arg, capitalised, message
from contactbench.pipeline.files import File, not_of_kind, read_bytes

_V = TypeVar("_V")

SCHEMA, VERSION = "contactbench.calibration", 2
SIZE_LIMIT = 32 * 2**20  # bytes; ten thousand poses take half of it
REMEDY = message("use the file as contactbench wrote it, or calibrate again.")
_ROUNDING = 1e-9  # of what is computed anew, on another machine too


class CalibrationFileError(InputError):
    """A calibration file that cannot be used: names the file, the field, and the remedy."""


@dataclass(frozen=True)
class SourceFile:
    """The file that the poses came from."""

    name: str  # Its name, without folders
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$")]  # Of its content

    @classmethod
    def of(cls, file: File) -> SourceFile:
        """Read a file for its hash; CalibrationFileError if that fails."""
        try:
            return cls(file.name, sha256_of(file))
        except InputError as error:
            raise CalibrationFileError(str(error)) from error


@dataclass(frozen=True, eq=False)
class Mount:
    """How the flange E sits on the sensor S."""

    quaternion_SE: NDArray[np.float64]  # (4,) orientation of E in S, scalar first, of length 1
    # (3, 3) of the rotation vector d in ``R_true = exp([d]x) @ R_SE``, in S, rad²; zero for a mounting that
    # was given
    covariance: NDArray[np.float64]

    @classmethod
    def of(cls, R_SE: NDArray[np.float64], covariance: NDArray[np.float64] | None = None) -> Mount:
        """Return the mounting of a rotation (3, 3), known exactly if there is no covariance."""
        quaternion = Rotation.from_matrix(R_SE).as_quat(canonical=True, scalar_first=True)
        return cls(quaternion, np.zeros((3, 3)) if covariance is None else covariance)

    @property
    def R_SE(self) -> NDArray[np.float64]:
        """(3, 3): ``v_S = R_SE @ v_E``."""
        return Rotation.from_quat(self.quaternion_SE, scalar_first=True).as_matrix()


@dataclass(frozen=True, eq=False)
class CalibrationRecord:
    """All that a calibration file holds."""

    calibration: Calibration
    created: datetime | None  # When, UTC; None if nobody said
    tool: str  # What wrote the file
    source: SourceFile | None  # What the poses came from
    mount: Mount | None


def save_calibration(
    calibration: Calibration,
    file: Path,
    *,
    source: File | SourceFile | None = None,
    created: datetime | None = None,
    mount: Mount | None = None,
) -> None:
    """
    Write a calibration as JSON; the same arguments give the same bytes.

    Parameters
    ----------
    calibration : Calibration
    file : path
        Appears as a whole; what was there stays until then.
    source : path or SourceFile, optional
        The file of the poses, noted with its hash.
    created : datetime, optional
        With a time zone; `creation_time` gives one. Kept to the second.
    mount : Mount, optional

    Raises
    ------
    CalibrationFileError
        The calibration holds something that no file of this kind can, or the file cannot be written.
    """
    data = encode_calibration(calibration, str(file), source=source, created=created, mount=mount)
    write_file(file, data, CalibrationFileError, message("the calibration cannot be written"))


def encode_calibration(
    calibration: Calibration,
    name: str,
    *,
    source: File | SourceFile | None = None,
    created: datetime | None = None,
    mount: Mount | None = None,
) -> bytes:
    """Return what `save_calibration` writes; `name` is what messages call it."""
    if created is not None and created.tzinfo is None:
        raise CalibrationFileError(f"{arg(name)}: created has no time zone: use datetime.now(UTC).")
    source = SourceFile.of(source) if isinstance(source, File) else source
    content = _document(calibration, source, created, mount)
    try:
        data = (json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()
    except ValueError as error:  # not finite, or text that is no Unicode
        raise CalibrationFileError(
            f"{arg(name)}: this calibration cannot be written ({arg(error)}): {arg(REMEDY)}"
        ) from error
    decode_record(data, name)  # what cannot be read is better refused now
    return data


def load_calibration(file: File) -> Calibration:
    """
    Read a calibration that `save_calibration` wrote.

    Raises
    ------
    CalibrationFileError
        As `load_record`.
    """
    return load_record(file).calibration


def load_record(file: File) -> CalibrationRecord:
    """
    Read a calibration with where and when it comes from.

    Raises
    ------
    CalibrationFileError
        The file is missing, too large, not JSON, of another kind or a newer version, or a field is missing,
        of the wrong type, not finite, or contradicts the others; the message names it.
    """
    return decode_record(read_bytes(file, SIZE_LIMIT, CalibrationFileError), str(file))


def creation_time() -> datetime:
    """
    Return the present time, UTC, or what SOURCE_DATE_EPOCH says, so that a build can be repeated to the bit.

    Raises
    ------
    InputError
        SOURCE_DATE_EPOCH is set, but not to seconds since 1970.
    """
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    try:
        return datetime.now(UTC) if epoch is None else datetime.fromtimestamp(int(epoch), UTC)
    except (ValueError, OverflowError, OSError):
        raise InputError(
            f"SOURCE_DATE_EPOCH is {arg(epoch)!r}: set it to whole seconds since 1970, or unset it."
        ) from None


# ---- the fields, in the order of the file -------------------------------------------------------


class _Listed:
    """A value that JSON has as a list: checked as the list, then made; written as the list again."""

    def __init__(self, listed: Any, make: Callable[[list[Any]], Any] = np.array) -> None:
        self._listed, self._make = listed, make

    def __get_pydantic_core_schema__(
        self, _source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_after_validator_function(
            self._make,
            handler.generate_schema(self._listed),
            serialization=core_schema.plain_serializer_function_ser_schema(lambda a: np.asarray(a).tolist()),
        )


def _list_of(each: Any, least: int, most: int | None = None) -> Any:
    return Annotated[list[each], Field(min_length=least, max_length=most or least)]


_Float = PlainSerializer(float)
# The square of the largest number is still one.
_Number = Annotated[float, Field(ge=-1e100, le=1e100), _Float]
_Positive = Annotated[float, Field(ge=0, le=1e100), _Float]
_Freedom = Annotated[float, Field(gt=0, le=1e100)]
_Count = Annotated[int, Field(ge=1, le=2**63 - 1), PlainSerializer(int)]
_Rank = Annotated[int, Field(ge=0, le=6)]
_Flag = Annotated[bool, PlainSerializer(bool)]
_Three = Annotated[NDArray[np.float64], _Listed(_list_of(_Number, 3))]
_ThreePositive = Annotated[NDArray[np.float64], _Listed(_list_of(_Positive, 3))]
_OneOrThree = Annotated[NDArray[np.float64], _Listed(_list_of(_Number, 1, 3))]  # one serves for all axes
_Four = Annotated[NDArray[np.float64], _Listed(_list_of(_Number, 4))]
_Matrix3 = Annotated[NDArray[np.float64], _Listed(_list_of(_list_of(_Number, 3), 3))]
_Matrix12 = Annotated[NDArray[np.float64], _Listed(_list_of(_list_of(_Number, 12), 12))]
_Two = Annotated[tuple[float, float], _Listed(_list_of(_Positive, 2), tuple)]
_Words = Annotated[tuple[str, ...], _Listed(list[str], tuple)]
_Time = Annotated[str, Field(pattern="^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z$")]


class _Part(BaseModel):
    """A JSON object: every field there, of its own type, finite. A field is called as in the value it is of."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

    @classmethod
    def of(cls, value: object, **more: Any) -> Self:
        """Return the part that writes a value; `more` has what the value itself does not."""
        given = {
            name: more[name] if name in more else getattr(value, name)
            for name in cls.model_fields
            if name in more or hasattr(value, name)
        }
        return cls.model_construct(**{cls.model_fields[name].alias or name: given[name] for name in given})

    def value(self, kind: type[_V], **more: Any) -> _V:
        """Return the value that was read; InputError if it refuses that."""
        known = {each.name for each in fields(kind)} & type(self).model_fields.keys()  # type: ignore[arg-type]
        return kind(**{**{name: getattr(self, name) for name in known}, **more})


class _TaskPart(_Part):
    point: _Three = Field(alias="point_S_m")
    normal: _Three = Field(alias="normal_S")
    force: _Number = Field(alias="force_N")
    tilt: _Number = Field(alias="tilt_rad")
    friction: _Number = Field(alias="friction_rad")


class _NoisePart(_Part):
    force: _OneOrThree = Field(alias="force_N")
    torque: _OneOrThree = Field(alias="torque_Nm")
    estimated: _Flag
    force_freedom: _Freedom | None  # None: infinite
    torque_freedom: _Freedom | None
    least_force: _ThreePositive = Field(alias="least_force_N")
    least_torque: _ThreePositive = Field(alias="least_torque_Nm")
    orientation: _Positive = Field(alias="orientation_rad")


class _ObservabilityPart(_Part):
    rank: Annotated[int, Field(ge=0, le=12)]
    force_rank: _Rank
    torque_rank: _Rank
    condition: _Positive | None  # None: infinite
    force_condition: _Positive | None
    torque_condition: _Positive | None
    null_directions: _Words
    weighs: _Flag
    weak: str


class _PosePart(_Part):
    """A pose, with what the fit leaves of it."""

    name: str
    time: _Number | None = Field(alias="time_s")
    R_WS: _Matrix3
    force: _Three = Field(alias="force_N")
    torque: _Three = Field(alias="torque_Nm")
    count: _Count
    force_sd: _ThreePositive | None = Field(alias="force_sd_N")
    torque_sd: _ThreePositive | None = Field(alias="torque_sd_Nm")
    temperature: _Number | None = Field(alias="temperature_C")
    residual_force: _Three = Field(alias="residual_force_N")
    residual_torque: _Three = Field(alias="residual_torque_Nm")
    offset_force: _Three = Field(alias="offset_force_N")
    offset_torque: _Three = Field(alias="offset_torque_Nm")
    force_deviate: _Number
    torque_deviate: _Number


class _DriftPart(_Part):
    """Growth of the biases at the session's end, and its 1 sigma."""

    force_N_per_s: _Three
    torque_Nm_per_s: _Three
    force_sigma_N_per_s: _ThreePositive
    torque_sigma_Nm_per_s: _ThreePositive


class _MountPart(_Part):
    quaternion_SE: _Four
    covariance: _Matrix3 = Field(alias="covariance_rad2")


class _Document(_Part):
    """A whole file."""

    schema_: Literal["contactbench.calibration"] = Field(alias="schema")
    version: Literal[2]
    tool: str
    created: _Time | None
    source: SourceFile | None
    verdict: Verdict
    contact_error: _Positive = Field(alias="contact_error_m")
    task: _TaskPart
    gravity_W: _Three = Field(alias="gravity_W_N")
    mass: _Positive = Field(alias="mass_kg")
    force_bias: _Three = Field(alias="force_bias_N")
    centre_of_mass_S: _Three = Field(alias="centre_of_mass_S_m")
    torque_bias: _Three = Field(alias="torque_bias_Nm")
    parameters: list[str]
    covariance: _Matrix12
    noise: _NoisePart
    scatter: _Positive
    plausible: _Flag
    noise_factor: _Two
    causes: tuple[Cause, ...]
    drift: _DriftPart | None
    model_error: _Positive = Field(alias="model_error_m")
    down_W: _Three
    observability: _ObservabilityPart
    rejected: tuple[Rejection, ...]
    poses: Annotated[list[_PosePart], Field(min_length=3)]
    mount: _MountPart | None = None


# ---- writing -----------------------------------------------------------------------------------


def _document(
    calibration: Calibration, source: SourceFile | None, created: datetime | None, mount: Mount | None
) -> dict[str, Any]:
    """Lay a calibration out as JSON."""
    noise, sight = calibration.noise, calibration.observability
    rate, sigma = calibration.drift_rate, calibration.drift_rate_sigma
    drift = None
    if rate is not None and sigma is not None:
        parts = (rate[:3], rate[3:], sigma[:3], sigma[3:])
        drift = _DriftPart.of(None, **dict(zip(_DriftPart.model_fields, parts, strict=True)))
    return _Document.of(
        calibration,
        schema_=SCHEMA,
        version=VERSION,
        tool=f"contactbench {__version__}",
        created=None if created is None else created.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        source=source,
        task=_TaskPart.of(calibration.task),
        parameters=list(PARAMETERS),
        noise=_NoisePart.of(
            noise,
            force=np.atleast_1d(noise.force),
            torque=np.atleast_1d(noise.torque),
            force_freedom=_or_null(noise.freedom[0]),
            torque_freedom=_or_null(noise.freedom[1]),
            least_force=noise.least[:3],
            least_torque=noise.least[3:],
        ),
        drift=drift,
        observability=_ObservabilityPart.of(
            sight, **{name: _or_null(getattr(sight, name)) for name in _CONDITIONS}
        ),
        poses=[
            _PosePart.of(
                pose,
                residual_force=residual[:3],
                residual_torque=residual[3:],
                offset_force=offset[:3],
                offset_torque=offset[3:],
                force_deviate=deviate[0],
                torque_deviate=deviate[1],
            )
            for pose, residual, offset, deviate in zip(
                calibration.poses,
                calibration.residuals,
                calibration.offsets,
                calibration.deviates,
                strict=True,
            )
        ],
        mount=None if mount is None else _MountPart.of(mount),
    ).model_dump(by_alias=True)


_CONDITIONS = ("condition", "force_condition", "torque_condition")


def _or_null(value: float) -> float | None:
    """JSON has no infinity."""
    return None if value == np.inf else float(value)


def _or_infinite(value: float | None) -> float:
    """Return what `_or_null` wrote."""
    return np.inf if value is None else value


# ---- reading -----------------------------------------------------------------------------------


def decode_record(data: bytes, name: str) -> CalibrationRecord:
    """Return what a file holds, after checking that its parts fit together."""
    if len(data) > SIZE_LIMIT:
        raise CalibrationFileError(
            f"{arg(name)}: larger than {arg(SIZE_LIMIT >> 20)} MiB: choose a calibration file."
        )
    content = _parse(data, name)
    model = _model(content, name)
    poses = tuple(_sample(pose, f"{name}: poses[{i}]") for i, pose in enumerate(content.poses))
    residuals = np.array([[*pose.residual_force, *pose.residual_torque] for pose in content.poses])
    offsets = np.array([[*pose.offset_force, *pose.offset_torque] for pose in content.poses])
    _check_residuals(model, poses, residuals + offsets, name)
    drift, sight = content.drift, content.observability
    calibration = content.value(
        Calibration,
        model=model,
        noise=_noise(content.noise, name),
        poses=poses,
        residuals=residuals,
        deviates=np.array([[pose.force_deviate, pose.torque_deviate] for pose in content.poses]),
        observability=sight.value(
            Observability, **{each: _or_infinite(getattr(sight, each)) for each in _CONDITIONS[1:]}
        ),
        task=_task(content, name),
        offsets=offsets,
        drift_rate=None if drift is None else np.hstack([drift.force_N_per_s, drift.torque_Nm_per_s]),
        drift_rate_sigma=None
        if drift is None
        else np.hstack([drift.force_sigma_N_per_s, drift.torque_sigma_Nm_per_s]),
        down_W=_down(content, name),
    )
    return CalibrationRecord(
        calibration, _created(content, name), content.tool, content.source, _mount(content.mount, name)
    )


def _model(content: _Document, name: str) -> GravityModel:
    with _at(f"{name}: covariance"):
        _check_covariance(content.covariance)
    model = content.value(GravityModel)
    if abs(model.mass - content.mass) > _ROUNDING * model.mass:
        raise CalibrationFileError(
            f"{arg(name)}: mass_kg is {arg(content.mass):.6g}, but gravity_W_N over {arg(STANDARD_GRAVITY)} m/s² is"
            f" {arg(model.mass):.6g}: {arg(REMEDY)}"
        )
    return model


def _sample(pose: _PosePart, where: str) -> PoseSample:
    with _at(where):
        sample = pose.value(PoseSample)
    _keep_digits(sample, "R_WS", pose.R_WS)
    return sample


def _task(content: _Document, name: str) -> ContactTask:
    with _at(f"{name}: task"):
        task = content.task.value(ContactTask, down_W=content.down_W)
    _keep_digits(task, "normal", content.task.normal)
    return task


def _keep_digits(value: PoseSample | ContactTask, field: str, written: NDArray[np.float64]) -> None:
    """Undo a last digit: constructors make unit vectors and rotations anew, which may round them again."""
    if np.abs(written - getattr(value, field)).max() < 1e-14:
        written.flags.writeable = False
        object.__setattr__(value, field, written)


def _noise(part: _NoisePart, name: str) -> PoseNoise:
    force, torque = (each[0] if len(each) == 1 else each for each in (part.force, part.torque))
    with _at(f"{name}: noise"):
        return part.value(
            PoseNoise,
            force=force,
            torque=torque,
            freedom=(_or_infinite(part.force_freedom), _or_infinite(part.torque_freedom)),
            least=np.hstack([part.least_force, part.least_torque]),
        )


def _down(content: _Document, name: str) -> NDArray[np.float64]:
    with _at(f"{name}: down_W"):
        direction(content.down_W)
    if abs(np.linalg.norm(content.down_W) - 1) > _ROUNDING:
        raise CalibrationFileError(f"{arg(name)}: down_W is not of length 1: {arg(REMEDY)}")
    return content.down_W


def _mount(part: _MountPart | None, name: str) -> Mount | None:
    if part is None:
        return None
    if abs(np.linalg.norm(part.quaternion_SE) - 1) > _ROUNDING:
        raise CalibrationFileError(f"{arg(name)}: mount.quaternion_SE is not of length 1: {arg(REMEDY)}")
    with _at(message(f"{arg(name)}: mount.covariance_rad2")):
        _check_covariance(part.covariance)
    return part.value(Mount)


def _created(content: _Document, name: str) -> datetime | None:
    try:
        return None if content.created is None else datetime.fromisoformat(content.created)
    except ValueError as error:  # the 31st of February
        raise CalibrationFileError(
            f"{arg(name)}: created is not a time ({arg(error)}): {arg(REMEDY)}"
        ) from None


# ---- sense -------------------------------------------------------------------------------------


def _check_residuals(
    model: GravityModel, poses: tuple[PoseSample, ...], residuals: NDArray[np.float64], name: str
) -> None:
    """Refuse parameters, readings and residuals (n, 6) that are not from one calibration."""
    read = np.array([[*pose.force, *pose.torque] for pose in poses])
    predicted = model.predict(np.array([pose.R_WS for pose in poses]))
    size = max(1.0, np.abs(model.vector).max(), np.abs(read).max(), np.abs(predicted).max())
    off = np.abs(read - predicted - residuals).max(axis=1)
    wrong = np.flatnonzero(off > _ROUNDING * size)
    if len(wrong):
        raise CalibrationFileError(
            f"{arg(name)}: poses[{arg(wrong[0])}]: the residual is not the reading minus the prediction: a"
            f" number was changed. {arg(capitalised(REMEDY))}"
        )


def _check_covariance(C: NDArray[np.float64]) -> None:
    """Refuse a matrix that cannot be a covariance; InputError."""
    deviations = np.sqrt(np.maximum(np.diag(C), 0.0))
    with np.errstate(all="ignore"):  # what overflows is refused
        scale = np.where(deviations > 0, deviations, 1.0)
        correlation = C / scale / scale[:, None]
    if not (np.abs(correlation - correlation.T) < _ROUNDING).all():
        raise InputError(f"the matrix is not symmetric: {arg(REMEDY)}")
    if (np.diag(C) < 0).any() or np.linalg.eigvalsh(correlation)[0] < -_ROUNDING:
        raise InputError(f"the matrix is not positive semidefinite, so it is not a covariance: {arg(REMEDY)}")


@contextmanager
def _at(place: str) -> Iterator[None]:
    try:
        yield
    except InputError as error:
        raise CalibrationFileError(f"{arg(place)}: {arg(error)}") from None


def _parse(data: bytes, name: str) -> _Document:
    """Return what a file holds, every field in its place and of its type; CalibrationFileError if not."""
    try:
        content = from_json(data)
    except ValueError as error:
        raise CalibrationFileError(
            f"{arg(name)}: not valid JSON ({arg(error)}): choose a calibration file, or copy it again."
        ) from None
    if why := not_of_kind(content, SCHEMA, VERSION, message("a calibration file")):
        raise CalibrationFileError(f"{arg(name)}: {arg(why)}")
    if content.get("version") == 1 and not isinstance(content["version"], bool):
        data = json.dumps(_upgraded(content)).encode()
    try:
        document = _Document.model_validate_json(data)
    except ValidationError as error:
        fault = error.errors(include_url=False, include_context=False, include_input=False)[0]
        raise CalibrationFileError(
            f"{arg(name)}: {arg(_where(fault['loc']))} {arg(_what(fault))}: {arg(REMEDY)}"
        ) from None
    _check_facts(document, name)
    return document


def _upgraded(content: dict[str, Any]) -> dict[str, Any]:
    """Return what version 1 said, as version 2 says it; what is no such file is left for the schema to refuse."""
    new = {
        "version": 2,
        "noise_factor": [1.0, 1.0],
        "causes": [],
        "drift": None,
        "model_error_m": 0.0,
        "down_W": [0.0, 0.0, -1.0],
    }
    noise, poses = content.get("noise"), content.get("poses")
    scatter = content.get("scatter")
    if isinstance(noise, dict):
        noise = {**noise, "orientation_rad": 0.0}
        # The covariance had been widened by the scatter, the noise beside it had not.
        if content.get("plausible") is False and isinstance(scatter, int | float) and scatter > 0:
            wider = float(scatter) ** 0.5
            new |= {"noise_factor": [wider, wider], "scatter": 1.0}
            for field in ("force_N", "torque_Nm"):
                if isinstance(values := noise.get(field), list):
                    noise[field] = [wider * value if isinstance(value, float) else value for value in values]
    if isinstance(poses, list):
        nothing = {"offset_force_N": [0.0] * 3, "offset_torque_Nm": [0.0] * 3}
        poses = [{**pose, **nothing} if isinstance(pose, dict) else pose for pose in poses]
    return {**content, **new, "noise": noise, "poses": poses}


def _check_facts(content: _Document, name: str) -> None:
    """Refuse fields that contradict one another."""
    sight = content.observability
    worst = max(_or_infinite(sight.force_condition), _or_infinite(sight.torque_condition))
    faults = {
        "parameters": tuple(content.parameters) != PARAMETERS,
        "observability.rank": sight.rank != sight.force_rank + sight.torque_rank,
        "observability.condition": _or_infinite(sight.condition) != worst,
    }
    indices = [part.index for part in content.rejected]
    known = set(range(len(content.poses)))
    faults["rejected"] = len(set(indices)) < len(indices) or not known.issuperset(indices)
    faults["causes"] = not all(0 <= cause.odds <= 1 for cause in content.causes)
    for field, wrong in faults.items():
        if wrong:
            raise CalibrationFileError(
                f"{arg(name)}: {arg(field)} does not fit the other fields: {arg(REMEDY)}"
            )


def _where(path: tuple[int | str, ...]) -> str:
    """Write the place of a field as one would in Python: ``poses[3].force_N[0]``."""
    steps = "".join(f"[{step}]" if isinstance(step, int) else f".{step[:60]!s}" for step in path)
    return steps.removeprefix(".").encode("ascii", "backslashreplace").decode()


_WORDS = {
    "missing": message("is missing"),
    "extra_forbidden": message("is not a known field"),
    "finite_number": message("is not a finite number"),
    "less_than_equal": message("is too large"),
    "greater_than_equal": message("is too small"),
    "greater_than": message("is too small"),
}


def _what(fault: Mapping[str, Any]) -> str:
    text = str(fault["msg"]).removeprefix("Input ")
    return _WORDS.get(fault["type"], text[:1].lower() + text[1:])
