import json
import os
import shutil
import subprocess
import sys
import weakref
from pathlib import Path

import pytest
from driving.hand import drop_files
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QListWidget, QPushButton, QToolBar
from typer.testing import CliRunner

from contactbench.app import application, commands
from contactbench.app.cli import app
from contactbench.app.opening import VIRTUAL_BENCH, free_folder, unpacked
from contactbench.app.settings import Recent, WindowSettings
from contactbench.app.start import QuestionCard, StartPage
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.archive import export_archive
from contactbench.pipeline.steps import Step
from contactbench.widgets.controls import PanelScroll

from .conftest import shown
from .test_failures_files import mounted


@pytest.fixture
def window(make_window, plain_pages):  # noqa: ARG001 - for what it does
    return make_window()


def asked(window):
    return window.start.question.sentence


class Ring:
    """Holds itself."""

    def __init__(self):
        self.me = self


def rubbish_goes(qtbot):
    """Check that what holds itself is collected, as it is not while modules are imported."""
    rings = [weakref.ref(Ring()) for _ in range(2_000)]
    qtbot.waitUntil(lambda: not any(each() for each in rings), timeout=10_000)


def test_the_virtual_bench_is_one_click_away(qtbot, window):
    start = window.start.virtual_button
    bench = shown(qtbot, window, lambda: qtbot.mouseClick(start, Qt.MouseButton.LeftButton))
    settings = bench.desk.state.settings
    assert settings["devices.sensor"].value == settings["devices.poses"].value == VIRTUAL_BENCH
    assert DeviceAddress.parse(VIRTUAL_BENCH).gives_wrenches
    assert bench.desk.folder.parent == window.settings.sessions
    assert window.pages.step is Step.GRAVITY
    qtbot.waitUntil(lambda: window.bench.connected, timeout=30_000)
    qtbot.waitUntil(lambda: "Hz" in window.live.rates(), timeout=10_000)
    assert window.header.device_line(bench).startswith("virtual bench")


def test_a_virtual_session_is_gone_on_with(qtbot, window, tmp_path):
    shown(qtbot, window, lambda: window.sessions.try_virtual(tmp_path / "v"))
    count = window.bench.desk.state.count
    shown(qtbot, window, lambda: window.sessions.try_virtual(tmp_path / "v"))
    assert window.bench.desk.state.count == count


def test_a_folder_of_something_else_is_refused_in_words(qtbot, window, tmp_path):
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "a.jpg").write_text("x", encoding="utf-8")
    window.sessions.new(tmp_path / "photos")
    qtbot.waitUntil(lambda: asked(window) != "", timeout=10_000)
    assert "photos" in asked(window)
    assert window.bench is None
    window.sessions.open(tmp_path / "photos")
    qtbot.waitUntil(lambda: "session" in asked(window), timeout=10_000)
    assert window.start.virtual_button.isEnabled()
    rubbish_goes(qtbot)


def test_rubbish_goes_again_once_a_session_has_come(qtbot, window, tmp_path):
    shown(qtbot, window, lambda: window.sessions.new(tmp_path / "a"))
    rubbish_goes(qtbot)


def test_a_session_that_is_open_elsewhere_can_be_looked_at(qtbot, window, tmp_path):
    code = (
        "import sys; from pathlib import Path; from contactbench.pipeline.session import Session\n"
        "s = Session.create(Path(sys.argv[1])); s.note('a note of theirs'); print('ready', flush=True); input()"
    )
    folder = tmp_path / "taken"
    other = subprocess.Popen(
        [sys.executable, "-c", code, str(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    with other:
        assert other.stdout.readline().strip() == "ready"
        window.sessions.open(folder)
        qtbot.waitUntil(lambda: "another process" in asked(window), timeout=20_000)
        answer(qtbot, window, "Open read-only")
        assert [note.text for note in window.bench.desk.state.notes] == ["a note of theirs"]
        read_only(qtbot, window, "another program is using this session")
        other.communicate("\n")


@pytest.fixture
def damaged(tmp_path):
    """A session with a damaged record between two notes."""
    folder = tmp_path / "s"
    with Session.create(folder) as session:
        session.note("before")
        begin = (folder / "journal").stat().st_size
        session.note("lost")
        session.note("after")
    content = bytearray((folder / "journal").read_bytes())
    content[begin + 60 : begin + 90] = b"#" * 30
    (folder / "journal").write_bytes(content)
    return folder


def files(folder):
    return {str(file): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def answer(qtbot, window, words):
    """Press the button of an answer, and wait until a session is shown."""
    button = next(each for each in window.start.question.answers() if each.text() == words)
    return shown(qtbot, window, lambda: qtbot.mouseClick(button, Qt.MouseButton.LeftButton))


def read_only(qtbot, window, words):
    """Check that the window says that nothing can be added, and locks its pages; a write is refused in words."""
    lines = lambda: [each for each in window.findChildren(QToolBar, "read-only") if each.isVisible()]  # noqa: E731
    qtbot.waitUntil(lambda: len(lines()) == 1, timeout=10_000)
    assert words in lines()[0].findChildren(QLabel)[-1].text()
    for step in Step:
        window.show_step(step)
        assert not window.docks.pages.currentWidget().isEnabled()
    window.bench.do("Noting", lambda session: session.note("n"))
    qtbot.waitUntil(lambda: any("read-only" in text for text in window.messages.texts()), timeout=10_000)
    with qtbot.waitSignal(window.gone, timeout=30_000):
        window.close_session()
    qtbot.waitUntil(lambda: lines() == [], timeout=10_000)


def test_a_damaged_session_is_salvaged_by_a_button(qtbot, window, damaged):
    before = files(damaged)
    window.sessions.open(damaged)
    qtbot.waitUntil(lambda: "is damaged" in asked(window), timeout=60_000)
    assert window.messages.texts() == ()  # an expected error is asked about, and is no fault
    bench = answer(qtbot, window, "Salvage a copy")
    assert bench.desk.folder == damaged.with_name("s-salvaged")
    assert [note.text for note in bench.desk.state.notes][:2] == ["before", "after"]
    assert any("At least one record is lost" in text for text in window.messages.texts())
    assert files(damaged) == before
    bench.desk.do(lambda session: session.note("continues")).result()


def test_a_damaged_session_is_opened_read_only_by_a_button(qtbot, window, damaged):
    before = files(damaged)
    window.sessions.open(damaged)
    qtbot.waitUntil(lambda: "is damaged" in asked(window), timeout=60_000)
    bench = answer(qtbot, window, "Open read-only")
    assert [note.text for note in bench.desk.state.notes][:2] == ["before", "after"]
    read_only(qtbot, window, "this session is damaged")
    assert files(damaged) == before


def test_each_way_into_a_damaged_session_says_what_it_costs(qtbot, window, damaged):
    before = files(damaged)
    window.sessions.open(damaged)
    qtbot.waitUntil(lambda: "is damaged" in asked(window), timeout=60_000)
    words = [each.text() for each in window.start.question.answers()]
    assert words[:3] == ["Salvage a copy", "Open read-only", "Open up to the damage"]
    salvage, look, cut = window.start.question.costs
    assert salvage.startswith("All 3 whole records")
    assert "at least 1 record" in salvage
    assert "Nothing is lost" in look
    assert "The first 2 records" in cut
    card = window.start.question
    for each in (*card.answers(), *card._costs):  # nothing is cut, as the window is wide
        assert each.width() >= each.minimumSizeHint().width()
        assert each.height() >= each.minimumSizeHint().height()
    assert files(damaged) == before  # looking changes nothing


def test_a_damaged_session_is_opened_up_to_the_damage_by_a_button(qtbot, window, damaged):
    journal = (damaged / "journal").read_bytes()
    window.sessions.open(damaged)
    qtbot.waitUntil(lambda: "is damaged" in asked(window), timeout=60_000)
    bench = answer(qtbot, window, "Open up to the damage")
    assert bench.desk.folder == damaged
    assert [note.text for note in bench.desk.state.notes] == ["before"]
    bench.desk.do(lambda session: session.note("continues")).result()
    (kept,) = damaged.glob("journal.before-repair-*")
    assert kept.read_bytes() == journal


def test_a_folder_on_a_disk_that_is_read_only_is_opened_read_only(qtbot, window, tmp_path):
    disk = mounted(tmp_path / "disk", "8m")
    try:
        folder = disk / "s"
        with Session.create(folder) as session:
            session.note("there")
        subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True, capture_output=True)
        shown(qtbot, window, lambda: window.sessions.open(folder))
        read_only(qtbot, window, "the session folder is not writable")
    finally:
        subprocess.run(["umount", "-l", str(disk)], check=False)


def test_a_folder_that_cannot_be_written_is_opened_read_only(qtbot, window, tmp_path, monkeypatch):
    with Session.create(tmp_path / "s") as session:
        session.note("there")
    before = files(tmp_path / "s")
    monkeypatch.setattr("contactbench.pipeline.session.lock.writable", lambda _path: False)
    bench = shown(qtbot, window, lambda: window.sessions.open(tmp_path / "s"))
    assert [note.text for note in bench.desk.state.notes] == ["there"]
    read_only(qtbot, window, "the session folder is not writable")
    assert files(tmp_path / "s") == before


def test_no_button_of_any_page_can_be_pressed_in_a_session_that_is_read_only(
    qtbot, make_window, tmp_path, monkeypatch
):
    Session.create(tmp_path / "s").close()
    monkeypatch.setattr("contactbench.pipeline.session.lock.writable", lambda _path: False)
    window = make_window()
    shown(qtbot, window, lambda: window.sessions.open(tmp_path / "s"))
    qtbot.waitUntil(lambda: window.findChild(QToolBar, "read-only") is not None, timeout=10_000)
    for step in Step:
        window.show_step(step)
        page = window.docks.pages.currentWidget()
        for button in page.findChildren(QPushButton):
            button.setEnabled(True)  # as pages do when their step's state changes
        window.pages.read_statuses()
        assert [each.text() for each in page.findChildren(QPushButton) if each.isEnabled()] == [], step
        for area in page.findChildren(PanelScroll):
            assert area.isEnabled(), step


def test_what_is_no_session_any_more_is_refused_in_words(qtbot, window, damaged):
    content = (damaged / "journal").read_bytes()
    (damaged / "journal").write_bytes(b"a newer format!!" * (len(content) // 16))
    window.sessions.open(damaged)
    qtbot.waitUntil(lambda: asked(window) != "", timeout=10_000)
    assert "Traceback" not in asked(window)
    assert window.bench is None
    assert window.messages.texts() == ()


def _cut_short(folder):
    """Leave a session as a process does that is killed while it records."""
    code = (
        "import os, sys, time; from pathlib import Path; import numpy as np\n"
        "from contactbench.pipeline.session import Session\n"
        "s = Session.create(Path(sys.argv[1]))\n"
        "(s.folder / 'raw' / 'unfinished-gravity-1.mcap').write_bytes(b'')\n"
        "os._exit(9)"
    )
    subprocess.run([sys.executable, "-c", code, str(folder)], check=False)


@pytest.mark.parametrize(("answer", "left"), [("Add recording", 0), ("Leave it", 1)])
def test_after_a_crash_the_recordings_are_asked_for(qtbot, window, tmp_path, answer, left):
    folder = tmp_path / "s"
    _cut_short(folder)
    window.sessions.open(folder)
    qtbot.waitUntil(lambda: "ended unexpectedly" in asked(window), timeout=10_000)
    button = next(each for each in window.start.question.answers() if each.text().startswith(answer))
    shown(qtbot, window, lambda: qtbot.mouseClick(button, Qt.MouseButton.LeftButton))
    assert len(list((folder / "raw").glob("unfinished-*"))) == left
    assert any("gravity-1" in text for text in window.messages.texts())


def test_killed_at_any_page_the_window_comes_back_to_it(qtbot, window, tmp_path):
    folder = tmp_path / "s"
    shown(qtbot, window, lambda: window.sessions.new(folder))
    window.show_step(Step.VERIFY)
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)  # as a kill at this moment leaves it
    qtbot.waitUntil(lambda: WindowSettings().recent_of(folder).page == "verify", timeout=10_000)
    settings = json.loads(WindowSettings().file.read_text(encoding="utf-8"))
    assert settings["recent"][0] | {"opened": "", "camera": ""} == {
        "folder": str(folder),
        "opened": "",
        "page": "verify",
        "done": "started",
        "camera": "",
    }
    with Session.open(copy) as session:
        assert session.state.count == window.bench.desk.state.count


def test_dropped_folders_are_opened(qtbot, window, tmp_path):
    with Session.create(tmp_path / "s"):
        pass
    assert not window.start.acceptDrops(), "what is dropped on it goes to the window"
    shown(qtbot, window, lambda: drop_files(window, tmp_path / "s"))
    assert window.bench.desk.folder == tmp_path / "s"


def test_recent_sessions_say_when_and_how_far_and_missing_ones_are_grey(qtbot):
    page = StartPage()
    qtbot.addWidget(page)
    rows = (Recent("/a/there", "2026-01-02T03:04:05+00:00", "gravity", "done: Devices"), Recent("/a/gone"))
    page.show_recent(rows, {"/a/gone"})
    table = page.findChild(QListWidget)
    assert "done: Devices" in table.item(0).text()
    assert "2026" in table.item(0).text() or "26" in table.item(0).text()
    assert "missing" in table.item(1).text()
    assert not table.item(1).flags() & Qt.ItemFlag.ItemIsEnabled
    chosen = []
    page.chosen.connect(chosen.append)
    table.itemActivated.emit(table.item(0))
    assert chosen == [Path("/a/there")]


def test_a_question_takes_one_answer(qtbot):
    question, answers = QuestionCard(), []
    qtbot.addWidget(question)
    question.ask(
        "What now?", [("This", lambda: answers.append("this")), ("That", lambda: answers.append("that"))]
    )
    assert question.sentence == "What now?"
    qtbot.mouseClick(question.answers()[1], Qt.MouseButton.LeftButton)
    assert answers == ["that"]
    assert question.sentence == ""


def test_a_free_folder_is_never_one_that_exists(tmp_path):
    first = free_folder(tmp_path, "virtual bench")
    first.mkdir()
    assert free_folder(tmp_path, "virtual bench") != first
    assert os.path.commonpath([first, tmp_path]) == str(tmp_path)


# ---- sessions are opened from what a file manager hands over -------------------------------------


@pytest.fixture
def archive(tmp_path):
    folder = tmp_path / "bench-1"
    session = Session.create(folder)
    session.set_parameter("devices.sensor", "virtual://bench?probe=linear")
    session.close()
    export_archive(folder, tmp_path / "bench-1.contactbench")
    return tmp_path / "bench-1.contactbench"


def test_an_archive_becomes_a_session_of_its_own(archive, tmp_path):
    one, other = (unpacked(archive, tmp_path / "sessions") for _ in range(2))
    try:
        assert one.desk.folder.parent == tmp_path / "sessions"
        assert one.desk.folder.name.startswith("bench-1 ")
        assert one.desk.folder != other.desk.folder
        with Session.open(one.desk.folder, write=False) as session:
            assert session.state.settings["devices.sensor"].value == "virtual://bench?probe=linear"
    finally:
        one.desk.close()
        other.desk.close()


def test_what_is_no_archive_leaves_nothing(tmp_path):
    (tmp_path / "a.contactbench").write_text("no zip", "utf-8")
    with pytest.raises(SessionError, match=r"a\.contactbench"):
        unpacked(tmp_path / "a.contactbench", tmp_path / "sessions")
    assert list((tmp_path / "sessions").iterdir()) == []


def test_the_window_is_given_what_the_command_line_names(archive, monkeypatch):
    given = []
    monkeypatch.setattr(commands, "check_screen", lambda: None)
    monkeypatch.setattr(application, "run", lambda session, **_: given.append(session) or 0)
    assert CliRunner().invoke(app, ["gui", str(archive)]).exit_code == 0
    assert CliRunner().invoke(app, ["gui", "--session", "a"]).exit_code == 0
    assert [str(each) for each in given] == [str(archive), "a"]
    assert CliRunner().invoke(app, ["gui", str(archive), "--session", "a"]).exit_code == 2
