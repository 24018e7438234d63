"""The surface that VTK draws on, inside Qt: who draws when, and who hears the mouse."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Signal
from pyvistaqt import QtInteractor
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkRenderingCore import vtkLight

from contactbench.widgets.software_gl import spare_cores

if TYPE_CHECKING:
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
