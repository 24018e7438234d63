"""Fits of many hypotheses side by side: the same few array operations for all of them.

Biases enter linearly and with equal weight, so they are projected out; what is left to be found
is gravity g and the centre of mass L, by Gauss-Newton, and how large the noise is.

How well each way to read the poses explains what was recorded.

Each hypothesis gets the likelihood of the *recorded* numbers, so one that divides torques by 1000 must also say
why the recorded noise was 1000 times larger. Up to a quarter of the poses may be bumped, whatever the hypothesis;
each that is left out costs as much as a bump of its size is improbable.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.calibration.diagnosis.hypothesis import AS_DECLARED, Hypothesis
from contactbench.pipeline.calibration.model import cross_matrix
from contactbench.pipeline.calibration.poses import Stack

# Noise is at least this share of the readings: none is so small, and simulated data have none at all.
_LEAST = 1e-6
_TINY = 1e-12
# What noise that is not of the size that was given costs at most: sometimes it is simply wrong.
_WORST_DOUBT = 12.0
_ALIKE = 0.6  # correlation of the doubts about forces and torques
# Steps are damped as if g and L were known beforehand to this many times what the readings suggest.
_DAMPING = 10.0
_NEWTON_STEPS, _HALVINGS = 10, 5
_CONVERGED = 0.02  # of the likelihood (its logarithm), and of the noise


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


@dataclass(frozen=True, eq=False)
class Fits:
    """Fits of h hypotheses side by side."""

    R: NDArray[np.float64]  # (h, n, 3, 3) R_SW, as each hypothesis has it
    y: NDArray[np.float64]  # (h, n, 6) wrenches likewise, over the noise
    # (h, 6) the noise, N and N·m, with what the orientations' errors make of the weight
    sigmas: NDArray[np.float64]
    kept: NDArray[np.bool_]  # (h, n)
    x: NDArray[np.float64]  # (h, 6) g and L, N and m
    # (h, 2) logarithm of the factor on forces and torques: the density of what was *recorded* is wanted
    scale: NDArray[np.float64]
    u: NDArray[np.float64]  # (h, 2) logarithm of the noise's true size over `sigmas`, for forces and torques
    doubt: float  # Standard deviation of u beforehand; infinite for noise that is not known
    # (h, 6) information on x that is added to what the poses say, N^-2 and m^-2
    damping: NDArray[np.float64]
    least: NDArray[np.float64]  # (h, 2) lower bound of u

    def take(self, chosen: NDArray[np.bool_]) -> Fits:
        """Return some of the fits."""
        parts = {
            name: getattr(self, name)[chosen]
            for name in ("R", "y", "sigmas", "kept", "x", "scale", "u", "damping", "least")
        }
        return replace(self, **parts)

    def put(self, chosen: NDArray[np.bool_], others: Fits) -> Fits:
        """Return these fits, with the `chosen` ones taken from `others`, which has no more than those."""
        parts = {name: getattr(self, name).copy() for name in ("kept", "x", "u")}
        for name, array in parts.items():
            array[chosen] = getattr(others, name)
        return replace(self, **parts)

    @property
    def count(self) -> NDArray[np.float64]:
        """(h, 1) kept poses."""
        return np.asarray(self.kept.sum(axis=1, keepdims=True), dtype=np.float64)

    def centred(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Take the bias of the kept poses out of (h, n, ...) values."""
        flat = values.reshape(*self.kept.shape, -1)
        return np.asarray((flat - self.biases(flat)[:, None]).reshape(values.shape))

    def biases(self, flat: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the means (h, m) of (h, n, m) values over the kept poses."""
        return np.asarray(((self.kept / np.maximum(self.count, 1))[:, None] @ flat)[:, 0])

    @property
    def freedom(self) -> NDArray[np.float64]:
        """(h,) degrees of freedom of the forces, and of the torques."""
        return np.asarray(3.0 * self.kept.sum(axis=1) - 6, dtype=np.float64)

    def weights(self) -> NDArray[np.float64]:
        """(h, 1, 6) what residuals are to be multiplied by for unit variance."""
        return np.repeat(np.exp(-self.u), 3, axis=1)[:, None]

    def residuals(self) -> NDArray[np.float64]:
        """(h, n, 6) residuals over the noise."""
        g, L = self.x[:, None, :3, None], self.x[:, 3:]
        weight = (self.R @ g)[..., 0]
        torque = weight @ cross_matrix(L).swapaxes(1, 2)
        return self.centred(self.y - np.concatenate([weight, torque], axis=2) / self.sigmas[:, None])

    def jacobian(self) -> NDArray[np.float64]:
        """(h, n, 6, 6) change of the predictions with x, for unit variance, before the biases follow."""
        J = np.zeros((*self.kept.shape, 6, 6))
        L, weight = cross_matrix(self.x[:, 3:])[:, None], (self.R @ self.x[:, None, :3, None])[..., 0]
        J[..., :3, :3] = self.R
        J[..., 3:, :3] = L @ self.R
        J[..., 3:, 3:6] = -cross_matrix(weight)
        J *= (self.weights() / self.sigmas[:, None])[..., None]
        return J

    def information(self, J: NDArray[np.float64]) -> NDArray[np.float64]:
        """(h, 6, 6) what the kept poses say of x, from the jacobian; a little more, against 0 / 0."""
        width = J.shape[-1]
        rows = (J * self.kept[..., None, None]).reshape(len(J), -1, width)
        gone = (self.biases(J.reshape(*self.kept.shape, -1)) * np.sqrt(self.count)).reshape(len(J), -1, width)
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
    wrenches = np.array([hypothesis.wrenches(poses.wrenches) for hypothesis in hypotheses])
    size = np.sqrt(np.square(wrenches).reshape(h, n, 2, 3).mean(axis=(1, 3))) + 1e-9
    span = wrenches.reshape(h, n, 2, 3).std(axis=1).mean(axis=2) + _LEAST * size
    # In proportion to the readings: a change of units changes nothing else.
    wide = _DAMPING * np.stack([size[:, 0], size[:, 1] / span[:, 0]], axis=1)
    damping = np.repeat(wide, 3, axis=1) ** -2
    R = np.array([hypothesis.R_WS for hypothesis in hypotheses]).swapaxes(2, 3)
    unsteady = _unsteady(span, noise) if np.isfinite(noise.doubt) else np.zeros((h, 2))
    sigmas = np.hypot(noise.sigmas, np.repeat(unsteady, 3, axis=1))
    larger = np.log(sigmas / noise.sigmas).reshape(h, 2, 3).mean(axis=2)
    start = 0 if np.isfinite(noise.doubt) else np.log(span / sigmas[:, [0, 3]])
    return Fits(
        R=R,
        y=wrenches / sigmas[:, None],
        sigmas=sigmas,
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


def fit(fits: Fits) -> Fits:
    """Maximise the likelihood; from zeros the first step finds g from forces, the second L from torques."""
    todo = np.ones(len(fits.x), dtype=bool)
    for _ in range(_NEWTON_STEPS):
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


# ---- how well each way to read the poses explains what was recorded ------------------------------


_BUMPED = np.log(20.0)  # one pose in twenty is bumped
_ONE_BY_ONE = 40  # poses beyond this number are left out more than one at a time
# What trails the best by so much (a logarithm) is not tried again: bumps that are left out do not make up for it.
_HOPELESS = 60.0
_PATIENCE = 3  # steps that help no hypothesis
_FEWEST_LEFT = 4  # poses: three determine the parameters
# Minus the logarithm of a density proportional to 1/r³ over a thousandfold range of r, for three numbers.
_ANY_SIZE = float(np.log(4 * np.pi * np.log(1e3)) - 1.5 * np.log(2 * np.pi))
_EXCHANGES = 2
_WHOLE = 1.005 * np.eye(6)  # a pose that alone decides something has no residual there: 0 / 0


@dataclass(frozen=True, eq=False)
class Evidence:
    """What the poses say of one hypothesis."""

    log_likelihood: float  # Of the recorded numbers, up to a constant that all hypotheses share
    # each (3,): N and m, so read
    gravity_W: NDArray[np.float64]
    centre_of_mass_S: NDArray[np.float64]
    covariance: NDArray[np.float64]  # (6, 6) of both
    # (2,) sums of squared residuals of forces and torques over the kept poses, in units of the noise
    squares: NDArray[np.float64]
    freedom: NDArray[np.float64]  # (2,) their degrees of freedom
    # (2,) size of the noise, in the same unit, that explains the forces and the torques best
    noise: NDArray[np.float64]
    kept: NDArray[np.bool_]  # (n,) poses that were not taken for bumped
    excess: float  # What it costs in log_likelihood that the noise is larger than was given
    occam: float = 0.0  # Logarithm of how rare it is, where no preference says so


def weigh(hypotheses: Sequence[Hypothesis], poses: Stack, noise: HypothesisNoise) -> list[Evidence]:
    """Fit every hypothesis.

    Parameters
    ----------
    hypotheses : sequence of Hypothesis
    poses : Stack
        As declared, four or more.
    noise : HypothesisNoise
    """
    # Readings that only assume something else of the load have the data of the declared ones.
    own = [hypothesis for hypothesis in hypotheses if hypothesis.prior is None]
    found = dict(zip((each.key for each in own), _weigh(own, poses, noise), strict=True))
    return [found[each.key if each.prior is None else AS_DECLARED] for each in hypotheses]


def _weigh(hypotheses: Sequence[Hypothesis], poses: Stack, noise: HypothesisNoise) -> list[Evidence]:
    n = len(poses)
    at_once = -(-n // _ONE_BY_ONE)
    steps = min(n // 4, n - _FEWEST_LEFT) // at_once
    best = fit(begin(hypotheses, poses, noise))
    best_value, since = _log_likelihood(best), 0
    alive = best_value > best_value.max() - _HOPELESS
    fits = best.take(alive)
    for _ in range(steps):
        fits, value = _fewer(fits, at_once)
        better = alive.copy()
        better[alive] = value > best_value[alive]
        best = best.put(better, fits.take(better[alive]))
        best_value[alive] = np.maximum(value, best_value[alive])
        since = 0 if better.any() else since + 1
        if since == _PATIENCE:
            break
    return _evidence(best, best_value)


# ---- bumped poses ------------------------------------------------------------------------------


def _fewer(fits: Fits, count: int) -> tuple[Fits, NDArray[np.float64]]:
    """Leave out `count` more poses of each hypothesis, then exchange poses as long as that helps."""
    for _ in range(count):
        fits = replace(fits, kept=_exchange(fits, insert=False)[0])
    fits = fit(fits)
    value = _log_likelihood(fits)
    for _ in range(_EXCHANGES):
        kept, gain, possible = _exchange(fits, insert=True)
        tried = possible & (gain > 0)
        if not tried.any():
            break
        before = fits
        attempt = fit(replace(fits.take(tried), kept=kept[tried]))
        fits = fits.put(tried, attempt)
        there = _log_likelihood(fits)
        worse = there < value
        fits, value = fits.put(worse, before.take(worse)), np.maximum(there, value)
    return fits, value


def _exchange(
    fits: Fits, *, insert: bool
) -> tuple[NDArray[np.bool_], NDArray[np.float64], NDArray[np.bool_]]:
    """Drop the pose whose absence lowers the squares most; `insert` the dropped one that raises them least.

    Returns
    -------
    kept : (h, n) bool
    gain : (h,)
        By how much the squares fall, to first order.
    possible : (h,) bool
    """
    J, r = fits.jacobian(), (fits.residuals() * fits.weights())[..., None]
    inverse = np.linalg.inv(fits.information(J))[:, None]
    J = fits.centred(J)
    leverage = J @ inverse @ J.swapaxes(2, 3)
    leverage += (1 / np.maximum(fits.count, 1))[..., None, None] * np.eye(6)
    sign = np.where(fits.kept, -1.0, 1.0)[..., None, None]
    change = (r.swapaxes(2, 3) @ np.linalg.solve(_WHOLE + sign * leverage, r))[..., 0, 0]
    rows = np.arange(len(change))
    droppable = fits.kept & (fits.count > _FEWEST_LEFT)
    worst = np.argmax(np.where(droppable, change, -1.0), axis=1)
    possible: NDArray[np.bool_] = np.asarray(droppable.any(axis=1))
    gain = np.asarray(change[rows, worst], dtype=np.float64)
    kept = fits.kept.copy()
    if insert:
        nearest = np.argmin(np.where(fits.kept, np.inf, change), axis=1)
        possible = possible & ~fits.kept[rows, nearest]
        gain = gain - change[rows, nearest]
        kept[rows[possible], nearest[possible]] = True
    kept[rows[possible], worst[possible]] = False
    return kept, gain, possible


# ---- likelihood --------------------------------------------------------------------------------


def _log_likelihood(fits: Fits) -> NDArray[np.float64]:
    """Return the logarithm of the likelihood (h,) of what was recorded.

    Bumps may have any size, each order of magnitude being as probable as any other: what a pose
    that is left out costs grows with the logarithm of its residual.
    """
    d, u = fits.freedom[:, None], fits.u
    residuals = fits.residuals()
    kept = d * (fits.scale - u) - 0.5 * fits.squares(residuals) * np.exp(-2 * u)
    size = np.sqrt(np.square(residuals).reshape(*fits.kept.shape, 2, 3).sum(axis=3))
    # Minus the log density of three numbers of a length that may have any order of magnitude.
    longer = np.maximum(np.log(np.maximum(size, 1e-300)), u[:, None]) - fits.scale[:, None]
    bumps = (3 * longer + _ANY_SIZE).sum(axis=2) + _BUMPED
    value = kept.sum(axis=1) - (bumps * ~fits.kept).sum(axis=1) - joint_doubts(fits, u)
    return np.asarray(value, dtype=np.float64)


# ---- what comes out ----------------------------------------------------------------------------


def _evidence(fits: Fits, value: NDArray[np.float64]) -> list[Evidence]:
    squares = fits.squares(fits.residuals())
    covariance = np.asarray(np.linalg.inv(fits.information(fits.jacobian())), dtype=np.float64)
    excess = joint_doubts(fits, np.maximum(fits.u, 0))
    return [
        Evidence(
            log_likelihood=float(value[i]),
            gravity_W=fits.x[i, :3],
            centre_of_mass_S=fits.x[i, 3:],
            covariance=covariance[i],
            squares=squares[i],
            freedom=np.full(2, fits.freedom[i]),
            noise=np.exp(fits.u[i]),
            kept=fits.kept[i],
            excess=float(excess[i]),
        )
        for i in range(len(value))
    ]
