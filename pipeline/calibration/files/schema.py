"""The schema of calibration files: which fields there are, of which type, and what is said of others."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from pydantic_core import from_json

from contactbench.pipeline.calibration.model import PARAMETERS
from contactbench.pipeline.calibration.verdict import Level
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from contactbench.pipeline.calibration.calibrate import Calibration
    from contactbench.pipeline.calibration.fit import PoseNoise
    from contactbench.pipeline.calibration.observability import Observability

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
        "noise": _noise(calibration.noise),
        "scatter": float(calibration.scatter),
        "plausible": bool(calibration.plausible),
        "noise_factor": list(calibration.noise_factor),
        "causes": [vars(cause) for cause in calibration.causes],
        "drift": _drift(calibration),
        "model_error_m": float(calibration.model_error),
        "down_W": calibration.down_W.tolist(),
        "observability": _observability(calibration.observability),
        "rejected": [vars(rejection) for rejection in calibration.rejected],
        "poses": [_pose(calibration, index) for index in range(len(calibration.poses))],
        "mount": mount,
    }


def _noise(noise: PoseNoise) -> dict[str, Any]:
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


def _observability(sight: Observability) -> dict[str, Any]:
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
