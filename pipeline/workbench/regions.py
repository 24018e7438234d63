"""Regions while they are painted: the model on its mesh, the tools that find facets, and steps with a name."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy import typing as npt
from numpy.typing import NDArray

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.colours import facet_colours
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph, MeshEdit
from contactbench.pipeline.mesh.regions.model import RegionChange, RegionModel, RegionSteps
from contactbench.pipeline.mesh.regions.region import RegionError, RegionSet
from contactbench.pipeline.mesh.regions.selections import (
    Brush,
    Selection,
    Stroke,
    Way,
    flood,
    grow,
    half_space,
    in_box,
    mirror,
    shrink,
    smooth,
)
from contactbench.pipeline.mesh.sidecar import ProbeFile


@dataclass(frozen=True)
class Flood:
    """From a facet up to edges that are sharper than an angle, rad."""

    face: int
    crease: float


@dataclass(frozen=True)
class Box:
    """Between two corners, m, along axes in S that are turned by R_SB and begin at p_SB_S, m."""

    low: npt.ArrayLike
    high: npt.ArrayLike
    R_SB: npt.ArrayLike | None = None
    p_SB_S: npt.ArrayLike | None = None


@dataclass(frozen=True)
class Plane:
    """The side of a plane that its normal points to; S, m."""

    point: npt.ArrayLike
    normal: npt.ArrayLike


@dataclass(frozen=True)
class Mirror:
    """Also the other side of a plane, where the surface is within a tolerance of the image; S, m."""

    point: npt.ArrayLike
    normal: npt.ArrayLike
    tolerance: float | None = None  # see `mirror`


@dataclass(frozen=True)
class Grow:
    """Outwards by a distance along the surface, m, or by rings of facets."""

    distance: float = 0.0
    rings: int = 0


@dataclass(frozen=True)
class Shrink:
    """Inwards by a distance along the surface, m, or by rings of facets."""

    distance: float = 0.0
    rings: int = 0


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
    Box: message("box into"),
    Plane: message("half into"),
    Mirror: "mirror",
    Grow: "grow",
    Shrink: "shrink",
    Smooth: "smooth",
    Clear: "clear",
}


@dataclass(frozen=True, eq=False)
class FoundFacets:
    """What a tool found."""

    tool: Tool
    rank: int  # Of the region that it was for
    selection: Selection
    revision: int  # Of the regions that it looked at


def find(
    graph: FacetGraph, labels: NDArray[np.int32], rank: int, tool: Tool, revision: int = 0
) -> FoundFacets:
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
        See `FoundFacets`.
    """
    return FoundFacets(tool, rank, _chosen(graph, labels == rank, labels == 0, tool), revision)


def _chosen(graph: FacetGraph, own: NDArray[np.bool_], free: NDArray[np.bool_], tool: Tool) -> Selection:
    match tool:
        case Flood(face=face, crease=crease):
            return Selection.whole(graph, flood(graph, face, crease))
        case Box():
            return in_box(graph, tool.low, tool.high, R_SB=tool.R_SB, p_SB_S=tool.p_SB_S)
        case Plane(point=point, normal=normal):
            return half_space(graph, point, normal)
        case Mirror():
            return mirror(graph, own, tool.normal, tool.point, tolerance=tool.tolerance)
        case Clear():
            return Selection.whole(graph, own)
        case Grow():
            return grow(graph, own, rings=tool.rings, distance=tool.distance)
        case Shrink():
            return shrink(graph, own, rings=tool.rings, distance=tool.distance)
        case Smooth(rings=rings):
            return Selection.whole(graph, smooth(graph, own, rings, allowed=free))


def give(model: RegionModel, found: FoundFacets, *, protect: bool, erase: bool) -> int:
    """
    Make what was found one step of the model; returns how many facets changed.

    Growing, shrinking and smoothing give the region its new shape and leave other regions alone; the rest is
    added to it or, with `erase`, taken out of it.
    """
    text = message(f"{arg(_WORDS[type(found.tool)])} {arg(model.regions[found.rank - 1].name)}")
    way: Way = "add"
    match found.tool:
        case Grow() | Shrink() | Smooth():
            way, protect = "reshape", True
        case Clear():
            way = "erase"
        case Flood() | Box() | Plane() if erase:
            way, text = "erase", message(f"{arg(text)}, erasing")
    return found.selection.give(model, found.rank, way, protect=protect, text=text)


@dataclass(frozen=True)
class RegionRow:
    """One region for a list."""

    name: str  # name, colour: The colour as ``#rrggbb``
    colour: str
    facets: int
    area: float  # m²
    untouchable: bool = False  # Nothing can touch it


class RegionsWork:
    """
    The regions of one mesh at work.

    One thread uses it. Building the graph takes about 0.1 s for 300,000 facets: make it in a worker.

    Parameters
    ----------
    shell : ProbeFile
        What is painted on: dense, closed, in S.
    regions : RegionSet, optional
        What there is already.
    notes : tuple of str
        What was noticed when they were read, in sentences.

    Attributes
    ----------
    probe : Probe
        The shell, its facets cut where strokes end.
    graph : FacetGraph
        Of it.
    model : RegionModel
        Edit it by `step`, `stroke`, `undo` and `redo` only, so that nothing that can be undone is missed.
    revision : int
        Another number after every change.
    """

    def __init__(
        self, shell: ProbeFile, regions: RegionSet | None = None, notes: tuple[str, ...] = ()
    ) -> None:
        regions = RegionSet.empty(len(shell.probe.faces)) if regions is None else regions
        self.shell, self.notes = shell, notes
        self.probe = shell.probe if regions.cut is None else regions.cut.put_on(shell.probe)
        self.graph = FacetGraph(self.probe)
        self.model = RegionModel(regions)
        self.revision = 0
        self._table = self._all_colours()
        self._colours = self._table[self.model.labels]
        self._listeners: list[Callable[[RegionChange, bool], None]] = []
        self._strokes = 0
        self._stroke: Stroke | None = None
        self.model.subscribe(self._changed)

    def put_steps(self, steps: RegionSteps) -> None:
        """Have steps that led to these very regions be undone and redone; RegionError if they did not."""
        for edits in (
            [each.back for each in reversed(steps.done)],
            [each.there for each in reversed(steps.undone)],
        ):
            probe = self.probe
            for edit in edits:
                probe = probe if edit is None else edit.put_on(probe)
        self.model.put_steps(steps)

    def warm_up(self) -> None:
        """Work out what the tools will ask for, so that the first use of one is as quick as the next."""
        _ = self.graph.pairs, self.graph.creases

    # ---- what there is -----------------------------------------------------------------------

    @property
    def colours(self) -> NDArray[np.uint8]:
        """Colour per facet, (m, 3); read-only, and the same array until the mesh is cut."""
        view = self._colours.view()
        view.flags.writeable = False
        return view

    def kept(self) -> RegionSet:
        """Return the regions as they are now, kept for the shell."""
        return replace(self.model.snapshot(), cut=MeshEdit.between(self.shell.probe, self.probe))

    def replace(self, regions: RegionSet) -> str | None:
        """Take over other regions that are kept for the shell, as one step; see `step`."""
        new = regions.mesh(self.shell.probe)
        cuts = MeshEdit.between(self.probe, new), MeshEdit.between(new, self.probe)
        return self.step(lambda model: model.replace_all(regions, there=cuts[0], back=cuts[1]))

    def rows(self) -> tuple[RegionRow, ...]:
        """Return the regions for a list, the first priority first."""
        count = len(self.model.regions) + 1
        labels = self.model.labels
        areas = np.bincount(labels, weights=self.probe.areas, minlength=count)
        facets = np.bincount(labels, minlength=count)
        return tuple(
            RegionRow(region.name, region.colour, int(facets[rank]), float(areas[rank]), region.untouchable)
            for rank, region in enumerate(self.model.regions, 1)
        )

    def untouchable(self) -> NDArray[np.int32]:
        """Return the facets that nothing can touch, ascending."""
        marks = np.array([False, *(region.untouchable for region in self.model.regions)])
        return np.flatnonzero(marks[self.model.labels]).astype(np.int32)

    def planned(self, found: FoundFacets) -> NDArray[np.uint8]:
        """Return the colours (m, 3) with what a tool found half painted, to be seen before it is done."""
        colours = self._colours.copy()
        half = self._table[found.rank].astype(np.uint16)
        touched = found.selection.touched
        colours[touched] = (colours[touched] + half) // 2
        return colours

    @property
    def drawing(self) -> bool:
        """Whether a stroke is being drawn."""
        return self._stroke is not None

    def subscribe(self, listener: Callable[[RegionChange, bool], None]) -> Callable[[], None]:
        """
        Have `listener` called after every change; returns what ends that.

        It gets what changed, its facets None where the colours of all of them may have, and whether that was a
        piece of a stroke which has not ended.
        """
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    # ---- editing -----------------------------------------------------------------------------

    def step(self, action: Callable[[RegionModel], object]) -> str | None:
        """
        Edit the model.

        Returns
        -------
        str or None
            What the step is called, or None: nothing changed, there is nothing to undo.

        Raises
        ------
        RegionError
            It is not possible; nothing changed.
        """
        before = self.revision
        action(self.model)
        return self.model.undo_text if self.revision != before else None

    def begin(self, brush: Brush, rank: int) -> None:
        """Begin a stroke; RegionError if there is no such region or another stroke is being drawn."""
        self._stroke = self.model.stroke(self.graph, brush, rank)

    def extend(self, face: int, point: NDArray[np.float64], *, joined: bool = True) -> NDArray[np.int32]:
        """Draw the stroke on to a picked point; returns the facets that changed. Without a stroke, none do."""
        if self._stroke is None:
            return np.empty(0, dtype=np.int32)
        return self._stroke.extend(face, point, joined=joined)

    def finish(self) -> str | None:
        """End the stroke; returns what the step is called, or None if nothing changed."""
        stroke, self._stroke = self._stroke, None
        if stroke is None or not len(stroke.finish()):
            return None
        self._tell(RegionChange(np.empty(0, dtype=np.int32), listed=False), False)
        return self.model.undo_text

    def abort(self) -> None:
        """End the stroke as if it had never begun."""
        stroke, self._stroke = self._stroke, None
        if stroke is not None:
            stroke.abort()

    def undo(self) -> bool:
        """Undo the last step, after aborting a stroke; returns whether there was one."""
        self.abort()
        return self.model.undo()

    def redo(self) -> bool:
        """Do again what was undone last, after aborting a stroke; returns whether there was one."""
        self.abort()
        return self.model.redo()

    # ---- tools -------------------------------------------------------------------------------

    def finder(self, tool: Tool, rank: int) -> Callable[[], FoundFacets]:
        """Return what finds a tool's facets, from a copy of the labels: to be called in any thread, one at a time."""
        if not 1 <= rank <= len(self.model.regions):
            raise RegionError("No region is chosen: add one, or choose one in the list.")
        labels, graph, revision = self.model.labels.copy(), self.graph, self.revision
        if isinstance(tool, Mirror | Grow | Shrink | Smooth) and rank not in labels:
            raise RegionError("The region is empty: paint something first.")
        return lambda: find(graph, labels, rank, tool, revision)

    def give(self, found: FoundFacets, *, protect: bool = False, erase: bool = False) -> str | None:
        """
        Give a region the facets that a tool found.

        Parameters
        ----------
        found : FoundFacets
        protect : bool
            Facets of other regions stay theirs.
        erase : bool
            Take those of the region away instead, where the tool allows that.

        Returns
        -------
        str or None
            See `step`.

        Raises
        ------
        RegionError
            The regions were changed while it was looking.
        """
        if found.revision != self.revision:
            raise RegionError("The regions have changed in the meantime, so nothing was done: repeat it.")
        return self.step(lambda model: give(model, found, protect=protect, erase=erase))

    # ---- how ---------------------------------------------------------------------------------

    def _all_colours(self) -> NDArray[np.uint8]:
        """Return the colour per rank, (k + 1, 3); what was made up is marked by whoever draws, not by a colour."""
        ranks = np.arange(len(self.model.regions) + 1, dtype=np.int32)
        colours = [region.colour for region in self.model.regions]
        return facet_colours(ranks, np.zeros(len(ranks), dtype=bool), colours)

    def _changed(self, change: RegionChange) -> None:
        self.revision += 1
        faces = change.faces
        if change.cut is not None:
            self.probe = change.cut.put_on(self.probe)
            self.graph = FacetGraph(self.probe)
            self._colours = np.empty((len(self.probe.faces), 3), dtype=np.uint8)
        if change.listed:
            table = self._all_colours()
            same = len(table) == len(self._table) and bool(np.array_equal(table, self._table))
            self._table = table
            if not same:
                faces = None
        if faces is None:
            np.take(self._table, self.model.labels, axis=0, out=self._colours)
        else:
            self._colours[faces] = self._table[self.model.labels[faces]]
        self._tell(RegionChange(faces, change.listed, change.cut), self._stroke is not None)

    def _tell(self, change: RegionChange, drawing: bool) -> None:
        for listener in tuple(self._listeners):
            listener(change, drawing)
