"""What a config says of a verification: a summary of the JSON file that ``contactbench verify touches`` wrote."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError
from pydantic_core import from_json

from contactbench.pipeline.config.runtime.canonical import fault_of
from contactbench.pipeline.config.runtime.errors import ConfigError
from contactbench.pipeline.config.runtime.model import VerificationPart
from contactbench.pipeline.config.runtime.mounts import UNTURNED, mount_of_angles
from contactbench.pipeline.contact.noise import WrenchNoise

if TYPE_CHECKING:
    from collections.abc import Mapping

    from contactbench.pipeline.config.runtime.build import Filters

_SCHEMA, _VERSION = "contactbench.verification", 1
_LONGEST = 10_000
RATE_OFF = 0.05  # share by which rates may differ and count as the same


@dataclass(frozen=True)
class Verified:
    """What was verified."""

    sources: dict[str, str]  # SHA-256 by role
    rate: float | None  # Of the recording, Hz; None if the verification does not say it
    # (4,) quaternion_ES; None if the verification does not say it
    mount: tuple[float, float, float, float] | None
    model_error: WrenchNoise | None  # What the wrench's model leaves out; None if it was not measured


def read_verification(data: bytes, name: str) -> tuple[VerificationPart, Verified]:
    """
    Return the summary, and what was verified.

    Parameters
    ----------
    data : bytes
    name : str
        What messages call it.

    Raises
    ------
    ConfigError
        It is no verification of this version, or none of its touches was accepted.
    """
    try:
        content = from_json(data, allow_inf_nan=False)
    except ValueError as error:
        raise ConfigError(f"{name}: this is not JSON ({error!s:.100}): choose a verification.") from None
    if (
        not isinstance(content, dict)
        or content.get("schema") != _SCHEMA
        or content.get("version") != _VERSION
    ):
        raise ConfigError(
            f"{name}: this is no {_SCHEMA} of version {_VERSION}: verify again with this contactbench."
        )
    if content.get("overall") is None:
        raise ConfigError(f"{name}: no touch was accepted, there is nothing to export: verify again.")
    try:
        return VerificationPart.model_validate(_summary(content)), _verified(content)
    except ValidationError as error:
        raise ConfigError(f"{name}: {fault_of(error)}: verify again.") from None
    except (KeyError, TypeError, ValueError) as error:
        raise ConfigError(
            f"{name}: the verification lacks a figure ({error!r:.100}): verify again."
        ) from error


def rate_reasons(verified: float | None, rate: float | None, filters: Filters | None) -> list[str]:
    """
    Say where rates, Hz, are not those of the verified recording, or of each other.

    Parameters
    ----------
    verified : float or None
        None: not known.
    rate : float or None
        Of the config.
    filters : Filters or None
        None: made for `rate`.
    """
    said = []
    if verified is not None and rate is not None and abs(rate / verified - 1) > RATE_OFF:
        said.append(
            f"Contacts were verified at {verified:.4g} readings a second, the config is for {rate:.4g}: verify again"
            " at this rate."
        )
    for what, made in (
        ("wrench", None if filters is None or filters.wrench is None else filters.wrench.rate),
        ("contact point", None if filters is None or filters.location is None else filters.location.rate),
    ):
        if made is not None and rate is not None and abs(rate / made - 1) > RATE_OFF:
            said.append(f"The filter of the {what} is for {made:.4g} Hz, the config for {rate:.4g}.")
    return said


def _verified(content: Mapping[str, Any]) -> Verified:
    settings = content.get("settings", {})
    rate, mount = settings.get("rate_Hz"), None
    if "mount" in settings:  # null: the orientations were the sensor's own
        mount = mount_of_angles(settings["mount"]) or UNTURNED
    error = content.get("model_error")
    return Verified(
        dict(content.get("sources", {})),
        None if rate is None else float(rate),
        mount,
        None if error is None else WrenchNoise(float(error["force_N"]), float(error["torque_Nm"])),
    )


def _unsaid(content: Mapping[str, Any]) -> str:
    """Return a sentence about what a verification does not say; empty if it says all."""
    names = {"rate_Hz": "rate", "mount": "mounting", "filters": "filters", "gates": "gates"}
    missing = [name for key, name in names.items() if key not in content.get("settings", {})]
    return (
        f"The verification does not say its {', '.join(missing)}: make sure they are these."
        if missing
        else ""
    )


def _left_out(content: Mapping[str, Any]) -> str:
    """Return a sentence about markers that were left out on purpose; empty if none was."""
    left_out = content.get("settings", {}).get("left_out")
    if not isinstance(left_out, dict) or not left_out:
        return ""
    said = ", ".join(f"{name} ({why})" for name, why in left_out.items())
    return f"Left out on purpose: {said}: nothing is known of contacts there."


def _summary(content: Mapping[str, Any]) -> dict[str, Any]:
    overall, times, verdict = content["overall"], content["times"], content["verdict"]
    words = [*verdict["reasons"], *([] if content["diagnosis"] is None else [content["diagnosis"]["text"]])]
    words += filter(None, [_left_out(content), _unsaid(content)])
    return {
        "touches": overall["touches"],
        "markers": len(content["per_marker"]),
        **{f"{name}_error_m": overall[f"{name}_mm"] / 1e3 for name in ("mean", "sd", "p95", "max")},
        "ratio": content["ratio"],
        "p99_time_s": None if times is None else times["p99_s"],
        "limit_mean_m": content["limits"]["mean_m"],
        "limit_max_m": content["limits"]["max_m"],
        "passed": verdict["passed"],
        "diagnosis": " ".join(words)[:_LONGEST],
    }
