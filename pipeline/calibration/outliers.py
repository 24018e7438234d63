"""Bumped poses: which they are, and why.

A pose that something touched can pull the parameters so far that a good pose looks worse than it. So when
a fit of all poses is not plausible, the largest set of poses that agree is grown from the inside: of many
fits of four poses, the one whose best majority agrees most; then pose after pose is let in as long as the
next nearest is plausible. Those that stay outside are named. What is let in counts in full: a loss function
that gives every pose a little less weight (Huber's) would cost five per cent of efficiency on clean data.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from math import comb
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import chdtrc, fdtrc, ndtri

from contactbench.pipeline.calibration.fit import jacobian, solve_with_offset, whitener
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    FORCE_BIAS,
    GRAVITY,
    TORQUE_BIAS,
    cross_matrix,
)
from contactbench.pipeline.calibration.number_text import plain
from contactbench.pipeline.calibration.poses import named
from contactbench.pipeline.calibration.reml import fit_with_noise
from contactbench.pipeline.errors import arg, join, message

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.fit import Fit, PoseNoise, Terms
    from contactbench.pipeline.calibration.poses import PoseSample, Stack
    from contactbench.pipeline.calibration.reml import NoisePrior, NoisyFit

# One clean set in a hundred may lose a pose.
FALSE_ALARM = 0.01

# A majority must agree, whatever the rest do.
LARGEST_SHARE = 0.4

_START = 4  # poses: three determine the parameters, the fourth tells whether they agree
FEWEST = 5  # with fewer, leaving one out leaves nothing to check it with
_MOST_STARTS = 200  # one in eight is clean even when two poses in five are bumped
_REFINED = 10
_AT_ONCE = 30  # of so many poses one is let in at a time
# The variance of a residual, over the noise's, is 1 less the leverage. A pose that alone decides a direction has
# no residual there; the little more keeps 0 / 0 away, and costs the other poses a few thousandths.
_WHOLE = 1.005
_MEDIAN = 2.366  # of the sum of three squared standard normal numbers
_TINY, _FAR = 1e-280, 35.0  # a probability that still has a deviate, and a deviate beyond all that have one


@dataclass(frozen=True)
class Rejection:
    """A pose that was left out."""

    index: int  # Into the poses that were given
    name: str
    # How far its force and torque are from what the other poses predict, as normal deviates: three numbers
    # that are jointly as improbable as one number so many standard deviations off
    force_sigmas: float
    torque_sigmas: float
    reason: str  # In words


def find_bumped(
    poses: Stack, prior: NoisePrior, terms: Terms, whole: NoisyFit
) -> tuple[NDArray[np.bool_], NoisyFit]:
    """Return which poses (n,) disagree with the others, and the fit of those; where most do, no majority agrees.

    Parameters
    ----------
    poses : Stack
    prior : NoisePrior
        Noise that is not known is taken anew from the poses that agree.
    terms : Terms
        What else may be in the readings.
    whole : NoisyFit
        Of all poses.
    """
    n, everybody = len(poses), np.ones(len(poses), dtype=bool)
    # Noise that is estimated with two bumped poses among few is so large that it hides both.
    known = prior.sigmas is not None and prior.believed
    if n < FEWEST or (known and (deviates(poses, everybody, whole, terms) < limit(n)).all()):
        return ~everybody, whole
    agreeing, noisy = _agreeing(poses, prior, terms, _best_majority(poses, prior, terms, whole))
    while not agreeing.all():
        worst = np.where(agreeing, np.inf, deviates(poses, agreeing, noisy, terms).max(axis=1))
        nearest = np.argsort(worst)[: -(-n // _AT_ONCE)]
        if worst[nearest[0]] >= limit(n):
            break
        agreeing[nearest[worst[nearest] < limit(n)]] = True
        noisy = refit(poses, agreeing, prior, terms, noisy)
    return ~agreeing, noisy


def _agreeing(
    poses: Stack, prior: NoisePrior, terms: Terms, majority: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], NoisyFit]:
    """Leave out of a majority whoever does not agree: one was asked for, so one was found, but it may not be one."""
    n, agreeing = len(poses), majority.copy()
    noisy = refit(poses, agreeing, prior, terms)
    while agreeing.sum() > _START:
        worst = np.where(agreeing, deviates(poses, agreeing, noisy, terms).max(axis=1), 0.0)
        if worst.max() < limit(n):
            break
        agreeing[np.argmax(worst)] = False
        noisy = refit(poses, agreeing, prior, terms)
    return agreeing, noisy


def limit(n: int) -> float:
    """Return the deviate that the worst of `n` clean poses passes in one set of a hundred."""
    return float(-ndtri(FALSE_ALARM / (4 * n)))  # forces and torques, both sides


def deviates(poses: Stack, inside: NDArray[np.bool_], noisy: NoisyFit, terms: Terms) -> NDArray[np.float64]:
    """Return how far each pose's force and torque are from what the poses inside the fit predict.

    Parameters
    ----------
    poses : Stack
    inside : (n,) bool
        The poses that the fit was made from.
    noisy : NoisyFit
    terms : Terms
        Of all poses.

    Returns
    -------
    (n, 2)
        Normal deviates: as improbable as one Gaussian number so many standard deviations off.
    """
    fit = noisy.fit
    R_SW = fit.mount @ poses.R_SW
    J = jacobian(R_SW, fit.theta, fit.free, terms)
    residuals = fit.left(poses, terms)
    V = noisy.noise.covariances(R_SW, fit.theta)
    # A pose that helped to make the fit is nearer to it than noise alone; any other is further away.
    sign = np.where(inside, -1.0, 1.0)[:, None, None]
    fitted = sign * (J @ fit.covariance @ J.swapaxes(1, 2))
    fitted[~inside, 3:, 3:] += _unpredicted(fit) * np.eye(3)
    squares = np.stack(
        [
            _squares(V[:, half, half], fitted[:, half, half], residuals[:, half])
            for half in (slice(0, 3), slice(3, 6))
        ],
        axis=1,
    )
    return as_deviates(squares, inside, noisy.noise)


def _squares(
    V: NDArray[np.float64], fitted: NDArray[np.float64], r: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return r' inv(V + fitted) r (n,), where `fitted` takes away no more than V has."""
    W = whitener(V)
    values, axes = np.linalg.eigh(W @ fitted @ W.swapaxes(1, 2))
    z = (axes.swapaxes(1, 2) @ W @ r[..., None])[..., 0]
    return np.asarray((z**2 / (_WHOLE + np.maximum(values, -1.0))).sum(axis=1), dtype=np.float64)


def _unpredicted(fit: Fit) -> float:
    """Return the variance of a new pose's torque, (N·m)², that the product of two errors makes.

    The Jacobian does not know it. Where g and L are both unknown, the first pose that shows them is no bump.
    """
    C = fit.covariance
    return float(np.trace(C[GRAVITY, GRAVITY]) * np.trace(C[CENTRE_OF_MASS, CENTRE_OF_MASS]))


def as_deviates(
    squares: NDArray[np.float64], inside: NDArray[np.bool_], noise: PoseNoise
) -> NDArray[np.float64]:
    """Turn sums of three squares into normal deviates of the same probability."""
    if np.isfinite(noise.freedom).all():
        freedom = np.broadcast_to(np.array(noise.freedom), squares.shape)
        # Without the pose itself, whose own residual would make the noise look large.
        rest = np.where(inside[:, None], np.maximum(freedom - 3, 1.0), freedom)
        without = np.maximum(freedom - squares, 1e-9 * freedom)
        squares = np.where(inside[:, None], squares * rest / without, squares)
        probability = fdtrc(3, rest, squares / 3)
    else:
        probability = chdtrc(3, squares)
    plain = np.sqrt(squares)
    return np.where(probability > _TINY, -ndtri(np.maximum(probability, _TINY) / 2), np.maximum(plain, _FAR))


def refit(
    poses: Stack,
    chosen: NDArray[np.bool_],
    prior: NoisePrior,
    terms: Terms,
    start: NoisyFit | None = None,
) -> NoisyFit:
    """Fit the `chosen` poses, with the noise that they show."""
    return fit_with_noise(
        poses.take(chosen), prior, terms.take(chosen), start=start, kept=float(chosen.mean())
    )


# ---- the best majority -------------------------------------------------------------------------


def _best_majority(poses: Stack, prior: NoisePrior, terms: Terms, whole: NoisyFit) -> NDArray[np.bool_]:
    """Return the poses (n,) of the smallest trimmed sum of squares (least trimmed squares).

    What the terms add is taken as all poses have it, for four poses say too little of it.
    """
    n = len(poses)
    majority = max(n - int(LARGEST_SHARE * n), _START)
    poses = replace(
        poses, R_SW=whole.fit.mount @ poses.R_SW, wrenches=poses.wrenches - terms.columns @ whole.fit.added
    )
    forces, torques = _square_residuals(poses, _fit_many(poses, _starts(n)))
    if prior.sigmas is None:
        sF2, sM2 = (np.median(block, axis=1).min() / _MEDIAN for block in (forces, torques))
    else:
        sF2, sM2 = (float(np.mean(half**2)) for half in np.split(prior.sigmas, 2))
    sF2, sM2 = max(sF2, 1e-24), max(sM2, 1e-24)
    squares = forces / sF2 + torques / sM2
    for _ in range(2):  # concentration: fit the majority, see who the majority is now
        nearest = np.argsort(squares, axis=1)[:, :majority]
        trimmed = np.take_along_axis(squares, nearest, axis=1).sum(axis=1)
        best = nearest[np.argsort(trimmed)[:_REFINED]]
        forces, torques = _square_residuals(poses, _fit_many(poses, best))
        squares = forces / sF2 + torques / sM2
    nearest = np.argsort(squares, axis=1)[:, :majority]
    trimmed = np.take_along_axis(squares, nearest, axis=1).sum(axis=1)
    agreeing = np.zeros(n, dtype=bool)
    agreeing[nearest[np.argmin(trimmed)]] = True
    return agreeing


def _starts(n: int) -> NDArray[np.intp]:
    """Return sets of four poses (k, 4): all there are, or many by chance (always the same)."""
    if comb(n, _START) <= _MOST_STARTS:
        return np.array(list(combinations(range(n), _START)))
    rng = np.random.default_rng(0)
    return rng.random((_MOST_STARTS, n)).argpartition(_START, axis=1)[:, :_START]


def _fit_many(poses: Stack, sets: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return the two-stage parameters (k, 12) of each set of poses (k, m)."""
    R, F, M = poses.R_SW[sets], poses.F[sets], poses.M[sets]
    g, F0 = solve_with_offset(R, F)
    weight = (R @ g[:, None, :, None])[..., 0]
    L, M0 = solve_with_offset(-cross_matrix(weight), M)
    return np.concatenate([g, F0, L, M0], axis=1)


def _square_residuals(
    poses: Stack, thetas: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return |F - predicted|² and |M - predicted|² (k, n) of every pose under every set of parameters."""
    weight = np.einsum("nij,kj->kni", poses.R_SW, thetas[:, GRAVITY])
    torque = np.cross(thetas[:, None, CENTRE_OF_MASS], weight)
    forces = poses.F - weight - thetas[:, None, FORCE_BIAS]
    torques = poses.M - torque - thetas[:, None, TORQUE_BIAS]
    return (forces**2).sum(axis=2), (torques**2).sum(axis=2)


def rejection(
    poses: Sequence[PoseSample], index: int, far: NDArray[np.float64], residual: NDArray[np.float64]
) -> Rejection:
    """Say why a pose is left out.

    Parameters
    ----------
    poses : sequence of PoseSample
    index : int
        Of the pose.
    far : (2,)
        Deviates of its force and torque.
    residual : (6,)
        Read minus predicted, N and N·m.
    """
    force, torque = float(far[0]), float(far[1])
    size_F, size_M = float(np.linalg.norm(residual[:3])), float(np.linalg.norm(residual[3:]))
    both = []
    if force >= limit(len(poses)):
        both.append(message(f"force {arg(force):.1f} sigma ({arg(plain(size_F))} N) off"))
    if torque >= limit(len(poses)):
        both.append(message(f"torque {arg(torque):.1f} sigma ({arg(plain(1e3 * size_M))} mN·m) off"))
    what = join(message(" and "), both) or message("least like the others")
    reason = message(
        f"{arg(what)} from the prediction of the other poses: bumped, touched, or captured while moving."
    )
    return Rejection(index, named(poses, index), force, torque, reason)
