"""Closed triangle meshes of a surface with a wanted number of facets, all vertices exactly on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from contactbench.assets.surface import Station, Surface, unit_section

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


# ---- curves once around a probe, evenly spaced between its edges ---------------------------------


_ANGLES = 384
_STEP = 0.25e-3  # [m] spacing of the tables along the profile
_GAIN = 1.5e-3  # [m] how strongly curvature shortens facets
_OFF_END = 1e-6  # the chart is singular at its very ends
_FINEST = 2.0  # facets on tight fillets are shorter by this factor at most


@dataclass(frozen=True)
class Band:
    """The part of a surface between two stations, tabulated at levels (rows) and angles (columns)."""

    t: Array
    """(levels, angles) profile parameter."""
    weight: Array
    """(levels, angles) how much shorter facets should be along the fronts."""
    level: Array
    """(levels, angles) weighted length along the meridian, from 0 to 1."""
    area: float
    """Area times both weights [m^2]."""
    perimeter: float
    """Mean weighted length of the fronts [m]."""

    def fronts(self, levels: Array) -> tuple[Array, Array]:
        """Return parameters and weights (k, angles) of the curves on which ``level`` has given values."""
        columns = range(self.t.shape[1])
        t = np.stack([np.interp(levels, self.level[:, j], self.t[:, j]) for j in columns], axis=1)
        weight = np.stack([np.interp(levels, self.level[:, j], self.weight[:, j]) for j in columns], axis=1)
        return t, weight


@dataclass(frozen=True)
class Fronts:
    """All bands of a surface, from the middle of the flange to the middle of the face."""

    phi: Array
    """Angles of the tables, the first repeated at 2 pi [rad]."""
    bands: tuple[Band, ...]
    area: float
    """Weighted area of the surface [m^2]."""

    @staticmethod
    @lru_cache(maxsize=8)
    def of(surface: Surface) -> Fronts:
        """Tabulate a surface; the last few are remembered."""
        phi = np.linspace(0, 2 * np.pi, _ANGLES + 1)
        stations = (Station(0.0, 0.0), *surface.stations, Station(1.0, 1.0))
        bands = tuple(_band(surface, phi, *pair) for pair in pairwise(stations))
        return Fronts(phi, bands, sum(band.area for band in bands))


def _band(surface: Surface, phi: Array, start: Station, stop: Station) -> Band:
    low, high = _curve(phi, start), _curve(phi, stop)
    reach = float(np.max(high - low)) * _profile_length(surface)
    s = np.linspace(0, 1, max(24, int(reach / _STEP)))[:, None]
    t = low + (high - low) * s
    around = np.broadcast_to(phi, t.shape)
    along, weight = _weights(surface, around, t)
    p = surface.points(around, t).reshape(*t.shape, 3)
    steps = np.linalg.norm(np.diff(p, axis=0), axis=-1) * (along[1:] + along[:-1]) / 2
    length = np.concatenate([np.zeros((1, len(phi))), np.cumsum(steps, axis=0)])
    area, perimeter = _measure(p, along, weight)
    return Band(t, weight, length / length[-1], area, perimeter)


def _weights(surface: Surface, phi: Array, t: Array) -> tuple[Array, Array]:
    """Return how much shorter facets should be along the meridians and along the fronts."""
    jet = surface.jet(phi.ravel(), np.clip(t.ravel(), _OFF_END, 1 - _OFF_END))
    normals = surface.normals(phi, t)
    rise = np.abs(np.einsum("ij,ij->i", jet.tt, normals)) / np.einsum("ij,ij->i", jet.t, jet.t)
    bend = np.abs(surface.principal_curvatures(phi, t)).max(axis=-1)
    # Rounded edges that run along the probe must not count along it: meridians beside them would be shorter,
    # and fronts would cross the edges at a slant.
    spread = (len(t) / 40, _ANGLES / 80)
    along, around = (
        # Facets should change size gradually, over about their own length.
        gaussian_filter(
            np.clip(1 + _GAIN * curve.reshape(t.shape), 1, _FINEST), spread, mode=("nearest", "wrap")
        )
        for curve in (rise, bend)
    )
    return along, around


def _curve(phi: Array, station: Station) -> Array:
    """Profile parameter of a station at each angle: ``side`` on the x ends, bulging to ``front``."""
    x = unit_section(phi, np.full_like(phi, 4.0))[0].value
    return station.side + (station.front - station.side) * (1 - x**2) ** 2


def _profile_length(surface: Surface) -> float:
    points = surface.profile(np.linspace(0, 1, 500))[:, :3]
    return float(np.linalg.norm(np.diff(points, axis=0), axis=-1).sum())


def _measure(p: Array, along: Array, weight: Array) -> tuple[float, float]:
    """Weighted area of a tabulated patch and the mean weighted length of its rows."""
    across, down = p[:-1, 1:] - p[1:, :-1], p[1:, 1:] - p[:-1, :-1]
    cells = np.linalg.norm(np.cross(across, down), axis=-1) / 2
    area = float((cells * weight[:-1, :-1] * along[:-1, :-1]).sum())
    rows = np.linalg.norm(np.diff(p, axis=1), axis=-1) * (weight[:, 1:] + weight[:, :-1]) / 2
    return area, float(rows.sum(axis=1).mean())


# ---- strips of triangles between neighbouring rings of different vertex counts -------------------


Mask = NDArray[np.bool_]

_PASSES = 12


def shift(ring: Ints, rings: int) -> Ints:
    """Half steps by which a ring's vertices are turned: every other ring, never the last."""
    return np.where(ring == rings - 1, 0, ring % 2)


@dataclass
class Strips:
    """All triangles between rings, in walking order around each strip.

    Each triangle advances by one vertex on the lower or on the upper ring of its strip; ``lower`` and
    ``upper`` are where the walk stands before it does.
    """

    strip: Ints
    """(m,) index of the lower ring."""
    place: Ints
    """(m,) position in the walk around the strip."""
    climbs: Mask
    """(m,) whether the triangle advances on the upper ring."""
    lower: Ints
    """(m,) vertex number within the lower ring."""
    upper: Ints
    """(m,) vertex number within the upper ring."""


def join(counts: Ints) -> Strips:
    """Stitch rings, all by one closed formula.

    An edge of one ring is joined to that vertex of the other in whose share of the turn the edge's middle
    lies. Everything is integer arithmetic on half steps, so that no two edges cross by rounding.

    Parameters
    ----------
    counts : (k,) integer array
        Vertices on each ring; 1 is a single point and has no edges.

    Returns
    -------
    Strips
        The triangles, strip after strip.
    """
    rings = len(counts)
    turned = shift(np.arange(rings), rings)
    edges = np.where(counts == 1, 0, counts)
    strip_a, i = _enumerate(edges[:-1])
    strip_b, j = _enumerate(edges[1:])
    na, nb, oa, ob = (part[strip_a] for part in (counts[:-1], counts[1:], turned[:-1], turned[1:]))
    met_b = -((-((2 * i + oa + 1) * nb - (ob + 1) * na)) // (2 * na))
    rank_a = i + np.where(nb == 1, 0, met_b)
    na, nb, oa, ob = (part[strip_b] for part in (counts[:-1], counts[1:], turned[:-1], turned[1:]))
    met_a = ((2 * j + ob + 1) * na - (oa + 1) * nb) // (2 * nb) + 1
    rank_b = j + np.where(na == 1, 0, met_a)
    strip = np.concatenate([strip_a, strip_b])
    size = (edges[:-1] + edges[1:])[strip]
    place = np.concatenate([rank_a, rank_b]) % size
    # Each strip's places are a permutation of its triangles, so sorting is only a scatter.
    start = np.concatenate([[0], np.cumsum(edges[:-1] + edges[1:])])[strip]
    order = np.empty_like(strip)
    order[start + place] = np.arange(len(strip))
    lower = np.concatenate([i, met_a]) % counts[:-1][strip]
    upper = np.concatenate([met_b, j]) % counts[1:][strip]
    climbs = np.arange(len(strip)) >= len(strip_a)
    return Strips(strip[order], place[order], climbs[order], lower[order], upper[order])


def improve(strips: Strips, loops: Array, counts: Ints) -> None:
    """Exchange diagonals between neighbouring triangles of a strip, in place, until they are Delaunay.

    Parameters
    ----------
    strips : Strips
        Changed in place.
    loops : (n, 3) array
        Vertices ring after ring [m].
    counts : (k,) integer array
        Vertices on each ring.
    """
    start = np.concatenate([[0], np.cumsum(counts)])
    pairs = np.flatnonzero(strips.strip[:-1] == strips.strip[1:])
    quiet = 0
    for turn in range(2 * _PASSES):
        first = pairs[(strips.place[pairs] + turn) % 2 == 0]
        first = first[strips.climbs[first] != strips.climbs[first + 1]]
        poor = first[_is_poor(strips, first, loops, start, counts)]
        quiet = quiet + 1 if len(poor) == 0 else 0
        if quiet == 2:
            break
        _exchange(strips, poor, counts)


def triangles(strips: Strips, counts: Ints) -> Ints:
    """Return the vertex numbers (m, 3) of all triangles, counter-clockwise seen from outside."""
    start = np.concatenate([[0], np.cumsum(counts)])
    a0, a1, b0, b1 = _quad(strips, np.arange(len(strips.strip)), start, counts)
    return np.stack([a0, np.where(strips.climbs, b1, a1), b0], axis=-1)


def _enumerate(sizes: Ints) -> tuple[Ints, Ints]:
    """Group number and number within the group, for groups of given sizes."""
    group = np.repeat(np.arange(len(sizes)), sizes)
    return group, np.arange(len(group)) - np.repeat(np.cumsum(sizes) - sizes, sizes)


def _quad(strips: Strips, which: Ints, start: Ints, counts: Ints) -> tuple[Ints, Ints, Ints, Ints]:
    """Vertex numbers of where the walk stands on both rings, and of the next vertex on each."""
    s, i, j = strips.strip[which], strips.lower[which], strips.upper[which]
    low, high = start[s], start[s + 1]
    return low + i, low + (i + 1) % counts[s], high + j, high + (j + 1) % counts[s + 1]


def _is_poor(strips: Strips, first: Ints, loops: Array, start: Ints, counts: Ints) -> Mask:
    """Tell where the angles opposite a diagonal sum to more than half a turn."""
    a0, a1, b0, b1 = (loops[v] for v in _quad(strips, first, start, counts))
    climbs = strips.climbs[first][:, None]
    # Climbing first puts the diagonal between a0 and b1, otherwise it is between a1 and b0.
    p, q = np.where(climbs, a0, a1), np.where(climbs, b1, b0)
    r, s = np.where(climbs, b0, a0), np.where(climbs, a1, b1)
    return _cotangent(p - r, q - r) + _cotangent(p - s, q - s) < -1e-9


def _cotangent(u: Array, v: Array) -> Array:
    area = np.linalg.norm(np.cross(u, v), axis=-1)
    return np.asarray(np.einsum("ij,ij->i", u, v) / np.maximum(area, 1e-30))


def _exchange(strips: Strips, first: Ints, counts: Ints) -> None:
    """Swap the order of two steps of the walk: the one that came second now starts from the first's place."""
    climbs = strips.climbs[first]
    s = strips.strip[first]
    strips.climbs[first], strips.climbs[first + 1] = ~climbs, climbs
    strips.lower[first + 1] = (strips.lower[first] + climbs) % counts[s]
    strips.upper[first + 1] = (strips.upper[first] + ~climbs) % counts[s + 1]
