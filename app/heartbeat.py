"""Measures how long the event loop stands still: what a technician feels as a window that hangs.

Python's cyclic garbage is collected in the GUI thread, a little at a time.

Left to itself Python collects in whichever thread happens to allocate: a worker, or a stream's thread, would then
free widgets and VTK objects, which only the GUI thread may do; and one full collection holds up all threads for a
third of a second, which is felt as a window that hangs.
"""

import gc
import sys
import time
from collections import deque
from collections.abc import Callable
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


# ---- python's cyclic garbage is collected in the GUI thread, a little at a time ------------------


_LOOK_MS = 500
_FULL_EVERY = 40  # looks: 20 s


class Garbage(QObject):
    """Collects instead of Python as long as there is any of its kind; belongs to a window."""

    _there = 0

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._looks = 0
        self._timer = QTimer(self, interval=_LOOK_MS)
        self._timer.timeout.connect(self._look)

        Garbage._there += 1
        gc.disable()
        self.start()
        self.destroyed.connect(Garbage._give_back)

    @staticmethod
    def _give_back(*_: object) -> None:
        Garbage._there -= 1
        if not Garbage._there:
            gc.unfreeze()
            gc.collect()  # here, and not in the next thread that allocates
            gc.enable()

    def start(self) -> None:
        """Collect from now on."""
        self._timer.start()

    def stop(self) -> None:
        """
        Collect nothing for now.

        While a worker imports, nearly all that is new stays, and to look through it is a window that hangs. A window
        that is closed might itself be what is collected, by its own timer.
        """
        self._timer.stop()

    def settle(self) -> None:
        """Take what there is now for what stays: later collections need not look at it again."""
        self._looks = 0
        gc.freeze()

    def clear(self) -> None:
        """Collect all there is, also what was taken for what stays; for moments when nobody waits."""
        gc.unfreeze()
        gc.collect()
        self.settle()

    def _look(self) -> None:
        self._looks += 1
        if self._looks >= _FULL_EVERY:
            self._looks = 0
            gc.collect()
            return
        young, middle, _ = gc.get_count()
        most, often, _ = gc.get_threshold()
        if young > most:
            gc.collect(1 if middle > often else 0)


# ---- what takes long in the GUI thread, in pieces: between two of them the window answers --------


_PAUSE_MS = 10  # for what waits: paint, keys, the heartbeat
_REST_MS = 60  # for what is drawn in more than one turn


class Turns(QObject):
    """Does one piece after the other, each in a turn of the event loop of its own."""

    failed = Signal()  # a piece raised, which the hook has told; those after it are not done

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._left: list[Callable[[], object] | None] = []
        self._timer = QTimer(self, interval=_PAUSE_MS, singleShot=True)
        self._timer.timeout.connect(self._do_one)

    @property
    def going_on(self) -> bool:
        """Whether something is left to do."""
        return bool(self._left)

    def run(self, *pieces: Callable[[], object] | None) -> None:
        """Do these, after those before; None is a rest, in which what was begun is drawn."""
        self._left += pieces
        self._timer.start(_PAUSE_MS)

    def _do_one(self) -> None:
        piece = self._left[0]
        try:
            if piece is not None:
                piece()
        except Exception:  # noqa: BLE001 - told by the hook, as what Qt calls itself
            self._left.clear()
            sys.excepthook(*sys.exc_info())
            self.failed.emit()
            return
        self._left.pop(0)
        if self._left:
            self._timer.start(_PAUSE_MS if piece is not None else _REST_MS)
