"""What is lost where gravity is taken as exactly vertical.

The calibration leaves the gravity vector free, so that it absorbs a base that is not level. A consumer that
knows only a weight, pointing along -z of its world frame, cannot express that.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from pipeline.calibration.model import length
from pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pipeline.calibration import GravityModel

# Less than this share of the weight is rounding, not a tilt: of a fit to exact data 1e-13 remains.
_ROUNDING = 1e-9
# Noise alone turns the weight of a bare sensor upwards every other time; this many sigma is no noise.
_POINTS_UP = 2.0
# The covariance of a compensated wrench is of second degree in the rotation. The mean over the 24 rotations
# of a cube is then the mean over all rotations, exactly.
_ORIENTATIONS = Rotation.create_group("O").as_matrix()


@dataclass(frozen=True)
class VerticalResidual:
    """The error of a compensated wrench that comes from taking gravity as vertical.

    Attributes
    ----------
    tilt : float
        Angle between the model's gravity and the world's -z axis, degrees.
    weight : float
        What the consumer takes off along -z of W, N: the vertical part of gravity.
    force, torque : float
        Largest error over all orientations of the sensor, N and N·m about the sensor origin.
    force_sigma, torque_sigma : float
        1 sigma of a compensated wrench that the calibration itself leaves, root mean square over all
        orientations, N and N·m. Zero when the model carries no covariance.
    warnings : tuple of str
        For the reader, when the error exceeds that sigma; empty otherwise.
    """

    tilt: float
    weight: float
    force: float
    torque: float
    force_sigma: float
    torque_sigma: float
    warnings: tuple[str, ...]


def vertical_residual(model: GravityModel) -> VerticalResidual:
    """Return what a consumer that takes gravity as vertical leaves in the wrench.

    With the horizontal part ``e`` of gravity, a still sensor keeps ``R_SW e`` in the force and
    ``L_S x R_SW e`` in the torque: at most ``|e|`` and ``|L| |e|``, whatever the orientation.

    Parameters
    ----------
    model : GravityModel
        Its world frame W has z up.

    Raises
    ------
    InputError
        Gravity points up.
    """
    g = model.gravity_W
    up = float(g[2])
    if up > max(_POINTS_UP * float(np.sqrt(model.covariance[2, 2])), 0.0):
        raise InputError(
            f"gravity_W: gravity points up ({up:.3g} N along the world's z axis). The sensor reports the"
            " opposite sign, or the orientations are turned over: mend that and calibrate again."
        )
    return residual_of(model, max(-up, 0.0))


def residual_of(model: GravityModel, weight: float) -> VerticalResidual:
    """Return the same for a consumer that was given another weight.

    Parameters
    ----------
    model : GravityModel
    weight : float
        What the consumer subtracts along -z of W, N.
    """
    g = model.gravity_W
    tilt = float(np.degrees(np.arctan2(np.hypot(g[0], g[1]), -g[2]))) if g.any() else 0.0
    force = length(g + [0.0, 0.0, weight])
    arm = length(model.centre_of_mass_S)
    torque = arm * force
    C = model.wrench_covariance(_ORIENTATIONS)
    force_sigma = _rms(np.trace(C[:, :3, :3], axis1=1, axis2=2))
    torque_sigma = _rms(np.trace(C[:, 3:, 3:], axis1=1, axis2=2))
    least = _ROUNDING * length(g)
    warnings = []
    if force > max(force_sigma, least) or torque > max(torque_sigma, arm * least):
        warnings.append(
            f"Gravity in the calibration is tilted by {tilt:.3g} deg from the vertical of its world frame. Taken"
            f" as vertical, it leaves up to {force:.2g} N and {torque:.2g} N*m in a compensated wrench, where"
            f" the calibration itself leaves {force_sigma:.2g} N and {torque_sigma:.2g} N*m (1 sigma). Level"
            " the base, or put its tilt into the robot description, and calibrate again."
        )
    return VerticalResidual(tilt, weight, force, torque, force_sigma, torque_sigma, tuple(warnings))


def _rms(variances: NDArray[np.float64]) -> float:
    return float(np.sqrt(max(float(variances.mean()), 0.0)))
