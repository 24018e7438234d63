"""Lines across facets that were made up, and crossed ones where nothing can touch: told apart without a colour."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.widgets.scene.shapes import segments

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.mesh import Probe

_LINES = 70  # across the probe's size
# The direction in which the lines follow each other, by the axis along which a facet's normal is longest: it is
# never along the normal, so every facet gets its lines.
_ACROSS = np.array([[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]]) / np.sqrt(2.0)
_CROSSED = _ACROSS * [[1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0]]


def hatches(probe: Probe) -> Any:
    """Return the lines across what was made up, for VTK."""
    return segments(hatch_segments(probe.vertices, probe.faces[probe.invented], probe.size / _LINES))


def crosses(probe: Probe, faces: NDArray[np.intp] | NDArray[np.int32]) -> Any:
    """Return crossed lines over the given facets, for VTK."""
    chosen, spacing = probe.faces[faces], probe.size / _LINES
    both = [hatch_segments(probe.vertices, chosen, spacing, across) for across in (_ACROSS, _CROSSED)]
    return segments(np.concatenate(both))


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
