"""Settings of a controller as a bundle holds them, and back."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.config.runtime.model import (
    AngleGainsPart,
    ControllerPart,
    ForceGainsPart,
    LeadPart,
    LimitsPart,
    ToolPart,
    TouchPart,
    WatchPart,
)
from contactbench.pipeline.control.settings import ControlSettings, Variant

if TYPE_CHECKING:
    from collections.abc import Sequence


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
    return ControllerPart(
        variant=settings.variant.value,
        desired_force_N=settings.desired_force,
        period_s=settings.period,
        servo_lag_s=settings.servo_lag,
        force=ForceGainsPart(
            mass_kg=settings.force_mass,
            damping_Nspm=settings.force_damping,
            stiffness_Npm=settings.force_stiffness,
            gain_per_s=settings.force_gain,
        ),
        angle=AngleGainsPart(
            inertia=list(settings.angle_inertia),
            damping=list(settings.angle_damping),
            stiffness=list(settings.angle_stiffness),
            gain_per_s=list(settings.angle_gains),
            settling_s=settings.settling,
        ),
        lead=LeadPart(
            bandwidth_per_s=list(settings.bandwidth),
            smoothing_s=settings.smoothing,
            lean_rad=settings.lean[0],
            lean_s=settings.lean[1],
        ),
        touch=TouchPart(
            approach_speed_mps=settings.approach_speed,
            approach_travel_m=settings.approach_travel,
            retract_speed_mps=settings.retract_speed,
            retract_travel_m=settings.retract_travel,
            touch_force_N=settings.touch_force,
            low_force_N=settings.low_force,
            ramp_s=settings.ramp,
            probing_m=settings.probing,
            attempts=settings.attempts,
        ),
        tool=ToolPart(
            left_force_N=settings.calibration_sigma[0],
            left_torque_Nm=settings.calibration_sigma[1],
            taring_s=settings.taring,
            gyration_m=settings.gyration,
        ),
        watch=WatchPart(
            stale_s=settings.stale,
            give_up_s=settings.give_up,
            following_s=settings.following,
            max_tilt_rad=settings.max_tilt,
        ),
    )


def limits_of(settings: ControlSettings) -> LimitsPart:
    """Return the limits of settings."""
    return LimitsPart(
        max_force_N=settings.max_force,
        max_torque_Nm=settings.max_torque,
        max_speed_mps=settings.max_speed,
        max_turn_radps=settings.max_turn,
    )


def _values(part: ControllerPart) -> dict[str, Any]:
    force, angle, lead = part.force, part.angle, part.lead
    touch, tool, watch = part.touch, part.tool, part.watch
    return {
        "variant": Variant(part.variant),
        "desired_force": part.desired_force_N,
        "period": part.period_s,
        "servo_lag": part.servo_lag_s,
        "force_mass": force.mass_kg,
        "force_damping": force.damping_Nspm,
        "force_stiffness": force.stiffness_Npm,
        "force_gain": force.gain_per_s,
        "angle_inertia": _pair(angle.inertia),
        "angle_damping": _pair(angle.damping),
        "angle_stiffness": _pair(angle.stiffness),
        "angle_gains": _pair(angle.gain_per_s),
        "settling": angle.settling_s,
        "bandwidth": tuple(lead.bandwidth_per_s),
        "smoothing": lead.smoothing_s,
        "lean": (lead.lean_rad, lead.lean_s),
        "approach_speed": touch.approach_speed_mps,
        "approach_travel": touch.approach_travel_m,
        "retract_speed": touch.retract_speed_mps,
        "retract_travel": touch.retract_travel_m,
        "touch_force": touch.touch_force_N,
        "low_force": touch.low_force_N,
        "ramp": touch.ramp_s,
        "probing": touch.probing_m,
        "attempts": touch.attempts,
        "calibration_sigma": (tool.left_force_N, tool.left_torque_Nm),
        "taring": tool.taring_s,
        "gyration": tool.gyration_m,
        "stale": watch.stale_s,
        "give_up": watch.give_up_s,
        "following": watch.following_s,
        "max_tilt": watch.max_tilt_rad,
    }


def _pair(values: Sequence[float]) -> tuple[float, float]:
    return values[0], values[1]
