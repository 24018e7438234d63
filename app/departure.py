"""Leaving a session in which work is going on: wait for it, stop it and keep what is done, or stay."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QMessageBox

from contactbench.app.undo import Weight
from contactbench.widgets.numbers import translated

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtWidgets import QPushButton

    from contactbench.app.window import MainWindow


class Departure(QObject):
    """
    Holds a session back from being closed while work is going on, until somebody has said what to do.

    Parameters
    ----------
    window : MainWindow

    Attributes
    ----------
    question : QMessageBox or None
        What is asked just now.
    wait, stop, stay : QPushButton
        Its answers; `wait` is left out where what goes on, such as a recording, does not end by itself.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._settled = False
        self._go: Callable[[], object] | None = None  # to be done as soon as nothing goes on
        self.question: QMessageBox | None = None
        self.wait: QPushButton | None = None
        self.stop: QPushButton | None = None
        self.stay: QPushButton | None = None
        window.gone.connect(self._forget)

    def holds(self, go: Callable[[], object], stay: Callable[[], object] = lambda: None) -> bool:
        """
        Whether the session stays open for now; then somebody is asked, and `go` or `stay` follows the answer.

        A second time while it is asked, the question is only brought up.
        """
        if self._settled or not self._going_on():
            return False
        self._go = None
        if self.question is None:
            self._ask(go, stay)
        else:
            self.question.raise_()
        return True

    @property
    def waiting(self) -> bool:
        """Whether the session is closed as soon as nothing goes on."""
        return self._go is not None

    def look(self) -> None:
        """See whether what was waited for is done; called twice a second."""
        if self._go is not None and not self._going_on():
            go, self._go = self._go, None
            go()

    def _going_on(self) -> tuple[str, ...]:
        """Return what goes on, in sentences."""
        bench = self._window.bench
        if bench is None or bench.ending:
            return ()
        from contactbench.pipeline.session.why import GOING_ON  # it is there, for a session is open

        return tuple(translated(words) for step, words in GOING_ON.items() if step in bench.running)

    def _ask(self, go: Callable[[], object], stay: Callable[[], object]) -> None:
        bench = self._window.bench
        box = self.question = QMessageBox(self._window)
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.setIcon(QMessageBox.Icon.Question)
        box.setWindowTitle(self.tr("Work in progress"))
        box.setText(" ".join(self._going_on()))
        role = QMessageBox.ButtonRole
        ends = bench is not None and not bench.live.taped
        box.setInformativeText(
            self.tr(
                "Stopping keeps all settings and recordings. The computation starts again when you reopen the"
                " session."
            )
            if ends
            else self.tr("Stopping keeps everything recorded so far. You can continue from there next time.")
        )
        self.wait = box.addButton(self.tr("Wait until done"), role.AcceptRole) if ends else None
        self.stop = box.addButton(self.tr("Stop and keep results"), role.DestructiveRole)
        self.stay = box.addButton(self.tr("Cancel"), role.RejectRole)
        box.setDefaultButton(self.wait or self.stay)
        box.setEscapeButton(self.stay)
        box.buttonClicked.connect(lambda button: self._answered(button, go, stay))
        box.open()

    def _answered(self, button: object, go: Callable[[], object], stay: Callable[[], object]) -> None:
        wait, stop = self.wait, self.stop
        self.question = self.wait = self.stop = self.stay = None
        if button is stop:
            self._settled = True
            go()
        elif wait is not None and button is wait:
            self._go = go
            self._window.tell(
                Weight.INFO,
                self.tr("The session closes as soon as the work is done. You can keep working until then."),
            )
            self.look()
        else:
            stay()

    def _forget(self) -> None:
        self._settled, self._go = False, None
