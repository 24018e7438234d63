"""Marked points on a probe that are touched again and again: five along the acoustic face, the others around it."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from scipy.cluster.vq import kmeans2
from scipy.spatial import cKDTree

from contactbench import assets
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.kernel import SurfaceIndex

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.mesh import Probe
    from contactbench.pipeline.mesh.arrays import Floats, Mask


COUNTS = {"t-shape": 17, "linear": 15, "convex": 15}
ON_FACE = 5

_SAMPLES = 20_000
_FACING = 0.85  # cos 32°: the whole of a convex face, little of the rounding around a flat one
_FACE_DEPTH_M, _HEAD_DEPTH_M = 0.012, 0.040
# What looks further down than this is reached past the flange only.
_LOWEST_NORMAL = -0.3
_ALONG_FACE = np.array([-0.8, -0.4, 0.0, 0.4, 0.8])
_CLEAR_OF_FACE_M = 0.006
# A tip of 1.5 mm slides off a sharper edge when it presses at an angle.
_SHARPEST_PER_M = 1 / 0.004


@cache
def _marked(name: str) -> Floats:
    surface = assets.surface(name)
    points, normals, phi, t = surface.sample(_SAMPLES, np.random.default_rng(0))
    flat = np.abs(surface.principal_curvatures(phi, t)).max(axis=1) < _SHARPEST_PER_M

    def foot(places: Floats) -> Floats:
        return surface.project(places)[0]

    marked = _placed(points, normals, flat, COUNTS[name], foot)
    marked.flags.writeable = False
    return marked


def markers(name: str) -> Floats:
    """
    Return the markers of a bundled probe, exactly on its true surface.

    Returns
    -------
    (n, 3) array
        In S, m: 17 on the T-shape, 15 on the others. The first five lie along the middle of the acoustic face, by
        increasing x, number 3 in its middle; the others are spread evenly over the sides of the head, one after the
        other around z. Read-only; the same on every call.

    Raises
    ------
    InputError
        There is no such probe.
    """
    if name not in COUNTS:
        raise InputError(f"there is no probe {arg(name)!r}: choose one of {arg(', '.join(COUNTS))}.")
    return _marked(name)


def markers_on(probe: Probe, count: int = 15) -> Floats:
    """
    Return markers of any probe, on its mesh.

    Parameters
    ----------
    probe : Probe
        Aligned: +z from the flange to the tip.
    count : int
        At least 5.

    Returns
    -------
    (count, 3) array
        In S, m, ordered as those of `markers`.

    Raises
    ------
    InputError
        There are too few of them, or no surface that a tip reaches.
    """
    if count < ON_FACE:
        raise InputError(f"{arg(count)} markers are too few: give at least {arg(ON_FACE)}.")
    rng = np.random.default_rng(0)
    facets = rng.choice(len(probe.faces), _SAMPLES, p=probe.areas / probe.areas.sum())
    shares = rng.dirichlet(np.ones(3), _SAMPLES)
    points = np.einsum("nk,nkd->nd", shares, probe.vertices[probe.faces[facets]])
    index = SurfaceIndex(probe.vertices, probe.faces)

    def foot(places: Floats) -> Floats:
        return np.asarray(index.closest(np.ascontiguousarray(places))[2])

    return _placed(points, probe.normals[facets], np.ones(_SAMPLES, bool), count, foot)


def _placed(
    points: Floats, normals: Floats, flat: Mask, count: int, foot: Callable[[Floats], Floats]
) -> Floats:
    """Return the markers out of points that are even over the surface; `foot` projects on it."""
    tip = float(points[:, 2].max())
    face = (normals[:, 2] > _FACING) & (points[:, 2] > tip - _FACE_DEPTH_M)
    if not face.any():
        raise InputError("markers: no part of the probe faces +z near its tip: check that it is aligned.")
    low, high = points[face].min(axis=0), points[face].max(axis=0)
    # In whole millimetres: the drawn points end a little before the face does, and not evenly on both sides.
    middle, half = np.round((low + high) / 2, 3), np.round((high - low) / 2, 3)
    along = np.column_stack(
        [middle[0] + _ALONG_FACE * half[0], np.full(ON_FACE, middle[1]), np.full(ON_FACE, tip)]
    )
    first = foot(along)
    beside, _ = cKDTree(points[face]).query(points)
    side = flat & ~face & (beside > _CLEAR_OF_FACE_M)
    side &= (points[:, 2] > tip - _HEAD_DEPTH_M) & (normals[:, 2] > _LOWEST_NORMAL)
    if np.count_nonzero(side) < count:
        raise InputError("markers: the probe has no sides that a tip can reach: check that it is aligned.")
    others = foot(_spread(points[side], count - ON_FACE))
    turn = np.arctan2(others[:, 1], others[:, 0] - middle[0])
    return np.concatenate([first, others[np.argsort(turn)]])


def _spread(points: Floats, count: int) -> Floats:
    """Return the points that lie in the middle of `count` equal parts."""
    if count == 0:
        return np.empty((0, 3))
    chosen = [int(np.argmin(points[:, 0]))]
    distance = np.linalg.norm(points - points[chosen[0]], axis=1)
    while len(chosen) < count:
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
    middles, _ = kmeans2(points, points[chosen], iter=30, minit="matrix")
    # A part that bends around the head has its middle inside: the nearest point is on the surface.
    return points[cKDTree(points).query(middles)[1]]
