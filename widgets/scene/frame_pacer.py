"""When the scene is drawn: as soon as asked for, but no more often than can be seen, or than can be done."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.widgets.scene.view import SceneView

_FRAME_MS = 33
_SETTLE_MS = 180
_PULSE_MS = 80


class FramePacer(QObject):
    """
    The scene's timers.

    Attributes
    ----------
    brisk : bool
        Whether frames come as soon as they can: paint must be seen within 33 ms of the mouse's event.
    waiting : list of callable
        What is done between two frames, one after the other.
    """

    drawn = Signal(float)  # a frame was drawn, in so many ms
    settled = Signal()  # nothing has moved for a moment
    beat = Signal()  # while it pulses

    def __init__(self, view: SceneView, parent: QObject) -> None:
        super().__init__(parent)
        self._view = view
        self._closed = self.brisk = self._drawing = False
        self._cost = self._began = 0.0
        self.waiting: list[Callable[[], None]] = []
        self._redraw = QTimer(self, singleShot=True)
        self._redraw.timeout.connect(self._ask)
        self._settle = QTimer(self, singleShot=True, interval=_SETTLE_MS)
        self._settle.timeout.connect(self.settled)
        self._pulse = QTimer(self, interval=_PULSE_MS)
        self._pulse.timeout.connect(self.beat)
        self._later = QTimer(self, interval=0)
        self._later.timeout.connect(self._do_one)
        view.frameSwapped.connect(self._swapped)

    def close(self) -> None:
        """Stop for good."""
        self._closed = True
        for timer in (self._redraw, self._settle, self._pulse, self._later):
            timer.stop()

    def redraw(self) -> None:
        """Ask for a frame; they come no more often than 30 times a second, nor than they can be drawn."""
        if self._closed or self._redraw.isActive():
            return
        gap = max(0.0 if self.brisk else _FRAME_MS, 1.2 * self._cost)
        passed = (time.perf_counter() - self._began) * 1e3
        if passed < gap:
            self._redraw.start(int(gap - passed) + 1)
        elif self.brisk:
            self._view.update()
        else:
            # not in the same breath as what asked for it, such as a page that shows what came: keys and the mouse are
            # heard before
            self._redraw.start(0)

    def _ask(self) -> None:
        if not self.brisk:
            # what is asked for until it begins is this frame, and not one more
            self._began = time.perf_counter()
        self._view.update()

    def begin(self) -> None:
        """Say that a frame is begun."""
        self._began, self._drawing = time.perf_counter(), True

    def settle(self) -> None:
        """Say that something moved."""
        if not self._closed:
            self._settle.start()

    @property
    def moving(self) -> bool:
        """Whether something moved a moment ago."""
        return self._settle.isActive()

    def later(self, actions: list[Callable[[], None]]) -> None:
        """Have something done after the next frame, instead of what waits."""
        self.waiting = actions
        if not self._closed:
            self._later.start()

    @property
    def pulses(self) -> bool:
        """Whether it beats."""
        return self._pulse.isActive()

    def set_pulse(self, pulses: bool) -> None:
        """Beat, or stop."""
        if not pulses or self._closed:
            self._pulse.stop()
        elif not self._pulse.isActive():
            self._pulse.start()

    def _do_one(self) -> None:
        if self.waiting and not self._redraw.isActive():
            self.waiting.pop(0)()
        if not self.waiting:
            self._later.stop()

    def _swapped(self) -> None:
        # The window is put together anew for charts and texts, too: since the last frame of the scene minutes may
        # have passed, which are not its cost.
        if not self._drawing:
            return
        self._drawing = False
        cost = (time.perf_counter() - self._began) * 1e3
        # quick to believe in a quicker frame: one slow frame must not slow down the next ten
        self._cost = cost if cost < self._cost else 0.5 * (self._cost + cost)
        self.drawn.emit(cost)
