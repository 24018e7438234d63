"""Polygons of any number of corners, convex or not, and the triangles that cover them."""

from array import array
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from contactbench.pipeline.errors import MeshError, arg, message
from contactbench.pipeline.mesh.arrays import Floats, Longs, Mask
from contactbench.pipeline.mesh.parse import refuse_too_many

# A triangle of a fan this flat, height over longest side, is left to the triangulation: it is as likely folded over.
_FLAT = 1e-6
# Corners of a planar polygon are known to single precision at best.
_PRECISION = 1e-6
# A polygon crosses itself when its triangles cover more than it does by this share.
_OVERLAP = 1e-3
# The triangulation takes up to the square of a polygon's corners, where it crosses itself; that is a second.
_MOST_WORK = 10**8
# Triangles that are looked at in one go: more would take memory and no less time.
_BLOCK = 2**17


@dataclass(frozen=True, eq=False)
class Triangulated:
    """
    The triangles of polygons.

    Attributes
    ----------
    faces : (m, 3) int64
        In the order of the polygons, wound like them.
    polygon : (m,) int64
        Which polygon each is of.
    notes : tuple of str
        What was left out or could not be right, in sentences.
    """

    faces: Longs
    polygon: Longs
    notes: tuple[str, ...]


class Polygons:
    """
    The polygons of a text, each with the line it stands on.

    Parameters
    ----------
    kind : str
        The format's name, for messages.
    """

    def __init__(self, kind: str) -> None:
        self._kind = kind
        self._corners = array("q")
        self._sizes = array("q")
        self._lines = array("q")
        self._facets = 0

    def add(self, polygon: Sequence[int], line: int) -> None:
        """
        Add one polygon, its vertices counted from 0.

        Raises
        ------
        MeshError
            There are too many facets now.
        """
        self._corners.extend(polygon)
        self._sizes.append(len(polygon))
        self._lines.append(line)
        self._facets += max(len(polygon) - 2, 0)
        refuse_too_many(self._facets)

    def finish(self, vertices: Floats) -> Triangulated:
        """
        Give the triangles, all of whose vertices are there.

        Parameters
        ----------
        vertices : (n, 3) float64

        Raises
        ------
        MeshError
            No facets, or one refers to a vertex that the file does not have; the message names its line.
        """
        if not self._facets:
            raise MeshError(
                f"the {arg(self._kind)} text holds no facets: export the part again, as a surface of triangles."
            )
        corners, sizes = (np.frombuffer(values, np.int64) for values in (self._corners, self._sizes))
        missing = (corners < 0) | (corners >= len(vertices))
        if missing.any():
            polygon = int(np.searchsorted(np.cumsum(sizes), np.argmax(missing), side="right"))
            raise MeshError(
                f"line {arg(self._lines[polygon])} of the {arg(self._kind)} text is a facet that refers to a"
                f" vertex that does not exist (the file has {arg(len(vertices))}): it is damaged or cut"
                " short, export it again."
            )
        return triangulate(vertices, corners, sizes)


def triangulate(vertices: Floats, corners: Longs, sizes: Longs) -> Triangulated:
    """
    Cover polygons with triangles.

    A polygon that its first corner sees all of becomes a fan about it, one of four corners along its shorter
    diagonal; another is triangulated in the plane of its Newell normal. A hole is part of the outline, which goes
    to it and back by the same way. Every side of a polygon is a side of one of its triangles, so that what was
    closed stays closed.

    Parameters
    ----------
    vertices : (n, 3) float64
    corners : (k,) int64
        Vertex indices of one polygon after another. Where one is out of range all become fans: it is for the
        caller to refuse.
    sizes : (p,) int64
        Corners of each polygon.

    Returns
    -------
    Triangulated

    Raises
    ------
    MeshError
        Too many facets, or polygons that are not convex with too many corners.
    """
    number = np.arange(len(sizes))
    if np.any(sizes > 3):
        corners, sizes = _without_repeats(corners, sizes)
    few = sizes < 3
    notes: tuple[str, ...] = ()
    if few.any():
        notes = (
            message(
                f"Polygons of fewer than three corners were left out (polygons: {arg(np.count_nonzero(few))})."
            ),
        )
        corners, sizes, number = corners[~np.repeat(few, sizes)], sizes[~few], number[~few]
    refuse_too_many(int(sizes.sum()) - 2 * len(sizes))
    if not np.any(sizes > 3):
        return Triangulated(corners.reshape(-1, 3), number, notes)
    there = corners.min() >= 0 and corners.max() < len(vertices)
    if there:
        corners = _shorter_way(vertices, corners, sizes)
    starts, firsts = _begins(sizes), _begins(sizes - 2)
    owner = np.repeat(np.arange(len(sizes)), sizes - 2)
    second = np.arange(len(owner)) - firsts[owner] + starts[owner] + 1
    faces = np.column_stack((corners[starts[owner]], corners[second], corners[second + 1]))
    if there:
        # Coordinates that overflow here are refused, with their row, by whoever takes them.
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            notes += _mend(vertices, corners, starts, sizes, faces, firsts)
    return Triangulated(faces, number[owner], notes)


def strip_triangles(corners: Longs, strip: Longs) -> Longs:
    """
    Give the triangles of strips, in which every other one is turned over.

    Parameters
    ----------
    corners : (k,) int64
        Vertex indices of one strip after another.
    strip : (k,) int64
        Ascending number of the strip of each.

    Returns
    -------
    (m, 3) int64
    """
    place = np.arange(len(corners))
    begin = np.maximum.accumulate(np.where(np.diff(strip, prepend=-1) != 0, place, 0))
    first = np.flatnonzero(strip[2:] == strip[:-2])
    triangles = np.column_stack((corners[first], corners[first + 1], corners[first + 2]))
    odd = (first - begin[first]) % 2 == 1
    triangles[odd] = triangles[odd][:, [1, 0, 2]]
    return triangles


def _begins(counts: Longs) -> Longs:
    ends: Longs = np.cumsum(counts)
    return ends - counts


def _without_repeats(corners: Longs, sizes: Longs) -> tuple[Longs, Longs]:
    """Take a corner once that a polygon of more than three names twice in a row: a triangle written as a quad."""
    before = np.arange(len(corners)) - 1
    held = sizes > 0
    starts = _begins(sizes)[held]
    before[starts] = starts + sizes[held] - 1
    owner = np.repeat(np.arange(len(sizes)), sizes)
    repeated = (corners == corners[before]) & (sizes[owner] > 3)
    if not repeated.any():
        return corners, sizes
    return corners[~repeated], sizes - np.bincount(owner[repeated], minlength=len(sizes))


def _shorter_way(vertices: Floats, corners: Longs, sizes: Longs) -> Longs:
    """Begin polygons of four corners where their shorter diagonal does: it tells more of a surface that is bent."""
    at = _begins(sizes)[sizes == 4][:, None] + np.arange(4)
    quads = corners[at]
    with np.errstate(over="ignore", invalid="ignore"):
        one, two = (np.sum((vertices[quads[:, k]] - vertices[quads[:, k + 2]]) ** 2, axis=1) for k in (0, 1))
    turned = two < (1 - _PRECISION) * one
    corners = corners.copy()
    corners[at[turned]] = np.roll(quads[turned], -1, axis=1)
    return corners


def _mend(
    vertices: Floats, corners: Longs, starts: Longs, sizes: Longs, faces: Longs, firsts: Longs
) -> tuple[str, ...]:
    """Replace the fans, in place, that do not cover their polygon; say which polygons nothing can cover."""
    polygons = np.flatnonzero(sizes > 3)
    ends = np.cumsum(sizes[polygons] - 2)
    blocks = np.searchsorted(ends, np.arange(_BLOCK, int(ends[-1]), _BLOCK))
    crossing, rest, normals = 0, [], []
    for block in np.split(polygons, np.unique(blocks)):
        if len(block):
            folded, newell, twisted = _judge(vertices, faces, firsts[block], sizes[block] - 2)
            crossing += twisted
            rest.append(block[folded])
            normals.append(newell[folded])
    chosen = np.concatenate(rest)
    newell = np.concatenate(normals)
    crossing += _cut(vertices, corners, starts[chosen], sizes[chosen], newell, faces, firsts[chosen])
    if not crossing:
        return ()
    return (message(f"Polygons cross themselves, so their triangles overlap (polygons: {arg(crossing)})."),)


def _judge(vertices: Floats, faces: Longs, firsts: Longs, counts: Longs) -> tuple[Mask, Floats, int]:
    """
    Tell which fans are folded over but have a plane, twice the area vectors of all, and how many are twisted.

    Each fan is given by its first triangle and its number of triangles.
    """
    begins = _begins(counts)
    owner = np.repeat(np.arange(len(counts)), counts)
    fans = faces[np.arange(len(owner)) - begins[owner] + firsts[owner]]
    apex = vertices[fans[:, 0]]
    one, two = vertices[fans[:, 1]] - apex, vertices[fans[:, 2]] - apex
    cross = np.cross(one, two)
    # Half of it is the area that the polygon surrounds, whichever way it is cut.
    newell = np.add.reduceat(cross, begins, axis=0)
    length = np.linalg.norm(newell, axis=1)
    normal = (newell / length[:, None])[owner]
    side = np.einsum("ij,ij->i", cross, normal)
    along = np.einsum("ij,ij->i", one, two)
    along -= np.einsum("ij,ij->i", one, normal) * np.einsum("ij,ij->i", two, normal)
    longest = np.maximum(np.einsum("ij,ij->i", one, one), np.einsum("ij,ij->i", two, two))
    turned = np.add.reduceat(np.arctan2(side, along), begins)
    covered = np.logical_and.reduceat(side > _FLAT * longest, begins) & (turned < 2 * np.pi)
    twice = np.add.reduceat(np.linalg.norm(cross, axis=1), begins)
    within = np.maximum.reduceat(longest, begins)
    # A bow tie surrounds nothing, and has no plane: its fan stays.
    plane = np.isfinite(length) & (length > _FLAT * within)
    twisted = int(np.count_nonzero(~plane & (twice > _FLAT * within)))
    return plane & ~covered, newell, twisted


def _cut(
    vertices: Floats, corners: Longs, starts: Longs, sizes: Longs, newell: Floats, faces: Longs, firsts: Longs
) -> int:
    """Triangulate polygons that are not convex, each in its plane, in place; count those that cross themselves."""
    if not len(sizes):
        return 0
    if float(np.sum(sizes.astype(float) ** 2)) > _MOST_WORK:
        raise MeshError(
            f"the non-convex polygons have {arg(int(sizes.sum()))} corners, too many to triangulate"
            " here: export the part again with triangles only."
        )
    # Imported for the few files that need it: most hold triangles.
    from manifold3d import triangulate as cut_polygon

    twice_area = np.linalg.norm(newell, axis=1)
    normal = newell / twice_area[:, None]
    helper = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    u = np.cross(helper, normal)
    u /= np.linalg.norm(u, axis=1)[:, None]
    owner, begins = np.repeat(np.arange(len(sizes)), sizes), _begins(sizes)
    outline = corners[np.arange(len(owner)) - begins[owner] + starts[owner]]
    moved = vertices[outline] - vertices[corners[starts]][owner]
    axes = np.stack((u, np.cross(normal, u)), axis=1)
    flat = np.einsum("ijk,ik->ij", axes[owner], moved)
    tolerance = _PRECISION * np.maximum.reduceat(np.abs(flat).max(axis=1), begins)
    triangles, ends = np.zeros((int(sizes.sum()) - 2 * len(sizes), 3), dtype=np.int64), _begins(sizes - 2)
    for begin, end, size, reach in zip(*(x.tolist() for x in (begins, ends, sizes, tolerance)), strict=True):
        cut = cut_polygon([flat[begin : begin + size]], reach)
        if len(cut) != size - 2:
            raise MeshError("a polygon cannot be triangulated: export the part again with triangles only.")
        triangles[end : end + size - 2] = cut
        triangles[end : end + size - 2] += begin
    a, b, c = (flat[triangles[:, k]].T for k in range(3))
    doubled = np.abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    own = np.repeat(np.arange(len(sizes)), sizes - 2)
    faces[np.arange(len(own)) - ends[own] + firsts[own]] = outline[triangles]
    return int(np.count_nonzero(np.add.reduceat(doubled, ends) > (1 + _OVERLAP) * twice_area))
