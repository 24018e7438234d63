"""How far contacts are off: as a number, as an arrow, and how it went."""

import math
from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from contactbench.widgets.numbers import filled, number
from contactbench.widgets.theme import colours, is_dark, sized, smooth_painter

_ARROW = 92
_NEWEST_ERRORS = 40


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
