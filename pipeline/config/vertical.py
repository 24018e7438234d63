"""Which way is down in W, and what is lost where gravity is taken as exactly vertical.

The calibration leaves the gravity vector free, so that it absorbs a base that is not level. A consumer that
knows only a weight along one fixed direction cannot express that.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel
from contactbench.pipeline.calibration.model import DOWN_W, length
from contactbench.pipeline.errors import InputError, arg, message

NO_ADMITTANCE: Final = message(
    "ros2.yaml holds only the broadcaster's offset: the admittance controller of ros2_control cannot take the weight of"
    " a tool whose robot is on a wall or a tilted base."
)
# The cosine of some 5 degrees: further from z of W, a weight along z is the wrong weight.
_ALONG_Z = 0.996

# Less than this share of the weight is rounding, not a tilt: of a fit to exact data 1e-13 remains.
_ROUNDING = 1e-9
# Noise alone turns the weight of a bare sensor upwards every other time; this many sigma is no noise.
_NOISE = 2.0
# The covariance of a compensated wrench is of second degree in the rotation. The mean over the 24 rotations
# of a cube is then the mean over all rotations, exactly.
_ORIENTATIONS = Rotation.create_group("O").as_matrix()


@dataclass(frozen=True)
class VerticalResidual:
    """The error of a compensated wrench that comes from taking gravity as vertical."""

    tilt: float  # Angle between the model's gravity and the consumer's vertical, degrees
    weight: float  # What the consumer takes off along its vertical, N: that part of gravity
    # Largest error over all orientations of the sensor, N and N·m about the sensor origin
    force: float
    torque: float
    # 1 sigma of a compensated wrench that the calibration itself leaves, root mean square over all
    # orientations, N and N·m. Zero when the model carries no covariance.
    force_sigma: float
    torque_sigma: float
    warnings: tuple[str, ...]  # For the reader, when the error exceeds that sigma; empty otherwise


def points_away(model: GravityModel, down_W: ArrayLike, cosine: float = 0.0) -> bool:
    """Tell whether gravity is further from ``down_W`` than an angle, by more than its noise.

    Parameters
    ----------
    model : GravityModel
    down_W : array_like (3,)
        Unit vector in W.
    cosine : float
        Of the angle; 0: gravity points up.
    """
    down = np.asarray(down_W, dtype=np.float64)
    sigma = float(np.sqrt(max(float(down @ model.covariance[:3, :3] @ down), 0.0)))
    return float(model.gravity_W @ down) + _NOISE * sigma < cosine * length(model.gravity_W)


def down_along_z(down_W: ArrayLike) -> float | None:
    """Return -1 where down is -z of W (the robot stands), 1 where it is +z (it hangs), else None.

    Parameters
    ----------
    down_W : array_like (3,)
        Unit vector in W.
    """
    z = float(np.asarray(down_W, dtype=np.float64)[2])
    return float(np.sign(z)) if abs(z) >= _ALONG_Z else None


def vertical_residual(model: GravityModel, down_W: ArrayLike = DOWN_W) -> VerticalResidual:
    """Return what a consumer that takes gravity along one direction leaves in the wrench.

    With the part ``e`` of gravity across that direction, a still sensor keeps ``R_SW e`` in the force and
    ``L_S x R_SW e`` in the torque: at most ``|e|`` and ``|L| |e|``, whatever the orientation.

    Parameters
    ----------
    model : GravityModel
    down_W : array_like (3,)
        Unit vector in W: the consumer's vertical.

    Raises
    ------
    InputError
        Gravity points up.
    """
    along = float(model.gravity_W @ np.asarray(down_W, dtype=np.float64))
    if points_away(model, down_W):
        raise InputError(
            f"gravity_W: gravity points up (by {arg(-along):.3g} N) against the declared direction of"
            " down. The sensor reports the opposite sign, or the orientations are inverted:"
            " correct that. If the robot is not mounted upright, give --down and recalibrate."
        )
    return residual_of(model, max(along, 0.0), down_W)


def residual_of(model: GravityModel, weight: float, down_W: ArrayLike = DOWN_W) -> VerticalResidual:
    """Return the same for a consumer that was given another weight.

    Parameters
    ----------
    model : GravityModel
    weight : float
        What the consumer subtracts along ``down_W``, N.
    down_W : array_like (3,)
        Unit vector in W.
    """
    g, down = model.gravity_W, np.asarray(down_W, dtype=np.float64)
    tilt = float(np.degrees(np.arctan2(length(np.cross(g, down)), float(g @ down)))) if g.any() else 0.0
    force = length(g - weight * down)
    arm = length(model.centre_of_mass_S)
    torque = arm * force
    C = model.wrench_covariance(_ORIENTATIONS)
    force_sigma = _rms(np.trace(C[:, :3, :3], axis1=1, axis2=2))
    torque_sigma = _rms(np.trace(C[:, 3:, 3:], axis1=1, axis2=2))
    least = _ROUNDING * length(g)
    warnings = []
    if force > max(force_sigma, least) or torque > max(torque_sigma, arm * least):
        warnings.append(
            message(
                f"Gravity in the calibration is tilted by {arg(tilt):.3g} deg from the vertical of its world"
                f" frame. Taken as vertical, it leaves up to {arg(force):.2g} N and {arg(torque):.2g} N*m in"
                f" a compensated wrench, where the calibration itself leaves {arg(force_sigma):.2g} N and"
                f" {arg(torque_sigma):.2g} N*m (1 sigma). Level the base, or put its tilt into the robot"
                " description, and calibrate again."
            )
        )
    return VerticalResidual(tilt, weight, force, torque, force_sigma, torque_sigma, tuple(warnings))


def _rms(variances: NDArray[np.float64]) -> float:
    return float(np.sqrt(max(float(variances.mean()), 0.0)))
