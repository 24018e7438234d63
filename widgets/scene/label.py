"""A word beside a point: drawn by Qt, so that it is crisp and knows every sign, and shown by VTK above all else."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QGuiApplication, QImage, QPainter, QPainterPath, QPen
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersSources import vtkPlaneSource
from vtkmodules.vtkRenderingCore import vtkPolyDataMapper2D, vtkTexture, vtkTexturedActor2D

if TYPE_CHECKING:
    from contactbench.widgets.scene.stage import SceneStage

_POINTS = 11.0


class Label:
    """
    One word on screen.

    Attributes
    ----------
    plain : bool
        Without a box: a letter, which stands right beside its point or nowhere.
    place : int
        Where it stood in the frame before, see `label_places`.
    width, height : int
        Device pixels.
    """

    def __init__(self, stage: SceneStage, plain: bool = False) -> None:
        self._stage, self.plain, self.place = stage, plain, 0
        self.wanted = True
        self.width = self.height = 0
        self._drawn: tuple[object, ...] = ()
        self._plane = vtkPlaneSource()
        self._texture = vtkTexture()
        self._texture.InterpolateOff()
        mapper = vtkPolyDataMapper2D()
        mapper.SetInputConnection(self._plane.GetOutputPort())
        self.actor: Any = vtkTexturedActor2D()
        self.actor.SetMapper(mapper)
        self.actor.SetTexture(self._texture)
        self.actor.GetPositionCoordinate().SetCoordinateSystemToDisplay()
        self.actor.VisibilityOff()
        stage.live.AddViewProp(self.actor)

    def write(self, text: str, colour: str, bold: bool = False) -> None:
        """Show a text in a colour, `#rrggbb`; nothing is done where it is so already."""
        ground = self._stage.colours.background if self.plain else self._stage.colours.panel
        now = (text, colour, bold, ground, self._stage.ratio)
        if now == self._drawn:
            return
        self._drawn = now
        image = _painted(text, colour, ground, bold or self.plain, self._stage.ratio, boxed=not self.plain)
        self.width, self.height = image.width(), image.height()
        self._texture.SetInputData(_for_vtk(image))
        self._plane.SetOrigin(0.0, 0.0, 0.0)
        self._plane.SetPoint1(float(self.width), 0.0, 0.0)
        self._plane.SetPoint2(0.0, float(self.height), 0.0)

    def stand(self, left: float, top: float, height: int) -> None:
        """Stand at a place, device pixels from the left and the top, in a picture of a height."""
        self.actor.VisibilityOn()
        # whole pixels: a texture between two of them is blurred
        self.actor.SetPosition(round(left), round(height - top - self.height))

    def hide(self) -> None:
        """Stand nowhere."""
        self.actor.VisibilityOff()

    @property
    def written(self) -> bool:
        """Whether there is anything to read, and it is wanted."""
        return self.wanted and bool(self._drawn)

    def remove(self) -> None:
        """Take it off the stage."""
        self._stage.live.RemoveViewProp(self.actor)


def _painted(text: str, colour: str, ground: str, bold: bool, ratio: float, *, boxed: bool) -> QImage:
    font = QFont(QGuiApplication.font())
    font.setPointSizeF(max(_POINTS, font.pointSizeF()))
    font.setBold(bold)
    measure = QFontMetricsF(font)
    width, height = measure.horizontalAdvance(text) + 10, measure.height() + 4
    image = QImage(round(width * ratio), round(height * ratio), QImage.Format.Format_RGBA8888)
    image.setDevicePixelRatio(ratio)
    image.fill(Qt.GlobalColor.transparent)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    box = QRectF(0.5, 0.5, width - 1, height - 1)
    back = QColor(ground)
    back.setAlpha(235)
    painter.setFont(font)
    if boxed:
        painter.setBrush(back)
        painter.setPen(QPen(QColor(colour), 1))
        painter.drawRoundedRect(box, 4, 4)
    else:  # a rim of the ground's colour: readable before anything
        path = QPainterPath()
        path.addText(5.0, 2.0 + measure.ascent(), font, text)
        rim = QPen(back, 4.0, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin)
        painter.strokePath(path, rim)
        painter.fillPath(path, QColor(colour))
        painter.end()
        return image
    painter.setPen(QColor(colour))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)
    painter.end()
    return image


def _for_vtk(image: QImage) -> Any:
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    pixels = rows[:, : image.width() * 4].reshape(image.height(), image.width(), 4)[::-1]
    data = vtkImageData()
    data.SetDimensions(image.width(), image.height(), 1)
    data.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(pixels).reshape(-1, 4), deep=True))
    return data
