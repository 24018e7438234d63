"""The contact frame C, for programs that want axes at a contact and not only its normal."""

import math

import numpy as np
from numpy.typing import NDArray

_STEEP = 0.9  # more of the sensor's x axis than this along the normal leaves too little beside it


def contact_frame(normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """
    Return R_SC (3, 3): z along the outward normal, x as near to the sensor's x axis as it can be.

    Where the normal is within 26° of the sensor's x axis, x is as near to the sensor's y axis instead. The wrench says
    nothing about how C is turned about its z axis.

    Parameters
    ----------
    normal : (3,) float64
        Outward, of unit length, in S.
    """
    # Every sample needs it: NumPy takes ten times as long for three numbers.
    x, y, z = normal.tolist()
    size = math.hypot(x, y, z)
    z_C = x / size, y / size, z / size
    axis = 0 if abs(z_C[0]) <= _STEEP else 1
    x_C = [(i == axis) - z_C[axis] * part for i, part in enumerate(z_C)]
    size = math.hypot(*x_C)
    (ax, ay, az), (bx, by, bz) = z_C, (part / size for part in x_C)
    return np.array([[bx, ay * bz - az * by, ax], [by, az * bx - ax * bz, ay], [bz, ax * by - ay * bx, az]])
