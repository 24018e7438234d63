"""The probe: a triangle mesh in the sensor frame S, checked once at the door and never changed after."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from typing import Any, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Surface
from contactbench.pipeline.shown import Shown

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


_Scalar = TypeVar("_Scalar", bound=np.generic)

SMALLEST_M = 0.005
LARGEST_M = 2.0

# No probe lies a million kilometres away; numbers like that are other data read as coordinates,
# and their squares would overflow.
_FARTHEST = 1e9

# A facet has no area when its height over its longest edge is below this share of the largest coordinate.
# A coordinate c is known to about eps * c, so below some tens of eps * c the facet's normal is made of
# rounding alone; a sliver a thousand times thinner than a float32 file can hold is still kept. Height, not
# area, because a small facet's area says nothing about its shape; coordinate, not size, because moving a
# mesh away from the origin rounds it.
_ROUNDING = 64 * float(np.finfo(np.float64).eps)


@dataclass(frozen=True, eq=False, repr=False)
class Probe(Shown):
    """
    A probe's surface in the sensor frame S.

    Make one with `from_arrays` or `load_probe`: they check; the bare constructor does not.

    Attributes
    ----------
    vertices : (n, 3) float64
        Metres in S, C-contiguous, read-only.
    faces : (m, 3) int32
        Vertex indices, counter-clockwise seen from outside, read-only.
    region : (m,) int32
        Priority per facet: 0 no region, 1 the first priority, 2 the next, and so on; read-only.
    invented : (m,) bool
        Facets that close an opening in the file: contacts there rest on a guess; read-only.
    name : str
        Name of the probe.
    health : MeshHealth
        Defects of the mesh.
    untouchable : tuple of int
        Numbers of the untouchable regions, hidden by a clamp or a drape.
    """

    vertices: Floats
    faces: Ints
    region: Ints
    invented: Mask
    name: str
    health: MeshHealth
    untouchable: tuple[int, ...] = ()

    def facts(self) -> dict[str, str]:
        """As `Shown.facts`."""
        size = " x ".join(f"{1e3 * each:.1f}" for each in np.ptp(self.bounds, axis=0))
        return {
            "facets": f"{len(self.faces):,}",
            "size": f"{size} mm",
            "regions": f"{self.region.max(initial=0)}",
        }

    @classmethod
    def from_arrays(
        cls,
        vertices_m: npt.ArrayLike,
        faces: npt.ArrayLike,
        region: npt.ArrayLike | None = None,
        *,
        invented: npt.ArrayLike | None = None,
        name: str = "probe",
        check_size: bool = True,
        untouchable: tuple[int, ...] = (),
    ) -> Probe:
        """
        Check arrays and make a probe of copies of them.

        Parameters
        ----------
        vertices_m : (n, 3) array_like of real numbers
            Metres in S. Unused vertices are kept, but do not count for bounds and size.
        faces : (m, 3) array_like of integers
            Vertex indices, counter-clockwise seen from outside.
        region : (m,) array_like of integers, optional
            Priority per facet, 0 for none. Default: all 0.
        invented : (m,) array_like of bool or 0 and 1, optional
            Facets that are not in the file. Default: none.
        name : str
            Name of the probe.
        check_size : bool
            Refuse a largest extent under 5 mm or over 2 m, which is nearly always a wrong unit.
        untouchable : tuple of int
            Numbers of the untouchable regions.

        Returns
        -------
        Probe

        Raises
        ------
        MeshError
            Wrong shape or dtype, no facets, a coordinate that is not finite, an index out of range, a facet
            that uses a vertex twice or has no area, a negative region, an `invented` other than 0 or 1, or an
            implausible size.
        """
        vertices = check_vertices(vertices_m)
        triangles = check_faces(faces, len(vertices))
        priorities = check_region(region, len(triangles))
        guessed = check_invented(invented, len(triangles))
        _refuse_degenerate(vertices, triangles)
        if check_size:
            refuse_size(extent(vertices, triangles), _array_remedy)
        return build_probe(vertices, triangles, priorities, name, invented=guessed, untouchable=untouchable)

    def with_region(self, region: npt.ArrayLike, untouchable: tuple[int, ...] = ()) -> Probe:
        """
        Give the same surface other regions; vertices and faces are shared, not copied.

        Parameters
        ----------
        region : (m,) array_like of integers
            Priority per facet, 0 for none.
        untouchable : tuple of int, optional
            Numbers of the untouchable regions.

        Returns
        -------
        Probe

        Raises
        ------
        MeshError
            Wrong length or dtype, or a negative region.
        """
        labels = _frozen(check_region(region, len(self.faces)))
        return replace(self, region=labels, untouchable=untouchable)

    def with_invented(self, invented: npt.ArrayLike) -> Probe:
        """
        Give the same surface other marks of what was made up; vertices and faces are shared, not copied.

        Parameters
        ----------
        invented : (m,) array_like of bool

        Returns
        -------
        Probe

        Raises
        ------
        MeshError
            Wrong length or content.
        """
        return replace(self, invented=_frozen(check_invented(invented, len(self.faces))))

    def cut(self, mesh: Surface, origin: Longs) -> Probe:
        """
        Give the same surface in other facets; each is like the facet that it is a part of.

        Parameters
        ----------
        mesh : Surface
            Vertices, (n, 3) float64, and facets, (m, 3) int32: they belong to nobody else.
        origin : (m,) int64
            The facet that each is a part of.
        """
        vertices, faces = mesh
        return replace(
            self,
            vertices=_frozen(vertices),
            faces=_frozen(faces),
            region=_frozen(self.region[origin]),
            invented=_frozen(self.invented[origin]),
        )

    @cached_property
    def normals(self) -> Floats:
        """Outward unit normal per facet in S, (m, 3), read-only."""
        cross, _ = _cross(self.vertices, self.faces)
        return _frozen(cross / np.linalg.norm(cross, axis=1, keepdims=True))

    @cached_property
    def preferred(self) -> Mask:
        """Facets of a region that is there to be touched, (m,), read-only."""
        return _frozen((self.region > 0) & ~np.isin(self.region, self.untouchable))

    @cached_property
    def areas(self) -> Floats:
        """Area per facet in m², (m,), read-only."""
        cross, scale = _cross(self.vertices, self.faces)
        return _frozen(np.linalg.norm(cross, axis=1) * (0.5 * scale**2))

    @cached_property
    def bounds(self) -> Floats:
        """Lowest and highest coordinate of the surface per axis of S in metres, (2, 3), read-only."""
        return _frozen(_bounds(self.vertices, self.faces))

    @cached_property
    def size(self) -> float:
        """Largest extent along an axis of S, in metres."""
        return float(np.ptp(self.bounds, axis=0).max())


def build_probe(
    vertices: Floats,
    faces: Ints,
    region: Ints,
    name: str,
    dropped_facets: int = 0,
    invented: Mask | None = None,
    untouchable: tuple[int, ...] = (),
) -> Probe:
    """Make a probe of arrays that have passed every check and belong to nobody else: they are frozen here."""
    health = measure_health(vertices, faces, dropped_facets)
    if invented is None:
        invented = np.zeros(len(faces), dtype=bool)
    return Probe(
        _frozen(vertices), _frozen(faces), _frozen(region), _frozen(invented), name, health, untouchable
    )


def check_vertices(values: npt.ArrayLike) -> Floats:
    """
    Copy coordinates to (n, 3) float64.

    Raises
    ------
    MeshError
        Not (n, 3), not real numbers, not finite, or further from the origin than any length can be.
    """
    array = _as_array(values, "vertices", "numbers")
    if array.dtype.kind not in "fiu":
        raise MeshError(
            f"vertices must be real numbers in metres, not {arg(array.dtype)}: convert them to float64."
        )
    if array.ndim != 2 or array.shape[1] != 3:
        raise MeshError(
            f"vertices must have shape (n, 3), not {arg(array.shape)}: give one x, y, z row per vertex."
        )
    # A longdouble beyond the range of float64 becomes infinite here, and is named below.
    with np.errstate(over="ignore"):
        vertices = np.array(array, dtype=np.float64, order="C")
    bad = ~(np.abs(vertices) <= _FARTHEST).all(axis=1)
    if bad.any():
        row = int(np.argmax(bad))
        place = ", ".join(f"{value:g}" for value in vertices[row])
        what = (
            message("is not a finite point")
            if not np.isfinite(vertices[row]).all()
            else message("is impossibly far away")
        )
        raise MeshError(
            f"vertices: row {arg(row)} ({arg(place)}) {arg(what)}; {arg(np.count_nonzero(bad))} of"
            f" {arg(len(vertices))} rows are. Repair or export the mesh again."
        )
    return vertices


def check_faces(values: npt.ArrayLike, vertex_count: int) -> Ints:
    """
    Copy facets to (m, 3) int32.

    Raises
    ------
    MeshError
        Not (m, 3), not integers, none at all, or an index that is negative or at least `vertex_count`.
    """
    array = _as_array(values, "faces", "integers")
    if array.size == 0:
        raise MeshError("faces: there are no facets: give at least one.")
    if array.dtype.kind not in "iu":
        raise MeshError(
            f"faces must be integers, not {arg(array.dtype)}: convert the vertex indices to int32."
        )
    if array.ndim != 2 or array.shape[1] != 3:
        raise MeshError(
            f"faces must have shape (m, 3), not {arg(array.shape)}: split polygons into triangles."
        )
    bad = ((array < 0) | (array >= vertex_count)).any(axis=1)
    if bad.any():
        row = int(np.argmax(bad))
        value = next(int(v) for v in array[row] if v < 0 or v >= vertex_count)
        raise MeshError(
            f"faces: row {arg(row)} refers to vertex {arg(value)}, but the indices run from 0 to"
            f" {arg(vertex_count - 1)}. Count vertices from 0, and export the mesh again if it was cut"
            " short."
        )
    return np.array(array, dtype=np.int32, order="C")


def check_region(values: npt.ArrayLike | None, facet_count: int) -> Ints:
    """
    Copy priorities to (m,) int32; all 0 for None.

    Raises
    ------
    MeshError
        Not one integer from 0 to 2³¹ - 1 per facet.
    """
    if values is None:
        return np.zeros(facet_count, dtype=np.int32)
    array = _as_array(values, "region", "integers")
    if array.shape != (facet_count,):
        raise MeshError(
            f"region has shape {arg(array.shape)}, but there are {arg(facet_count)} facets: give one integer per facet."
        )
    if array.dtype.kind not in "iu":
        raise MeshError(
            f"region must be integers, not {arg(array.dtype)}: 0 for no region, 1 for the first priority."
        )
    bad = (array < 0) | (array > np.iinfo(np.int32).max)
    if bad.any():
        row = int(np.argmax(bad))
        raise MeshError(
            f"region: row {arg(row)} is {arg(array[row])}: use 0 for no region, 1 for the first priority, and so on."
        )
    return np.array(array, dtype=np.int32, order="C")


def check_invented(values: npt.ArrayLike | None, facet_count: int) -> Mask:
    """
    Copy marks to (m,) bool; all False for None.

    Raises
    ------
    MeshError
        Not one bool, or 0 or 1, per facet.
    """
    if values is None:
        return np.zeros(facet_count, dtype=bool)
    array = _as_array(values, "invented", "marks")
    if array.shape != (facet_count,) or array.dtype.kind not in "biu":
        raise MeshError(
            f"invented must be one 0 or 1 for each of the {arg(facet_count)} facets, not {arg(array.dtype)} of shape"
            f" {arg(array.shape)}."
        )
    if array.dtype.kind != "b" and not np.isin(array, (0, 1)).all():
        row = int(np.argmax(~np.isin(array, (0, 1))))
        raise MeshError(
            f"invented: row {arg(row)} is {arg(array[row])}: use 1 for a facet that closes an opening, else 0."
        )
    return np.array(array, dtype=bool, order="C")


def degenerate_facets(vertices: Floats, faces: Ints, reach: float = 0.0) -> Mask:
    """
    Facets that use a vertex twice or have no area within the rounding of their coordinates; (m,) bool.

    `reach`: how large coordinates may become when the mesh is moved, in their unit.
    """
    cross, scale = _cross(vertices, faces)
    sides = (vertices[np.roll(faces, -1, axis=1)] - vertices[faces]) / scale
    longest = np.sqrt(np.einsum("ijk,ijk->ij", sides, sides).max(axis=1))
    # Twice the area over the longest edge is the height; the scaled coordinates reach at most 1.
    rounding = _ROUNDING * max(1.0, reach / scale)
    flat: Mask = np.linalg.norm(cross, axis=1) <= rounding * longest
    return flat | _repeated(faces)


def extent(vertices: Floats, faces: Ints) -> float:
    """Largest extent along an axis of the vertices that facets use, in their own unit."""
    return float(np.ptp(_bounds(vertices, faces), axis=0).max())


def refuse_size(size_m: float, remedy: Callable[[bool], str]) -> None:
    """
    Refuse a size that no probe has.

    Parameters
    ----------
    size_m : float
        Largest extent in metres.
    remedy : callable
        Takes whether the probe is too large, returns the sentence that says what to do.

    Raises
    ------
    MeshError
        Under 5 mm or over 2 m.
    """
    if SMALLEST_M <= size_m <= LARGEST_M:
        return
    too_large = size_m > LARGEST_M
    limit = (
        message(f"more than {arg(LARGEST_M * 1e3):g} mm")
        if too_large
        else message(f"less than {arg(SMALLEST_M * 1e3):g} mm")
    )
    raise MeshError(f"the probe is {arg(size_m * 1e3):.6g} mm long, {arg(limit)}: {arg(remedy(too_large))}")


def _array_remedy(too_large: bool) -> str:
    unit, factor = (
        ("millimetres", "0.001")
        if too_large
        else (message("another unit than metres"), message("its length in metres"))
    )
    advice = message(" (from a file: load_probe with units='mm')") if too_large else ""
    return message(
        f"is the file in {arg(unit)}? Multiply by {arg(factor)}{arg(advice)}, or pass check_size=False if it"
        " is correct."
    )


def _refuse_degenerate(vertices: Floats, faces: Ints) -> None:
    bad = degenerate_facets(vertices, faces)
    if not bad.any():
        return
    row, count = int(np.argmax(bad)), int(np.count_nonzero(bad))
    why = message("uses a vertex twice") if _repeated(faces[row : row + 1])[0] else message("has zero area")
    raise MeshError(
        f"faces: row {arg(row)} {arg(faces[row].tolist())} {arg(why)}; {arg(count)} of {arg(len(faces))}"
        " facets have no area. Remove them, or read the mesh with load_probe, which leaves a few of them"
        " out."
    )


def _repeated(faces: Ints) -> Mask:
    a, b, c = faces.T
    repeated: Mask = (a == b) | (b == c) | (c == a)
    return repeated


def _cross(vertices: Floats, faces: Ints) -> tuple[Floats, float]:
    """Twice the area vector per facet, of the mesh divided by `scale`, and the scale: a power of two."""
    corners = vertices[faces]
    # A power of two divides without rounding, and coordinates of at most 1 neither overflow nor underflow.
    scale = float(np.ldexp(1.0, int(np.frexp(np.abs(corners).max())[1])))
    corners /= scale
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), scale


def _bounds(vertices: Floats, faces: Ints) -> Floats:
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    points = vertices[used]
    return np.stack((points.min(axis=0), points.max(axis=0)))


def _as_array(values: npt.ArrayLike, field: str, content: str) -> npt.NDArray[Any]:
    try:
        return np.asarray(values)
    except (ValueError, TypeError) as error:
        raise MeshError(f"{arg(field)} cannot be read as an array of {arg(content)}: {arg(error)}") from error


def _frozen(array: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
    array.flags.writeable = False
    return array
