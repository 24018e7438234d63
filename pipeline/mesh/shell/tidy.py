"""Facets too thin to have a normal, as cutting leaves them: joined to what lies beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.kernel import SurfaceIndex, crossings
from contactbench.pipeline.mesh.probe import degenerate_facets
from contactbench.pipeline.mesh.soundness import CROSSING, OVERLAP
from contactbench.pipeline.mesh.triangles import cross_products

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

_STEEP = 0.5  # cosine: a facet with a normal may not turn further


def without_slivers(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], slivers: NDArray[np.int64], width: float
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """
    Join slivers to their neighbours: one of their edges shrinks to a point.

    Parameters
    ----------
    vertices : (n, 3) float64
        They stay where they are; some are not used any longer.
    faces : (m, 3) int32
        Closed, 2-manifold and consistently oriented, and so is the result.
    slivers : (k,) int64
        Facets to join. Those that cannot be joined without turning a wider facet are left as they are.
    width : float
        Only what is lower is joined, and the surface moves by no more; in the vertices' unit.

    Returns
    -------
    faces : (l, 3) int32
    of : (l,) int64
        The facet that each was.
    """
    faces = faces.copy()
    left = np.ones(len(faces), dtype=bool)
    for facet in slivers.tolist():
        if left[facet] and _height(vertices, faces[[facet]])[0] <= width:
            for a, b in _by_length(vertices, faces[facet]):
                if _shrunk(vertices, faces, left, a, b, width):
                    break
    return faces[left], np.flatnonzero(left)


def _by_length(vertices: NDArray[np.float64], corners: NDArray[np.int32]) -> Iterator[tuple[int, int]]:
    """Give the edges, shortest first, each in both directions."""
    ends = np.column_stack((corners, np.roll(corners, -1)))
    length = np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1)
    for a, b in ends[np.argsort(length)].tolist():
        yield a, b
        yield b, a


def _shrunk(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    left: NDArray[np.bool_],
    gone: int,
    stays: int,
    width: float,
) -> bool:
    """Move a vertex onto its neighbour, unless the surface would meet itself or a wider facet turn; tell whether."""
    round_one, round_other = (
        np.flatnonzero(left & (faces == vertex).any(axis=1)) for vertex in (gone, stays)
    )
    between = np.intersect1d(round_one, round_other)
    shared = np.intersect1d(faces[round_one], faces[round_other])
    # Both ends and the two vertices across the edge: one more, and the surface would meet itself.
    if len(between) != 2 or len(shared) != 4:
        return False
    moved = np.setdiff1d(round_one, between)
    after = np.where(faces[moved] == gone, stays, faces[moved]).astype(np.int32)
    if _spoils(vertices, faces[moved], after, width):
        return False
    if SurfaceIndex(vertices, after).closest(vertices[[gone]])[0][0] > width:
        return False
    before = faces[moved]
    met = _meeting(vertices, faces, left, moved)
    faces[moved] = after
    left[between] = False
    if _meeting(vertices, faces, left, moved) > met:
        faces[moved] = before
        left[between] = True
        return False
    return True


def _meeting(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    left: NDArray[np.bool_],
    some: NDArray[np.int64],
) -> int:
    """Count the pairs of facets round some that cross or lie on each other."""
    corners = vertices[faces[some]].reshape(-1, 3)
    spread = np.stack([vertices[faces[:, corner]] for corner in range(3)])
    near = ((spread.max(axis=0) >= corners.min(axis=0)) & (spread.min(axis=0) <= corners.max(axis=0))).all(
        axis=1
    )
    return int(crossings(vertices, np.ascontiguousarray(faces[left & near]))[2][[CROSSING, OVERLAP]].sum())


def _spoils(
    vertices: NDArray[np.float64], before: NDArray[np.int32], after: NDArray[np.int32], width: float
) -> bool:
    """Tell whether a facet loses its area, or one that is wider turns."""
    old, new = cross_products(vertices, before), cross_products(vertices, after)
    sizes = np.linalg.norm(old, axis=1) * np.linalg.norm(new, axis=1)
    turns = np.einsum("ij,ij->i", old, new) < _STEEP * sizes
    return bool((degenerate_facets(vertices, after) | (turns & (_height(vertices, before) > width))).any())


def _height(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    corners = vertices[faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    return np.asarray(np.linalg.norm(cross_products(vertices, faces), axis=1) / longest)
