from __future__ import annotations

import logging
import sys
import threading

import pytest
from PySide6.QtCore import QtMsgType, qWarning

from contactbench.app.errors import LOG, Faults, LogFile
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.steps import Step

from .conftest import shown


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
