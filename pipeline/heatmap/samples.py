"""What samples of a recording are worth: which of them are settled, and how noisy they are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.contact import WrenchNoise

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.calibration import GravityModel

_BESIDE = 0.1  # s before and after a sample in which its force must be the same
_CHANGE = 0.05  # of the force, between the one and the other
_LAG = 0.025  # s: samples further apart are independent, also behind a filter
_FEWEST_DIFFERENCES = 30  # differences that a noise is measured from
_ORIENTATIONS = 64  # over which a calibration's uncertainty is averaged
_MAD = 0.6744897501960817  # of a normal distribution of SD 1
_LEAST = 1e-3  # of the usual noise: a channel without any would count for all the others


def settled(times: NDArray[np.float64], forces: NDArray[np.float64]) -> NDArray[np.bool_]:
    """
    Tell at which samples the force is steady: the means over 0.1 s before and after differ by 5 % at most.

    Parameters
    ----------
    times : (n,) float64
        Increasing, s.
    forces : (n,) float64
        |F|, N; NaN is not steady.

    Returns
    -------
    (n,) bool
        False beside a gap, and at the ends.
    """
    steady = np.zeros(len(times), dtype=bool)
    step = usual_step(times)
    half = max(1, round(_BESIDE / step)) if step > 0 else len(times)
    if len(times) <= 2 * half:
        return steady
    sums = np.concatenate([[0.0], np.cumsum(np.nan_to_num(forces))])
    at = np.arange(half, len(times) - half)
    before = (sums[at] - sums[at - half]) / half
    after = (sums[at + half + 1] - sums[at + 1]) / half
    whole = times[at + half] - times[at - half] <= 3 * half * step
    steady[at] = whole & (np.abs(after - before) <= _CHANGE * np.minimum(before, after)) & (forces[at] > 0)
    return steady


def usual_step(times: NDArray[np.float64]) -> float:
    """Return the median time between samples, s; 0: there is none."""
    steps = np.diff(times)
    return float(np.median(steps[steps > 0])) if (steps > 0).any() else 0.0


def measured_noise(times: NDArray[np.float64], wrenches: NDArray[np.float64]) -> WrenchNoise | None:
    """
    Return the noise of a sample of compensated wrenches (n, 6), N and N·m; None: it cannot be told.

    It is taken from second differences over 25 ms, so that what rises evenly is no noise, and from their median, so
    that touching and letting go are none.
    """
    step = usual_step(times)
    lag = max(1, round(_LAG / step)) if step > 0 else len(times)
    if len(times) < 2 * lag + _FEWEST_DIFFERENCES:
        return None
    there = times[2 * lag :] - times[: -2 * lag] <= 3 * lag * step
    curved = (wrenches[2 * lag :] - 2 * wrenches[lag:-lag] + wrenches[: -2 * lag])[there]
    if len(curved) < _FEWEST_DIFFERENCES:
        return None
    sigma = np.median(np.abs(curved), axis=0) / (_MAD * np.sqrt(6.0))
    usual = np.sqrt(np.diag(WrenchNoise().covariance))
    if (sigma <= _LEAST * usual).all():  # made up, or rounded off
        return None
    sigma = np.maximum(sigma, _LEAST * usual)
    return WrenchNoise(sigma[:3], sigma[3:])


def with_calibration(noise: WrenchNoise, model: GravityModel, R_WS: NDArray[np.float64]) -> WrenchNoise:
    """Return a noise with what the calibration leaves uncertain, averaged over orientations (n, 3, 3)."""
    chosen = R_WS[np.linspace(0, len(R_WS) - 1, min(len(R_WS), _ORIENTATIONS)).astype(np.intp)]
    extra = np.mean(model.wrench_covariance(chosen), axis=0)
    if noise.extra is not None:
        extra = extra + np.asarray(noise.extra)
    return WrenchNoise(noise.force, noise.torque, extra=0.5 * (extra + extra.T))
