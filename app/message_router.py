"""What the window tells: into the message list, the log and, for faults, the session's journal."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from contactbench.app.bench import Weight
from contactbench.app.errors import LOG, in_words
from contactbench.widgets.numbers import translated

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.bench import Bench, Notice
    from contactbench.app.jobs import Job
    from contactbench.app.window_docks import Docks


class MessageRouter(QObject):
    """
    Puts messages where they belong.

    Parameters
    ----------
    docks : Docks
        With the message list.
    bench : callable
        Returns what is open and not being closed, or None.

    Signals
    -------
    told : str, str
        Weight and text of a message that matters.
    """

    told = Signal(str, object)

    def __init__(self, docks: Docks, bench: Callable[[], Bench | None], parent: QObject) -> None:
        super().__init__(parent)
        self._docks, self._bench = docks, bench
        self._noted: set[str] = set()

    def tell(self, weight: str, text: str, details: str = "", *, over: bool = False) -> None:
        """Put a message into the list; one that matters, or ends it, is also seen where the list is not shown."""
        LOG.info("%s: %s", weight, text)
        self._docks.messages.add(str(weight), text, details)
        if over or weight in (Weight.WARNING, Weight.ERROR):
            self.told.emit(str(weight), text)

    def message(self, message: Notice) -> None:
        """Put a page's message into the list."""
        self.tell(message.weight, message.text, message.details, over=message.over)

    def fault(self, sentence: str, details: str, expected: bool) -> None:
        """Tell of what nobody caught; once in the journal, too."""
        if not expected:
            sentence = self.tr(
                "Unexpected error: {}. Your session is safe. Try again. If the error persists, save"
                " diagnostics (File menu) and send them to your support contact."
            ).format(translated(sentence))
        self.tell(Weight.WARNING if expected else Weight.ERROR, sentence, details)
        bench = self._bench()
        if bench is not None and sentence not in self._noted:
            self._noted.add(sentence)
            with suppress(RuntimeError):  # the desk was closed meanwhile
                future = bench.desk.do(lambda session: session.note(sentence))
                # a full disk was told by what met it
                future.add_done_callback(lambda ended: ended.exception())

    def job_failed(self, job: Job, error: BaseException) -> None:
        """Tell why long work came to no end."""
        sentence, details, expected = in_words(error)
        if expected or isinstance(error, OSError):
            self.tell(Weight.ERROR, self.tr("{}: {}").format(job.title, translated(sentence)), details)
        else:
            LOG.error("%s", details)
            self.fault(sentence, details, False)

    def stalled(self, seconds: float) -> None:
        """Write into the log that the window stood still."""
        LOG.warning("the window stood still for %.0f ms", 1000 * seconds)
