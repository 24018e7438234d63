"""Calibrations as JSON files: everything the report and the next pose need, and nothing that runs.

What is loaded is checked twice: its shape by a strict schema, then its sense. A bit that flipped in a
parameter, or a number that was edited, no longer fits the poses and residuals beside it.
"""

from __future__ import annotations

import hashlib
import json
import os
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from pydantic_core import from_json
from scipy.spatial.transform import Rotation

from contactbench import __version__
from contactbench.pipeline.calibration.calibrate import Calibration, direction
from contactbench.pipeline.calibration.causes import Cause
from contactbench.pipeline.calibration.contact_error import ContactTask
from contactbench.pipeline.calibration.fit import PoseNoise
from contactbench.pipeline.calibration.model import PARAMETERS, STANDARD_GRAVITY, GravityModel
from contactbench.pipeline.calibration.observability import Observability
from contactbench.pipeline.calibration.outliers import Rejection
from contactbench.pipeline.calibration.poses import PoseSample
from contactbench.pipeline.calibration.verdict import Level, Verdict
from contactbench.pipeline.durable import write_durably
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

SIZE_LIMIT = 32 * 2**20  # bytes; ten thousand poses take half of it


@dataclass(frozen=True)
class Source:
    """The file that the poses came from."""

    name: str  # Its name, without folders
    sha256: str  # Of its content, 64 hexadecimal digits

    @classmethod
    def of(cls, file: Path) -> Source:
        """Read a file for its hash; CalibrationFileError if that fails."""
        try:
            with file.open("rb") as stream:
                return cls(file.name, hashlib.file_digest(stream, "sha256").hexdigest())
        except (OSError, ValueError) as error:
            raise CalibrationFileError(
                f"{file}: the file cannot be read ({error}): check the path."
            ) from error


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
        x, y, z, w = Rotation.from_matrix(R_SE).as_quat(canonical=True)
        return cls(np.array([w, x, y, z]), np.zeros((3, 3)) if covariance is None else covariance)

    @property
    def R_SE(self) -> NDArray[np.float64]:
        """(3, 3): ``v_S = R_SE @ v_E``."""
        w, x, y, z = self.quaternion_SE
        return Rotation.from_quat([x, y, z, w]).as_matrix()


@dataclass(frozen=True, eq=False)
class CalibrationRecord:
    """All that a calibration file holds."""

    calibration: Calibration
    created: datetime | None  # When, UTC; None if nobody said
    tool: str  # What wrote the file
    source: Source | None  # What the poses came from
    mount: Mount | None


def save_calibration(
    calibration: Calibration,
    file: Path,
    *,
    source: Path | Source | None = None,
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
    source : path or Source, optional
        The file of the poses, noted with its hash.
    created : datetime, optional
        With a time zone; `creation_time` gives one. Kept to the second.
    mount : Mount, optional

    Raises
    ------
    CalibrationFileError
        The calibration holds something that no file of this kind can, or the file cannot be written.
    """
    if isinstance(source, Path):
        source = Source.of(source)
    if created is not None and created.tzinfo is None:
        raise CalibrationFileError(f"{file}: created: the time has no zone: use datetime.now(UTC).")
    provenance = {
        "tool": f"contactbench {__version__}",
        "created": None if created is None else created.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "source": None if source is None else vars(source),
    }
    fields = None
    if mount is not None:
        fields = {
            "quaternion_SE": mount.quaternion_SE.tolist(),
            "covariance_rad2": mount.covariance.tolist(),
        }
    content = document(calibration, provenance, fields)
    try:
        data = (json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()
    except ValueError as error:  # not finite, or text that is no Unicode
        raise CalibrationFileError(
            f"{file}: this calibration cannot be written ({error}): {REMEDY}"
        ) from error
    _decode(data, str(file))  # what cannot be read is better refused now
    try:
        write_durably(file, data)
    except (OSError, ValueError) as error:
        raise CalibrationFileError(
            f"{file}: the calibration cannot be written ({error}): choose a folder that exists, is writable"
            " and has space."
        ) from error


def load_calibration(file: Path) -> Calibration:
    """
    Read a calibration that `save_calibration` wrote.

    Raises
    ------
    CalibrationFileError
        As `load_record`.
    """
    return load_record(file).calibration


def load_record(file: Path) -> CalibrationRecord:
    """
    Read a calibration with where and when it comes from.

    Raises
    ------
    CalibrationFileError
        The file is missing, too large, not JSON, of another kind or a newer version, or a field is missing,
        of the wrong type, not finite, or contradicts the others; the message names it.
    """
    try:
        with file.open("rb") as stream:
            data = stream.read(SIZE_LIMIT + 1)
    except FileNotFoundError:
        raise CalibrationFileError(f"{file}: there is no such file: check the path.") from None
    except (OSError, ValueError) as error:
        raise CalibrationFileError(
            f"{file}: the file cannot be read ({error}): choose a calibration file."
        ) from error
    return _decode(data, str(file))


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
            f"SOURCE_DATE_EPOCH is {epoch!r}: set it to whole seconds since 1970, or unset it."
        ) from None


# ---- reading -----------------------------------------------------------------------------------

_ROUNDING = 1e-9  # of what is computed anew, on another machine too


def _decode(data: bytes, name: str) -> CalibrationRecord:
    """Return what a file holds, after checking that its parts fit together."""
    if len(data) > SIZE_LIMIT:
        raise CalibrationFileError(f"{name}: larger than {SIZE_LIMIT >> 20} MiB: choose a calibration file.")
    content = parse(data, name)
    model = _model(content, name)
    poses = tuple(_sample(pose, f"{name}: poses[{i}]") for i, pose in enumerate(content.poses))
    residuals = np.array([pose.residual_force_N + pose.residual_torque_Nm for pose in content.poses])
    offsets = np.array([pose.offset_force_N + pose.offset_torque_Nm for pose in content.poses])
    _check_residuals(model, poses, residuals + offsets, name)
    drift = content.drift
    calibration = Calibration(
        model=model,
        noise=_noise(content, name),
        poses=poses,
        residuals=residuals,
        deviates=np.array([[pose.force_deviate, pose.torque_deviate] for pose in content.poses]),
        rejected=tuple(Rejection(**vars(part)) for part in content.rejected),
        observability=_observability(content),
        scatter=content.scatter,
        plausible=content.plausible,
        task=_task(content, name),
        contact_error=content.contact_error_m,
        verdict=Verdict(content.verdict.level, tuple(content.verdict.reasons)),
        causes=tuple(Cause(**vars(part)) for part in content.causes),
        offsets=offsets,
        drift_rate=None if drift is None else np.array(drift.force_N_per_s + drift.torque_Nm_per_s),
        drift_rate_sigma=None
        if drift is None
        else np.array(drift.force_sigma_N_per_s + drift.torque_sigma_Nm_per_s),
        noise_factor=(content.noise_factor[0], content.noise_factor[1]),
        model_error=content.model_error_m,
        down_W=_down(content, name),
    )
    source = None if content.source is None else Source(**vars(content.source))
    return CalibrationRecord(
        calibration, _created(content, name), content.tool, source, _mount(content, name)
    )


def _model(content: Document, name: str) -> GravityModel:
    with _at(f"{name}: covariance"):
        covariance = _covariance(content.covariance)
    model = GravityModel(
        np.array(content.gravity_W_N),
        np.array(content.force_bias_N),
        np.array(content.centre_of_mass_S_m),
        np.array(content.torque_bias_Nm),
        covariance,
    )
    if abs(model.mass - content.mass_kg) > _ROUNDING * model.mass:
        raise CalibrationFileError(
            f"{name}: mass_kg is {content.mass_kg:.6g}, but gravity_W_N over {STANDARD_GRAVITY} m/s² is"
            f" {model.mass:.6g}: {REMEDY}"
        )
    return model


def _sample(pose: PosePart, where: str) -> PoseSample:
    with _at(where):
        sample = PoseSample(
            np.array(pose.R_WS),
            np.array(pose.force_N),
            np.array(pose.torque_Nm),
            count=pose.count,
            force_sd=None if pose.force_sd_N is None else np.array(pose.force_sd_N),
            torque_sd=None if pose.torque_sd_Nm is None else np.array(pose.torque_sd_Nm),
            temperature=pose.temperature_C,
            time=pose.time_s,
            name=pose.name,
        )
    _keep_digits(sample, "R_WS", pose.R_WS)
    return sample


def _task(content: Document, name: str) -> ContactTask:
    part = content.task
    with _at(f"{name}: task"):
        task = ContactTask(
            np.array(part.point_S_m),
            np.array(part.normal_S),
            part.force_N,
            part.tilt_rad,
            part.friction_rad,
            np.array(content.down_W),
        )
    _keep_digits(task, "normal", part.normal_S)
    return task


def _keep_digits(value: PoseSample | ContactTask, field: str, written: list[Any]) -> None:
    """Undo a last digit: constructors make unit vectors and rotations anew, which may round them again."""
    array = np.array(written)
    if np.abs(array - getattr(value, field)).max() < 1e-14:
        array.flags.writeable = False
        object.__setattr__(value, field, array)


def _noise(content: Document, name: str) -> PoseNoise:
    part = content.noise
    force, torque = (
        values[0] if len(values) == 1 else np.array(values) for values in (part.force_N, part.torque_Nm)
    )
    least = np.array(part.least_force_N + part.least_torque_Nm)
    freedom = (or_infinite(part.force_freedom), or_infinite(part.torque_freedom))
    with _at(f"{name}: noise"):
        return PoseNoise(force, torque, part.estimated, freedom, least, part.orientation_rad)


def _down(content: Document, name: str) -> NDArray[np.float64]:
    with _at(f"{name}: down_W"):
        direction(content.down_W)
    down = np.array(content.down_W)
    if abs(np.linalg.norm(down) - 1) > _ROUNDING:
        raise CalibrationFileError(f"{name}: down_W is not of length 1: {REMEDY}")
    return down


def _observability(content: Document) -> Observability:
    part = content.observability
    return Observability(
        rank=part.rank,
        force_rank=part.force_rank,
        torque_rank=part.torque_rank,
        force_condition=or_infinite(part.force_condition),
        torque_condition=or_infinite(part.torque_condition),
        null_directions=tuple(part.null_directions),
        weighs=part.weighs,
        weak=part.weak,
    )


def _mount(content: Document, name: str) -> Mount | None:
    part = content.mount
    if part is None:
        return None
    if abs(np.linalg.norm(part.quaternion_SE) - 1) > _ROUNDING:
        raise CalibrationFileError(f"{name}: mount.quaternion_SE is not of length 1: {REMEDY}")
    with _at(f"{name}: mount.covariance_rad2"):
        return Mount(np.array(part.quaternion_SE), _covariance(part.covariance_rad2))


def _created(content: Document, name: str) -> datetime | None:
    try:
        return None if content.created is None else datetime.fromisoformat(content.created)
    except ValueError as error:  # the 31st of February
        raise CalibrationFileError(f"{name}: created is no time ({error}): {REMEDY}") from None


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
            f"{name}: poses[{wrong[0]}]: its residual is not its reading minus what the parameters predict:"
            f" a number was changed. {REMEDY.capitalize()}"
        )


def _covariance(rows: list[list[float]]) -> NDArray[np.float64]:
    """Return a matrix that can be a covariance; InputError if it cannot."""
    C = np.array(rows)
    deviations = np.sqrt(np.maximum(np.diag(C), 0.0))
    with np.errstate(all="ignore"):  # what overflows is refused
        scale = np.where(deviations > 0, deviations, 1.0)
        correlation = C / scale / scale[:, None]
    if not (np.abs(correlation - correlation.T) < _ROUNDING).all():
        raise InputError(f"the matrix is not symmetric: {REMEDY}")
    if (np.diag(C) < 0).any() or np.linalg.eigvalsh(correlation)[0] < -_ROUNDING:
        raise InputError(f"the matrix is not positive semidefinite, so no covariance: {REMEDY}")
    return C


@contextmanager
def _at(place: str) -> Iterator[None]:
    try:
        yield
    except InputError as error:
        raise CalibrationFileError(f"{place}: {error}") from None


SCHEMA, VERSION = "contactbench.calibration", 2

REMEDY = "use the file as contactbench wrote it, or calibrate again."


class CalibrationFileError(InputError):
    """A calibration file that cannot be used: names the file, the field, and the remedy."""


class Part(BaseModel):
    """A JSON object: every field named, of its own type, finite."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)


# The square of the largest number is still one.
_Number = Annotated[float, Field(ge=-1e100, le=1e100)]
_Positive = Annotated[float, Field(ge=0, le=1e100)]
_Freedom = Annotated[float, Field(gt=0, le=1e100)]
_Three = Annotated[list[_Number], Field(min_length=3, max_length=3)]
_ThreePositive = Annotated[list[_Positive], Field(min_length=3, max_length=3)]
_OneOrThree = Annotated[list[_Number], Field(min_length=1, max_length=3)]  # one serves for all axes
_Four = Annotated[list[_Number], Field(min_length=4, max_length=4)]
_Twelve = Annotated[list[_Number], Field(min_length=12, max_length=12)]
_Matrix3 = Annotated[list[_Three], Field(min_length=3, max_length=3)]
_Matrix12 = Annotated[list[_Twelve], Field(min_length=12, max_length=12)]
_Rank = Annotated[int, Field(ge=0, le=6)]
_Time = Annotated[str, Field(pattern="^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z$")]


class SourcePart(Part):
    """Which file the poses came from."""

    name: str
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$")]


class VerdictPart(Part):
    """As Verdict."""

    level: Level
    reasons: list[str]


class TaskPart(Part):
    """As ContactTask."""

    point_S_m: _Three
    normal_S: _Three
    force_N: _Number
    tilt_rad: _Number
    friction_rad: _Number


class NoisePart(Part):
    """As PoseNoise; a freedom of null is infinite."""

    force_N: _OneOrThree
    torque_Nm: _OneOrThree
    estimated: bool
    force_freedom: _Freedom | None
    torque_freedom: _Freedom | None
    least_force_N: _ThreePositive
    least_torque_Nm: _ThreePositive
    orientation_rad: _Positive


class ObservabilityPart(Part):
    """As Observability; a condition of null is infinite."""

    rank: Annotated[int, Field(ge=0, le=12)]
    force_rank: _Rank
    torque_rank: _Rank
    condition: _Positive | None
    force_condition: _Positive | None
    torque_condition: _Positive | None
    null_directions: list[str]
    weighs: bool
    weak: str


class RejectedPart(Part):
    """As Rejection."""

    index: Annotated[int, Field(ge=0)]
    name: str
    force_sigmas: _Number
    torque_sigmas: _Number
    reason: str


class PosePart(Part):
    """As PoseSample, with what the fit leaves of it."""

    name: str
    time_s: _Number | None
    R_WS: _Matrix3
    force_N: _Three
    torque_Nm: _Three
    count: Annotated[int, Field(ge=1, le=2**63 - 1)]
    force_sd_N: _ThreePositive | None
    torque_sd_Nm: _ThreePositive | None
    temperature_C: _Number | None
    residual_force_N: _Three
    residual_torque_Nm: _Three
    offset_force_N: _Three
    offset_torque_Nm: _Three
    force_deviate: _Number
    torque_deviate: _Number


class CausePart(Part):
    """As Cause."""

    key: str
    odds: Annotated[float, Field(ge=0, le=1)]
    sentence: str
    believed: bool


class DriftPart(Part):
    """Growth of the biases at the session's end, and its 1 sigma."""

    force_N_per_s: _Three
    torque_Nm_per_s: _Three
    force_sigma_N_per_s: _ThreePositive
    torque_sigma_Nm_per_s: _ThreePositive


class MountPart(Part):
    """As Mount."""

    quaternion_SE: _Four
    covariance_rad2: _Matrix3


class Document(Part):
    """A whole file."""

    schema_: Literal["contactbench.calibration"] = Field(alias="schema")
    version: Literal[2]
    tool: str
    created: _Time | None
    source: SourcePart | None
    verdict: VerdictPart
    contact_error_m: _Positive
    task: TaskPart
    gravity_W_N: _Three
    mass_kg: _Positive
    force_bias_N: _Three
    centre_of_mass_S_m: _Three
    torque_bias_Nm: _Three
    parameters: list[str]
    covariance: _Matrix12
    noise: NoisePart
    scatter: _Positive
    plausible: bool
    noise_factor: Annotated[list[_Positive], Field(min_length=2, max_length=2)]
    causes: list[CausePart]
    drift: DriftPart | None
    model_error_m: _Positive
    down_W: _Three
    observability: ObservabilityPart
    rejected: list[RejectedPart]
    poses: Annotated[list[PosePart], Field(min_length=3)]
    mount: MountPart | None = None


def parse(data: bytes, name: str) -> Document:
    """
    Return what a file holds, every field in its place and of its type.

    Parameters
    ----------
    data : bytes
        Its content.
    name : str
        What messages call it.

    Raises
    ------
    CalibrationFileError
        It is no JSON, of another kind or version, or a field is missing, unknown, wrong or contradicts another.
    """
    try:
        content = from_json(data)
    except ValueError as error:
        raise CalibrationFileError(
            f"{name}: this is not JSON ({error}): choose a calibration file, or copy it again."
        ) from None
    _check_kind(content, name)
    if content.get("version") == 1 and not isinstance(content["version"], bool):
        data = json.dumps(_upgraded(content)).encode()
    try:
        document = Document.model_validate_json(data)
    except ValidationError as error:
        fault = error.errors(include_url=False, include_context=False, include_input=False)[0]
        raise CalibrationFileError(f"{name}: {_where(fault['loc'])} {_what(fault)}: {REMEDY}") from None
    _check_facts(document, name)
    return document


def _check_kind(content: Any, name: str) -> None:
    schema = content.get("schema") if isinstance(content, dict) else None
    if schema != SCHEMA:
        found = f"the schema is {schema[:60]!a}" if isinstance(schema, str) else "there is no schema"
        raise CalibrationFileError(f"{name}: {found}, not {SCHEMA!r}: choose a calibration file.")
    version = content.get("version")
    if isinstance(version, int) and not isinstance(version, bool) and version > VERSION:
        raise CalibrationFileError(
            f"{name}: this file was written by a newer contactbench (its version is above {VERSION}): update"
            " contactbench."
        )


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


def _check_facts(content: Document, name: str) -> None:
    """Refuse fields that contradict one another."""
    sight = content.observability
    worst = max(or_infinite(sight.force_condition), or_infinite(sight.torque_condition))
    faults = {
        "parameters": tuple(content.parameters) != PARAMETERS,
        "observability.rank": sight.rank != sight.force_rank + sight.torque_rank,
        "observability.condition": or_infinite(sight.condition) != worst,
    }
    indices = [part.index for part in content.rejected]
    faults["rejected"] = len(set(indices)) < len(indices) or max(indices, default=0) >= len(content.poses)
    for field, wrong in faults.items():
        if wrong:
            raise CalibrationFileError(f"{name}: {field} does not fit the other fields: {REMEDY}")


def _where(path: tuple[int | str, ...]) -> str:
    """Write the place of a field as one would in Python: ``poses[3].force_N[0]``."""
    steps = "".join(f"[{step}]" if isinstance(step, int) else f".{step[:60]!s}" for step in path)
    return steps.removeprefix(".").encode("ascii", "backslashreplace").decode()


_WORDS = {
    "missing": "is missing",
    "extra_forbidden": "is not known here",
    "finite_number": "is not a finite number",
    "less_than_equal": "is too large",
    "greater_than_equal": "is too small",
    "greater_than": "is too small",
}


def _what(fault: Mapping[str, Any]) -> str:
    message = str(fault["msg"]).removeprefix("Input ")
    return _WORDS.get(fault["type"], message[:1].lower() + message[1:])


# ---- writing -----------------------------------------------------------------------------------


def document(
    calibration: Calibration, provenance: Mapping[str, Any], mount: Mapping[str, Any] | None
) -> dict[str, Any]:
    """
    Lay a calibration out as JSON; the order of the fields is that of the file.

    Parameters
    ----------
    calibration : Calibration
    provenance : mapping
        The fields tool, created and source.
    mount : mapping, optional
        The field mount.
    """
    model, task, verdict = calibration.model, calibration.task, calibration.verdict
    return {
        "schema": SCHEMA,
        "version": VERSION,
        **provenance,
        "verdict": {"level": verdict.level.value, "reasons": list(verdict.reasons)},
        "contact_error_m": float(calibration.contact_error),
        "task": {
            "point_S_m": task.point.tolist(),
            "normal_S": task.normal.tolist(),
            "force_N": float(task.force),
            "tilt_rad": float(task.tilt),
            "friction_rad": float(task.friction),
        },
        "gravity_W_N": model.gravity_W.tolist(),
        "mass_kg": model.mass,
        "force_bias_N": model.force_bias.tolist(),
        "centre_of_mass_S_m": model.centre_of_mass_S.tolist(),
        "torque_bias_Nm": model.torque_bias.tolist(),
        "parameters": list(PARAMETERS),
        "covariance": model.covariance.tolist(),
        "noise": _noise_part(calibration.noise),
        "scatter": float(calibration.scatter),
        "plausible": bool(calibration.plausible),
        "noise_factor": list(calibration.noise_factor),
        "causes": [vars(cause) for cause in calibration.causes],
        "drift": _drift(calibration),
        "model_error_m": float(calibration.model_error),
        "down_W": calibration.down_W.tolist(),
        "observability": _observability_part(calibration.observability),
        "rejected": [vars(rejection) for rejection in calibration.rejected],
        "poses": [_pose(calibration, index) for index in range(len(calibration.poses))],
        "mount": mount,
    }


def _noise_part(noise: PoseNoise) -> dict[str, Any]:
    return {
        "force_N": np.atleast_1d(noise.force).tolist(),
        "torque_Nm": np.atleast_1d(noise.torque).tolist(),
        "estimated": bool(noise.estimated),
        "force_freedom": _or_null(noise.freedom[0]),
        "torque_freedom": _or_null(noise.freedom[1]),
        "least_force_N": noise.least[:3].tolist(),
        "least_torque_Nm": noise.least[3:].tolist(),
        "orientation_rad": float(noise.orientation),
    }


def _drift(calibration: Calibration) -> dict[str, Any] | None:
    rate, sigma = calibration.drift_rate, calibration.drift_rate_sigma
    if rate is None or sigma is None:
        return None
    return {
        "force_N_per_s": rate[:3].tolist(),
        "torque_Nm_per_s": rate[3:].tolist(),
        "force_sigma_N_per_s": sigma[:3].tolist(),
        "torque_sigma_Nm_per_s": sigma[3:].tolist(),
    }


def _observability_part(sight: Observability) -> dict[str, Any]:
    return {
        "rank": sight.rank,
        "force_rank": sight.force_rank,
        "torque_rank": sight.torque_rank,
        "condition": _or_null(sight.condition),
        "force_condition": _or_null(sight.force_condition),
        "torque_condition": _or_null(sight.torque_condition),
        "null_directions": list(sight.null_directions),
        "weighs": bool(sight.weighs),
        "weak": sight.weak,
    }


def _pose(calibration: Calibration, index: int) -> dict[str, Any]:
    pose, residual, offset = (
        calibration.poses[index],
        calibration.residuals[index],
        calibration.offsets[index],
    )
    return {
        "name": pose.name,
        "time_s": None if pose.time is None else float(pose.time),
        "R_WS": pose.R_WS.tolist(),
        "force_N": pose.force.tolist(),
        "torque_Nm": pose.torque.tolist(),
        "count": int(pose.count),
        "force_sd_N": None if pose.force_sd is None else pose.force_sd.tolist(),
        "torque_sd_Nm": None if pose.torque_sd is None else pose.torque_sd.tolist(),
        "temperature_C": None if pose.temperature is None else float(pose.temperature),
        "residual_force_N": residual[:3].tolist(),
        "residual_torque_Nm": residual[3:].tolist(),
        "offset_force_N": offset[:3].tolist(),
        "offset_torque_Nm": offset[3:].tolist(),
        "force_deviate": float(calibration.deviates[index, 0]),
        "torque_deviate": float(calibration.deviates[index, 1]),
    }


def _or_null(value: float) -> float | None:
    """JSON has no infinity."""
    return None if value == np.inf else float(value)


def or_infinite(value: float | None) -> float:
    """Return what `_or_null` wrote."""
    return np.inf if value is None else value
