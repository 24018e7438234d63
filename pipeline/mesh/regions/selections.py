"""Facets chosen by where they lie, which way they face, what they hang together with, or by the stroke of a brush.

Where a choice ends at a line of its own, facets are cut along it: a `Selection`. Others are (m,) bool, whole facets.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from types import TracebackType
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt
import scipy

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.kernel import Geodesic, SurfaceIndex
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Surface
from contactbench.pipeline.mesh.deviation import doubled_areas
from contactbench.pipeline.mesh.probe import Probe, connected
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph, cut_between, halve_long
from contactbench.pipeline.mesh.regions.region import RegionError
from contactbench.pipeline.mesh.regions.transfer import (
    carry_labels,
    cut_along,
    facing,
    lines_between,
    places_on,
)

if TYPE_CHECKING:
    from scipy.sparse import csr_array

    from contactbench.pipeline.mesh.regions.model import RegionModel

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
Way = Literal["add", "erase", "reshape"]

# Nearer than this share of an edge to a corner, a plane runs through the corner; and nearer than this, m, in any case.
_SNAP, _ON_PLANE = 1e-4, 1e-9


@dataclass(frozen=True, eq=False)
class Selection:
    """
    Chosen facets of a mesh, which are cut where the choice ends.

    Attributes
    ----------
    before : Probe
        The mesh that they were chosen on.
    mesh : Surface
        The same surface in facets of which each is chosen or not.
    origin : (k,) int64
        The facet of the probe that each of its facets is, or is a part of.
    mask : (k,) bool
        Which are chosen.
    """

    before: Probe
    mesh: Surface
    origin: Longs
    mask: Mask

    @classmethod
    def whole(cls, graph: FacetGraph, mask: Mask) -> Selection:
        """Choose the facets of a mask (m,) as they are."""
        probe = graph.probe
        return cls(probe, (probe.vertices, probe.faces), np.arange(len(mask)), mask)

    @property
    def probe(self) -> Probe:
        """The mesh with its facets cut; the same object where none had to be."""
        cut = len(self.origin) > len(self.before.faces)
        return self.before.cut(self.mesh, self.origin) if cut else self.before

    @property
    def sentence(self) -> str:
        """What to know about it; may be empty."""
        return ""

    @property
    def area(self) -> float:
        """Of what is chosen, m²."""
        return float(doubled_areas(self.mesh[0], self.mesh[1][self.mask]).sum()) / 2

    @property
    def touched(self) -> Mask:
        """The facets of the mesh before that are chosen in part or as a whole, (m,)."""
        touched = np.zeros(len(self.before.faces), dtype=bool)
        touched[self.origin[self.mask]] = True
        return touched

    def give(self, model: RegionModel, rank: int, way: Way = "add", *, protect: bool, text: str) -> int:
        """
        Change a region by what is chosen, as one step of the model, or none if nothing changes.

        Parameters
        ----------
        model : RegionModel
            Of the mesh before.
        rank : int
        way : {"add", "erase", "reshape"}
            Add it to the region, take it out, or let the region be nothing else.
        protect : bool
            Facets of other regions stay theirs.
        text : str
            What the step is called.

        Returns
        -------
        int
            How many facets changed, of the mesh as it is then.
        """
        before = model.labels[self.origin]
        own = before == rank
        gained = self.mask & ~own & ((before == 0) | (not protect)) & (way != "erase")
        lost = own & (self.mask if way == "erase" else ~self.mask) & (way != "add")
        if not (gained | lost).any():
            return 0
        labels = np.where(gained, rank, np.where(lost, 0, before)).astype(np.int32)
        model.relabel(labels, self.before, self.probe, text)
        return int(np.count_nonzero(gained | lost))


def in_box(
    graph: FacetGraph,
    low: npt.ArrayLike,
    high: npt.ArrayLike,
    *,
    R_SB: npt.ArrayLike | None = None,
    p_SB_S: npt.ArrayLike | None = None,
) -> Selection:
    """
    Choose what lies in a box.

    Parameters
    ----------
    graph : FacetGraph
    low, high : (3,) array_like
        Corners in the box's frame B, m; infinite where the box has no end.
    R_SB : (3, 3) array_like, optional
        Orientation of B in S; B is parallel to S when left out.
    p_SB_S : (3,) array_like, optional
        Origin of B in S, m; that of S when left out.

    Raises
    ------
    RegionError
        Not three numbers, NaN, a low corner that is not below the high one, or no rotation.
    """
    lower, upper = (vector(value, name, finite=False) for value, name in ((low, "low"), (high, "high")))
    if not (lower < upper).all():
        raise RegionError(
            f"the box goes from {arg(lower.tolist())} to {arg(upper.tolist())} m: each low value must be"
            " below the high one."
        )
    axes = np.eye(3) if R_SB is None else _rotation(R_SB).T
    at = axes @ (np.zeros(3) if p_SB_S is None else vector(p_SB_S, message("origin of the box")))
    return _beyond(graph, np.concatenate((axes, -axes)), np.concatenate((lower + at, -upper - at)))


def half_space(graph: FacetGraph, point: npt.ArrayLike, normal: npt.ArrayLike) -> Selection:
    """
    Choose what lies on a plane or on the side that its normal points to.

    Parameters
    ----------
    graph : FacetGraph
    point : (3,) array_like
        On the plane, S, m.
    normal : (3,) array_like
        S, of any length but 0.

    Raises
    ------
    RegionError
        Not three finite numbers, or a normal without direction.
    """
    n = unit(normal, "normal")
    return _beyond(graph, n[None], np.array([vector(point, "point") @ n]))


def _beyond(graph: FacetGraph, normals: Floats, least: Floats) -> Selection:
    """Choose what lies where n . x is at least so much, m, for all normals (p, 3)."""
    mesh, origin = (graph.probe.vertices, graph.probe.faces), np.arange(graph.facet_count)
    mask = np.ones(graph.facet_count, dtype=bool)
    for n, value in zip(normals, least, strict=True):
        if not np.isfinite(value):  # no end of a box
            continue
        above = mesh[0] @ n - value
        above[np.abs(above) < _ON_PLANE] = 0.0
        mesh, parents, side = cut_between(
            mesh, (above >= 0).astype(np.int32), np.abs(above), np.flatnonzero(mask), _SNAP
        )
        mask, origin = mask[parents] & (side != 0), origin[parents]
    return Selection(graph.probe, mesh, origin, mask)


def flood(graph: FacetGraph, face: int, crease: float) -> Mask:
    """
    Facets that can be reached from one without crossing a crease.

    Parameters
    ----------
    graph : FacetGraph
    face : int
        Where to begin.
    crease : float
        Edges whose facets differ by more than this are not crossed, rad, from 0 to pi.

    Raises
    ------
    RegionError
        No such facet or angle.
    """
    _check_angle(crease)
    graph.check_face(face)
    label = connected(graph.facet_count, *graph.pairs[graph.creases <= crease].T)
    same: Mask = label == label[face]
    return same


def unit(values: npt.ArrayLike, name: str) -> Floats:
    """Return a direction (3,) of length 1; RegionError if it has none."""
    v = vector(values, name)
    length = float(np.linalg.norm(v))
    if not 1e-100 < length < 1e100:
        raise RegionError(f"{arg(name)} {arg(v.tolist())} has no direction: give a vector that is not zero.")
    return v / length


def vector(values: npt.ArrayLike, name: str, *, finite: bool = True) -> Floats:
    """Return (3,) numbers, none of them NaN and, if asked for, all finite; RegionError otherwise."""
    try:
        v = np.asarray(values, dtype=np.float64)
    except (ValueError, TypeError) as error:
        raise RegionError(f"{arg(name)} is not three numbers ({arg(error)}): give x, y and z.") from error
    bad = ~np.isfinite(v) if finite else np.isnan(v)
    if v.shape != (3,) or bad.any():
        raise RegionError(
            f"{arg(name)} is {arg(np.array2string(v, threshold=9))}: give three numbers x, y and z."
        )
    return v


def _rotation(values: npt.ArrayLike) -> Floats:
    R = np.asarray(values, dtype=np.float64)
    if R.shape != (3, 3) or not np.allclose(R.T @ R, np.eye(3), atol=1e-6) or np.linalg.det(R) < 0:
        raise RegionError("the box's orientation is not a rotation: give a 3 x 3 matrix R_SB.")
    return R


def _check_angle(angle: float) -> None:
    if not 0 <= angle <= math.pi:
        raise RegionError(f"{arg(angle)} rad is not an angle between two directions: give 0 to 180 degrees.")


# ---- the facets on the other side of a plane -----------------------------------------------------


@dataclass(frozen=True, eq=False)
class Mirrored(Selection):
    """
    The image of a set of facets.

    Attributes
    ----------
    unmatched : (c,) int64
        Facets of the set, ascending, that have no counterpart: no surface that faces their way is near enough to
        where their centroid is mirrored to.
    tolerance : float
        What near enough was, m.
    """

    unmatched: Longs
    tolerance: float

    @property
    def sentence(self) -> str:
        """How well it went."""
        area = 1e4 * self.area
        if len(self.unmatched) == 0:
            return message(f"{arg(area):.3g} cm² mirrored; every facet has a counterpart.")
        return message(
            f"{arg(area):.3g} cm² mirrored; {arg(len(self.unmatched))} facets have no counterpart within"
            f" {arg(1e3 * self.tolerance):.3g} mm: the surface is not symmetric there."
        )


def mirror(
    graph: FacetGraph,
    mask: Mask,
    normal: npt.ArrayLike,
    point: npt.ArrayLike = (0.0, 0.0, 0.0),
    *,
    tolerance: float | None = None,
) -> Mirrored:
    """
    Find the facets that lie where those of a set are after mirroring; they are cut along its outline.

    The image of the surface takes the place of an older mesh, see `transfer`: a mesh that is not symmetric itself
    leaves no holes in a set that is, and the other side of a wall is left alone.

    Parameters
    ----------
    graph : FacetGraph
    mask : (m,) bool
    normal : (3,) array_like
        Of the plane, S.
    point : (3,) array_like
        On the plane, S, m.
    tolerance : float, optional
        m; the edge of a regular triangle of the mean facet's area when left out.

    Raises
    ------
    RegionError
        A normal without direction, or a tolerance that is not a positive length.
    """
    n, p = unit(normal, "normal"), vector(point, "point")
    reach = _edge(graph) if tolerance is None else float(tolerance)
    if not (math.isfinite(reach) and reach > 0):
        raise RegionError(f"a tolerance of {arg(tolerance)} m is not valid: give a length above 0.")
    probe = graph.probe
    surface = probe.vertices, probe.faces
    image = (
        probe.vertices - 2 * np.outer((probe.vertices - p) @ n, n),
        np.ascontiguousarray(probe.faces[:, ::-1]),
    )
    labels = mask.astype(np.int32)
    mesh, origin = cut_along(image, labels, surface, reach)
    found, _ = carry_labels(image, labels, mesh, reach=reach)
    own = np.flatnonzero(mask)
    turned = probe.normals[own] - 2 * np.outer(probe.normals[own] @ n, n)
    there = facing(surface, image[0][image[1][own]].mean(axis=1), turned, reach)
    return Mirrored(probe, mesh, origin, found > 0, own[there < 0], reach)


def _edge(graph: FacetGraph) -> float:
    return math.sqrt(float(graph.probe.areas.mean()) * 4 / math.sqrt(3))


# ---- growing, shrinking and smoothing a set of facets ---------------------------------------------


_MOST_RINGS = 10_000


def grow(graph: FacetGraph, mask: Mask, *, rings: int = 0, distance: float = 0.0) -> Selection:
    """
    Take in what lies around the border.

    Parameters
    ----------
    graph : FacetGraph
    mask : (m,) bool
    rings : int
        So many times all facets that share a vertex with the mask.
    distance : float
        Or: what is this near the border, m along the surface. Give one of the two.

    Raises
    ------
    RegionError
        Both or neither are given, or one is not positive.
    """
    _check_amount(rings, distance)
    if rings:
        return Selection.whole(graph, _grow_rings(graph, mask, rings))
    near = _near_border(graph, mask, distance)
    return replace(near, mask=near.mask | mask[near.origin])


def shrink(graph: FacetGraph, mask: Mask, *, rings: int = 0, distance: float = 0.0) -> Selection:
    """
    Give up what lies along the border; a rim of the mesh is none.

    Parameters and errors as for `grow`.
    """
    _check_amount(rings, distance)
    if rings:
        return Selection.whole(graph, ~_grow_rings(graph, ~mask, rings))
    near = _near_border(graph, mask, distance)
    return replace(near, mask=~near.mask & mask[near.origin])


def smooth(graph: FacetGraph, mask: Mask, rings: int, *, allowed: Mask | None = None) -> Mask:
    """
    Straighten the border, fill holes and remove specks.

    Parts and holes of fewer facets than a disc of so many rings has half of go first, except the largest part.
    What is left is blurred over neighbours and cut again at the level that gives back its area, so that it
    neither grows nor shrinks (diffusion-generated motion that preserves area: Ruuth & Wetton, J. Sci. Comput.
    19, 2003). Only whole facets can change hands, so the area comes back to within a few of them.

    Parameters
    ----------
    graph : FacetGraph
    mask : (m,) bool
    rings : int
        How far to blur, at least 1.
    allowed : (m,) bool, optional
        Where facets may be gained: those of other regions are usually not.

    Raises
    ------
    RegionError
        Not a positive number of rings.
    """
    _check_amount(rings, 0.0)
    may_gain = np.ones_like(mask) if allowed is None else mask | allowed
    cleaned = _without_specks(graph, mask, may_gain, rings)
    blurred = cleaned.astype(np.float64)
    average = _averaging(graph)
    # One ring of facets is about two steps from facet to facet.
    for _ in range(2 * rings):
        blurred = np.asarray(average @ blurred)
    blurred[~may_gain] = 0.0
    return _without_specks(graph, _cut(graph, blurred, cleaned), may_gain, rings)


def _cut(graph: FacetGraph, values: Floats, mask: Mask) -> Mask:
    """Facets with the highest values, as many as have the area of the mask."""
    areas = graph.probe.areas
    # Of facets that are equally deep inside, those that are in already come first.
    order = np.lexsort((~mask, -values))
    order = order[: np.searchsorted(-values[order], 0.0)]
    total = np.cumsum(areas[order])
    target = float(areas[mask].sum())
    count = int(np.searchsorted(total, target * (1 - 1e-12))) + 1
    # The last facet may overshoot by more than stopping before it falls short.
    if 1 < count <= len(total) and total[count - 1] - target > target - total[count - 2]:
        count -= 1
    result = np.zeros_like(mask)
    result[order[:count]] = True
    return result


def _without_specks(graph: FacetGraph, mask: Mask, may_gain: Mask, rings: int) -> Mask:
    """Drop parts of under 3 rings² facets, then fill such holes; the largest part, and the largest rest, stay."""
    mask = mask & ~_small_parts(graph, mask, 3 * rings**2)
    return mask | (may_gain & _small_parts(graph, ~mask, 3 * rings**2))


def _small_parts(graph: FacetGraph, mask: Mask, least: int) -> Mask:
    """Facets of the mask that hang together with fewer than `least`, the largest part excepted."""
    label = connected(graph.facet_count, *graph.pairs[mask[graph.pairs].all(axis=1)].T)
    sizes = np.bincount(label[mask], minlength=int(label.max()) + 1)
    small = sizes < least
    small[np.argmax(sizes)] = False
    found: Mask = mask & small[label]
    return found


def _averaging(graph: FacetGraph) -> csr_array[np.float64]:
    """Mean over a facet and its neighbours, weighted by their areas: a speck of small facets counts little."""
    m = graph.facet_count
    one, other = graph.pairs.T
    areas = graph.probe.areas
    rows = np.concatenate((one, other, np.arange(m)))
    columns = np.concatenate((other, one, np.arange(m)))
    weights = scipy.sparse.coo_array((areas[columns], (rows, columns)), shape=(m, m)).tocsr()
    mean: csr_array[np.float64] = (scipy.sparse.diags_array(1 / weights.sum(axis=1)) @ weights).tocsr()
    return mean


def _grow_rings(graph: FacetGraph, mask: Mask, rings: int) -> Mask:
    faces = graph.probe.faces
    for _ in range(rings):
        used = np.zeros(len(graph.probe.vertices), dtype=bool)
        used[faces[mask]] = True
        grown = np.any(used[faces], axis=1)
        if np.array_equal(grown, mask):
            break
        mask = grown
    return mask


def _near_border(graph: FacetGraph, mask: Mask, distance: float) -> Selection:
    probe = graph.probe
    ends, _ = lines_between((probe.vertices, probe.faces), mask.astype(np.int32))
    if not len(ends):
        return Selection.whole(graph, np.zeros_like(mask))
    places, _ = places_on(ends, STOPS_APART * distance)
    return Selection(probe, *covered_by(probe, places, distance, geodesic=True))


def _check_amount(rings: int, distance: float) -> None:
    if (rings == 0) == (distance == 0):
        raise RegionError("give the distance, either in rings of facets or as a length.")
    if not (0 <= rings <= _MOST_RINGS and distance >= 0 and math.isfinite(distance)):
        what = f"{rings} rings" if rings else f"{distance} m"
        raise RegionError(
            f"{arg(what)} is not a valid distance: give 1 to {arg(_MOST_RINGS)} rings, or a length above 0."
        )


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
