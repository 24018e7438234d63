"""Cut facets along the lines where they cross or touch, until none crosses another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.kernel import crossings
from contactbench.pipeline.mesh.engines import cut_along_crossings
from contactbench.pipeline.mesh.shell.sew import distinct, sew

if TYPE_CHECKING:
    from typing import Unpack

    from numpy.typing import NDArray

    from contactbench.pipeline.mesh.engines import Control

# New vertices are rounded, and pieces beside them may cross again by the last bits.
_ROUNDS = 8
# Of the size. As fine as double precision allows: coarser, and thin facets of real files are moved across others.
_GRID = 2.0**-42
_SAME = 1e-11  # of the size: new vertices nearer than this are one
_WORSE = 3.0  # times the pairs that were left: it will not end
_MOST = 10.0  # times the facets that cutting may make of what it was given


@dataclass(frozen=True, eq=False)
class Cut:
    """
    Facets that meet at shared vertices and edges only.

    Attributes
    ----------
    vertices : (n, 3) float64
        Those of facets that met others were rounded by 1e-12 of the size; the others are as they were.
    faces : (m, 3) int32
        With area, none twice.
    born : (m,) int64
        The facet given that each is, or is a piece of.
    left : int
        Pairs of facets that still cross; 0 nearly always.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]
    born: NDArray[np.int64]
    left: int


def cut_crossings(vertices: NDArray[np.float64], faces: NDArray[np.int32], **control: Unpack[Control]) -> Cut:
    """
    Cut facets along the lines where they cross or touch. A facet that meets no other in this way is left as it is.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
    **control
        See `contactbench.pipeline.mesh.engines.child.run`.

    Returns
    -------
    Cut

    Raises
    ------
    EngineError, Cancelled
        See `contactbench.pipeline.mesh.engines.child.run`.
    """
    size = float(np.ptp(vertices, axis=0).max())
    grid = 2.0 ** np.ceil(np.log2(size * _GRID))
    state = distinct(vertices, faces, np.arange(len(faces)))
    best = Cut(*state, left=-1)
    most = _MOST * max(len(faces), 1000)
    for _ in range(_ROUNDS):
        vertices, faces, born = state
        if best.left >= 0 and len(faces) > most:
            break
        pairs, _, counts, _ = crossings(vertices, faces)
        left = int(counts.sum())
        if best.left < 0 or left < best.left:
            best = Cut(vertices, faces, born, left)
        if left == 0 or left > _WORSE * best.left:
            break
        met = np.unique(pairs)
        # All that meets something lies on the grid, or what is rounded would cross what is not.
        corners = np.unique(faces[met])
        vertices = vertices.copy()
        vertices[corners] = np.rint(vertices[corners] / grid) * grid
        local = np.searchsorted(corners, faces[met]).astype(
            np.int32
        )  # the engine looks at every vertex it is given
        points, pieces, of = cut_along_crossings(vertices[corners], local, **control)
        points = np.rint(points / grid) * grid
        whole = np.ones(len(faces), dtype=bool)
        whole[met] = False
        state = sew(
            *distinct(
                np.concatenate((vertices, points)),
                np.concatenate((faces[whole], pieces + np.int32(len(vertices)))),
                np.concatenate((born[whole], born[met[of]])),
            ),
            _SAME * size,
        )
    return best
