"""
``planes.csv``: the facets as planes in priority order.

For controllers that run the loop of Cao et al. (2023) themselves: the first plane whose triangle the axis of the
wrench passes through is the contact. Facets of region 1 come first, then 2, and so on, then those of no region, and
those of untouchable regions last.
Columns: the facet's row in ``probe.ply``; its outward unit normal n; d of the plane ``n . p + d = 0``, as
the paper prints it, m; its region; its three corners in S, m, counter-clockwise from outside.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from pipeline.config.runtime.errors import ConfigError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pipeline.mesh import Probe

COLUMNS = (
    "index",
    "nx",
    "ny",
    "nz",
    "d",
    "region",
    *(f"{axis}{corner}" for corner in "123" for axis in "xyz"),
)
_HEADER = ",".join(COLUMNS)
# Python reads 1_0 and spaces as numbers; others do not.
_PLAIN = re.compile(rb"[a-z0-9,]+\n[0-9e+.,\n-]+\n")
# Normals are computed anew on another machine.
_ROUNDING = 1e-9


def encode_planes(probe: Probe) -> bytes:
    """Write the table; every number reads back as the same double."""
    order = _order(probe)
    numbers = np.hstack(_parts(probe, order)).tolist()
    lines = [_HEADER]
    for index, region, row in zip(order.tolist(), probe.region[order].tolist(), numbers, strict=True):
        plane, corners = row[:4], row[4:]
        lines.append(f"{index},{','.join(map(repr, plane))},{region},{','.join(map(repr, corners))}")
    return ("\n".join(lines) + "\n").encode("ascii")


def check_planes(data: bytes, probe: Probe, name: str) -> int:
    """
    Refuse a table that is not of this mesh, and return how many planes it has.

    Raises
    ------
    ConfigError
        It is no such table, or a row is not the plane of its facet, or not in its place.
    """
    if not _PLAIN.fullmatch(data):
        raise ConfigError(f"{name}: this is no table of planes: export the config again.")
    try:
        header, *lines = data.decode("ascii").removesuffix("\n").split("\n")
        # Cell by cell: as an array of texts, one long cell would make every cell as long.
        table = np.array([[float(cell) for cell in line.split(",")] for line in lines])
    except ValueError as error:
        raise ConfigError(
            f"{name}: this is no table of planes ({error!s:.100}): export the config again."
        ) from None
    order = _order(probe)
    if header != _HEADER or table.shape != (len(order), len(COLUMNS)):
        raise ConfigError(
            f"{name}: the table has another header, or {table.shape[0]} planes where the mesh has {len(order)}"
            " facets: export the config again."
        )
    planes, corners = _parts(probe, order)
    exact = np.column_stack([order, probe.region[order], corners])
    same = (table[:, [0, 5, *range(6, 15)]] == exact).all(axis=1)
    same &= (np.abs(table[:, 1:5] - planes) <= _ROUNDING).all(axis=1)
    if not same.all():
        row = int(np.argmin(same))
        raise ConfigError(
            f"{name}: row {row + 2} is not the plane of facet {order[row]}, which belongs there:"
            " export the config again."
        )
    return len(table)


def _order(probe: Probe) -> NDArray[np.int64]:
    last = np.iinfo(np.int64).max
    ranks = np.where(probe.region > 0, probe.region.astype(np.int64), last - 1)
    ranks[np.isin(probe.region, probe.untouchable)] = last
    return np.argsort(ranks, kind="stable")


def _parts(probe: Probe, order: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return (m, 4) normals and d, and (m, 9) corners."""
    corners, normals = probe.vertices[probe.faces[order]], probe.normals[order]
    d = -np.einsum("ij,ij->i", normals, corners.mean(axis=1))
    return np.column_stack([normals, d]), corners.reshape(-1, 9)
