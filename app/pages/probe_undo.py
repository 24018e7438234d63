"""`Use this probe`, as the window's undo stack knows it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtGui import QUndoCommand

from contactbench.pipeline.workbench.probe import commit
from contactbench.pipeline.workbench.undoing import Change, observed

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.bench import Bench
    from contactbench.pipeline.session import Session
    from contactbench.pipeline.workbench.probe import Preview


class UseProbe(QUndoCommand):
    """
    A probe that takes the place of the one before.

    Parameters
    ----------
    bench : Bench
    preview : Preview
    words : tuple of str
        For the stack: what was done; for the list of running work: doing, undoing.
    done : callable
        Called in the GUI thread when the session has it; with what was used, or None after an undo or a redo.
    failed : callable
        Gets why it could not be.
    """

    def __init__(
        self,
        bench: Bench,
        preview: Preview,
        words: tuple[str, str, str],
        done: Callable[[Preview | None], None],
        failed: Callable[[BaseException], None],
    ) -> None:
        super().__init__(words[0])
        self._bench, self._preview, self._words = bench, preview, words
        self._done, self._failed = done, failed
        self._change: Change | None = None

    def redo(self) -> None:
        """Put it into the session."""
        if self._change is None:
            preview = self._preview
            self._bench.do(self._words[1], self._use, lambda _: self._done(preview), self._wrong)
        else:
            self._put(self._words[1], self._change.redo)

    def undo(self) -> None:
        """Put back what was there before."""
        if self._change is not None:
            self._put(self._words[2], self._change.undo)

    def _use(self, session: Session) -> None:
        # In the desk's thread: what was there before is what is there when it is this one's turn.
        _, self._change = observed(lambda there: commit(there, self._preview))(session)

    def _put(self, title: str, way: Callable[[Session], None]) -> None:
        self._bench.do(title, way, lambda _: self._done(None), self._failed)

    def _wrong(self, error: BaseException) -> None:
        self.setObsolete(True)  # there is nothing to undo
        self._failed(error)
