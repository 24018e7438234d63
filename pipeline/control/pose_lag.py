"""How late the poses are that a controller is told of its own arm."""

from __future__ import annotations

import math

_KEPT_S = 1.0  # time constant of what is remembered
_MOVED = 1.5e-6  # m²/s: a fifth of a second at 3 mm/s; after less motion nothing is said
_SHARE = 0.5  # of the squares of the speeds: an arm that goes less does not follow


class PoseLag:
    """
    What the arm is behind over how fast it was sent: ``lag = sum v off / sum v²``, least squares with forgetting.

    A stream of poses that waits in a buffer somewhere tells of the same motion, later. An arm that does not move at all
    is not late: it does not follow.
    """

    def __init__(self) -> None:
        self._off = self._size = self._moved = 0.0

    def take(self, speed: float, told: float, off: float, dt: float) -> None:
        """
        Take a period.

        Parameters
        ----------
        speed, told : float
            How fast it was sent along an axis, and how fast it went, by what was told, m/s.
        off : float
            How far it is behind, m.
        dt : float
            s.
        """
        kept = math.exp(-dt / _KEPT_S)
        self._off = kept * self._off + speed * off * dt
        self._size = kept * self._size + speed * speed * dt
        self._moved = kept * self._moved + told * told * dt

    @property
    def seconds(self) -> float:
        """How late they are, s; 0 while too little moved to say."""
        moves = self._size > _MOVED and self._moved > _SHARE * self._size
        return max(self._off / self._size, 0.0) if moves else 0.0
