import os
import signal
import subprocess
import sys

import pytest
from terminal import command
from waiting import until

from contactbench.app import commands
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session import Session

from .failures import prepared

needs_screen = pytest.mark.skipif(not os.environ.get("DISPLAY"), reason="needs a screen")


def run(*arguments, **environment):
    env = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    env.pop("QT_QPA_PLATFORM", None)
    env |= environment
    return subprocess.run(
        command(*arguments), env=env, capture_output=True, text=True, timeout=60, check=False
    )


def ended(*words):
    """Return what a Python that ended well had done, in the home of the test."""
    result = subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, timeout=120, check=False
    )
    assert result.returncode == 0, result.stderr
    return result


def test_help_names_the_window_and_imports_no_qt():
    result = run("--help")
    assert result.returncode == 0
    assert all(name in result.stdout for name in ("gui", "heatmap", "locate"))
    heavy = ("PySide6", "vtkmodules", "numpy")
    code = f"import sys, contactbench.app.cli; sys.exit(any(name in sys.modules for name in {heavy}))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize("arguments", [(), ("gui",), ("heatmap", "view")])
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only there is a screen a variable")
def test_without_a_screen_there_is_a_sentence(arguments):
    result = run(*arguments)
    assert result.returncode == 2
    assert "no screen" in result.stderr
    assert "Traceback" not in result.stderr


def test_without_qt_there_is_a_sentence(monkeypatch):
    monkeypatch.setattr(commands, "find_spec", lambda name: None if name == "PySide6" else object())
    with pytest.raises(InputError, match=r"PySide6.*pip install 'contactbench\[gui\]'"):
        commands.check_screen()


@needs_screen
def test_the_window_opens_and_ends(tmp_path):
    code = (
        "import sys; from PySide6.QtCore import QTimer; from PySide6.QtWidgets import QApplication\n"
        "from app import application\n"
        "made = application.prepared()\n"
        "QTimer.singleShot(500, lambda: [w.close() for w in QApplication.topLevelWidgets()])\n"
        "sys.exit(application.run(language='en'))"
    )
    ended("-c", code)
    assert (tmp_path / "home" / "config" / "window.json").exists()
    assert (tmp_path / "home" / "log" / "contactbench.log").exists()


@needs_screen
def test_the_window_is_painted_before_anything_heavy_is_loaded():
    code = """
import sys
from PySide6.QtCore import QEvent, QTimer
from contactbench.app import application, cli
class Window(application.MainWindow):
    def event(self, event):
        if event.type() == QEvent.Type.Paint:
            heavy = ("numpy", "scipy", "vtkmodules", "pyvista", "mujoco", "contactbench.pipeline.settings")
            print(*(name for name in heavy if name in sys.modules), file=sys.stderr, flush=True)
            QTimer.singleShot(0, self, self.close)
        return super().event(event)
application.MainWindow = Window
sys.argv = ["contactbench", "gui"]
cli.main()
"""
    assert not ended("-c", code).stderr.strip(), "loaded while somebody waits for the window"


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="signals as there")
@needs_screen
def test_ctrl_c_closes_the_window_and_frees_the_session(tmp_path):
    words = command("gui", "--virtual", "--session", tmp_path / "s")
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True) as window:
        until((tmp_path / "home" / "config" / "window.json").exists)  # the session is shown
        window.send_signal(signal.SIGINT)
        _, said = window.communicate(timeout=60)
    assert window.returncode == 0, said
    assert "leaked" not in said
    with Session.open(tmp_path / "s") as session:
        assert session.state.settings["devices.sensor"].value.startswith("virtual://")


_LOOKED_AT = """
import sys
from pathlib import Path
from PySide6.QtCore import QTimer
from contactbench.app import application
from contactbench.app.window import MainWindow
from contactbench.pipeline.steps import Step

class Window(MainWindow):
    def __init__(self, *given):
        super().__init__(*given)
        self.timer = QTimer(self, interval=100)
        self.timer.timeout.connect(self.look)
        self.timer.start()

    def look(self):
        if self.bench is None or not self.pages.made:
            return
        self.show_step(Step.VERIFY)
        if self.pages.current.work.tool is not None and self.bench.live.solver is not None:
            self.timer.stop()
            self.close()

application.MainWindow = Window
sys.exit(application.run(Path(sys.argv[1])))
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="a screen of X")
@needs_screen
def test_nothing_of_the_kernel_or_qt_is_left_when_the_application_ends(tmp_path):
    errors = ended("-X", "faulthandler", "-c", _LOOKED_AT, str(prepared(tmp_path))).stderr
    said = [line for line in errors.splitlines() if "stood still" not in line]
    assert not [line for line in said if "leaked" in line or "QThread" in line or "Fatal" in line], errors
