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


def run(*arguments, **environment):
    env = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    env.pop("QT_QPA_PLATFORM", None)
    env |= environment
    return subprocess.run(
        command(*arguments), env=env, capture_output=True, text=True, timeout=60, check=False
    )


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


def test_the_window_opens_and_ends(tmp_path):
    if not os.environ.get("DISPLAY"):
        pytest.skip("needs a screen")
    code = (
        "import sys; from PySide6.QtCore import QTimer; from PySide6.QtWidgets import QApplication\n"
        "from app import application\n"
        "made = application.prepared()\n"
        "QTimer.singleShot(500, lambda: [w.close() for w in QApplication.topLevelWidgets()])\n"
        "sys.exit(application.run(language='en'))"
    )
    home = tmp_path / "home"
    env = os.environ | {"CONTACTBENCH_HOME": str(home)}
    result = subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=60, check=False
    )
    assert result.returncode == 0, result.stderr
    assert (home / "config" / "window.json").exists()
    assert (home / "log" / "contactbench.log").exists()


def test_the_window_is_painted_before_anything_heavy_is_loaded(tmp_path):
    if not os.environ.get("DISPLAY"):
        pytest.skip("needs a screen")
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
    env = os.environ | {"CONTACTBENCH_HOME": str(tmp_path / "home")}
    result = subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=60, check=False
    )
    assert result.returncode == 0, result.stderr
    assert not result.stderr.strip(), "loaded while somebody waits for the window"


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="signals as there")
def test_ctrl_c_closes_the_window_and_frees_the_session(tmp_path):
    if not os.environ.get("DISPLAY"):
        pytest.skip("needs a screen")
    env = os.environ | {"CONTACTBENCH_HOME": str(tmp_path / "home")}
    words = command("gui", "--virtual", "--session", tmp_path / "s")
    with subprocess.Popen(words, env=env, stderr=subprocess.PIPE, text=True) as window:
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
def test_nothing_of_the_kernel_or_qt_is_left_when_the_application_ends(tmp_path):
    if not os.environ.get("DISPLAY"):
        pytest.skip("needs a screen")
    env = os.environ | {"CONTACTBENCH_HOME": str(tmp_path / "home")}
    words = [sys.executable, "-X", "faulthandler", "-c", _LOOKED_AT, str(prepared(tmp_path))]
    ended = subprocess.run(words, env=env, capture_output=True, text=True, timeout=120, check=False)
    assert ended.returncode == 0, ended.stderr
    said = [line for line in ended.stderr.splitlines() if "stood still" not in line]
    assert not [line for line in said if "leaked" in line or "QThread" in line or "Fatal" in line], (
        ended.stderr
    )
