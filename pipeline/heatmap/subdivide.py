"""The same surface in smaller facets, so that a map on it can be finer than the mesh that contacts are solved on."""

from weakref import WeakKeyDictionary

import numpy as np

from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.regions.facet_graph import halve_long

EDGE = 1.5e-3  # m: the smallest bandwidth by default; a bell is then drawn by some twenty corners
_MOST_FACETS = 100_000  # facets: what a picture needs, and what is turned by hand without waiting
_AREA_OF_EDGE = 0.2  # of the longest edge squared: the area of a facet after halving, on average
_HALVINGS_OF_EDGES = 20  # each halves the longest edges: a millionth of the longest is left
_made: WeakKeyDictionary[Probe, Probe] = WeakKeyDictionary()


def drawing_of(probe: Probe) -> Probe:
    """Return the probe that maps are drawn on, `finer`; the same one each time, as long as the probe is in use."""
    found = _made.get(probe)
    if found is None:
        found = finer(probe)
        if found is not probe:  # a value that is its own key would never go
            _made[probe] = found
    return found


def finer(probe: Probe, edge: float = EDGE) -> Probe:
    """
    Return a probe whose facets have no longer edges, and the same surface.

    An edge that is too long is halved in both facets that share it, so no gap opens. Corners of the probe keep
    their numbers.

    Parameters
    ----------
    edge : float
        The longest edge, m; longer where there would be more than 100,000 facets.

    Returns
    -------
    Probe
        The same object when its edges are short enough.
    """
    limit = max(edge, float(np.sqrt(probe.areas.sum() / (_AREA_OF_EDGE * _MOST_FACETS))))
    mesh, origin = (probe.vertices, probe.faces), np.arange(len(probe.faces))
    for _ in range(_HALVINGS_OF_EDGES):
        finer = halve_long(mesh, np.arange(len(mesh[1])), lambda _: limit)
        if finer is None:
            break
        mesh, origin = finer[0], origin[finer[1]]
    return probe if mesh[1] is probe.faces else probe.cut(mesh, origin)
