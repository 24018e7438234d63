"""
What can be seen from outside: hidden walls, double walls, and facets that face the wrong way.

From points spread evenly over the area, rays go out in a fixed fan of directions on both sides of the facet. A
point whose rays all end on the mesh lies inside, whatever the winding says; a point whose back sees more of the
outside than its front is turned over. All shares are of the area, with the error of counting a few thousand
points: about 1 % at worst.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask
from contactbench.pipeline.mesh.probe import EdgeTable, label_parts
from contactbench.pipeline.mesh.shell.exposure import exposure_at

SAMPLES = 8_000
DIRECTIONS = 128

# A part gets this many points however small it is, as long as there are few parts.
_FEWEST = 24
_SEED = 20

# Rays start this share of the size off their facet. A CAD file in float32 is flat to 6e-8 of it.
_LIFT = 1e-6
# Under this share of the sky the outside is seen through a hole or from the bottom of a groove only.
_SHELTERED = 0.05
# A housing's wall, as a share of the size; behind a solid body's skin there is more, or nothing.
_WALL = 0.05
_CHUNK = 400


@dataclass(frozen=True)
class Visibility:
    """
    Shares of the area, 0 to 1, unless said otherwise.

    Attributes
    ----------
    points : int
        Points that rays went out from.
    directions : int
        Rays per point, over the whole sphere.
    hidden_share : float
        No ray from outside reaches either side.
    sheltered_share : float
        Less than a twentieth of the sky is seen from either side: inner walls behind a hole, or grooves.
    turned_share : float
        The back sees clearly more of the outside than the front, and no facet stands back to back with it.
    two_sided_share : float
        Both sides see more than a twentieth of the sky: sheets, or the wall of an open bowl.
    double_wall_share : float
        Of the area that is seen: right behind it, within 5 % of the size, comes the inner side of a wall with
        a closed space behind.
    wall_m : float or None
        Median thickness of those walls, in metres.
    """

    points: int
    directions: int
    hidden_share: float
    sheltered_share: float
    turned_share: float
    two_sided_share: float
    double_wall_share: float
    wall_m: float | None


@dataclass(frozen=True, eq=False)
class _Samples:
    points: Floats
    normals: Floats
    facet: Longs
    part: Longs
    weight: Floats


def look(
    vertices: Floats,
    faces: Ints,
    parts: Parts,
    both_sides: Mask,
    overlaps: Longs,
    *,
    samples: int = SAMPLES,
    tick: Callable[[float], None],
) -> tuple[Visibility, tuple[MeshPart, ...]]:
    """
    Find out what of a mesh can be seen from outside.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres.
    faces : (m, 3) int32
        With an area.
    parts : Parts
        Of the mesh.
    both_sides : (m,) bool
        Facets that stand back to back with another: one of the two faces the right way.
    overlaps : (k, 2) int64
        Pairs of parts that cut through each other, the lower number first: the skin of one behind that of the other is
        no far side of a wall.
    samples : int
        Points, about.
    tick : callable
        Told the share that is done, 0 to 1, after pieces of about 50,000 rays; may raise to stop.

    Returns
    -------
    visibility : Visibility
    parts : tuple of MeshPart
        Those listed, with their shares filled in.
    """
    index = SurfaceIndex(np.ascontiguousarray(vertices), np.ascontiguousarray(faces))
    chosen = _draw(vertices, faces, parts, samples)
    size = float(np.ptp(vertices[faces.ravel()], axis=0).max())
    front, back = (np.empty(len(chosen.points)) for _ in range(2))
    for start in range(0, len(chosen.points), _CHUNK):
        piece = slice(start, start + _CHUNK)
        for side, out in ((1.0, front), (-1.0, back)):
            out[piece] = exposure_at(
                chosen.points[piece], side * chosen.normals[piece], index, _LIFT * size, count=DIRECTIONS
            )
        tick(min(1.0, (start + _CHUNK) / len(chosen.points)))
    thickness = _walls(index, chosen, front, back, size, parts, overlaps)
    hidden = (front == 0) & (back == 0)
    turned = (back > 2 * front + _SHELTERED / 2) & ~both_sides[chosen.facet]
    weight = chosen.weight / chosen.weight.sum()

    def share(which: Mask) -> float:
        return min(1.0, float(weight[which].sum()))  # the sum of all may round to more

    doubled = np.isfinite(thickness)
    visibility = Visibility(
        len(chosen.points),
        DIRECTIONS,
        share(hidden),
        share(~hidden & (np.maximum(front, back) < _SHELTERED)),
        share(turned),
        share(np.minimum(front, back) > _SHELTERED),
        share(doubled) / max(share(~hidden), np.finfo(float).tiny),
        float(np.median(thickness[doubled])) if doubled.any() else None,
    )
    return visibility, _per_part(parts, chosen, hidden, turned)


def _draw(vertices: Floats, faces: Ints, parts: Parts, samples: int) -> _Samples:
    """Points evenly over the area of each part, the same every time."""
    total = np.bincount(parts.label, parts.area, minlength=parts.count)
    fewest = min(_FEWEST, samples // parts.count)
    number = np.maximum(fewest, np.round(samples * total / total.sum())).astype(np.int64)
    order = np.argsort(parts.label, kind="stable")
    reach = np.cumsum(parts.area[order])
    part = np.repeat(np.arange(parts.count), number)
    step = np.arange(len(part)) - np.repeat(np.cumsum(number) - number, number) + 0.5
    begin = np.cumsum(total) - total
    at = begin[part] + step / number[part] * total[part]
    facet = order[np.minimum(np.searchsorted(reach, at), len(order) - 1)]
    random = np.random.default_rng(_SEED)
    u, v = np.sqrt(random.random(len(facet))), random.random(len(facet))
    a, b, c = (vertices[faces[facet, corner]] for corner in range(3))
    cross = np.cross(b - a, c - a)
    normals = cross / np.linalg.norm(cross, axis=1, keepdims=True)
    points = a + (u * (1 - v))[:, None] * (b - a) + (u * v)[:, None] * (c - a)
    return _Samples(points, normals, facet, part, (total / np.maximum(number, 1))[part])


def _walls(
    index: SurfaceIndex,
    chosen: _Samples,
    front: Floats,
    back: Floats,
    size: float,
    parts: Parts,
    overlaps: Longs,
) -> Floats:
    """Thickness of the wall behind each point that sees the sky; infinite where there is no wall."""
    thickness = np.full(len(front), np.inf)
    seen = np.flatnonzero(np.maximum(front, back) >= _SHELTERED)
    if not len(seen):
        return thickness
    inward = np.where((front >= back)[seen, None], -1.0, 1.0) * chosen.normals[seen]
    lift = _LIFT * size
    first, hit = index.first_hit(chosen.points[seen] + lift * inward, inward)
    bodies = np.sort(parts.label[np.column_stack((chosen.facet[seen], hit))], axis=1)
    overlapping = np.isin(bodies @ (parts.count, 1), overlaps @ (parts.count, 1))
    near = np.flatnonzero((first < _WALL * size) & ~overlapping)
    if not len(near):
        return thickness
    beyond = chosen.points[seen[near]] + (first[near] + 2 * lift)[:, None] * inward[near]
    # Behind the far skin of a solid fin lies the outside; behind a housing's wall a space that ends again.
    closed = exposure_at(beyond, inward[near], index, 0.0, count=DIRECTIONS) < _SHELTERED
    thickness[seen[near[closed]]] = first[near[closed]]
    return thickness


def _per_part(parts: Parts, chosen: _Samples, hidden: Mask, turned: Mask) -> tuple[MeshPart, ...]:
    count = np.bincount(chosen.part, minlength=parts.count)
    unseen = np.bincount(chosen.part, hidden, minlength=parts.count)
    wrong = np.bincount(chosen.part, turned, minlength=parts.count)
    return tuple(
        replace(part, hidden_share=float(unseen[i] / count[i]), turned_share=float(wrong[i] / count[i]))
        if count[i]
        else part
        for i, part in enumerate(parts.listed)
    )


# ---- the separate parts of a mesh, each with its area, size, volume and whether it is closed -----


# Screws and letters of an assembly come by the hundred; the rest is counted, not listed.
LISTED = 200


@dataclass(frozen=True)
class MeshPart:
    """
    Facets that hang together over vertices.

    Attributes
    ----------
    facets : int
    area_m2 : float
    extents_m : (3,) tuple of float
        Along the axes.
    closed : bool
        Every edge belongs to exactly two facets.
    volume_m3 : float or None
        Signed, negative where the facets face inwards; None where the part is open or its facets disagree.
    hidden_share : float or None
        Share of the area that no ray from outside reaches; None where no ray was shot at it.
    turned_share : float or None
        Share of the area whose back sees clearly more of the outside than its front.
    """

    facets: int
    area_m2: float
    extents_m: tuple[float, float, float]
    closed: bool
    volume_m3: float | None
    hidden_share: float | None = None
    turned_share: float | None = None


@dataclass(frozen=True, eq=False)
class Parts:
    """
    All parts, numbered from the largest area on.

    Attributes
    ----------
    label : (m,) int64
        The part of each facet.
    area : (m,) float64
        Of each facet, m².
    listed : tuple of MeshPart
        The largest 200.
    count : int
    """

    label: Longs
    area: Floats
    listed: tuple[MeshPart, ...]
    count: int


def find_parts(vertices: Floats, faces: Ints, edges: EdgeTable) -> Parts:
    """
    Take a mesh apart.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres.
    faces : (m, 3) int32
        Indices in range.
    edges : EdgeTable
        Of the mesh.
    """
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    # About the middle: no cancellation far from the origin.
    centred = vertices - (vertices[used].min(axis=0) + vertices[used].max(axis=0)) / 2
    a, b, c = (centred[faces[:, corner]] for corner in range(3))
    cross = np.cross(b - a, c - a)
    area = np.linalg.norm(cross, axis=1) / 2
    volume = np.einsum("ij,ij->i", a, cross) / 6
    label = label_parts(faces, len(vertices))
    count = int(label.max()) + 1
    total = np.bincount(label, area, minlength=count)
    rank = np.empty(count, dtype=np.int64)
    rank[np.lexsort((np.arange(count), -total))] = np.arange(count)
    label = rank[label]
    part_of_vertex = np.zeros(len(vertices), dtype=np.int64)
    part_of_vertex[faces] = label[:, None]
    closed, sound = np.ones(count, dtype=bool), np.ones(count, dtype=bool)
    closed[part_of_vertex[edges.low[edges.uses != 2]]] = False
    sound[part_of_vertex[edges.low[(edges.uses != 2) | (edges.balance != 0)]]] = False
    facets, total = np.bincount(label, minlength=count), np.bincount(label, area, minlength=count)
    enclosed = np.bincount(label, volume, minlength=count)
    extents = _extents(centred, part_of_vertex, used, min(count, LISTED))
    listed = tuple(
        MeshPart(
            int(facets[i]),
            float(total[i]),
            extents[i],
            bool(closed[i]),
            float(enclosed[i]) if sound[i] else None,
        )
        for i in range(min(count, LISTED))
    )
    return Parts(label, area, listed, count)


def genus_of(vertices: Floats, faces: Ints, edges: EdgeTable, parts: int) -> tuple[int, int | None]:
    """
    Euler number V - E + F of the surface, and its genus: handles, that is holes that go right through.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
        Indices in range.
    edges : EdgeTable
        Of the mesh.
    parts : int
        How many; each adds 2 to the Euler number of a closed surface and takes 2 for each handle.

    Returns
    -------
    euler : int
    genus : int or None
        All parts together; None unless every edge belongs to exactly two facets of opposite direction, and
        where surfaces touch in a vertex.
    """
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    euler = int(used.sum()) - len(edges.low) + len(faces)
    handles, odd = divmod(2 * parts - euler, 2)
    closed = bool(np.all(edges.uses == 2) and np.all(edges.balance == 0))
    return euler, handles if closed and not odd and handles >= 0 else None


def _extents(points: Floats, part: Longs, used: Mask, count: int) -> list[tuple[float, float, float]]:
    chosen = np.flatnonzero(used & (part < count))
    order = chosen[np.argsort(part[chosen], kind="stable")]
    first = np.searchsorted(part[order], np.arange(count))
    spans = np.maximum.reduceat(points[order], first) - np.minimum.reduceat(points[order], first)
    return [(float(x), float(y), float(z)) for x, y, z in spans]
