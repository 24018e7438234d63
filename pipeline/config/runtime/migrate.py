"""Configs of older versions: what each step to the next version changes."""

import json
from collections.abc import Callable
from typing import Any

from contactbench.pipeline.config.runtime.model import VERSION
from contactbench.pipeline.errors import ConfigError, arg, message

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
