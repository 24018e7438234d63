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
from contactbench.pipeline.calibration.diagnosis.diagnose import FEWEST_POSES, MOST_POSES, diagnose
from contactbench.pipeline.calibration.diagnosis.explain import NONE
from contactbench.pipeline.calibration.diagnosis.hypothesis import AS_DECLARED
from contactbench.pipeline.calibration.diagnosis.prior import Prior
from contactbench.pipeline.calibration.model import PoseNoise, jacobian, nothing_beside, predict, whitener
from contactbench.pipeline.calibration.orientation import plain
from contactbench.pipeline.calibration.poses import named
from contactbench.pipeline.calibration.reml import NoisyFit, fit_with_noise, over_unknowns
from contactbench.pipeline.calibration.verdict import LARGEST_SHARE, deviates, find_bumped, limit, refit
from contactbench.pipeline.errors import arg, join, message

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.calibrate import Findings
    from contactbench.pipeline.calibration.diagnosis.diagnose import RawOrientations
    from contactbench.pipeline.calibration.model import Terms
    from contactbench.pipeline.calibration.poses import PoseSample, Stack
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


# ---- what is found behind the residuals, in words ------------------------------------------------


_TOLD = 0.01  # probability from which a cause is listed
_LIKELY = 0.95  # a mistake that overrules what the residuals say by themselves
_OFF = float(np.log(2.0))  # of the logarithm of a figure that is called wrong
_HOUR = 3600.0  # s


@dataclass(frozen=True)
class Cause:
    """What may be behind the residuals."""

    # plain, noise, drift, rezero, cable or mount; a convention that the diagnosis found; or none of those
    # known
    key: str
    odds: float  # Its probability among all causes that were compared, 0 to 1
    sentence: str  # What it would mean, with its size and the remedy
    believed: bool  # The evidence is strong: the calibration rests on it

    @property
    def diagnosed(self) -> bool:
        """Whether the diagnosis of conventions found it."""
        own = {PLAIN, NOISE, nuisance.DRIFT, nuisance.REZERO, nuisance.CABLE, nuisance.MOUNT}
        return self.key not in own


def causes(poses: Sequence[PoseSample], compared: CauseComparison, told: Candidate) -> tuple[Cause, ...]:
    """Return what the comparison found, the most probable first.

    Parameters
    ----------
    poses : sequence of PoseSample
    compared : CauseComparison
        Of the same.
    told : Candidate
        The cause that is believed; it is listed in any case.
    """
    shares: dict[str, float] = {}
    first: dict[str, Candidate] = {}
    for candidate, probability in zip(compared.candidates, compared.probabilities.tolist(), strict=True):
        key = _key(candidate)
        shares[key] = shares.get(key, 0.0) + probability
        first.setdefault(key, candidate)
    found = [
        Cause(key, min(share, 1.0), _sentence(first[key], poses, compared), key == _key(told))
        for key, share in shares.items()
        if share > _TOLD or key == _key(told)
    ]
    return tuple(sorted(found, key=lambda cause: -cause.odds))


def convention_cause(findings: Findings, prior: NoisePrior, raw: RawOrientations | None) -> Cause | None:
    """Return the mistaken convention that explains poses better than what they were said to be, if there is one.

    Parameters
    ----------
    findings : Findings
    prior : NoisePrior
        With the noise as it was given.
    raw : RawOrientations or None
        The numbers behind the orientations.
    """
    poses = findings.poses
    if not FEWEST_POSES <= len(poses) <= MOST_POSES:
        return None
    noise = None
    if prior.sigmas is not None:
        noise = PoseNoise(prior.sigmas[:3], prior.sigmas[3:], orientation=prior.orientation)
    known = Prior(down_W=(findings.down_W[0], findings.down_W[1], findings.down_W[2]))
    found = diagnose(poses, noise, prior=known, raw=raw)
    key = NONE if found.none_known else found.best.hypothesis
    told = {cause.key for cause in findings.causes if cause.believed}
    if found.consistent or key in {AS_DECLARED, *told} or (key == NONE and told - {PLAIN, NOISE}):
        return None
    odds = min(max(float(found.odds.get(key, 0.0)), 0.0), 1.0)
    return Cause(key, odds, found.sentence, odds >= _LIKELY)


def overruled(causes: tuple[Cause, ...], by: Cause) -> tuple[Cause, ...]:
    """Return causes with one more that speaks for the same residuals: what it leaves of them is theirs."""
    others = (
        replace(cause, odds=cause.odds * (1 - by.odds), believed=cause.believed and not by.believed)
        for cause in causes
    )
    return tuple(sorted((by, *others), key=lambda cause: -cause.odds))


def _key(candidate: Candidate) -> str:
    doubted = candidate.key == PLAIN and candidate.prior.sigmas is not None and not candidate.prior.believed
    return NOISE if doubted else candidate.key


def _sentence(candidate: Candidate, poses: Sequence[PoseSample], compared: CauseComparison) -> str:
    fit, arrays = candidate.noisy.fit, compared.poses
    match _key(candidate):
        case nuisance.DRIFT:
            return _drift(candidate, arrays)
        case nuisance.REZERO:
            return _rezero(candidate, poses, compared)
        case nuisance.CABLE:
            return message(
                f"A pull of up to {arg(_sizes(fit.offsets))} changes with the orientation, but not as a"
                " weight does: a cable or a hose, or a sensor whose axes differ in gain. Loosen"
                " the cables and hoses, fix them to the flange, and retake the poses."
            )
        case nuisance.MOUNT:
            turn = Rotation.from_matrix(fit.mount).as_rotvec()
            angle = float(np.linalg.norm(turn))
            axis = ", ".join(f"{value + 0.0:.1f}" for value in (turn / max(angle, 1e-12)).round(1))
            return message(
                f"The sensor seems to be turned by {arg(np.degrees(angle)):.2g}° about ({arg(axis)}) from"
                " its declared mounting: with that corrected, the force residuals fall from"
                f" {arg(plain(_left(compared.plain, arrays)))} to {arg(plain(_left(candidate, arrays)))} N."
                " Calibrate with --estimate-mount, or correct the mounting."
            )
        case "noise":
            given = candidate.prior.sigmas
            factors = (candidate.noisy.noise.sigmas / given)[[0, 3]] if given is not None else np.ones(2)
            scatter, said = candidate.noisy.noise.orientation, candidate.prior.orientation
            if said and not candidate.prior.guessed and abs(np.log(scatter / said)) > _OFF:
                return message(
                    f"The orientations scatter by {arg(np.degrees(scatter)):.2g}°, not by the specified"
                    f" {arg(np.degrees(said)):.2g}°. All uncertainties are computed from the scatter of"
                    " the poses."
                )
            return message(
                f"The residuals are {arg(plain(factors[0]))} times (forces) and {arg(plain(factors[1]))}"
                " times (torques) what the specified noise explains. All uncertainties are"
                " computed from the scatter of the poses."
            )
        case _:
            return message("Bias, weight and noise alone explain the poses.")


def _left(candidate: Candidate, arrays: Stack) -> float:
    """Return the root mean square of the forces' residuals, N."""
    left = candidate.noisy.fit.left(arrays, candidate.terms)
    return float(np.sqrt((left[:, :3] ** 2).sum(axis=1).mean()))


def _drift(candidate: Candidate, arrays: Stack) -> str:
    fit = candidate.noisy.fit
    whole = candidate.terms.columns[np.argmin(arrays.moments)] @ fit.added
    rate = ""
    if arrays.duration is not None:
        F, M = (np.linalg.norm(half) for half in np.split(fit.added[:6] * _HOUR / arrays.duration, 2))
        rate = message(
            f", {arg(plain(float(F)))} N and {arg(plain(1e3 * float(M)))} mN·m per hour at the end"
        )
    return message(
        f"The bias drifts by {arg(_sizes(whole[None]))} from the first pose to the last{arg(rate)}. The"
        " drift has been removed, and the bias is that at the end of the session. Let the sensor"
        " warm up, and recalibrate before you rely on it."
    )


def _rezero(candidate: Candidate, poses: Sequence[PoseSample], compared: CauseComparison) -> str:
    moments = {
        each.moment: probability
        for each, probability in zip(compared.candidates, compared.probabilities.tolist(), strict=True)
        if each.key == nuisance.REZERO
    }
    total = sum(moments.values())
    likely = [moment for moment, share in moments.items() if share > 0.1 * total] or [candidate.moment]
    names = join(" or ", (named(poses, _at(compared.poses, moment)) for moment in sorted(likely)))
    return message(
        f"The sensor's zero jumped by {arg(_sizes(candidate.noisy.fit.added[None]))} before {arg(names)}, as"
        " after a re-zero. The bias is that of the poses since then. Do not zero the sensor while"
        " taking poses."
    )


def _at(arrays: Stack, moment: float) -> int:
    later = np.where(arrays.moments >= moment, arrays.moments, np.inf)
    return int(np.argmin(later))


def _sizes(wrenches: NDArray[np.float64]) -> str:
    F = float(np.linalg.norm(wrenches[:, :3], axis=1).max())
    M = float(np.linalg.norm(wrenches[:, 3:], axis=1).max())
    return message(f"{arg(plain(F))} N and {arg(plain(1e3 * M))} mN·m")
