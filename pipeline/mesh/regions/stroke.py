"""
A brush and one stroke of it.

Facets change at once, by their centroids; when the stroke is finished, they are cut where it ends, and it is one step.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType

import numpy as np
import numpy.typing as npt
import scipy

from contactbench.pipeline.errors import arg
from contactbench.pipeline.kernel import Geodesic, SurfaceIndex
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Surface
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph, cut_between, halve_long
from contactbench.pipeline.mesh.regions.region import RegionError

# Edges near the end of a stroke are at most this share of its radius long: a dab keeps 99 % of its area.
_FINE = 1 / 3
# No point of a triangle is further from all corners than this share of its longest edge.
_AMID = 0.58
# Distances over facets that are longer than so many radii would take long to find.
_COARSE = 2.0
# Each round halves the edges: from the longest probe to the finest brush.
_ROUNDS = 24
# Stops on the way are this share of the radius apart, which leaves scallops of 0.2 % of it; and how many at most. Where
# to halve edges shows with fewer.
STOPS_APART, _FEW, _MOST_STOPS = 1 / 8, 1 / 2, 4096
# Measured through space, a stroke covers what hangs together with it within so many radii along the surface.
_HANGS = 2.0
# Distances are measured as far as so many radii, or the ways to where the stroke ends would be cut off.
_ROOM = 1.4


@dataclass(frozen=True)
class Brush:
    """
    How a stroke paints.

    Attributes
    ----------
    radius : float
        In metres, above 0.
    geodesic : bool
        Measured along the surface; otherwise straight through space, but only as far as the facets hang
        together with the stroke within the radius, so that the far side of a thin wall stays clean.
    erase : bool
        Take facets out of their region instead.
    protect : bool
        Facets of other regions stay as they are.

    Raises
    ------
    RegionError
        The radius is not a positive length.
    """

    radius: float
    geodesic: bool = True
    erase: bool = False
    protect: bool = False

    def __post_init__(self) -> None:
        if not (math.isfinite(self.radius) and self.radius > 0):
            raise RegionError(f"the brush has a radius of {arg(self.radius)} m: give a length above 0.")


class Stroke:
    """
    One stroke, from pressing the button to letting it go; made by `RegionModel.stroke`.

    As a context manager it finishes at the end of the block, and aborts when the block raises.
    """

    def __init__(
        self,
        graph: FacetGraph,
        brush: Brush,
        rank: int,
        labels: Ints,
        changed: Callable[[Ints], None],
        ended: Callable[[Ints, Probe, Probe], None],
    ) -> None:
        self.brush = brush
        self.rank = rank
        self._graph = graph
        self._labels = labels
        self._changed = changed
        self._ended = ended
        self._before = labels.copy()
        self._way: list[tuple[int, Floats]] = []
        self._stops: list[Floats] = []
        self._open = True
        graph.geodesic.begin(brush.radius, brush.geodesic)

    def extend(self, face: int, point: npt.ArrayLike, *, joined: bool = True) -> Ints:
        """
        Go on to a picked point.

        Between two picks the stroke runs along the surface; where no way leads that is not many times
        longer than the straight line, the picks stay apart.

        Parameters
        ----------
        face : int
            The facet that was picked.
        point : (3,) array_like
            Where on it, S, m.
        joined : bool
            False after the pointer left the surface and came back: nothing in between is painted.

        Returns
        -------
        (c,) int32
            Facets whose label changed, ascending.

        Raises
        ------
        RegionError
            The stroke has ended, the facet does not exist, or the point is not finite.
        """
        self._refuse_ended()
        where = np.ascontiguousarray(point, dtype=np.float64)
        if where.shape != (3,) or not np.isfinite(where).all():
            raise RegionError(f"the picked point {arg(where.tolist())} is not a point in space: pick again.")
        fresh = self._graph.geodesic.extend(self._graph.check_face(face), where, joined)
        way = np.empty((0, 3))
        if joined and self._way:
            way = self._graph.geodesic.path(*self._way[-1], face, where)
        self._stops.append(_stops(way if len(way) else where[None], STOPS_APART * self.brush.radius))
        self._way.append((face, where))
        faces = fresh[self._changes(self._labels[fresh])]
        self._labels[faces] = 0 if self.brush.erase else self.rank
        if len(faces):
            self._changed(faces)
        return faces

    def _changes(self, old: Ints) -> Mask:
        if self.brush.erase:
            return np.equal(old, self.rank) if self.brush.protect else np.not_equal(old, 0)
        return np.equal(old, 0) if self.brush.protect else np.not_equal(old, self.rank)

    def finish(self) -> Ints:
        """
        Cut the facets where the stroke ends, and make it a step.

        Returns
        -------
        (c,) int32
            Facets of the mesh as it is now whose label changed, ascending.
        """
        stale, before = self._taken_back(), self._labels
        old = new = self._graph.probe
        changed, labels = stale[:0], before
        if self._stops:
            mesh, origin, covered = covered_by(
                old, np.concatenate(self._stops), self.brush.radius, geodesic=self.brush.geodesic
            )
            labels = before[origin]
            changed = np.flatnonzero(covered & self._changes(labels)).astype(np.int32)
            labels[changed] = 0 if self.brush.erase else self.rank
            if len(changed) and len(origin) > len(before):
                new = old.cut(mesh, origin)
            elif not len(changed):
                labels = before
        self._ended(labels, old, new)
        stale = np.setdiff1d(stale, changed)
        if new is old and len(stale):
            self._changed(stale)
        return changed

    def abort(self) -> None:
        """End the stroke as if it had never begun."""
        faces = self._taken_back()
        self._ended(self._labels, self._graph.probe, self._graph.probe)
        if len(faces):
            self._changed(faces)

    def _taken_back(self) -> Ints:
        """Give facets the labels they had; returns those that had changed."""
        self._refuse_ended()
        self._open = False
        faces = np.flatnonzero(self._labels != self._before).astype(np.int32)
        self._labels[:] = self._before
        return faces

    def __enter__(self) -> Stroke:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if not self._open:
            return
        if kind is None:
            self.finish()
        else:
            self.abort()

    def _refuse_ended(self) -> None:
        if not self._open:
            raise RegionError("this stroke has ended: start another one.")


def _stops(way: Floats, apart: float) -> Floats:
    """Return points (k, 3) along a way (n, 3), its corners among them, that are no further apart, m."""
    steps = np.linalg.norm(np.diff(way, axis=0), axis=1)
    counts = np.ceil(steps / max(apart, steps.sum() / _MOST_STOPS, 1e-300)).astype(int)
    pieces = [
        np.linspace(a, b, n, endpoint=False) for a, b, n in zip(way, way[1:], counts, strict=False) if n
    ]
    return np.concatenate([*pieces, way[-1:]])


def covered_by(probe: Probe, stops: Floats, radius: float, *, geodesic: bool) -> tuple[Surface, Longs, Mask]:
    """
    Cut a surface at a distance from points on it.

    Parameters
    ----------
    probe : Probe
    stops : (k, 3) float64
        On the surface, S, m.
    radius : float
        The distance, m: along the surface, or else straight through space, see `Brush`.

    Returns
    -------
    mesh : Surface
        The same surface.
    origin : (m,) int64
        The facet that each of its facets is, or is a part of.
    covered : (m,) bool
        Which lie within the distance.
    """
    mesh, origin = (probe.vertices, probe.faces), np.arange(len(probe.faces))
    tree, rows, fine = scipy.spatial.cKDTree(stops), origin, _COARSE * radius
    for _ in range(_ROUNDS):
        rows, longest = _near(mesh, rows, tree, _ROOM * radius)
        finer = _finer(mesh, origin, rows, longest > fine, fine)
        if finer is None:
            break
        mesh, origin, rows = finer
    walked = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(stops, axis=0), axis=1)))
    few = stops[np.unique(walked // (_FEW * radius), return_index=True)[1]]
    reach = radius + longest.max()
    for _ in range(_ROUNDS):
        part, used = _part(mesh, rows)
        away = _distances(part, few, reach, radius, geodesic=geodesic)
        longest = _longest(part)
        crossed = np.abs(away[part[1]] - radius).min(axis=1) <= _AMID * longest
        reached = np.isfinite(away[part[1]]).any(axis=1)
        finer = _finer(mesh, origin, rows[reached], crossed[reached], _FINE * radius)
        if finer is None:
            break
        reach = radius + longest[crossed].max()
        mesh, origin, rows = finer
    if len(few) < len(stops):
        away = _distances(part, stops, reach, radius, geodesic=geodesic)
    whole = np.full(len(mesh[0]), reach)
    whole[used] = np.minimum(away, reach)
    cut, parents, side = cut_between(mesh, (whole <= radius).astype(np.int32), np.abs(whole - radius), rows)
    on = np.flatnonzero(side < 0)  # a facet with all its corners on the line
    side[on] = whole[mesh[1][parents[on]]].mean(axis=1) <= radius
    return cut, origin[parents], side > 0


def _near(mesh: Surface, rows: Longs, tree: scipy.spatial.cKDTree, distance: float) -> tuple[Longs, Floats]:
    """Return those facets that come so near to points, m, a few others among them, and their longest edges."""
    corners, points = mesh[0][mesh[1][rows]], tree.data
    low, high = points.min(axis=0) - distance, points.max(axis=0) + distance
    boxed = ((corners.max(axis=1) >= low) & (corners.min(axis=1) <= high)).all(axis=1)
    rows, longest = rows[boxed], _longest((mesh[0], mesh[1][rows[boxed]]))
    near = tree.query(corners[boxed].mean(axis=1))[0] <= distance + longest
    return rows[near], longest[near]


def _part(mesh: Surface, rows: Longs) -> tuple[Surface, Longs]:
    """Return some facets as a mesh of their own, and which vertices it has."""
    used, faces = np.unique(mesh[1][rows], return_inverse=True)
    return (mesh[0][used], faces.reshape(-1, 3).astype(np.int32)), used.astype(np.int64)


def _distances(mesh: Surface, stops: Floats, reach: float, radius: float, *, geodesic: bool) -> Floats:
    """Return how far the vertices are from the nearest stop, m, infinite beyond the reach; see `covered_by`."""
    _, at, _ = SurfaceIndex(*mesh).closest(stops)
    near, along = Geodesic(*mesh).spread(at, stops, reach if geodesic else max(reach, _HANGS * radius))
    away = np.full(len(mesh[0]), np.inf)
    away[near] = along if geodesic else scipy.spatial.cKDTree(stops).query(mesh[0][near])[0]
    return away


def _finer(
    mesh: Surface, origin: Longs, rows: Longs, chosen: Mask, longest: float
) -> tuple[Surface, Longs, Longs] | None:
    """Halve the edges of chosen ones among facets that are longer than so much, m; None: none is."""
    finer = halve_long(mesh, rows[chosen], lambda _: longest)
    if finer is None:
        return None
    made, parents = finer
    new = np.arange(len(origin), len(parents))
    return made, origin[parents], np.concatenate((rows, new[np.isin(parents[new], rows)]))


def _longest(mesh: Surface) -> Floats:
    """Return the longest edge of each facet, m; (m,)."""
    corners = mesh[0][mesh[1]]
    lengths: Floats = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    return lengths
