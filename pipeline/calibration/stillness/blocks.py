"""Samples summarised in blocks of whole mains periods: all else is decided from them."""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import ceil, inf, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri

from contactbench.pipeline.calibration.stillness.captures import BLOCK, LEAST
from contactbench.pipeline.errors import InputError, arg

Floats = NDArray[np.float64]

_MAINS = 2 * np.pi * np.array([50.0, 60.0])  # rad/s
_FEWEST_IN_BLOCK = 10  # samples: of fewer the scatter says little, so slow sensors get longer blocks
# At so few samples a second, blocks of ten would make a window longer than a robot stands.
_CRAWL, _FEWEST_OF_CRAWL = 25.0, 5
SLOWEST = 4.0  # samples a second; so few are a wrong unit of time
_LATEST = 1e12  # s; beyond, a float hardly tells one sample from the next
_SLOW, _FEWEST_FITTED = 90.0, 16  # Hz below which mains lines are not fitted, and samples that it takes
_MOST_WAITING = 1_000_000  # samples that are waited for until a block ends
_LEARN, _LEARNT = 0.5, 20  # s and samples from which the rate is taken
_USABLE = 0.3  # share of a block's samples without which it is left out
_SPIKE = 6.0  # robust standard deviations; of Gaussian samples one in 500 million is further off
_SPIKE_RUN = 0.004  # s, and two samples at least: what lasts longer is a knock, not a spike
_MADN = 1.4826  # standard deviation of Gaussian numbers over their median absolute deviation


class SampleBlock(NamedTuple):
    """What 0.1 s of samples say."""

    first: int
    last: int  # one beyond
    gap: float  # s without a sample before it
    start: float
    stop: float
    centre: float
    samples: int
    spikes: int
    freedom: float
    mean: Floats
    variance: Floats  # of one sample, without spikes and hum
    quick: Floats  # the same from second differences: white noise alone, also in motion
    R_WS: Floats | None


class HeldCapture(NamedTuple):
    """A capture that was disturbed: dropped if that was a bump, kept if the robot left."""

    blocks: list[SampleBlock]
    reason: str
    since: float


def _line_up(t: Floats) -> Floats:
    """Return the columns (n, 1 or 5) of a constant and of the mains lines."""
    lines = len(t) >= _FEWEST_FITTED // 2 and (len(t) - 1) >= _SLOW * (t[-1] - t[0])
    A = np.ones((len(t), 5 if lines else 1))
    if lines:
        angles = (t - t[0])[:, None] * _MAINS
        np.cos(angles, out=A[:, 1:3])
        np.sin(angles, out=A[:, 3:5])
    return A


def _fit(A: Floats, w: Floats) -> Floats:
    square = A.T @ A
    square.flat[:: len(square) + 1] += 1e-6 * len(A)  # a line at half the rate shows only one of its phases
    square[0, 0] -= 1e-6 * len(A)
    return np.asarray(np.linalg.solve(square, A.T @ w), dtype=np.float64)


def _robust(
    t: Floats, w: Floats, step: Floats, calm: Floats, run: int
) -> tuple[Floats, Floats, Floats, float, int, Floats]:
    """Return mean, variance, its quick part (6,) and freedom of samples (n, 6), spikes, and the smallest step.

    Parameters
    ----------
    t : (n,)
    w : (n, 6)
        Finite, n >= 3.
    step : (6,)
        Smallest difference between two values so far: of a converter that rounds, its step.
    calm : (6,)
        What the robust standard deviation is at least.
    run : int
        So many samples in a row may be spikes.
    """
    ordered = np.sort(w, axis=0)
    steps = np.diff(ordered, axis=0)
    step = np.minimum(np.where(steps > 0, steps, inf).min(axis=0), step)
    # Rounding can leave no median deviation at all; then one step up or down is no spike.
    least = np.maximum(np.where(np.isfinite(step), 0.5 * step, 0.0), calm)
    middle = len(w) // 2
    kept = ~_spikes(w - 0.5 * (ordered[middle] + ordered[-1 - middle]), least, run)
    A = _line_up(t)
    for _ in range(2):
        mean = _fit(A[kept], w[kept])
        residuals = w - A @ mean
        again = ~_spikes(residuals, least, run)
        if (again == kept).all():
            break
        kept = again
    count = int(kept.sum())
    freedom = max(count - A.shape[1], 1)
    rest = residuals[kept]
    variance = (rest**2).sum(axis=0) / freedom
    bends = np.diff(rest, 2, axis=0)  # of white noise, six times its variance
    quick = (bends**2).sum(axis=0) / (6 * max(count - 2, 1)) * (count / freedom)
    return mean[0], variance, quick, float(freedom), len(w) - count, step


def _spikes(residuals: Floats, least: Floats, run: int) -> NDArray[np.bool_]:
    """Return which samples (n,) are further off than noise is, for no longer than `run` samples."""
    size = np.abs(residuals)
    scale = np.maximum(_MADN * np.sort(size, axis=0)[len(size) // 2], least)
    far: NDArray[np.bool_] = (size > _SPIKE * scale).any(axis=1)
    if not far.any():
        return far
    edges = np.flatnonzero(np.diff(np.concatenate([[False], far, [False]]).astype(np.int8)))
    for start, stop in edges.reshape(-1, 2):
        if stop - start > run:
            far[start:stop] = False
    return far if far.sum() <= 0.25 * len(far) else np.zeros_like(far)


class Window:
    """Blocks as arrays, and the straight line through their means."""

    def __init__(self, blocks: Sequence[SampleBlock]) -> None:
        self.blocks = blocks
        self.means = np.array([block.mean for block in blocks])
        self.variances = np.array([block.variance for block in blocks])
        self.freedom = np.array([block.freedom for block in blocks])
        self.counts = np.array([block.samples for block in blocks], dtype=np.float64)
        share = self.freedom / self.freedom.sum()
        self.variance: Floats = share @ self.variances
        self.quick: Floats = share @ np.array([block.quick for block in blocks])
        n = len(blocks)
        self.mean = self.means.sum(axis=0) / n
        t = np.array([block.centre for block in blocks])
        t -= t.sum() / n
        self.rest = self.means - self.mean
        if n < 3:
            self.slope = self.slope_sigma = self.scatter = np.full(6, np.nan)
            return
        self.reach = sqrt(t @ t)  # s
        self.slope = t @ self.means / (t @ t)
        self.rest -= t[:, None] * self.slope
        self.scatter = np.sqrt((self.rest**2).sum(axis=0) / (n - 2))
        white = np.sqrt(self.variance / self.counts.mean())
        self.slope_sigma = np.maximum(self.scatter, white) / self.reach


@lru_cache(maxsize=4096)
def by_chance(freedom: float, risk: float) -> float:
    """Return how far a variance of so many degrees of freedom exceeds its mean by chance."""
    return float(chdtri(freedom, risk)) / freedom


class StillnessIntake:
    """Cuts a stream of samples into blocks.

    The blocks follow one another from the first sample on; after a pause they start anew with the sample that
    ends it. So they depend on the samples alone, not on how many are handed over at a time.
    """

    def __init__(self, rate: float | None) -> None:
        self._t, self._w = np.empty(256), np.empty((256, 6))
        self._R: Floats | None = None
        self._filled = self._index = 0
        self.due = self.latest = self.last_finite = -inf
        self._step = np.full(6, inf)
        self.calm = LEAST  # scatter (6,) that is known to be noise: no part of it is a spike
        self.rate, self.length = 0.0, _LEARN
        if rate is not None:
            self._know(rate)

    def _know(self, rate: float) -> None:
        if rate < SLOWEST:
            raise InputError(
                f"{arg(rate):.2g} samples per second are too few to tell stillness from motion: check"
                f" that the times are in s, and give {arg(SLOWEST):g} or more"
            )
        self.rate = rate
        fewest = _FEWEST_FITTED if rate >= _SLOW else _FEWEST_IN_BLOCK if rate > _CRAWL else _FEWEST_OF_CRAWL
        self.length = BLOCK * ceil(fewest / (BLOCK * rate) - 1e-9)
        self._run = max(2, int(_SPIKE_RUN * rate))

    @property
    def step(self) -> Floats:
        """Smallest step (6,) between two values so far; 0 while there was none."""
        return np.where(np.isfinite(self._step), self._step, 0.0)

    def put(self, t: Floats | float, w: Floats, count: int, R_WS: Floats | None) -> None:
        """Add `count` samples that belong to this block; `R_WS` (3, 3) is that of the last."""
        stop = self._filled + count
        if stop > len(self._t):
            if stop > _MOST_WAITING:
                raise InputError(
                    f"{arg(stop)} samples since {arg(self._t[0]):g} s span less than {arg(self.length):g} s: the"
                    " times stand still; give the time of each sample in s"
                )
            self._t = np.concatenate([self._t[: self._filled], np.empty(2 * count + self._filled)])
            self._w = np.concatenate([self._w[: self._filled], np.empty((2 * count + self._filled, 6))])
        self._t[self._filled : stop], self._w[self._filled : stop] = t, w
        self.latest = float(self._t[stop - 1])
        self._filled, self._R = stop, R_WS

    def feed(self, t: Floats, w: Floats, R_WS: Floats | None) -> Iterator[SampleBlock | None]:
        """Add samples (n,), (n, 6) with orientations (n, 3, 3), (3, 3) or None; yield the blocks they end."""
        i = 0
        while i < len(t):
            if t[i] >= self.due:
                yield from self.close(t[i])
            j = max(int(np.searchsorted(t, self.due)), i + 1)
            self.put(t[i:j], w[i:j], j - i, R_WS[j - 1] if R_WS is not None and R_WS.ndim == 3 else R_WS)
            i = j

    def close(self, t: float) -> Iterator[SampleBlock | None]:
        """End the block because a sample came at `t`; yield None for one with too few samples."""
        if not abs(t) < _LATEST:
            raise InputError(f"the time {arg(t):.10g} is no time in s: give times in s")
        if not self.rate and self._filled >= _LEARNT:
            yield from self._learn()
        while t >= self.due:
            if self.rate and self._filled:
                yield self.summary()
            if not self.rate or t >= self.due + self.length:
                self.due = t
            self.due += self.length

    def _learn(self) -> Iterator[SampleBlock | None]:
        """Take the rate from the samples so far, and cut them again."""
        t, w = self._t[: self._filled].copy(), self._w[: self._filled].copy()
        self._know((len(t) - 1) / (t[-1] - t[0]))
        self._filled, self.due = 0, -inf
        yield from self.feed(t, w, self._R)

    def summary(self) -> SampleBlock | None:
        """Return what the block says, and begin the next."""
        count, first = self._filled, self._index
        t, w = self._t[:count], self._w[:count]
        self._filled, self._index = 0, first + count
        finite = np.isfinite(w).all(axis=1)
        if not finite.all():
            t, w = t[finite], w[finite]
        if len(t) < max(3.0, _USABLE * self.rate * self.length):
            return None
        gap, self.last_finite = float(t[0]) - self.last_finite, float(t[-1])
        mean, variance, quick, freedom, spikes, self._step = _robust(t, w, self._step, self.calm, self._run)
        return SampleBlock(
            first, first + count, gap, float(t[0]), float(t[-1]), float(t.mean()), len(t) - spikes, spikes,
            freedom, mean, variance, quick, self._R,
        )  # fmt: skip
