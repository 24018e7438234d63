"""Fits of many hypotheses side by side: the same few array operations for all of them.

Biases, and their course over the poses, enter linearly and with equal weight, so they are projected out; what is
left to be found is gravity g and the centre of mass L, for some hypotheses a constant turn of the sensor, by
Gauss-Newton, and how large the noise is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.model import cross_matrix

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.diagnosis.hypothesis import Hypothesis
    from contactbench.pipeline.calibration.poses import Stack

# Noise is at least this share of the readings: none is so small, and simulated data have none at all.
_LEAST = 1e-6
_TINY = 1e-12
# What noise that is not of the size that was given costs at most: sometimes it is simply wrong.
_WORST_DOUBT = 12.0
_ALIKE = 0.6  # correlation of the doubts about forces and torques
# Steps are damped as if g and L were known beforehand to this many times what the readings suggest.
_DAMPING = 10.0
_ROUNDS, _HALVINGS = 10, 5
_CONVERGED = 0.02  # of the likelihood (its logarithm), and of the noise
_NOT_FREE = 1.0  # information on an angle that is not free: any, its step is zero


@dataclass(frozen=True, eq=False)
class HypothesisNoise:
    """What is known of the noise before anything is fitted."""

    sigmas: NDArray[np.float64]  # (6,) of a pose's mean, N and N·m
    # It may be larger or smaller by a factor whose logarithm has this standard deviation; infinite: nothing
    # is known of it, `sigmas` are a unit to count in
    doubt: float
    orientation: float = 0.0  # 1 sigma of the orientations about each axis, rad
    # Bounds of the load, N, and of its centre of mass, m: an orientation's error moves no more than these
    heaviest: float = np.inf
    longest: float = np.inf
    # (3,) where gravity points, roughly: where turns of the sensor are looked for from
    down_W: tuple[float, float, float] = (0.0, 0.0, -1.0)


@dataclass(frozen=True, eq=False)
class Fits:
    """Fits of h hypotheses side by side."""

    R: NDArray[np.float64]  # (h, n, 3, 3) R_SW, as each hypothesis has it
    y: NDArray[np.float64]  # (h, n, 6) wrenches likewise, over the noise
    # (h, 6) the noise, N and N·m, with what the orientations' errors make of the weight
    sigmas: NDArray[np.float64]
    # (h, n) what the bias changes with over the poses: 0 and 1 before and after a re-zero, time for a drift;
    # else 0
    course: NDArray[np.float64]
    free: NDArray[np.bool_]  # (h, 3) about which axes of S the sensor may be turned
    kept: NDArray[np.bool_]  # (h, n)
    x: NDArray[np.float64]  # (h, 6) g and L, N and m
    # (h, 2) logarithm of the factor on forces and torques: the density of what was *recorded* is wanted
    scale: NDArray[np.float64]
    u: NDArray[np.float64]  # (h, 2) logarithm of the noise's true size over `sigmas`, for forces and torques
    doubt: float  # Standard deviation of u beforehand; infinite for noise that is not known
    # (h, 6) information on x that is added to what the poses say, N^-2 and m^-2; (h, 9) with that on a turn,
    # rad^-2, where any hypothesis has one
    damping: NDArray[np.float64]
    least: NDArray[np.float64]  # (h, 2) lower bound of u

    def take(self, chosen: NDArray[np.bool_]) -> Fits:
        """Return some of the fits."""
        parts = {
            name: getattr(self, name)[chosen]
            for name in ("R", "y", "sigmas", "course", "free", "kept", "x", "scale", "u", "damping", "least")
        }
        return replace(self, **parts)

    def put(self, chosen: NDArray[np.bool_], others: Fits) -> Fits:
        """Return these fits, with the `chosen` ones taken from `others`, which has no more than those."""
        changing = ("kept", "x", "u", "R") if self.turns else ("kept", "x", "u")
        parts = {name: getattr(self, name).copy() for name in changing}
        for name, array in parts.items():
            array[chosen] = getattr(others, name)
        return replace(self, **parts)

    @property
    def turns(self) -> bool:
        """Whether any hypothesis has a turn to be found."""
        return bool(self.damping.shape[1] > 6)

    @property
    def changes(self) -> NDArray[np.bool_]:
        """(h,) whether the bias changes."""
        return np.asarray(self.course.any(axis=1))

    @property
    def count(self) -> NDArray[np.float64]:
        """(h, 1) kept poses."""
        return np.asarray(self.kept.sum(axis=1, keepdims=True), dtype=np.float64)

    def around(self) -> NDArray[np.float64]:
        """(h, n) the course, less its mean over the kept poses."""
        mean = (self.course * self.kept).sum(axis=1, keepdims=True) / np.maximum(self.count, 1)
        return np.asarray(self.course - mean)

    def pull(self) -> NDArray[np.float64]:
        """(h, 1) sum of its squares over the kept poses: how sure they are of a change of the bias."""
        square = (self.kept * self.around() ** 2).sum(axis=1, keepdims=True)
        return np.asarray(np.maximum(square, _TINY))

    def biases(self, flat: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the means of (h, n, m) values over the kept poses, and their slopes on the course (h, m)."""
        mean = (self.kept / np.maximum(self.count, 1))[:, None] @ flat
        slope = np.zeros_like(mean)
        changes = self.changes
        if changes.any():
            part = self.take(changes)
            slope[changes] = (part.kept * part.around() / part.pull())[:, None] @ flat[changes]
        return mean[:, 0], slope[:, 0]

    def centred(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Take the bias of the kept poses, and its course, out of (h, n, ...) values."""
        flat = values.reshape(*self.kept.shape, -1)
        mean, slope = self.biases(flat)
        flat = flat - mean[:, None]
        changes = self.changes
        if changes.any():
            flat[changes] -= self.take(changes).around()[..., None] * slope[changes][:, None]
        return flat.reshape(values.shape)

    def leverage(self) -> NDArray[np.float64]:
        """(h, n) variance of the bias at each pose, in units of a pose's."""
        return np.asarray(
            1 / np.maximum(self.count, 1) + self.around() ** 2 / self.pull() * self.changes[:, None]
        )

    @property
    def beside(self) -> NDArray[np.int64]:
        """(h, n) kept poses that share each pose's bias."""
        late = self.course == 1  # a drift ends at 0
        before, after = (self.kept & ~late).sum(axis=1)[:, None], (self.kept & late).sum(axis=1)[:, None]
        return np.asarray(np.where(late, after, before), dtype=np.int64)

    @property
    def freedom(self) -> NDArray[np.float64]:
        """(h,) degrees of freedom of the forces, and of the torques."""
        lost = 6 + 3 * self.changes + self.free.sum(axis=1) / 2
        return np.asarray(3.0 * self.kept.sum(axis=1) - lost, dtype=np.float64)

    def weights(self) -> NDArray[np.float64]:
        """(h, 1, 6) what residuals are to be multiplied by for unit variance."""
        return np.repeat(np.exp(-self.u), 3, axis=1)[:, None]

    def raw_residuals(self) -> NDArray[np.float64]:
        """(h, n, 6) residuals over the noise, with the biases still in them."""
        g, L = self.x[:, None, :3, None], self.x[:, 3:]
        weight = (self.R @ g)[..., 0]
        torque = weight @ cross_matrix(L).swapaxes(1, 2)
        return self.y - np.concatenate([weight, torque], axis=2) / self.sigmas[:, None]

    def residuals(self) -> NDArray[np.float64]:
        """(h, n, 6) residuals over the noise."""
        return self.centred(self.raw_residuals())

    def jacobian(self) -> NDArray[np.float64]:
        """(h, n, 6, 6 or 9) change of the predictions with x, for unit variance, before the biases follow."""
        J = np.zeros((*self.kept.shape, 6, self.damping.shape[1]))
        L, arm = (
            cross_matrix(self.x[:, 3:])[:, None],
            -cross_matrix((self.R @ self.x[:, None, :3, None])[..., 0]),
        )
        J[..., :3, :3] = self.R
        J[..., 3:, :3] = L @ self.R
        J[..., 3:, 3:6] = arm
        if self.turns:
            J[..., :3, 6:] = arm
            J[..., 3:, 6:] = L @ arm
            J[..., 6:] *= self.free[:, None, None]
        J *= (self.weights() / self.sigmas[:, None])[..., None]
        return J

    def stepped(self, step: NDArray[np.float64]) -> Fits:
        """Return the fits a step (h, 6 or 9) further."""
        moved = replace(self, x=self.x + step[:, :6])
        if not self.turns:
            return moved
        return replace(moved, R=Rotation.from_rotvec(step[:, 6:]).as_matrix()[:, None] @ self.R)

    def information(self, J: NDArray[np.float64]) -> NDArray[np.float64]:
        """(h, 6, 6), or 9: what the kept poses say of x, from the jacobian; a little more, against 0 / 0."""
        width = J.shape[-1]
        rows = (J * self.kept[..., None, None]).reshape(len(J), -1, width)
        mean, slope = self.biases(J.reshape(*self.kept.shape, -1))
        gone = np.stack([mean * np.sqrt(self.count), slope * np.sqrt(self.pull())], axis=1).reshape(
            len(J), -1, width
        )
        return np.asarray(
            rows.swapaxes(1, 2) @ rows - gone.swapaxes(1, 2) @ gone + self.damping[..., None] * np.eye(width)
        )

    def squares(self, residuals: NDArray[np.float64]) -> NDArray[np.float64]:
        """(h, 2) sums of squares over the kept poses."""
        each = np.square(residuals).reshape(*self.kept.shape, 2, 3).sum(axis=3)
        return np.asarray((self.kept[:, None].astype(np.float64) @ each)[:, 0], dtype=np.float64)


def begin(hypotheses: Sequence[Hypothesis], poses: Stack, noise: HypothesisNoise) -> Fits:
    """Return fits that have not begun: g and L are zero.

    Parameters
    ----------
    hypotheses : sequence of Hypothesis
    poses : Stack
        As declared.
    noise : HypothesisNoise
    """
    h, n = len(hypotheses), len(poses)
    factors = np.array([hypothesis.factor for hypothesis in hypotheses])
    wrenches = np.array([hypothesis.wrench(poses.wrenches) for hypothesis in hypotheses])
    size = np.sqrt(np.square(wrenches).reshape(h, n, 2, 3).mean(axis=(1, 3))) + 1e-9
    span = wrenches.reshape(h, n, 2, 3).std(axis=1).mean(axis=2) + _LEAST * size
    # In proportion to the readings: a change of units changes nothing else.
    wide = _DAMPING * np.stack([size[:, 0], size[:, 1] / span[:, 0]], axis=1)
    damping = np.repeat(wide, 3, axis=1) ** -2
    free = np.array([hypothesis.free for hypothesis in hypotheses], dtype=bool)
    R = np.array([hypothesis.R_WS for hypothesis in hypotheses]).swapaxes(2, 3)
    if free.any():
        angles = np.where(free, (_DAMPING * np.pi) ** -2, _NOT_FREE)
        damping = np.concatenate([damping, angles], axis=1)
        R = _turned(R, wrenches[..., :3], free, np.array(noise.down_W))
    unsteady = _unsteady(span, noise) if np.isfinite(noise.doubt) else np.zeros((h, 2))
    sigmas = np.hypot(noise.sigmas, np.repeat(unsteady, 3, axis=1))
    larger = np.log(sigmas / noise.sigmas).reshape(h, 2, 3).mean(axis=2)
    start = 0 if np.isfinite(noise.doubt) else np.log(span / sigmas[:, [0, 3]])
    return Fits(
        R=R,
        y=wrenches / sigmas[:, None],
        sigmas=sigmas,
        course=np.array([hypothesis.course for hypothesis in hypotheses]),
        free=free,
        kept=np.ones((h, n), dtype=bool),
        x=np.zeros((h, 6)),
        scale=np.log(np.abs(factors[:, [0, 3]])) - larger,
        u=np.zeros((h, 2)) + start,
        doubt=noise.doubt,
        damping=damping,
        least=np.log(_LEAST * size / sigmas.reshape(h, 2, 3).min(axis=2)),
    )


def _unsteady(span: NDArray[np.float64], noise: HypothesisNoise) -> NDArray[np.float64]:
    """Return what the orientations' errors make (h, 2) of the weight and its torque, N and N·m.

    A vector of any direction is sqrt(3) times as long as each component's standard deviation; an error moves it
    across, along two of three axes.
    """
    across = np.sqrt(2)
    weight, torque = np.minimum(across * span[:, 0], noise.heaviest), across * span[:, 1]
    return noise.orientation * np.stack([weight, np.minimum(torque, weight * noise.longest)], axis=1)


def _turned(
    R_SW: NDArray[np.float64],
    forces: NDArray[np.float64],
    free: NDArray[np.bool_],
    down_W: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Turn orientations (h, n, 3, 3) as forces (h, n, 3) suggest if gravity points down (Kabsch 1976)."""
    down = (R_SW @ down_W[:, None])[..., 0]
    H = (forces - forces.mean(axis=1, keepdims=True)).swapaxes(1, 2) @ (
        down - down.mean(axis=1, keepdims=True)
    )
    U, _, Vt = np.linalg.svd(H)
    U[..., 2] *= np.linalg.det(U @ Vt)[:, None]
    yaw = np.arctan2(H[:, 1, 0] - H[:, 0, 1], H[:, 0, 0] + H[:, 1, 1])
    about_z = Rotation.from_euler("z", yaw[:, None]).as_matrix()
    any_axis = np.asarray(free.all(axis=1))[:, None, None]
    turns = np.where(any_axis, U @ Vt, about_z)
    return np.asarray(turns[:, None] @ R_SW, dtype=np.float64)


def fit(fits: Fits, rounds: int = _ROUNDS) -> Fits:
    """Maximise the likelihood; from zeros the first step finds g from forces, the second L from torques."""
    todo = np.ones(len(fits.x), dtype=bool)
    for _ in range(rounds):
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
    gradient = J.reshape(len(J), -1, J.shape[-1]).swapaxes(1, 2) @ r.reshape(len(J), -1, 1)
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
        attempt = attempt.stepped(0.5**halving * step[todo])
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


def joint_doubts(fits: Fits, u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return what noise of size u (h, 2) costs (h,), beside that which was given.

    Who is wrong about the noise is mostly wrong about that of the forces and of the torques alike.
    """
    if not np.isfinite(fits.doubt):
        return np.zeros(len(u))
    u = u / fits.doubt
    square = (np.square(u).sum(axis=1) - 2 * _ALIKE * u[:, 0] * u[:, 1]) / (1 - _ALIKE**2)
    return np.asarray(np.minimum(0.5 * square, 2 * _WORST_DOUBT))


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
