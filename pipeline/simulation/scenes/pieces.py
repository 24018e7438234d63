"""A probe's surface in convex pieces, as MuJoCo wants it: only where something touches."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.simulation.scenes.physics import physics

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.simulation.scenes.physics import TrueSurface

_THICKNESS_M = 0.002
_FACING = 1e-3  # facets that look away from the one that is touched are its other side
_MOST_PIECES = 4_000


def facets_near(truth: TrueSurface, point_S: NDArray[np.float64], radius: float) -> NDArray[np.intp]:
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


def triangle_distances(point: NDArray[np.float64], corners: NDArray[np.float64]) -> NDArray[np.float64]:
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
