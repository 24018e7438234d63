"""How stiff the tissue is: a small press, twice in and out, before anything is tracked."""

from __future__ import annotations

import math

import numpy as np


class StiffnessProbe:
    """
    A small press, twice in and out, by which the stiffness of what is touched is measured.

    The force is fitted as a + b t + c t² + k s with the travel s of the tip, so that tissue that moves meanwhile does
    not spoil k.

    Parameters
    ----------
    amplitude : float
        m.
    """

    _FREQUENCY, _PERIODS = 5.0, 2

    def __init__(self, amplitude: float) -> None:
        self._amplitude = amplitude
        self._rows: list[tuple[float, float, float]] = []
        self._began: float | None = None

    @property
    def seconds(self) -> float:
        """How long it takes."""
        return self._PERIODS / self._FREQUENCY

    @property
    def begun(self) -> bool:
        """Whether it was started."""
        return self._began is not None

    def begin(self, now: float) -> None:
        """Start."""
        self._began = now
        self._rows.clear()

    def speed(self, now: float) -> float:
        """Return the speed into the tissue, m/s; 0 before and after."""
        if self._began is None or not 0 <= now - self._began < self.seconds - 1e-6:
            return 0.0
        turn = 2 * math.pi * self._FREQUENCY
        return self._amplitude * turn * math.cos(turn * (now - self._began))

    def take(self, time: float, travel: float, force: float) -> None:
        """Take how far the tip was into the tissue, m, and the force then, N."""
        if self._began is not None:
            self._rows.append((time, travel, force))

    def over(self, now: float) -> bool:
        """Whether it is done."""
        return self._began is not None and now - self._began > self.seconds + 0.04

    def stiffness(self) -> tuple[float, float] | None:
        """Return the stiffness and its standard error, N/m; None: the readings do not tell."""
        if len(self._rows) < 10:
            return None
        rows = np.array(self._rows)
        t = rows[:, 0] - rows[:, 0].mean()
        s = rows[:, 1] - rows[:, 1].mean()
        A = np.column_stack([np.ones_like(t), t, t * t, s / self._amplitude])
        found, _, rank, _ = np.linalg.lstsq(A, rows[:, 2], rcond=None)
        if rank < 4:
            return None
        left = rows[:, 2] - A @ found
        variance = float(left @ left) / (len(t) - 4)
        error = math.sqrt(variance * float(np.linalg.inv(A.T @ A)[3, 3])) / self._amplitude
        stiffness = float(found[3]) / self._amplitude
        return (stiffness, error) if stiffness > 4 * error else None
