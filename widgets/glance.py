"""What matters just now, so large that it can be read from two metres away, and the one thing to do."""

from dataclasses import dataclass
from math import isfinite, nan

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from contactbench.widgets.action_bar import ActionBar, ActionButton
from contactbench.widgets.controls import accent, column
from contactbench.widgets.messages import number
from contactbench.widgets.theme import colours, draw_fitted, is_dark, smooth_painter

_NUMBER_PT, _HEADLINE_PT, _SENTENCE_PT, _LEAST_PT = 66.0, 32.0, 20.0, 13.0
_TITLE_PX, _NUMBER_PX, _HEADLINE_PX, _FORCE_PX, _ACTION_PX = 40, 120, 96, 74, 128
_MARGIN, _SPACE = 18, 10
_ACTION_PT = {True: 24, False: 15}  # the first button, the second one


@dataclass(frozen=True)
class Glance:
    """
    What matters on a page just now.

    Attributes
    ----------
    headline : str
        How it stands, in a word or two.
    sentence : str
        What that means, or what to do.
    number, of : str
        The one number that counts, with its unit, and what it is of.
    role : str
        Name of the theme's colour for the headline.
    force : float
        |F|, N; NaN: it does not matter here.
    window : (low, high)
        Where the force should be, N.
    share : float
        Of what is being measured, 0 to 1; NaN: nothing is.
    """

    headline: str
    sentence: str = ""
    number: str = ""
    of: str = ""
    role: str = "text"
    force: float = nan
    window: tuple[float, float] = (0.0, 0.0)
    share: float = nan


class _Face(QWidget):
    """The words and the number, painted: each as large as its room lets it be."""

    def __init__(self) -> None:
        super().__init__()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.title, self.glance = "", Glance("")

    def paintEvent(self, _: QPaintEvent) -> None:
        c, glance = colours(is_dark()), self.glance
        wrapped = Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
        line = Qt.AlignmentFlag.AlignVCenter
        with smooth_painter(self) as painter:
            top = QRectF(_MARGIN, _MARGIN, self.width() - 2 * _MARGIN, 0)

            def below(height: float) -> QRectF:
                box = QRectF(top.left(), top.top(), top.width(), height)
                top.moveTop(box.bottom() + _SPACE)
                return box

            painter.setPen(QColor(c.muted))
            draw_fitted(painter, below(_TITLE_PX), self.title, _SENTENCE_PT, _LEAST_PT, line)
            if glance.number:
                painter.setPen(QColor(c.text))
                draw_fitted(painter, below(_NUMBER_PX), glance.number, _NUMBER_PT, _LEAST_PT, line, bold=True)
                painter.setPen(QColor(c.muted))
                draw_fitted(painter, below(_TITLE_PX), glance.of, _SENTENCE_PT, _LEAST_PT, line)
            painter.setPen(QColor(getattr(c, glance.role)))
            box = QRectF(top.left(), top.top(), top.width(), _HEADLINE_PX)
            below(draw_fitted(painter, box, glance.headline, _HEADLINE_PT, _LEAST_PT, wrapped, bold=True))
            if isfinite(glance.force):
                self._draw_force(painter, below(_FORCE_PX))
            elif isfinite(glance.share):
                self._draw_share(painter, below(_FORCE_PX / 2))
            painter.setPen(QColor(c.text))
            rest = self.height() - top.top() - _MARGIN
            draw_fitted(painter, below(rest), glance.sentence, _SENTENCE_PT, _LEAST_PT, wrapped)

    def _draw_share(self, painter: QPainter, box: QRectF) -> None:
        c = colours(is_dark())
        painter.setPen(QPen(QColor(c.line), 2))
        painter.setBrush(QColor(c.background))
        painter.drawRect(box)
        box.setWidth(box.width() * min(max(self.glance.share, 0.0), 1.0))
        painter.fillRect(box, QColor(c.accent))

    def _draw_force(self, painter: QPainter, box: QRectF) -> None:
        """Draw |F| from 0 to half as much again as the end of its window, which is a frame."""
        c, (low, high), force = colours(is_dark()), self.glance.window, self.glance.force
        words = QRectF(box.right() - 150, box.top(), 150, box.height())
        bar = QRectF(box.left(), box.top() + 14, box.width() - 165, box.height() - 28)

        def across(value: float) -> float:
            return bar.width() * min(max(value / (1.5 * high), 0.0), 1.0)

        painter.fillRect(bar, QColor(c.line))
        inside = low <= force <= high
        filled = QRectF(bar.left(), bar.top(), across(force), bar.height())
        painter.fillRect(filled, QColor(c.good if inside else c.accent))
        painter.setPen(QPen(QColor(c.text), 3))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        left, wide = bar.left() + across(low), across(high) - across(low)
        painter.drawRect(QRectF(left, box.top() + 4, wide, box.height() - 8))
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        text = self.tr("{force} N").format(force=number(force, ".1f"))
        draw_fitted(painter, words, text, _HEADLINE_PT, _LEAST_PT, right, bold=True)


class GlanceView(QWidget):
    """
    A glance, and below it the buttons of the page's foot, for gloves.

    Signals
    -------
    pressed : int
        0: the first button, 1: the second one.

    Attributes
    ----------
    primary, second : QPushButton
    """

    pressed = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._face = _Face()
        self.primary, self.second = ActionButton(_ACTION_PX), ActionButton(_ACTION_PX // 2)
        for index, (button, first) in enumerate(((self.primary, True), (self.second, False))):
            button.setStyleSheet(f"padding: 2px 6px; font-size: {_ACTION_PT[first]}pt;")
            button.clicked.connect(lambda _=False, index=index: self.pressed.emit(index))
        kept = self.second.sizePolicy()
        kept.setRetainSizeWhenHidden(True)  # else the first one would move
        self.second.setSizePolicy(kept)
        column(self, (self._face, 1), self.second, self.primary, margins=(12, 0, 12, 12), space=8)

    def show_glance(self, title: str, glance: Glance, bar: ActionBar) -> None:
        """Show what matters on the page with this title, and what its foot offers."""
        for own, button in ((self.primary, bar.primary), (self.second, bar.second)):
            own.setText(button.text())
            own.setEnabled(button.isEnabled())
            own.setVisible(not button.isHidden())
        accent(self.primary, bar.primary.isEnabled())
        if (title, glance) != (self._face.title, self._face.glance):
            self._face.title, self._face.glance = title, glance
            words = (title, glance.number, glance.of, glance.headline, glance.sentence)
            self.setAccessibleName(". ".join(filter(None, words)))
            self._face.update()
