"""What stands beside the view, and covers nothing of it: which colour is which value, and what the signs mean."""

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QBrush, QColor, QLinearGradient, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QFrame, QMenu, QToolButton, QWidget

from contactbench.pipeline.colour_ramp import ColourScale, colour_ramp, round_length
from contactbench.widgets.controls import beside, tool_button
from contactbench.widgets.messages import filled, number
from contactbench.widgets.theme import Colours, smooth_painter

_NARROWEST_PX, _WIDEST_PX = 96, 220  # px, of what stands beside the view
_LINE, _CAP = 20, 9  # px: of a line of text; of the arrow that says that there is more
_TALL, _FLAT = 230, 66  # px: of a bar upright, and lying
_SIGN = 26  # px, of a sign of the key


class LegendPart(QWidget):
    """A part of the legend: upright beside a wide view, lying below a narrow one."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._text = self._muted = self._line = "#000000"
        self.hide()

    def dress(self, colours: Colours) -> None:
        """Take the theme's colours."""
        self._text, self._muted, self._line = colours.text, colours.muted, colours.line
        self.update()

    def wanted(self, lying: bool, width: int) -> QSize:
        """Return the size that it needs, in a column, or `lying` in so many pixels."""
        raise NotImplementedError

    def _wide(self, texts: Sequence[str], beside: int = 0) -> int:
        widest = max((self.fontMetrics().horizontalAdvance(text) for text in texts), default=0)
        return min(max(widest + beside + 16, _NARROWEST_PX), _WIDEST_PX)


class ColourBar(LegendPart):
    """Which colour is which value, and how far values go that are beyond the last colour."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.title = self.over = ""
        self.scale = ColourScale()

    def tell(self, title: str, scale: ColourScale, largest: float | None = None) -> None:
        """Show a title, with its unit, the colours of values, and the largest if that is beyond the end."""
        self.title, self.scale = title, scale
        beyond = largest is not None and largest > scale.top * (1.0 + 1e-6)
        self.over = filled(self.tr("darkest: up to {largest:.3g}"), largest=largest) if beyond else ""
        words = filled(
            self.tr("{title}: from {low:.3g} to {high:.3g}"), title=title, low=scale.low, high=scale.top
        )
        self.setAccessibleName("; ".join(filter(None, (words, self.over))))
        self.update()

    def wanted(self, lying: bool, width: int) -> QSize:
        """Return the size that it needs."""
        return QSize(width, _FLAT) if lying else QSize(self._wide((*self._lines(), self.over)), _TALL)

    def _lines(self) -> list[str]:
        """Return the title in as many lines as it needs beside the view: its unit goes to the next one."""
        if self.fontMetrics().horizontalAdvance(self.title) + 16 <= _WIDEST_PX or ", " not in self.title:
            return [self.title]
        return [part.strip() for part in self.title.rsplit(",", 1)]

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it."""
        painter = smooth_painter(self)
        if self.width() > 1.5 * self.height():
            self._paint_lying(painter)
        else:
            self._paint_upright(painter)

    def _paint_upright(self, painter: QPainter) -> None:
        painter.setPen(QColor(self._text))
        lines = self._lines()
        for row, line in enumerate(lines):
            self._write(painter, QRectF(8, 4 + row * _LINE, self.width() - 12, _LINE), line)
        top = 8 + len(lines) * _LINE
        if self.over:
            painter.setPen(QColor(self._muted))
            self._write(painter, QRectF(8, top, self.width() - 12, _LINE), self.over)
            top += _LINE
        bar = QRectF(12, top + 6 + _CAP, 20, self.height() - top - 20 - _CAP)
        self._fill(painter, bar, bar.bottomLeft(), bar.topLeft())
        if self.over:
            self._cap(painter, [bar.topLeft(), QPointF(bar.center().x(), bar.top() - _CAP), bar.topRight()])
        painter.setPen(QColor(self._text))
        for value, place in self._ticks():
            y = bar.bottom() - place * bar.height()
            painter.drawLine(QPointF(bar.right(), y), QPointF(bar.right() + 5, y))
            self._write(
                painter, QRectF(bar.right() + 9, y - 11, self.width() - bar.right() - 12, 22), _said(value)
            )

    def _paint_lying(self, painter: QPainter) -> None:
        painter.setPen(QColor(self._text))
        words = f"{self.title} ({self.over})" if self.over else self.title
        self._write(painter, QRectF(12, 2, self.width() - 24, _LINE), words)
        bar = QRectF(12, 4 + _LINE, self.width() - 32 - _CAP, 14)
        self._fill(painter, bar, bar.topLeft(), bar.topRight())
        if self.over:
            self._cap(
                painter, [bar.topRight(), QPointF(bar.right() + _CAP, bar.center().y()), bar.bottomRight()]
            )
        painter.setPen(QColor(self._text))
        for value, place in self._ticks():
            x = bar.left() + place * bar.width()
            painter.drawLine(QPointF(x, bar.bottom()), QPointF(x, bar.bottom() + 4))
            wide = painter.fontMetrics().horizontalAdvance(_said(value))
            left = min(max(x - wide / 2, 2.0), self.width() - wide - 2.0)
            painter.drawText(QRectF(left, bar.bottom() + 4, wide + 2, _LINE), 0, _said(value))

    def _ticks(self) -> list[tuple[float, float]]:
        values = self.scale.ticks()
        return list(zip(values, self.scale.places(values).tolist(), strict=True))

    def _fill(self, painter: QPainter, bar: QRectF, begin: QPointF, end: QPointF) -> None:
        shades = QLinearGradient(begin, end)
        for i, (red, green, blue) in enumerate(self.scale.ramp(33)):
            shades.setColorAt(i / 32, QColor.fromRgbF(red, green, blue))
        painter.fillRect(bar, shades)
        painter.setPen(QPen(QColor(self._line), 1))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(bar)

    def _cap(self, painter: QPainter, corners: list[QPointF]) -> None:
        red, green, blue = colour_ramp(2)[1]
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor.fromRgbF(red, green, blue))
        painter.drawPolygon(QPolygonF(corners))

    @staticmethod
    def _write(painter: QPainter, place: QRectF, text: str) -> None:
        short = painter.fontMetrics().elidedText(text, Qt.TextElideMode.ElideRight, int(place.width()))
        painter.drawText(place, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, short)


@dataclass(frozen=True)
class KeySign:
    """A sign that is seen in the view, and what it means."""

    kind: str  # "area", "lines", "crossed", "pale", "arrow", "ellipse", "ring" or "cross"
    words: str
    colour: str = ""  # of an area, ``#rrggbb``; empty: that of a surface without a region


class SceneKey(LegendPart):
    """What the signs in the view mean: told apart by their form, and not by a colour alone."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.signs: tuple[KeySign, ...] = ()

    def tell(self, signs: Sequence[KeySign]) -> None:
        """Show other signs."""
        self.signs = tuple(signs)
        self.setAccessibleName("; ".join(sign.words for sign in signs))
        self.update()

    def wanted(self, lying: bool, width: int) -> QSize:
        """Return the size that it needs."""
        words = [sign.words for sign in self.signs]
        if not lying:
            return QSize(self._wide(words, _SIGN + 8), len(words) * (_LINE + 2) + 10)
        return QSize(width, (self._places(width)[-1][1] if words else 0) + _LINE + 8)

    def _places(self, width: int) -> list[tuple[int, int]]:
        """Return where each sign stands, one beside the other, in so many pixels."""
        places, x, y = [], 8, 4
        for sign in self.signs:
            wide = min(_SIGN + 8 + self.fontMetrics().horizontalAdvance(sign.words), width - 16)
            if x > 8 and x + wide > width - 8:
                x, y = 8, y + _LINE + 2
            places.append((x, y))
            x += wide + 14
        return places

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it."""
        painter = smooth_painter(self)
        lying = self.width() > _WIDEST_PX
        column = [(8, 4 + number * (_LINE + 2)) for number in range(len(self.signs))]
        for sign, (x, y) in zip(self.signs, self._places(self.width()) if lying else column, strict=True):
            self._sign(painter, sign, QRectF(x, y + 3, _SIGN, _LINE - 6))
            painter.setPen(QColor(self._text))
            room = self.width() - x - _SIGN - 12
            words = painter.fontMetrics().elidedText(sign.words, Qt.TextElideMode.ElideRight, room)
            painter.drawText(QRectF(x + _SIGN + 8, y, room + 2, _LINE), Qt.AlignmentFlag.AlignVCenter, words)

    def _sign(self, painter: QPainter, sign: KeySign, box: QRectF) -> None:
        plain = QColor("#c8c8c8")
        painter.setPen(QPen(QColor(self._line), 1))
        if sign.kind in ("area", "lines", "crossed", "pale"):
            fill = {"area": QColor(sign.colour or "#c8c8c8"), "pale": QColor("#ededed")}.get(sign.kind, plain)
            painter.fillRect(box, fill)
            style = {"lines": Qt.BrushStyle.BDiagPattern, "crossed": Qt.BrushStyle.DiagCrossPattern}
            if sign.kind in style:
                painter.fillRect(box, QBrush(QColor("#2b2f33"), style[sign.kind]))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(box)
            return
        red, green, blue = colour_ramp(9)[6]
        painter.setPen(QPen(QColor.fromRgbF(red, green, blue), 2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        middle = box.center()
        if sign.kind == "arrow":
            tip = QPointF(box.right(), middle.y())
            painter.drawLine(box.topLeft() + QPointF(0, box.height() / 2), tip)
            painter.drawPolyline([tip + QPointF(-6, -4), tip, tip + QPointF(-6, 4)])
        elif sign.kind == "ellipse":
            painter.drawEllipse(box.adjusted(2, 2, -2, -2))
        elif sign.kind == "ring":
            painter.setPen(QPen(QColor(self._text), 2))
            painter.drawEllipse(middle, 6, 6)
        else:
            painter.setPen(QPen(QColor(self._text), 2))
            for step in (QPointF(5, 5), QPointF(5, -5)):
                painter.drawLine(middle - step, middle + step)


def _said(value: float) -> str:
    return number(value, ".4g").replace("-", "\u2212")


# ---- what lies over the view: buttons, and a scale bar -------------------------------------------


_LONGEST_BAR_PX = 190.0  # of the scale bar, pixels
_BUTTON_HEIGHT = 36
_SPACE = 3  # around the buttons, pixels


class ViewButtons(QFrame):
    """Front, side, top, fit, and the switch to perspective; one button with a menu where they have no room."""

    chosen = Signal(str)
    perspective = Signal(bool)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("viewButtons")
        self._row = beside(self, margins=(_SPACE, _SPACE, _SPACE, _SPACE), space=2)
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
            self.tr("Perspective"), self.tr("Nearer objects look larger, so no scale bar is shown")
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
        button = tool_button("", tip, words=text)
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
        return QSize(int(_LONGEST_BAR_PX) + 20, 36)

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
        return round_length(_LONGEST_BAR_PX * self._per_pixel)

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
        painter = smooth_painter(self)
        painter.setPen(QPen(QColor(self._colour), 2))
        middle, y, half = self.width() / 2, self.height() - 7.0, self.pixels / 2
        painter.drawLine(QPointF(middle - half, y), QPointF(middle + half, y))
        for x in (middle - half, middle + half):
            painter.drawLine(QPointF(x, y - 5), QPointF(x, y + 5))
        where = QRectF(0, 0, self.width(), y - 4)
        painter.drawText(where, Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignBottom, self.text)
