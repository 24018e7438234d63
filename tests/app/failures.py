"""A whole window, as the application makes it, and what the tests of failures do with it."""

from contextlib import contextmanager
from pathlib import Path

from workbench.touch_session import make_session

from contactbench.app.errors import Faults, LogFile
from contactbench.app.settings import WindowSettings
from contactbench.app.window import MainWindow
from contactbench.pipeline.steps import Step

from .conftest import close, delete_now, shown

LONG = 60_000


class Whole:
    """The window with its real pages, its log and its hooks."""

    def __init__(self, qtbot, folder):
        self.qtbot = qtbot
        self.log, self.faults = LogFile(folder / "log"), Faults()
        self.window = MainWindow(WindowSettings(), self.faults, self.log)
        self.faults.install()
        self.unexpected = []
        self.faults.happened.connect(self._happened)
        self.window.show()
        qtbot.waitExposed(self.window)

    def _happened(self, sentence, details, expected):
        if not expected:
            self.unexpected.append((sentence, details))

    def open(self, folder):
        return shown(self.qtbot, self.window, lambda: self.window.sessions.open(folder))

    def new(self, folder):
        return shown(self.qtbot, self.window, lambda: self.window.sessions.new(folder))

    def page(self, step):
        self.window.show_step(Step(step))
        return self.window.pages.current

    def wait(self, condition, timeout=LONG):
        self.qtbot.waitUntil(condition, timeout=timeout)

    def idle(self):
        self.wait(lambda: not self.window._running())

    def said(self, *words):
        """Whether one message has all these words."""
        return any(
            all(word.lower() in text.lower() for word in words) for text in self.window.messages.texts()
        )

    def wait_said(self, *words):
        try:
            self.wait(lambda: self.said(*words))
        except Exception as error:
            raise AssertionError(f"{words} was not said: {self.window.messages.texts()}") from error

    def alive(self):
        """Whether the window answers, and draws: the heartbeat goes on, and another page can be shown."""
        before = self.window.heartbeat.stalls().beats
        self.wait(lambda: self.window.heartbeat.stalls().beats > before + 3)
        return self.window.isVisible() and self.window.isEnabled()

    def end(self):
        try:
            if self.window.isVisible():
                close(self.qtbot, self.window)
        finally:
            self.faults.uninstall()
            self.log.close()
            self.window.deleteLater()
            self.window = None
            delete_now()


@contextmanager
def whole(qtbot, folder):
    made = Whole(qtbot, folder)
    try:
        yield made
    finally:
        made.end()


def prepared(parent: Path) -> Path:
    """Make a session with a calibration, a probe and the virtual bench's address."""
    (parent / "files").mkdir(parents=True)
    return make_session(parent / "s", parent / "files")
