"""Nuisance terms: what may be in the readings beside bias, weight and noise.

Drift and re-zeros change the bias with time; their columns are zero at the session's end, so that the bias beside
them is the one that the sensor has afterwards. A cable and a turned mount depend on the orientation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.model import Terms, cross_matrix

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.poses import Stack

DRIFT, REZERO, CABLE, MOUNT = "drift", "rezero", "cable", "mount"

# The largest that is thought of: N and N·m.
_FORCE, _TORQUE = 20.0, 1.0
_CHANNELS = np.repeat([_FORCE, _TORQUE], 3)
# A re-zero needs so many poses on either side: a single one cannot be told from a bumped pose.
FEWEST_BESIDE = 2


def drift(poses: Stack, power: int = 1) -> Terms:
    """Return a drift of each channel: linear in time, or with a bend (`power` 2), as while a sensor warms up."""
    before = poses.moments - 1
    columns = [before[:, None, None] ** degree * np.eye(6) for degree in range(1, power + 1)]
    return Terms(np.concatenate(columns, axis=2), np.tile(_CHANNELS, power))


def rezero(poses: Stack, moment: float) -> Terms:
    """Return another bias in all poses before `moment`."""
    earlier = (poses.moments < moment).astype(np.float64)
    return Terms(earlier[:, None, None] * np.eye(6), _CHANNELS)


def rezero_moments(poses: Stack) -> NDArray[np.float64]:
    """Return the moments of the poses before which the sensor may have been re-zeroed."""
    moments = np.unique(poses.moments)
    return moments[FEWEST_BESIDE : max(len(moments) - FEWEST_BESIDE + 1, FEWEST_BESIDE)]


def cable(poses: Stack, down_W: NDArray[np.float64]) -> Terms:
    """Return what pulls with the orientation otherwise than a weight does.

    With u the direction of gravity in S: a symmetric matrix times u in the force (a multiple of u is weight, an
    antisymmetric one a turned mount), one in the torque (there, an antisymmetric one is the centre of mass); and
    what a force that stays in the room does on a lever that is not the weight's, ``p x R_SW c`` for horizontal c.
    """
    u = poses.R_SW @ down_W
    symmetric = _symmetric(u)
    columns = np.zeros((len(u), 6, 5 + 6 + 6))
    columns[:, :3, :5] = symmetric[:, :, :5]
    columns[:, 3:, 5:11] = symmetric
    level = np.linalg.svd(down_W[None])[2][1:]
    for index, axis_W in enumerate(level):
        columns[:, 3:, 11 + 3 * index : 14 + 3 * index] = -cross_matrix(poses.R_SW @ axis_W)
    return Terms(columns, np.array([_FORCE] * 5 + [_TORQUE] * 12))


def _symmetric(u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return S_k u (n, 3, 6) for a basis S_k of the symmetric matrices; the last is a multiple of 1."""
    x, y, z = u.T
    nought = np.zeros_like(x)
    columns = [
        (y, x, nought),
        (z, nought, x),
        (nought, z, y),
        (x, -y, nought),
        (x, y, -2 * z),
        (x, y, z),
    ]
    return np.stack([np.stack(column, axis=1) for column in columns], axis=2)


def mount(poses: Stack) -> Terms:
    """Return a turn of the sensor on its mount."""
    return Terms(np.zeros((len(poses), 6, 0)), np.zeros(0), turns=True)
