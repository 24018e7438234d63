"""Files that are bad and disks that are full: said in words, and nothing that was there is lost."""

import errno
import os
import shutil
import signal
import subprocess
import sys
import threading

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence
from waiting import until
from workbench.gravity_bench import batches, record
from workbench.probe_files import egg

from contactbench.app.pages.gravity_run import Phase
from contactbench.pipeline.recording import read_recording
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.check import check
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.probe import draft_of

from .conftest import close as close_window
from .conftest import shown
from .failures import LONG, whole


@pytest.fixture
def full():
    """Fill the disk, and free it."""
    with pytest.MonkeyPatch.context() as patch:

        class Disk:
            def fill(self):
                def refuses(*_, **__):
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

                for name in ("write", "fsync", "replace", "link"):
                    patch.setattr(os, name, refuses)

            def free(self):
                patch.undo()

        yield Disk()


def results(folder):
    with Session.open(folder, write=False) as session:
        return {slot: result.number for slot, result in session.state.current_results.items()}


def click(made, button):
    made.wait(button.isEnabled)
    made.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def close(made):
    close_window(made.qtbot, made.window)


# ---- a full disk ---------------------------------------------------------------------------------


def use_devices(made, _tmp_path):
    page = made.page(Step.DEVICES)
    page.serial.setText("another")
    click(made, page.use_button)


def begin_gravity(made, _tmp_path):
    page = made.page(Step.GRAVITY)
    click(made, page.panel.anew)


def place_markers(made, _tmp_path):
    page = made.page(Step.VERIFY)
    click(made, page.panel_markers.spread)


def export(made, tmp_path):
    page = made.page(Step.EXPORT)
    made.wait(lambda: page.view is not None)
    page.unverified.setChecked(True)
    page.write(tmp_path / "out.zip")


def test_a_disk_that_is_full_and_free_again(made, calibrated, tmp_path, full):
    folder = shutil.copytree(calibrated, tmp_path / "s")
    with Session.open(folder) as session:
        session.set_parameter("config.rate", 200.0)
    before = results(folder)
    made.open(folder)
    for what in (use_devices, begin_gravity, place_markers, export):
        made.wait(lambda: made.window.bench.connected)
        made.page(Step.VERIFY)
        made.wait(lambda: made.window.pages.current.work.tool is not None)
        made.page(Step.EXPORT)
        made.page(Step.DEVICES)
        made.idle()
        made.window.messages.clear()
        full.fill()
        what(made, tmp_path)
        made.wait_said("no space left")
        made.wait(lambda: made.said("free disk space") or made.said("no space left", "choose"))
        made.idle()
        assert made.alive()
        assert made.window.bench.running == set()
        full.free()
        shown(made.qtbot, made.window, made.window.menus.open_again)
        made.window.bench.desk.do(lambda session: session.note("continues")).result(10)
        assert not made.unexpected
    close(made)
    assert results(folder) == before
    assert not check(folder).problems


def mounted(folder, size):
    folder.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
    try:
        subprocess.run(command, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("this computer mounts no small disk for a test")
    return folder


def test_a_home_that_cannot_be_written_is_no_reason_to_stop(made, tmp_path, full):
    made.new(tmp_path / "s")
    full.fill()
    made.page(Step.PROBE)  # remembered for the next start, if that goes
    made.idle()
    full.free()
    assert made.alive()
    assert not made.unexpected


# ---- sessions ------------------------------------------------------------------------------------


def damaged(calibrated, folder, damage):
    shutil.copytree(calibrated, folder)
    journal = folder / "journal"
    content = bytearray(journal.read_bytes())
    if damage == "flipped":
        content[len(content) // 3] ^= 0x10
        journal.write_bytes(content)
    elif damage == "empty":
        journal.write_bytes(b"")
    elif damage == "no journal":
        journal.unlink()
    elif damage == "result is gone":
        for file in (folder / "results").iterdir():
            file.unlink()
    elif damage == "result is changed":
        for file in (folder / "results").iterdir():
            file.chmod(0o644)
            changed = bytearray(file.read_bytes())
            changed[len(changed) // 2] ^= 0x01
            file.write_bytes(changed)
    return folder


@pytest.mark.parametrize("damage", ["flipped", "empty", "no journal"])
def test_a_damaged_journal_is_said_and_left_as_it_is(made, calibrated, tmp_path, damage):
    folder = damaged(calibrated, tmp_path / "s", damage)
    before = {file.name: file.read_bytes() for file in folder.rglob("*") if file.is_file()}
    made.window.sessions.open(folder)
    made.wait(lambda: made.window.start.question.sentence != "")
    sentence = made.window.start.question.sentence
    assert str(folder) in sentence
    assert "Traceback" not in sentence
    assert any(word in sentence for word in ("backup", "repair", "check the path"))
    assert made.window.bench is None
    after = {file.name: file.read_bytes() for file in folder.rglob("*") if file.is_file()}
    assert before == after
    made.new(tmp_path / "another")  # and the window goes on
    assert not made.unexpected


@pytest.mark.parametrize("damage", ["result is gone", "result is changed"])
def test_results_that_are_damaged_are_said_and_every_page_still_opens(made, calibrated, tmp_path, damage):
    made.open(damaged(calibrated, tmp_path / "s", damage))
    for step in Step:
        made.page(step)
        made.idle()
    made.wait_said("files in this session have changed since they were written")
    made.wait_said("results/", "restore it from an archive")
    assert made.alive()
    assert not made.unexpected


def test_a_session_that_vanishes_while_it_is_open(made, calibrated, tmp_path):
    folder = shutil.copytree(calibrated, tmp_path / "s")
    made.open(folder)
    made.idle()
    shutil.move(folder, tmp_path / "elsewhere")
    for step in Step:
        made.page(step)
    made.idle()
    made.window.bench.do("Noting", lambda session: session.note("n"))
    made.wait_said("reload the session")
    assert made.alive()
    assert not made.unexpected
    close(made)
    assert not check(tmp_path / "elsewhere").problems


# ---- killed --------------------------------------------------------------------------------------

_KILLED = """
import sys
from pathlib import Path
from contactbench.app import application
from contactbench.app.window import MainWindow
from contactbench.pipeline.steps import Step
from PySide6.QtCore import QTimer

class Window(MainWindow):
    def look(self):
        page = self.pages.current
        if self.bench is None or self.pages.step is not Step.GRAVITY or not self.bench.connected:
            return
        if page.run.phase == "idle":
            page.primary.click()
        elif page.run.phase == "capturing" and page.run._tape.seconds > 2.0:
            print("recording", flush=True)

    def show(self):
        super().show()
        self.timer = QTimer(self, interval=200)
        self.timer.timeout.connect(self.look)
        self.timer.start()

application.MainWindow = Window
application.run(Path(sys.argv[1]), virtual=True)
"""


def on_disk(folder):
    """Return how many wrenches of an unfinished recording are on the disk."""
    (file,) = (folder / "raw").glob("unfinished-*.mcap")
    return sum(len(each.times) for each in read_recording(file).wrenches.values())


def test_killed_while_it_records_the_next_start_asks_and_adopts(made, tmp_path):
    folder = tmp_path / "s"
    other = subprocess.Popen([sys.executable, "-c", _KILLED, str(folder)], stdout=subprocess.PIPE, text=True)
    try:
        assert other.stdout.readline().strip() == "recording"
        until(lambda: on_disk(folder) > 200)
    finally:
        other.send_signal(signal.SIGKILL)
        other.wait()
        other.stdout.close()
    made.window.sessions.open(folder)
    made.wait(lambda: made.window.start.question.sentence != "")
    sentence = made.window.start.question.sentence
    assert "ended unexpectedly" in sentence
    assert sentence.endswith("?")
    yes = made.window.start.question.answers()[0]
    with made.qtbot.waitSignal(made.window.shown, timeout=LONG):
        made.qtbot.mouseClick(yes, Qt.MouseButton.LeftButton)
    made.wait_said("gravity-1.mcap", "recovered")
    assert made.window.pages.step is Step.GRAVITY
    page = made.window.pages.current
    made.wait(lambda: page.primary.text() == "Continue gravity-1.mcap")
    (kept,) = [each for each in made.window.bench.desk.state.inputs if each.name == "gravity-1.mcap"]
    assert kept.about["wrenches"] > 200
    assert not made.unexpected
    close(made)
    assert not check(folder).problems


def test_a_recording_is_adopted_after_an_ordinary_day_too(made, tmp_path):
    with Session.create(tmp_path / "s") as session:
        record(session, "gravity-1.mcap", batches(1), abruptly=True)
    made.window.sessions.open(tmp_path / "s")
    made.wait(lambda: made.window.start.question.sentence != "")
    later = made.window.start.question.answers()[1]
    with made.qtbot.waitSignal(made.window.shown, timeout=LONG):
        made.qtbot.mouseClick(later, Qt.MouseButton.LeftButton)
    assert list((tmp_path / "s" / "raw").glob("unfinished-*"))
    assert made.alive()


# ---- leaving while work goes on ------------------------------------------------------------------


@pytest.fixture
def tried(qtbot, tmp_path):
    with whole(qtbot, tmp_path) as window:
        shown(qtbot, window.window, lambda: window.window.sessions.try_virtual(tmp_path / "s"))
        window.wait(lambda: window.window.bench.connected)
        yield window


def quit_by_key(tried):
    """Do what the key does; the key itself reaches the window only where a window manager gives it the focus."""
    quits = [
        each for each in tried.window.findChildren(QAction) if QKeySequence("Ctrl+Q") in each.shortcuts()
    ]
    assert len(quits) == 1
    quits[0].trigger()


def answer(tried, button):
    tried.wait(button.isVisible)
    tried.qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def record_gravity(tried):
    page = tried.page(Step.GRAVITY)
    tried.wait(page.primary.isEnabled)
    tried.qtbot.mouseClick(page.primary, Qt.MouseButton.LeftButton)
    tried.wait(lambda: page.run.phase is Phase.CAPTURING and page.run._tape.seconds > 0.5)
    return page


def test_with_nothing_going_on_nothing_is_asked(tried):
    tried.idle()
    quit_by_key(tried)
    assert tried.window.departure.question is None
    tried.wait(lambda: not tried.window.isVisible())


def test_not_closed_after_all(tried, tmp_path):
    page = record_gravity(tried)
    departure = tried.window.departure
    quit_by_key(tried)
    assert "Recording a" in departure.question.text()
    assert departure.wait is None  # a recording does not end by itself
    quit_by_key(tried)  # asked once
    answer(tried, departure.stay)
    tried.wait(lambda: departure.question is None)
    assert tried.alive()
    assert page.run.phase is Phase.CAPTURING
    # Another session is not opened either, now or when this one is closed.
    tried.window.sessions.new(tmp_path / "other")
    answer(tried, departure.stay)
    tried.qtbot.mouseClick(page.panel.stop, Qt.MouseButton.LeftButton)
    tried.wait(lambda: page.run.phase is Phase.IDLE)
    tried.window.close_session()
    tried.wait(lambda: tried.window.bench is None)
    tried.idle()
    assert tried.window.bench is None
    assert not (tmp_path / "other").exists()
    assert not tried.unexpected


def test_stopped_a_recording_is_kept(tried, tmp_path):
    record_gravity(tried)
    quit_by_key(tried)
    answer(tried, tried.window.departure.stop)
    tried.wait(lambda: not tried.window.isVisible())
    assert not tried.unexpected
    with Session.open(tmp_path / "s") as session:
        assert ("recording", "gravity-1.mcap") in session.state.current_inputs
    assert not check(tmp_path / "s").problems


def test_waited_for_it_is_closed_when_the_work_is_done(tried, tmp_path):
    stages, may_end, ended = tried.page(Step.PROBE).stages, threading.Event(), []
    tried.wait(lambda: not stages.worker.busy)
    stages.take(egg(tmp_path))
    tried.wait(lambda: draft_of(tried.window.bench.desk.state) is not None)
    stages.worker.start("Working", lambda _monitor: may_end.wait(60), ended.append)
    quit_by_key(tried)
    departure = tried.window.departure
    assert "Preparing the probe" in departure.question.text()
    answer(tried, departure.wait)
    tried.wait(lambda: departure.waiting)
    assert tried.alive()  # meanwhile it can be used
    may_end.set()
    tried.wait(lambda: not tried.window.isVisible())
    assert ended == [True]  # neither stopped nor left before its end
    assert not tried.unexpected
    with Session.open(tmp_path / "s", write=False) as session:
        assert draft_of(session.state).name == "egg.stl"


def test_why_it_failed_leaves_the_status_bar_once_it_went_well(tried, tmp_path):
    stages, newest = tried.page(Step.PROBE).stages, tried.window._newest
    (tmp_path / "text.stl").write_text("no mesh")
    tried.wait(lambda: not stages.worker.busy)
    stages.take(tmp_path / "text.stl")
    tried.wait(lambda: "text.stl" in stages.bar.words)
    assert newest.isHidden()  # the foot of the page says it
    tried.window.show_step(Step.DEVICES)
    stages.take(tmp_path / "text.stl")
    tried.wait(newest.isVisible)
    stages.take(egg(tmp_path))
    tried.wait(newest.isHidden)
    assert not tried.unexpected
