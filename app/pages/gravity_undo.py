"""What can be undone of a gravity calibration."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtGui import QUndoCommand

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


class LeaveOut(QUndoCommand):
    """
    Poses left out, or taken back.

    Parameters
    ----------
    text : str
    moments : sequence of float
        That name the poses, s.
    left_out : bool
    apply : callable
        Gets the moments and whether they are left out.
    """

    def __init__(
        self,
        text: str,
        moments: Sequence[float],
        left_out: bool,
        apply: Callable[[Sequence[float], bool], None],
    ) -> None:
        super().__init__(text)
        self._moments, self._left_out, self._apply = tuple(moments), left_out, apply

    def redo(self) -> None:
        """Do it."""
        self._apply(self._moments, self._left_out)

    def undo(self) -> None:
        """Do the opposite."""
        self._apply(self._moments, not self._left_out)


class Confirm(QUndoCommand):
    """
    Parameters that mend a finding.

    Parameters
    ----------
    text : str
    new, old : sequence of (str, JSON value)
    apply : callable
        Sets parameters.
    """

    def __init__(
        self,
        text: str,
        new: Sequence[tuple[str, Any]],
        old: Sequence[tuple[str, Any]],
        apply: Callable[[Sequence[tuple[str, Any]]], None],
    ) -> None:
        super().__init__(text)
        self._new, self._old, self._apply = tuple(new), tuple(old), apply

    def redo(self) -> None:
        """Set the new values."""
        self._apply(self._new)

    def undo(self) -> None:
        """Set the ones before."""
        self._apply(self._old)
