"""The facets on the other side of a plane."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.regions.region import RegionError
from contactbench.pipeline.mesh.regions.selections import unit, vector

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph, Mask


@dataclass(frozen=True, eq=False)
class Mirrored:
    """
    A mirrored set of facets.

    Attributes
    ----------
    mask : (m,) bool
        Facets whose mirror image lies on a facet of the set.
    unmatched : (c,) int64
        Facets of the set, ascending, that have no counterpart: no centroid is near enough to where theirs is
        mirrored to.
    tolerance : float
        What near enough was, m.
    """

    mask: Mask
    unmatched: npt.NDArray[np.int64]
    tolerance: float

    @property
    def sentence(self) -> str:
        """How well it went."""
        found = int(np.count_nonzero(self.mask))
        if len(self.unmatched) == 0:
            return message(f"{arg(found)} facets mirrored; every one has a counterpart.")
        return message(
            f"{arg(found)} facets mirrored; {arg(len(self.unmatched))} have no counterpart within"
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
    Find the facets that lie where those of a set are after mirroring.

    A facet is found when, of all centroids, the one nearest to its own mirrored centroid belongs to the set
    and is within the tolerance; facets that face different ways count as further apart, and those that face
    opposite ways never match. Asked from the far side like this, a mesh that is not symmetric itself leaves no
    holes in a set that is.

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
    centres, normals = graph.centroids, graph.probe.normals
    images = centres - 2 * np.outer((centres - p) @ n, n)
    turned = normals - 2 * np.outer(normals @ n, n)
    near, nearest = _nearest(centres, normals, images, turned, reach)
    found = near & mask[np.minimum(nearest, len(mask) - 1)]
    return Mirrored(found, np.flatnonzero(mask & ~near), reach)


def _nearest(
    centres: npt.NDArray[np.float64],
    normals: npt.NDArray[np.float64],
    images: npt.NDArray[np.float64],
    turned: npt.NDArray[np.float64],
    reach: float,
) -> tuple[Mask, npt.NDArray[np.int64]]:
    """For each image whether there is a centroid in reach that faces the same way, and the nearest such one."""
    # A normal that points the other way is as far as the reach: the two sides of a wall stay apart.
    tree = cKDTree(np.hstack((centres, normals * (reach / 2))))
    distance, nearest = tree.query(np.hstack((images, turned * (reach / 2))), distance_upper_bound=reach)
    return np.isfinite(distance), np.asarray(nearest, dtype=np.int64)


def _edge(graph: FacetGraph) -> float:
    return math.sqrt(float(graph.probe.areas.mean()) * 4 / math.sqrt(3))
