"""A verdict with its reasons, and a number that shrinks."""

from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QFrame, QLabel, QSizePolicy, QWidget

from contactbench.pipeline.errors import message
from contactbench.widgets.controls import beside, column, sentence_label
from contactbench.widgets.messages import translated
from contactbench.widgets.theme import Sign, colours, icon, is_dark, smooth_painter

GOOD, USABLE, REFUSE, LOCKED = "good", "usable", "refuse", "locked"
_LOOKS = {
    GOOD: ("done", "good", message("Good")),
    USABLE: ("warning", "warning", message("Usable")),
    REFUSE: ("failed", "bad", message("Rejected: do not use")),
    LOCKED: ("locked", "muted", message("Not ready yet")),
}


class VerdictBox(QFrame):
    """An icon, a word and sentences."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._icon, self._word, self._text = Sign(26), QLabel(), sentence_label()
        self._word.setStyleSheet("font-weight: 600;")
        words = column(None, self._word, self._text, space=2)
        beside(self, (self._icon, 0, Qt.AlignmentFlag.AlignTop), (words, 1), margins=(8, 6, 8, 6))
        self._word.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.level = ""

    @property
    def text(self) -> str:
        """All that it says."""
        return f"{self._word.text()}: {self._text.text()}"

    @property
    def word(self) -> str:
        """The word above the sentences."""
        return self._word.text()

    @property
    def reasons(self) -> str:
        """The sentences."""
        return self._text.text()

    @property
    def role(self) -> str:
        """Name of the theme's colour for the level."""
        return _LOOKS[self.level][1]

    def show_verdict(self, level: str, reasons: Sequence[str], word: str = "") -> None:
        """Show a level (good, usable, refuse or locked) and why; `word`: instead of the usual one."""
        name, colour, usual = _LOOKS[level]
        self.level = level
        self._icon.show_icon(icon(name, colour))
        self._word.setText(word or translated(usual))
        self._text.setText("\n".join(translated(reason) for reason in reasons))
        self.setAccessibleName(self.text)


class Shrinking(QWidget):
    """A small curve of a number over the steps that it took; logarithmic, with the limit for good."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._values: tuple[float, ...] = ()
        self._limit = 0.0
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(self.tr("Contact error over poses"))

    def sizeHint(self) -> QSize:
        """Return a size beside a number."""
        return QSize(60, 44)

    def show_values(self, values: Sequence[float], limit: float) -> None:
        """Show values above 0, and a limit."""
        self._values, self._limit = tuple(values), limit
        self.update()

    def paintEvent(self, _: QPaintEvent) -> None:
        """Draw it."""
        import math

        if not self._values:
            return
        c = colours(is_dark())
        logs = [math.log10(max(value, 1e-9)) for value in self._values]
        bar = math.log10(self._limit)
        low, high = min(*logs, bar) - 0.1, max(*logs, bar) + 0.1
        room = QRectF(5, 4, self.width() - 10, self.height() - 8)

        def at(step: int, value: float) -> QPointF:
            x = room.left() + room.width() * step / max(len(logs) - 1, 1)
            return QPointF(x, room.bottom() - room.height() * (value - low) / (high - low))

        painter = smooth_painter(self)
        painter.setPen(QPen(QColor(c.muted), 1, Qt.PenStyle.DashLine))
        painter.drawLine(QPointF(room.left(), at(0, bar).y()), QPointF(room.right(), at(0, bar).y()))
        painter.setPen(QPen(QColor(c.accent), 2))
        painter.drawPolyline(QPolygonF([at(step, value) for step, value in enumerate(logs)]))
        painter.setBrush(QColor(c.accent))
        painter.drawEllipse(at(len(logs) - 1, logs[-1]), 3, 3)
        painter.end()
