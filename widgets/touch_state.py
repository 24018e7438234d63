"""How a touch goes and how far it is off, to be read from a metre away: icon, word, colour, force, number, arrow."""

import math
from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from contactbench.pipeline.errors import message
from contactbench.widgets.messages import filled, number, translated
from contactbench.widgets.theme import colours, draw_fitted, icon, is_dark, sized, smooth_painter

_ARROW = 92
_NEWEST_ERRORS = 40
# State -> icon, colour of the theme, word.
_LOOKS = {
    "idle": ("pause", "muted", message("not started")),
    "armed": ("ready", "accent", message("ready: touch")),
    "touching": ("down", "warning", message("hold still")),
    "settled": ("running", "warning", message("measuring")),
    "accepted": ("done", "good", message("accepted")),
    "rejected": ("failed", "bad", message("not counted")),
}
_GAUGE = 74
_CONTACT = 84  # px below, for how sure the contact is


class TouchState(QWidget):
    """The state of a touch, |F| as a vertical gauge beside it, and below how sure the contact is."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.state, self.detail = "idle", ""
        self.force, self.window_N = math.nan, (8.0, 10.0)
        self.contact, self.sure = "", True
        self.setMinimumHeight(150 + _CONTACT)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._name()

    def sizeHint(self) -> QSize:
        """Return the size that it likes."""
        return QSize(340, 160 + _CONTACT)

    @property
    def word(self) -> str:
        """The state in a word."""
        return translated(_LOOKS[self.state][2])

    @property
    def role(self) -> str:
        """Name of the theme's colour for the state."""
        return _LOOKS[self.state][1]

    def show_state(
        self, state: str, detail: str = "", force: float = math.nan, window: tuple[float, float] = (8.0, 10.0)
    ) -> None:
        """
        Show another moment.

        Parameters
        ----------
        state : {"idle", "armed", "touching", "settled", "accepted", "rejected"}
        detail : str
            A short sentence below the word.
        force : float
            |F|, N; NaN: not known.
        window : (low, high)
            Where it should be, N.
        """
        shown = force if math.isnan(force) else round(force, 1)
        same = shown == self.force or (math.isnan(shown) and math.isnan(self.force))
        if same and (state, detail, window) == (self.state, self.detail, self.window_N):
            return
        changed = state != self.state or detail != self.detail
        self.state, self.detail, self.force, self.window_N = state, detail, shown, window
        if changed:
            self._name()
        self.update()

    def show_contact(self, text: str, sure: bool = True) -> None:
        """Say in a sentence how sure the contact is; empty: there is none."""
        if (text, sure) != (self.contact, self.sure):
            self.contact, self.sure = text, sure
            self._name()
            self.update()

    def _name(self) -> None:
        name = self.tr("Touch state: {word}. {detail}").format(word=self.word, detail=self.detail)
        self.setAccessibleName(f"{name} {self.contact}".strip())

    # ---- drawing -----------------------------------------------------------------------------

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        """Draw it."""
        with smooth_painter(self) as painter:
            self._draw(painter)

    def _draw(self, painter: QPainter) -> None:
        theme = colours(is_dark())
        name, role, _ = _LOOKS[self.state]
        colour = QColor(getattr(theme, role))
        box = QRectF(self.rect()).adjusted(1.5, 1.5, -1.5, -1.5)
        painter.setPen(QPen(colour, 3))
        painter.setBrush(QColor(theme.panel))
        painter.drawRoundedRect(box, 8, 8)
        self._contact(painter, QRectF(box.left(), box.bottom() - _CONTACT, box.width(), _CONTACT))
        box.setBottom(box.bottom() - _CONTACT)
        text = box.adjusted(14, 12, -_GAUGE, -10)
        size = 40
        icon(name, role).paint(painter, int(text.left()), int(text.top()), size, size)
        painter.setPen(colour)
        word = QRectF(text.left() + size + 10, text.top(), text.width() - size - 10, size)
        draw_fitted(painter, word, self.word, 20, 12, Qt.AlignmentFlag.AlignVCenter, bold=True)
        painter.setPen(QColor(theme.text))
        painter.setFont(sized(self.font(), 11.5))
        below = QRectF(text.left(), text.top() + size + 8, text.width(), text.height() - size - 8)
        painter.drawText(below, Qt.TextFlag.TextWordWrap, self.detail)
        self._gauge(painter, QRectF(box.right() - _GAUGE + 8, box.top() + 12, _GAUGE - 18, box.height() - 24))

    def _contact(self, painter: QPainter, box: QRectF) -> None:
        """Draw how sure the contact is, as large as it fits; a doubt has a sign."""
        theme, sign = colours(is_dark()), 22
        painter.setPen(QPen(QColor(theme.line), 1))
        painter.drawLine(box.topLeft(), box.topRight())
        text = box.adjusted(14, 8, -12, -8)
        if not self.contact:
            return
        shown = icon("done", "good") if self.sure else icon("warning", "warning")
        shown.paint(painter, int(text.left()), int(text.top()), sign, sign)
        text.setLeft(text.left() + sign + 8)
        painter.setPen(QColor(theme.text))
        draw_fitted(painter, text, self.contact, 14, 8.5, Qt.TextFlag.TextWordWrap, bold=True)

    def _gauge(self, painter: QPainter, box: QRectF) -> None:
        """Draw |F| from 0 to half as much again as the window's end; the window is a hatched band."""
        theme, (low, high) = colours(is_dark()), self.window_N
        top, bar = 1.5 * high, QRectF(box.left() + 30, box.top() + 4, 18, box.height() - 30)

        def height(force: float) -> float:
            return bar.bottom() - bar.height() * min(max(force / top, 0.0), 1.0)

        painter.setPen(QPen(QColor(theme.line), 1))
        painter.setBrush(QColor(theme.background))
        painter.drawRect(bar)
        band = QRectF(bar.left() - 5, height(high), bar.width() + 10, height(low) - height(high))
        inside = not math.isnan(self.force) and low <= self.force <= high
        if not math.isnan(self.force):
            level = bar.adjusted(0, height(self.force) - bar.top(), 0, 0)
            painter.fillRect(level, QColor(theme.good if inside else theme.accent))
        painter.setPen(QPen(QColor(theme.text), 1.5))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(band)
        painter.setFont(sized(self.font(), 9.5))
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        for force in (low, high):
            side = QRectF(box.left() - 6, height(force) - 9, 28, 18)
            painter.drawText(side, right, number(force, "g"))
        painter.setFont(sized(self.font(), 11, bold=True))
        known = "–" if math.isnan(self.force) else number(self.force, ".1f")
        below = QRectF(box.left() - 10, bar.bottom() + 4, box.width() + 16, 24)
        painter.drawText(below, Qt.AlignmentFlag.AlignCenter, self.tr("{force} N").format(force=known))


class ErrorView(QWidget):
    """The mean error of accepted touches, the last one as an arrow seen along z, and all of them as a line."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.title = self.tr("Mean error")
        self.mean_mm: float | None = None
        self.sd_mm: float | None = None
        self.detail = ""
        self.last_mm: tuple[float, float, float] | None = None
        self.errors_mm: tuple[float, ...] = ()
        self.limit_mm = 2.0
        self.setMinimumHeight(150)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def sizeHint(self) -> QSize:
        """Return the size that it likes."""
        return QSize(340, 156)

    def show_errors(
        self,
        mean_mm: float | None,
        sd_mm: float | None,
        errors_mm: Sequence[float] = (),
        last_mm: tuple[float, float, float] | None = None,
        limit_mm: float = 2.0,
        detail: str = "",
    ) -> None:
        """Show other errors, mm; `last_mm` is that of the newest touch in S, `limit_mm` the largest that may be."""
        given = (mean_mm, sd_mm, tuple(errors_mm), last_mm, limit_mm, detail)
        if given == (self.mean_mm, self.sd_mm, self.errors_mm, self.last_mm, self.limit_mm, self.detail):
            return
        self.mean_mm, self.sd_mm, self.errors_mm, self.last_mm, self.limit_mm, self.detail = given
        self.setAccessibleName(f"{self.title}: {self.number}. {detail}")
        self.update()

    @property
    def number(self) -> str:
        """The mean with its scatter."""
        if self.mean_mm is None:
            return "–"
        spread = "" if self.sd_mm is None else filled(" ± {:.2f}", self.sd_mm)
        return self.tr("{mean}{spread} mm").format(mean=number(self.mean_mm, ".2f"), spread=spread)

    # ---- drawing -----------------------------------------------------------------------------

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002
        """Draw it."""
        with smooth_painter(self) as painter:
            theme, box = colours(is_dark()), QRectF(self.rect())
            left = box.width() - _ARROW - 8
            painter.setPen(QColor(theme.muted))
            painter.setFont(sized(self.font(), 10.5))
            painter.drawText(QRectF(0, 0, left, 20), Qt.AlignmentFlag.AlignVCenter, self.title)
            painter.setPen(QColor(theme.text))
            points = 24.0
            painter.setFont(sized(self.font(), points, bold=True))
            while points > 14 and painter.fontMetrics().horizontalAdvance(self.number) > left:
                points -= 1
                painter.setFont(sized(self.font(), points, bold=True))
            painter.drawText(QRectF(0, 20, left, 42), Qt.AlignmentFlag.AlignVCenter, self.number)
            painter.setPen(QColor(theme.muted))
            painter.setFont(sized(self.font(), 10))
            painter.drawText(QRectF(0, 62, left, 36), Qt.TextFlag.TextWordWrap, self.detail)
            self._arrow(painter, QRectF(box.right() - _ARROW, 4, _ARROW - 2, _ARROW - 2))
            self._trend(painter, QRectF(0, 104, box.width() - 1, box.height() - 110))

    def _arrow(self, painter: QPainter, box: QRectF) -> None:
        """Draw the newest error in x and y, in rings of the limit and half of it."""
        theme, centre, radius = colours(is_dark()), box.center(), box.width() / 2 - 12
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for share in (0.5, 1.0):
            painter.setPen(QPen(QColor(theme.line), 1))
            painter.drawEllipse(centre, share * radius, share * radius)
        painter.setFont(sized(self.font(), 9))
        painter.setPen(QColor(theme.muted))
        painter.drawText(QRectF(box.right() - 11, centre.y() - 9, 12, 18), Qt.AlignmentFlag.AlignCenter, "x")
        painter.drawText(QRectF(centre.x() - 6, box.top() - 4, 12, 16), Qt.AlignmentFlag.AlignCenter, "y")
        if self.last_mm is None:
            return
        x, y, z = self.last_mm
        over = math.hypot(x, y, z) > self.limit_mm
        scale = radius / self.limit_mm * min(1.0, self.limit_mm / max(math.hypot(x, y), 1e-9))
        tip = QPointF(centre.x() + scale * x, centre.y() - scale * y)
        colour = QColor(theme.bad if over else theme.accent)
        painter.setPen(QPen(colour, 2.5))
        painter.drawLine(centre, tip)
        painter.setBrush(colour)
        angle = math.atan2(centre.y() - tip.y(), tip.x() - centre.x())
        if math.hypot(tip.x() - centre.x(), tip.y() - centre.y()) > 3:
            back = [
                QPointF(tip.x() - 8 * math.cos(angle + turn), tip.y() + 8 * math.sin(angle + turn))
                for turn in (0.4, -0.4)
            ]
            painter.drawPolygon(QPolygonF([tip, *back]))
        painter.setPen(QColor(theme.muted))
        painter.drawText(
            QRectF(box.left() - 16, box.bottom() - 2, box.width() + 20, 16),
            Qt.AlignmentFlag.AlignCenter,
            self.tr("last {size} mm").format(size=number(math.hypot(x, y, z), ".2f")),
        )

    def _trend(self, painter: QPainter, box: QRectF) -> None:
        theme, shown = colours(is_dark()), self.errors_mm[-_NEWEST_ERRORS:]
        top = 1.25 * max((*shown, self.limit_mm))
        limit = box.bottom() - box.height() * self.limit_mm / top
        painter.setPen(QPen(QColor(theme.line), 1))
        painter.drawLine(box.bottomLeft(), box.bottomRight())
        painter.setPen(QPen(QColor(theme.warning), 1, Qt.PenStyle.DashLine))
        painter.drawLine(QPointF(box.left(), limit), QPointF(box.right(), limit))
        if not shown:
            return
        step = box.width() / max(len(shown), 8)
        places = [
            QPointF(box.left() + (number + 0.5) * step, box.bottom() - box.height() * error / top)
            for number, error in enumerate(shown)
        ]
        painter.setPen(QPen(QColor(theme.accent), 1.5))
        painter.drawPolyline(QPolygonF(places))
        painter.setBrush(QColor(theme.accent))
        for place in places:
            painter.drawEllipse(place, 2.5, 2.5)
