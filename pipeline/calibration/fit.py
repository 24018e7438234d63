"""The twelve parameters from poses: two-stage least squares, then joint maximum likelihood.

Observation model of pose i, with R_i = R_SW and independent Gaussian noise of known size:

    F_i = R_i g + F0,    M_i = L x (R_i g) + M0

The first stage is linear in (g, F0). The second takes the *predicted* R_i g as its regressor: a measured
force would carry its noise into the regressor and shrink L towards zero (errors in variables). Both stages
leave information on the table, because torques too say something about g; Gauss-Newton on all twelve,
weighted by the noise, uses it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import chdtrc, chdtri

from pipeline.calibration.model import (
    CENTRE_OF_MASS,
    FORCE_BIAS,
    GRAVITY,
    TORQUE_BIAS,
    cross_matrix,
    prediction_jacobian,
)
from pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pipeline.calibration.poses import Stack

# What a parameter could be if the poses say nothing of it: N, N, m, N·m. Only directions that the poses do
# not show get this uncertainty; it is wide, so that everything computed from it says "unknown".
UNKNOWN = np.repeat([20.0, 20.0, 0.3, 3.0], 3)

# Orientations are known to some tenths of a degree. What poses separate by less than this (as a sine, per
# pose) they do not separate: a noise-free set spun about the vertical is as blind as one spun nearly so.
BLIND = 2e-3

ALL = np.ones(12, dtype=bool)
_IDENTITY, _THREE = np.eye(12), np.eye(3)
_RIDGE = 1e-6

_STEPS, _HALVINGS = 25, 12
_CONVERGED = 1e-2  # of a standard deviation; what is left is a hundred times less
_SINGULAR = 1e-12
_FELT = 5.0
_TINY = 1e-300  # N²: a variance beside another that is 1e20 times larger may come out as nothing
_ROUNDING = 1 + 1e-12  # at the maximum a step neither helps nor harms


@dataclass(frozen=True, eq=False)
class PoseNoise:
    """Standard deviation of a pose's *mean* reading: what averaging leaves, drift and hum included.

    Parameters
    ----------
    force : float or (3,)
        N, per axis of S.
    torque : float or (3,)
        N·m, per axis of S.
    estimated : bool
        The values come from the poses themselves.
    freedom : (float, float)
        Degrees of freedom behind the two values; infinite for values that are known.
    least : (6,)
        What the scatter within the poses says the noise is at least, N and N·m.
    """

    force: float | NDArray[np.float64]
    torque: float | NDArray[np.float64]
    estimated: bool = False
    freedom: tuple[float, float] = (np.inf, np.inf)
    least: NDArray[np.float64] = field(default_factory=lambda: np.zeros(6))

    def __post_init__(self) -> None:
        for name, value, unit in (("force", self.force, "N"), ("torque", self.torque, "N·m")):
            array = np.asarray(value, dtype=np.float64)
            if array.shape not in {(), (3,)} or not np.isfinite(array).all() or (array <= 0).any():
                raise InputError(
                    f"PoseNoise.{name}: give one or three finite numbers above 0, {unit}, not {value!r}"
                )

    @property
    def sigmas(self) -> NDArray[np.float64]:
        """(6,) standard deviations, N and N·m."""
        both = np.empty(6)
        both[:3], both[3:] = self.force, self.torque
        return both


@dataclass(frozen=True, eq=False)
class Fit:
    """A maximum of the likelihood.

    Attributes
    ----------
    theta : (12,)
        In the order of PARAMETERS.
    covariance : (12, 12)
        Inverse of the information matrix; directions that the poses do not show have the width of UNKNOWN.
    residuals : (n, 6)
        Read minus predicted, in standard deviations of the noise.
    J : (n, 6, 12)
        Change of the predictions with the free parameters, in the same unit.
    free : (12,) bool
        Parameters that were fitted.
    """

    theta: NDArray[np.float64]
    covariance: NDArray[np.float64]
    residuals: NDArray[np.float64]
    J: NDArray[np.float64]
    free: NDArray[np.bool_]

    @property
    def cost(self) -> float:
        """Sum of the squared residuals, chi-square distributed for a right model."""
        return float(np.vdot(self.residuals, self.residuals))


def two_stage(poses: Stack) -> NDArray[np.float64]:
    """Return the parameters (12,) by least squares: (g, F0) from forces, then (L, M0) from torques."""
    g, F0 = solve_with_offset(poses.R_SW, poses.F)
    L, M0 = solve_with_offset(-cross_matrix(poses.R_SW @ g), poses.M)
    return np.concatenate([g, F0, L, M0])


def solve_with_offset(
    A: NDArray[np.float64], b: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return x and offset, each (..., 3), that minimise sum |A_i x + offset - b_i|².

    Where the rows leave a direction of x open, x is zero along it; elsewhere it is shorter than it should
    be by a few parts in 10,000, which is good enough to start from.

    Parameters
    ----------
    A : (..., n, 3, 3)
    b : (..., n, 3)
    """
    middle_A, middle_b = A.mean(axis=-3), b.mean(axis=-2)
    rows = (A - middle_A[..., None, :, :]).reshape(*A.shape[:-3], -1, 3)
    turned = rows.swapaxes(-1, -2)
    square, right = turned @ rows, turned @ (b - middle_b[..., None, :]).reshape(*b.shape[:-2], -1, 1)
    # As large as what poses that differ by a tenth of a degree would add; a little more against 0 / 0.
    ridge = _RIDGE * (A * A).sum(axis=(-1, -2, -3)) + 1e-30
    x = np.linalg.solve(square + ridge[..., None, None] * _THREE, right)
    return x[..., 0], middle_b - (middle_A @ x)[..., 0]


def predict(R_SW: NDArray[np.float64], theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the (n, 6) readings of an untouched sensor at orientations R_SW (n, 3, 3)."""
    weight = R_SW @ theta[GRAVITY]
    predicted = np.empty((len(R_SW), 6))
    predicted[:, :3] = weight + theta[FORCE_BIAS]
    predicted[:, 3:] = weight @ cross_matrix(theta[CENTRE_OF_MASS]).T + theta[TORQUE_BIAS]
    return predicted


def maximise(
    poses: Stack, sigmas: NDArray[np.float64], start: NDArray[np.float64], free: NDArray[np.bool_] = ALL
) -> Fit:
    """Maximise the likelihood from `start` by Gauss-Newton.

    Parameters
    ----------
    poses : Stack
    sigmas : (6,)
        Noise of a pose's mean, N and N·m.
    start : (12,)
        Near the maximum: the answer of `two_stage`.
    free : (12,) bool
        Parameters to fit; the others stay where they are.
    """
    theta = start
    residuals = (poses.wrenches - predict(poses.R_SW, theta)) / sigmas
    weights = free * UNKNOWN / sigmas[:, None]
    for _ in range(_STEPS):
        scaled = (prediction_jacobian(poses.R_SW, theta) * weights).reshape(-1, 12)
        gradient, information = scaled.T @ residuals.ravel(), scaled.T @ scaled
        # Nothing beside what the readings say; it keeps the step short where they say nothing.
        step = np.linalg.solve(information + _least_information(information) * _IDENTITY, gradient)
        theta, residuals, better = _descend(poses, sigmas, theta, residuals, UNKNOWN * step)
        # The step's length in standard deviations; each is many times shorter than the one before.
        if not better or step @ gradient < _CONVERGED**2:
            break
    J = free_jacobian(poses.R_SW, theta, sigmas, free)
    return Fit(theta, parameter_covariance(J), residuals, J, free)


def free_jacobian(
    R_SW: NDArray[np.float64],
    theta: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    free: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Return how predictions change with the free parameters (n, 6, 12), over the noise."""
    return prediction_jacobian(R_SW, theta) * (free / sigmas[:, None])


def _descend(
    poses: Stack,
    sigmas: NDArray[np.float64],
    theta: NDArray[np.float64],
    residuals: NDArray[np.float64],
    step: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64], bool]:
    """Go along `step` as far as the likelihood grows; the model is bilinear, so that is nearly always all of it."""
    cost = float(np.vdot(residuals, residuals))
    for _ in range(_HALVINGS):
        attempt = theta + step
        there = (poses.wrenches - predict(poses.R_SW, attempt)) / sigmas
        if np.vdot(there, there) <= cost * _ROUNDING:
            return attempt, there, True
        step = 0.5 * step
    return theta, residuals, False


def parameter_covariance(J: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the inverse of the information in Jacobians J (n, 6, 12), which are over the noise.

    Directions that the readings say less of than UNKNOWN, and parameters that are not free, get the width
    of UNKNOWN: the result is always finite, and never claims what was not seen.
    """
    scaled = (J * UNKNOWN).reshape(-1, 12)
    information = scaled.T @ scaled
    values, vectors = np.linalg.eigh(information)
    unseen = values < _least_information(information)
    root = UNKNOWN[:, None] * vectors / np.sqrt(np.where(unseen, 1.0, values))
    covariance: NDArray[np.float64] = root @ root.T
    return covariance


def _least_information(information: NDArray[np.float64]) -> float:
    """Return what counts as none: 1 / UNKNOWN², or what rounding makes of nothing where the noise is tiny."""
    return max(1.0, _SINGULAR * float(information.max()))


def felt(theta: NDArray[np.float64], covariance: NDArray[np.float64]) -> bool:
    """Tell whether the weight is five standard deviations from zero, along any direction that is known.

    Below that, the centre of mass is a ratio of two numbers that are both noise.
    """
    variances, axes = np.linalg.eigh(covariance[GRAVITY, GRAVITY])
    return float(((axes.T @ theta[GRAVITY]) ** 2 / np.maximum(variances, _TINY)).sum()) > _FELT**2


# ---- unknown noise -----------------------------------------------------------------------------

_ROUNDS = 3
# Below what any converter resolves; keeps noise-free data from dividing by zero.
_LEAST = np.repeat([1e-6, 1e-8], 3)


def fit_with_unknown_noise(
    poses: Stack, least: NDArray[np.float64], *, kept: float = 1.0
) -> tuple[Fit, PoseNoise]:
    """Fit poses whose noise is not known: its size is taken from the residuals.

    Parameters
    ----------
    poses : Stack
    least : (6,)
        Standard deviations that the mean of a pose has at least, N and N·m.
    kept : float
        Share of all poses that these are, if they were kept for having small residuals: their scatter then
        says less than the whole noise, by a factor that is known for Gaussian noise.

    Returns
    -------
    Fit, PoseNoise
        The noise is marked as estimated, with its degrees of freedom.
    """
    n = len(poses)
    theta, freedom = two_stage(poses), np.full(2, max(3.0 * n - 6.0, 1.0))
    for _ in range(_ROUNDS):
        squares = (poses.wrenches - predict(poses.R_SW, theta)) ** 2
        variances = squares.reshape(n, 2, 3).sum(axis=(0, 2)) / (freedom * truncation(kept))
        sigmas = np.maximum(np.repeat(np.sqrt(variances), 3), np.maximum(least, _LEAST))
        fit = maximise(poses, sigmas, theta)
        theta = fit.theta
        # Torques help to find the weight, so they pay for some of its degrees of freedom.
        paid = np.einsum("nij,jk,nik->ni", fit.J, fit.covariance, fit.J).reshape(n, 2, 3).sum(axis=(0, 2))
        freedom = np.maximum(3 * n - paid, 1.0)
    both = (float(freedom[0]), float(freedom[1]))
    return fit, PoseNoise(sigmas[:3], sigmas[3:], estimated=True, freedom=both, least=least)


def truncation(kept: float) -> float:
    """Return the variance of the nearest share `kept` of Gaussian six-vectors, over that of all of them."""
    if kept >= 1:
        return 1.0
    radius = chdtri(6, 1 - kept)
    return float(1 - chdtrc(8, radius)) / kept
