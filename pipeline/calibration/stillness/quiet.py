"""What counts as quiet, drifting, disturbed or touched."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, inf, log, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import chdtri

from contactbench.pipeline.calibration.model import GravityModel
from contactbench.pipeline.calibration.stillness.blocks import SampleBlock, StillnessIntake, Window, by_chance
from contactbench.pipeline.calibration.stillness.captures import LEAST, StillnessSettings, both, short, size
from contactbench.pipeline.errors import arg, message

Floats = NDArray[np.float64]

_FILLED = 0.6  # share of a window's samples that must have come
_RISK = 1e-6  # that one axis of one clean block looks disturbed: some 200 are tested in a capture
_JUMP = 6.0  # standard deviations of a block's mean
_TAIL = 0.02  # probability that the first third of a settled capture differs from the rest by chance
_TOUCH_RISK = 1e-5  # that an untouched window looks touched
_PATIENCE = 5.0  # s after which the quietest window is believed to have been still


class Yardstick:
    """What counts as quiet: the noise floor, given or learnt, and the limits that follow from it.

    Attributes
    ----------
    floor : (6,)
        Standard deviation of a sample when all is quiet, N and N·m.
    sigma : (6,)
        The same of a block's mean.
    memory : NoiseMemory
        Of the captures.
    """

    def __init__(self, settings: StillnessSettings, intake: StillnessIntake) -> None:
        self._s, self._intake = settings, intake
        self._slopes = np.repeat([settings.slope_force, settings.slope_torque], 3)
        self._loudest = np.repeat([settings.loudest_force, settings.loudest_torque], 3)
        self._given = both(settings.floor_force, settings.floor_torque)
        self._scatter, self._quick, self._wander = np.full((3, 6), inf)
        self._share = 1.0  # of samples that are independent
        self._sure, self._since = bool((self._given > 0).all()), 0.0

    def begin(self, length: float, since: float) -> int:
        """Return how many blocks of this length, s, make a window; the first ended at `since`."""
        self._since = since
        self.memory = NoiseMemory(length, self._s.horizon)
        self.measure()
        return max(ceil(self._s.window / length - 1e-9), 6)

    def learn(self, window: Window, captured: bool) -> bool:
        """Keep the scatter of the quietest full window; return whether the floor has fallen.

        A recording may begin in motion, and its quietest window may be a tremor. Until a window was no louder
        than white noise, the quick part of the scatter, to which a tremor adds little, is the floor. A sensor
        that filters its readings has no quick part: after some seconds its quietest window is believed.
        """
        self._quick = np.minimum(self._quick, np.sqrt(window.quick))
        self._sure |= captured or window.blocks[-1].stop - self._since > _PATIENCE
        # The smallest of many is too small by chance.
        scatter = np.sqrt(window.variance) * (1 + 2 / sqrt(2 * self._free(float(window.freedom.sum()))))
        wander = window.scatter * (1 + 2 / sqrt(2 * len(window.blocks)))
        self._wander = np.minimum(np.minimum(self._wander, wander), 0.25 * self._loudest)
        fallen = bool((scatter < 0.9 * self._scatter).any())
        if fallen:
            self._scatter = np.minimum(np.minimum(self._scatter, scatter), self._loudest)
            # Of noise that was filtered down to a band B, second differences keep about B^4, and a block holds
            # as many independent samples as B allows.
            kept = np.maximum(self._quick, self._least) / np.maximum(self._scatter, self._least)
            self._share = float(np.sqrt(np.minimum(kept, 1.0)).min())
        self.measure()
        if fallen:
            self._intake.calm = self.floor
        return fallen

    @property
    def _least(self) -> Floats:
        return np.asarray(np.maximum(0.5 * self._intake.step, LEAST), dtype=np.float64)

    def _free(self, freedom: float) -> float:
        """Return how many of the degrees of freedom of a variance are independent."""
        return max(freedom * self._share if self._sure else freedom, 1.0)

    def measure(self) -> None:
        """Set `floor` and `sigma` by what is known now."""
        floor = np.minimum(self._scatter, self._loudest)
        if not self._sure:
            floor = np.minimum(floor, self._quick)
        floor = np.where(self._given > 0, self._given, floor)
        self.floor = np.maximum(floor, self._least)
        samples = max(self._intake.rate * self._intake.length, 1.0)
        rounding = rounding_variance(np.minimum(self._scatter, self.floor) ** 2, self._intake.step)
        white = np.sqrt(self.floor**2 / samples + rounding)
        wander = np.minimum(self._wander, 0.25 * self._loudest)
        if self.memory.block_variance is not None:
            wander = np.sqrt(self.memory.block_variance)
        elif not self._sure:
            wander = np.minimum(wander, 1.5 * white)
        self.sigma: Floats = np.maximum(wander, white)

    def quiet(self, window: Window) -> bool:
        """Return whether nothing in a full window is more than noise and the slope allowed."""
        ratio, n = self._s.scatter_ratio, len(window.blocks) - 2
        if window.blocks[-1].stop - window.blocks[0].start > (n + 2) * self._intake.length / _FILLED:
            return False
        loudest = (ratio * self.floor) ** 2
        chance = np.array([by_chance(self._free(freedom), _RISK) for freedom in window.freedom.tolist()])
        whole = by_chance(self._free(float(window.freedom.sum())), _RISK)
        return bool(
            (window.variances <= loudest * chance[:, None]).all()
            and (window.variance <= loudest * whole).all()
            and (window.scatter <= ratio * self.sigma * sqrt(by_chance(n, _RISK))).all()
            and (np.abs(window.rest) <= ratio * _JUMP * self.sigma).all()
            and (self.creep(window, self.sigma) <= 1).all()
        )

    def creep(self, window: Window, sigma: Floats) -> Floats:
        """Return the drift (6,) over the largest that is allowed and that noise explains."""
        excess: Floats = np.abs(window.slope) / (self._slopes + 4 * sigma / window.reach)
        return excess

    def _crept(self, window: Window, sigma: Floats) -> str:
        excess = self.creep(window, sigma)
        if (excess <= 1).all():
            return ""
        return message(f"the reading crept by {arg(size(window.slope, excess))}/s")

    def unrest(self, window: Window) -> tuple[float, str]:
        """Return how unquiet the newest block is, 1 being the limit, and by what."""
        last = window.blocks[-1]
        limit = self._s.scatter_ratio * self.floor * sqrt(by_chance(self._free(last.freedom), _RISK))
        scatter = np.sqrt(last.variance) / limit
        if len(window.blocks) > 1:
            step = last.mean - window.blocks[-2].mean
            jump = np.abs(step) / (_JUMP * sqrt(2) * self.sigma + self._slopes * self._intake.length)
            if jump.max() >= scatter.max():
                return float(jump.max()), f"{size(step / self._intake.length, jump)}/s"
        return float(scatter.max()), message(f"{arg(size(np.sqrt(last.variance), scatter))} of scatter")

    def disturbance(self, block: SampleBlock, before: Window, window: Window) -> str:
        """Return how a block departs from the capture `before` it, in words; empty if it does not."""
        n = len(before.blocks)
        jitter = np.sqrt(0.5 * (np.diff(before.means, axis=0) ** 2).mean(axis=0))
        off = block.mean - before.mean
        late = block.centre - 0.5 * (before.blocks[0].centre + before.blocks[-1].centre)
        allowed = _JUMP * np.maximum(self.sigma, jitter) * sqrt(1 + 1 / n) + self._slopes * late
        if (np.abs(off) > allowed).any():
            return message(f"the reading jumped by {arg(size(off, np.abs(off) / allowed))}")
        calm = np.maximum(before.variance, self._least**2)
        louder = block.variance / (calm * 1.2 * by_chance(self._free(block.freedom), _RISK))
        if (louder > 1).any():
            return message(f"the reading shook by {arg(size(np.sqrt(block.variance), louder))}")
        return self._crept(window, np.maximum(self.sigma, window.scatter))

    def noise(self, blocks: Sequence[SampleBlock]) -> NoiseFloor:
        """Return the noise behind the means of `blocks`."""
        part = Window(blocks)
        rounding = rounding_variance(part.variance, self._intake.step)
        return self.memory.fit(part.means, part.variance / self._intake.rate, rounding)

    def duration(self, blocks: Sequence[SampleBlock]) -> float:
        """Return how long to average by the noise in `blocks`, s: to the target given, or a fifth of the floor."""
        given, s = both(self._s.target_force, self._s.target_torque), self._s
        target = np.where(given > 0, given, 0.2 * self.floor)
        return self.noise(blocks).advise(target, s.min_duration, s.max_duration)

    def tail(self, blocks: Sequence[SampleBlock]) -> int:
        """Return how many blocks to leave out at the start, because they had not settled yet."""
        head, length = len(blocks) // 3, self._intake.length
        means = np.array([block.mean for block in blocks])
        rest = means[head:]
        noise = self.noise(blocks[head:])
        white = noise.white * (1 / head + 1 / len(rest)) / length
        sigma = np.sqrt(white + 2 * noise.flicker + noise.walk * len(rest) * length)
        # What settles does so on all axes together.
        off = (means[:head].mean(axis=0) - rest.mean(axis=0)) / sigma
        return head if off @ off > chdtri(6, _TAIL) else 0

    def refusal(self, whole: Window) -> str:
        """Return why the blocks of a capture cannot be used, in words; empty if they can."""
        count, spikes = whole.counts.sum(), sum(block.spikes for block in whole.blocks)
        if spikes > self._s.most_spikes * (count + spikes):
            share = 100 * spikes / (count + spikes)
            return message(f"{arg(share):.1f} % of the samples are spikes: check plug and cable")
        return self._crept(whole, self.sigma)

    def touch(self, window: Window, model: GravityModel | None) -> str:
        """Return in words what the load does not explain; empty if nothing, or if it cannot be told."""
        R = window.blocks[-1].R_WS
        if model is None or R is None:
            return ""
        residual = window.mean - model.predict(R)
        own = np.repeat([self._s.model_force, self._s.model_torque], 3) ** 2 + self.sigma**2
        C = model.wrench_covariance(R) + np.diag(own)
        if residual @ np.linalg.solve(C, residual) <= chdtri(6, _TOUCH_RISK):
            return ""
        force, torque = np.linalg.norm(residual[:3]), np.linalg.norm(residual[3:])
        return message(
            f"{arg(short(force))} N and {arg(short(1e3 * torque))} mN·m more than the load explains"
        )


# ---- noise that is not white: how uncertain the mean of a capture is, and how long to average ----


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
