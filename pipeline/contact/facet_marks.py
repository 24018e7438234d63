"""What a contact lies on: facets of the mesh file, facets that were made up, or facets that nothing can touch."""

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.mesh import Probe

MARKS = ("measured", "invented", "untouchable")
"""The words, in the order of their numbers; the C library has the same numbers (``cb_contact.on``)."""

INVENTED, UNTOUCHABLE = 1, 2


def facet_marks(probe: Probe) -> NDArray[np.uint8]:
    """
    Return the mark of each facet, a place in `MARKS`.

    A made-up facet of an untouchable region is untouchable: that somebody has said, and it doubts the whole answer.

    Parameters
    ----------
    probe : Probe

    Returns
    -------
    (m,) uint8
    """
    marks = np.where(probe.invented, INVENTED, 0).astype(np.uint8)
    marks[np.isin(probe.region, probe.untouchable)] = UNTOUCHABLE
    return marks
