"""A line that holds samples back."""

from collections import deque
from typing import Generic, TypeVar

import numpy as np

Item = TypeVar("Item")


class LateLine(Generic[Item]):
    """
    First in, first out: what is sent at t arrives at t + latency + Exp(jitter), and not before what was sent earlier.

    Parameters
    ----------
    latency, jitter : float
        s; of the second, the mean.
    """

    def __init__(self, latency: float, jitter: float, rng: np.random.Generator) -> None:
        self._latency, self._jitter, self._rng = latency, jitter, rng
        self._under_way: deque[tuple[float, Item]] = deque()
        self._last = float("-inf")

    def arrival(self, time: float) -> float:
        """Return when what is sent at a time arrives; ask once for each."""
        late = self._rng.exponential(self._jitter) if self._jitter else 0.0
        self._last = max(self._last, time + self._latency + late)
        return self._last

    def send(self, arrival: float, item: Item) -> None:
        """Let something arrive at a time that `arrival` gave."""
        self._under_way.append((arrival, item))

    def due(self, now: float) -> list[Item]:
        """Return what has arrived by now, and has not been given."""
        given = []
        while self._under_way and self._under_way[0][0] <= now + 1e-9:
            given.append(self._under_way.popleft()[1])
        return given
