"""
What a controller does, and when it does something else.

====================  =======================================================================================
approach              goes along the probe's axis until it meets tissue, no farther than it may
contact               the wanted force grows; then one small press measures how stiff the tissue is
track                 keeps the force and stays upright
hold                  stands still: the readings are not to be believed, or the place is lost
retract               goes back the way it came
safe                  stands still for good, away from the tissue; the end
====================  =======================================================================================

==========================================  ====================  ==================================================
what happens                                in                    what follows
==========================================  ====================  ==================================================
saturation                                  any but safe          retract
no fresh sample for `stale` s, or stuck     approach to track     hold; after `give_up` s retract
... and tissue that moves                   hold                  retract before it could have pressed to 80 %
fresh samples again                         hold                  contact, or track again, if it touches; else approach
force off by 2 N of 7 for 0.3 s             track                 it says so: `swinging`, with nothing led any more,
                                                                  or `degraded`
force swings, whatever the gain             track                 hold for 0.3 s, then contact: the stiffness is
                                                                  measured anew; after `attempts` retract
force over `touch_force`                    approach              contact
farther than `approach_travel`              approach              retract
wanted force reached                        contact               track
force under `low_force` for 0.1 s           contact, track        approach again; after `attempts` of them retract;
                                                                  in contact only under half of `touch_force`
place of contact lost for 0.3 s             track                 it no longer turns, and keeps the force
... for 2 s                                 track                 retract
joint limit or singularity for 0.3 s        approach to track     retract
arm not where it was sent for 0.06 s        approach to track     hold, and on from there; after `attempts` retract
poses late by `following` for 0.2 s         approach to track     retract
clock that goes back                        approach to track     as no fresh sample
force or torque from any side over 80 %     any but safe          retract
... or over the limit within 0.08 s         any but safe          retract
force 50 % over the wanted one              hold                  retract
turned by `max_tilt` from the first axis    contact, track        retract
stopped                                     any but safe          retract
gone back, nothing touches                  retract               safe
==========================================  ====================  ==================================================

To go back is the one motion that needs no fresh sample: the probe came that way, and nothing was there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.control.intake import Sensed, SensingFault
from contactbench.pipeline.control.inverse import JointStep, MotionLimit
from contactbench.pipeline.errors import InputError, arg, message

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.control.settings import ControlSettings

_LOW_S, _LOST_S, _GIVEN_UP_S, _STOPPED_S, _LATE_S = 0.1, 0.3, 2.0, 0.3, 0.05
_YET = 0.5  # of the force that counted as a touch
_NEAR, _STEADY_S = 0.15, 0.2  # of the wanted force, and for how long, before tracking
_ALARM = 0.8  # of the largest force
# s until a retreat is under way: readings are 10 ms old, a set-point takes 20 ms to be reached, and to turn round takes
# as much again.
_REACTION_S = 0.08
_PRESSED = 1.5  # of the wanted force: who stands still does not give in
_BAND = 2 / 7  # of the wanted force: a force that is farther off strays
# Time constant, s, of the share of time that it strayed; shares from which that is said, and is over.
_STRAY_S, _STRAYED, _BACK = 0.3, 0.6, 0.2
_REST_S = 0.3  # that it stands still after a swing: what is pressed comes to rest
_DELAYED_S = 0.2
_LITTLE = 0.5  # of a step: less is no going on


class ControlState(StrEnum):
    """What the controller does."""

    APPROACH = "approach"
    CONTACT = "contact"
    TRACK = "track"
    HOLD = "hold"
    RETRACT = "retract"
    SAFE = "safe"


@dataclass(frozen=True)
class StateChange:
    """A change of state: when (s), from and to what, and why, in a sentence."""

    time: float
    before: ControlState
    after: ControlState
    reason: str


class Safety:
    """
    The state machine; it moves nothing, and knows nothing of geometry.

    Attributes
    ----------
    state : ControlState
    changes : list of StateChange
    elapsed : float
        s in this state, by the periods: it goes on when a clock does not.
    turning : bool
        While tracking: whether the place of the contact is known well enough to turn by it.
    word : str
        What is wrong with the force while it tracks: "swinging", "degraded", or "".
    """

    def __init__(self, settings: ControlSettings) -> None:
        self.settings = settings
        self.state = ControlState.APPROACH
        self.changes: list[StateChange] = []
        self.turning = True
        self.since = 0.0
        self.elapsed = 0.0
        self._now = 0.0
        self._low = self._lost = self._blocked = self._steady = self._late = 0.0
        self._attempts = 0
        self._stop = False
        self._loads = (math.nan, math.nan)  # |F| and |M| of the newest fresh step
        self._load_age = 0.0
        self._held_from = ControlState.APPROACH
        self._patience = settings.give_up
        self._delayed = 0.0  # s that the poses have been late
        self._rest = 0.0  # s to stand still, whatever is sensed
        self._unsure = ""  # why there is no place
        self.word, self._strayed = "", 0.0

    def stop(self) -> None:
        """Have it end: it goes back."""
        self._stop = True

    def update(
        self,
        now: float,
        sensed: Sensed,
        force: float,
        *,
        travelled: float,
        last: JointStep | None,
        probed: bool,
        dt: float,
        follows: bool = True,
        turned: float = 0.0,
        rising: float = 0.0,
        swinging: float = 0.0,
        swings: bool = False,
        poses_late: float = 0.0,
    ) -> ControlState:
        """
        Decide what to do in this step.

        Parameters
        ----------
        now : float
            s.
        force : float
            How hard the tissue is pressed, N; NaN without a fresh sample.
        travelled : float
            m since the state began: into the tissue in `approach`, back in `retract`.
        last : JointStep or None
            What became of the motion of the step before.
        probed : bool
            Whether the stiffness is known.
        dt : float
            s.
        follows : bool
            Whether the arm is where it was sent.
        turned : float
            Between the probe's axis and the one that it began with, rad.
        rising : float
            How fast the force would grow if the probe stood still, at most, as far as is known, N/s.
        swinging : float
            Amplitude of a swing that a lower gain did not stop, N; 0: there is none.
        swings : bool
            Whether the force alternates.
        poses_late : float
            How far the arm seems to be behind its set-points, s.
        """
        self._now = now
        self.elapsed += dt
        self._count(sensed, force, last, follows, dt)
        if self.state is not ControlState.SAFE and self._alarm(sensed, force, turned, dt):
            return self.state  # what was travelled until now is not the way back
        self._stray(force, swings, dt)
        delayed = poses_late > self.settings.following + self.settings.servo_lag
        self._delayed = self._delayed + dt if delayed else 0.0
        working = self.state in (ControlState.APPROACH, ControlState.CONTACT, ControlState.TRACK)
        if working and sensed.fault is not None:
            self._wait(
                message(f"the sensor is {arg(sensed.fault.value)}: no motion on stale readings."), rising
            )
        elif working and self._delayed > _DELAYED_S:
            reason = message(
                f"the poses are {arg(1e3 * poses_late):.0f} ms late, so the position is unknown."
            )
            self._to(ControlState.RETRACT, reason)
        elif working and self._late > _LATE_S:
            self._behind(rising)
        elif self.state is ControlState.TRACK and swinging > 0:
            self._swings(swinging, rising)
        elif self.state is ControlState.APPROACH:
            self._approach(force, travelled)
        elif self.state is ControlState.CONTACT:
            self._contact(force, probed, dt)
        elif self.state is ControlState.TRACK:
            self._track()
        elif self.state is ControlState.HOLD:
            self._hold(sensed, force)
        elif self.state is ControlState.RETRACT:
            self._retract(sensed, force, travelled, last)
        return self.state

    # ---- what is counted -------------------------------------------------------------------------

    def _count(self, sensed: Sensed, force: float, last: JointStep | None, follows: bool, dt: float) -> None:
        def longer(so_far: float, holds: bool) -> float:
            return so_far + dt if holds else 0.0

        if sensed.fresh:
            # What has just touched may press a little less at first, and touches yet.
            touched = _YET * self.settings.touch_force if self.state is ControlState.CONTACT else math.inf
            self._low = longer(self._low, force < min(self.settings.low_force, touched))
            self._lost = longer(self._lost, sensed.contact is None)
            self._unsure = "" if sensed.reason is None else f" ({sensed.reason.name.lower()})"
        self._late = longer(self._late, not follows)
        self._blocked = longer(self._blocked, last is not None and _blocked(last))
        self.turning = self._lost < _LOST_S

    def _stray(self, force: float, swings: bool, dt: float) -> None:
        """Say so when the force stays outside its band while it tracks, and when it is back."""
        if self.state is not ControlState.TRACK:
            self.word, self._strayed = "", 0.0
            return
        off = abs(force - self.settings.desired_force) > _BAND * self.settings.desired_force
        self._strayed += (1 - math.exp(-dt / _STRAY_S)) * (off - self._strayed)
        before = self.word
        if self._strayed > _STRAYED:
            self.word = "swinging" if swings or before == "swinging" else "degraded"
        elif self._strayed < _BACK:
            self.word = ""
        if self.word != before:
            told = message("the force is back in its band.")
            if self.word == "swinging":
                told = message("swinging: the force alternates around what is wanted; nothing is led.")
            elif self.word:
                told = message(f"degraded: the force is {arg(force):.1f} N.")
            self.changes.append(StateChange(self._now, self.state, self.state, told))

    def _alarm(self, sensed: Sensed, force: float, turned: float, dt: float) -> bool:
        """Have it go back at once, if it must; tell whether it does from now on."""
        overload = self._overload(sensed, dt)  # always: it remembers the loads
        if self.state is ControlState.RETRACT:
            return False
        reason = self._danger(sensed) or overload or self._askew(turned) or self._squeezed(sensed, force)
        if reason is not None:
            self._to(ControlState.RETRACT, reason)
        return reason is not None

    def _danger(self, sensed: Sensed) -> str | None:
        if self._stop:
            return message("it was stopped.")
        if sensed.fault is SensingFault.SATURATED:
            return message("the sensor is at the end of its range, so the force is unknown.")
        if self._blocked > _STOPPED_S and self.state is not ControlState.HOLD:
            return message("the arm cannot move farther: joint limit or singularity.")
        return None

    def _overload(self, sensed: Sensed, dt: float) -> str | None:
        """Return why a load is too near to its limit, or will be, or None; from whatever side it comes."""
        self._load_age += dt
        if not sensed.fresh:
            return None
        before, age = self._loads, self._load_age
        F, M = sensed.wrench[:3], sensed.wrench[3:]
        self._loads, self._load_age = (math.sqrt(float(F @ F)), math.sqrt(float(M @ M))), 0.0
        limits = ("N", self.settings.max_force), ("N·m", self.settings.max_torque)
        for (unit, most), size, old in zip(limits, self._loads, before, strict=True):
            if size > _ALARM * most:
                return message(
                    f"{arg(size):.1f} {arg(unit)} come too close to the limit of {arg(most):g} {arg(unit)}."
                )
            rate = (size - old) / age
            if size + _REACTION_S * rate > most:  # never of NaN, as at first
                return message(
                    f"{arg(size):.1f} {arg(unit)} grow by {arg(rate):.0f} {arg(unit)} per s and will soon"
                    f" exceed the limit of {arg(most):g} {arg(unit)}."
                )
        return None

    def _askew(self, turned: float) -> str | None:
        if self.state in (ControlState.CONTACT, ControlState.TRACK) and turned > self.settings.max_tilt:
            return message(
                f"it has turned by {arg(math.degrees(turned)):.0f} degrees from the start, more than any"
                " tissue requires."
            )
        return None

    def _squeezed(self, sensed: Sensed, force: float) -> str | None:
        if (
            self.state is ControlState.HOLD
            and sensed.fresh
            and force > _PRESSED * self.settings.desired_force
        ):
            return message(f"the tissue pushes with {arg(force):.1f} N while the arm stands still.")
        return None

    # ---- one state each --------------------------------------------------------------------------

    def _approach(self, force: float, travelled: float) -> None:
        if force > self.settings.touch_force:
            self._to(ControlState.CONTACT, message(f"in contact, with {arg(force):.1f} N."))
        elif travelled > self.settings.approach_travel:
            far = 1000 * self.settings.approach_travel
            self._to(ControlState.RETRACT, message(f"no tissue found within {arg(far):.0f} mm."))

    def _contact(self, force: float, probed: bool, dt: float) -> None:
        if self._again():
            return
        near = abs(force - self.settings.desired_force) < _NEAR * self.settings.desired_force
        self._steady = self._steady + dt if near else 0.0
        if self._steady >= _STEADY_S and probed and self.elapsed > self.settings.ramp:
            self._to(ControlState.TRACK, message(f"the force is {arg(force):.1f} N."))

    def _track(self) -> None:
        if not self._again() and self._lost > _GIVEN_UP_S:
            unknown = message(f"the contact was unknown for {arg(_GIVEN_UP_S):g} s{arg(self._unsure)}.")
            self._to(ControlState.RETRACT, unknown)

    def _again(self) -> bool:
        if self._low < _LOW_S:
            return False
        self._attempts += 1
        if self._attempts > self.settings.attempts:
            self._to(ControlState.RETRACT, message(f"the tissue was lost {arg(self._attempts)} times."))
        else:
            self._to(ControlState.APPROACH, message("the tissue was lost: searching for it again."))
        return True

    def _behind(self, rising: float) -> None:
        self._attempts += 1
        if self._attempts > self.settings.attempts:
            often = message(f"the arm missed its commanded position {arg(self._attempts)} times.")
            self._to(ControlState.RETRACT, often)
        else:
            self._wait(message("the arm is not at its commanded position: motion waits until it is."), rising)

    def _swings(self, amplitude: float, rising: float) -> None:
        self._attempts += 1
        if self._attempts > self.settings.attempts:
            often = message(
                f"the force oscillated {arg(self._attempts)} times, now by {arg(amplitude):.1f} N."
            )
            self._to(ControlState.RETRACT, often)
            return
        swings = message(
            f"the force oscillates by {arg(amplitude):.1f} N although the gain was lowered: holding still."
        )
        self._wait(swings, rising)
        # On this tissue nothing is known any more.
        self._held_from, self._rest = ControlState.CONTACT, _REST_S

    def _hold(self, sensed: Sensed, force: float) -> None:
        if sensed.fresh and self._late == 0:
            if self.elapsed < self._rest:
                return
            after = ControlState.CONTACT if force > self.settings.touch_force else ControlState.APPROACH
            if self._held_from is ControlState.TRACK and after is ControlState.CONTACT:
                after = ControlState.TRACK  # all is known; and tissue that moves does not wait
            self._to(after, message("the readings are fresh, and the arm is at its commanded position."))
        elif self.elapsed > self._patience:
            self._to(
                ControlState.RETRACT,
                message(f"{arg(self.elapsed):.2g} s did not help: retracting along its path."),
            )

    def _wait(self, reason: str, rising: float) -> None:
        """Hold, for no longer than moving tissue can be trusted not to press too hard meanwhile."""
        self._held_from, self._rest = self.state, 0.0
        room = _ALARM * self.settings.max_force - self._loads[0]
        time = room / rising - _REACTION_S if rising > 0 else math.inf
        self._patience = min(self.settings.give_up, max(time, 0.0))
        self._to(ControlState.HOLD, reason)

    def _retract(self, sensed: Sensed, force: float, travelled: float, last: JointStep | None) -> None:
        away = travelled >= self.settings.retract_travel
        free = not sensed.fresh or force < self.settings.low_force
        stuck = self.elapsed > 1.0 and (self._late > 1.0 or (last is not None and last.share < _LITTLE))
        if (away and free) or travelled >= 2 * self.settings.retract_travel or stuck:
            self._to(
                ControlState.SAFE,
                message("fully retracted.") if not stuck else message("it cannot retract farther."),
            )

    def _to(self, state: ControlState, reason: str) -> None:
        self.changes.append(StateChange(self._now, self.state, state, reason))
        self.state, self.since, self.elapsed = state, self._now, 0.0
        self._low = self._lost = self._blocked = self._steady = self._late = 0.0
        self.turning = True


def _blocked(step: JointStep) -> bool:
    return MotionLimit.SINGULAR in step.held or (MotionLimit.LIMIT in step.held and step.share < _LITTLE)


# ---- what a controller is built on, and what a step of it decides --------------------------------


@dataclass(frozen=True, eq=False)
class SensorMount:
    """
    How the sensor sits on the flange.

    Raises
    ------
    InputError
        It is no rotation, or a number is not finite.
    """

    R_ES: NDArray[np.float64]  # (3, 3)
    p_ES_E: NDArray[np.float64]  # (3,) m

    def __post_init__(self) -> None:
        R, p = np.array(self.R_ES, dtype=np.float64), np.array(self.p_ES_E, dtype=np.float64)
        proper = (
            R.shape == (3, 3)
            and np.isfinite(R).all()
            and np.allclose(R @ R.T, np.eye(3), atol=1e-6)
            and np.linalg.det(R) > 0
        )
        if not proper or p.shape != (3,) or not np.isfinite(p).all():
            raise InputError(
                "mount: R_ES must be a rotation (3, 3), p_ES_E three finite numbers (m): take both from the drawing"
                " of the adapter between flange and sensor."
            )
        object.__setattr__(self, "R_ES", R)
        object.__setattr__(self, "p_ES_E", p)


@dataclass(frozen=True, eq=False)
class ControlCommand:
    """What a step decided."""

    q: NDArray[np.float64]  # (n,) Set-point of the joints at the end of the period
    state: ControlState
    change: StateChange | None  # what changed in this step, and why
    twist: NDArray[np.float64]  # (6,) wanted velocity of the tip and angular velocity, in B, m/s and rad/s
    force: float  # pressing force, N; NaN without a fresh sample
    # (2,) contact minus wanted contact along S's x and y, m; NaN where it is not known
    offset: NDArray[np.float64]
    sensed: Sensed
    step: JointStep  # what the arm makes of the twist
