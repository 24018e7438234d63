"""How well each way to read the poses explains what was recorded.

Each hypothesis gets the likelihood of the *recorded* numbers, so one that divides torques by 1000 must also say
why the recorded noise was 1000 times larger. Up to a quarter of the poses may be bumped, whatever the hypothesis;
each that is left out costs as much as a bump of its size is improbable.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.diagnosis.hypotheses import FEWEST_BESIDE
from contactbench.pipeline.calibration.diagnosis.hypothesis import AS_DECLARED
from contactbench.pipeline.calibration.diagnosis.side_by_side import (
    Fits,
    HypothesisNoise,
    begin,
    fit,
    joint_doubts,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.diagnosis.hypothesis import Hypothesis
    from contactbench.pipeline.calibration.poses import Stack

_BUMPED = np.log(20.0)  # one pose in twenty is bumped
_STEPS = 40  # poses beyond this number are left out more than one at a time
_FIRST_ROUNDS = 3
# What trails the best by so much (a logarithm) is not refined: bumps that are left out do not make up for it.
_HOPELESS = 60.0
_PATIENCE = 3  # steps that help no hypothesis
_FEWEST_LEFT = 4  # poses: three determine the parameters
# Minus the logarithm of a density proportional to 1/r³ over a thousandfold range of r, for three numbers.
_ANY_SIZE = float(np.log(4 * np.pi * np.log(1e3)) - 1.5 * np.log(2 * np.pi))
_LEAST_JUMP = 5.0  # standard deviations of the jump: smaller ones cost no less
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
    # (6,) what the bias gains from 0 to 1 of the hypothesis' course, N and N·m; 0 where it has none
    change: NDArray[np.float64]
    excess: float  # What it costs in log_likelihood that the noise is larger than was given
    R_WS: NDArray[np.float64]  # (n, 3, 3) orientations, with the turn that was found
    # Logarithm of how probable such a turn, to its uncertainty, was beforehand; 0 where there is none
    occam: float


def weigh(
    hypotheses: Sequence[Hypothesis],
    poses: Stack,
    noise: HypothesisNoise,
    progress: Callable[[int, int], None] | None = None,
) -> list[Evidence]:
    """Fit every hypothesis.

    Parameters
    ----------
    hypotheses : sequence of Hypothesis
    poses : Stack
        As declared, four or more.
    noise : HypothesisNoise
    progress : callable, optional
        Called with steps done and steps in all.
    """
    # Readings that only assume something else of the load have the data of the declared ones; those with a turn to
    # be found are few, and would slow down all others.
    own = [hypothesis for hypothesis in hypotheses if hypothesis.prior is None]
    turning, rest = ([each for each in own if any(each.free) is free] for free in (True, False))
    found = dict(zip((each.key for each in rest), _weigh(rest, poses, noise, progress), strict=True))
    found |= dict(zip((each.key for each in turning), _weigh(turning, poses, noise), strict=True))
    return [found[each.key if each.prior is None else AS_DECLARED] for each in hypotheses]


def _weigh(
    hypotheses: Sequence[Hypothesis],
    poses: Stack,
    noise: HypothesisNoise,
    progress: Callable[[int, int], None] | None = None,
) -> list[Evidence]:
    if not hypotheses:
        return []
    n = len(poses)
    at_once = -(-n // _STEPS)
    steps = min(n // 4, n - _FEWEST_LEFT) // at_once
    best = fit(begin(hypotheses, poses, noise), _FIRST_ROUNDS)
    best_value = _log_likelihood(best)
    alive = best_value > best_value.max() - 2 * _HOPELESS
    fits = fit(best.take(alive))
    best, best_value[alive] = best.put(alive, fits), _log_likelihood(fits)
    since = 0
    for step in range(steps):
        if progress is not None:
            progress(step + 1, steps + 1)
        still = best_value[alive] > best_value.max() - _HOPELESS
        alive[alive] = still
        fits, value = _fewer(fits.take(still), at_once)
        better = alive.copy()
        better[alive] = value > best_value[alive]
        best, best_value[alive] = (
            best.put(better, fits.take(better[alive])),
            np.maximum(value, best_value[alive]),
        )
        since = 0 if better.any() else since + 1
        if since == _PATIENCE:
            break
    if progress is not None:
        progress(steps + 1, steps + 1)
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
    leverage += fits.leverage()[..., None, None] * np.eye(6)
    sign = np.where(fits.kept, -1.0, 1.0)[..., None, None]
    change = (r.swapaxes(2, 3) @ np.linalg.solve(_WHOLE + sign * leverage, r))[..., 0, 0]
    rows = np.arange(len(change))
    spare = np.where((fits.course == 1).any(axis=1), FEWEST_BESIDE, _FEWEST_LEFT)[:, None]
    droppable = fits.kept & (fits.beside > spare)
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

    Bumps and jumps may have any size, each order of magnitude being as probable as any other: what a pose
    that is left out costs grows with the logarithm of its residual.
    """
    d, u = fits.freedom[:, None], fits.u
    residuals = fits.residuals()
    kept = d * (fits.scale - u) - 0.5 * fits.squares(residuals) * np.exp(-2 * u)
    size = np.sqrt(np.square(residuals).reshape(*fits.kept.shape, 2, 3).sum(axis=3))
    bumps = _free_size(size, u[:, None], fits.scale[:, None]).sum(axis=2) + _BUMPED
    value = kept.sum(axis=1) - (bumps * ~fits.kept).sum(axis=1) - joint_doubts(fits, u)
    changed = fits.changes
    if changed.any():
        value[changed] -= _change_cost(fits.take(changed))
    return np.asarray(value, dtype=np.float64)


def _free_size(
    size: NDArray[np.float64], u: NDArray[np.float64], scale: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return minus the log density of three numbers of a length that may have any order of magnitude."""
    return np.asarray(3 * (np.maximum(np.log(np.maximum(size, 1e-300)), u) - scale) + _ANY_SIZE)


def _change_cost(fits: Fits) -> NDArray[np.float64]:
    """Return what changes of the bias (h,) cost, marginalised: their variance is the noise's over `pull`."""
    slope = fits.biases(fits.raw_residuals())[1]
    change, pull = np.linalg.norm(slope.reshape(-1, 2, 3), axis=2), np.log(fits.pull())
    cost = _free_size(change, fits.u + np.log(_LEAST_JUMP) - pull / 2, fits.scale) + 1.5 * pull
    return np.asarray(cost.sum(axis=1), dtype=np.float64)


# ---- what comes out ----------------------------------------------------------------------------


def _evidence(fits: Fits, value: NDArray[np.float64]) -> list[Evidence]:
    squares = fits.squares(fits.residuals())
    covariance = np.asarray(np.linalg.inv(fits.information(fits.jacobian())), dtype=np.float64)
    change = fits.biases(fits.raw_residuals())[1] * fits.sigmas
    excess = joint_doubts(fits, np.maximum(fits.u, 0))
    return [
        Evidence(
            log_likelihood=float(value[i]),
            gravity_W=fits.x[i, :3],
            centre_of_mass_S=fits.x[i, 3:],
            covariance=covariance[i, :6, :6],
            squares=squares[i],
            freedom=np.full(2, fits.freedom[i]),
            noise=np.exp(fits.u[i]),
            kept=fits.kept[i],
            change=change[i],
            excess=float(excess[i]),
            R_WS=fits.R[i].swapaxes(1, 2),
            occam=_occam(covariance[i, 6:, 6:], fits.free[i]),
        )
        for i in range(len(value))
    ]


def _occam(covariance: NDArray[np.float64], free: NDArray[np.bool_]) -> float:
    """Return the logarithm of the share of all turns about the free axes that the poses leave open (Laplace)."""
    if not free.any():
        return 0.0
    left_open = covariance[np.ix_(free, free)]
    every = 2 * np.pi if free.sum() == 1 else 8 * np.pi**2
    volume = 0.5 * np.linalg.slogdet(2 * np.pi * left_open)[1] - np.log(every)
    return min(float(volume), 0.0)
