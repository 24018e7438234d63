"""The least that makes a mesh sound: facets turned, dropped or left as they are, never moved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from pipeline.mesh.health import measure_health
from pipeline.mesh.shell.exposure import exposure
from pipeline.mesh.triangles import cross_products

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

_HIDDEN = 1e-3  # a part of which less than this is exposed, at best, lies inside another
_LOOKS = 64


def repair(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], tick: Callable[[float], None] | None = None
) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """
    Drop repeated facets and hidden parts, and turn facets until all face outwards, as far as that helps.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int32
    tick : callable, optional
        Told the share that is done; may raise to stop.

    Returns
    -------
    kept : (k,) int64
        Facets that remain, ascending; all of them where the mesh cannot be mended like this.
    turned : (m,) bool
        Facets to turn over, of all.
    """
    kept = _without_repeats(faces)
    turned = np.zeros(len(faces), dtype=bool)
    found = _consistent(faces[kept])
    if found is None:
        return np.arange(len(faces)), turned
    turned[kept], label = found
    oriented = turn(faces, turned)
    corners = vertices[oriented[kept]] - vertices[oriented[kept[0], 0]]
    volumes = np.einsum("ij,ij->i", corners[:, 0], cross_products(vertices, oriented[kept]))
    inwards = np.bincount(label, volumes) < 0
    turned[kept] ^= inwards[label]
    if len(inwards) > 1:
        seen = exposure(vertices, turn(faces, turned)[kept], count=_LOOKS, tick=tick)
        best = np.zeros(len(inwards))
        np.maximum.at(best, label, seen)
        kept = kept[best[label] > _HIDDEN]
    return kept, turned


def turn(faces: NDArray[np.int32], turned: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Copy the facets, with those of `turned` the other way round."""
    out = faces.copy()
    out[turned] = out[turned][:, ::-1]
    return out


def is_sound(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> bool:
    """Tell whether the facets form one closed surface that faces outwards."""
    return not measure_health(vertices, faces).sentences


def _without_repeats(faces: NDArray[np.int32]) -> NDArray[np.int64]:
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return np.sort(first)


def _consistent(faces: NDArray[np.int32]) -> tuple[NDArray[np.bool_], NDArray[np.int64]] | None:
    """Tell which facets to turn to agree, and their parts, (m,) each; None unless each edge has two facets."""
    m = len(faces)
    start, end = faces.T.ravel().astype(np.int64), np.roll(faces, -1, axis=1).T.ravel().astype(np.int64)
    count = int(faces.max()) + 1
    key = np.minimum(start, end) * count + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    if len(order) % 2 or (np.diff(key[order])[::2] != 0).any() or (np.diff(key[order])[1::2] == 0).any():
        return None
    a, b = order[::2], order[1::2]
    # The facets of an edge agree when they run along it in opposite directions. Each facet is there twice, as it
    # is and turned over; what hangs together among those doubles is one consistent choice.
    agree = (start[a] < end[a]) != (start[b] < end[b])
    f, g = a % m, b % m
    rows = np.concatenate((f, f + m))
    columns = np.concatenate((np.where(agree, g, g + m), np.where(agree, g + m, g)))
    graph = coo_array((np.ones(2 * len(f), dtype=np.int8), (rows, columns)), shape=(2 * m, 2 * m))
    _, label = connected_components(graph, directed=False)
    as_is, turned = label[:m], label[m:]
    if (as_is == turned).any():  # one-sided, like a Möbius strip
        return None
    part = np.unique(np.minimum(as_is, turned), return_inverse=True)[1]
    return turned < as_is, part.astype(np.int64)
