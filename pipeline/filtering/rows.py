"""Samples as rows of numbers: what the filters share."""

from math import isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactbench.pipeline.errors import InputError, arg

Floats = NDArray[np.float64]


def positive(name: str, value: float) -> float:
    """Return `value` as a float, or raise InputError naming it if it is not positive and finite."""
    if not (isfinite(value) and value > 0):
        raise InputError(f"{arg(name)} must be positive and finite, not {arg(value)}")
    return float(value)


def as_row(name: str, sample: ArrayLike) -> Floats:
    """Return one sample (c,) as float64, c >= 1, or raise InputError."""
    row = np.asarray(sample, dtype=np.float64)
    if row.ndim != 1 or row.size == 0:
        raise InputError(
            f"{arg(name)}: one sample is a row of one number per channel, not of shape {arg(row.shape)}"
        )
    return row


def as_rows(name: str, samples: ArrayLike) -> Floats:
    """Return samples (n, c) as float64, c >= 1, or raise InputError."""
    rows = np.asarray(samples, dtype=np.float64)
    if rows.ndim != 2 or rows.shape[1] == 0:
        raise InputError(
            f"{arg(name)}: samples are rows (n, c) of one number per channel, not of shape {arg(rows.shape)};"
            " give a single channel as samples[:, None]"
        )
    return rows


def time_steps(times: ArrayLike, count: int, rate: float) -> Floats:
    """Return the time from each sample to the next (count,), s; the first, unknown, is 1 / rate.

    Raises
    ------
    InputError
        The times (count,) are not finite or do not increase; the message names the first wrong index.
    """
    array = np.asarray(times, dtype=np.float64)
    if array.shape != (count,):
        raise InputError(f"times: give one per sample, {arg(count)}, not shape {arg(array.shape)}")
    finite = np.isfinite(array)
    rising = np.concatenate([[True], array[1:] > array[:-1]])[:count]
    if not np.all(finite & rising):
        at = int(np.argmin(finite & rising))
        before = f" after {array[at - 1]} s" if at else ""
        raise InputError(
            f"times[{arg(at)}] is {arg(array[at])} s{arg(before)}: times must be finite and increase; sort"
            " the samples or drop those with a repeated time"
        )
    return np.concatenate([[1 / rate], np.diff(array)])[:count]
