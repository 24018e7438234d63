"""Bumped poses: which they are, and why.

A pose that something touched can pull the parameters so far that a good pose looks worse than it. So when
a fit of all poses is not plausible, the largest set of poses that agree is grown from the inside: of many
fits of four poses, the one whose best majority agrees most; then pose after pose is let in as long as the
next nearest is plausible. Those that stay outside are named. What is let in counts in full: a loss function
that gives every pose a little less weight (Huber's) would cost five per cent of efficiency on clean data.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from math import comb
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import chdtrc, fdtrc, ndtri

from pipeline.calibration.fit import (
    Fit,
    PoseNoise,
    fit_with_unknown_noise,
    free_jacobian,
    maximise,
    predict,
    solve_with_offset,
    two_stage,
)
from pipeline.calibration.model import (
    CENTRE_OF_MASS,
    FORCE_BIAS,
    GRAVITY,
    TORQUE_BIAS,
    cross_matrix,
)
from pipeline.calibration.poses import named
from pipeline.calibration.wording import plain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from pipeline.calibration.poses import PoseSample, Stack

# One clean set in a hundred may lose a pose.
FALSE_ALARM = 0.01

# A majority must agree, whatever the rest do.
LARGEST_SHARE = 0.4

_START = 4  # poses: three determine the parameters, the fourth tells whether they agree
FEWEST = 5  # with fewer, leaving one out leaves nothing to check it with
_MOST_STARTS = 200  # one in eight is clean even when two poses in five are bumped
_REFINED = 10
# The variance of a residual, over the noise's, is 1 less the leverage. A pose that alone decides a direction has
# no residual there; the little more keeps 0 / 0 away, and costs the other poses a few thousandths.
_WHOLE = 1.005 * np.eye(3)
_MEDIAN = 2.366  # of the sum of three squared standard normal numbers
_TINY, _FAR = 1e-280, 35.0  # a probability that still has a deviate, and a deviate beyond all that have one


@dataclass(frozen=True)
class Rejection:
    """A pose that was left out.

    Attributes
    ----------
    index : int
        Into the poses that were given.
    name : str
    force_sigmas, torque_sigmas : float
        How far its force and torque are from what the other poses predict, as normal deviates: three numbers
        that are jointly as improbable as one number so many standard deviations off.
    reason : str
        In words.
    """

    index: int
    name: str
    force_sigmas: float
    torque_sigmas: float
    reason: str


def find_bumped(poses: Stack, noise: PoseNoise, far: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which poses (n,) disagree with the others; where most do, no majority agrees.

    Parameters
    ----------
    poses : Stack
    noise : PoseNoise
        When `estimated`, its size is taken anew from the poses that agree.
    far : (n, 2)
        `deviates` of a fit of all poses.
    """
    n = len(poses)
    agreeing = np.ones(n, dtype=bool)
    # Noise that is estimated with two bumped poses among few is so large that it hides both.
    plausible = not noise.estimated and bool((far < limit(n)).all())
    if n < FEWEST or plausible:
        return ~agreeing
    agreeing = _agreeing(poses, noise, _best_majority(poses, noise))
    while not agreeing.all():
        worst = _worst(poses, noise, agreeing)
        nearest = np.argmin(np.where(agreeing, np.inf, worst))
        if worst[nearest] >= limit(n):
            break
        agreeing[nearest] = True
    return ~agreeing


def _agreeing(poses: Stack, noise: PoseNoise, majority: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Leave out of a majority whoever does not agree: one was asked for, so one was found, but it may not be one."""
    n, agreeing = len(poses), majority.copy()
    while agreeing.sum() > _START:
        worst = np.where(agreeing, _worst(poses, noise, agreeing), 0.0)
        if worst.max() < limit(n):
            return agreeing
        agreeing[np.argmax(worst)] = False
    return agreeing


def _worst(poses: Stack, noise: PoseNoise, agreeing: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the larger deviate (n,) of each pose from a fit of the agreeing ones."""
    fit, noise = refit(poses, agreeing, noise)
    worst: NDArray[np.float64] = deviates(poses, agreeing, fit, noise).max(axis=1)
    return worst


def limit(n: int) -> float:
    """Return the deviate that the worst of `n` clean poses passes in one set of a hundred."""
    return float(-ndtri(FALSE_ALARM / (4 * n)))  # forces and torques, both sides


def deviates(poses: Stack, inside: NDArray[np.bool_], fit: Fit, noise: PoseNoise) -> NDArray[np.float64]:
    """Return how far each pose's force and torque are from what the poses inside the fit predict.

    Parameters
    ----------
    poses : Stack
    inside : (n,) bool
        The poses that `fit` was made from.
    fit : Fit
    noise : PoseNoise

    Returns
    -------
    (n, 2)
        Normal deviates: as improbable as one Gaussian number so many standard deviations off.
    """
    J, residuals = fit.J, fit.residuals
    if not inside.all():
        J = free_jacobian(poses.R_SW, fit.theta, noise.sigmas, fit.free)
        residuals = (poses.wrenches - predict(poses.R_SW, fit.theta)) / noise.sigmas
    # A pose that helped to make the fit is nearer to it than noise alone; any other is further away.
    sign = np.where(inside, -1.0, 1.0)[:, None, None]
    halves = J.reshape(-1, 2, 3, 12)
    covariance = _WHOLE + sign[..., None] * (halves @ fit.covariance @ halves.swapaxes(2, 3))
    covariance[~inside, 1] += _unpredicted(fit, noise) * np.eye(3)
    r = residuals.reshape(-1, 2, 3, 1)
    squares = np.maximum((r.swapaxes(2, 3) @ np.linalg.solve(covariance, r))[..., 0, 0], 0.0)
    return as_deviates(squares, inside, noise)


def _unpredicted(fit: Fit, noise: PoseNoise) -> float:
    """Return the variance of a new pose's torque, over the noise's, that the product of two errors makes.

    The Jacobian does not know it. Where g and L are both unknown, the first pose that shows them is no bump.
    """
    C = fit.covariance
    product = np.trace(C[GRAVITY, GRAVITY]) * np.trace(C[CENTRE_OF_MASS, CENTRE_OF_MASS])
    return float(product / np.min(noise.sigmas[3:]) ** 2)


def as_deviates(
    squares: NDArray[np.float64], inside: NDArray[np.bool_], noise: PoseNoise
) -> NDArray[np.float64]:
    """Turn sums of three squares into normal deviates of the same probability."""
    if noise.estimated:
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


def refit(poses: Stack, chosen: NDArray[np.bool_], noise: PoseNoise) -> tuple[Fit, PoseNoise]:
    """Fit the `chosen` poses; noise that is estimated is estimated from them."""
    inner = poses.take(chosen)
    if noise.estimated:
        return fit_with_unknown_noise(inner, noise.least, kept=float(chosen.mean()))
    return maximise(inner, noise.sigmas, two_stage(inner)), noise


# ---- the best majority -------------------------------------------------------------------------


def _best_majority(poses: Stack, noise: PoseNoise) -> NDArray[np.bool_]:
    """Return the poses (n,) of the smallest trimmed sum of squares (least trimmed squares)."""
    n = len(poses)
    majority = max(n - int(LARGEST_SHARE * n), _START)
    forces, torques = _square_residuals(poses, _fit_many(poses, _starts(n)))
    if noise.estimated:
        sF2, sM2 = (np.median(block, axis=1).min() / _MEDIAN for block in (forces, torques))
    else:
        sF2, sM2 = (float(np.mean(half**2)) for half in np.split(noise.sigmas, 2))
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
        both.append(f"force {force:.1f} sigma ({plain(size_F)} N) off")
    if torque >= limit(len(poses)):
        both.append(f"torque {torque:.1f} sigma ({plain(1e3 * size_M)} mN·m) off")
    what = " and ".join(both) or "least like the others"
    reason = f"{what} what the other poses predict: bumped, touched, or captured while moving."
    return Rejection(index, named(poses, index), force, torque, reason)
