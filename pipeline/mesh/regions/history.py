"""Steps of editing that can be undone and redone, byte for byte."""

from __future__ import annotations

import uuid
from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from contactbench.pipeline.mesh.regions.region import Region

    Ints = npt.NDArray[np.int32]


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
    key: str = field(default_factory=lambda: uuid.uuid4().hex)

    def redo(self, labels: Ints) -> None:
        """Change labels (m,) in place."""
        if self.table is not None:
            labels[:] = self.table[labels]
        labels[self.faces] = self.new

    def undo(self, labels: Ints) -> None:
        """Change labels (m,) in place, back to what they were."""
        if self.table is not None:
            back = np.zeros(len(self.after) + 1, dtype=np.int32)
            kept = np.flatnonzero(self.table)
            back[self.table[kept]] = kept
            labels[:] = back[labels]
        labels[self.faces] = self.old


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
