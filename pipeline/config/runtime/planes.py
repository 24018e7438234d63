"""
``planes.csv``: the facets as planes in priority order.

For controllers that run the loop of Cao et al. (2023) themselves: the first plane whose triangle the axis of the
wrench passes through is the contact. Facets of region 1 come first, then 2, and so on, then those of no region, and
those of untouchable regions last.
Columns: the facet's row in ``probe.ply``; its outward unit normal n; d of the plane ``n . p + d = 0``, as
the paper prints it, m; its region; its three corners in S, m, counter-clockwise from outside.
"""

import numpy as np
from numpy.typing import NDArray

from contactbench.pipeline.mesh import Probe

_CORNERS = tuple(f"{axis}{corner}" for corner in "123" for axis in "xyz")
COLUMNS = ("index", "nx", "ny", "nz", "d", "region", *_CORNERS)


def encode_planes(probe: Probe) -> bytes:
    """Write the table; the same mesh gives the same bytes, and every number reads back as the same double."""
    order = _order(probe)
    numbers = np.hstack(_parts(probe, order)).tolist()
    lines = [",".join(COLUMNS)]
    for index, region, row in zip(order.tolist(), probe.region[order].tolist(), numbers, strict=True):
        plane, corners = row[:4], row[4:]
        lines.append(f"{index},{','.join(map(repr, plane))},{region},{','.join(map(repr, corners))}")
    return ("\n".join(lines) + "\n").encode("ascii")


def _order(probe: Probe) -> NDArray[np.int64]:
    last = np.iinfo(np.int64).max
    ranks = np.where(probe.region > 0, probe.region.astype(np.int64), last - 1)
    ranks[np.isin(probe.region, probe.untouchable)] = last
    return np.argsort(ranks, kind="stable")


def _parts(probe: Probe, order: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return (m, 4) normals and d, and (m, 9) corners."""
    corners, normals = probe.vertices[probe.faces[order]], probe.normals[order]
    # In a fixed order, for the same bits on every computer.
    middles = (corners[:, 0] + corners[:, 1] + corners[:, 2]) / 3.0
    x, y, z = (normals * middles).T
    d = -(x + z + y)
    return np.column_stack([normals, d]), corners.reshape(-1, 9)
