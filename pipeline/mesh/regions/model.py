"""Regions that are being edited: every edit is one step that can be undone, and views are told what changed."""

from __future__ import annotations

import uuid
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.mesh.arrays import Ints
from contactbench.pipeline.mesh.probe import Probe
from contactbench.pipeline.mesh.regions.facet_graph import FacetGraph, MeshEdit
from contactbench.pipeline.mesh.regions.region import (
    Region,
    RegionError,
    RegionSet,
    check_list,
    find_rank,
    free_colour,
    free_name,
)
from contactbench.pipeline.mesh.regions.selections import Brush, Stroke

_NO_FACES = np.empty(0, dtype=np.int32)


@dataclass(frozen=True, eq=False)
class RegionChange:
    """
    What a view has to draw again.

    Attributes
    ----------
    faces : (c,) int32 or None
        Facets whose label changed; None: any may have.
    listed : bool
        Names, colours, marks or order changed.
    cut : MeshEdit or None
        What makes the mesh that the facets are of now from the one before; None: it is the same.
    """

    faces: Ints | None
    listed: bool
    cut: MeshEdit | None = None


class RegionModel:
    """
    The regions of one mesh and their history.

    Regions are named by rank: 1 is the first priority. Methods that edit make one step, or none when
    nothing changes, and raise RegionError, changing nothing, for a rank, facet, name or colour that is not
    possible, and while a stroke is being drawn.

    Parameters
    ----------
    initial : RegionSet
        What there is; undoing everything leads back to it.
    undo_limit : int, optional
        How many steps can be undone; all when left out.
    """

    def __init__(self, initial: RegionSet, *, undo_limit: int | None = None) -> None:
        self._regions = initial.regions
        self._labels = initial.labels.copy()
        self._history = RegionHistory(undo_limit)
        self._stroke: Stroke | None = None
        self._listeners: list[Callable[[RegionChange], None]] = []

    # ---- what there is -----------------------------------------------------------------------

    @property
    def regions(self) -> tuple[Region, ...]:
        """In the order of their priority."""
        return self._regions

    @property
    def labels(self) -> Ints:
        """Rank per facet, 0 for none, (m,): a read-only view that follows the edits."""
        view = self._labels.view()
        view.flags.writeable = False
        return view

    def snapshot(self) -> RegionSet:
        """Return the regions as they are now, as a value of their own."""
        return RegionSet(self._regions, self._labels)

    def rank_of(self, name: str) -> int:
        """Return the rank of the region of this name; RegionError if there is none."""
        return find_rank(self._regions, name)

    def subscribe(self, listener: Callable[[RegionChange], None]) -> Callable[[], None]:
        """Have `listener` called after every change; returns what ends that."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    # ---- the list ----------------------------------------------------------------------------

    def add(self, name: str | None = None, colour: str | None = None) -> int:
        """Add a region with the last priority, by default with the next free name and colour; returns its rank."""
        name = free_name(self._regions) if name is None else name
        region = Region(name, free_colour(self._regions) if colour is None else colour)
        self._relist(f"add {region.name}", (*self._regions, region))
        return len(self._regions)

    def rename(self, rank: int, name: str) -> None:
        """Give a region another name."""
        region = replace(self._region(rank), name=name)
        self._relist(f"rename {self._region(rank).name}", self._with(rank, region))

    def recolour(self, rank: int, colour: str) -> None:
        """Give a region another colour, ``#rrggbb``."""
        region = replace(self._region(rank), colour=colour)
        self._relist(f"colour {region.name}", self._with(rank, region))

    def set_untouchable(self, rank: int, untouchable: bool) -> None:
        """Say whether nothing can touch a region."""
        region = replace(self._region(rank), untouchable=untouchable)
        self._relist(
            f"mark {region.name} {'untouchable' if untouchable else 'touchable'}", self._with(rank, region)
        )

    def remove(self, rank: int) -> None:
        """Remove a region; its facets belong to none, and the ranks behind it move up."""
        name = self._region(rank).name
        ranks = np.arange(len(self._regions) + 1, dtype=np.int32)
        table = np.where(ranks < rank, ranks, ranks - 1).astype(np.int32)
        table[rank] = 0
        faces = np.flatnonzero(self._labels == rank).astype(np.int32)
        regions = (*self._regions[: rank - 1], *self._regions[rank:])
        self._do(self._step(f"remove {name}", regions, table, faces, np.zeros_like(faces)))

    def reorder(self, order: Sequence[int]) -> None:
        """Put the regions in another order: `order` lists all present ranks, first priority first."""
        if sorted(order) != list(range(1, len(self._regions) + 1)):
            raise RegionError(
                f"{arg(list(order))} is not an order of {arg(len(self._regions))} regions: name every rank once."
            )
        table = np.zeros(len(order) + 1, dtype=np.int32)
        table[list(order)] = np.arange(1, len(order) + 1)
        if list(order) == sorted(order):
            return
        regions = tuple(self._regions[rank - 1] for rank in order)
        self._do(self._step(message("reorder regions"), regions, table, _NO_FACES, _NO_FACES))

    def move(self, rank: int, to: int) -> None:
        """Give a region another rank; those between move by one."""
        self._region(rank)
        order = [other for other in range(1, len(self._regions) + 1) if other != rank]
        order.insert(min(max(to, 1), len(self._regions)) - 1, rank)
        self.reorder(order)

    # ---- facets ------------------------------------------------------------------------------

    def assign(
        self, faces: npt.ArrayLike, rank: int, *, protect: bool = False, text: str | None = None
    ) -> Ints:
        """
        Give facets to a region.

        Parameters
        ----------
        faces : (c,) array_like of integers, or (m,) bool
            Which ones; several times is once.
        rank : int
            The region, or 0 to take them out of theirs.
        protect : bool
            Facets of other regions stay theirs. With rank 0 nothing changes then.
        text : str, optional
            What the step is called.

        Returns
        -------
        (d,) int32
            Those that changed, ascending.
        """
        name = self._region(rank).name if rank else "none"
        chosen = self._faces(faces)
        old = self._labels[chosen]
        changed: Ints = chosen[(old != rank) & ((old == 0) | (not protect))]
        new = np.full(len(changed), rank, dtype=np.int32)
        self._do(self._step(text or message(f"assign to {arg(name)}"), self._regions, None, changed, new))
        return changed

    def replace_all(
        self,
        other: RegionSet,
        *,
        text: str = message("import regions"),
        there: MeshEdit | None = None,
        back: MeshEdit | None = None,
    ) -> None:
        """Take over other regions of the same mesh, or of one that an edit makes of it, as one step."""
        count = len(self._labels)
        if len(other.labels) != (count if there is None else there.count):
            raise RegionError(
                f"these regions are for a mesh of {arg(len(other.labels))} facets, this one has"
                f" {arg(len(self._labels))}: transfer them from their mesh instead."
            )
        table = np.zeros(len(self._regions) + 1, dtype=np.int32)
        old, new = np.zeros((2, max(count, len(other.labels))), dtype=np.int32)
        old[:count], new[: len(other.labels)] = self._labels, other.labels
        faces = np.flatnonzero(old | new).astype(np.int32)
        self._do(
            RegionEdit(text, self._regions, other.regions, table, faces, old[faces], new[faces], there, back)
        )

    def stroke(self, graph: FacetGraph, brush: Brush, rank: int) -> Stroke:
        """Begin a stroke with a brush; it is one step, made when it is finished."""
        self._refuse_during_stroke()
        self._region(rank)
        if graph.facet_count != len(self._labels):
            raise RegionError(
                f"the mesh has {arg(graph.facet_count)} facets, but the regions {arg(len(self._labels))}:"
                " load both again."
            )
        self._stroke = Stroke(graph, brush, rank, self._labels, self._emit_faces, self._end_stroke)
        return self._stroke

    # ---- history -----------------------------------------------------------------------------

    @property
    def undo_text(self) -> str | None:
        """What `undo` would undo, or None."""
        step = self._history.next_undo
        return None if step is None else step.text

    @property
    def undo_key(self) -> str | None:
        """The `RegionEdit.key` of what `undo` would undo, or None."""
        step = self._history.next_undo
        return None if step is None else step.key

    @property
    def redo_key(self) -> str | None:
        """The `RegionEdit.key` of what `redo` would do again, or None."""
        step = self._history.next_redo
        return None if step is None else step.key

    @property
    def steps(self) -> RegionSteps:
        """What can be undone and redone."""
        return self._history.steps

    def put_steps(self, steps: RegionSteps) -> None:
        """
        Have steps that led to these very regions be undone and redone.

        Raises
        ------
        RegionError
            They lead to other regions, or are for another mesh.
        """
        regions, count = self._regions, len(self._labels)
        for step in reversed(steps.done):
            count = self._check_fits(step, step.after, regions, count, (step.there, step.back))
            regions = step.before
        regions, count = self._regions, len(self._labels)
        for step in reversed(steps.undone):
            count = self._check_fits(step, step.before, regions, count, (step.back, step.there))
            regions = step.after
        self._history.put(steps)

    def undo(self) -> bool:
        """Undo the last step; returns whether there was one."""
        self._refuse_during_stroke()
        step = self._history.back()
        if step is None:
            return False
        self._labels = step.undo(self._labels)
        self._regions = step.before
        self._emit(step, step.back)
        return True

    def redo(self) -> bool:
        """Do the step again that was undone last; returns whether there was one."""
        self._refuse_during_stroke()
        step = self._history.forward()
        if step is None:
            return False
        self._apply(step)
        return True

    # ---- how ---------------------------------------------------------------------------------

    def _region(self, rank: int) -> Region:
        if not 1 <= rank <= len(self._regions):
            raise RegionError(
                f"there is no region of rank {arg(rank)}: there are {arg(len(self._regions))}, numbered from 1."
            )
        return self._regions[rank - 1]

    def _check_fits(
        self,
        step: RegionEdit,
        side: tuple[Region, ...],
        regions: tuple[Region, ...],
        count: int,
        cuts: tuple[MeshEdit | None, MeshEdit | None],
    ) -> int:
        """Return the facets on the step's other side; of the cuts, the first leads to this side, of `count` facets."""
        here, other = (count if each is None else each.count for each in cuts)
        ranks = np.array([len(step.before), len(step.after)], dtype=np.int64)
        least, most = np.array([[0, 0, 0], [max(count, other) - 1, *ranks]])
        known = all(
            array.ndim == 1
            and len(array) == len(step.faces)
            and (not len(array) or (array.min() >= low and array.max() <= high))
            for array, low, high in zip((step.faces, step.old, step.new), least, most, strict=True)
        )
        table = step.table
        renumbers = table is None or (
            table.shape == (ranks[0] + 1,) and table.min() >= 0 and table.max() <= ranks[1]
        )
        if side != regions or here != count or not (known and renumbers):
            raise RegionError(f"the step {arg(step.text)!r} does not belong to these regions.")
        return other

    def _with(self, rank: int, region: Region) -> tuple[Region, ...]:
        return (*self._regions[: rank - 1], region, *self._regions[rank:])

    def _faces(self, faces: npt.ArrayLike) -> Ints:
        array = np.asarray(faces)
        count = len(self._labels)
        if array.dtype == np.bool_ and array.shape == (count,):
            return np.flatnonzero(array).astype(np.int32)
        if array.size == 0:
            return _NO_FACES
        if array.ndim != 1 or array.dtype.kind not in "iu":
            raise RegionError(
                f"facets are {arg(array.dtype)} of shape {arg(array.shape)}: give their numbers, or one bool per facet."
            )
        if array.min() < 0 or array.max() >= count:
            bad = int(array.min() if array.min() < 0 else array.max())
            raise RegionError(f"facet {arg(bad)} does not exist: they run from 0 to {arg(count - 1)}.")
        return np.unique(array).astype(np.int32)

    def _step(
        self, text: str, after: tuple[Region, ...], table: Ints | None, faces: Ints, new: Ints
    ) -> RegionEdit:
        return RegionEdit(text, self._regions, after, table, faces, self._labels[faces], new)

    def _relist(self, text: str, regions: tuple[Region, ...]) -> None:
        check_list(regions)
        self._do(self._step(text, regions, None, _NO_FACES, _NO_FACES))

    def _do(self, step: RegionEdit) -> None:
        self._refuse_during_stroke()
        if step.before == step.after and np.array_equal(step.old, step.new) and step.there is None:
            return
        self._history.push(step)
        self._apply(step)

    def _apply(self, step: RegionEdit) -> None:
        self._labels = step.redo(self._labels)
        self._regions = step.after
        self._emit(step, step.there)

    def _end_stroke(self, labels: Ints, old: Probe, new: Probe) -> None:
        """Make a stroke a step, given the labels (m,) on the mesh that it cut, and the meshes."""
        stroke, self._stroke = self._stroke, None
        if stroke is not None:
            name = self._regions[stroke.rank - 1].name
            self.relabel(labels, old, new, f"{'erase' if stroke.brush.erase else 'paint'} {name}")

    def relabel(self, labels: Ints, old: Probe, new: Probe, text: str) -> None:
        """Take the ranks (m,) of the facets of a mesh that is cut from this one, as one step."""
        if old is new and np.array_equal(labels, self._labels):
            return
        there, back = MeshEdit.between(old, new), MeshEdit.between(new, old)
        before = self._labels if there is None else there.resized(self._labels)
        faces = np.flatnonzero(before != labels).astype(np.int32)
        regions = self._regions
        self._do(RegionEdit(text, regions, regions, None, faces, before[faces], labels[faces], there, back))

    def _emit(self, step: RegionEdit, cut: MeshEdit | None) -> None:
        faces = step.faces if step.table is None and cut is None else None
        self._tell(RegionChange(faces, listed=step.before != step.after, cut=cut))

    def _emit_faces(self, faces: Ints) -> None:
        self._tell(RegionChange(faces, listed=False))

    def _tell(self, change: RegionChange) -> None:
        for listener in tuple(self._listeners):
            listener(change)

    def _refuse_during_stroke(self) -> None:
        if self._stroke is not None:
            raise RegionError("a stroke is in progress: finish or cancel it first.")


# ---- steps of editing that can be undone and redone, byte for byte -------------------------------


@dataclass(frozen=True, eq=False)
class RegionEdit:
    """
    One edit: a new list of regions, ranks renumbered by it, and facets that changed hands.

    Attributes
    ----------
    text : str
        What was done, for a menu: "paint Lens".
    before, after : tuple of Region
        The list.
    table : (k + 1,) int32 or None
        New rank per old rank, 0 for 0 and for a region that went; None where no rank moves.
    faces : (c,) int32
        Ascending: those whose label is not what the table alone makes of it, or could not be made back.
    old, new : (c,) int32
        Their labels before and after.
    there, back : MeshEdit or None
        What makes the mesh afterwards of the one before, and the other way round; None: it is the same.
    key : str
        Tells it from every other edit, also after the program was started again.
    """

    text: str
    before: tuple[Region, ...]
    after: tuple[Region, ...]
    table: Ints | None
    faces: Ints
    old: Ints
    new: Ints
    there: MeshEdit | None = None
    back: MeshEdit | None = None
    key: str = field(default_factory=lambda: uuid.uuid4().hex)

    def redo(self, labels: Ints) -> Ints:
        """Change labels (m,), in place where the mesh stays, and return them."""
        labels = labels if self.there is None else self.there.resized(labels)
        if self.table is not None:
            labels[:] = self.table[labels]
        there = np.searchsorted(self.faces, len(labels))
        labels[self.faces[:there]] = self.new[:there]
        return labels

    def undo(self, labels: Ints) -> Ints:
        """Change labels (m,) back to what they were, in place where the mesh stays, and return them."""
        labels = labels if self.back is None else self.back.resized(labels)
        if self.table is not None:
            back = np.zeros(len(self.after) + 1, dtype=np.int32)
            kept = np.flatnonzero(self.table)
            back[self.table[kept]] = kept
            labels[:] = back[labels]
        there = np.searchsorted(self.faces, len(labels))
        labels[self.faces[:there]] = self.old[:there]
        return labels


@dataclass(frozen=True)
class RegionSteps:
    """Edits that were done, and those that were undone; the newest last: the next to be undone, and to be redone."""

    done: tuple[RegionEdit, ...] = ()
    undone: tuple[RegionEdit, ...] = ()


class RegionHistory:
    """
    What was done and undone.

    Parameters
    ----------
    limit : int, optional
        How many steps are kept; all when left out.
    """

    def __init__(self, limit: int | None = None) -> None:
        self._done: deque[RegionEdit] = deque(maxlen=limit)
        self._undone: list[RegionEdit] = []

    def push(self, step: RegionEdit) -> None:
        """Remember a step that was just done; what was undone before it is forgotten."""
        self._done.append(step)
        self._undone.clear()

    def back(self) -> RegionEdit | None:
        """Return the step to undo, if there is one."""
        if not self._done:
            return None
        self._undone.append(self._done.pop())
        return self._undone[-1]

    def forward(self) -> RegionEdit | None:
        """Return the step to redo, if there is one."""
        if not self._undone:
            return None
        self._done.append(self._undone.pop())
        return self._done[-1]

    @property
    def next_undo(self) -> RegionEdit | None:
        """What would be undone, or None."""
        return self._done[-1] if self._done else None

    @property
    def next_redo(self) -> RegionEdit | None:
        """What would be redone, or None."""
        return self._undone[-1] if self._undone else None

    @property
    def steps(self) -> RegionSteps:
        """All of them."""
        return RegionSteps(tuple(self._done), tuple(self._undone))

    def put(self, steps: RegionSteps) -> None:
        """Have these instead."""
        self._done, self._undone = deque(steps.done, self._done.maxlen), list(steps.undone)
