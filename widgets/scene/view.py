"""The surface that VTK draws on, inside Qt: who draws when, and who hears the mouse."""

from __future__ import annotations

import logging
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Qt, QTimer, Signal
from pyvistaqt import QtInteractor
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkRenderingCore import vtkLight

from contactbench.widgets.software_gl import spare_cores

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtGui import QDragEnterEvent, QDropEvent, QKeyEvent, QMouseEvent, QWheelEvent
    from PySide6.QtWidgets import QWidget

    from contactbench.widgets.scene.mouse import Mouse

_LOG = logging.getLogger("contactbench.scene")
_GL_RENDERER = 0x1F01
_SOFTWARE = ("llvmpipe", "softpipe", "swrast", "swiftshader", "gdi generic", "software")
_SAMPLES = 4
# Where they are, seen by the camera: right, up, toward it; and how bright. The main one from above on the left, as
# people expect it, and one beside the eye, so that nothing is black. Each more costs every pixel of every frame.
_LIGHTS = (((-0.6, 0.9, 1.0), 0.75), ((0.4, -0.1, 1.0), 0.35))


def log_vtk() -> None:
    """Send what VTK says to the log instead of the console; once for the process."""
    if isinstance(vtkOutputWindow.GetInstance(), vtkStringOutputWindow):
        return
    window: Any = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(window)
    for event, level in (("ErrorEvent", logging.ERROR), ("WarningEvent", logging.WARNING)):

        def heard(_caller: Any, _event: str, text: str = "", level: int = level) -> None:
            _LOG.log(level, "%s", text.strip())

        heard.CallDataType = "string0"  # type: ignore[attr-defined]
        window.AddObserver(event, heard)


class SceneView(QtInteractor):  # type: ignore[misc]
    """
    A QtInteractor that draws when Qt paints, and leaves mouse, keys and dropped files to the scene.

    VTK's own mouse styles and its keys (q closes, w shows wires) are never reached.
    """

    dropped = Signal(object)  # Path

    def __init__(self, parent: QWidget) -> None:
        log_vtk()
        spare_cores()
        super().__init__(parent, auto_update=False, multi_samples=0, off_screen=False, lighting=None)
        for place, bright in _LIGHTS:
            light = vtkLight()
            light.SetLightTypeToCameraLight()
            light.SetPosition(*place)
            light.SetIntensity(bright)
            self.renderer.AddLight(light)
        self.mouse: Mouse | None = None
        self.stage_hands: Any = None  # has before() and after()
        self.software = True
        # a click on the view must not take the space bar from the page
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)

    # ---- drawing -----------------------------------------------------------------------------------

    def initializeGL(self) -> None:
        """Smooth edges where there is a graphics card: without one they cost three times the frame."""
        name = str(self.context().functions().glGetString(_GL_RENDERER) or "").lower()
        self.software = any(word in name for word in _SOFTWARE)
        if self._RenderWindow is not None and not self.software:
            self._RenderWindow.SetMultiSamples(_SAMPLES)
        super().initializeGL()

    def paintGL(self) -> None:
        """Draw a frame."""
        if self.stage_hands is None or self._RenderWindow is None:
            super().paintGL()
            return
        self.stage_hands.before()
        try:
            super().paintGL()
        finally:
            self.stage_hands.after()

    # ---- the mouse ---------------------------------------------------------------------------------

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Hand it on."""
        if self.mouse is not None:
            self.mouse.press(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Take it as one more press."""
        self.mousePressEvent(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Hand it on."""
        if self.mouse is not None:
            self.mouse.move(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Hand it on."""
        if self.mouse is not None:
            self.mouse.release(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Hand it on."""
        if self.mouse is not None:
            self.mouse.wheel(event)

    def enterEvent(self, event: Any) -> None:
        """Keep it from VTK."""

    def leaveEvent(self, _event: Any) -> None:
        """Forget where the pointer was."""
        if self.mouse is not None:
            self.mouse.leave()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Leave keys to the window."""
        event.ignore()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Leave keys to the window."""
        event.ignore()

    # ---- files -------------------------------------------------------------------------------------

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take files."""
        if _files(event):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Tell of the first file; pyvistaqt would read and show it by itself."""
        files = _files(event)
        if files:
            event.acceptProposedAction()
            self.dropped.emit(files[0])


def _files(event: QDropEvent) -> list[Path]:
    places = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
    return [place for place in places if place.is_file()]


# ---- when the scene is drawn ---------------------------------------------------------------------


_FRAME_MS = 33
_SETTLE_MS = 180
_PULSE_MS = 80


class FramePacer(QObject):
    """
    The scene's timers.

    Attributes
    ----------
    brisk : bool
        Whether frames come as soon as they can: paint must be seen within 33 ms of the mouse's event.
    waiting : list of callable
        What is done between two frames, one after the other.
    """

    drawn = Signal(float)  # a frame was drawn, in so many ms
    settled = Signal()  # nothing has moved for a moment
    beat = Signal()  # while it pulses

    def __init__(self, view: SceneView, parent: QObject) -> None:
        super().__init__(parent)
        self._view = view
        self._closed = self.brisk = self._drawing = False
        self._cost = self._began = 0.0
        self.waiting: list[Callable[[], None]] = []
        self._redraw = QTimer(self, singleShot=True)
        self._redraw.timeout.connect(self._ask)
        self._settle = QTimer(self, singleShot=True, interval=_SETTLE_MS)
        self._settle.timeout.connect(self.settled)
        self._pulse = QTimer(self, interval=_PULSE_MS)
        self._pulse.timeout.connect(self.beat)
        self._later = QTimer(self, interval=0)
        self._later.timeout.connect(self._do_one)
        view.frameSwapped.connect(self._swapped)

    def close(self) -> None:
        """Stop for good."""
        self._closed = True
        for timer in (self._redraw, self._settle, self._pulse, self._later):
            timer.stop()

    def redraw(self) -> None:
        """Ask for a frame; they come no more often than 30 times a second, nor than they can be drawn."""
        if self._closed or self._redraw.isActive():
            return
        gap = max(0.0 if self.brisk else _FRAME_MS, 1.2 * self._cost)
        passed = (time.perf_counter() - self._began) * 1e3
        if passed < gap:
            self._redraw.start(int(gap - passed) + 1)
        elif self.brisk:
            self._view.update()
        else:
            # not in the same breath as what asked for it, such as a page that shows what came: keys and the mouse are
            # heard before
            self._redraw.start(0)

    def _ask(self) -> None:
        if not self.brisk:
            # what is asked for until it begins is this frame, and not one more
            self._began = time.perf_counter()
        self._view.update()

    def begin(self) -> None:
        """Say that a frame is begun."""
        self._began, self._drawing = time.perf_counter(), True

    def settle(self) -> None:
        """Say that something moved."""
        if not self._closed:
            self._settle.start()

    @property
    def moving(self) -> bool:
        """Whether something moved a moment ago."""
        return self._settle.isActive()

    def later(self, actions: list[Callable[[], None]]) -> None:
        """Have something done after the next frame, instead of what waits."""
        self.waiting = actions
        if not self._closed:
            self._later.start()

    @property
    def pulses(self) -> bool:
        """Whether it beats."""
        return self._pulse.isActive()

    def set_pulse(self, pulses: bool) -> None:
        """Beat, or stop."""
        if not pulses or self._closed:
            self._pulse.stop()
        elif not self._pulse.isActive():
            self._pulse.start()

    def _do_one(self) -> None:
        if self.waiting and not self._redraw.isActive():
            self.waiting.pop(0)()
        if not self.waiting:
            self._later.stop()

    def _swapped(self) -> None:
        # The window is put together anew for charts and texts, too: since the last frame of the scene minutes may
        # have passed, which are not its cost.
        if not self._drawing:
            return
        self._drawing = False
        cost = (time.perf_counter() - self._began) * 1e3
        # quick to believe in a quicker frame: one slow frame must not slow down the next ten
        self._cost = cost if cost < self._cost else 0.5 * (self._cost + cost)
        self.drawn.emit(cost)
