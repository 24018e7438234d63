"""
What a config says of the verification, the known weight and the known touch: summaries of the files about them.

Neither check has to be there. But one that failed shows that the sensor's sign, unit or scale is wrong, and then every
force that a robot acts on: such a config counts as unverified, whatever the markers said.
"""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import ValidationError
from pydantic_core import from_json

from contactbench.pipeline.config.runtime.canonical import fault_of
from contactbench.pipeline.config.runtime.model import (
    ChecksPart,
    KnownTouchPart,
    KnownWeightPart,
    VerificationPart,
)
from contactbench.pipeline.config.runtime.mounts import UNTURNED, mount_of_angles
from contactbench.pipeline.contact.touch_model import WrenchNoise
from contactbench.pipeline.errors import ConfigError, InputError, arg, join, message
from contactbench.pipeline.filtering import KalmanFilter

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from contactbench.pipeline.config.runtime.build import Filters
    from contactbench.pipeline.gates import Gates

# Kind, as the schema and the session name it -> (how messages call it, what it rests on, its part of a config).
_KINDS: dict[str, tuple[str, tuple[str, ...], type[KnownWeightPart | KnownTouchPart]]] = {
    "known_weight": (message("known weight"), ("calibration",), KnownWeightPart),
    "known_touch": (message("known touch"), ("calibration", "probe"), KnownTouchPart),
}
CHECK_KINDS = tuple(_KINDS)
_VERSION = 1
_LONGEST = 10_000
_LATEST_S = 0.05  # a controller at 50 Hz takes a contact for no older
_ROUGHEST = 1.25  # times the scatter that was verified
RATE_OFF = 0.05  # share by which rates may differ and count as the same
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
    again = message(f"check the {arg(words)} again")
    content = _content(data, name, f"contactbench.{kind}", words, again)
    with _refused(name, words, again):
        taken = {field: content[field] for field in part.model_fields}
        if (created := taken["created"] or made) is not None:
            taken["created"] = _seconds(created)
        return part.model_validate(taken), {role: content[f"{role}_sha256"] for role in roles}


@contextmanager
def _refused(name: str, words: str, again: str) -> Iterator[None]:
    try:
        yield
    except ValidationError as error:
        raise ConfigError(f"{arg(name)}: {arg(fault_of(error))}: {arg(again)}.") from None
    except (KeyError, TypeError, ValueError) as error:
        raise ConfigError(
            f"{arg(name)}: the {arg(words)} lacks a figure ({arg(repr(error)[:100])}): {arg(again)}."
        ) from error


def _content(data: bytes, name: str, schema: str, words: str, again: str) -> dict[str, Any]:
    try:
        content = from_json(data, allow_inf_nan=False)
    except ValueError as error:
        raise ConfigError(
            f"{arg(name)}: not valid JSON ({arg(str(error)[:100])}): choose a {arg(words)}."
        ) from None
    if not isinstance(content, dict) or (content.get("schema"), content.get("version")) != (schema, _VERSION):
        raise ConfigError(f"{arg(name)}: not a {arg(schema)} of version {arg(_VERSION)}: {arg(again)}.")
    return content


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
        message(f"The {arg(words)} was checked with another {arg(role)}: check it again.")
        for role in roles
        if made_with.get(role) not in hashes[role]
    ]


def failed_checks(checks: ChecksPart) -> dict[str, str]:
    """Return kind -> a sentence about each check that failed."""
    failed = {}
    if (weight := checks.known_weight) is not None and weight.outcome == "failed":
        failed["known_weight"] = message(
            f"The known weight of {arg(weight.mass_kg):.4g} kg was measured as {arg(weight.measured_kg):.4g}"
            " kg: find the wrong sign, unit or scale, calibrate again, and check it again."
        )
    if (touch := checks.known_touch) is not None and touch.outcome == "failed":
        where = (
            message("was not located at all")
            if touch.error_m is None
            else message(f"was located {arg(1e3 * touch.error_m):.3g} mm off")
        )
        failed["known_touch"] = message(
            f"The known touch {arg(where)}: find the wrong sign, unit or mounting, calibrate again, and check it again."
        )
    return failed


def unchecked(checks: ChecksPart) -> str:
    """Return a sentence where neither check told anything; empty where one did."""
    done = [part for part in (checks.known_weight, checks.known_touch) if part is not None]
    if any(part.outcome != "undecided" for part in done):
        return ""
    if done:
        return message(
            "The check was inconclusive about sign, unit and scale of the sensor: use a heavier"
            " weight, or press the known point again."
        )
    return message(
        "Neither a known weight nor a known touch was checked: a wrong sign, unit or scale of the sensor would go"
        " unnoticed. Check one of them."
    )


def _seconds(created: Any) -> str:
    """Return a time with a zone as a config spells it; ValueError if it is none."""
    time = datetime.fromisoformat(created)
    if time.tzinfo is None:
        raise ValueError(message("created has no time zone"))
    return time.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


# ---- verification ------------------------------------------------------------------------------


@dataclass(frozen=True)
class Verified:
    """What was verified."""

    sources: dict[str, str]  # SHA-256 by role
    rate: float | None  # Of the recording, Hz; None if the verification does not say it
    # (4,) quaternion_ES; None if the verification does not say it
    mount: tuple[float, float, float, float] | None
    model_error: WrenchNoise | None  # What the wrench's model leaves out; None if it was not measured
    follow: bool = False  # Whether the zero followed
    gates: Mapping[str, Any] | None = None  # As the verification tells them; None if it does not
    torsion_arm: float | None = None  # One sigma, torsion over force, m; None if it does not say it
    taken: Taken | None = None


@dataclass(frozen=True)
class Taken:
    """What the wrenches were whose contacts were verified: means of readings, without a filter."""

    noise: NDArray[np.float64]  # (6,) of one reading, 1 sigma, N and N·m
    left: float  # Share of it in a wrench, no less than behind the usual filter
    floor: NDArray[np.float64]  # (6,) what no mean makes smaller, 1 sigma, N and N·m


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
    content = _content(
        data,
        name,
        "contactbench.verification",
        "verification",
        message("verify again with this contactbench"),
    )
    if content.get("overall") is None:
        raise ConfigError(f"{arg(name)}: no touch was accepted, so there is nothing to export: verify again.")
    with _refused(name, message("verification"), message("verify again")):
        return VerificationPart.model_validate(_summary(content)), _verified(content)


def gate_reasons(verified: Mapping[str, Any] | None, gates: Gates) -> list[str]:
    """Say which `gates` of a config accept touches that those of the verification, as it tells them, would not."""
    if verified is None:
        return []
    try:
        more = ", ".join(gates.more_than(verified))
    except (InputError, TypeError) as error:
        raise ConfigError(
            f"the verification's gates cannot be read ({arg(str(error)[:200])}): verify again."
        ) from None
    if not more:
        return []
    return [
        message(
            f"The config accepts touches that the verification did not, by these gates (as verified): {arg(more)}:"
            " export with the verified gates."
        )[:1000]
    ]


def model_reasons(
    verified: Verified, rate: float, filters: Filters, noise: WrenchNoise | None, arm: float, *, follow: bool
) -> list[str]:
    """
    Say where a config's contacts are later or rougher than the verified ones, or claim to be surer.

    Parameters
    ----------
    verified : Verified
    rate : float
        Of the config, Hz.
    filters : Filters
    noise : WrenchNoise or None
        Of one reading, as a person gave it; None: as it was measured.
    arm : float
        One sigma of the torsion over the force that a touch may have, m.
    follow : bool
        Whether the zero follows.
    """
    wrench, point, taken = filters.wrench, filters.location, verified.taken
    lag = 0.0 if wrench is None or filters.adaptive else wrench.figures().delay
    lag += 0.0 if point is None else point.delay
    rougher = stated = 1.0
    if taken is not None:
        left = 1.0 if wrench is None else wrench.figures().noise_left
        one, verified_one = (np.hypot(share * taken.noise, taken.floor) for share in (left, taken.left))
        rougher = float((one / verified_one).max())
        stated = 1.0 if noise is None else float((np.diag(noise.covariance) ** 0.5 / taken.noise).min())
    least = arm if verified.torsion_arm is None else verified.torsion_arm
    made = [each.rate for each in (wrench, point) if each is not None and _is_off(rate, each.rate)]
    wrong = {
        message(
            f"Contacts were verified at {arg(verified.rate or rate):.4g} readings per second, but the config is for"
            f" {arg(rate):.4g}: verify again at this rate."
        ): _is_off(rate, verified.rate or rate),
        message(
            f"A filter is for {arg(made[0] if made else rate):.4g} Hz, but the config is for {arg(rate):.4g}."
        ): bool(made),
        message(
            "Only one of config and verification lets the zero follow: verify and export with the same choice."
        ): follow != verified.follow,
        message(
            f"The config's filters let contacts lag by {arg(1e3 * lag):.0f} ms, and verified touches stood still:"
            " export with the adaptive filter and a higher cutoff."
        ): lag > _LATEST_S,
        message(
            f"Behind the config's filter wrenches scatter {arg(rougher):.1f} times as much as was verified: filter the"
            " wrench more."
        ): rougher > _ROUGHEST,
        message(
            f"The config states {arg(stated):.1g} of the noise that the verification found, so more contacts are sure"
            " than were verified: leave the noise out."
        ): stated < 1 / _ROUGHEST,
        message(
            f"The config allows a touch {arg(1e3 * arm):.2g} mm of torsion over force, the verification"
            f" {arg(1e3 * least):.2g} mm, so more contacts are sure than were verified: verify with the same scene."
        ): arm < least,
    }
    return [sentence for sentence, is_so in wrong.items() if is_so]


def _is_off(rate: float, other: float) -> bool:
    return abs(rate / other - 1) > RATE_OFF


def _verified(content: Mapping[str, Any]) -> Verified:
    settings = content.get("settings", {})
    rate, mount = settings.get("rate_Hz"), None
    if "mount" in settings:  # null: the orientations were the sensor's own
        mount = mount_of_angles(settings["mount"]) or UNTURNED
    told, assumed, taken = content.get("model_error"), settings.get("assumed", {}), None
    error = None if told is None else WrenchNoise(float(told["force_N"]), float(told["torque_Nm"]))
    if rate is not None and {"noise", "protocol"} <= settings.keys() and "model_error" in assumed:
        protocol = settings["protocol"]
        count = max(float(protocol["samples"]), rate * protocol.get("take_s", 0.0), 1.0)
        given = settings["noise"], assumed["model_error"]
        noise, floor = (np.diag(WrenchNoise(each[:3], each[3:]).covariance) ** 0.5 for each in given)
        taken = Taken(
            noise.clip(1e-9),  # a simulated sensor may have none
            max(count**-0.5, KalmanFilter(rate).figures().noise_left),
            floor if error is None else np.diag(error.covariance) ** 0.5,
        )
    return Verified(
        dict(content.get("sources", {})),
        None if rate is None else float(rate),
        mount,
        error,
        bool(settings.get("follow", False)),
        settings.get("gates"),
        float(assumed["torsion_arm_m"]) if "torsion_arm_m" in assumed else None,
        taken,
    )


def _unsaid(content: Mapping[str, Any]) -> str:
    """Return a sentence about what a verification does not say; empty if it says all."""
    names = {"rate_Hz": "rate", "mount": "mounting", "filters": "filters", "gates": "gates"}
    missing = [name for key, name in names.items() if key not in content.get("settings", {})]
    return (
        message(f"The verification does not state its {arg(', '.join(missing))}: make sure they match.")
        if missing
        else ""
    )


def _left_out(content: Mapping[str, Any]) -> str:
    """Return a sentence about markers that were left out on purpose; empty if none was."""
    left_out = content.get("settings", {}).get("left_out")
    if not isinstance(left_out, dict) or not left_out:
        return ""
    said = ", ".join(f"{name} ({why})" for name, why in left_out.items())
    return message(f"Skipped on purpose: {arg(said)}: contacts there are not verified.")


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
        "diagnosis": join(" ", words)[:_LONGEST],
    }
