"""
JSON with one spelling, a reader that takes nothing ambiguous, and what changed since older versions.

Canonical: UTF-8, keys in the order of their code points, no spaces, numbers as Python's ``repr`` writes them (the
shortest digits that read back as the same double), one line feed at the end. The same content gives the same bytes.
"""

import json
from collections.abc import Callable, Mapping
from typing import Any

from pydantic import ValidationError

from contactbench.pipeline.config.runtime.model import SCHEMA, VERSION, RuntimeModel
from contactbench.pipeline.errors import ConfigError, arg, message
from contactbench.pipeline.files import not_of_kind

_OLD_FORCE, _OLD_ANGLE = ("mass_kg", "damping_Nspm", "stiffness_Npm"), ("inertia", "damping", "stiffness")
_OLD_GAINS = {"desired_force_N", *(f"force_{n}" for n in _OLD_FORCE), *(f"angle_{n}" for n in _OLD_ANGLE)}


# What versions 1 and 2 left open, as contactbench took it by itself when the next came. The C++ loader has the same.
_CONTROLLER = (
    '{"variant":"aware","desired_force_N":0,"period_s":0.02,"servo_lag_s":0.0,'
    '"force":{"mass_kg":0,"damping_Nspm":0,"stiffness_Npm":0,"gain_per_s":6.0},'
    '"angle":{"inertia":[0,0],"damping":[0,0],"stiffness":[0,0],"gain_per_s":[6.0,6.0],"settling_s":0.04},'
    '"lead":{"bandwidth_per_s":[20.0,13.0,13.0],"smoothing_s":0.08,"lean_rad":0.025,"lean_s":0.8},'
    '"touch":{"approach_speed_mps":0.006,"approach_travel_m":0.05,"retract_speed_mps":0.06,'
    '"retract_travel_m":0.03,"touch_force_N":0.7,"low_force_N":0.7,"ramp_s":0.5,"probing_m":0.00015,"attempts":3},'
    '"tool":{"left_force_N":0.01,"left_torque_Nm":0.0005,"taring_s":0.5,"gyration_m":0.035},'
    '"watch":{"stale_s":0.06,"give_up_s":0.2,"following_s":0.05,"max_tilt_rad":0.5}}'
)
_PARTS = (
    '{"touch":{"torsion_arm_m":0.001,"model_error":{"force_N":[0.05,0.05,0.05],"torque_Nm":[0.001,0.001,0.001],'
    '"measured":false},"mesh_deviation_m":0.0,"mesh_curved":true},'
    '"streams":{"pose_gap_s":0.25,"pose_ahead_s":0.15,"silence_s":0.12,"frozen_probability":1e-10,"motion":null},'
    '"self_test":null}'
)
_GATES = (
    '{"implausible_misfit":10.827566170662935,"rival_odds":100.0,"first_odds":7.38905609893065,'
    '"follow_odds":1000.0,"accept_by_region":true}'
)
_REMEDY = message("export the config again.")
_LONGEST = 60


def encode_json(content: Mapping[str, Any]) -> bytes:
    """
    Write a JSON object in its one spelling.

    Raises
    ------
    ConfigError
        A number is not finite, or a text is no Unicode.
    """
    try:
        return _spelled(content)
    except ValueError as error:
        raise ConfigError(f"the config cannot be written ({arg(error)}): {arg(_REMEDY)}") from error


def decode_json(data: bytes, name: str) -> tuple[RuntimeModel, int]:
    """
    Read a config of this version or an older one; returns the version, too, in which it was written.

    Parameters
    ----------
    data : bytes
    name : str
        What messages call it.

    Raises
    ------
    ConfigError
        It is no JSON object in its one spelling, is of another kind or a newer version, or a field is missing,
        unknown, of the wrong type or out of range.
    """
    written = _checked_kind(_parse(data, name), name)
    try:
        return RuntimeModel.model_validate(migrated(written, name)), written["version"]
    except ValidationError as error:
        raise ConfigError(f"{arg(name)}: {arg(fault_of(error))}: {arg(_REMEDY)}") from None


def json_schema() -> bytes:
    """Return the JSON Schema of a config, as it is checked in."""
    schema = RuntimeModel.model_json_schema(by_alias=True)
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "$id": f"{SCHEMA}.{VERSION}"}
    return (json.dumps({**head, **schema}, indent=1, sort_keys=True, ensure_ascii=False) + "\n").encode()


def first_difference(one: bytes, other: bytes) -> int:
    """Return the place of the first byte in which two texts differ; the shorter one's end if that is all."""
    pairs = enumerate(zip(one, other, strict=False))
    return next((place for place, (a, b) in pairs if a != b), min(len(one), len(other)))


def fault_of(error: ValidationError) -> str:
    """Return the first thing that a schema found wrong: the field, the value, and why."""
    fault = error.errors(include_url=False, include_context=False)[0]
    where = ".".join(str(part) for part in fault["loc"]) or message("the content")
    value = fault["input"]
    shown = (
        "" if isinstance(value, dict | list) or fault["type"] == "missing" else f" is {value!a:.{_LONGEST}}"
    )
    return message(f"{arg(where)}{arg(shown)}: {arg(fault['msg'])}")


def _parse(data: bytes, name: str) -> dict[str, Any]:
    try:
        content = json.loads(data.decode())
        spelled = _spelled(content)
    except (ValueError, RecursionError) as error:
        raise ConfigError(f"{arg(name)}: not valid JSON ({arg(str(error)[:200])}): {arg(_REMEDY)}") from None
    if not isinstance(content, dict):
        raise ConfigError(f"{arg(name)}: not a JSON object: {arg(_REMEDY)}")
    # Readers differ in what they make of a key that occurs twice, of 1e999 or of a byte after the end.
    if spelled != data:
        raise ConfigError(
            f"{arg(name)}: byte {arg(first_difference(data, spelled))} differs from what contactbench writes"
            " (a space, a duplicate or misplaced key, or another spelling of a number or a text):"
            f" {arg(_REMEDY)}"
        )
    return content


def _spelled(content: object) -> bytes:
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return (text + "\n").encode()


def _checked_kind(content: dict[str, Any], name: str) -> dict[str, Any]:
    if why := not_of_kind(content, SCHEMA, VERSION, message("a runtime config")):
        raise ConfigError(f"{arg(name)}: {arg(why)}")
    version = content.get("version")
    if isinstance(version, bool) or not isinstance(version, int):
        raise ConfigError(
            f"{arg(name)}: version is {arg(ascii(version)[:_LONGEST])}, not a whole number: {arg(_REMEDY)}"
        )
    return content


def _from_1(content: dict[str, Any]) -> dict[str, Any]:
    """Version 1 had one gain for both turns, and left the rest of the controller to who read it."""
    old = content["controller"]
    if old is None:
        return content
    if set(old) != _OLD_GAINS:
        raise ValueError(message(f"controller: not the fields {arg(', '.join(sorted(_OLD_GAINS)))}"))
    new = json.loads(_CONTROLLER)
    new["desired_force_N"] = old["desired_force_N"]
    new["force"] |= {name: old[f"force_{name}"] for name in _OLD_FORCE}
    new["angle"] |= {name: [old[f"angle_{name}"]] * 2 for name in _OLD_ANGLE}
    return {**content, "controller": new}


_DOUBT = message(
    "Bundles before version 3 were verified with other rules, which are gone: verify and export again."
)
_REGION_ODDS = (1000.0, 100.0, 10.0)  # by rank; the last for all that follow


def _from_2(content: dict[str, Any]) -> dict[str, Any]:
    """Version 2 ranked, and verified, by rules: the ratio of torques, rivals in sigmas, any region before none."""
    gates, parts, new_gates = dict(content["gates"]), json.loads(_PARTS), json.loads(_GATES)
    del gates["torque_ratio"], gates["rival_sigmas"]
    regions, new = [dict(region) for region in content["regions"]], {"odds", "untouchable"}
    if (
        parts.keys() & content.keys()
        or new_gates.keys() & gates.keys()
        or any(new & each.keys() for each in regions)
    ):
        raise ValueError(message("touch, streams, self_test, gates or regions: fields of version 3"))
    for index, region in enumerate(regions):
        region |= {"odds": _REGION_ODDS[min(index, len(_REGION_ODDS) - 1)], "untouchable": False}
    provenance = {**content["provenance"], "stale": content["provenance"]["stale"] + [_DOUBT]}
    parts |= {"gates": gates | new_gates, "regions": regions, "provenance": provenance, "verified": False}
    return {**content, **parts}


def _from_3(content: dict[str, Any]) -> dict[str, Any]:
    """Version 3 took -z of W for down, and held neither the age of the zero nor checks."""
    frames, noise = content["frames"], content["noise"]
    if frames["world"] != "W, z up":
        raise ValueError(message(f"frames.world is {arg(repr(frames['world'])[:40])}, not 'W, z up'"))
    if {"world", "zero", "checks"} & content.keys() or "orientation_rad" in noise:
        raise ValueError(message("world, zero, checks or noise.orientation_rad: fields of version 4"))
    return {
        **content,
        "frames": {**frames, "world": "W"},
        "world": {"down_W": [0.0, 0.0, -1.0]},
        "noise": {**noise, "orientation_rad": None},
        "zero": {"measured": None, "drift": None},
        "checks": {"known_weight": None, "known_touch": None},
    }


# Version -> what turns its JSON object into one of the next version. Version 1 is the first.
STEPS: dict[int, Callable[[dict[str, Any]], dict[str, Any]]] = {1: _from_1, 2: _from_2, 3: _from_3}


def migrated(content: dict[str, Any], name: str) -> dict[str, Any]:
    """
    Return a JSON object of the present version.

    Parameters
    ----------
    content : dict
        Of this version or an older one; its version is a whole number.
    name : str
        What messages call it.

    Raises
    ------
    ConfigError
        There never was such a version, or its content cannot be carried over.
    """
    while content["version"] < VERSION:
        version = content["version"]
        step = STEPS.get(version)
        if step is None:
            raise ConfigError(f"{arg(name)}: there is no version {arg(version)}: export the config again.")
        try:
            content = {**step(content), "version": version + 1}
        except (KeyError, TypeError, ValueError) as error:
            raise ConfigError(
                f"{arg(name)}: this config of version {arg(version)} cannot be migrated ({arg(repr(error)[:100])}):"
                " export it again."
            ) from error
    return content
