"""A user meets each fault with mouse and keys only, in a real window with a window manager."""

import shutil
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from driving.hand import Hand
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractButton, QListWidget
from workbench.probe_files import egg
from workbench.touch_session import verify

from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.session.why import DISK
from contactbench.pipeline.steps import Step

from .conftest import close as close_window
from .probe_hand import STAGES
from .test_failures_files import mounted

pytestmark = [pytest.mark.window, pytest.mark.timeout(540)]
LONG = 120.0


@pytest.fixture
def hand(made, tmp_path):
    return Hand(made.window, tmp_path / "pictures")


@pytest.fixture(scope="module")
def verified(calibrated):
    return verify(calibrated)


def open_recent(hand, name):
    """Click a session in the list of those that were open."""
    found = hand.find("Recent sessions", QListWidget)
    rows = [found.item(row) for row in range(found.count())]
    (item,) = [each for each in rows if each.text().startswith(name)]
    hand.click(found, found.viewport().mapTo(found, found.visualItemRect(item).center()))


def go_to(hand, step):
    """Click a step in the list on the left."""
    hand.press(f"{1 + list(Step).index(step)} {step.value.capitalize()}")


def remembered(made, folder):
    """Have a session be among the recent ones."""
    made.window.settings.opened(folder, "", "started")
    made.window.sessions.list_recent()
    made.wait(lambda: not made.window.jobs.running)
    return folder


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


def test_quitting_while_it_computes_waits_if_one_wants(made, hand, tmp_path):
    hand.press("Try the virtual bench")
    go_to(hand, Step.PROBE)
    hand.press("Use virtual bench housing", LONG)
    hand.until(lambda: Step.PROBE in made.window.bench.running, "the work to begin", LONG)
    hand.key(Qt.Key.Key_Q, Qt.KeyboardModifier.ControlModifier)
    question = asked(made, hand)
    question.read("Preparing the probe")
    question.press("Wait until done")
    assert made.window.isVisible()
    hand.until(lambda: not made.window.isVisible(), "the window to close", LONG)
    assert not made.unexpected
    (folder,) = (tmp_path / "home" / "sessions").iterdir()
    with Session.open(folder, write=False) as session:
        assert session.state.setting("draft.probe")["plan"]["facets"], "it was done to its end"
    assert not check(folder).problems


def fill(file):
    """Take what is left of a disk."""
    with file.open("wb", buffering=0) as stream, suppress(OSError):
        while True:
            stream.write(b"x" * 4096)


# ---- one truth -------------------------------------------------------------------------------------


def test_a_full_disk_is_red_on_every_page_and_goes_on_by_itself(made, hand, verified, tmp_path):
    disk = mounted(tmp_path / "disk", "8m")
    try:
        folder = remembered(made, shutil.copytree(verified, disk / "s"))
        open_recent(hand, "s")
        go_to(hand, Step.VERIFY)
        hand.press("Distribute evenly", LONG)
        filling = disk / "filling"
        fill(filling)
        for count in ("5", "6", "7", "8"):
            hand.type("Number of markers", count)
            hand.press("Distribute evenly", LONG)
        hand.read(DISK, LONG)
        go_to(hand, Step.EXPORT)
        hand.read(DISK, LONG)
        assert not hand.enabled("Export file")
        filling.unlink()
        hand.read("The disk is writable again", LONG)
        hand.until(
            lambda: DISK not in made.window.pages.statuses[Step.EXPORT].sentence, "the end of it", LONG
        )
        hand.key(Qt.Key.Key_Q, Qt.KeyboardModifier.ControlModifier)
        hand.until(lambda: not made.window.isVisible(), "the window to close", LONG)
        assert not made.unexpected
        assert not check(folder).problems
    finally:
        if made.window.isVisible():
            close_window(made.qtbot, made.window)
        subprocess.run(["umount", "-l", str(disk)], check=False)


def test_a_missing_file_is_red_everywhere_and_well_again_when_it_is_back(made, hand, verified, tmp_path):
    folder = remembered(made, shutil.copytree(verified, tmp_path / "s"))
    with Session.open(folder, write=False) as session:
        file = folder / session.state.newest("probe").file.path
    open_recent(hand, "s")
    go_to(hand, Step.VERIFY)
    hand.read("Passed", LONG)
    made.idle()
    content = file.read_bytes()
    file.unlink()
    for step in (Step.PROBE, Step.VERIFY, Step.EXPORT):
        go_to(hand, step)
        hand.read(file.name, LONG)
        hand.until(lambda: "Passed" not in hand.words(), "the verdict to go", LONG)
    assert not hand.enabled("Export file")
    file.write_bytes(content)
    hand.until(lambda: hand.enabled("Export file"), "the export", LONG)
    assert not made.unexpected


# ---- a way in --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("answer", "found"),
    [
        ("Open up to the damage", "is kept as journal.before-repair-"),
        ("Open read-only", "this session is damaged"),
        ("Salvage a copy", "At least one record is lost"),
    ],
)
def test_each_way_into_a_damaged_session(made, hand, verified, tmp_path, answer, found):
    folder = shutil.copytree(verified, tmp_path / "s")
    content = bytearray((folder / "journal").read_bytes())
    middle = len(content) // 2
    content[middle : middle + 40] = b"#" * 40
    (folder / "journal").write_bytes(content)
    before = bytes(content)
    remembered(made, folder)
    open_recent(hand, "s")
    hand.read("is damaged", LONG)
    hand.read("Nothing is lost", LONG)  # what each costs stands beside it
    hand.press(answer, LONG)
    hand.until(lambda: made.window.bench is not None, "the session", LONG)
    made.idle()
    hand.until(lambda: made.said(found) or found in hand.words(), f"'{found}'", LONG)
    for step in Step:
        go_to(hand, step)
        made.idle()
    if answer == "Open up to the damage":
        (kept,) = folder.glob("journal.before-repair-*")
        assert kept.read_bytes() == before
    else:
        assert (folder / "journal").read_bytes() == before
    assert not made.unexpected


def test_a_folder_that_cannot_be_written_is_looked_at(made, hand, verified, tmp_path):
    disk = mounted(tmp_path / "disk", "8m")
    try:
        remembered(made, shutil.copytree(verified, disk / "s"))
        subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True, capture_output=True)
        open_recent(hand, "s")
        hand.read("the session folder is not writable", LONG)
        for step in Step:
            go_to(hand, step)
            made.idle()
            page = made.window.pages.current
            assert not [each for each in page.findChildren(QAbstractButton) if each.isEnabled()], step
        hand.key(Qt.Key.Key_Q, Qt.KeyboardModifier.ControlModifier)
        hand.until(lambda: not made.window.isVisible(), "the window to close", LONG)
        assert not made.unexpected
    finally:
        subprocess.run(["umount", "-l", str(disk)], check=False)
