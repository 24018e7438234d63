"""What can be undone, as commands of the window's undo stack; also after the session was opened again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject
from PySide6.QtGui import QUndoCommand

from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.undo_history import Deed, PaintedStep, UndoHistory, write_history

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from contactbench.app.bench import Bench
    from contactbench.pipeline.session import Session


class Exchange(QUndoCommand):
    """
    Something in the place of something else, such as other markers.

    Parameters
    ----------
    bench : Bench
    text : str
        What is done, in words.
    before, after
    put : callable
        Gets what holds from now on; what it has done with the session is asked for before it returns.
    """

    def __init__(self, bench: Bench, text: str, before: Any, after: Any, put: Callable[[Any], None]) -> None:
        super().__init__(text)
        self._bench, self._before, self._after, self._put = bench, before, after, put
        self.deed, self._first = Deed(text), True

    def redo(self) -> None:
        """Do it."""
        if not self._first:
            self._put(self._after)
            return
        self._first = False
        self._bench.desk.do(self.deed.begin)
        self._put(self._after)
        self._bench.desk.do(self.deed.end)

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
        self._bench, self._again = bench, again
        self._action: Callable[[Session], Any] | None = action
        self._done, self._failed = done, failed
        self.deed = Deed(text)

    def redo(self) -> None:
        """Do it, or do it again."""
        action, self._action = self._action, None
        if action is not None:
            self._bench.do(self.text(), self.deed.around(action), self._done, self._failed)
        else:
            self._put("redo")

    def undo(self) -> None:
        """Put back what was before."""
        self._put("undo")

    def _put(self, way: str) -> None:
        def put(session: Session) -> None:
            # Read in the desk's thread: the action itself was done there before. Else it failed, and changed nothing.
            if self.deed.happened:
                getattr(self.deed.change(session), way)(session)

        again = self._again
        self._bench.do(self.text(), put, None if again is None else lambda _: again(), again and self._failed)


class DoneCommand(SessionCommand):
    """
    A step that the session has already: pushed, nothing is done.

    Parameters
    ----------
    bench : Bench
    deed : Deed
        By `Deed.around`, or of a session that was opened again.
    """

    def __init__(self, bench: Bench, deed: Deed) -> None:
        super().__init__(bench, deed.text, lambda _session: None)
        self.deed, self.resting = deed, True
        self._action = None

    def redo(self) -> None:
        """Do it again."""
        if not self.resting:
            super().redo()

    def undo(self) -> None:
        """Take it back."""
        if not self.resting:
            super().undo()


def push_done(bench: Bench, deed: Deed) -> None:
    """Let what was done, such as by a job, be undone."""
    if deed.happened:
        command = DoneCommand(bench, deed)
        bench.undo.push(command)
        command.resting = False


@dataclass
class PaintRequest:
    """
    That a step of painting be taken back or done again, by the page that has the regions.

    Attributes
    ----------
    way : str
        "undo" or "redo".
    key : str
        Of the step.
    refused : bool
        It is not the step that is next there: another surface is worked on by now.
    """

    way: str
    key: str
    refused: bool = False


class PaintCommand(QUndoCommand):
    """
    A step of painting that was made already: the regions' own history takes it back, and both go in step.

    Parameters
    ----------
    bench : Bench
    step : PaintedStep
    """

    def __init__(self, bench: Bench, step: PaintedStep) -> None:
        super().__init__(step.text)
        self._bench, self.deed, self.resting = bench, step, True

    def redo(self) -> None:
        """Do it again."""
        self._ask("redo")

    def undo(self) -> None:
        """Take it back."""
        self._ask("undo")

    def _ask(self, way: str) -> None:
        if self.resting:
            return
        self._bench.go_to.emit(Step.REGIONS)  # where it is seen; after it, the page is there
        request = PaintRequest(way, self.deed.key)
        self._bench.paint_asked.emit(request)
        self.setObsolete(request.refused)


def push_painted(bench: Bench, step: PaintedStep) -> None:
    """Let a step of painting be undone."""
    command = PaintCommand(bench, step)
    bench.undo.push(command)
    command.resting = False


class UndoMemory(QObject):
    """
    Keeps what can be undone in the session's folder, and puts it there again; belongs to its bench.

    Parameters
    ----------
    bench : Bench
    history : UndoHistory
        What the session had when it was opened.
    """

    def __init__(self, bench: Bench, history: UndoHistory) -> None:
        super().__init__(bench)
        self._bench, stack = bench, bench.undo
        commands = [
            PaintCommand(bench, deed) if isinstance(deed, PaintedStep) else DoneCommand(bench, deed)
            for deed in history.deeds
        ]
        for command in commands:
            stack.push(command)
        stack.setIndex(history.done)
        for command in commands:
            command.resting = False
        stack.indexChanged.connect(self._keep)

    def _keep(self, index: int) -> None:
        if self._bench.desk.closed:
            return
        stack = self._bench.undo
        commands = [stack.command(number) for number in range(stack.count())]
        known = [
            (number, each.deed)
            for number, each in enumerate(commands)
            if isinstance(each, Exchange | SessionCommand | PaintCommand)
        ]
        deeds, done = [deed for _, deed in known], sum(number < index for number, _ in known)
        # In the desk's order: what was just pushed is done by then.
        self._bench.desk.do(lambda session: write_history(session.folder, deeds, done))


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
