"""From values to colours: `contactbench.pipeline.colour_ramp`, whose zero is the grey of no data."""

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.colour_ramp import PLAIN, ColourScale
from contactbench.pipeline.heatmap.heatmap import Heatmap

NO_DATA = (PLAIN / 255,) * 3


def colours(heatmap: Heatmap, scale: ColourScale | None = None) -> NDArray[np.float64]:
    """Return the sRGB colour (v, 3), 0 to 1, of each vertex, by its own scale or another."""
    return np.where(heatmap.known[:, None], (scale or heatmap.scale).colours(heatmap.values), NO_DATA)


def linear(srgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return sRGB colours as shares of light, which is how glTF keeps them (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
