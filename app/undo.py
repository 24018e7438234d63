"""What can be undone, as commands of the window's undo stack."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtGui import QUndoCommand

from contactbench.pipeline.workbench.session_change import SessionChange, observed

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from contactbench.app.bench import Bench
    from contactbench.pipeline.session import Session


class Exchange(QUndoCommand):
    """
    Something in the place of something else, such as other markers.

    Parameters
    ----------
    text : str
        What is done, in words.
    before, after
    put : callable
        Gets what holds from now on.
    """

    def __init__(self, text: str, before: Any, after: Any, put: Callable[[Any], None]) -> None:
        super().__init__(text)
        self._before, self._after, self._put = before, after, put

    def redo(self) -> None:
        """Do it."""
        self._put(self._after)

    def undo(self) -> None:
        """Go back to what was before."""
        self._put(self._before)


class SessionCommand(QUndoCommand):
    """
    Something done with the session: pushed onto `bench.undo`, it is done; taken back, what was before is put back.

    All of it happens in the desk's order, so it may be taken back before it is over.

    Parameters
    ----------
    bench : Bench
    text : str
        What it does, for people: it stands in the menu and beside its progress.
    action : callable
        Gets the session, in the desk's thread.
    done, failed : callable, optional
        Get what `action` returned or raised, in the GUI thread, the first time; see `Bench.do`.
    again : callable, optional
        Called when it was taken back or done again.
    """

    def __init__(
        self,
        bench: Bench,
        text: str,
        action: Callable[[Session], Any],
        done: Callable[[Any], None] | None = None,
        failed: Callable[[BaseException], None] | None = None,
        again: Callable[[], None] | None = None,
    ) -> None:
        super().__init__(text)
        self._bench, self._action, self._again = bench, action, again
        self._done, self._failed = done, failed
        self._change: SessionChange | None = None
        self._first = True

    def redo(self) -> None:
        """Do it, or do it again."""
        if self._first:
            self._first = False
            self._bench.do(self.text(), self._run, self._done, self._failed)
        else:
            self._put("redo")

    def undo(self) -> None:
        """Put back what was before."""
        self._put("undo")

    def _run(self, session: Session) -> Any:
        result, self._change = observed(self._action)(session)
        return result

    def _put(self, way: str) -> None:
        def put(session: Session) -> None:
            # Read in the desk's thread: the action itself was done there before. None: it failed, and changed nothing.
            if self._change is not None:
                getattr(self._change, way)(session)

        again = self._again
        self._bench.do(self.text(), put, None if again is None else lambda _: again(), again and self._failed)


class SetParameters(SessionCommand):
    """
    Set parameters of the session as one step; those that have the value already are left alone.

    As ``contactbench session set SESSION KEY VALUE``.
    """

    def __init__(
        self,
        bench: Bench,
        values: Mapping[str, Any],
        text: str,
        failed: Callable[[BaseException], None] | None = None,
    ) -> None:
        super().__init__(bench, text, lambda session: _set_all(session, values), None, failed)


def _set_all(session: Session, values: Mapping[str, Any]) -> None:
    settings = session.state.settings
    for key, value in values.items():
        if key not in settings or settings[key].value != value:
            session.set_parameter(key, value)
