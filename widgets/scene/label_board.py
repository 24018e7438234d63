"""All words of the view: they find their places together, and lead to their points by a line where they are off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QGuiApplication, QImage, QPainterPath, QPen
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkPlaneSource
from vtkmodules.vtkRenderingCore import vtkActor2D, vtkPolyDataMapper2D, vtkTexture, vtkTexturedActor2D

from contactbench.widgets.scene.stage import SceneStage, rgb, segments
from contactbench.widgets.theme import sized, smooth_painter


class LabelBoard:
    """
    Places labels in a frame.

    Layers tell their labels with `want`, and what must not be covered with `keep_free`; then `place` does it.
    """

    def __init__(self, stage: SceneStage) -> None:
        self._stage = stage
        self._wanted: list[tuple[int, int, Label, float, float, int, int]] = []
        self._free: list[tuple[float, float, float, float]] = []
        self._before: object = None
        self._mapper = vtkPolyDataMapper2D()
        self._mapper.SetInputData(vtkPolyData())
        self._lines: Any = vtkActor2D()
        self._lines.SetMapper(self._mapper)
        self._lines.GetPositionCoordinate().SetCoordinateSystemToDisplay()
        stage.live.AddViewProp(self._lines)

    def dress(self) -> None:
        """Take the theme's colours."""
        self._lines.GetProperty().SetColor(*rgb(self._stage.colours.text))
        self._lines.GetProperty().SetLineWidth(self._stage.ratio)

    def want(self, label: Label, x: float, y: float, visible: bool, rank: int) -> None:
        """Have a label stand beside a place, device pixels; the lower the rank, the surer it is shown."""
        if visible and label.written:
            self._wanted.append((rank, len(self._wanted), label, x, y, label.width, label.height))
        else:
            label.hide()

    def keep_free(self, x: float, y: float, radius: float) -> None:
        """Have no label stand on a disc, device pixels."""
        self._free.append((x - radius, y - radius, x + radius, y + radius))

    def place(self, size: tuple[int, int], covered: Sequence[tuple[float, float, float, float]] = ()) -> None:
        """Place all labels in a picture of a size, and not below what lies over it; the next frame begins anew."""
        wanted = sorted(self._wanted, key=lambda each: each[:2])
        before, self._before = self._before, (tuple(wanted), tuple(self._free), tuple(covered), size)
        if before == self._before:  # as under the brush: then no frame is spent on it
            self._wanted, self._free = [], []
            return
        words = [Word(x, y, wide, high, label.plain, label.place) for _, _, label, x, y, wide, high in wanted]
        free = np.array([*self._free, *covered], float).reshape(-1, 4)
        leaders: list[tuple[float, float, float]] = []
        for (_, _, label, x, y, *_), found in zip(
            wanted, label_places(words, free, size, self._stage.ratio), strict=True
        ):
            if found is None:
                label.hide()
                continue
            left, top, label.place = found
            label.stand(left, top, size[1])
            if label.place >= BESIDE:
                near_x = float(np.clip(x, left, left + label.width))
                near_y = float(np.clip(y, top, top + label.height))
                leaders += [(x, size[1] - y, 0.0), (near_x, size[1] - near_y, 0.0)]
        self._mapper.SetInputData(segments(np.array(leaders).reshape(-1, 3)))
        self._lines.SetVisibility(bool(leaders))
        self._wanted, self._free = [], []


# ---- where words stand on screen: beside their points, and on no marker and no other word --------


_MOST_WORDS = 80  # words at once: more are not read, and looking for their places costs time
_GAP = 3.0  # pixels between two words
_NEAR_PX, _RINGS = 10.0, (1.0, 2.2, 4.0, 6.5, 9.5)  # pixels from the point; in how many of them it is looked
# To the right first, as one reads; then left, above, below and the corners.
_DIRECTIONS = np.array(
    [(1.0, 0.0), (-1.0, 0.0), (0.8, -0.7), (0.8, 0.7), (-0.8, -0.7), (-0.8, 0.7), (0.0, -1.0), (0.0, 1.0)]
)
BESIDE = len(_DIRECTIONS)
"""Places before this number are right beside the point: no line need lead to it."""
_CANDIDATES = np.concatenate([ring * _DIRECTIONS for ring in _RINGS])


@dataclass(frozen=True)
class Word:
    """A word that looks for its place; all in device pixels, from the left and the top."""

    x: float  # x, y: the point that it belongs to
    y: float
    width: float
    height: float
    near: bool = False  # it stands right beside its point or nowhere
    last: int = 0  # where it stood in the frame before: there it stays as long as it can


def label_places(
    words: Sequence[Word], kept_free: NDArray[np.float64], size: tuple[int, int], ratio: float = 1.0
) -> list[tuple[float, float, int] | None]:
    """
    Return where words stand: left, top, and the number of the place among those that were tried; None: nowhere.

    Words are placed one after the other, each at the first of forty places about its point that is free; the more
    important ones come first. What finds none is not shown, rather than covering something.

    Parameters
    ----------
    words : sequence of Word
        The most important first.
    kept_free : (k, 4)
        Left, top, right and bottom of what must not be covered.
    size : (width, height)
        Of the picture.
    ratio : float
        Device pixels per pixel.
    """
    taken = np.empty((len(kept_free) + len(words), 4))
    taken[: len(kept_free)] = kept_free
    count = len(kept_free)
    found: list[tuple[float, float, int] | None] = []
    for word in words[:_MOST_WORDS]:
        boxes = _boxes(word, ratio)
        inside = (boxes[:, :2] >= 0).all(axis=1) & (boxes[:, 2] <= size[0]) & (boxes[:, 3] <= size[1])
        others = taken[:count, None]
        covers = (
            (boxes[:, 0] < others[..., 2] + _GAP)
            & (boxes[:, 2] > others[..., 0] - _GAP)
            & (boxes[:, 1] < others[..., 3] + _GAP)
            & (boxes[:, 3] > others[..., 1] - _GAP)
        ).any(axis=0)
        free = np.flatnonzero(inside & ~covers)
        free = free[free < BESIDE] if word.near else free
        if not len(free):
            found.append(None)
            continue
        place = word.last if word.last in free else int(free[0])
        taken[count] = boxes[place]
        count += 1
        found.append((float(boxes[place, 0]), float(boxes[place, 1]), place))
    return found + [None] * (len(words) - len(found))


def _boxes(word: Word, ratio: float) -> NDArray[np.float64]:
    """Return left, top, right and bottom (40, 4) of the places that a word may have."""
    middle = np.array([word.x, word.y]) + ratio * _NEAR_PX * _CANDIDATES
    # a word to the right of its point begins there, one to the left ends there, one above stands centred
    shift = 0.5 * (np.sign(np.round(_CANDIDATES, 9)) - 1.0) * [word.width, word.height]
    corner = middle + shift
    corner = np.where(_CANDIDATES == 0.0, middle - 0.5 * np.array([word.width, word.height]), corner)
    return np.concatenate([corner, corner + [word.width, word.height]], axis=1)


# ---- A word beside a point -----------------------------------------------------------------------


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
    font = QGuiApplication.font()
    font = sized(font, max(_POINTS, font.pointSizeF()), bold=bold)
    measure = QFontMetricsF(font)
    width, height = measure.horizontalAdvance(text) + 10, measure.height() + 4
    image = QImage(round(width * ratio), round(height * ratio), QImage.Format.Format_RGBA8888)
    image.setDevicePixelRatio(ratio)
    image.fill(Qt.GlobalColor.transparent)
    painter = smooth_painter(image)
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
