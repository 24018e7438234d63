"""The probe: a triangle mesh in the sensor frame S, checked once at the door and never changed after."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Surface
from contactbench.pipeline.mesh.health import MeshHealth, measure_health
from contactbench.pipeline.shown import Shown

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
