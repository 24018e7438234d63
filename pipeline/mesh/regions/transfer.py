"""Carry regions from one mesh of a surface to another: after making a shell, simplifying, or a new export."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from contactbench.pipeline.errors import arg, join, message
from contactbench.pipeline.mesh.errors import MeshWarning
from contactbench.pipeline.mesh.regions.closest import carry_labels
from contactbench.pipeline.mesh.regions.errors import RegionError
from contactbench.pipeline.mesh.regions.region import RegionSet

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.mesh.probe import Probe

# Of the old mesh's size: a surface that was made a shell or simplified stays well within.
_REACH = 0.02


@dataclass(frozen=True)
class RegionReport:
    """
    What became of one region.

    Attributes
    ----------
    name : str
    before, after : float
        Its area on the old and on the new mesh, m².
    lost, gained : float
        Area of the old region that no facet of the new one lies on, and of the new one that lies outside the
        old, m²; as far as centroids tell.
    """

    name: str
    before: float
    after: float
    lost: float
    gained: float

    @property
    def vanished(self) -> bool:
        """There was a region, and nothing of it is left."""
        return self.before > 0 and self.after == 0

    @property
    def change(self) -> float:
        """Change of the area as a share of what it was; NaN for a region that was empty."""
        return (self.after - self.before) / self.before if self.before > 0 else math.nan

    @property
    def sentence(self) -> str:
        """The figures for people, mm² and %."""
        if self.vanished:
            return message(f"{arg(self.name)}: VANISHED, it had {arg(1e6 * self.before):.3g} mm².")
        if self.before == 0:
            return message(f"{arg(self.name)}: empty before, {arg(1e6 * self.after):.3g} mm² now.")
        return message(
            f"{arg(self.name)}: {arg(1e6 * self.before):.4g} mm² before, {arg(1e6 * self.after):.4g} mm² now"
            f" ({arg(100 * self.change):+.2f} %); lost {arg(1e6 * self.lost):.3g} mm²"
            f" ({arg(100 * self.lost / self.before):.2f} %), gained {arg(1e6 * self.gained):.3g} mm²"
            f" ({arg(100 * self.gained / self.before):.2f} %)."
        )

    def to_json(self) -> dict[str, Any]:
        """Areas in mm²."""
        return {
            "name": self.name,
            "before_mm2": 1e6 * self.before,
            "after_mm2": 1e6 * self.after,
            "lost_mm2": 1e6 * self.lost,
            "gained_mm2": 1e6 * self.gained,
            "vanished": self.vanished,
        }


@dataclass(frozen=True, eq=False)
class Transferred:
    """
    Regions on the new mesh, and what it cost.

    Attributes
    ----------
    regions : RegionSet
        The same names, colours and order.
    report : tuple of RegionReport
        One per region, in the order of priority.
    unmatched : int
        Facets of the new mesh that belong to no region because the old surface is too far away there, or
        faces the other way.
    """

    regions: RegionSet
    report: tuple[RegionReport, ...]
    unmatched: int

    @property
    def warnings(self) -> tuple[str, ...]:
        """What someone should look at, in sentences."""
        found = [
            message(
                f"the region {arg(part.name)} ({arg(1e6 * part.before):.3g} mm²) vanished: the new mesh is"
                " too coarse there or has lost that part. Keep more facets, or paint it again."
            )
            for part in self.report
            if part.vanished
        ]
        if self.unmatched:
            found.append(
                message(
                    f"{arg(self.unmatched)} of {arg(len(self.regions.labels))} facets have no part of the old"
                    " surface near them and belong to no region: check that both meshes are in the"
                    " same place."
                )
            )
        return tuple(found)


def transfer(
    regions: RegionSet,
    old: Probe,
    new: Probe,
    vertex_map: npt.ArrayLike | None = None,
    *,
    reach: float | None = None,
) -> Transferred:
    """
    Carry regions to another mesh of the same surface, in the same frame.

    A facet whose three corners come from the corners of one old facet takes over that one's region. Any other
    takes the region of the old surface's point nearest to its centroid, among facets that face the same way:
    a thin wall does not take over what lies on its other side.

    Parameters
    ----------
    regions : RegionSet
        On the old mesh.
    old, new : Probe
        Both in S.
    vertex_map : (n,) array_like of integers, optional
        For each vertex of the new mesh the old vertex it is, -1 for none.
    reach : float, optional
        Facets further than this from the old surface belong to no region, m; 2 % of the old size when left out.

    Returns
    -------
    Transferred

    Raises
    ------
    RegionError
        Regions of another mesh, or a vertex map that does not fit.

    Warns
    -----
    MeshWarning
        A region vanished, or facets have no counterpart.
    """
    if len(regions.labels) != len(old.faces):
        raise RegionError(
            f"the regions are for {arg(len(regions.labels))} facets, but the old mesh has"
            f" {arg(len(old.faces))}: give the mesh that they belong to."
        )
    distance = _REACH * old.size if reach is None else reach
    labels, unmatched = carry_labels(
        (old.vertices, old.faces),
        regions.labels,
        (new.vertices, new.faces),
        vertex_map=vertex_map,
        reach=distance,
    )
    carried = RegionSet(regions.regions, labels)
    back, _ = carry_labels(
        (new.vertices, new.faces), labels, (old.vertices, old.faces), vertex_map=None, reach=distance
    )
    forth = labels
    result = Transferred(carried, _report(regions, back, forth, old, new), unmatched)
    if result.warnings:
        warnings.warn(join(" ", result.warnings), MeshWarning, stacklevel=2)
    return result


def _report(
    regions: RegionSet,
    back: npt.NDArray[np.int32],
    forth: npt.NDArray[np.int32],
    old: Probe,
    new: Probe,
) -> tuple[RegionReport, ...]:
    """Compare areas; what the new labels say when carried back onto the old mesh tells what was lost and gained."""
    parts = []
    for rank, region in enumerate(regions.regions, 1):
        was, returned, now = regions.labels == rank, back == rank, forth == rank
        parts.append(
            RegionReport(
                region.name,
                float(old.areas[was].sum()),
                float(new.areas[now].sum()),
                lost=float(old.areas[was & ~returned].sum()),
                gained=float(old.areas[returned & ~was].sum()),
            )
        )
    return tuple(parts)
