from datetime import UTC, datetime

import pytest
from PySide6.QtCore import QLocale
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QComboBox, QListWidget, QPlainTextEdit

from contactbench.widgets.message_list import MessageList


@pytest.fixture
def messages(qtbot):
    QLocale.setDefault(QLocale.c())  # another test may have left a reader's
    made = MessageList()
    qtbot.addWidget(made)
    made.show()
    return made


def rows(messages):
    table = messages.findChild(QListWidget)
    return [table.item(row) for row in range(table.count())]


def test_newest_first_with_time_and_word(messages):
    messages.add("info", "One.", at=datetime(2026, 1, 1, 9, 8, 7, tzinfo=UTC))
    messages.add("error", "Two.", "a trace")
    assert messages.texts() == ("Two.", "One.")
    assert rows(messages)[1].text() == "09:08:07  Note: One."
    assert "Error: Two." in rows(messages)[0].text()


def test_the_same_again_is_counted(messages):
    for _ in range(3):
        messages.add("warning", "The line was lost.")
    assert len(rows(messages)) == 1
    assert rows(messages)[0].text().endswith("(3 times)")


def test_a_device_that_comes_and_goes_is_two_messages(messages):
    for _ in range(40):
        messages.add("warning", "The sensor gives nothing.")
        messages.add("good", "All devices give samples again.")
    assert messages.texts() == ("All devices give samples again.", "The sensor gives nothing.")
    assert all(row.text().endswith("(40 times)") for row in rows(messages))


def test_what_is_long_past_is_told_again(messages):
    messages.add("warning", "The line was lost.")
    for name in "abcdef":
        messages.add("info", f"Wrote {name}.")
    messages.add("warning", "The line was lost.")
    assert len(rows(messages)) == 8


def test_a_message_that_moves_up_stays_selected_and_hidden(messages):
    messages.add("info", "One.")
    messages.add("warning", "Two.")
    rows(messages)[1].setSelected(True)
    messages.findChild(QComboBox).setCurrentIndex(1)
    messages.add("info", "One.")
    assert messages.texts() == ("One.", "Two.")
    assert rows(messages)[0].isSelected()
    assert rows(messages)[0].isHidden()


def test_the_filter_hides_what_matters_less(messages):
    for weight in ("info", "good", "warning", "error"):
        messages.add(weight, f"{weight}.")
    box = messages.findChild(QComboBox)
    seen = []
    for choice in range(3):
        box.setCurrentIndex(choice)
        seen.append([not row.isHidden() for row in rows(messages)])
    assert seen == [[True] * 4, [True, True, False, False], [True, False, False, False]]
    messages.add("info", "Later.")
    assert rows(messages)[0].isHidden()


def test_details_and_copy(messages):
    messages.add("error", "It failed.", "Traceback: x")
    rows(messages)[0].setSelected(True)
    details = messages.findChild(QPlainTextEdit)
    assert details.isHidden()
    messages._more.setChecked(True)
    assert details.toPlainText() == "Traceback: x"
    messages.copy()
    assert "error: It failed.\nTraceback: x" in QGuiApplication.clipboard().text()


def test_it_does_not_grow_without_end(messages):
    for number in range(600):
        messages.add("info", f"{number}")
    assert len(rows(messages)) == 500
    assert messages.texts()[0] == "599"
