"""How soon the window can be used, beside what importing PySide6 and pyvista and one empty view take anyway."""

import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from benchmarks.window.driver import load, loaded, own_home

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, StudyReport

_MOST = 1.5
_MOST_S = 1.5
_PATIENCE_S = 120.0
_DONE = "usable"

_EMPTY_VIEW = f"""
import os, sys
from PySide6.QtWidgets import QApplication
import pyvista
from pyvistaqt import QtInteractor
application = QApplication([])
view = QtInteractor(auto_update=False)
view.resize(1280, 800)
def seen():
    print("{_DONE}", flush=True)
    os._exit(0)
view.frameSwapped.connect(seen)
view.show()
application.exec()
"""

# The real command line with the real window; only where it says that it can be used is added.
_WINDOW = f"""
import os, sys
import contactbench.app.cli, contactbench.app.application
from PySide6.QtCore import QEvent, QTimer
class Seen(contactbench.app.application.MainWindow):
    def event(self, event):
        done = super().event(event)
        if event.type() == QEvent.Type.Paint:
            QTimer.singleShot(0, lambda: QTimer.singleShot(0, seen))  # what came before the next event is done
        return done
def seen():
    button = window().start.virtual_button
    if button.isVisible() and button.isEnabled():
        print("{_DONE}", flush=True)
        os._exit(0)
def window():
    from PySide6.QtWidgets import QApplication
    return next(each for each in QApplication.topLevelWidgets() if isinstance(each, Seen))
contactbench.app.application.MainWindow = Seen
sys.argv = ["contactbench", "gui"]
contactbench.app.cli.main()
"""


def run(repeats: int = 7, *, progress: Callable[[str], None] = lambda _: None) -> StudyReport:
    """Start both as processes of their own, in turns, and compare pair by pair."""
    before = load()
    views: list[float] = []
    windows: list[float] = []
    with own_home() as home:
        for number in range(repeats + 1):
            progress(f"start {number} of {repeats}" if number else "filling the cache")
            pair = _seconds(_EMPTY_VIEW, home), _seconds(_WINDOW, home)
            if number:
                views.append(pair[0])
                windows.append(pair[1])
    ratios = [window / view for window, view in zip(windows, views, strict=True)]
    figures = (
        Figure.of(
            "PySide6, pyvista, an empty QtInteractor", "from the process to its first frame", views, "s"
        ),
        Figure.of(
            "contactbench gui", "from the process to a button that can be pressed", windows, "s", most=_MOST_S
        ),
        Figure.of("contactbench gui / empty QtInteractor", "ratio, pair by pair", ratios, most=_MOST),
    )
    notes = (loaded(before), "The 3D view of the window is made with the first session, not at its start.")
    return StudyReport("Start of the window", {"repeats": repeats}, figures, notes)


def _seconds(code: str, home: Path) -> float:
    """Return how long a process takes until it says that it can be used."""
    began = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=_PATIENCE_S,
        check=False,
        env=os.environ | {"CONTACTBENCH_HOME": str(home / "home")},
    )
    took = time.perf_counter() - began
    if _DONE not in done.stdout:
        raise InputError(f"a window did not open: {done.stderr.strip()[-500:] or f'exit {done.returncode}'}")
    return took
