"""Facets chosen by where they lie, which way they face, or what they hang together with: (m,) bool each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.health import connected
from contactbench.pipeline.mesh.regions.region import RegionError
from contactbench.pipeline.mesh.regions.transfer import carry_labels, cut_along
from contactbench.pipeline.mesh.regions.transfer import facing as facing_surface

if TYPE_CHECKING:
    import numpy.typing as npt
    from scipy.sparse import csr_array

    from contactbench.pipeline.mesh.arrays import Floats, Longs, Mask
    from contactbench.pipeline.mesh.probe import Probe
    from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph
    from contactbench.pipeline.mesh.regions.model import RegionModel


def in_box(
    graph: FacetGraph,
    low: npt.ArrayLike,
    high: npt.ArrayLike,
    *,
    R_SB: npt.ArrayLike | None = None,
    p_SB_S: npt.ArrayLike | None = None,
) -> Mask:
    """
    Facets whose centroid lies in a box.

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
    points = (
        graph.centroids if p_SB_S is None else graph.centroids - vector(p_SB_S, message("origin of the box"))
    )
    if R_SB is not None:
        points = points @ _rotation(R_SB)
    inside: Mask = np.all((points >= lower) & (points <= upper), axis=1)
    return inside


def half_space(graph: FacetGraph, point: npt.ArrayLike, normal: npt.ArrayLike) -> Mask:
    """
    Facets whose centroid lies on a plane or on the side that its normal points to.

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
    side: Mask = (graph.centroids - vector(point, "point")) @ unit(normal, "normal") >= 0
    return side


def facing(graph: FacetGraph, direction: npt.ArrayLike, angle: float) -> Mask:
    """
    Facets whose outward normal is within an angle of a direction.

    Parameters
    ----------
    graph : FacetGraph
    direction : (3,) array_like
        S, of any length but 0.
    angle : float
        Half-angle of the cone, rad, from 0 to pi.

    Raises
    ------
    RegionError
        No direction, or no such angle.
    """
    _check_angle(angle)
    cone: Mask = graph.probe.normals @ unit(direction, "direction") >= math.cos(angle) - 1e-12
    return cone


def flood(graph: FacetGraph, face: int, crease: float, *, within: Mask | None = None) -> Mask:
    """
    Facets that can be reached from one without crossing a crease.

    Parameters
    ----------
    graph : FacetGraph
    face : int
        Where to begin.
    crease : float
        Edges whose facets differ by more than this are not crossed, rad, from 0 to pi.
    within : (m,) bool, optional
        Only these facets are entered, such as those of no region; the first one counts in any case.

    Raises
    ------
    RegionError
        No such facet or angle.
    """
    _check_angle(crease)
    graph.check_face(face)
    crossed = graph.creases <= crease
    if within is not None:
        entered = within.copy()
        entered[face] = True
        crossed &= entered[graph.pairs].all(axis=1)
    label = connected(graph.facet_count, *graph.pairs[crossed].T)
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
class Mirrored:
    """
    A mirrored set of facets.

    Attributes
    ----------
    before, probe : Probe
        The mesh, and with its facets cut along the outline of the image; the same object where none had to be.
    origin : (k,) int64
        The facet of the graph that each of its facets is a part of.
    mask : (k,) bool
        Its facets that lie in the image.
    unmatched : (c,) int64
        Facets of the set, ascending, that have no counterpart: no surface that faces their way is near enough to
        where their centroid is mirrored to.
    tolerance : float
        What near enough was, m.
    """

    before: Probe
    probe: Probe
    origin: Longs
    mask: Mask
    unmatched: Longs
    tolerance: float

    @property
    def sentence(self) -> str:
        """How well it went."""
        area = 1e4 * float(self.probe.areas[self.mask].sum())
        if len(self.unmatched) == 0:
            return message(f"{arg(area):.3g} cm² mirrored; every facet has a counterpart.")
        return message(
            f"{arg(area):.3g} cm² mirrored; {arg(len(self.unmatched))} facets have no counterpart within"
            f" {arg(1e3 * self.tolerance):.3g} mm: the surface is not symmetric there."
        )

    def give(self, model: RegionModel, rank: int, *, protect: bool, text: str) -> int:
        """Give the image to a region, as one step of the model; returns how many facets changed."""
        before = model.labels[self.origin]
        changed = self.mask & (before != rank) & ((before == 0) | (not protect))
        if changed.any():
            labels = np.where(changed, rank, before).astype(np.int32)
            model.relabel(labels, self.before, self.probe, text)
        return int(np.count_nonzero(changed))


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
    there = facing_surface(surface, image[0][image[1][own]].mean(axis=1), turned, reach)
    cut = probe.cut(mesh, origin) if len(origin) > len(mask) else probe
    return Mirrored(probe, cut, origin, found > 0, own[there < 0], reach)


def _edge(graph: FacetGraph) -> float:
    return math.sqrt(float(graph.probe.areas.mean()) * 4 / math.sqrt(3))


# ---- growing, shrinking and smoothing a set of facets; (m,) bool in, (m,) bool out ---------------


_MOST_RINGS = 10_000


def grow(graph: FacetGraph, mask: Mask, *, rings: int = 0, distance: float = 0.0) -> Mask:
    """
    Take in facets around the border.

    Parameters
    ----------
    graph : FacetGraph
    mask : (m,) bool
    rings : int
        So many times all facets that share a vertex with the mask.
    distance : float
        Or: all whose centroid is this near the border, m along the surface. Give one of the two.

    Raises
    ------
    RegionError
        Both or neither are given, or one is not positive.
    """
    _check_amount(rings, distance)
    if rings:
        return _grow_rings(graph, mask, rings)
    return mask | _near_border(graph, mask, distance)


def shrink(graph: FacetGraph, mask: Mask, *, rings: int = 0, distance: float = 0.0) -> Mask:
    """
    Give up facets along the border; a rim of the mesh is none.

    Parameters and errors as for `grow`.
    """
    _check_amount(rings, distance)
    if rings:
        return ~_grow_rings(graph, ~mask, rings)
    return mask & ~_near_border(graph, mask, distance)


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


def _near_border(graph: FacetGraph, mask: Mask, distance: float) -> Mask:
    near = np.zeros_like(mask)
    border = graph.border_vertices(mask)
    if len(border):
        faces, _ = graph.geodesic.spread(border, distance)
        near[faces] = True
    return near


def _check_amount(rings: int, distance: float) -> None:
    if (rings == 0) == (distance == 0):
        raise RegionError("give the distance, either in rings of facets or as a length.")
    if not (0 <= rings <= _MOST_RINGS and distance >= 0 and math.isfinite(distance)):
        what = f"{rings} rings" if rings else f"{distance} m"
        raise RegionError(
            f"{arg(what)} is not a valid distance: give 1 to {arg(_MOST_RINGS)} rings, or a length above 0."
        )
