"""The touches of the Verify page: the state, large; the error; what to do next."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtWidgets import QInputDialog, QToolButton, QWidget

from contactbench.app.bench import Weight
from contactbench.app.pages.verify_scene import firm_contact
from contactbench.pipeline.contact.facet_marks import INVENTED, MARKS, UNTOUCHABLE
from contactbench.pipeline.kernel import Reason
from contactbench.pipeline.verification.protocol import ProtocolState
from contactbench.widgets.controls import HIGH, check_box, column, push_button, row, sentence_label
from contactbench.widgets.error_view import ErrorView
from contactbench.widgets.icons import icon
from contactbench.widgets.phrases import said
from contactbench.widgets.sounds import Sounds
from contactbench.widgets.touch_state import TouchState

if TYPE_CHECKING:
    from contactbench.app.bench import Bench
    from contactbench.pipeline.kernel import Contact
    from contactbench.pipeline.workbench.live import LiveReading
    from contactbench.pipeline.workbench.verify import VerifyWork
    from contactbench.pipeline.workbench.verify_touches import LiveTouches, TouchOf, TouchView
    from contactbench.widgets.action_bar import ActionBar

_KEPT_TICKS = 45  # how long a decision stays on the screen after the probe was let go, ticks
_DECIDED = (ProtocolState.ACCEPTED, ProtocolState.REJECTED)
_SURE = (Reason.OK, Reason.VERTEX, Reason.BY_REGION)
_TWO_LINES_PX = 38
_LONGEST = 200  # characters of a reason


class TouchPanel(QWidget):
    """Shows touches as they happen, with words and tones."""

    def __init__(self, bench: Bench, work: VerifyWork, bar: ActionBar, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._bench, self._work, self._bar, self.sounds = bench, work, bar, Sounds(self)
        self._decided: TouchOf | None = None
        self._left = 0
        self.state, self.error = TouchState(), ErrorView()
        self.next = sentence_label()
        self.next.setMinimumHeight(_TWO_LINES_PX)  # what lies below stays where it is
        self._make_buttons()
        self.virtual = QWidget()
        pair = row((self.touch, 1), (self.touch_all, 1))
        pair.setContentsMargins(0, 0, 0, 0)
        self.virtual.setLayout(pair)
        column(
            self, self.state, self.next, self.error,
            row((self.repeat, 1), (self.skip, 1)), self.virtual, row((self.heat, 1), self.mute),
            margins=(0, 8, 0, 0),
        ).addStretch(1)  # fmt: skip

    def _make_buttons(self) -> None:
        self.repeat = push_button(
            self.tr("Touch again"),
            None,
            "redo",
            tip=self.tr(
                "The marker that is selected in the table, or else the last one; all its touches count"
            ),
        )
        self.skip = push_button(
            self.tr("Leave it out"),
            self._ask_why,
            "remove",
            tip=self.tr("Go on with the marker after the next one; you say why, and the report repeats it"),
        )
        self.touch = push_button(
            self.tr("Touch it for me"),
            None,
            "play",
            tip=self.tr("The virtual bench presses the next marker with a tip"),
        )
        self.touch_all = push_button(
            self.tr("Touch all"),
            None,
            "play",
            tip=self.tr("The virtual bench presses one marker after the other"),
        )
        self.touch_all.setCheckable(True)
        tip = self.tr("Colour the probe by where it was touched, in contacts per mm²")
        self.heat = check_box(self.tr("Heat map of contacts"), tip=tip)
        self.mute = QToolButton()
        self.mute.setCheckable(True)
        self.mute.setIcon(icon("sound"))
        self.mute.setMinimumSize(HIGH, HIGH)
        self.mute.setAccessibleName(self.tr("Mute the tones"))
        self.mute.setToolTip(self.tr("A tone for each state; press to mute them"))
        self.mute.toggled.connect(self._mute)

    def _mute(self, muted: bool) -> None:
        self.mute.setIcon(icon("mute" if muted else "sound"))
        self.mute.setAccessibleName(self.tr("Tones are muted") if muted else self.tr("Mute the tones"))
        self.sounds.muted = muted

    # ---- what is shown -------------------------------------------------------------------------------

    def say(self, text: str) -> None:
        """Show what is in the way; empty: nothing."""
        self._bar.say(text, bad=bool(text))

    def allow(self, *, virtual: bool, busy: bool) -> None:
        """Show the buttons that are of use now."""
        going_on = self._work.going_on
        for each in (self.repeat, self.skip, self.touch, self.touch_all):
            each.setEnabled(going_on and not busy)
        self.virtual.setVisible(virtual)

    def show_reading(self, reading: LiveReading | None) -> None:
        """Say how sure the contact is now."""
        contact = firm_contact(reading)
        on = None if contact is None or reading is None else reading.on
        sure = contact is None or (contact.reason in _SURE and on in (None, MARKS[0]))
        words = (self._contact(contact), self._mark(on))
        self.state.show_contact(" ".join(filter(None, words)), sure)

    def show_idle(self, reading: LiveReading | None) -> None:
        """Show that nothing goes on."""
        force = math.nan if reading is None else float(np.linalg.norm(reading.compensated[:3]))
        self.state.show_state("idle", self._what_first(), force, self._work.parameters.windows[0])

    def show_touches(self, touches: LiveTouches, view: TouchView) -> None:
        """Show how the touches stand."""
        self._play(touches, view)
        state, detail = view.state.value, self._wish(view)
        if self._decided is not None and self._left > 0:
            self._left -= view.state is ProtocolState.ARMED
            state = ProtocolState.REJECTED.value if self._decided.why else ProtocolState.ACCEPTED.value
            detail = self._said(self._decided, view.state is ProtocolState.ARMED)
        self.state.show_state(state, detail, view.force, view.window)
        self.next.setText(self._next(view))
        findings = self._work.findings
        self.say(findings[0] if findings else view.notice)
        last = view.last.error_mm if view.last is not None and not view.last.why else None
        limit = 1e3 * touches.settings.limits.max_m
        self.error.show_errors(view.mean_mm, view.sd_mm, view.errors_mm, last, limit, self._against(view))

    def _play(self, touches: LiveTouches, view: TouchView) -> None:
        events = touches.take_events()
        for event in events:
            if event.touch is not None:
                self._decided, self._left = view.last, _KEPT_TICKS
            elif event.state is ProtocolState.TOUCHING:
                self._decided, self._left = None, 0
        loudest = next((each for each in reversed(events) if each.state in _DECIDED), None)
        if events:
            self.sounds.play((loudest or events[-1]).state.value)

    # ---- leaving a marker out ------------------------------------------------------------------------

    def _ask_why(self) -> None:
        """Ask why the next marker is left out; touches go on meanwhile."""
        touches = self._work.touches
        view = None if touches is None else touches.view()
        if view is None or view.next_one is None:
            return
        name = view.rows[view.next_one].name
        dialog = QInputDialog(self.window())
        dialog.setWindowTitle(self.tr("Leave {name} out").format(name=name))
        dialog.setLabelText(self.tr("Why is {name} not touched? The report says so.").format(name=name))
        dialog.setComboBoxEditable(True)
        dialog.setComboBoxItems(
            [
                self.tr("nothing reaches it"),
                self.tr("the mark cannot be seen any more"),
                self.tr("the housing gives way there"),
                self.tr("a touch there would do damage"),
            ]
        )
        dialog.setOkButtonText(self.tr("Leave it out"))
        dialog.textValueSelected.connect(lambda why: self.leave_out(name, why))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def leave_out(self, name: str, why: str) -> None:
        """Leave a marker out for a reason, if it is still the next one."""
        touches, why = self._work.touches, " ".join(why.split())[:_LONGEST]
        if touches is None:
            return
        weight = Weight.WARNING
        if not why:
            words = self.tr("{name} is not left out: that needs a reason.")
        elif touches.skip(why, name) is None:
            weight, words = Weight.INFO, self.tr("{name} is not left out: it was touched meanwhile.")
        else:
            words = self.tr("{name} is left out: {why}. The verdict and the report say so.")
        self._bench.tell(weight, words.format(name=name, why=why))

    # ---- words ---------------------------------------------------------------------------------------

    def captions(self, contact: Contact | None) -> tuple[str, str]:
        """Return what is written beside the second place: in sight, and behind the probe."""
        if contact is None:
            return "", ""
        if contact.reason is Reason.TWO_TOUCHES:
            return self.tr("second touch"), self.tr("second touch, behind")
        return self.tr("could also be here"), self.tr("could also be here, behind")

    def _what_first(self) -> str:
        if self._bench.live.pair is None:
            return self.tr("No sensor is open: connect one in step 1, Devices.")
        if not len(self._work.markers):
            return self.tr("Place markers first, on the first tab.")
        return self.tr(
            "Take everything off the probe, then start. From then on, only touch: no mouse is needed."
        )

    def _wish(self, view: TouchView) -> str:
        low, high = view.window
        words = {
            ProtocolState.ARMED: self.tr("Press with {low} to {high} N, and hold still."),
            ProtocolState.TOUCHING: self.tr("Bring the force to {low} to {high} N, and hold still."),
            ProtocolState.SETTLED: self.tr("Do not move: the samples are taken."),
            ProtocolState.ACCEPTED: self.tr("Let go."),
            ProtocolState.REJECTED: self.tr("Let go."),
        }[view.state]
        return words.format(low=f"{low:g}", high=f"{high:g}")

    def _said(self, touch: TouchOf, free: bool) -> str:
        if touch.why:
            why = said(touch.why)
            return self.tr("{why} ({force} N). Let go, and touch again.").format(
                why=f"{why[0].upper()}{why[1:]}", force=f"{touch.force:.1f}"
            )
        words = self.tr("{marker}: {size} mm off.") if free else self.tr("{marker}: {size} mm off. Let go.")
        return words.format(
            marker=touch.marker, size="–" if touch.size_mm is None else f"{touch.size_mm:.2f}"
        )

    def _contact(self, contact: Contact | None) -> str:
        """Say how sure the contact is, or why there is none."""
        if contact is None:
            return ""
        sure = self.tr("Confidence {percent} %").format(percent=_percent(contact.confidence))
        match contact.reason:
            case Reason.OK | Reason.VERTEX:
                return sure
            case Reason.BY_REGION:
                return self.tr(
                    "{sure}, because of the declared regions: the wrench fits another place, too."
                ).format(sure=sure)
            case Reason.AMBIGUOUS:
                return self.tr(
                    "{sure}: the wrench fits another place, too. Press in another direction."
                ).format(sure=sure)
            case Reason.TWO_TOUCHES:
                return self.tr("A second touch joined: both are shown.")
            case Reason.IMPLAUSIBLE:
                return self.tr(
                    "No single touch explains this wrench: {sigmas} sigma left over, torque arm {arm} mm."
                    " Two touches at once, or wrong units, mount or compensation?"
                ).format(sigmas=f"{math.sqrt(contact.misfit):.1f}", arm=f"{1e3 * abs(contact.arm):.0f}")
            case Reason.TANGENTIAL:
                return self.tr("The force is almost parallel to the surface: press more steeply.")
            case Reason.OUTSIDE_REGION:
                return self.tr("The contact is outside every region.")
            case Reason.SATURATED:
                return self.tr("The sensor is at the end of its range: press less hard.")
        return self.tr(
            "No part of the probe faces this force: check that it is the force on the probe, and the mount."
        )

    def _mark(self, on: str | None) -> str:
        """Say where a contact is no better than a guess, or should not be; empty: it lies on the mesh as it was."""
        if on == MARKS[INVENTED]:
            return self.tr("On a facet that the mesh file did not have: its place is a guess.")
        if on == MARKS[UNTOUCHABLE]:
            return self.tr("On a region marked untouchable: check the region and the mount.")
        return ""

    def _next(self, view: TouchView) -> str:
        if view.next_one is None:
            return self.tr(
                "All markers are touched; touches: {done}. Finish, or touch some once more."
            ).format(done=view.accepted)
        return self.tr("Next: {name} · {done} of {wanted} touches").format(
            name=view.rows[view.next_one].name, done=view.accepted, wanted=view.wanted
        )

    def _against(self, view: TouchView) -> str:
        if view.last is None or view.last.ratio is None or view.max_mm is None:
            return self.tr("of the touches that count")
        return self.tr("largest {largest} mm; the last was {ratio} times what noise explains").format(
            largest=f"{view.max_mm:.2f}", ratio=f"{view.last.ratio:.1f}"
        )


def _percent(confidence: float) -> str:
    """Return a share of one in per cent; what is not certain is never said to be 100."""
    return f"{min(100 * confidence, 99.9):.1f}" if confidence > 0.99 else f"{100 * confidence:.0f}"
