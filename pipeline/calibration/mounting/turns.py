"""Rotations of the mount, what is unknown of them, and small help."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.fit import ANY_TURN, UNKNOWN
from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


ROTATION = slice(12, 15)  # behind PARAMETERS


ALL_UNKNOWN = np.append(UNKNOWN, np.full(3, ANY_TURN))


_ROTATION_TOLERANCE = 1e-3  # as for PoseSample


def turn(d: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return exp([d]x) (..., 3, 3) for rotation vectors d (..., 3), rad."""
    return Rotation.from_rotvec(d).as_matrix()


def unit(v: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a vector at length 1."""
    return v / max(float(np.linalg.norm(v)), 1e-12)


def largest_sigma(covariance: NDArray[np.float64]) -> float:
    """Return the standard deviation in the worst direction."""
    return float(np.sqrt(np.linalg.eigvalsh(covariance)[-1]))


def matrices(R_WE: ArrayLike) -> NDArray[np.float64]:
    """Return rotations (3, 3) or (n, 3, 3), checked; InputError if they are none."""
    R = np.asarray(R_WE, dtype=np.float64)
    if R.shape[-2:] != (3, 3) or R.ndim > 3:
        raise InputError(f"R_WE has shape {R.shape}: give (3, 3) or (n, 3, 3)")
    if not (np.abs(R @ R.swapaxes(-1, -2) - np.eye(3)) < _ROTATION_TOLERANCE).all():
        raise InputError("R_WE is no rotation: give finite matrices of unit columns at right angles")
    return R
