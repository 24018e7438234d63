"""The touches of the Verify page: the state, large; the error; what to do next; and what the scene shows of them."""

import math
import time
from typing import Any

import numpy as np
from PySide6.QtWidgets import QInputDialog, QWidget

from contactbench.app.bench import Bench, Weight
from contactbench.pipeline.colour_ramp import ColourScale
from contactbench.pipeline.contact.facet_marks import INVENTED, MARKS, UNTOUCHABLE
from contactbench.pipeline.errors import InputError, capitalised
from contactbench.pipeline.heatmap.heatmap import default_bandwidth, heatmap
from contactbench.pipeline.heatmap.subdivide import drawing_of
from contactbench.pipeline.kernel import Contact, Reason
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.region import Region
from contactbench.pipeline.touch_settings import TORSION_ARM_M
from contactbench.pipeline.verification.figures import Verification
from contactbench.pipeline.verification.protocol import ProtocolState
from contactbench.pipeline.workbench.live import LiveReading
from contactbench.pipeline.workbench.markers import Markers
from contactbench.pipeline.workbench.verify import VerifyOutcome, VerifyWork
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
from contactbench.widgets.messages import filled, number, translated
from contactbench.widgets.scene import TouchErrors
from contactbench.widgets.sounds import Sounds
from contactbench.widgets.theme import icon
from contactbench.widgets.touch_state import ErrorView, TouchState

_EVERY_S = 0.5
_MOST_CONTACTS = 4_000
_LEAST_N = 1.0
_SHOWN = {"skipped": "open"}  # the scene knows open, done and failed
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


def firm_contact(reading: LiveReading | None) -> Contact | None:
    """Return the contact of a press that is firm enough to be shown; None: there is none."""
    # A hand that lets go: the ellipse of so little force is larger than the probe, and says nothing.
    light = reading is None or not float(np.linalg.norm(reading.compensated[:3])) >= _LEAST_N
    return None if reading is None or light else reading.contact


def millimetres_within(contact: Contact) -> float:
    """Return how far the 95 % ellipse of a contact reaches, mm, at least a tenth."""
    return max(1e3 * contact.within, 0.1)


class VerifyScene:
    """Draws for one page; nothing while that is not shown."""

    def __init__(self, bench: Bench) -> None:
        self._bench, self._scene = bench, bench.scene
        self.probe: Probe | None = None
        self.heat = False
        self.outcome: VerifyOutcome | None = None
        self.regions: tuple[Region, ...] = ()
        self._shown: Any = None
        self._points: list[np.ndarray[Any, Any]] = []
        self._sigmas: list[float] = []
        self._counted, self._drawn_at, self._busy = 0, 0.0, False
        self._contact: Any = None

    def begin(self, title: str) -> None:
        """Show all of it anew; `title` is what the job of drawing heat is called."""
        self._title, self._shown, self._contact = title, None, None
        if self.probe is not None:
            self._scene.show_probe(self.probe, regions=self.regions)
        self._scene.set_tool("turn")

    def end(self) -> None:
        """Take it all away."""
        none = np.zeros((0, 3))
        self._scene.show_markers(none)
        self._scene.show_errors(None)
        self._scene.show_contact(None)
        self._scene.show_force(None)
        self._scene.show_field(None)
        self._scene.set_tool("turn")

    # ---- markers -----------------------------------------------------------------------------

    def show_markers(self, markers: Markers, view: TouchView | None) -> None:
        """Show markers, and how far they are, or what the last verification found; only if something changed."""
        outcome = self.outcome if view is None else None
        content = (markers, None if view is None else (view.rows, view.next_one, view.accepted), outcome)
        if content == self._shown:
            return
        self._shown = content
        points = np.array([each.point_S for each in markers.all]).reshape(-1, 3)
        if view is not None:
            states = tuple(_SHOWN.get(row.state, row.state) for row in view.rows)
            self._scene.show_markers(points, markers.names, states, view.next_one)
            self._scene.show_errors(_live(view))
        elif outcome is None or outcome.stale:
            self._scene.show_markers(points, markers.names, ("open",) * len(markers))
            self._scene.show_errors(None)
        else:
            self._show_found(outcome.found, markers, points)

    def _show_found(self, found: Verification, markers: Markers, points: np.ndarray[Any, Any]) -> None:
        """Show where touches were located, and markers in the colour of their largest error."""
        touches = located(found)
        self._scene.show_errors(touches)
        judged = {each.name: each for each in found.per_marker}
        worst = _worst(found)
        names, states, tints = [], [], []
        scale = ColourScale(0.0 if touches is None else 1e3 * touches.top)
        for name in markers.names:
            each = judged.get(name)
            names.append(name if each is None else filled("{}  {:.2f} mm", name, each.max_mm))
            states.append(
                "open" if each is None else "failed" if each.max_mm > 1e3 * found.limits.max_m else "done"
            )
            shade = scale.colours(np.array([0.0 if each is None else each.max_mm]))[0]
            tints.append("" if each is None else "#" + bytes(np.rint(255 * shade).astype(np.uint8)).hex())
        place = markers.names.index(worst) if worst in markers.names else None
        self._scene.show_markers(points, names, states, None, tints, place)

    def show_worst(self) -> None:
        """Turn the view so that the marker with the largest error is seen."""
        outcome = self.outcome
        worst = None if outcome is None else _worst(outcome.found)
        if outcome is None or worst is None:
            return
        touch = max(
            (each for each in outcome.found.touches if each.accepted and each.marker == worst),
            key=lambda each: each.distance_mm or 0.0,
        )
        if touch.point_mm is not None and touch.error_mm is not None:
            self._scene.bring_into_view(1e-3 * (np.array(touch.point_mm) - touch.error_mm))

    # ---- the contact -------------------------------------------------------------------------

    def show_reading(self, reading: LiveReading | None, captions: tuple[str, str] = ("", "")) -> None:
        """
        Show the contact and the force now.

        Parameters
        ----------
        reading : LiveReading or None
        captions : (str, str)
            What is written beside the second place, if there is one: in sight, and behind the probe.
        """
        contact = firm_contact(reading)
        if contact is None or contact.point is None or reading is None:
            if self._contact is not None:
                self._contact = None
                self._scene.show_contact(None)
                self._scene.show_force(None)
            return
        self._contact = contact
        two = contact.reason is Reason.TWO_TOUCHES  # the force is that of both: it acts at neither
        covariance = None if two else contact.covariance
        sure = "" if two else filled("≤ {:.1f} mm", millimetres_within(contact))
        if contact.reason is Reason.AMBIGUOUS:
            sure = filled("{:.0f} %", 100 * contact.confidence)
        self._scene.show_contact(contact.point, covariance, contact.normal, _others(contact), captions, sure)
        self._scene.show_force(None if two else reading.compensated[:3], contact.point)
        if contact.accepted and len(self._points) < _MOST_CONTACTS:
            self._points.append(np.asarray(contact.point))
            self._sigmas.append(float(contact.sigma_max))

    # ---- heat --------------------------------------------------------------------------------

    def forget_contacts(self) -> None:
        """Begin anew with where it was touched."""
        self._points, self._sigmas, self._counted = [], [], 0
        self._scene.show_field(None)

    def show_heat(self, wanted: bool) -> None:
        """Colour the probe by contacts, or not."""
        self.heat, self._counted = wanted, 0
        if not wanted:
            self._scene.show_field(None)

    def tick(self) -> None:
        """Bring the heat up to date, twice a second at most, in a worker."""
        probe, count = self.probe, len(self._points)
        if not self.heat or self._busy or probe is None or count == self._counted or not count:
            return
        if time.monotonic() < self._drawn_at + _EVERY_S:
            return
        self._busy, self._counted, self._drawn_at = True, count, time.monotonic()
        points, width = np.array(self._points), default_bandwidth(self._sigmas)

        def work(_progress: object, _cancelled: object) -> Any:
            try:
                return heatmap(drawing_of(probe), points, bandwidth=width, counted="samples")
            except InputError:  # a bandwidth that does not suit a tiny probe: no colours then
                return None

        self._bench.jobs.start(self._title, work, self._drawn, self._not_drawn)

    def _drawn(self, found: Any) -> None:
        self._busy = False
        if found is not None and self.heat:
            title = f"{found.title} [{found.unit}]"
            self._scene.show_field(found.values, title, found.scale, on=found.probe)

    def _not_drawn(self, error: BaseException) -> None:
        self._busy = self.heat = False
        self._bench.jobs.failed.emit(None, error)


def located(found: Verification) -> TouchErrors | None:
    """Return the accepted touches of a verification, and where the rejected ones could be as well; None: no touch."""
    used = [each for each in found.touches if each.accepted and each.point_mm and each.error_mm]
    if not used:
        return None
    points = 1e-3 * np.array([each.point_mm for each in used])
    upper = np.array([each.covariance_mm2 or (np.nan,) * 6 for each in used])
    covariances = 1e-6 * upper[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)
    rivals = [place for each in found.touches for place in each.rivals_mm]
    return TouchErrors(
        points - 1e-3 * np.array([each.error_mm for each in used]),
        points,
        covariances,
        1e-3 * np.array(rivals).reshape(-1, 3),
    )


def _live(view: TouchView) -> TouchErrors | None:
    return TouchErrors(*map(np.array, zip(*view.contacts, strict=True))) if view.contacts else None


def _worst(found: Verification) -> str | None:
    """Return the name of the marker with the largest error; None: no touch was accepted."""
    return max(found.per_marker, key=lambda each: each.max_mm).name if found.per_marker else None


def _others(contact: Contact) -> np.ndarray[Any, Any] | None:
    """Return where it could be as well, the likeliest first, or where the second touch is; (k, 3), S, m."""
    if contact.reason is Reason.TWO_TOUCHES and contact.second is not None:
        return np.asarray(contact.second).reshape(1, 3)
    if contact.reason not in (Reason.AMBIGUOUS, Reason.BY_REGION) or not contact.candidates:
        return None
    return np.array([each.point for each in contact.candidates])
