"""Take a wrap's offset off again: lay its vertices on the surface that it was wrapped round."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.mesh.triangles import cross_products

if TYPE_CHECKING:
    from numpy.typing import NDArray

# A facet that turns further than this, or shrinks more, has folded: its corners stop short.
_LEAST_COSINE = 0.5
_LEAST_AREA = 0.02
_ROUNDS = 8


def settle(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], targets: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Move vertices to their targets, as far as no facet folds or loses its area.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
    targets : (n, 3) float64
        Where each vertex should go: nearest points of another surface.

    Returns
    -------
    vertices : (n, 3) float64
    share : (n,) float64
        Of the way that each vertex went: 1 nearly everywhere.
    """
    before = cross_products(vertices, faces)
    area = np.linalg.norm(before, axis=1)
    share = np.ones(len(vertices))
    for attempt in range(_ROUNDS + 1):
        moved = vertices + share[:, None] * (targets - vertices)
        if attempt == _ROUNDS:  # what folded last time stands where it was, and cannot fold
            break
        after = cross_products(moved, faces)
        size = np.linalg.norm(after, axis=1)
        upright = np.einsum("ij,ij->i", before, after) > _LEAST_COSINE * area * size
        bad = np.unique(faces[~(upright & (size > _LEAST_AREA * area))])
        if len(bad) == 0:
            break
        share[bad] = 0.0 if attempt == _ROUNDS - 1 else share[bad] / 2
    return moved, share
