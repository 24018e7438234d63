"""
A hand at the Probe page of the real application, in a process that is ended without warning.

``python probe_hand.py SESSION MESH STAGE`` does everything up to a stage by clicks and keys, says so, and waits to be
killed.
"""

import sys
from pathlib import Path

from driving.hand import Hand, rest
from PySide6.QtCore import QPoint, Qt, QTimer
from PySide6.QtWidgets import QWidget

from contactbench.app import application
from contactbench.app.window import MainWindow

STAGES = ("loaded", "closed", "placed", "counted", "used")
LONG = 120.0


def drive(hand, mesh, stage):
    """Do everything up to a stage."""
    hand.press("3 Probe", LONG)
    hand.name_file("Choose mesh…", mesh)
    hand.read(mesh.name, LONG)
    if stage == "loaded":
        kept(hand, "mesh")  # it is shown a moment before
        return
    hand.press("Align with sensor (3)", LONG)  # enabled only when the surface is there
    if stage == "closed":
        return
    hand.type("Mesh origin along sensor z, mm", "35")
    hand.press("Apply placement")
    if stage == "placed":
        kept(hand, "alignment")
        return
    hand.until(lambda: hand.enabled("Use this probe"), "the probe to be prepared", LONG)
    chart = hand.find("Contact error against facet count", QWidget)
    hand.click(chart, QPoint(chart.width() // 2, chart.height() // 2))
    hand.key(Qt.Key.Key_Left)
    hand.until(lambda: hand.enabled("Use this probe"), "the probe to be prepared anew", LONG)
    rest(1_000)
    if stage == "counted":
        return
    hand.press("Use this probe", LONG)
    hand.press("Next: Regions", LONG)


def kept(hand, part):
    """Wait until a part of what was chosen is in the session."""

    def there():
        draft = hand.window.bench.desk.state.setting("draft.probe")
        return bool(draft) and draft.get(part) is not None

    hand.until(there, f"the {part} to be kept", LONG)


class Driven(MainWindow):
    """The window, with a hand at it."""

    def show(self):
        super().show()
        self.shown.connect(lambda _: QTimer.singleShot(200, self, self._drive))

    def _drive(self):
        _, session, mesh, stage = sys.argv
        drive(Hand(self, Path(session).with_name("pictures")), Path(mesh), stage)
        sys.stdout.write(f"{stage}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    application.MainWindow = Driven
    application.run(Path(sys.argv[1]))
