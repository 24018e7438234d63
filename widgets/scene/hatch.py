"""Lines across facets that were made up, and crossed ones where nothing can touch: told apart without a colour."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.widgets.scene.stage import segments

if TYPE_CHECKING:
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
