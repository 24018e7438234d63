"""Python's cyclic garbage is collected in the GUI thread, a little at a time.

Left to itself Python collects in whichever thread happens to allocate: a worker, or a stream's thread, would then
free widgets and VTK objects, which only the GUI thread may do; and one full collection holds up all threads for a
third of a second, which is felt as a window that hangs.
"""

from __future__ import annotations

import gc

from PySide6.QtCore import QObject, QTimer

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
