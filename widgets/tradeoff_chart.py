"""The chart on which one chooses how many facets to keep: contact error against facets or time of a solve."""

import math
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import QEvent, QPointF, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QComboBox, QLabel, QWidget

from contactbench.pipeline.workbench.probe import Trade, TradePoint
from contactbench.widgets.controls import beside, called, column, plain_label
from contactbench.widgets.messages import filled, number
from contactbench.widgets.plot_frame import PlotFrame
from contactbench.widgets.theme import colours, is_dark

# An error of nothing has no place on a logarithmic axis.
_LEAST_MM, _LEAST_US = 1e-3, 1e-3
_NEAR_PX = 30.0
_MOST_TICKS = 5
_POINT, _KNEE = 11, 17  # sizes of symbols, px
_KEY_STEPS = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1, Qt.Key.Key_Down: -1, Qt.Key.Key_Up: 1}


class TradeoffChart(QWidget):
    """
    Points of a `Trade`, of which one is chosen by a click or by the arrow keys.

    It changes nothing itself: `chosen` says what is asked for, `choose` shows it.

    Attributes
    ----------
    facets : int
        Of the choice; 0: none.
    """

    chosen = Signal(int)  # facets

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._trade: Trade | None = None
        self._dark: bool | None = None
        self.facets = 0
        narrow = QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        self.across = QComboBox(sizeAdjustPolicy=narrow, minimumContentsLength=8)
        self.across.addItems([self.tr("facets"), self.tr("solve time, µs"), self.tr("plain loop time, µs")])
        called(self.across, self.tr("Horizontal axis"), self.tr("Horizontal axis: facets, or µs per solve"))
        self.across.currentIndexChanged.connect(self._draw)
        self._plot: Any = None  # made for the first trade: it takes as long as all the rest of a panel
        self._words = QLabel(wordWrap=True)
        label = plain_label(self.tr("Error, mm, against"), buddy=self.across)
        label.setToolTip(self.tr("95th percentile of the contact shift relative to the full mesh, mm"))
        self._box = column(self, beside(None, label, (self.across, 1)), self._words, space=-1)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(self.tr("Contact error against facet count"))
        self._say()

    def _make_plot(self) -> None:
        self._plot = plot = PlotFrame(self)
        plot.setFixedHeight(210)
        plot.setMinimumWidth(180)
        plot.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        plot.box.setMouseEnabled(x=False, y=False)  # the wheel scrolls the page
        plot.scene().sigMouseClicked.connect(self._clicked)
        # Made once and moved: making them takes longer than the eye forgives.
        self._curve = pg.PlotCurveItem()
        self._dots = pg.ScatterPlotItem(size=_POINT, symbol="o")
        self._allowed = pg.InfiniteLine(
            angle=0, label=" ", labelOpts={"position": 0.98, "anchors": [(1, 1), (1, 1)]}
        )
        self._between = pg.InfiniteLine(angle=90)
        self._knee = pg.ScatterPlotItem(size=_KNEE, symbol="star")
        self._ring = pg.ScatterPlotItem(size=_KNEE + 5, symbol="o", brush=pg.mkBrush(None))
        self._word = pg.TextItem(self.tr("knee"), anchor=(0.5, -0.35))
        lines = (self._curve, self._dots, self._allowed, self._between)
        for item in (*lines, self._knee, self._ring, self._word):
            plot.box.addItem(item, ignoreBounds=True)
        self._box.insertWidget(1, plot)

    # ---- what it shows ---------------------------------------------------------------------------

    def show_trade(self, trade: Trade | None, facets: int = 0) -> None:
        """Show a ladder, and what is chosen."""
        if trade is not self._trade:
            self._trade, self.facets = trade, facets
            self._draw()
        else:
            self.choose(facets)

    def choose(self, facets: int) -> None:
        """Show another choice; one that was not measured stands between the points."""
        if facets != self.facets:
            self.facets = facets
            if self._plot is not None:
                self._draw_choice()

    def where(self, facets: int) -> QPointF:
        """Return where the point of so many facets is drawn, in the coordinates of this widget."""
        point = next(each for each in self._points if each.facets == facets)
        at = self._plot.box.mapViewToScene(QPointF(*self._at(point)))
        inside = self._plot.mapFromScene(at)
        return QPointF(self._plot.viewport().mapTo(self, inside))

    @property
    def _points(self) -> tuple[TradePoint, ...]:
        return () if self._trade is None else self._trade.points

    def _across(self, point: TradePoint) -> float:
        return (float(point.facets), point.solve_us, point.loop_us)[self.across.currentIndex()]

    def _at(self, point: TradePoint) -> tuple[float, float]:
        """Return where a point lies on the logarithmic axes."""
        return (math.log10(max(self._across(point), _LEAST_US)), math.log10(max(point.error_mm, _LEAST_MM)))

    def _draw(self) -> None:
        """Show it all anew: other points, another quantity across, another theme."""
        if self._plot is None:
            if self._trade is None:
                return
            self._make_plot()
        self._dress()
        points = self._points
        knee = next((each for each in points if each.advised), None)
        self._allowed.setVisible(self._trade is not None and self._trade.allowed_mm > 0)
        for item in (self._knee, self._word):
            item.setVisible(knee is not None)
        for item in (self._curve, self._dots):
            item.setVisible(bool(points))
        if self._trade is not None and points:
            at = [self._at(each) for each in points]
            for item in (self._curve, self._dots):
                item.setData([x for x, _ in at], [y for _, y in at])
            limit = math.log10(max(self._trade.allowed_mm, _LEAST_MM))
            self._allowed.setValue(limit)
            self._allowed.label.setFormat(filled(self.tr("limit {:.2g} mm"), self._trade.allowed_mm))
            self._fit([x for x, _ in at], [*(y for _, y in at), limit])
        if knee is not None:
            x, y = self._at(knee)
            self._knee.setData([x], [y])
            self._word.setPos(x, y)
        self._draw_choice()

    def _dress(self) -> None:
        self._dark = is_dark()
        look = colours(self._dark)
        self._plot.setBackground(look.panel)
        for axis in (self._plot.bottom, self._plot.left):
            axis.setPen(look.line)
            axis.setTextPen(look.text)
        self._curve.setPen(pg.mkPen(look.muted, width=1.5))
        self._dots.setBrush(pg.mkBrush(look.panel))
        self._dots.setPen(pg.mkPen(look.accent, width=2))
        self._allowed.setPen(pg.mkPen(look.warning, width=1.5, style=Qt.PenStyle.DashLine))
        self._allowed.label.setColor(look.warning)
        self._between.setPen(pg.mkPen(look.text, width=1.5))
        self._knee.setPen(pg.mkPen(look.accent, width=2.4))
        self._knee.setBrush(pg.mkBrush(look.accent))
        self._ring.setPen(pg.mkPen(look.text, width=2.4))
        self._word.setColor(look.text)

    def _fit(self, xs: list[float], ys: list[float]) -> None:
        wide, high = max(max(xs) - min(xs), 0.3), max(max(ys) - min(ys), 0.3)
        self._plot.bottom.setTicks([_ticks(min(xs), max(xs))])
        self._plot.left.setTicks([_ticks(min(ys), max(ys))])
        self._plot.box.setRange(
            xRange=(min(xs) - 0.1 * wide, max(xs) + 0.1 * wide),
            yRange=(min(ys) - 0.1 * high, max(ys) + 0.18 * high),
            padding=0,
        )

    def _draw_choice(self) -> None:
        known = next((each for each in self._points if each.facets == self.facets), None)
        self._ring.setVisible(known is not None)
        if known is not None:
            x, y = self._at(known)
            self._ring.setData([x], [y])
        between = known is None and self.facets > 0 and bool(self._points) and self.across.currentIndex() == 0
        self._between.setVisible(between)
        if between:
            self._between.setValue(math.log10(self.facets))
        self._say()

    def _say(self) -> None:
        known = next((each for each in self._points if each.facets == self.facets), None)
        if known is None:
            words = self.tr("Choose a point with a click or the arrow keys.") if self._points else ""
        else:
            words = self.tr("{:,} facets: contacts shift by up to {:.2g} mm; one solve takes {:.2g} µs.")
            words = filled(words, known.facets, known.error_mm, known.solve_us)
        self._words.setText(words)
        self._words.setVisible(bool(words))
        self.setAccessibleDescription(words)

    # ---- how one chooses -------------------------------------------------------------------------

    def _clicked(self, event: Any) -> None:
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        box = self._plot.box
        near = [
            (math.hypot(*(box.mapViewToScene(QPointF(*self._at(each))) - event.scenePos()).toTuple()), each)
            for each in self._points
        ]
        distance, point = min(near, key=lambda pair: pair[0], default=(math.inf, None))
        if point is not None and distance <= _NEAR_PX:
            event.accept()
            self._ask(point)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Choose the next point by the arrow keys."""
        step = _KEY_STEPS.get(Qt.Key(event.key()))
        if step is None or not self._points:
            super().keyPressEvent(event)
            return
        counts = [each.facets for each in self._points]
        nearest = min(range(len(counts)), key=lambda i: abs(counts[i] - self.facets))
        self._ask(self._points[min(max(nearest + step, 0), len(counts) - 1)])

    def _ask(self, point: TradePoint) -> None:
        if point.facets != self.facets:
            self.choose(point.facets)
            self.chosen.emit(point.facets)

    def minimumSizeHint(self) -> QSize:
        """Fit into a narrow panel."""
        return QSize(200, super().minimumSizeHint().height())

    def changeEvent(self, event: QEvent) -> None:
        """Take on another theme."""
        super().changeEvent(event)
        # the palette also changes, to the same, when a panel is put into its place
        if event.type() == QEvent.Type.PaletteChange and is_dark() != self._dark:
            self._draw()


def _ticks(low: float, high: float) -> list[tuple[float, str]]:
    """Return some round numbers between two logarithms, well apart: at each the logarithm, and the number."""
    apart = max(high - low, 0.3) / _MOST_TICKS
    found: list[tuple[float, str]] = []
    for power in range(math.floor(low), math.ceil(high) + 1):
        for step in (1, 2, 5):
            value = step * 10.0**power
            at = math.log10(value)
            if low - 0.05 <= at <= high + 0.05 and (not found or at - found[-1][0] >= apart):
                found.append((at, number(value, ",.6g")))
    return found
