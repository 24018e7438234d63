"""A start for the mount's rotation in closed form (Kabsch 1976)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.calibration.fit import solve_with_offset
from contactbench.pipeline.calibration.model import (
    CENTRE_OF_MASS,
    FORCE_BIAS,
    GRAVITY,
    TORQUE_BIAS,
    cross_matrix,
    upright,
)
from contactbench.pipeline.calibration.outliers import LARGEST_SHARE
from contactbench.pipeline.calibration.reml import LEAST

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration.poses import Stack
    from contactbench.pipeline.calibration.reml import NoisePrior
from contactbench.pipeline.calibration.mounting.turns import turn

# Where gravity may point in W: down; else the sensor or the orientations are turned over, or W is.
DOWNS = np.array([[0.0, 0, -1], [0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]])


_ANOTHER = 20.0  # doubled log likelihood by which another direction must be better than down


_SETS, _REFINED, _FEWEST = 100, 10, 5


_MEDIAN = 2.366  # of the sum of three squared standard normal numbers


_ROUNDS, _RIDGE = 3, 1e-4


def start_rotation(flange: Stack, prior: NoisePrior, down_W: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return R_SE (3, 3) of the smallest trimmed sum of squares.

    From many sets of four poses, with gravity that points down; or, where that explains the poses far
    better, up or along a horizontal axis: a wrench of the opposite sign, or a base on a wall of which nobody spoke.
    """
    downs = DOWNS @ upright(down_W)
    n = len(flange)
    size = min(n, max(n - int(LARGEST_SHARE * n), _FEWEST))
    ways = np.repeat(np.arange(len(downs)), _SETS)
    sets = np.random.default_rng(0).random((len(ways), n)).argpartition(3, axis=1)[:, :4]
    variances = None if prior.sigmas is None else (prior.sigmas**2).reshape(2, 3).mean(axis=1)
    for leading in (_REFINED, _REFINED, 1):  # concentration: fit the majority, see who the majority is now
        R, theta = _start(flange.R_SW[sets], flange.wrenches[sets], downs[ways])
        squares = _squares(flange, R, theta)
        if variances is None:
            variances = np.maximum(np.median(squares, axis=1).min(axis=0) / _MEDIAN, LEAST[[0, 3]] ** 2)
        total = squares @ (1 / variances)
        sets = np.argsort(total, axis=1)[:, :size]
        trimmed = np.take_along_axis(total, sets, axis=1).sum(axis=1)
        order = np.lexsort((trimmed, ways)).reshape(len(downs), -1)[:, :leading].ravel()
        sets, ways, trimmed = sets[order], ways[order], trimmed[order]
    gain = (6 * size - 15) * np.log((trimmed[0] + 1) / (trimmed + 1))
    way = int(np.argmax(gain)) if gain.max() > _ANOTHER else 0
    R_SE: NDArray[np.float64] = R[order][way]
    return R_SE


def _start(
    E: NDArray[np.float64], wrenches: NDArray[np.float64], down_W: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return R_SE (k, 3, 3) and parameters (k, 12) of sets of poses, from forces, then torques.

    Parameters
    ----------
    E : (k, m, 3, 3)
        R_EW.
    wrenches : (k, m, 6)
    down_W : (k, 3)
        Where gravity points, roughly.
    """
    F, M = wrenches[..., :3], wrenches[..., 3:]
    dF = centred(F)
    u = centred((E @ down_W[:, None, :, None])[..., 0])
    U, s, Vt = np.linalg.svd(dF.swapaxes(1, 2) @ u)
    sign = np.linalg.det(U @ Vt)  # the nearest rotation, not the nearest mirror
    U[:, :, 2] *= sign[:, None]
    s[:, 2] *= sign
    R = U @ Vt
    weight = np.maximum(s.sum(axis=1) / np.maximum((u**2).sum(axis=(1, 2)), 1e-12), 1e-9)
    g = weight[:, None] * down_W
    for _ in range(_ROUNDS):  # of Gauss-Newton on gravity and rotation: the base may be tilted
        R_SW = R[:, None] @ E
        v = (R_SW @ g[:, None, :, None])[..., 0]
        rows = centred(np.concatenate([R_SW, -cross_matrix(v) / weight[:, None, None, None]], axis=3))
        rows = rows.reshape(len(E), -1, 6)
        square = rows.swapaxes(1, 2) @ rows
        ridge = _RIDGE * np.trace(square, axis1=1, axis2=2)[:, None, None] + 1e-30
        right = rows.swapaxes(1, 2) @ (dF - centred(v)).reshape(len(E), -1, 1)
        step = np.linalg.solve(square + ridge * np.eye(6), right)[..., 0]
        g, R = g + step[:, :3], turn(step[:, 3:] / weight[:, None]) @ R
    v = (R[:, None] @ E @ g[:, None, :, None])[..., 0]
    L, M0 = solve_with_offset(-cross_matrix(v), M)
    return R, np.concatenate([g, (F - v).mean(axis=1), L, M0], axis=1)


def centred(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return values (k, m, ...) less their means over the m poses: what is left when a bias is free."""
    centred: NDArray[np.float64] = values - values.mean(axis=1, keepdims=True)
    return centred


def _squares(flange: Stack, R: NDArray[np.float64], theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return |F - predicted|² and |M - predicted|² (k, n, 2) of every pose under every set of parameters."""
    v = np.einsum("kab,nbc,kc->kna", R, flange.R_SW, theta[:, GRAVITY], optimize=True)
    torque = np.cross(theta[:, None, CENTRE_OF_MASS], v)
    forces = flange.F - v - theta[:, None, FORCE_BIAS]
    torques = flange.M - torque - theta[:, None, TORQUE_BIAS]
    return np.stack([(forces**2).sum(axis=2), (torques**2).sum(axis=2)], axis=2)
