"""What all scenes share: a MuJoCo model, the sensor behind the probe, and the truth about every contact."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.calibration.model import STANDARD_GRAVITY
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.arrays import Floats
from contactbench.pipeline.robot.robot_file import import_mujoco

SENSOR, PROBE, OTHER = "S", "probe", "other"
FORCE, TORQUE, CONTACT = "force", "torque", "contact"

# Bits of what a contact sensor gives, and its way of summing up; MuJoCo has no names for them in Python.
_FOUND, _CONTACT_FORCE, _CONTACT_TORQUE, _POSITION = 1 << 0, 1 << 1, 1 << 2, 1 << 4
_NET_FORCE = 3


def physics() -> Any:
    """Return the module ``mujoco``; InputError if it is not installed."""
    return import_mujoco(message("the virtual bench"))


class PhysicsError(InputError):
    """Physics that came apart: what a scene would give from there on is not true."""


@dataclass(frozen=True, eq=False)
class Payload:
    """
    What hangs on the sensor, probe included: a rigid body.

    Attributes
    ----------
    mass : float
        kg.
    centre_of_mass_S : (3,)
        m.
    gyration : float
        Radius of gyration about the centre of mass, m: the inertia is that of a ball of this one. It matters only
        while the sensor turns.
    """

    mass: float = 0.45
    centre_of_mass_S: Floats = field(default_factory=lambda: np.array([0.003, -0.002, 0.062]))
    gyration: float = 0.04

    def __post_init__(self) -> None:
        centre = np.array(self.centre_of_mass_S, dtype=np.float64)
        if centre.shape != (3,) or not np.isfinite(centre).all():
            raise InputError(f"payload: centre of mass {arg(centre)}: give three numbers, m.")
        if not (0 < self.mass < 1000 and 0 < self.gyration < 10):
            raise InputError(
                f"payload: {arg(self.mass)} kg, gyration {arg(self.gyration)} m: give positive numbers."
            )
        object.__setattr__(self, "centre_of_mass_S", centre)


@dataclass(frozen=True, eq=False)
class SceneMoment:
    """
    The truth at one moment; all in S, the contact as what it does to the probe.

    Attributes
    ----------
    time : float
        s, of the scene.
    R_WS : (3, 3)
    reading : (6,)
        What a perfect sensor reads: contact, weight and inertia; N and N·m about the sensor's origin.
    contact : (6,)
        Wrench of all contacts together; zero in the air.
    contacts : int
        How many there are.
    centroid_S : (3,)
        Mean of the contacts' places, weighted by force, m; NaN in the air. A tip's lies at half penetration, some µm;
        those of tissue lie on the probe.
    point_S, normal_S : (3,)
        Where the contact is on the true surface, and the outward normal there; NaN in the air. A tip: the nearest
        point to the centroid. Tissue: see `TissueScene`.
    """

    time: float
    R_WS: Floats
    reading: Floats
    contact: Floats
    contacts: int
    centroid_S: Floats
    point_S: Floats
    normal_S: Floats

    @property
    def force(self) -> float:
        """|F| of the contact, N."""
        return float(np.linalg.norm(self.contact[:3]))

    @property
    def torsion(self) -> float:
        """Torque of the contact about the normal at its point, N·m; NaN in the air."""
        force, torque = self.contact[:3], self.contact[3:]
        return float((torque - np.cross(self.point_S, force)) @ self.normal_S)


class TrueSurface:
    """The true surface: where contacts are projected on.

    Parameters
    ----------
    probe : Probe
        As it really is: as fine as wanted.
    """

    def __init__(self, probe: Probe) -> None:
        self.probe = probe
        self._index = SurfaceIndex(probe.vertices, probe.faces)

    def nearest(self, point_S: ArrayLike) -> tuple[Floats, Floats]:
        """Return the nearest point of the surface and the outward normal there, both (3,)."""
        _, facets, points = self._index.closest(np.asarray(point_S, dtype=np.float64).reshape(1, 3))
        return np.asarray(points[0]), self.probe.normals[int(facets[0])]

    def facet(self, point_S: ArrayLike) -> tuple[int, float]:
        """Return the number of the facet nearest to a point, and how far it is, m."""
        point = np.asarray(point_S, dtype=np.float64).reshape(1, 3)
        _, facets, points = self._index.closest(point)
        return int(facets[0]), float(np.linalg.norm(points[0] - point[0]))

    def along(self, point_S: Floats, direction_S: Floats, reach: float) -> tuple[Floats, Floats]:
        """Return where the line through a point leaves the probe, at most `reach` m away, and the normal there.

        Parameters
        ----------
        point_S : (3,)
            m.
        direction_S : (3,)
            Out of the probe; a unit vector.
        reach : float
            m. Where the line meets no surface so near, it is the nearest point.
        """
        # Backwards from outside: a start within rounding of the surface would miss it.
        start = (point_S + reach * direction_S).reshape(1, 3)
        distances, facets = self._index.first_hit(start, np.ascontiguousarray(-direction_S).reshape(1, 3))
        if facets[0] < 0 or distances[0] > 2 * reach:
            return self.nearest(point_S)
        return start[0] - distances[0] * direction_S, self.probe.normals[int(facets[0])]


class PhysicsScene:
    """
    A compiled model and its state.

    Parameters
    ----------
    spec : mujoco.MjSpec
        With what `sensed_body` and `sense` added.
    truth : TrueSurface
    """

    def __init__(self, spec: Any, truth: TrueSurface) -> None:
        self.mujoco = physics()
        self.truth = truth
        self._compile(spec)

    def _compile(self, spec: Any) -> None:
        self.model = spec.compile()
        self.data = self.mujoco.MjData(self.model)
        self._step_s = float(self.model.opt.timestep)
        self._warnings = self.data.warning.number
        self._site = self.model.site(SENSOR).id
        first, force, torque = (int(self.model.sensor(name).adr[0]) for name in (CONTACT, FORCE, TORQUE))
        self._contact_at = slice(first, first + 10)
        self._read_at = np.r_[force : force + 3, torque : torque + 3]

    @property
    def time(self) -> float:
        """Time of the scene, s."""
        return float(self.data.time)

    @property
    def step_s(self) -> float:
        """Time step, s."""
        return self._step_s

    def control(self) -> None:
        """Set the forces of the next step; the scene's own part."""

    def step(self) -> None:
        """
        Go on by one time step.

        Raises
        ------
        PhysicsError
            The numbers grew beyond all bounds, or there are more contacts than there is room for.
        """
        self.control()
        self.mujoco.mj_step(self.model, self.data)
        if self._warnings.any():
            self._fail()

    def advance(self, seconds: float) -> None:
        """Go on by this time, to the nearest step."""
        for _ in range(round(seconds / self.step_s)):
            self.step()

    def _fail(self) -> None:
        names = [
            str(self.mujoco.mjtWarning(k).name).removeprefix("mjWARN_")
            for k in np.flatnonzero(self._warnings)
        ]
        raise PhysicsError(
            f"the physics diverged ({arg(', '.join(names))}), so later results would be wrong. Push"
            " less hard, or turn more slowly."
        )

    def look(self) -> None:
        """Have the sensors tell of now; after a step they are those of its beginning."""
        self.mujoco.mj_forward(self.model, self.data)

    def moment(self) -> SceneMoment:
        """Return the truth now."""
        self.look()
        R_WS = self.data.site_xmat[self._site].reshape(3, 3).copy()
        p_WS = self.data.site_xpos[self._site].copy()
        values = self.data.sensordata
        # MuJoCo gives what the probe does to the sensor's mount; a sensor reads the reverse.
        reading = -values[self._read_at]
        if values[self._contact_at.start] == 0:
            nowhere = np.full(3, np.nan)
            return SceneMoment(self.time, R_WS, reading, np.zeros(6), 0, nowhere, nowhere, nowhere)
        return self._touched(R_WS, p_WS, reading)

    def _touched(self, R_WS: Floats, p_WS: Floats, reading: Floats) -> SceneMoment:
        """Return the truth about a contact, as MuJoCo sums it up."""
        found, force_W, torque_W, where_W = np.split(self.data.sensordata[self._contact_at].copy(), [1, 4, 7])
        centroid = R_WS.T @ (where_W - p_WS)
        force, local = R_WS.T @ force_W, R_WS.T @ torque_W
        contact = np.concatenate([force, local + np.cross(centroid, force)])
        point, normal = self.truth.nearest(centroid)
        return SceneMoment(self.time, R_WS, reading, contact, int(found[0]), centroid, point, normal)


def new_spec(step: float, gravity: bool = True) -> Any:
    """Return an empty model with the settings that all scenes share; the time step in s."""
    mujoco = physics()
    spec = mujoco.MjSpec()
    spec.option.timestep = step
    spec.option.gravity = [0.0, 0.0, -STANDARD_GRAVITY if gravity else 0.0]
    # The pyramid is no cone: its friction depends on the direction, and so would the contact's place.
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    # Friction ten times as stiff as the normal direction: a held tip creeps by some µm/s.
    spec.option.impratio = 10.0
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    return spec


def sensed_body(spec: Any, parent: Any, payload: Payload) -> Any:
    """Add the probe's body with the sensor's frame S at its origin; contacts sensed are those with the body OTHER."""
    mujoco = physics()
    body = parent.add_body(
        name=PROBE,
        mass=payload.mass,
        ipos=payload.centre_of_mass_S,
        inertia=np.full(3, payload.mass * payload.gyration**2),
        explicitinertial=True,
    )
    body.add_site(name=SENSOR)
    kinds = mujoco.mjtSensor
    for name, kind in ((FORCE, kinds.mjSENS_FORCE), (TORQUE, kinds.mjSENS_TORQUE)):
        spec.add_sensor(name=name, type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=SENSOR)
    # With the probe second, the force is the one on it.
    spec.add_sensor(
        name=CONTACT,
        type=kinds.mjSENS_CONTACT,
        objtype=mujoco.mjtObj.mjOBJ_BODY,
        objname=OTHER,
        reftype=mujoco.mjtObj.mjOBJ_BODY,
        refname=PROBE,
        intprm=[_FOUND | _CONTACT_FORCE | _CONTACT_TORQUE | _POSITION, _NET_FORCE, 1],
    )
    return body


# ---- A probe's surface in convex pieces, as MuJoCo wants it: only where something touches --------


_THICKNESS_M = 0.002
_FACING = 1e-3  # facets that look away from the one that is touched are its other side
_MOST_PIECES = 4_000


def facets_near(truth: TrueSurface, point_S: Floats, radius: float) -> NDArray[np.intp]:
    """
    Return the facets within a radius, m, of a point on the surface, and on its side.

    Raises
    ------
    InputError
        There are none, or so many that no scene would move.
    """
    probe = truth.probe
    nearest, distance = truth.facet(point_S)
    if distance > radius:
        raise InputError(
            f"there is no surface within {arg(1e3 * radius):.3g} mm of {arg(np.round(1e3 * point_S, 1))} mm."
        )
    corners = probe.vertices[probe.faces]
    boxed = np.linalg.norm(np.maximum(corners.min(axis=1) - point_S, 0), axis=1) <= radius
    boxed &= np.linalg.norm(np.maximum(point_S - corners.max(axis=1), 0), axis=1) <= radius
    # A side that meets the touched one at a right angle looks away from it, but for rounding.
    boxed &= probe.normals @ probe.normals[nearest] > _FACING
    boxed[nearest] = True
    chosen = np.flatnonzero(boxed)
    found = chosen[triangle_distances(point_S, corners[chosen]) <= radius]
    if len(found) > _MOST_PIECES:
        raise InputError(
            f"{arg(len(found)):,} facets lie within {arg(1e3 * radius):.3g} mm of the touch: simplify the"
            " true surface to facets of half a millimetre."
        )
    return found


def triangle_distances(point: Floats, corners: Floats) -> Floats:
    """Return how far triangles (n, 3, 3) are from a point (3,), each with its inside; (n,), in the same unit."""
    edges = np.roll(corners, -1, axis=1) - corners
    arms = point - corners
    normals = np.cross(edges[:, 0], edges[:, 1])
    # Inside the prism over a triangle when it is on the left of every edge.
    left = np.einsum("nkd,nd->nk", np.cross(edges, arms), normals) >= 0
    size = np.linalg.norm(normals, axis=1)
    height = np.abs(np.einsum("nd,nd->n", arms[:, 0], normals)) / np.where(size > 0, size, 1.0)
    lengths = np.einsum("nkd,nkd->nk", edges, edges)
    share = np.einsum("nkd,nkd->nk", arms, edges) / np.where(lengths > 0, lengths, 1.0)
    feet = arms - np.clip(share, 0.0, 1.0)[..., None] * edges
    beside = np.linalg.norm(feet, axis=2).min(axis=1)
    return np.asarray(np.where(left.all(axis=1) & (size > 0), height, beside))


def add_facets(
    spec: Any, body: Any, probe: Probe, facets: NDArray[np.intp], prefix: str, **geometry: Any
) -> None:
    """
    Add facets to a body, each as a prism that reaches 2 mm inwards: together exactly the surface, convex or not.

    Parameters
    ----------
    spec : mujoco.MjSpec
    body : mujoco.MjsBody
        In S.
    facets : (k,) int
    prefix : str
        Of the pieces' names.
    **geometry
        Of every piece, such as friction.
    """
    mujoco = physics()
    for facet in facets.tolist():
        top = probe.vertices[probe.faces[facet]]
        corners = np.concatenate([top, top - _THICKNESS_M * probe.normals[facet]])
        name = f"{prefix}{facet}"
        # The inertia is the payload's; this only keeps thin pieces from being refused.
        spec.add_mesh(
            name=name, uservert=corners.ravel(), inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
        )
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, **geometry)
