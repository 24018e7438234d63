"""The colours of fields, heatmaps and errors: from the grey of a surface without any value to a dark violet.

Zero is what the surface looks like anyway, so that only what is there stands out. The steps are even to the eye:
lightness falls evenly in Oklab (Ottosson 2020) and the path through hue is measured by its length there, so that it
reads alike with any colour vision, and in grey.
"""

import numpy as np
from numpy.typing import NDArray

PLAIN = 200
"""Grey of a surface without a value, of 255: `contactbench.pipeline.mesh.colours.PLAIN` as a number."""

_TOP = 95.0  # per cent of the known values are below the last colour
_FAR_OUT = 1.5  # quartiles' distances above the upper quartile, of the logarithms
_NEARLY = 0.8  # of the largest value: nearer than that, the colours end at it

# Red, green, blue at even steps.
_RAMP = (
    "c8c8c8c7c4bdc7c1b4c7beaac7bba0c7b796c8b48bc8b081c9ac76caa86bcba460cc9f55cc9b49"
    "cc953fcc9035cc8a2ccc8522cd7f19cd7910cc7309cb6e06ca6807c8630cc65d11c45816c2521a"
    "c04d1ebd4822bb4226b83d29b5382db13431ad3034a82c38a42a3b9f273e9925409423438f2145"
    "8a1f47841e497e1d4a781d4b721d4c6c1d4c661d4c601d4c5a1d4b541d4a4e1d49481c47421c45"
)


def colour_ramp(count: int = 256) -> NDArray[np.float64]:
    """Return the colours from zero to the largest value, sRGB (count, 3), 0 to 1."""
    known = np.frombuffer(bytes.fromhex(_RAMP), np.uint8).reshape(-1, 3) / 255.0
    places, share = np.linspace(0.0, 1.0, len(known)), np.linspace(0.0, 1.0, count)
    return np.column_stack([np.interp(share, places, known[:, k]) for k in range(3)])


def ramp_colours(values: NDArray[np.float64], top: float) -> NDArray[np.float64]:
    """Return the colours (n, 3), sRGB, 0 to 1, of values (n,) from 0 to `top`; what is above has the last one."""
    table = colour_ramp()
    share = np.clip(np.nan_to_num(values) / (top or 1.0), 0.0, 1.0)
    return table[np.rint(share * (len(table) - 1)).astype(np.intp)]


def end_of_colours(values: NDArray[np.float64], weights: NDArray[np.float64] | None = None) -> float:
    """
    Return where the colours of values (v,) end; 0 where none is known.

    `weights` (v,), 0 or more, are what each of them counts; left out, all count alike. Of that 95 % are below, unless
    that is nearly the largest, and it is not beyond Tukey's fence (1977) of the logarithms: by as large a factor above
    the upper quartile as 1.5 times that between the quartiles. One wrong touch of ten would else leave a single colour
    for all the others; what varies over decades, as a density does, is not cut.
    """
    there = np.isfinite(values)
    if not there.any():
        return 0.0
    known, counts = values[there], np.ones(int(there.sum())) if weights is None else weights[there]
    (high,), largest = _percentiles(known, counts, [_TOP]), float(known.max())
    above = known > 0
    low, middle = _percentiles(known[above], counts[above], [25.0, 75.0]) if high > 0 else (0.0, 0.0)
    if low > 0:
        high = min(high, float(middle * (middle / low) ** _FAR_OUT))
    return high if 0 < high < _NEARLY * largest else largest


def _percentiles(
    values: NDArray[np.float64], counts: NDArray[np.float64], per_cent: list[float]
) -> list[float]:
    """Return percentiles of values that count as much as `counts`; linear between them, as NumPy has it for ones."""
    order = np.argsort(values)
    up_to = np.cumsum(counts[order]) - 0.5 * counts[order]
    share = (up_to - up_to[0]) / max(float(up_to[-1] - up_to[0]), 1e-300)
    return [float(each) for each in np.interp(np.divide(per_cent, 100.0), share, values[order])]
