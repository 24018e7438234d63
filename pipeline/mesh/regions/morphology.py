"""Growing, shrinking and smoothing a set of facets; (m,) bool in, (m,) bool out."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array, diags_array

from contactbench.pipeline.errors import arg
from contactbench.pipeline.mesh.regions.region import RegionError
from contactbench.pipeline.mesh.regions.selections import component_labels

if TYPE_CHECKING:
    import numpy.typing as npt
    from scipy.sparse import csr_array

    from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph, Mask

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


def _cut(graph: FacetGraph, values: npt.NDArray[np.float64], mask: Mask) -> Mask:
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
    label = component_labels(graph.facet_count, graph.pairs[mask[graph.pairs].all(axis=1)])
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
    weights = coo_array((areas[columns], (rows, columns)), shape=(m, m)).tocsr()
    mean: csr_array[np.float64] = (diags_array(1 / weights.sum(axis=1)) @ weights).tocsr()
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
