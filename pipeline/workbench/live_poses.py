"""The orientation of the sensor at the time of each sample."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from pipeline.devices.sample import FlangeSample

LONGEST_GAP = 0.25
"""Between two poses, or since the newest one, s: beyond, no orientation is known."""
_KEPT = 512


class PoseTrack:
    """
    The newest poses of the flange, asked for the sensor's orientation at any time among them.

    Poses may come in one thread and be asked for in another.

    Parameters
    ----------
    R_ES : (3, 3)
        How the sensor is mounted on the flange.
    """

    def __init__(self, R_ES: NDArray[np.float64]) -> None:
        self._R_ES = R_ES
        self._poses: deque[tuple[float, NDArray[np.float64]]] = deque(maxlen=_KEPT)
        self._lock = threading.Lock()

    @property
    def newest(self) -> float:
        """Time of the newest pose, s; minus infinity before the first."""
        with self._lock:
            return self._poses[-1][0] if self._poses else -np.inf

    def add(self, samples: Sequence[FlangeSample]) -> None:
        """Take poses, oldest first; one that is no rotation is left out."""
        with self._lock:
            for sample in samples:
                R = np.asarray(sample.R_BE, dtype=np.float64)
                if not (np.isfinite(R).all() and np.linalg.det(R) > 0.5):
                    continue
                if self._poses and sample.time < self._poses[-1][0]:
                    self._poses.clear()  # the clock jumped back
                if not self._poses or sample.time > self._poses[-1][0]:
                    self._poses.append((sample.time, R))

    def at(self, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """
        Return R_WS (n, 3, 3), between two poses along the shortest turn; NaN where none is near enough.

        Parameters
        ----------
        times : (n,)
            s, ascending. After the newest pose that one is held, for `LONGEST_GAP`.
        """
        with self._lock:
            poses = tuple(self._poses)
        result = np.full((len(times), 3, 3), np.nan)
        if not poses or not len(times):
            return result
        moments = np.array([time for time, _ in poses])
        # Only those around the samples: turning hundreds of matrices for each block would cost more than all else.
        first = max(int(np.searchsorted(moments, times[0], side="right")) - 1, 0)
        last = min(int(np.searchsorted(moments, times[-1])) + 1, len(moments))
        moments, R_WE = moments[first:last], np.array([R for _, R in poses[first:last]])
        held = (times >= moments[-1]) & (times - moments[-1] <= LONGEST_GAP)
        result[held] = R_WE[-1] @ self._R_ES
        if len(moments) > 1:
            self._between(moments, R_WE, times, result)
        return result

    def _between(
        self,
        moments: NDArray[np.float64],
        R_WE: NDArray[np.float64],
        times: NDArray[np.float64],
        result: NDArray[np.float64],
    ) -> None:
        after = np.clip(np.searchsorted(moments, times, side="right"), 1, len(moments) - 1)
        begin, end = moments[after - 1], moments[after]
        there = (times >= begin) & (times < end) & ((end - begin <= LONGEST_GAP) | (times == begin))
        if not there.any():
            return
        turns = Rotation.from_matrix(R_WE)
        # Slerp: the rotation vector of the way from one pose to the next, cut to the share of the time.
        ways = (turns[:-1].inv() * turns[1:]).as_rotvec()
        share = ((times - begin) / (end - begin))[there]
        before = after[there] - 1
        result[there] = (turns[before] * Rotation.from_rotvec(ways[before] * share[:, None])).as_matrix()
        result[there] = result[there] @ self._R_ES
