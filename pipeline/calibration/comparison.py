"""What explains the poses? Noise, bumped poses, drift, a re-zero, a cable, a turned mount: all compared at once.

Every cause is fitted with the noise and with the poses that it must leave out, and gets the logarithm of its
evidence: the likelihood of the readings over all that it leaves open. One with more unknowns explains more, and
pays for what it could have explained otherwise; so the simplest that explains the poses wins. Of causes that the
residuals do not speak for, a linear estimate of the evidence suffices.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import chdtrc, logsumexp

from contactbench.pipeline.calibration import nuisance
from contactbench.pipeline.calibration.model import jacobian, nothing_beside, predict, whitener
from contactbench.pipeline.calibration.reml import NoisyFit, fit_with_noise, over_unknowns
from contactbench.pipeline.calibration.verdict import LARGEST_SHARE, deviates, find_bumped, limit, refit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.model import Terms
    from contactbench.pipeline.calibration.poses import Stack
    from contactbench.pipeline.calibration.reml import NoisePrior

PLAIN, NOISE = "plain", "noise"
ONLY_BIAS = (PLAIN, nuisance.DRIFT, nuisance.REZERO)
POSSIBLE = 0.01  # probability from which a cause widens the uncertainty
_STRONG = 20.0  # odds from which a cause is believed that nobody has asked for
_EXPLAINED = 2.5  # times the noise given: what is left with a cause that explains the poses

# How often each is met on a bench, as logarithms. A bend in the drift is one drift in three.
_COMMON = {
    nuisance.DRIFT: np.log(0.05),
    nuisance.REZERO: np.log(0.03),
    nuisance.CABLE: np.log(0.03),
    nuisance.MOUNT: np.log(0.03),
    PLAIN: np.log(0.86),
}
_BENT = np.log(1 / 3)
_BUMPED = 0.05  # share of poses
_WORTH = -3.0  # log odds against the plain model from which a cause is fitted for good
_FAR, _MOST = 15.0, 6  # log odds behind the best of them, and causes, that are fitted for good
_FEWEST_FREEDOM = 6  # degrees of freedom that a cause must leave
# A bump has any size, each order of magnitude of three as likely: the log density of three numbers, but for -3 log r.
_ANY_SIZE = -float(np.log(4 * np.pi * np.log(1e3)))
_ODD = 0.02  # chance of residuals as large or as small as these, from which the noise given is doubted
_PATIENCE = 2  # poses left out in vain


@dataclass(frozen=True, eq=False)
class Candidate:
    """One cause, fitted."""

    key: str  # PLAIN, or one of `nuisance`'s
    moment: float  # Of the re-zero; 0 for others
    noisy: NoisyFit  # Of the poses that agree
    bumped: NDArray[np.bool_]  # (n,)
    terms: Terms  # Of all poses
    prior: NoisePrior  # With which it was fitted
    log_odds: float  # Logarithm of prior times evidence, up to a constant that all causes share

    @property
    def agree(self) -> bool:
        """Whether a majority of the poses agrees."""
        return bool(self.bumped.mean() <= LARGEST_SHARE)

    @property
    def inside(self) -> NDArray[np.bool_]:
        """(n,) poses that are used: all, where nobody can say who is right."""
        return ~self.bumped if self.agree else np.ones(len(self.bumped), dtype=bool)


@dataclass(frozen=True, eq=False)
class CauseComparison:
    """All causes that were fitted, the most probable first."""

    poses: Stack
    prior: NoisePrior  # With the noise as it was given
    down_W: NDArray[np.float64]  # (3,) where gravity was said to point
    candidates: tuple[Candidate, ...]
    probabilities: NDArray[np.float64]  # (k,) of each, among them

    @property
    def best(self) -> Candidate:
        """The most probable."""
        return self.candidates[0]

    @property
    def plain(self) -> Candidate:
        """The likelier of those without a cause."""
        return next(each for each in self.candidates if each.key == PLAIN)

    def probability(self, key: str) -> float:
        """Return that of a cause in all its variants."""
        return float(
            sum(p for each, p in zip(self.candidates, self.probabilities, strict=True) if each.key == key)
        )

    def used(self) -> tuple[Candidate, Candidate]:
        """Return the cause that is told, and the fit that is used: an effect of the orientation cannot be taken out."""
        plain, best = self.plain, self.best
        if self.probability(best.key) < _STRONG * self.probability(PLAIN) or best.key == PLAIN:
            return plain, plain
        if best.key in ONLY_BIAS:
            left = 1.0
            if best.prior.sigmas is not None and not best.prior.believed:
                left = float((best.noisy.noise.sigmas / best.prior.sigmas).max())
            return (best, best) if left < _EXPLAINED else (plain, plain)
        doubted = plain.prior.doubted
        noisy = refit(self.poses, best.inside, doubted, plain.terms)
        return best, replace(plain, noisy=noisy, bumped=best.bumped, prior=doubted)

    def between(self, chosen: Candidate) -> NDArray[np.float64]:
        """Return the covariance that causes add which are not excluded, and say otherwise of the parameters.

        Of the twelve, and of the mount's rotation if that is unknown: (12, 12) or (15, 15).
        """
        size = 15 if chosen.terms.turns else 12
        fit, added = chosen.noisy.fit, np.zeros((size, size))
        for each, probability in zip(self.candidates, self.probabilities, strict=True):
            if each is not chosen and each.key in ONLY_BIAS and probability > POSSIBLE:
                other = each.noisy.fit
                turn = Rotation.from_matrix(other.mount @ fit.mount.T).as_rotvec()
                off = np.append(other.theta - fit.theta, turn)[:size]
                values, vectors = np.linalg.eigh(
                    other.covariance[:size, :size] - fit.covariance[:size, :size]
                )
                added += probability * (np.outer(off, off) + vectors * np.maximum(values, 0.0) @ vectors.T)
        return added


def compare(
    poses: Stack, prior: NoisePrior, down_W: NDArray[np.float64], *, mounted: bool = True
) -> CauseComparison:
    """Fit every cause that is worth it.

    Parameters
    ----------
    poses : Stack
    prior : NoisePrior
    down_W : (3,)
        Where gravity points.
    mounted : bool
        How the sensor sits on its mount is known; else its rotation is among the unknowns of every cause, and the
        poses' orientations are roughly the sensor's.
    """
    base = nothing_beside(len(poses)) if mounted else nuisance.mount(poses)
    whole = fit_with_noise(poses, prior, base)
    found = [_robust(poses, prior, base, whole)]
    if prior.sigmas is not None and (found[0].bumped.any() or _odd(whole)):
        doubted = fit_with_noise(poses, prior.doubted, base)
        found.append(_robust(poses, prior.doubted, base, doubted))
    found.sort(key=lambda candidate: -candidate.log_odds)
    best = found[0]
    for key, moment, terms, common, inside in _worth(poses, best, down_W):
        candidate = _fitted(poses, prior, key, moment, terms, common, inside)
        found.append(candidate)
        if prior.sigmas is not None and (candidate.bumped.any() or _odd(candidate.noisy)):
            found.append(_fitted(poses, prior.doubted, key, moment, terms, common, inside))
    found.sort(key=lambda candidate: -candidate.log_odds)
    odds = np.array([candidate.log_odds for candidate in found])
    return CauseComparison(poses, prior, down_W, tuple(found), np.exp(odds - logsumexp(odds)))


def _fitted(
    poses: Stack,
    prior: NoisePrior,
    key: str,
    moment: float,
    terms: Terms,
    common: float,
    inside: NDArray[np.bool_],
) -> Candidate:
    """Fit a cause to the poses inside, and let in whom they find plausible."""
    noisy = refit(poses, inside, prior, terms)
    while not inside.all():
        far = np.where(inside, np.inf, deviates(poses, inside, noisy, terms).max(axis=1))
        if far.min() >= limit(len(poses)):
            break
        inside = inside.copy()
        inside[np.argmin(far)] = True
        noisy = refit(poses, inside, prior, terms, noisy)
    return _candidate(poses, key, moment, noisy, ~inside, terms, prior, common)


def _odd(whole: NoisyFit) -> bool:
    """Tell whether residuals are larger or smaller than the noise that was given makes them."""
    freedom = whole.fit.residuals.size - len(whole.fit.covariance)
    if freedom < 1:
        return False
    chance = float(chdtrc(freedom, whole.fit.cost))
    return min(chance, 1 - chance) < _ODD


def _robust(poses: Stack, prior: NoisePrior, terms: Terms, whole: NoisyFit) -> Candidate:
    """Return the plain model with the poses left out that the largest agreeing set leaves out."""
    bumped, noisy = find_bumped(poses, prior, terms, whole)
    if bumped.mean() > LARGEST_SHARE:
        noisy = whole  # nobody can say who is right: show them all
    return _candidate(poses, PLAIN, 0.0, noisy, bumped, terms, prior)


def _candidate(
    poses: Stack,
    key: str,
    moment: float,
    noisy: NoisyFit,
    bumped: NDArray[np.bool_],
    terms: Terms,
    prior: NoisePrior,
    common: float = 0.0,
) -> Candidate:
    """Weigh a fit together with the poses that it leaves out."""
    out, n = int(bumped.sum()), len(bumped)
    log_odds = _COMMON[key] + common + noisy.log_evidence
    log_odds += out * np.log(_BUMPED) + (n - out) * np.log(1 - _BUMPED)
    if out and out < n and bumped.mean() <= LARGEST_SHARE:
        left = noisy.fit.left(poses.take(bumped), terms.take(bumped))
        sizes = np.linalg.norm(left.reshape(-1, 2, 3), axis=2)
        least = noisy.noise.sigmas.reshape(2, 3).max(axis=1)
        log_odds += float((_ANY_SIZE - 3 * np.log(np.maximum(sizes, least))).sum())
    return Candidate(key, moment, noisy, bumped, terms, prior, float(log_odds))


# ---- what is worth a fit -----------------------------------------------------------------------


def _worth(
    poses: Stack, best: Candidate, down_W: NDArray[np.float64]
) -> list[tuple[str, float, Terms, float, NDArray[np.bool_]]]:
    """Return key, moment, terms, log share and agreeing poses of the causes that the residuals may speak for."""
    moments = nuisance.rezero_moments(poses)
    causes: list[tuple[str, float, Terms, float]] = [
        (nuisance.DRIFT, 0.0, nuisance.drift(poses), float(np.log1p(-np.exp(_BENT)))),
        (nuisance.DRIFT, 0.0, nuisance.drift(poses, 2), float(_BENT)),
        (nuisance.CABLE, 0.0, nuisance.cable(poses, down_W), 0.0),
        (nuisance.MOUNT, 0.0, nuisance.mount(poses), 0.0),
    ]
    share = -float(np.log(max(len(moments), 1)))
    causes += [
        (nuisance.REZERO, moment, nuisance.rezero(poses, moment), share) for moment in moments.tolist()
    ]
    linear = _Linear(poses, best)
    plain = linear.value(best.inside, best.terms)
    found = []
    # Of many moments for a re-zero, those that explain most with all poses.
    if len(moments) > _MOST:
        values = [linear.value(np.ones(len(poses), dtype=bool), _with(each[2], best)) for each in causes[4:]]
        causes[4:] = [causes[4 + index] for index in np.argsort(values)[::-1][:_MOST].tolist()]
    for key, moment, alone, common in causes:
        terms = _with(alone, best)
        already = key == nuisance.MOUNT and best.terms.turns
        if not already and 6 * len(poses) >= len(terms.scale) + _FEWEST_FREEDOM:
            value, inside = linear.greedy(terms)
            odds = value - plain + _COMMON[key] - _COMMON[PLAIN] + common
            found.append((odds, (key, moment, terms, common, inside)))
    top = max([0.0, *(odds for odds, _ in found)])
    worth = sorted((each for each in found if each[0] > max(_WORTH, top - _FAR)), key=lambda each: -each[0])
    return [each for _, each in worth[:_MOST]]


def _with(terms: Terms, best: Candidate) -> Terms:
    """Return terms with the mount's rotation beside them, where that is unknown."""
    return replace(terms, turns=terms.turns or best.terms.turns)


class _Linear:
    """The evidence of terms about one fit: linear, with its noise, re-estimated only in size."""

    def __init__(self, poses: Stack, best: Candidate) -> None:
        fit = best.noisy.fit
        self._n, self._fit, self._R_SW = len(poses), fit, fit.mount @ poses.R_SW
        self._W = whitener(best.noisy.noise.covariances(self._R_SW, fit.theta))
        self._r = (self._W @ (poses.wrenches - predict(self._R_SW, fit.theta))[..., None])[..., 0]
        # Of six whitened numbers of any size, as `_candidate` weighs a pose that is left out.
        whitened = -np.log(self._W[:, range(6), range(6)]).sum(axis=1)
        self._out = 2 * _ANY_SIZE + 3 * np.log(2 * np.pi) + whitened + np.log(_BUMPED / (1 - _BUMPED))
        self._sigmas = best.noisy.noise.sigmas.reshape(2, 3).max(axis=1)
        self._known = best.prior.sigmas is not None and best.prior.believed

    def value(self, inside: NDArray[np.bool_], terms: Terms) -> float:
        """Return the log evidence of terms with the poses inside, up to a constant."""
        return self._solved(inside, self._columns(terms))[0]

    def greedy(self, terms: Terms) -> tuple[float, NDArray[np.bool_]]:
        """Leave out pose after pose as long as the evidence grows; return it, and the poses inside (n,)."""
        columns = self._columns(terms)
        inside = np.ones(self._n, dtype=bool)
        value, far = self._solved(inside, columns)
        best, since = (value, inside), 0
        fewest = max(self._n - int(LARGEST_SHARE * self._n), -(-(len(terms.scale) + _FEWEST_FREEDOM) // 6))
        while inside.sum() > fewest and since < _PATIENCE:
            inside = inside.copy()
            inside[np.argmax(np.where(inside, far, -1.0))] = False
            value, far = self._solved(inside, columns)
            best, since = ((value, inside), 0) if value > best[0] else (best, since + 1)
        return best

    def _columns(self, terms: Terms) -> NDArray[np.float64]:
        """Return the whitened columns (n, 6, p) of all unknowns, per unit of their widths."""
        J = jacobian(self._R_SW, self._fit.theta, self._fit.free, terms)
        columns: NDArray[np.float64] = self._W @ J * terms.scale
        return columns

    def _solved(
        self, inside: NDArray[np.bool_], columns: NDArray[np.float64]
    ) -> tuple[float, NDArray[np.float64]]:
        """Return the evidence, and by how much (n,) the squares fall without each pose."""
        A, r = columns[inside].reshape(-1, columns.shape[2]), self._r[inside].ravel()
        information = A.T @ A
        C = np.linalg.inv(information + max(1.0, 1e-12 * float(information.max())) * np.eye(len(information)))
        x = C @ (A.T @ r)
        left = self._r - columns @ x
        cost = float((left[inside] ** 2).sum())
        freedom = max(6.0 * inside.sum() - len(x), 1.0)
        value = -0.5 * cost
        if not self._known:  # the noise adapts itself to what is left
            value = -0.5 * freedom * (1 + np.log(max(cost / freedom, 1e-6)))
        own = information[:12, :12]
        value -= 0.5 * float(np.linalg.slogdet(own + np.eye(12))[1])
        if len(x) > 12:
            across = information[12:, :12]
            known = information[12:, 12:] - across @ np.linalg.solve(own + np.eye(12), across.T)
            value += over_unknowns(x[12:], known)
        out = ~inside
        if out.any():
            sizes = np.linalg.norm(
                (np.linalg.inv(self._W[out]) @ left[out][..., None]).reshape(-1, 2, 3), axis=2
            )
            value += float(self._out[out].sum() - 3 * np.log(np.maximum(sizes, self._sigmas)).sum())
        leverage = columns @ C @ columns.swapaxes(1, 2)
        solved = np.linalg.solve(
            1.005 * np.eye(6) - np.where(inside[:, None, None], leverage, 0.0), left[..., None]
        )
        return float(value), (left * solved[..., 0]).sum(axis=1)
