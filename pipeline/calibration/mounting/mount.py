"""Gravity calibration when nobody knows how the sensor is turned on the flange.

Observation model of pose i, with E_i = R_EW the known orientation of the flange and R_SE one unknown rotation:

    F_i = R_SE E_i g + F0,    M_i = L x (R_SE E_i g) + M0

Fifteen unknowns. With gravity along the vertical z of W, the forces less their mean are those verticals,
E_i z less their mean, turned and scaled: a Wahba problem with a closed solution (Kabsch 1976). From there
Gauss-Newton on all fifteen, with R_SE on SO(3): a small rotation vector d, in S, acts from the left,
``R_SE <- exp([d]x) R_SE``, and changes a force ``v = R_SE E_i g`` by ``-[v]x d``.

A tilt of the base and the mount's rotation do nearly the same to a force. Only poses that tilt far, about
two axes, tell them apart; a prior for the tilt of the base does too.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import chdtri, fdtri

from contactbench.pipeline.calibration.calibrate import (
    Calibration,
    assembled,
    between,
    checked_angle,
    direction,
    facing,
    used,
    within_scatter,
)
from contactbench.pipeline.calibration.comparison import compare
from contactbench.pipeline.calibration.contact_error import ContactTask, usual_task, worst_sigma
from contactbench.pipeline.calibration.fit import turn_jacobian
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    DOWN_W,
    FORCE_BIAS,
    GRAVITY,
    TORQUE_BIAS,
    GravityModel,
    cross_matrix,
    prediction_jacobian,
)
from contactbench.pipeline.calibration.mounting.sight import see
from contactbench.pipeline.calibration.mounting.start import start_rotation
from contactbench.pipeline.calibration.mounting.turns import ROTATION, largest_sigma, matrices
from contactbench.pipeline.calibration.mounting.words import simple, verdict
from contactbench.pipeline.calibration.poses import PoseError, PoseSample, stack
from contactbench.pipeline.calibration.reml import NoisePrior
from contactbench.pipeline.calibration.verdict import Level, Limits

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from contactbench.pipeline.calibration.fit import PoseNoise


@dataclass(frozen=True, eq=False)
class MountCalibration:
    """What poses of the flange say of the sensor's mounting, and of bias, weight and centre of mass.

    Attributes
    ----------
    R_SE : (3, 3)
        Components in the flange frame E to components in the sensor frame S.
    calibration : Calibration
        As from known orientations: its poses have ``R_WS = R_WE @ R_SE.T``. Its covariance is what the
        parameters' becomes because R_SE is uncertain too; its contact error and its verdict include R_SE.
        For the uncertainty of a compensated wrench ask `wrench_covariance` here, not that of its model.
    joint_covariance : (15, 15)
        Of PARAMETERS, then of the rotation vector d in ``R_true = exp([d]x) @ R_SE``, in S, rad. What the
        poses do not show has a wide width, never a small one.
    mounting : str
        The simple mounting (a multiple of 45 degrees about the flange's z axis) that this may be, in words;
        empty when there is none near.
    """

    R_SE: NDArray[np.float64]
    calibration: Calibration
    joint_covariance: NDArray[np.float64]
    mounting: str

    @property
    def rotation_covariance(self) -> NDArray[np.float64]:
        """(3, 3) of the rotation vector, S, rad²; see `joint_covariance`."""
        return self.joint_covariance[ROTATION, ROTATION]

    @property
    def rotation_sigma_deg(self) -> float:
        """Standard deviation of R_SE about the axis on which least is known, degrees."""
        return float(np.degrees(largest_sigma(self.rotation_covariance)))

    def rotation_ellipsoid(self, probability: float = 0.95) -> float:
        """Return d² such that ``e' inv(rotation_covariance) e < d²`` holds with this probability.

        Chi-square for noise that is known, three times an F variable for noise estimated from the poses.
        """
        freedom = self.calibration.noise.freedom[0]  # forces tell most of the rotation
        if not np.isfinite(freedom):
            return float(chdtri(3, 1 - probability))
        return float(3 * fdtri(3, freedom, probability))

    @property
    def refused(self) -> bool:
        """Whether the result must not be used; `reasons` say why."""
        return self.calibration.verdict.level is Level.REFUSE

    @property
    def reasons(self) -> tuple[str, ...]:
        """Of the verdict, in words."""
        return self.calibration.verdict.reasons

    def compensate(self, R_WE: ArrayLike, wrench: ArrayLike) -> NDArray[np.float64]:
        """Return what the tissue does to the probe: the reading without bias and weight (Eq. 1).

        Parameters
        ----------
        R_WE : array_like (3, 3) or (n, 3, 3)
            Orientation of the flange at each reading; one serves for all readings.
        wrench : array_like (6,) or (n, 6)
            Readings, S, N and N·m about the sensor origin.

        Returns
        -------
        (6,) or (n, 6)

        Raises
        ------
        InputError
            The shapes do not fit.
        """
        return self.calibration.model.compensate(matrices(R_WE) @ self.R_SE.T, wrench)

    def wrench_covariance(self, R_WE: ArrayLike) -> NDArray[np.float64]:
        """Return what the calibration leaves uncertain in a compensated wrench.

        From the joint covariance: the weight in S may be well known where gravity and R_SE alone are not.

        Parameters
        ----------
        R_WE : array_like (3, 3) or (n, 3, 3)
            Orientation of the flange.

        Returns
        -------
        (6, 6) or (n, 6, 6)
            Force before torque, N², N²·m, N²·m².

        Raises
        ------
        InputError
            The shape does not fit.
        """
        R_EW = np.swapaxes(matrices(R_WE), -1, -2)
        R_SW, theta = (self.R_SE @ R_EW).reshape(-1, 3, 3), self.calibration.model.vector
        J = np.concatenate([prediction_jacobian(R_SW, theta), turn_jacobian(R_SW, theta)], axis=2)
        C: NDArray[np.float64] = J @ self.joint_covariance @ J.swapaxes(1, 2)
        return 0.5 * (C + C.swapaxes(1, 2)).reshape(*R_EW.shape[:-2], 6, 6)


def estimate_mount(
    poses: Sequence[PoseSample],
    noise: PoseNoise | None = None,
    *,
    orientation_sigma: float | None = None,
    down_W: ArrayLike = DOWN_W,
    task: ContactTask | None = None,
    limits: Limits | None = None,
) -> MountCalibration:
    """Calibrate bias, weight and centre of mass together with the sensor's rotation on the flange.

    Poses that disagree with the rest are left out and named.

    Parameters
    ----------
    poses : sequence of PoseSample
        At least four; their `R_WS` holds the orientation of the *flange*, R_WE. Eight or more that tilt far
        about two axes let bumped ones be named with certainty.
    noise : PoseNoise, optional
        Of a pose's mean. Left out: estimated from the residuals, and at least what the scatter within the
        poses says.
    orientation_sigma : float, optional
        1 sigma of the poses' orientations about each axis, rad. Left out: estimated, around what a robot has.
    down_W : (3,)
        Where gravity points in W, roughly.
    task : ContactTask, optional
        The touches that the calibration is for.
    limits : Limits, optional
        The rule behind the verdict.

    Returns
    -------
    MountCalibration
        Also for poses that are too few or too alike: then it is `refused`, with `reasons`.

    Raises
    ------
    PoseError
        There are fewer than four poses.
    InputError
        `orientation_sigma` or `down_W` is not finite, or the latter zero.
    """
    if len(poses) < 4:
        raise PoseError(
            f"{len(poses)} poses: fifteen unknowns need at least four poses that tilt about two axes, and six or"
            " more to check them against one another."
        )
    flange, down = stack(poses), direction(down_W)
    prior = NoisePrior.of(noise, checked_angle(orientation_sigma), within_scatter(poses))
    R_start = start_rotation(flange, prior, down)
    arrays = replace(flange, R_SW=R_start @ flange.R_SW)
    compared = compare(arrays, prior, down, mounted=False)
    told, chosen = used(arrays, compared)
    fit = chosen.noisy.fit
    wider = np.zeros_like(fit.covariance)
    wider[:15, :15] = between(compared, chosen)
    fit = replace(fit, covariance=(fit.covariance + wider)[:15, :15])
    R_SE = fit.mount @ R_start
    sight = see(flange, chosen.inside, fit, R_SE, chosen.noisy.noise)
    theta, joint = sight.fit.theta, sight.fit.covariance
    task = facing(task or usual_task(), down)
    noisy = replace(chosen.noisy, fit=replace(chosen.noisy.fit, theta=theta))
    calibration = assembled(
        [replace(pose, R_WS=pose.R_WS @ R_SE.T) for pose in poses],
        arrays,
        prior,
        compared,
        (told, replace(chosen, noisy=noisy)),
        GravityModel.from_vector(theta, joint[:12, :12]),
        sight.parameters,
        task,
        _contact_error(task, theta, joint),
        down,
    )
    found = verdict(calibration, sight, chosen.agree, limits or Limits())
    calibration = replace(calibration, verdict=found)
    mounting = "" if found.level is Level.REFUSE else simple(R_SE, joint[ROTATION, ROTATION])
    return MountCalibration(R_SE, calibration, joint, mounting)


def _contact_error(task: ContactTask, theta: NDArray[np.float64], joint: NDArray[np.float64]) -> float:
    """Return the worst 1 sigma of a contact point over the task, m, R_SE included."""
    A = task.parameter_sensitivity(theta)
    turned = -cross_matrix(task.orientations @ theta[GRAVITY])
    turned = np.repeat(turned, len(A) // len(turned), axis=0)
    # A turn of the mount changes force and torque as a change of the biases would.
    by_turn = (A[:, :, FORCE_BIAS] + A[:, :, TORQUE_BIAS] @ cross_matrix(theta[CENTRE_OF_MASS])) @ turned
    return worst_sigma(np.concatenate([A, by_turn], axis=2), joint)
