"""The ends of a scale of colours, and round numbers for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def limits_of(values: NDArray[np.float64]) -> tuple[float, float]:
    """Return the lowest and highest finite value, never the same."""
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        return 0.0, 1.0
    low, high = float(finite.min()), float(finite.max())
    return (low, high) if high > low else (low, low + max(abs(low), 1.0) * 1e-3)


def round_length(longest: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is at most `longest`."""
    power = 10.0 ** np.floor(np.log10(longest))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= longest * (1 + 1e-9)))


def ticks(low: float, high: float) -> list[float]:
    """Return three to six round values between two."""
    step = round_length((high - low) / 2.5)
    first = np.ceil(low / step - 1e-9)
    return [float((first + i) * step) for i in range(int((high / step - first) + 1 + 1e-9))]
