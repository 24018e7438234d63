"""The closed outside of a soup of facets, made of its own facets where they are, and of new ones only across holes.

The outer hull of a soup of facets: those that border the outside, to the digit.

The facets cut space into cells. Where facets meet at an edge, the side of one and the side of the next round the edge
border the same cell; sides that hang together like that border one cell, and the cell is the outside when light
reaches it. A facet with the outside on one side only is part of the hull, whichever way it was turned; inner walls,
repeats and enclosed parts are not, and neither is a sheet with the outside on both its sides.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, Unpack

import numpy as np
import scipy

from contactbench.pipeline.errors import MeshError
from contactbench.pipeline.kernel import SurfaceIndex, crossings
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Soup, Surface
from contactbench.pipeline.mesh.engines import Control
from contactbench.pipeline.mesh.polygons import triangulate
from contactbench.pipeline.mesh.probe import connected, edge_table, label_parts
from contactbench.pipeline.mesh.shell.rim import Opening, choose, describe, make_patch, resample
from contactbench.pipeline.mesh.shell.tidy import (
    ROUNDING,
    Cut,
    cut_crossings,
    distinct,
    holes,
    open_edges,
    sew,
)
from contactbench.pipeline.mesh.shell.wrap import wrap_round
from contactbench.pipeline.mesh.soundness import TOUCHING
from contactbench.pipeline.mesh.triangles import (
    cross_products,
    directions,
    first_alike,
    join,
    only_used,
    six_volumes,
)

# Vertices of open edges nearer than this, as a share of the size, belong together: 0.01 mm on a probe.
SEAM = 1e-4
SINGLE = 1e-7  # of the size: what numbers in single precision are rounded by
_FLAT = 0.01  # of the width: a hole with such a rim needs no vertices inside
_SEAMS = 0.7  # of the open edges: sewing that joins fewer nibbles at the rims of holes
_FILLINGS = 4
_RIM = 1000  # points of a rim that is compared with another
_SCRAP = 1e-4  # of the area
_FRAYED = 0.005  # open edges a facet that are left: so many are no fins, but a surface in rags
_SHEETS = 0.01  # of the hull's area: with more that has the outside on both sides the surface is not closed


@dataclass(frozen=True, eq=False)
class Outside:
    """
    A closed surface, and what was done for it.

    Attributes
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
        Outward; each edge belongs to two facets.
    born : (m,) int64
        The facet of the soup that each is, or is a piece of; -1 for a new one across a hole.
    turned, cut, inner, sheets : int
        Facets of the soup that were turned over, cut, left out because they do not border the outside, and left out
        because they border it on both sides.
    holes : tuple of Opening
        Holes that were closed and are wide enough to be named, largest first.
    small_holes : int
        Those that are not.
    parted : int
        Vertices that were doubled, because bodies only met in them.
    bodies : int
        How many closed bodies were united; 0 where facets were cut one by one, or none was.
    """

    vertices: Floats
    faces: Ints
    born: Longs
    turned: int
    cut: int
    inner: int
    sheets: int
    holes: tuple[Opening, ...] = ()
    small_holes: int = 0
    parted: int = 0
    bodies: int = 0


@dataclass(frozen=True, eq=False)
class Sewn:
    """
    A soup of facets whose seams are sewn and whose holes are closed, as far as they go.

    Attributes
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
    born : (m,) int64
        The facet given that each is, or is a piece of; -1 for one that closes a hole.
    given : int
        How many facets there were.
    holes, small_holes
        See `Outside`.
    bodies : int
        How many closed bodies were united; 0 where facets were cut one by one.
    pieces : (given,) int64
        Into how many each facet given was cut; 0 before it was.
    sheets : (k,) int64
        The facets given that were left out because they border the outside on both sides.
    frayed : bool
        So many edges are open that some of it is in rags.
    """

    vertices: Floats
    faces: Ints
    born: Longs
    given: int
    holes: tuple[Opening, ...]
    small_holes: int
    bodies: int
    pieces: Longs
    sheets: Longs
    frayed: bool

    def cut(self, **control: Unpack[Control]) -> Sewn:
        """
        Unite it where it is closed bodies, else cut its facets where they meet others.

        Raises
        ------
        EngineError, Cancelled
            See `contactbench.pipeline.mesh.engines.child.run`.
        """
        soup = self.vertices, self.faces
        cut = unite(*soup, **control) or cut_crossings(*soup, **control)
        born = self.born[cut.born]
        pieces = np.maximum(np.bincount(born[born >= 0], minlength=self.given), self.pieces)
        made = replace(self, vertices=cut.vertices, faces=cut.faces, born=born)
        return replace(made, bodies=cut.bodies, pieces=pieces)

    def with_added(self, added: Sequence[Surface]) -> Sewn:
        """Add surfaces (vertices, faces) that close it; what of them is not needed is cut off later."""
        vertices, faces, born = _with((self.vertices, self.faces, self.born), added)
        return replace(self, vertices=vertices, faces=faces, born=born)

    def rewrapped(self, alpha: float, **control: Unpack[Control]) -> Sewn | None:
        """Wrap what is torn, at a size in metres, and leave out its facets; None where nothing or much is torn."""
        rims = open_edges(self.faces, len(self.vertices))
        made = None
        if len(rims):
            made = wrap_round(self.vertices, self.faces, self.born < 0, rims, alpha, **control)
        if made is None:
            return None
        wrap, deep = made
        return replace(self, faces=self.faces[~deep], born=self.born[~deep]).with_added([wrap])


def on_grid(vertices: Floats, share: float) -> Floats:
    """Round vertices (n, 3) by up to a share of the size."""
    grid = 2.0 ** np.ceil(np.log2(share * float(np.ptp(vertices, axis=0).max())))
    return np.asarray(np.rint(vertices / grid) * grid)


def sew_up(vertices: Floats, faces: Ints, *, smallest: float, spacing: float) -> Sewn:
    """
    Sew the seams of a soup of facets, and close its holes.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres.
    faces : (m, 3) int32
    smallest : float
        Width from which a hole is named, and closed as a mouth is; metres.
    spacing : float
        Of the vertices of what closes such a hole, metres.

    Returns
    -------
    Sewn
    """
    size = float(np.ptp(vertices[faces.ravel()], axis=0).max())
    soup = _sewn(distinct(vertices, faces, np.arange(len(faces))), SEAM * size)
    soup = _trimmed(_without_dust(soup))
    soup = sew(*_with(soup, _strips(*soup[:2], smallest, spacing)), ROUNDING * size)
    left = len(open_edges(soup[1], len(soup[0])))
    named: list[Opening] = []
    small = 0
    for _ in range(_FILLINGS):  # what closes a hole may leave a smaller one where the rim meets itself
        patches, found = _patches(*soup[:2], smallest, spacing)
        if not patches:
            break
        filled = sew(*_with(soup, patches), ROUNDING * size)
        open_yet = len(open_edges(filled[1], len(filled[0])))
        if open_yet >= left:
            break
        soup, left = filled, open_yet
        named += found
        small += len(patches) - len(found)
    named.sort(key=lambda opening: -opening.area)
    none = np.empty(0, dtype=np.int64)
    frayed = left > _FRAYED * len(soup[1])
    return Sewn(*soup, len(faces), tuple(named), small, 0, np.zeros(len(faces), dtype=np.int64), none, frayed)


def find_outside(cut: Sewn) -> tuple[Outside, Sewn] | None:
    """
    Find the closed outside of facets that were cut where they meet others.

    Returns
    -------
    Outside and Sewn, or None
        Also the facets of the outside alone, to which more can be added: what is inside stays inside. None where the
        facets do not enclose a space.
    """
    hull = outer_hull(cut.vertices, cut.faces)
    if len(hull.faces) == 0:
        return None
    hull = _without_specks(hull)
    areas = np.linalg.norm(cross_products(cut.vertices, cut.faces), axis=1)
    of = cut.born
    thin = hull.sheets[of[hull.sheets] >= 0]
    if areas[thin].sum() > _SHEETS * areas[hull.born].sum():
        return None
    if len(open_edges(hull.faces, len(hull.vertices))):
        return None
    origin = of[hull.born]
    kept = np.unique(origin[origin >= 0])
    sheets = np.union1d(of[thin], cut.sheets)
    filled = bool((origin < 0).any())  # what closes a hole of a part inside another is inside, too
    own = np.unique(hull.born)
    rest = replace(cut, faces=cut.faces[own], born=of[own], sheets=sheets)
    return Outside(
        hull.vertices,
        hull.faces,
        origin,
        turned=len(np.unique(origin[hull.turned & (origin >= 0)])),
        cut=int(np.count_nonzero(cut.pieces[kept] > 1)),
        inner=cut.given - len(np.union1d(kept, sheets)),
        sheets=len(sheets),
        holes=cut.holes if filled else (),
        small_holes=cut.small_holes if filled else 0,
        parted=int(np.count_nonzero(first_alike(hull.vertices) != np.arange(len(hull.vertices)))),
        bodies=cut.bodies,
    ), rest


def _without_specks(hull: Hull) -> Hull:
    """Leave out bodies that are next to nothing: cells between facets that cross each other in slivers."""
    area = np.linalg.norm(cross_products(hull.vertices, hull.faces), axis=1)
    label = label_parts(hull.faces, len(hull.vertices))
    kept = (np.bincount(label, area) >= _SCRAP * area.sum())[label]
    vertices, faces = only_used(hull.vertices, hull.faces[kept])
    return Hull(vertices, faces, hull.born[kept], hull.turned[kept], hull.sheets)


def _edges(faces: Ints) -> tuple[Longs, Longs]:
    """Give a number for the edges of each facet, and how many facets have them, (m, 3)."""
    start, end = faces.astype(np.int64), np.roll(faces, -1, axis=1).astype(np.int64)
    key = np.minimum(start, end) * (int(faces.max()) + 1) + np.maximum(start, end)
    _, number, count = np.unique(key, return_inverse=True, return_counts=True)
    return number.reshape(-1, 3), np.asarray(count[number].reshape(-1, 3))


def _with(soup: Soup, added: Sequence[Surface]) -> Soup:
    """Add surfaces that no facet of the file is in."""
    points, triangles = join([soup[:2], *added])
    return distinct(points, triangles, np.concatenate((soup[2], np.full(len(triangles) - len(soup[2]), -1))))


def _without_dust(soup: Soup) -> Soup:
    """Leave out tiny open scraps: where they lie on a surface they cross it without end."""
    vertices, faces, born = soup
    label = label_parts(faces, len(vertices))
    area = np.linalg.norm(cross_products(vertices, faces), axis=1)
    torn = np.bincount(label, (_edges(faces)[1] == 1).any(axis=1)) > 0
    scraps = (torn & (np.bincount(label, area) < _SCRAP * area.sum()))[label]
    if area[scraps].sum() > _FRAYED * area.sum():
        return soup
    return distinct(vertices, faces[~scraps], born[~scraps])


def _trimmed(soup: Soup) -> Soup:
    """Leave out facets that hang on an edge of two others, and lone ones: they are no part of a surface."""
    vertices, faces, born = soup
    for _ in range(_FILLINGS):
        _, uses = _edges(faces)
        hanging = (uses == 1).any(axis=1) & ((uses > 2).any(axis=1) | (uses == 1).all(axis=1))
        if not hanging.any() or hanging.sum() > _FRAYED * len(faces):
            break
        faces, born = faces[~hanging], born[~hanging]
    return distinct(vertices, faces, born)


def _sewn(soup: Soup, tolerance: float) -> Soup:
    """Sew as wide as helps: where facets are smaller than the seams it makes more open edges than it joins."""
    best, fewest = soup, len(open_edges(soup[1], len(soup[0])))
    for share in (1e-4, 1e-2, 1.0):
        tried = sew(*best, share * tolerance)
        left = len(open_edges(tried[1], len(tried[0])))
        if left < _SEAMS * fewest and len(tried[1]) <= len(soup[1]) + fewest:
            best, fewest = tried, left
    return best


def _strips(vertices: Floats, faces: Ints, smallest: float, reach: float) -> list[Surface]:
    """Join wide rims that run beside each other, where two parts of a housing meet: their lids would cross."""
    loops = [vertices[loop] for loop in holes(faces, len(vertices))]
    loops = [rim for rim in loops if np.ptp(rim, axis=0).max() >= smallest]
    dense = [resample(rim, _RIM) for rim in loops]
    trees = [scipy.spatial.cKDTree(rim) for rim in dense]
    strips: list[Surface] = []
    free = set(range(len(loops)))
    for one, other in combinations(range(len(loops)), 2):
        gaps = np.hstack((trees[one].query(dense[other])[0], trees[other].query(dense[one])[0]))
        if {one, other} <= free and (gaps < reach).all():
            free -= {one, other}
            strips.append(_strip(loops[one], loops[other]))
    return strips


def _strip(one: Floats, other: Floats) -> Surface:
    """Join two closed lines, (n, 3) and (k, 3), by facets across the shorter diagonals."""
    other = np.roll(other, -int(np.argmin(np.linalg.norm(other - one[0], axis=1))), axis=0)
    quarter, ahead, back = resample(one, 4)[1], *resample(other, 4)[[1, 3]]
    if np.linalg.norm(quarter - back) < np.linalg.norm(quarter - ahead):
        other = np.roll(other[::-1], 1, axis=0)
    n, k = len(one), len(other)
    i = j = 0
    faces = []
    while i < n or j < k:
        along_one = np.linalg.norm(one[(i + 1) % n] - other[j % k])
        along_other = np.linalg.norm(other[(j + 1) % k] - one[i % n])
        here, there = i % n, n + j % k
        if j == k or (i < n and along_one < along_other):
            i += 1
            faces.append((here, i % n, there))
        else:
            j += 1
            faces.append((here, n + j % k, there))
    return np.vstack((one, other)), np.array(faces, dtype=np.int32)


def _patches(
    vertices: Floats, faces: Ints, smallest: float, spacing: float
) -> tuple[list[Surface], list[Opening]]:
    """Close every hole: the wide ones as mouths, which are given too, the others by the fewest facets."""
    patches: list[Surface] = []
    named: list[Opening] = []
    middle = vertices.mean(axis=0)
    for loop in holes(faces, len(vertices)):
        rim = vertices[loop]
        if np.ptp(rim, axis=0).max() >= smallest:
            opening = describe(rim, middle[None])
            if opening.width >= smallest:
                named.append(opening)
                flat = np.ptp(opening.to_plane(rim)[:, 2]) < _FLAT * opening.width
                if not flat and (made := _patch(opening, spacing)) is not None:
                    patches.append(made)
                    continue
        few = triangulate(rim, np.arange(len(loop)), np.array([len(loop)]))
        patches.append((rim, few.faces.astype(np.int32)))
    return patches, named


def _patch(opening: Opening, spacing: float) -> Surface | None:
    """Make a patch; None where the rim crosses itself seen from outside, or the patch does not follow it."""
    try:
        vertices, faces = make_patch(opening, choose(opening), spacing)
    except MeshError:
        return None
    count = len(opening.rim)
    rim = np.column_stack((np.arange(count), np.roll(np.arange(count), -1)))
    edges = edge_table(faces, len(vertices))
    have = np.isin(edges.low * len(vertices) + edges.high, rim.min(axis=1) * len(vertices) + rim.max(axis=1))
    return (vertices, faces) if np.count_nonzero(have) == count else None


# ---- closed bodies that cross, as CAD assemblies have them: their union, by manifold3d -----------


_MOST_BODIES = 2000


def unite(vertices: Floats, faces: Ints, **control: Unpack[Control]) -> Cut | None:
    """
    Unite bodies that cross each other: what lies inside another one is gone, and the rest is cut where they meet.

    Cutting facet by facet (`cut_crossings`) needs no bodies, but rounds what it cuts, and many slanted cuts near each
    other cross again without end. A union of bodies cannot (Manifold, E. Lalish, by symbolic perturbation).

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
        With area, none twice.
    **control
        See `contactbench.pipeline.mesh.engines.child.run`.

    Returns
    -------
    Cut or None
        None where the facets are no closed bodies, or meet nowhere. A body that crosses itself or is not wound one way
        is cut by itself before.
    """
    import manifold3d

    if (edge_table(faces, len(vertices)).uses % 2).any():
        return None
    part = _bodies(faces)
    count = int(part.max()) + 1
    if not 2 <= count <= _MOST_BODIES:
        return None
    pairs, kinds, _, complete = crossings(vertices, faces)
    met = part[pairs]
    if not complete or len(met) == 0:
        return None
    inverted = six_volumes(vertices, faces, part)[part] < 0
    outward = faces.copy()
    outward[inverted] = outward[inverted][:, ::-1]
    crossed = met[(kinds != TOUCHING) & (met[:, 0] == met[:, 1]), 0]
    solids: list[Any] = []
    for number in range(count):
        own = np.flatnonzero(part == number)
        body = vertices, outward[own], own
        solid = None if number in crossed else _solid(*body)
        solids.append(solid or _solid(*_uncrossed(*body, **control)))
    if not all(solids):
        return None
    made = manifold3d.Manifold.batch_boolean(solids, manifold3d.OpType.Add).to_mesh64()
    points = np.array(made.vert_properties, dtype=np.float64)[:, :3]
    triangles = made.tri_verts.astype(np.int32)
    born = np.array(made.face_id, dtype=np.int64)
    # As they were: whoever keeps them turns them over, and says so.
    back = inverted[born]
    triangles[back] = triangles[back][:, ::-1]
    # It rounds, too: where bodies lie on each other, needles are left.
    cut = cut_crossings(points, triangles, **control)
    return replace(cut, born=born[cut.born], bodies=count) if cut.left == 0 else None


def _bodies(faces: Ints) -> Longs:
    """Label the facets that hang together over edges of two, however wound, (m,): bodies may meet in others."""
    number, uses = (each.ravel() for each in _edges(faces))
    two = np.flatnonzero(uses == 2)
    beside = two[np.argsort(number[two], kind="stable")].reshape(-1, 2) // 3
    label = connected(len(faces), *beside.T)
    # Where a body has one facet of an edge only, it goes on with another such facet.
    more = np.flatnonzero(uses > 2)
    ends, times = np.unique(np.column_stack((number[more], label[more // 3])), axis=0, return_counts=True)
    ends = ends[times % 2 == 1]
    here = np.flatnonzero(ends[1:, 0] == ends[:-1, 0])
    joined = connected(int(label.max()) + 1, ends[here, 1], ends[here + 1, 1])
    return np.asarray(joined[label])


def _uncrossed(vertices: Floats, faces: Ints, born: Longs, **control: Unpack[Control]) -> Soup:
    """Give the outside of a body that crosses itself, meets itself in an edge or is not wound one way."""
    cut = cut_crossings(vertices, faces, **control)
    hull = outer_hull(cut.vertices, cut.faces)
    return hull.vertices, hull.faces, born[cut.born[hull.born]]


def _solid(vertices: Floats, faces: Ints, born: Longs) -> Any:
    """Make a solid of a body; None where it is no closed 2-manifold that is wound one way."""
    import manifold3d

    used, corner = np.unique(faces, return_inverse=True)
    solid = manifold3d.Manifold(
        manifold3d.Mesh64(
            vert_properties=vertices[used],
            tri_verts=corner.reshape(-1, 3).astype(np.uint64),
            face_id=born.astype(np.uint64),  # facets of one number may be merged where they are level
            run_index=np.array([0, 3 * len(born)], dtype=np.uint64),
            run_original_id=np.array([1], dtype=np.uint32),
        )
    )
    return solid if solid.status() == manifold3d.Error.NoError and not solid.is_empty() else None


# ---- the outer hull of a soup of facets: those that border the outside, to the digit -------------


_GLANCES, _RAYS = 24, 128  # facets looked at a cell, and rays from each
_LIFT = 1e-6  # of the size: rays start so far in front of their facet
_HALVINGS = 4
_SLIPPED = 3  # rays that may find a way between two facets by rounding


@dataclass(frozen=True, eq=False)
class Hull:
    """
    The facets that border the outside.

    Attributes
    ----------
    vertices : (n, 3) float64
        Those of the soup; one that several sheets of the hull meet in occurs once for each.
    faces : (m, 3) int32
        Outward. Each edge belongs to two facets where the soup has no hole.
    born : (m,) int64
        The facet of the soup that each is.
    turned : (m,) bool
        Turned over against it.
    sheets : (k,) int64
        Facets of the soup with the outside on both sides.
    """

    vertices: Floats
    faces: Ints
    born: Longs
    turned: Mask
    sheets: Longs


def outer_hull(vertices: Floats, faces: Ints) -> Hull:
    """
    Find the facets that border the outside.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
        Any orientation. No facet may cross another or touch it but at shared vertices and edges; facets have area,
        and no two have the same corners.

    Returns
    -------
    Hull
    """
    m = len(faces)
    ring = _Rings(vertices, faces)
    # Round an edge, the side of a facet that looks ahead borders the same cell as the next one's that looks back.
    ahead = np.where(ring.forward, 0, m) + ring.facet
    back = np.where(ring.forward, m, 0) + ring.facet
    cell = connected(2 * m, ahead, back[ring.next])
    outside = _lit(vertices, faces, cell)[cell].reshape(2, m)
    kept = np.flatnonzero(outside[0] != outside[1])
    turned = outside[1][kept]
    hull = faces[kept]
    hull[turned] = hull[turned][:, ::-1]
    sheets = np.flatnonzero(outside[0] & outside[1])
    if len(hull) == 0:
        return Hull(vertices[:0], hull, kept, turned, sheets)
    points, triangles, of = apart(vertices, hull)
    return Hull(points, triangles, kept[of], turned[of], sheets)


def apart(vertices: Floats, faces: Ints) -> Soup:
    """
    Give sheets that only meet along an edge or in a vertex vertices of their own, so that the surface is 2-manifold.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
        Consistently oriented.

    Returns
    -------
    vertices : (k, 3) float64
        Every corner stays where it is; vertices that no facet uses are left out.
    faces : (l, 3) int32
        The same facets; some are halved, where sheets meet in an edge whose ends they share anyway.
    of : (l,) int64
        The facet that each is, or is a half of.
    """
    of = np.arange(len(faces))
    for _ in range(_HALVINGS):
        vertices, faces, pairs = _unshared(vertices, faces)
        uses = edge_table(faces, len(vertices)).uses
        if uses.max() <= 2:
            break
        vertices, faces, half = _halved(vertices, faces, pairs)
        of = of[half]
    return vertices, faces, of


def _halved(vertices: Floats, faces: Ints, pairs: tuple[Longs, Longs]) -> Soup:
    """Halve pairs of facets at an edge that others share, each pair at a vertex of its own; one edge a facet."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    crowded = _edges(faces)[1].ravel() > 2
    whole = np.ones(len(faces), dtype=bool)
    new: list[Floats] = []
    halves: list[tuple[int, int, int]] = []
    of: list[int] = []
    for one, other in zip(*pairs, strict=True):
        if crowded[one] and whole[one // 3] and whole[other // 3]:
            middle = len(vertices) + len(new)
            new.append((vertices[start[one]] + vertices[end[one]]) / 2)
            for half in (one, other):
                facet = half // 3
                whole[facet] = False
                third = int(start[_end(_end(half))])
                halves += [(int(start[half]), middle, third), (middle, int(end[half]), third)]
                of += [facet, facet]
    kept = np.flatnonzero(whole)
    return (
        np.concatenate((vertices, np.array(new).reshape(-1, 3))),
        np.concatenate((faces[whole], np.array(halves, dtype=np.int32).reshape(-1, 3))),
        np.concatenate((kept, np.array(of, dtype=np.int64))),
    )


def _unshared(vertices: Floats, faces: Ints) -> tuple[Floats, Ints, tuple[Longs, Longs]]:
    """Give each sheet vertices of its own; gives the pairs of half-edges that hang together, too."""
    m = len(faces)
    ring = _Rings(vertices, faces)
    # Sheets are paired across their inner side, which a facet whose half-edge runs backwards has ahead of it.
    one, other = ring.inner_pairs()
    ends, starts = _end(one), _end(other)
    corner = connected(3 * m, np.concatenate((one, ends)), np.concatenate((starts, other)))
    # Corners of one vertex that nothing joins are different vertices now; the order of the old ones is kept.
    old = faces.ravel().astype(np.int64)
    _, first, number = np.unique(corner, return_index=True, return_inverse=True)
    order = np.argsort(old[first], kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    points = vertices[old[first][order]]
    return points, rank[number.reshape(-1)].reshape(-1, 3).astype(np.int32), (one, other)


class _Rings:
    """
    The half-edges of facets in cyclic order round each edge, by rising angle seen along it from low to high vertex.

    Attributes
    ----------
    half, facet : (3 m,) int64
        Half-edge ``3 f + k`` runs from corner k of facet f to the next.
    forward : (3 m,) bool
        It runs from the lower vertex number to the higher; then the facet's front looks ahead, to greater angles.
    next : (3 m,) int64
        The position of the next half-edge round the same edge; its own where it is alone.
    rings : (e, 2) int64
        Where each edge's half-edges begin, and how many there are.
    """

    def __init__(self, vertices: Floats, faces: Ints) -> None:
        start = faces.ravel().astype(np.int64)
        end = np.roll(faces, -1, axis=1).ravel().astype(np.int64)
        low, high = np.minimum(start, end), np.maximum(start, end)
        key = low * len(vertices) + high
        order = np.argsort(key, kind="stable")
        first = np.flatnonzero(np.diff(key[order], prepend=-1))
        uses = np.diff(first, append=len(order))
        crowded = np.repeat(uses > 2, uses)
        if crowded.any():
            half = order[crowded]
            angle = _angles(vertices, low[half], high[half], faces.ravel()[_end(_end(half))])
            # Facets that lie on each other, as far as rounding can tell, are ordered so that a thin wedge is solid.
            order[crowded] = half[np.lexsort(((start == low)[half], angle, key[half]))]
        self.half = order
        self.facet = order // 3
        self.forward = (start == low)[order]
        self.next = np.arange(len(order)) + 1
        self.next[first + uses - 1] = first
        self.rings = np.column_stack((first, uses))

    def inner_pairs(self) -> tuple[Longs, Longs]:
        """Half-edges that bound one solid wedge: one that runs backwards, and the next that runs forward, (k,) each."""
        after = np.where(~self.forward & self.forward[self.next], self.next, -1)
        done = after >= 0
        done[after[done]] = True
        # Facets that lie on each other within rounding may be in the wrong order: pair them like brackets.
        for first, uses in self.rings[~np.logical_and.reduceat(done, self.rings[:, 0])].tolist():
            opened: list[int] = []
            after[first : first + uses] = -1
            for place in 2 * [*range(first, first + uses)]:
                if not self.forward[place]:
                    opened.append(place)
                elif opened:
                    last = opened.pop()
                    if after[last] < 0 and place not in after[first : first + uses]:
                        after[last] = place
        here = np.flatnonzero(after >= 0)
        return self.half[here], self.half[after[here]]


def _angles(vertices: Floats, low: Longs, high: Longs, opposite: Ints) -> Floats:
    """Directions of facets about their edges, radians from a direction that is the same for all facets of an edge."""
    axis = vertices[high] - vertices[low]
    axis /= np.maximum(np.linalg.norm(axis, axis=1, keepdims=True), np.finfo(float).tiny)
    reach = vertices[opposite] - vertices[low]
    u = np.eye(3)[np.argmin(np.abs(axis), axis=1)]
    u = u - np.einsum("ij,ij->i", u, axis)[:, None] * axis
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    v = np.cross(axis, u)
    return np.asarray(np.arctan2(np.einsum("ij,ij->i", reach, v), np.einsum("ij,ij->i", reach, u)))


def _lit(vertices: Floats, faces: Ints, cell: Longs) -> Mask:
    """Tell which cells light reaches from far away, (cells,)."""
    m, count = len(faces), int(cell.max()) + 1
    cross = cross_products(vertices, faces)
    twice = np.linalg.norm(cross, axis=1)
    size = float(np.ptp(vertices[faces.ravel()], axis=0).max())
    # The largest facets of each cell, and others taken at even steps through those that are left.
    area = np.concatenate((twice, twice))
    order = np.lexsort((-area, cell))
    first = np.flatnonzero(np.diff(cell[order], prepend=-1))
    members = np.diff(first, append=len(order))
    looks = np.minimum(members, _GLANCES)
    place = np.arange(int(looks.sum())) - np.repeat(np.cumsum(looks) - looks, looks)
    many, number = np.repeat(members, looks), np.repeat(looks, looks)
    half = number // 2
    spread = half + (place - half) * (many - half) // np.maximum(number - half, 1)
    pick = order[np.repeat(first, looks) + np.where(place < half, place, spread)]
    facet, sign = pick % m, np.where(pick < m, 1.0, -1.0)
    normal = sign[:, None] * cross[facet] / np.maximum(twice[facet], np.finfo(float).tiny)[:, None]
    origins = vertices[faces[facet]].mean(axis=1) + _LIFT * size * normal
    index = SurfaceIndex(vertices, faces)
    free = np.zeros(count, dtype=np.int64)
    for direction in directions(_RAYS):
        front = np.flatnonzero(normal @ direction > 0.05)
        escaped = index.escapes(origins[front], np.tile(direction, (len(front), 1)))
        np.add.at(free, cell[pick[front[escaped]]], 1)
    return free > np.minimum(_SLIPPED, np.bincount(cell[pick], minlength=count))


def _end(half: Longs) -> Longs:
    """Give the half-edge that follows in the same facet: it starts where this one ends."""
    return half - half % 3 + (half + 1) % 3
