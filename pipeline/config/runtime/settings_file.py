"""
Settings of an export as a JSON file: those parts of a config that neither a calibration nor a probe knows.

``controller`` and ``limits`` are as in ``contactbench.json``; ``gates`` too, but what is left out there is as ever;
``filters`` are its two filters without ``sections``. What a file leaves out as a whole is as without a file.
"""

from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError
from pydantic_core import from_json

from contactbench.pipeline.config.runtime.build import Filters
from contactbench.pipeline.config.runtime.canonical import fault_of
from contactbench.pipeline.config.runtime.model import (
    ConfigPart,
    ControllerPart,
    GatesPart,
    KalmanPart,
    LimitsPart,
)
from contactbench.pipeline.config.runtime.options import ExportOptions
from contactbench.pipeline.config.runtime.values import kalman_of
from contactbench.pipeline.errors import ConfigError, InputError, arg
from contactbench.pipeline.filtering import LowPass
from contactbench.pipeline.gates import Gates

_LARGEST = 2**20


class _LowPass(ConfigPart):
    kind: Literal["lowpass"] = "lowpass"
    rate_Hz: Annotated[float, Field(gt=0, le=1e9)]
    cutoff_Hz: Annotated[float, Field(gt=0, le=1e9)]
    order: Annotated[int, Field(ge=1, le=8)] = 2


class _Filters(ConfigPart):
    wrench: KalmanPart | None
    location: _LowPass | None


class _Settings(ConfigPart):
    controller: ControllerPart | None = None
    limits: LimitsPart | None = None
    gates: dict[str, Any] | None = None
    filters: _Filters | None = None


def with_file(options: ExportOptions, data: bytes, name: str) -> ExportOptions:
    """
    Return settings in which the parts of a file take the place of their own.

    Parameters
    ----------
    options : ExportOptions
    data : bytes
        JSON.
    name : str
        What messages call it.

    Raises
    ------
    ConfigError
        It is no JSON, or a field is unknown, missing, of the wrong type or out of its range.
    """
    given = _read(data, name)
    try:
        return options.having(_parts(given, options.gates), _filters(given.filters))
    except ValidationError as error:  # of the gates, once they are whole
        raise ConfigError(f"{arg(name)}: {arg(fault_of(error))}: correct it.") from None
    except InputError as error:
        raise ConfigError(f"{arg(name)}: {arg(error)}") from None


def controller_in(data: bytes, name: str) -> ControllerPart:
    """
    Return the controller of a file of settings.

    Parameters
    ----------
    data, name
        As of `with_file`.

    Raises
    ------
    ConfigError
        As of `with_file`, or there is none.
    """
    given = _read(data, name)
    if given.controller is None:
        raise ConfigError(f"{arg(name)}: it contains no controller: choose the gains.json of control tune.")
    return given.controller


def _read(data: bytes, name: str) -> _Settings:
    if len(data) > _LARGEST:
        raise ConfigError(f"{arg(name)}: larger than {arg(_LARGEST >> 20)} MiB: choose a settings file.")
    try:
        return _Settings.model_validate(from_json(data, allow_inf_nan=False))
    except ValidationError as error:
        raise ConfigError(f"{arg(name)}: {arg(fault_of(error))}: correct it.") from None
    except ValueError as error:
        raise ConfigError(f"{arg(name)}: not valid JSON ({arg(str(error)[:100])}): correct it.") from None


def _parts(given: _Settings, gates: Gates) -> dict[str, Any]:
    parts: dict[str, Any] = {}
    if given.controller is not None:
        parts["controller"] = given.controller
    if given.limits is not None:
        limits = given.limits
        parts |= {"max_force": limits.max_force_N, "max_torque": limits.max_torque_Nm}
        parts |= {"max_speed": limits.max_speed_mps, "max_turn": limits.max_turn_radps}
    if given.gates is not None:
        said = GatesPart.model_validate({**gates.stored(), **given.gates})
        others = {"region_odds": gates.region_odds, "untouchable_odds": gates.untouchable_odds}
        parts |= dict(Gates.of_stored(said, **others))
    return parts


def _filters(given: _Filters | None) -> Filters | None:
    if given is None:
        return None
    location = given.location
    return Filters(
        None if given.wrench is None else kalman_of(given.wrench),
        None if location is None else LowPass(location.cutoff_Hz, location.rate_Hz, location.order),
        adaptive=given.wrench is None or given.wrench.kind == "adaptive",
    )
