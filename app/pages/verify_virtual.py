"""Touches that the virtual bench does for somebody without hardware."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from contactbench.pipeline.verification.protocol import ProtocolState
from contactbench.widgets.messages import translated

if TYPE_CHECKING:
    from concurrent.futures import Future

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.app.bench import Bench
    from contactbench.pipeline.simulation.virtual.bench import VirtualBench
    from contactbench.pipeline.simulation.virtual.given import Done
    from contactbench.pipeline.workbench.verify_touches import LiveTouches, TouchView

_HELD_S, _PAUSE_S, _MOST_TRIES = 1.2, 0.4, 3


class Toucher(QObject):
    """
    Presses markers on the virtual bench, one or all.

    Attributes
    ----------
    all : bool
        Whether it goes on by itself.
    """

    stopped = Signal(object)  # why it does not go on; empty: all are done

    def __init__(self, bench: Bench, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._bench, self.all = bench, False
        self._tried, self._tries = -1, 0
        self._asked: Future[Done] | None = None
        self._over: tuple[VirtualBench, float] | None = None  # when the press is, on the bench's clock

    @property
    def there(self) -> bool:
        """Whether a virtual bench is open."""
        return self._bench.live.bench is not None

    def touch(self, point: NDArray[np.float64], force: float) -> None:
        """Press a point, m, with a force, N; for a little more than a second."""
        bench = self._bench.live.bench
        if bench is not None:
            self._asked, self._over = bench.touch(point_S=point, force=force, seconds=_HELD_S), None

    def press_next(self, touches: LiveTouches, view: TouchView) -> None:
        """Press the next marker, in the middle of its force window."""
        if view.next_one is not None:
            self.touch(touches.markers[view.next_one].point_S, 0.5 * sum(view.window))

    def begin(self) -> None:
        """Go on by itself from now on."""
        self.all, self._tried, self._tries = True, -1, 0

    def end(self) -> None:
        """Do no more."""
        self.all = False

    def tick(self, touches: LiveTouches | None, view: TouchView | None) -> None:
        """Press the next marker, if the one before is over."""
        if self._presses() or not self.all:
            return
        if touches is None or view is None or view.next_one is None:
            self._stop("")
            return
        if view.state is not ProtocolState.ARMED:
            return
        self._tries = self._tries + 1 if view.next_one == self._tried else 1
        self._tried = view.next_one
        if self._tries > max(_MOST_TRIES, view.rows[view.next_one].wanted + 1):
            name = touches.markers[view.next_one].name
            why = "" if view.last is None else view.last.why
            self._stop(
                self.tr(
                    "{name} was pressed {count} times without an accepted touch ({why}). Press Skip"
                    " marker, then Touch all again. Or discard the touches and move the marker."
                ).format(
                    name=name, count=self._tries - 1, why=translated(why) or self.tr("no touch was detected")
                )
            )
            return
        self.press_next(touches, view)

    def _presses(self) -> bool:
        """
        Whether the press before is not over; a press that failed ends it all.

        On the bench's clock: on a computer that is too slow for it a press takes longer than it would, and another
        one before its end would be counted as one that failed.
        """
        bench = self._bench.live.bench
        if self._asked is not None:
            if not self._asked.done():
                return True
            asked, self._asked = self._asked, None
            error = asked.exception()
            if error is not None:
                self._stop(str(error))
                return True
            self._over = None if bench is None else (bench, asked.result().until + _PAUSE_S)
        if self._over is not None and self._over[0] is bench and bench.time < self._over[1]:
            return True
        self._over = None
        return False

    def _stop(self, why: str) -> None:
        self.all = False
        self.stopped.emit(why)
