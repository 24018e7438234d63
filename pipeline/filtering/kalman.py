"""The Kalman filter of wrenches, and what it costs in lag."""

from dataclasses import dataclass
from math import asin, inf, log1p, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg.lapack import dgttrs

from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.filtering.rows import Bools, Floats, alike, as_row, as_rows, positive, time_steps

_BLOCK = 16384  # rows at a time: a whole recording needs no second copy, and a block stays in the cache


@dataclass(frozen=True)
class KalmanFigures:
    """What a Kalman filter with identity transition does once its gain has settled."""

    rate: float  # Samples a second, Hz
    # Variance added between two samples, and variance of a sample, at this rate; unit²
    q: float
    r: float

    @property
    def predicted_variance(self) -> float:
        """Steady variance P- before a sample, unit²: the positive root of P-² = Q P- + Q R."""
        return self.q / 2 + sqrt(self.q) * sqrt(self.q / 4 + self.r)

    @property
    def gain(self) -> float:
        """Steady gain K = P- / (P- + R)."""
        return 1 / (1 + self.r / self.predicted_variance)

    @property
    def time_constant(self) -> float:
        """Time in which a step is followed to 1 - 1/e, s: -dt / ln(1 - K)."""
        return 1 / (self.rate * log1p(self.predicted_variance / self.r))

    @property
    def cutoff(self) -> float | None:
        """Frequency of half power, Hz; None where K > 2 √2 - 2, as even the Nyquist frequency then passes.

        |H|² = K² / (K² + 4 (1 - K) sin²(w / 2)) = 1/2 for w radians a sample.
        """
        sine = self.predicted_variance / (2 * sqrt(self.r) * sqrt(self.predicted_variance + self.r))
        return self.rate * asin(sine) / pi if sine <= 1 else None

    @property
    def delay(self) -> float:
        """Lag behind slow motion, s: the group delay at 0 Hz, (1 - K) / K dt."""
        return self.r / self.predicted_variance / self.rate

    @property
    def noise_left(self) -> float:
        """Standard deviation of white noise after the filter over that before, √(K / (2 - K))."""
        return sqrt(self.predicted_variance / (self.predicted_variance + 2 * self.r))

    def __str__(self) -> str:
        cutoff = message("no cut-off") if self.cutoff is None else f"-3 dB at {self.cutoff:.3g} Hz"
        return message(
            f"at {arg(self.rate):g} Hz gain {arg(self.gain):.3g}, time constant"
            f" {arg(1e3 * self.time_constant):.3g} ms, {arg(cutoff)}, lag {arg(1e3 * self.delay):.3g} ms,"
            f" {arg(100 * self.noise_left):.3g} % of white noise left"
        )


class KalmanFilter:
    """The wrench filter of Cao, Chen, Hu and Liu (2023): each channel a random walk seen through white noise.

    By default Q and R belong to `tuned_rate` and follow time: Q grows with the time since the last sample, and
    R, the variance of one sample, with the nominal rate (a white noise density). So every rate gives the same
    physical filter, and a gap makes the next sample weigh more. R is that of the nominal rate also after a
    gap, which makes no sample better: where a share m of the samples is missing at random, the time constant
    grows as 1/√(1 - m), by 20 % for 30 %. With `per_sample` Q and R are added per sample as in the paper,
    whatever the time: at another rate, or with samples left out, that is another filter (see `describe`).

    The first sample of a channel becomes its state, with variance R.

    Parameters
    ----------
    rate : float
        Nominal samples a second, Hz: the time step where none is given.
    q, r : float
        Variances Q and R at `tuned_rate`, unit². Defaults are the paper's. Only Q / R shapes the answer, so
        they serve forces and torques alike; the variance told is true only if Q and R are.
    tuned_rate : float
        Rate to which `q` and `r` belong, Hz. Default 200, the paper's.
    per_sample : bool
        Repeat the paper's Q and R at any rate.

    Raises
    ------
    InputError
        A number is not positive and finite.
    """

    def __init__(
        self,
        rate: float = 200.0,
        *,
        q: float = 1e-6,
        r: float = 2e-4,
        tuned_rate: float = 200.0,
        per_sample: bool = False,
    ) -> None:
        self.rate = positive("KalmanFilter.rate", rate)
        self.q = positive("KalmanFilter.q", q)
        self.r = positive("KalmanFilter.r", r)
        self.tuned_rate = positive("KalmanFilter.tuned_rate", tuned_rate)
        self.per_sample = per_sample
        self._q, self._r = self.figures().q, self.figures().r
        self.reset()

    def figures(self, rate: float | None = None) -> KalmanFigures:
        """Return what the filter does at its own rate, or would do at another one, in Hz."""
        rate = self.rate if rate is None else positive("KalmanFilter.figures: rate", rate)
        if self.per_sample:
            return KalmanFigures(rate, self.q, self.r)
        return KalmanFigures(rate, self.q * (1 / rate * self.tuned_rate), self.r * (rate / self.tuned_rate))

    def describe(self, rate: float | None = None) -> str:
        """Tell in a sentence or two what the filter does, and what it would do at `rate`, Hz.

        Without a rate, a filter that repeats Q and R per sample is compared with itself at `tuned_rate`.
        """
        if rate is None and self.per_sample:
            rate = self.tuned_rate
        here = message(f"Kalman filter with Q = {arg(self.q):g}, R = {arg(self.r):g}")
        here += message(" per sample") if self.per_sample else message(f" at {arg(self.tuned_rate):g} Hz")
        text = message(f"{arg(here)}: {arg(self.figures())}.")
        if rate is None or rate == self.rate:
            return text
        same = (
            message("The same Q and R are another filter")
            if self.per_sample
            else message("Q and R follow time")
        )
        return message(f"{arg(text)} {arg(same)}: {arg(self.figures(rate))}.")

    @property
    def state(self) -> Floats | None:
        """(c,) latest answer, NaN for a channel that has had no sample; None before the first row."""
        return None if self._state is None else np.where(np.isinf(self._variance), np.nan, self._state)

    @property
    def variance(self) -> Floats:
        """(c,) variance of the latest answer, unit²; infinite for a channel that has had no sample."""
        return self._variance.copy()

    def reset(self, state: ArrayLike | None = None) -> None:
        """Forget everything; with `state` (c,) go on as if that had been the first sample.

        Raises
        ------
        InputError
            `state` is not a row of finite numbers.
        """
        if state is None:
            self._state: Floats | None = None
            self._variance = np.zeros(0)
            return
        row = as_row("KalmanFilter.reset", state)
        if not np.all(np.isfinite(row)):
            raise InputError(f"KalmanFilter.reset: the state must be finite, not {arg(row)}; or give none")
        self._state, self._variance = row.copy(), np.full(row.shape, self._r)

    def update(self, sample: ArrayLike, dt: float | None = None) -> Floats:
        """Take one sample (c,) that came `dt` s after the one before (default 1 / rate); return the answer (c,).

        Raises
        ------
        InputError
            The number of channels changed, or `dt` is not positive and finite.
        """
        answer: Floats = self.update_block(as_row("KalmanFilter.update", sample)[None], dt)[0]
        return answer

    def update_block(self, samples: ArrayLike, dt: float | ArrayLike | None = None) -> Floats:
        """Take several samples (n, c), each `dt` s (one number or (n,)) after the one before; return (n, c).

        Exactly what `update` returns row by row.

        Raises
        ------
        InputError
            As for `update`.
        """
        rows = as_rows("KalmanFilter.update_block", samples)
        added = self._added(rows.shape[0], dt)
        if self._state is None:
            # A channel without a sample yet has infinite variance: its first gain is then 1, and 0 is no guess.
            self._state, self._variance = np.zeros(rows.shape[1]), np.full(rows.shape[1], inf)
        if rows.shape[1] != self._state.size:
            raise InputError(
                f"KalmanFilter: {arg(rows.shape[1])} channels after {arg(self._state.size)}; call reset()"
                " for another stream"
            )
        answers = np.empty_like(rows)
        for start in range(0, rows.shape[0], _BLOCK):
            block = slice(start, start + _BLOCK)
            answers[block] = self._advance(self._state, rows[block], added[block])
        return answers

    def filter(self, samples: ArrayLike, times: ArrayLike | None = None) -> Floats:
        """Filter a whole recording from its start; the live state is neither used nor changed.

        Parameters
        ----------
        samples : array_like (n, c)
            Any unit; NaN for what is missing.
        times : array_like (n,), optional
            Time of each sample, s. Default: regular, at `rate`.

        Returns
        -------
        array (n, c)
            To the last bit what a fresh filter's `update` returns for one row after the other.

        Raises
        ------
        InputError
            A shape is wrong, or the times do not increase.
        """
        rows = as_rows("KalmanFilter.filter", samples)
        fresh = KalmanFilter(
            self.rate, q=self.q, r=self.r, tuned_rate=self.tuned_rate, per_sample=self.per_sample
        )
        return fresh.update_block(
            rows, None if times is None else time_steps(times, rows.shape[0], self.rate)
        )

    def _added(self, count: int, dt: float | ArrayLike | None) -> Floats:
        """Return the variance to add before each row, (count,)."""
        if dt is None:
            return np.full(count, self._q)
        steps = np.asarray(dt, dtype=np.float64)
        if steps.shape not in {(), (count,)}:
            raise InputError(
                f"KalmanFilter: dt has shape {arg(steps.shape)}; give one number or {arg(count)}"
            )
        if not np.all((steps > 0) & (steps < inf)):
            raise InputError(
                "KalmanFilter: every dt must be positive and finite (seconds); is a time repeated?"
            )
        added = np.empty(count)
        added[:] = self._q if self.per_sample else self.q * (steps * self.tuned_rate)
        return added

    def _advance(self, state: Floats, rows: Floats, added: Floats) -> Floats:
        missing = ~np.isfinite(rows)
        answers = np.empty_like(rows)
        for columns, lost in alike(missing, self._variance.tolist()):
            before = float(self._variance[columns][0])
            gains, after = _gains(before, self._r, added, lost)
            seen = np.where(lost[:, None], 0.0, rows[:, columns]) if lost.any() else rows[:, columns]
            blended = _blend(state[columns], seen, gains)
            state[columns] = blended[-1]
            self._variance[columns] = after
            answers[:, columns] = blended
            if before == inf and lost[0]:
                answers[: len(lost) if lost.all() else int(np.argmin(lost)), columns] = np.nan
        return answers


def _gains(variance: float, r: float, added: Floats, lost: Bools) -> tuple[Floats, float]:
    """Return the gain of every row, 0 for a lost one, and the variance after the last."""
    gains = np.zeros(added.size)
    settles = not lost.any() and bool(np.all(added == added[:1]))
    for i, (q, gone) in enumerate(zip(added.tolist(), lost.tolist(), strict=True)):
        predicted = variance + q
        if gone:
            variance = predicted
            continue
        # Written so, each rounded operation is monotone in the variance: it falls or rises until it stands
        # still to the last bit and cannot cycle, and the rest of a regular recording needs no loop.
        gains[i] = gain = 1 / (1 + r / predicted)
        if settles and gain * r == variance:
            gains[i:] = gain
            break
        variance = gain * r
    return gains, variance


def _blend(state: Floats, rows: Floats, gains: Floats) -> Floats:
    """Return x_i = K_i z_i + (1 - K_i) x_(i-1) for rows z (n, c), gains K (n,) and x_(-1) the state (c,).

    That is a bidiagonal system of equations; LAPACK's solver for a factored tridiagonal one runs the
    recurrence in compiled code with a gain that changes, which lfilter cannot. One sample goes the same way
    as a million, so live and offline agree even where a compiler fuses multiplication and addition.
    """
    size = len(rows) + 2  # one idle row in front: the wrapper cannot take a system of two
    lower = np.zeros(size - 1)
    np.subtract(gains, 1, out=lower[1:])
    right = np.zeros((size, state.size), order="F")
    right[1] = state
    np.multiply(rows, gains[:, None], out=right[2:])
    upper, pivots = np.zeros(size - 1), np.arange(1, size + 1, dtype=np.int32)
    solved: Floats = dgttrs(lower, np.ones(size), upper, upper[1:], pivots, right, overwrite_b=True)[0]
    return solved[2:]
