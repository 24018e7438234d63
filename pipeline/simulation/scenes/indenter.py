"""A small tip that presses one place: with so much force, at such an angle, with such a torsion.

The smallest scene: a probe on its sensor, held still, and a tip that presses one place of it.

Left out: the arm, the room, the probe's own bending, tissue. The sensor does not move, so there is no inertia. What
stays is what a touch of a marker is made of: a contact with friction and torsion on the true surface, the probe's
weight, and a tip that comes to rest.
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
