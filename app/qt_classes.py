"""Qt's classes, made in the GUI thread before any worker names them.

PySide makes a class when it is first named, by code or by an event. A worker that imports a page names hundreds, and
where the window needs a class for an event at the same moment, the process crashes.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6 import QtCore, QtGui, QtOpenGL, QtOpenGLWidgets, QtSvg, QtWidgets

if TYPE_CHECKING:
    from collections.abc import Callable

_MODULES = (QtCore, QtGui, QtWidgets, QtOpenGL, QtOpenGLWidgets, QtSvg)
_PIECE_S = 0.005


class QtClasses(QtCore.QObject):
    """Makes them a few at a time, so that the window answers meanwhile."""

    def __init__(self, parent: QtCore.QObject | None = None) -> None:
        super().__init__(parent)
        self._left = iter([(module, name) for module in _MODULES for name in dir(module)])
        self._then: Callable[[], object] | None = None
        self._timer = QtCore.QTimer(self, interval=0)
        self._timer.timeout.connect(self._make_some)
        self._timer.start()
        self._make_some()  # all of them, where another window has made them before

    def when_made(self, then: Callable[[], object]) -> None:
        """Call `then` as soon as all are made, at once if they are; another call before that takes its place."""
        if self._timer.isActive():
            self._then = then
        else:
            then()

    def forget(self) -> None:
        """Do not call what waits."""
        self._then = None

    def _make_some(self) -> None:
        end = time.perf_counter() + _PIECE_S
        for module, name in self._left:
            getattr(module, name, None)
            if time.perf_counter() > end:
                return
        self._timer.stop()
        then, self._then = self._then, None
        if then is not None:
            then()
