"""What is run, what the controller does, in words, and what has happened."""

from __future__ import annotations

import math
from enum import Enum, auto
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFrame, QWidget

from contactbench.widgets.action_bar import ActionBar
from contactbench.widgets.controls import (
    STYLED,
    FoldRow,
    PanelScroll,
    accent,
    choice,
    column,
    form,
    named,
    panel,
    plain_label,
    push_button,
    row,
    sentence_label,
)
from contactbench.widgets.messages import NumberBox, filled, translated

if TYPE_CHECKING:
    from collections.abc import Sequence

    from contactbench.pipeline.control.frames import LoopFrame
    from contactbench.pipeline.workbench.motion import MotionChange, MotionChoice

_WIDTH_PX = (320, 420)
_PACE_PX = 34  # two lines
_DOES_PX = 40  # two lines
_REAL = 0.9  # of real time: what is less is seen
_PERIODS_S = (20.0, 10.0, 5.0, 2.0)
_SHOWN = 6  # changes


class MotionPhase(Enum):
    """How a closed loop stands: the one thing that decides what can be pressed, and what is said of it."""

    EMPTY = auto()  # no bundle is chosen
    OPENING = auto()  # a bundle is being made or read
    READY = auto()
    STARTING = auto()  # the virtual robot is being made
    RUNNING = auto()
    STOPPING = auto()  # it was asked to go back
    ENDED = auto()
    FAILED = auto()  # it ended without an outcome

    @property
    def going_on(self) -> bool:
        """Whether a robot is there."""
        return self in (MotionPhase.STARTING, MotionPhase.RUNNING, MotionPhase.STOPPING)


class MotionControls(QWidget):
    """The panel on the right of the window."""

    asked_start = Signal()
    asked_stop = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.robot = choice(
            ((self.tr("Elfin3 arm"), "virtual://arm"), (self.tr("stiff mount"), "virtual://platform")),
            self.tr("Robot"),
            tip=self.tr("Both are simulated; no real hardware moves."),
        )
        self.motion = choice(
            (
                (self.tr("rocks along the face"), "in-plane"),
                (self.tr("rocks across the face"), "out-of-plane"),
                (self.tr("moves up and down"), "vertical"),
                (self.tr("at rest"), "none"),
            ),
            self.tr("Phantom"),
            tip=self.tr("Motion of the soft phantom under the probe."),
        )
        self.period = choice(
            [(filled(self.tr("{seconds:g} s"), seconds=each), each) for each in _PERIODS_S],
            self.tr("Period"),
            tip=self.tr("Period T of the phantom's motion."),
        )
        self.period.setCurrentIndex(_PERIODS_S.index(10.0))
        self.variant = choice(
            (
                (self.tr("from the bundle"), None),
                (self.tr("predictive"), "aware"),
                (self.tr("basic"), "plain"),
            ),
            self.tr("Control"),
            tip=self.tr(
                "Predictive: estimates the phantom's motion and leads it. Basic: force and position only."
            ),
        )
        self.size_of = NumberBox(decimals=0, minimum=0.0, maximum=20.0, value=10.0)
        tip = self.tr("Amplitude of the phantom's motion to each side.")
        named(self.size_of, self.tr("Amplitude"), tip=tip)
        self.bar, self.bundle = ActionBar(), sentence_label(role="muted")
        self.state, self.does = plain_label("", "title"), sentence_label()
        self.does.setMinimumHeight(_DOES_PX)  # the panel must not jump
        self.force, self.angle = plain_label("", "number"), plain_label("", "number")
        self.happened = sentence_label(role="muted")
        self.state.setAccessibleName(self.tr("Controller state"))
        self.force.setAccessibleName(self.tr("Force"))
        self.angle.setAccessibleName(self.tr("Angle to the phantom"))
        self.pace = sentence_label(role="muted")  # in one line it would be wider than the panel
        self.pace.setMinimumHeight(_PACE_PX)
        tip = self.tr(
            "How fast its time goes, against the clock: 1.00 is real time. Measured over the last frames."
        )
        self.pace.setToolTip(tip)
        tip = self.tr("Use a bundle of the open session in its current state.")
        self.of_session = push_button(self.tr("Use session"), None, "folder", tip=tip)
        tip = self.tr("An exported folder or zip file.")
        self.other = push_button(self.tr("Open bundle"), None, "folder", tip=tip)
        self.start, self.stop = self.bar.primary, self.bar.second
        self._lay_out()
        self._connect()
        self.show_phase(MotionPhase.EMPTY)

    def _lay_out(self) -> None:
        rows = form(space=4)
        for box in (self.robot, self.motion, self.size_of, self.period, self.variant):
            rows.addRow(box.accessibleName(), box)
        title, bundles = plain_label(self.tr("Motion control"), "title"), _even(self.of_session, self.other)
        parts = (title, bundles, self.bundle, rows, self._card(), self.happened)
        column(self, (PanelScroll(panel(*parts, 1, margins=(12, 10, 12, 8))), 1), self.bar, space=0)
        self.setMinimumWidth(_WIDTH_PX[0])
        self.setMaximumWidth(_WIDTH_PX[1])

    def _card(self) -> QFrame:
        card = QFrame()
        card.setProperty("role", "card")
        numbers = _even(self.force, self.angle)
        captions = (
            plain_label(each, "muted") for each in (self.tr("force"), self.tr("angle to the phantom"))
        )
        column(card, self.state, self.does, numbers, _even(*captions), self.pace, margins=STYLED, space=2)
        return card

    def _connect(self) -> None:
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
            period=self.period.currentData(),
            size=self.size_of.value(),
            variant=self.variant.currentData(),
        )

    # ---- what is shown -----------------------------------------------------------------------------

    def show_phase(
        self, phase: MotionPhase, frame: LoopFrame | None = None, pace: float | None = None
    ) -> None:
        """Show how it stands; `frame`: the newest, of what runs or has ended."""
        name, does = self._words().get(self._key(phase, frame), ("", ""))
        self.state.setText(name)
        self.does.setText(does)
        live = frame is not None and phase in (MotionPhase.RUNNING, MotionPhase.STOPPING)
        self._show_numbers(frame if live else None, pace if live else None)
        for each in (self.robot, self.motion, self.variant, self.of_session, self.other):
            each.setEnabled(not phase.going_on and phase is not MotionPhase.OPENING)
        self._show_size()
        self.bar.offer(
            self.tr("Start"),
            self.asked_start.emit,
            enabled=phase in (MotionPhase.READY, MotionPhase.ENDED, MotionPhase.FAILED),
            accented=not phase.going_on,
            picture="play",
        )
        can_stop = phase in (MotionPhase.STARTING, MotionPhase.RUNNING)
        tip = self.tr("Retract the probe and stop (Esc).")
        self.bar.offer_second(self.tr("Stop"), self.asked_stop.emit, enabled=can_stop, tip=tip)
        accent(self.stop, phase.going_on, "stop")

    def _key(self, phase: MotionPhase, frame: LoopFrame | None) -> str:
        if phase is MotionPhase.RUNNING and frame is not None:
            return frame.state
        return phase.name

    def _show_numbers(self, frame: LoopFrame | None, pace: float | None) -> None:
        if frame is None:
            self.force.setText("–")
            self.angle.setText("–")
        else:
            largest = max(abs(math.degrees(each)) for each in frame.angles_rad)
            self.force.setText(filled(self.tr("{:z.1f} N"), frame.force_N))
            self.angle.setText(filled(self.tr("{:.1f}°"), largest))
        if pace is None:
            self.pace.setText(self.tr("Pace: –"))
            return
        words = self.tr("Pace: {pace:.2f} of real time")
        if pace <= _REAL:
            words = self.tr("Pace: {pace:.2f} of real time: this computer is too slow")
        self.pace.setText(filled(words, pace=pace))

    def show_changes(self, changes: Sequence[MotionChange]) -> None:
        """Show the newest changes of state, newest first."""
        names = {key: name for key, (name, _) in self._words().items()}
        lines = [
            filled(
                self.tr("{time:.1f} s  {state}: {why}"),
                time=each.time_s,
                state=names.get(each.state, each.state),
                why=translated(each.reason),
            )
            for each in reversed(changes[-_SHOWN:])
        ]
        self.happened.setText("\n".join(lines))

    def _words(self) -> dict[str, tuple[str, str]]:
        return {
            "approach": (self.tr("Approaching"), self.tr("The probe is slowly approaching the phantom.")),
            "contact": (self.tr("In contact"), self.tr("The force rises, then the stiffness is estimated.")),
            "track": (self.tr("Tracking"), self.tr("Keeps its force and stays perpendicular.")),
            "hold": (self.tr("Holding"), self.tr("Waiting until the readings are reliable again.")),
            "retract": (self.tr("Retracting"), self.tr("The probe is leaving the phantom.")),
            "safe": (self.tr("Stopped"), self.tr("Nothing moves any more; it is about to end.")),
            "EMPTY": (self.tr("No bundle"), self.tr("Choose the bundle that is to be run.")),
            "OPENING": (self.tr("Opening the bundle"), ""),
            "READY": (self.tr("Ready"), self.tr("Nothing moves until you press Start.")),
            "STARTING": (self.tr("Starting"), self.tr("The virtual robot is being made.")),
            "STOPPING": (self.tr("Stopping"), self.tr("The probe leaves the phantom, then stands still.")),
            "ENDED": (self.tr("Ended"), self.tr("The probe stands still; nothing moves any more.")),
            "FAILED": (self.tr("Failed"), self.tr("Nothing moves any more; the message says why.")),
        }


def _even(*widgets: QWidget) -> FoldRow:
    return row(*((each, 1) for each in widgets))
