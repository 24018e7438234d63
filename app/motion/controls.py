"""What is run, what the controller does, in words, and what has happened."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDoubleSpinBox, QFrame, QHBoxLayout, QVBoxLayout, QWidget

from contactbench.widgets.controls import (
    PanelScroll,
    accent,
    choice,
    column,
    form,
    named,
    plain_label,
    push_button,
    row,
    sentence_label,
    set_role,
)
from contactbench.widgets.phrases import said

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.workbench.motion import MotionChange, MotionChoice

_WIDTH_PX, _BUTTON_PX, _LINES_PX = 348, 40, 40
_PERIODS_S = (20.0, 10.0, 5.0, 2.0)
_SHOWN = 6  # changes


class MotionControls(QWidget):
    """The panel on the right of the window."""

    asked_bundle = Signal(bool)  # True: that of the session
    asked_start = Signal()
    asked_stop = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.robot = choice(
            ((self.tr("Elfin3 arm"), "virtual://arm"), (self.tr("stiff mount"), "virtual://platform")),
            self.tr("Robot"),
            tip=self.tr("Both are simulated: nothing real moves."),
        )
        self.motion = choice(
            (
                (self.tr("tilts along the face"), "in-plane"),
                (self.tr("tilts across the face"), "out-of-plane"),
                (self.tr("goes up and down"), "vertical"),
                (self.tr("rests"), "none"),
            ),
            self.tr("The phantom"),
            tip=self.tr("How the soft phantom moves under the probe."),
        )
        self.period = choice(
            [(self.tr("{seconds:g} s").format(seconds=each), each) for each in _PERIODS_S],
            self.tr("There and back in"),
            tip=self.tr("Period T of the phantom's motion."),
        )
        self.period.setCurrentIndex(_PERIODS_S.index(10.0))
        self.variant = choice(
            (
                (self.tr("as in the bundle"), None),
                (self.tr("aware"), "aware"),
                (self.tr("plain"), "plain"),
            ),
            self.tr("Control"),
            tip=self.tr("Aware: how the phantom moves is estimated and led. Plain: force and place alone."),
        )
        self.size_of = QDoubleSpinBox(decimals=0, minimum=0.0, maximum=20.0, value=10.0)
        tip = self.tr("Amplitude of the phantom's motion, to either side.")
        named(self.size_of, self.tr("How far"), tip=tip)
        self.bundle, self.message = sentence_label(role="muted"), sentence_label()
        self.message.setMinimumHeight(_LINES_PX)  # the panel must not jump
        self.state, self.does = plain_label("", "title"), sentence_label()
        self.force, self.angle = plain_label("", "number"), plain_label("", "number")
        self.happened = sentence_label(role="muted")
        self.state.setAccessibleName(self.tr("What the controller does"))
        self.force.setAccessibleName(self.tr("Force"))
        self.angle.setAccessibleName(self.tr("Angle to the phantom"))
        tip = self.tr("What would be exported of the open session now.")
        self.of_session = push_button(self.tr("This session"), None, "folder", tip=tip)
        tip = self.tr("A folder or zip file that was exported.")
        self.other = push_button(self.tr("Open bundle"), None, "folder", tip=tip)
        for button in (self.of_session, self.other):
            button.setStyleSheet("padding: 4px 6px;")
        self.start = push_button(self.tr("Start"), None, "play", high=_BUTTON_PX, primary=True)
        tip = self.tr("The probe goes back and stands still (Esc).")
        self.stop = push_button(self.tr("Stop"), None, "stop", tip=tip, high=_BUTTON_PX)
        self._lay_out()
        self._connect()
        self.show_state(None)

    def _lay_out(self) -> None:
        rows = form()
        rows.setSpacing(4)
        for box in (self.robot, self.motion, self.size_of, self.period, self.variant):
            rows.addRow(box.accessibleName(), box)
        inside = QWidget()
        column(
            inside, plain_label(self.tr("Motion control"), "title"), _even(self.of_session, self.other),
            self.bundle, rows, _even(self.start, self.stop), self.message, self._card(), self.happened,
            margins=(12, 10, 12, 8),
        ).addStretch(1)  # fmt: skip
        column(self, PanelScroll(inside))
        self.setFixedWidth(_WIDTH_PX)

    def _card(self) -> QFrame:
        card = QFrame()
        card.setProperty("role", "card")
        layout = QVBoxLayout(card)
        layout.setSpacing(2)
        layout.addWidget(self.state)
        layout.addWidget(self.does)
        layout.addLayout(_even(self.force, self.angle))
        captions = (self.tr("force"), self.tr("angle to the phantom"))
        layout.addLayout(_even(*(plain_label(each, "muted") for each in captions)))
        return card

    def _connect(self) -> None:
        self.of_session.clicked.connect(lambda: self.asked_bundle.emit(True))
        self.other.clicked.connect(lambda: self.asked_bundle.emit(False))
        self.start.clicked.connect(self.asked_start)
        self.stop.clicked.connect(self.asked_stop)
        self.motion.currentIndexChanged.connect(lambda _index: self._show_size())
        self._show_size()

    def _show_size(self) -> None:
        motion = self.motion.currentData()
        self.size_of.setSuffix(self.tr(" mm") if motion == "vertical" else self.tr("°"))
        for box in (self.size_of, self.period):
            box.setEnabled(motion != "none" and self.motion.isEnabled())

    # ---- what is chosen ----------------------------------------------------------------------------

    def choice(self) -> MotionChoice:
        """Return what is chosen."""
        from contactbench.pipeline.workbench.motion import MotionChoice

        return MotionChoice(
            robot=self.robot.currentData(),
            motion=self.motion.currentData(),
            period_s=self.period.currentData(),
            size=self.size_of.value(),
            variant=self.variant.currentData(),
        )

    def set_running(self, running: bool, ready: bool) -> None:
        """Say whether something runs; if not, whether something can."""
        for each in (self.robot, self.motion, self.variant, self.of_session, self.other):
            each.setEnabled(not running)
        self._show_size()
        self.start.setEnabled(ready and not running)
        self.stop.setEnabled(running)
        accent(self.start, not running, "play")
        accent(self.stop, running, "stop")

    # ---- what is shown -----------------------------------------------------------------------------

    def say(self, text: str, bad: bool = False) -> None:
        """Show a sentence."""
        text = said(text)
        if text == self.message.text():
            return
        set_role(self.message, "bad" if bad else "")
        self.message.setText(text)

    def show_state(self, state: str | None) -> None:
        """Show what the controller does; None: nothing."""
        name, does = self._words().get(state or "", (self.tr("Not running"), ""))
        self.state.setText(name)
        self.does.setText(does)

    def show_numbers(self, force: float | None, angles: tuple[float, float] | None) -> None:
        """Show the force, N, and the angles, degrees, the larger one."""
        self.force.setText("–" if force is None else self.tr("{:z.1f} N").format(force))
        self.angle.setText("–" if angles is None else self.tr("{:.1f}°").format(max(map(abs, angles))))

    def show_changes(self, changes: Sequence[MotionChange]) -> None:
        """Show the newest changes of state, newest first."""
        names = {key: name for key, (name, _) in self._words().items()}
        lines = [
            self.tr("{time:.1f} s  {state}: {why}").format(
                time=each.time_s, state=names.get(each.state, each.state), why=said(each.reason)
            )
            for each in reversed(changes[-_SHOWN:])
        ]
        self.happened.setText("\n".join(lines))

    def _words(self) -> dict[str, tuple[str, str]]:
        return {
            "approach": (self.tr("Approaching"), self.tr("The probe goes slowly towards the phantom.")),
            "contact": (self.tr("In contact"), self.tr("The force grows; then the stiffness is felt.")),
            "track": (self.tr("Tracking"), self.tr("It keeps its force and stands upright.")),
            "hold": (self.tr("Holding"), self.tr("Nothing moves until it is sure again.")),
            "retract": (self.tr("Going back"), self.tr("The probe leaves the phantom.")),
            "safe": (self.tr("Standing still"), self.tr("It has ended; nothing moves any more.")),
        }


def _even(*widgets: QWidget) -> QHBoxLayout:
    return row(*((each, 1) for each in widgets))
