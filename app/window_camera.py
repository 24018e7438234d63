"""How the scene is looked at: remembered while a session is open, and the same when it is opened again."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.widgets.scene import Scene

_REST_MS = 700
_FARTHEST_M = 1e3


class SceneMemory(QObject):
    """
    Remembers the camera of the scene.

    Parameters
    ----------
    parent : QObject
    remember : callable
        Called when the camera rests after it was moved.
    """

    def __init__(self, parent: QObject, remember: Callable[[], None]) -> None:
        super().__init__(parent)
        self._scene: Scene | None = None
        self._restored = False
        self._timer = QTimer(self, interval=_REST_MS, singleShot=True)
        self._timer.timeout.connect(remember)

    def watch(self, scene: Scene) -> None:
        """Begin with a scene."""
        self._scene = scene
        scene.camera_moved.connect(self._timer.start)

    def text(self) -> str:
        """Return how the scene is looked at now."""
        return "" if self._scene is None else json.dumps(self._scene.camera())

    def restore(self, text: str) -> None:
        """Look as `text` says, also while the page and the probe are being loaded."""
        camera = _camera(text)
        self._restored = self._scene is not None and bool(camera)
        if self._scene is not None and camera:
            self._scene.hold(camera)
            self._timer.start()  # it is what a crash would come back to

    def release(self) -> None:
        """Let pages choose the view again: all is loaded, or another page is shown."""
        if self._restored and self._scene is not None:
            self._restored = False
            self._scene.release()

    def stop(self) -> None:
        """Remember nothing more: the session is being closed."""
        self._timer.stop()


def _camera(text: str) -> tuple[tuple[float, float, float], ...]:
    """Return a camera of a text; empty: it is none."""
    try:
        rows = tuple((float(x), float(y), float(z)) for x, y, z in json.loads(text))
    except (ValueError, TypeError):
        return ()
    numbers = [each for row in rows for each in row]
    well = all(math.isfinite(each) and abs(each) < _FARTHEST_M for each in numbers)
    apart = len(rows) == 4 and rows[0] != rows[1] and any(rows[2]) and rows[3][0] > 0
    return rows if well and apart else ()
