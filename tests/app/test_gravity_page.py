from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from workbench.gravity_bench import batches, record

from contactbench.app.pages.gravity import GravityPage
from contactbench.app.pages.gravity_run import Phase
from contactbench.pipeline.calibration import Level
from contactbench.pipeline.session import Session
from contactbench.pipeline.steps import StepState, StepStatus
from contactbench.pipeline.workbench.gravity_fit import GravityFinding, PoseState, Solved

from .page_window import PageWindow

STEPWISE = "virtual://bench?probe=t-shape&sensor=paper&speed=step"
_TURN = "Move virtual tool there"
READY = StepStatus(StepState.READY, "Take poses.")


class Window(PageWindow):
    """On a bench whose clock goes when it is told."""

    def __init__(self, qtbot, folder, prepare=None):
        session = Session.create(folder)
        if prepare is not None:
            prepare(session)
        super().__init__(qtbot, session, GravityPage)
        self.enter(READY)

    def open(self, sensor=STEPWISE, poses=STEPWISE):
        self.bench.live.open(sensor, poses)

    def until(self, condition, steps=250, poll=None):
        super().until(condition, steps, poll)

    def press(self, button):
        self.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)

    def start(self):
        self.press(self.page.primary)
        self.until(lambda: self.page.run.phase is Phase.CAPTURING, steps=0)

    def take(self, count):
        """Let the wrist go from proposed pose to proposed pose."""
        for _ in range(count):
            before = len(self.page.panel.table.rows)
            self.turn(steps=25)
            self.until(lambda before=before: len(self.page.panel.table.rows) > before)
            self.until(lambda: not self.page.run.work.view().busy, steps=0)
            self.page.tick()

    def turn(self, steps=0):
        bar = self.page.bar
        self.until(lambda: _TURN in (bar.primary.text(), bar.second.text()), steps)
        self.press(bar.primary if bar.primary.text() == _TURN else bar.second)

    def finish(self):
        self.until(lambda: self.page.primary.text() == "Finish", steps=0)
        self.press(self.page.primary)
        self.until(lambda: self.page.run.phase is Phase.IDLE, steps=0)


@pytest.fixture
def window(qtbot, tmp_path):
    made = []

    def make(prepare=None):
        made.append(Window(qtbot, tmp_path / "s", prepare))
        return made[-1]

    yield make
    for each in made:
        each.close()


def test_from_start_to_a_checked_calibration_by_clicks(window):
    w = window()
    w.open()
    page, panel = w.page, w.page.panel
    assert page.primary.text() == "Start"
    w.start()
    assert (page.second.text(), page.second.isEnabled()) == ("Finish", False)  # there are no three poses
    w.until(lambda: w.scene.ghost is not None, steps=0)
    w.take(5)
    assert w.scene.R_WS is not None
    assert panel.figures.error.text().endswith(" mm")
    assert panel.figures.count.text() == "5 poses: you can finish"
    assert page.primary.text() == "Finish"
    assert page.primary.property("primary")
    assert page.second.text() == _TURN, "more poses can still be taken"
    assert [row.state for row in panel.table.rows] == [PoseState.TAKEN] * 5
    w.finish()
    assert page.run.outcome.calibration.verdict.level is Level.GOOD
    w.until(lambda: w.bench.live.model is not None, steps=0)
    assert ("calibration", "calibration.json") in w.bench.desk.state.current_results
    assert ("recording", "gravity-1.mcap") in w.bench.desk.state.current_inputs
    assert panel.verdict.text.startswith("Good")

    assert w.bench.undo.undoText() == "calibrate gravity"
    w.bench.undo.undo()
    w.until(lambda: page.run.outcome is None, steps=0)
    assert w.bench.desk.state.current_results["calibration", "calibration.json"].rejected
    assert not page.run.left_behind  # its poses were taken: it is no run that was cut short
    w.bench.undo.redo()
    w.until(lambda: page.run.outcome is not None and page.run.phase is Phase.IDLE, steps=0)
    assert panel.verdict.text.startswith("Good")

    assert page.primary.text() == "Next: Probe"
    assert panel.more.isVisible()  # what is good can still be made better, or anew
    assert panel.anew.isVisible()
    w.press(page.second)  # check one more pose
    w.until(lambda: page.run.phase is Phase.CHECKING, steps=0)
    w.turn()
    w.until(lambda: page.run.checked is not None)
    assert page.run.checked.passed
    assert panel.checked.isVisible()
    assert any("had not seen (gravity-check-1.mcap)" in note.text for note in w.bench.desk.state.notes)
    assert ("recording", "gravity-check-1.mcap") in w.bench.desk.state.current_inputs


def test_poses_are_left_out_by_key_and_undone(window):
    w = window(lambda session: record(session, "gravity-1.mcap", batches()))
    table = w.page.panel.table
    w.until(lambda: w.page.primary.text().startswith("Continue gravity-1"))
    w.bench.do("compute", lambda session: _computed(session))
    w.until(lambda: w.page.run.outcome is not None)
    assert len(table.rows) == 6
    table.setFocus()
    table.selectRow(1)
    w.qtbot.keyClick(table, Qt.Key.Key_Delete)
    w.until(lambda: w.page.run.phase is Phase.IDLE and len(w.page.run.outcome.leave_out) == 1)
    assert table.rows[-1].state is PoseState.LEFT_OUT
    assert "leave out pose 2" in w.bench.undo.undoText()
    w.bench.undo.undo()
    w.until(lambda: w.page.run.phase is Phase.IDLE and not w.page.run.outcome.leave_out)
    assert [row.state for row in table.rows] == [PoseState.TAKEN] * 6


def _computed(session):
    from contactbench.pipeline.workbench.gravity_fit import finish

    return finish(session, "gravity-1.mcap")


def test_by_key_the_space_bar_takes_poses(window):
    w = window()
    w.open()
    w.press(w.page.panel.automatic)
    w.start()
    w.take(1)

    # The wrist may have been sent away from a moment that was nearly still: such a one is told as rejected.
    def states():
        return {row.state for row in w.page.panel.table.rows}

    w.until(
        lambda: w.page.panel.state.word == "still: press SPACE" and PoseState.LEFT_OUT in states(), steps=50
    )
    assert PoseState.TAKEN not in states()
    w.widget.activateWindow()
    w.qtbot.waitUntil(w.widget.isActiveWindow, timeout=20_000)
    w.qtbot.keyClick(w.widget, Qt.Key.Key_Space)
    w.until(lambda: w.page.panel.table.rows[-1].state is PoseState.TAKEN, steps=50)
    w.until(lambda: w.page.panel.state.word == "captured", steps=0)
    assert w.page.run.work.view().count == 1
    w.page.leave()
    assert not w.page.space.isEnabled()
    w.page.enter()
    assert w.page.space.isEnabled()


def test_a_bump_is_shown_and_costs_nothing(window):
    w = window()
    w.open()
    w.start()
    w.take(1)
    w.turn()
    w.until(lambda: w.page.panel.state.word == "still", steps=20)
    w.press(w.page.panel.bump)
    w.until(lambda: w.page.panel.state.word == "bumped", steps=5)
    # The pose before the bump may have been left while it was averaged: the wrist is turned as soon as one can.
    ends = [(PoseState.REJECTED, True), (PoseState.TAKEN, False)]
    w.until(lambda: [(row.state, row.reason != "") for row in w.page.panel.table.rows[-2:]] == ends)


def test_a_refused_calibration_says_why_and_its_remedy_mends_it(window):
    def wrong(session):
        session.set_parameter("devices.mount", [0.0, 0.0, 90.0])
        record(session, "gravity-1.mcap", batches())

    w = window(wrong)
    w.bench.do("compute", lambda session: _computed(session))
    w.until(lambda: w.page.run.outcome is not None)
    panel = w.page.panel
    assert panel.verdict.level == "refuse"
    assert w.page.primary.text() == "Add poses"
    (button, *_) = panel.findings.buttons
    assert "mount" in button.accessibleName()
    w.press(button)
    w.until(lambda: w.page.run.outcome.calibration.verdict.level is Level.GOOD)
    assert np.abs(w.bench.desk.state.settings["devices.mount"].value).max() < 0.01
    w.bench.undo.undo()
    w.until(lambda: w.page.run.outcome.calibration.verdict.level is Level.REFUSE)


def test_findings_are_told_while_another_page_is_shown(window):
    w = window()
    run = w.page.run
    w.open()
    w.start()
    w.page.leave()
    found = GravityFinding(
        "rejected pose 2", "Pose 2: bumped. Retake it, or continue with 3 poses.", leave_out=(1,)
    )
    run.work._solved = Solved(None, None, (found,))
    w.page.watch()  # as the window calls it for all pages; the page is not ticked
    assert found.sentence in w.said()
    run.work._solved = Solved(None, None, (replace(found, sentence="Pose 2: bumped. Go on with 4 poses."),))
    w.page.watch()
    assert sum(text.startswith("Pose 2: bumped") for text in w.said()) == 1, "told once, not with each pose"


def test_stopping_keeps_the_recording(window):
    w = window()
    w.open()
    w.start()
    w.until(lambda: w.page.run.work.view().R_WS is not None)
    w.press(w.page.panel.stop)
    w.until(lambda: w.page.run.phase is Phase.IDLE, steps=0)
    assert ("recording", "gravity-1.mcap") in w.bench.desk.state.current_inputs
    w.until(lambda: w.page.primary.text() == "Continue gravity-1.mcap", steps=0)
    w.press(w.page.primary)  # there is no still pose in it
    w.until(lambda: bool(w.page.run.problem), steps=0)
    assert "hold more poses still" in w.page.panel.problem.text


def test_without_devices_or_poses_it_says_what_to_choose(window):
    w = window()
    w.press(w.page.primary)
    assert "Choose and open a sensor under Devices first" in w.page.panel.problem.text
    w.open("virtual://bench?probe=convex&speed=step", None)
    w.press(w.page.primary)
    assert "No pose source" in w.page.panel.problem.text
    assert w.page.run.phase is Phase.IDLE
    w.page.show_state(StepStatus(StepState.LOCKED, "Choose devices first."))
    assert w.page.primary.text() == "Open Devices"
    assert "Choose devices first." in w.page.panel.problem.text


def test_nothing_is_cut_in_the_narrow_panel(window):
    w = window()
    w.open()
    w.start()
    w.take(4)
    panel = w.page.panel
    assert panel.widget().minimumSizeHint().width() <= panel.viewport().width()
    for button in (w.page.primary, w.page.second, panel.stop, panel.bump, panel.out, panel.back):
        assert button.height() >= 36
        assert button.fontMetrics().horizontalAdvance(button.text()) < button.width()


def test_the_largest_tilt_is_a_parameter_of_the_session(window):
    w = window()
    w.page.panel.tilt.setValue(90)
    w.until(lambda: "devices.max_tilt" in w.bench.desk.state.settings)
    assert w.bench.desk.state.settings["devices.max_tilt"].value == 90.0
    w.bench.undo.undo()
    w.until(lambda: w.page.panel.tilt.value() == 180)
