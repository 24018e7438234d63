"""Times of samples that were read together: a serial adapter hands on 16 ms of them at once, with one arrival."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_LONGEST_STEP_S = 0.005  # after a silence, nobody knows when in it the first of them was measured


def spread_bursts(times: NDArray[np.float64], before: float | None = None) -> NDArray[np.float64]:
    """
    Return times of which no two are equal, where they were so because samples came together.

    The samples of a burst lie evenly between what came before and their common arrival, at most 5 ms apart; the last
    keeps its time. Times that go back stay as they are.

    Parameters
    ----------
    times : (n,)
        s, as they arrived.
    before : float, optional
        Time of the sample before them.
    """
    if len(times) < 2 and before is None:
        return times
    starts = np.flatnonzero(np.r_[True, times[1:] != times[:-1]])
    counts = np.diff(np.r_[starts, len(times)])
    if counts.max(initial=1) == 1 and (before is None or before != times[0]):
        return times
    arrival = times[starts]
    earlier = np.r_[np.nan if before is None else before, arrival[:-1]]
    room = (arrival - earlier) / counts
    steps = np.where(room > 0, np.minimum(room, _LONGEST_STEP_S), np.nan)
    # The first burst of all has nothing before it: as far apart as those that follow, or else as samples may be.
    usual = np.nanmedian(steps) if np.isfinite(steps).any() else _LONGEST_STEP_S
    steps = np.where(np.isnan(steps) & np.isnan(earlier), usual, np.nan_to_num(steps))
    left = np.repeat(starts + counts, counts) - 1 - np.arange(len(times))
    return np.asarray(times - left * np.repeat(steps, counts))
