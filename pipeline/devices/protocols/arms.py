"""Flange poses of the emulated robots, by their Denavit-Hartenberg tables."""

from collections.abc import Sequence
from math import pi

import numpy as np
from numpy.typing import NDArray

Table = tuple[tuple[float, float, float, float], ...]
"""Offset (rad), d (m), a (m), alpha (rad) of each joint."""

ELFIN3_TABLE: Table = (
    (0, 0.1925, 0, pi / 2),
    (pi / 2, 0, 0.266, pi),
    (pi / 2, 0, 0, pi / 2),
    (0, 0.324, 0, -pi / 2),
    (0, 0, 0, pi / 2),
    (0, 0.155, 0, 0),
)
UR5E_TABLE: Table = (
    (0, 0.1625, 0, pi / 2),
    (0, 0, -0.425, 0),
    (0, 0, -0.3922, 0),
    (0, 0.1333, 0, pi / 2),
    (0, 0.0997, 0, -pi / 2),
    (0, 0.0996, 0, 0),
)


def flange_pose(table: Table, joints: Sequence[float]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return R_BE (3, 3) and p_BE_B (3,) m of joint angles in rad: A = Rz(q + offset) Tz(d) Tx(a) Rx(alpha)."""
    pose = np.eye(4)
    for (offset, d, a, alpha), joint in zip(table, joints, strict=True):
        c, s = np.cos(joint + offset), np.sin(joint + offset)
        ca, sa = np.cos(alpha), np.sin(alpha)
        pose = pose @ np.array(
            [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
        )
    return pose[:3, :3], pose[:3, 3]
