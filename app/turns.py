"""What takes long in the GUI thread, in pieces: between two of them the window answers."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

if TYPE_CHECKING:
    from collections.abc import Callable

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
