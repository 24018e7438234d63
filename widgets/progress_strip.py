"""What goes on, how far it is, and a button that stops it; in the status bar."""

import time
from collections.abc import Callable, Sequence
from typing import Any, Protocol

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QProgressBar, QPushButton, QWidget

from contactbench.widgets.controls import ElidedLabel, beside, called, show_value

PATIENCE_S = 0.3
"""What takes longer than this is shown."""
_LOOK_MS = 100
_BAR_STEPS = 1000


class ShownWork(Protocol):
    """One piece of work; see `contactbench.app.jobs.Job`, which this package does not know."""

    title: str
    share: float
    started: float
    stoppable: bool

    def cancel(self) -> None:
        """Ask it to stop."""

    def cancelled(self) -> bool:
        """Whether it was asked to."""


class ProgressStrip(QWidget):
    """
    The oldest work under way, and how many more there are; empty while nothing takes long.

    Parameters
    ----------
    running : callable
        Returns what is under way, oldest first.
    """

    def __init__(self, running: Callable[[], Sequence[Any]], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._running = running
        self._shown: ShownWork | None = None
        self._title = ElidedLabel()
        self._bar = called(QProgressBar(maximum=_BAR_STEPS), self.tr("Progress"))
        self._bar.setFixedWidth(120)
        self._stop = QPushButton(self.tr("Cancel"))
        self._stop.setToolTip(self.tr("Stop this task; finished results are kept"))
        self._stop.clicked.connect(self._cancel)
        beside(self, self._title, self._bar, self._stop, margins=(4, 0, 4, 0))
        for widget in (self._title, self._bar, self._stop):
            widget.hide()
        self._timer = QTimer(self, interval=_LOOK_MS)
        self._timer.timeout.connect(self._look)

    def watch(self, *_: object) -> None:
        """Begin to look; to be called when work begins."""
        self._timer.start()

    def text(self) -> str:
        """Return what is written; empty while nothing is shown."""
        return "" if self._shown is None else self._title.text()

    def _look(self) -> None:
        running = self._running()
        late = [each for each in running if time.monotonic() - each.started > PATIENCE_S]
        self._shown = late[0] if late else None
        for widget in (self._title, self._bar):
            widget.setVisible(self._shown is not None)
        self._stop.setVisible(self._shown is not None and self._shown.stoppable)
        if self._shown is not None:
            self._show(self._shown, len(late) - 1)
        elif not running:
            self._timer.stop()

    def _show(self, work: ShownWork, more: int) -> None:
        others = self.tr(" (and {} more)").format(more) if more else ""
        self._title.setText(work.title + others)
        self._stop.setEnabled(not work.cancelled())
        self._stop.setText(self.tr("Stopping") if work.cancelled() else self.tr("Cancel"))
        # Of what does not tell how far it is, the seconds: a bar that moves by itself has the window drawn 30 times a
        # second, which without a graphics card takes half a processor from the work that it tells of.
        seconds = self.tr("{} s").format(int(time.monotonic() - work.started))
        self._bar.setFormat("%p%" if work.share > 0 else seconds)
        show_value(self._bar, round(_BAR_STEPS * min(work.share, 1.0)))

    def _cancel(self) -> None:
        if self._shown is not None:
            self._shown.cancel()
            self._look()
