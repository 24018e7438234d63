"""What lies over the view: buttons, and a scale bar."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QFrame, QToolButton, QWidget

from contactbench.widgets.controls import FoldRow
from contactbench.widgets.numbers import filled
from contactbench.widgets.scene.fields import round_length

if TYPE_CHECKING:
    from PySide6.QtGui import QPaintEvent

    from contactbench.widgets.theme import Colours

_LONGEST = 190.0  # of the scale bar, pixels
_BUTTON_HEIGHT = 36


class ViewButtons(QFrame):
    """Front, side, top, fit, and the switch to perspective."""

    chosen = Signal(str)
    perspective = Signal(bool)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("viewButtons")
        self._row = row = FoldRow(2)
        row.setContentsMargins(3, 3, 3, 3)
        self.setLayout(row)
        self.buttons: dict[str, QToolButton] = {}
        for name, text, tip in (
            ("front", self.tr("Front"), self.tr("View from the front: x right, z up")),
            ("side", self.tr("Side"), self.tr("View from the side: y right, z up")),
            ("top", self.tr("Top"), self.tr("View the tip from above: x right, y up")),
            ("fit", self.tr("Fit"), self.tr("Show the whole probe from the same direction")),
        ):
            button = self._button(text, tip)
            button.clicked.connect(lambda _checked=False, name=name: self.chosen.emit(name))
            self.buttons[name] = button
        depth = self._button(
            self.tr("Perspective"),
            self.tr("Nearer objects look larger, so no scale bar is shown"),
        )
        depth.setCheckable(True)
        depth.toggled.connect(self.perspective)
        self.buttons["perspective"] = depth

    def _button(self, text: str, tip: str) -> QToolButton:
        button = QToolButton(self)
        button.setText(text)
        button.setToolTip(tip)
        button.setAccessibleName(tip)
        button.setMinimumSize(46, _BUTTON_HEIGHT)
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self._row.add(button)
        return button

    def wanted(self, width: int) -> QSize:
        """Return the size for a width, px: in one line where there is room."""
        whole = self.sizeHint()
        if whole.width() <= width:
            return whole
        return QSize(width, self._row.heightForWidth(width))

    def dress(self, colours: Colours) -> None:
        """Take the theme's colours."""
        self.setStyleSheet(
            f"#viewButtons {{ background: {colours.panel}; border: 1px solid {colours.line}; border-radius: 7px; }}"
            f" QToolButton {{ color: {colours.text}; border: 1px solid transparent;"
            " border-radius: 5px; padding: 4px 8px; }"
            f" QToolButton:hover, QToolButton:focus {{ border-color: {colours.accent}; }}"
            f" QToolButton:checked {{ background: {colours.accent}; color: {colours.panel}; }}"
        )


class ScaleBar(QWidget):
    """How long a round number of millimetres is on screen."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._per_pixel = 1e-4
        self._colour = "#000000"
        self.resize(self.sizeHint())

    def sizeHint(self) -> QSize:
        """Return its size."""
        return QSize(int(_LONGEST) + 20, 36)

    def dress(self, colours: Colours) -> None:
        """Take the theme's colours."""
        self._colour = colours.text
        self.update()

    def set_scale(self, metres_per_pixel: float) -> None:
        """Say how long a pixel is, m."""
        if metres_per_pixel != self._per_pixel:
            self._per_pixel = metres_per_pixel
            self.setAccessibleName(self.tr("Scale bar: {length}").format(length=self.text))
            self.update()

    @property
    def length(self) -> float:
        """Of the bar, m."""
        return round_length(_LONGEST * self._per_pixel)

    @property
    def pixels(self) -> float:
        """Of the bar."""
        return self.length / self._per_pixel

    @property
    def text(self) -> str:
        """What is written over it."""
        return filled(self.tr("{length:g} mm"), length=round(self.length * 1e3, 6))

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(self._colour), 2))
        middle, y, half = self.width() / 2, self.height() - 7.0, self.pixels / 2
        painter.drawLine(QPointF(middle - half, y), QPointF(middle + half, y))
        for x in (middle - half, middle + half):
            painter.drawLine(QPointF(x, y - 5), QPointF(x, y + 5))
        where = QRectF(0, 0, self.width(), y - 4)
        painter.drawText(where, Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignBottom, self.text)
