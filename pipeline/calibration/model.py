"""The load's gravity and the sensor's bias: what to take off a reading, and how sure that is.

The twelve parameters from poses: two-stage least squares, then joint maximum likelihood.

Observation model of pose i, with R_i = R_SW and Gaussian noise of known covariance V_i:

    F_i = R_i g + F0,    M_i = L x (R_i g) + M0

The first stage is linear in (g, F0). The second takes the *predicted* R_i g as its regressor: a measured
force would carry its noise into the regressor and shrink L towards zero (errors in variables). Both stages
leave information on the table, because torques too say something about g; Gauss-Newton on all twelve,
weighted by the noise, uses it. Beside the twelve there may be others: what a drift adds to the readings, or a
turn of the sensor on its mount (see `nuisance`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration.poses import Stack
from contactbench.pipeline.errors import InputError, arg

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


# ---- the twelve parameters from poses: two-stage least squares, then joint maximum likelihood ----


# What a parameter could be if the poses say nothing of it: N, N, m, N·m. Only directions that the poses do
# not show get this uncertainty; it is wide, so that everything computed from it says "unknown".
UNKNOWN = np.repeat([20.0, 20.0, 0.3, 3.0], 3)
# A rotation of which the poses say nothing: any angle is as likely as another, rad.
ANY_TURN = np.pi / np.sqrt(3)

# Orientations are known to some tenths of a degree. What poses separate by less than this (as a sine, per
# pose) they do not separate: a noise-free set spun about the vertical is as blind as one spun nearly so.
BLIND = 2e-3

ALL = np.ones(12, dtype=bool)
_THREE = np.eye(3)
_RIDGE = 1e-6

_NEWTON_STEPS, _HALVINGS = 25, 12
_CONVERGED = 1e-2  # of a standard deviation; what is left is a hundred times less
_SINGULAR = 1e-12
_FELT = 5.0
_TINY = 1e-300  # N²: a variance beside another that is 1e20 times larger may come out as nothing
_ROUNDING = 1 + 1e-12  # at the maximum a step neither helps nor harms


@dataclass(frozen=True, eq=False)
class PoseNoise:
    """Standard deviation of a pose's *mean* reading: what averaging leaves, drift and hum included.

    Parameters
    ----------
    force : float or (3,)
        N, per axis of S.
    torque : float or (3,)
        N·m, per axis of S.
    estimated : bool
        The values come from the poses themselves.
    freedom : (float, float)
        Degrees of freedom behind the two values; infinite for values that are known.
    least : (6,)
        What the scatter within the poses says the noise is at least, N and N·m.
    orientation : float
        1 sigma of the poses' orientations, about each axis, rad: it moves the weight in the reading.
    """

    force: float | NDArray[np.float64]
    torque: float | NDArray[np.float64]
    estimated: bool = False
    freedom: tuple[float, float] = (np.inf, np.inf)
    least: NDArray[np.float64] = field(default_factory=lambda: np.zeros(6))
    orientation: float = 0.0

    def __post_init__(self) -> None:
        for name, value, unit in (("force", self.force, "N"), ("torque", self.torque, "N·m")):
            array = np.asarray(value, dtype=np.float64)
            if array.shape not in {(), (3,)} or not np.isfinite(array).all() or (array <= 0).any():
                raise InputError(
                    f"PoseNoise.{arg(name)}: give one or three finite numbers above 0, {arg(unit)}, not {arg(value)!r}"
                )
        if not 0 <= self.orientation < np.inf:
            raise InputError(
                f"PoseNoise.orientation: give a finite angle of at least 0, rad, not {arg(self.orientation)!r}"
            )

    @property
    def sigmas(self) -> NDArray[np.float64]:
        """(6,) standard deviations, N and N·m."""
        both = np.empty(6)
        both[:3], both[3:] = self.force, self.torque
        return both

    def covariances(self, R_SW: NDArray[np.float64], theta: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the covariance (n, 6, 6) of readings at R_SW (n, 3, 3) about parameters `theta` (12,)."""
        G = turn_jacobian(R_SW, theta)
        V: NDArray[np.float64] = self.orientation**2 * (G @ G.swapaxes(1, 2))
        V[:, range(6), range(6)] += self.sigmas**2
        return V


@dataclass(frozen=True, eq=False)
class Terms:
    """What may be in the readings beside bias and weight."""

    # (n, 6, m) what each unknown adds to the readings, N and N·m for one unit of it
    columns: NDArray[np.float64]
    widths: NDArray[np.float64]  # (m,) what each could be if the readings say nothing of it
    # The sensor is turned on its mount by an unknown rotation: three more unknowns, before the others
    turns: bool = False

    def take(self, chosen: NDArray[np.bool_]) -> Terms:
        """Return the terms of some of the poses."""
        return Terms(self.columns[chosen], self.widths, self.turns)

    @property
    def scale(self) -> NDArray[np.float64]:
        """(p,) widths of all parameters: the twelve, a rotation vector if there is one, and the others."""
        return np.concatenate([UNKNOWN, np.full(3 if self.turns else 0, ANY_TURN), self.widths])


def nothing_beside(count: int) -> Terms:
    """Return no terms, for `count` poses."""
    return Terms(np.zeros((count, 6, 0)), np.zeros(0))


@dataclass(frozen=True, eq=False)
class Fit:
    """A maximum of the likelihood."""

    theta: NDArray[np.float64]  # (12,) in the order of PARAMETERS
    # (p, p) inverse of the information matrix, of the twelve, then of the terms' unknowns; directions that
    # the poses do not show have the width of UNKNOWN
    covariance: NDArray[np.float64]
    residuals: NDArray[np.float64]  # (n, 6) read minus predicted, in standard deviations of the noise
    J: NDArray[np.float64]  # (n, 6, p) change of the predictions with the free parameters, in the same unit
    free: NDArray[np.bool_]  # (12,) parameters that were fitted
    added: NDArray[np.float64]  # (m,) the terms' unknowns, without the rotation
    # (3, 3) by which the sensor is turned from where it was said to be: ``R_SW <- mount @ R_SW``
    mount: NDArray[np.float64]
    R_SW: NDArray[np.float64]  # (n, 3, 3) orientations, so turned
    terms: Terms

    @property
    def cost(self) -> float:
        """Sum of the squared residuals, chi-square distributed for a right model."""
        return float(np.vdot(self.residuals, self.residuals))

    @property
    def beside(self) -> NDArray[np.float64]:
        """(p - 12,) the terms' unknowns, with the rotation vector of the mount before them if it was free."""
        turn = Rotation.from_matrix(self.mount).as_rotvec() if self.terms.turns else np.zeros(0)
        return np.concatenate([turn, self.added])

    @property
    def offsets(self) -> NDArray[np.float64]:
        """(n, 6) what the terms add to the readings, N and N·m."""
        offsets: NDArray[np.float64] = self.terms.columns @ self.added
        return offsets

    def left(self, poses: Stack, terms: Terms) -> NDArray[np.float64]:
        """Return read minus predicted (n, 6), N and N·m, of any poses; `terms` are those of the same poses."""
        predicted = predict(self.mount @ poses.R_SW, self.theta)
        left: NDArray[np.float64] = poses.wrenches - predicted - terms.columns @ self.added
        return left


def two_stage(poses: Stack) -> NDArray[np.float64]:
    """Return the parameters (12,) by least squares: (g, F0) from forces, then (L, M0) from torques."""
    g, F0 = solve_with_offset(poses.R_SW, poses.F)
    L, M0 = solve_with_offset(-cross_matrix(poses.R_SW @ g), poses.M)
    return np.concatenate([g, F0, L, M0])


def solve_with_offset(
    A: NDArray[np.float64], b: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return x and offset, each (..., 3), that minimise sum |A_i x + offset - b_i|².

    Where the rows leave a direction of x open, x is zero along it; elsewhere it is shorter than it should
    be by a few parts in 10,000, which is good enough to start from.

    Parameters
    ----------
    A : (..., n, 3, 3)
    b : (..., n, 3)
    """
    middle_A, middle_b = A.mean(axis=-3), b.mean(axis=-2)
    rows = (A - middle_A[..., None, :, :]).reshape(*A.shape[:-3], -1, 3)
    turned = rows.swapaxes(-1, -2)
    square, right = turned @ rows, turned @ (b - middle_b[..., None, :]).reshape(*b.shape[:-2], -1, 1)
    # As large as what poses that differ by a tenth of a degree would add; a little more against 0 / 0.
    ridge = _RIDGE * (A * A).sum(axis=(-1, -2, -3)) + 1e-30
    x = np.linalg.solve(square + ridge[..., None, None] * _THREE, right)
    return x[..., 0], middle_b - (middle_A @ x)[..., 0]


def predict(R_SW: NDArray[np.float64], theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the (n, 6) readings of an untouched sensor at orientations R_SW (n, 3, 3)."""
    weight = R_SW @ theta[GRAVITY]
    predicted = np.empty((len(R_SW), 6))
    predicted[:, :3] = weight + theta[FORCE_BIAS]
    predicted[:, 3:] = weight @ cross_matrix(theta[CENTRE_OF_MASS]).T + theta[TORQUE_BIAS]
    return predicted


def turn_jacobian(R_SW: NDArray[np.float64], theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how predictions change (n, 6, 3) with a rotation vector d, S, rad: ``R <- exp([d]x) R_SW``."""
    G: NDArray[np.float64] = np.empty((len(R_SW), 6, 3))
    G[:, :3] = -cross_matrix(R_SW @ theta[GRAVITY])
    G[:, 3:] = cross_matrix(theta[CENTRE_OF_MASS]) @ G[:, :3]
    return G


def jacobian(
    R_SW: NDArray[np.float64], theta: NDArray[np.float64], free: NDArray[np.bool_], terms: Terms
) -> NDArray[np.float64]:
    """Return how predictions change (n, 6, p) with the free parameters and with the terms, N and N·m."""
    parts = [prediction_jacobian(R_SW, theta) * free]
    if terms.turns:
        parts.append(turn_jacobian(R_SW, theta))
    return np.concatenate([*parts, terms.columns], axis=2)


def whitener(V: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return W (n, k, k) such that W r has unit covariance for r of covariance V (n, k, k)."""
    each = range(V.shape[1])
    d = 1 / np.sqrt(V[:, each, each])
    C = V * d[:, :, None] * d[:, None] + _SINGULAR * np.eye(len(each))  # orientations alone leave V singular
    return np.asarray(np.linalg.inv(np.linalg.cholesky(C)) * d[:, None], dtype=np.float64)


def maximise(
    poses: Stack,
    noise: NDArray[np.float64],
    start: NDArray[np.float64],
    free: NDArray[np.bool_] = ALL,
    terms: Terms | None = None,
    added: NDArray[np.float64] | None = None,
    mount: NDArray[np.float64] = _THREE,
) -> Fit:
    """Maximise the likelihood from `start` by Gauss-Newton.

    Parameters
    ----------
    poses : Stack
    noise : (6,) or (n, 6, 6)
        Standard deviations of a pose's mean, N and N·m, or the covariance of each pose.
    start : (12,)
        Near the maximum: the answer of `two_stage`.
    free : (12,) bool
        Parameters to fit; the others stay where they are.
    terms : Terms, optional
        What else may be in the readings.
    added : (m,), optional
    mount : (3, 3)
        Where to start with it.
    """
    terms = terms or nothing_beside(len(poses))
    W = np.diag(1 / noise)[None] if noise.ndim == 1 else whitener(noise)
    scale = terms.scale
    theta, R_SW = start, mount @ poses.R_SW
    added = np.zeros(len(terms.widths)) if added is None else added
    residuals = _residuals(poses, W, R_SW, theta, terms, added)
    for _ in range(_NEWTON_STEPS):
        scaled = (W @ jacobian(R_SW, theta, free, terms) * scale).reshape(-1, len(scale))
        gradient, information = scaled.T @ residuals.ravel(), scaled.T @ scaled
        # Nothing beside what the readings say; it keeps the step short where they say nothing.
        least = _least_information(information) * np.eye(len(scale))
        step = np.linalg.solve(information + least, gradient)
        better, cost = False, float(np.vdot(residuals, residuals))
        for halving in range(_HALVINGS):  # the model is bilinear, so the whole step is nearly always good
            d = 0.5**halving * scale * step
            turn = Rotation.from_rotvec(d[12:15]).as_matrix() if terms.turns else _THREE
            there = theta + d[:12], turn @ mount, added + d[len(d) - len(added) :]
            attempt = _residuals(poses, W, there[1] @ poses.R_SW, there[0], terms, there[2])
            better = bool(np.vdot(attempt, attempt) <= cost * _ROUNDING)
            if better:
                (theta, mount, added), residuals = there, attempt
                R_SW = mount @ poses.R_SW
                break
        # The step's length in standard deviations; each is many times shorter than the one before.
        if not better or step @ gradient < _CONVERGED**2:
            break
    J = W @ jacobian(R_SW, theta, free, terms)
    return Fit(theta, parameter_covariance(J, scale), residuals, J, free, added, mount, R_SW, terms)


def _residuals(
    poses: Stack,
    W: NDArray[np.float64],
    R_SW: NDArray[np.float64],
    theta: NDArray[np.float64],
    terms: Terms,
    added: NDArray[np.float64],
) -> NDArray[np.float64]:
    left = poses.wrenches - predict(R_SW, theta) - terms.columns @ added
    whitened: NDArray[np.float64] = (W @ left[..., None])[..., 0]
    return whitened


def parameter_covariance(J: NDArray[np.float64], scale: NDArray[np.float64] = UNKNOWN) -> NDArray[np.float64]:
    """Return the inverse of the information in Jacobians J (n, 6, p), which are over the noise.

    Directions that the readings say less of than `scale` (p,), and parameters that are not free, get its
    width: the result is always finite, and never claims what was not seen.
    """
    scaled = (J * scale).reshape(-1, len(scale))
    information = scaled.T @ scaled
    values, vectors = np.linalg.eigh(information)
    unseen = values < _least_information(information)
    root = scale[:, None] * vectors / np.sqrt(np.where(unseen, 1.0, values))
    covariance: NDArray[np.float64] = root @ root.T
    return covariance


def _least_information(information: NDArray[np.float64]) -> float:
    """Return what counts as none: 1 / UNKNOWN², or what rounding makes of nothing where the noise is tiny."""
    return max(1.0, _SINGULAR * float(information.max()))


def felt(theta: NDArray[np.float64], covariance: NDArray[np.float64]) -> bool:
    """Tell whether the weight is five standard deviations from zero, along any direction that is known.

    Below that, the centre of mass is a ratio of two numbers that are both noise.
    """
    variances, axes = np.linalg.eigh(covariance[GRAVITY, GRAVITY])
    return float(((axes.T @ theta[GRAVITY]) ** 2 / np.maximum(variances, _TINY)).sum()) > _FELT**2
