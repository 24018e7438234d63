"""The load's gravity and the sensor's bias: what to take off a reading, and how sure that is."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import InputError, arg

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

STANDARD_GRAVITY = 9.80665  # m/s²
DOWN_W = (0.0, 0.0, -1.0)  # where gravity points if nobody says otherwise: W has z up
_IDENTITY = np.eye(3)
# Row k holds, flattened, what component k of v contributes to [v]x: one product makes many matrices.
_CROSS = np.array(
    [[0, 0, 0, 0, 0, -1, 0, 1, 0], [0, 0, 1, 0, 0, 0, -1, 0, 0], [0, -1, 0, 1, 0, 0, 0, 0, 0]], float
)
_SURE = 3.0  # a vector this many times longer than its uncertainty has a direction

# The order of the parameters in every vector and covariance of this package.
GRAVITY, FORCE_BIAS, CENTRE_OF_MASS, TORQUE_BIAS = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12)
PARAMETERS = (
    *(f"gravity_W_{axis}" for axis in "xyz"),
    *(f"force_bias_{axis}" for axis in "xyz"),
    *(f"centre_of_mass_S_{axis}" for axis in "xyz"),
    *(f"torque_bias_{axis}" for axis in "xyz"),
)


def length(v: NDArray[np.float64]) -> float:
    """Return the length of a vector (3,), with the same bits on every processor, which `np.linalg.norm` has not."""
    x, y, z = v.tolist()
    return math.sqrt(x * x + y * y + z * z)


@dataclass(frozen=True, eq=False)
class GravityModel:
    """The reading of a still, untouched sensor with a load.

        F = R_SW g_W + F0,    M = L_S x (R_SW g_W) + M0

    (Cao et al. 2023, Eq. 1, with the gravity vector free to absorb a tilted base).

    Parameters
    ----------
    gravity_W : array_like (3,)
        Weight of the load as a vector in the world frame W (z up), N: downwards, so z is negative.
    force_bias, torque_bias : array_like (3,)
        F0, M0: the sensor's reading without load, S, N and N·m about the sensor origin.
    centre_of_mass_S : array_like (3,)
        L: from the sensor origin to the load's centre of mass, S, m.
    covariance : array_like (12, 12), optional
        Of gravity_W, force_bias, centre_of_mass_S, torque_bias, in this order; zero when left out.

    Raises
    ------
    InputError
        A shape is wrong or a value is not finite.
    """

    gravity_W: NDArray[np.float64]
    force_bias: NDArray[np.float64]
    centre_of_mass_S: NDArray[np.float64]
    torque_bias: NDArray[np.float64]
    covariance: NDArray[np.float64] = field(default_factory=lambda: np.zeros((12, 12)))

    def __post_init__(self) -> None:
        for name in ("gravity_W", "force_bias", "centre_of_mass_S", "torque_bias"):
            object.__setattr__(self, name, _finite(name, getattr(self, name), (3,)))
        object.__setattr__(self, "covariance", _finite("covariance", self.covariance, (12, 12)))

    @classmethod
    def from_vector(cls, theta: NDArray[np.float64], covariance: NDArray[np.float64]) -> GravityModel:
        """Return the model whose twelve parameters are `theta`, in the order of PARAMETERS."""
        return cls(theta[GRAVITY], theta[FORCE_BIAS], theta[CENTRE_OF_MASS], theta[TORQUE_BIAS], covariance)

    @property
    def vector(self) -> NDArray[np.float64]:
        """The twelve parameters, in the order of PARAMETERS."""
        return np.concatenate([self.gravity_W, self.force_bias, self.centre_of_mass_S, self.torque_bias])

    @property
    def mass(self) -> float:
        """Mass of the load, kg."""
        return length(self.gravity_W) / STANDARD_GRAVITY

    @property
    def mass_sigma(self) -> float:
        """Standard deviation of the mass, kg; in the worst direction, where the weight's own is hardly known."""
        g, C = self.gravity_W, self.covariance[GRAVITY, GRAVITY]
        size, worst = float(np.linalg.norm(g)), float(np.sqrt(np.linalg.norm(C, 2)))
        if size < _SURE * worst:
            return worst / STANDARD_GRAVITY
        return float(np.sqrt(max(float(g @ C @ g), 0.0))) / size / STANDARD_GRAVITY

    def predict(self, R_WS: ArrayLike) -> NDArray[np.float64]:
        """Return the reading of the untouched sensor at orientations R_WS.

        Parameters
        ----------
        R_WS : array_like (3, 3) or (n, 3, 3)

        Returns
        -------
        (6,) or (n, 6)
            Force before torque, S, N and N·m.
        """
        R = np.asarray(R_WS, dtype=np.float64)
        weight_S = self.gravity_W @ R  # R_WS^T g, for one or many
        torque = np.cross(self.centre_of_mass_S, weight_S)
        return np.concatenate([weight_S + self.force_bias, torque + self.torque_bias], axis=-1)

    def compensate(self, R_WS: ArrayLike, wrench: ArrayLike) -> NDArray[np.float64]:
        """Return the force and torque of the tissue on the probe: the reading without bias and weight (Eq. 1).

        Parameters
        ----------
        R_WS : array_like (3, 3) or (n, 3, 3)
            Orientation of the sensor at each reading; one serves for all readings.
        wrench : array_like (6,) or (n, 6)
            Readings, S, N and N·m about the sensor origin.

        Returns
        -------
        (6,) or (n, 6)

        Raises
        ------
        InputError
            The shapes do not fit.
        """
        w, R = np.asarray(wrench, dtype=np.float64), np.asarray(R_WS, dtype=np.float64)
        if w.shape[-1:] != (6,) or R.shape[-2:] != (3, 3) or R.shape[:-2] not in {(), w.shape[:-1]}:
            raise InputError(
                f"compensate: wrench {arg(w.shape)} and R_WS {arg(R.shape)} do not fit: give (6,) with (3, 3),"
                " or (n, 6) with (3, 3) or (n, 3, 3)"
            )
        return w - self.predict(R)

    def wrench_covariance(self, R_WS: ArrayLike) -> NDArray[np.float64]:
        """Return what the calibration leaves uncertain in a compensated wrench.

        Give it to ``WrenchNoise(extra=...)``, so that a contact's uncertainty includes it.

        Parameters
        ----------
        R_WS : array_like (3, 3) or (n, 3, 3)

        Returns
        -------
        (6, 6) or (n, 6, 6)
            Force before torque, N², N²·m, N²·m².
        """
        R = np.asarray(R_WS, dtype=np.float64)
        J = prediction_jacobian(np.swapaxes(R, -1, -2).reshape(-1, 3, 3), self.vector)
        C = J @ self.covariance @ J.transpose(0, 2, 1)
        return 0.5 * (C + C.transpose(0, 2, 1)).reshape(*R.shape[:-2], 6, 6)


def upright(down_W: ArrayLike) -> NDArray[np.float64]:
    """Return the rotation (3, 3) that turns the world by the shortest way so that `down_W` (3,) becomes -z.

    The identity for a robot that stands upright; then orientations seen from it are those of the world.
    """
    down = np.asarray(down_W, dtype=np.float64)
    if down[0] == 0 and down[1] == 0 and down[2] < 0:
        return np.eye(3)
    turned: NDArray[np.float64] = Rotation.align_vectors([[0.0, 0.0, -1.0]], down[None])[0].as_matrix()
    return turned


def prediction_jacobian(R_SW: NDArray[np.float64], theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how the predicted readings change with the parameters.

    Parameters
    ----------
    R_SW : (n, 3, 3)
    theta : (12,)

    Returns
    -------
    (n, 6, 12)
        Rows Fx Fy Fz Mx My Mz, columns as PARAMETERS.
    """
    J = np.zeros((len(R_SW), 6, 12))
    J[:, :3, GRAVITY] = R_SW
    J[:, :3, FORCE_BIAS] = J[:, 3:, TORQUE_BIAS] = _IDENTITY
    J[:, 3:, GRAVITY] = cross_matrix(theta[CENTRE_OF_MASS]) @ R_SW
    J[:, 3:, CENTRE_OF_MASS] = -cross_matrix(R_SW @ theta[GRAVITY])
    return J


def cross_matrix(v: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return [v]x with [v]x a = v x a, for (..., 3) vectors."""
    matrices: NDArray[np.float64] = (v @ _CROSS).reshape(*v.shape, 3)
    return matrices


def _finite(name: str, value: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.float64]:
    array = np.array(value, dtype=np.float64)
    if array.shape != shape or not np.isfinite(array).all():
        raise InputError(
            f"GravityModel.{arg(name)}: give finite numbers of shape {arg(shape)}, not {arg(array.shape)}"
        )
    array.flags.writeable = False
    return array
