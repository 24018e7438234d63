"""The fifteen unknowns by maximum likelihood, from a start that is near."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pipeline.calibration.fit import (
    UNKNOWN,
    PoseNoise,
    predict,
    truncation,
)
from pipeline.calibration.model import (
    CENTRE_OF_MASS,
    GRAVITY,
    cross_matrix,
    prediction_jacobian,
)
from pipeline.calibration.poses import Stack

if TYPE_CHECKING:
    from numpy.typing import NDArray
from pipeline.calibration.mounting.turns import ALL_UNKNOWN, ROTATION, turn

_STEPS, _STUCK, _CONVERGED = 100, 1e12, 1e-3


_ROUNDING = 1 + 1e-12  # at the maximum a step neither helps nor harms


_ROUNDS = 3  # of estimating the noise anew
LEAST = np.repeat([1e-6, 1e-8], 3)  # below what any converter resolves, N and N·m


@dataclass(frozen=True, eq=False)
class Fit:
    """A maximum of the likelihood: parameters (12,), rotation (3, 3), and as in fit.Fit for fifteen columns."""

    theta: NDArray[np.float64]
    R_SE: NDArray[np.float64]
    covariance: NDArray[np.float64]
    residuals: NDArray[np.float64]
    J: NDArray[np.float64]

    @property
    def cost(self) -> float:
        """Sum of the squared residuals."""
        return float(np.vdot(self.residuals, self.residuals))

    @property
    def freedom(self) -> NDArray[np.float64]:
        """(2,) degrees of freedom that the fit leaves to forces and to torques."""
        leverage = np.einsum("nai,ij,naj->a", self.J, self.covariance, self.J)
        freedom: NDArray[np.float64] = 3 * len(self.J) - leverage.reshape(2, 3).sum(axis=1)
        return np.maximum(freedom, 1.0)


def jacobian(R_SW: NDArray[np.float64], theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how the predicted readings change with PARAMETERS and with the rotation vector (n, 6, 15)."""
    J: NDArray[np.float64] = np.zeros((len(R_SW), 6, 15))
    J[:, :, :12] = prediction_jacobian(R_SW, theta)
    J[:, :3, ROTATION] = -cross_matrix(R_SW @ theta[GRAVITY])
    J[:, 3:, ROTATION] = cross_matrix(theta[CENTRE_OF_MASS]) @ J[:, :3, ROTATION]
    return J


def _maximise(
    flange: Stack,
    sigmas: NDArray[np.float64],
    R: NDArray[np.float64],
    theta: NDArray[np.float64],
    level: float,
) -> Fit:
    """Maximise the likelihood (with a prior for the tilt of the base, if finite) by Gauss-Newton."""
    tilt = np.zeros(15)  # the prior's weight on the horizontal parts of gravity
    tilt[:2] = 1 / (level * max(float(np.linalg.norm(theta[GRAVITY])), 1e-9))
    residuals, cost = _residuals(flange, sigmas, R, theta, tilt)
    damping = 1.0  # nothing beside what the readings say, and keeps a step short where they say nothing
    for _ in range(_STEPS):
        scaled = (jacobian(R @ flange.R_SW, theta) / sigmas[:, None] * ALL_UNKNOWN).reshape(-1, 15)
        gradient = scaled.T @ residuals.ravel() - ALL_UNKNOWN * tilt**2 * np.append(theta, np.zeros(3))
        information = scaled.T @ scaled + np.diag((ALL_UNKNOWN * tilt) ** 2)
        while damping < _STUCK:
            step = np.linalg.solve(information + damping * np.eye(15), gradient)
            there = turn(ALL_UNKNOWN[ROTATION] * step[ROTATION]) @ R, theta + UNKNOWN * step[:12]
            attempt, lower = _residuals(flange, sigmas, *there, tilt)
            if lower <= cost * _ROUNDING:
                break
            damping *= 10
        else:
            break
        (R, theta), residuals, cost = there, attempt, lower
        if damping < 2 and step @ gradient < _CONVERGED**2:
            break
        damping = max(0.1 * damping, 1.0)
    J = jacobian(R @ flange.R_SW, theta) / sigmas[:, None]
    scaled = (J * ALL_UNKNOWN).reshape(-1, 15)
    values, vectors = np.linalg.eigh(scaled.T @ scaled + np.diag((ALL_UNKNOWN * tilt) ** 2))
    root = ALL_UNKNOWN[:, None] * vectors / np.sqrt(np.maximum(values, 1.0))
    return Fit(theta, R, root @ root.T, residuals, J)


def _residuals(
    flange: Stack,
    sigmas: NDArray[np.float64],
    R: NDArray[np.float64],
    theta: NDArray[np.float64],
    tilt: NDArray[np.float64],
) -> tuple[NDArray[np.float64], float]:
    residuals = (flange.wrenches - predict(R @ flange.R_SW, theta)) / sigmas
    prior = tilt[:12] * theta
    return residuals, float(np.vdot(residuals, residuals) + prior @ prior)


def fit_all(
    flange: Stack,
    noise: PoseNoise,
    R: NDArray[np.float64],
    theta: NDArray[np.float64],
    level: float,
    kept: float = 1.0,
) -> tuple[Fit, PoseNoise]:
    """Fit from a start; noise that is estimated is estimated anew, `kept` as in fit_with_unknown_noise."""
    if not noise.estimated:
        return _maximise(flange, noise.sigmas, R, theta, level), noise
    freedom = np.array([3 * len(flange) - 9.0, 3 * len(flange) - 6.0])
    for _ in range(_ROUNDS):
        squares = (flange.wrenches - predict(R @ flange.R_SW, theta)) ** 2
        variances = squares.reshape(-1, 2, 3).sum(axis=(0, 2)) / (freedom * truncation(kept))
        sigmas = np.maximum(np.repeat(np.sqrt(variances), 3), np.maximum(noise.least, LEAST))
        fit = _maximise(flange, sigmas, R, theta, level)
        R, theta, freedom = fit.R_SE, fit.theta, fit.freedom
    F, M = freedom.tolist()
    return fit, PoseNoise(sigmas[:3], sigmas[3:], estimated=True, freedom=(F, M), least=noise.least)


def to_estimate(least: NDArray[np.float64]) -> PoseNoise:
    """Return noise whose size is to be estimated, and is at least so much (6,)."""
    return PoseNoise(1.0, 1.0, estimated=True, freedom=(1.0, 1.0), least=least)
