"""The Kalman filter of wrenches, and what it costs in lag."""

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np
from numpy.typing import ArrayLike

from contactbench.pipeline import kernel
from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.filtering.rows import Floats, as_row, as_rows, positive, time_steps


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
    def delay(self) -> float:
        """Lag behind slow motion, s: the group delay at 0 Hz, (1 - K) / K dt."""
        return self.r / self.predicted_variance / self.rate

    @property
    def noise_left(self) -> float:
        """Standard deviation of white noise after the filter over that before, √(K / (2 - K))."""
        return sqrt(self.predicted_variance / (self.predicted_variance + 2 * self.r))


class KalmanFilter:
    """The wrench filter of Cao, Chen, Hu and Liu (2023): each channel a random walk seen through white noise.

    By default Q and R belong to `tuned_rate` and follow time: Q grows with the time since the last sample, and
    R, the variance of one sample, with the nominal rate (a white noise density). So every rate gives the same
    physical filter, and a gap makes the next sample weigh more. R is that of the nominal rate also after a
    gap, which makes no sample better: where a share m of the samples is missing at random, the time constant
    grows as 1/√(1 - m), by 20 % for 30 %. With `per_sample` Q and R are added per sample as in the paper,
    whatever the time: at another rate, or with samples left out, that is another filter.

    The first sample of a channel becomes its state, with variance R.

    Fixed, it lags by `KalmanFigures.delay`. With `sigma` it follows changes: it starts anew with a sample where the
    mean of the innovations, weighted as the state weighs samples, is beyond chance. One sample alone, however far off,
    is not enough, and what turns back and back again within a moment is taken for noise. At rest it is the fixed one.
    A row is then taken whole or, with a number missing, lost whole.

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
    sigma : (6,) array_like, optional
        Standard deviation of the noise of one sample, N and N·m: follow changes.

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
        sigma: ArrayLike | None = None,
    ) -> None:
        self.rate = positive("KalmanFilter.rate", rate)
        self.q = positive("KalmanFilter.q", q)
        self.r = positive("KalmanFilter.r", r)
        self.tuned_rate = positive("KalmanFilter.tuned_rate", tuned_rate)
        self.per_sample = per_sample
        self.sigma = sigma
        self._q, self._r = self.figures().q, self.figures().r
        self._following: kernel.WrenchKalman | None = None
        if sigma is not None:
            each = [positive("KalmanFilter.sigma", value) for value in as_row("KalmanFilter.sigma", sigma)]
            numbers = (self.rate, self.q, self.r, self.tuned_rate, per_sample, *each)
            self._following = kernel.WrenchKalman(np.array(numbers, dtype=np.float64))
        self.reset()

    def figures(self, rate: float | None = None) -> KalmanFigures:
        """Return what the filter does at its own rate, or would do at another one, in Hz."""
        rate = self.rate if rate is None else positive("KalmanFilter.figures: rate", rate)
        if self.per_sample:
            return KalmanFigures(rate, self.q, self.r)
        return KalmanFigures(rate, self.q * (1 / rate * self.tuned_rate), self.r * (rate / self.tuned_rate))

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
        if self._following is not None:
            self._following.reset()
        if state is None:
            self._state: Floats | None = None
            self._variance = np.zeros(0)
            return
        row = as_row("KalmanFilter.reset", state)
        if not np.all(np.isfinite(row)):
            raise InputError(f"KalmanFilter.reset: the state must be finite, not {arg(row)}; or give none")
        self._state, self._variance = row.copy(), np.full(row.shape, self._r)
        if self._following is not None:
            self._following.update(row[None], np.array([1 / self.rate]))

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
        steps = self._steps(rows.shape[0], dt)
        if self._state is None:
            # A channel without a sample yet has infinite variance: its first gain is then 1, and 0 is no guess.
            self._state, self._variance = np.zeros(rows.shape[1]), np.full(rows.shape[1], inf)
        if rows.shape[1] != self._state.size:
            raise InputError(
                f"KalmanFilter: {arg(rows.shape[1])} channels after {arg(self._state.size)}; call reset()"
                " for another stream"
            )
        if self._following is None:
            added = np.full(len(steps), self.q) if self.per_sample else self.q * (steps * self.tuned_rate)
            return kernel.kalman(rows, added, self._r, self._state, self._variance)
        answers = self._following.update(rows, steps)
        if len(answers):
            self._state, self._variance[:] = answers[-1], self._following.variance
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
        settings = {"q": self.q, "r": self.r, "tuned_rate": self.tuned_rate}
        fresh = KalmanFilter(self.rate, per_sample=self.per_sample, sigma=self.sigma, **settings)
        return fresh.update_block(
            rows, None if times is None else time_steps(times, rows.shape[0], self.rate)
        )

    def _steps(self, count: int, dt: float | ArrayLike | None) -> Floats:
        """Return the time before each row, s, (count,)."""
        steps = np.asarray(1 / self.rate if dt is None else dt, dtype=np.float64)
        if steps.shape not in {(), (count,)}:
            raise InputError(
                f"KalmanFilter: dt has shape {arg(steps.shape)}; give one number or {arg(count)}"
            )
        if not np.all((steps > 0) & (steps < inf)):
            raise InputError(
                "KalmanFilter: every dt must be positive and finite (seconds); is a time repeated?"
            )
        return np.broadcast_to(steps, (count,)).copy()
