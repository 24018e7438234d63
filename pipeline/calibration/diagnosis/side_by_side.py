"""Fits of many hypotheses side by side: the same few array operations for all of them.

Biases enter linearly and with equal weight, so they are taken out with the means; what is left to be found is
gravity g and the centre of mass L, by Gauss-Newton, and how large the noise is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from pipeline.calibration.model import cross_matrix

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from pipeline.calibration.diagnosis.hypotheses import Hypothesis
    from pipeline.calibration.poses import Stack

# Noise is at least this share of the readings: none is so small, and simulated data have none at all.
_LEAST = 1e-6
# What noise that is not of the size that was given costs at most: sometimes it is simply wrong.
_WORST_DOUBT = 12.0
# Steps are damped as if g and L were known beforehand to this many times what the readings suggest.
_DAMPING = 10.0
_ROUNDS, _HALVINGS = 10, 5
_CONVERGED = 0.02  # of the likelihood (its logarithm), and of the noise


@dataclass(frozen=True, eq=False)
class Fits:
    """Fits of h hypotheses side by side.

    Attributes
    ----------
    R : (h, n, 3, 3)
        R_SW, as each hypothesis has it.
    y : (h, n, 6)
        Wrenches likewise, over the noise.
    sigmas : (6,)
        The noise, N and N·m.
    later : (h, n) bool
        Poses after a re-zero.
    kept : (h, n) bool
    x : (h, 6)
        g and L, N and m.
    scale : (h, 2)
        Logarithm of the factor on forces and torques: the density of what was *recorded* is wanted.
    u : (h, 2)
        Logarithm of the noise's true size over `sigmas`, for forces and torques.
    doubt : float
        Standard deviation of u beforehand; infinite for noise that is not known.
    damping : (h, 6)
        Information on x that is added to what the poses say, N^-2 and m^-2.
    least : (h, 2)
        Lower bound of u.
    """

    R: NDArray[np.float64]
    y: NDArray[np.float64]
    sigmas: NDArray[np.float64]
    later: NDArray[np.bool_]
    kept: NDArray[np.bool_]
    x: NDArray[np.float64]
    scale: NDArray[np.float64]
    u: NDArray[np.float64]
    doubt: float
    damping: NDArray[np.float64]
    least: NDArray[np.float64]

    def take(self, chosen: NDArray[np.bool_]) -> Fits:
        """Return some of the fits."""
        parts = {
            name: getattr(self, name)[chosen]
            for name in ("R", "y", "later", "kept", "x", "scale", "u", "damping", "least")
        }
        return replace(self, **parts)

    def put(self, chosen: NDArray[np.bool_], others: Fits) -> Fits:
        """Return these fits, with the `chosen` ones taken from `others`, which has no more than those."""
        parts = {name: getattr(self, name).copy() for name in ("kept", "x", "u")}
        for name, array in parts.items():
            array[chosen] = getattr(others, name)
        return replace(self, **parts)

    def means(self, flat: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the means (h, 2, m) of (h, n, m) values over the kept poses before and after a re-zero."""
        chosen = np.stack([self.kept & ~self.later, self.kept & self.later], axis=1)
        sums = chosen.astype(np.float64) @ flat
        return np.asarray(sums / np.maximum(chosen.sum(axis=2), 1)[..., None], dtype=np.float64)

    def centred(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Take the mean of the kept poses out of (h, n, ...) values, before and after a re-zero."""
        flat = values.reshape(*self.kept.shape, -1)
        means = self.means(flat)
        flat = flat - means[:, :1]
        late, pose = np.nonzero(self.later)
        flat[late, pose] += means[late, 0] - means[late, 1]
        return flat.reshape(values.shape)

    @property
    def beside(self) -> NDArray[np.int64]:
        """(h, n) kept poses that share each pose's bias."""
        late = self.kept & self.later
        before, after = (self.kept.sum(axis=1) - late.sum(axis=1))[:, None], late.sum(axis=1)[:, None]
        return np.asarray(np.where(self.later, after, before), dtype=np.int64)

    @property
    def freedom(self) -> NDArray[np.float64]:
        """(h,) degrees of freedom of the forces, and of the torques."""
        return np.asarray(3.0 * self.kept.sum(axis=1) - 6 - 3 * self.later.any(axis=1), dtype=np.float64)

    def weights(self) -> NDArray[np.float64]:
        """(h, 1, 6) what residuals are to be multiplied by for unit variance."""
        return np.repeat(np.exp(-self.u), 3, axis=1)[:, None]

    def raw_residuals(self) -> NDArray[np.float64]:
        """(h, n, 6) residuals over the noise, with the biases still in them."""
        g, L = self.x[:, None, :3, None], self.x[:, 3:]
        weight = (self.R @ g)[..., 0]
        torque = weight @ cross_matrix(L).swapaxes(1, 2)
        return self.y - np.concatenate([weight, torque], axis=2) / self.sigmas

    def residuals(self) -> NDArray[np.float64]:
        """(h, n, 6) residuals over the noise."""
        return self.centred(self.raw_residuals())

    def jacobian(self) -> NDArray[np.float64]:
        """(h, n, 6, 6) change of the predictions with x, for unit variance, before the biases follow."""
        J = np.zeros((*self.kept.shape, 6, 6))
        J[..., :3, :3] = self.R
        J[..., 3:, :3] = cross_matrix(self.x[:, 3:])[:, None] @ self.R
        J[..., 3:, 3:] = -cross_matrix((self.R @ self.x[:, None, :3, None])[..., 0])
        J *= (self.weights() / self.sigmas)[..., None]
        return J

    def information(self, J: NDArray[np.float64]) -> NDArray[np.float64]:
        """(h, 6, 6) what the kept poses say of x, from the jacobian; a little more, against 0 / 0."""
        rows = (J * self.kept[..., None, None]).reshape(len(J), -1, 6)
        means = self.means(J.reshape(*self.kept.shape, -1))
        late = (self.kept & self.later).sum(axis=1)
        counts = np.stack([self.kept.sum(axis=1) - late, late], axis=1)
        means = (means * np.sqrt(counts)[..., None]).reshape(len(J), -1, 6)
        return np.asarray(
            rows.swapaxes(1, 2) @ rows - means.swapaxes(1, 2) @ means + self.damping[..., None] * np.eye(6)
        )

    def squares(self, residuals: NDArray[np.float64]) -> NDArray[np.float64]:
        """(h, 2) sums of squares over the kept poses."""
        each = np.square(residuals).reshape(*self.kept.shape, 2, 3).sum(axis=3)
        return np.asarray((self.kept[:, None].astype(np.float64) @ each)[:, 0], dtype=np.float64)


def begin(hypotheses: Sequence[Hypothesis], poses: Stack, sigmas: NDArray[np.float64], doubt: float) -> Fits:
    """Return fits that have not begun: g and L are zero.

    Parameters
    ----------
    hypotheses : sequence of Hypothesis
    poses : Stack
        As declared.
    sigmas : (6,)
        Noise of a pose's mean, N and N·m.
    doubt : float
        As in `Fits`.
    """
    h, n = len(hypotheses), len(poses)
    factors = np.array([hypothesis.factor for hypothesis in hypotheses])
    changes = np.array([hypothesis.change or n for hypothesis in hypotheses])
    wrenches = np.concatenate([poses.F, poses.M], axis=1) * factors[:, None]
    size = np.sqrt(np.square(wrenches).reshape(h, n, 2, 3).mean(axis=(1, 3))) + 1e-9
    span = wrenches.reshape(h, n, 2, 3).std(axis=1).mean(axis=2) + _LEAST * size
    # In proportion to the readings: a change of units changes nothing else.
    wide = _DAMPING * np.stack([size[:, 0], size[:, 1] / span[:, 0]], axis=1)
    start = 0 if np.isfinite(doubt) else np.log(span / sigmas[[0, 3]])
    return Fits(
        R=np.array([hypothesis.R_WS for hypothesis in hypotheses]).swapaxes(2, 3),
        y=wrenches / sigmas,
        sigmas=sigmas,
        later=np.arange(n) >= changes[:, None],
        kept=np.ones((h, n), dtype=bool),
        x=np.zeros((h, 6)),
        scale=np.log(np.abs(factors[:, [0, 3]])),
        u=np.zeros((h, 2)) + start,
        doubt=doubt,
        damping=np.repeat(wide, 3, axis=1) ** -2,
        least=np.log(_LEAST * size / sigmas.reshape(2, 3).min(axis=1)),
    )


def fit(fits: Fits) -> Fits:
    """Maximise the likelihood; from zeros the first step finds g from forces, the second L from torques."""
    todo = np.ones(len(fits.x), dtype=bool)
    for _ in range(_ROUNDS):
        fits_todo, unfinished = _improve(fits.take(todo))
        fits = fits.put(todo, fits_todo)
        todo[todo] = unfinished
        if not todo.any():
            break
    return fits


def _improve(fits: Fits) -> tuple[Fits, NDArray[np.bool_]]:
    """Take one step of Gauss-Newton, then adapt the noise; tell which fits (h,) are not at their end yet."""
    J, residuals = fits.jacobian(), fits.residuals()
    r = residuals * fits.weights() * fits.kept[..., None]  # centred, which spares centring J
    gradient = J.reshape(len(J), -1, 6).swapaxes(1, 2) @ r.reshape(len(J), -1, 1)
    step = np.asarray(np.linalg.solve(fits.information(J), gradient)[..., 0], dtype=np.float64)
    fits, residuals = _descend(fits, residuals, step)
    u = _noise(fits, fits.squares(residuals))
    far = (step * gradient[..., 0]).sum(axis=1) > _CONVERGED
    return replace(fits, u=u), far | (np.abs(u - fits.u).max(axis=1) > _CONVERGED)


def _descend(
    fits: Fits, residuals: NDArray[np.float64], step: NDArray[np.float64]
) -> tuple[Fits, NDArray[np.float64]]:
    """Go along `step` (h, 6) as far as the likelihood of each hypothesis grows."""
    shrink = np.exp(-2 * fits.u)
    before = (shrink * fits.squares(residuals)).sum(axis=1)
    todo = np.ones(len(before), dtype=bool)
    residuals = residuals.copy()
    for halving in range(_HALVINGS):
        attempt = fits.take(todo)
        attempt = replace(attempt, x=attempt.x + 0.5**halving * step[todo])
        there = attempt.residuals()
        good = (shrink[todo] * attempt.squares(there)).sum(axis=1) <= before[todo] * (1 + 1e-9)
        reached = todo.copy()
        reached[todo] = good
        fits = fits.put(reached, attempt.take(good))
        residuals[reached] = there[good]
        todo &= ~reached
        if not todo.any():
            break
    return fits, residuals


def doubts(fits: Fits, u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return what noise of size u (h, 2) costs, beside that which was given."""
    return np.asarray(np.minimum(0.5 * (u / fits.doubt) ** 2, _WORST_DOUBT), dtype=np.float64)


def _noise(fits: Fits, squares: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the u (h, 2) that maximises -d u - squares exp(-2 u) / 2 - doubts."""
    d = fits.freedom[:, None]
    plain = np.maximum(0.5 * np.log(np.maximum(squares, 1e-300) / d), fits.least)
    if not np.isfinite(fits.doubt):
        return np.asarray(plain, dtype=np.float64)
    pull = fits.doubt**-2
    # Left of the root of a convex function Newton's steps never pass it.
    u = 0.5 * np.log(d * np.exp(2 * plain) / (d + pull * np.maximum(plain, 0)))
    for _ in range(8):
        fall = squares * np.exp(-2 * u)
        u += (fall - pull * u - d) / (2 * fall + pull)
    u = np.maximum(u, fits.least)
    # Where the doubts are at their bound, they do not pull.
    costs = [d * v + 0.5 * squares * np.exp(-2 * v) + doubts(fits, v) for v in (u, plain)]
    return np.asarray(np.where(costs[0] <= costs[1], u, plain), dtype=np.float64)
