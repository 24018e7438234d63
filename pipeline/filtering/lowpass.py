"""The low-pass filter of contact locations."""

from math import pi, sin, sqrt, tan

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import quad
from scipy.signal import butter, sosfilt, sosfilt_zi

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.filtering.rows import Floats, as_row, as_rows, positive


class LowPass:
    """Butterworth low-pass, for contact locations above all; starts at the first sample, not at zero.

    A missing sample is skipped: the last answer is held and the filter stands still, because a single noisy
    sample repeated through a gap would become the answer.

    Parameters
    ----------
    cutoff : float
        Frequency of half power, Hz, between 0 and half the rate.
    rate : float
        Samples a second, Hz.
    order : int
        At least 1. Default 2: more costs lag and overshoots.

    Raises
    ------
    InputError
        A number is out of its range.
    """

    def __init__(self, cutoff: float, rate: float, order: int = 2) -> None:
        self.rate = positive("LowPass.rate", rate)
        if not 0 < cutoff < rate / 2:
            raise InputError(
                f"LowPass.cutoff must be above 0 and below half the rate, {arg(rate / 2):g} Hz, not {arg(cutoff)} Hz"
            )
        if not isinstance(order, int) or order < 1:
            raise InputError(f"LowPass.order must be a whole number of at least 1, not {arg(order)}")
        self.cutoff, self.order = float(cutoff), order
        self._sections: Floats = butter(order, cutoff, fs=rate, output="sos")
        self._first: Floats = sosfilt_zi(self._sections)
        self.reset()

    @property
    def delay(self) -> float:
        """Lag behind slow motion, s: the group delay at 0 Hz, 1 / (2 rate tan(π f / rate) sin(π / (2 n)))."""
        return 1 / (2 * self.rate * tan(pi * self.cutoff / self.rate) * sin(pi / (2 * self.order)))

    @property
    def noise_left(self) -> float:
        """Standard deviation of white noise after the filter over that before: √ of the mean of |H|².

        With t = tan(π cutoff / rate) and frequency as u = tan(π f / rate) / t, |H|² = 1 / (1 + u^(2 n)). The
        part above u = 1 is integrated over 1 / u, so that no narrow band can slip through the quadrature; a t
        above 1 is the complement of 1 / t, the spectrum being mirrored.
        """
        corner, n = tan(pi * self.cutoff / self.rate), self.order
        narrow = min(corner, 1 / corner)

        def power(u: float) -> float:
            tail = u ** (2 * n)
            return narrow * (1 / (1 + (narrow * u) ** 2) + tail / (u * u + narrow**2)) / (1 + tail)

        passed = 2 / pi * quad(power, 0, 1)[0]
        return sqrt(passed if corner <= 1 else 1 - passed)

    def reset(self) -> None:
        """Forget everything: the next sample is the first."""
        self._memory: Floats | None = None
        self._last = np.zeros(0)

    def update(self, sample: ArrayLike) -> Floats:
        """Take one sample (c,) and return the answer (c,).

        Raises
        ------
        InputError
            The number of channels changed.
        """
        answer: Floats = self.update_block(as_row("LowPass.update", sample)[None])[0]
        return answer

    def update_block(self, samples: ArrayLike) -> Floats:
        """Take several samples (n, c); return exactly what `update` returns row by row, (n, c).

        Raises
        ------
        InputError
            As for `update`.
        """
        rows = as_rows("LowPass.update_block", samples)
        if self._memory is None:
            self._memory = np.zeros((len(self._sections), 2, rows.shape[1]))
            self._last = np.full(rows.shape[1], np.nan)
        if rows.shape[1] != self._last.size:
            raise InputError(
                f"LowPass: {arg(rows.shape[1])} channels after {arg(self._last.size)}; call reset() for another stream"
            )
        answers = np.empty_like(rows)
        for column in range(rows.shape[1]):
            good = np.isfinite(rows[:, column])
            seen, memory = rows[good, column], self._memory[:, :, column]
            if len(seen) and np.isnan(self._last[column]):
                memory[:] = self._first * seen[0]
            passed, memory[:] = sosfilt(self._sections, seen, zi=memory) if len(seen) else (seen, memory)
            answers[:, column] = np.concatenate([self._last[[column]], passed])[np.cumsum(good)]
        if len(rows):
            self._last = answers[-1].copy()
        return answers

    def filter(self, samples: ArrayLike) -> Floats:
        """Filter a whole recording (n, c) from its start as a fresh `update` would, to the last bit.

        Raises
        ------
        InputError
            The shape is wrong.
        """
        return LowPass(self.cutoff, self.rate, self.order).update_block(samples)
