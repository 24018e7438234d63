"""The colours of fields, heatmaps and errors: from the grey of a surface without any value to a dark violet.

Zero is what the surface looks like anyway, so that only what is there stands out. The steps are even to the eye:
lightness falls evenly in Oklab (Ottosson 2020) and the path through hue is measured by its length there, so that it
reads alike with any colour vision, and in grey.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

PLAIN = 200
"""Grey of a surface without a value, of 255: `contactbench.pipeline.mesh.colours.PLAIN` as a number."""

_TOP = 95.0  # per cent of the known values are below the last colour
_FAR_OUT = 1.5  # quartiles' distances above the upper quartile, of the logarithms
_NEARLY = 0.8  # of the largest value: nearer than that, the colours end at it

_DECADES = 6.0  # that a logarithmic scale has at most; one at the least
_BEGINNING = 0.12  # of the ramp: the first colour of a logarithmic scale, which is told from none at all

# Red, green, blue at even steps.
_RAMP = (
    "c8c8c8c7c4bdc7c1b4c7beaac7bba0c7b796c8b48bc8b081c9ac76caa86bcba460cc9f55cc9b49"
    "cc953fcc9035cc8a2ccc8522cd7f19cd7910cc7309cb6e06ca6807c8630cc65d11c45816c2521a"
    "c04d1ebd4822bb4226b83d29b5382db13431ad3034a82c38a42a3b9f273e9925409423438f2145"
    "8a1f47841e497e1d4a781d4b721d4c6c1d4c661d4c601d4c5a1d4b541d4a4e1d49481c47421c45"
)


def colour_ramp(count: int = 256, begin: float = 0.0) -> NDArray[np.float64]:
    """Return the colours from zero, or from that share of the way, to the largest value, sRGB (count, 3), 0 to 1."""
    known = np.frombuffer(bytes.fromhex(_RAMP), np.uint8).reshape(-1, 3) / 255.0
    places, share = np.linspace(0.0, 1.0, len(known)), np.linspace(begin, 1.0, count)
    return np.column_stack([np.interp(share, places, known[:, k]) for k in range(3)])


@dataclass(frozen=True)
class ColourScale:
    """Which value has which colour: from `low` to `top`; what is beyond has the colour of that end."""

    top: float = 1.0
    low: float = 0.0  # above 0 where it is logarithmic
    logarithmic: bool = False

    @classmethod
    def of(
        cls,
        values: NDArray[np.float64],
        weights: NDArray[np.float64] | None = None,
        logarithmic: bool = False,
    ) -> "ColourScale":
        """Return the scale of values, see `end_of_colours`; a logarithmic one begins at the least above 0."""
        top = end_of_colours(values, weights)
        if not logarithmic or not top > 0:
            return cls(top)
        low = float(np.clip(values[values > 0].min(), top / 10**_DECADES, top / 10))
        return cls(top, low, True)

    def joined(self, other: "ColourScale") -> "ColourScale":
        """Return the scale for what either of two is for; one that ends at 0 is for nothing."""
        if not (self.top > 0 and other.top > 0):
            return self if self.top > 0 else other
        return ColourScale(max(self.top, other.top), min(self.low, other.low), self.logarithmic)

    @property
    def _end(self) -> float:
        return self.top if self.top > self.low else self.low + 1.0

    def places(self, values: ArrayLike) -> NDArray[np.float64]:
        """Return where values lie between the two ends, 0 to 1; NaN at the first."""
        known = np.nan_to_num(np.asarray(values, dtype=np.float64))
        low, top = self.low, self._end
        if self.logarithmic:
            known, low, top = np.log(np.maximum(known, low)), np.log(low), np.log(top)
        return np.clip((known - low) / (top - low), 0.0, 1.0)

    def ramp(self, count: int = 256) -> NDArray[np.float64]:
        """Return the colours from one end to the other, sRGB (count, 3), 0 to 1."""
        return colour_ramp(count, _BEGINNING if self.logarithmic else 0.0)

    def colours(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the colours (n, 3), sRGB, 0 to 1, of values (n,)."""
        table = self.ramp()
        return table[np.rint(self.places(values) * (len(table) - 1)).astype(np.intp)]

    def ticks(self) -> list[float]:
        """Return round values from one end to the other: powers of ten on a logarithmic scale that has some."""
        if not self.logarithmic:
            step = round_length((self._end - self.low) / 2.5)
            first = np.ceil(self.low / step - 1e-9)
            return [float((first + i) * step) for i in range(int((self._end / step - first) + 1 + 1e-9))]
        powers = range(int(np.floor(np.log10(self.low))), int(np.ceil(np.log10(self.top))) + 1)
        inside = [
            [
                value
                for power in powers
                for step in steps
                if self.low <= (value := step * 10.0**power) <= self.top
            ]
            for steps in ((1.0,), (1.0, 2.0, 5.0))
        ]
        return inside[0] if len(inside[0]) > 2 else inside[1]


def round_length(longest: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is at most `longest`."""
    power = 10.0 ** np.floor(np.log10(longest))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= longest * (1 + 1e-9)))


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
