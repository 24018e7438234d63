"""Units of force, torque, length, angle and time, as devices write them."""

import math
import re

_POUND = 0.45359237 * 9.80665  # lbf in N; both factors are exact by definition
_INCH = 0.0254
_GRAVITY = 9.80665
# Written with and without hyphens, and kg for kgf, by different firmware.
FORCES = {
    "n": 1.0,
    "kn": 1e3,
    "lbf": _POUND,
    "lb": _POUND,
    "klbf": 1e3 * _POUND,
    "klb": 1e3 * _POUND,
    "kgf": _GRAVITY,
    "kg": _GRAVITY,
    "gf": 1e-3 * _GRAVITY,
    "g": 1e-3 * _GRAVITY,
}
"""In N."""
TORQUES = {
    "nm": 1.0,
    "nmm": 1e-3,
    "ncm": 1e-2,
    "knm": 1e3,
    "lbfin": _POUND * _INCH,
    "lbin": _POUND * _INCH,
    "lbfft": 12 * _POUND * _INCH,
    "lbft": 12 * _POUND * _INCH,
    "kgfm": _GRAVITY,
    "kgm": _GRAVITY,
    "kgfcm": 1e-2 * _GRAVITY,
    "kgcm": 1e-2 * _GRAVITY,
}
"""In N·m."""
LENGTHS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": _INCH}
"""In m."""
ANGLES = {"rad": 1.0, "deg": math.pi / 180}
"""In rad."""
TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
"""In s."""


def unit_factor(units: dict[str, float], text: str) -> float | None:
    """
    Return a unit in SI, however it is spelt (``N-m``, ``Nm``, ``N·m``); None: it is none of these.

    A hyphen counts only between letters: one at an end may be meant as a sign, which no unit has.
    """
    return units.get(re.sub(r"(?<=[a-z])-(?=[a-z])", "", re.sub(r"[ .·]", "", text.lower())))
