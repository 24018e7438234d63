"""From poses to a calibration, with an honest statement of how good it is."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import chdtri, fdtri

from contactbench.pipeline.calibration import nuisance
from contactbench.pipeline.calibration.causes import Cause, causes, convention_cause, overruled
from contactbench.pipeline.calibration.comparison import PLAIN, Candidate, Comparison, compare
from contactbench.pipeline.calibration.contact_error import ContactTask, usual_task
from contactbench.pipeline.calibration.fit import ALL, Fit, PoseNoise, felt, predict
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    DOWN_W,
    GRAVITY,
    PARAMETERS,
    TORQUE_BIAS,
    GravityModel,
)
from contactbench.pipeline.calibration.observability import Observability, observe, observe_weightless
from contactbench.pipeline.calibration.outliers import Rejection, deviates, refit, rejection
from contactbench.pipeline.calibration.poses import PoseError, Stack, stack
from contactbench.pipeline.calibration.reml import NoisePrior, NoisyFit, fit_with_noise
from contactbench.pipeline.calibration.verdict import Level, Limits, Verdict, judge, same_readings
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration.diagnosis.diagnose import RawOrientations
    from contactbench.pipeline.calibration.poses import PoseSample

# Odds from which a cause is believed that nobody has asked for.
_STRONG = 20.0
_POSSIBLE = 0.01  # probability from which a cause widens the uncertainty
_NO_ORIENTATION = 0.5  # rad: beyond, the orientations say nothing
_EXPLAINED = 2.5  # times the noise given: what is left with a cause that explains the poses
_UNEXPECTED = 3.0  # times the noise that was given
_ONLY_BIAS = (PLAIN, nuisance.DRIFT, nuisance.REZERO)


@dataclass(frozen=True, eq=False)
class Calibration:
    """What poses say of bias, weight and centre of mass.

    Attributes
    ----------
    model : GravityModel
        The parameters, with their covariance.
    noise : PoseNoise
        Of a pose's mean; `estimated` tells whether it was given or follows from the residuals.
    poses : tuple of PoseSample
        As given.
    residuals : (n, 6)
        Read minus predicted minus `offsets`, N and N·m; also of poses that were left out.
    deviates : (n, 2)
        Distance of each pose's force and torque from what the (other) poses predict, as normal deviates.
    rejected : tuple of Rejection
        Poses that were left out, with reasons.
    observability : Observability
        Rank, condition, and what cannot be told apart.
    scatter : float
        Residual variance over the noise's: near 1 when the noise is right.
    plausible : bool
        Whether chance explains the residuals with the noise that was given. Where it does not, the noise has been
        estimated.
    task : ContactTask
        The touches behind `contact_error`.
    contact_error : float
        The calibration's share of the contact error: worst 1 sigma over the task, `model_error` included, m.
    verdict : Verdict
    causes : tuple of Cause
        What may be behind the residuals, the most probable first.
    offsets : (n, 6)
        What a drift or a re-zero that was found adds to each pose's reading, N and N·m; zero at the session's
        end, so that the biases are those of the end.
    drift_rate, drift_rate_sigma : (6,) or None
        Growth of the biases at the session's end, N/s and N·m/s; None without a drift, or without times.
    noise_factor : (2,)
        How many times the noise that was given forces and torques show; 1 where it is believed, or none was given.
    model_error : float
        How far a pull that follows the orientation, or a turned mount, moves a contact, m.
    down_W : (3,)
        Where gravity was said to point, W; of length 1.
    """

    model: GravityModel
    noise: PoseNoise
    poses: tuple[PoseSample, ...]
    residuals: NDArray[np.float64]
    deviates: NDArray[np.float64]
    rejected: tuple[Rejection, ...]
    observability: Observability
    scatter: float
    plausible: bool
    task: ContactTask
    contact_error: float
    verdict: Verdict
    causes: tuple[Cause, ...] = ()
    offsets: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 6)))
    drift_rate: NDArray[np.float64] | None = None
    drift_rate_sigma: NDArray[np.float64] | None = None
    noise_factor: tuple[float, float] = (1.0, 1.0)
    model_error: float = 0.0
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

        Chi-square for noise that is known. For noise estimated from the poses, forces and torques each
        contribute six times an F variable; one F variable is matched to the mean and variance of their sum.
        """
        if not np.isfinite(self.noise.freedom).all():
            return float(chdtri(12, 1 - probability))
        freedom = np.maximum(self.noise.freedom, 4.5)  # below, the variance to match does not exist
        means = 6 * freedom / (freedom - 2)
        ratio = float((means**2 * (freedom + 4) / (3 * (freedom - 4))).sum() / means.sum() ** 2)
        matched = (10 + 24 * ratio) / (6 * ratio - 1)
        return float(means.sum() * (matched - 2) / matched * fdtri(12, matched, probability))


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
    poses, drift, a re-zero, a cable, a turned mount and wrong noise figures are compared (`comparison`); what is
    found is told, and drift and re-zeros are taken out.

    Parameters
    ----------
    poses : sequence of PoseSample
        At least three; eight or more let bumped ones be named with certainty.
    noise : PoseNoise, optional
        Of a pose's mean. Left out: estimated from the residuals, and at least what the scatter within the
        poses says.
    orientation_sigma : float, optional
        1 sigma of the poses' orientations about each axis, rad. Left out: estimated, around what a robot has.
    down_W : (3,)
        Where gravity points in W, roughly; its length does not matter.
    task : ContactTask, optional
        The touches that the calibration is for.
    limits : Limits, optional
        The rule behind the verdict.
    raw : RawOrientations, optional
        The numbers behind the orientations, for the diagnosis of poses that do not fit.

    Returns
    -------
    Calibration
        Also for poses that are too few or too alike: then its verdict is to refuse it, in words.

    Raises
    ------
    PoseError
        There are fewer than three poses.
    InputError
        `orientation_sigma` or `down_W` is not finite, or the latter zero.
    """
    if len(poses) < 3:
        raise PoseError(
            f"{len(poses)} poses: twelve unknowns need at least three poses with different tilts, and five or"
            " more to check them against one another."
        )
    down = direction(down_W)
    arrays = stack(poses)
    prior = NoisePrior.of(noise, checked_angle(orientation_sigma), within_scatter(poses))
    compared = compare(arrays, prior, down)
    told, chosen = used(arrays, compared)
    noisy, sight = _observed(arrays, chosen, down)
    covariance = noisy.fit.covariance[:12, :12] + between(compared, chosen)
    if sight.null_directions or sight.weak:
        covariance = covariance + _product(covariance, arrays.R_SW[chosen.inside])
    task = facing(task or usual_task(), down)
    model = GravityModel.from_vector(noisy.fit.theta, covariance)
    error = task.calibration_error(noisy.fit.theta, covariance)
    calibration = assembled(
        poses, arrays, prior, compared, (told, replace(chosen, noisy=noisy)), model, sight, task, error, down
    )
    limits = limits or Limits()
    calibration = replace(calibration, verdict=judge(calibration, chosen.agree, limits))
    if _doubtful(calibration) and (cause := convention_cause(calibration, prior, raw)):
        calibration = replace(calibration, causes=overruled(calibration.causes, cause))
        calibration = replace(calibration, verdict=judge(calibration, chosen.agree, limits))
    return calibration


def _doubtful(calibration: Calibration) -> bool:
    """Tell whether the residuals exceed what is expected, or what they say is no everyday cause."""
    strange = any(
        cause.believed and cause.key in {nuisance.CABLE, nuisance.MOUNT} for cause in calibration.causes
    )
    refused = calibration.verdict.level is Level.REFUSE and calibration.observability.force_rank == 6
    if same_readings(calibration):
        return False
    return strange or refused or max(calibration.noise_factor) > _UNEXPECTED


def assembled(
    poses: Sequence[PoseSample],
    arrays: Stack,
    prior: NoisePrior,
    compared: Comparison,
    told_used: tuple[Candidate, Candidate],
    model: GravityModel,
    sight: Observability,
    task: ContactTask,
    error: float,
    down_W: NDArray[np.float64],
) -> Calibration:
    """Return a calibration, complete but for its verdict; `error`: the worst 1 sigma at a contact, m."""
    told, chosen = told_used
    noisy, inside, terms = chosen.noisy, chosen.inside, chosen.terms
    fit = noisy.fit
    offsets = terms.columns @ fit.added
    residuals = fit.left(arrays, terms)
    far = deviates(arrays, inside, noisy, terms)
    # What is not excluded counts by its probability.
    square = 0.0 if told.key == chosen.key else _model_error(arrays, told, fit, task) ** 2
    for each, probability in zip(compared.candidates, compared.probabilities.tolist(), strict=True):
        if each.key not in {*_ONLY_BIAS, told.key} and probability > _POSSIBLE:
            square += probability * _model_error(arrays, each, fit, task) ** 2
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
    return Calibration(
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
        verdict=Verdict(Level.REFUSE, ()),
        causes=causes(poses, arrays, compared, told),
        offsets=offsets,
        drift_rate=rate,
        drift_rate_sigma=rate_sigma,
        noise_factor=factors,
        model_error=model_error,
        down_W=down_W,
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
            f"down_W is {np.array(down_W).tolist()!r}: give where gravity points in the world frame, three finite"
            " numbers that are not all 0, such as 0,0,-1"
        )
    down /= np.abs(down).max()
    return np.asarray(down / np.linalg.norm(down), dtype=np.float64)


def checked_angle(sigma: float | None) -> float | None:
    """Return a standard deviation of orientations, rad; InputError if it cannot be one."""
    if sigma is not None and not 0 <= sigma < _NO_ORIENTATION:
        raise InputError(
            f"orientation_sigma is {sigma} rad: give at least 0 and less than {_NO_ORIENTATION:g} rad, not degrees"
        )
    return sigma


def used(arrays: Stack, compared: Comparison) -> tuple[Candidate, Candidate]:
    """Return the cause that is told, and the fit that is used: an effect of the orientation cannot be taken out."""
    plain = next(each for each in compared.candidates if each.key == PLAIN)
    best = compared.best
    if compared.probability(best.key) < _STRONG * compared.probability(PLAIN) or best.key == PLAIN:
        return plain, plain
    if best.key in _ONLY_BIAS:
        left = 1.0
        if best.prior.sigmas is not None and not best.prior.believed:
            left = float((best.noisy.noise.sigmas / best.prior.sigmas).max())
        return (best, best) if left < _EXPLAINED else (plain, plain)
    doubted = plain.prior.doubted
    noisy = refit(arrays, best.inside, doubted, plain.terms)
    return best, replace(plain, noisy=noisy, bumped=best.bumped, prior=doubted)


def between(compared: Comparison, chosen: Candidate) -> NDArray[np.float64]:
    """Return the covariance that causes add which are not excluded, and say otherwise of the parameters.

    Of the twelve, and of the mount's rotation if that is unknown: (12, 12) or (15, 15).
    """
    size = 15 if chosen.terms.turns else 12
    fit, added = chosen.noisy.fit, np.zeros((size, size))
    for each, probability in zip(compared.candidates, compared.probabilities, strict=True):
        if each is not chosen and each.key in _ONLY_BIAS and probability > _POSSIBLE:
            other = each.noisy.fit
            turn = Rotation.from_matrix(other.mount @ fit.mount.T).as_rotvec()
            off = np.append(other.theta - fit.theta, turn)[:size]
            values, vectors = np.linalg.eigh(other.covariance[:size, :size] - fit.covariance[:size, :size])
            added += probability * (np.outer(off, off) + vectors * np.maximum(values, 0.0) @ vectors.T)
    return added


def _model_error(arrays: Stack, told: Candidate, fit: Fit, task: ContactTask) -> float:
    """Return how far what the used model leaves out moves a contact: root mean square over the poses, m."""
    other = told.noisy.fit
    full = predict(other.mount @ arrays.R_SW, other.theta) + told.terms.columns @ other.added
    return task.wrench_error(full - predict(fit.mount @ arrays.R_SW, fit.theta))


def within_scatter(poses: Sequence[PoseSample]) -> NDArray[np.float64]:
    """Return the standard error (6,) of the poses' means if their samples were independent, else zeros."""
    known = [
        np.concatenate([pose.force_sd, pose.torque_sd]) / np.sqrt(pose.count)
        for pose in poses
        if pose.force_sd is not None and pose.torque_sd is not None
    ]
    return np.median(known, axis=0) if known else np.zeros(6)


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
