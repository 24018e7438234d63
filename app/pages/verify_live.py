"""What the Verify page shows 30 times a second."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject

from contactbench.app.bench import Weight
from contactbench.app.pages.verify_scene import firm_contact
from contactbench.pipeline.contact.facet_marks import INVENTED, MARKS, UNTOUCHABLE
from contactbench.pipeline.kernel import Reason
from contactbench.pipeline.verification.protocol import ProtocolState
from contactbench.widgets.marker_table import ShownMarker
from contactbench.widgets.phrases import said

if TYPE_CHECKING:
    from contactbench.app.pages.verify import VerifyPage
    from contactbench.pipeline.kernel import Contact
    from contactbench.pipeline.workbench.verify_touches import TouchOf, TouchView

_KEPT_TICKS = 45  # how long a decision stays on the screen after the probe was let go, ticks
_SAID = (ProtocolState.ACCEPTED, ProtocolState.REJECTED)
_SURE = (Reason.OK, Reason.VERTEX, Reason.BY_REGION)


class LiveShow(QObject):
    """Brings the panels and the scene up to date."""

    def __init__(self, page: VerifyPage) -> None:
        super().__init__(page)
        self._page = page
        self._decided: TouchOf | None = None
        self._left = 0
        self._rows: tuple[object, ...] = ()
        self._wrong: tuple[str, ...] = ()

    def tick(self) -> None:
        """Show the newest moment."""
        page = self._page
        reading = page.bench.live.reading()
        contact = firm_contact(reading)
        page.scene_view.show_reading(reading, self._captions(contact))
        on = None if contact is None or reading is None else reading.on
        sure = contact is None or (contact.reason in _SURE and on in (None, MARKS[0]))
        words = (self._contact(contact), self._mark(on))
        page.panel_touch.state.show_contact(" ".join(filter(None, words)), sure)
        page.scene_view.tick()
        self.watch()
        touches = page.work.touches
        if touches is None:
            page.toucher.tick(None, None)
            size = math.nan if reading is None else float(np.linalg.norm(reading.compensated[:3]))
            self._idle(size)
            return
        view = touches.view()
        self._play(view)
        self._show(view)
        page.toucher.tick(touches, view)

    def watch(self) -> None:
        """Tell what is wrong with what goes on, whichever page is shown."""
        self._tell(self._page.work.findings)

    def _tell(self, wrong: tuple[str, ...]) -> None:
        """Put into the message list what is wrong with devices or disk, and that all is well again."""
        bench, before, self._wrong = self._page.bench, self._wrong, wrong
        for sentence in wrong:
            if sentence not in before:
                bench.tell(Weight.WARNING, sentence)
        if before and not wrong and self._page.work.going_on:
            bench.tell(Weight.GOOD, self.tr("All devices give samples again; the recording goes on."))

    def _play(self, view: TouchView) -> None:
        touches = self._page.work.touches
        events = [] if touches is None else touches.take_events()
        for event in events:
            if event.touch is not None:
                self._decided, self._left = view.last, _KEPT_TICKS
            elif event.state is ProtocolState.TOUCHING:
                self._decided, self._left = None, 0
        loudest = next(
            (each for each in reversed(events) if each.state in _SAID), events[-1] if events else None
        )
        if loudest is not None:
            self._page.sounds.play(loudest.state.value)

    def _show(self, view: TouchView) -> None:
        page, panel = self._page, self._page.panel_touch
        state, detail = view.state.value, ""
        if self._decided is not None and self._left > 0:
            self._left -= view.state is ProtocolState.ARMED
            state = ProtocolState.REJECTED.value if self._decided.why else ProtocolState.ACCEPTED.value
            detail = self._said(self._decided, view.state is ProtocolState.ARMED)
        else:
            detail = self._wish(view)
        panel.state.show_state(state, detail, view.force, view.window)
        panel.next.setText(self._next(view))
        panel.say(self._wrong[0] if self._wrong else view.notice)
        last = view.last.error_mm if view.last is not None and not view.last.why else None
        limit = 1e3 * page.work.touches.settings.limits.max_m if page.work.touches is not None else 2.0
        panel.error.show_errors(view.mean_mm, view.sd_mm, view.errors_mm, last, limit, self._against(view))
        page.scene_view.show_markers(page.markers, view)
        self._table(view)

    def _idle(self, force: float) -> None:
        page = self._page
        page.panel_touch.state.show_state("idle", self._what_first(), force, page.window_N)
        page.scene_view.show_markers(page.markers, None)
        self._table(None)

    def show_idle(self) -> None:
        """Show that nothing goes on, also where nothing ticks."""
        if not self._page.work.going_on:
            self._page.panel_touch.state.show_state("idle", self._what_first(), math.nan, self._page.window_N)
            self._page.panel_touch.next.setText("")
            self._table(None)

    def _table(self, view: TouchView | None) -> None:
        page = self._page
        content = (page.markers, page.outcome if view is None else (view.rows, view.next_one))
        if content == self._rows:
            return
        self._rows = content
        rows = []
        for place, marker in enumerate(page.markers.all):
            x, y, z = (1e3 * marker.point_S).tolist()
            if view is None or place >= len(view.rows):
                rows.append(self._judged(marker.name, (x, y, z)))
                continue
            row = view.rows[place]
            state = "next" if place == view.next_one and row.state == "open" else row.state
            rows.append(
                ShownMarker(marker.name, (x, y, z), row.touches, row.wanted, row.mean_mm, row.max_mm, state)
            )
        page.panel_markers.show_markers(rows)

    def _judged(self, name: str, point_mm: tuple[float, float, float]) -> ShownMarker:
        """Return a row as the last verification has it, if it still holds."""
        outcome, wanted = self._page.outcome, self._page.wanted
        if outcome is not None and not outcome.stale:
            for each in outcome.markers:
                if each.name == name:
                    state = "failed" if each.max_mm > outcome.max_limit_mm else "done"
                    return ShownMarker(name, point_mm, each.touches, wanted, each.mean_mm, each.max_mm, state)
        return ShownMarker(name, point_mm, 0, wanted)

    # ---- words -----------------------------------------------------------------------------------

    def _what_first(self) -> str:
        page = self._page
        if page.bench.live.pair is None:
            return self.tr("No sensor is open: connect one in step 1, Devices.")
        if not len(page.markers):
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

    def _captions(self, contact: Contact | None) -> tuple[str, str]:
        """Return what is written beside the second place: in sight, and behind the probe."""
        if contact is None:
            return "", ""
        if contact.reason is Reason.TWO_TOUCHES:
            return self.tr("second touch"), self.tr("second touch, behind")
        return self.tr("could also be here"), self.tr("could also be here, behind")

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
