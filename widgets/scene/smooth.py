"""A surface that is shaded as it is meant, round or sharp at its edges, and hatched where facets were made up."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QObject, Signal

from contactbench.widgets.scene.stage import segments, thinned

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe

_LINES = 70  # across the probe's size
_BEFORE = 0.003  # of the probe's size: how far the lines are before the surface
_FEWEST_LINES = 3.0  # lines across a patch that are read as hatching
# The direction in which the lines follow each other, by the axis along which a facet's normal is longest: it is
# never along the normal, so every facet gets its lines.
_ACROSS = np.array([[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]]) / np.sqrt(2.0)
_CROSSED = _ACROSS * [[1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0]]


def narrow_patches(probe: Probe) -> NDArray[np.bool_]:
    """
    Return which facets (m,) were made up in a patch that is too narrow for lines across it to be read as such.

    A seam where a housing was closed, a few lines wide: hatched, it looks like a crack. The width of a patch is twice
    its area over the length of its edge, which is that of a band.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    found = np.zeros(len(probe.faces), dtype=bool)
    rows = np.flatnonzero(probe.invented)
    if not len(rows):
        return found
    faces, count = probe.faces[rows], len(probe.vertices)
    corners = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2).astype(np.int64)
    ones = np.ones(len(corners))
    graph = coo_array((ones, (corners[:, 0], corners[:, 1])), shape=(count, count))
    _, group = connected_components(graph, directed=False)
    of_face = group[faces[:, 0]]
    key = np.sort(corners, axis=1) @ [count, 1]
    _, first, times = np.unique(key, return_index=True, return_counts=True)
    edge = first[times == 1]
    length = np.linalg.norm(probe.vertices[corners[edge, 0]] - probe.vertices[corners[edge, 1]], axis=1)
    around = np.bincount(group[corners[edge, 0]], length, minlength=group.max() + 1)
    area = np.bincount(of_face, probe.areas[rows], minlength=group.max() + 1)
    with np.errstate(divide="ignore", invalid="ignore"):  # groups of no facet
        width = np.where(around > 0, 2.0 * area / around, np.inf)
    found[rows] = width[of_face] < _FEWEST_LINES * probe.size / _LINES
    return found


def hatches(probe: Probe, narrow: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the ends (2 k, 3) of the lines across what was made up, but not across narrow patches (m,)."""
    return _before(probe, np.flatnonzero(probe.invented & ~narrow), _ACROSS)


def _before(
    probe: Probe, faces: NDArray[np.intp] | NDArray[np.int32], directions: NDArray[np.float64]
) -> NDArray[np.float64]:
    """
    Return lines (2 k, 3) a little before facets (c,).

    Not upon them: at the edge of what closes a cavity, those of the far side would come through the thin wall, and look
    like cracks.
    """
    corners = probe.vertices[probe.faces[faces]] + _BEFORE * probe.size * probe.normals[faces][:, None]
    own = np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3)
    return hatch_segments(corners.reshape(-1, 3), own, probe.size / _LINES, directions)


def crosses(probe: Probe, faces: NDArray[np.intp] | NDArray[np.int32]) -> Any:
    """Return crossed lines over the given facets, for VTK."""
    return segments(np.concatenate([_before(probe, faces, across) for across in (_ACROSS, _CROSSED)]))


def hatch_segments(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    spacing: float,
    directions: NDArray[np.float64] = _ACROSS,
) -> NDArray[np.float64]:
    """
    Return where parallel planes cut facets.

    Parameters
    ----------
    vertices : (n, 3)
    faces : (m, 3)
    spacing : float
        Between the planes.
    directions : (3, 3)
        In which the planes follow each other, by the axis along which a facet's normal is longest.

    Returns
    -------
    (2 k, 3)
        Ends of k segments, two by two.
    """
    if len(faces) == 0:
        return np.zeros((0, 3))
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    across = directions[np.argmax(np.abs(normals), axis=1)]
    height = np.einsum("mcj,mj->mc", corners, across) / spacing
    low, high = np.ceil(height.min(axis=1)), np.floor(height.max(axis=1))
    count = np.maximum(high - low + 1, 0).astype(np.int64)
    facet = np.repeat(np.arange(len(faces)), count)
    level = low[facet] + (np.arange(len(facet)) - np.repeat(np.cumsum(count) - count, count))
    ends = []
    for one, other in ((0, 1), (1, 2), (2, 0)):
        a, b = height[facet, one], height[facet, other]
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (level - a) / (b - a)
        share[~((share >= 0.0) & (share < 1.0))] = np.nan
        ends.append(corners[facet, one] + share[:, None] * (corners[facet, other] - corners[facet, one]))
    found = np.stack(ends, axis=1)
    cut = np.isfinite(found[..., 0])
    both = cut.sum(axis=1) == 2
    return np.asarray(found[both][cut[both]].reshape(-1, 3))


CREASE = float(np.cos(np.radians(40.0)))
"""Cosine of the angle between two facets from which on their edge is meant to be one."""
_DRAWN = float(np.cos(np.radians(60.0)))
_SHORT = 0.12  # of the probe's size: a crease with all that joins it that is shorter looks like a crack


@dataclass(frozen=True, eq=False)
class SmoothSurface:
    """The same facets in the same order, with normals at their corners; vertices of sharp edges several times."""

    of: NDArray[np.int64]  # (k,) which vertex of the probe each is; the first n are the vertices
    faces: NDArray[np.int32]  # (m, 3) into these
    normals: NDArray[np.float64]  # (k, 3) of unit length


def crease_edges(
    faces: NDArray[np.int32], normals: NDArray[np.float64], vertices: int
) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """
    Return the edges (k, 2), as numbers of vertices, of one facet, and of two that meet at more than 40 degrees.

    And which of them (k,) are sharp enough to be drawn, 60 degrees: in a fillet of few facets some edges are sharper
    than others by chance, and lines along these alone are ragged.
    """
    corners = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype(np.int64)
    key = corners.min(axis=1) * vertices + corners.max(axis=1)
    order = np.argsort(key)
    key = key[order]
    starts = np.flatnonzero(np.diff(key, prepend=-1))
    counts = np.diff(starts, append=len(key))
    open_ones, pairs = starts[counts == 1], starts[counts == 2]
    one, other = order[pairs] % len(faces), order[pairs + 1] % len(faces)
    bend = np.einsum("ij,ij->i", normals[one], normals[other])
    sharp = np.concatenate([open_ones, pairs[bend < CREASE]])
    drawn = np.concatenate([np.ones(len(open_ones), bool), bend[bend < CREASE] < _DRAWN])
    edges: NDArray[np.int64] = corners[order[sharp]]
    return edges, drawn


def long_creases(edges: NDArray[np.int64], vertices: NDArray[np.float64], size: float) -> NDArray[np.bool_]:
    """
    Return which edges (k, 2) belong to a line that is meant, (k,).

    What is joined to nothing else, and short, is where a surface was closed or made smaller: drawn, it would look like
    a crack.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    if not len(edges):
        return np.zeros(0, dtype=bool)
    used, ends = np.unique(edges, return_inverse=True)
    ends = ends.reshape(-1, 2)
    graph = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(used), len(used)))
    _, group = connected_components(graph, directed=False)
    of_edge = group[ends[:, 0]]
    length = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    whole = np.bincount(of_edge, length)
    return np.asarray(whole[of_edge] > _SHORT * size)


def smoothed(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    normals: NDArray[np.float64],
    edges: NDArray[np.int64],
) -> SmoothSurface:
    """
    Return corners with normals: the mean of the facets around, weighted by their angles (Thürmer and Wüthrich, 1998).

    At a vertex of a sharp edge, only those facets are in a corner's mean that turn less than 40 degrees from its own.

    Parameters
    ----------
    vertices : (n, 3)
    faces : (m, 3)
    normals : (m, 3)
        Of unit length.
    edges : (k, 2)
        Those that are sharp, see `crease_edges`.
    """
    count = len(vertices)
    weights = _angles(vertices[faces])
    at, facet = faces.ravel().astype(np.int64), np.repeat(np.arange(len(faces)), 3)
    scaled = weights.ravel()[:, None] * normals[facet]
    total = np.column_stack([np.bincount(at, scaled[:, k], minlength=count) for k in range(3)])
    sharp = np.zeros(count, dtype=bool)
    sharp[edges.ravel()] = True
    corners = np.flatnonzero(sharp[at])  # each of them gets a normal of its own
    corners = corners[np.argsort(at[corners], kind="stable")]
    own = np.zeros((len(corners), 3))
    if len(corners):
        _, first, many = np.unique(at[corners], return_index=True, return_counts=True)
        # all pairs of corners at the same vertex
        here = np.repeat(np.arange(len(corners)), np.repeat(many, many))
        begins = np.repeat(np.repeat(first, many), np.repeat(many, many))
        steps = np.arange(len(here)) - np.repeat(
            np.cumsum(np.repeat(many, many)) - np.repeat(many, many), np.repeat(many, many)
        )
        there = begins + steps
        alike = np.einsum("ij,ij->i", normals[facet[corners[here]]], normals[facet[corners[there]]]) >= CREASE
        here, there = here[alike], there[alike]
        for k in range(3):
            own[:, k] = np.bincount(here, scaled[corners[there], k], minlength=len(corners))
    new = at.copy()
    new[corners] = count + np.arange(len(corners))
    both = np.concatenate([total, own])
    length = np.linalg.norm(both, axis=1, keepdims=True)
    return SmoothSurface(
        np.concatenate([np.arange(count), at[corners]]),
        new.reshape(-1, 3).astype(np.int32),
        both / np.maximum(length, 1e-300),
    )


def rounded(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return normals (n, 3) of a likeness that is seen for a moment: the mean of the facets around, edges or not."""
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    area = np.repeat(np.cross(b - a, c - a), 3, axis=0)
    at = faces.ravel()
    total = np.column_stack([np.bincount(at, area[:, k], minlength=len(vertices)) for k in range(3)])
    return np.asarray(total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300))


def _angles(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the angle (m, 3) at each corner (m, 3, 3) of a facet, radians."""
    after = np.roll(corners, -1, axis=1) - corners
    before = np.roll(corners, 1, axis=1) - corners
    across = np.linalg.norm(np.cross(after, before), axis=2)
    return np.asarray(np.arctan2(across, np.einsum("mcj,mcj->mc", after, before)))


# ---- what the next frames need of a new probe, computed beside the window ------------------------


MANY = 30_000
"""Facets from which on a likeness stands in while all moves."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """What was computed of a probe."""

    probe: Probe
    # (vertices, faces, kept) or None: See `contactbench.widgets.scene.stage.thinned`; None: it has few
    # facets
    likeness: tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]] | None
    creases: NDArray[np.float64]  # (2 k, 3): Ends of its sharp and open edges that are drawn, S, m
    smooth: SmoothSurface
    narrow: NDArray[np.bool_]  # (m,) See `contactbench.widgets.scene.smooth.narrow_patches`
    hatched: NDArray[np.float64]  # (2 l, 3): Ends of the lines across what was made up, S, m


class Ahead(QObject):
    """Prepares a probe in a thread; what has become old meanwhile is dropped."""

    _came = Signal(object)

    def __init__(self, take: Callable[[Prepared], None], parent: QObject | None) -> None:
        super().__init__(parent)
        self._take = take
        self._wanted: Probe | None = None
        # One that stays: to begin a thread is to wait until it runs, which on a busy machine takes long.
        self._pool = ThreadPoolExecutor(1, "ahead")
        self._newest: Prepared | None = None
        self._came.connect(self._taken)

    @property
    def busy(self) -> bool:
        """Whether something is still to come."""
        return self._wanted is not None

    def begin(self, probe: Probe | None) -> None:
        """Prepare a probe, instead of any other; None: none."""
        if self._newest is not None and self._newest.probe is probe:  # as when a page is shown again
            self._wanted = None
            self._take(self._newest)
            return
        self._wanted = probe
        if probe is not None:
            self._pool.submit(self._work, probe)

    def close(self) -> None:
        """End it; waits for what is under way, for it tells an object that is gone soon, and drops the rest."""
        self._wanted = self._newest = None
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _work(self, probe: Probe) -> None:
        if probe is not self._wanted:
            return  # another was shown meanwhile
        prepared = prepare(probe)
        with suppress(RuntimeError):  # the scene is gone
            self._came.emit(prepared)

    def _taken(self, prepared: Prepared) -> None:
        if prepared.probe is self._wanted:
            self._wanted, self._newest = None, prepared
            self._take(prepared)


def prepare(probe: Probe) -> Prepared:
    """Compute what is needed of a probe; NumPy leaves the interpreter to others while it sorts."""
    likeness = thinned(probe.vertices, probe.faces) if len(probe.faces) > MANY else None
    edges, clear = crease_edges(probe.faces, probe.normals, len(probe.vertices))
    drawn, narrow = edges[clear], narrow_patches(probe)
    drawn = drawn[long_creases(drawn, probe.vertices, probe.size)]
    return Prepared(
        probe,
        likeness,
        probe.vertices[drawn].reshape(-1, 3),
        smoothed(probe.vertices, probe.faces, probe.normals, edges),
        narrow,
        hatches(probe, narrow),
    )
