"""
Whether a mesh can be trusted as a probe, checked as if a stranger had made it.

Every mesh that leaves the preparation goes through `check_soundness`, whatever the program that made it says about it.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.kernel import SurfaceIndex, crossings
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Surface
from contactbench.pipeline.mesh.probe import (
    MeshHealth,
    connected,
    degenerate_facets,
    label_parts,
    measure_health,
)
from contactbench.pipeline.mesh.triangles import cross_products

_Pairs = tuple[Longs, Longs]

CROSSING, TOUCHING, OVERLAP = range(3)

# More than this away from every original normal nearby, and a facet stands across the surface or is turned over.
STEEPEST_DEG = 60.0

# Original facets count as near within this share of the mesh's size, or within so many times the distance
# by which the facet missed the original anyway.
_NEAR, _NEAR_MISS = 1e-3, 3.0

# The same for facets that are steep, but not turned over.
_WIDE = 1e-2

# Between normals that differ by nearly 180 degrees, less than this, rounding decides what is between them.
_OPPOSITE_DEG = 1.0

# A facet this close to the normal of its nearest original facet is not looked at further.
_ALIGNED_DEG = 20.0

# Facets this much thinner than their neighbour that fold back onto it are no blade's edge but slivers turned over.
_FOLD_DEG, _THIN, _CRACK = 170.0, 0.1, 0.01
SPECKS = 5e-5  # of the area: what folds and is no more can be left

# Towards the corners of a tetrahedron, turned so that no edge of a CAD model runs along one.
_DIRECTIONS = np.array(
    [[0.573, 0.681, 0.456], [-0.816, -0.153, 0.557], [0.476, -0.827, -0.300], [-0.233, 0.299, -0.925]]
)

_SHELL = message("Make the outer shell before use.")


@dataclass(frozen=True, eq=False)
class Soundness:
    """
    What is right and wrong about a finished mesh.

    Attributes
    ----------
    health : MeshHealth
        Openings, edges of more than two facets, winding, parts, repeated facets.
    volume_m3 : float
        Enclosed, signed; of an open mesh as seen from the middle of its bounding box.
    inward_parts : int
        Closed parts that face inwards and lie in no other part.
    nested_parts : int
        Parts inside another one.
    nested_facets : (k,) int64
        Their facets, ascending.
    pinched_vertices : (k,) int64
        Vertices at which the surface meets itself in one point: more than one fan of facets.
    flat_facets : (k,) int64
        Facets without area.
    pairs : (k, 2) int32
        Facets that meet beyond the vertices and edges that they share, decided exactly.
    kinds : (k,) uint8
        Of each pair: CROSSING, TOUCHING (without any inside meeting an inside), or OVERLAP (sharing an area).
    crossing, touching, overlapping : int
        How many pairs there are of each kind, unlisted ones included.
    every_pair_checked : bool
        False where crossings were too many to look at all pairs.
    normal_deviation_deg : (m,) float64
        Angle between each facet and the original's surface nearby: the smallest one to the normals of facets within
        max(0.1 % of the size, 3 x its own distance to the original), and to what lies between two of those, as where
        an edge is rounded off or cut. What is below 20 is an upper bound. NaN where there is no original to
        compare with.
    folded_facets : (k,) int64
        Facets over the limit of the normal deviation, and slivers that fold back onto a neighbour, also where the
        original has them.
    folded_share : float
        Of the area. As little as a few slivers of a cut have is no fault: it is less than any contact is known by.
    """

    health: MeshHealth
    volume_m3: float
    inward_parts: int
    nested_parts: int
    nested_facets: Longs
    pinched_vertices: Longs
    flat_facets: Longs
    pairs: Ints
    kinds: npt.NDArray[np.uint8]
    crossing: int
    touching: int
    overlapping: int
    every_pair_checked: bool
    normal_deviation_deg: Floats
    folded_facets: Longs
    folded_share: float

    @property
    def sound(self) -> bool:
        """Whether the mesh is closed, 2-manifold and outward, and crosses and folds nowhere."""
        return not self.faults

    @property
    def largest_deviation_deg(self) -> float | None:
        """Of the normals of all facets that were compared with an original."""
        compared = self.normal_deviation_deg[np.isfinite(self.normal_deviation_deg)]
        return float(compared.max()) if len(compared) else None

    def facets_of(self, *kinds: int) -> Longs:
        """Facets in the listed pairs of some kinds (CROSSING, TOUCHING, OVERLAP), ascending."""
        return np.unique(self.pairs[np.isin(self.kinds, kinds)]).astype(np.int64)

    @property
    def faults(self) -> tuple[str, ...]:
        """What makes the mesh unfit, and what to do, a sentence or two per defect; empty when it is sound."""
        return tuple(self._faults())

    def _faults(self) -> Iterator[str]:
        # Several parts are no fault by themselves, as long as none is inside another.
        yield from replace(self.health, components=1, dropped_facets=0).sentences
        if self.crossing:
            yield message(
                f"Facets cut through each other (pairs: {arg(self.crossing):,}). Inside and outside are"
                f" mixed up there, so a contact can land on an inner wall. {arg(_SHELL)}"
            )
        if self.overlapping > self.health.duplicate_facets:
            yield message(
                f"Facets lie on top of each other (pairs: {arg(self.overlapping):,}), so a force meets"
                f" two surfaces at once. {arg(_SHELL)}"
            )
        if not self.every_pair_checked:
            yield message(f"The facets are too entangled to check every pair. {arg(_SHELL)}")
        if len(self.pinched_vertices):
            yield message(
                "The surface meets itself in single points (vertices:"
                f" {arg(len(self.pinched_vertices)):,}). Separate the bodies that touch there in the CAD"
                f" program, or join them. {arg(_SHELL)}"
            )
        if self.nested_parts:
            yield message(
                f"Closed parts lie inside the body (parts: {arg(self.nested_parts):,}). They cannot be"
                f" touched, but a line of force can hit them. {arg(_SHELL)}"
            )
        if self.inward_parts and self.health.outward is not False:
            yield message(
                f"Separate parts are inside out (parts: {arg(self.inward_parts):,}). Contacts on them"
                " are found on the far side. Flip their normals in the CAD program."
            )
        if self.folded_share > SPECKS:
            yield self._folds()
        if len(self.flat_facets):
            yield message(
                f"Facets have no area (facets: {arg(len(self.flat_facets)):,}) and so no normal. Remove"
                " them in the CAD program and close the seams they leave."
            )

    @property
    def sentences(self) -> tuple[str, ...]:
        """The faults, and then what is worth knowing of a sound mesh."""
        return tuple(self._sentences())

    def _sentences(self) -> Iterator[str]:
        yield from self.faults
        if self.touching:
            yield message(
                f"Facets touch without sharing a vertex or edge (pairs: {arg(self.touching):,}): two"
                " walls meet there. No action needed if the bodies are meant to touch."
            )
        if 0 < self.folded_share <= SPECKS:
            yield message(
                f"Slivers fold back onto their neighbours (facets: {arg(len(self.folded_facets)):,}). No action"
                " needed: together they are too small to be touched."
            )

    def _folds(self) -> str:
        count = f"{len(self.folded_facets):,}"
        remedy = message(
            "Contacts there are missed or found on the far side. Keep more facets, or repair the mesh there."
        )
        largest = self.normal_deviation_deg[self.folded_facets]
        if (largest > STEEPEST_DEG).any():  # else slivers, some of them as the original has them
            return message(
                f"Facets are turned against the original surface (facets: {arg(count)}, by up to"
                f" {arg(np.nanmax(largest)):.0f}°). {arg(remedy)}"
            )
        return message(f"Thin facets fold back onto their neighbours (facets: {arg(count)}). {arg(remedy)}")

    def to_json(self) -> dict[str, Any]:
        """Give the figures as plain values, without the lists of facets."""
        largest = self.largest_deviation_deg
        return {
            "sound": self.sound,
            "closed": self.health.watertight,
            "nonmanifold_edges": self.health.nonmanifold_edges,
            "pinched_vertices": len(self.pinched_vertices),
            "winding_consistent": self.health.winding_consistent,
            "outward": self.health.outward,
            "parts": self.health.components,
            "inward_parts": self.inward_parts,
            "nested_parts": self.nested_parts,
            "crossing_pairs": self.crossing,
            "overlapping_pairs": self.overlapping,
            "touching_pairs": self.touching,
            "every_pair_checked": self.every_pair_checked,
            "folded_facets": len(self.folded_facets),
            "facets_without_area": len(self.flat_facets),
            "largest_normal_deviation_deg": None if largest is None else round(largest, 2),
            "volume_cm3": round(1e6 * self.volume_m3, 6),
            "sentences": list(self.sentences),
        }


def check_soundness(
    vertices: Floats,
    faces: Ints,
    original: Surface | None = None,
    *,
    invented: Mask | None = None,
    steepest_deg: float = STEEPEST_DEG,
) -> Soundness:
    """
    Check a mesh for everything that a probe must not have.

    Parameters
    ----------
    vertices : (n, 3) float64
        Finite, metres, any frame.
    faces : (m, 3) int32
        At least one facet, indices in range.
    original : tuple of (n', 3) float64 and (m', 3) int32, optional
        The surface that the mesh was made from, in the same frame. Unless it is consistently wound and all its parts
        face outwards, its normals count in both directions.
    invented : (m,) bool, optional
        Facets that close openings: the original says nothing about their normals.
    steepest_deg : float
        Largest normal deviation that is not a fold.

    Returns
    -------
    Soundness
        In O(m log m); about 6 s for a million facets compared with a million.
    """
    vertices, faces = (
        np.ascontiguousarray(vertices, dtype=np.float64),
        np.ascontiguousarray(faces, dtype=np.int32),
    )
    health = measure_health(vertices, faces)
    low, high = vertices[faces].min(axis=(0, 1)), vertices[faces].max(axis=(0, 1))
    # Centred and to unit size: no cancellation far from the origin, no underflow for tiny meshes.
    middle, size = (low + high) / 2, float((high - low).max()) or 1.0
    unit = (vertices - middle) / size
    doubled = cross_products(unit, faces)
    volumes = np.einsum("ij,ij->i", unit[faces[:, 0]], doubled) / 6
    inward, nested_parts, nested = 0, 0, np.zeros(len(faces), dtype=np.bool_)
    if health.watertight and health.winding_consistent:
        label, inside, inverted = _parts_inside(unit, faces, doubled)
        inward, nested_parts, nested = int(inverted.sum()), int(inside.sum()), inside[label]
    pairs, kinds, counts, complete = crossings(vertices, faces)
    deviation = np.full(len(faces), np.nan)
    flat = degenerate_facets(vertices, faces)
    ours = ~flat if invented is None else ~(flat | np.asarray(invented, dtype=np.bool_))
    if original is not None:
        there = (
            np.ascontiguousarray(original[0], dtype=np.float64),
            np.ascontiguousarray(original[1], dtype=np.int32),
        )
        scaled = ((there[0] - middle) / size, there[1])
        state = measure_health(*there)
        signed = state.outward is True
        if signed and state.components > 1:  # one of them may be inside out, and the whole outward
            signed = not _parts_inside(*scaled, cross_products(*scaled))[2].any()
        deviation[ours] = _normal_deviation(unit, faces[ours], doubled[ours], scaled, signed, steepest_deg)
    edges = _half_edges(faces)
    slivers = _turned_slivers(unit, faces, doubled, edges)
    slivers &= ~flat
    folded = slivers | (np.nan_to_num(deviation) > steepest_deg)
    areas = np.linalg.norm(doubled, axis=1)
    return Soundness(
        health=health,
        volume_m3=float(volumes.sum()) * size**3,
        inward_parts=inward,
        nested_parts=nested_parts,
        nested_facets=np.flatnonzero(nested),
        pinched_vertices=_pinched(faces, edges),
        flat_facets=np.flatnonzero(flat),
        pairs=pairs,
        kinds=kinds,
        crossing=int(counts[CROSSING]),
        touching=int(counts[TOUCHING]),
        overlapping=int(counts[OVERLAP]),
        every_pair_checked=complete,
        normal_deviation_deg=deviation,
        folded_facets=np.flatnonzero(folded),
        folded_share=float(areas[folded].sum() / (areas.sum() or 1.0)),
    )


def _unit(vectors: Floats) -> Floats:
    length = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    unit: Floats = vectors / np.where(length > 0, length, 1.0)[:, None]
    return unit


def _half_edges(faces: Ints) -> _Pairs:
    """Pair the half-edges of each edge: (k,) each, of k pairs; three that share an edge make two pairs.

    Half-edge ``3 f + c`` runs from corner c of facet f to the next one.
    """
    start = faces.ravel().astype(np.int64)
    end = np.roll(faces, -1, axis=1).ravel().astype(np.int64)
    key = np.minimum(start, end) * (int(faces.max()) + 1) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    same = np.diff(key[order]) == 0
    return order[:-1][same], order[1:][same]


def _pinched(faces: Ints, edges: _Pairs) -> Longs:
    """Vertices whose facets hang together over edges in more than one fan."""
    first, second = edges
    vertex = faces.ravel()
    after = 3 * (np.arange(3 * len(faces)) // 3) + (np.arange(3 * len(faces)) + 1) % 3
    # The corners at both ends of an edge hang together with those of the facet across.
    along = vertex[first] == vertex[second]
    rows = np.concatenate((first, after[first]))
    columns = np.concatenate((np.where(along, second, after[second]), np.where(along, after[second], second)))
    fan = connected(len(vertex), rows, columns)
    owner = np.empty(fan.max() + 1, dtype=np.int64)
    owner[fan] = vertex
    fans = np.bincount(owner)
    return np.flatnonzero(fans > 1)


def _parts_inside(vertices: Floats, faces: Ints, doubled: Floats) -> tuple[Longs, Mask, Mask]:
    """Give each facet's part, and tell which parts lie inside others, and which of the rest are inside out."""
    label = label_parts(faces, len(vertices))
    volumes = np.einsum("ij,ij->i", vertices[faces[:, 0]], doubled) / 6
    volume = np.bincount(label, volumes).astype(np.float64)
    inside = _nested(vertices, faces, label, volume, doubled)
    return label, inside, (volume <= 0) & ~inside


def _nested(vertices: Floats, faces: Ints, label: Longs, volume: Floats, doubled: Floats) -> Mask:
    """
    Tell for each part of a closed, consistent mesh whether it lies inside another.

    From the farthest point of a part in some direction a ray goes on in that direction. Where it leaves the first part
    that it meets, it was inside that one; where it enters it, both are inside the same others or none. A part that only
    touches or crosses another one is beyond it in some direction.
    """
    count = len(volume)
    inside = np.full(count, count > 1)
    if count == 1:
        return inside
    used = np.unique(faces)
    part = np.empty(len(vertices), dtype=np.int64)
    part[faces] = label[:, None]
    index = SurfaceIndex(vertices, faces)
    for direction in _DIRECTIONS:
        reach = vertices @ direction
        order = used[np.argsort(reach[used], kind="stable")]
        farthest = np.empty(count, dtype=np.int64)
        farthest[part[order]] = order
        _, hit = index.first_hit(np.ascontiguousarray(vertices[farthest]), np.tile(direction, (count, 1)))
        leaves = (doubled[hit] @ direction > 0) == (volume[label[hit]] > 0)
        seen = np.zeros(count, dtype=np.bool_)
        for each in np.argsort(-reach[farthest], kind="stable"):
            met = label[hit[each]]
            if hit[each] >= 0:
                seen[each] = leaves[each] or seen[met]
        inside &= seen
    return inside


def _normal_deviation(
    vertices: Floats, faces: Ints, doubled: Floats, original: Surface, signed: bool, steepest_deg: float
) -> Floats:
    """Angle in degrees between each facet and the original near it, lengths as shares of the mesh's size."""
    normals = _unit(cross_products(*original))
    own = _unit(doubled)
    corners = vertices[faces]
    index = SurfaceIndex(*original)
    distance, nearest, _ = index.closest(corners.mean(axis=1))
    angle = _angle(np.einsum("ij,ij->i", own, normals[nearest]))

    def look(
        chosen: Longs, points: Floats, distance: Floats, least: Floats | float, sharpest: bool = False
    ) -> None:
        radius = np.maximum(least, _NEAR_MISS * distance)
        for sign in (1.0,) if signed else (1.0, -1.0):
            found = _angle_to_hull(index, normals, points, sign * own[chosen], radius, sharpest)
            angle[chosen] = np.minimum(angle[chosen], found)

    chosen = np.flatnonzero(angle > _ALIGNED_DEG)
    look(chosen, corners[chosen].mean(axis=1), distance[chosen], _NEAR)
    for corner in range(3):
        chosen = np.flatnonzero(angle > steepest_deg)
        points = (corners[chosen].sum(axis=1) + 3 * corners[chosen, corner]) / 6
        look(chosen, points, index.closest(points)[0], _NEAR)
    # What is steep but not turned over may close off a tip or an edge that was cut, whose sides are farther apart.
    chosen = np.flatnonzero((angle > steepest_deg) & (angle <= 90.0))
    sides = corners[chosen] - np.roll(corners[chosen], 1, axis=1)
    longest = np.sqrt(np.einsum("ijk,ijk->ij", sides, sides).max(axis=1, initial=0.0))
    look(chosen, corners[chosen].mean(axis=1), distance[chosen], np.maximum(_WIDE, longest), sharpest=True)
    return angle


def _angle_to_hull(
    index: SurfaceIndex, normals: Floats, points: Floats, directions: Floats, radius: Floats, sharpest: bool
) -> Floats:
    """
    Angle from directions to the normals of facets near points, and to what lies between two of those.

    A surface that rounds an edge off, or cuts it, has the normals between those of the two sides. With `sharpest` only
    what lies between two that are over 90 degrees apart counts.

    Returns
    -------
    (k,) float64
        Degrees.
    """
    enough = float(np.cos(np.radians(_ALIGNED_DEG)))
    cosine, facet = index.best_aligned(points, directions, radius, normals, enough)
    angle = np.full(len(points), 180.0) if sharpest else _angle(cosine)
    rest = np.flatnonzero((cosine < enough) & (facet >= 0))
    points, directions, radius = points[rest], directions[rest], radius[rest]
    first = normals[facet[rest]]
    mirrored = 2 * cosine[rest, None] * directions - first
    second = normals[index.best_aligned(points, mirrored, radius, normals)[1]]
    pole = np.cross(first, second)
    sine = np.linalg.norm(pole, axis=1)
    pole /= np.maximum(sine, 1e-300)[:, None]
    height = np.einsum("ij,ij->i", directions, pole)
    foot = directions - height[:, None] * pole
    # Of normals that are opposite, as on both sides of a sheet, no direction is between.
    blunt = np.einsum("ij,ij->i", first, second) >= 0
    apart = blunt | (sine > np.sin(np.radians(_OPPOSITE_DEG)))
    between = (np.einsum("ij,ij->i", np.cross(first, foot), pole) >= 0) & (
        np.einsum("ij,ij->i", np.cross(foot, second), pole) >= 0
    )
    use = between & apart & (sine > 0) & ~(blunt & sharpest)
    away = np.degrees(np.arcsin(np.minimum(np.abs(height[use]), 1.0)))
    angle[rest[use]] = np.minimum(angle[rest[use]], away)
    return angle


def _angle(cosine: Floats) -> Floats:
    angle: Floats = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    return angle


def _turned_slivers(vertices: Floats, faces: Ints, doubled: Floats, edges: _Pairs) -> Mask:
    """
    Mark facets that fold back onto a neighbour across an edge and are much thinner than it; (m,).

    One that is turned over has a fold on either side, one of them outwards. One that folds inwards only is the end of a
    crack, as where bodies meet at a small angle: part of the shape.
    """
    first, second = edges
    normals = _unit(doubled)
    f, g = first // 3, second // 3
    folded = np.einsum("ij,ij->i", normals[f], normals[g]) < np.cos(np.radians(_FOLD_DEG))
    first, f, g = first[folded], f[folded], g[folded]
    flat = faces.ravel()
    edge = vertices[flat[3 * f + (first + 1) % 3]] - vertices[flat[first]]
    length = np.linalg.norm(edge, axis=1)
    length[length == 0] = 1.0
    height = np.stack([np.linalg.norm(doubled[each], axis=1) / length for each in (f, g)])
    thin = height.min(axis=0) < _THIN * np.minimum(height.max(axis=0), length)
    marked, outwards = np.zeros((2, len(faces)), dtype=np.bool_)
    marked[np.where(height[0] < height[1], f, g)[thin]] = True
    across = vertices[flat[3 * f + (first + 2) % 3]] - vertices[flat[first]]
    out = np.einsum("ij,ij->i", normals[g], across) < _CRACK * height[0]
    outwards[f[out]] = outwards[g[out]] = True
    return marked & outwards
