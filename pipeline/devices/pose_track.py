"""Where the flange was, is, or is about to be: one rule for recordings, the window, verification and the runtime."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline import kernel

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from contactbench.pipeline.devices.sample import FlangeSample

LONGEST_GAP_S = 0.25
"""Between two poses: beyond, nothing is interpolated."""
LONGEST_AHEAD_S = 0.15
"""After the last pose: so far it is carried on by the last twist. Poses of 10 Hz with jitter cover every sample."""

_KEPT = 512
_IDENTITY, _ORTHOGONAL = np.eye(3), 1e-3


def poses_at(
    moments: NDArray[np.float64],
    R: NDArray[np.float64],
    p: NDArray[np.float64],
    times: NDArray[np.float64],
    *,
    longest_gap: float = LONGEST_GAP_S,
    longest_ahead: float = LONGEST_AHEAD_S,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Return the poses at some times, by the rule of the runtime (``pose_track.hpp``), to the last bit.

    Between two poses: the shortest turn and a straight line. After the last one, or in a longer gap: carried on by the
    last twist.

    Parameters
    ----------
    moments : (n,)
        Times of the poses, s. Of those that do not increase, the later ones in the array are left out.
    R : (n, 3, 3)
    p : (n, 3)
        m; NaN where it is not known.
    times : (m,)
        s.
    longest_gap, longest_ahead : float
        s.

    Returns
    -------
    R : (m, 3, 3)
    p : (m, 3)
        NaN where there is none.
    """
    usable = np.isfinite(moments) & np.isfinite(R).all(axis=(1, 2))
    latest = np.maximum.accumulate(np.where(usable, moments, -np.inf))
    usable &= np.r_[True, moments[1:] > latest[:-1]] if len(moments) else usable
    if not usable.all():
        moments, R, p = moments[usable], R[usable], p[usable]
    return kernel.poses_at(
        np.ascontiguousarray(moments, dtype=np.float64),
        np.ascontiguousarray(R, dtype=np.float64),
        np.ascontiguousarray(p, dtype=np.float64),
        np.ascontiguousarray(times, dtype=np.float64),
        longest_gap,
        longest_ahead,
    )


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

    def add(self, samples: Iterable[FlangeSample]) -> None:
        """Take poses, oldest first; one that is no rotation is left out."""
        with self._lock:
            for sample in samples:
                R = np.asarray(sample.R_BE, dtype=np.float64)
                if not (np.abs(R.T @ R - _IDENTITY) <= _ORTHOGONAL).all() or np.linalg.det(R) < 0:
                    continue
                if self._poses and sample.time < self._poses[-1][0] - LONGEST_GAP_S:
                    self._poses.clear()  # the clock was set back
                if not self._poses or sample.time > self._poses[-1][0]:
                    self._poses.append((sample.time, R))

    def at(self, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return R_WS (n, 3, 3) at times (n,), s; NaN where none is near enough."""
        with self._lock:
            poses = tuple(self._poses)
        if not poses or not len(times):
            return np.full((len(times), 3, 3), np.nan)
        # Only those around the samples: handing over hundreds of matrices for each block would cost more than all else.
        moments = np.array([time for time, _ in poses])
        first = max(int(np.searchsorted(moments, times.min() - LONGEST_GAP_S)) - 1, 0)
        last = min(int(np.searchsorted(moments, times.max())) + 2, len(moments))
        nowhere = np.full((last - first, 3), np.nan)
        R_WE, _ = poses_at(moments[first:last], np.array([R for _, R in poses[first:last]]), nowhere, times)
        return R_WE @ self._R_ES
