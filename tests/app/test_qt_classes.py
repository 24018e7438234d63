"""Qt's classes are made in the GUI thread, before a worker that opens a session names them."""

import subprocess
import sys

_CODE = """
import sys
from pathlib import Path
from PySide6.QtWidgets import QApplication
from contactbench.app import window_sessions
from contactbench.app.window_sessions import _MODULES
from contactbench.app.settings import WindowSettings
from contactbench.app.window import MainWindow

def unmade():
    return [name for module in _MODULES for name in dir(module) if name not in vars(module)]

application = QApplication(sys.argv)
window = MainWindow(WindowSettings())
assert len(unmade()) > 100, "this test proves nothing"

def opens(*_):
    sys.stdout.write(",".join(unmade()) + "|")
    application.exit(7)

window_sessions.new_session = opens
window.sessions.new(Path(sys.argv[1]))
sys.exit(application.exec())
"""


def test_no_class_of_qt_is_left_to_be_made_when_a_session_is_opened(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", _CODE, str(tmp_path / "s")], capture_output=True, text=True, check=False
    )
    assert done.returncode == 7, done.stderr
    assert done.stdout.startswith("|"), done.stdout
