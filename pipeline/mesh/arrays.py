"""Types of arrays, for annotations: what is in them is said where they are used."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Longs = NDArray[np.int64]
Mask = NDArray[np.bool_]

Surface = tuple[Floats, Ints]
"""Vertices, (n, 3), and facets, (m, 3)."""
Soup = tuple[Floats, Ints, Longs]
"""The same, and a number for each facet, (m,)."""
