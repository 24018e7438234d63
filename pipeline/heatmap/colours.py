"""From values to colours: cividis, which reads the same with every kind of colour vision; no data is grey."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.heatmap.heatmap import Heatmap

MAP = "cividis"
NO_DATA = (0.85, 0.85, 0.87)


def colours(heatmap: Heatmap, largest: float | None = None) -> NDArray[np.float64]:
    """Return the sRGB colour (v, 3), 0 to 1, of each vertex; `largest`, or else its `top`, has the last colour."""
    import matplotlib as mpl

    top = heatmap.top if largest is None else largest
    share = np.clip(np.nan_to_num(heatmap.values) / (top or 1.0), 0.0, 1.0)
    colour = np.asarray(mpl.colormaps[MAP](share), dtype=np.float64)[:, :3]
    return np.where(heatmap.known[:, None], colour, NO_DATA)


def linear(srgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return sRGB colours as shares of light, which is how glTF keeps them (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
