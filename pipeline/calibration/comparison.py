"""What explains the poses? Noise, bumped poses, drift, a re-zero, a cable, a turned mount: all compared at once.

Every cause is fitted with the noise and with the poses that it must leave out, and gets the logarithm of its
evidence: the likelihood of the readings over all that it leaves open. One with more unknowns explains more, and
pays for what it could have explained otherwise; so the simplest that explains the poses wins. Of causes that the
residuals do not speak for, a linear estimate of the evidence suffices.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from scipy.special import chdtrc, logsumexp

from contactbench.pipeline.calibration import nuisance
from contactbench.pipeline.calibration.diagnosis.hypothesis import AS_DECLARED
from contactbench.pipeline.calibration.model import Terms, jacobian, nothing_beside, predict, whitener
from contactbench.pipeline.calibration.nuisance import NOISE, PLAIN, WORDS, Beside
from contactbench.pipeline.calibration.orientation import plain
from contactbench.pipeline.calibration.poses import PoseSample, Stack, named
from contactbench.pipeline.calibration.reml import NoisePrior, NoisyFit, fit_with_noise, over_unknowns
from contactbench.pipeline.calibration.verdict import LARGEST_SHARE, deviates, find_bumped, limit, refit
from contactbench.pipeline.errors import arg, join, message

ONLY_BIAS = (PLAIN, nuisance.DRIFT, nuisance.REZERO)
POSSIBLE = 0.01  # probability from which a cause widens the uncertainty
_STRONG = 20.0  # odds from which a cause is believed that nobody has asked for
_EXPLAINED = 2.5  # times the noise given: what is left with a cause that explains the poses

_USUAL = 0.82  # share of benches without any cause
_BUMPED = 0.05  # share of poses
_WORTH = -3.0  # log odds against the plain model from which a cause is fitted for good
_FAR, _MOST_CAUSES = 15.0, 6  # log odds behind the best of them, and causes, that are fitted for good
_FEWEST_FREEDOM = 6  # degrees of freedom that a cause must leave
# A bump has any size, each order of magnitude of three as likely: the log density of three numbers, but for -3 log r.
_ANY_SIZE = -float(np.log(4 * np.pi * np.log(1e3)))
_ODD = 0.02  # chance of residuals as large or as small as these, from which the noise given is doubted
_PATIENCE = 2  # poses left out in vain
_MOSTLY = 0.8  # share of the pose before that no filter leaves


@dataclass(frozen=True, eq=False)
class Candidate:
    """One cause, fitted."""

    beside: Beside
    noisy: NoisyFit  # Of the poses that agree
    bumped: NDArray[np.bool_]  # (n,)
    prior: NoisePrior  # With which it was fitted
    log_odds: float  # Logarithm of prior times evidence, up to a constant that all causes share

    @property
    def key(self) -> str:
        """PLAIN, or one of `nuisance`'s."""
        return self.beside.key

    @property
    def terms(self) -> Terms:
        """Of all poses."""
        return self.beside.terms

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
        """Return that of a cause in all its variants, among them."""
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
    terms = nothing_beside(len(poses)) if mounted else nuisance.turned_mount(poses).terms
    base = Beside(PLAIN, _USUAL, terms)
    whole = fit_with_noise(poses, prior, terms)
    found = [_robust(poses, prior, base, whole)]
    if prior.sigmas is not None and (found[0].bumped.any() or _odd(whole)):
        found.append(_robust(poses, prior.doubted, base, fit_with_noise(poses, prior.doubted, terms)))
    found.sort(key=lambda candidate: -candidate.log_odds)
    start = nuisance.straight(poses, down_W) if mounted else None
    if start is not None:
        found += [
            _turned(poses, each, start) for each in {id(each.prior): each.prior for each in found}.values()
        ]
    for beside, inside in _worth(poses, found[0], down_W):
        candidate = _fitted(poses, prior, beside, inside)
        if beside.key == nuisance.FILTER and not 0 < candidate.noisy.fit.added[0] < _MOSTLY:
            continue  # it holds a part of the pose before: all of it are rows in another order
        found.append(candidate)
        if prior.sigmas is not None and (candidate.bumped.any() or _odd(candidate.noisy)):
            found.append(_fitted(poses, prior.doubted, beside, inside))
    found.sort(key=lambda candidate: -candidate.log_odds)
    odds = np.array([candidate.log_odds for candidate in found])
    return CauseComparison(poses, prior, down_W, tuple(found), np.exp(odds - logsumexp(odds)))


def _turned(poses: Stack, prior: NoisePrior, start: NDArray[np.float64]) -> Candidate:
    """Fit a turned mount, from a turn that is far from none."""
    there, beside = replace(poses, R_SW=start @ poses.R_SW), nuisance.turned_mount(poses)
    found = _robust(there, prior, beside, fit_with_noise(there, prior, beside.terms))
    fit = replace(found.noisy.fit, mount=found.noisy.fit.mount @ start)
    return replace(found, noisy=replace(found.noisy, fit=fit))


def _fitted(poses: Stack, prior: NoisePrior, beside: Beside, inside: NDArray[np.bool_]) -> Candidate:
    """Fit a cause to the poses inside, and let in whom they find plausible."""
    terms = beside.terms
    noisy = refit(poses, inside, prior, terms)
    while not inside.all():
        far = np.where(inside, np.inf, deviates(poses, inside, noisy, terms).max(axis=1))
        if far.min() >= limit(len(poses)):
            break
        inside = inside.copy()
        inside[np.argmin(far)] = True
        noisy = refit(poses, inside, prior, terms, noisy)
    return _candidate(poses, beside, noisy, ~inside, prior)


def _odd(whole: NoisyFit) -> bool:
    """Tell whether residuals are larger or smaller than the noise that was given makes them."""
    freedom = whole.fit.residuals.size - len(whole.fit.covariance)
    if freedom < 1:
        return False
    halves = (whole.fit.residuals.reshape(-1, 2, 3) ** 2).sum(axis=(0, 2))
    chance = np.append(chdtrc(freedom / 2, halves), chdtrc(freedom, whole.fit.cost))
    return bool((np.minimum(chance, 1 - chance) < _ODD / 2).any())


def _robust(poses: Stack, prior: NoisePrior, beside: Beside, whole: NoisyFit) -> Candidate:
    """Return the plain model with the poses left out that the largest agreeing set leaves out."""
    bumped, noisy = find_bumped(poses, prior, beside.terms, whole)
    if bumped.mean() > LARGEST_SHARE:
        noisy = whole  # nobody can say who is right: show them all
    return _candidate(poses, beside, noisy, bumped, prior)


def _candidate(
    poses: Stack, beside: Beside, noisy: NoisyFit, bumped: NDArray[np.bool_], prior: NoisePrior
) -> Candidate:
    """Weigh a fit together with the poses that it leaves out."""
    out, n = int(bumped.sum()), len(bumped)
    log_odds = np.log(beside.share) + beside.coincidence + noisy.log_evidence
    log_odds += out * np.log(_BUMPED) + (n - out) * np.log(1 - _BUMPED)
    if out and out < n and bumped.mean() <= LARGEST_SHARE:
        left = noisy.fit.left(poses.take(bumped), beside.terms.take(bumped))
        sizes = np.linalg.norm(left.reshape(-1, 2, 3), axis=2)
        least = noisy.noise.sigmas.reshape(2, 3).max(axis=1)
        log_odds += float((_ANY_SIZE - 3 * np.log(np.maximum(sizes, least))).sum())
    return Candidate(beside, noisy, bumped, prior, float(log_odds))


# ---- what is worth a fit -----------------------------------------------------------------------


def _worth(
    poses: Stack, best: Candidate, down_W: NDArray[np.float64]
) -> list[tuple[Beside, NDArray[np.bool_]]]:
    """Return the causes that the residuals may speak for, with the poses that agree."""
    turned = best.terms.turns
    causes = [
        replace(each, terms=replace(each.terms, turns=turned or each.terms.turns))
        for each in nuisance.beside(poses, down_W, best.noisy.fit.theta)
        if not (turned and each.key == nuisance.MOUNT)
    ]
    linear = _Linear(poses, best)
    plain = linear.value(best.inside, best.terms) + np.log(best.beside.share)
    # Of many moments for a re-zero, those that explain most with all poses.
    jumps = [each for each in causes if each.key == nuisance.REZERO]
    if len(jumps) > _MOST_CAUSES:
        jumps.sort(key=lambda each: -linear.value(np.ones(len(poses), dtype=bool), each.terms))
        causes = [each for each in causes if each.key != nuisance.REZERO or each in jumps[:_MOST_CAUSES]]
    found = []
    for each in causes:
        if 6 * len(poses) >= len(each.terms.scale) + _FEWEST_FREEDOM:
            value, inside = linear.greedy(each.terms)
            odds = value - plain + np.log(each.share) + each.coincidence
            found.append((odds, (each, inside)))
    top = max([0.0, *(odds for odds, _ in found)])
    worth = sorted((each for each in found if each[0] > max(_WORTH, top - _FAR)), key=lambda each: -each[0])
    return [each for _, each in worth[:_MOST_CAUSES]]


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

        turning = replace(nothing_beside(len(poses)), turns=True)
        self._J = self._W @ jacobian(self._R_SW, fit.theta, fit.free, turning)

    def value(self, inside: NDArray[np.bool_], terms: Terms) -> float:
        """Return the log evidence of terms with the poses inside, up to a constant."""
        return self._solved(inside, self._columns(terms))[0]

    def greedy(self, terms: Terms) -> tuple[float, NDArray[np.bool_]]:
        """Leave out pose after pose as long as the evidence grows; return it, and the poses inside (n,)."""
        columns = self._columns(terms)
        inside = np.ones(self._n, dtype=bool)
        value, left, C = self._solved(inside, columns)
        best, since = (value, inside), 0
        fewest = max(self._n - int(LARGEST_SHARE * self._n), -(-(len(terms.scale) + _FEWEST_FREEDOM) // 6))
        while inside.sum() > fewest and since < _PATIENCE:
            leverage = np.where(inside[:, None, None], columns @ C @ columns.swapaxes(1, 2), 0.0)
            pulled = np.linalg.solve(1.005 * np.eye(6) - leverage, left[..., None])[..., 0]
            far = (left * pulled).sum(axis=1)  # by how much the squares fall without each
            inside = inside.copy()
            inside[np.argmax(np.where(inside, far, -1.0))] = False
            value, left, C = self._solved(inside, columns)
            best, since = ((value, inside), 0) if value > best[0] else (best, since + 1)
        return best

    def _columns(self, terms: Terms) -> NDArray[np.float64]:
        """Return the whitened columns (n, 6, p) of all unknowns, per unit of their widths."""
        own = self._J if terms.turns else self._J[:, :, :12]
        columns: NDArray[np.float64] = np.concatenate([own, self._W @ terms.columns], axis=2) * terms.scale
        return columns

    def _solved(
        self, inside: NDArray[np.bool_], columns: NDArray[np.float64]
    ) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
        """Return the evidence, what is left of the readings (n, 6), and the covariance (p, p) of the unknowns."""
        A, r = columns[inside].reshape(-1, columns.shape[2]), self._r[inside].ravel()
        information = A.T @ A
        least = max(1.0, 1e-12 * float(information.max()))
        C = np.asarray(np.linalg.inv(information + least * np.eye(len(information))), dtype=np.float64)
        x = C @ (A.T @ r)
        left = self._r - columns @ x
        cost = float((left[inside] ** 2).sum())
        freedom = max(6.0 * inside.sum() - len(x), 1.0)
        value = -0.5 * cost
        if not self._known:  # the noise adapts itself to what is left
            value = -0.5 * freedom * (1 + np.log(max(cost / freedom, 1e-6)))
        own = information[:12, :12] + np.eye(12)
        value -= 0.5 * float(np.linalg.slogdet(own)[1])
        if len(x) > 12:
            across = information[12:, :12]
            value += over_unknowns(x[12:], information[12:, 12:] - across @ np.linalg.solve(own, across.T))
        out = ~inside
        if out.any():
            sizes = np.linalg.norm(
                (np.linalg.inv(self._W[out]) @ left[out][..., None]).reshape(-1, 2, 3), axis=2
            )
            value += float(self._out[out].sum() - 3 * np.log(np.maximum(sizes, self._sigmas)).sum())
        return float(value), left, C


# ---- what is found behind the residuals, in words ------------------------------------------------


_TOLD = 0.01  # probability from which a cause is listed
_ALIKE = float(np.exp(-2.0))  # share of a cause's probability from which another explains the poses as well
_OFF = float(np.log(2.0))  # of the logarithm of a figure that is called wrong
_HOUR = 3600.0  # s


@dataclass(frozen=True)
class Cause:
    """What may be behind the residuals."""

    # plain, noise or one of `nuisance`'s; a convention that the diagnosis found; or none of those known
    key: str
    odds: float  # Its probability among all causes that were compared, 0 to 1
    sentence: str  # What it would mean, with its size and the remedy
    believed: bool  # The evidence is strong: the calibration rests on it

    @property
    def diagnosed(self) -> bool:
        """Whether the diagnosis of conventions found it."""
        return self.key not in {PLAIN, NOISE, *WORDS}

    def covers(self, hypothesis: str) -> bool:
        """Tell whether it is this hypothesis of a diagnosis, in any variant."""
        return hypothesis == self.key or hypothesis.startswith(f"{self.key}_")


def joined(
    causes: tuple[Cause, ...], odds: Mapping[str, float], readings: Sequence[Cause]
) -> tuple[Cause, ...]:
    """Return causes with the odds that they have among all readings of the poses, and the readings that are likely.

    Parameters
    ----------
    causes : tuple of Cause
        Of the poses as declared.
    odds : mapping of str to float
        Of all, by their keys; a re-zero has one for each moment, a channel one for each.
    readings : sequence of Cause
        Other readings, with these odds.
    """
    own = {cause.key: sum((p for key, p in odds.items() if cause.covers(key)), 0.0) for cause in causes}
    # What is plain and what is noise of another size differ by nothing that a reading knows.
    declared = [cause for cause in causes if cause.key in {PLAIN, NOISE}]
    for cause in declared:
        own[cause.key] = odds[AS_DECLARED] * cause.odds / max(sum(each.odds for each in declared), 1e-300)
    # What is believed of the poses as declared is not, beside a reading that is likelier.
    likeliest = max((reading.odds for reading in readings), default=0.0)
    kept = (
        replace(cause, odds=own[cause.key], believed=cause.believed and own[cause.key] >= likeliest)
        for cause in causes
    )
    return tuple(sorted((*readings, *kept), key=lambda cause: -cause.odds))


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
        Cause(
            key,
            min(share, 1.0),
            _beside_rivals(key, _sentence(first[key], poses, compared), shares),
            key == _key(told),
        )
        for key, share in shares.items()
        if share > _TOLD or key == _key(told)
    ]
    return tuple(sorted(found, key=lambda cause: -cause.odds))


def _beside_rivals(key: str, sentence: str, shares: Mapping[str, float]) -> str:
    """Return a sentence with the causes that explain the poses as well, and what tells them apart."""
    rivals = [each for each in WORDS if each != key and shares.get(each, 0.0) > _ALIKE * shares[key]]
    if key not in WORDS or not rivals:
        return sentence
    titles, telling = join("; ", (WORDS[each].title for each in rivals)), WORDS[rivals[0]].telling
    return join(" ", (sentence, message(f"Cannot be distinguished from: {arg(titles)}. {arg(telling)}")))


def _key(candidate: Candidate) -> str:
    doubted = candidate.key == PLAIN and candidate.prior.sigmas is not None and not candidate.prior.believed
    return NOISE if doubted else candidate.key


def _sentence(candidate: Candidate, poses: Sequence[PoseSample], compared: CauseComparison) -> str:
    arrays = compared.poses
    match _key(candidate):
        case nuisance.DRIFT:
            return _drift(candidate, arrays)
        case nuisance.REZERO:
            return _rezero(candidate, poses, compared)
        case nuisance.NOISE:
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
        case nuisance.PLAIN:
            return message("Bias, weight and noise alone explain the poses.")
        case _:
            return _of_orientation(candidate, compared)


CHANNEL_NAMES = ("fx", "fy", "fz", "mx", "my", "mz")
_DEAD = 0.2  # share of a channel's weight: what responds less is dead


def _of_orientation(candidate: Candidate, compared: CauseComparison) -> str:
    """Say what follows the orientation, and what its correction does to forces and torques apart."""
    before, after = (_left(each, compared.poses) for each in (compared.plain, candidate))
    F, M = ([plain(1000**i * each[i]) for each in (before, after)] for i in range(2))
    changes = [message("rise") if after[i] > before[i] else message("fall") for i in range(2)]
    forces = message(f"the force residuals {arg(changes[0])} from {arg(F[0])} to {arg(F[1])} N")
    torques = message(f"the torque residuals {arg(changes[1])} from {arg(M[0])} to {arg(M[1])} mN·m")
    remedy = WORDS[candidate.key].remedy
    return message(
        f"{arg(fact(candidate))}. With that corrected, {arg(forces)} and {arg(torques)}. {arg(remedy)}"
    )


def fact(candidate: Candidate) -> str:
    """Say what a cause comes to, without a full stop."""
    fit = candidate.noisy.fit
    match candidate.key:
        case nuisance.MOUNT:
            turn = Rotation.from_matrix(fit.mount).as_rotvec()
            angle = float(np.linalg.norm(turn))
            axis = ", ".join(f"{value + 0.0:.1f}" for value in (turn / max(angle, 1e-12)).round(1))
            return message(
                f"The sensor seems to be turned by {arg(np.degrees(angle)):.2g}° about ({arg(axis)}) from its"
                " declared mounting"
            )
        case nuisance.CHANNEL:
            return _of_channel(candidate)
        case nuisance.CABLE:
            torque = 1e3 * float(np.linalg.norm(fit.offsets[:, 3:], axis=1).max())
            return message(f"A pull of up to {arg(plain(torque))} mN·m stays in the room: a cable or a hose")
        case nuisance.CLIPPED:
            return message(
                f"The channel {arg(CHANNEL_NAMES[candidate.beside.channel])} stands at its limit in several poses"
            )
        case nuisance.FILTER:
            return message(
                f"Each reading holds {arg(100 * fit.added[0]):.1f} % of the pose before: the sensor filters and"
                " has not settled, or a cable or hose drags"
            )
        case nuisance.DRIFT:
            return message("The sensor's zero drifts")
        case nuisance.REZERO:
            return message("The sensor was re-zeroed")
        case _:
            return message(
                f"Up to {arg(_sizes(fit.offsets))} changes with the orientation otherwise than a weight does:"
                " crosstalk or wrong gains of the sensor, or a cable that follows the wrist"
            )


def gain_error(candidate: Candidate) -> tuple[float, float]:
    """Return by what share of the weight a channel reads too much, and what it reads beside, as a share too."""
    k, fit = candidate.beside.channel, candidate.noisy.fit
    weight = predict(fit.R_SW, np.where(np.arange(12) % 6 < 3, fit.theta, 0.0))[:, k]
    size, added = float(weight @ weight), fit.offsets[:, k]
    gain = float(added @ weight) / max(size, 1e-300)
    return gain, float(np.sqrt(np.mean((added - gain * weight) ** 2) / max(size / len(weight), 1e-300)))


def _of_channel(candidate: Candidate) -> str:
    """Say what is wrong with a channel: it is dead, its gain is wrong, or it shows another."""
    (gain, beside), name = gain_error(candidate), CHANNEL_NAMES[candidate.beside.channel]
    if abs(1 + gain) < _DEAD and beside < _DEAD:
        return message(
            f"The channel {arg(name)} hardly responds ({arg(100 * (1 + gain)):.0f} % of its weight): it is dead"
        )
    if abs(gain) > beside:
        return message(f"The gain of the channel {arg(name)} is wrong by {arg(100 * gain):+.1f} %")
    return message(
        f"The channel {arg(name)} reads {arg(100 * beside):.1f} % of the weight beside its own: crosstalk"
    )


def _left(candidate: Candidate, arrays: Stack) -> NDArray[np.float64]:
    """Return the root mean square (2,) of the residuals of forces, N, and torques, N·m."""
    left = candidate.noisy.fit.left(arrays, candidate.terms).reshape(-1, 2, 3)
    return np.asarray(np.sqrt((left**2).sum(axis=2).mean(axis=0)))


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
        each.beside.moment: probability
        for each, probability in zip(compared.candidates, compared.probabilities.tolist(), strict=True)
        if each.key == nuisance.REZERO
    }
    total = sum(moments.values())
    likely = [moment for moment, share in moments.items() if share > 0.1 * total] or [candidate.beside.moment]
    names = join(" or ", (named(poses, compared.poses.first_from(moment)) for moment in sorted(likely)))
    return message(
        f"The sensor's zero jumped by {arg(_sizes(candidate.noisy.fit.added[None]))} before {arg(names)}, as"
        " after a re-zero. The bias is that of the poses since then. Do not zero the sensor while"
        " taking poses."
    )


def _sizes(wrenches: NDArray[np.float64]) -> str:
    F = float(np.linalg.norm(wrenches[:, :3], axis=1).max())
    M = float(np.linalg.norm(wrenches[:, 3:], axis=1).max())
    return message(f"{arg(plain(F))} N and {arg(plain(1e3 * M))} mN·m")
