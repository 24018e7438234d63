r"""
What a touch of a known point says about the mount.

A touch of the point p (in P) with outward normal n obeys ``p_S x F + k n_S = M`` with ``p_S = R p + t`` and
``n_S = R n`` (Cao et al. 2023, Eq. 4-6). The local torque k is unknown, so the two components of
``M - p_S x F`` across the normal must vanish, and nothing else is known. With two tangents T (2, 3) at p:

    r = T R^T (M - p_S x F) = 0
    cov(r) = B Sigma_w B^T + s^2 (F . n_S)^2 I,    B (dF, dM) = T R^T (dM - p_S x dF)

where s is how well the marker was hit, per direction in the surface. For fixed p the residual is linear in
the wrench's noise, so ``sum r^T inv(cov(r)) r`` is the likelihood itself once the unknown true forces are
eliminated, as long as cov(r) is taken where p is: it is differentiated with the rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.preparation.alignment.rigid import across, step

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# Of a scaled unknown: central differences then err by about 1e-10 of the derivative.
_DIFFERENCE = 1e-5


@dataclass(frozen=True, eq=False)
class MarkerModel:
    """Touches, ready to be compared with a mount."""

    # points_P, normals_P: (n, 3) on the mesh, m; outward unit normals
    points_P: Floats
    normals_P: Floats
    wrenches: Floats  # (n, 6) in S, N and N·m
    covariance: Floats  # (6, 6) of a wrench's noise, independent from touch to touch
    placement: float  # standard deviation of where a marker is hit, in each direction of the surface, m

    def __len__(self) -> int:
        return len(self.points_P)

    @cached_property
    def tangents_P(self) -> Floats:
        """(n, 2, 3) two unit tangents per touch: they turn with the mesh, so the residual is smooth."""
        return across(self.normals_P)

    def chosen(self, rows: NDArray[np.intp] | NDArray[np.bool_]) -> MarkerModel:
        """Return some of the touches."""
        return MarkerModel(
            self.points_P[rows], self.normals_P[rows], self.wrenches[rows], self.covariance, self.placement
        )

    def pressed(self, T_SP: Floats) -> NDArray[np.bool_]:
        """Return which forces (n,) push on the surface; tissue cannot pull."""
        into = np.einsum("ij,ij->i", self.wrenches[:, :3], self.normals_P @ T_SP[:3, :3].T)
        return np.asarray(into < 0)

    def residuals(self, T_SP: Floats, bias: Floats | None = None) -> Floats:
        """
        Return the residuals (..., n, 2), each pair of unit covariance.

        Parameters
        ----------
        T_SP : (..., 4, 4)
            One mount or several.
        bias : (6,), optional
            A wrench error common to all touches, to be subtracted.
        """
        wrenches = self.wrenches if bias is None else self.wrenches - bias
        r, spread, _ = self._compare(T_SP, wrenches)
        return _whiten(spread, r)

    def sigmas(self, T_SP: Floats) -> Floats:
        """Return the smallest contact error (n, 2, 2) that the noise allows, as covariances in the surface, m²."""
        _, spread, into = self._compare(T_SP, self.wrenches)
        # The contact moves in the surface by u with T (u x F) = r, which is r turned by 90 deg over F.n.
        turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
        covariances: Floats = turn @ spread @ turn.T / into[:, None, None] ** 2
        return covariances

    def plane_errors(self, T_SP: Floats) -> Floats:
        """Return how far (n,) each contact is from its marker in the marker's tangent plane, m."""
        r, _, into = self._compare(T_SP, self.wrenches)
        errors: Floats = np.linalg.norm(r, axis=1) / np.maximum(np.abs(into), 1e-12)
        return errors

    def jacobian(self, T_SP: Floats, about_S: Floats, scales: Floats) -> Floats:
        """Return the derivative (n, 2, 6) of the residuals by scaled steps of the mount about a point of S."""
        steps = _DIFFERENCE * np.diag(scales)
        r = self.residuals(step(T_SP, about_S, np.concatenate([steps, -steps])))
        return np.moveaxis((r[:6] - r[6:]) / (2 * _DIFFERENCE), 0, 2)

    def bias_jacobian(self, T_SP: Floats) -> Floats:
        """Return the derivative (n, 2, 6) of the residuals by a common wrench error, per N and per N·m."""
        steps = _DIFFERENCE * np.eye(6)
        r = np.stack([self.residuals(T_SP, -d) - self.residuals(T_SP, d) for d in steps])
        return np.moveaxis(r / (2 * _DIFFERENCE), 0, 2)

    def _compare(self, T_SP: Floats, wrenches: Floats) -> tuple[Floats, Floats, Floats]:
        """Return r (..., n, 2), cov(r) (..., n, 2, 2) and the force along the normal (..., n), N."""
        F, M = wrenches[:, :3], wrenches[:, 3:]
        R_PS = T_SP[..., :3, :3].swapaxes(-1, -2)
        p = self.points_P @ R_PS + T_SP[..., None, :3, 3]
        T_S = self.tangents_P @ R_PS[..., None, :, :]
        r = (T_S @ (M - _cross(p, F))[..., None])[..., 0]
        # Row i of B: a tangent e takes (dF, dM) to e.(dM - p x dF) = e.dM - (e x p).dF.
        B = np.concatenate([-_cross(T_S, p[..., None, :]), T_S], axis=-1)
        spread = B @ self.covariance @ B.swapaxes(-1, -2)
        into = ((self.normals_P @ R_PS) * F).sum(axis=-1)
        spread = spread + (self.placement * into)[..., None, None] ** 2 * np.eye(2)
        return r, spread, into


def _cross(a: Floats, b: Floats) -> Floats:
    """Return cross products; NumPy's own spends ten times as long on moving axes."""
    product = a[..., [1, 2, 0]] * b[..., [2, 0, 1]]
    product -= a[..., [2, 0, 1]] * b[..., [1, 2, 0]]
    return product


def _whiten(spread: Floats, r: Floats) -> Floats:
    """Return inv(L) r for spread = L L^T, (..., n, 2)."""
    a = np.sqrt(spread[..., 0, 0])
    b = spread[..., 1, 0] / a
    c = np.sqrt(spread[..., 1, 1] - b * b)
    first = r[..., 0] / a
    return np.stack([first, (r[..., 1] - b * first) / c], axis=-1)
