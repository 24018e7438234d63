"""The separate parts of a mesh, each with its area, size, volume and whether it is closed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.mesh.health import label_parts

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.mesh.health import EdgeTable

# Screws and letters of an assembly come by the hundred; the rest is counted, not listed.
LISTED = 200


@dataclass(frozen=True)
class MeshPart:
    """
    Facets that hang together over vertices.

    Attributes
    ----------
    facets : int
    area_m2 : float
    extents_m : (3,) tuple of float
        Along the axes.
    closed : bool
        Every edge belongs to exactly two facets.
    volume_m3 : float or None
        Signed, negative where the facets face inwards; None where the part is open or its facets disagree.
    hidden_share : float or None
        Share of the area that no ray from outside reaches; None where no ray was shot at it.
    turned_share : float or None
        Share of the area whose back sees clearly more of the outside than its front.
    """

    facets: int
    area_m2: float
    extents_m: tuple[float, float, float]
    closed: bool
    volume_m3: float | None
    hidden_share: float | None = None
    turned_share: float | None = None


@dataclass(frozen=True, eq=False)
class Parts:
    """
    All parts, numbered from the largest area on.

    Attributes
    ----------
    label : (m,) int64
        The part of each facet.
    area : (m,) float64
        Of each facet, m².
    listed : tuple of MeshPart
        The largest 200.
    count : int
    """

    label: npt.NDArray[np.int64]
    area: npt.NDArray[np.float64]
    listed: tuple[MeshPart, ...]
    count: int


def find_parts(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32], edges: EdgeTable) -> Parts:
    """
    Take a mesh apart.

    Parameters
    ----------
    vertices : (n, 3) float64
        Metres.
    faces : (m, 3) int32
        Indices in range.
    edges : EdgeTable
        Of the mesh.
    """
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    # About the middle: no cancellation far from the origin.
    centred = vertices - (vertices[used].min(axis=0) + vertices[used].max(axis=0)) / 2
    a, b, c = (centred[faces[:, corner]] for corner in range(3))
    cross = np.cross(b - a, c - a)
    area = np.linalg.norm(cross, axis=1) / 2
    volume = np.einsum("ij,ij->i", a, cross) / 6
    label = label_parts(faces, len(vertices))
    count = int(label.max()) + 1
    total = np.bincount(label, area, minlength=count)
    rank = np.empty(count, dtype=np.int64)
    rank[np.lexsort((np.arange(count), -total))] = np.arange(count)
    label = rank[label]
    part_of_vertex = np.zeros(len(vertices), dtype=np.int64)
    part_of_vertex[faces] = label[:, None]
    closed, sound = np.ones(count, dtype=bool), np.ones(count, dtype=bool)
    closed[part_of_vertex[edges.low[edges.uses != 2]]] = False
    sound[part_of_vertex[edges.low[(edges.uses != 2) | (edges.balance != 0)]]] = False
    facets, total = np.bincount(label, minlength=count), np.bincount(label, area, minlength=count)
    enclosed = np.bincount(label, volume, minlength=count)
    extents = _extents(centred, part_of_vertex, used, min(count, LISTED))
    listed = tuple(
        MeshPart(
            int(facets[i]),
            float(total[i]),
            extents[i],
            bool(closed[i]),
            float(enclosed[i]) if sound[i] else None,
        )
        for i in range(min(count, LISTED))
    )
    return Parts(label, area, listed, count)


def genus_of(
    vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int32], edges: EdgeTable, parts: int
) -> tuple[int, int | None]:
    """
    Euler number V - E + F of the surface, and its genus: handles, that is holes that go right through.

    Parameters
    ----------
    vertices : (n, 3) float64
        Any unit.
    faces : (m, 3) int32
        Indices in range.
    edges : EdgeTable
        Of the mesh.
    parts : int
        How many; each adds 2 to the Euler number of a closed surface and takes 2 for each handle.

    Returns
    -------
    euler : int
    genus : int or None
        All parts together; None unless every edge belongs to exactly two facets of opposite direction, and
        where surfaces touch in a vertex.
    """
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    euler = int(used.sum()) - len(edges.low) + len(faces)
    handles, odd = divmod(2 * parts - euler, 2)
    closed = bool(np.all(edges.uses == 2) and np.all(edges.balance == 0))
    return euler, handles if closed and not odd and handles >= 0 else None


def _extents(
    points: npt.NDArray[np.float64],
    part: npt.NDArray[np.int64],
    used: npt.NDArray[np.bool_],
    count: int,
) -> list[tuple[float, float, float]]:
    chosen = np.flatnonzero(used & (part < count))
    order = chosen[np.argsort(part[chosen], kind="stable")]
    first = np.searchsorted(part[order], np.arange(count))
    spans = np.maximum.reduceat(points[order], first) - np.minimum.reduceat(points[order], first)
    return [(float(x), float(y), float(z)) for x, y, z in spans]
