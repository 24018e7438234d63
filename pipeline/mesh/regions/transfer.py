"""Carry regions from one mesh of a surface to another: after making a shell, simplifying, or a new export."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh.errors import MeshWarning
from contactbench.pipeline.mesh.regions.region import RegionError, RegionSet

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy.typing as npt

    from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Surface
    from contactbench.pipeline.mesh.probe import Probe

# Of the old mesh's size: a surface that was made a shell or simplified stays well within.
_REACH = 0.02


@dataclass(frozen=True)
class RegionReport:
    """
    What became of one region.

    Attributes
    ----------
    name : str
    before, after : float
        Its area on the old and on the new mesh, m².
    lost, gained : float
        Area of the old region that no facet of the new one lies on, and of the new one that lies outside the
        old, m²; as far as centroids tell.
    """

    name: str
    before: float
    after: float
    lost: float
    gained: float

    @property
    def vanished(self) -> bool:
        """There was a region, and nothing of it is left."""
        return self.before > 0 and self.after == 0

    @property
    def change(self) -> float:
        """Change of the area as a share of what it was; NaN for a region that was empty."""
        return (self.after - self.before) / self.before if self.before > 0 else math.nan

    @property
    def sentence(self) -> str:
        """The figures for people, mm² and %."""
        if self.vanished:
            return message(f"{arg(self.name)}: VANISHED, it had {arg(1e6 * self.before):.3g} mm².")
        if self.before == 0:
            return message(f"{arg(self.name)}: empty before, {arg(1e6 * self.after):.3g} mm² now.")
        return message(
            f"{arg(self.name)}: {arg(1e6 * self.before):.4g} mm² before, {arg(1e6 * self.after):.4g} mm² now"
            f" ({arg(100 * self.change):+.2f} %); lost {arg(1e6 * self.lost):.3g} mm²"
            f" ({arg(100 * self.lost / self.before):.2f} %), gained {arg(1e6 * self.gained):.3g} mm²"
            f" ({arg(100 * self.gained / self.before):.2f} %)."
        )

    def to_json(self) -> dict[str, Any]:
        """Areas in mm²."""
        return {
            "name": self.name,
            "before_mm2": 1e6 * self.before,
            "after_mm2": 1e6 * self.after,
            "lost_mm2": 1e6 * self.lost,
            "gained_mm2": 1e6 * self.gained,
            "vanished": self.vanished,
        }


@dataclass(frozen=True, eq=False)
class Transferred:
    """
    Regions on the new mesh, and what it cost.

    Attributes
    ----------
    regions : RegionSet
        The same names, colours and order.
    report : tuple of RegionReport
        One per region, in the order of priority.
    unmatched : int
        Facets of the new mesh that belong to no region because the old surface is too far away there, or
        faces the other way.
    """

    regions: RegionSet
    report: tuple[RegionReport, ...]
    unmatched: int

    @property
    def warnings(self) -> tuple[str, ...]:
        """What someone should look at, in sentences."""
        return tuple(self._warnings())

    def _warnings(self) -> Iterator[str]:
        for part in self.report:
            if part.vanished:
                yield message(
                    f"the region {arg(part.name)} ({arg(1e6 * part.before):.3g} mm²) vanished: the new mesh is"
                    " too coarse there or has lost that part. Keep more facets, or paint it again."
                )
        if self.unmatched:
            yield message(
                f"{arg(self.unmatched)} of {arg(len(self.regions.labels))} facets have no part of the old"
                " surface near them and belong to no region: check that both meshes are in the"
                " same place."
            )


def transfer(
    regions: RegionSet,
    old: Probe,
    new: Probe,
    vertex_map: npt.ArrayLike | None = None,
    *,
    reach: float | None = None,
) -> Transferred:
    """
    Carry regions to another mesh of the same surface, in the same frame.

    A facet whose three corners come from the corners of one old facet takes over that one's region. Any other
    takes the region of the old surface's point nearest to its centroid, among facets that face the same way:
    a thin wall does not take over what lies on its other side.

    Parameters
    ----------
    regions : RegionSet
        On the old mesh.
    old, new : Probe
        Both in S.
    vertex_map : (n,) array_like of integers, optional
        For each vertex of the new mesh the old vertex it is, -1 for none.
    reach : float, optional
        Facets further than this from the old surface belong to no region, m; 2 % of the old size when left out.

    Returns
    -------
    Transferred

    Raises
    ------
    RegionError
        Regions of another mesh, or a vertex map that does not fit.

    Warns
    -----
    MeshWarning
        A region vanished, or facets have no counterpart.
    """
    if len(regions.labels) != len(old.faces):
        raise RegionError(
            f"the regions are for {arg(len(regions.labels))} facets, but the old mesh has"
            f" {arg(len(old.faces))}: give the mesh that they belong to."
        )
    distance = _REACH * old.size if reach is None else reach
    labels, unmatched = carry_labels(
        (old.vertices, old.faces),
        regions.labels,
        (new.vertices, new.faces),
        vertex_map=vertex_map,
        reach=distance,
    )
    carried = RegionSet(regions.regions, labels)
    back, _ = carry_labels(
        (new.vertices, new.faces), labels, (old.vertices, old.faces), vertex_map=None, reach=distance
    )
    forth = labels
    result = Transferred(carried, _report(regions, back, forth, old, new), unmatched)
    if result.warnings:
        warnings.warn(join(" ", result.warnings), MeshWarning, stacklevel=2)
    return result


def _report(regions: RegionSet, back: Ints, forth: Ints, old: Probe, new: Probe) -> tuple[RegionReport, ...]:
    """Compare areas; what the new labels say when carried back onto the old mesh tells what was lost and gained."""
    parts = []
    for rank, region in enumerate(regions.regions, 1):
        was, returned, now = regions.labels == rank, back == rank, forth == rank
        parts.append(
            RegionReport(
                region.name,
                float(old.areas[was].sum()),
                float(new.areas[now].sum()),
                lost=float(old.areas[was & ~returned].sum()),
                gained=float(old.areas[returned & ~was].sum()),
            )
        )
    return tuple(parts)


# ---- the label of the nearest surface that faces the same way; arrays in, arrays out -------------


# Normals this far apart (60 degrees) still agree: a coarse facet may cut a rounded edge.
_AGREE = 0.5

# The axes and diagonals of a cube: every direction is within 35 degrees of one of them.
_DIRECTIONS = np.array(
    [d for d in product((-1, 0, 1), repeat=3) if sum(map(abs, d)) in (1, 3)], dtype=np.float64
)
_DIRECTIONS /= np.linalg.norm(_DIRECTIONS, axis=1, keepdims=True)


def carry_labels(
    old: Surface,
    labels: Ints,
    new: Surface,
    *,
    vertex_map: npt.ArrayLike | None = None,
    reach: float = np.inf,
) -> tuple[Ints, int]:
    """
    Give every new facet the label of the old surface under its centroid.

    Parameters
    ----------
    old, new : ((n, 3) float64, (m, 3) int32)
        Vertices in one frame and unit, C-contiguous, and facets.
    labels : (m,) int32
        Of the old facets; 0 for none.
    vertex_map : (n,) array_like of integers, optional
        For each new vertex the old vertex it is, -1 for none. A facet whose corners are those of an old facet
        takes its label without any search.
    reach : float
        Beyond this distance, in the vertices' unit, a facet gets 0.

    Returns
    -------
    labels : (m,) int32
        Of the new facets.
    unmatched : int
        New facets that got 0 because nothing that faces their way is in reach.

    Raises
    ------
    RegionError
        A vertex map of another length, or with numbers of vertices that do not exist.
    """
    carried = np.zeros(len(new[1]), dtype=np.int32)
    source = np.full(len(new[1]), -1, dtype=np.int64)
    if vertex_map is not None:
        source = _same_facets(old, new, vertex_map)
    open_faces = np.flatnonzero(source < 0)
    if len(open_faces):
        source[open_faces] = nearest_facets(old, new, open_faces, reach)
    found = source >= 0
    carried[found] = labels[source[found]]
    return carried, int(np.count_nonzero(~found))


def nearest_facets(old: Surface, new: Surface, chosen: Longs, reach: float) -> Longs:
    """Old facet nearest to each chosen new facet's centroid that faces the same way; -1 beyond `reach`; (k,)."""
    old_normals, new_normals = _normals(old), _normals((new[0], new[1][chosen]))
    centroids = np.ascontiguousarray(new[0][new[1][chosen]].mean(axis=1))
    distance, face, _ = SurfaceIndex(*old).closest(centroids)
    found = face.astype(np.int64)
    agree = np.einsum("ij,ij->i", old_normals[found], new_normals) >= _AGREE
    wrong = np.flatnonzero(~agree)
    if len(wrong):
        found[wrong], distance[wrong] = _facing(old, old_normals, centroids[wrong], new_normals[wrong])
    found[~(distance <= reach)] = -1
    return found


def _facing(old: Surface, old_normals: Floats, points: Floats, normals: Floats) -> tuple[Longs, Floats]:
    """Search again among those old facets only that face about the same way as each point's facet."""
    found = np.full(len(points), -1, dtype=np.int64)
    distance = np.full(len(points), np.inf)
    nearest_direction = np.argmax(normals @ _DIRECTIONS.T, axis=1)
    for number in np.unique(nearest_direction):
        direction = _DIRECTIONS[number]
        # Facets within 90 degrees of the direction; so all that agree with a normal near it are among them.
        subset = np.flatnonzero(old_normals @ direction > 0)
        if len(subset) == 0:
            continue
        rows = np.flatnonzero(nearest_direction == number)
        index = SurfaceIndex(old[0], np.ascontiguousarray(old[1][subset]))
        away, face, _ = index.closest(np.ascontiguousarray(points[rows]))
        facets = subset[face]
        same_side = np.einsum("ij,ij->i", old_normals[facets], normals[rows]) > 0
        found[rows[same_side]] = facets[same_side]
        distance[rows[same_side]] = away[same_side]
    return found, distance


def _same_facets(old: Surface, new: Surface, vertex_map: npt.ArrayLike) -> Longs:
    """Old facet with the same three corners per new facet, -1 for none."""
    mapping = np.asarray(vertex_map)
    count = len(old[0])
    if mapping.shape != (len(new[0]),) or mapping.dtype.kind not in "iu":
        raise RegionError(
            f"the vertex map is {arg(mapping.dtype)} of shape {arg(mapping.shape)}, but the new mesh has"
            f" {arg(len(new[0]))} vertices: give one old vertex number each, -1 for none."
        )
    if mapping.size and (mapping.min() < -1 or mapping.max() >= count):
        raise RegionError(
            f"the vertex map names vertex {arg(int(mapping.max()))} or one below -1, but the old mesh has {arg(count)}"
            " vertices: it belongs to another mesh."
        )
    ours, theirs = np.sort(old[1].astype(np.int64)), np.sort(mapping.astype(np.int64)[new[1]])
    # Two numbers per facet: three indices of 31 bits do not fit into one.
    both = np.vstack((ours, theirs))
    pair = np.unique(both[:, 0] * (count + 1) + both[:, 1], return_inverse=True)[1].ravel()
    key = pair.astype(np.int64) * (count + 1) + both[:, 2]
    order = np.argsort(key[: len(ours)], kind="stable")
    run = key[: len(ours)][order]
    place = np.minimum(np.searchsorted(run, key[len(ours) :]), len(run) - 1)
    hit = (run[place] == key[len(ours) :]) & (theirs >= 0).all(axis=1)
    return np.where(hit, order[place], -1)


def _normals(mesh: Surface) -> Floats:
    a, b, c = (mesh[0][mesh[1][:, corner]] for corner in range(3))
    cross = np.cross(b - a, c - a)
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    # A facet without area faces nowhere: it agrees with nothing.
    normals: Floats = np.divide(cross, length, out=np.zeros_like(cross), where=length > 0)
    return normals
