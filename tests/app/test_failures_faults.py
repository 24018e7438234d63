"""Exceptions where nobody expects one: in a slot, a worker, a stream's thread, a page, a scene; told, and survived."""

from __future__ import annotations

import errno
import threading

import pytest
from PySide6.QtCore import QObject, Qt, Signal

from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.live import Ring

from .failures import prepared, whole

pytestmark = pytest.mark.qt_no_exception_capture


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return prepared(tmp_path_factory.mktemp("made"))


@pytest.fixture
def open_window(qtbot, folder, tmp_path):
    with whole(qtbot, tmp_path) as made:
        made.open(folder)
        made.wait(lambda: made.window.bench.connected)
        yield made


def wait_told(made, words, *, times=1):
    """It is in the list, the log and the journal; and the window lives."""
    made.wait_said(words, "your session is safe")
    assert words in made.log.read()
    notes = lambda: [note for note in made.window.bench.desk.state.notes if words in note.text]  # noqa: E731
    made.wait(lambda: len(notes()) >= times)
    assert len(notes()) == times
    assert made.alive()


class Sender(QObject):
    sent = Signal()


def test_in_a_slot(open_window):
    def slot():
        raise ZeroDivisionError("in a slot")

    sender = Sender()
    sender.sent.connect(slot)
    sender.sent.emit()
    sender.sent.emit()
    wait_told(open_window, "in a slot")  # the same one again is one note


def test_in_a_worker_and_in_what_follows_it(open_window):
    def work(_progress, _cancelled):
        raise KeyError("in a worker")

    def done(_):
        raise ValueError("after a worker")

    jobs = open_window.window.bench.jobs
    jobs.start("Working", work)
    wait_told(open_window, "in a worker")
    jobs.start("Working", lambda _progress, _cancelled: None, done)
    wait_told(open_window, "after a worker")
    open_window.idle()  # neither is still shown as running


def test_at_the_desk(open_window):
    def action(_session):
        raise ArithmeticError("at the desk")

    open_window.window.bench.do("Doing", action)
    wait_told(open_window, "at the desk")
    open_window.window.bench.desk.do(lambda session: session.note("continues")).result(10)


def test_in_a_follower_while_samples_come(open_window):
    calls = []

    def follower(_block):
        calls.append(None)
        raise LookupError("in a follower")

    live = open_window.window.bench.live
    end = live.follow(follower)
    wait_told(open_window, "in a follower")
    open_window.wait(lambda: len(calls) > 20)
    count = live.samples
    open_window.wait(lambda: live.samples > count)  # the devices go on
    end()
    assert sum("in a follower" in text for text in open_window.window.messages.texts()) == 1


def test_in_the_streams_own_thread(open_window, monkeypatch):
    live = open_window.window.bench.live

    def add(*_):
        monkeypatch.undo()
        raise OverflowError("in a stream")

    monkeypatch.setattr(Ring, "add", add)
    open_window.wait_said("in a stream")
    assert open_window.alive()
    count = live.samples
    try:
        open_window.wait(lambda: live.samples > count, timeout=10_000)
    except Exception:  # noqa: BLE001
        pytest.fail(f"the samples stopped: {open_window.window.messages.texts()}")


def test_in_a_thread_of_somebody(open_window):
    def run():
        raise EOFError("in a thread")

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    wait_told(open_window, "in a thread")


@pytest.mark.parametrize("step", list(Step))
def test_in_each_page(open_window, monkeypatch, step):
    page = open_window.page(step)

    def raises(*_):
        raise AttributeError(f"in the page of {step}")

    for name in ("tick", "show_state", "leave"):
        monkeypatch.setattr(page, name, raises)
    wait_told(open_window, f"in the page of {step}")
    other = Step.EXPORT if step is not Step.EXPORT else Step.DEVICES
    open_window.page(other)
    assert open_window.window.pages.step is other
    monkeypatch.undo()
    open_window.page(step)
    open_window.window.pages.tick()


def test_in_the_scene_and_in_the_charts(open_window, monkeypatch):
    window = open_window.window
    open_window.page(Step.GRAVITY)

    def raises(*_, **__):
        raise RuntimeError("in the scene")

    monkeypatch.setattr(window.scene, "show_orientation", raises)
    wait_told(open_window, "in the scene")
    monkeypatch.undo()

    def falters(*_):
        raise FloatingPointError("in the charts")

    monkeypatch.setattr(window.live.charts, "tick", falters)
    wait_told(open_window, "in the charts")


def test_a_full_disk_and_no_memory_are_no_riddles(open_window):
    def full(_progress, _cancelled):
        raise OSError(errno.ENOSPC, "No space left on device")

    def large(_progress, _cancelled):
        raise MemoryError

    jobs = open_window.window.bench.jobs
    jobs.start("Writing", full)
    open_window.wait_said("disk is full", "free some space")
    jobs.start("Reading", large)
    open_window.wait_said("not enough memory", "smaller file")
    assert not open_window.unexpected


def test_the_details_are_one_click_away(open_window, qtbot):
    def work(_progress, _cancelled):
        raise KeyError("in a worker")

    open_window.window.bench.jobs.start("Working", work)
    open_window.wait_said("in a worker")
    messages = open_window.window.messages
    assert "Traceback" not in messages.texts()[0]
    messages._list.setCurrentRow(0)
    qtbot.mouseClick(messages._more, Qt.MouseButton.LeftButton)
    assert "Traceback" in messages._details.toPlainText()
