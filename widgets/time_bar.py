"""What time is looked at: a window of it, and a playhead that runs through the window at a chosen speed."""

import time

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QFocusEvent, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QPushButton, QSizePolicy, QWidget

from contactbench.widgets.controls import ElidedLabel, FoldRow, choice, column
from contactbench.widgets.messages import filled
from contactbench.widgets.theme import colours, icon, is_dark, smooth_painter

SPEEDS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
WINDOWS = (0.5, 1.0, 2.0, 5.0, 10.0, 30.0)  # s
_TICK = 33  # ms


class TimeBar(QWidget):
    """
    A bar of time with a window, and what plays it.

    At rest the whole window counts. While the playhead is shown, what counts ends at it: all since the window's
    start, or only the last seconds.
    """

    changed = Signal()  # what is looked at

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.slider = RangeSlider(self, playhead=True)
        self.slider.setAccessibleName(self.tr("Time window"))
        self.slider.setToolTip(
            self.tr(
                "Time in seconds. Drag the handles or the bar between them; above the line: current"
                " time.\nKeys: left and right; Space switches handles."
            )
        )
        self.play = QPushButton(self)
        self.play.setProperty("primary", "true")
        self.whole = QPushButton(self.tr("Show all"), self)
        self.whole.setIcon(icon("stop"))
        self.whole.setToolTip(self.tr("Stop and show the whole time window."))
        speeds = ((filled(self.tr("{speed:g}x"), speed=each), each) for each in SPEEDS)
        self.speed = choice(speeds, self.tr("Speed"), tip=self.tr("Recorded seconds per second of playback."))
        self.speed.setCurrentIndex(SPEEDS.index(1.0))
        spans = ((filled(self.tr("last {seconds:g} s"), seconds=each), each) for each in WINDOWS)
        tip = self.tr("During playback: show all contacts from the start, or only the last seconds.")
        name = self.tr("Contacts shown during playback")
        self.last = choice(((self.tr("keep touches"), None), *spans), name, tip=tip)
        self.label = ElidedLabel()
        self._timer = QTimer(self, interval=_TICK)
        self._before = 0.0
        self._lay_out()
        self._connect()
        self._show()

    def _lay_out(self) -> None:
        for each in (self.play, self.whole, self.speed, self.last):
            each.setMinimumHeight(36)
        self.play.setMinimumWidth(112)
        row = FoldRow()
        for each in (self.play, self.whole, self.speed, self.last):
            row.add(each)
        row.add(self.label, stretch=1)
        column(self, self.slider, row, margins=(12, 6, 12, 8), space=-1)

    def _connect(self) -> None:
        self.slider.changed.connect(lambda _low, _high: self._told())
        self.slider.moved.connect(lambda _at: self._told())
        self.play.clicked.connect(self.toggle)
        self.whole.clicked.connect(self.show_all)
        self.last.currentIndexChanged.connect(lambda _index: self._told())
        self._timer.timeout.connect(self._tick)

    # ---- what is looked at -------------------------------------------------------------------------

    def set_duration(self, seconds: float, profile: NDArray[np.float64] | None = None) -> None:
        """Begin again with another length, s, and how much there is at each part of it."""
        self.stop()
        self.slider.set_limits(0.0, seconds)
        self.slider.set_profile(profile)
        self._show()

    def chosen(self) -> tuple[float | None, float | None]:
        """Return start and end of what counts now, s; None: no limit."""
        low, high = self.slider.values()
        at, seconds = self.slider.playhead(), self.seconds()
        if at is None:
            return (None, None) if self.slider.whole() else (low, high)
        return (low if seconds is None else max(low, at - seconds)), at

    def played_range(self) -> tuple[float | None, float | None]:
        """Return start and end of what is played, s; None: no limit."""
        return (None, None) if self.slider.whole() else self.slider.values()

    def seconds(self) -> float | None:
        """Return how long what was touched is shown while playing, s; None: it stays."""
        chosen = self.last.currentData()
        return None if chosen is None else float(chosen)

    def speed_value(self) -> float:
        """Return the speed."""
        return float(self.speed.currentData())

    # ---- playing -----------------------------------------------------------------------------------

    def playing(self) -> bool:
        """Whether it plays."""
        return self._timer.isActive()

    def toggle(self) -> None:
        """Play, or pause."""
        if self.playing():
            self.stop()
            return
        low, high = self.slider.values()
        at = self.slider.playhead()
        if at is None or at >= high:
            self.slider.set_playhead(low)
        self._before = time.monotonic()
        self._timer.start()
        self._told()

    def stop(self) -> None:
        """Pause."""
        if self.playing():
            self._timer.stop()
            self._show()

    def show_all(self) -> None:
        """Stop, and look at the whole window."""
        self.stop()
        self.slider.set_playhead(None)
        self._told()

    def _tick(self) -> None:
        now = time.monotonic()
        passed, self._before = (now - self._before) * self.speed_value(), now
        at = (self.slider.playhead() or 0.0) + passed
        self.slider.set_playhead(at)
        if at >= self.slider.values()[1]:
            self.stop()
        self._told()

    def _told(self) -> None:
        self._show()
        self.changed.emit()

    def changeEvent(self, event: QEvent) -> None:
        """Say the time only where there is some."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.EnabledChange:
            self._show()

    def _show(self) -> None:
        self.play.setText(self.tr("Pause") if self.playing() else self.tr("Play"))
        self.play.setIcon(icon("pause" if self.playing() else "play", "panel"))
        self.whole.setEnabled(self.slider.playhead() is not None)
        start, end = self.chosen()
        most = self.slider.limits()[1]
        low, high = (0.0 if start is None else start), (most if end is None else end)
        words = self.tr("{start:.1f} to {end:.1f} s of {whole:.1f} s")
        self.label.setText(filled(words, start=low, end=high, whole=most) if self.isEnabled() else "")


# ---- A slider with two handles -------------------------------------------------------------------


_HANDLE = 9.0  # px: half the width of a handle
_GRAB = 16.0  # px: a gloved hand on a touch pad is no finer
_KEY_STEPS = 200  # of the keyboard, from end to end


class RangeSlider(QWidget):
    """
    Choose a part of a range of numbers.

    Drag a handle, or what is between them. Keys: left and right move the handle that is marked, Space marks the
    other one, Home and End go to its limits.

    Parameters
    ----------
    playhead : bool
        With a third mark, above the line, that can be dragged within the range.
    """

    changed = Signal(float, float)  # by hand
    moved = Signal(float)  # the playhead, by hand

    def __init__(self, parent: QWidget | None = None, *, playhead: bool = False) -> None:
        super().__init__(parent)
        self._least, self._most = 0.0, 1.0
        self._low, self._high = 0.0, 1.0
        self._with_playhead, self._playhead = playhead, None
        self._profile: NDArray[np.float64] | None = None
        self._grabbed, self._active, self._offset = "", "low", 0.0
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    _playhead: float | None

    # ---- values ------------------------------------------------------------------------------------

    def limits(self) -> tuple[float, float]:
        """Return the least and the largest value there is."""
        return self._least, self._most

    def set_limits(self, least: float, most: float) -> None:
        """Give other limits; both handles go to them."""
        self._least, self._most = least, max(most, least)
        self._low, self._high, self._playhead = self._least, self._most, None
        self.update()

    def values(self) -> tuple[float, float]:
        """Return what is chosen."""
        return self._low, self._high

    def set_values(self, low: float, high: float) -> None:
        """Choose; tells nobody."""
        low, high = (min(max(each, self._least), self._most) for each in (low, high))
        self._low, self._high = min(low, high), max(low, high)
        self.update()

    def whole(self) -> bool:
        """Whether everything is chosen."""
        return self._low <= self._least and self._high >= self._most

    def playhead(self) -> float | None:
        """Where the playhead is; None: it is not shown."""
        return self._playhead

    def set_playhead(self, value: float | None) -> None:
        """Put the playhead somewhere; tells nobody."""
        self._playhead = None if value is None else min(max(value, self._low), self._high)
        self.update()

    def set_profile(self, heights: NDArray[np.float64] | None) -> None:
        """Show how much there is at each of n even parts of the range; None: nothing."""
        top = 0.0 if heights is None or not len(heights) else float(np.max(heights))
        self._profile = None if heights is None or top <= 0 else np.asarray(heights) / top
        self.update()

    # ---- looks -------------------------------------------------------------------------------------

    def sizeHint(self) -> QSize:
        """Return a comfortable size."""
        return QSize(260, 52 if self._with_playhead else 40)

    def minimumSizeHint(self) -> QSize:
        """Return the least size."""
        return QSize(120, 52 if self._with_playhead else 40)

    def place(self, value: float) -> float:
        """Return where a value is, px from the left."""
        wide = self.width() - 2 * _HANDLE - 2
        return _HANDLE + 1 + wide * (value - self._least) / ((self._most - self._least) or 1.0)

    def _value(self, x: float) -> float:
        wide = max(self.width() - 2 * _HANDLE - 2, 1.0)
        share = min(max((x - _HANDLE - 1) / wide, 0.0), 1.0)
        return self._least + share * (self._most - self._least)

    def _line(self) -> float:
        return self.height() - 17.0

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it."""
        theme, painter = colours(is_dark()), smooth_painter(self)
        on = self.isEnabled()
        accent, line = QColor(theme.accent if on else theme.stale), QColor(theme.line)
        left, right, y = self.place(self._low), self.place(self._high), self._line()
        self._paint_profile(painter, QColor(theme.muted), y)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(line)
        first, last = self.place(self._least), self.place(self._most)
        painter.drawRoundedRect(QRectF(first, y - 3, last - first, 6), 3, 3)
        painter.setBrush(accent)
        painter.drawRect(QRectF(left, y - 3, right - left, 6))
        for name, x in (("low", left), ("high", right)):
            marked = self.hasFocus() and self._active == name
            painter.setBrush(accent if marked else QColor(theme.panel))
            painter.setPen(QPen(accent, 3 if marked else 2))
            painter.drawRoundedRect(QRectF(x - _HANDLE + 2, y - 12, 2 * _HANDLE - 4, 24), 4, 4)
        if self._playhead is not None:
            self._paint_playhead(painter, QColor(theme.text), self.place(self._playhead))
        painter.end()

    def _paint_profile(self, painter: QPainter, colour: QColor, y: float) -> None:
        if self._profile is None:
            return
        colour.setAlpha(90)
        first, wide = self.place(self._least), self.place(self._most) - self.place(self._least)
        step, high = wide / len(self._profile), y - 8
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        for number, share in enumerate(self._profile.tolist()):
            if share > 0:
                tall = max(2.0, high * share)
                painter.drawRect(QRectF(first + number * step, y - 4 - tall, max(step, 1.0), tall))

    def _paint_playhead(self, painter: QPainter, colour: QColor, x: float) -> None:
        painter.setPen(QPen(colour, 2))
        painter.drawLine(QPointF(x, 8), QPointF(x, self.height() - 4))
        painter.setBrush(colour)
        painter.drawPolygon(QPolygonF([QPointF(x - 7, 1), QPointF(x + 7, 1), QPointF(x, 11)]))

    # ---- mouse and keys ----------------------------------------------------------------------------

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take what is under the mouse."""
        if event.button() != Qt.MouseButton.LeftButton:
            return
        at = event.position()
        self._grabbed = self._under(at.x(), at.y())
        if self._grabbed in ("low", "high"):
            self._active = self._grabbed
        self._offset = self._value(at.x()) - self._low
        if self._grabbed == "playhead":
            self._drag(at.x())
        self.update()

    def _under(self, x: float, y: float) -> str:
        if self._with_playhead and y < self._line() - 13:
            return "playhead"
        left, right = self.place(self._low), self.place(self._high)
        distances = {"low": abs(x - left), "high": abs(x - right)}
        nearest = min(distances, key=distances.__getitem__)
        if distances["low"] == distances["high"] or (left == right and distances[nearest] <= _GRAB):
            nearest = "low" if x < left or (x == left and self._high >= self._most) else "high"
        if distances[nearest] <= _GRAB or not left < x < right:
            return nearest
        return "band"

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move what was taken."""
        if self._grabbed:
            self._drag(event.position().x())

    def mouseReleaseEvent(self, _event: QMouseEvent) -> None:
        """Let it go."""
        self._grabbed = ""

    def _drag(self, x: float) -> None:
        value = self._value(x)
        if self._grabbed == "playhead":
            self.set_playhead(value)
            self.moved.emit(self._playhead or 0.0)
        elif self._grabbed == "band":
            wide = self._high - self._low
            low = min(max(value - self._offset, self._least), self._most - wide)
            self._choose(low, low + wide)
        else:
            self._move_active(value)

    def _move_active(self, value: float) -> None:
        value = min(max(value, self._least), self._most)
        if self._active == "low":
            self._choose(min(value, self._high), self._high)
        else:
            self._choose(self._low, max(value, self._low))

    def _choose(self, low: float, high: float) -> None:
        if (low, high) == (self._low, self._high):
            return
        self._low, self._high = low, high
        if self._playhead is not None:
            self._playhead = min(max(self._playhead, low), high)
        self.update()
        self.changed.emit(low, high)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move the marked handle."""
        step = (self._most - self._least) / _KEY_STEPS
        now = self._low if self._active == "low" else self._high
        key = event.key()
        if key in (Qt.Key.Key_Left, Qt.Key.Key_Down):
            self._move_active(now - step)
        elif key in (Qt.Key.Key_Right, Qt.Key.Key_Up):
            self._move_active(now + step)
        elif key == Qt.Key.Key_Home:
            self._move_active(self._least)
        elif key == Qt.Key.Key_End:
            self._move_active(self._most)
        elif key == Qt.Key.Key_Space:
            self._active = "high" if self._active == "low" else "low"
            self.update()
        else:
            super().keyPressEvent(event)

    def focusInEvent(self, event: QFocusEvent) -> None:
        """Show which handle the keys move."""
        super().focusInEvent(event)
        self.update()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Show that none does."""
        super().focusOutEvent(event)
        self.update()
