"""Angles behind a rotation matrix, and matrices that a mistaken conversion made of them.

An order in lower case names fixed axes, the one that is turned about first at the front; each angle belongs to
its axis. `columns_mistaken` takes three numbers in the order of their columns instead, whatever axes they belong to.
"""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from numpy.typing import NDArray

VECTOR = "vector"
FIXED_ORDERS = tuple("".join(axes) for axes in permutations("xyz"))
# Orders as scipy has them, as read and as meant, whose columns are the other way round. Those that are left out make
# the same of every rotation as one of these.
COLUMNS_REVERSED = (("xyz", "ZYX"), ("xyz", "zyx"), ("XYZ", "ZYX"))
_LOCKED = 1e-9


def recovered(R: NDArray[np.float64], read: str, meant: str) -> NDArray[np.float64]:
    """Return the angles (n, 3) that became R when they were `read` one way but `meant` another, rad.

    Two sets of angles give the same R. Which of them was written is known by what they meant: programs write
    a middle angle within 90 degrees of zero, and rotation vectors of up to half a turn.
    """
    first = angles_of(R, read)
    if read == VECTOR:
        length = np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-12)
        second = first * (1 - 2 * np.pi / length)
    else:
        middle = "xyz".index(read[1])
        second = first + np.pi
        second[:, middle] = np.pi - first[:, middle]
        second -= 2 * np.pi * np.ceil(second / (2 * np.pi) - 0.5)
    plain = _writes(first, meant) | ~_writes(second, meant)
    return np.where(plain[:, None], first, second)


def columns_mistaken(R: NDArray[np.float64], read: str, meant: str) -> NDArray[np.float64]:
    """Return the rotations (n, 3, 3) that three numbers meant which became R when `read` as another order.

    Both are a pair of COLUMNS_REVERSED, whose first column is read as the angle about x. Programs write a middle
    angle within 90 degrees of zero, as is found here.
    """
    return Rotation.from_euler(
        meant, angles_of(R, read if read.islower() else read.lower()[::-1])
    ).as_matrix()


def _writes(angles: NDArray[np.float64], way: str) -> NDArray[np.bool_]:
    """Tell whether a program writes such angles (n, 3)."""
    if way == VECTOR:
        return np.asarray(np.linalg.norm(angles, axis=1) <= np.pi + _LOCKED)
    middle = np.abs(angles[:, "xyz".index(way[1])]) <= np.pi / 2 + _LOCKED
    return middle & (np.abs(angles) <= np.pi + _LOCKED).all(axis=1)


def angles_of(R: NDArray[np.float64], way: str) -> NDArray[np.float64]:
    """Return three numbers (n, 3), that of each axis in its column, rad; the middle one within 90 degrees of 0."""
    if way == VECTOR:
        return Rotation.from_matrix(R).as_rotvec()
    i, j, k = ("xyz".index(axis) for axis in way)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    cosine = np.hypot(R[:, i, i], R[:, j, i])
    free = cosine > _LOCKED  # else only the sum or difference of the outer angles is known
    angles = np.empty((len(R), 3))
    angles[:, j] = np.arctan2(-sign * R[:, k, i], cosine)
    angles[:, k] = np.where(free, np.arctan2(sign * R[:, j, i], R[:, i, i]), 0.0)
    angles[:, i] = np.where(
        free, np.arctan2(sign * R[:, k, j], R[:, k, k]), np.arctan2(-sign * R[:, j, k], R[:, j, j])
    )
    return angles


def from_angles(angles: NDArray[np.float64], way: str) -> NDArray[np.float64]:
    """Return the rotations (n, 3, 3) that angles (n, 3), rad, mean one way."""
    if way == VECTOR:
        return Rotation.from_rotvec(angles).as_matrix()
    return Rotation.from_euler(way, angles[:, ["xyz".index(axis) for axis in way]]).as_matrix()
