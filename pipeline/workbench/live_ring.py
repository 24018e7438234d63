"""The last minutes of samples, in memory that never grows."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration import GravityModel

_FIRST = 1024  # rows looked at first
_SLICE = 4096  # rows compensated at a time under the lock: a millisecond, for a stream waits for it


class Ring:
    """
    The newest samples; any thread may add and read.

    Parameters
    ----------
    capacity : int
        Samples that are kept.
    """

    def __init__(self, capacity: int) -> None:
        self._times = np.full(capacity, np.nan)
        self._raw = np.full((capacity, 6), np.nan)
        self._compensated = np.full((capacity, 6), np.nan)
        self._R_WS = np.full((capacity, 3, 3), np.nan)
        self._capacity, self._count = capacity, 0
        self._lock = threading.Lock()

    @property
    def count(self) -> int:
        """Samples that were ever added."""
        return self._count

    def clear(self) -> None:
        """Forget all."""
        with self._lock:
            self._count = 0

    def add(
        self,
        times: NDArray[np.float64],
        raw: NDArray[np.float64],
        compensated: NDArray[np.float64],
        R_WS: NDArray[np.float64],
    ) -> None:
        """Take samples: times (n,), wrenches raw and compensated (n, 6), orientations (n, 3, 3)."""
        kept = min(len(times), self._capacity)
        with self._lock:
            first = self._count + len(times) - kept
            for store, new in (
                (self._times, times),
                (self._raw, raw),
                (self._compensated, compensated),
                (self._R_WS, R_WS),
            ):
                _put(store, first % self._capacity, new[len(times) - kept :])
            self._count += len(times)

    def last(self, seconds: float) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Return times (n,), raw (n, 6) and compensated (n, 6) of the last seconds, oldest first; copies."""
        with self._lock:
            rows = self._rows(seconds)
            times = self._times[rows]
            if len(times):
                # A clock that jumped back, such as a replay begun again, is no reason to show nothing.
                back = np.flatnonzero(np.diff(times) < 0)
                start = int(back[-1]) + 1 if len(back) else 0
                start += int(np.searchsorted(times[start:], times[-1] - seconds))
                rows, times = rows[start:], times[start:]
            return times, self._raw[rows], self._compensated[rows]

    def compensate(self, model: GravityModel | None) -> None:
        """Compute the compensated wrenches anew with another model; None: there are none."""
        for begin in range(0, min(self._count + _SLICE, self._capacity), _SLICE):
            part = slice(begin, begin + _SLICE)
            with self._lock:
                if model is None:
                    self._compensated[part] = np.nan
                else:
                    self._compensated[part] = model.compensate(self._R_WS[part], self._raw[part])

    def _rows(self, seconds: float) -> NDArray[np.intp]:
        """Return rows that hold the last seconds, oldest first, and perhaps older ones."""
        kept, some = min(self._count, self._capacity), _FIRST
        while True:  # not all at once: 30 times a second that would be 100 MB of copies
            some = min(some, kept)
            rows = np.arange(self._count - some, self._count, dtype=np.intp) % self._capacity
            if some == kept or self._times[rows[0]] < self._times[rows[-1]] - seconds:
                return rows
            some *= 4


def _put(store: NDArray[np.float64], place: int, new: NDArray[np.float64]) -> None:
    until_end = min(len(new), len(store) - place)
    store[place : place + until_end] = new[:until_end]
    store[: len(new) - until_end] = new[until_end:]
