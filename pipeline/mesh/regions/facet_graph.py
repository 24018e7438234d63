"""A mesh as regions see it: which facets are neighbours, how they lie, and how far it is along the surface."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import arg
from contactbench.pipeline.kernel import Geodesic, SurfaceIndex
from contactbench.pipeline.mesh.arrays import Floats, Ints, Longs, Mask, Surface
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.regions.region import RegionError


class FacetGraph:
    """
    Neighbours, normals, areas and distances of a mesh's facets.

    Facets are neighbours when they share an edge, also one of more than two facets. Building takes about
    0.1 s for 300,000 facets; what only some edits need is worked out when it is first asked for.

    Parameters
    ----------
    probe : Probe
        Its vertices and faces count, not its regions.
    """

    def __init__(self, probe: Probe) -> None:
        self.probe = probe
        self.geodesic = Geodesic(probe.vertices, probe.faces)
        self._first, self._second = self.geodesic.neighbours()

    @property
    def facet_count(self) -> int:
        """How many facets there are."""
        return len(self.probe.faces)

    @property
    def neighbours(self) -> tuple[Ints, Ints]:
        """Facets across the edges of facet f: ``second[first[f]:first[f + 1]]``; (m + 1,) and (k,)."""
        return self._first, self._second

    @cached_property
    def pairs(self) -> Longs:
        """Neighbours, each pair once, the lower facet first; (k, 2)."""
        one = np.repeat(np.arange(self.facet_count), np.diff(self._first))
        once = one < self._second
        return np.column_stack((one[once], self._second[once]))

    @cached_property
    def creases(self) -> Floats:
        """Angle between the normals of each pair, rad, (k,): 0 where the surface is flat."""
        # The half-angle form keeps its digits at 0 and at pi, where the cosine alone loses half of them.
        one, other = (self.probe.normals[self.pairs[:, side]] for side in (0, 1))
        half = np.arctan2(np.linalg.norm(one - other, axis=1), np.linalg.norm(one + other, axis=1))
        return 2 * np.asarray(half, dtype=np.float64)

    @cached_property
    def index(self) -> SurfaceIndex:
        """Where the nearest point of the surface is."""
        return SurfaceIndex(self.probe.vertices, self.probe.faces)

    def pick(self, points: npt.ArrayLike, within: float | None = None) -> tuple[Ints, Floats]:
        """
        Find the points of the surface that are nearest to given ones.

        Parameters
        ----------
        points : (k, 3) array_like
            S, m.
        within : float, optional
            Refuse points that are further from the surface, m.

        Returns
        -------
        faces : (k,) int32
        points : (k, 3) float64
            On these facets.

        Raises
        ------
        RegionError
            A point is further away than `within`.
        """
        rows = np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 3)
        distances, faces, nearest = self.index.closest(rows)
        if within is not None and not (distances <= within).all():
            far = int(np.argmin(distances <= within))
            place = ", ".join(f"{1e3 * value:g}" for value in rows[far])
            raise RegionError(
                f"the point {arg(place)} mm is {arg(1e3 * distances[far]):.3g} mm from the surface, more"
                f" than {arg(1e3 * within):.3g} mm: give a point on the surface, in mm and in the"
                " probe's frame."
            )
        return faces, nearest

    def check_face(self, face: int) -> int:
        """Return the facet number; RegionError if the mesh has no such facet."""
        if not 0 <= face < self.facet_count:
            raise RegionError(
                f"facet {arg(face)} does not exist: they run from 0 to {arg(self.facet_count - 1)}."
            )
        return int(face)


# ---- facets cut along a line, so that what is chosen ends where it was drawn ---------------------


# No slivers.
_SNAP = 0.05


@dataclass(frozen=True, eq=False)
class MeshEdit:
    """
    What makes one mesh of another that has the same beginning, such as one whose facets were cut.

    Attributes
    ----------
    vertices : int
        How many vertices of the old mesh stay; the rest go.
    points : (k, 3) float64
        Vertices that come behind them, m.
    facets : int
        How many of its facets stay, but for the slots.
    slots : (s,) int32
        Facets among them that are others now, ascending.
    faces : (s + a, 3) int32
        These, and facets that come behind all.
    invented : (s + a,) bool
        Whether each was made up.
    """

    vertices: int
    points: Floats
    facets: int
    slots: Ints
    faces: Ints
    invented: Mask

    @classmethod
    def between(cls, old: Probe, new: Probe) -> MeshEdit | None:
        """Compare two meshes; None: they are the same."""
        if np.array_equal(old.faces, new.faces) and np.array_equal(old.vertices, new.vertices):
            return None
        vertices = _alike(old.vertices, new.vertices).argmin()
        facets = min(len(old.faces), len(new.faces))
        slots = np.flatnonzero(~_alike(old.faces, new.faces)[:facets]).astype(np.int32)
        made = np.concatenate((slots, np.arange(facets, len(new.faces), dtype=np.int32)))
        return cls(int(vertices), new.vertices[vertices:], facets, slots, new.faces[made], new.invented[made])

    @property
    def count(self) -> int:
        """Facets of the new mesh."""
        return self.facets + len(self.faces) - len(self.slots)

    def resized(self, labels: Ints) -> Ints:
        """Return labels (m,) of the old mesh for as many facets as the new one has, 0 behind them."""
        return np.append(labels[: self.facets], np.zeros(self.count - self.facets, dtype=np.int32))

    def put_on(self, probe: Probe) -> Probe:
        """
        Return the new mesh, given the old one; it has no regions.

        Raises
        ------
        RegionError
            It is not made for this mesh.
        """
        here, count = len(self.slots), len(probe.faces)
        fits = (
            0 <= self.vertices <= len(probe.vertices)
            and 0 <= self.facets <= count
            and here <= len(self.faces)
        )
        if fits and self.slots.min(initial=0) >= 0 and self.slots.max(initial=0) < max(self.facets, 1):
            vertices = np.concatenate((probe.vertices[: self.vertices], self.points))
            faces = np.concatenate((probe.faces[: self.facets], self.faces[here:]))
            invented = np.concatenate((probe.invented[: self.facets], self.invented[here:]))
            faces[self.slots], invented[self.slots] = self.faces[:here], self.invented[:here]
            if len(faces) and faces.min() >= 0 and faces.max() < len(vertices):
                none = np.zeros(len(faces), dtype=np.int32)
                return replace(probe, vertices=vertices, faces=faces, invented=invented, region=none)
        raise RegionError("the facets were cut on another mesh: paint the regions again.")

    def to_json(self) -> dict[str, Any]:
        """Give plain values."""
        return {name: np.asarray(value).tolist() for name, value in vars(self).items()}

    @classmethod
    def from_json(cls, entry: Mapping[str, Any]) -> MeshEdit:
        """Read what `to_json` gave; RegionError for anything else."""
        try:
            points, faces = (np.reshape(entry[name], (-1, 3)) for name in ("points", "faces"))
            slots, invented = (np.asarray(entry[name]) for name in ("slots", "invented"))
            whole = all(each.dtype.kind == "i" or not each.size for each in (faces, slots))
            if whole and slots.ndim == 1 and invented.shape == faces.shape[:1] and np.isfinite(points).all():
                numbers = int(entry["vertices"]), int(entry["facets"])
                parts = faces.astype(np.int32), invented.astype(bool)
                return cls(numbers[0], points.astype(np.float64), numbers[1], slots.astype(np.int32), *parts)
        except (ValueError, TypeError, KeyError, OverflowError) as error:
            raise RegionError(f"the cut facets cannot be read ({arg(error)}): export them again.") from error
        raise RegionError("the cut facets cannot be read: export them again.")


def _alike(old: Floats | Ints, new: Floats | Ints) -> Mask:
    """Whether each row, as far as both have it, is the same; False behind the last."""
    both = min(len(old), len(new))
    return np.append((old[:both] == new[:both]).all(axis=1), False)


def split_edges(mesh: Surface, ends: Longs, points: Floats) -> tuple[Surface, Longs]:
    """
    Split edges in all facets that share them, so no gap opens.

    Parameters
    ----------
    mesh : Surface
    ends : (k, 2) integers
        The edges, each once.
    points : (k, 3) float64
        Where on each.

    Returns
    -------
    mesh : Surface
        Vertices keep their numbers, and so do facets that stay whole; the parts of others take their places, and
        come behind all.
    origin : (m,) int64
        The facet that each is, or is a part of.
    """
    vertices, faces = mesh
    count = len(vertices)
    keys = np.sort(ends, axis=1).astype(np.int64) @ (count, 1)
    order = np.argsort(keys)
    touched = np.zeros(count, dtype=bool)
    touched[ends] = True
    rows = np.flatnonzero(touched[faces].sum(axis=1) > 1)
    sought = sides_of(faces[rows]) @ (count, 1)
    place = np.minimum(np.searchsorted(keys[order], sought), max(len(keys) - 1, 0))
    found = keys[order][place] == sought
    parts, origin = _split(faces[rows], np.where(found, count + order[place], -1))
    origin = rows[origin]
    slots, first = np.unique(origin, return_index=True)
    behind = np.setdiff1d(np.arange(len(parts)), first)
    whole = np.concatenate((faces, parts[behind]), dtype=np.int32, casting="same_kind")
    whole[slots] = parts[first]
    return (np.concatenate((vertices, points)), whole), np.concatenate(
        (np.arange(len(faces)), origin[behind])
    )


def _split(faces: Ints, middle: Longs) -> tuple[Longs, Longs]:
    """
    Split facets at points (m, 3) of their edges 01, 12 and 20; -1: that edge stays whole.

    Returns
    -------
    (k, 3) facets, and (k,) the facet that each is a part of.
    """
    cut = middle >= 0
    count = cut.sum(axis=1)
    # Turn each facet so that its cut edges come first; of two, the whole one is last.
    first = np.where(count == 2, np.argmin(cut, axis=1) + 1, np.argmax(cut, axis=1))
    turned = (first[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(faces.astype(np.int64), turned, axis=1).T
    p, q, r = np.take_along_axis(middle, turned, axis=1).T
    parts = {
        0: [(a, b, c)],
        1: [(a, p, c), (p, b, c)],
        2: [(p, b, q), (a, p, q), (a, q, c)],
        3: [(a, p, r), (p, b, q), (r, q, c), (p, q, r)],
    }
    made, parents = [], []
    for cuts, pieces in parts.items():
        rows = np.flatnonzero(count == cuts)
        for piece in pieces:
            made.append(np.column_stack([corner[rows] for corner in piece]))
            parents.append(rows)
    return np.concatenate(made), np.concatenate(parents)


def sides_of(faces: Ints) -> Longs:
    """Return edges 01, 12 and 20 of each facet, the lower vertex first; (m, 3, 2)."""
    return np.sort(np.stack((faces, np.roll(faces, -1, axis=1)), axis=2).astype(np.int64), axis=2)


def edges_of(faces: Ints) -> Longs:
    """Return the edges of facets, each once, the lower vertex first; (e, 2)."""
    ends = sides_of(faces).reshape(-1, 2)
    count = int(ends.max(initial=0)) + 1
    return np.column_stack(np.divmod(np.unique(ends @ (count, 1)), count))


def halve_long(
    mesh: Surface, chosen: Longs, longest: Callable[[Floats], Floats | float]
) -> tuple[Surface, Longs] | None:
    """Halve the edges of chosen facets that are longer than they may be where their middles are, m; None: none is."""
    vertices, faces = mesh
    ends = edges_of(faces[chosen])
    if not len(ends):
        return None
    lengths, middle = (
        np.linalg.norm(np.diff(vertices[ends], axis=1)[:, 0], axis=1),
        vertices[ends].mean(axis=1),
    )
    long = lengths > longest(middle)
    return split_edges(mesh, ends[long], middle[long]) if long.any() else None


def cut_between(
    mesh: Surface, side: Ints, away: Floats, rows: Longs, snap: float = _SNAP
) -> tuple[Surface, Longs, Ints]:
    """
    Cut the facets along the line between vertices of different sides.

    Parameters
    ----------
    mesh : Surface
    side : (n,) int32
        Of which side of the line each vertex is.
    away : (n,) float64
        How far it is from the line.
    rows : (k,) int64
        The facets that the line may cross.
    snap : float
        Nearer than this share of an edge to a corner, the line runs through the corner.

    Returns
    -------
    mesh, origin
        See `split_edges`.
    side : (m,) int32
        Of each facet; -1 where all of its corners are on the line.
    """
    vertices, faces = mesh
    ends = edges_of(faces[rows])
    ends = ends[side[ends[:, 0]] != side[ends[:, 1]]]
    along = away[ends[:, 0]] / np.maximum(away[ends].sum(axis=1), 1e-300)
    on = np.zeros(len(vertices), dtype=bool)
    on[ends[along < snap, 0]] = on[ends[along > 1 - snap, 1]] = True
    apart = ~on[ends].any(axis=1)
    ends, along = ends[apart], along[apart, None]
    points = (1 - along) * vertices[ends[:, 0]] + along * vertices[ends[:, 1]]
    cut, origin = split_edges(mesh, ends, points)
    sides = np.concatenate((np.where(on, -1, side), np.full(len(points), -1)))
    return cut, origin, sides[cut[1]].max(axis=1).astype(np.int32)
