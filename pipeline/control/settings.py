"""What a controller is told: wanted force, gains, speeds and limits."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from contactbench.pipeline.config.runtime.config import RuntimeConfig
from contactbench.pipeline.config.runtime.model import ControllerPart, LimitsPart
from contactbench.pipeline.config.runtime.values import touch_model_of
from contactbench.pipeline.contact.patch import FACE_DEPTH_M, spread
from contactbench.pipeline.contact.touch_model import WrenchNoise
from contactbench.pipeline.control.intake import SampleIntake
from contactbench.pipeline.control.states import SensorMount
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.mesh import Probe

_PLACES = 1500
_DEPTHS = 400
USUAL_MODULUS = 3e6  # N/m³


@dataclass(frozen=True)
class FacePress:
    """
    One press.

    Attributes
    ----------
    depth : float
        m.
    stiffness : float
        N/m, change of force with depth.
    gain_x, gain_y : float
        How far the contact moves along S's x and y for each rad that the tissue is tilted, m/rad.
    x, y : float
        Where the contact is in S while the tissue is not tilted, m.
    """

    depth: float
    stiffness: float
    gain_x: float
    gain_y: float
    x: float
    y: float


class Foundation:
    """
    A probe's face on a bed of springs of one modulus E (N/m³): force E A(d), stiffness E A'(d) at a depth d.

    With the modulus and the force, all else is known from the shape: the depth, the stiffness, and how far the contact
    moves when the tissue tilts: for a tilt t about y each place at x is deeper by x t, which moves the centroid by
    t sum(x (x - mean)) / A(d) over the places in contact.

    Parameters
    ----------
    probe : Probe
        In S, its face towards +z.

    Attributes
    ----------
    height : float
        Of the probe's tip in S, m.

    Raises
    ------
    InputError
        Nothing of the probe faces +z.
    """

    def __init__(self, probe: Probe) -> None:
        places, _, area = spread(probe, _PLACES)
        high = float(probe.vertices[:, 2].max())
        self._depths = np.linspace(FACE_DEPTH_M / _DEPTHS, FACE_DEPTH_M * 0.98, _DEPTHS)
        deep = np.maximum(self._depths[:, None] - (high - places[:, 2])[None], 0.0)  # (depths, places)
        inside = deep > 0
        count = np.maximum(inside.sum(axis=1), 1)
        self._force = np.maximum(deep.sum(axis=1) * area, 1e-15)  # A(d), m³
        self._slope = count * area  # A'(d), m²
        gains, means = [], []
        for x in (places[:, 0], places[:, 1]):
            weighted = deep @ x / np.maximum(deep.sum(axis=1), 1e-15)
            means.append(weighted)
            gains.append((inside @ (x * x) - (inside @ x) * weighted) * area / self._force)
        self._gains = np.maximum(np.array(gains), 1e-5)
        # One row per depth: all that a press is made of is found with one look into the table.
        self._rows = np.column_stack([self._depths, self._slope, self._gains.T, np.array(means).T])
        self._numbers = np.arange(float(_DEPTHS))
        self.height = high

    def at(self, force: float, modulus: float) -> FacePress:
        """Return the press of a force, N, on tissue of a modulus, N/m³; beyond 12 mm that of 12 mm."""
        place = float(np.interp(force / modulus, self._force, self._numbers))
        first = min(int(place), _DEPTHS - 2)
        share = place - first
        found = (1 - share) * self._rows[first] + share * self._rows[first + 1]
        depth, slope, gain_x, gain_y, x, y = found.tolist()
        return FacePress(depth, modulus * slope, gain_x, gain_y, x, y)

    def modulus_of(self, force: float, stiffness: float) -> float:
        """Return the modulus, N/m³, that gives a stiffness, N/m, at a force, N; the nearest that the table has."""
        # At each depth a force stands for one modulus, and that for one stiffness, which falls with the depth.
        moduli = force / self._force
        stiffnesses = moduli * self._slope
        order = np.argsort(stiffnesses, kind="stable")
        return float(np.interp(stiffness, stiffnesses[order], moduli[order]))


USUAL_STIFFNESS = 2000.0  # N/m, of a convex probe at 7 N on soft tissue
_SETTLING_S = 0.04
_STIFFEST = 5.0  # times the usual modulus
_STOPPING_S, _TOUCH_SHARE, _FASTEST_APPROACH = 0.05, 0.6, 0.01
USUAL_GAIN = 6.0  # 1/s, of force and angle: the paper's figures follow from about this


TOOL_KG, TO_TIP_M = 0.45, 0.08  # a usual tool, and how far its centre of mass is from its tip
LEFT = 0.35  # share of its inertia that compensation leaves, measured in `PlatformScene`
# N/m per kg of tool: on softer tissue its own inertia looks like more depth than the force loop bears at full speed.
_STIFF_PER_KG = 2000.0
_HEAVY = 0.05  # kg·m, mass times lever: up to there the usual turns leave twice the gain


class Variant(StrEnum):
    """How the tissue's motion is met."""

    PLAIN = "plain"  # Eq. 7 and 8 alone: what moves steadily is followed behind
    AWARE = "aware"  # the tissue's motion is estimated and led


@dataclass(frozen=True)
class ControlSettings:
    """
    All that a controller needs beside a probe, an arm and a calibration.

    Raises
    ------
    InputError
        A number is out of range.
    """

    desired_force: float = 7.0  # N
    # force_mass, force_damping, force_stiffness: of Eq. 7: kg, N·s/m, N/m. A tissue of k N/m is followed
    # with a gain of k / damping, per s.
    force_mass: float = 13.0
    force_damping: float = USUAL_STIFFNESS / USUAL_GAIN
    force_stiffness: float = 0.0
    # angle_inertia, angle_damping, angle_stiffness: (about x, about y) of Eq. 8, with the torque
    # ``desired_force`` times the contact's offset: kg·m², N·m·s/rad, N·m/rad.
    angle_inertia: tuple[float, float] = (0.0003, 0.0027)
    angle_damping: tuple[float, float] = (0.0075, 0.067)
    angle_stiffness: tuple[float, float] = (0.0, 0.0)
    period: float = 0.02  # s between set-points
    servo_lag: float = 0.0  # how much later than its set-point the arm is there, s
    max_force: float = 30.0  # N that must never be passed; the probe is drawn back from 80 % of it on
    # max_speed, max_turn: of the tip, m/s and rad/s
    max_speed: float = 0.1
    max_turn: float = 1.0
    # approach_speed, retract_speed: m/s; what presses harder than wanted is left at `max_speed`
    approach_speed: float = 0.006
    retract_speed: float = 0.06
    # approach_travel, retract_travel: m: so far it looks for tissue, and so far it goes back
    approach_travel: float = 0.05
    retract_travel: float = 0.03
    # touch_force, low_force: N: above the first it has met tissue, below the second it has lost it
    touch_force: float = 0.7
    low_force: float = 0.7
    ramp: float = 0.5  # s in which the wanted force grows at first touch
    # s without a fresh sample after which nothing moves any more; after `give_up` it goes back the way it
    # came
    stale: float = 0.06
    give_up: float = 0.2  # s
    attempts: int = 3  # how often it approaches again after tissue was lost
    # m, the small press by which the stiffness is measured before tracking; 0: not at all
    probing: float = 0.00015
    variant: Variant = Variant.AWARE
    # (place, tilt about x, tilt about y) 1/s, of the estimate of the tissue's motion. Of the tilt about x,
    # out of plane, the contact's place tells little on a narrow face.
    bandwidth: tuple[float, float, float] = (20.0, 13.0, 13.0)
    # s, time constant of the turns that the aware variant leads by: they shake the tool, and the sensor
    # feels that
    smoothing: float = 0.08
    # (rad, s) what friction does to the direction of the tissue's force, and for how long: see `Tilt`
    lean: tuple[float, float] = (0.025, 0.8)
    # (N, N·m) what is left of a sensor's bias after gravity and `taring`
    calibration_sigma: tuple[float, float] = (0.01, 0.0005)
    # s that it waits in the air and takes off what the sensor still reads; 0: not at all
    taring: float = 0.5
    # m, radius of gyration of the tool about its centre of mass, from its drawing: a tool of 0.45 kg needs
    # it to a third. 0: what turning it takes is left out.
    gyration: float = 0.035
    # s, by how much an arm may be late at the largest speeds before it counts as not following
    following: float = 0.05
    # rad, between the probe's axis and the one that it began with; beyond it the probe goes back. What
    # turns it so far is no tissue but a place that is wrong: a bias on a narrow face, or an edge.
    max_tilt: float = 0.5
    max_torque: float = 6.0  # N·m about the sensor's origin that must never be passed; as `max_force`
    # s, mass over damping of the aware variant's turns: it gets its tilt from more than the place, and
    # needs less
    settling: float = _SETTLING_S
    # (about x, about y) 1/s, how fast the aware variant turns towards what it knows
    angle_gains: tuple[float, float] = (6.0, 6.0)
    force_gain: float = 6.0  # 1/s, how fast it goes towards the wanted force

    def __post_init__(self) -> None:
        try:
            object.__setattr__(self, "variant", Variant(self.variant))
        except ValueError:
            raise InputError(
                f"control settings: variant is {arg(self.variant)!s:.40}: give one of {arg(', '.join(Variant))}."
            ) from None
        for each in fields(self):
            value = getattr(self, each.name)
            numbers = np.atleast_1d(value) if not isinstance(value, str) else np.ones(1)
            low_ok = numbers >= 0 if each.name in _MAY_BE_ZERO else numbers > 0
            if not (np.isfinite(numbers).all() and low_ok.all()):
                raise InputError(
                    f"control settings: {arg(each.name)} is {arg(value)}: give positive, finite numbers."
                )
        if not self.touch_force < self.desired_force < 0.8 * self.max_force:
            raise InputError(
                f"control settings: the wanted force of {arg(self.desired_force):g} N must be above"
                f" {arg(self.touch_force):g} N and below 80 % of the limit of {arg(self.max_force):g} N:"
                " change one of them."
            )
        if self.max_tilt >= math.pi / 2:
            raise InputError(
                f"control settings: max_tilt is {arg(self.max_tilt):g} rad: give less than a quarter turn, 1.57."
            )

    @classmethod
    def for_probe(
        cls,
        foundation: Foundation,
        *,
        desired_force: float = 7.0,
        modulus: float = USUAL_MODULUS,
        force_gain: float = USUAL_GAIN,
        angle_gains: tuple[float, float] = (USUAL_GAIN, USUAL_GAIN),
    ) -> ControlSettings:
        """
        Return the defaults for a probe: what it does to the loops' gains is taken out by the damping.

        Where Eq. 7 turns a force into a speed, tissue of k N/m turns a path into a force: the loop's gain is
        k / damping. Of Eq. 8 it is desired force times the place's change per rad over the damping. A narrow face
        gets less gain and more mass than wanted in the plain variant: what is left of the tool's own inertia looks
        like a contact far off, and would shake it (see `margins`).

        Parameters
        ----------
        foundation : Foundation
            Of the probe.
        desired_force : float
            N.
        modulus : float
            Of the tissue that the gains are meant for, N/m³; others get others, as `margins` shows.
        force_gain : float
            1/s.
        angle_gains : (about x, about y)
            1/s.

        Raises
        ------
        InputError
            A number is out of range.
        """
        press = foundation.at(desired_force, modulus)
        damping = press.stiffness / force_gain
        about = [
            _turning(desired_force, gain, wanted)
            for gain, wanted in zip((press.gain_y, press.gain_x), angle_gains, strict=True)
        ]
        stiffest = _STIFFEST * press.stiffness
        return cls(
            desired_force=desired_force,
            # What comes in the time that it takes to stop must not be the wanted force already.
            approach_speed=min(_FASTEST_APPROACH, _TOUCH_SHARE * desired_force / (stiffest * _STOPPING_S)),
            force_mass=damping * _SETTLING_S,
            force_damping=damping,
            force_gain=force_gain,
            angle_inertia=(about[0][0], about[1][0]),
            angle_damping=(about[0][1], about[1][1]),
            angle_gains=angle_gains,
        )


def for_tool(settings: ControlSettings, mass: float, lever: float) -> ControlSettings:
    """
    Slow the aware variant's turns down for a heavy tool.

    What compensation leaves of a tool's inertia leans the force against the turn: m l a / f for an acceleration a,
    and a controller that takes that for a tilt drives itself. How much of it a loop bears goes with the square of its
    time: gain, lead, smoothing and settling become slower together.

    Parameters
    ----------
    mass : float
        kg.
    lever : float
        From its centre of mass to the tip, m.
    """
    slower = math.sqrt(mass * abs(lever) / _HEAVY * ControlSettings.desired_force / settings.desired_force)
    if slower <= 1:
        return settings
    place, about_x, about_y = settings.bandwidth
    return replace(
        settings,
        angle_gains=(settings.angle_gains[0] / slower, settings.angle_gains[1] / slower),
        bandwidth=(place, about_x / slower, about_y / slower),
        smoothing=settings.smoothing * slower,
        settling=settings.settling * slower,
    )


def calm_on(stiffness: float, mass: float) -> float:
    """Return the share of the aware force loop's speed on N/m with a tool of kg: less on what is soft for it."""
    return min(1.0, math.sqrt(stiffness / (_STIFF_PER_KG * mass)))


def _turning(force: float, gain: float, wanted: float) -> tuple[float, float]:
    """Return inertia and damping of Eq. 8 about one axis, for a gain of the place, m/rad, and of the loop, 1/s."""
    # At the highest frequency, where it alternates, the loop's gain is K J / settling: it may be a third.
    felt = 3 * LEFT * TOOL_KG * TO_TIP_M**2 / (gain * force)
    # A quarter of the phase at the crossover may go to the settling.
    loop = min(wanted, math.sqrt(0.25 / felt))
    damping = force * gain / loop
    return damping * max(_SETTLING_S, loop * felt), damping


_MAY_BE_ZERO = {
    "force_stiffness",
    "angle_stiffness",
    "servo_lag",
    "probing",
    "attempts",
    "taring",
    "gyration",
}


# ---- from a runtime config to what a controller is made of ---------------------------------------


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
    return found
