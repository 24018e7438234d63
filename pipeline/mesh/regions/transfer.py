"""
Carry regions from one mesh of a surface to another: after making a shell, or a new export.

The outline of a region on the old mesh is a line on the new one, whose facets are cut along it.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
import scipy

from contactbench.pipeline.errors import MeshWarning, arg, join, message
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Surface
from contactbench.pipeline.mesh.deviation import doubled_areas
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.regions.facet_graph import MeshEdit, cut_between, halve_long, sides_of
from contactbench.pipeline.mesh.regions.region import RegionError, RegionSet
from contactbench.pipeline.mesh.triangles import cross_products, vertex_normals

# Of the old mesh's size: a surface that was made a shell or simplified stays well within.
_REACH = 0.02

# Of what was painted: more area missed or added than this is a warning.
_MOST_OFF = 0.03
# Places at which areas are compared, per region: they are spread evenly, so they tell 0.2 % of it.
_PLACES = 4000

# Edges across an outline are at most this share of area over outline long, as a brush leaves them; places on it are a
# tenth of that apart, and on an edge of the new mesh if they are nearer than a fiftieth.
_FINE, _APART, _ON = 0.5, 0.1, 0.02
# And at most this part of the outline: its corners are kept.
_CORNERS = 24
_ROUNDS = 24


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
        old, m².
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

    @property
    def warning(self) -> str:
        """What someone should look at: more than 3 % was lost or gained; empty if not."""
        if self.before == 0 or max(self.lost, self.gained) <= _MOST_OFF * self.before:
            return ""
        if self.vanished:
            return message(
                f"the region {arg(self.name)} ({arg(1e6 * self.before):.3g} mm²) vanished: the new mesh is"
                " too coarse there or has lost that part. Keep more facets, or paint it again."
            )
        lost, gained = (1e4 * area for area in (self.lost, self.gained))
        return message(
            f"the region {arg(self.name)} is not what was painted: of {arg(1e4 * self.before):.3g} cm²,"
            f" {arg(lost):.2g} cm² ({arg(100 * self.lost / self.before):.0f} %) are missing, and {arg(gained):.2g} cm²"
            f" ({arg(100 * self.gained / self.before):.0f} %) were added. Keep more facets, or paint it again."
        )

    def after_that(self, later: RegionReport) -> RegionReport:
        """Return what this and a later step did, taken together: at most so much was lost and gained."""
        return replace(
            later, before=self.before, lost=self.lost + later.lost, gained=self.gained + later.gained
        )

    @classmethod
    def from_json(cls, entry: Mapping[str, Any]) -> RegionReport:
        """Read what `to_json` gave; KeyError, TypeError or ValueError for anything else."""
        areas = (float(entry[f"{name}_mm2"]) / 1e6 for name in ("before", "after", "lost", "gained"))
        return cls(str(entry["name"]), *areas)

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
        yield from (part.warning for part in self.report if part.warning)
        if self.unmatched:
            yield message(
                f"{arg(self.unmatched)} of {arg(len(self.regions.labels))} facets have no part of the old"
                " surface near them and belong to no region: check that both meshes are in the"
                " same place."
            )


def transfer(regions: RegionSet, old: Probe, new: Probe, *, reach: float | None = None) -> Transferred:
    """
    Carry regions to another mesh of the same surface, in the same frame.

    Facets of the new mesh are cut along the outlines. Each takes the region of the old surface's point nearest to its
    centroid, among facets that face the same way: a thin wall does not take over what lies on its other side.

    Parameters
    ----------
    regions : RegionSet
        On the old mesh.
    old, new : Probe
        Both in S.
    reach : float, optional
        Facets further than this from the old surface belong to no region, m; 2 % of the old size when left out.

    Returns
    -------
    Transferred
        Its regions are kept for the new mesh.

    Raises
    ------
    RegionError
        Regions of another mesh.

    Warns
    -----
    MeshWarning
        A region is not what it was, or facets have no counterpart.
    """
    if len(regions.labels) != len(old.faces):
        raise RegionError(
            f"the regions are for {arg(len(regions.labels))} facets, but the old mesh has"
            f" {arg(len(old.faces))}: give the mesh that they belong to."
        )
    distance = _REACH * old.size if reach is None else reach
    surface = (old.vertices, old.faces)
    mesh, origin = cut_along(surface, regions.labels, (new.vertices, new.faces), distance)
    labels, unmatched = carry_labels(surface, regions.labels, mesh, reach=distance)
    cut = new.cut(mesh, origin) if len(origin) > len(new.faces) else new
    carried = RegionSet(regions.regions, labels, MeshEdit.between(new, cut))
    report = compare(regions, old, cut.with_region(labels), reach=distance)
    result = Transferred(carried, report, unmatched)
    if result.warnings:
        warnings.warn(join(" ", result.warnings), MeshWarning, stacklevel=2)
    return result


def compare(
    regions: RegionSet, old: Probe, new: Probe, *, reach: float = math.inf
) -> tuple[RegionReport, ...]:
    """
    Tell what became of the area of each region.

    Parameters
    ----------
    regions : RegionSet
        On the old mesh.
    old, new : Probe
        Meshes of one surface; the regions of the new one are its own.
    reach : float
        Places further than this from the other surface are on none of its regions, m.
    """
    meshes = [(probe.vertices, probe.faces) for probe in (old, new)]
    labels, parts = (regions.labels, new.region), []
    for rank, region in enumerate(regions.regions, 1):
        areas, off = [0.0, 0.0], [0.0, 0.0]
        for this, probe in enumerate((old, new)):
            own = np.flatnonzero(labels[this] == rank)
            areas[this] = float(probe.areas[own].sum())
            if len(own):
                at, places = _places(probe, own)
                found = facing(meshes[1 - this], places, probe.normals[at], reach)
                there = np.append(labels[1 - this], 0)[found] == rank
                off[this] = areas[this] * (1 - float(there.mean()))
        parts.append(RegionReport(region.name, *areas, *off))
    return tuple(parts)


def _places(probe: Probe, rows: Longs) -> tuple[Longs, Floats]:
    """Return places (k, 3) spread evenly over facets, and on which each is."""
    ends = np.cumsum(probe.areas[rows])
    number = np.arange(_PLACES) + 0.5
    at = rows[np.searchsorted(ends, number * (ends[-1] / _PLACES)).clip(max=len(rows) - 1)]
    # Roberts' sequence fills a square evenly; what lies beyond its diagonal is folded back.
    u, v = np.outer((0.7548776662466927, 0.5698402909980532), number) % 1
    u, v = np.where(u + v > 1, (1 - u, 1 - v), (u, v))
    a, b, c = np.moveaxis(probe.vertices[probe.faces[at]], 1, 0)
    return at, np.ascontiguousarray(a + u[:, None] * (b - a) + v[:, None] * (c - a))


def cut_along(old: Surface, labels: Ints, new: Surface, reach: float) -> tuple[Surface, Longs]:
    """Cut the facets of a mesh along the outlines of regions on another; see `split_edges` for what is returned."""
    mesh, origin = new, np.arange(len(new[1]))
    places, fine = _outlines(old, labels)
    if not len(places):
        return mesh, origin
    tree = scipy.spatial.cKDTree(places)
    for _ in range(_ROUNDS):
        rows = _crossed(mesh, places, _ON * fine, reach)
        finer = halve_long(mesh, rows, lambda middle: fine[tree.query(middle)[1]])
        if finer is None:
            break
        mesh, origin = finer[0], origin[finer[1]]
    if not len(rows):
        return mesh, origin
    corners, number = np.unique(mesh[1][rows], return_inverse=True)
    # Each facet counts alike: the small ones are where it was cut.
    normals = vertex_normals(
        _normals((mesh[0], mesh[1][rows])), number.reshape(-1, 3).astype(np.int32), len(corners)
    )
    points = np.ascontiguousarray(mesh[0][corners])
    side, away = np.zeros(len(mesh[0]), dtype=np.int32), np.zeros(len(mesh[0]))
    side[corners] = np.append(labels, 0)[facing(old, points, normals, reach)]
    away[corners] = tree.query(points)[0]
    cut, parents, _ = cut_between(mesh, side, away, rows)
    return cut, origin[parents]


def _outlines(mesh: Surface, labels: Ints) -> tuple[Floats, Floats]:
    """Return places (k, 3) on the lines between regions, and how long edges across them may be, m; (k,)."""
    ends, pair = lines_between(mesh, labels)
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    count = int(labels.max(initial=0)) + 1
    around = sum(np.bincount(each, weights=lengths, minlength=count) for each in pair)
    areas = np.bincount(labels, weights=doubled_areas(*mesh) / 2, minlength=count)
    with np.errstate(divide="ignore", invalid="ignore"):
        fine = np.minimum(_FINE * areas / around, around / _CORNERS)
    fine[0] = np.inf
    finest = fine[pair].min(axis=0)
    places, at = places_on(ends, _APART * finest)
    return places, finest[at]


def lines_between(mesh: Surface, labels: Ints) -> tuple[Floats, Ints]:
    """Return edges (k, 2, 3) between facets of different labels, and these labels (2, k)."""
    vertices, faces = mesh
    sides = sides_of(faces).reshape(-1, 2)
    order = np.lexsort(sides.T)
    same = (sides[order[1:]] == sides[order[:-1]]).all(axis=1)
    label = np.repeat(labels, 3)[order]
    between = np.flatnonzero(same & (label[1:] != label[:-1]))
    return vertices[sides[order[between]]], np.stack((label[between], label[between + 1]))


def places_on(ends: Floats, apart: Floats | float) -> tuple[Floats, Longs]:
    """Return places (n, 3) on edges (k, 2, 3), at most so far apart, m, and on which edge each is."""
    steps = ends[:, 1] - ends[:, 0]
    counts = np.ceil(np.linalg.norm(steps, axis=1) / apart).astype(int)
    at = np.repeat(np.arange(len(steps)), counts)
    along = (np.arange(len(at)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5) / counts[at]
    return ends[at, 0] + along[:, None] * steps[at], at


def _crossed(mesh: Surface, places: Floats, on: Floats, reach: float) -> Longs:
    """Return the facets that have places inside, further than so much, m, from their edges."""
    away, at, nearest = SurfaceIndex(*mesh).closest(places)
    corners = mesh[0][mesh[1][at]]
    sides = np.roll(corners, -1, axis=1) - corners
    offs = np.linalg.norm(np.cross(nearest[:, None] - corners, sides), axis=2) / np.linalg.norm(sides, axis=2)
    return np.unique(at[(offs.min(axis=1) > on) & (away <= reach)]).astype(np.int64)


# ---- the label of the nearest surface that faces the same way; arrays in, arrays out -------------


# Normals this far apart (60 degrees) still agree: a coarse facet may cut a rounded edge.
_AGREE = 0.5

# The axes and diagonals of a cube: every direction is within 35 degrees of one of them.
_DIRECTIONS = np.array(
    [d for d in product((-1, 0, 1), repeat=3) if sum(map(abs, d)) in (1, 3)], dtype=np.float64
)
_DIRECTIONS /= np.linalg.norm(_DIRECTIONS, axis=1, keepdims=True)


def carry_labels(old: Surface, labels: Ints, new: Surface, *, reach: float = np.inf) -> tuple[Ints, int]:
    """
    Give every new facet the label of the old surface under its centroid.

    Parameters
    ----------
    old, new : ((n, 3) float64, (m, 3) int32)
        Vertices in one frame and unit, C-contiguous, and facets.
    labels : (m,) int32
        Of the old facets; 0 for none.
    reach : float
        Beyond this distance, in the vertices' unit, a facet gets 0.

    Returns
    -------
    labels : (m,) int32
        Of the new facets.
    unmatched : int
        New facets that got 0 because nothing that faces their way is in reach.
    """
    source = facing(old, new[0][new[1]].mean(axis=1), _normals(new), reach)
    found = source >= 0
    carried = np.where(found, labels[source], 0).astype(np.int32)
    return carried, int(np.count_nonzero(~found))


def facing(old: Surface, points: Floats, normals: Floats, reach: float) -> Longs:
    """Old facet nearest to each point (k, 3) that faces about as its unit normal does; -1 beyond `reach`; (k,)."""
    old_normals = _normals(old)
    distance, face, _ = SurfaceIndex(*old).closest(np.ascontiguousarray(points))
    found = face.astype(np.int64)
    agree = np.einsum("ij,ij->i", old_normals[found], normals) >= _AGREE
    wrong = np.flatnonzero(~agree)
    if len(wrong):
        found[wrong], distance[wrong] = _facing(old, old_normals, points[wrong], normals[wrong])
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


def _normals(mesh: Surface) -> Floats:
    cross = cross_products(*mesh)
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    # A facet without area faces nowhere: it agrees with nothing.
    normals: Floats = np.divide(cross, length, out=np.zeros_like(cross), where=length > 0)
    return normals
