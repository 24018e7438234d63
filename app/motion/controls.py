"""What is run, what the controller does, in words, and what has happened."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from contactbench.widgets.controls import PanelScroll, accent
from contactbench.widgets.icons import icon
from contactbench.widgets.phrases import said

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.workbench.motion import Change, MotionChoice

_WIDTH_PX, _BUTTON_PX, _LINES_PX = 348, 40, 40
_PERIODS_S = (20.0, 10.0, 5.0, 2.0)
_SHOWN = 6  # changes


class Controls(QWidget):
    """The panel on the right of the window."""

    asked_bundle = Signal(bool)  # True: that of the session
    asked_start = Signal()
    asked_stop = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.robot, self.motion, self.period = QComboBox(self), QComboBox(self), QComboBox(self)
        self.size_of, self.variant = QDoubleSpinBox(self), QComboBox(self)
        self.bundle, self.message, self.happened = QLabel(self), QLabel(self), QLabel(self)
        self.state, self.does = QLabel(self), QLabel(self)
        self.force, self.angle = QLabel(self), QLabel(self)
        self.of_session = QPushButton(icon("folder"), self.tr("This session"), self)
        self.other = QPushButton(icon("folder"), self.tr("Open bundle"), self)
        self.start = QPushButton(icon("play", "panel"), self.tr("Start"), self)
        self.stop = QPushButton(icon("stop"), self.tr("Stop"), self)
        self._fill()
        self._dress()
        self._lay_out()
        self._connect()
        self.show_state(None)

    # ---- making ------------------------------------------------------------------------------------

    def _fill(self) -> None:
        for box, name, tip, choices in (
            (
                self.robot,
                self.tr("Robot"),
                self.tr("Both are simulated: nothing real moves."),
                (
                    (self.tr("Elfin3 arm"), "virtual://arm"),
                    (self.tr("stiff mount"), "virtual://platform"),
                ),
            ),
            (
                self.motion,
                self.tr("The phantom"),
                self.tr("How the soft phantom moves under the probe."),
                (
                    (self.tr("tilts along the face"), "in-plane"),
                    (self.tr("tilts across the face"), "out-of-plane"),
                    (self.tr("goes up and down"), "vertical"),
                    (self.tr("rests"), "none"),
                ),
            ),
            (
                self.period,
                self.tr("There and back in"),
                self.tr("Period T of the phantom's motion."),
                tuple((self.tr("{seconds:g} s").format(seconds=each), each) for each in _PERIODS_S),
            ),
            (
                self.variant,
                self.tr("Control"),
                self.tr("Aware: how the phantom moves is estimated and led. Plain: force and place alone."),
                (
                    (self.tr("as in the bundle"), None),
                    (self.tr("aware"), "aware"),
                    (self.tr("plain"), "plain"),
                ),
            ),
        ):
            box.setAccessibleName(name)
            box.setToolTip(tip)
            for text, value in choices:
                box.addItem(text, value)
        self.period.setCurrentIndex(_PERIODS_S.index(10.0))
        self.size_of.setRange(0.0, 20.0)
        self.size_of.setDecimals(0)
        self.size_of.setValue(10.0)
        self.size_of.setAccessibleName(self.tr("How far"))
        self.size_of.setToolTip(self.tr("Amplitude of the phantom's motion, to either side."))

    def _dress(self) -> None:
        for label, role in (
            (self.bundle, "muted"), (self.state, "title"), (self.force, "number"), (self.angle, "number"),
            (self.happened, "muted"),
        ):  # fmt: skip
            label.setProperty("role", role)
        for label in (self.bundle, self.message, self.happened, self.does):
            label.setWordWrap(True)
        self.message.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.state.setAccessibleName(self.tr("What the controller does"))
        self.force.setAccessibleName(self.tr("Force"))
        self.angle.setAccessibleName(self.tr("Angle to the phantom"))
        self.message.setMinimumHeight(_LINES_PX)  # the panel must not jump
        for button in (self.of_session, self.other):
            button.setMinimumHeight(36)
            button.setStyleSheet("padding: 4px 6px;")
        for button in (self.start, self.stop):
            button.setMinimumHeight(_BUTTON_PX)
        self.of_session.setToolTip(self.tr("What would be exported of the open session now."))
        self.other.setToolTip(self.tr("A folder or zip file that was exported."))
        self.stop.setToolTip(self.tr("The probe goes back and stands still (Esc)."))

    def _lay_out(self) -> None:
        column = QVBoxLayout()
        column.setContentsMargins(12, 10, 12, 8)
        column.setSpacing(8)
        title = QLabel(self.tr("Motion control"), self)
        title.setProperty("role", "title")
        column.addWidget(title)
        column.addLayout(_row(self.of_session, self.other))
        column.addWidget(self.bundle)
        form = QFormLayout()
        form.setSpacing(4)
        for box in (self.robot, self.motion, self.size_of, self.period, self.variant):
            form.addRow(box.accessibleName(), box)
        column.addLayout(form)
        column.addLayout(_row(self.start, self.stop))
        column.addWidget(self.message)
        column.addWidget(self._card())
        column.addWidget(self.happened)
        column.addStretch(1)
        inside = QWidget(self)
        inside.setLayout(column)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.addWidget(PanelScroll(inside, self))
        self.setFixedWidth(_WIDTH_PX)

    def _card(self) -> QFrame:
        card = QFrame(self)
        card.setProperty("role", "card")
        column = QVBoxLayout(card)
        column.setSpacing(2)
        column.addWidget(self.state)
        column.addWidget(self.does)
        column.addLayout(_row(self.force, self.angle))
        captions = QLabel(self.tr("force"), card), QLabel(self.tr("angle to the phantom"), card)
        for caption in captions:
            caption.setProperty("role", "muted")
        column.addLayout(_row(*captions))
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
        accent(self.start, not running)
        accent(self.stop, running)
        self.start.setIcon(icon("play", "text" if running else "panel"))
        self.stop.setIcon(icon("stop", "panel" if running else "text"))

    # ---- what is shown -----------------------------------------------------------------------------

    def say(self, text: str, bad: bool = False) -> None:
        """Show a sentence."""
        text = said(text)
        if text == self.message.text():
            return
        self.message.setProperty("role", "bad" if bad else "")
        self.message.style().unpolish(self.message)
        self.message.style().polish(self.message)
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

    def show_changes(self, changes: Sequence[Change]) -> None:
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


def _row(*widgets: QWidget) -> QHBoxLayout:
    row = QHBoxLayout()
    row.setSpacing(6)
    for each in widgets:
        row.addWidget(each, 1)
    return row
