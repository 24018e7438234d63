"""
Bell curves on a surface: each contact spread by a Gaussian of the distance along the surface.

Contacts in the same cell of half a bandwidth become one source at their middle: that changes the width of
a bell by about 1 %, and bounds the work whatever the bandwidth. A bell ends at three
bandwidths and is scaled so that its integral over the surface is 1, also beside an edge of the mesh. Where facets are
so large that a bell reaches no corner, a source is shared among the corners of its facet by its barycentric weights.
"""

from functools import cached_property
from math import prod

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from contactbench.pipeline.kernel import Geodesic, SurfaceIndex
from contactbench.pipeline.mesh import Probe

REACH = 3.0  # bandwidths
_CELL = 0.5  # bandwidths
_MOST_PLACES = 2**25  # where a table of them is faster than sorting


class Bells:
    """
    Bells of one bandwidth around n contacts on one probe.

    Parameters
    ----------
    probe : Probe
    points : (n, 3) float64
        S, m; on the surface or near it.
    bandwidth : float
        Standard deviation of a bell along the surface, m.

    Attributes
    ----------
    areas : (v,) float64
        A third of the facets around each vertex, m². Their sum is the whole surface.
    """

    def __init__(self, probe: Probe, points: NDArray[np.float64], bandwidth: float) -> None:
        self._probe, self._bandwidth = probe, bandwidth
        self.areas = vertex_areas(probe)
        index = SurfaceIndex(probe.vertices, probe.faces)
        _, faces, nearest = index.closest(np.ascontiguousarray(points, dtype=np.float64))
        self._source_of, middles = _cells(probe, nearest, faces, _CELL * bandwidth)
        _, self._faces, self._middles = index.closest(middles)

    def spread(
        self, weights: NDArray[np.float64], rows: NDArray[np.intp] | None = None
    ) -> NDArray[np.float64]:
        """
        Return the density (v,) of weights (n,), in units of a weight per m²; its integral is their sum.

        With `rows` (k,), the weights (k,) are those of these contacts, and only they count; so too below.
        """
        spread: NDArray[np.float64] = self._matrix @ np.bincount(
            self._sources(rows), weights, minlength=len(self._faces)
        )
        return spread

    def mean(
        self, values: NDArray[np.float64], weights: NDArray[np.float64], rows: NDArray[np.intp] | None = None
    ) -> NDArray[np.float64]:
        """Return the mean (v,) of values (n,) under the bells; NaN beyond their reach."""
        total = self.spread(weights, rows)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = self.spread(weights * values, rows) / total
        # A mean lies among its values; so far out in the bells rounding may say otherwise.
        return np.where(total > 0, np.clip(mean, values.min(initial=0), values.max(initial=0)), np.nan)

    def peak(self, values: NDArray[np.float64], rows: NDArray[np.intp] | None = None) -> NDArray[np.float64]:
        """Return the largest value (v,) within one bandwidth, and at the corners of its facet; else NaN."""
        largest = np.full(len(self._faces), -np.inf)
        np.maximum.at(largest, self._sources(rows), values)
        sources, vertices, begins = self._near
        peak = np.full(len(self.areas), np.nan)
        found = np.maximum.reduceat(largest[sources], begins)
        peak[vertices] = np.where(np.isfinite(found), found, np.nan)
        return peak

    def at(self, vertex: int, rows: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return how high the bell of each of these contacts (k,) is at a vertex, 1/m²."""
        begin, end = self._matrix.indptr[vertex : vertex + 2]
        heights = np.zeros(len(self._faces))
        heights[self._matrix.indices[begin:end]] = self._matrix.data[begin:end]
        return np.asarray(heights[self._sources(rows)])

    def _sources(self, rows: NDArray[np.intp] | None) -> NDArray[np.intp]:
        return self._source_of if rows is None else self._source_of[rows]

    @cached_property
    def _near(self) -> tuple[NDArray[np.intp], NDArray[np.int32], NDArray[np.intp]]:
        """Sources within one bandwidth in the order of the vertices, these vertices, and where each one's begin."""
        rows, vertices, distances = self._reached
        near = distances <= self._bandwidth
        corners = self._probe.faces[self._faces]
        sources = np.concatenate([rows[near], np.repeat(np.arange(len(corners)), 3)])
        vertices = np.concatenate([vertices[near], corners.ravel()])
        order = np.argsort(vertices, kind="stable")
        return sources[order], *np.unique(vertices[order], return_index=True)

    @cached_property
    def _reached(self) -> tuple[NDArray[np.intp], NDArray[np.int32], NDArray[np.float64]]:
        """Pairs of a source and a vertex within reach, and how far they are apart, m."""
        geodesic = Geodesic(self._probe.vertices, self._probe.faces)
        first, vertices, distances = geodesic.around(self._faces, self._middles, REACH * self._bandwidth)
        return np.repeat(np.arange(len(self._faces)), np.diff(first)), vertices, distances

    @cached_property
    def _matrix(self) -> csr_array:
        """(vertices, sources) 1/m²; a column's integral over the surface is 1."""
        rows, vertices, distances = self._reached
        heights = np.exp(-0.5 * (distances / self._bandwidth) ** 2)
        lost = np.flatnonzero(np.bincount(rows, minlength=len(self._faces)) == 0)
        corners = self._probe.faces[self._faces[lost]]
        shares = barycentric(self._probe.vertices[corners], self._middles[lost])
        rows, vertices = np.append(rows, np.repeat(lost, 3)), np.append(vertices, corners.ravel())
        heights = np.append(heights, (shares / self.areas[corners]).ravel())
        integrals = np.bincount(rows, heights * self.areas[vertices], minlength=len(self._faces))
        shape = (len(self._faces), len(self.areas))
        return csr_array((heights / integrals[rows], (rows, vertices)), shape=shape).T.tocsr()


def vertex_areas(probe: Probe) -> NDArray[np.float64]:
    """Return a third of the area of the facets around each vertex, (v,) m²; 0 for one that no facet uses."""
    shares = np.repeat(probe.areas / 3, 3)
    return np.asarray(
        np.bincount(probe.faces.ravel(), shares, minlength=len(probe.vertices)), dtype=np.float64
    )


def barycentric(corners: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the weights (n, 3) of points (n, 3) on facets with these corners (n, 3, 3); none is negative."""
    a, b, c = np.moveaxis(corners, 1, 0)
    normal = np.cross(b - a, c - a)
    parts = [np.cross(c - b, points - b), np.cross(a - c, points - c), np.cross(b - a, points - a)]
    shares = np.clip(np.column_stack([np.einsum("ij,ij->i", part, normal) for part in parts]), 0.0, None)
    weights: NDArray[np.float64] = shares / shares.sum(axis=1, keepdims=True)
    return weights


def _cells(
    probe: Probe, points: NDArray[np.float64], faces: NDArray[np.int32], cell: float
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Return for each point (n, 3) the number of its source, (n,), and the middles (k, 3) of the sources."""
    # Two sides of a thin wall are near each other and must not become one: they face different ways.
    facing = ((probe.normals > 0) @ np.array([1, 2, 4])).take(faces)
    places = [np.floor((points[:, k] - probe.bounds[0, k]) / cell).astype(np.int64) for k in range(3)]
    group = _numbered([*places, facing])
    sums = np.column_stack([np.bincount(group, points[:, k]) for k in range(3)])
    return group, np.ascontiguousarray(np.divide(sums, np.bincount(group)[:, None]))


def _numbered(columns: list[NDArray[np.int64]]) -> NDArray[np.intp]:
    """Return for each row of columns of integers (n,) its place (n,) among the different ones in ascending order."""
    lowest = [int(column.min()) for column in columns]
    sizes = [int(column.max()) - low + 1 for column, low in zip(columns, lowest, strict=True)]
    if prod(sizes) > _MOST_PLACES:
        rows = np.column_stack(columns)
        return np.asarray(np.unique(rows, axis=0, return_inverse=True)[1].ravel(), dtype=np.intp)
    place = np.zeros(len(columns[0]), dtype=np.int64)
    for column, low, size in zip(columns, lowest, sizes, strict=True):
        place *= size
        place += column
        place -= low
    taken = np.zeros(prod(sizes), dtype=bool)
    taken[place] = True
    there = np.flatnonzero(taken)
    numbers = np.empty(len(taken), dtype=np.intp)  # most of it is never touched
    numbers[there] = np.arange(len(there))
    return np.asarray(numbers[place])


def vertex_normals(probe: Probe) -> NDArray[np.float64]:
    """Return unit normals (v, 3), those of the facets around weighted by area; 0 for a vertex without facets."""
    scaled = np.repeat(probe.normals * probe.areas[:, None], 3, axis=0)
    at, count = probe.faces.ravel(), len(probe.vertices)
    total = np.column_stack([np.bincount(at, scaled[:, k], minlength=count) for k in range(3)])
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return total / np.where(length > 0, length, 1.0)
