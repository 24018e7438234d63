"""The Verify page: somebody touches markers, and shows that contacts are where they should be."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QLabel, QTabWidget, QWidget

from contactbench.app.bench import Bench, Page, Weight
from contactbench.app.pages.known_check import PointPanel
from contactbench.app.pages.verify_markers import MarkersPanel
from contactbench.app.pages.verify_result import ResultPanel
from contactbench.app.pages.verify_touch import TouchPanel, VerifyScene, firm_contact
from contactbench.app.undo import SetParameters, push_done
from contactbench.pipeline.contact import ContactSolver, Gates
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session.why import why_locked
from contactbench.pipeline.settings import VerificationSettings
from contactbench.pipeline.steps import Step, StepState, StepStatus
from contactbench.pipeline.verification.protocol import ProtocolState
from contactbench.pipeline.workbench.live import follows
from contactbench.pipeline.workbench.markers import Markers, kept
from contactbench.pipeline.workbench.undo_history import Deed
from contactbench.pipeline.workbench.verify import (
    TouchTool,
    VerifyOutcome,
    VerifyWork,
    asked_near,
    checked_parameters,
    outcome_of,
    parameters_of,
    plain_parameters,
    tool_key,
    tool_of,
)
from contactbench.widgets.controls import PanelScroll, choice, form, named, panel, row, show_quietly
from contactbench.widgets.glance import Glance
from contactbench.widgets.messages import NumberBox, number, translated
from contactbench.widgets.settings_rows import rows_of

if TYPE_CHECKING:
    from collections.abc import Callable
    from concurrent.futures import Future

    import numpy as np
    from numpy.typing import NDArray

    from contactbench.pipeline.simulation.virtual.bench import VirtualBench
    from contactbench.pipeline.simulation.virtual.commands import Done
    from contactbench.pipeline.verification.result import VerificationParameters
    from contactbench.pipeline.workbench.verify_touches import LiveTouches, TouchView
    from contactbench.widgets.scene.scene import Pick

_MARKERS, _HOW, _POINT, _TOUCH, _RESULT = range(5)


class VerifyPage(Page):
    """Markers, how to touch them, a known point, the touches, and the verdict, on a tab each."""

    step: ClassVar[Step] = Step.VERIFY

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, parent)
        self.work = VerifyWork(bench.desk, bench.live)
        self.toucher, self.scene_view = Toucher(bench, self), VerifyScene(bench)
        self._entered = self._busy = False
        self._broken = ""  # what is wrong with a file behind the verification
        self._read_at, self._told = -1, tuple[str, ...]()
        self._loading: object = None
        self._locked = ""  # why nothing can be done yet
        self._build()
        self._connect()
        self._allow()

    def _build(self) -> None:
        self.tabs = QTabWidget(documentMode=True, usesScrollButtons=False)
        self.panel_markers, self.panel_how = MarkersPanel(self.bench, self.work), VerifySettingsPanel()
        self.panel_touch, self.panel_result = TouchPanel(self.bench, self.work, self.bar), ResultPanel()
        self.panel_point = PointPanel(self.bench)
        point = panel(self.panel_point, 1, margins=(0, 8, 0, 0))
        for each, name in (
            (self.panel_markers, self.tr("Markers")),
            (self.panel_how, self.tr("Settings")),
            (point, self.tr("Point")),
            (self.panel_touch, self.tr("Touch")),
            (self.panel_result, self.tr("Result")),
        ):
            self.tabs.addTab(PanelScroll(each), name)
        kept = self.tabs.sizePolicy()
        kept.setRetainSizeWhenHidden(True)
        self.tabs.setSizePolicy(kept)
        self.fill(panel(self.tabs, margins=(6, 4, 6, 0)))

    def _connect(self) -> None:
        touch, markers = self.panel_touch, self.panel_markers
        touch.repeat.clicked.connect(self._repeat)
        touch.discard.clicked.connect(self.discard)
        touch.touch_all.toggled.connect(lambda on: self.toucher.begin() if on else self.toucher.end())
        touch.heat.toggled.connect(self.scene_view.show_heat)
        self.toucher.stopped.connect(self._touched_all)
        self.panel_how.changed.connect(self._set)
        markers.changed.connect(self._allow)
        markers.count.valueChanged.connect(self._offer)
        markers.refused.connect(self._read_again)
        self.panel_result.worst.clicked.connect(self.scene_view.show_worst)
        self.bench.scene.picked.connect(self._picked)

    # ---- shown and hidden ------------------------------------------------------------------------

    def enter(self) -> None:
        """Show markers and contacts in the scene."""
        self._entered = True
        self.scene_view.begin(self.tr("Drawing heatmap"))
        self._read()

    def leave(self) -> None:
        """Take them away; a verification goes on."""
        self._entered = False
        self.panel_markers.pick.setChecked(False)
        self.scene_view.end()

    def show_state(self, status: StepStatus) -> None:
        """Show how the step stands."""
        if self.bench.ending:  # what was under way when the session was closed still ends
            return
        missing = why_locked(self.bench.desk.state)
        before = self._locked
        self._locked = missing or (status.sentence if status.state is StepState.LOCKED else "")
        if self._locked != before:  # else: what the touches say stays
            self.bar.say(self._locked)
        self.tabs.setVisible(not self._locked)
        if self._broken != (broken := status.sentence if status.broken else ""):
            self._broken = broken
            self._show_outcome(self.work.outcome)
        self._read()
        self._allow()

    def tick(self) -> None:
        """Show the newest of what is live."""
        reading, touches = self.bench.live.reading(), self.work.touches
        view = None if touches is None else touches.view()
        self.scene_view.show_reading(reading, self.panel_touch.captions(firm_contact(reading)))
        self.scene_view.tick()
        self.scene_view.show_markers(self.work.markers, view)
        self.panel_touch.show_reading(reading)
        self.panel_markers.show_touches(view)
        if touches is None or view is None:
            self.panel_touch.show_idle(reading)
        else:
            self.panel_touch.show_touches(touches, view)
            self._offer()
        self.toucher.tick(touches, view)
        self.watch()

    def glance(self, status: StepStatus) -> Glance:
        """Return which marker is next and how it is pressed, or how the verification ended."""
        state, outcome, touches = self.panel_touch.state, self.work.outcome, self.work.touches
        if touches is None:
            if outcome is None or self._locked:
                return super().glance(status)
            result = self.panel_result
            words = self.bar.words or result.why.text()
            return Glance(
                result.verdict.text(), words, result.number.text(), result.range.text(), result.role
            )
        view = touches.view()
        last = None if view.last is None or view.last.why else view.last.size_mm
        size = (
            "" if view.last is None or last is None else self.tr("{mean} mm").format(mean=number(last, ".2f"))
        )
        of = "" if view.last is None else self.tr("error at {}").format(view.last.marker)
        name = "" if view.next_one is None else view.rows[view.next_one].name
        words = "\n".join(filter(None, (self.bar.words, state.detail if name else "", state.contact)))
        headline = f"{name} \N{MIDDLE DOT} {state.word}" if name else self.panel_touch.next.text()
        return Glance(headline, words, size, of, state.role, state.force, state.window_N)

    def watch(self) -> None:
        """Tell what is wrong with devices and disk, and that all is well again, whichever page is shown."""
        work = self.work
        self._told = self.bench.tell_findings(self._told, work.findings, recorded=work.going_on)
        if self.work.error:
            self.work.pause()
            self.panel_touch.say(self.work.error)
            self.bench.set_failed(Step.VERIFY, self.work.error)
        self.panel_point.poll()

    def close_page(self) -> None:
        """End it; what was recorded is kept."""
        self.panel_point.close_panel()
        # Not here: it may have to wait for what is just being judged, and for the disk.
        self.bench.jobs.start(self.tr("Saving recording"), lambda *_: self.work.abandon())
        self.panel_touch.sounds.close()

    def _go(self) -> None:
        missing = why_locked(self.bench.desk.state, "calibration")
        self.bench.go_to.emit(Step.GRAVITY if missing else Step.PROBE)

    # ---- what the session has --------------------------------------------------------------------

    def _read(self) -> None:
        """Read markers, parameters and the verdict from the session, if it changed; in a worker."""
        desk = self.bench.desk
        state, stale = desk.state, desk.stale
        if state.count == self._read_at:
            return
        self._read_at = state.count
        try:
            self.work.parameters = checked_parameters(parameters_of(state))
            self.panel_how.show_parameters(self.work.parameters)
        except InputError as error:
            self.bench.tell(Weight.ERROR, str(error))

        def work(_progress: object, _cancelled: object) -> tuple[Markers, VerifyOutcome | None]:
            return kept(desk.folder, state), outcome_of(desk.folder, state, stale)

        def came(found: tuple[Markers, VerifyOutcome | None]) -> None:
            if state.count == self._read_at:
                if not self.panel_markers.pending:
                    self.work.markers = found[0]
                self._show_outcome(found[1])
                self._allow()

        self.bench.jobs.start(self.tr("Loading verification"), work, came, self.bench.tell_error)
        self.panel_point.read()
        self._load_tool()

    def _read_again(self) -> None:
        self._read_at = -1
        self._read()

    def _load_tool(self) -> None:
        """Load probe and calibration, if they are others than before."""
        desk, state, known = self.bench.desk, self.bench.desk.state, self.work.tool
        key, *asked = tool_key(state), asked_near(state), follows(state)
        shown = None if known is None else (known.content, known.sigma_max, known.follow)
        if key is None or (key, *asked) in (self._loading, shown):
            return
        self._loading = key, *asked

        def work(_progress: object, _cancelled: object) -> tuple[TouchTool, ContactSolver]:
            tool = tool_of(desk.folder, state)
            return tool, ContactSolver(tool.probe, gates=Gates(sigma_max=tool.sigma_max))

        def came(found: tuple[TouchTool, ContactSolver]) -> None:
            self._loading = None
            self.work.tool = tool = found[0]
            self.scene_view.probe, self.scene_view.regions = tool.probe, tool.regions
            self.bench.live.set_model(tool.model, follow=tool.follow)
            self.bench.live.solver = found[1]
            self.panel_markers.show_regions()
            if self._entered:
                self.scene_view.begin(self.tr("Drawing heatmap"))
            self._allow()

        def wrong(error: BaseException) -> None:
            self._loading = None
            self.bench.tell_error(error)

        self.bench.jobs.start(self.tr("Loading probe"), work, came, wrong)

    def _show_outcome(self, outcome: VerifyOutcome | None) -> None:
        if outcome is not None:
            outcome = replace(outcome, broken=self._broken)
        self.work.take_outcome(outcome)
        self.scene_view.outcome = self.work.outcome
        self.panel_result.show_outcome(self.work.outcome)

    def _set(self, values: dict[str, object], text: str) -> None:
        """Change settings of the verification."""
        if "order" in values:
            values = {"order": list(self.work.markers.names) if values["order"] else []}
        try:
            known = parameters_of(self.bench.desk.state)
            before, _ = plain_parameters(known), checked_parameters({**known, **values})
        except InputError as error:
            self.bench.tell(Weight.WARNING, str(error))
            self._read_again()
            return
        now = {f"verification.{name}": value for name, value in values.items() if value != before[name]}
        if now:
            self.bench.undo.push(SetParameters(self.bench, now, text))

    def _picked(self, pick: Pick) -> None:
        if self._entered and self.panel_markers.pick.isChecked():
            self.panel_markers.picked(pick)

    # ---- touching --------------------------------------------------------------------------------

    def _do(self, title: str, work: Callable[..., object], done: Callable[..., None]) -> None:
        self._busy = True
        self._allow()

        def over(then: Callable[[Any], None], what: object) -> None:
            self._busy = False
            try:
                then(what)
            finally:
                self.bench.set_running(Step.VERIFY, self.work.going_on)
                self._allow()

        def wrong(error: BaseException) -> None:
            self.bench.tell_error(error)
            self.panel_touch.say(str(error))

        self.bench.jobs.start(title, work, partial(over, done), partial(over, wrong))

    def start(self) -> None:
        """Begin to follow and record touches."""
        tool, markers = self.work.tool, self.work.markers
        if tool is None or not len(markers) or self._busy or self.work.going_on:
            return
        self.tabs.setCurrentIndex(_TOUCH)
        self.panel_touch.say("")
        self.scene_view.forget_contacts()
        self._do(
            self.tr("Measuring noise"),
            lambda _, cancelled: self.work.start(tool, markers, cancelled),
            lambda _: None,
        )

    def finish(self) -> None:
        """Keep the recording and judge it."""
        if self._busy or not self.work.going_on:
            return
        self.toucher.end()

        deed = Deed(self.tr("verify"))

        def judged(outcome: VerifyOutcome | None) -> None:
            push_done(self.bench, deed)
            if outcome is not None:
                self._show_outcome(outcome)
                self.panel_touch.say("")  # what was wrong while it was recorded: the verdict says it better
                self.tabs.setCurrentIndex(_RESULT)
                self.scene_view.show_worst()
                self.panel_touch.sounds.play("done")
                passed, failed = self.tr("Verification passed."), self.tr("Verification failed.")
                good = outcome.passed
                self.bench.tell(Weight.GOOD if good else Weight.WARNING, passed if good else failed)

        self._do(self.tr("Evaluating touches"), lambda *_: self.work.finish(deed), judged)

    def discard(self) -> None:
        """End it without a verdict."""
        if not self._busy and self.work.going_on:
            self.toucher.end()
            self._do(self.tr("Stopping recording"), lambda *_: self.work.discard(), lambda _: None)

    def _repeat(self) -> None:
        touches = self.work.touches
        if touches is None:
            return
        last = touches.view().last
        name = self.panel_markers.table.current_name or (None if last is None else last.marker)
        if name is not None and name in touches.markers.names:
            touches.repeat(name)

    def _touch_one(self) -> None:
        touches = self.work.touches
        if touches is not None:
            self.toucher.press_next(touches, touches.view())

    def _touched_all(self, why: str) -> None:
        self.panel_touch.touch_all.setChecked(False)
        if why:
            self.bench.tell(Weight.WARNING, why)

    # ---- what can be done ------------------------------------------------------------------------

    def _offer(self, *_: object) -> None:
        """Offer what is to be done next."""
        work, bar, outcome = self.work, self.bar, self.work.outcome
        ready = work.tool is not None and len(work.markers) > 0
        start, again = self.tr("Start touching"), self.tr("Verify again")
        if self._locked:
            missing = why_locked(self.bench.desk.state, "calibration")
            words = self.tr("Go to Gravity") if missing else self.tr("Open Probe")
            bar.offer(words, self._go)
            bar.offer_second()
        elif work.going_on:
            view = None if work.touches is None else work.touches.view()
            left = None if view is None or view.next_one is None else view.rows[view.next_one].name
            tip = self.tr("Save the recording, evaluate it and create the report")
            free = not self._busy
            if left is not None and self.toucher.there:
                bar.offer(
                    self.tr("Touch {}").format(left), self._touch_one, enabled=free and not self.toucher.all
                )
                bar.offer_second(self.tr("Finish"), self.finish, enabled=free, tip=tip)
            else:  # on a real bench the probe touches, not a button
                bar.offer(self.tr("Finish"), self.finish, enabled=free, accented=left is None, tip=tip)
                bar.offer_second()
        elif work.tool is not None and not len(work.markers):
            words = self.tr("Place {} markers").format(self.panel_markers.count.value())
            bar.offer(words, self.panel_markers.spread.click, enabled=not self._busy)
            bar.offer_second()
        elif outcome is not None and outcome.passed and not (outcome.stale or outcome.broken):
            bar.offer(self.tr("Next: Export"), lambda: self.bench.go_to.emit(Step.EXPORT))
            bar.offer_second(again, self.start, enabled=ready and not self._busy)
        else:
            bar.offer(start if outcome is None else again, self.start, enabled=ready and not self._busy)
            bar.offer_second()

    def _allow(self) -> None:
        """Show what can be done now, also where nothing ticks."""
        work = self.work
        free = not work.going_on and not self._busy
        self.panel_touch.allow(virtual=self.toucher.there, busy=self._busy)
        self._offer()
        self.panel_markers.lock(not free or work.tool is None)
        self.panel_how.setEnabled(free)
        known = [(each.name, each.point_S.tolist()) for each in work.markers.all]
        self.panel_point.show_markers(known, None if work.tool is None else work.tool.model)
        self.panel_point.setEnabled(free)
        if not work.going_on:
            self.panel_touch.show_idle(None)
            self.panel_touch.next.setText("")
            self.panel_markers.show_touches(None)


# ---- how touches must be: force, repeats, order, limits ------------------------------------------


_FIRST_LIMIT = "mean_limit_mm"  # above the limits stands what is asked of a touch


class VerifySettingsPanel(QWidget):
    """Asks for the settings of a verification, as its parameters have them."""

    changed = Signal(dict, str)  # parameter -> JSON value; what was done, in words

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._others: tuple[tuple[float, float], ...] = ()
        self.low = self._number(0.2, 500.0, " N", self.tr("Lower force limit, N"))
        self.high = self._number(0.3, 500.0, " N", self.tr("Upper force limit, N"))
        self.order = choice(
            ((self.tr("any order"), False), (self.tr("table order"), True)),
            self.tr("Order in which to touch the markers"),
            tip=self.tr(
                "Any order: a touch counts for the nearest marker. Table order: it counts for the next"
                " marker."
            ),
        )
        self.follow = choice(
            ((self.tr("as calibrated"), False), (self.tr("follows"), True)),
            self.tr("The sensor's zero"),
            tip=self.tr(
                "Follows: what the sensor reads between touches is subtracted, here and in the runtime."
                " Lift the probe clear for half a second before each touch."
            ),
        )
        self.rows = rows_of(VerificationSettings)
        layout = form(self, top=8)
        layout.addRow(self.tr("Press with"), row((self.low, 1), QLabel(self.tr("to")), (self.high, 1)))
        for name, each in self.rows.items():
            if name == _FIRST_LIMIT:
                layout.addRow(self.tr("Touch order"), self.order)
                layout.addRow(self.tr("Zero"), self.follow)
            layout.addRow(each.title, each.field)
            each.changed.connect(
                lambda _, name=name, row=each: self.changed.emit({name: row.value}, row.name)
            )
        for end in (self.low, self.high):
            end.valueChanged.connect(self._set_window)
        self.order.currentIndexChanged.connect(
            lambda _: self.changed.emit({"order": self.order.currentData()}, self.tr("Order of touches"))
        )
        self.follow.currentIndexChanged.connect(
            lambda _: self.changed.emit({"follow": self.follow.currentData()}, self.tr("The sensor's zero"))
        )

    def _number(self, low: float, high: float, unit: str, name: str) -> NumberBox:
        return named(NumberBox(decimals=2, minimum=low, maximum=high, singleStep=0.5, suffix=unit), name)

    def _set_window(self) -> None:
        if self.low.value() >= self.high.value():
            return  # until the other end follows
        window = [self.low.value(), self.high.value()]
        self.changed.emit({"windows": [window, *map(list, self._others)]}, self.tr("Force window"))

    def show_parameters(self, given: VerificationParameters) -> None:
        """Show what holds."""
        (low, high), *others = given.windows
        self._others = tuple(others)
        for field, value in (
            (self.low, low),
            (self.high, high),
            (self.order, 1 if given.order else 0),
            (self.follow, int(given.follow)),
        ):
            show_quietly(field, value)
        for name, each in self.rows.items():
            each.show(getattr(given, name))


# ---- touches that the virtual bench does for somebody without hardware ---------------------------


_HELD_S, _PAUSE_S, _MOST_TRIES = 1.2, 0.4, 3


class Toucher(QObject):
    """
    Presses markers on the virtual bench, one or all.

    Attributes
    ----------
    all : bool
        Whether it goes on by itself.
    """

    stopped = Signal(object)  # why it does not go on; empty: all are done

    def __init__(self, bench: Bench, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._bench, self.all = bench, False
        self._tried, self._tries = -1, 0
        self._asked: Future[Done] | None = None
        self._over: tuple[VirtualBench, float] | None = None  # when the press is, on the bench's clock

    @property
    def there(self) -> bool:
        """Whether a virtual bench is open."""
        return self._bench.live.bench is not None

    def touch(self, point: NDArray[np.float64], force: float) -> None:
        """Press a point, m, with a force, N; for a little more than a second."""
        bench = self._bench.live.bench
        if bench is not None:
            self._asked, self._over = bench.touch(point_S=point, force=force, seconds=_HELD_S), None

    def press_next(self, touches: LiveTouches, view: TouchView) -> None:
        """Press the next marker, in the middle of its force window."""
        if view.next_one is not None:
            self.touch(touches.markers[view.next_one].point_S, 0.5 * sum(view.window))

    def begin(self) -> None:
        """Go on by itself from now on."""
        self.all, self._tried, self._tries = True, -1, 0

    def end(self) -> None:
        """Do no more."""
        self.all = False

    def tick(self, touches: LiveTouches | None, view: TouchView | None) -> None:
        """Press the next marker, if the one before is over."""
        if self._presses() or not self.all:
            return
        if touches is None or view is None or view.next_one is None:
            self._stop("")
            return
        if view.state is not ProtocolState.ARMED:
            return
        self._tries = self._tries + 1 if view.next_one == self._tried else 1
        self._tried = view.next_one
        if self._tries > max(_MOST_TRIES, view.rows[view.next_one].wanted + 1):
            name = touches.markers[view.next_one].name
            why = "" if view.last is None else view.last.why
            self._stop(
                self.tr(
                    "{name} was pressed {count} times without an accepted touch ({why}). Press Skip"
                    " marker, then Touch all again. Or discard the touches and move the marker."
                ).format(
                    name=name, count=self._tries - 1, why=translated(why) or self.tr("no touch was detected")
                )
            )
            return
        self.press_next(touches, view)

    def _presses(self) -> bool:
        """
        Whether the press before is not over; a press that failed ends it all.

        On the bench's clock: on a computer that is too slow for it a press takes longer than it would, and another
        one before its end would be counted as one that failed.
        """
        bench = self._bench.live.bench
        if self._asked is not None:
            if not self._asked.done():
                return True
            asked, self._asked = self._asked, None
            error = asked.exception()
            if error is not None:
                self._stop(str(error))
                return True
            self._over = None if bench is None else (bench, asked.result().until + _PAUSE_S)
        if self._over is not None and self._over[0] is bench and bench.time < self._over[1]:
            return True
        self._over = None
        return False

    def _stop(self, why: str) -> None:
        self.all = False
        self.stopped.emit(why)
