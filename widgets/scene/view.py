"""The surface that VTK draws on, inside Qt: who draws when, and who hears the mouse."""

import logging
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Qt, QTimer, Signal
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QWidget
from pyvistaqt import QtInteractor
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkRenderingCore import vtkLight
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLFramebufferObject

from contactbench.widgets.scene.views import Mouse
from contactbench.widgets.software_gl import spare_cores

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
        # pyvistaqt keeps the context's surface, which Qt frees with the widget: what is made at its place next would
        # come back to Python as that surface as long as anybody holds this view.
        self.destroyed.connect(partial(self.__dict__.update, _surface=None))
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


# ---- the picture of what stands still, kept ------------------------------------------------------


# Where a computer draws without a graphics card, a probe of many facets costs 60 ms a frame; its kept picture 2 ms.
_READ, _DRAW = 0x8CA8, 0x8CA9  # GL_READ_FRAMEBUFFER, GL_DRAW_FRAMEBUFFER
_COLOUR_AND_DEPTH = 0x4000 | 0x0100  # GL_COLOR_BUFFER_BIT, GL_DEPTH_BUFFER_BIT
_NEAREST = 0x2600
_UNSIGNED_CHAR = 3


class StillPicture:
    """
    Keeps colour and depth of the renderer of what stands still.

    Between two frames with the same camera, size and content, its renderer draws nothing: the kept picture is
    copied under what lives. Facets that were painted meanwhile are drawn into the kept picture alone.

    Parameters
    ----------
    window : vtkRenderWindow
    renderer : vtkRenderer
        Of what stands still.
    """

    def __init__(self, window: Any, renderer: Any) -> None:
        self._window, self._renderer = window, renderer
        self._kept: Any = None
        self._key: object = None
        self._size = (0, 0)
        self._hidden: list[Any] = []
        self._copy_in = self._copy_out = False
        self._observers = [
            renderer.AddObserver("StartEvent", lambda _caller, _event: self._begin()),
            renderer.AddObserver("EndEvent", lambda _caller, _event: self._end()),
        ]

    def prepare(self, key: object, actors: list[Any], fresh: Any | None) -> bool:
        """
        Before a frame: draw all of `actors`, or the kept picture and `fresh` alone; return whether all.

        Parameters
        ----------
        key : object
            Equal as long as the kept picture is right; None: no picture is kept, as while all moves.
        actors : list of vtkProp
            What stands still.
        fresh : vtkProp or None
            What is to be drawn into the kept picture.
        """
        whole = key is None or key != self._key or self._kept is None
        self._key = key
        self._copy_in, self._copy_out = not whole, key is not None and (whole or fresh is not None)
        self._renderer.SetPreserveColorBuffer(not whole)
        self._renderer.SetPreserveDepthBuffer(not whole)
        if not whole:
            self._hidden = [actor for actor in actors if actor.GetVisibility()]
            for actor in self._hidden:
                actor.VisibilityOff()
        if fresh is not None:
            fresh.SetVisibility(not whole)
        return whole

    def finish(self, fresh: Any) -> None:
        """After a frame: show again what was not drawn."""
        for actor in self._hidden:
            actor.VisibilityOn()
        self._hidden = []
        fresh.VisibilityOff()

    def forget(self) -> None:
        """Draw all the next time."""
        self._key = None

    def close(self) -> None:
        """Give its memory back; the window's context must still be there."""
        for observer in self._observers:
            self._renderer.RemoveObserver(observer)
        if self._kept is not None:
            self._kept.ReleaseGraphicsResources(self._window)
            self._kept = None

    def _begin(self) -> None:
        if self._copy_in:
            self._copy(self._kept, self._window.GetRenderFramebuffer())

    def _end(self) -> None:
        if not self._copy_out:
            return
        width, height = self._window.GetSize()
        if self._kept is None or self._size != (width, height):
            self._size = width, height
            if self._kept is not None:
                self._kept.ReleaseGraphicsResources(self._window)
            self._kept = vtkOpenGLFramebufferObject()
            self._kept.SetContext(self._window)
            state = self._window.GetState()
            state.PushFramebufferBindings()
            # as VTK makes its own: nothing at all is copied where the depths have other formats
            depth = self._window.GetRenderBufferTargetDepthSize()
            self._kept.PopulateFramebuffer(width, height, True, 1, _UNSIGNED_CHAR, True, depth, 0)
            state.PopFramebufferBindings()
        self._copy(self._window.GetRenderFramebuffer(), self._kept)

    def _copy(self, source: Any, target: Any) -> None:
        width, height = self._window.GetSize()
        state = self._window.GetState()
        state.PushFramebufferBindings()
        source.Bind(_READ)
        source.ActivateReadBuffer(0)
        target.Bind(_DRAW)
        target.ActivateDrawBuffer(0)
        whole = [0, width, 0, height]
        vtkOpenGLFramebufferObject.Blit(whole, whole, _COLOUR_AND_DEPTH, _NEAREST)
        state.PopFramebufferBindings()
