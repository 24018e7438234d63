"""What soft tissue can reach of a probe's face: places spread evenly over it, as seen from above."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.mesh import Probe

FACE_DEPTH_M = 0.012
_OUTSIDE_M = 0.001


def spread(probe: Probe, count: int) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """
    Spread places over what tissue can reach of a probe: what is within 12 mm of its tip, seen from above.

    Parameters
    ----------
    count : int
        About how many.

    Returns
    -------
    places, normals : (n, 3)
        S, m, and outward.
    area : float
        Of the tissue's top for each place, m².
    """
    low, high = probe.vertices.min(axis=0) - _OUTSIDE_M, probe.vertices.max(axis=0) + _OUTSIDE_M
    index = SurfaceIndex(probe.vertices, probe.faces)
    cell = float(np.prod((high - low)[:2])) / count
    # The first grid shows how much of the rectangle is covered; the second has the right size.
    for _ in range(2):
        places, normals = _seen_from_above(probe, index, low, high, cell)
        if not len(places):
            raise InputError(
                f"probe {arg(probe.name)}: no part of it lies within 12 mm of its tip: check that it is aligned."
            )
        cell, area = cell * len(places) / count, cell
    return places, normals, area


def _seen_from_above(
    probe: Probe, index: Any, low: NDArray[np.float64], high: NDArray[np.float64], cell: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the surface under the middles of a triangular grid, one per `cell` (m²)."""
    side = np.sqrt(2 * cell / np.sqrt(3))
    row = side * np.sqrt(3) / 2
    count = np.ceil((high - low)[:2] / [side, row]).astype(int) + 1
    x, y = np.meshgrid(np.arange(count[0]) * side, np.arange(count[1]) * row)
    x[1::2] += side / 2
    # Centred: a probe that is the same on both sides gets the same places there.
    middle = (low + high)[:2] / 2
    flat = np.column_stack([(x - x.mean()).ravel(), (y - y.mean()).ravel()]) + middle
    starts = np.column_stack([flat, np.full(len(flat), high[2] + _OUTSIDE_M)])
    down = np.broadcast_to([0.0, 0.0, -1.0], starts.shape)
    distances, facets = index.first_hit(starts, np.ascontiguousarray(down))
    hit = (facets >= 0) & (distances < 2 * _OUTSIDE_M + FACE_DEPTH_M)
    # Only what is hit: elsewhere the distance is infinite.
    return starts[hit] + distances[hit, None] * down[hit], probe.normals[facets[hit]]
