"""From a motion of the probe's tip to joints: damped least squares (the paper's Eq. 10), within the arm's limits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.errors import InputError, arg, message

_LENGTH_M = 0.3  # an arm's length for which 1 rad counts as much as 0.3 m
_SCALE = np.repeat([1 / _LENGTH_M, 1.0], 3)
_NEAR = 0.05  # smallest singular value below which it is damped; at 0 by as much
_MARGIN = 0.02  # rad or m that are kept from a limit
# Of an arm's acceleration; the rest is the servo's, which else cannot make up for what it is behind: set-points at the
# limit had an Elfin3 fall 8 mm behind within half a second, and swing.
_PLANNED = 0.6


class MotionLimit(StrEnum):
    """What kept the arm from going as it should."""

    SPEED = message("joint speed")
    LIMIT = message("joint limit")
    SINGULAR = "singularity"


@dataclass(frozen=True, eq=False)
class JointStep:
    """One step of the joints."""

    q: NDArray[np.float64]  # (n,) next joints
    share: float  # of the motion that was wanted, 0 to 1: the direction is kept, the length cut
    held: tuple[MotionLimit, ...]  # why it was cut, or bent by damping
    joint: int | None  # which one is at its limit
    smallest: float  # smallest singular value of the Jacobian, metres scaled by 0.3 m; 0 is a singularity


def tip_jacobian(J: NDArray[np.float64], lever: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the Jacobian (6, n) of a point that E carries at `lever` (3,), m in B, from that of E's origin."""
    x, y, z = lever.tolist()
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    moved = J.copy()
    moved[:3] -= cross @ J[3:]  # v + w x lever = v - lever x w
    return moved


def solve_step(
    arm: Arm,
    q: NDArray[np.float64],
    lever: NDArray[np.float64],
    twist: NDArray[np.float64],
    dt: float,
    before: NDArray[np.float64] | None = None,
) -> JointStep:
    """
    Return the joints that move a tip by twist times dt.

    dq = J^T (J J^T + lambda² I)^-1 e with translation divided by 0.3 m, so that both halves of e are of one kind.
    lambda is 0 until the smallest singular value falls below 0.05, and grows smoothly towards the singularity.

    Parameters
    ----------
    q : (n,)
        Set-points of the step before.
    lever : (3,)
        From E's origin to the tip, in B, m.
    twist : (6,)
        Velocity of the tip and angular velocity, in B, m/s and rad/s.
    dt : float
        s.
    before : (n,), optional
        Joint speeds of the step before, per s: then accelerations are limited, too.
    """
    # As they stand in the middle of the step: from its beginning, a quick turn would draw the tip back, each time.
    middle = lever + np.cross(twist[3:], lever) * dt / 2
    on = q if before is None else q + before * dt / 2
    J = tip_jacobian(arm.flange_jacobian(on), middle) * _SCALE[:, None]
    e = twist * _SCALE * dt
    U, sizes, Vt = np.linalg.svd(J, full_matrices=False)
    smallest = float(sizes[-1])
    damping = 0.0 if smallest >= _NEAR else _NEAR**2 * (1 - (smallest / _NEAR) ** 2)
    dq = Vt.T @ (sizes / (sizes**2 + damping) * (U.T @ e))
    held: list[MotionLimit] = [MotionLimit.SINGULAR] if damping else []
    share = _share(np.abs(dq), arm.velocity_limits * dt)
    if share < 1:
        held.append(MotionLimit.SPEED)
    dq = share * dq
    if before is not None:
        reach = _PLANNED * arm.acceleration_limits * dt * dt
        # The change of speed is limited as a whole: a joint alone would bend the path.
        change = dq - before * dt
        dq = before * dt + _share(np.abs(change), reach) * change
    room, joint = _room(arm, q, dq)
    if room < 1:
        held.append(MotionLimit.LIMIT)
    return JointStep(q + room * dq, share * room, tuple(held), joint, smallest)


def _share(sizes: NDArray[np.float64], most: NDArray[np.float64]) -> float:
    ratio = float((sizes / most).max())
    return 1.0 if ratio <= 1 else 1 / ratio


def _room(arm: Arm, q: NDArray[np.float64], dq: NDArray[np.float64]) -> tuple[float, int | None]:
    """Return how much of a step the limits leave, and which joint says so; a way back inside is always free."""
    low, high = arm.lower + _MARGIN, arm.upper - _MARGIN
    steps = dq.tolist()
    free = np.where(dq > 0, high - q, q - low).tolist()
    least, which = 1.0, None
    for joint, (step, room) in enumerate(zip(steps, free, strict=True)):
        if step != 0 and room < abs(step) * least:
            least, which = max(room, 0.0) / abs(step), joint
    return least, which


# ---- admittance ----------------------------------------------------------------------------------


class Admittance:
    """
    One axis of M du/dt + D u + K s = e: the error e drives a speed u, whose path is s.

    It is solved exactly for an error that is constant over a step, so that no step is too long for it; the paper's
    explicit step needs dt < 2 M / D. With K = 0, as in the paper, the speed that an error drives lasts until the
    error is gone.

    Parameters
    ----------
    mass, damping, stiffness : float
        M, D, K; for a force error kg, N·s/m, N/m; for a torque kg·m², N·m·s/rad, N·m/rad.

    Attributes
    ----------
    speed, path : float
        u and s; m/s and m, or rad/s and rad.

    Raises
    ------
    InputError
        Mass or damping is not positive, or the stiffness negative.
    """

    def __init__(self, mass: float, damping: float, stiffness: float = 0.0) -> None:
        if not (0 < mass < math.inf and 0 < damping < math.inf and 0 <= stiffness < math.inf):
            raise InputError(
                f"admittance: mass {arg(mass)}, damping {arg(damping)}, stiffness {arg(stiffness)}: the"
                " first two must be positive, the last 0 or more."
            )
        self.mass, self.damping, self.stiffness = mass, damping, stiffness
        self.speed = self.path = 0.0

    def reset(self, speed: float = 0.0) -> None:
        """Forget the path; go on at a speed."""
        self.speed, self.path = speed, 0.0

    def step(self, error: float, dt: float) -> float:
        """
        Go on for dt (s) under an error (N or N·m); returns the mean speed over the step.

        Raises
        ------
        InputError
            A number is not finite, or dt not positive.
        """
        if not (math.isfinite(error) and 0 < dt < math.inf):
            raise InputError(
                f"admittance: error {arg(error)}, dt {arg(dt)}: they must be finite, dt positive."
            )
        before = self.path
        if self.stiffness == 0:
            decay = math.exp(-self.damping * dt / self.mass)
            steady = error / self.damping
            self.path += steady * dt + (self.speed - steady) * (1 - decay) * self.mass / self.damping
            self.speed = steady + (self.speed - steady) * decay
        else:
            self._sprung(error, dt)
        return (self.path - before) / dt

    def hold_back(self, share: float, dt: float, mean: float) -> None:
        """
        Take back what a limit left out of the step before: else it would wind up.

        Parameters
        ----------
        share : float
            Of the motion that was done, 0 to 1.
        dt, mean : float
            Of that step, and what it returned.
        """
        self.path -= (1 - share) * mean * dt
        self.speed *= share

    def _sprung(self, error: float, dt: float) -> None:
        """Solve M s'' + D s' + K s = e: around its rest at e / K, by the roots of the characteristic equation."""
        half, rest = self.damping / (2 * self.mass), error / self.stiffness
        away = self.path - rest
        inner = half * half - self.stiffness / self.mass
        decay = math.exp(-half * dt)
        # cosh and sinh / root, which are cos and sin / root below critical damping, and 1 and dt at it.
        if inner > 1e-12 * half * half:
            root = math.sqrt(inner)
            # exp(-(half - root) dt): the product of a vanishing and an overflowing exponential is never formed.
            slow, fast = math.exp(-(half - root) * dt), math.exp(-(half + root) * dt)
            c, s = (slow + fast) / 2, (slow - fast) / (2 * root)
        elif inner < -1e-12 * half * half:
            root = math.sqrt(-inner)
            c, s = decay * math.cos(root * dt), decay * math.sin(root * dt) / root
        else:
            c, s = decay, decay * dt
        along = self.speed + half * away
        self.path = rest + away * c + along * s
        self.speed = self.speed * c - (half * self.speed + self.stiffness / self.mass * away) * s


# ---- what a controller needs to know of what carries the probe -----------------------------------


class Arm(Protocol):
    """
    A chain of n joints from the base B to the flange E; `contactbench.pipeline.robot.Robot` is one.

    Joint values are rad, or m for one that slides; B stands upright and is taken as the world W.
    """

    @property
    def lower(self) -> NDArray[np.float64]:
        """(n,) lower limits."""

    @property
    def upper(self) -> NDArray[np.float64]:
        """(n,) upper limits."""

    @property
    def velocity_limits(self) -> NDArray[np.float64]:
        """(n,) largest speeds, per s."""

    @property
    def acceleration_limits(self) -> NDArray[np.float64]:
        """(n,) largest accelerations, per s²."""

    def flange_pose(self, q: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return R_BE (3, 3) and p_BE_B (3,), m."""

    def flange_jacobian(self, q: ArrayLike) -> NDArray[np.float64]:
        """Return J (6, n): velocity of E's origin, then angular velocity, both in B, per joint speed."""


class CartesianMount:
    """
    Three slides along B's axes, then three hinges about the moved x, y and z axes, as in `PlatformScene`.

    With all hinges at 0, the flange points down, its x along B's.

    Parameters
    ----------
    reach : float
        m to either side of the origin.
    hardest : (2,) of float
        Largest acceleration of a slide, m/s², and of a hinge, rad/s².
    """

    def __init__(self, *, reach: float = 1.0, hardest: tuple[float, float] = (5.0, 30.0)) -> None:
        self._R_0 = np.diag([1.0, -1.0, -1.0])
        # (6,) m and rad: below a quarter turn, where the hinges lock
        self.upper = np.repeat([reach, 1.2], 3)
        self.lower = -self.upper
        self.velocity_limits = np.repeat([0.25, np.pi / 2], 3)  # (6,) m/s and rad/s
        self.acceleration_limits = np.repeat(hardest, 3)  # (6,) m/s² and rad/s²

    def flange_pose(self, q: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return R_BE (3, 3) and p_BE_B (3,), m."""
        values = np.asarray(q, dtype=np.float64)
        x, y, z = (_turn(axis, angle) for axis, angle in enumerate(values[3:].tolist()))
        return x @ y @ z @ self._R_0, values[:3].copy()

    def flange_jacobian(self, q: ArrayLike) -> NDArray[np.float64]:
        """Return J (6, 6)."""
        values = np.asarray(q, dtype=np.float64)
        x, y = _turn(0, float(values[3])), _turn(1, float(values[4]))
        J = np.zeros((6, 6))
        J[:3, :3] = np.eye(3)
        J[3, 3] = 1.0
        J[3:, 4] = x[:, 1]
        J[3:, 5] = (x @ y)[:, 2]
        return J


def _turn(axis: int, angle: float) -> NDArray[np.float64]:
    c, s = np.cos(angle), np.sin(angle)
    R = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[i, i] = R[j, j] = c
    R[i, j], R[j, i] = -s, s
    return R
