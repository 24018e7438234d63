"""Windows for tests: with settings, logs and sessions of their own, and closed at the end."""

import gc

import pytest
from PySide6.QtCore import QEvent
from PySide6.QtWidgets import QApplication
from shiboken6 import isValid

from contactbench.app.bench import Page
from contactbench.app.settings import WindowSettings
from contactbench.app.window import MainWindow
from contactbench.pipeline.steps import Step


@pytest.fixture(autouse=True)
def _own_home(tmp_path, monkeypatch):
    monkeypatch.setenv("CONTACTBENCH_HOME", str(tmp_path / "home"))


@pytest.fixture(autouse=True)
def _frozen_once(monkeypatch):
    """What was there before the first test stays frozen, and a window adds nothing: it has to be collected."""
    monkeypatch.setattr(gc, "freeze", lambda: None)
    monkeypatch.setattr(gc, "unfreeze", lambda: None)


class PlainPage(Page):
    """A page that writes down what the window does with it."""

    def __init__(self, bench, parent=None):
        super().__init__(bench, parent)
        self.calls, self.ticks = [], 0

    def enter(self):
        self.calls.append("enter")

    def leave(self):
        self.calls.append("leave")

    def show_state(self, status):
        self.status = status

    def tick(self):
        self.ticks += 1

    def close_page(self):
        self.calls.append("close")


@pytest.fixture
def plain_pages(monkeypatch):
    """Pages without content, by step."""
    classes = {step: type(f"Plain{step}", (PlainPage,), {"step": step}) for step in Step}
    monkeypatch.setattr("contactbench.app.window_pages.page_class", classes.__getitem__)
    return classes


@pytest.fixture
def made(qtbot, tmp_path):
    """A whole window, as the application makes it."""
    from .failures import whole

    with whole(qtbot, tmp_path) as window:
        yield window


@pytest.fixture
def make_window(qtbot):
    """Make windows that are closed, with their session, when the test ends."""
    made = []

    def make(**options):
        window = MainWindow(options.pop("settings", None) or WindowSettings(), **options)
        made.append(window)
        window.show()
        qtbot.waitExposed(window)
        return window

    yield make
    for window in made:
        if isValid(window):
            if window.isVisible():
                close(qtbot, window)
            window.deleteLater()
        del window
    made.clear()
    delete_now()


def delete_now():
    """Delete what was said to be deleted later: outside of an event loop nothing else does, until the next test's."""
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()


def beats(qtbot, window, count=8):
    """Let the window go on for some beats of its heart, in which it lays out, draws and ticks."""
    heart = window.heartbeat
    first = heart.stalls().beats
    qtbot.waitUntil(lambda: heart.stalls().beats >= first + count, timeout=60_000)


def close(qtbot, window):
    """Close a window, and wait until it is; what is going on is stopped."""
    window.close()
    if window.departure.question is not None:
        window.departure.stop.click()
    qtbot.waitUntil(lambda: not window.isVisible(), timeout=30_000)


def shown(qtbot, window, begin):
    """Begin to open a session, and wait until it is shown."""
    with qtbot.waitSignal(window.shown, timeout=60_000):
        begin()
    return window.bench
