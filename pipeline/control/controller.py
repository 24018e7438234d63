"""The controller: samples and joints in, set-points out; the same inputs always give the same."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.config.runtime.config import RuntimeConfig
from contactbench.pipeline.control.intake import SampleIntake, Sensed
from contactbench.pipeline.control.inverse import Admittance, Arm, JointStep, solve_step
from contactbench.pipeline.control.margins import weak_loops
from contactbench.pipeline.control.settings import (
    ControlSettings,
    Foundation,
    Variant,
    calm_on,
    for_tool,
    intake_of,
    mount_of,
    settings_of,
)
from contactbench.pipeline.control.states import ControlCommand, ControlState, Safety, SensorMount
from contactbench.pipeline.control.stiffness import StiffnessProbe, StiffnessTrack, Swing
from contactbench.pipeline.control.surface import TissueSurface
from contactbench.pipeline.control.upright import Tilt, Upright, cross, pressing
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh import Probe

Pose = tuple[NDArray[np.float64], NDArray[np.float64]]

_CAREFUL = 1.2  # the step in which it touched may have begun in the air
_UNSURE = 0.25  # share of the tool's inertia
_PRESS_N = 0.8  # about what the small press may add to the force
# Of the wanted force, and s: what is farther off for longer may be tissue of another stiffness; a jump in its speed is
# met sooner.
_DOUBTED, _DOUBTED_S = 0.1, 0.05
_TRUST_S = 0.1  # time constant of the trust in what leads
_STILL, _WHOLE = 1e-4, 0.98  # m/s or rad/s; of a motion: more is all of it
_HALF = 0.5  # of the turns, while the stiffness is in doubt: on stiffer tissue a tilt is read too large
_WRONG = 0.5  # of the wanted force: as far off the other way, what leads is wrong
_REMEMBERED_S = 2.0  # how long tissue counts as moving after it did
_UP = np.array([0.0, 0.0, 1.0])


class Controller:
    """
    Keeps a force, and the probe upright on what it presses; one call of `step` per period.

    Parameters
    ----------
    probe : Probe
        In S, its face towards +z.
    intake : SampleIntake
        What is believed of the sensor.
    q : (n,)
        Joints at the beginning.

    Attributes
    ----------
    safety : Safety
    surface : TissueSurface
    """

    def __init__(
        self,
        settings: ControlSettings,
        arm: Arm,
        probe: Probe,
        intake: SampleIntake,
        mount: SensorMount,
        q: NDArray[np.float64],
    ) -> None:
        foundation, tool = Foundation(probe), intake.gravity
        lever = foundation.height - float(tool.centre_of_mass_S[2])
        settings = for_tool(settings, float(tool.mass), lever)
        self.settings, self._arm, self._intake, self._mount = settings, arm, intake, mount
        force, torque = settings.calibration_sigma
        error = float(np.hypot(force * foundation.height, torque)) / settings.desired_force
        tilts = Tilt(*settings.lean, error), Tilt(*settings.lean, error)
        self.surface = TissueSurface(foundation, settings.bandwidth, tilts=tilts)
        self.safety = Safety(settings)
        wanted = self.surface.press(settings.desired_force)
        self.wanted_S = np.array([wanted.x, wanted.y, foundation.height])
        self._lever_S = self.wanted_S + mount.R_ES.T @ mount.p_ES_E
        self._force = Admittance(settings.force_mass, settings.force_damping, settings.force_stiffness)
        self._upright = Upright(settings, self.surface)
        self._inertia = Inertia(intake.gravity, settings.gyration)
        self._tare = Tare(settings.taring)
        self._probing = StiffnessProbe(settings.probing)
        self._probed = settings.probing == 0
        self._stiffness = StiffnessTrack()
        self._swing = Swing(settings.desired_force)
        self._lag, self._sent_speed = PoseLag(), 0.0
        self._wrong = 0.0  # s that the force has been off
        self._trust = 1.0  # in what leads
        self._driven = 0.0  # m/s, what the force loop asked for
        self._pressed = 0.0  # N, as last sensed
        self._q = np.array(q, dtype=np.float64)
        self._sent = self._pose(self._q)  # where that is
        self._first_axis = self._sent[0][:, 2].copy()
        self._calm = 1.0  # share of the force loop's speed, by the tissue's stiffness
        self._felt = np.zeros(6)  # what speeds up the tool
        self._moves = 0.0  # m/s, of the tissue along the axis, the largest of late
        self._speeds = np.zeros_like(self._q)
        self._last: JointStep | None = None
        self._before: Pose | None = None  # at the step before
        self._travelled = self._began_force = 0.0
        self._way, self._place = 0.0, self._sent[1]  # m, how far the tip went along its axis, to where in B
        self._touching: tuple[float, float] | None = None  # the way then, and the force
        self._unseen = 0.0  # s since the surface was last updated

    @classmethod
    def from_config(
        cls,
        config: RuntimeConfig,
        arm: Arm,
        q: NDArray[np.float64],
        *,
        p_ES_E: ArrayLike = (0.0, 0.0, 0.0),
        quaternion_ES: ArrayLike | None = None,
        method: str = "contactbench",
        variant: Variant | None = None,
    ) -> Controller:
        """
        Take everything from a bundle: probe, calibration, noise, gates, limits, and the controller where it has one.

        Parameters
        ----------
        q : (n,)
            Joints at the beginning.
        p_ES_E : (3,)
            Where the sensor is on the flange, m: a bundle does not say.
        quaternion_ES : (4,), optional
            How it is turned, for a bundle that does not say.
        method : str
            A name of `contactbench.pipeline.contact.methods.METHODS`.
        variant : Variant, optional
            Another one than the bundle's.

        Raises
        ------
        InputError
            Something is missing in the bundle, or contradicts it.
        """
        part = config.model.controller
        force = ControlSettings.desired_force if part is None else part.desired_force_N
        base = ControlSettings.for_probe(Foundation(config.probe), desired_force=force)
        chosen = settings_of(part, config.model.limits, base)
        if variant is not None:
            chosen = replace(chosen, variant=variant)
        if swings := [said for said, left in weak_loops(config, chosen) if not left.stable]:
            raise InputError(f"bundle: this would swing. {arg(swings[0])}")
        mount = mount_of(config, p_ES_E, quaternion_ES)
        return cls(chosen, arm, config.probe, intake_of(config, chosen, method), mount, q)

    @property
    def state(self) -> ControlState:
        """What it does."""
        return self.safety.state

    def stop(self) -> None:
        """Have it go back and end."""
        self.safety.stop()

    def step(
        self, now: float, q_measured: NDArray[np.float64], samples: Sequence[WrenchSample]
    ) -> ControlCommand:
        """
        Decide on the next set-point.

        Parameters
        ----------
        now : float
            s, on the samples' clock.
        q_measured : (n,)
            Where the joints are now.
        samples : sequence of WrenchSample
            Raw, those that came since the step before.
        """
        dt = self.settings.period
        here, follows = self._arrived(q_measured)
        R_BS, tip = self._pose(here)
        if follows:
            inward, was = self._sent[0][:, 2], tip if self._before is None else self._before[1]
            self._lag.take(
                self._sent_speed, float((tip - was) @ inward) / dt, float((self._sent[1] - tip) @ inward), dt
            )
        self._inertia.moved(R_BS, tip - R_BS @ self.wanted_S)
        self._felt = self._inertia.wrench(R_BS, dt)
        sensed = self._intake.take(now, samples, R_BS, self._felt - self._tare.wrench)
        force = pressing(sensed.wrench[:3], _UP)
        self._pressed = force if sensed.fresh else self._pressed
        offset = self._offset(sensed)
        R_then, moved = self._moved(now, sensed, R_BS, tip)
        # Piece by piece: along an axis that turns, the place in B goes with the distance from the base.
        self._way += float((moved - self._place) @ R_then[:, 2])
        self._place = moved
        before, told = self.safety.state, len(self.safety.changes)
        state = self.safety.update(
            now,
            sensed,
            force,
            travelled=self._travelled,
            last=self._last,
            probed=self._probed,
            follows=follows,
            turned=math.acos(min(max(float(R_BS[:, 2] @ self._first_axis), -1.0), 1.0)),
            rising=self.surface.press(self.settings.desired_force).stiffness * self._moves,
            swinging=self._swing.amplitude if self._swing.beyond else 0.0,
            swings=self._swing.seen,
            poses_late=self._lag.seconds,
            dt=dt,
        )
        if state is not before:
            if self._swing.beyond and state is ControlState.HOLD:
                self._probed = self.settings.probing == 0  # what was known of the tissue is wrong
            self._enter(before, state, force, None if follows else here)
            if (before, state) == (ControlState.APPROACH, ControlState.CONTACT) and not self._probed:
                self._guess(force)
        self._learn(now, sensed, force, offset, moved, R_then, dt)
        R_cmd = self._sent[0]
        wished = self._twist(now, state, sensed, force, offset, R_cmd, dt)
        twist = self._limited(wished.copy())
        lever = R_cmd @ self._lever_S
        step = solve_step(self._arm, self._q, lever, twist, dt, self._speeds)
        self._speeds = (step.q - self._q) / dt
        left, self._sent = self._sent, self._pose(step.q)
        self._sent_speed = float((self._sent[1] - left[1]) @ R_cmd[:, 2]) / dt
        self._hold_back(wished, left, dt)
        self._q, self._last = step.q, step
        self._travelled += abs(float(twist[:3] @ R_cmd[:, 2])) * step.share * dt
        change = self.safety.changes[-1] if len(self.safety.changes) > told else None
        return ControlCommand(step.q, state, change, twist, force, offset, sensed, step)

    def _arrived(self, q_measured: NDArray[np.float64]) -> tuple[NDArray[np.float64], bool]:
        """Return where the arm is, and whether that is near to where the last set-point should have brought it."""
        here = np.asarray(q_measured, dtype=np.float64)
        if here.shape != self._q.shape:
            raise InputError(
                f"controller: {arg(here.shape)} joints for an arm that has {arg(self._q.shape)}: give all of them."
            )
        if not np.isfinite(here).all():
            return self._q, False
        if (here == self._q).all():
            return here, True
        (R, tip), (R_cmd, tip_cmd) = self._pose(here), self._sent
        off, turned = tip - tip_cmd, R - R_cmd
        late = self.settings.following
        # |R - R'|² = 8 sin²(angle / 2), about twice the angle's square.
        far = float(off @ off) > (late * self.settings.max_speed) ** 2
        return here, not far and float((turned * turned).sum()) < 2 * (late * self.settings.max_turn) ** 2

    # ---- what is sensed ----------------------------------------------------------------------------

    def _pose(self, q: NDArray[np.float64]) -> Pose:
        """Return R_BS and where the wanted contact is in B."""
        R_BE, p_BE_B = self._arm.flange_pose(q)
        R_BS = R_BE @ self._mount.R_ES
        return R_BS, p_BE_B + R_BE @ self._mount.p_ES_E + R_BS @ self.wanted_S

    def _offset(self, sensed: Sensed) -> NDArray[np.float64]:
        return np.full(2, np.nan) if sensed.point is None else sensed.point[:2] - self.wanted_S[:2]

    def _moved(self, now: float, sensed: Sensed, R_BS: NDArray[np.float64], tip: NDArray[np.float64]) -> Pose:
        """Return how the probe stood at the mean time of the readings: they are older than the joints."""
        R_before, before = (R_BS, tip) if self._before is None else self._before
        self._before = R_BS, tip
        share = min(max(now - sensed.time, 0.0) / self.settings.period, 1.0) if sensed.fresh else 0.0
        # In a period it turns by so little that the chord is as good as the arc.
        return R_BS - share * (R_BS - R_before), tip - share * (tip - before)

    def _enter(
        self, before: ControlState, state: ControlState, force: float, here: NDArray[np.float64] | None
    ) -> None:
        """Begin a state; `here` is where the arm stands, if it does not follow: then it goes on from there."""
        if here is not None:
            self._q, self._speeds, self._sent = here.copy(), np.zeros_like(here), self._pose(here)
        self._travelled = self._unseen = 0.0
        self._force.reset()
        self._upright.reset()
        if state is ControlState.APPROACH or before is ControlState.HOLD:
            self.surface.forget()
        if before is ControlState.APPROACH:
            self._tare.over = True  # from now on something may touch
        self._began_force = max(force, 0.0) if np.isfinite(force) else 0.0
        self._probing = StiffnessProbe(self.settings.probing)
        self._stiffness.reset()
        self._swing.reset()

    def _learn(
        self,
        now: float,
        sensed: Sensed,
        force: float,
        offset: NDArray[np.float64],
        tip: NDArray[np.float64],
        R_BS: NDArray[np.float64],
        dt: float,
    ) -> None:
        if sensed.fresh and self.state is ControlState.APPROACH:
            self._tare.take(sensed.wrench, sensed.count, dt)
            self._touching = self._way, force
        self._unseen += dt
        if not sensed.fresh or force < self.settings.low_force:
            return
        known = (float(offset[0]), float(offset[1])) if np.isfinite(offset).all() else None
        F = sensed.wrench[:3]
        # Tissue that is turned about +x pushes towards +y, about +y towards -x.
        leaning = (float(np.arctan2(F[1], -F[2])), float(np.arctan2(-F[0], -F[2])))
        # What speeds up the tool is known no better than to a quarter; else it would pass for friction, for a second.
        noise, left = self._intake.sigmas(sensed.count), _UNSURE * np.abs(self._felt)
        sigmas = math.hypot(noise[0], left[:2].max()), math.hypot(noise[1], left[3:5].max())
        self.surface.update(self._unseen, tip, R_BS, force, known, leaning, sigmas)
        faded = self._moves * math.exp(-self._unseen / _REMEMBERED_S)
        self._moves = max(abs(self.surface.speed_along(R_BS[:, 2], 0.0)), faded)
        self._unseen = 0.0
        if self.state is ControlState.TRACK:
            self._follow(sensed.time, force, R_BS[:, 2], dt)
        if self.state is not ControlState.CONTACT or self._probed:
            return
        self._probing.take(sensed.time, self._way, force)
        if self._probing.over(now):
            found = self._probing.stiffness()
            sunk = 0.0 if self._touching is None else self._way - self._touching[0]
            if found is not None:
                self._take(force, found[0])
            elif sunk > 0:
                # So soft that a small press shows nothing: then the way from the first touch on is long.
                self._take(force, force / sunk)
            self._probed = True

    def _take(self, force: float, stiffness: float) -> None:
        """Take a stiffness, N/m; the force loop is slower on what is soft for so heavy a tool."""
        self._calm = calm_on(stiffness, float(self._intake.gravity.mass))
        self.surface.learn(force, stiffness, self._calm)

    def _follow(self, time: float, force: float, inward: NDArray[np.float64], dt: float) -> None:
        """Follow the stiffness while it tracks, and slow the force loop down where the force swings."""
        wanted = self.settings.desired_force
        self._swing.take(wanted - force, dt)
        if self.settings.variant is Variant.PLAIN:
            return  # its gain is what it is, on any tissue
        self._wrong = self._wrong + dt if abs(wanted - force) > _DOUBTED * wanted else 0.0
        if self._wrong > _DOUBTED_S or self._swing.seen:
            self._stiffness.doubt()
        known = self.surface.press(force).stiffness
        found = self._stiffness.take(time, self._way, force, known)
        self._swing.explained(found / known)
        if found != known:
            self._calm = calm_on(found, float(self._intake.gravity.mass))
        self.surface.learn(force, found, self._calm * self._swing.share, inward)

    def _guess(self, force: float) -> None:
        """Guess the stiffness from how the force grew as it touched, rather too high: then it goes on gently."""
        if self._touching is None:
            return
        travel, grown = self._way - self._touching[0], force - self._touching[1]
        if travel > 0 and grown > 0:
            self.surface.learn(force, _CAREFUL * grown / travel)
            stiffness = self.surface.press(self.settings.desired_force).stiffness
            self._probing = StiffnessProbe(min(self.settings.probing, _PRESS_N / stiffness))

    # ---- what is done ------------------------------------------------------------------------------

    def _twist(
        self,
        now: float,
        state: ControlState,
        sensed: Sensed,
        force: float,
        offset: NDArray[np.float64],
        R_BS: NDArray[np.float64],
        dt: float,
    ) -> NDArray[np.float64]:
        inward = R_BS[:, 2]
        twist = np.zeros(6)
        if state is ControlState.APPROACH:
            if self._tare.over:
                twist[:3] = self.settings.approach_speed * inward
        elif state is ControlState.RETRACT:
            # What became stiff presses harder than any force loop bears: out of it as fast as the limits allow.
            hard = self._pressed > self.settings.desired_force
            twist[:3] = -(self.settings.max_speed if hard else self.settings.retract_speed) * inward
        elif state in (ControlState.CONTACT, ControlState.TRACK) and sensed.fresh:
            lead = now - sensed.time + dt / 2 + self.settings.servo_lag
            wanted = self._wanted(now)
            twist[:3] = (self._along(force, wanted, inward, lead, dt) + self._press(now, force)) * inward
            if state is ControlState.TRACK and self.safety.turning:
                # About the tip: what is then dragged over the tissue leans the force against the turn. About the
                # tissue's surface, before the tip, it would lean with it, and the turn would drive itself.
                part = _HALF if self._stiffness.doubted else 1.0
                shares = part * self._swing.share, part * self._left
                twist[3:] = self._upright.speed(offset, R_BS, lead, dt, *shares)
        return twist

    @property
    def _left(self) -> float:
        """Share of what leads that a swing leaves: while it is told of, none."""
        return 0.0 if self.safety.word == "swinging" else self._swing.share

    def _wanted(self, now: float) -> float:
        """Return the wanted force, which grows at first touch."""
        if self.state is not ControlState.CONTACT:
            return self.settings.desired_force
        share = min((now - self.safety.since) / self.settings.ramp, 1.0)
        return self._began_force + share * (self.settings.desired_force - self._began_force)

    def _press(self, now: float, force: float) -> float:
        """Return the speed of the small press that measures the stiffness, once the force is there."""
        if self.state is ControlState.TRACK and self.settings.variant is Variant.AWARE:
            return self._stiffness.asking(self.surface.press(force).stiffness, self.settings.period)
        if self._probed:
            return 0.0
        if self._ready(now, force):
            self._probing.begin(now)
        return self._probing.speed(now)

    def _ready(self, now: float, force: float) -> bool:
        grown = now - self.safety.since > self.settings.ramp + 0.1
        return grown and self._probing.began is None and abs(force - self.settings.desired_force) < 1.0

    def _along(
        self, force: float, wanted: float, inward: NDArray[np.float64], lead: float, dt: float
    ) -> float:
        """Eq. 7 with its sign: pressed too little it goes in. Aware, it leads the tissue by its speed."""
        plain = self.settings.variant is Variant.PLAIN
        # As Eq. 7, with the damping that gives the usual gain on what is touched.
        damping = self.settings.force_damping * self.settings.force_gain
        scale = 1.0 if plain else self._calm * damping / self.surface.press(force).stiffness
        self._driven = self._force.step(math.sqrt(self._swing.share) * scale * (wanted - force), dt)
        if self.state is ControlState.TRACK and force < self.settings.low_force:
            # What is lost is not run after: where it was, or comes back, it would be hit.
            self._force.reset()
            return min(self._driven, self.settings.approach_speed)
        # Before the stiffness is measured, or while the force grows, tissue that gives way would seem to flee.
        known = self._probed and self.safety.elapsed > self.settings.ramp
        if plain or not (known or self.state is ControlState.TRACK):
            return self._driven
        led = self.surface.speed_along(inward, lead)
        return led * self._left * self._trusted(led, wanted - force, dt) + self._driven

    def _hold_back(self, wished: NDArray[np.float64], before: Pose, dt: float) -> None:
        """Have what drives the motion know what limits left of it: of speed, acceleration, and joints."""
        (R, tip), (R_before, tip_before) = self._sent, before
        turn = R @ R_before.T
        done = (
            (tip - tip_before) / dt,
            np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / (2 * dt),
        )
        shares = []
        for part, reached in zip((wished[:3], wished[3:]), done, strict=True):
            size2 = float(part @ part)
            share = 1.0 if size2 < _STILL**2 else min(max(float(reached @ part) / size2, 0.0), 1.0)
            shares.append(1.0 if share > _WHOLE else share)
        if shares[0] < 1:
            self._force.hold_back(shares[0], dt, self._driven)
        if shares[1] < 1:
            self._upright.hold_back(shares[1], dt)

    def _trusted(self, led: float, error: float, dt: float) -> float:
        """
        Return how much of a lead, m/s inward, to believe: less where the force, N too little, says the contrary.

        Not at once: it would be a gain of its own, of a cough's 80 mm/s 25 mm/s for each N, which alternates.
        """
        low, high = _DOUBTED * self.settings.desired_force, _WRONG * self.settings.desired_force
        wanted = 1.0 if led * error >= 0 else min(max((high - abs(error)) / (high - low), 0.0), 1.0)
        self._trust += (1 - math.exp(-dt / _TRUST_S)) * (wanted - self._trust)
        return self._trust

    def _limited(self, twist: NDArray[np.float64]) -> NDArray[np.float64]:
        for part, most in ((slice(0, 3), self.settings.max_speed), (slice(3, 6), self.settings.max_turn)):
            size = math.sqrt(float(twist[part] @ twist[part]))
            if size > most:
                twist[part] *= most / size
        return twist


# ---- the tool's own inertia in a reading: what speeds up feels a force that no contact made ------


_PLACES = 3


class Inertia:
    """
    What the acceleration of the centre of mass adds to a reading, from where the arm was at the last steps.

    A quick turn about a tip that is 80 mm away from the centre of mass (0.45 kg) at 10 rad/s² takes 0.36 N: at 7 N
    that looks like a contact 7 mm away, and a controller that turns by it shakes itself. The torque that turns the tool
    itself, 7 mN·m then, is that of a ball: a gravity calibration knows no moments of inertia.

    Parameters
    ----------
    gravity : GravityModel
        Mass and centre of mass.
    gyration : float
        Radius of gyration about the centre of mass, m; 0: that torque is left out.
    """

    def __init__(self, gravity: GravityModel, gyration: float = 0.0) -> None:
        self._mass = float(gravity.mass)
        self._moment = self._mass * gyration**2
        self._centre_S = np.array(gravity.centre_of_mass_S)
        self._places: deque[NDArray[np.float64]] = deque(maxlen=_PLACES)
        self._turns: deque[NDArray[np.float64]] = deque(maxlen=_PLACES)

    def moved(self, R_BS: NDArray[np.float64], p_BS_B: NDArray[np.float64]) -> None:
        """Take where the sensor is now; once a period."""
        self._places.append(p_BS_B + R_BS @ self._centre_S)
        self._turns.append(R_BS)

    def wrench(self, R_BS: NDArray[np.float64], period: float) -> NDArray[np.float64]:
        """
        Return what to add to a reading that is the mean over the last period, (6,) in S.

        A servo that goes smoothly through its set-points has, at each, the mean speed of the period before, so that
        the mean acceleration of a period is the second difference of the places at its end and the two before.
        """
        if len(self._places) < _PLACES:
            return np.zeros(6)
        a, b, c = self._places
        force = self._mass * (R_BS.T @ ((c - 2 * b + a) / period**2))
        first, second = (_turn(*pair) for pair in ((self._turns[0], self._turns[1]), (self._turns[1], R_BS)))
        torque = self._moment * (R_BS.T @ ((second - first) / period**2))
        return np.concatenate([force, cross(self._centre_S, force) + torque])


def _turn(R_a: NDArray[np.float64], R_b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the small turn (3,) from one orientation to the next, rad, in B: R_b = (1 + [w]x) R_a."""
    D = R_b @ R_a.T
    return np.array([D[2, 1] - D[1, 2], D[0, 2] - D[2, 0], D[1, 0] - D[0, 1]]) / 2


# ---- how late the poses are that a controller is told of its own arm -----------------------------


_KEPT_S = 1.0  # time constant of what is remembered
_MOVED = 1.5e-6  # m²/s: a fifth of a second at 3 mm/s; after less motion nothing is said
_SHARE = 0.5  # of the squares of the speeds: an arm that goes less does not follow


class PoseLag:
    """
    What the arm is behind over how fast it was sent: ``lag = sum v off / sum v²``, least squares with forgetting.

    A stream of poses that waits in a buffer somewhere tells of the same motion, later. An arm that does not move at all
    is not late: it does not follow.
    """

    def __init__(self) -> None:
        self._off = self._size = self._moved = 0.0

    def take(self, speed: float, told: float, off: float, dt: float) -> None:
        """
        Take a period.

        Parameters
        ----------
        speed, told : float
            How fast it was sent along an axis, and how fast it went, by what was told, m/s.
        off : float
            How far it is behind, m.
        dt : float
            s.
        """
        kept = math.exp(-dt / _KEPT_S)
        self._off = kept * self._off + speed * off * dt
        self._size = kept * self._size + speed * speed * dt
        self._moved = kept * self._moved + told * told * dt

    @property
    def seconds(self) -> float:
        """How late they are, s; 0 while too little moved to say."""
        moves = self._size > _MOVED and self._moved > _SHARE * self._size
        return max(self._off / self._size, 0.0) if moves else 0.0


# ---- what a sensor still reads in the air, after gravity: taken off before the first touch -------


_MOST_N, _MOST_NM = 0.35, 0.03  # a calibration leaves less; more may be a touch, which must not be taken off


class Tare:
    """
    The mean of compensated readings while nothing touches.

    What a calibration leaves, 0.05 N and 2 mN·m, moves the contact at 7 N by 1.3 mm on a probe of 140 mm: eleven
    degrees of tilt on a narrow face. One second in the air leaves a twentieth of it.

    Parameters
    ----------
    seconds : float
        How long it takes; 0: nothing is taken off.

    Attributes
    ----------
    wrench : (6,)
        What to take off, S, N and N·m; 0 until it is done.
    over : bool
        Whether it is done, or was given up.
    """

    def __init__(self, seconds: float) -> None:
        self._left = seconds
        self._sum = np.zeros(6)
        self._count = 0
        self.wrench = np.zeros(6)
        self.over = seconds <= 0

    def take(self, wrench: NDArray[np.float64], count: int, dt: float) -> None:
        """Take the mean wrench (6,) of `count` samples of a period of dt (s)."""
        if self.over:
            return
        self._sum += count * wrench
        self._count += count
        self._left -= dt
        if self._left > 1e-9:
            return
        self.over = True
        mean = self._sum / self._count
        if (np.abs(mean[:3]) < _MOST_N).all() and (np.abs(mean[3:]) < _MOST_NM).all():
            self.wrench = mean
