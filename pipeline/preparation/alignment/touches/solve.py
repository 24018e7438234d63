"""Damped Gauss-Newton on the mount: the steps, the weights that bound a wrong touch, and the belief."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.errors import arg
from contactbench.pipeline.preparation.alignment.errors import AlignmentError
from contactbench.pipeline.preparation.alignment.rigid import difference, step

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.preparation.alignment.touches.model import MarkerModel

    Floats = NDArray[np.float64]

_STEPS = 60
_SETTLED = 1e-7  # of a scaled unknown: below a nanometre
_DAMPING = 1e-6
_HOPELESS = 1e12
# Cauchy's loss: a touch at this many sigmas (both directions together) counts half.
_HALF = 3.0


@dataclass(frozen=True)
class MountBelief:
    """
    How far the mount to start from may be off, 1 sigma per axis.

    Touches that know a combination of shift and rotation less well than this do not show it: it stays as it
    was. The ratio of the two is also the length by which rotations and shifts are compared: 95 mm by default.

    Raises
    ------
    AlignmentError
        Not above 0, or beyond 1 m or pi.
    """

    shift: float = 0.005  # of the touched points' centroid, m
    rotation: float = float(np.radians(3.0))  # in radians

    def __post_init__(self) -> None:
        for name, most in (("shift", 1.0), ("rotation", np.pi)):
            value = getattr(self, name)
            if not 0 < value <= most:
                raise AlignmentError(
                    f"MountBelief.{arg(name)}: {arg(value)} is not above 0 and at most {arg(most):.4g} (m, rad)."
                )

    @property
    def scales(self) -> Floats:
        """(6,) units of the scaled unknowns: m, m, m, rad, rad, rad."""
        return np.array([self.shift] * 3 + [self.rotation] * 3)


@dataclass(frozen=True, eq=False)
class MountProblem:
    """What is minimised: the touches' residuals, plus the belief about the mount where it is asked for."""

    model: MarkerModel
    start: Floats  # (4, 4) T_SP to start from, which the belief is about
    about_S: Floats  # (3,) what steps turn about, m
    belief: MountBelief

    def mount(self, z: Floats) -> Floats:
        """Return T_SP for scaled unknowns (6,)."""
        return step(self.start, self.about_S, z * self.belief.scales)

    def unknowns(self, T_SP: Floats) -> Floats:
        """Return the scaled unknowns (6,) of a mount."""
        return difference(T_SP, self.start, self.about_S) / self.belief.scales

    def jacobian(self, T_SP: Floats) -> Floats:
        """Return the derivative (n, 2, 6) by scaled steps from a mount."""
        return self.model.jacobian(T_SP, self.about_S, self.belief.scales)

    def squares(self, T_SP: Floats) -> Floats:
        """Return the squared distance (n,) of each touch in sigmas, of two degrees of freedom each."""
        return np.asarray((self.model.residuals(T_SP) ** 2).sum(axis=1))


def minimise(problem: MountProblem, T_SP: Floats, free: Floats, *, robust: bool, believing: bool) -> Floats:
    """
    Descend from a mount to the nearest minimum.

    Parameters
    ----------
    problem : MountProblem
    T_SP : (4, 4)
        Where to begin.
    free : (6, r)
        Orthonormal directions of scaled steps that may be taken.
    robust : bool
        Weigh touches by Cauchy's loss instead of squares.
    believing : bool
        Add the square of the scaled distance from the problem's start.

    Returns
    -------
    (4, 4) T_SP
    """
    damping = _DAMPING
    cost = loss(problem, T_SP, robust=robust, believing=believing)
    gradient, square = _normal(problem, T_SP, free, robust=robust, believing=believing)
    for _ in range(_STEPS):
        z = free @ np.linalg.solve(
            square + damping * (np.diag(np.diag(square)) + np.eye(len(square))), gradient
        )
        moved = step(T_SP, problem.about_S, -z * problem.belief.scales)
        new = loss(problem, moved, robust=robust, believing=believing)
        if new <= cost:
            T_SP, cost, damping = moved, new, max(damping / 10, 1e-12)
            if np.abs(z).max() < _SETTLED:
                break
            gradient, square = _normal(problem, T_SP, free, robust=robust, believing=believing)
        else:
            damping *= 10
            if np.abs(z).max() < _SETTLED or damping > _HOPELESS:
                break  # rounding leaves nothing to gain
    return T_SP


def loss(problem: MountProblem, T_SP: Floats, *, robust: bool, believing: bool) -> float:
    """Return what `minimise` lowers."""
    squares = problem.squares(T_SP)
    total = float((_HALF**2 * np.log1p(squares / _HALF**2) if robust else squares).sum())
    return total + (float((problem.unknowns(T_SP) ** 2).sum()) if believing else 0.0)


def _normal(
    problem: MountProblem, T_SP: Floats, free: Floats, *, robust: bool, believing: bool
) -> tuple[Floats, Floats]:
    """Return the gradient (r,) and the normal matrix (r, r) along the free directions."""
    r, J = problem.model.residuals(T_SP), problem.jacobian(T_SP)
    if robust:
        root = 1 / np.sqrt(1 + (r**2).sum(axis=1) / _HALF**2)
        r, J = r * root[:, None], J * root[:, None, None]
    r, J = r.ravel(), J.reshape(-1, 6) @ free
    if believing:  # the belief's own derivative is the identity but for second order
        r, J = np.concatenate([r, problem.unknowns(T_SP)]), np.concatenate([J, free])
    return J.T @ r, J.T @ J
