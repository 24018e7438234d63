"""A flat face: the simplest thing to touch."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.mesh import Probe

_HALF_M, _TOP_M = 0.03, 0.1


class FlatFace:
    """A square plane across z: what is touched."""

    def sample(self, count: int, rng: np.random.Generator) -> Sequence[NDArray[np.float64]]:
        """Give points (count, 3), m, and outward normals (count, 3)."""
        points = np.column_stack([rng.uniform(-_HALF_M, _HALF_M, (count, 2)), np.full(count, _TOP_M)])
        return points, np.broadcast_to([0.0, 0.0, 1.0], (count, 3))


def _block() -> Probe:
    """Return a box whose top is the plane, 12 facets."""
    low, high = np.array([-_HALF_M, -_HALF_M, 0.0]), np.array([_HALF_M, _HALF_M, _TOP_M])
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=np.float64)
    faces = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4]]
    faces += [[2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]
    return Probe.from_arrays(low + corners * (high - low), faces, name="flat face")
