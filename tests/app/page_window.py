"""A page beside its scene with a session behind it, as the main window has them, for tests of one page."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QWidget

from contactbench.app.bench import Bench
from contactbench.pipeline.steps import StepState, StepStatus
from contactbench.pipeline.workbench.desk import Desk
from contactbench.widgets.scene import Scene

READY = StepStatus(StepState.READY, "")
LONG = 30_000  # ms; a wait ends as soon as what it waits for is there


class PaperScene(QWidget):
    """A scene that draws nothing, and remembers what it was told last."""

    picked, dropped = Scene.picked, Scene.dropped
    handle_moved, handle_dropped = Scene.handle_moved, Scene.handle_dropped

    def __init__(self):
        super().__init__()
        self.probe = self.overlay = self.field = self.tool = self.R_WS = self.ghost = self.handle = None

    def show_probe(self, probe):
        self.probe = probe

    def show_overlay(self, probe):
        self.overlay = probe

    def show_field(self, values, _title=""):
        self.field = values

    def show_orientation(self, R_WS):
        self.R_WS = R_WS

    def show_ghost(self, R_WS, p=None):
        self.ghost = R_WS if p is None else (R_WS, p)

    def show_handle(self, R, p=None):
        self.handle = None if R is None else (R, p)

    def set_tool(self, tool):
        self.tool = tool

    def look(self, view):
        pass

    def close_scene(self):
        pass


class PageWindow:
    """
    A page in a window; `enter` shows it as the main window does.

    Parameters
    ----------
    qtbot
    session : Session
    make : callable
        Makes the page, or a panel, of a bench.
    scene : QWidget, optional
        Left out: a `PaperScene`.
    """

    def __init__(self, qtbot, session, make, scene=None):
        self.qtbot, self.told = qtbot, []
        self.desk, self.scene = Desk(session), scene or PaperScene()
        self.bench = Bench(self.desk, self.scene)
        self.bench.told.connect(self.told.append)
        self.page = make(self.bench)
        self.page.setFixedWidth(360)
        self.widget = QWidget()
        qtbot.addWidget(self.widget)
        layout = QHBoxLayout(self.widget)
        layout.addWidget(self.scene, 1)
        layout.addWidget(self.page)
        self.widget.resize(1000, 700)
        self.widget.show()
        qtbot.waitExposed(self.widget)

    def enter(self, status=READY):
        """Show the page, and tell it of every change of the session."""
        self.bench.changed.connect(lambda: self.page.show_state(status))
        self.page.enter()
        self.page.show_state(status)

    def wait(self, condition):
        self.qtbot.waitUntil(condition, timeout=LONG)

    def until(self, condition, steps=100, poll=None):
        """Let the clock of a stepwise bench go until something is so."""

        def look():
            pair = self.bench.live.pair
            if pair is not None and pair.stepwise:
                pair.step(steps)
            (poll or self.page.tick)()
            assert condition()

        self.qtbot.waitUntil(look, timeout=2 * LONG)

    def click(self, button):
        assert button.isEnabled()
        self.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)

    def said(self):
        return [message.text for message in self.told]

    def close(self):
        self.page.leave()
        self.page.close_page()
        self.bench.close()
        self.scene.close_scene()
