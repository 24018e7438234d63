"""Good, usable, or to be refused: the rule, and the words.

Bumped poses: which they are, and why.

A pose that something touched can pull the parameters so far that a good pose looks worse than it. So when
a fit of all poses is not plausible, the largest set of poses that agree is grown from the inside: of many
fits of four poses, the one whose best majority agrees most; then pose after pose is let in as long as the
next nearest is plausible. Those that stay outside are named. What is let in counts in full: a loss function
that gives every pose a little less weight (Huber's) would cost five per cent of efficiency on clean data.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import combinations
from math import comb
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import chdtrc, fdtrc, ndtri

from contactbench.pipeline.calibration.diagnosis.hypotheses import units
from contactbench.pipeline.calibration.diagnosis.prior import Prior, quiet
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    FORCE_BIAS,
    GRAVITY,
    STANDARD_GRAVITY,
    TORQUE_BIAS,
    Fit,
    PoseNoise,
    Terms,
    cross_matrix,
    jacobian,
    solve_with_offset,
    whitener,
)
from contactbench.pipeline.calibration.nuisance import NOISE, PLAIN
from contactbench.pipeline.calibration.orientation import plain
from contactbench.pipeline.calibration.poses import PoseSample, Stack, named, stack
from contactbench.pipeline.calibration.reml import NoisePrior, NoisyFit, fit_with_noise
from contactbench.pipeline.errors import DIAGNOSE, InputError, arg, join, message

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.calibrate import Findings
    from contactbench.pipeline.calibration.comparison import Cause

_CHECKED_FROM = 5  # poses: with fewer, none of them can be checked against the others
_RESTLESS = 50.0  # drift and hum make a mean several times worse than its samples promise, but not this much
_WORTH_A_WORD = 0.2  # probability from which a cause that is not believed is told
_LEVEL, _SURELY = 1.0, 4.0  # degrees to which bases are level, and standard deviations
_ABSURD = 5.0  # times the noise given: no wrong figure, but something that nobody knows
_HARDLY = 1.3  # times the noise given: nobody knows it better
_LEAN = np.radians(60.0)  # bases are mounted in multiples of 90 degrees
# m: a centre of mass is nearer than this, or than so many times the tip; on the tip's side; not at the origin; and
# what lies further away than the last is refused
_LONG, _REACH, _BEHIND, _NEAREST_M, _NO_TOOL = 0.2, 1.5, 0.01, 0.001, 0.5
_NOT_EXCLUDED = 0.005  # probability of other units that keeps a verdict from being good
_NAMED_FROM = 8  # poses: with fewer, leaving some out leaves little to be sure that it was the right ones


class Level(StrEnum):
    """How far a calibration can be trusted."""

    GOOD = "good"
    USABLE = "usable"
    REFUSE = "refuse"


@dataclass(frozen=True)
class Limits:
    """The rule behind the verdict.

    Attributes
    ----------
    good_error, usable_error : float
        Largest share of the calibration in the contact error, worst 1 sigma over the task, m. For comparison:
        noise of 0.05 N and 1.4 mN·m in the live wrench alone makes 0.5 mm on each axis at 10 N.
    """

    good_error: float = 0.0005
    usable_error: float = 0.0015

    def __post_init__(self) -> None:
        if not 0 < self.good_error <= self.usable_error < np.inf:
            raise InputError(
                f"Limits: give 0 < good_error <= usable_error, m, not {arg(self.good_error)} and"
                f" {arg(self.usable_error)}"
            )


@dataclass(frozen=True)
class Verdict:
    """What to think of a calibration.

    Attributes
    ----------
    level : Level
    reasons : tuple of str
        Why it is not better, what weighs most first; for a good one, what makes it good.
    """

    level: Level
    reasons: tuple[str, ...]


def judge(findings: Findings, agree: bool, limits: Limits) -> Verdict:
    """Apply the rule.

    Refuse when the poses contradict one another, leave something undetermined that contact needs, say that
    gravity points up, or leave more than ``usable_error``. Usable when there is more than ``good_error``, or
    something that a technician should know. Good otherwise.

    Parameters
    ----------
    findings : Findings
    agree : bool
        Whether a majority of the poses agrees.
    limits : Limits
    """
    error = message(
        f"The calibration adds up to {arg(plain(1e3 * findings.contact_error))} mm (1 sigma) to a contact point"
    )
    grave = [*_grave(findings, agree)] or _too_unsure(findings, limits, error)
    doubts = [
        cause.sentence
        for cause in findings.causes
        if cause.diagnosed and not cause.believed and cause.odds > _WORTH_A_WORD
    ]
    if grave or any(cause.diagnosed and cause.believed for cause in findings.causes):
        return Verdict(Level.REFUSE, (*_found(findings), *doubts, *grave))
    slight = [*_slight(findings, limits, error)] or _other_units(findings)
    if slight or doubts:
        return Verdict(Level.USABLE, (*slight, *_possible(findings)))
    good = message(
        f"{arg(error)}; the limit for good is {arg(1e3 * limits.good_error):g} mm. No action needed."
    )
    return Verdict(Level.GOOD, (good, *_possible(findings)))


def _found(findings: Findings) -> list[str]:
    """Return the cause that is believed, beside plain noise and noise that is less than was given."""
    return [
        cause.sentence
        for cause in findings.causes
        if cause.believed and cause.key != PLAIN and not _harmless(findings, cause)
    ]


def _harmless(findings: Findings, cause: Cause) -> bool:
    """Tell whether a figure was given that is merely careful: the noise is less, or hardly more."""
    return cause.key == NOISE and max(findings.noise_factor) < _HARDLY


def _possible(findings: Findings) -> Iterator[str]:
    """Yield causes that the evidence is too weak for, as what they are."""
    for cause in findings.causes:
        if cause.believed or cause.key == PLAIN or cause.odds <= _WORTH_A_WORD:
            continue
        if cause.diagnosed:  # says itself how probable it is
            yield cause.sentence
            continue
        yield message(f"Possible, with a probability of {arg(100 * cause.odds):.0f} %: {arg(cause.sentence)}")
    yield from (cause.sentence for cause in findings.causes if cause.believed and _harmless(findings, cause))
    yield from _tilted(findings)


def _tilted(findings: Findings) -> Iterator[str]:
    """Say that gravity surely points aside: the sensor cannot tell a tilted base from a pull that never changes."""
    g, C, down = findings.gravity_W, findings.covariance[:3, :3], findings.down_W
    aside = g - (g @ down) * down
    size = float(np.linalg.norm(aside))
    angle = float(np.degrees(np.arctan2(size, g @ down)))
    sigma = float(np.sqrt(aside @ C @ aside)) / max(size, 1e-12)
    if angle >= _LEVEL and size >= _SURELY * sigma and findings.observability.weighs:
        yield message(
            f"Gravity is {arg(angle):.1f}° off vertical: the base is not level, or something such as a"
            " cable pulls sideways all the time and counts as weight. Check the base and the cables."
        )


def _grave(findings: Findings, agree: bool) -> Iterator[str]:
    told = any(cause.believed and cause.key not in {PLAIN, NOISE} for cause in findings.causes)
    if not agree:
        yield message(
            "No majority of the poses fits one gravity model. Either the orientations follow"
            f" another convention than declared ({arg(DIAGNOSE)}), or most captures were disturbed."
        )
    if _restless(findings):
        yield message(
            "The poses disagree far more than the readings scatter within each of them. Either"
            f" the orientations follow another convention than declared ({arg(DIAGNOSE)}), or captures were disturbed."
        )
    elif min(findings.noise_factor) > _ABSURD and not told:
        yield message(
            f"The residuals are {arg(max(findings.noise_factor)):.0f} times what the specified noise"
            f" explains. Check the convention of the orientations ({arg(DIAGNOSE)}), and that nothing touched the tool."
        )
    if same_readings(findings):
        yield message(
            "Every pose has exactly the same reading although the tool was turned: the sensor is"
            " not responding. Check its cable and its power."
        )
    sight = findings.observability
    if sight.force_rank < 6 or (sight.weighs and sight.torque_rank < 6):
        yield from sight.null_directions
    elif sight.weighs and not sight.weak and (off := _off_down(findings)):
        yield message(
            f"Gravity points {arg(off):.0f}° away from down. Either the sensor reports the opposite"
            f" sign, the orientations are turned ({arg(DIAGNOSE)}), or the"
            " robot is not mounted upright: then give the direction of down (--down)."
        )
    if (far := no_tool(findings)) and np.linalg.norm(findings.centre_of_mass_S) > _NO_TOOL:
        yield far


def _too_unsure(findings: Findings, limits: Limits, error: str) -> list[str]:
    sight = findings.observability
    if findings.contact_error <= limits.usable_error:
        return []
    remedy = sight.weak or message("Take more poses tilted about two axes, or average each for longer.")
    if findings.model_error > 0.5 * findings.contact_error and not sight.weak:
        remedy = message("More poses will not help: the error is not noise.")
    most = 1e3 * limits.usable_error
    return [
        *sight.null_directions,
        message(f"{arg(error)}; more than {arg(most):g} mm is refused. {arg(remedy)}"),
    ]


def no_tool(findings: Findings) -> str:
    """Return a sentence if the centre of mass surely lies where that of no tool is; empty: it does not."""
    L, tip = findings.centre_of_mass_S, findings.task.point
    if not findings.observability.weighs or findings.observability.torque_rank < 6:
        return ""
    spread = 2 * float(np.sqrt(np.linalg.eigvalsh(findings.covariance[6:9, 6:9])[-1]))
    length, reach = float(np.linalg.norm(L)), max(_LONG, _REACH * float(np.linalg.norm(tip)))
    along = float(L @ tip) / max(float(np.linalg.norm(tip)), 1e-12)
    if length - spread > reach or length + spread < _NEAREST_M:
        return message(
            f"The centre of mass lies {arg(1e3 * length):,.0f} mm from the sensor, where no tool is: check the"
            f" units of forces and torques ({arg(DIAGNOSE)}), and the place of the tip (--tip)."
        )
    if along + spread < -_BEHIND:
        return message(
            f"The centre of mass lies {arg(-1e3 * along):.0f} mm on the side of the sensor that is away from the"
            " tip: check the signs of the torques, and the place of the tip (--tip)."
        )
    return ""


def known_load(findings: Findings) -> Prior:
    """Return what is known of the load beforehand: where down is, and on which side of the sensor the tip is."""
    tip = findings.task.point
    axis = tuple(tip.tolist()) if tip.any() else (0.0, 0.0, 1.0)
    return Prior(down_W=tuple(findings.down_W.tolist()), tool_axis_S=axis)


def _other_units(findings: Findings) -> list[str]:
    """Return a sentence if units that would move contacts fit as well, for nobody gave the noise to tell them by."""
    if not findings.noise.estimated or not findings.observability.weighs:
        return []
    load, noise = known_load(findings), findings.noise.sigmas[[0, 3]]
    C = findings.covariance[np.ix_([0, 1, 2, 6, 7, 8], [0, 1, 2, 6, 7, 8])]

    def value(F: float, M: float) -> float:
        scale = np.repeat([F, M / F], 3)
        g, L = findings.gravity_W * F, findings.centre_of_mass_S * (M / F)
        parts = load.log_densities(g, L, C * np.outer(scale, scale))
        return sum(parts.values()) + quiet(noise * (F, M))

    every, as_read = list(units(np.empty((0, 3, 3)))), value(1.0, 1.0)
    shares = sum(each.share for each in every)
    odds = {
        each: float(np.exp(value(*each.factor[[0, 3]]) - as_read)) * load.mistake * each.share / shares
        for each in every
        if each.factor[0] != each.factor[3]  # alike for both, they move no contact
    }
    likeliest, total = max(odds, key=lambda each: odds[each]), sum(odds.values())
    if total < _NOT_EXCLUDED:
        return []
    mass = float(np.linalg.norm(findings.gravity_W)) / STANDARD_GRAVITY
    said = message(
        f"Other units are not excluded, with a probability of {arg(100 * total / (1 + total)):.1f} %:"
        f" {arg(likeliest.title)} would fit as well, with a tool of {arg(mass * likeliest.factor[0]):.2g} kg instead"
        f" of {arg(mass):.2g} kg. Weigh it, or give the noise from the sensor's data sheet."
    )
    return [said]


def same_readings(findings: Findings) -> bool:
    """Tell whether the sensor read the same in every pose, to the last digit, though it stood differently."""
    readings = np.array([[*pose.force, *pose.torque] for pose in findings.poses])
    return bool((np.ptp(readings, axis=0) == 0).all()) and findings.observability.force_rank == 6


def _restless(findings: Findings) -> bool:
    """Tell whether noise that was estimated between the poses is out of proportion to that within them."""
    noise = findings.noise
    loud = (noise.sigmas > _RESTLESS * noise.least).any()
    return bool(noise.estimated and (noise.least > 0).all() and loud)


def _off_down(findings: Findings) -> float:
    """Return by how many degrees gravity surely points away from down; 0 if a tilted base explains it."""
    g, down = findings.gravity_W, findings.down_W
    sideways = np.eye(3) - np.outer(down, down)
    along = float(g @ down) + 2 * float(np.sqrt(down @ findings.covariance[:3, :3] @ down))
    angle = float(np.degrees(np.arctan2(np.linalg.norm(sideways @ g), g @ down)))
    return angle if along < np.linalg.norm(g) * np.cos(_LEAN) else 0.0


def _slight(findings: Findings, limits: Limits, error: str) -> Iterator[str]:
    kept, rejected = int(findings.kept.sum()), findings.rejected
    sight = findings.observability
    if not sight.weighs:
        yield from sight.null_directions
    if findings.contact_error > limits.good_error:
        good = 1e3 * limits.good_error
        more = message(f"{arg(error)}; {arg(good):g} mm would be good. One or two more poses will help.")
        if findings.model_error >= 0.5 * findings.contact_error:
            more = message(
                f"{arg(error)}; {arg(good):g} mm would be good. The error is not noise, so more poses will not help."
            )
        yield more
    latest = int(np.argmax(stack(findings.poses).moments))
    if findings.deviates[latest].max() >= limit(len(findings.poses)):
        yield message(
            f"{arg(named(findings.poses, latest).capitalize())}, the last one, disagrees: it was"
            " bumped, or the sensor's zero jumped before it and the bias is wrong. Take one or"
            " two more poses to find out which."
        )
    yield from filter(None, (no_tool(findings), sight.weak, *_found(findings)))
    if kept < _CHECKED_FROM:
        yield message(
            f"With {arg(kept)} poses, none can be checked against the others. Take at least {arg(_CHECKED_FROM)}."
        )
    if rejected and len(findings.poses) < _NAMED_FROM:
        names = join(", ", (named(findings.poses, each.index) for each in rejected))
        again = message("Retake it") if len(rejected) == 1 else message("Retake them")
        yield message(f"Left out: {arg(names)}. {arg(again)}, to have {arg(_NAMED_FROM)} poses or more.")


# ---- bumped poses: which they are, and why -------------------------------------------------------


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
    halves = slice(0, 3), slice(3, 6)
    squares = [_squares(V[:, half, half], fitted[:, half, half], residuals[:, half]) for half in halves]
    return as_deviates(np.stack(squares, axis=1), inside, noisy.noise)


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
    poses: Stack, chosen: NDArray[np.bool_], prior: NoisePrior, terms: Terms, start: NoisyFit | None = None
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
