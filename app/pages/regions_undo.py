"""One step on the regions, as the window's undo stack knows it."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING

from PySide6.QtGui import QUndoCommand

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.pipeline.workbench.regions import RegionsWork


class RegionStep(QUndoCommand):
    """
    A step that was made already: the model's own history undoes and redoes it, and both go in step.

    Parameters
    ----------
    text : str
        Such as "paint Lens".
    work : RegionsWork
        That it was made on.
    shown : callable
        A method that brings that to view and returns True, or returns False: something else is worked on by now,
        and the step cannot be undone any more.
    """

    # The stack belongs to Qt: what its commands held, Python could never see to be a circle, and never free.

    def __init__(self, text: str, work: RegionsWork, shown: Callable[[RegionsWork], bool]) -> None:
        super().__init__(text)
        self._work, self._shown = weakref.ref(work), weakref.WeakMethod(shown)
        self._new = True

    def undo(self) -> None:
        """Take it back."""
        work = self._found()
        if work is None or not work.undo():
            self.setObsolete(True)

    def redo(self) -> None:
        """Do it again; the first time it is done already."""
        if self._new:
            self._new = False
            return
        work = self._found()
        if work is None or not work.redo():
            self.setObsolete(True)

    def _found(self) -> RegionsWork | None:
        work, shown = self._work(), self._shown()
        return work if work is not None and shown is not None and shown(work) else None
