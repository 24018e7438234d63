"""What a controller is told: wanted force, gains, speeds and limits."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.control.foundation import USUAL_MODULUS
from contactbench.pipeline.errors import InputError, arg

if TYPE_CHECKING:
    from contactbench.pipeline.control.foundation import Foundation

USUAL_STIFFNESS = 2000.0  # N/m, of a convex probe at 7 N on soft tissue
_SETTLING_S = 0.04
_STIFFEST = 5.0  # times the usual modulus
_STOPPING_S, _TOUCH_SHARE, _FASTEST_APPROACH = 0.05, 0.6, 0.01
USUAL_GAIN = 6.0  # 1/s, of force and angle: the paper's figures follow from about this


TOOL_KG, TO_TIP_M = 0.45, 0.08  # a usual tool, and how far its centre of mass is from its tip
LEFT = 0.35  # share of its inertia that compensation leaves, measured in `PlatformScene`
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
    # approach_speed, retract_speed: m/s
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
