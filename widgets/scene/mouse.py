"""What the mouse does in the view: turn, move, scale, pick, brush."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QObject, QPointF, Qt, QTimer
from PySide6.QtWidgets import QApplication
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

from contactbench.widgets.scene.views import moved, scaled, turned

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtGui import QMouseEvent, QWheelEvent

    from contactbench.widgets.scene.scene import Scene

_HOVER_MS = 34
_NOTCH = 120  # of a wheel, in eighths of a degree
_ZOOM = 1.15  # per notch
_BUTTON = Qt.MouseButton


class Mouse(QObject):
    """
    Turns events of the view into changes of the camera and signals of the scene.

    A drag of the camera is only noted; the newest place is used when the next frame is drawn.

    Attributes
    ----------
    dragging : bool
        The camera is being dragged.
    painting : bool
        The brush is drawn over the surface.
    """

    def __init__(self, scene: Scene) -> None:
        super().__init__(scene)
        self._scene = scene
        self.tool = "turn"
        self._button = _BUTTON.NoButton
        self._from = self._at = QPointF()
        self.dragging = False
        self.painting = self._handling = False
        self._notches = 0.0
        self._hover: QPointF | None = None
        self._timer = QTimer(self, interval=_HOVER_MS, singleShot=True)
        self._timer.timeout.connect(self._tell_hover)

    def stop(self) -> None:
        """Hear nothing more."""
        self._timer.stop()

    def press(self, event: QMouseEvent) -> None:
        """Begin what the button does."""
        if self._button != _BUTTON.NoButton:
            return
        self._button = event.button()
        self._from = self._at = event.position()
        self.dragging = False
        self._handling = event.button() == _BUTTON.LeftButton and self._scene.handle.grab(event.position())
        if self._paints():
            self._brush(event)

    def move(self, event: QMouseEvent) -> None:
        """Follow the pointer."""
        here = event.position()
        if self._button == _BUTTON.NoButton or self._paints():
            self._hover = here
            if not self._timer.isActive():
                self._timer.start()
        if self._button == _BUTTON.NoButton:
            return
        if self._handling:
            self._scene.handle_moved.emit(self._scene.handle.drag(here))
            self._scene.redraw()
            return
        if self._paints():
            self._brush(event)
            return
        if not self.dragging:
            far = (here - self._from).manhattanLength() >= QApplication.startDragDistance()
            if not far:
                return
            self.dragging = True
            self._at = self._from
        self._hover = here
        self._scene.redraw()

    def release(self, event: QMouseEvent) -> None:
        """End what the button did."""
        if event.button() != self._button:
            return
        if self._handling:
            self._handling, self._button = False, _BUTTON.NoButton
            self._scene.handle.drop()
            self._scene.handle_dropped.emit()
            self._scene.redraw()
            return
        painted, dragged = self._paints(), self.dragging
        if dragged:
            self._hover = event.position()
            self.apply_drag()
        self._button = _BUTTON.NoButton
        if painted:
            if self.painting:
                self.painting = False
                self._scene.brush_ended.emit()
        elif event.button() == _BUTTON.LeftButton and not dragged:
            pick = self._scene.pick_at(event.position())
            if pick is not None:
                self._scene.picked.emit(pick)
        self.dragging = False
        self._scene.settle()

    def leave(self) -> None:
        """Forget the pointer: it left the view."""
        if self._button == _BUTTON.NoButton:
            self._hover = None
            self._tell_hover()

    def wheel(self, event: QWheelEvent) -> None:
        """Scale about the pointer, or scale the brush."""
        self._notches += event.angleDelta().y() / _NOTCH
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier and self.tool == "brush":
            whole = int(self._notches)
            self._notches -= whole
            for _ in range(abs(whole)):
                self._scene.brush_scaled.emit(1 if whole > 0 else -1)
            return
        notches, self._notches = self._notches, 0.0
        screen, ratio = self._scene.projection(), self._scene.stage.ratio
        right = (event.position().x() * ratio - screen.width / 2) * screen.metres_per_pixel
        up = (screen.height / 2 - event.position().y() * ratio) * screen.metres_per_pixel
        self._scene.move_camera(scaled(screen.look, _ZOOM**notches, right, up))
        event.accept()

    def apply_drag(self) -> None:
        """Move the camera to where the pointer has dragged it; before a frame is drawn."""
        if not self.dragging or self._hover is None or self._paints():
            return
        step, self._at = self._hover - self._at, self._hover
        if step.isNull():
            return
        screen, ratio = self._scene.projection(), self._scene.stage.ratio
        if self._button == _BUTTON.MiddleButton:
            unit = screen.metres_per_pixel * ratio
            look = moved(screen.look, step.x() * unit, step.y() * unit)
        else:
            # as far across the view as half a turn
            angle = np.pi * ratio / max(min(screen.width, screen.height), 1)
            look = turned(screen.look, step.x() * angle, step.y() * angle)
        self._scene.move_camera(look)

    def _paints(self) -> bool:
        return self.tool == "brush" and self._button == _BUTTON.LeftButton

    def _brush(self, event: QMouseEvent) -> None:
        pick = self._scene.pick_at(event.position())
        if self.painting:
            self._scene.brush_moved.emit(pick)
        elif pick is not None:
            self.painting = True
            self._scene.brush_began.emit(pick, event.modifiers())
        self._scene.show_brush(pick)

    def _tell_hover(self) -> None:
        if self.dragging:
            return
        pick: Any = None if self._hover is None else self._scene.pick_at(self._hover)
        if self.tool == "brush":
            self._scene.show_brush(pick)
        self._scene.hovered.emit(pick)


# ---- which facet is under the pointer: a static cell locator, which answers in microseconds ------


@dataclass(frozen=True, eq=False)
class Pick:
    """A place on the probe under the mouse."""

    face: int
    point: NDArray[np.float64]  # (3,): S, m


def _number(value: float) -> Any:
    """Return a number that VTK writes to; its stubs call it an object."""
    return mutable(value)


class Picker:
    """
    Finds facets on lines of sight, and near points.

    Parameters
    ----------
    data : vtkPolyData
        What the mapper draws: a locator on another copy finds nothing in it.
    """

    def __init__(self, data: Any) -> None:
        self.data = data
        self._locator: Any = None

    def build(self) -> None:
        """Make the locator now, about 0.1 ms per 1,000 facets; otherwise the first question makes it."""
        if self._locator is None:
            self._locator = vtkStaticCellLocator()
            self._locator.SetDataSet(self.data)
            self._locator.BuildLocator()

    def along(self, begin: NDArray[np.float64], end: NDArray[np.float64]) -> Pick | None:
        """Return the first place on a line from `begin` to `end`, S, m."""
        self.build()
        share, part, cell = _number(0.0), _number(0), _number(-1)
        point, inside = [0.0] * 3, [0.0] * 3
        if not self._locator.IntersectWithLine(list(begin), list(end), 0.0, share, point, inside, part, cell):
            return None
        return Pick(int(cell.get()), np.array(point))

    def nearest(self, point: NDArray[np.float64]) -> Pick:
        """Return the place of the surface that is nearest to a point, S, m."""
        self.build()
        found, cell, part, squared = [0.0] * 3, _number(-1), _number(0), _number(0.0)
        self._locator.FindClosestPoint(list(point), found, cell, part, squared)
        return Pick(int(cell.get()), np.array(found))
