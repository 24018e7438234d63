"""The iterative rival's surface: a paraboloid fitted to the contact face."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import Probe

Float = NDArray[np.float64]

_FACING = np.cos(np.radians(45.0))
_FACE_DEPTH = 0.1  # of the probe's size, below its tip


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
