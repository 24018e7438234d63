"""What is done with the session, as commands of the window's undo stack."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtGui import QUndoCommand

from contactbench.pipeline.workbench.undoing import Change, observed

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from contactbench.app.bench import Bench
    from contactbench.pipeline.session import Session


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
    """

    def __init__(
        self,
        bench: Bench,
        text: str,
        action: Callable[[Session], Any],
        done: Callable[[Any], None] | None = None,
        failed: Callable[[BaseException], None] | None = None,
    ) -> None:
        super().__init__(text)
        self._bench, self._action = bench, action
        self._done, self._failed = done, failed
        self._change: Change | None = None
        self._first = True

    def redo(self) -> None:
        """Do it, or do it again."""
        if self._first:
            self._first = False
            self._bench.do(self.text(), self._run, self._done, self._failed)
        else:
            self._bench.do(self.text(), lambda session: self._put(session, "redo"))

    def undo(self) -> None:
        """Put back what was before."""
        self._bench.do(self.text(), lambda session: self._put(session, "undo"))

    def _run(self, session: Session) -> Any:
        result, self._change = observed(self._action)(session)
        return result

    def _put(self, session: Session, way: str) -> None:
        # Read in the desk's thread: the action itself was done there before. None: it failed, and changed nothing.
        if self._change is not None:
            getattr(self._change, way)(session)


class SetParameter(SessionCommand):
    """Set one of the session's parameters: ``contactbench session set SESSION KEY VALUE``."""

    def __init__(self, bench: Bench, key: str, value: Any, text: str) -> None:
        super().__init__(bench, text, lambda session: session.set_parameter(key, value))


class SetParameters(SessionCommand):
    """Set several of the session's parameters as one step; those that have the value already are left alone."""

    def __init__(
        self,
        bench: Bench,
        values: Mapping[str, Any],
        text: str,
        done: Callable[[Any], None] | None = None,
        failed: Callable[[BaseException], None] | None = None,
    ) -> None:
        super().__init__(bench, text, lambda session: _set_all(session, values), done, failed)


def _set_all(session: Session, values: Mapping[str, Any]) -> None:
    settings = session.state.settings
    for key, value in values.items():
        if key not in settings or settings[key].value != value:
            session.set_parameter(key, value)
