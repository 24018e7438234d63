"""The same surface in smaller facets, so that a map on it can be finer than the mesh that contacts are solved on."""

from __future__ import annotations

from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from contactbench.pipeline.mesh.probe import Probe, build_probe

if TYPE_CHECKING:
    from numpy.typing import NDArray

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
    vertices: NDArray[np.float64] = probe.vertices
    faces: NDArray[np.integer] = probe.faces
    origin = np.arange(len(faces))
    for _ in range(_HALVINGS_OF_EDGES):
        edges, of_face = _edges(faces)
        long = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1) > limit
        if not long.any():
            break
        middle = np.full(len(edges), -1, dtype=np.int64)
        middle[long] = len(vertices) + np.arange(np.count_nonzero(long))
        vertices = np.concatenate([vertices, vertices[edges[long]].mean(axis=1)])
        faces, parents = _split(faces, middle[of_face])
        origin = origin[parents]
    if faces is probe.faces:
        return probe
    return build_probe(
        np.ascontiguousarray(vertices),
        np.ascontiguousarray(faces, dtype=np.int32),
        probe.region[origin],
        probe.name,
        invented=probe.invented[origin],
    )


def _edges(faces: NDArray[np.integer]) -> tuple[NDArray[np.int64], NDArray[np.intp]]:
    """Return the edges (e, 2), and for each facet (m, 3) the numbers of those opposite its corners 2, 0 and 1."""
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2).astype(np.int64)
    ends.sort(axis=1)
    count = int(ends.max()) + 1
    keys, number = np.unique(ends[:, 0] * count + ends[:, 1], return_inverse=True)
    return np.column_stack(np.divmod(keys, count)), number.reshape(-1, 3)


def _split(
    faces: NDArray[np.integer], middle: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.intp]]:
    """
    Split facets at the middles (m, 3) of their edges 01, 12 and 20; -1: that edge stays whole.

    Returns
    -------
    (k, 3) facets, and (k,) the facet that each is a part of.
    """
    cut = middle >= 0
    count = cut.sum(axis=1)
    # Turn each facet so that its cut edges come first; of two, the whole one is last.
    first = np.where(count == 2, np.argmin(cut, axis=1) + 1, np.argmax(cut, axis=1))
    turned = (first[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(faces.astype(np.int64), turned, axis=1).T
    p, q, r = np.take_along_axis(middle, turned, axis=1).T
    parts = {
        0: [(a, b, c)],
        1: [(a, p, c), (p, b, c)],
        2: [(p, b, q), (a, p, q), (a, q, c)],
        3: [(a, p, r), (p, b, q), (r, q, c), (p, q, r)],
    }
    made, parents = [], []
    for cuts, pieces in parts.items():
        rows = np.flatnonzero(count == cuts)
        for piece in pieces:
            made.append(np.column_stack([corner[rows] for corner in piece]))
            parents.append(rows)
    return np.concatenate(made), np.concatenate(parents)
