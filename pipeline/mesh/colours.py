"""Colours of regions, and of what was invented: the same in files, windows and pictures."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.mesh.arrays import Ints, Mask

# Okabe & Ito's colours, told apart with every kind of colour vision; black is left out, it hides the shading.
PALETTE = ("#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7")
PLAIN, INVENTED = "#c8c8c8", "#464646"


def facet_colours(region: Ints, invented: Mask, colours: Sequence[str] = ()) -> npt.NDArray[np.uint8]:
    """
    Colour facets by region; an invented one in a region is half of each.

    Parameters
    ----------
    region : (m,) int32
        Priority per facet, 0 for none.
    invented : (m,) bool
    colours : sequence of str
        ``#rrggbb`` per priority; the palette's for those that are left out.

    Returns
    -------
    (m, 3) uint8
        Red, green, blue.
    """
    table = np.array([_rgb(colour) for colour in (PLAIN, *colours, *PALETTE)], dtype=np.uint16)
    # A rank may be any number up to 2^31: no table of that length is made.
    left_out = 1 + len(colours) + (region.astype(np.int64) - 1) % len(PALETTE)
    found = table[np.where(region <= len(colours), region, left_out)]
    guess = np.array(_rgb(INVENTED), dtype=np.uint16)
    mixed = np.where((region > 0)[:, None], (found + guess) // 2, guess)
    return np.where(invented[:, None], mixed, found).astype(np.uint8)


def _rgb(colour: str) -> tuple[int, int, int]:
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
