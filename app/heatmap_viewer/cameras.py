"""Two scenes that are looked at in the same way."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

if TYPE_CHECKING:
    from contactbench.widgets.scene import Scene


class OneCamera(QObject):
    """Turns each scene as another one was turned, while they are joined."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._scenes: list[Scene] = []
        self._joined = False

    def add(self, scene: Scene) -> None:
        """Take one more scene in."""
        self._scenes.append(scene)
        scene.camera_moved.connect(lambda: self._follow(scene))

    def join(self, joined: bool) -> None:
        """Begin to keep them alike, as the first is looked at, or end it."""
        self._joined = joined
        self.follow_first()

    def follow_first(self) -> None:
        """Look everywhere as the first is looked at."""
        if self._scenes:
            self._follow(self._scenes[0])

    def _follow(self, moved: Scene) -> None:
        camera = moved.camera() if self._joined else ()
        for scene in self._scenes:
            if camera and scene is not moved:
                scene.set_camera(camera)
