"""What the poses show of the mount's rotation."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import block_diag
from scipy.special import chdtrc, fdtrc

from contactbench.pipeline.calibration.fit import ANY_TURN, UNKNOWN, Fit, PoseNoise, parameter_covariance
from contactbench.pipeline.calibration.model import (
    FORCE_BIAS,
    GRAVITY,
    TORQUE_BIAS,
    cross_matrix,
    prediction_jacobian,
)
from contactbench.pipeline.calibration.observability import Observability, observe
from contactbench.pipeline.calibration.poses import Stack

if TYPE_CHECKING:
    from numpy.typing import NDArray
from contactbench.pipeline.calibration.mounting.start import DOWNS, centred
from contactbench.pipeline.calibration.mounting.turns import ALL_UNKNOWN, ROTATION, unit
from contactbench.pipeline.calibration.mounting.words import blind_words, named_axes

# A mount that is known less well than this, 1 sigma, is of no use (the eye does better), and is more than a
# linear covariance can describe.
_UNSURE, _SURE = np.radians(10.0), np.radians(2.0)


# Orientations are off by some tenths of a degree, rad. Where the poses separate a turn of the mount from all
# else by less than _BLIND, as a sine, errors like that turn the mount by more than _UNSURE.
_ORIENTATION = 5e-3


_BLIND = _ORIENTATION / _UNSURE


# Forces that follow the orientations this improbably by chance are weight.
_FELT = 1e-5


@dataclass(frozen=True, eq=False)
class Sight:
    """What the poses show: the fit with honest widths, why R_SE is refused or weak, and the parameters'."""

    fit: Fit
    grave: tuple[str, ...]
    slight: tuple[str, ...]
    parameters: Observability


def see(
    flange: Stack, inside: NDArray[np.bool_], fit: Fit, R_SE: NDArray[np.float64], noise: PoseNoise
) -> Sight:
    """Widen what the poses inside do not show of the mount, and say why."""
    R_EW, poses = flange.R_SW[inside], flange.take(inside)
    R_SW = R_SE @ R_EW
    # A fit of poses that show nothing may put gravity anywhere, and then see all from there: ask level, too.
    found = [_sines(R_SW, down) for down in (unit(fit.theta[GRAVITY]), DOWNS[0])]
    sines, axes_S = min(found, key=lambda pair: float(pair[0].sum()))
    blind = axes_S[:, sines < _BLIND]
    felt = _felt(poses, fit, noise)
    weighs = felt or blind.shape[1] == 3  # what looks alike in every pose may well be weight
    if blind.shape[1] == 3:
        fit = replace(_biases(poses, R_SW, fit, noise), covariance=np.diag(ALL_UNKNOWN**2))
    else:
        fit = _widened(fit, blind) if felt else _biases(poses, R_SW, fit, noise)
    parameters = observe(R_SW, fit.theta[GRAVITY], weighs=weighs)
    values, vectors = np.linalg.eigh(fit.covariance[ROTATION, ROTATION])
    worst, axis = float(np.sqrt(values[-1])), named_axes(R_SE.T @ vectors[:, -1:])
    known = f"The mount's rotation about {axis} is known to {np.degrees(worst):.1f}° (1 sigma) only"
    if blind.shape[1]:
        grave = blind_words(R_EW, R_SE.T @ blind)
    elif not felt:
        grave = (
            "The weight is too small to show a rotation: the forces do not follow the orientations beyond"
            " their noise. Hang a heavier load on the sensor, or average each pose for longer."
        )
    elif worst > _UNSURE:
        grave = (
            f"{known}; more than {np.degrees(_UNSURE):.0f}° is refused. The weight is too small, or the poses tilt"
            " too little, for this noise: take more poses that tilt up to 90° about two axes, or a heavier load."
        )
    else:
        grave = ""
    return Sight(fit, (grave,) if grave else (), (f"{known}.",) if worst > _SURE else (), parameters)


def _felt(inside: Stack, fit: Fit, noise: PoseNoise) -> bool:
    """Tell whether forces follow the orientations by more than chance: six parameters more than a bias."""
    flat = centred(inside.F[None])[0] / noise.sigmas[:3]
    gain = max(float((flat**2).sum() - (fit.residuals[:, :3] ** 2).sum()), 0.0)
    chance = (
        fdtrc(6, noise.freedom[0], gain / 6)
        if np.isfinite(noise.freedom[0]) and noise.estimated
        else chdtrc(6, gain)
    )
    return bool(chance < _FELT)


def _sines(
    R_SW: NDArray[np.float64], down_W: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return how far a turn of the mount is from all that gravity and bias can do to forces.

    For a load of 1 N, the part of the forces' change with a small turn that neither a tilt of the base, as far
    as it is free, nor another bias explains: root mean square over the poses, N/rad.

    Returns
    -------
    (3,), (3, 3)
        Ascending, and in the columns the axes of the turns, S.
    """
    n = len(R_SW)
    rows = centred(np.concatenate([R_SW, -cross_matrix(R_SW @ down_W)], axis=2)[None]).reshape(-1, 6)
    square = rows.T @ rows / n
    alike = np.linalg.pinv(square[:3, :3], rcond=1e-9, hermitian=True)
    values, axes = np.linalg.eigh(square[3:, 3:] - square[3:, :3] @ alike @ square[:3, 3:])
    return np.sqrt(np.maximum(values, 0.0)), axes


def _widened(fit: Fit, blind_S: NDArray[np.float64]) -> Fit:
    """Take away what is known of turns about axes (3, k); what was known given the rotation stays."""
    C = fit.covariance
    follow = ANY_TURN * C[:, ROTATION] @ np.linalg.solve(C[ROTATION, ROTATION], blind_S)
    return replace(fit, covariance=C + follow @ follow.T)


def _biases(inside: Stack, R_SW: NDArray[np.float64], fit: Fit, noise: PoseNoise) -> Fit:
    """Fit the biases alone; the weight may be up to what would have been felt, in any direction."""
    theta = np.zeros(12)
    theta[FORCE_BIAS], theta[TORQUE_BIAS] = inside.F.mean(axis=0), inside.M.mean(axis=0)
    C = parameter_covariance(prediction_jacobian(R_SW, theta) / noise.sigmas[:, None])
    C += 8 * C[:, GRAVITY] @ np.linalg.solve(C[GRAVITY, GRAVITY], C[GRAVITY])
    # A weight that small, on any lever, is in the torques' mean, too.
    C[TORQUE_BIAS, TORQUE_BIAS] += np.linalg.norm(C[GRAVITY, GRAVITY], 2) * UNKNOWN[6] ** 2 * np.eye(3)
    return replace(fit, theta=theta, covariance=block_diag(C, ANY_TURN**2 * np.eye(3)))
