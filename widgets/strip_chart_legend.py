"""What is written above the lines of a strip chart: names in their colours and strokes, and newest values."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from PySide6.QtCore import QPoint, QSize
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

if TYPE_CHECKING:
    from collections.abc import Sequence

_POINT_SIZE, _TIGHT_SIZE = 10, 9


class LegendEntry(NamedTuple):
    """One line's name and value; the sign looks like its stroke."""

    sign: str
    name: str
    colour: str
    value: str


class Legend(QWidget):
    """
    Entries side by side.

    Painted, not a label: a label whose text changes asks for its layout, and with it for that of the whole window, 30
    times a second.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._strong = QFont(self.font())
        self._strong.setBold(True)
        self._size(_POINT_SIZE)
        self._entries: tuple[LegendEntry, ...] = ()
        self._tight = False
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)

    def show_entries(self, entries: Sequence[LegendEntry], tight: bool) -> None:
        """Show entries; `tight`: with little room between them."""
        if tight != self._tight:
            self._size(_TIGHT_SIZE if tight else _POINT_SIZE)
        if (tuple(entries), tight) != (self._entries, self._tight):
            self._entries, self._tight = tuple(entries), tight
            self.update()

    def sizeHint(self) -> QSize:
        """Return the height of a line; any width will do."""
        return QSize(0, QFontMetrics(self._strong).height())

    minimumSizeHint = sizeHint

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Write it."""
        painter = QPainter(self)
        strong, plain = QFontMetrics(self._strong), QFontMetrics(self.font())
        gap = self._gap(strong, plain)
        words = self.palette().windowText().color()
        at = QPoint(0, strong.ascent())
        for entry in self._entries:
            for text, font, metrics, colour in (
                (entry.sign, self._strong, strong, QColor(entry.colour)),
                (entry.name, self.font(), plain, QColor(entry.colour)),
                (entry.value, self.font(), plain, words),
            ):
                painter.setFont(font)
                painter.setPen(colour)
                painter.drawText(at, text)
                at.setX(at.x() + metrics.horizontalAdvance(text) + gap)
            at.setX(at.x() + gap)

    def _gap(self, strong: QFontMetrics, plain: QFontMetrics) -> int:
        """Return a space, or what is left of it where the pane is narrow: nothing may be cut."""
        words = sum(
            strong.horizontalAdvance(each.sign)
            + plain.horizontalAdvance(each.name)
            + plain.horizontalAdvance(each.value)
            for each in self._entries
        )
        room = (self.width() - words) // max(4 * len(self._entries) - 2, 1)
        return max(1, min(plain.horizontalAdvance(" "), room))

    def _size(self, points: int) -> None:
        font = self.font()
        for each in (font, self._strong):
            each.setPointSize(points)
        self.setFont(font)
