"""The Verify page: somebody touches markers, and shows that contacts are where they should be."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from PySide6.QtWidgets import QLabel, QPushButton, QTabWidget, QVBoxLayout, QWidget

from contactbench.app.bench import Weight
from contactbench.app.page import Page
from contactbench.app.pages.verify_editing import MarkerEditing
from contactbench.app.pages.verify_leaving import Leaving
from contactbench.app.pages.verify_live import LiveShow
from contactbench.app.pages.verify_markers import MarkersPanel
from contactbench.app.pages.verify_point import PointPanel
from contactbench.app.pages.verify_result import ResultPanel
from contactbench.app.pages.verify_scene import TouchScene
from contactbench.app.pages.verify_settings import SettingsPanel
from contactbench.app.pages.verify_touch import TouchPanel
from contactbench.app.pages.verify_undo import ChangeSettings
from contactbench.app.pages.verify_virtual import Toucher
from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.workbench.markers import Markers, kept
from contactbench.pipeline.workbench.steps import Step, StepState
from contactbench.pipeline.workbench.verify import (
    Outcome,
    Tool,
    VerifyWork,
    checked_parameters,
    outcome_of,
    parameters_of,
    plain_parameters,
    tool_key,
    tool_of,
    why_locked,
)
from contactbench.widgets.controls import PanelScroll
from contactbench.widgets.phrases import said
from contactbench.widgets.sounds import Sounds

if TYPE_CHECKING:
    from collections.abc import Callable

    from contactbench.app.bench import Bench
    from contactbench.app.jobs import Job
    from contactbench.pipeline.workbench.steps import StepStatus
    from contactbench.widgets.scene.scene import Pick

_MARKERS, _HOW, _POINT, _TOUCH, _RESULT = range(5)


class VerifyPage(Page):
    """
    Markers, how to touch them, a known point, the touches, and the verdict, on a tab each.

    Attributes
    ----------
    work : VerifyWork
    markers : Markers
    """

    step: ClassVar[Step] = Step.VERIFY

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, parent)
        self.work = VerifyWork(bench.desk, bench.live)
        self.markers = Markers()
        self.tool: Tool | None = None
        self.outcome: Outcome | None = None
        self.sounds = Sounds(self)
        self.toucher = Toucher(bench, self)
        self.scene_view = TouchScene(bench)
        self._live = LiveShow(self)
        self._editing, self._leaving = MarkerEditing(self), Leaving(self)
        self.window_N, self.wanted = (8.0, 10.0), 1
        self._entered = self._busy = self._closed = False
        self._read_at = -1
        self._loading: object = None
        self._job: Job | None = None
        self._build()
        self._connect()
        self._allow()

    def _build(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(10, 8, 10, 8)
        title = QLabel(self.tr("Verify"))
        title.setProperty("role", "title")
        column.addWidget(title)
        self.locked = QLabel()
        self.locked.setWordWrap(True)
        self.go = QPushButton(self.tr("Go there"))
        self.go.setMinimumHeight(36)
        self.go.setProperty("primary", True)
        column.addWidget(self.locked)
        column.addWidget(self.go)
        self.tabs = QTabWidget()
        self.tabs.setDocumentMode(True)
        self.tabs.setUsesScrollButtons(False)
        self.panel_markers, self.panel_how = MarkersPanel(), SettingsPanel()
        self.panel_touch, self.panel_result = TouchPanel(), ResultPanel()
        self.panel_point = PointPanel(self.bench)
        for panel, name in (
            (self.panel_markers, self.tr("Markers")),
            (self.panel_how, self.tr("How")),
            (_filling_top(self.panel_point), self.tr("Point")),
            (self.panel_touch, self.tr("Touch")),
            (self.panel_result, self.tr("Result")),
        ):
            self.tabs.addTab(PanelScroll(panel), name)
        column.addWidget(self.tabs, 1)
        column.addStretch(0)

    def _connect(self) -> None:
        touch = self.panel_touch
        self.go.clicked.connect(self._go)
        touch.start_wanted.connect(self.start)
        touch.finish_wanted.connect(self.finish)
        touch.discard_wanted.connect(self.discard)
        touch.skip_wanted.connect(self._leaving.ask)
        touch.repeat_wanted.connect(self._repeat)
        touch.touch_wanted.connect(self._touch_one)
        touch.touch_all_toggled.connect(lambda on: self.toucher.begin() if on else self.toucher.end())
        touch.muted.connect(lambda muted: setattr(self.sounds, "muted", muted))
        touch.heat_toggled.connect(self.scene_view.show_heat)
        self.toucher.stopped.connect(self._touched_all)
        self.panel_how.changed.connect(self._set)
        self._editing.connect_panel()
        self.panel_result.again_wanted.connect(self.start)
        self.panel_result.go_on_wanted.connect(lambda: self.bench.go_to.emit(Step.EXPORT))
        self.panel_markers.touch_wanted.connect(lambda: self.tabs.setCurrentIndex(_TOUCH))
        self.bench.scene.picked.connect(self._picked)

    # ---- shown and hidden ------------------------------------------------------------------------

    def enter(self) -> None:
        """Show markers and contacts in the scene."""
        self._entered = True
        self.scene_view.begin(self.tr("Drawing the heat map"))
        self._read()

    def leave(self) -> None:
        """Take them away; a verification goes on."""
        self._entered = False
        self.panel_markers.pick.setChecked(False)
        self.scene_view.end()

    def show_state(self, status: StepStatus) -> None:
        """Show how the step stands."""
        if self._closed:  # what was under way when the session was closed still ends
            return
        missing = why_locked(self.bench.desk.state)
        locked = bool(missing) or status.state is StepState.LOCKED
        self.locked.setText(said(missing or status.sentence))
        self.locked.setVisible(locked)
        self.go.setVisible(bool(missing))
        self.tabs.setVisible(not locked)
        self._read()
        self._allow()

    def tick(self) -> None:
        """Show the newest of what is live."""
        self._live.tick()
        self.panel_point.poll()

    def watch(self) -> None:
        """Hear of devices and disk while another page is shown."""
        self._live.watch()
        self.panel_point.poll()

    def close_page(self) -> None:
        """End it; what was recorded is kept."""
        self._closed = True
        self.panel_point.close_panel()
        if self._job is not None:
            self._job.cancel()
        # Not here: it may have to wait for what is just being judged, and for the disk.
        self.bench.jobs.start(self.tr("Keeping the recording"), lambda *_: self.work.abandon())
        self.sounds.close()

    def _go(self) -> None:
        state = self.bench.desk.state
        missing = why_locked(state, "calibration")
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
            given = checked_parameters(parameters_of(state))
            self.panel_how.show_parameters(given)
            self.window_N, self.wanted = given.windows[0], given.repeats * len(given.windows)
        except InputError as error:
            self.bench.tell(Weight.ERROR, str(error))

        def work(_progress: object, _cancelled: object) -> tuple[Markers, Outcome | None]:
            return kept(desk.folder, state), outcome_of(desk.folder, state, stale)

        def came(found: tuple[Markers, Outcome | None]) -> None:
            if state.count == self._read_at and not self._closed:
                if not self._editing.pending:
                    self.show_markers(found[0])
                differs = self.outcome.differs if self.outcome is not None and found[1] is not None else ""
                self._show_outcome(found[1], differs)

        self.bench.jobs.start(self.tr("Reading the verification"), work, came, self._not_read)
        self.panel_point.read()
        self._load_tool()

    def read_again(self) -> None:
        """Read everything, also if the session did not change."""
        self._read_at = -1
        self._read()

    def _not_read(self, error: BaseException) -> None:
        if not isinstance(error, InputError):
            raise error
        if not self._closed:
            self.bench.tell(Weight.ERROR, str(error))

    def _load_tool(self) -> None:
        """Load probe and calibration, if they are others than before."""
        desk, state = self.bench.desk, self.bench.desk.state
        key = tool_key(state)
        if key is None or key == self._loading or (self.tool is not None and self.tool.content == key):
            return
        self._loading = key

        def work(_progress: object, _cancelled: object) -> tuple[Tool, ContactSolver]:
            tool = tool_of(desk.folder, state)
            return tool, ContactSolver(tool.probe)

        def came(found: tuple[Tool, ContactSolver]) -> None:
            self._loading = None
            if self._closed:
                return
            self.tool, solver = found
            self.scene_view.probe = self.tool.probe
            self.bench.live.set_model(self.tool.model)
            self.bench.live.set_solver(solver)
            self.panel_markers.show_regions(self._regions())
            if self._entered:
                self.scene_view.begin(self.tr("Drawing the heat map"))
            self._allow()

        def wrong(error: BaseException) -> None:
            self._loading = None
            self._not_read(error)

        self.bench.jobs.start(self.tr("Loading the probe"), work, came, wrong)

    def _regions(self) -> list[tuple[int, str]]:
        if self.tool is None:
            return []
        ranks = sorted({int(rank) for rank in self.tool.probe.region.tolist()} - {0})
        return [(rank, self.tr("region {rank}").format(rank=rank)) for rank in ranks]

    def show_markers(self, markers: Markers) -> None:
        """Show markers that are another set now."""
        self.markers = markers
        self._allow()

    def _show_outcome(self, outcome: Outcome | None, differs: str = "") -> None:
        if outcome is not None and differs and not outcome.differs:
            outcome = outcome.with_difference(differs)
        self.outcome = outcome
        self.panel_result.show_outcome(outcome)

    def _set(self, values: dict[str, object], text: str) -> None:
        """Change settings of the verification."""
        if "order" in values:
            values = {"order": list(self.markers.names) if values["order"] else []}
        try:
            before = plain_parameters(parameters_of(self.bench.desk.state))
            checked_parameters({**parameters_of(self.bench.desk.state), **values})
        except InputError as error:
            self.bench.tell(Weight.WARNING, str(error))
            self.read_again()
            return
        now = {f"verification.{name}": value for name, value in values.items()}
        was = {f"verification.{name}": before[name] for name in values}
        if now != was:
            self.bench.undo.push(ChangeSettings(self.bench, was, now, text))

    def _picked(self, pick: Pick) -> None:
        if self._entered and self.panel_markers.pick.isChecked():
            self._editing.picked(pick)

    # ---- touching --------------------------------------------------------------------------------

    def _do(self, title: str, work: Callable[..., object], done: Callable[..., None]) -> None:
        self._busy = True
        self._allow()

        def over(found: object) -> None:
            self._busy, self._job = False, None
            if not self._closed:
                done(found)
                self._allow()

        def wrong(error: BaseException) -> None:
            self._busy, self._job = False, None
            if self._closed:
                return
            self.bench.set_running(Step.VERIFY, self.work.going_on)
            self._allow()
            if not isinstance(error, InputError):
                raise error
            self.panel_touch.say(str(error))
            self.bench.tell(Weight.ERROR, str(error))

        self._job = self.bench.jobs.start(title, work, over, wrong)

    def start(self) -> None:
        """Begin to follow and record touches."""
        tool, markers = self.tool, self.markers
        if tool is None or not len(markers) or self._busy or self.work.going_on:
            return
        self.tabs.setCurrentIndex(_TOUCH)
        self.panel_touch.say("")
        self.scene_view.forget_contacts()

        def began(_: object) -> None:
            self.bench.set_running(Step.VERIFY, self.work.going_on)

        self._do(
            self.tr("Measuring the noise"),
            lambda _, cancelled: self.work.start(tool, markers, cancelled),
            began,
        )

    def finish(self) -> None:
        """Keep the recording and judge it."""
        if self._busy or not self.work.going_on:
            return
        self.toucher.end()

        def judged(outcome: object) -> None:
            self.bench.set_running(Step.VERIFY, False)
            if isinstance(outcome, Outcome):
                self._show_outcome(outcome)
                self.panel_touch.say("")  # what was wrong while it was recorded: the verdict says it better
                self.tabs.setCurrentIndex(_RESULT)
                self.sounds.play("done")
                good = outcome.passed
                self.bench.tell(
                    Weight.GOOD if good else Weight.WARNING,
                    self.tr("The verification passed.")
                    if good
                    else self.tr("The verification did not pass."),
                )

        self._do(self.tr("Judging the touches"), lambda *_: self.work.finish(), judged)

    def discard(self) -> None:
        """End it without a verdict."""
        if not self._busy and self.work.going_on:
            self.toucher.end()
            self._do(
                self.tr("Ending the recording"),
                lambda *_: self.work.discard(),
                lambda _: self.bench.set_running(Step.VERIFY, False),
            )

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

    def _allow(self) -> None:
        going_on = self.work.going_on
        ready = self.tool is not None and len(self.markers) > 0
        self.panel_touch.allow(ready=ready, going_on=going_on, virtual=self.toucher.there, busy=self._busy)
        self.panel_markers.lock(going_on or self._busy or self.tool is None)
        self.panel_how.setEnabled(not going_on and not self._busy)
        known = [(each.name, each.point_S.tolist()) for each in self.markers.all]
        self.panel_point.show_markers(known, None if self.tool is None else self.tool.model)
        self.panel_point.setEnabled(not going_on and not self._busy)
        self._live.show_idle()


def _filling_top(panel: QWidget) -> QWidget:
    """Return a panel at the top of its tab, with what is left empty below it."""
    widget = QWidget()
    column = QVBoxLayout(widget)
    column.setContentsMargins(0, 8, 0, 0)
    column.addWidget(panel)
    column.addStretch(1)
    return widget
