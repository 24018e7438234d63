"""The page on which the tool is weighed: captures in still poses, and what they amount to."""

from collections.abc import Callable, Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QApplication, QLineEdit, QWidget

from contactbench.app.bench import Bench, Page, Weight
from contactbench.app.pages.gravity_panel import GravityPanel
from contactbench.app.pages.gravity_run import GravityRun, Phase
from contactbench.app.pages.known_check import KnownCheckPanel
from contactbench.pipeline.calibration import Level
from contactbench.pipeline.calibration.model import DOWN_W, STANDARD_GRAVITY
from contactbench.pipeline.calibration.stillness import StillState
from contactbench.pipeline.errors import message
from contactbench.pipeline.steps import Step, StepState, StepStatus
from contactbench.pipeline.verification.known_check import WEIGHT
from contactbench.pipeline.workbench.gravity import GravityView, GravityWork
from contactbench.pipeline.workbench.gravity_fit import (
    DOWN,
    FEWEST,
    ORIENTATION_NOISE,
    TILT,
    GravityFinding,
    PoseRow,
    PoseState,
)
from contactbench.pipeline.workbench.verify import StillReading
from contactbench.widgets.controls import accent, form, named, push_button, sentence_label, show_quietly
from contactbench.widgets.glance import Glance
from contactbench.widgets.messages import NumberBox, translated
from contactbench.widgets.verdict_box import LOCKED, REFUSE

Choice = tuple[str, Callable[[], None]]  # a button's text, and what it does

_BUMP_N = [6.0, 0.0, 0.0]
_SO_FAR = {"good": message("good"), "usable": message("usable"), "refuse": message("not good enough to use")}


class GravityPage(Page):
    """The gravity step."""

    step: ClassVar[Step] = Step.GRAVITY

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, parent)
        self.run = GravityRun(bench, self)
        self.panel, self.weight = GravityPanel(), WeightPanel(bench)
        self.panel.add_check(self.weight)
        self.primary, self.second = self.bar.primary, self.bar.second
        self._shown, self._heard = -1, -1
        self._locked = self._entered = self._fitted = False
        self._view: GravityView | None = None  # of the last tick
        self.fill(self.panel)
        self.space = QShortcut(QKeySequence(Qt.Key.Key_Space), self)
        self.space.setContext(Qt.ShortcutContext.WindowShortcut)
        self.space.setWhatsThis(self.tr("Capture this pose (gravity)"))
        self._connect()
        self._show()

    def _connect(self) -> None:
        panel, run = self.panel, self.run
        run.changed.connect(self._show)
        self.weight.changed.connect(self._show_buttons)
        self.space.activated.connect(self._take)
        panel.automatic.toggled.connect(run.set_automatic)
        panel.table.leave_out.connect(lambda rows: self._leave_out(rows, left_out=True))
        panel.table.take_back.connect(lambda rows: self._leave_out(rows, left_out=False))
        panel.table.selectionModel().selectionChanged.connect(self._show_selection)
        panel.findings.confirmed.connect(self._confirm)
        panel.more.clicked.connect(lambda: self._begin(again=False))
        panel.anew.clicked.connect(lambda: self._begin(again=True))
        panel.stop.clicked.connect(run.stop)
        panel.bump.clicked.connect(self._bump)
        panel.tilt.valueChanged.connect(self._set_tilt)
        panel.down.activated.connect(self._set_down)
        panel.orientation_noise.activated.connect(self._set_orientation_noise)

    # ---- what the window calls ---------------------------------------------------------------------

    def enter(self) -> None:
        """Be shown."""
        self._entered, self._fitted = True, False
        if self._show_tool() is None:
            self.bench.scene.look("fit")
        self.run.reload()
        self.weight.read()
        self._show()

    def leave(self) -> None:
        """Be hidden; captures go on."""
        self._entered = False
        self.space.setEnabled(False)
        self.bench.scene.show_ghost(None)
        self.bench.scene.show_orientation(None)

    def show_state(self, status: StepStatus) -> None:
        """Show how the step stands."""
        self._locked = status.state is StepState.LOCKED
        self.run.reload()
        self.weight.read()
        self._show()
        if self._locked:
            self.panel.problem.show_verdict(LOCKED, [status.sentence])
            self.panel.problem.show()

    def tick(self) -> None:
        """Show the newest of what is live."""
        self.run.poll()
        self.weight.poll()
        R_WS = self._show_tool()
        self.panel.coverage.show_now(R_WS)
        if self.run.work is not None:
            pair = self.bench.live.pair
            self._view = self.run.work.view(None if pair is None else pair.now())
            self._show_view(self._view)
            self._show_buttons()
        elif self.run.check is not None:
            self.panel.state.show_state(self.run.check.state)
            self.panel.sentence.setText(translated(self.run.check.sentence))
            self.panel.show_away(R_WS, self.run.check.proposal)
            self._show_buttons()

    def glance(self, status: StepStatus) -> Glance:
        """Return how many poses there are and how the tool moves, or what the calibration amounts to."""
        panel, run, work = self.panel, self.run, self.run.work
        if work is not None and run.phase is Phase.CAPTURING:
            view, state = self._newest(work), panel.state
            words = (panel.problem.text if run.problem else "", self.bar.words, panel.away.text(), state.line)
            of = self.tr("poses captured") if view.solved.enough else self.tr("poses captured, of about {}")
            return Glance(
                state.word, "\n".join(filter(None, words)), str(view.count), of.format(view.expected), state.role,
                share=state.share,
            )  # fmt: skip
        if run.check is not None:
            doing = "\n".join((panel.away.text(), panel.sentence.text()))
            return Glance(panel.state.word, doing, role=panel.state.role)
        if run.outcome is None or run.phase is not Phase.IDLE:
            return super().glance(status)
        box = panel.verdict if run.checked is None else panel.checked
        error = panel.figures.error.text()
        return Glance(
            box.word, box.reasons, error, self.tr("contact error from calibration (1 sigma)"), role=box.role
        )

    def watch(self) -> None:
        """Hear of findings while another page is shown."""
        self.run.poll()
        self.weight.poll()

    def close_page(self) -> None:
        """End everything."""
        self.run.close()
        self.weight.close_panel()

    # ---- what it shows -----------------------------------------------------------------------------

    def _now(self) -> NDArray[np.float64] | None:
        reading = self.bench.live.reading() if self.bench.live.pair is not None else None
        return None if reading is None or not np.isfinite(reading.R_WS).all() else reading.R_WS

    def _show_tool(self) -> NDArray[np.float64] | None:
        """Show the tool as it is held, R_WS, and all of its world as soon as that is known; None: it is not."""
        R_WS = self._now()
        self.bench.scene.show_orientation(R_WS)
        if R_WS is not None and not self._fitted:
            self._fitted = True
            self.bench.scene.look("fit")
        return R_WS

    def _newest(self, work: GravityWork) -> GravityView:
        """Return how the captures stand, as the last tick has it: it costs too much to be asked for each button."""
        if self._view is None:
            self._view = work.view()
        return self._view

    def _show(self) -> None:
        """Show all that does not change by itself."""
        self._shown, self._view = -1, None
        run, panel = self.run, self.panel
        capturing, checking = run.phase is Phase.CAPTURING, run.phase is Phase.CHECKING
        outcome = run.outcome if run.phase in {Phase.IDLE, Phase.CHECKING} else None
        self.space.setEnabled(self._entered and capturing)
        panel.stop.setVisible(capturing or checking)
        panel.problem.setVisible(bool(run.problem))
        if run.problem:
            panel.problem.show_verdict(REFUSE, [run.problem], self.tr("Action failed"))
        panel.intro.setVisible(run.phase is Phase.IDLE and outcome is None)
        # No "captured" beside what is wrong: while nothing is recorded, nothing is captured.
        well = not (run.problem or self.bench.trouble.devices or self.bench.trouble.disk)
        panel.state.setVisible((capturing or checking) and well)
        panel.sentence.setVisible((capturing or checking) and well)
        panel.automatic.setVisible(
            capturing or (run.phase is Phase.IDLE and outcome is None and not self._locked)
        )
        panel.figures.setVisible(capturing or outcome is not None)
        panel.verdict.setVisible(outcome is not None)
        panel.checked.setVisible(run.checked is not None and outcome is not None)
        refused = outcome is not None and outcome.calibration.verdict.level is Level.REFUSE
        self.weight.setVisible(run.phase is Phase.IDLE and outcome is not None and not refused)
        for widget in (panel.table, panel.out, panel.back, panel.coverage):
            widget.setVisible(capturing or outcome is not None)
        self._show_tilt()
        if not capturing:
            self._show_result()
        self._show_buttons()
        self._show_selection()

    def _show_result(self) -> None:
        """Show what the session has."""
        run, panel = self.run, self.panel
        outcome = None if run.busy else run.outcome
        check = run.check
        panel.next.hide()
        panel.away.setVisible(check is not None)
        panel.bump.hide()
        self.bench.scene.show_ghost(check.proposal if check is not None and self._entered else None)
        panel.findings.show_findings(() if outcome is None else outcome.findings)
        if outcome is None:
            return
        fitted = outcome.calibration
        panel.verdict.show_verdict(fitted.verdict.level.value, fitted.verdict.reasons)
        panel.figures.show_figures(
            int(fitted.kept.sum()), len(fitted.poses), (fitted.contact_error,), running=False
        )
        panel.coverage.show_poses(outcome.rows, None if check is None else check.proposal, *self._limits())
        panel.table.show_rows(outcome.rows)
        if run.checked is not None:
            verdict = run.checked.verdict
            panel.checked.show_verdict(
                verdict.level.value, verdict.reasons, self.tr("Checked with a new pose")
            )

    def _show_view(self, view: GravityView) -> None:
        """Show the captures as they come."""
        panel = self.panel
        panel.state.show_state(
            view.state,
            seconds=view.seconds,
            share=view.progress,
            captured=view.captured,
            by_key=not self.run.automatic,
            wanted=view.wanted,
        )
        asked = view.state is StillState.STILL and not (self.run.automatic or view.captured or view.wanted)
        # What is averaged is not taken yet.
        panel.sentence.setText("" if asked else translated(view.sentence))
        goal = view.solved.proposal
        panel.show_away(self._now(), None if goal is None else goal.R_WS)
        if view.revision * 2 + view.busy == self._shown:
            return
        self._shown = view.revision * 2 + view.busy
        proposal = view.solved.proposal
        panel.table.show_rows(view.rows)
        panel.coverage.show_poses(view.rows, None if proposal is None else proposal.R_WS, *self._limits())
        panel.figures.show_figures(view.count, view.expected, view.errors, running=True)
        panel.findings.show_findings(view.solved.findings)
        panel.show_next(proposal, virtual=self.bench.live.bench is not None, running=True)
        self.bench.scene.show_ghost(None if proposal is None or not self._entered else proposal.R_WS)
        fitted = view.solved.calibration
        # One headline at a time: before there are enough poses, how the tool is held is what matters.
        shown = fitted is not None and view.solved.enough
        panel.verdict.setVisible(shown)
        if fitted is not None and shown:
            panel.verdict.show_verdict(
                fitted.verdict.level.value,
                fitted.verdict.reasons,
                self.tr("So far: {level}").format(level=translated(_SO_FAR[fitted.verdict.level.value])),
            )
        self._beep(view.rows)
        self._show_buttons()
        self._show_selection()

    def _beep(self, rows: tuple[PoseRow, ...]) -> None:
        """Let it be heard that a pose was taken: nobody needs to look."""
        taken = sum(row.state is PoseState.TAKEN and not row.earlier for row in rows)
        if taken > self._heard >= 0:
            QApplication.beep()
        self._heard = taken

    def _show_buttons(self) -> None:
        run, bar = self.run, self.bar
        (words, _), second = self._choices()
        virtual = self.bench.live.bench is not None
        # for the machine, or for somebody to turn the tool
        waits = run.busy or (run.phase is Phase.CHECKING and not virtual) or self.weight.busy
        can, few = not waits, run.work is not None and self._newest(run.work).count < FEWEST
        tip = self.tr("A calibration needs at least three poses.") if few else ""
        good = run.work is not None or (
            run.phase is not Phase.IDLE or not (self._mendable() or self.weight.unloaded)
        )
        if self._locked and not waits and run.phase is Phase.IDLE:
            words, good = self.tr("Open Devices"), True
        elif self._locked:
            can = False
        bar.offer(words, lambda: self._press(0), enabled=can, accented=good, tip=tip)
        free = not (run.busy or self.weight.busy or self._locked)
        tell = "" if second is None else second[0]
        bar.offer_second(tell, lambda: self._press(1), enabled=free and not few, tip=tip)
        outcome = run.outcome if run.phase is Phase.IDLE else None
        self.panel.more.setVisible(outcome is not None and outcome.changeable)
        self.panel.anew.setVisible(outcome is not None)
        for button in (self.panel.more, self.panel.anew):
            button.setEnabled(free)

    def _begin(self, *, again: bool) -> None:
        """Capture more poses, or all of them anew."""
        outcome = self.run.outcome
        if outcome is not None and not self.run.busy:
            self._heard = -1
            self.run.start("" if again else outcome.recording)

    def _choices(self) -> tuple[Choice, Choice | None]:
        """Return what the primary button does now, and the other if there is one."""
        run = self.run
        match run.phase:
            case Phase.STARTING:
                return (self.tr("Starting…"), lambda: None), None
            case Phase.CAPTURING if run.work is not None:
                view, finish = self._newest(run.work), (self.tr("Finish"), run.finish)
                on = self._turning(view.solved.proposal is not None and not self.panel.there) or (
                    self.tr("Capture pose {} of {}").format(
                        view.count + 1, max(view.expected, view.count + 1)
                    ),
                    self._take,
                )
                return (finish, on) if view.solved.enough else (on, finish)
            case Phase.CHECKING:
                waiting = (self.tr("Waiting for a still pose…"), lambda: None)
                return self._turning(not self.panel.there) or waiting, None
            case Phase.IDLE:
                return self._idle_choices()
            case _:
                return (self.tr("Computing…"), lambda: None), None

    def _turning(self, wanted: bool) -> Choice | None:
        """Return the choice to turn the tool, if that is wanted and a virtual bench can do it."""
        there = self.bench.live.bench is not None
        return (self.tr("Move virtual tool there"), self._turn) if wanted and there else None

    def _idle_choices(self) -> tuple[Choice, Choice | None]:
        run, outcome = self.run, self.run.outcome
        anew = (self.tr("Start over"), lambda: run.start(""))
        if left := run.left_behind:
            return (self.tr("Continue {recording}").format(recording=left), lambda: run.start(left)), anew
        if outcome is None:
            return (self.tr("Start"), lambda: run.start("")), None
        add = (self.tr("Add poses"), lambda: run.start(outcome.recording)) if outcome.changeable else anew
        if outcome.calibration.verdict.level is Level.REFUSE:
            return add, anew if outcome.changeable else None
        check = (self.tr("Check with another pose"), run.begin_check)
        go_on = (self.tr("Next: Probe"), lambda: self.bench.go_to.emit(Step.PROBE))
        if outcome.calibration.verdict.level is Level.GOOD:
            return go_on, check
        return (go_on, add) if run.checked is not None and run.checked.passed else (check, add)

    def _mendable(self) -> bool:
        """Whether there is a finding whose remedy is the thing to do now."""
        outcome = self.run.outcome
        return outcome is not None and any(finding.settings for finding in outcome.findings)

    def _show_selection(self) -> None:
        rows = self.panel.table.selected() if not self.run.busy else ()
        self.panel.out.setEnabled(any(row.state is not PoseState.LEFT_OUT for row in rows))
        self.panel.back.setEnabled(any(row.state is PoseState.LEFT_OUT for row in rows))

    def _max_tilt(self) -> float:
        tilt = self.bench.desk.state.setting(TILT)
        return 180.0 if tilt is None else float(tilt)

    def _limits(self) -> tuple[float, tuple[float, float, float]]:
        """Return the largest tilt, degrees, and where gravity points in W."""
        settings = self.run.settings()
        return self._max_tilt(), DOWN_W if settings is None else settings.down_W

    def _show_tilt(self) -> None:
        show_quietly(self.panel.tilt, round(self._max_tilt()))
        state = self.bench.desk.state
        down = state.setting(DOWN)
        self.panel.show_setting(self.panel.down, DOWN_W if down is None else down)
        self.panel.show_setting(self.panel.orientation_noise, state.setting(ORIENTATION_NOISE))

    # ---- what the buttons do -----------------------------------------------------------------------

    def _press(self, number: int) -> None:
        """Do what a button says; 0: the primary one."""
        if self._locked and not self.run.busy:
            self.bench.go_to.emit(Step.DEVICES)
            return
        choice = self._choices()[number]
        if choice is not None and not self.run.busy:
            if self.run.phase is Phase.IDLE:
                self._heard = -1
            choice[1]()

    def _take(self) -> None:
        words = self.run.take()
        if words:
            self.bench.tell(Weight.INFO, words)

    def _leave_out(self, rows: tuple[PoseRow, ...], *, left_out: bool) -> None:
        if rows and not self.run.busy:
            self.run.leave_out(rows, left_out)

    def _confirm(self, finding: GravityFinding) -> None:
        if not self.run.busy:
            self.run.confirm(finding)

    def _set_tilt(self, degrees: int) -> None:
        self.run.set_parameters(
            self.tr("set the tilt limit to {degrees}°").format(degrees=degrees), ((TILT, float(degrees)),)
        )

    def _set_down(self, index: int) -> None:
        down = self.panel.down.itemData(index)
        self.run.set_parameters(self.tr("set the down direction"), ((DOWN, list(down)),))

    def _set_orientation_noise(self, index: int) -> None:
        degrees = self.panel.orientation_noise.itemData(index)
        self.run.set_parameters(self.tr("set the orientation accuracy"), ((ORIENTATION_NOISE, degrees),))

    # ---- on the virtual bench ----------------------------------------------------------------------

    def _turn(self) -> None:
        """Have the virtual wrist turn to the pose that is proposed."""
        bench = self.bench.live.bench
        R_WS = None
        if self.run.check is not None:
            R_WS = self.run.check.proposal
        elif self.run.work is not None:
            proposal = self._newest(self.run.work).solved.proposal
            R_WS = None if proposal is None else proposal.R_WS
        if bench is not None and R_WS is not None:
            bench.turn_to(R_WS)

    def _bump(self) -> None:
        bench = self.bench.live.bench
        if bench is not None:
            bench.bump(_BUMP_N)


# ---- the known weight of the gravity page: mass, a reading without it, a reading with it ---------


_HUNG_S, _OFF_S = 30.0, 0.01  # on the virtual bench


class WeightPanel(KnownCheckPanel):
    """Hang a known weight on the tool: mass, a reading without it, a reading with it."""

    kind = WEIGHT

    def __init__(self, bench: Bench, parent: QWidget | None = None) -> None:
        super().__init__(bench, "", parent)
        self.setTitle(self.tr("Known weight"))
        self.unloaded = ""
        intro = sentence_label(
            self.tr(
                "Hang a known mass on the tool. This reveals wrong sensor units, signs or scale, which"
                " poses alone cannot show."
            )
        )
        self.mass = NumberBox(decimals=3, minimum=0.001, maximum=500.0, value=1.0, suffix=" kg")
        self.sigma = NumberBox(decimals=2, minimum=0.0, maximum=10_000.0, value=0.5, suffix=" g")
        self.certificate = QLineEdit(maxLength=200, placeholderText=self.tr("Number (optional)"))
        rows = form()
        for text, field, tip in (
            (self.tr("Mass"), self.mass, ""),
            (self.tr("Uncertainty (1 sigma)"), self.sigma, ""),
            (self.tr("Certificate"), self.certificate, self.certificate.placeholderText()),
        ):
            rows.addRow(text, named(field, text, tip=tip))
        self.first = push_button(self.tr("1. Read without weight"), self._read_unloaded, "play")
        self.second = push_button(self.tr("2. Read with weight"), self._read_loaded, "play")
        self.lay_out(intro, rows, self.first, self.second)

    def _read_unloaded(self) -> None:
        self.unloaded = ""
        self.hint.setText(self.tr("Remove everything from the tool and hold it still."))

        def read(name: str) -> None:
            self.unloaded = name
            self.hint.setText(
                self.tr("Done. Hang the weight on the tool, wait until it is at rest, then press 2.")
            )

        self.take(StillReading(), read)

    def _read_loaded(self) -> None:
        bench, reading = self.bench.live.bench, self.bench.live.reading()
        if bench is not None and reading is not None and np.isfinite(reading.R_WS).all():
            down = (
                STANDARD_GRAVITY * self.mass.value() * (reading.R_WS.T @ [0.0, 0.0, -1.0])
            )  # the virtual bench is upright
            bench.bump(down.tolist(), _HUNG_S)
        self.hint.setText(self.tr("Wait until the weight is at rest."))
        given = {
            "mass": self.mass.value(),
            "mass_sigma": self.sigma.value() / 1000,
            "certificate": self.certificate.text().strip(),
        }

        def read(name: str) -> None:
            unloaded, self.unloaded = self.unloaded, ""
            if bench is not None:
                bench.bump([0.0, 0.0, 0.0], _OFF_S)
            self.hint.setText("")
            self.judge({"unloaded": unloaded, "loaded": name}, given)

        self.take(StillReading(), read)

    def show_parameters(self, parameters: Mapping[str, Any]) -> None:
        """Show mass and certificate of the check that there is."""
        if self.unloaded or self.busy:  # another weight is just being typed in
            return
        self.mass.setValue(float(parameters.get("mass", self.mass.value())))
        self.sigma.setValue(1000 * float(parameters.get("mass_sigma", 0.0)))
        self.certificate.setText(str(parameters.get("certificate", "")))

    def allow(self) -> None:
        """Say which buttons do something now."""
        super().allow()
        free = not self.busy
        self.first.setEnabled(free)
        self.second.setEnabled(free and bool(self.unloaded))
        for field in (self.mass, self.sigma, self.certificate):
            field.setEnabled(free)
        accent(self.second, free and bool(self.unloaded), "play")
