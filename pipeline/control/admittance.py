"""Admittance: what is pushed moves as a mass in a thick liquid would (the paper's Eq. 7 and 8)."""

from __future__ import annotations

import math

from contactbench.pipeline.errors import InputError, arg


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
