"""The table of markers, and the checklist: what they show, and what they ask for."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QPushButton

from contactbench.pipeline.session.why import CheckItem, CheckState
from contactbench.pipeline.steps import Step
from contactbench.pipeline.workbench.verify_touches import MarkerRow
from contactbench.widgets.checklist import Checklist
from contactbench.widgets.marker_table import MarkerTable

ROWS = (
    MarkerRow("tip", (0.0, -1.2, 150.4), 1, 2, 0.42, 0.51),
    MarkerRow("left", (10.0, 0.0, 150.0), 2, 2, 2.4, 3.1, "failed"),
    MarkerRow("right", (-10.0, 0.0, 150.0)),
)


@pytest.fixture
def table(seen):
    made = MarkerTable()
    made.show_rows(ROWS, 0)
    return seen(made, 340, 300)


def texts(table):
    return [
        [table.item(row, column).text() for column in range(table.columnCount())]
        for row in range(table.rowCount())
    ]


def test_rows_are_shown_with_words_and_icons(table):
    assert texts(table) == [
        ["tip", "0  -1  150", "1 / 2", "0.42", "next"],
        ["left", "10  0  150", "2 / 2", "2.40 / 3.10", "too far off"],
        ["right", "-10  0  150", "0 / 1", "", "open"],
    ]
    assert all(not table.item(row, 4).icon().isNull() for row in range(3))
    table.show_rows(ROWS[:1])
    assert table.rowCount() == 1


def test_nothing_is_cut_at_the_width_of_a_page(table):
    header = table.horizontalHeader()
    for wide in (200, 360, 600):
        table.resize(wide, 200)
        assert all(header.sectionSize(each) >= header.sectionSizeHint(each) for each in range(header.count()))
        assert (header.length() == table.viewport().width()) == (wide > 200)  # else it scrolls


def test_a_name_that_is_typed_is_only_asked_for(table, qtbot):
    with qtbot.waitSignal(table.rename_wanted) as asked:
        table.item(0, 0).setText(" nose ")
    assert asked.args == ["tip", "nose"]
    assert table.item(0, 0).text() == "tip"
    with qtbot.assertNotEmitted(table.rename_wanted):
        table.item(1, 0).setText("left")
        table.item(1, 0).setText("  ")


def test_delete_asks_for_what_is_selected(table, qtbot):
    table.select("left")
    assert table.current_name == "left"
    with qtbot.waitSignal(table.remove_wanted) as asked:
        qtbot.keyClick(table, Qt.Key.Key_Delete)
    assert asked.args == [["left"]]


def test_a_new_error_keeps_what_is_selected(table):
    table.select("right")
    table.show_rows((*ROWS[:2], MarkerRow("right", (-10.0, 0.0, 150.0), 1, 1, 0.2, 0.2, "done")))
    assert table.current_name == "right"
    assert texts(table)[2][3:] == ["0.20", "done"]


def test_a_checklist_says_what_to_do_and_leads_there(qtbot):
    checks = Checklist()
    qtbot.addWidget(checks)
    checks.show_items(
        (
            CheckItem("Probe", CheckState.DONE, "Made.", Step.PROBE),
            CheckItem("Verification", CheckState.STALE, "The probe <b>changed</b>.", Step.VERIFY),
        )
    )
    (button,) = checks.findChildren(QPushButton)
    assert "Verification" in button.accessibleName()
    with qtbot.waitSignal(checks.wanted) as asked:
        button.click()
    assert asked.args == [Step.VERIFY]
    words = [label.text() for label in checks.findChildren(type(checks._grid.itemAtPosition(1, 1).widget()))]
    assert any("stale" in text and "&lt;b&gt;changed" in text for text in words)
