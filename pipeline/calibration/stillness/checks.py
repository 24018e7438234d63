"""Checks of what comes in, and words for what goes out."""

from __future__ import annotations

from math import inf, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
from contactbench.pipeline.calibration.stillness.captures import Capture


def both(force: float | None, torque: float | None) -> Floats:
    """Return two settings as (6,); 0 where one was left out."""
    return np.repeat([force or 0.0, torque or 0.0], 3)


def checked(
    t: ArrayLike, wrenches: ArrayLike, R_WS: ArrayLike | None, latest: float
) -> tuple[Floats, Floats, Floats | None]:
    """Return samples as arrays, or raise InputError; `latest` is the time before the first."""
    times, w = np.asarray(t, dtype=np.float64), np.ascontiguousarray(wrenches, dtype=np.float64)
    if w.ndim != 2 or w.shape[1] != 6:
        raise InputError(f"wrenches: give rows of six numbers, force before torque, not shape {w.shape}")
    if times.shape != (len(w),):
        raise InputError(f"times: give one for each of the {len(w)} samples, s, not shape {times.shape}")
    before = np.concatenate([[latest], times[:-1]])
    wrong = np.flatnonzero(~((times >= before) & (times < inf)))
    if len(wrong):
        at = int(wrong[0])
        raise InputError(f"sample {at + 1}: {backwards(times[at], before[at])}")
    return times, w, None if R_WS is None else orientation(R_WS, times.shape)


def orientation(R_WS: ArrayLike, many: tuple[int, ...]) -> Floats:
    """Return one orientation, or as many as there are samples, or raise InputError."""
    R = np.array(R_WS, dtype=np.float64)
    if R.shape not in {(3, 3), (*many, 3, 3)}:
        raise InputError(f"R_WS: give (3, 3) or one (3, 3) for each sample, not shape {R.shape}")
    return R


def backwards(t: float, before: float) -> str:
    """Say what is wrong with the time of a sample."""
    return (
        f"time {t} s after {before} s: times must be finite and must not run backwards; sort the samples, or begin"
        " with a new detector after a restart of the clock"
    )


def angle(first: Floats, second: Floats) -> float:
    """Return the angle between two orientations, rad; for small ones."""
    return float(np.linalg.norm(first - second)) / sqrt(2)


def size(wrench: Floats, weight: Floats) -> str:
    """Return the size of what weighs most in a wrench: of its force in N, or of its torque in mN·m."""
    if weight[:3].max() >= weight[3:].max():
        return f"{short(np.linalg.norm(wrench[:3]))} N"
    return f"{short(1e3 * np.linalg.norm(wrench[3:]))} mN·m"


def short(value: float | np.floating[Any]) -> str:
    """Return two digits that count, never with an exponent for large values."""
    return f"{float(f'{value:.2g}'):g}"


def done_words(capture: Capture) -> str:
    """Say that a pose is captured."""
    force, torque = capture.standard_error[:3].max(), capture.standard_error[3:].max()
    return (
        f"Captured: {capture.duration:.1f} s averaged, ± {force:.1g} N and ± {1e3 * torque:.1g} mN·m."
        " Go to the next pose."
    )


def stale_words(silent: float) -> str:
    """Say that no samples have come for so many s."""
    return f"Too few samples, or none, for {silent:.1f} s: check the sensor's plug, connection and rate."
