"""From poses to a calibration, with an honest statement of how good it is."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import chdtrc, chdtri, fdtri

from pipeline.calibration.contact_error import ContactTask, usual_task
from pipeline.calibration.fit import (
    ALL,
    Fit,
    PoseNoise,
    felt,
    fit_with_unknown_noise,
    maximise,
    predict,
    two_stage,
)
from pipeline.calibration.model import CENTRE_OF_MASS, GRAVITY, PARAMETERS, TORQUE_BIAS, GravityModel
from pipeline.calibration.observability import Observability, observe, observe_weightless
from pipeline.calibration.outliers import LARGEST_SHARE, Rejection, deviates, find_bumped, refit, rejection
from pipeline.calibration.poses import PoseError, Stack, stack
from pipeline.calibration.verdict import Level, Limits, Verdict, judge

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from pipeline.calibration.poses import PoseSample

# Noise that was given is doubted when chance explains the residuals once in so many clean sets.
_DOUBT = 1e-3


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
        Read minus predicted, N and N·m; also of poses that were left out.
    deviates : (n, 2)
        Distance of each pose's force and torque from what the (other) poses predict, as normal deviates.
    rejected : tuple of Rejection
        Poses that were left out, with reasons.
    observability : Observability
        Rank, condition, and what cannot be told apart.
    scatter : float
        Residual variance over the noise's: near 1 when the noise is right.
    plausible : bool
        Whether chance explains the scatter. Where it does not, the covariance has been multiplied by it.
    task : ContactTask
        The touches behind `contact_error`.
    contact_error : float
        The calibration's share of the contact error: worst 1 sigma over the task, m.
    verdict : Verdict
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
        if not self.noise.estimated:
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
    task: ContactTask | None = None,
    limits: Limits | None = None,
) -> Calibration:
    """Calibrate bias, weight and centre of mass from still, contact-free poses.

    Two-stage least squares, then joint maximum likelihood of all twelve parameters (mathematics of Cao et
    al. 2023, Eq. 1-2, without the noise in the regressor); poses that disagree with the rest are left out
    and named.

    Parameters
    ----------
    poses : sequence of PoseSample
        At least three; eight or more let bumped ones be named with certainty.
    noise : PoseNoise, optional
        Of a pose's mean. Left out: estimated from the residuals, and at least what the scatter within the
        poses says.
    task : ContactTask, optional
        The touches that the calibration is for.
    limits : Limits, optional
        The rule behind the verdict.

    Returns
    -------
    Calibration
        Also for poses that are too few or too alike: then its verdict is to refuse it, in words.

    Raises
    ------
    PoseError
        There are fewer than three poses.
    """
    if len(poses) < 3:
        raise PoseError(
            f"{len(poses)} poses: twelve unknowns need at least three poses with different tilts, and five or"
            " more to check them against one another."
        )
    arrays = stack(poses)
    fit, noise = _first_fit(arrays, noise, poses)
    far = deviates(arrays, np.ones(len(poses), dtype=bool), fit, noise)
    bumped = find_bumped(arrays, noise, far)
    agree = bool(bumped.mean() <= LARGEST_SHARE)
    if not agree:
        bumped[:] = False  # nobody can say who is right: show them all
    elif bumped.any():
        fit, noise = refit(arrays, ~bumped, noise)
    if bumped.any():
        far = deviates(arrays, ~bumped, fit, noise)
    fit, sight = _observed(arrays.take(~bumped), fit, noise)
    fit, scatter, plausible = _with_scatter(fit, noise, sight.rank)
    task = task or usual_task()
    error = task.calibration_error(fit.theta, fit.covariance)
    residuals = arrays.wrenches - predict(arrays.R_SW, fit.theta)
    calibration = Calibration(
        model=GravityModel.from_vector(fit.theta, fit.covariance),
        noise=noise,
        poses=tuple(poses),
        residuals=residuals,
        deviates=far,
        rejected=tuple(
            rejection(poses, index, far[index], residuals[index]) for index in np.flatnonzero(bumped).tolist()
        ),
        observability=sight,
        scatter=scatter,
        plausible=plausible,
        task=task,
        contact_error=error,
        verdict=Verdict(Level.REFUSE, ()),
    )
    return replace(calibration, verdict=judge(calibration, agree, limits or Limits()))


def _first_fit(arrays: Stack, noise: PoseNoise | None, poses: Sequence[PoseSample]) -> tuple[Fit, PoseNoise]:
    if noise is None:
        return fit_with_unknown_noise(arrays, within_scatter(poses))
    return maximise(arrays, noise.sigmas, two_stage(arrays)), noise


def within_scatter(poses: Sequence[PoseSample]) -> NDArray[np.float64]:
    """Return the standard error (6,) of the poses' means if their samples were independent, else zeros."""
    known = [
        np.concatenate([pose.force_sd, pose.torque_sd]) / np.sqrt(pose.count)
        for pose in poses
        if pose.force_sd is not None and pose.torque_sd is not None
    ]
    return np.median(known, axis=0) if known else np.zeros(6)


def _observed(inside: Stack, fit: Fit, noise: PoseNoise) -> tuple[Fit, Observability]:
    """Tell what the poses show; where the weight is lost in the noise, hold the centre of mass at zero."""
    if felt(fit.theta, fit.covariance):
        sight = observe(inside.R_SW, fit.theta[GRAVITY])
    else:
        free = ALL.copy()
        free[CENTRE_OF_MASS] = False
        fit = maximise(inside, noise.sigmas, np.where(free, fit.theta, 0.0), free)
        sight = observe_weightless(inside.R_SW)
    if sight.null_directions or sight.weak:
        fit = replace(fit, covariance=fit.covariance + _product(fit.covariance, inside.R_SW))
    return fit, sight


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


def _with_scatter(fit: Fit, noise: PoseNoise, rank: int) -> tuple[Fit, float, bool]:
    """Widen the covariance where the residuals say that the noise is larger than was given."""
    freedom = fit.residuals.size - rank
    scatter = fit.cost / freedom
    if noise.estimated or chdtrc(freedom, fit.cost) > _DOUBT:
        return fit, scatter, True
    return replace(fit, covariance=fit.covariance * scatter), scatter, False
