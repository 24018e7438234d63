"""What finds facets for a region: fill, box, plane, mirror, grow, shrink, smooth, clear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.mesh.regions import (
    RegionError,
    flood,
    grow,
    half_space,
    in_box,
    mirror,
    shrink,
    smooth,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from contactbench.pipeline.mesh.regions import FacetGraph, RegionModel

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Flood:
    """From a facet up to edges that are sharper than an angle, rad."""

    face: int
    crease: float


@dataclass(frozen=True)
class Box:
    """Between two corners in S, m."""

    low: Vector
    high: Vector


@dataclass(frozen=True)
class Plane:
    """The side of a plane that its normal points to; S, m."""

    point: Vector
    normal: Vector


@dataclass(frozen=True)
class Mirror:
    """Also the other side of a plane; S, m."""

    point: Vector
    normal: Vector


@dataclass(frozen=True)
class Grow:
    """Outwards by a distance along the surface, m."""

    distance: float


@dataclass(frozen=True)
class Shrink:
    """Inwards by a distance along the surface, m."""

    distance: float


@dataclass(frozen=True)
class Smooth:
    """Straighten the border over so many rings of facets, fill holes, remove specks."""

    rings: int


@dataclass(frozen=True)
class Clear:
    """All of the region, to be taken out of it."""


Tool = Flood | Box | Plane | Mirror | Grow | Shrink | Smooth | Clear
_WORDS: dict[type, str] = {
    Flood: "fill",
    Box: "box into",
    Plane: "half into",
    Mirror: "mirror",
    Grow: "grow",
    Shrink: "shrink",
    Smooth: "smooth",
    Clear: "clear",
}


@dataclass(frozen=True, eq=False)
class Found:
    """
    What a tool found.

    Attributes
    ----------
    tool : Tool
    rank : int
        Of the region that it was for.
    mask : (m,) bool
    sentence : str
        What to know about it; may be empty.
    revision : int
        Of the regions that it looked at.
    """

    tool: Tool
    rank: int
    mask: NDArray[np.bool_]
    sentence: str
    revision: int


def find(graph: FacetGraph, labels: NDArray[np.int32], rank: int, tool: Tool, revision: int = 0) -> Found:
    """
    Find the facets of a tool for the region of a rank; RegionError if it cannot.

    Parameters
    ----------
    graph : FacetGraph
    labels : (m,) int32
        Ranks per facet.
    rank : int
    tool : Tool
    revision : int
        See `Found`.
    """
    mask, sentence = _mask(graph, labels, rank, tool)
    return Found(tool, rank, mask, sentence, revision)


def _mask(
    graph: FacetGraph, labels: NDArray[np.int32], rank: int, tool: Tool
) -> tuple[NDArray[np.bool_], str]:
    own = labels == rank
    match tool:
        case Flood(face=face, crease=crease):
            return flood(graph, face, crease), ""
        case Box(low=low, high=high):
            return in_box(graph, low, high), ""
        case Plane(point=point, normal=normal):
            return half_space(graph, point, normal), ""
        case Clear():
            return own, ""
    if not own.any():
        raise RegionError("The region is empty: paint something first.")
    match tool:
        case Mirror(point=point, normal=normal):
            result = mirror(graph, own, normal, point)
            return result.mask, result.sentence
        case Grow(distance=distance):
            return grow(graph, own, distance=distance), ""
        case Shrink(distance=distance):
            return shrink(graph, own, distance=distance), ""
        case Smooth(rings=rings):
            return smooth(graph, own, rings, allowed=labels == 0), ""


def give(model: RegionModel, found: Found, *, protect: bool, erase: bool) -> None:
    """
    Make what was found one step of the model, as the commands ``contactbench probe regions ...`` do.

    Growing, shrinking and smoothing give the region its new shape and leave other regions alone; the rest is
    added to it or, with `erase`, taken out of it.
    """
    text = f"{_WORDS[type(found.tool)]} {model.regions[found.rank - 1].name}"
    own = model.labels == found.rank
    match found.tool:
        case Grow() | Shrink() | Smooth():
            model.set_region(found.rank, found.mask, text=text)
        case Clear():
            model.assign(own, 0, text=text)
        case Flood() | Box() | Plane() if erase:
            model.assign(found.mask & own, 0, text=f"{text}, erasing")
        case _:
            model.assign(found.mask, found.rank, protect=protect, text=text)
