"""Measures how long the event loop stands still: what a technician feels as a window that hangs."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass

from PySide6.QtCore import QObject, Qt, QTimer, Signal

_BEAT_MS = 10
_KEPT = 60_000  # ten minutes
_LONG_S = 0.1


@dataclass(frozen=True)
class Stalls:
    """How late the beats came."""

    beats: int
    # longest, p99: s; 99 of 100 beats were at most `p99` late
    longest: float
    p99: float
    # Longest time that the GUI thread itself worked between two beats, s, drawing included. What a stall
    # is longer than that, others had the processors or the interpreter
    worked: float


class Heartbeat(QObject):
    """Beats every 10 ms in the GUI thread; a beat that is late tells how long the event loop stood still."""

    stalled = Signal(float)  # s, more than 0.1

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._late: deque[float] = deque(maxlen=_KEPT)
        self._last, self._spent, self._worked = time.perf_counter(), time.thread_time(), 0.0
        self._timer = QTimer(self, interval=_BEAT_MS, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._beat)

    def start(self) -> None:
        """Begin, from nothing."""
        self.restart()
        self._timer.start()

    def stop(self) -> None:
        """End; what was measured stays."""
        self._timer.stop()

    def restart(self) -> None:
        """Forget what was measured."""
        self._late.clear()
        self._last, self._spent, self._worked = time.perf_counter(), time.thread_time(), 0.0

    def stalls(self) -> Stalls:
        """Return how late the beats of the last ten minutes came, and the longest work since `restart`."""
        late = sorted(self._late)
        if not late:
            return Stalls(0, 0.0, 0.0, 0.0)
        return Stalls(len(late), late[-1], late[min(len(late) - 1, int(0.99 * len(late)))], self._worked)

    def _beat(self) -> None:
        now = time.perf_counter()
        late = max(0.0, now - self._last - _BEAT_MS / 1000)
        spent = time.thread_time()
        self._worked = max(self._worked, spent - self._spent)
        self._last, self._spent = now, spent
        self._late.append(late)
        if late > _LONG_S:
            self.stalled.emit(late)
