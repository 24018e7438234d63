"""How the scene is looked at: a camera as a value, what the mouse does with it, and where things are on screen."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QObject, QPointF, Qt, QTimer
from PySide6.QtWidgets import QApplication
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtGui import QMouseEvent, QWheelEvent

    from contactbench.widgets.scene.pose_layer import PoseLayer
    from contactbench.widgets.scene.probe_layer import ProbeLayer
    from contactbench.widgets.scene.scene import Scene
    from contactbench.widgets.scene.stage import SceneStage
    from contactbench.widgets.scene.view import SceneView

_HOVER_MS = 34
_NOTCH = 120  # of a wheel, in eighths of a degree
_ZOOM = 1.15  # per notch
_BUTTON = Qt.MouseButton
Triple = tuple[float, float, float]

# Where the camera is, seen from what it looks at, and what points upwards on screen.
_DIRECTIONS: dict[str, tuple[Triple, Triple]] = {
    "front": ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    "side": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "top": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    "oblique": ((0.6, -0.7, 0.35), (0.0, 0.0, 1.0)),
}
VIEWS = tuple(_DIRECTIONS)
ANGLE = 30.0  # of the perspective view, degrees, from bottom to top
_NEAREST, _FARTHEST = 2e-4, 5.0  # half of what is seen from bottom to top, m
_LEVEL = 0.2  # across z: a normal with less has no side
_STRAIGHT = 1e-6  # across the line of sight: less has no direction


@dataclass(frozen=True)
class SceneLook:
    """A camera."""

    # position, focal, up: (x, y, z): Where it is, what it looks at, and what points upwards on screen; m
    position: Triple
    focal: Triple
    up: Triple
    scale: float  # Half of what is seen from bottom to top at the focal point, m
    perspective: bool = False

    @property
    def axes(self) -> NDArray[np.float64]:
        """Unit vectors to the right, upwards and into the screen, as rows (3, 3)."""
        into = np.subtract(self.focal, self.position)
        into = into / np.linalg.norm(into)
        right = np.cross(into, self.up)
        right = right / np.linalg.norm(right)
        return np.array([right, np.cross(right, into), into])

    @property
    def distance(self) -> float:
        """From the camera to the focal point, m; in perspective it follows from the scale."""
        if self.perspective:
            return float(self.scale / np.tan(np.radians(ANGLE) / 2))
        return float(np.linalg.norm(np.subtract(self.focal, self.position)))

    def tuples(self) -> tuple[Triple, ...]:
        """Return position, focal point, up, and (scale, 1 in perspective, 0)."""
        return self.position, self.focal, self.up, (self.scale, float(self.perspective), 0.0)

    @staticmethod
    def of(tuples: tuple[Triple, ...], otherwise: SceneLook) -> SceneLook:
        """Return what `tuples` made; position, focal point and up alone leave the rest as it was."""
        position, focal, up = tuples[:3]
        scale, perspective = tuples[3][:2] if len(tuples) > 3 else (otherwise.scale, otherwise.perspective)
        return SceneLook(position, focal, up, scale, bool(perspective))


def looking(view: str, focal: Triple, radius: float, perspective: bool = False) -> SceneLook:
    """Return the camera of a named view in which a ball of a radius (m) about the focal point is seen."""
    toward, up = _DIRECTIONS[view]
    unit = np.divide(toward, np.linalg.norm(toward))
    return SceneLook(triple(np.add(focal, 4.0 * radius * unit)), focal, up, radius, perspective)


def fitted(look: SceneLook, focal: Triple, radius: float) -> SceneLook:
    """Return the camera, in the same direction, in which a ball of a radius (m) about a point is seen."""
    position = triple(focal - 4.0 * radius * look.axes[2])
    return replace(look, position=position, focal=focal, scale=radius)


def turned(look: SceneLook, right: float, down: float) -> SceneLook:
    """
    Return the camera after the scene was dragged by angles, radians, about the focal point, as on a turntable.

    Across the screen it turns about z, down the screen about what lies level, and no further than to look straight
    down or up: z stays upwards on screen, so that nobody loses where the flange is.
    """
    toward = -look.axes[2]
    level = np.array([-toward[1], toward[0], 0.0])
    if (
        np.hypot(*toward[:2]) < _STRAIGHT
    ):  # straight from above or below: what is to the right says how it is turned
        level = look.axes[0] * [1.0, 1.0, 0.0]
    level = _rotation(np.array([0.0, 0.0, 1.0]), -right) @ level / max(float(np.linalg.norm(level)), 1e-300)
    height = np.arcsin(np.clip(toward[2], -1.0, 1.0)) + down
    height = float(np.clip(height, -np.pi / 2, np.pi / 2))
    outward = np.array([level[1], -level[0], 0.0])
    toward = np.cos(height) * outward + np.array([0.0, 0.0, np.sin(height)])
    up = np.cos(height) * np.array([0.0, 0.0, 1.0]) - np.sin(height) * outward
    away = float(np.linalg.norm(np.subtract(look.position, look.focal)))
    return replace(look, position=triple(np.add(look.focal, away * toward)), up=triple(up))


def facing(look: SceneLook, outward: NDArray[np.float64]) -> SceneLook:
    """Return the camera that looks along a normal (3,) from outside, but from somewhat above; z stays up."""
    flat = outward * [1.0, 1.0, 0.0]
    if np.linalg.norm(flat) < _LEVEL:  # a face that looks up or down: from where the camera is
        flat = -look.axes[2] * [1.0, 1.0, 0.0]
    if np.linalg.norm(flat) < _LEVEL:
        flat = np.array([0.0, -1.0, 0.0])
    azimuth = np.arctan2(flat[1], flat[0])
    rise = np.arcsin(np.clip(outward[2] / max(float(np.linalg.norm(outward)), 1e-300), -1.0, 1.0))
    height = float(np.clip(0.7 * rise + 0.3, -1.2, 1.2))
    toward = np.array([np.cos(azimuth) * np.cos(height), np.sin(azimuth) * np.cos(height), np.sin(height)])
    away = float(np.linalg.norm(np.subtract(look.position, look.focal)))
    return replace(look, position=triple(np.add(look.focal, away * toward)), up=(0.0, 0.0, 1.0))


def moved(look: SceneLook, right: float, down: float) -> SceneLook:
    """Return the camera after the scene was dragged by lengths, m at the focal point."""
    axes = look.axes
    step = -right * axes[0] + down * axes[1]
    return replace(look, position=triple(np.add(look.position, step)), focal=triple(np.add(look.focal, step)))


def scaled(look: SceneLook, factor: float, right: float = 0.0, up: float = 0.0) -> SceneLook:
    """Return the camera with all `factor` times as large; what is at (right, up), m from the middle, stays."""
    scale = float(np.clip(look.scale / factor, _NEAREST, _FARTHEST))
    share = 1.0 - scale / look.scale
    return replace(moved(look, -right * share, up * share), scale=scale)


def _rotation(axis: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    x, y, z = axis
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * (K @ K))


def triple(vector: NDArray[np.float64]) -> Triple:
    """Return a vector (3,) as three plain numbers."""
    x, y, z = (float(value) for value in vector)
    return x, y, z


@dataclass(frozen=True)
class Screen:
    """A camera and the picture it makes."""

    look: SceneLook
    # width, height: Device pixels
    width: int
    height: int

    @property
    def metres_per_pixel(self) -> float:
        """At the focal point."""
        return 2.0 * self.look.scale / self.height

    def project(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """
        Return where points are seen.

        Parameters
        ----------
        points : (k, 3)
            m, world.

        Returns
        -------
        (k, 3)
            Pixels from the left and from the top, and metres behind the camera's plane through the focal point.
        """
        offset = (np.reshape(points, (-1, 3)) - self.look.focal) @ self.look.axes.T
        enlarged = np.ones(len(offset))
        if self.look.perspective:
            distance = self.look.distance
            # what is behind the camera has no place on screen: kept far away instead of mirrored
            enlarged = distance / np.maximum(distance + offset[:, 2], 1e-9)
        x = self.width / 2 + offset[:, 0] * enlarged / self.metres_per_pixel
        y = self.height / 2 - offset[:, 1] * enlarged / self.metres_per_pixel
        return np.column_stack([x, y, offset[:, 2]])

    def ray(self, x: float, y: float, reach: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return where the line of sight through a pixel begins and ends, `reach` (m) about the focal point."""
        axes, look = self.look.axes, self.look
        right = (x - self.width / 2) * self.metres_per_pixel
        up = (self.height / 2 - y) * self.metres_per_pixel
        middle = look.focal + right * axes[0] + up * axes[1]
        if not look.perspective:
            return middle - reach * axes[2], middle + reach * axes[2]
        eye = look.focal - look.distance * axes[2]
        into = (middle - eye) / np.linalg.norm(middle - eye)
        return eye, eye + (look.distance + reach) * into


# ---- the scene's camera among what is shown ------------------------------------------------------


_AROUND = 1.25  # room about the probe for the arrow of a force
# Right and down, radians: from where else a point is looked at if something hides it.
_SWINGS = [(turn, tilt) for tilt in (0.0, 0.5, -0.6, -1.2) for turn in (0.0, 0.6, -0.6, 1.2, -1.2, 2.0, -2.0)]
_COVERED = 64.0  # px along the lower edge: buttons and the scale bar


class Eye:
    """
    Looks at the scene.

    Attributes
    ----------
    look : SceneLook
    also : (k, 3)
        What is to be seen beside the probe, S, m.
    reach : float
        How far from the origin there is anything, m; grows and shrinks in steps of two.
    """

    def __init__(self, view: SceneView, stage: SceneStage, probe: ProbeLayer, poses: PoseLayer) -> None:
        self._view, self._stage, self._probe, self._poses = view, stage, probe, poses
        self.also: NDArray[np.float64] = np.zeros((0, 3))
        self.look = looking("oblique", (0.0, 0.0, 0.0), 0.08)
        self.reach = 0.1

    def screen(self) -> Screen:
        """Return the camera with the size of the picture, device pixels."""
        ratio = self._view.devicePixelRatioF()
        width, height = round(self._view.width() * ratio), round(self._view.height() * ratio)
        return Screen(self.look, max(1, width), max(1, height))

    def aim(self) -> None:
        """Set VTK's camera; its range of depths changes in steps, so that a kept picture stays right."""
        bounds = [*self._stage.live.ComputeVisiblePropBounds(), *self._stage.still.ComputeVisiblePropBounds()]
        # what is not there has bounds of 1e299
        far = max([abs(value) for value in bounds if abs(value) < 1e3] + [0.02]) * np.sqrt(3.0)
        self.reach = float(2.0 ** np.ceil(np.log2(far)))
        look, into = self.look, self.look.axes[2]
        middle = -float(np.dot(look.focal, into))
        distance = look.distance
        if not look.perspective:
            # a parallel view is the same from anywhere on the line of sight: stand before everything
            distance = max(2.0 * self.reach - middle, self.reach)
        camera: Any = self._stage.still.GetActiveCamera()
        camera.SetParallelProjection(not look.perspective)
        camera.SetPosition(*(np.asarray(look.focal) - distance * into))
        camera.SetFocalPoint(*look.focal)
        camera.SetViewUp(*look.up)
        camera.SetParallelScale(look.scale)
        near, end = distance + middle - self.reach, max(distance + middle + self.reach, 1e-3)
        # in perspective most of the depth lies just before the camera: it must not begin there
        least = min(0.05 * end, 0.3 * distance) if look.perspective else 1e-6
        camera.SetClippingRange(max(near, least), end)

    def fit(self, view: str | None) -> SceneLook:
        """Return the camera in which all of the probe is seen, from a named side or from where it is."""
        middle, radius = self._ball()
        found = fitted(self.look, middle, radius)
        if view is not None:
            found = looking(view, middle, radius, self.look.perspective)
        high, wide = max(self._view.height(), 1), max(self._view.width(), 1)
        # what lies along the lower edge must not cover it
        covered = min(_COVERED / high, 0.3)
        scale = _AROUND * self._half(found, radius, high / wide) / (1.0 - covered)
        return moved(replace(found, scale=scale), 0.0, -covered * scale)

    def facing(self, point: NDArray[np.float64]) -> SceneLook:
        """Return the camera in which all of the probe is seen, and a point of its surface (3,), S, m, faces it."""
        picker, turn = self._probe.picker, self._stage.turn[:3, :3]
        outward = np.array([0.0, -1.0, 0.0])
        if picker is not None and self._probe.probe is not None:
            outward = self._probe.probe.normals[picker.nearest(point).face]
        whole, before = self.fit(None), self.look
        best = facing(whole, turn @ outward)
        for swing in _SWINGS:  # something may stand before it
            self.look = self._centred(turned(best, *swing))
            if self.sees(point):
                break
        else:
            self.look = self._centred(best)
        found, self.look = self.look, before
        return found

    def _centred(self, look: SceneLook) -> SceneLook:
        """Return a camera that looks in the same direction, with the whole probe as `fit` has it."""
        before, self.look = self.look, look
        found, self.look = self.fit(None), before
        return found

    def with_perspective(self, perspective: bool) -> SceneLook:
        """Return the camera in the other way of looking."""
        return replace(self.look, perspective=perspective)

    def pick(self, place: QPointF) -> Pick | None:
        """Return what is seen at a place of the view, in pixels of Qt."""
        picker = self._probe.picker
        if picker is None:
            return None
        ratio = self._view.devicePixelRatioF()
        begin, end = self.screen().ray(place.x() * ratio, place.y() * ratio, 4.0 * self.reach + 1.0)
        turn, origin = self._stage.turn[:3, :3], self._stage.turn[:3, 3]
        return picker.along(turn.T @ (begin - origin), turn.T @ (end - origin))

    def sees(self, point: NDArray[np.float64]) -> bool:
        """Whether no part of the probe hides a point of S."""
        picker = self._probe.picker
        if picker is None:
            return True
        turn, origin = self._stage.turn[:3, :3], self._stage.turn[:3, 3]
        world = turn @ point + origin
        into = self.look.axes[2]
        if self.look.perspective:
            eye = np.asarray(self.look.focal) - self.look.distance * into
            into = (world - eye) / max(float(np.linalg.norm(world - eye)), 1e-9)
        begin, end = world - 4.0 * self.reach * into, world - 0.01 * self._stage.size * into
        return picker.along(turn.T @ (begin - origin), turn.T @ (end - origin)) is None

    def _half(self, look: SceneLook, radius: float, narrow: float) -> float:
        """Return half of what must be seen from bottom to top: of the probe's box, as it is turned, or of its ball."""
        if self._poses.in_world or look.perspective:
            return radius * max(1.0, narrow)
        low, high = self._probe.bounds
        sides = 0.5 * (high - low)
        also = np.vstack([self.also, self._poses.ends])
        beyond = np.abs((also - 0.5 * (low + high)) @ look.axes.T)
        right, up, _ = np.maximum(np.abs(look.axes) @ sides, beyond.max(axis=0, initial=0.0))
        return float(max(up, right * narrow, 0.4 * radius))

    def _ball(self) -> tuple[tuple[float, float, float], float]:
        """Return the middle and the radius of what is to be seen: in the world, whichever way the tool is held."""
        low, high = self._probe.bounds
        if self._poses.in_world:
            farthest = float(np.linalg.norm(np.maximum(np.abs(low), np.abs(high))))
            return (0.0, 0.0, 0.0), max(farthest, self._poses.reach)
        x, y, z = (float(value) for value in 0.5 * (low + high))
        return (x, y, z), float(np.linalg.norm(high - low)) / 2


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
