"""
A probe on a position-controlled mount, over a soft phantom on a platform that moves with six axes.

Left out: the arm that would carry the mount (its joints, limits and bending), what tissue does sideways and between its
places. The mount follows its set-points with 60 rad/s, as an arm's servo, and carries weight and inertia of the tool on
its sensor; neither it nor the platform stands more than 0.1 mm off under 7 N.

On a convex probe at 7 N and a motion as of the paper's quickest, half the time step changes the force by 0.02 N and
the place by 0.01 mm, four times as many places change them by 0.2 N and 0.09 mm; without friction the force leans by
0.3 degrees less.

The phantom is a bed of springs: each place of the face is pushed by its own depth times the foundation modulus, and by
nothing else.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from contactbench.pipeline.contact.patch import spread
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.simulation.scenes.indenter import PROBE_BIT, TIP_BIT
from contactbench.pipeline.simulation.scenes.physics import (
    OTHER,
    PROBE,
    Payload,
    PhysicsScene,
    SceneMoment,
    TrueSurface,
    new_spec,
    physics,
    sensed_body,
)
from contactbench.pipeline.simulation.scenes.setpoints import ServoPath

BALL_M = 0.001
PLACES = 100
# MuJoCo's impedance d, the same at every depth: then a contact is a linear spring, f = (k r - a) / R. The second part
# acts like a mass 1 / R on each place; so small a d leaves a gram of it.
_SHARE = 1e-3
_CARRIAGE_KG, _CARRIAGE_GYRATION = 5.0, 0.17
_REACH_M = 0.01  # how far the centroid of a bulged area may lie inside the probe
# Nearer to the far side than to the top, it would push out there: soft tissue lets a narrow face in by 25 mm.
_HALF_HEIGHT_M = 0.06


@dataclass(frozen=True)
class TissueCourse:
    """
    How stiff tissue becomes while it is pressed: a rib that slides under, a bubble, tissue that creeps.

    Attributes
    ----------
    times : tuple of float
        s, of the scene, growing.
    factors : tuple of float
        Of the modulus and the damping at those times. Between two times the logarithm goes evenly; before the first and
        after the last it rests.

    Raises
    ------
    InputError
        Times do not grow, factors are not positive, or there are not as many of both.
    """

    times: tuple[float, ...]
    factors: tuple[float, ...]

    def __post_init__(self) -> None:
        times, factors = np.asarray(self.times), np.asarray(self.factors)
        right = len(times) == len(factors) > 0 and np.isfinite(times).all() and np.isfinite(factors).all()
        if not (right and (np.diff(times) > 0).all() and (factors > 0).all()):
            raise InputError(
                f"tissue: course of times {arg(self.times)} and factors {arg(self.factors)}: give as many of"
                " both, times that grow, s, and factors above 0."
            )

    def at(self, time: float) -> float:
        """Return the factor at a time, s."""
        return float(np.exp(np.interp(time, self.times, np.log(self.factors))))


@dataclass(frozen=True)
class TissueCylinder:
    """
    A phantom like a limb: under a long face that lies askew on it, it twists the probe even without friction.

    Attributes
    ----------
    radius : float
        m.
    askew : float
        Angle from the platform's x to the axis, about its z, rad.
    """

    radius: float
    askew: float = 0.0

    def __post_init__(self) -> None:
        if not (0.02 <= self.radius < np.inf and np.isfinite(self.askew)):
            raise InputError(
                f"tissue: a cylinder of {arg(self.radius)} m, {arg(self.askew)} rad askew: give at least"
                " 0.02 m, a finite angle."
            )

    @property
    def axis(self) -> Floats:
        """Its direction in the phantom's frame, whose surface faces -z, (3,)."""
        return np.array([np.cos(self.askew), -np.sin(self.askew), 0.0])

    def nearest(self, point: Floats) -> tuple[Floats, Floats]:
        """
        Return the place of the surface next to a point, and the normal out of it there, both (3,).

        Parameters
        ----------
        point : (3,)
            In the phantom's frame, m.
        """
        middle = np.array([0.0, 0.0, self.radius])
        out = point - middle
        along = (out @ self.axis) * self.axis
        normal = (out - along) / np.linalg.norm(out - along)
        return middle + along + self.radius * normal, normal


@dataclass(frozen=True)
class Tissue:
    """
    A soft phantom, flat or a cylinder.

    Attributes
    ----------
    modulus : float
        Pressure per depth, N/m³. The default is what a stamp of a probe's size feels on deep tissue of 50 kPa. How
        much that pushes depends on the shape: at 4 mm 17.2 N on the T-shape, 5.7 N on the linear and 5.0 N on the
        convex probe.
    damping : float
        Pressure per speed, N·s/m³.
    friction : float
        With gel on it, about 0.1; dry skin up to 0.6.
    half_size : float
        Of its square top, m.
    course : TissueCourse, optional
        How modulus and damping change; left out, they do not.
    cylinder : TissueCylinder, optional
        In place of the flat top.
    """

    modulus: float = 3e6
    damping: float = 5e4
    friction: float = 0.3
    half_size: float = 0.1
    course: TissueCourse | None = None
    cylinder: TissueCylinder | None = None

    def __post_init__(self) -> None:
        values = (self.modulus, self.damping, self.friction, self.half_size)
        if not np.isfinite(values).all() or min(values) < 0 or self.modulus == 0 or self.half_size == 0:
            raise InputError(f"tissue {arg(values)}: give positive numbers; damping and friction may be 0.")


class TissueScene(PhysicsScene):
    """
    A probe and tissue that pushes each place of its face by that place's own depth.

    MuJoCo lets a contact act at half its penetration, 2 mm below the skin of a probe that is pressed in by 4 mm. Here
    every force acts on the probe, at the place that feels it: the truth and the reading are those of this wrench, and
    friction turns the probe as it would. The side that moves does not feel the difference.

    A contact of some area has no one point. `SceneMoment.point_S` is where its line of action - through the centroid of
    the forces, along their sum - leaves the true surface: the centroid of a bulged area lies inside the probe, and
    with friction the nearest point to it is not on that line. Contact location without noise, on the true mesh, is
    0.17 mm (T-shape), 0.08 mm (linear) and 0.03 mm (convex) off it, RMS: the forces of an area also twist about axes
    other than the normal, which no single point explains.

    Parameters
    ----------
    spec : mujoco.MjSpec
        With a probe that `add_probe` and a phantom that `add_phantom` added.
    places : (n, 3)
        Of the face, S, m; what `add_probe` returned.
    area : float
        Of the tissue's top for each, m².
    """

    def __init__(self, spec: Any, truth: TrueSurface, tissue: Tissue, places: Floats, area: float) -> None:
        super().__init__(spec, truth)
        self.area = area
        self._tissue = tissue
        self._make_springs()
        self._places = np.full((self.model.ngeom, 3), np.nan)
        self._places[self.model.geom_bodyid == self.model.body(PROBE).id] = places

    def _touched(self, R_WS: Floats, p_WS: Floats, reading: Floats) -> SceneMoment:
        """Return the truth, and the reading, with every force where the probe feels it."""
        places, forces, moved = self._felt(R_WS, p_WS)
        reading = reading + np.concatenate([np.zeros(3), _torque(places - moved, forces)])
        total = forces.sum(axis=0)
        contact = np.concatenate([total, _torque(places, forces)])
        sizes = np.sqrt((forces * forces).sum(axis=1))
        if not sizes.any():  # they have just met: where is all that there is to say
            sizes = np.ones(len(sizes))
        centroid = sizes @ places / sizes.sum()
        push = float(np.linalg.norm(total))
        if push > 0:
            point, normal = self.truth.along(centroid, -total / push, _REACH_M)
        else:
            point, normal = self.truth.nearest(centroid)
        return SceneMoment(self.time, R_WS, reading, contact, len(places), centroid, point, normal)

    def _felt(self, R_WS: Floats, p_WS: Floats) -> tuple[Floats, Floats, Floats]:
        """Return where the probe feels forces, the forces on it, and where MuJoCo lets them act; all (n, 3) in S."""
        contacts = self.data.contact
        first = contacts.efc_address
        there = first >= 0
        # Of an elliptic cone the constraint's forces are those along the contact's axes.
        along_axes = self.data.efc_force[first[there, None] + np.arange(3)]
        pairs = contacts.geom[there]
        probe_second = self.model.geom_bodyid[pairs[:, 1]] == self.model.body(PROBE).id
        forces = np.einsum("nk,nkd->nd", along_axes, contacts.frame[there].reshape(-1, 3, 3))
        forces = np.where(probe_second, 1.0, -1.0)[:, None] * forces
        places = self._places[np.where(probe_second, pairs[:, 1], pairs[:, 0])]
        return places, forces @ R_WS, (contacts.pos[there] - p_WS) @ R_WS

    def _change_tissue(self) -> None:
        """Have the tissue be as stiff as its course says of now."""
        if self._tissue.course is not None:
            self._springs_are(self._tissue.course.at(self.time))

    def _push(self, acceleration: Floats, most: Floats | None = None) -> None:
        """Give all joints the forces that accelerate them so, gravity and each other met; at most some."""
        force = np.empty(self.model.nv)
        self.mujoco.mj_mulM(self.model, self.data, force, acceleration)
        force += self.data.qfrc_bias
        self.data.qfrc_applied[:] = force if most is None else np.clip(force, -most, most)

    def _make_springs(self) -> None:
        """Turn the tissue's figures into MuJoCo's: a contact at rest pushes with k r / R, R = (1 - d) / d A."""
        model, tissue = self.model, self._tissue
        other, probe = model.body(OTHER).id, model.body(PROBE).id
        weight = float(model.body_invweight0[other, 0] + model.body_invweight0[probe, 0])
        scale = (1 - _SHARE) * weight * self.area
        # Any contact of a pair takes these from the phantom, whose priority is higher.
        self._phantom = np.flatnonzero(model.geom_bodyid == other)
        self._springs = np.array([-tissue.modulus * scale, -tissue.damping * scale])
        self._springs_are(1.0 if tissue.course is None else tissue.course.at(0.0))

    def _springs_are(self, factor: float) -> None:
        self.model.geom_solref[self._phantom] = factor * self._springs


def _torque(places: Floats, forces: Floats) -> Floats:
    """Return the sum of places x forces, both (n, 3); numpy's own cross takes twenty times as long."""
    C = places.T @ forces
    return np.array([C[1, 2] - C[2, 1], C[2, 0] - C[0, 2], C[0, 1] - C[1, 0]])


def add_probe(
    spec: Any, parent: Any, truth: TrueSurface, payload: Payload, tissue: Tissue, count: int
) -> tuple[Floats, float]:
    """Add the sensed probe with a small ball at each of about `count` places; return them, (n, 3), and their area."""
    places, normals, area = spread(truth.probe, count)
    body = sensed_body(spec, parent, payload)
    for place, normal in zip(places, normals, strict=True):
        body.add_geom(
            type=physics().mjtGeom.mjGEOM_SPHERE,
            size=[BALL_M, 0, 0],
            pos=place - BALL_M * normal,
            contype=PROBE_BIT,
            conaffinity=TIP_BIT,
            **_skin(tissue),
        )
    return places, area


def add_phantom(body: Any, tissue: Tissue) -> None:
    """Give a body the phantom: it fills the side z > 0 of its frame, and its surface faces -z."""
    kinds = physics().mjtGeom
    if tissue.cylinder is None:
        shape = {
            "type": kinds.mjGEOM_BOX,
            "size": [tissue.half_size, tissue.half_size, _HALF_HEIGHT_M],
            "pos": [0, 0, _HALF_HEIGHT_M],
        }
    else:
        lying, _ = Rotation.align_vectors(tissue.cylinder.axis[None], [[0.0, 0.0, 1.0]])
        shape = {
            "type": kinds.mjGEOM_CYLINDER,
            "size": [tissue.cylinder.radius, tissue.half_size, 0],
            "pos": [0, 0, tissue.cylinder.radius],
            "quat": lying.as_quat(scalar_first=True),
        }
    body.add_geom(**shape, contype=TIP_BIT, conaffinity=PROBE_BIT, priority=1, **_skin(tissue))


def _skin(tissue: Tissue) -> dict[str, Any]:
    # Both sides of the pair ask for the same; the stiffness is set later, when the weights are known.
    return {
        "condim": 3,
        "friction": [tissue.friction, 0.001, 1e-4],
        "solimp": [_SHARE, _SHARE, 0.001, 0.5, 2.0],
    }


def add_six_joints(body: Any, axes: Floats | None = None) -> None:
    """Let a body move along, and then turn about, three axes: the rows of (3, 3) in its own frame; left out x, y, z."""
    mujoco = physics()
    body.mass, body.inertia = _CARRIAGE_KG, np.full(3, _CARRIAGE_KG * _CARRIAGE_GYRATION**2)
    # Left out, MuJoCo takes the body's own place and turn for those of its mass: a phantom away from the world's origin
    # would hang from a lever.
    body.ipos, body.iquat = np.zeros(3), [1.0, 0.0, 0.0, 0.0]
    body.explicitinertial = True
    for kind in (mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE):
        for axis in np.eye(3) if axes is None else axes:
            body.add_joint(type=kind, axis=axis)


PRESS_STEP_S = 0.001
SERVO = 150.0  # rad/s, how stiffly the moved side follows


DOWN = np.diag([1.0, -1.0, -1.0])  # R_BS of a tool that points down, x kept
_FASTEST = np.repeat([0.25, np.pi / 2], 3)  # m/s and rad/s, of the mount
_HARDEST = np.repeat([5.0, 30.0], 3)  # m/s² and rad/s²
_BANDWIDTH = 60.0  # rad/s, as an arm's: what jumps in acceleration shakes the tool as no machine does


class MovedScene(TissueScene):
    """
    What scenes with a phantom on a platform share: where its surface is, and how the probe stands to it.

    The platform goes where its motion says, pulled by a stiff servo that knows it beforehand. Its six joints are the
    last ones of the model.

    Parameters
    ----------
    spec, truth, tissue, places, area
        As of `TissueScene`.
    motion : PlatformMotion or None
        None: it rests.
    T_BP : (4, 4)
        Where the middle of the phantom's top rests in B, z up: the frame whose axes the motion is along and about.

    Attributes
    ----------
    R_ES : (3, 3)
    p_ES_E : (3,)
        How the sensor sits on the flange, m.
    top : float
        Height of the probe's face above S, m.
    start : (n,)
        Joints at the beginning, m and rad.
    """

    start: Floats

    def __init__(
        self,
        spec: Any,
        truth: TrueSurface,
        tissue: Tissue,
        places: Floats,
        area: float,
        *,
        motion: PlatformMotion | None,
        T_BP: Floats,
        R_ES: Floats,
        p_ES_E: Floats,
    ) -> None:
        super().__init__(spec, truth, tissue, places, area)
        self.motion, self.T_BP, self.R_ES, self.p_ES_E = motion, T_BP, R_ES, p_ES_E
        self.top = float(truth.probe.vertices[:, 2].max())
        self.data.qpos[-6:], self.data.qvel[-6:] = self._platform(0.0), self._platform_speed(0.0)

    # ---- what a controller has to do with ---------------------------------------------------------

    @property
    def joints(self) -> Floats:
        """What the encoders say, (n,)."""
        raise NotImplementedError

    @property
    def true_joints(self) -> Floats:
        """Where the joints are, (n,)."""
        raise NotImplementedError

    def command(self, joints: ArrayLike) -> None:
        """Give the servo its next set-point, (n,)."""
        raise NotImplementedError

    def joints_for(self, R_BS: Floats, p_BS_B: Floats, near: ArrayLike | None = None) -> Floats:
        """Return joints, (n,), that hold the sensor so; of several the ones found from `near`, or from `start`."""
        raise NotImplementedError

    # ---- physics and truth -------------------------------------------------------------------------

    def step(self) -> None:
        """
        Go on by one time step; the servos know the masses and the weight where everything is now.

        Raises
        ------
        PhysicsError
            See `PhysicsScene.step`.
        """
        self._change_tissue()
        # Before `mj_step` they would be those of the step before, and none at all at the first.
        self.mujoco.mj_step1(self.model, self.data)
        self.control()
        self.mujoco.mj_step2(self.model, self.data)
        if self._warnings.any():
            self._fail()

    def look(self) -> None:
        """Have the sensors tell of now, with the forces that the servos give now: what speeds up is felt by them."""
        self.mujoco.mj_step1(self.model, self.data)
        self.control()
        # Places and speeds are known by now.
        self.mujoco.mj_forwardSkip(self.model, self.data, self.mujoco.mjtStage.mjSTAGE_VEL, 0)

    def surface(self) -> tuple[Floats, Floats]:
        """
        Return the middle of the phantom's top in B, m, and the normal that points out of it, both (3,).

        Of a cylinder it is the place next to the middle of the probe's face.
        """
        # After a step the poses are those of its beginning.
        self.mujoco.mj_kinematics(self.model, self.data)
        body = self.data.body(OTHER)
        R_BO, p_BO = body.xmat.reshape(3, 3), body.xpos.copy()
        if self._tissue.cylinder is None:
            return p_BO, -R_BO[:, 2]
        R_BS = self.data.site_xmat[self._site].reshape(3, 3)
        face = self.data.site_xpos[self._site] + self.top * R_BS[:, 2]
        place, normal = self._tissue.cylinder.nearest(R_BO.T @ (face - p_BO))
        return p_BO + R_BO @ place, R_BO @ normal

    def angles(self) -> tuple[float, float]:
        """
        Return how far the phantom's normal is turned against the probe's axis, rad.

        In plane: the turn about S's y, along the long side of the face; out of plane: about its x. A probe that turns
        by them in S, as small as they are, stands upright on the phantom.
        """
        _, normal = self.surface()
        R_BS = self.data.site_xmat[self._site].reshape(3, 3)
        inward = -R_BS.T @ normal
        return float(np.arctan2(inward[0], inward[2])), float(np.arctan2(-inward[1], inward[2]))

    def held_at(self, gap: float, pose: ArrayLike | None = None) -> tuple[Floats, Floats]:
        """
        Return R_BS (3, 3) and p_BS_B (3,) of a probe upright on the phantom's middle.

        Parameters
        ----------
        gap : float
            m between them.
        pose : (6,), optional
            Where the phantom is, as `PlatformMotion.at` says; left out, where it rests.
        """
        moved = np.zeros(6) if pose is None else np.asarray(pose, dtype=np.float64)
        R_BP = self.T_BP[:3, :3]
        R_BS = R_BP @ Rotation.from_euler("XYZ", moved[3:]).as_matrix() @ DOWN
        return R_BS, self.T_BP[:3, 3] + R_BP @ moved[:3] - (self.top + gap) * R_BS[:, 2]

    def _pulled(self) -> Floats:
        """Return the acceleration (6,) with which the platform stays where it should be."""
        now = self.time
        speed = self._platform_speed(now)
        # Over the step: at a jump in speed the derivative is none, and what it begins with must fit its length.
        ahead = (self._platform_speed(now + self.step_s) - speed) / self.step_s
        off = self._platform(now) - self.data.qpos[-6:]
        return np.asarray(ahead + SERVO**2 * off + 2 * SERVO * (speed - self.data.qvel[-6:]))

    def _platform(self, time: float) -> Floats:
        return np.zeros(6) if self.motion is None else self.motion.at(time)

    def _platform_speed(self, time: float) -> Floats:
        return np.zeros(6) if self.motion is None else self.motion.speed(time)


def add_platform(spec: Any, T_BP: Floats, tissue: Tissue) -> None:
    """Add the phantom, which moves along and about the axes of P, z up."""
    turned = Rotation.from_matrix(T_BP[:3, :3] @ DOWN).as_quat(scalar_first=True)
    other = spec.worldbody.add_body(name=OTHER, pos=T_BP[:3, 3], quat=turned)
    # The inverse of DOWN is itself: its rows are the axes of P in the body's frame.
    add_six_joints(other, DOWN)
    add_phantom(other, tissue)


class PlatformScene(MovedScene):
    """
    The probe points down at the phantom; B is where the platform rests, z up.

    Parameters
    ----------
    truth : TrueSurface
    payload : Payload, optional
    tissue : Tissue, optional
    motion : PlatformMotion, optional
        Left out: it rests.
    gap : float
        m between probe and phantom at the beginning.
    step : float
        s.
    places : int
        About how many places of the face feel the tissue.
    period : float
        s between set-points.

    Attributes
    ----------
    start : (6,)
        Joints at the beginning: where the flange E, which is S, is in B (m), and turns about the moved x, y, z axes
        (rad) on top of `DOWN`.

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
        tissue: Tissue | None = None,
        motion: PlatformMotion | None = None,
        gap: float = 0.003,
        step: float = PRESS_STEP_S,
        places: int = PLACES,
        period: float = 0.02,
    ) -> None:
        tissue = tissue or Tissue()
        spec = new_spec(step)
        turned = Rotation.from_matrix(DOWN).as_quat(scalar_first=True)
        carrier = spec.worldbody.add_body(name="carrier", quat=turned)
        add_six_joints(carrier, DOWN)
        where, area = add_probe(spec, carrier, truth, payload or Payload(), tissue, places)
        add_platform(spec, np.eye(4), tissue)
        fixed = {"T_BP": np.eye(4), "R_ES": np.eye(3), "p_ES_E": np.zeros(3)}
        super().__init__(spec, truth, tissue, where, area, motion=motion, **fixed)
        self.start = np.array([0.0, 0.0, self.top + gap, 0.0, 0.0, 0.0])
        self._path = ServoPath(self.start, _FASTEST, _HARDEST, period, _BANDWIDTH, self.step_s)
        self.data.qpos[:6] = self.start

    @property
    def joints(self) -> Floats:
        """Where the mount is, (6,), as `start`: nothing is rounded."""
        return np.array(self.data.qpos[:6])

    @property
    def true_joints(self) -> Floats:
        """The same."""
        return self.joints

    def joints_for(self, R_BS: Floats, p_BS_B: Floats, near: ArrayLike | None = None) -> Floats:
        """Return joints, (6,), that hold the sensor so; there are no others, so that `near` does not count."""
        del near
        return np.concatenate([p_BS_B, Rotation.from_matrix(R_BS @ DOWN).as_euler("XYZ")])

    def command(self, joints: ArrayLike) -> None:
        """Give the mount's servo its next set-point, (6,)."""
        self._path.give(self.time, np.asarray(joints, dtype=np.float64))

    def control(self) -> None:
        """Pull both sides to where they should be, with the forces that this takes."""
        path = self._path
        path.go_on(self.time)
        off, slow = path.place - self.data.qpos[:6], path.speed - self.data.qvel[:6]
        asked = path.change + SERVO**2 * off + 2 * SERVO * slow
        self._push(np.concatenate([asked, self._pulled()]))


# ---- how a platform moves what lies on it --------------------------------------------------------


_INSTANT_S = 1e-9  # times of a scene are sums of its steps
AXES = ("x", "y", "z", "rx", "ry", "rz")


@dataclass(frozen=True, eq=False)
class PlatformMotion:
    """
    A sine along and about the axes of the platform P, z up; the turns are about the middle of the phantom's top.

    Attributes
    ----------
    amplitude : (6,)
        m along x, y, z, then rad about x, y, z.
    period : float
        s.
    start : float
        Until then it rests, s; then it begins with a jump in speed, as the paper's.
    ease : float
        For so long after the start the amplitude grows to its full size, s; 0: at once.
    """

    amplitude: Floats
    period: float
    start: float = 0.0
    ease: float = 0.0

    def __post_init__(self) -> None:
        amplitude = np.array(self.amplitude, dtype=np.float64)
        if amplitude.shape != (6,) or not np.isfinite(amplitude).all():
            raise InputError(
                f"platform: amplitude {arg(self.amplitude)}: give six finite numbers, m and rad."
            )
        if not (0 < self.period < 1e6 and 0 <= self.start < 1e6 and 0 <= self.ease < 1e6):
            raise InputError(
                f"platform: period {arg(self.period)} s, start {arg(self.start)} s, ease {arg(self.ease)} s:"
                " the period must be positive, the others 0 or more."
            )
        object.__setattr__(self, "amplitude", amplitude)

    @classmethod
    def along(cls, axis: str, size: float, period: float, start: float = 0.0) -> PlatformMotion:
        """
        Move along or about one axis.

        Parameters
        ----------
        size : float
            m or rad.
        period, start : float
            s.

        Raises
        ------
        InputError
            There is no such axis.
        """
        if axis not in AXES:
            raise InputError(f"platform: axis {arg(axis)!r}: give one of {arg(', '.join(AXES))}.")
        return cls(size * np.eye(6)[AXES.index(axis)], period, start)

    def at(self, time: float) -> Floats:
        """Return position and angles, (6,), at a time, s."""
        since = max(time - self.start, 0.0)
        share = 1.0 if self.ease == 0 else min(since / self.ease, 1.0)
        return np.asarray(self.amplitude * (share * math.sin(2 * math.pi * since / self.period)))

    def speed(self, time: float) -> Floats:
        """Return how fast they change, (6,), m/s and rad/s; where that jumps, the mean of both sides."""
        since, turn = time - self.start, 2 * math.pi / self.period
        if since < -_INSTANT_S:
            return np.zeros(6)
        if since >= self.ease - _INSTANT_S:
            share = 1.0 if since > _INSTANT_S or self.ease > 0 else 0.5
            return np.asarray(self.amplitude * (share * turn * math.cos(turn * since)))
        growing = math.sin(turn * since) + turn * since * math.cos(turn * since)
        return np.asarray(self.amplitude * (growing / self.ease))
