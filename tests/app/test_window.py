import gc
import logging
import os
import sys
import threading
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt, QtMsgType, qWarning
from PySide6.QtGui import QAction, QDesktopServices, QImage, QUndoCommand, QWheelEvent
from PySide6.QtWidgets import QApplication, QDoubleSpinBox, QListWidget, QScrollArea, QVBoxLayout, QWidget
from shiboken6 import isValid

from contactbench.app.errors import LOG, Faults, LogFile
from contactbench.app.help_book import HelpBook
from contactbench.app.settings import WindowSettings
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session import Session
from contactbench.pipeline.steps import Step
from contactbench.widgets.controls import guard_wheels

from .conftest import beats, close, shown

LONG = 30_000


@pytest.fixture
def window(make_window, plain_pages):  # noqa: ARG001 - for what it does
    return make_window()


@pytest.fixture
def opened(qtbot, window, tmp_path):
    shown(qtbot, window, lambda: window.sessions.new(tmp_path / "a session"))
    return window


def test_a_new_window_offers_sessions_and_nothing_that_needs_one(window):
    assert window.start.isVisible()
    assert not window.docks.step_dock.isVisible()
    assert window.bench is None
    assert not next(a for a in window.menus._only_open if a.text().startswith("&Close")).isEnabled()


def test_a_session_brings_steps_page_scene_and_charts(opened):
    docks = (
        opened.docks.step_dock,
        opened.docks.page_dock,
        opened.docks.chart_dock,
        opened.docks.message_dock,
    )
    assert all(dock.isVisible() for dock in docks)
    assert opened.scene.isVisible()
    assert opened.pages.step is Step.DEVICES
    assert "a session" in opened.windowTitle()


def test_steps_by_click_key_and_page(qtbot, opened):
    qtbot.mouseClick(opened.steps.row(Step.PROBE), Qt.MouseButton.LeftButton)
    assert opened.pages.step is Step.PROBE
    opened.activateWindow()
    qtbot.waitUntil(opened.isActiveWindow, timeout=10_000)
    qtbot.keyClick(opened, Qt.Key.Key_5, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: opened.pages.step is Step.VERIFY, timeout=5000)
    opened.bench.go_to.emit(Step.REGIONS)
    assert opened.pages.step is Step.REGIONS
    probe = opened.pages._pages[Step.PROBE]
    assert probe.calls == ["enter", "leave"]


def test_a_step_that_is_clicked_while_the_session_is_opened_is_shown_and_stays(qtbot, window, tmp_path):
    click = window.steps.row(Step.PROBE).click
    window.pages.judged.connect(lambda _: click(), Qt.ConnectionType.SingleShotConnection)
    shown(qtbot, window, lambda: window.sessions.new(tmp_path / "a session"))
    beats(qtbot, window)
    assert window.pages.step is Step.PROBE
    assert window.pages.current.calls == ["enter"]


def test_the_page_that_is_shown_is_ticked_and_told_its_state(qtbot, opened):
    page = opened.pages.current
    qtbot.waitUntil(lambda: page.ticks > 3, timeout=10_000)
    assert page.status.state == "ready"


def test_pages_are_made_ahead_without_being_entered(qtbot, opened):
    qtbot.waitUntil(lambda: len(opened.pages._pages) == len(Step), timeout=20_000)
    assert opened.pages._pages[Step.EXPORT].calls == []


def test_a_page_that_cannot_be_made_leaves_the_others(qtbot, make_window, plain_pages, tmp_path, monkeypatch):
    seen = []
    monkeypatch.setattr("sys.excepthook", lambda *info: seen.append(info[1]))
    del plain_pages[Step.DEVICES]
    window = make_window()
    shown(qtbot, window, lambda: window.sessions.new(tmp_path / "s"))
    window.show_step(Step.PROBE)
    assert isinstance(seen[0], KeyError)
    assert window.pages.current.calls == ["enter"]


def test_undo_and_redo_belong_to_the_session(qtbot, opened):
    done = []

    class Count(QUndoCommand):
        def redo(self):
            done.append("redo")

        def undo(self):
            done.append("undo")

    assert not opened.menus.undo.isEnabled()
    opened.bench.undo.push(Count("Count"))
    opened.menus.undo.trigger()
    opened.menus.redo.trigger()
    opened.gone.connect(lambda stack=opened.bench.undo: done.append(stack.count()))
    with qtbot.waitSignal(opened.gone, timeout=30_000):
        opened.close_session()
    assert done == ["redo", "undo", "redo", 0]
    assert not opened.menus.undo.isEnabled()


def test_long_work_is_shown_with_a_cancel_button(qtbot, opened):
    stop = threading.Event()
    job = opened.bench.jobs.start("Simplifying", lambda progress, _: (progress(0.5), stop.wait(30)))
    qtbot.waitUntil(lambda: opened.strip.text().startswith("Simplifying"), timeout=10_000)
    assert opened.strip._bar.value() == 500
    qtbot.mouseClick(opened.strip._stop, Qt.MouseButton.LeftButton)
    assert job.cancelled()
    assert opened.strip._stop.text() == "Stopping"
    stop.set()
    qtbot.waitUntil(lambda: opened.strip.text() == "", timeout=10_000)


def test_a_failed_job_is_told_in_its_own_words(qtbot, opened):
    def fail(_progress, _cancelled):
        raise InputError("mesh.stl: no facet: choose another file.")

    opened.bench.jobs.start("Reading", fail)
    qtbot.waitUntil(lambda: opened.messages.texts()[:1] != (), timeout=10_000)
    assert opened.messages.texts()[0] == "Reading: mesh.stl: no facet: choose another file."
    assert opened.messages.weights()[0] == "error"


def test_closing_gives_the_session_back_and_remembers_the_page(qtbot, opened, tmp_path):
    pages = opened.pages
    opened.show_step(Step.GRAVITY)
    gravity = pages.current
    with qtbot.waitSignal(opened.gone, timeout=30_000):
        opened.close_session()
    assert gravity.calls == ["enter", "leave", "close"]
    with Session.open(tmp_path / "a session"):
        pass  # nothing holds its lock
    assert WindowSettings().recent_of(tmp_path / "a session").page == "gravity"
    photo = QImage(str(opened.settings.picture_of(tmp_path / "a session")))
    listed = opened.start.findChild(QListWidget)
    assert listed.item(0).icon().pixmap(listed.iconSize()).toImage().size() == photo.size() / 2
    shown(qtbot, opened, lambda: opened.sessions.open(tmp_path / "a session"))
    assert pages.step is Step.GRAVITY


def test_layout_and_theme_are_remembered(qtbot, opened):
    opened.docks.message_dock.hide()
    opened.set_theme("dark")
    with qtbot.waitSignal(opened.gone, timeout=30_000):
        opened.close_session()
    opened.set_theme("light")
    folder = Path(opened.settings.now.recent[0].folder)
    shown(qtbot, opened, lambda: opened.sessions.open(folder))
    assert opened.docks.message_dock.isHidden()
    assert not opened.docks.chart_dock.isHidden()
    opened.reset_layout()
    assert not opened.docks.message_dock.isHidden()
    assert WindowSettings().now.theme == "light"


def test_a_session_is_opened_while_another_is_open(qtbot, opened, tmp_path):
    shown(qtbot, opened, lambda: opened.sessions.new(tmp_path / "another"))
    assert opened.bench.desk.folder.name == "another"
    with Session.open(tmp_path / "a session"):
        pass


@pytest.mark.parametrize("built", [True, False])
def test_the_documentation_is_offered_where_it_was_built_and_opens_in_the_browser(
    make_window, plain_pages, monkeypatch, tmp_path, built
):
    del plain_pages
    page, opened = tmp_path / "index.html", []
    monkeypatch.setattr("contactbench.app.window_menus.start_page", lambda: page if built else None)
    monkeypatch.setattr(QDesktopServices, "openUrl", opened.append)
    window = make_window()
    (action,) = (each for each in window.findChildren(QAction) if each.text() == "&Documentation")
    assert action.isVisible() == built
    action.trigger()
    assert [url.toLocalFile() for url in opened] == ([str(page)] if built else [])


def test_help_shortcuts_log_and_about_open(opened):
    opened.menus.show_help()
    book = opened.findChild(HelpBook)
    assert book.isVisible()
    assert "sensor" in book.view.toPlainText()
    opened.menus.show_help_page("tutorial")
    assert opened.findChild(HelpBook) is book
    assert book.name == "tutorial"
    book.close()
    opened.menus.show_log()
    dialog = QApplication.activeModalWidget()
    assert "stall" in dialog.view.toPlainText()
    dialog.close()
    opened.menus.show_shortcuts()
    sheet = QApplication.activeModalWidget()
    keys = {sheet.table.item(row, 0).text() for row in range(sheet.table.rowCount())}
    assert {"Ctrl+1", "Ctrl+6", "F1", "Ctrl+Z", "Ctrl+O"} <= keys
    sheet.close()
    opened.menus.show_about()
    about = QApplication.activeModalWidget()
    assert "numpy" in about.licences.toPlainText()
    assert "pytest" not in about.licences.toPlainText()
    about.close()


def test_diagnostics_are_saved_from_the_menu(qtbot, opened, tmp_path):
    opened.menus.save_diagnostics(tmp_path / "d.zip")
    qtbot.waitUntil(lambda: opened.messages.texts()[:1] != (), timeout=20_000)
    assert "Diagnostics saved as" in opened.messages.texts()[0]
    assert (tmp_path / "d.zip").stat().st_size > 500


def test_the_heatmap_viewer_opens_beside_and_closes_with_the_window(qtbot, window):
    window.menus.show_heatmap_viewer()
    window.menus.show_heatmap_viewer()
    viewers = [each for each in QApplication.topLevelWidgets() if each.windowTitle() == "Heatmap viewer"]
    assert [each.isVisible() for each in viewers] == [True, True]
    viewers[0].close()
    close(qtbot, window)
    qtbot.waitUntil(lambda: not any(isValid(each) and each.isVisible() for each in viewers), timeout=10_000)


def test_the_wheel_changes_no_number_that_has_not_the_focus(qtbot):
    area, inner = QScrollArea(), QWidget()
    qtbot.addWidget(area)
    column = QVBoxLayout(inner)
    box, other = QDoubleSpinBox(value=5), QDoubleSpinBox()
    column.addWidget(box)
    column.addWidget(other)
    area.setWidget(inner)
    guard_wheels(area)
    area.show()
    qtbot.waitExposed(area)
    area.activateWindow()
    other.setFocus()
    qtbot.waitUntil(other.hasFocus, timeout=10_000)

    def turn():
        at = QPointF(box.rect().center())
        none, no_keys = Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier
        event = QWheelEvent(
            at,
            box.mapToGlobal(at),
            QPoint(),
            QPoint(0, 120),
            none,
            no_keys,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(box, event)

    turn()
    assert box.value() == 5
    box.setFocus()
    qtbot.waitUntil(box.hasFocus, timeout=10_000)
    turn()
    assert box.value() == 6


@pytest.mark.usefixtures("plain_pages")
def test_opened_and_closed_many_times_nothing_is_left(qtbot, make_window, tmp_path):
    def once(number):
        window = make_window()
        begin = window.sessions.new if number == 0 else window.sessions.open
        shown(qtbot, window, lambda: begin(tmp_path / "s"))
        close(qtbot, window)
        window.deleteLater()
        QApplication.sendPostedEvents(None, 52)  # what was to be deleted later
        QApplication.processEvents()
        del window

    once(0)
    gc.collect()
    windows, threads = len(QApplication.topLevelWidgets()), threading.active_count()
    for number in range(1, int(os.environ.get("CONTACTBENCH_OPENINGS", "6"))):
        once(number)
    gc.collect()
    qtbot.waitUntil(lambda: threading.active_count() <= threads, timeout=10_000)
    assert len(QApplication.topLevelWidgets()) <= windows


def test_a_session_comes_in_turns_and_what_is_asked_meanwhile_follows(qtbot, window, tmp_path):
    for name in ("a", "b"):
        Session.create(tmp_path / name).close()
    window.sessions.open(tmp_path / "a")
    qtbot.waitUntil(lambda: window._turns.going_on, timeout=LONG)
    assert window.bench is None
    window.sessions.open(tmp_path / "b")
    qtbot.waitUntil(lambda: window.bench is not None and window.bench.desk.folder.name == "b", timeout=LONG)
    with Session.open(tmp_path / "a"):
        pass  # it was closed, and its lock given back


def test_a_window_that_is_closed_while_a_session_comes_closes_both(qtbot, window, tmp_path):
    Session.create(tmp_path / "a").close()
    window.sessions.open(tmp_path / "a")
    qtbot.waitUntil(lambda: window._turns.going_on, timeout=LONG)
    window.close()
    assert window.isVisible()
    qtbot.waitUntil(lambda: not window.isVisible(), timeout=LONG)
    Session.open(tmp_path / "a").close()


def test_a_scene_that_cannot_be_made_gives_the_session_back(qtbot, make_window, monkeypatch, tmp_path):
    def broken(_self, _parent=None):
        raise RuntimeError("no OpenGL here")

    Session.create(tmp_path / "a").close()
    told = []
    monkeypatch.setattr("sys.excepthook", lambda _kind, error, _trace: told.append(str(error)))
    monkeypatch.setattr("contactbench.widgets.scene.Scene.__init__", broken)
    window = make_window()
    window.sessions.open(tmp_path / "a")
    qtbot.waitUntil(lambda: bool(told), timeout=LONG)
    assert told == ["no OpenGL here"]
    qtbot.waitUntil(lambda: not window._running(), timeout=LONG)
    assert window.bench is None
    assert window.start.virtual_button.isEnabled()
    Session.open(tmp_path / "a").close()


# ----  --------------------------------------------------------------------------------------------


@pytest.fixture
def faults(qapp):  # noqa: ARG001 - for what it does
    made = Faults()
    made.install()
    yield made
    made.uninstall()


@pytest.mark.usefixtures("plain_pages")
@pytest.mark.qt_no_exception_capture
def test_exceptions_of_any_thread_reach_list_log_and_journal(qtbot, faults, make_window, tmp_path):
    log = LogFile(tmp_path / "log")
    try:
        window = make_window(faults=faults, log=log)
        shown(qtbot, window, lambda: window.sessions.new(tmp_path / "s"))

        def fail():
            raise ZeroDivisionError("in a thread")

        thread = threading.Thread(target=fail)
        thread.start()
        thread.join()
        qtbot.waitUntil(
            lambda: any("in a thread" in text for text in window.messages.texts()), timeout=10_000
        )
        sys.excepthook(*_raised(InputError("a.csv: no column fx: add it.")))
        assert window.messages.texts()[0] == "a.csv: no column fx: add it."
        assert window.messages.weights()[:2] == ("warning", "error")
        notes = window.bench.desk.state.notes
        qtbot.waitUntil(lambda: len(window.bench.desk.state.notes) >= 2, timeout=10_000)
        assert "in a thread" in window.bench.desk.state.notes[0].text, notes
        assert "ZeroDivisionError" in log.read()
        sys.excepthook(*_raised(InputError("a.csv: no column fx: add it.")))
        window.show_step(Step.PROBE)
        assert window.bench.desk.do(lambda session: len(session.state.notes)).result(10) == 2  # told once
    finally:
        log.close()


def _raised(error):
    try:
        raise error
    except InputError:
        return sys.exc_info()


@pytest.mark.qt_no_exception_capture
def test_hooks_are_put_back(qapp):  # noqa: ARG001
    before = (sys.excepthook, threading.excepthook, sys.unraisablehook)
    faults = Faults()
    faults.install()
    faults.install()
    assert sys.excepthook != before[0]
    faults.uninstall()
    assert (sys.excepthook, threading.excepthook, sys.unraisablehook) == before


def test_an_interrupt_is_no_fault(faults, qtbot):
    with qtbot.assertNotEmitted(faults.happened):
        faults.caught(KeyboardInterrupt, KeyboardInterrupt(), None)


@pytest.mark.no_qt_log
def test_what_qt_says_is_in_the_log(faults, caplog):  # noqa: ARG001
    with caplog.at_level(logging.WARNING, logger="contactbench"):
        qWarning("a word of Qt")
    assert "a word of Qt" in caplog.text


def test_what_makes_qt_end_the_process_is_said_where_it_was_started(faults, capsys):
    faults._from_qt(QtMsgType.QtWarningMsg, None, "no icon")
    assert not capsys.readouterr().err
    faults._from_qt(QtMsgType.QtFatalMsg, None, "Could not initialize GLX")
    said = capsys.readouterr().err
    assert "the window cannot be shown: Could not initialize GLX. Check the display" in said


def test_a_log_that_cannot_be_written_is_survived(tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    log = LogFile(tmp_path / "file")
    LOG.info("words")
    assert log.read() == ""
    log.close()
