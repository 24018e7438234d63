"""What lies over the view: buttons, and a scale bar."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QFrame, QHBoxLayout, QMenu, QToolButton, QWidget

from contactbench.widgets.numbers import filled
from contactbench.widgets.scene.fields import round_length

if TYPE_CHECKING:
    from PySide6.QtGui import QPaintEvent

    from contactbench.widgets.theme import Colours

_LONGEST = 190.0  # of the scale bar, pixels
_BUTTON_HEIGHT = 36
_SPACE = 3  # around the buttons, pixels


class ViewButtons(QFrame):
    """Front, side, top, fit, and the switch to perspective; one button with a menu where they have no room."""

    chosen = Signal(str)
    perspective = Signal(bool)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("viewButtons")
        self._row = row = QHBoxLayout(self)
        row.setContentsMargins(_SPACE, _SPACE, _SPACE, _SPACE)
        row.setSpacing(2)
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
        self.menu = self._button(self.tr("View"), self.tr("How the probe is viewed"))
        self.menu.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.menu.setMenu(self._menu())
        self.menu.hide()

    def _menu(self) -> QMenu:
        menu = QMenu(self)
        for button in self.buttons.values():
            action = menu.addAction(button.text())
            action.setToolTip(button.toolTip())
            action.triggered.connect(button.click)
            if button.isCheckable():
                action.setCheckable(True)
                button.toggled.connect(action.setChecked)
        return menu

    def _button(self, text: str, tip: str) -> QToolButton:
        button = QToolButton(self)
        button.setText(text)
        button.setToolTip(tip)
        button.setAccessibleName(tip)
        button.setMinimumSize(46, _BUTTON_HEIGHT)
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self._row.addWidget(button)
        return button

    def fit(self, width: int, height: int) -> QSize:
        """Choose the buttons, or only the one with the menu, or nothing, for a room, px; return the size."""
        sizes = [each.sizeHint().expandedTo(each.minimumSize()) for each in self.buttons.values()]
        room = 2 * (_SPACE + len(sizes)) + sum(size.width() for size in sizes)
        self.menu.setVisible(room > width)
        for button in self.buttons.values():
            button.setVisible(room <= width)
        size = self.sizeHint()
        self.setVisible(size.height() <= height)
        return size

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
