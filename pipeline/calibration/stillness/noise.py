"""Noise that is not white: how uncertain the mean of a capture is, and how long to average."""

from __future__ import annotations

from dataclasses import dataclass
from math import log, pi
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import chdtri

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
from contactbench.pipeline.calibration.stillness.captures import LEAST

# 1/f noise assumed until enough was seen: equal to the white noise at 0.5 Hz, rather much for a bridge amplifier.
_CORNER = 0.5
_PRIOR_TIME, _PRIOR_FREEDOM = 3.2, 3.0  # s, and how many readings at that scale it counts for
_GAIN = 0.9  # on the standard error, by averaging for twice as long: less is not worth the technician's time
_LEVELS = 8  # octaves of block means
_FITS = 40  # rounds of the fit: to some per cent of the standard error


@dataclass(frozen=True, eq=False)
class NoiseFloor:
    """Noise of each axis (6,) by its Allan variance: ``white / tau + flicker + walk tau``.

    The variance of a mean over T is half the sum of the Allan variances at T, 2 T, 4 T, ... up to the horizon
    (the mean over T differs from that over 2 T by half an Allan difference, and so on). For drift, the variance
    of the mean against the value at its end.
    """

    white: Floats
    flicker: Floats
    walk: Floats
    rounding: Floats
    horizon: float

    def variance(self, T: ArrayLike) -> Floats:
        """Return the variance (..., 6) of means over T (...), s."""
        tau = np.asarray(T, dtype=np.float64)[..., None]
        octaves = np.log2(np.maximum(self.horizon / tau, 1.0))
        total: Floats = self.white / tau + 0.5 * self.flicker * octaves + self.walk * tau + self.rounding
        return total

    def advise(self, target: Floats, shortest: float, longest: float) -> float:
        """Return how long to average for standard errors `target` (6,), s.

        The shortest time that reaches the target on every axis, or beyond which twice the time gains less than a
        tenth on the axis that is furthest from it.
        """
        T = np.geomspace(shortest, longest, 64)
        left = (self.variance(T) / target**2).max(axis=1)  # of the way to the target, on the worst axis
        later = (self.variance(2 * T) / target**2).max(axis=1)
        enough = (left <= 1) | (later > _GAIN**2 * left)
        return float(T[np.argmax(enough)] if enough.any() else T[-1])


def _allan(means: Floats) -> tuple[Floats, Floats]:
    """Return the Allan variances (levels, 6) of block means (n, 6) at 1, 2, 4... blocks, and their freedom."""
    total = np.concatenate([np.zeros((1, 6)), np.cumsum(means - means[0], axis=0)])
    levels: list[Floats] = []
    freedom: list[float] = []
    size = 1
    while 2 * size <= len(means) and len(levels) < _LEVELS:
        averages = (total[size:] - total[:-size]) / size
        levels.append(0.5 * ((averages[size:] - averages[:-size]) ** 2).mean(axis=0))
        freedom.append(len(means) / size - 1)
        size *= 2
    return np.array(levels).reshape(-1, 6), np.array(freedom)


class NoiseMemory:
    """What earlier captures said of the noise; one capture alone is too short to show its slow part."""

    def __init__(self, block: float, horizon: float) -> None:
        self._block, self._horizon = block, horizon
        self._runs: list[tuple[Floats, Floats]] = []
        self.block_variance: Floats | None = None  # (6,) from one block to the next; of captures so far

    def add(self, means: Floats) -> None:
        """Remember the block means (n, 6) of a capture."""
        self._remember([*self._runs, _allan(means)])

    def extend(self, means: Floats) -> None:
        """Remember for the newest capture those of all the time that it was still."""
        self._remember([*self._runs[:-1], _allan(means)])

    def forget(self, index: int) -> None:
        """Forget a capture."""
        self._remember([*self._runs[:index], *self._runs[index + 1 :]])

    def _remember(self, runs: list[tuple[Floats, Floats]]) -> None:
        self._runs, self.block_variance = runs, None
        if runs:
            freedom = np.array([run[1][0] for run in runs])
            self.block_variance = freedom @ np.array([run[0][0] for run in runs]) / freedom.sum()

    def fit(self, means: Floats, white: Floats, rounding: Floats) -> NoiseFloor:
        """Return the noise behind block means (n, 6), n >= 2, and all remembered ones.

        The estimates of Allan variances are gamma distributed; multiplying each coefficient by the ratio of
        the two halves of the likelihood's gradient climbs to its maximum without ever becoming negative.

        Parameters
        ----------
        means : (n, 6)
        white : (6,)
            What the samples within blocks say it is at least, by the variance of a mean over 1 s.
        rounding : (6,)
            Variance that averaging leaves.
        """
        own, own_freedom = _allan(means)
        A, freedom = self._pooled(own, own_freedom)
        tau = self._block * 2.0 ** np.arange(len(A))
        A = np.maximum(A, np.maximum(white, LEAST**2) / tau[:, None])
        flicker = 4 * log(2) * _CORNER  # over white, by the Allan variance of both
        prior = A[0] / (1 / self._block + flicker) * (1 / _PRIOR_TIME + flicker)
        A, tau = np.vstack([A, prior]), np.append(tau, _PRIOR_TIME)
        weight = np.append(freedom, _PRIOR_FREEDOM)[:, None]
        shapes = np.column_stack([1 / tau, np.ones_like(tau), tau])
        parts = np.vstack([A[0] * self._block, 0.1 * A[0], 0.01 * A[0]])
        for _ in range(_FITS):
            fitted = shapes @ parts
            parts *= (shapes.T @ (weight * A / fitted**2)) / (shapes.T @ (weight / fitted))
        fitted = (shapes @ parts)[: len(own)]
        # A capture that is less quiet than the others has its own error.
        excess = (own_freedom[:, None] * own / fitted).sum(axis=0) / chdtri(own_freedom.sum(), 0.05)
        parts *= np.maximum(excess, 1.0)
        return NoiseFloor(parts[0], parts[1], parts[2], rounding, self._horizon)

    def _pooled(self, own: Floats, own_freedom: Floats) -> tuple[Floats, Floats]:
        sums, freedom = np.zeros((_LEVELS, 6)), np.zeros(_LEVELS)
        for levels, weight in [*self._runs, (own, own_freedom)]:
            sums[: len(levels)] += levels * weight[:, None]
            freedom[: len(levels)] += weight
        used = freedom > 0
        return sums[used] / freedom[used, None], freedom[used]


def rounding_variance(variance: Floats, step: Floats) -> Floats:
    """Return the variance (6,) of the error that rounding to `step` leaves in a mean.

    The error of the mean is a Fourier series in the true value, damped by the noise that shakes it (Widrow);
    its mean square is step²/12 without noise and nothing once the noise reaches half a step.
    """
    if (step**2 < variance).all():
        return np.zeros(6)
    k = np.arange(1, 9)[:, None]
    step = np.maximum(step, 1e-12)
    shaken = np.maximum(variance - step**2 / 12, 0.0) / step**2
    total: Floats = step**2 * (np.exp(-4 * (pi * k) ** 2 * shaken) / (2 * (pi * k) ** 2)).sum(axis=0)
    return total
