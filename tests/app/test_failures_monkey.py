"""Somebody who presses everything in any order, for a minute: nothing is raised, nothing hangs, nothing is lost."""

import errno
import os
import random
import threading

import pytest
from PySide6.QtCore import QModelIndex, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QAction, QColor, QDesktopServices
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSpinBox,
    QApplication,
    QColorDialog,
    QComboBox,
    QFileDialog,
    QLineEdit,
    QMenu,
    QSlider,
    QTabBar,
    QWidget,
)
from shiboken6 import isValid

from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.live import Ring

from .failures import prepared, whole

DEEDS = int(os.environ.get("CONTACTBENCH_MONKEY_DEEDS", "400"))
SEED = int(os.environ.get("CONTACTBENCH_MONKEY_SEED", "8"))
HANGS_S = 20.0  # a machine full of other work makes seconds out of nothing
PRESSED = (QAbstractButton, QComboBox, QAbstractSpinBox, QTabBar, QAbstractItemView, QSlider, QLineEdit)
KEYS = (
    Qt.Key.Key_Space,
    Qt.Key.Key_Return,
    Qt.Key.Key_Delete,
    Qt.Key.Key_Escape,
    Qt.Key.Key_BracketLeft,
    Qt.Key.Key_BracketRight,
    Qt.Key.Key_Tab,
    Qt.Key.Key_E,
)


class Monkey(QObject):
    """Does something at random each time its timer says so; a timer, because a real event loop must serve it."""

    def __init__(self, window, folder, seed):
        super().__init__(window)
        self.window, self.folder = window, folder
        self.random = random.Random(seed)  # noqa: S311 - no secret
        self.did = []
        self.timer = QTimer(self, singleShot=True)
        self.timer.timeout.connect(self._go)
        self.timer.start(100)

    def _go(self):
        # Before it: a menu that pops up has an event loop of its own, in which this must go on.
        self.timer.start(self.random.choice((0, 10, 40, 120, 300)))
        try:
            self.did.append(self._something())
        except RuntimeError as error:  # what was chosen is gone by now
            if "already deleted" not in str(error):
                raise

    def _something(self):
        window, chance = self.window, self.random.random()
        top = QApplication.activePopupWidget() or QApplication.activeModalWidget() or window
        if isinstance(top, (QFileDialog, QMenu)) or (top is not window and chance < 0.4):
            top.close()
            return f"close {type(top).__name__}"
        if window.bench is None and not window._running():
            window.sessions.open(self.folder)
            return "open"
        if chance < 0.1:
            step = self.random.choice(list(Step))
            window.show_step(step)
            return f"step {step}"
        if chance < 0.2:
            action = self.random.choice((window.menus.undo, window.menus.redo))
            words = action.text()
            action.trigger()
            return words
        if chance < 0.25:
            return self._menu()
        if chance < 0.255:
            window.close_session()
            return "close session"
        if chance < 0.3:
            key = self.random.choice(KEYS)
            QTest.keyClick(QApplication.focusWidget() or window, key)
            return f"key {key.name}"
        return self._press(top)

    def _menu(self):
        menus = self.window.menuBar().findChildren(QMenu)
        actions = [each for menu in menus for each in menu.actions() if self._harmless(each)]
        action = self.random.choice(actions)
        words = action.text()
        action.trigger()
        return f"menu {words}"

    def _harmless(self, action: QAction):
        words = action.text().replace("&", "")
        far = words in {"Quit", "Full screen", "Close session"} or "diagnostics" in words
        return action.isEnabled() and not action.menu() and not action.isSeparator() and not far

    def _press(self, top):
        page = self.window.pages.current if self.window.bench is not None else None
        # What matters most is on the page.
        inside = page if top is self.window and page is not None and self.random.random() < 0.75 else top
        there = [each for each in inside.findChildren(QWidget) if isinstance(each, PRESSED)]
        there = [each for each in there if each.isVisible() and each.isEnabled()]
        if not there:
            return "nothing"
        widget = self.random.choice(there)
        words = f"{type(widget).__name__} {widget.accessibleName() or getattr(widget, 'text', str)()}"
        self._use(widget)
        return f"{words} on {self.window.pages.step}"

    def _use(self, widget):
        pick = self.random
        if isinstance(widget, QAbstractSpinBox):
            widget.stepBy(pick.choice((-3, -1, 1, 5)))
        elif isinstance(widget, QComboBox):
            index = pick.randrange(max(widget.count(), 1))
            widget.setCurrentIndex(index)
            widget.activated.emit(index)
        elif isinstance(widget, QTabBar):
            widget.setCurrentIndex(pick.randrange(max(widget.count(), 1)))
        elif isinstance(widget, QLineEdit):
            widget.setFocus()
            QTest.keyClicks(widget, pick.choice(("x", "12", "/no/where", "-")))
        elif isinstance(widget, QSlider):
            widget.setValue(pick.randint(widget.minimum(), widget.maximum()))
        elif isinstance(widget, QAbstractItemView):
            model = widget.model()
            if model is not None and model.rowCount(QModelIndex()):
                index = model.index(pick.randrange(model.rowCount(QModelIndex())), 0)
                at = widget.visualRect(index).center()
                if widget.viewport().rect().contains(at):
                    click(widget.viewport(), at)
        else:
            click(widget, widget.rect().center())


def click(widget, at):
    """
    Press and let go, if it is still there then: a press may open a menu, in whose event loop all goes on.

    `QTest.mouseClick` would let go of a widget that is gone, and the process would die of it.
    """
    left, none = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    QTest.mousePress(widget, left, none, at)
    if isValid(widget):
        QTest.mouseRelease(widget, left, none, at)


@pytest.fixture
def harmless(monkeypatch):
    """Let nothing be asked for by the computer, opened in another program, or said to a real sensor."""
    nothing = {"getOpenFileName": ("", ""), "getSaveFileName": ("", ""), "getOpenFileNames": ([], "")}
    for name, answer in nothing.items():
        monkeypatch.setattr(QFileDialog, name, lambda *_, answer=answer, **__: answer)
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_, **__: "")
    monkeypatch.setattr(QColorDialog, "getColor", lambda *_, **__: QColor())
    monkeypatch.setattr(QDesktopServices, "openUrl", lambda *_: True)
    monkeypatch.setattr("contactbench.app.pages.devices.list_ports", list)


@pytest.mark.window
@pytest.mark.usefixtures("harmless")
@pytest.mark.qt_no_exception_capture
def test_everything_in_any_order(qtbot, tmp_path):
    folder = prepared(tmp_path / "made")
    with Session.open(folder) as session:
        known = [record.hash for record in session.records]
    with whole(qtbot, tmp_path) as made:
        made.open(folder)
        longest = []
        made.window.heartbeat.stalled.connect(longest.append)
        monkey = Monkey(made.window, folder, SEED)
        qtbot.waitUntil(lambda: len(monkey.did) >= DEEDS or bool(made.unexpected), timeout=500_000)
        monkey.timer.stop()
        monkey.timer.timeout.disconnect()
        assert not made.unexpected, (made.unexpected, monkey.did[-15:])
        odd = [text for text in made.window.messages.texts() if "unexpected" in text or "Error:" in text]
        assert not odd, (odd, monkey.did[-40:])
        assert max(longest, default=0.0) < HANGS_S
        while (dialog := QApplication.activeModalWidget() or QApplication.activePopupWidget()) is not None:
            dialog.close()
    assert not check(folder).problems
    with Session.open(folder) as session:
        assert [record.hash for record in session.records][: len(known)] == known
        for slot in (("calibration", "calibration.json"), ("probe", "probe.ply")):
            assert slot in session.state.current_results


# ---- exceptions where nobody expects one ---------------------------------------------------------


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


def test_in_a_slot_a_thread_a_worker_and_at_the_desk(open_window, qtbot):
    def slot():
        raise ZeroDivisionError("in a slot")

    sender = Sender()
    sender.sent.connect(slot)
    sender.sent.emit()
    sender.sent.emit()
    wait_told(open_window, "in a slot")  # the same one again is one note

    def run():
        raise EOFError("in a thread")

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    wait_told(open_window, "in a thread")

    def work(_progress, _cancelled):
        raise KeyError("in a worker")

    def done(_):
        raise ValueError("after a worker")

    jobs = open_window.window.bench.jobs
    jobs.start("Working", work)
    wait_told(open_window, "in a worker")
    messages = open_window.window.messages  # the details are one click away
    assert "Traceback" not in messages.texts()[0]
    messages._list.setCurrentRow(0)
    qtbot.mouseClick(messages._more, Qt.MouseButton.LeftButton)
    assert "Traceback" in messages._details.toPlainText()
    jobs.start("Working", lambda _progress, _cancelled: None, done)
    wait_told(open_window, "after a worker")
    open_window.idle()  # neither is still shown as running

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
    count = live.ring.count
    open_window.wait(lambda: live.ring.count > count)  # the devices go on
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
    count = live.ring.count
    try:
        open_window.wait(lambda: live.ring.count > count, timeout=10_000)
    except Exception:  # noqa: BLE001
        pytest.fail(f"the samples stopped: {open_window.window.messages.texts()}")


def test_in_each_page(open_window, monkeypatch):
    for step in Step:
        page = open_window.page(step)

        def raises(*_, step=step):
            raise AttributeError(f"in the page of {step}")

        with monkeypatch.context() as patched:
            for name in ("tick", "show_state", "leave"):
                patched.setattr(page, name, raises)
            wait_told(open_window, f"in the page of {step}")
            other = Step.EXPORT if step is not Step.EXPORT else Step.DEVICES
            open_window.page(other)
            assert open_window.window.pages.step is other
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
