"""From a runtime config to what a controller is made of, and its settings as a bundle holds them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.config.runtime.model import ControllerPart, LimitsPart
from contactbench.pipeline.config.runtime.values import touch_model_of
from contactbench.pipeline.contact.noise import WrenchNoise
from contactbench.pipeline.control.command import SensorMount
from contactbench.pipeline.control.intake import SampleIntake
from contactbench.pipeline.control.settings import ControlSettings, Variant
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.gates import Gates

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from contactbench.pipeline.config.runtime.config import RuntimeConfig


def intake_of(config: RuntimeConfig, settings: ControlSettings, method: str = "contactbench") -> SampleIntake:
    """
    Return what a bundle says of its sensor: gravity and bias, noise of a reading, gates, touch model.

    The bundle's filters are left out: a controller takes the mean of the readings of a period, and what a slow filter
    holds back is lost to its loops.

    Raises
    ------
    InputError
        There is no such method.
    """
    noise = WrenchNoise(config.model.noise.force_N, config.model.noise.torque_Nm)
    model = touch_model_of(config.model.touch)
    # Odds stand with the regions: of the first of either kind all others follow.
    odds = {region.untouchable: region.odds for region in reversed(config.model.regions)}
    others = {"region_odds": odds[False]} if False in odds else {}
    if True in odds:
        others["untouchable_odds"] = 1 / odds[True]
    gates = Gates.of_stored(config.model.gates, **others)
    return SampleIntake(
        config.probe, config.gravity, noise, gates, model, method=method, stale=settings.stale
    )


def mount_of(config: RuntimeConfig, p_ES_E: ArrayLike, quaternion_ES: ArrayLike | None = None) -> SensorMount:
    """
    Return how the sensor sits on the flange.

    Parameters
    ----------
    p_ES_E : (3,)
        m; a bundle does not know it.
    quaternion_ES : (4,), optional
        w, x, y, z; for a bundle that does not say.

    Raises
    ------
    InputError
        Neither says, or they contradict each other.
    """
    told = config.model.frames.quaternion_ES
    given = None if quaternion_ES is None else np.asarray(quaternion_ES, dtype=np.float64)
    if told is None and given is None:
        raise InputError(
            "bundle: frames.quaternion_ES is null because its orientations were the sensor's own:"
            " give the rotation of the sensor on the flange."
        )
    if told is not None and given is not None and abs(float(np.dot(told, given))) < 1 - 1e-6:
        raise InputError(
            f"bundle: frames.quaternion_ES is {arg(told)}, but {arg(given.tolist())} was given: leave it"
            " out, or recalibrate."
        )
    quaternion = given if told is None else np.array(told)
    R_ES = Rotation.from_quat(np.asarray(quaternion), scalar_first=True).as_matrix()
    return SensorMount(R_ES, np.asarray(p_ES_E, dtype=np.float64))


# ---- settings -------------------------------------------------------------------------------------

# Parts of a bundle's controller, their fields, and those of the settings; of a pair, with the place in it.
_FIELDS: dict[str, dict[str, str | tuple[str, int]]] = {
    "": {
        "variant": "variant",
        "desired_force_N": "desired_force",
        "period_s": "period",
        "servo_lag_s": "servo_lag",
    },
    "force": {
        "mass_kg": "force_mass",
        "damping_Nspm": "force_damping",
        "stiffness_Npm": "force_stiffness",
        "gain_per_s": "force_gain",
    },
    "angle": {
        "inertia": "angle_inertia",
        "damping": "angle_damping",
        "stiffness": "angle_stiffness",
        "gain_per_s": "angle_gains",
        "settling_s": "settling",
    },
    "lead": {
        "bandwidth_per_s": "bandwidth",
        "smoothing_s": "smoothing",
        "lean_rad": ("lean", 0),
        "lean_s": ("lean", 1),
    },
    "touch": {
        "approach_speed_mps": "approach_speed",
        "approach_travel_m": "approach_travel",
        "retract_speed_mps": "retract_speed",
        "retract_travel_m": "retract_travel",
        "touch_force_N": "touch_force",
        "low_force_N": "low_force",
        "ramp_s": "ramp",
        "probing_m": "probing",
        "attempts": "attempts",
    },
    "tool": {
        "left_force_N": ("calibration_sigma", 0),
        "left_torque_Nm": ("calibration_sigma", 1),
        "taring_s": "taring",
        "gyration_m": "gyration",
    },
    "watch": {
        "stale_s": "stale",
        "give_up_s": "give_up",
        "following_s": "following",
        "max_tilt_rad": "max_tilt",
    },
}


def settings_of(
    controller: ControllerPart | None, limits: LimitsPart, base: ControlSettings | None = None
) -> ControlSettings:
    """
    Return the settings of a bundle; `base` is for what it leaves open.

    Its limits always count. Without a controller all else is as in `base`; with one, only speeds without a limit are.

    Raises
    ------
    InputError
        They contradict each other.
    """
    base = base or ControlSettings()
    return replace(
        base,
        max_force=limits.max_force_N,
        max_torque=limits.max_torque_Nm,
        max_speed=limits.max_speed_mps or base.max_speed,
        max_turn=limits.max_turn_radps or base.max_turn,
        **({} if controller is None else _values(controller)),
    )


def controller_of(settings: ControlSettings) -> ControllerPart:
    """Return what a bundle holds of settings, beside their limits."""

    def plain(field: str | tuple[str, int]) -> Any:
        if isinstance(field, tuple):
            return getattr(settings, field[0])[field[1]]
        value = getattr(settings, field)
        return list(value) if isinstance(value, tuple) else getattr(value, "value", value)

    parts = {part: {name: plain(field) for name, field in given.items()} for part, given in _FIELDS.items()}
    return ControllerPart.model_validate(parts.pop("") | parts)


def limits_of(settings: ControlSettings) -> LimitsPart:
    """Return the limits of settings."""
    return LimitsPart(
        max_force_N=settings.max_force,
        max_torque_Nm=settings.max_torque,
        max_speed_mps=settings.max_speed,
        max_turn_radps=settings.max_turn,
    )


def _values(controller: ControllerPart) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for part, given in _FIELDS.items():
        holder = getattr(controller, part) if part else controller
        for name, field in given.items():
            value = getattr(holder, name)
            if isinstance(field, tuple):
                found[field[0]] = (*found.get(field[0], ()), value)
            else:
                found[field] = tuple(value) if isinstance(value, list) else value
    return found | {"variant": Variant(controller.variant)}
