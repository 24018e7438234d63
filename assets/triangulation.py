"""Closed triangle meshes of a surface with a wanted number of facets, all vertices exactly on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactbench.assets.fronts import Fronts
from contactbench.assets.stitch import improve, join, shift, triangles
from contactbench.assets.surface import Surface

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_LEAST = 100
_ROW = np.sqrt(3) / 2  # height of an equilateral triangle of unit side
_AREA = np.sqrt(3) / 4  # and its area
_FEWEST = 6  # vertices on a ring
_POINT = 1e-9  # [m] a middle segment shorter than this is a point


@dataclass(frozen=True)
class _Layout:
    """The rings of a mesh before their vertices are chosen; the last is the middle of the face."""

    t: Array
    """(rings, angles) profile parameter of each ring at the angles of the fronts."""
    arc: Array
    """(rings, angles) weighted arc length from phi = 0 [m]."""


def tessellate(surface: Surface, faces: int) -> tuple[Array, NDArray[np.int32]]:
    """Mesh a surface by rings of vertices, each stitched to its neighbours.

    The facets are nearly equilateral; they are up to about half as long where the surface bends tightly,
    so that coarse meshes keep the shape.

    Parameters
    ----------
    surface : Surface
        What to mesh.
    faces : int
        Wanted number of facets, at least 100; met within 5 % from 300 on.

    Returns
    -------
    vertices : (n, 3) float64 array
        Exactly on the surface, frame S [m].
    faces : (m, 3) int32 array
        Counter-clockwise seen from outside; every edge belongs to two facets.

    Raises
    ------
    ValueError
        If fewer than 100 facets are asked for.
    """
    if faces < _LEAST:
        raise ValueError(f"cannot close a probe with {faces} facets: ask for at least {_LEAST}")
    fronts = Fronts.of(surface)
    layout = _lay_out(surface, fronts, float(np.sqrt(fronts.area / (_AREA * faces))))
    counts = _count(layout.arc[:, -1], faces)
    phi, t = _spread(fronts.phi, layout, counts)
    names, unique = _name(counts)
    loops = surface.points(phi, t)
    strips = join(counts)
    improve(strips, loops, counts)
    return loops[unique], names[triangles(strips, counts)].astype(np.int32)


def _lay_out(surface: Surface, fronts: Fronts, side: float) -> _Layout:
    """Place rings about a triangle's height apart, ``side`` [m] being its weighted side."""
    levels, weights = [], []
    for band in fronts.bands:
        rows = max(1, round(band.area / (band.perimeter * side * _ROW)))
        t, weight = band.fronts(np.arange(1, rows + 1) / rows)
        levels.append(t)
        weights.append(weight)
    t, weight = np.concatenate(levels), np.concatenate(weights)
    p = surface.points(np.broadcast_to(fronts.phi, t.shape), t).reshape(*t.shape, 3)
    steps = np.linalg.norm(np.diff(p, axis=1), axis=-1) * (weight[:, 1:] + weight[:, :-1]) / 2
    arc = np.concatenate([np.zeros((len(t), 1)), np.cumsum(steps, axis=1)], axis=1)
    return _Layout(t, arc)


def _count(lengths: Array, faces: int) -> Ints:
    """Choose how many vertices each ring gets, the flange's centre first and the face's middle last."""
    low, high = lengths.sum() / faces / 8, lengths.sum() / faces * 32
    for _ in range(60):
        middle = np.sqrt(low * high)
        few = _total(_shares(lengths, middle)) < faces
        low, high = (low, middle) if few else (middle, high)
    candidates = [_shares(lengths, side) for side in (low, high)]
    return min(candidates, key=lambda counts: abs(_total(counts) - faces))


def _shares(lengths: Array, side: float) -> Ints:
    # Even counts put a vertex at both x ends of a ring, where the outline of the probe is widest.
    rings = np.maximum(_FEWEST, 2 * np.rint(lengths[:-1] / (2 * side))).astype(np.int64)
    # The face's middle needs fewer than the ring around it, or a facet could fold over an end of the segment.
    segment = int(np.clip(2 * np.rint(lengths[-1] / (2 * side)), 2, rings[-1] - 4))
    return np.concatenate([[1], rings, [segment if lengths[-1] > _POINT else 1]])


def _total(counts: Ints) -> int:
    """Facets between rings: as many as both have edges; a single vertex has none."""
    edges = np.where(counts == 1, 0, counts)
    return int((edges[1:] + edges[:-1]).sum())


def _spread(angles: Array, layout: _Layout, counts: Ints) -> tuple[Array, Array]:
    """Space each ring's vertices evenly by weighted length, every other ring shifted by half a step."""
    phi, t = [np.zeros(1)], [np.zeros(1)]
    turned = shift(np.arange(len(counts)), len(counts))
    for k, (n, arc, along) in enumerate(zip(counts[1:], layout.arc, layout.t, strict=True), start=1):
        at = (np.arange(n) + turned[k] / 2) / n * arc[-1]
        phi.append(np.interp(at, arc, angles))
        t.append(np.interp(phi[-1], angles, along))
    return np.concatenate(phi), np.concatenate(t)


def _name(counts: Ints) -> tuple[Ints, Ints]:
    """Give the vertices their numbers; the face's middle is walked there and back over the same ones."""
    size, last = int(counts.sum()), int(counts[-1])
    keep = size - last + last // 2 + 1 if last > 1 else size
    names = np.arange(size)
    names[keep:] = np.arange(size - last + last // 2 - 1, size - last, -1)[: size - keep]
    return names, np.arange(keep)
