"""
A small tip that presses one place: with so much force, at such an angle, with such a torsion; held still or on a wrist.

The smallest scene: a probe on its sensor, held still, and a tip that presses one place of it. Left out: the arm, the
room, the probe's own bending, tissue. The sensor does not move, so there is no inertia. What stays is what a touch of a
marker is made of: a contact with friction and torsion on the true surface, the probe's weight, and a tip that comes to
rest.

The same with the tool on a wrist that takes any orientation, for gravity calibration. Left out: the arm behind the
wrist (its reach, its joints and their ripple), the room, tissue. The wrist turns as it is told, on a smooth path, with
the weight and the inertia of the tool on the sensor; it yields to a push as a stiff arm.
"""

from dataclasses import dataclass
from math import cos, radians, sin
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.simulation.scenes.physics import (
    OTHER,
    PROBE,
    Payload,
    PhysicsScene,
    SceneMoment,
    TrueSurface,
    add_facets,
    facets_near,
    new_spec,
    physics,
    sensed_body,
)

_WRIST_INERTIA = 0.05  # kg·m², of what turns with the tool
_STIFF = 200.0  # rad/s: 10 N at the tip bend the wrist by some hundredths of a degree
_SPEED = np.radians(60.0)  # mean turning speed of a move without a time of its own
_SHORTEST_S = 0.3
_FASTEST, _HARDEST = np.radians(1000.0), 2000.0  # rad/s in the mean, rad/s² at most
_PEAK = 10 / np.sqrt(3)  # largest acceleration of a path, times angle / seconds²
MOST_BUMP_N, MOST_LEVER_M = 1e3, 10.0
_HEIGHT_M = 0.5
PROBE_BIT, TIP_BIT = 1, 2
_HOLDER = "holder"
_GAP_M = 0.0005  # how far above the surface the tip waits
_APPROACH_N = 0.5  # N, until it touches: sideways force before that would only push it away
_REST_S = 0.05  # after first touch, before it leans: a tip that still bounces would slip
_RAMP_S = 0.15
_MOST_TORSION_NM = 10.0


@dataclass(frozen=True)
class Tip:
    """
    The indenter's end: a hard ball on a carriage that moves freely and turns about the surface's normal.

    Attributes
    ----------
    radius : float
        m.
    mass : float
        Of the carriage, kg.
    friction : float
        Coefficient of sliding friction: 1 holds up to 45 degrees.
    torsional_friction : float
        Torque about the normal that is held, over the normal force, m.
    damping : float
        Of the carriage, N·s/m: what comes to rest within the ramp.
    """

    radius: float = 0.0015
    mass: float = 1.0
    friction: float = 1.0
    torsional_friction: float = 0.001
    damping: float = 40.0

    def geometry(self, step: float) -> dict[str, Any]:
        """Return what a pair of surfaces is made of: as hard as the time step, s, allows."""
        return {
            "condim": 4,
            "friction": [self.friction, self.torsional_friction, 1e-4],
            # The shortest time constant that stays stable: a softer contact lets the tip sink in.
            "solref": [2.0 * step, 1.0],
            "solimp": [0.99, 0.99, 0.001, 0.5, 2.0],
        }


@dataclass(frozen=True)
class TipPress:
    """
    How the tip presses.

    Attributes
    ----------
    force : float
        |F|, N; 0 lifts it.
    tilt : float
        Angle between the force and the inward normal, degrees.
    azimuth : float
        Where the force leans to, degrees about the normal: 0 along the image plane (S's x axis), 90 across it.
    torsion : float
        Torque about the outward normal, N·m; up to 10 either way.
    """

    force: float = 0.0
    tilt: float = 0.0
    azimuth: float = 0.0
    torsion: float = 0.0

    def __post_init__(self) -> None:
        values = (self.force, self.tilt, self.azimuth, self.torsion)
        possible = 0 <= self.force <= 1e3 and 0 <= self.tilt < 90 and abs(self.torsion) <= _MOST_TORSION_NM
        if not np.isfinite(values).all() or not possible:
            raise InputError(
                f"press {arg(values)}: give a force from 0 to 1000 N, a tilt from 0 to under 90 degrees, and"
                f" a torsion of at most {arg(_MOST_TORSION_NM):g} N·m."
            )


def add_indenter(spec: Any, tip: Tip, step: float) -> None:
    """Add the tip and its holder to a model; the holder is put where it is wanted by `Indenter.place`."""
    mujoco = physics()
    holder = spec.worldbody.add_body(name=_HOLDER, mocap=True)
    body = holder.add_body(
        name=OTHER,
        pos=[0.0, 0.0, tip.radius + _GAP_M],
        mass=tip.mass,
        inertia=np.full(3, 1e-4),
        explicitinertial=True,
        gravcomp=1.0,
    )
    for axis in np.eye(3):
        body.add_joint(type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis, damping=tip.damping)
    # It does not roll: the only turn is the one that friction about the normal resists.
    body.add_joint(type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 0, 1], damping=0.02)
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[tip.radius, 0, 0],
        contype=TIP_BIT,
        conaffinity=PROBE_BIT,
        **tip.geometry(step),
    )


class Indenter:
    """
    Moves the tip of a compiled model.

    Parameters
    ----------
    model, data
        Of MuJoCo, with `add_indenter`.
    """

    def __init__(self, model: Any, data: Any) -> None:
        self._data = data
        body = model.body(OTHER)
        first = int(body.jntadr[0])
        self._dofs = slice(int(model.jnt_dofadr[first]), int(model.jnt_dofadr[first]) + 4)
        self._qpos = slice(int(model.jnt_qposadr[first]), int(model.jnt_qposadr[first]) + 4)
        self._holder = int(model.body(_HOLDER).mocapid[0])
        self._sensor = int(model.sensor("contact").adr[0])
        self._wanted, self._from, self._since = np.zeros(4), np.zeros(4), 0.0
        self._touched = False

    def place(self, point_W: Floats, normal_W: Floats, along_W: Floats) -> None:
        """Put the holder above a point, m; azimuth 0 is `along_W`, as far as it lies in the surface."""
        x = along_W - (along_W @ normal_W) * normal_W
        if np.linalg.norm(x) < 1e-6:
            raise InputError(
                "the indenter's azimuth: the surface faces along its axis of reference; give another."
            )
        x = x / np.linalg.norm(x)
        R = np.column_stack([x, np.cross(normal_W, x), normal_W])
        self._data.mocap_pos[self._holder] = point_W
        self._data.mocap_quat[self._holder] = Rotation.from_matrix(R).as_quat(scalar_first=True)
        self._data.qpos[self._qpos], self._data.qvel[self._dofs] = 0.0, 0.0
        self._touched = False
        self.press(TipPress())

    def press(self, press: TipPress) -> None:
        """Go over to another force, direction and torsion, within a ramp."""
        tilt, azimuth = radians(press.tilt), radians(press.azimuth)
        self._from, self._since = self._now(), float(self._data.time)
        self._wanted = np.array(
            [
                press.force * sin(tilt) * cos(azimuth),
                press.force * sin(tilt) * sin(azimuth),
                -press.force * cos(tilt),
                press.torsion,
            ]
        )

    def control(self) -> None:
        """Set what pushes the tip in the next step."""
        if self._wanted[2] == 0.0:  # lifted: back to where it waits
            self._touched = False
            self._data.qfrc_applied[self._dofs] = -200.0 * self._data.qpos[self._qpos]
            return
        if not self._touched:
            self._touched = bool(self._data.sensordata[self._sensor])
            self._since = float(self._data.time) + _REST_S
            self._from = np.array([0.0, 0.0, -_APPROACH_N, 0.0])
        self._data.qfrc_applied[self._dofs] = self._now()

    @property
    def steady(self) -> bool:
        """Whether the tip touches and presses as it was told; how it moves is another matter."""
        return self._touched and float(self._data.time) >= self._since + _RAMP_S

    def _now(self) -> Floats:
        share = min(1.0, max(0.0, (float(self._data.time) - self._since) / _RAMP_S))
        return self._from + share * (self._wanted - self._from)


# ---- the smallest scene --------------------------------------------------------------------------


STEP_S = 0.0005
PATCH_M = 0.005  # how much of the surface a tip can reach that slips
_SETTLED_MPS = 5e-5
_LONGEST_S = 3.0
FORCE_N = (8.0, 10.0)
_TORSION_M = 0.0003  # N·m per N: torsional friction of a patch of 1.5 mm
_MOST_TORSION_M = 0.0006  # more would turn the tip


class TouchScene(PhysicsScene):
    """
    A tip above one point of a probe.

    Parameters
    ----------
    truth : TrueSurface
        The true surface.
    marker_S : array_like (3,)
        m; the tip aims at the nearest point of the surface, along the normal there.
    payload : Payload, optional
        Its weight is in the readings.
    R_WS : (3, 3), optional
        How the sensor is held; upright when left out.
    tip : Tip, optional
    step : float
        s.

    Raises
    ------
    InputError
        MuJoCo is missing, or the surface is not there or too fine.
    """

    def __init__(
        self,
        truth: TrueSurface,
        marker_S: ArrayLike,
        *,
        payload: Payload | None = None,
        R_WS: Floats | None = None,
        tip: Tip | None = None,
        step: float = STEP_S,
    ) -> None:
        R = np.eye(3) if R_WS is None else np.asarray(R_WS, dtype=np.float64)
        tip = tip or Tip()
        self.marker_S, normal_S = truth.nearest(marker_S)
        spec = new_spec(step)
        held = spec.worldbody.add_body(quat=Rotation.from_matrix(R).as_quat(scalar_first=True))
        body = sensed_body(spec, held, payload or Payload())
        bits = {"contype": PROBE_BIT, "conaffinity": TIP_BIT}
        near = facets_near(truth, self.marker_S, PATCH_M)
        add_facets(spec, body, truth.probe, near, "facet", **bits, **tip.geometry(step))
        add_indenter(spec, tip, step)
        super().__init__(spec, truth)
        self.indenter = Indenter(self.model, self.data)
        self.indenter.place(R @ self.marker_S, R @ normal_S, R @ along(normal_S))

    def control(self) -> None:
        """Push the tip."""
        self.indenter.control()

    def press(self, press: TipPress) -> None:
        """Press so from now on; see `settle`."""
        self.indenter.press(press)

    def settle(self) -> SceneMoment | None:
        """Go on until the tip rests, and return the truth then; None when it does not within 3 s: it slips."""
        stop = self.time + _LONGEST_S
        while self.time < stop:
            self.advance(0.05)
            if not self.indenter.steady:
                continue
            speed = float(np.linalg.norm(self.data.qvel[:3]))
            if self.data.ncon and speed < _SETTLED_MPS:
                return self.moment()
        return None


def draw_press(rng: np.random.Generator, tilt: float, azimuth: float | None = None) -> TipPress:
    """Draw the force, 8 to 10 N, and the torsion of a press so tilted, degrees; the azimuth too, if it is left out."""
    force = rng.uniform(*FORCE_N)
    bearing = rng.uniform(0.0, 360.0) if azimuth is None else azimuth
    arm = float(np.clip(_TORSION_M * rng.standard_normal(), -_MOST_TORSION_M, _MOST_TORSION_M))
    return TipPress(force, tilt, bearing, arm * force)


def along(normal_S: Floats) -> Floats:
    """Return the direction of azimuth 0: S's x axis, the image plane of a probe; y where the surface faces along x."""
    return np.array([1.0, 0.0, 0.0]) if abs(normal_S[0]) < 0.9 else np.array([0.0, 1.0, 0.0])


class _Turn:
    """A smooth path from one orientation to another: no jump in speed or acceleration.

    Parameters
    ----------
    start, seconds : float
        s.
    R0 : (3, 3)
    axis_angle : (3,)
        The turn in the frame of R0, rad.
    """

    def __init__(self, start: float, seconds: float, R0: Floats, axis_angle: Floats) -> None:
        self._start, self._seconds, self._axis_angle = start, seconds, axis_angle
        self._begin = Rotation.from_matrix(R0).as_quat(scalar_first=True)
        self._angle = float(np.linalg.norm(axis_angle))
        self._axis = axis_angle / self._angle if self._angle else np.array([0.0, 0.0, 1.0])
        self._mujoco = physics()
        self._over = (self._on_the_way(1.0), np.zeros(3), np.zeros(3))

    def at(self, time: float) -> tuple[Floats, Floats, Floats]:
        """Return the quaternion (w first), angular velocity and acceleration in the body's frame, rad/s and rad/s²."""
        u = max((time - self._start) / self._seconds, 0.0)
        if u >= 1.0:
            return self._over
        share = u**3 * (10 + u * (-15 + 6 * u))
        rate = 30 * u**2 * (1 - u) ** 2 / self._seconds
        change = 60 * u * (1 - u) * (1 - 2 * u) / self._seconds**2
        return self._on_the_way(share), rate * self._axis_angle, change * self._axis_angle

    def _on_the_way(self, share: float) -> Floats:
        # In place: at 2 kHz a Rotation for each step would take longer than the physics.
        step, now = np.empty(4), np.empty(4)
        self._mujoco.mju_axisAngle2Quat(step, self._axis, share * self._angle)
        self._mujoco.mju_mulQuat(now, self._begin, step)
        return now


class BenchScene(PhysicsScene):
    """
    A wrist, a sensor, a probe, and a tip that waits.

    Parameters
    ----------
    truth : TrueSurface
    payload : Payload, optional
    R_WS : (3, 3), optional
        Orientation at the start; upright when left out.
    tip : Tip, optional
    step : float
        s.

    Raises
    ------
    InputError
        MuJoCo is missing.
    """

    def __init__(
        self,
        truth: TrueSurface,
        *,
        payload: Payload | None = None,
        R_WS: Floats | None = None,
        tip: Tip | None = None,
        step: float = STEP_S,
    ) -> None:
        self._payload, self._tip, self._step = payload or Payload(), tip or Tip(), step
        R = np.eye(3) if R_WS is None else np.asarray(R_WS, dtype=np.float64)
        self._turn = _Turn(0.0, 1.0, R, np.zeros(3))
        self._bump: tuple[float, Floats] = (-1.0, np.zeros(6))
        self.aimed_S: Floats | None = None
        super().__init__(self._spec(truth, None), truth)
        self._hold(R)

    # ---- what a person at the bench does -------------------------------------------------------

    def turn_to(self, R_WS: ArrayLike, seconds: float | None = None) -> float:
        """
        Turn the wrist on a smooth path, and return how long that takes, s.

        Raises
        ------
        InputError
            It is no rotation, the time is not positive or too short, or a tip presses on the tool.
        """
        R = np.asarray(R_WS, dtype=np.float64)
        if R.shape != (3, 3) or not np.allclose(R @ R.T, np.eye(3), atol=1e-6) or np.linalg.det(R) < 0:
            raise InputError("the wrist: give a rotation matrix.")
        if self.aimed_S is not None:
            raise InputError("the wrist: a tip is at the tool: release it first.")
        start = Rotation.from_quat(self._turn.at(self.time)[0], scalar_first=True).as_matrix()
        path = Rotation.from_matrix(start.T @ R).as_rotvec()
        needed = max(_SHORTEST_S, float(np.linalg.norm(path)) / _SPEED) if seconds is None else seconds
        if not 0 < needed < 1e4:
            raise InputError(f"the wrist: {arg(needed):g} s is not a valid duration: give a positive number.")
        angle = float(np.linalg.norm(path))
        shortest = max(angle / _FASTEST, float(np.sqrt(_PEAK * angle / _HARDEST)))
        if needed < shortest:
            raise InputError(
                f"the wrist: {arg(np.degrees(angle)):.0f} degrees in {arg(needed):g} s is too fast for an"
                f" arm: give {arg(shortest):.3f} s or more."
            )
        self._turn = _Turn(self.time, needed, start, path)
        return needed

    def aim(self, marker_S: ArrayLike) -> Floats:
        """
        Put the tip above the nearest point of the probe, and return that point, (3,), m.

        The wrist and the time stay as they are.
        """
        point, normal = self.truth.nearest(marker_S)
        self._rebuild(point)
        self.aimed_S = point
        site = self.data.site_xmat[self._site].reshape(3, 3)
        origin = self.data.site_xpos[self._site]
        self.indenter = Indenter(self.model, self.data)
        self.indenter.place(origin + site @ point, site @ normal, site @ along(normal))
        self.control()
        return point

    def press(self, press: TipPress) -> None:
        """Press where the tip is aimed at.

        Raises
        ------
        InputError
            It is aimed at nothing.
        """
        if self.aimed_S is None:
            raise InputError("the tip has no target: aim at a marker first.")
        self.indenter.press(press)

    def release(self) -> None:
        """Take the tip away from the tool at once."""
        if self.aimed_S is not None:
            self._rebuild(None)
            self.aimed_S = None
            self.control()

    def bump(self, force_S: ArrayLike, seconds: float, lever_S: ArrayLike = (0.0, 0.0, 0.1)) -> None:
        """
        Push the tool at a point of S, m, with a force, N, for some time, s.

        Raises
        ------
        InputError
            A number is not finite, or larger than 1000 N or 10 m.
        """
        force, lever = np.asarray(force_S, float), np.asarray(lever_S, float)
        if force.shape != (3,) or lever.shape != (3,) or not np.isfinite([*force, *lever, seconds]).all():
            raise InputError("a bump: give a force and a lever of three finite numbers.")
        if np.linalg.norm(force) > MOST_BUMP_N or np.linalg.norm(lever) > MOST_LEVER_M:
            raise InputError(
                f"a bump: give a force of at most {arg(MOST_BUMP_N):g} N on a lever of at most {arg(MOST_LEVER_M):g} m."
            )
        self._bump = (self.time + seconds, np.concatenate([force, np.cross(lever, force)]))

    # ---- physics -------------------------------------------------------------------------------

    def control(self) -> None:
        """Hold the wrist on its path, push the tip, and bump."""
        target, rate, change = self._turn.at(self.time)
        off = np.empty(3)
        self.mujoco.mju_subQuat(off, target, self.data.qpos[:4])
        wanted = np.zeros(self.model.nv)
        wanted[:3] = change + _STIFF**2 * off + 2 * _STIFF * (rate - self.data.qvel[:3])
        force = np.empty(self.model.nv)
        self.mujoco.mj_mulM(self.model, self.data, force, wanted)
        self.data.qfrc_applied[:3] = force[:3] + self.data.qfrc_bias[:3]
        if self.aimed_S is not None:
            self.indenter.control()
        self._push()

    def _push(self) -> None:
        until, wrench_S = self._bump
        if until < 0:
            return
        body = self.model.body(PROBE).id
        if self.time >= until:
            self.data.xfrc_applied[body] = 0.0
            self._bump = (-1.0, wrench_S)
            return
        site = self.data.site_xmat[self._site].reshape(3, 3)
        force, torque = site @ wrench_S[:3], site @ wrench_S[3:]
        # MuJoCo applies it at the centre of mass, not at S.
        arm = self.data.xipos[body] - self.data.site_xpos[self._site]
        self.data.xfrc_applied[body] = np.concatenate([force, torque - np.cross(arm, force)])

    def _spec(self, truth: TrueSurface, point: Floats | None) -> Any:
        mujoco = physics()
        spec = new_spec(self._step)
        wrist = spec.worldbody.add_body(
            pos=[0, 0, _HEIGHT_M],
            mass=1.0,
            # Left out, MuJoCo takes the body's own place for that of its mass.
            ipos=[0, 0, 0],
            iquat=[1, 0, 0, 0],
            inertia=np.full(3, _WRIST_INERTIA),
            explicitinertial=True,
        )
        wrist.add_joint(name="wrist", type=mujoco.mjtJoint.mjJNT_BALL)
        body = sensed_body(spec, wrist, self._payload)
        add_indenter(spec, self._tip, self._step)
        if point is not None:
            near = facets_near(truth, point, PATCH_M)
            bits = {"contype": PROBE_BIT, "conaffinity": TIP_BIT}
            add_facets(spec, body, truth.probe, near, "facet", **bits, **self._tip.geometry(self._step))
        return spec

    def _rebuild(self, point: Floats | None) -> None:
        """Compile the model with another patch of surface; wrist and time go on.

        The new model holds nothing yet: without `control` after it, a sensor would see the wrist fall at this moment.
        """
        before = self.data
        self._compile(self._spec(self.truth, point))
        self.data.time = before.time
        self.data.qpos[:4], self.data.qvel[:3] = before.qpos[:4], before.qvel[:3]
        self.mujoco.mj_forward(self.model, self.data)

    def _hold(self, R_WS: Floats) -> None:
        self.data.qpos[:4] = Rotation.from_matrix(R_WS).as_quat(scalar_first=True)
        self.mujoco.mj_forward(self.model, self.data)
