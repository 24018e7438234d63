"""The contact frame C, for programs that want axes at a contact and not only its normal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
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
    z = normal / np.linalg.norm(normal)
    near = np.array([1.0, 0.0, 0.0] if abs(z[0]) <= _STEEP else [0.0, 1.0, 0.0])
    x = near - (near @ z) * z
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])
