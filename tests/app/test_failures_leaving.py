"""Leaving while work goes on: asked, waited for, stopped with all that was done, or not left at all."""

from __future__ import annotations

import threading

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence
from workbench.probe_files import egg

from contactbench.app.pages.gravity_run import Phase
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.probe import draft_of

from .conftest import shown
from .failures import whole


@pytest.fixture
def made(qtbot, tmp_path):
    with whole(qtbot, tmp_path) as window:
        shown(qtbot, window.window, lambda: window.window.sessions.try_virtual(tmp_path / "s"))
        window.wait(lambda: window.window.bench.connected)
        yield window


def quit_by_key(made):
    """Do what the key does; the key itself reaches the window only where a window manager gives it the focus."""
    quits = [each for each in made.window.findChildren(QAction) if QKeySequence("Ctrl+Q") in each.shortcuts()]
    assert len(quits) == 1
    quits[0].trigger()


def answer(made, button):
    made.wait(button.isVisible)
    made.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def record_gravity(made):
    page = made.page(Step.GRAVITY)
    made.wait(page.primary.isEnabled)
    made.qtbot.mouseClick(page.primary, Qt.MouseButton.LeftButton)
    made.wait(lambda: page.run.phase is Phase.CAPTURING and page.run._tape.seconds > 0.5)
    return page


def test_with_nothing_going_on_nothing_is_asked(made):
    made.idle()
    quit_by_key(made)
    assert made.window.departure.question is None
    made.wait(lambda: not made.window.isVisible())


def test_not_closed_after_all(made, tmp_path):
    page = record_gravity(made)
    departure = made.window.departure
    quit_by_key(made)
    assert "Recording a" in departure.question.text()
    assert departure.wait is None  # a recording does not end by itself
    quit_by_key(made)  # asked once
    answer(made, departure.stay)
    made.wait(lambda: departure.question is None)
    assert made.alive()
    assert page.run.phase is Phase.CAPTURING
    # Another session is not opened either, now or when this one is closed.
    made.window.sessions.new(tmp_path / "other")
    answer(made, departure.stay)
    made.qtbot.mouseClick(page.second, Qt.MouseButton.LeftButton)
    made.wait(lambda: page.run.phase is Phase.IDLE)
    made.window.close_session()
    made.wait(lambda: made.window.bench is None)
    made.idle()
    assert made.window.bench is None
    assert not (tmp_path / "other").exists()
    assert not made.unexpected


def test_stopped_a_recording_is_kept(made, tmp_path):
    record_gravity(made)
    quit_by_key(made)
    answer(made, made.window.departure.stop)
    made.wait(lambda: not made.window.isVisible())
    assert not made.unexpected
    with Session.open(tmp_path / "s") as session:
        assert ("recording", "gravity-1.mcap") in session.state.current_inputs
    assert not check(tmp_path / "s").problems


def test_waited_for_it_is_closed_when_the_work_is_done(made, tmp_path):
    stages, may_end, ended = made.page(Step.PROBE).stages, threading.Event(), []
    made.wait(lambda: not stages.worker.busy)
    stages.take(egg(tmp_path))
    made.wait(lambda: draft_of(made.window.bench.desk.state) is not None)
    stages.worker.start("Working", lambda _progress, _cancelled: may_end.wait(60), ended.append)
    quit_by_key(made)
    departure = made.window.departure
    assert "Preparing the probe" in departure.question.text()
    answer(made, departure.wait)
    made.wait(lambda: departure.waiting)
    assert made.alive()  # meanwhile it can be used
    may_end.set()
    made.wait(lambda: not made.window.isVisible())
    assert ended == [True]  # neither stopped nor left before its end
    assert not made.unexpected
    with Session.open(tmp_path / "s", write=False) as session:
        assert draft_of(session.state).name == "egg.stl"
