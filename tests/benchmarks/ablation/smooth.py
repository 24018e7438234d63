"""Normals that are interpolated over a facet: what a smooth-shaded mesh would make of a contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.kernel import Batch
    from contactbench.pipeline.mesh import Probe

_ROUNDS = 6  # four are enough where the facet stays the same
_OUTSIDE = -1e-9
_SETTLED = -1e-3  # of a facet: what is farther out after all rounds goes to and fro between facets


class SmoothNormals:
    """
    Solve ``p x F + k n(p) = M`` on the flat facets, with n(p) interpolated between the normals of their corners.

    It begins at what a solver found, and walks to a neighbour where the point leaves its facet; where it comes to no
    rest, the flat facet's point stays. The length of n(p) does not count: k takes it up.
    """

    def __init__(self, probe: Probe) -> None:
        self._corners = probe.vertices[probe.faces]
        self._normals = probe.normals
        self._offsets = np.einsum("md,md->m", probe.normals, self._corners[:, 0])
        self._at_corners = vertex_normals(probe)[probe.faces]
        self._across = _neighbours(probe.faces)
        self._some_facet = np.zeros(len(probe.vertices), dtype=np.intp)
        self._some_facet[probe.faces.ravel()] = np.repeat(np.arange(len(probe.faces)), 3)
        # Barycentric weights of a point are linear in it: one (3, 4) matrix for each facet.
        self._weights = _weights(self._corners, self._normals)

    def refine(
        self, wrenches: NDArray[np.float64], found: Batch, *, bulge: bool = False
    ) -> NDArray[np.float64]:
        """
        Return the points (n, 3), m, that the smooth normals give; NaN where nothing was found.

        Parameters
        ----------
        wrenches : (n, 6)
            S, N and N·m.
        found : Batch
            The same wrenches, located with flat facets.
        bulge : bool
            Whether the facets bulge as their corners' normals say, too: half of a Phong tessellation, which is the
            exact height over a chord of a circle.
        """
        points = np.array(found.points)
        rows = np.flatnonzero(np.isfinite(points).all(axis=1))
        facets = np.where(found.faces[rows] >= 0, found.faces[rows], self._some_facet[found.vertices[rows]])
        points[rows] = self._solve(wrenches[rows], facets, points[rows], bulge)
        return points

    def _solve(
        self, wrenches: NDArray[np.float64], facets: NDArray[np.intp], start: NDArray[np.float64], bulge: bool
    ) -> NDArray[np.float64]:
        F, M = wrenches[:, :3], wrenches[:, 3:]
        square = np.einsum("nd,nd->n", F, F)
        axial = np.einsum("nd,nd->n", M, F)
        foot = np.cross(F, M) / square[:, None]
        p = start
        for _ in range(_ROUNDS):
            weights = self._weigh(facets, p)
            # One step over the edge that the point is farthest beyond; a rim has no other side.
            worst = weights.argmin(axis=1)
            beyond = weights[np.arange(len(p)), worst] < _OUTSIDE
            over = self._across[facets, worst]
            moved = beyond & (over >= 0)
            facets = np.where(moved, over, facets)
            weights = np.where(moved[:, None], self._weigh(facets, p), weights)
            normal = np.einsum("nk,nkd->nd", np.maximum(weights, 0.0), self._at_corners[facets])
            k = axial / np.einsum("nd,nd->n", normal, F)
            r = foot - k[:, None] * np.cross(F, normal) / square[:, None]
            flat = self._normals[facets]
            height = self._height(facets, weights, p) if bulge else 0.0
            t = (self._offsets[facets] + height - np.einsum("nd,nd->n", flat, r)) / np.einsum(
                "nd,nd->n", flat, F
            )
            p = r + t[:, None] * F
        settled = self._weigh(facets, p).min(axis=1) > _SETTLED
        return np.where(settled[:, None], p, start)

    def _height(
        self, facets: NDArray[np.intp], weights: NDArray[np.float64], p: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return how far (n,), m, the bulged facet stands over the flat one where p is."""
        inside = np.clip(weights, 0.0, 1.0)
        normals = self._at_corners[facets]
        beyond = np.einsum("nkd,nkd->nk", self._corners[facets] - p[:, None], normals)
        along = np.einsum("nkd,nd->nk", normals, self._normals[facets])
        return np.asarray(0.5 * np.einsum("nk,nk,nk->n", inside, beyond, along))

    def _weigh(self, facets: NDArray[np.intp], p: NDArray[np.float64]) -> NDArray[np.float64]:
        matrices = self._weights[facets]
        return np.asarray(np.einsum("nkd,nd->nk", matrices[:, :, :3], p) + matrices[:, :, 3])


def vertex_normals(probe: Probe) -> NDArray[np.float64]:
    """Return normals at the vertices (n, 3): those of the facets around each, weighted by their angle there."""
    corners = probe.vertices[probe.faces]
    summed = np.zeros_like(probe.vertices)
    for corner in range(3):
        a = corners[:, (corner + 1) % 3] - corners[:, corner]
        b = corners[:, (corner + 2) % 3] - corners[:, corner]
        sine = np.linalg.norm(np.cross(a, b), axis=1)
        angle = np.arctan2(sine, np.einsum("md,md->m", a, b))
        np.add.at(summed, probe.faces[:, corner], angle[:, None] * probe.normals)
    lengths = np.linalg.norm(summed, axis=1, keepdims=True)
    return np.asarray(summed / np.where(lengths > 0, lengths, 1.0))


def _neighbours(faces: NDArray[np.int32]) -> NDArray[np.intp]:
    """Return the facet across the edge that faces each corner, (m, 3); -1 where there is none or are several."""
    # The edge that faces corner c runs between the other two.
    edges = np.sort(np.stack([faces[:, [1, 2]], faces[:, [2, 0]], faces[:, [0, 1]]], axis=1), axis=2)
    keys = edges[..., 0].astype(np.int64) << 32 | edges[..., 1]
    flat = keys.ravel()
    order = np.argsort(flat, kind="stable")
    _, first, count = np.unique(flat[order], return_index=True, return_counts=True)
    across = np.full(flat.shape, -1, dtype=np.intp)
    pairs = first[count == 2]
    one, other = order[pairs], order[pairs + 1]
    across[one], across[other] = other // 3, one // 3
    return across.reshape(-1, 3)


def _weights(corners: NDArray[np.float64], normals: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return (m, 3, 4) so that weight k of a point p is W[k, :3] . p + W[k, 3]."""
    made = np.empty((len(corners), 3, 4))
    for k in range(3):
        a, b, c = corners[:, k], corners[:, (k + 1) % 3], corners[:, (k + 2) % 3]
        inward = np.cross(normals, c - b)
        height = np.einsum("md,md->m", inward, a - b)[:, None]
        made[:, k, :3] = inward / height
        made[:, k, 3] = -np.einsum("md,md->m", inward / height, b)
    return made
