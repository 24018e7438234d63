"""The parts of the gravity page, and how they show what goes on."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QComboBox, QFrame, QPushButton, QSpinBox, QWidget

from contactbench.pipeline.calibration import Limits
from contactbench.pipeline.calibration.orientation import plain
from contactbench.pipeline.settings import ORIENTATION_NOISE_DEG
from contactbench.pipeline.workbench.gravity_fit import GravityFinding, Proposal
from contactbench.widgets.controls import (
    PanelScroll,
    beside,
    called,
    check_box,
    choice,
    column,
    named,
    plain_label,
    push_button,
    row,
    sentence_label,
    show_quietly,
    stacked,
)
from contactbench.widgets.coverage import CaptureState, Coverage
from contactbench.widgets.messages import filled, local, number, translated
from contactbench.widgets.residual_table import ResidualTable
from contactbench.widgets.verdict_box import REFUSE, USABLE, Shrinking, VerdictBox

_UNDETERMINED = 0.05  # m: beyond, a number says nothing
_THREE_LINES = 54  # px
_THERE = 8.0  # degrees: near enough, what a pose tells hardly changes


class GravityFigures(QWidget):
    """How many poses, and the contact error with its curve."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.count, self.before, self.error = (plain_label("", each) for each in ("title", "muted", "number"))
        self.curve = Shrinking()
        caption = sentence_label(self.tr("contact error from calibration (1 sigma)"), "muted")
        caption.setToolTip(
            self.tr(
                "Contact error caused by the calibration alone, mm: worst case over the intended touches."
                " 0.5 mm is good."
            )
        )
        self.curve.setToolTip(
            self.tr("Error after each pose, logarithmic scale; dashed: 0.5 mm, the limit for good")
        )
        low = Qt.AlignmentFlag.AlignBottom
        numbers = beside(None, (self.before, 0, low), (self.error, 0, low), (self.curve, 1), space=6)
        column(self, self.count, caption, numbers, space=2)

    def show_figures(self, count: int, expected: int, errors: Sequence[float], *, running: bool) -> None:
        """Show the numbers."""
        if running:
            text = self.tr("pose {count} of about {expected}").format(
                count=min(count + 1, expected), expected=expected
            )
            if count >= expected:
                text = self.tr("{count} poses: you can finish").format(count=count)
        else:
            text = self.tr("poses: {count}").format(count=count)
        self.count.setText(text)
        known = [error for error in errors if error < _UNDETERMINED]
        determined = bool(errors) and errors[-1] < _UNDETERMINED
        self.error.setText(f"{local(plain(1e3 * known[-1]))} mm" if determined else "\N{EN DASH} mm")
        arrow = determined and len(known) > 1
        self.before.setText(f"{local(plain(1e3 * known[-2]))} \N{RIGHTWARDS ARROW}" if arrow else "")
        self.before.setVisible(arrow)
        self.curve.setVisible(len(known) > 1)
        self.curve.show_values(known, Limits().good_error)


class FindingCards(QWidget):
    """Sentences, each with a button that does what mends it."""

    confirmed = Signal(object)  # Finding

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._box = column(self, space=-1)
        self._shown: tuple[tuple[str, str], ...] = ()
        self.buttons: list[QPushButton] = []

    def show_findings(self, findings: Sequence[GravityFinding]) -> None:
        """Show these, and no others."""
        shown = tuple((finding.sentence, finding.remedy) for finding in findings)
        if shown == self._shown:
            return
        self._shown, self.buttons = shown, []
        while (item := self._box.takeAt(0)) is not None:
            if (widget := item.widget()) is not None:
                widget.deleteLater()
        for finding in findings:
            self._box.addWidget(self._card(finding))

    def _card(self, finding: GravityFinding) -> QWidget:
        card = QFrame()
        card.setProperty("role", "card")
        words = VerdictBox()
        heavy = bool(finding.settings) or not finding.leave_out
        words.show_verdict(REFUSE if heavy else USABLE, [finding.sentence], self.tr("Findings"))
        box = stacked(card, words)
        if finding.remedy:
            remedy = translated(finding.remedy)
            button = called(push_button(self.tr("Apply fix"), None, "check", tip=remedy), remedy)
            button.setProperty("primary", bool(finding.settings))
            button.clicked.connect(lambda: self.confirmed.emit(finding))
            box.addWidget(sentence_label(f"{remedy}.", "muted"))
            box.addWidget(button)
            self.buttons.append(button)
        return card


class GravityPanel(PanelScroll):
    """All that the page shows, above its buttons."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent=parent)
        inside = QWidget()
        self._box = column(inside, margins=(10, 8, 10, 8), space=-1)
        self.setWidget(inside)
        self._make()

    def _make(self) -> None:
        title = plain_label(self.tr("Gravity"), "title")
        self.intro = sentence_label(
            self.tr(
                "Hold the tool still in about six different tilts, touching nothing. These poses"
                " determine the tool's weight and the sensor offset, which are then subtracted from every"
                " reading."
            )
        )
        self.state = CaptureState()
        self.sentence = sentence_label(role="muted")
        self.sentence.setMinimumHeight(_THREE_LINES)  # what comes and goes does not move the rest
        self.there = False  # whether the tool is as the next pose needs it
        tip = self.tr("Off: press SPACE or the foot switch to capture each pose.")
        self.automatic = check_box(self.tr("Capture automatically when still"), tip=tip)
        tip = self.tr("End without a calibration; the poses are kept, and you can continue from them")
        self.stop = push_button(self.tr("Stop"), None, "stop", tip=tip)
        self.automatic.setChecked(True)
        self.figures = GravityFigures()
        self.verdict, self.checked, self.problem = VerdictBox(), VerdictBox(), VerdictBox()
        self.findings = FindingCards()
        self.coverage = Coverage()
        self.table = ResidualTable()
        self._add(title, self.intro, self.problem, self.state, self.sentence)
        self._box.addLayout(row((self.automatic, 1), self.stop))
        self._make_next()
        self._add(self.figures, self.verdict, self.checked, self.findings, self.coverage, self.table)
        self._make_table_buttons()
        self._make_tilt()
        self._make_bench()
        self._box.addStretch(1)

    def _add(self, *widgets: QWidget) -> None:
        for widget in widgets:
            self._box.addWidget(widget)

    def _make_next(self) -> None:
        self.next = sentence_label()
        self.next.setMinimumHeight(_THREE_LINES)  # the buttons below stay where they are
        self.away = sentence_label(role="muted")
        tip = self.tr("Push the virtual tool briefly to see the effect")
        self.bump = push_button(self.tr("Bump virtual tool"), tip=tip)
        self._add(self.next, self.away)
        self._box.addWidget(self.bump)

    def _make_table_buttons(self) -> None:
        table = self.table
        tip = self.tr("Leave out the selected poses (Delete)")
        self.out = push_button(self.tr("Leave out"), None, "remove", tip=tip)
        self.out.clicked.connect(lambda: table.leave_out.emit(table.selected()))
        tip = self.tr("Restore the selected poses (Return)")
        self.back = push_button(self.tr("Restore"), None, "check", tip=tip)
        self.back.clicked.connect(lambda: table.take_back.emit(table.selected()))
        self._box.addLayout(row(self.out, self.back))
        # Below a result, whatever the foot of the page offers.
        self.more = push_button(self.tr("Add poses"), None, "add")
        self.anew = push_button(self.tr("Start over"), None, "redo")
        self._box.addLayout(row(self.more, self.anew))

    def _make_tilt(self) -> None:
        words = self.tr("Tilt limit of the tool")
        self.tilt = QSpinBox(minimum=20, maximum=180, singleStep=10, suffix="°")
        tip = self.tr(
            "Largest angle between the sensor's z axis and straight down, degrees. Poses beyond it are"
            " not proposed."
        )
        self._add_line(words, named(self.tilt, words, tip=tip))

    def _add_line(self, words: str, field: QWidget) -> None:
        self._box.addLayout(row((plain_label(words, buddy=field), 1), field))

    def _make_bench(self) -> None:
        """Make the questions of where down is, and of what gives the orientations."""
        self.down = self._choice(
            self.tr("Robot base"),
            (
                (self.tr("upright"), (0.0, 0.0, -1.0)),
                (self.tr("on the ceiling"), (0.0, 0.0, 1.0)),
                (self.tr("on a wall, +x down"), (1.0, 0.0, 0.0)),
                (self.tr("on a wall, -x down"), (-1.0, 0.0, 0.0)),
                (self.tr("on a wall, +y down"), (0.0, 1.0, 0.0)),
                (self.tr("on a wall, -y down"), (0.0, -1.0, 0.0)),
            ),
            self.tr(
                "Direction of gravity in the frame of the orientations. For other directions: session set"
                " calibration.down"
            ),
        )
        names = {
            "robot": self.tr("from a robot ({degrees}°)"),
            "tracker": self.tr("from a tracker ({degrees}°)"),
            "hand": self.tr("by hand ({degrees}°)"),
        }
        self.orientation_noise = self._choice(
            self.tr("Orientation accuracy"),
            (
                (self.tr("from the poses"), None),
                *(
                    (names[key].format(degrees=number(degrees, "g")), degrees)
                    for key, degrees in ORIENTATION_NOISE_DEG.items()
                ),
            ),
            self.tr("1 sigma about each axis. Orientation errors shift the weight in the readings."),
        )

    def _choice(self, words: str, choices: Sequence[tuple[str, Any]], tip: str) -> QComboBox:
        box = choice(choices, words, tip=tip)
        self._add_line(words, box)
        return box

    def show_setting(self, box: QComboBox, value: Any) -> None:
        """Show a setting; one that is not among the choices gets an entry of its own."""
        known = [box.itemData(index) for index in range(box.count())]
        value = tuple(value) if isinstance(value, list) else value
        if value not in known:
            known.append(value)
            with QSignalBlocker(box):
                box.addItem(str(value), value)
        show_quietly(box, known.index(value))

    def add_check(self, widget: QWidget) -> None:
        """Put a further check of the calibration below its verdicts."""
        self._box.insertWidget(self._box.indexOf(self.findings), widget)

    def show_next(self, proposal: Proposal | None, *, virtual: bool, running: bool) -> None:
        """Show the pose to take next, and on a virtual bench the buttons that do it."""
        words = self.tr("Tilt the tool to match the ghost: {words}")
        self.next.setText(words.format(words=translated(proposal.sentence)) if proposal else "")
        self.next.setVisible(proposal is not None)
        self.away.setVisible(proposal is not None)
        self.bump.setVisible(virtual and running)

    def show_away(self, R_WS: NDArray[np.float64] | None, goal: NDArray[np.float64] | None) -> None:
        """Show by how much the weight's direction still differs from that of a pose to take."""
        self.there = False
        if R_WS is None or goal is None:
            self.away.setText("")
            return
        angle = float(np.degrees(np.arccos(np.clip(R_WS[2] @ goal[2], -1, 1))))
        self.there = angle < _THERE
        words = self.tr("In position: keep still.") if self.there else self.tr("{angle:.0f}° to go.")
        self.away.setText(filled(words, angle=angle))
