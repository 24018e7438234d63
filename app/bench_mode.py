"""Bench mode: the scene, one number and one button on the whole screen, for somebody who stands beside the robot."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, QTimer
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QAbstractSpinBox,
    QLineEdit,
    QPlainTextEdit,
    QPushButton,
    QWidget,
)

from contactbench.pipeline.steps import Step
from contactbench.widgets.glance import GlanceView

if TYPE_CHECKING:
    from contactbench.app.window import MainWindow

_ENTER = (Qt.Key.Key_Return, Qt.Key.Key_Enter)
_TURNS: dict[int, int] = {Qt.Key.Key_PageDown: 1, Qt.Key.Key_PageUp: -1}


class BenchMode(QObject):
    """
    What a window is in bench mode, and the keys by which the page's actions are done: there, and out of it.

    Parameters
    ----------
    window : MainWindow

    Attributes
    ----------
    view : GlanceView
        To be put beside the scene.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._before: tuple[str, Qt.WindowState] | None = None
        self.view = GlanceView()
        self.view.hide()
        self.view.pressed.connect(self._press)

    @property
    def on(self) -> bool:
        """Whether the window is in bench mode."""
        return self._before is not None

    def toggle(self) -> None:
        """Enter or leave it."""
        self.set_on(not self.on)

    def set_on(self, on: bool) -> None:
        """Enter or leave it; without a session there is nothing to do in it."""
        window = self._window
        if on == self.on or (on and window.bench is None):
            return
        if self._before is None:
            self._before = window.docks.layout_text(), window.windowState()
            window.docks.hide()
            window.setWindowState(Qt.WindowState.WindowFullScreen)
        else:
            layout, state = self._before
            self._before = None
            window.docks.restore(layout)
            window.setWindowState(state)
        window.menuBar().setVisible(not on)
        window.header.setVisible(not on)
        self.view.setVisible(on)
        self.view.primary.setFocus()
        self.tick()
        if window.scene is not None:  # once it has its new size
            QTimer.singleShot(0, window.scene, partial(window.scene.look, "fit"))

    def tick(self) -> None:
        """Show what matters now, if the window is in bench mode."""
        pages = self._window.pages
        page, step = pages.current, pages.step
        if not self.on or page is None or step is None or step not in pages.statuses:
            return
        title = self._window.docks.page_dock.windowTitle()  # also while the dock is hidden
        self.view.show_glance(title, page.glance(pages.statuses[step]), page.bar)

    def took(self, event: QKeyEvent) -> bool:
        """
        Do what a key asks for, and return whether it does anything.

        Enter presses the page's first button; in a field it only ends what is typed, and on another button that was
        reached with Tab it presses that. In bench mode Backspace presses the second button, Page Down and Page Up show
        the next and the previous step, and Escape leaves.
        """
        page, key = self._window.pages.current, event.key()
        if page is None or event.isAutoRepeat():
            return False
        if key in _ENTER:
            return self._enter(self._window.focusWidget())
        if not self.on:
            return False
        if key == Qt.Key.Key_Backspace:
            self._press(1)
        elif key == Qt.Key.Key_Escape:
            self.set_on(False)
        elif (turn := _TURNS.get(key)) is not None:
            steps = list(Step)
            at = steps.index(self._window.pages.step or steps[0]) + turn
            self._window.show_step(steps[min(max(at, 0), len(steps) - 1)])
        else:
            return False
        return True

    def _enter(self, focus: QWidget | None) -> bool:
        if isinstance(focus, QLineEdit | QAbstractSpinBox):
            focus.clearFocus()
        elif isinstance(focus, QPushButton):
            focus.click()
        elif isinstance(focus, QAbstractItemView | QPlainTextEdit):
            return False
        else:
            self._press(0)
        return True

    def _press(self, number: int) -> None:
        page = self._window.pages.current
        if page is not None and not self._window.ending:
            button = (page.bar.primary, page.bar.second)[number]
            if not button.isHidden():
                button.click()
