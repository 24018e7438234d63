"""Soft tissue as a bed of springs under a probe: what the scenes that press on it share."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.contact.footprint import spread
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
    physics,
    sensed_body,
)

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
