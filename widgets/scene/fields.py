"""The colours of fields, cividis, which people with any colour vision read alike; and round numbers for a bar."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Every fifth of the 256 colours of Nuñez, Anderton and Renslow (2018): red, green, blue.
_CIVIDIS = (
    "00224e002656002a5f002d68003070083370163770203a6f273e6e2e416d34456c3a486c3f4c6c"
    "444f6c49536c4e566c535a6d575d6d5c616e60646f656870696b716d6f727272747676767a7a78"
    "7e7d788381798885788d8878928c789690779b9476a09875a59c74aaa073afa471b5a86fbaac6d"
    "bfb06bc4b468c9b965cfbd62d4c15fdac65bdfca57e5cf52ead34cf0d846f6dd3ffce236fee838"
)


def cividis(count: int = 256) -> NDArray[np.float64]:
    """Return the colours from the lowest to the highest value, (count, 3), 0 to 1."""
    known = np.frombuffer(bytes.fromhex(_CIVIDIS), np.uint8).reshape(-1, 3) / 255.0
    places, share = np.linspace(0.0, 1.0, len(known)), np.linspace(0.0, 1.0, count)
    return np.column_stack([np.interp(share, places, known[:, k]) for k in range(3)])


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
