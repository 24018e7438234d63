"""What is undone on the last two pages: another set of markers, another setting of the session."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtGui import QUndoCommand

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.bench import Bench
    from contactbench.pipeline.workbench.markers import Markers


class ChangeMarkers(QUndoCommand):
    """
    Other markers.

    Parameters
    ----------
    before, after : Markers
    use : callable
        Gets what holds from now on, and what is done, in words; shows it and keeps it in the session.
    text : str
        What is done, in words.
    """

    def __init__(
        self, before: Markers, after: Markers, use: Callable[[Markers, str], None], text: str
    ) -> None:
        super().__init__(text)
        self._before, self._after, self._use = before, after, use

    def redo(self) -> None:
        """Do it."""
        self._use(self._after, self.text())

    def undo(self) -> None:
        """Go back to those before."""
        self._use(self._before, self.text())


class ChangeSettings(QUndoCommand):
    """
    Other values of settings of the session.

    Parameters
    ----------
    bench : Bench
    before, after : dict
        Key -> JSON value.
    text : str
    """

    def __init__(self, bench: Bench, before: dict[str, Any], after: dict[str, Any], text: str) -> None:
        super().__init__(text)
        self._bench, self._before, self._after = bench, before, after

    def redo(self) -> None:
        """Do it."""
        self._use(self._after)

    def undo(self) -> None:
        """Go back to those before."""
        self._use(self._before)

    def _use(self, values: dict[str, Any]) -> None:
        def put(session: Any) -> None:
            for key, value in values.items():
                session.set_parameter(key, value)

        self._bench.do(self.text(), put)
