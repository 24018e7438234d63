"""The methods that every speed-against-error report compares, behind one signature.

Each takes a probe, the noise, the gates and the touch model, and gives a :class:`ContactMethod`. Rivals answer with one
contact or none and no doubt: only contactbench weighs touches against each other, says ``ambiguous``, ``by_region`` and
``implausible``, and uses regions, noise and model for more than the uncertainty of the point.

=============  ========================================================================================
algorithm1     the paper's loop taken literally: one 4x4 solve a plane, priority planes first, first accepted
               wins; compiled
wrench_axis    k = 0: the wrench axis as a ray against the mesh, by Embree (extra ``embree``)
iterative      Levenberg-Marquardt on a paraboloid fitted to the contact face; compiled, or by SciPy
scan           the closed form for any k over every facet, the smallest local torque wins; compiled
contactbench   the likeliest touch, with every other one that explains the wrench about as well
=============  ========================================================================================
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline import kernel
from contactbench.pipeline.contact.solver import ContactSolver
from contactbench.pipeline.contact.touch_model import TouchModel, WrenchNoise
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.installation import remedy
from contactbench.pipeline.kernel import Batch, Contact
from contactbench.pipeline.mesh import Probe

Float = NDArray[np.float64]
_FACING = np.cos(np.radians(45.0))
_FACE_DEPTH = 0.1  # of the probe's size, below its tip


class WrenchAxis(ABC):
    """The first facet that the wrench axis enters, looking along the force; how it is found is left open.

    Assumes k = 0: ``p x F = M - (M . F) F / |F|^2``, so p is where the axis
    ``r = F x M / |F|^2 + t F`` meets the surface. A ray tracer finds the facet in single precision; the point is
    then computed on that facet's plane in double precision.
    """

    def __init__(self, solver: ContactSolver) -> None:
        self._solver = solver
        probe = solver.probe
        self._offset = np.einsum("ij,ij->i", probe.normals, probe.vertices[probe.faces[:, 0]])
        # Away from the origin single precision would blur the mesh: trace about its centre.
        self._centre = probe.bounds.mean(axis=0)
        self._far = 2.0 * float(np.linalg.norm(np.diff(probe.bounds, axis=0))) + probe.size
        self._single = (probe.vertices - self._centre).astype(np.float32), probe.faces.astype(np.int32)

    @abstractmethod
    def trace(self, origins: NDArray[np.float32], directions: NDArray[np.float32]) -> NDArray[np.int32]:
        """Return the first facet that each ray (n, 3), (n, 3) enters, (n,); -1 for none."""

    def rays(self, wrenches: Float) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Return origins (n, 3) about the mesh centre, m, and unit directions (n, 3), upstream of the probe."""
        with np.errstate(all="ignore"):  # a wrench without force gives NaN, which hits nothing
            directions = wrenches[:, :3] / np.linalg.norm(wrenches[:, :3], axis=1, keepdims=True)
            moments = wrenches[:, 3:] - np.cross(self._centre, wrenches[:, :3])
            foot = np.cross(wrenches[:, :3], moments) / np.sum(wrenches[:, :3] ** 2, axis=1, keepdims=True)
        origins = foot - self._far * directions
        return origins.astype(np.float32), directions.astype(np.float32)

    def locate_batch(self, wrenches: ArrayLike) -> Batch:
        """Locate each row of (n, 6): Fx Fy Fz Mx My Mz in S, N and N·m."""
        rows = np.ascontiguousarray(wrenches, dtype=np.float64).reshape(-1, 6)
        origins, directions = self.rays(rows)
        usable = np.isfinite(origins).all(axis=1) & np.isfinite(directions).all(axis=1)
        faces = np.full(len(rows), -1, dtype=np.int32)
        if usable.any():
            faces[usable] = self.trace(origins[usable], directions[usable])
        points = self._points(rows, faces)
        return self._solver.foreign_batch(rows, points, faces, np.zeros(len(rows)))

    def locate(self, wrench: ArrayLike) -> Contact:
        """Locate the contact of one wrench (6,)."""
        return self.locate_batch(np.reshape(np.asarray(wrench, dtype=np.float64), (1, 6)))[0]

    def _points(self, rows: Float, faces: NDArray[np.int32]) -> Float:
        points = np.full((len(rows), 3), np.nan)
        hit = np.flatnonzero(faces >= 0)
        force, torque = rows[hit, :3], rows[hit, 3:]
        normal = self._solver.probe.normals[faces[hit]]
        along = np.einsum("ij,ij->i", normal, force)
        faces[hit[along >= 0]] = -1  # the back of an open or inside-out mesh: no push
        hit, force, torque, normal, along = (a[along < 0] for a in (hit, force, torque, normal, along))
        foot = np.cross(force, torque) / np.sum(force**2, axis=1, keepdims=True)
        t = (self._offset[faces[hit]] - np.einsum("ij,ij->i", normal, foot)) / along
        points[hit] = foot + t[:, None] * force
        return points


class EmbreeAxis(WrenchAxis):
    """The wrench axis traced by Embree.

    Raises
    ------
    InputError
        Embree's bindings are not installed.
    """

    def __init__(self, solver: ContactSolver) -> None:
        try:
            scene_module = import_module("embreex.rtcore_scene")
            mesh_module = import_module("embreex.mesh_construction")
        except ImportError as error:
            raise InputError(f"the wrench_axis method needs Embree: {arg(remedy('embree'))}") from error
        super().__init__(solver)
        self.scene = scene_module.EmbreeScene()
        self._mesh = mesh_module.TriangleMesh(self.scene, *self._single)

    def trace(self, origins: NDArray[np.float32], directions: NDArray[np.float32]) -> NDArray[np.int32]:
        """Return the first facet that each ray enters; see `WrenchAxis`."""
        faces: NDArray[np.int32] = self.scene.run(origins, directions, query="INTERSECT")
        return faces


@dataclass(frozen=True)
class ContactMethod:
    """One way to locate contacts."""

    name: str  # As in :data:`METHODS`
    locate: Callable[[ArrayLike], Contact]  # (6,) wrench in S, N and N·m -> Contact
    locate_batch: Callable[[ArrayLike], Batch]  # (n, 6) wrenches -> Batch, each row on its own
    # What does the work; compiled ones have ``time_each(wrenches)`` -> nanoseconds of each solve
    engine: Any = field(repr=False, compare=False, default=None)


class MakeMethod(Protocol):
    """Makes a method for a probe."""

    def __call__(
        self,
        probe: Probe,
        noise: WrenchNoise | None = None,
        gates: Gates | None = None,
        model: TouchModel | None = None,
    ) -> ContactMethod:
        """Return it, with the sensor's noise, what is asked of a contact, and what is known of a touch."""


def _method(engine: Callable[[ContactSolver], Any]) -> MakeMethod:
    """Return what makes a method of a probe, its noise, gates and touch model: `engine` does the work."""

    def made(
        probe: Probe,
        noise: WrenchNoise | None = None,
        gates: Gates | None = None,
        model: TouchModel | None = None,
    ) -> ContactMethod:
        built = engine(ContactSolver(probe, noise, gates, model))
        return ContactMethod(engine.__name__, built.locate, built.locate_batch, built)

    made.__doc__ = engine.__doc__
    return made


@_method
def contactbench(solver: ContactSolver) -> Any:
    """Return the solver: the likeliest touch and its rivals, with reason, confidence and uncertainty."""
    return solver


@_method
def scan(solver: ContactSolver) -> Any:
    """Return the closed form over every facet: the limit of an infinite torsion arm and no noise."""
    return kernel.Scan(solver)


@_method
def algorithm1(solver: ContactSolver) -> Any:
    """Return Algorithm 1 of Cao et al. (2023), literally."""
    return kernel.Algorithm1(solver)


@_method
def wrench_axis(solver: ContactSolver) -> Any:
    """Return the wrench-axis method: no local torque, the first facet that the axis enters.

    Raises
    ------
    InputError
        Embree's bindings are not installed.
    """
    return EmbreeAxis(solver)


@_method
def iterative(solver: ContactSolver) -> Any:
    """Return Levenberg-Marquardt on a paraboloid fitted to the contact face.

    Raises
    ------
    InputError
        There is no contact face to fit.
    """
    surface = fit_contact_face(solver.probe)
    return kernel.Iterative(solver, surface.origin_S, surface.axes_S, surface.coefficients, surface.reach)


METHODS: dict[str, MakeMethod] = {
    "contactbench": contactbench,
    "scan": scan,
    "algorithm1": algorithm1,
    "wrench_axis": wrench_axis,
    "iterative": iterative,
}


def make(
    name: str,
    probe: Probe,
    noise: WrenchNoise | None = None,
    gates: Gates | None = None,
    model: TouchModel | None = None,
) -> ContactMethod:
    """Build a method by name.

    Raises
    ------
    InputError
        There is no method of this name.
    """
    if name not in METHODS:
        raise InputError(f"there is no method {arg(name)!r}: choose one of {arg(', '.join(METHODS))}")
    return METHODS[name](probe, noise, gates, model)


@dataclass(frozen=True, eq=False)
class Paraboloid:
    """``z = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2`` in a frame on the contact face.

    Attributes
    ----------
    origin_S : (3,) S, m
    axes_S : (3, 3) rows are the x, y and outward z axis, unit, in S
    coefficients : (6,) c0 [m], c1, c2, c3 [1/m], c4 [1/m], c5 [1/m]
    reach : float
        Distance from the origin, m, beyond which a solution is a failure: 1.5 times the fitted patch.
    rms : float
        Root mean square of the fit's residual, m.
    """

    origin_S: Float
    axes_S: Float
    coefficients: Float
    reach: float
    rms: float


def contact_face(probe: Probe) -> NDArray[np.bool_]:
    """Return which facets (m,) a technician would fit: the regions, or else the face at the probe's tip."""
    if np.any(probe.region > 0):
        return np.asarray(probe.region > 0)
    centroids = probe.vertices[probe.faces].mean(axis=1)
    axis = centroids.mean(axis=0)
    length = float(np.linalg.norm(axis))
    axis = axis / length if length > 1e-9 * probe.size else np.array([0.0, 0.0, 1.0])
    height = centroids @ axis
    return np.asarray((probe.normals @ axis > _FACING) & (height > height.max() - _FACE_DEPTH * probe.size))


def fit_contact_face(probe: Probe) -> Paraboloid:
    """Fit the contact face by area-weighted least squares.

    Raises
    ------
    InputError
        Fewer than six facets make up the face.
    """
    chosen = np.flatnonzero(contact_face(probe))
    if len(chosen) < 6:
        raise InputError(
            "the iterative method needs a contact face of at least six facets; mark one as a region"
        )
    weight = probe.areas[chosen]
    points = probe.vertices[probe.faces[chosen]].mean(axis=1)
    origin = np.average(points, axis=0, weights=weight)
    outward = np.average(probe.normals[chosen], axis=0, weights=weight)
    z = outward / np.linalg.norm(outward)
    x = np.cross([0.0, 1.0, 0.0] if abs(z[1]) < 0.9 else [1.0, 0.0, 0.0], z)
    x /= np.linalg.norm(x)
    axes = np.array([x, np.cross(z, x), z])
    local = (points - origin) @ axes.T
    design = _monomials(local[:, 0], local[:, 1])
    root = np.sqrt(weight / weight.mean())
    coefficients, *_ = np.linalg.lstsq(design * root[:, None], local[:, 2] * root, rcond=None)
    residual = design @ coefficients - local[:, 2]
    reach = 1.5 * float(np.linalg.norm(local[:, :2], axis=1).max())
    return Paraboloid(
        origin, axes, coefficients, reach, float(np.sqrt(np.average(residual**2, weights=weight)))
    )


def _monomials(x: Float, y: Float) -> Float:
    return np.column_stack([np.ones_like(x), x, y, x * x, x * y, y * y])
