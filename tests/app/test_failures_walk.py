"""A user comes back after a kill, and leaves amid a recording, with mouse and keys only."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest
from driving.hand import Hand
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QListWidget
from workbench.probe_files import egg

from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.steps import Step

from .probe_hand import STAGES

pytestmark = [pytest.mark.window, pytest.mark.timeout(540)]
LONG = 120.0


@pytest.fixture
def hand(made, tmp_path):
    return Hand(made.window, tmp_path / "pictures")


def open_recent(hand, name):
    """Click a session in the list of those that were open."""
    found = hand.find("Recent sessions", QListWidget)
    rows = [found.item(row) for row in range(found.count())]
    (item,) = [each for each in rows if each.text().startswith(name)]
    hand.click(found, found.viewport().mapTo(found, found.visualItemRect(item).center()))


# ---- nothing is lost -------------------------------------------------------------------------------

# What can be read or pressed when the window is opened again after each stage of the Probe page.
_FOUND = {
    "loaded": "Align with sensor (3)",
    "closed": "Align with sensor (3)",
    "placed": "Use this probe",
    "counted": "Use this probe",
    "used": "Next: Regions",
}


@pytest.mark.parametrize("stage", STAGES)
def test_killed_after_each_stage_of_the_probe_it_goes_on_from_there(made, hand, tmp_path, stage):
    folder, mesh = tmp_path / "s", egg(tmp_path)
    Session.create(folder).close()
    script = Path(__file__).with_name("probe_hand.py")
    with subprocess.Popen(
        [sys.executable, str(script), str(folder), str(mesh), stage], stdout=subprocess.PIPE, text=True
    ) as other:
        try:
            assert other.stdout.readline().strip() == stage
        finally:
            other.send_signal(signal.SIGKILL)
    made.window.settings.__init__()  # the other process has written it
    made.window.sessions.list_recent()
    made.wait(lambda: not made.window.jobs.running)
    open_recent(hand, "s")
    hand.read(mesh.name, LONG)
    assert made.window.pages.step is Step.PROBE
    hand.until(lambda: hand.enabled(_FOUND[stage]), f"'{_FOUND[stage]}'", LONG)
    assert made.window.bench.undo.canUndo()
    hand.press("Undo")
    made.idle()
    assert not made.unexpected
    assert not check(folder).problems


# ---- leaving while work goes on --------------------------------------------------------------------


def quit_while_recording(made, hand):
    """Begin to weigh on the virtual bench, and press Ctrl+Q."""
    hand.press("Try the virtual bench")
    hand.press("Start", LONG)
    hand.read("pose 1 of", LONG)
    hand.key(Qt.Key.Key_Q, Qt.KeyboardModifier.ControlModifier)
    return asked(made, hand)


def asked(made, hand):
    """Return a hand at the question that is asked."""
    hand.until(lambda: made.window.departure.question is not None, "a question", LONG)
    return Hand(made.window.departure.question, hand.pictures)


def test_quitting_while_it_records_can_be_taken_back_or_keeps_what_was_recorded(made, hand, tmp_path):
    question = quit_while_recording(made, hand)
    question.read("Recording a calibration")
    question.press("Cancel")
    hand.until(lambda: made.window.departure.question is None, "the question to go")
    hand.press("Move virtual tool there", LONG)
    hand.read("pose 2 of", LONG)  # it goes on
    hand.key(Qt.Key.Key_Q, Qt.KeyboardModifier.ControlModifier)
    asked(made, hand).press("Stop and keep results")
    hand.until(lambda: not made.window.isVisible(), "the window to close", LONG)
    assert not made.unexpected
    (folder,) = (tmp_path / "home" / "sessions").iterdir()
    with Session.open(folder, write=False) as session:
        assert ("recording", "gravity-1.mcap") in session.state.current_inputs
    assert not check(folder).problems
