"""Three ultrasound probes of true size, with flange, neck, handle and acoustic head."""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BSpline

from contactbench.assets.surface import Arc, Shoulder, Station, Surface, Warp
from contactbench.assets.triangulation import tessellate

Array = NDArray[np.float64]

PROBE_NAMES = ("linear", "convex", "t-shape")

_MM = 1e-3
_DEGREE = 3
_GROWTH = 1.6  # of the control points' spacing along a straight leg
_FACING = np.cos(np.radians(45.0))


class Corner(NamedTuple):
    """A corner of a probe's outline.

    Half widths ``a``, ``b`` and height ``z`` are in millimetres, ``m`` is the section's exponent, and the
    corner is rounded over the length ``soft`` [mm] on either side. Meshes follow the corner if ``lag`` is
    given: the followed curve lies that much lower [mm] on the broad sides.
    """

    a: float
    b: float
    z: float
    m: float
    soft: float
    lag: float | None = None


class Design(NamedTuple):
    """A probe's outline from the middle of the base to the middle of the face, and its shear."""

    outline: tuple[Corner, ...]
    warp: Warp | None
    face_depth: float
    """How far below the tip the acoustic face may reach [m]."""


# The flange disc of a tool changer and the round neck above it are the same on every probe.
_MOUNT = (
    Corner(0, 0, 0, 2, 0),
    Corner(25, 25, 0, 2, 2.4, lag=0),
    Corner(25, 25, 8, 2, 2.4, lag=0),
    Corner(11, 11, 8, 2, 2.6, lag=0),
)

_LINEAR = Design(
    outline=(
        *_MOUNT,
        Corner(11, 11, 20, 2, 4),
        Corner(15, 12.5, 38, 2.6, 9),
        Corner(13.5, 11.5, 82, 2.6, 10),
        Corner(24, 9.5, 112, 4, 7),
        Corner(24, 9.0, 130, 5, 3, lag=0),
        Corner(21.5, 5.75, 136, 5.5, 2.2, lag=0),
        Corner(21.5, 5.75, 150, 6, 1.9, lag=0),
        Corner(15.75, 0, 150, 4, 0),
    ),
    warp=None,
    face_depth=3 * _MM,
)

_CONVEX = Design(
    outline=(
        *_MOUNT,
        Corner(11, 11, 20, 2, 4),
        Corner(15, 12.5, 38, 2.6, 9),
        Corner(14, 11.5, 76, 2.6, 10),
        Corner(31, 9.5, 112, 4, 7),
        Corner(31, 8, 140, 6, 2.2, lag=0),
        Corner(23, 0, 140, 4, 0),
    ),
    warp=Arc(radius=60 * _MM, start=70 * _MM, stop=130 * _MM),
    face_depth=12 * _MM,
)

# The bar's underside is at z = 104 mm: the fan's sides are slanted so that the shear lays them level.
_T_SHAPE = Design(
    outline=(
        *_MOUNT,
        Corner(11, 11, 18, 2, 4),
        Corner(15, 11, 34, 3, 6),
        Corner(15, 11, 80, 3.6, 8),
        Corner(15, 10, 104 - 0.44 * 3, 4.4, 3.0),
        Corner(40, 10, 104 + 0.44 * 22, 5, 2.4, lag=7),
        Corner(40, 10, 128, 5, 2.4, lag=0),
        Corner(30, 0, 128, 4, 0),
    ),
    warp=Shoulder(slope=0.44, inner=16 * _MM, blend=4 * _MM, foot=60 * _MM, start=113 * _MM, stop=127 * _MM),
    face_depth=3 * _MM,
)

_DESIGNS = dict(zip(PROBE_NAMES, (_LINEAR, _CONVEX, _T_SHAPE), strict=True))


@cache
def surface(name: str) -> Surface:
    """Return the exact surface of a probe.

    Parameters
    ----------
    name : {"linear", "convex", "t-shape"}
        Which probe.

    Returns
    -------
    Surface
        In frame S [m]; the same object on every call.

    Raises
    ------
    ValueError
        If there is no probe of that name.
    """
    design = _design(name)
    profile, at = _spline(design.outline)
    heights = profile(np.linspace(0, 1, 4001))[:, 2]
    stations = []
    for corner, t in zip(design.outline, at, strict=True):
        if corner.lag is not None:
            behind = np.interp(float(profile(t)[2]) - corner.lag * _MM, heights, np.linspace(0, 1, 4001))
            stations.append(Station(t, float(behind) if corner.lag else t))
    return Surface(profile, design.warp, tuple(stations))


def make(name: str, faces: int = 2000) -> tuple[Array, NDArray[np.int32]]:
    """Tessellate a probe.

    Parameters
    ----------
    name : {"linear", "convex", "t-shape"}
        Which probe.
    faces : int
        Wanted number of facets; met within 5 %.

    Returns
    -------
    vertices : (n, 3) float64 array
        On the surface, frame S [m].
    faces : (m, 3) int32 array
        Counter-clockwise seen from outside.

    Raises
    ------
    ValueError
        If there is no probe of that name, or ``faces`` is too small to close the surface.
    """
    return tessellate(surface(name), faces)


def contact_region(name: str, vertices: ArrayLike, faces: ArrayLike) -> NDArray[np.int32]:
    """Mark the facets of the acoustic face.

    Parameters
    ----------
    name : {"linear", "convex", "t-shape"}
        Which probe the mesh is of.
    vertices : (n, 3) array
        Frame S [m].
    faces : (m, 3) integer array
        Counter-clockwise seen from outside.

    Returns
    -------
    (m,) int32 array
        1 where the facet's normal is within 45 degrees of +z and its middle is near the tip, else 0.

    Raises
    ------
    ValueError
        If there is no probe of that name.
    """
    design = _design(name)
    corners = np.asarray(vertices, np.float64)[np.asarray(faces)]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = cross[:, 2] > _FACING * np.linalg.norm(cross, axis=-1)
    near_tip = corners[:, :, 2].mean(axis=1) > design.outline[-1].z * _MM - design.face_depth
    return np.asarray(facing & near_tip, np.int32)


def _design(name: str) -> Design:
    design = _DESIGNS.get(name)
    if design is None:
        raise ValueError(f"unknown probe {name!r}: choose one of {', '.join(PROBE_NAMES)}")
    return design


def _spline(outline: tuple[Corner, ...]) -> tuple[BSpline, list[float]]:
    """Round an outline's corners by a clamped cubic spline; also return each corner's parameter."""
    corners = np.array([corner[:4] for corner in outline]) * [_MM, _MM, _MM, 1]
    clusters, middles = [corners[:1]], [0.0]
    for before, here, after, corner in zip(corners, corners[1:], corners[2:], outline[1:], strict=False):
        # The inner points cut the corner in two equal turns; the outer ones keep the legs straight.
        near, far = _toward(here, before, corner.soft), _toward(here, after, corner.soft)
        steps = [step * near for step in (1.6, 1.0, 0.4)] + [step * far for step in (0.4, 1.0, 1.6)]
        clusters.append(here + np.array(steps))
        middles.append(2.5)
    clusters.append(corners[-1:])
    middles.append(0.0)
    controls, at = [clusters[0]], [0.0]
    for before, after, middle in zip(clusters, clusters[1:], middles[1:], strict=False):
        controls.append(_between(before, after))
        at.append(sum(map(len, controls)) + middle)
        controls.append(after)
    points = np.concatenate(controls)
    # Even knots keep the roundings circular, whatever lies beside them.
    inner = np.linspace(0, 1, len(points) - _DEGREE + 1)
    knots = np.concatenate([np.zeros(_DEGREE), inner, np.ones(_DEGREE)])
    greville = [knots[i + 1 : i + 1 + _DEGREE].mean() for i in range(len(points))]
    return BSpline(knots, points, _DEGREE), [
        float(t) for t in np.interp(at, np.arange(len(points)), greville)
    ]


def _between(before: Array, after: Array) -> Array:
    """Control points (n, 4) on the straight leg between two clusters, their spacing growing to its middle."""
    leg = after[0] - before[-1]
    gap = float(_length(leg))
    left, right = (
        [float(_length(part[1] - part[0]))] if len(part) > 1 else [gap / 4]
        for part in (before[-2:], after[:2])
    )
    while sum(left) + sum(right) < gap:
        side = left if left[-1] < right[-1] else right
        side.append(side[-1] * _GROWTH)
    steps = np.cumsum(left + right[::-1])
    return np.asarray(before[-1] + leg * (steps[:-1] / steps[-1])[:, None])


def _toward(here: Array, there: Array, soft: float) -> Array:
    """Vector of ``soft`` millimetres from one corner to the next; 1.6 of it never pass the leg's middle."""
    leg = there - here
    return np.asarray(leg * min(soft * _MM / float(_length(leg)), 0.31))


def _length(leg: Array) -> Array:
    """Length of legs (..., 4) along the meridian that moves most [m]."""
    return np.asarray(np.hypot(np.maximum(np.abs(leg[..., 0]), np.abs(leg[..., 1])), leg[..., 2]))
