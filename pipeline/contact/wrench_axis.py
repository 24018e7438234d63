"""The wrench axis as a ray, traced by Embree: what contact sensing was before local torque."""

from abc import ABC, abstractmethod
from importlib import import_module

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.contact.solver import ContactSolver
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.installation import remedy
from contactbench.pipeline.kernel import Batch, Contact

Float = NDArray[np.float64]


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
