"""Errors that nobody expected: into the log, the message list and the journal, never into a dead window."""

from __future__ import annotations

import errno
import faulthandler
import logging
import sys
import threading
import traceback
from contextlib import suppress
from logging.handlers import RotatingFileHandler
from typing import IO, TYPE_CHECKING, Any

from PySide6.QtCore import QCoreApplication, QObject, QtMsgType, Signal, qInstallMessageHandler

from contactbench.app.bench import Bench, Notice, Weight
from contactbench.app.settings import own_folder
from contactbench.pipeline.errors import InputError
from contactbench.widgets.messages import translated

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from types import TracebackType

    from contactbench.app.jobs import Job
    from contactbench.app.window_docks import Docks

LOG = logging.getLogger("contactbench")
_FULL = {errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC)}
_LONGEST_LOG, _LOGS = 1_000_000, 3
_LEVELS = {
    QtMsgType.QtDebugMsg: logging.DEBUG,
    QtMsgType.QtInfoMsg: logging.INFO,
    QtMsgType.QtWarningMsg: logging.WARNING,
    QtMsgType.QtCriticalMsg: logging.ERROR,
    QtMsgType.QtFatalMsg: logging.CRITICAL,
}


class LogFile:
    """
    The log on the disk; a disk that cannot be written leaves the one on standard error.

    Parameters
    ----------
    folder : path, optional
        Left out: the computer's place for logs.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self.file = (folder or own_folder("log")) / "contactbench.log"
        self._handler: logging.Handler
        self._crash: IO[str] | None = None
        try:
            self.file.parent.mkdir(parents=True, exist_ok=True)
            self._handler = RotatingFileHandler(
                self.file, maxBytes=_LONGEST_LOG, backupCount=_LOGS, encoding="utf-8"
            )
            self._crash = self.file.with_name("crash.log").open("a", encoding="utf-8")
        except OSError:
            self._handler = logging.StreamHandler()
        self._handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(threadName)s %(message)s"))
        logging.getLogger().addHandler(self._handler)
        LOG.setLevel(logging.INFO)
        if self._crash is not None:
            faulthandler.enable(self._crash)  # what kills the process leaves at least where

    def read(self, most: int = 200_000) -> str:
        """Return the newest characters of the log."""
        self._handler.flush()
        try:
            return self.file.read_text(encoding="utf-8", errors="replace")[-most:]
        except OSError:
            return ""

    def close(self) -> None:
        """End it."""
        logging.getLogger().removeHandler(self._handler)
        self._handler.close()
        if self._crash is not None:
            faulthandler.disable()
            self._crash.close()
            self._crash = None


class Faults(QObject):
    """
    Catches what nobody caught, in any thread, while it is installed.

    The signal comes in the thread of the object: `sentence` for people, `details` for who asks, and whether it was
    expected, that is, an error with its remedy.
    """

    happened = Signal(object, str, bool)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._before: tuple[Any, ...] | None = None
        self._busy = threading.local()

    def install(self) -> None:
        """Begin to catch."""
        if self._before is not None:
            return
        qt = qInstallMessageHandler(self._from_qt)
        self._before = (sys.excepthook, threading.excepthook, sys.unraisablehook, qt)
        sys.excepthook = self.caught
        threading.excepthook = lambda args: self.caught(args.exc_type, args.exc_value, args.exc_traceback)
        sys.unraisablehook = lambda args: self.caught(args.exc_type, args.exc_value, args.exc_traceback)

    def uninstall(self) -> None:
        """Leave everything as it was before."""
        if self._before is not None:
            sys.excepthook, threading.excepthook, sys.unraisablehook, qt = self._before
            qInstallMessageHandler(qt)
            self._before = None

    def caught(
        self, kind: type[BaseException], error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Tell of an exception; safe in any thread, and while telling of another."""
        if issubclass(kind, (KeyboardInterrupt, SystemExit)) or getattr(self._busy, "now", False):
            return
        self._busy.now = True
        try:
            self._tell(error if error is not None else kind(), trace)
        finally:
            self._busy.now = False

    def _tell(self, error: BaseException, trace: TracebackType | None) -> None:
        details = "".join(traceback.format_exception(type(error), error, trace or error.__traceback__))
        sentence, expected = _sentence(error)
        LOG.log(logging.WARNING if expected else logging.ERROR, "%s", details.rstrip())
        try:
            self.happened.emit(sentence, details, expected)
        except RuntimeError:  # the window is gone; the log has it
            return

    def _from_qt(self, kind: QtMsgType, context: object, text: str) -> None:  # noqa: ARG002 - Qt's signature
        LOG.log(_LEVELS.get(kind, logging.INFO), "Qt: %s", text)
        if (
            kind == QtMsgType.QtFatalMsg and sys.stderr is not None
        ):  # Qt ends the process as soon as we return
            sys.stderr.write(
                f"contactbench: the window cannot be shown: {text}. Check the display and its OpenGL driver (Debian:"
                " libgl1-mesa-dri).\n"
            )
            sys.stderr.flush()


def in_words(error: BaseException) -> tuple[str, str, bool]:
    """Return sentence, details, and whether an error is one that says its remedy itself."""
    details = "".join(traceback.format_exception(type(error), error, error.__traceback__))
    sentence, expected = _sentence(error)
    return sentence, details, expected


def _sentence(error: BaseException) -> tuple[str, bool]:
    """Return what to say, and whether it says its remedy itself."""
    if isinstance(error, InputError):
        return str(error), True
    if isinstance(error, OSError) and error.errno in _FULL:
        words = QCoreApplication.translate(
            "Faults", "The disk is full ({}). Earlier recordings are safe. Free some space, then try again."
        )
        return words.format(error), True
    if isinstance(error, MemoryError):
        words = QCoreApplication.translate(
            "Faults", "Not enough memory. Close other programs or use a smaller file, then try again."
        )
        return words, True
    return f"{type(error).__name__}: {error}", False


# ---- what the window tells -----------------------------------------------------------------------


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
