"""From poses to a calibration, with an honest statement of how good it is."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import chdtri, fdtri

from contactbench.pipeline.calibration import nuisance
from contactbench.pipeline.calibration.comparison import (
    ONLY_BIAS,
    POSSIBLE,
    Candidate,
    Cause,
    CauseComparison,
    causes,
    compare,
    joined,
)
from contactbench.pipeline.calibration.diagnosis.diagnose import FEWEST_POSES, MOST_POSES, diagnose
from contactbench.pipeline.calibration.diagnosis.explain import NONE
from contactbench.pipeline.calibration.diagnosis.hypothesis import AS_DECLARED
from contactbench.pipeline.calibration.model import (
    ALL,
    CENTRE_OF_MASS,
    DOWN_W,
    GRAVITY,
    PARAMETERS,
    TORQUE_BIAS,
    Fit,
    GravityModel,
    PoseNoise,
    felt,
    predict,
)
from contactbench.pipeline.calibration.nuisance import NOISE
from contactbench.pipeline.calibration.observability import Observability, observe, observe_weightless
from contactbench.pipeline.calibration.poses import PoseError, PoseSample, Stack, stack
from contactbench.pipeline.calibration.reml import NoisePrior, NoisyFit, fit_with_noise
from contactbench.pipeline.calibration.suggest import ContactTask, usual_task
from contactbench.pipeline.calibration.verdict import (
    Level,
    Limits,
    Rejection,
    Verdict,
    deviates,
    judge,
    known_load,
    no_tool,
    rejection,
    same_readings,
)
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.shown import Shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration.diagnosis.diagnose import RawOrientations

_UNEXPECTED = 3.0  # times the noise that was given, or a share of it so small
_APART = 0.5  # of each other: sizes of noise that one wrong figure does not explain
_AT_LEAST = 0.1
_LIKELY = 0.95  # a mistake that overrules what the residuals say by themselves


@dataclass(frozen=True, eq=False)
class Findings:
    """What poses say of bias, weight and centre of mass."""

    model: GravityModel  # The parameters, with their covariance
    noise: PoseNoise  # Of a pose's mean; `estimated` tells whether it was given or follows from the residuals
    poses: tuple[PoseSample, ...]  # As given
    # (n, 6) read minus predicted minus `offsets`, N and N·m; also of poses that were left out
    residuals: NDArray[np.float64]
    # (n, 2) distance of each pose's force and torque from what the (other) poses predict, as normal deviates
    deviates: NDArray[np.float64]
    rejected: tuple[Rejection, ...]  # Poses that were left out, with reasons
    observability: Observability  # Rank, condition, and what cannot be told apart
    scatter: float  # Residual variance over the noise's: near 1 when the noise is right
    # Whether chance explains the residuals with the noise that was given. Where it does not, the noise has
    # been estimated.
    plausible: bool
    task: ContactTask  # The touches behind `contact_error`
    # The calibration's share of the contact error: worst 1 sigma over the task, `model_error` included, m
    contact_error: float
    causes: tuple[Cause, ...] = ()  # What may be behind the residuals, the most probable first
    # (n, 6) what a drift or a re-zero that was found adds to each pose's reading, N and N·m; zero at the
    # session's end, so that the biases are those of the end
    offsets: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 6)))
    # (6,) growth of the biases at the session's end, N/s and N·m/s; None without a drift, or without
    # times
    drift_rate: NDArray[np.float64] | None = None
    drift_rate_sigma: NDArray[np.float64] | None = None
    # (2,) how many times the noise that was given forces and torques show; 1 where it is believed, or none
    # was given
    noise_factor: tuple[float, float] = (1.0, 1.0)
    # How far a pull that follows the orientation, or a turned mount, moves a contact, m
    model_error: float = 0.0
    # (3,) where gravity was said to point, W; of length 1
    down_W: NDArray[np.float64] = field(default_factory=lambda: np.array(DOWN_W))

    @property
    def gravity_W(self) -> NDArray[np.float64]:
        """Weight of the load as a vector, W, N."""
        return self.model.gravity_W

    @property
    def mass(self) -> float:
        """Mass of the load, kg."""
        return self.model.mass

    @property
    def force_bias(self) -> NDArray[np.float64]:
        """F0, S, N."""
        return self.model.force_bias

    @property
    def torque_bias(self) -> NDArray[np.float64]:
        """M0, S, N·m."""
        return self.model.torque_bias

    @property
    def centre_of_mass_S(self) -> NDArray[np.float64]:
        """L, S, m."""
        return self.model.centre_of_mass_S

    @property
    def covariance(self) -> NDArray[np.float64]:
        """(12, 12), in the order of PARAMETERS."""
        return self.model.covariance

    @property
    def sigmas(self) -> dict[str, float]:
        """1 sigma of each parameter by its name, N, m and N·m."""
        return dict(zip(PARAMETERS, np.sqrt(np.diag(self.covariance)).tolist(), strict=True))

    @property
    def rank(self) -> int:
        """Of the twelve parameters, how many combinations the poses determine."""
        return self.observability.rank

    @property
    def condition(self) -> float:
        """How much worse the worst combination is determined than the best, for a load of 1 N."""
        return self.observability.condition

    @property
    def null_directions(self) -> tuple[str, ...]:
        """What the poses cannot tell apart, in words."""
        return self.observability.null_directions

    @property
    def kept(self) -> NDArray[np.bool_]:
        """(n,) poses that were used."""
        kept = np.ones(len(self.poses), dtype=bool)
        kept[[rejection.index for rejection in self.rejected]] = False
        return kept

    def ellipsoid(self, probability: float = 0.95) -> float:
        """Return d² such that ``e' inv(covariance) e < d²`` holds for the errors e with this probability.

        Chi-square for noise that is known, `matched_f` for noise estimated from the poses.
        """
        if not np.isfinite(self.noise.freedom).all():
            return float(chdtri(12, 1 - probability))
        scale, matched = matched_f(12, np.array(self.noise.freedom))
        return float(scale * fdtri(12, matched, probability))


@dataclass(frozen=True, eq=False, repr=False)
class Calibration(Shown, Findings):
    """Findings with a verdict.

    Attributes
    ----------
    verdict : Verdict
        Whether the calibration may be used.
    """

    verdict: Verdict = field(kw_only=True)

    def facts(self) -> dict[str, str]:
        """As `Shown.facts`."""
        return {
            "verdict": ". ".join([self.verdict.level.value, *self.verdict.reasons]),
            "mass": f"{self.mass:.4f} ± {self.model.mass_sigma:.4f} kg",
            "centre of mass": f"{np.round(1e3 * self.centre_of_mass_S, 2)} mm",
            "bias": f"{np.round(self.force_bias, 3)} N, {np.round(self.torque_bias, 4)} N·m",
            "contact error": f"{1e3 * self.contact_error:.2f} mm, 1 sigma",
            "poses": f"{len(self.poses)}, {len(self.rejected)} left out",
        }


def matched_f(freedom: int, behind: NDArray[np.float64]) -> tuple[float, float]:
    """Return a scale and a freedom m such that ``scale F(freedom, m)`` is distributed like a sum of squares.

    Of residuals with `freedom` degrees of freedom, over noise that was estimated with so many `behind` it (2,), for
    forces and torques: each contributes half the freedom times an F variable. One is matched to their sum in mean
    and variance.
    """
    behind, half = np.maximum(behind, 4.5), freedom / 2  # below, the variance to match does not exist
    mean = (half * behind / (behind - 2)).sum()
    spread = 2 * half**2 * behind**2 * (half + behind - 2) / (half * (behind - 2) ** 2 * (behind - 4))
    # Of a multiple s of F(freedom, m): mean s m / (m - 2); variance over mean² 2 (f + m - 2) / (f (m - 4)).
    ratio = 0.5 * freedom * spread.sum() / mean**2
    matched = (freedom - 2 + 4 * ratio) / (ratio - 1)
    return float(mean * (matched - 2) / matched), float(matched)


def calibrate(
    poses: Sequence[PoseSample],
    noise: PoseNoise | None = None,
    *,
    orientation_sigma: float | None = None,
    down_W: ArrayLike = DOWN_W,
    task: ContactTask | None = None,
    limits: Limits | None = None,
    raw: RawOrientations | None = None,
) -> Calibration:
    """Calibrate bias, weight and centre of mass from still, contact-free poses.

    Two-stage least squares, then joint maximum likelihood of all twelve parameters (mathematics of Cao et
    al. 2023, Eq. 1-2, without the noise in the regressor), with the noise of readings and orientations. Bumped
    poses, drift, a re-zero, a cable, a turned mount and wrong noise figures are compared (`comparison`) and
    reported; drift and re-zeros are removed.

    Parameters
    ----------
    poses : sequence of PoseSample
        At least three; with eight or more, bumped poses can be named with certainty.
    noise : PoseNoise, optional
        Noise of a pose's mean. Default: estimated from the residuals, and at least the scatter within the
        poses.
    orientation_sigma : float, optional
        1 sigma of the poses' orientations about each axis, rad. Default: estimated, starting from a robot's.
    down_W : (3,)
        Approximate direction of gravity in W, of any length.
    task : ContactTask, optional
        The touches that the calibration is for.
    limits : Limits, optional
        The rule behind the verdict.
    raw : RawOrientations, optional
        The numbers behind the orientations, for the diagnosis of poses that do not fit.

    Returns
    -------
    Calibration
        Also for poses that are too few or too similar; its verdict then refuses it and gives the reasons.

    Raises
    ------
    PoseError
        There are fewer than three poses.
    InputError
        `orientation_sigma` or `down_W` is not finite, or the latter zero.
    """
    if len(poses) < 3:
        raise PoseError(
            f"{arg(len(poses))} poses are too few. Twelve unknowns need at least three poses with"
            " different tilts; checking them against one another needs five or more."
        )
    down = direction(down_W)
    compared = compare(stack(poses), NoisePrior.of(poses, noise, orientation_sigma), down)
    told, chosen = compared.used()
    noisy, sight = _observed(compared.poses, chosen, down)
    covariance = noisy.fit.covariance[:12, :12] + compared.between(chosen)
    if sight.null_directions or sight.weak:
        covariance = covariance + _product(covariance, compared.poses.R_SW[chosen.inside])
    task = facing(task or usual_task(), down)
    model = GravityModel.from_vector(noisy.fit.theta, covariance)
    error = task.calibration_error(noisy.fit.theta, covariance)
    findings = findings_of(poses, compared, told, replace(chosen, noisy=noisy), model, sight, task, error)
    limits = limits or Limits()
    verdict = judge(findings, chosen.agree, limits)
    if _doubtful(findings, verdict):
        findings = replace(findings, causes=_joined(findings, compared, raw))
        verdict = judge(findings, chosen.agree, limits)
    return Calibration(**vars(findings), verdict=verdict)


def _doubtful(findings: Findings, verdict: Verdict) -> bool:
    """Tell whether the residuals exceed what is expected, or what they say is no everyday cause."""
    strange = any(cause.believed and cause.key not in {NOISE, *ONLY_BIAS} for cause in findings.causes)
    refused = verdict.level is Level.REFUSE and findings.observability.force_rank == 6
    if same_readings(findings):
        return False
    quiet, loud = sorted(findings.noise_factor)
    # Units that are wrong alike for forces and torques make the noise small alike, and move no contact.
    unexpected = loud > _UNEXPECTED or (quiet < 1 / _UNEXPECTED and quiet < _APART * loud)
    return strange or refused or unexpected or bool(no_tool(findings))


def _joined(findings: Findings, compared: CauseComparison, raw: RawOrientations | None) -> tuple[Cause, ...]:
    """Return the causes with the odds that they have beside mistaken conventions, and those that are likely."""
    poses, prior = findings.poses, compared.prior
    if not FEWEST_POSES <= len(poses) <= MOST_POSES:
        return findings.causes
    noise = None
    if prior.sigmas is not None:
        noise = PoseNoise(prior.sigmas[:3], prior.sigmas[3:], orientation=prior.orientation)
    found = diagnose(poses, noise, prior=known_load(findings), raw=raw, compared=compared)
    if found.consistent:
        return findings.causes
    key = NONE if found.none_known else found.best.hypothesis
    odds = float(found.odds[key])
    if key == AS_DECLARED or any(cause.covers(key) for cause in findings.causes):
        return joined(findings.causes, found.odds, ())
    return joined(findings.causes, found.odds, [Cause(key, odds, found.sentence, odds >= _LIKELY)])


def findings_of(
    poses: Sequence[PoseSample],
    compared: CauseComparison,
    told: Candidate,
    chosen: Candidate,
    model: GravityModel,
    sight: Observability,
    task: ContactTask,
    error: float,
) -> Findings:
    """Return what is to be judged; `error`: the worst 1 sigma at a contact, m."""
    arrays, prior = compared.poses, compared.prior
    noisy, inside, terms = chosen.noisy, chosen.inside, chosen.terms
    fit = noisy.fit
    offsets = terms.columns @ fit.added
    residuals = fit.left(arrays, terms)
    far = deviates(arrays, inside, noisy, terms)
    # What is not excluded counts by its probability, which rests on how often causes are met: by no less than a tenth.
    square = 0.0 if told.key == chosen.key else _model_error(arrays, told, fit, task) ** 2
    for each, probability in zip(compared.candidates, compared.probabilities.tolist(), strict=True):
        if each.key not in {*ONLY_BIAS, told.key} and probability > POSSIBLE:
            square += max(probability, _AT_LEAST) * _model_error(arrays, each, fit, task) ** 2
    model_error = float(np.sqrt(square))
    factors = (1.0, 1.0)
    if prior.sigmas is not None and not chosen.prior.believed:
        F, M = (noisy.noise.sigmas / prior.sigmas)[[0, 3]].tolist()
        factors = (F, M)
    rate = rate_sigma = None
    if chosen.key == nuisance.DRIFT and arrays.duration is not None:
        first = len(fit.covariance) - len(fit.added)
        spread = np.sqrt(np.diag(fit.covariance)[first : first + 6])
        rate, rate_sigma = fit.added[:6] / arrays.duration, spread / arrays.duration
    return Findings(
        model=model,
        noise=noisy.noise,
        poses=tuple(poses),
        residuals=residuals,
        deviates=far,
        rejected=tuple(
            rejection(poses, index, far[index], residuals[index])
            for index in np.flatnonzero(~inside).tolist()
        ),
        observability=sight,
        scatter=fit.cost / max(fit.residuals.size - sight.rank, 1),
        plausible=chosen.prior.believed or prior.sigmas is None,
        task=task,
        contact_error=float(np.hypot(error, model_error)),
        causes=causes(poses, compared, told),
        offsets=offsets,
        drift_rate=rate,
        drift_rate_sigma=rate_sigma,
        noise_factor=factors,
        model_error=model_error,
        down_W=compared.down_W,
    )


def facing(task: ContactTask, down_W: NDArray[np.float64]) -> ContactTask:
    """Return a task whose probe points where gravity does."""
    return task if np.array_equal(task.down_W, down_W) else replace(task, down_W=down_W)


def direction(down_W: ArrayLike) -> NDArray[np.float64]:
    """Return a direction (3,) at length 1; InputError if it is none."""
    try:
        down = np.array(down_W, dtype=np.float64)
    except (TypeError, ValueError):
        down = np.zeros(0)
    if down.shape != (3,) or not np.isfinite(down).all() or not down.any():
        raise InputError(
            f"down_W is {arg(np.array(down_W).tolist())!r}: give the direction of gravity in the world"
            " frame, three finite numbers that are not all 0, such as 0,0,-1"
        )
    down /= np.abs(down).max()
    return np.asarray(down / np.linalg.norm(down), dtype=np.float64)


def _model_error(arrays: Stack, told: Candidate, fit: Fit, task: ContactTask) -> float:
    """Return how far what the used model leaves out moves a contact, m: over the poses, and with the touch."""
    other = told.noisy.fit
    full = predict(other.mount @ arrays.R_SW, other.theta) + told.terms.columns @ other.added
    return task.wrench_error(full - predict(fit.mount @ arrays.R_SW, fit.theta)) + task.response_error(
        told.beside.response(other)
    )


def _observed(
    arrays: Stack, chosen: Candidate, down_W: NDArray[np.float64]
) -> tuple[NoisyFit, Observability]:
    """Tell what the poses show; where the weight is lost in the noise, hold the centre of mass at zero."""
    noisy, inside = chosen.noisy, chosen.inside
    R_SW = arrays.R_SW[inside]
    if felt(noisy.fit.theta, noisy.fit.covariance):
        return noisy, observe(R_SW, noisy.fit.theta[GRAVITY])
    free = ALL.copy()
    free[CENTRE_OF_MASS] = False
    noisy = fit_with_noise(arrays.take(inside), chosen.prior, chosen.terms.take(inside), free=free)
    return noisy, observe_weightless(R_SW, down_W)


def _product(C: NDArray[np.float64], R_SW: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the covariance (12, 12) that the product of two errors leaves in the torque bias.

    The torque L x (R g) is bilinear. Where both g and L are hardly known, their errors' product is no longer
    small beside what the Jacobian says; its mean over the poses ends up in M0. For independent a and b with
    covariances A and B, a x b has (tr A tr B - tr AB) 1 - tr A B - tr B A + AB + BA.
    """
    A = C[CENTRE_OF_MASS, CENTRE_OF_MASS]
    B = np.mean(R_SW @ C[GRAVITY, GRAVITY] @ R_SW.transpose(0, 2, 1), axis=0)
    trace_A, trace_B, AB = np.trace(A), np.trace(B), A @ B
    added = np.zeros((12, 12))
    added[TORQUE_BIAS, TORQUE_BIAS] = (
        (trace_A * trace_B - np.trace(AB)) * np.eye(3) - trace_A * B - trace_B * A + AB + AB.T
    )
    return added
