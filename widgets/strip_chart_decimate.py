"""Fewer points to draw, with the same peaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def decimate(
    times: NDArray[np.float64], values: NDArray[np.float64], begin: float, end: float, bins: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Return the smallest and largest value of each bin of time; all of them where there are few.

    Bins lie at fixed times, not at those of the view: a chart that scrolls does not shimmer.

    Parameters
    ----------
    times : (n,)
        s, ascending.
    values : (n, c)
        NaN for what is missing.
    begin, end : float
        What is in view, s.
    bins : int
        About as many as pixels.

    Returns
    -------
    times : (k,)
    values : (k, c)
        k is at most about twice the number of bins. A bin without any number is NaN.
    """
    first, last = np.searchsorted(times, [begin, end], side="left")
    first, last = max(int(first) - 1, 0), min(int(last) + 1, len(times))  # lines go to the edge
    times, values = times[first:last], values[first:last]
    if len(times) <= 2 * bins or end <= begin:
        return times, values
    width = (end - begin) / bins
    places = np.floor(times / width)
    starts = np.flatnonzero(np.diff(places, prepend=places[0] - 1))
    middles = (places[starts] + 0.5) * width
    # fmin and fmax leave NaN out: one missing sample must not hide its bin.
    low = np.fmin.reduceat(values, starts, axis=0)
    high = np.fmax.reduceat(values, starts, axis=0)
    drawn = np.empty((2 * len(starts), values.shape[1]))
    drawn[0::2], drawn[1::2] = low, high
    return np.repeat(middles, 2), drawn


def nearest(times: NDArray[np.float64], moment: float) -> int | None:
    """Return the index of the time nearest to a moment; None: there are none."""
    if not len(times):
        return None
    after = min(int(np.searchsorted(times, moment)), len(times) - 1)
    before = max(after - 1, 0)
    return before if abs(times[before] - moment) < abs(times[after] - moment) else after


def steady_range(
    values: NDArray[np.float64], least: float, before: tuple[float, float] | None
) -> tuple[float, float]:
    """
    Return what to show of values, so that it changes seldom.

    Parameters
    ----------
    values : array
    least : float
        The smallest span, in the values' unit: noise does not fill the chart.
    before : (low, high), optional
        What is shown now; kept while it holds the values and is not far too wide.
    """
    there = values[np.isfinite(values)]
    if not there.size:
        return before or (-least / 2, least / 2)
    low, high = float(there.min()), float(there.max())
    span = max(high - low, least)
    if before is not None:
        shown = before[1] - before[0]
        if before[0] <= low and high <= before[1] and shown <= 3 * span:
            return before
    middle, half = (low + high) / 2, 0.625 * span
    return middle - half, middle + half
