"""
The real window in a process of its own, looked at through the accessibility bus while it shows each of its pages.

``python -m app.bus_window SESSION`` prints as JSON what was read of each page, and what Qt itself shows there.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.window.layout_faults import CONTROLS, VisibleWidgets
from benchmarks.window.walk import rest, settled, until
from PySide6.QtGui import QAccessible
from PySide6.QtWidgets import QAbstractButton

from contactbench.app.application import prepared
from contactbench.app.settings import WindowSettings
from contactbench.app.window import MainWindow
from contactbench.pipeline.steps import Step
from contactbench.widgets.theme import use_theme

_READER = Path(__file__).with_name("bus_reader.py")


def read(*asked):
    """Have somebody else read the window, while it goes on."""
    command = ["/usr/bin/python3", str(_READER), str(os.getpid()), *asked]
    with tempfile.TemporaryFile() as said, subprocess.Popen(command, stdout=said) as other:
        until(lambda: other.poll() is not None, lambda: "the reader did not end")
        if other.returncode:
            raise SystemExit(other.returncode)
        said.seek(0)
        return said.read().decode()


def controls(window):
    """Return the names of what can be used now, as Qt has them."""
    found = []
    for each in VisibleWidgets(window).of(*CONTROLS):
        interface = QAccessible.queryAccessibleInterface(each)
        if each.isVisible() and interface is not None and not each.visibleRegion().isEmpty():
            found.append([interface.text(QAccessible.Text.Name), isinstance(each, QAbstractButton)])
    return found


def main(session):
    """Show every page."""
    prepared()
    use_theme("light")
    window = MainWindow(WindowSettings())
    window.show()
    pages = {"start": look(window)}
    window.sessions.open(Path(session))
    until(lambda: window.bench is not None and window.pages.made, lambda: "the session to be opened")
    window.scene.setUpdatesEnabled(False)  # nobody sees it, and without a graphics card it takes long
    for timer in (window._tick, window._slow):
        timer.stop()  # numbers that change all the time: each is told on the bus, and answers have to wait
    window.bench.live.close()
    for number, step in enumerate(Step, 1):
        row = window.steps.row(step).accessibleName()
        assert row.startswith(str(number))
        sys.stderr.write(f"{step}\n")
        read("press", row)  # by the bus, too
        until(lambda step=step: window.pages.step is step, lambda step=step: f"{step} to be shown")
        until(lambda: not window._running(), lambda: [each.title for each in window._running()])
        settled()
        rest(200)
        pages[step] = look(window)
    json.dump(pages, sys.stdout)
    sys.stdout.flush()
    os._exit(0)


def look(window):
    """Return what is there, and what was read of it."""
    settled()
    return {"there": controls(window), "read": json.loads(read())}


if __name__ == "__main__":
    main(*sys.argv[1:])
