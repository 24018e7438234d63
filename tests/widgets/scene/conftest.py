"""A scene in a real window, and what to do to it."""

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt

from contactbench.pipeline.mesh import Probe
from contactbench.widgets.scene import Scene


def box(size=(0.04, 0.03, 0.06)):
    """Return a box whose base is at z = 0; facets 0 and 1 are its top."""
    x, y, z = size
    corners = np.array([[i, j, k] for k in (0, z) for j in (-y / 2, y / 2) for i in (-x / 2, x / 2)])
    quads = [(4, 5, 7, 6), (0, 2, 3, 1), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
    return Probe.from_arrays(corners, np.array(faces))


class Bench:
    """A scene with helping hands."""

    def __init__(self, scene, qtbot):
        self.scene, self.qtbot = scene, qtbot

    def settle(self):
        """Wait until a frame shows all that was asked for."""
        scene = self.scene
        self.qtbot.waitUntil(lambda: not (scene._pacing.waiting or scene.ahead.busy), timeout=20_000)
        self.frame()
        # without a graphics card edges are smoothed once all is at rest
        self.qtbot.waitUntil(lambda: not (scene._pacing.moving or scene._rough), timeout=20_000)
        self.frame()

    def frame(self):
        """Wait for a frame."""
        frames = []
        self.scene.drawn.connect(frames.append)
        self.scene.view.update()
        self.qtbot.waitUntil(lambda: len(frames) > 0, timeout=20_000)
        self.scene.drawn.disconnect(frames.append)

    def place(self, point):
        """Return where a point of S is in the view, in pixels of Qt."""
        turn = self.scene.stage.turn[:3, :3]
        x, y, _ = self.scene.projection().project(turn @ np.asarray(point, float))[0]
        ratio = self.scene.view.devicePixelRatioF()
        return QPointF(x / ratio, y / ratio)

    def colour(self, point):
        """Return the colour (3,) that is seen at a point of S."""
        picture = self.scene.picture()
        place = self.place(point)
        ratio = picture.shape[0] / self.scene.height()
        return picture[int(place.y() * ratio), int(place.x() * ratio)].astype(int)

    def move(self, place, buttons=Qt.MouseButton.NoButton, modifiers=Qt.KeyboardModifier.NoModifier):
        """Move the mouse; `QTest` would tell of no button."""
        from PySide6.QtGui import QMouseEvent

        view, place = self.scene.view, QPointF(place)
        event = QMouseEvent(
            QMouseEvent.Type.MouseMove,
            place,
            QPointF(view.mapToGlobal(place)),
            Qt.MouseButton.NoButton,
            buttons,
            modifiers,
        )
        view.mouseMoveEvent(event)

    def drag(self, begin, end, button=Qt.MouseButton.LeftButton, steps=4):
        """Drag with a button."""
        begin, end = QPointF(begin), QPointF(end)
        self.qtbot.mousePress(self.scene.view, button, pos=begin.toPoint())
        for i in range(1, steps + 1):
            self.move(begin + (end - begin) * (i / steps), button)
        self.qtbot.mouseRelease(self.scene.view, button, pos=end.toPoint())

    def click(self, place):
        """Click with the left button."""
        self.qtbot.mouseClick(self.scene.view, Qt.MouseButton.LeftButton, pos=QPoint(place.toPoint()))


@pytest.fixture
def bench(qtbot):
    """Return a scene of 420 x 380 in a window, with a box in it, seen from the front."""
    scene = Scene()
    scene.resize(420, 380)
    scene.show()
    qtbot.waitExposed(scene)
    hands = Bench(scene, qtbot)
    scene.show_probe(box())
    scene.look("front")
    hands.settle()
    yield hands
    scene.close_scene()
    scene.close()
    scene.deleteLater()


@pytest.fixture
def make_box():
    """Return how to make a box of a largest extent, m."""
    return lambda size=0.06: box((size * 2 / 3, size / 2, size))
