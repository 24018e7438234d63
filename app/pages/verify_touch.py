"""The touches of the Verify page: the state, large; the error; what to do next."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from contactbench.app.pages.verify_markers import narrow
from contactbench.widgets.error_view import ErrorView
from contactbench.widgets.icons import icon
from contactbench.widgets.phrases import said
from contactbench.widgets.touch_state import TouchState

_TALL = 36


class TouchPanel(QWidget):
    """Shows touches as they happen; does nothing by itself."""

    start_wanted = Signal()
    finish_wanted = Signal()
    discard_wanted = Signal()
    skip_wanted = Signal()
    repeat_wanted = Signal()
    touch_wanted = Signal()
    touch_all_toggled = Signal(bool)
    muted = Signal(bool)
    heat_toggled = Signal(bool)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 8, 0, 0)
        column.setSpacing(8)
        self.state = TouchState()
        column.addWidget(self.state)
        self.next = self._label("")
        column.addWidget(self.next)
        self.notice = self._label("bad")
        self.notice.hide()
        column.addWidget(self.notice)
        column.addLayout(self._main_buttons())
        self.error = ErrorView()
        column.addWidget(self.error)
        column.addLayout(self._other_buttons())
        column.addWidget(self._virtual())
        column.addLayout(self._switches())
        column.addStretch(1)

    def _label(self, role: str) -> QLabel:
        label = QLabel()
        label.setWordWrap(True)
        label.setTextFormat(Qt.TextFormat.PlainText)
        if role:
            label.setProperty("role", role)
        return label

    def _main_buttons(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(6)
        self.start = self._button(self.tr("Start touching"), "play", self.start_wanted)
        self.start.setProperty("primary", True)
        self.finish = self._button(self.tr("Finish"), "check", self.finish_wanted)
        self.finish.setProperty("primary", True)
        for each, name in ((self.start, "play"), (self.finish, "check")):
            each.setIcon(icon(name, "panel"))
        self.finish.setToolTip(self.tr("Keep the recording, judge it, and make the report"))
        self.discard = self._button(self.tr("Throw away"), "cross", self.discard_wanted)
        self.discard.setToolTip(self.tr("End without a verdict; the touches are not kept"))
        row.addWidget(self.start, 1)
        row.addWidget(self.finish, 1)
        row.addWidget(self.discard, 1)
        return row

    def _other_buttons(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setSpacing(6)
        self.repeat = self._button(self.tr("Touch again"), "redo", self.repeat_wanted)
        self.repeat.setToolTip(
            self.tr("The marker that is selected in the table, or else the last one; all its touches count")
        )
        self.skip = self._button(self.tr("Leave it out"), "remove", self.skip_wanted)
        self.skip.setToolTip(
            self.tr("Go on with the marker after the next one; you say why, and the report repeats it")
        )
        grid.addWidget(self.repeat, 0, 0)
        grid.addWidget(self.skip, 0, 1)
        return grid

    def _virtual(self) -> QWidget:
        self.virtual = QWidget()
        row = QHBoxLayout(self.virtual)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(6)
        self.touch = self._button(self.tr("Touch it for me"), "play", self.touch_wanted)
        self.touch.setToolTip(self.tr("The virtual bench presses the next marker with a tip"))
        self.touch_all = QPushButton(icon("play"), self.tr("Touch all"))
        self.touch_all.setCheckable(True)
        narrow(self.touch_all, 110)
        self.touch_all.setMinimumHeight(_TALL)
        self.touch_all.setToolTip(self.tr("The virtual bench presses one marker after the other"))
        self.touch_all.toggled.connect(self.touch_all_toggled)
        row.addWidget(self.touch, 1)
        row.addWidget(self.touch_all, 1)
        return self.virtual

    def _switches(self) -> QHBoxLayout:
        row = QHBoxLayout()
        self.heat = QCheckBox(self.tr("Heat map of contacts"))
        self.heat.setToolTip(self.tr("Colour the probe by where it was touched, in contacts per mm²"))
        self.heat.setMinimumHeight(_TALL)
        self.heat.toggled.connect(self.heat_toggled)
        row.addWidget(self.heat, 1)
        self.mute = QToolButton()
        self.mute.setCheckable(True)
        self.mute.setIcon(icon("sound"))
        self.mute.setMinimumSize(_TALL, _TALL)
        self.mute.setAccessibleName(self.tr("Mute the tones"))
        self.mute.setToolTip(self.tr("A tone for each state; press to mute them"))
        self.mute.toggled.connect(self._muted)
        row.addWidget(self.mute)
        return row

    def _button(self, text: str, name: str, signal: object) -> QPushButton:
        button = QPushButton(icon(name), text)
        button.setMinimumHeight(_TALL)
        narrow(button, 110)
        button.clicked.connect(lambda _=False: signal.emit())  # type: ignore[attr-defined]
        return button

    def _muted(self, muted: bool) -> None:
        self.mute.setIcon(icon("mute" if muted else "sound"))
        self.mute.setAccessibleName(self.tr("Tones are muted") if muted else self.tr("Mute the tones"))
        self.muted.emit(muted)

    def say(self, text: str) -> None:
        """Show what is in the way; empty: nothing."""
        text = said(text)
        if text != self.notice.text():
            self.notice.setText(text)
        self.notice.setVisible(bool(text))

    def allow(self, *, ready: bool, going_on: bool, virtual: bool, busy: bool) -> None:
        """Show the buttons that are of use now."""
        self.start.setVisible(not going_on)
        self.start.setEnabled(ready and not busy)
        self.finish.setVisible(going_on)
        self.discard.setVisible(going_on)
        for each in (self.finish, self.discard, self.repeat, self.skip, self.touch, self.touch_all):
            each.setEnabled(going_on and not busy)
        self.virtual.setVisible(virtual)
