"""
What a config says of the known weight and the known touch: summaries of what ``calibrate check`` wrote.

Neither has to be there. But one that failed shows that the sensor's sign, unit or scale is wrong, and then every force
that a robot acts on: such a config counts as unverified, whatever the markers said.
"""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError
from pydantic_core import from_json

from contactbench.pipeline.config.runtime.canonical import fault_of
from contactbench.pipeline.config.runtime.errors import ConfigError
from contactbench.pipeline.config.runtime.model import ChecksPart, KnownTouchPart, KnownWeightPart

if TYPE_CHECKING:
    from collections.abc import Mapping

# Kind, as the schema and the session name it -> (how messages call it, what it rests on, its part of a config).
_KINDS: dict[str, tuple[str, tuple[str, ...], type[KnownWeightPart | KnownTouchPart]]] = {
    "known_weight": ("known weight", ("calibration",), KnownWeightPart),
    "known_touch": ("known touch", ("calibration", "probe"), KnownTouchPart),
}
CHECK_KINDS = tuple(_KINDS)
_VERSION = 1
NONE_DONE = ChecksPart(known_weight=None, known_touch=None)


def read_check(
    kind: str, data: bytes, name: str, made: str | None = None
) -> tuple[KnownWeightPart | KnownTouchPart, dict[str, str]]:
    """
    Return the summary of a check, and the SHA-256 of the files that it was made with, by role.

    Parameters
    ----------
    kind : str
        One of `CHECK_KINDS`.
    data : bytes
    name : str
        What messages call the file.
    made : str, optional
        When, ISO 8601 with a zone, where the file does not say it.

    Raises
    ------
    ConfigError
        It is no check of this kind and version, or lacks a figure.
    """
    words, roles, part = _KINDS[kind]
    again = f"check the {words} again"
    try:
        content = from_json(data, allow_inf_nan=False)
    except ValueError as error:
        raise ConfigError(f"{name}: this is not JSON ({error!s:.100}): choose a {words}.") from None
    schema = f"contactbench.{kind}"
    if not isinstance(content, dict) or content.get("schema") != schema or content.get("version") != _VERSION:
        raise ConfigError(f"{name}: this is no {schema} of version {_VERSION}: {again}.")
    try:
        taken = {field: content[field] for field in part.model_fields}
        if (created := taken["created"] or made) is not None:
            taken["created"] = _seconds(created)
        return part.model_validate(taken), {role: content[f"{role}_sha256"] for role in roles}
    except ValidationError as error:
        raise ConfigError(f"{name}: {fault_of(error)}: {again}.") from None
    except (KeyError, TypeError, ValueError) as error:
        raise ConfigError(f"{name}: the {words} lacks a figure ({error!r:.100}): {again}.") from error


def checks_of(parts: Mapping[str, KnownWeightPart | KnownTouchPart]) -> ChecksPart:
    """Return the part of a config from kind -> part, as `read_check` gives them."""
    return ChecksPart.model_validate({**NONE_DONE.model_dump(), **parts})


def made_with_others(kind: str, made_with: Mapping[str, str], hashes: Mapping[str, set[str]]) -> list[str]:
    """
    Say which files a check was made with that are not those of the config.

    Parameters
    ----------
    kind : str
    made_with : mapping of str to str
        As `read_check` returns it.
    hashes : mapping of str to set of str
        Role -> the SHA-256 that the config's file of this role is known by.
    """
    words, roles, _ = _KINDS[kind]
    return [
        f"The {words} was checked with another {role}: check it again."
        for role in roles
        if made_with.get(role) not in hashes[role]
    ]


def failed_checks(checks: ChecksPart) -> dict[str, str]:
    """Return kind -> a sentence about each check that failed."""
    failed = {}
    if (weight := checks.known_weight) is not None and weight.outcome == "failed":
        failed["known_weight"] = (
            f"The known weight of {weight.mass_kg:.4g} kg was measured as {weight.measured_kg:.4g} kg: find the wrong"
            " sign, unit or scale, calibrate again, and check it again."
        )
    if (touch := checks.known_touch) is not None and touch.outcome == "failed":
        where = (
            "was not located at all"
            if touch.error_m is None
            else f"was located {1e3 * touch.error_m:.3g} mm off"
        )
        failed["known_touch"] = (
            f"The known touch {where}: find the wrong sign, unit or mounting, calibrate again, and check it again."
        )
    return failed


def unchecked(checks: ChecksPart) -> str:
    """Return a sentence where neither check told anything; empty where one did."""
    done = [part for part in (checks.known_weight, checks.known_touch) if part is not None]
    if any(part.outcome != "undecided" for part in done):
        return ""
    if done:
        return (
            "The check could not tell whether sign, unit and scale of the sensor are right: check a heavier weight,"
            " or press the known point again."
        )
    return (
        "Neither a known weight nor a known touch was checked: a wrong sign, unit or scale of the sensor would go"
        " unnoticed. Check one of them."
    )


def _seconds(created: Any) -> str:
    """Return a time with a zone as a config spells it; ValueError if it is none."""
    time = datetime.fromisoformat(created)
    if time.tzinfo is None:
        raise ValueError("created has no time zone")
    return time.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
