"""From a motion of the probe's tip to joints: damped least squares (the paper's Eq. 10), within the arm's limits."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import message

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.control.arms import Arm

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
    J = tip_jacobian(arm.flange_jacobian(q), lever) * _SCALE[:, None]
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
