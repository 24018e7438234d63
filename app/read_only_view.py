"""A session that is open read-only: the window says so all the time, and locks what would write."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import QDockWidget, QLabel, QSizePolicy, QStackedWidget, QTabBar, QToolBar, QWidget

from contactbench.widgets.controls import PanelScroll
from contactbench.widgets.icons import Sign, icon

if TYPE_CHECKING:
    from PySide6.QtWidgets import QMainWindow

    from contactbench.app.bench import Bench

_ICON_PX = 20
_DIRECT = Qt.FindChildOption.FindDirectChildrenOnly


class ReadOnlyView(QObject):
    """
    A line on top of the window, and pages that can only be looked at; belongs to its bench, and goes with it.

    Parameters
    ----------
    bench : Bench
    window : QMainWindow
    why : str
        See `Opened`.
    """

    def __init__(self, bench: Bench, window: QMainWindow, why: str) -> None:
        super().__init__(bench)
        self._line = QToolBar(self.tr("Read-only"))
        self._line.setObjectName("read-only")
        self._line.setMovable(False)
        self._line.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
        sign, words = Sign(_ICON_PX), QLabel(self._sentence(why), wordWrap=True)
        sign.show_icon(icon("warning", "warning"))
        words.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        words.setStyleSheet("font-weight: 600; padding: 4px 6px;")
        self._line.addWidget(sign)
        self._line.addWidget(words)
        window.addToolBarBreak()
        window.addToolBar(self._line)
        bench.destroyed.connect(self._line.deleteLater)
        dock = window.findChild(QDockWidget, "page")
        stack = dock.widget() if dock is not None else None
        if isinstance(stack, QStackedWidget):
            self._stack = stack
            stack.currentChanged.connect(self._lock)
            self._lock()

    def _sentence(self, why: str) -> str:
        if why == "damaged":
            return self.tr(
                "Read-only: this session is damaged. To continue working, close it, open it again and"
                " salvage a copy."
            )
        if why == "elsewhere":
            return self.tr(
                "Read-only: another program is using this session. It is shown as it was when opened."
            )
        return self.tr(
            "Read-only: the session folder is not writable. To continue working, make it writable or copy it."
        )

    def _lock(self) -> None:
        page = self._stack.currentWidget()
        if page is not None:
            self._lock_in(page)

    def _lock_in(self, widget: QWidget) -> None:
        """Lock a widget, but leave what is needed to scroll and to turn to another tab."""
        if isinstance(widget, QTabBar):
            return
        if widget.findChild(PanelScroll) is None and not isinstance(widget, PanelScroll):
            widget.setEnabled(False)
            widget.installEventFilter(self)
            return
        inside = widget.widget() if isinstance(widget, PanelScroll) else None
        for child in [inside] if inside is not None else widget.findChildren(QWidget, options=_DIRECT):
            self._lock_in(child)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Lock again what a page unlocks when its step's state changes."""
        if event.type() == QEvent.Type.EnabledChange and isinstance(watched, QWidget) and watched.isEnabled():
            watched.setEnabled(False)
        return False
