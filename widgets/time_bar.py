"""What time is looked at: a window of it, and a playhead that runs through the window at a chosen speed."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QTimer, Signal
from PySide6.QtWidgets import QComboBox, QPushButton, QVBoxLayout, QWidget

from contactbench.widgets.controls import ElidedLabel, FoldRow
from contactbench.widgets.numbers import filled
from contactbench.widgets.range_slider import RangeSlider
from contactbench.widgets.theme import icon

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

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
        self.speed, self.last = QComboBox(self), QComboBox(self)
        for each in SPEEDS:
            self.speed.addItem(filled(self.tr("{speed:g}x"), speed=each), each)
        self.speed.setCurrentIndex(SPEEDS.index(1.0))
        self.speed.setAccessibleName(self.tr("Speed"))
        self.speed.setToolTip(self.tr("Recorded seconds per second of playback."))
        self.last.addItem(self.tr("keep touches"), None)
        for seconds in WINDOWS:
            self.last.addItem(filled(self.tr("last {seconds:g} s"), seconds=seconds), seconds)
        self.last.setAccessibleName(self.tr("Contacts shown during playback"))
        self.last.setToolTip(
            self.tr("During playback: show all contacts from the start, or only the last seconds.")
        )
        self.label = ElidedLabel()
        self._timer = QTimer(self)
        self._timer.setInterval(_TICK)
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
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 6, 12, 8)
        column.addWidget(self.slider)
        column.addLayout(row)

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
        self.label.setText(
            ""
            if not self.isEnabled()
            else filled(
                self.tr("{start:.1f} to {end:.1f} s of {whole:.1f} s"), start=low, end=high, whole=most
            )
        )
