"""Defects of a triangle mesh, counted, and put in words for the person who has to mend them."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs

# Volumes below this share of the bounding cube are rounding: a folded sheet has no inside.
_FLAT = 1e-12


@dataclass(frozen=True)
class MeshHealth:
    """
    What is sound and what is not about a mesh.

    Attributes
    ----------
    watertight : bool
        Every edge belongs to exactly two facets.
    winding_consistent : bool
        No two neighbouring facets disagree about which side is outside.
    outward : bool or None
        Whether the facets face outwards (positive signed volume); None where the mesh cannot tell:
        inconsistent winding, no volume, or so open that the sign depends on where one stands.
    components : int
        Separate parts; facets that share a vertex belong to the same part.
    boundary_edges : int
        Edges of one facet only: the rims of holes.
    nonmanifold_edges : int
        Edges of more than two facets.
    duplicate_facets : int
        Facets beyond the first with the same three vertices and the same winding.
    dropped_facets : int
        Facets without area that were left out when the file was read.
    """

    watertight: bool
    winding_consistent: bool
    outward: bool | None
    components: int
    boundary_edges: int
    nonmanifold_edges: int
    duplicate_facets: int
    dropped_facets: int = 0

    @property
    def sentences(self) -> tuple[str, ...]:
        """What is wrong, why it matters and what to do, in sentences per defect; empty when sound."""
        return tuple(self._sentences())

    def _sentences(self) -> Iterator[str]:
        if self.boundary_edges > 0:
            yield message(
                f"The surface is open (edges at a hole or gap: {arg(self.boundary_edges)}). A line of force can"
                " pass through and end on an inner wall. Close the outer shell before use."
            )
        if self.nonmanifold_edges > 0:
            yield message(
                f"More than two facets meet at an edge (edges: {arg(self.nonmanifold_edges)}), so"
                " inside and outside cannot be told apart there. Keep only the outer shell."
            )
        if not self.winding_consistent:
            yield message(
                "Neighbouring facets disagree about which side is outside. Contacts on flipped"
                " facets are missed, or found on the far side. Make the normals consistent in the"
                " CAD program."
            )
        if self.outward is False:
            yield message(
                "The mesh is inside out: its facets face inwards, so contacts would be found on the far side of the"
                " probe. Flip all normals in the CAD program."
            )
        if self.components > 1:
            yield message(
                f"The mesh has {arg(self.components)} separate parts. A part inside the housing can be"
                " mistaken for the surface. Keep only the outer shell."
            )
        if self.duplicate_facets > 0:
            yield message(
                f"Facets occur more than once (surplus: {arg(self.duplicate_facets)}). They slow the"
                " search and give double answers. Remove duplicate facets in the CAD program."
            )
        if self.dropped_facets > 0:
            yield message(
                f"Facets without area were left out (facets: {arg(self.dropped_facets)}). They cannot"
                " be touched, but may have closed a seam. If the surface is open, export again"
                " with cleaner triangles."
            )


def measure_health(vertices: Floats, faces: Ints, dropped_facets: int = 0) -> MeshHealth:
    """
    Count the defects of a mesh.

    Parameters
    ----------
    vertices : (n, 3) float64
        Finite; any length unit, any frame.
    faces : (m, 3) int32
        At least one facet, indices in range, no index twice in a row.
    dropped_facets : int
        Passed through to the result.

    Returns
    -------
    MeshHealth
        In O(m log m); about 0.5 s for a million facets.
    """
    edges = edge_table(faces, len(vertices))
    uses, balance = edges.uses, edges.balance
    # An even number of facets round an edge must run along it equally often in both directions.
    consistent = bool(np.all(np.abs(balance)[uses > 1] <= (uses % 2)[uses > 1]))
    return MeshHealth(
        watertight=bool(np.all(uses == 2)),
        winding_consistent=consistent,
        outward=_outward(vertices, faces) if consistent else None,
        components=int(label_parts(faces, len(vertices)).max()) + 1,
        boundary_edges=int(np.count_nonzero(uses == 1)),
        nonmanifold_edges=int(np.count_nonzero(uses > 2)),
        duplicate_facets=_duplicates(faces, len(vertices)),
        dropped_facets=dropped_facets,
    )


class EdgeTable(NamedTuple):
    """
    Every edge of a mesh once.

    Attributes
    ----------
    low, high : (e,) int64
        Its vertices, the lower index first; edges are in ascending order of both.
    uses : (e,) int64
        How many facets have it.
    balance : (e,) int64
        Uses from low to high minus uses from high to low.
    """

    low: Longs
    high: Longs
    uses: Longs
    balance: Longs


def edge_table(faces: Ints, vertex_count: int) -> EdgeTable:
    """
    List the edges of a mesh.

    Parameters
    ----------
    faces : (m, 3) int32
        Indices in range, no index twice in a row.
    vertex_count : int
        Above the highest index.

    Returns
    -------
    EdgeTable
        In O(m log m).
    """
    start = faces.T.astype(np.int64)
    end = np.roll(start, -1, axis=0)
    # One integer per directed edge, direction in the lowest bit: a plain sort then groups the edges,
    # and costs a fifth of a row-wise unique.
    key = (np.minimum(start, end) * vertex_count + np.maximum(start, end)) * 2 + (start < end)
    key = np.sort(key.ravel())
    first = np.flatnonzero(np.diff(key >> 1, prepend=-1))
    uses = np.diff(first, append=len(key))
    forward = np.add.reduceat(key & 1, first)
    low, high = np.divmod(key[first] >> 1, vertex_count)
    return EdgeTable(low, high, uses, 2 * forward - uses)


def connected(count: int, a: Longs | Ints, b: Longs | Ints) -> Longs:
    """Return the part, 0, 1, ..., of each of `count` nodes of a graph that links join, (k,) from a to b."""
    label = np.arange(count)
    while len(a):
        # Every part takes the number of a lower one that it is joined to, and those in a chain that of the last.
        label[np.maximum(a, b)] = np.minimum(a, b)
        while not np.array_equal(further := label[label], label):
            label = further
        a, b = label[a], label[b]
        a, b = a[a != b], b[a != b]
    return np.unique(label, return_inverse=True)[1].astype(np.int64)


def label_parts(faces: Ints, vertex_count: int) -> Longs:
    """
    Label the separate parts of a mesh; facets that share a vertex belong to the same part.

    Parameters
    ----------
    faces : (m, 3) int32
        At least one facet, indices in range.
    vertex_count : int
        Above the highest index.

    Returns
    -------
    (m,) int64
        The part of each facet: 0, 1, ..., none left out.
    """
    rows = np.concatenate((faces[:, 0], faces[:, 1]))
    columns = np.concatenate((faces[:, 1], faces[:, 2]))
    label = connected(vertex_count, rows, columns)
    # Vertices that no facet uses are parts of their own in the graph, but not in the mesh.
    return np.unique(label[faces[:, 0]], return_inverse=True)[1].astype(np.int64)


def _duplicates(faces: Ints, vertex_count: int) -> int:
    # Turn every facet so that its smallest index comes first; that keeps the winding.
    lowest = np.argmin(faces, axis=1)
    a, b, c = (faces[np.arange(len(faces)), (lowest + k) % 3].astype(np.int64) for k in range(3))
    pair = a * vertex_count + b
    order = np.lexsort((c, pair))
    return int(np.count_nonzero((np.diff(pair[order]) == 0) & (np.diff(c[order]) == 0)))


def _outward(vertices: Floats, faces: Ints) -> bool | None:
    """
    Sign of the volume that the facets enclose, as far as it can be told.

    Seen from o the signed volume is V(o) = V(0) - o . a / 3, where a is the vector area, zero for a closed
    mesh. With holes it depends on o; where it has one sign over the whole bounding box the sign is still
    certain (so it is for an open box), otherwise the answer is None.
    """
    low, high = vertices[faces].min(axis=(0, 1)), vertices[faces].max(axis=(0, 1))
    size = float((high - low).max())
    # Centred and to unit size: no cancellation far from the origin, no underflow for tiny meshes.
    a, b, c = ((vertices[faces[:, corner]] - (low + high) / 2) / size for corner in range(3))
    cross = np.cross(b - a, c - a)
    volume = float(np.vdot(a, cross)) / 6
    area = cross.sum(axis=0) / 2
    half = (high - low) / (2 * size)
    seen = [volume - float(np.dot(half * signs, area)) / 3 for signs in product((-1.0, 1.0), repeat=3)]
    if min(seen) > _FLAT:
        return True
    return False if max(seen) < -_FLAT else None
