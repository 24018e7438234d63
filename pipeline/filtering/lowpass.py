"""The low-pass filter of contact locations."""

from math import pi, sin, tan

from contactbench.pipeline.errors import InputError, arg
from contactbench.pipeline.filtering.rows import positive


class LowPass:
    """Settings of a Butterworth low-pass; a runtime starts it at the first sample, not at zero.

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

    @property
    def delay(self) -> float:
        """Lag behind slow motion, s: the group delay at 0 Hz, 1 / (2 rate tan(π f / rate) sin(π / (2 n)))."""
        return 1 / (2 * self.rate * tan(pi * self.cutoff / self.rate) * sin(pi / (2 * self.order)))
