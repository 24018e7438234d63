"""
Priority regions of a probe: named, ordered sets of facets, edited with undo, kept in files, carried along.

A `RegionSet` is a value: names and colours in the order of priority, and a rank per facet, which is what
`Probe.region` holds. A `RegionModel` edits one; a `FacetGraph` knows the mesh. Nothing here draws anything.
"""

from contactbench.pipeline.mesh.colours import PALETTE
from contactbench.pipeline.mesh.regions.exchange import load_regions, save_regions
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph, MeshEdit
from contactbench.pipeline.mesh.regions.model import RegionChange, RegionModel
from contactbench.pipeline.mesh.regions.region import Region, RegionError, RegionSet
from contactbench.pipeline.mesh.regions.selections import (
    Mirrored,
    Selection,
    flood,
    grow,
    half_space,
    in_box,
    mirror,
    shrink,
    smooth,
)
from contactbench.pipeline.mesh.regions.stroke import Brush, Stroke
from contactbench.pipeline.mesh.regions.transfer import (
    RegionReport,
    Transferred,
    carry_labels,
    compare,
    transfer,
)

__all__ = [
    "PALETTE",
    "Brush",
    "FacetGraph",
    "MeshEdit",
    "Mirrored",
    "Region",
    "RegionChange",
    "RegionError",
    "RegionModel",
    "RegionReport",
    "RegionSet",
    "Selection",
    "Stroke",
    "Transferred",
    "carry_labels",
    "compare",
    "flood",
    "grow",
    "half_space",
    "in_box",
    "load_regions",
    "mirror",
    "save_regions",
    "shrink",
    "smooth",
    "transfer",
]
