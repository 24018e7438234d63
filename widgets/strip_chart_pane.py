"""One pane of the strip charts: up to three lines over time, named, in different strokes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPoint, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPaintEvent
from PySide6.QtWidgets import QGraphicsItem, QGraphicsView, QLabel, QSizePolicy, QWidget

from contactbench.widgets.controls import column
from contactbench.widgets.messages import filled, number
from contactbench.widgets.plot_frame import PlotFrame
from contactbench.widgets.theme import colours, is_dark

_STROKES = (Qt.PenStyle.SolidLine, Qt.PenStyle.DashLine, Qt.PenStyle.DotLine)
_SIGNS = ("—", "╌", "┈")  # as the strokes look
_AXIS_PX, _AXIS_PT = 46, 9
_GRID = 38  # of 255: seen, and behind the lines
_LEAST_BINS = 50
_NARROW_PX = 280


@dataclass(frozen=True)
class Curves:
    """What a pane shows."""

    title: str
    names: tuple[str, ...]  # Of the lines
    unit: str
    digits: int  # Behind the point
    least: float  # The smallest span of the axis, in the unit
    first_colour: int = 0  # Of the theme's series


class Pane(QWidget):
    """Lines over time. Times are shown as seconds before the newest one."""

    pointed = Signal(object)  # s after (before: negative) the newest sample, or None
    taken = Signal()  # the mouse zoomed or moved the time
    stretched = Signal(float, float)  # shown time, s relative to the newest sample

    def __init__(self, curves: Curves, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.curves = curves
        self.setAccessibleName(curves.title)
        self._legend = Legend()
        self._plot: Any = PlotFrame()
        self._plot.setMinimumHeight(48)
        # Left to itself, each plot has the whole window flushed for its change alone, and where a 3D view lies in the
        # window a flush puts all of it together anew: four for four panes. See _repaint.
        self._plot.setViewportUpdateMode(QGraphicsView.ViewportUpdateMode.NoViewportUpdate)
        self._unit = QLabel(self._plot)
        self._unit.setProperty("role", "muted")
        self._unit.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._unit.move(_AXIS_PX + 4, 0)
        self._view: Any = self._plot.box
        self._view.setMouseEnabled(x=True, y=False)
        self._plot.left.setWidth(_AXIS_PX)
        for axis in (self._plot.left, self._plot.bottom):
            axis.setGrid(_GRID)
            # kept as a picture: drawing grid and numbers anew takes longer than the lines
            axis.setCacheMode(QGraphicsItem.CacheMode.DeviceCoordinateCache)
        self._lines: list[Any] = [_Line(connect="finite") for _ in curves.names]
        for line in self._lines:
            self._view.addItem(line, ignoreBounds=True)
        self._cursor: Any = pg.InfiniteLine(angle=90, movable=False)
        self._cursor.setVisible(False)
        self._view.addItem(self._cursor, ignoreBounds=True)
        self._low_high: tuple[float, float] | None = None
        self._range: tuple[float, float, float, float] | None = None
        self._times: NDArray[np.float64] = np.empty(0)
        self._values: NDArray[np.float64] = np.empty((0, len(curves.names)))
        self._moment: float | None = None
        column(self, self._legend, (self._plot, 1), space=0)
        self._view.sigRangeChangedManually.connect(self._moved)
        self._plot.scene().sigMouseMoved.connect(self._point)
        self._plot.viewport().installEventFilter(self)
        self.dress()

    # ---- looks -------------------------------------------------------------------------------------

    def changeEvent(self, event: QEvent) -> None:
        """Give the unit the room that it needs in another font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.StyleChange:
            self._unit.adjustSize()

    def dress(self) -> None:
        """Take the colours of the running application's theme."""
        chosen = colours(is_dark())
        self._plot.setBackground(chosen.panel)
        self._unit.setStyleSheet(f"background: {chosen.panel};")
        font = QFont(self.font())
        font.setPointSize(_AXIS_PT)
        for axis in (self._plot.left, self._plot.bottom):
            axis.setPen(pg.mkPen(chosen.line))
            axis.setTextPen(pg.mkPen(chosen.muted))
            axis.setTickFont(font)
        for line, colour, stroke in zip(self._lines, self._colours(), _STROKES, strict=False):
            line.setPen(pg.mkPen(colour, width=1, style=stroke))
        self._cursor.setPen(pg.mkPen(QColor(chosen.muted), width=1))
        self._write()

    def _colours(self) -> Sequence[str]:
        series, first = colours(is_dark()).series, self.curves.first_colour
        return [series[(first + index) % len(series)] for index in range(len(self.curves.names))]

    # ---- what is shown -----------------------------------------------------------------------------

    def show_data(
        self, times: NDArray[np.float64], values: NDArray[np.float64], begin: float, end: float
    ) -> None:
        """
        Show values over time.

        Parameters
        ----------
        times : (n,)
            s, relative to the newest sample.
        values : (n, c)
        begin, end : float
            What to show, s.
        """
        self._times, self._values = times, values
        drawn, points = decimate(times, values, begin, end, max(self._plot.width() - _AXIS_PX, _LEAST_BINS))
        for index, line in enumerate(self._lines):
            line.setData(drawn, points[:, index])
        self._low_high = steady_range(points, self.curves.least, self._low_high)
        shown = (begin, end, *self._low_high)
        if shown != self._range:  # asked for anew, both axes are laid out anew, also where nothing changed
            self._range = shown
            self._view.setRange(xRange=(begin, end), yRange=self._low_high, padding=0, disableAutoRange=False)
        self._write()

    def show_cursor(self, moment: float | None) -> None:
        """Read the lines at a moment, s relative to the newest sample; None: read the newest values."""
        self._moment = moment
        self._cursor.setVisible(moment is not None)
        if moment is not None:
            self._cursor.setValue(moment)
        self._write()

    @property
    def read_out(self) -> str:
        """What is written above the lines, without its looks."""
        parts = [f"{name} {value}" for name, value in zip(self.curves.names, self._numbers(), strict=True)]
        when = "" if self._moment is None else filled(", {:+.2f} s", self._moment)
        return f"{self.curves.title}: {'  '.join(parts)} {self.curves.unit}{when}"

    def _numbers(self) -> list[str]:
        row = nearest(self._times, 0.0 if self._moment is None else self._moment)
        if row is None:
            return ["–"] * len(self.curves.names)
        digits = self.curves.digits - (self.width() < _NARROW_PX)
        return [number(value, f"z.{digits}f") if np.isfinite(value) else "–" for value in self._values[row]]

    def _write(self) -> None:
        entries = [
            LegendEntry(*parts)
            for parts in zip(_SIGNS, self.curves.names, self._colours(), self._numbers(), strict=False)
        ]
        self._legend.show_entries(entries, tight=self.width() < _NARROW_PX)
        when = "" if self._moment is None else filled("   {:+.2f} s", self._moment)
        unit = f"{self.curves.unit}{when}"
        if unit != self._unit.text():
            self._unit.setText(unit)
            self._unit.ensurePolished()
            self._unit.adjustSize()
        self._repaint()

    def _repaint(self) -> None:
        """Have the plot painted with whatever else of the window is."""
        self._plot.viewport().update()

    # ---- the mouse ---------------------------------------------------------------------------------

    def _moved(self, *_: object) -> None:
        self._range = None
        begin, end = self._view.viewRange()[0]
        self.taken.emit()
        self.stretched.emit(float(begin), float(end))

    def _point(self, place: Any) -> None:
        if self._plot.sceneBoundingRect().contains(place):
            self.pointed.emit(float(self._view.mapSceneToView(place).x()))

    def eventFilter(self, watched: Any, event: Any) -> bool:
        """Take the cursor away when the mouse leaves."""
        if event.type() == event.Type.Leave:
            self.pointed.emit(None)
        return bool(super().eventFilter(watched, event))


class _Line(pg.PlotCurveItem):  # type: ignore[misc]
    """A curve of which all that is in view is painted: asking 300 points for their bounds takes as long as painting."""

    def boundingRect(self) -> Any:
        """Return the view."""
        return self.viewRect()


# ---- fewer points to draw, with the same peaks ---------------------------------------------------


def decimate(
    times: NDArray[np.float64], values: NDArray[np.float64], begin: float, end: float, bins: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Return the smallest and largest value of each bin of time; all of them where there are few.

    Bins lie at fixed times, not at those of the view: a chart that scrolls does not shimmer.

    Parameters
    ----------
    times : (n,)
        s, ascending.
    values : (n, c)
        NaN for what is missing.
    begin, end : float
        What is in view, s.
    bins : int
        About as many as pixels.

    Returns
    -------
    times : (k,)
    values : (k, c)
        k is at most about twice the number of bins. A bin without any number is NaN.
    """
    first, last = np.searchsorted(times, [begin, end], side="left")
    first, last = max(int(first) - 1, 0), min(int(last) + 1, len(times))  # lines go to the edge
    times, values = times[first:last], values[first:last]
    if len(times) <= 2 * bins or end <= begin:
        return times, values
    width = (end - begin) / bins
    places = np.floor(times / width)
    starts = np.flatnonzero(np.diff(places, prepend=places[0] - 1))
    middles = (places[starts] + 0.5) * width
    # fmin and fmax leave NaN out: one missing sample must not hide its bin.
    low = np.fmin.reduceat(values, starts, axis=0)
    high = np.fmax.reduceat(values, starts, axis=0)
    drawn = np.empty((2 * len(starts), values.shape[1]))
    drawn[0::2], drawn[1::2] = low, high
    return np.repeat(middles, 2), drawn


def nearest(times: NDArray[np.float64], moment: float) -> int | None:
    """Return the index of the time nearest to a moment; None: there are none."""
    if not len(times):
        return None
    after = min(int(np.searchsorted(times, moment)), len(times) - 1)
    before = max(after - 1, 0)
    return before if abs(times[before] - moment) < abs(times[after] - moment) else after


def steady_range(
    values: NDArray[np.float64], least: float, before: tuple[float, float] | None
) -> tuple[float, float]:
    """
    Return what to show of values, so that it changes seldom.

    Parameters
    ----------
    values : array
    least : float
        The smallest span, in the values' unit: noise does not fill the chart.
    before : (low, high), optional
        What is shown now; kept while it holds the values and is not far too wide.
    """
    there = values[np.isfinite(values)]
    if not there.size:
        return before or (-least / 2, least / 2)
    low, high = float(there.min()), float(there.max())
    span = max(high - low, least)
    if before is not None:
        shown = before[1] - before[0]
        if before[0] <= low and high <= before[1] and shown <= 3 * span:
            return before
    middle, half = (low + high) / 2, 0.625 * span
    return middle - half, middle + half


# ---- what is written above the lines of a strip chart --------------------------------------------


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
