"""The touches of the Verify page: the state, large; the error; what to do next."""

import math

import numpy as np
from PySide6.QtWidgets import QInputDialog, QWidget

from contactbench.app.bench import Bench, Weight
from contactbench.app.pages.verify_scene import firm_contact, millimetres_within
from contactbench.pipeline.contact.facet_marks import INVENTED, MARKS, UNTOUCHABLE
from contactbench.pipeline.errors import capitalised
from contactbench.pipeline.kernel import Contact, Reason
from contactbench.pipeline.touch_settings import TORSION_ARM_M
from contactbench.pipeline.verification.protocol import ProtocolState
from contactbench.pipeline.workbench.live import LiveReading
from contactbench.pipeline.workbench.verify import VerifyWork
from contactbench.pipeline.workbench.verify_touches import SEEN, LiveTouches, TouchOf, TouchView
from contactbench.widgets.action_bar import ActionBar
from contactbench.widgets.controls import (
    HIGH,
    check_box,
    column,
    push_button,
    row,
    sentence_label,
    tool_button,
)
from contactbench.widgets.error_view import ErrorView
from contactbench.widgets.messages import translated
from contactbench.widgets.numbers import number
from contactbench.widgets.sounds import Sounds
from contactbench.widgets.theme import icon
from contactbench.widgets.touch_state import TouchState

_KEPT_TICKS = 45  # how long a decision stays on the screen after the probe was let go, ticks
_DECIDED = (ProtocolState.ACCEPTED, ProtocolState.REJECTED)
_SURE = (Reason.OK, Reason.VERTEX, Reason.BY_REGION)
_TWO_LINES_PX = 38
_LONGEST_REASON = 200  # characters of a reason


class TouchPanel(QWidget):
    """Shows touches as they happen, with words and tones."""

    def __init__(self, bench: Bench, work: VerifyWork, bar: ActionBar, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._bench, self._work, self._bar, self.sounds = bench, work, bar, Sounds(self)
        self._decided: TouchOf | None = None
        self._left = 0
        self.state, self.error = TouchState(), ErrorView()
        self.state.setToolTip(
            self.tr(
                "Within: 95 of 100 touches lie no farther from the point shown, by its covariance"
                " (2.45 times the largest standard deviation)"
            )
        )
        self.next = sentence_label()
        self.next.setMinimumHeight(_TWO_LINES_PX)  # what lies below stays where it is
        self._make_buttons()
        column(
            self, self.state, self.next, self.error,
            row((self.repeat, 1), (self.skip, 1)), row((self.touch_all, 1), (self.discard, 1)),
            row((self.heat, 1), self.mute),
            margins=(0, 8, 0, 0),
        ).addStretch(1)  # fmt: skip

    def _make_buttons(self) -> None:
        tip = self.tr("Repeat the marker selected in the table, or the last one; all its touches count")
        self.repeat = push_button(self.tr("Touch again"), None, "redo", tip=tip)
        tip = self.tr("Skip the next marker and enter the reason, which appears in the report")
        self.skip = push_button(self.tr("Skip marker"), self._ask_why, "remove", tip=tip)
        tip = self.tr("Stop without a verdict; the touches are discarded")
        self.discard = push_button(self.tr("Discard"), None, "stop", tip=tip)
        tip = self.tr("The virtual bench presses all markers in turn")
        self.touch_all = push_button(self.tr("Touch all"), None, "play", tip=tip)
        self.touch_all.setCheckable(True)
        tip = self.tr("Colour the probe by contact density, in contacts per mm²")
        self.heat = check_box(self.tr("Contact heatmap"), tip=tip)
        tip = self.tr("Each state has its own tone; press to mute")
        self.mute = tool_button("sound", self.tr("Mute tones"), tip=tip)
        self.mute.setCheckable(True)
        self.mute.setMinimumSize(HIGH, HIGH)
        self.mute.toggled.connect(self._mute)

    def _mute(self, muted: bool) -> None:
        self.mute.setIcon(icon("mute" if muted else "sound"))
        self.mute.setAccessibleName(self.tr("Tones muted") if muted else self.tr("Mute tones"))
        self.sounds.muted = muted

    # ---- what is shown -------------------------------------------------------------------------------

    def say(self, text: str) -> None:
        """Show what is in the way, or that nothing is; empty: nothing is."""
        self._bar.say(text, bad=text not in ("", SEEN))

    def allow(self, *, virtual: bool, busy: bool) -> None:
        """Show the buttons that are of use now."""
        going_on = self._work.going_on
        for each in (self.repeat, self.skip, self.touch_all, self.discard):
            each.setEnabled(going_on and not busy)
        self.touch_all.setVisible(virtual)

    def show_reading(self, reading: LiveReading | None) -> None:
        """Say how sure the contact is now."""
        contact = firm_contact(reading)
        on = None if contact is None or reading is None else reading.on
        place, mark = contact is None or contact.reason in _SURE, self._mark(on)
        sure = "" if place and mark else self._contact(contact)  # no doubt beside it
        words = (sure, self._torsion(contact), mark)
        self.state.show_contact(" ".join(filter(None, words)), place and not mark)

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
        dialog.setWindowTitle(self.tr("Skip {name}").format(name=name))
        dialog.setLabelText(self.tr("Reason for skipping {name} (appears in the report)").format(name=name))
        dialog.setComboBoxEditable(True)
        dialog.setComboBoxItems(
            [
                self.tr("not reachable"),
                self.tr("mark no longer visible"),
                self.tr("housing is too soft there"),
                self.tr("a touch could cause damage"),
            ]
        )
        dialog.setOkButtonText(self.tr("Skip marker"))
        dialog.textValueSelected.connect(lambda why: self.leave_out(name, why))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def leave_out(self, name: str, why: str) -> None:
        """Leave a marker out for a reason, if it is still the next one."""
        touches, why = self._work.touches, " ".join(why.split())[:_LONGEST_REASON]
        if touches is None:
            return
        weight = Weight.WARNING
        if not why:
            words = self.tr("{name} was not skipped: enter a reason.")
        elif touches.skip(why, name) is None:
            weight, words = (
                Weight.INFO,
                self.tr("{name} was not skipped because it has been touched in the meantime."),
            )
        else:
            words = self.tr("{name} skipped: {why}. The verdict and the report state the reason.")
        self._bench.tell(weight, words.format(name=name, why=why))

    # ---- words ---------------------------------------------------------------------------------------

    def captions(self, contact: Contact | None) -> tuple[str, str]:
        """Return what is written beside the second place: in sight, and behind the probe."""
        if contact is None:
            return "", ""
        if contact.reason is Reason.TWO_TOUCHES:
            return self.tr("second touch"), self.tr("second touch, behind")
        return self.tr("possible alternative"), self.tr("possible alternative, behind")

    def _what_first(self) -> str:
        if self._bench.live.pair is None:
            return self.tr("No sensor is open. Connect one in step 1, Devices.")
        if not len(self._work.markers):
            return self.tr("Place markers on the first tab.")
        return self.tr(
            "Remove everything from the probe, then start. After that, just touch the markers; no mouse"
            " is needed."
        )

    def _wish(self, view: TouchView) -> str:
        low, high = view.window
        words = {
            ProtocolState.ARMED: self.tr("Press with {low} to {high} N and hold still."),
            ProtocolState.TOUCHING: self.tr("Adjust the force to {low}–{high} N and hold still."),
            ProtocolState.SETTLED: self.tr("Keep still: measuring."),
            ProtocolState.ACCEPTED: self.tr("Release."),
            ProtocolState.REJECTED: self.tr("Release."),
        }[view.state]
        return words.format(low=number(low, "g"), high=number(high, "g"))

    def _said(self, touch: TouchOf, free: bool) -> str:
        if touch.why:
            return self.tr("{why} ({force} N). Release, then touch again.").format(
                why=translated(capitalised(touch.why)), force=number(touch.force, ".1f")
            )
        size = "–" if touch.size_mm is None else number(touch.size_mm, ".2f")
        released, pressed = (
            self.tr("{marker}: error {size} mm."),
            self.tr("{marker}: error {size} mm. Release."),
        )
        return (released if free else pressed).format(marker=touch.marker, size=size)

    def _contact(self, contact: Contact | None) -> str:
        """Say how sure the contact is, or why there is none."""
        if contact is None:
            return ""
        near = number(millimetres_within(contact), ".1f")
        match contact.reason:
            case Reason.OK | Reason.VERTEX:
                return self.tr("Sure, within {near} mm").format(near=near)
            case Reason.BY_REGION:
                return self.tr("Sure by the defined regions, within {near} mm").format(near=near)
            case Reason.UNCERTAIN:
                return self.tr(
                    "Only within {near} mm. Press harder, or more directly into the surface."
                ).format(near=near)
            case Reason.AMBIGUOUS:
                return self.tr(
                    "Confidence {percent} %: the wrench also fits another place. Press in a different direction."
                ).format(percent=number(100 * contact.confidence, ".0f"))
            case Reason.TWO_TOUCHES:
                return self.tr("Two touches detected; both are shown.")
            case Reason.IMPLAUSIBLE:
                return self.tr(
                    "No single touch explains this wrench (residual {sigmas} sigma, moment arm {arm} mm)."
                    " Check for two simultaneous touches, and check units, mount and compensation."
                ).format(
                    sigmas=number(math.sqrt(contact.misfit), ".1f"), arm=number(1e3 * abs(contact.arm), ".0f")
                )
            case Reason.TANGENTIAL:
                return self.tr("The force is almost parallel to the surface. Press more directly into it.")
            case Reason.OUTSIDE_REGION:
                return self.tr("The contact is outside all regions.")
            case Reason.SATURATED:
                return self.tr("The sensor is at the limit of its range. Press less hard.")
        return self.tr("No part of the probe faces this force. Check the force sign and the mount.")

    def _torsion(self, contact: Contact | None) -> str:
        """Say how large torsion was found to be, and for how long; empty: no larger than it usually is."""
        if contact is None or contact.point is None or not contact.torsion_arm > 1.05 * TORSION_ARM_M:
            return ""
        return self.tr("Torsion arm {arm} mm, learned for {seconds} s.").format(
            arm=number(1e3 * contact.torsion_arm, ".1f"), seconds=number(contact.torsion_since, ".0f")
        )

    def _mark(self, on: str | None) -> str:
        """Say where a contact is no better than a guess, or should not be; empty: it lies on the mesh as it was."""
        if on == MARKS[INVENTED]:
            return self.tr("On a facet added during repair: its position is an estimate.")
        if on == MARKS[UNTOUCHABLE]:
            return self.tr("On an untouchable region: check the region and the mount.")
        return ""

    def _next(self, view: TouchView) -> str:
        if view.next_one is None:
            return self.tr("All markers touched ({done} touches). Finish, or repeat any marker.").format(
                done=view.accepted
            )
        return self.tr("Next: {name} · {done} of {wanted} touches").format(
            name=view.rows[view.next_one].name, done=view.accepted, wanted=view.wanted
        )

    def _against(self, view: TouchView) -> str:
        if view.last is None or view.last.ratio is None or view.max_mm is None:
            return self.tr("of accepted touches")
        return self.tr("largest {largest} mm; last: {ratio} times the expected noise").format(
            largest=number(view.max_mm, ".2f"), ratio=number(view.last.ratio, ".1f")
        )
