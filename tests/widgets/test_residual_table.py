import pytest
from PySide6.QtCore import Qt

from contactbench.pipeline.workbench.gravity_fit import PoseRow, PoseState
from contactbench.widgets.residual_table import SIGMAS, STATE, ResidualTable
from contactbench.widgets.verdict_box import GOOD, REFUSE, Shrinking, VerdictBox

ROWS = (
    PoseRow("pose 1", 1.0, None, "14°, +z down", PoseState.TAKEN, "", 0.84, 0.8, 0.3),
    PoseRow("pose 2", 2.0, None, "90°, -x down", PoseState.REJECTED, "bumped", 6.1, 1.0, 6.1),
    PoseRow("at 5 s", 5.0, None, "moving: not captured", PoseState.REJECTED, "too short", changeable=False),
    PoseRow("pose 3", 7.0, None, "42°, +y down", PoseState.LEFT_OUT, "You left it out."),
)


@pytest.fixture
def table(seen):
    widget = ResidualTable()
    widget.show_rows(ROWS)
    return seen(widget, 330, 200)


def _text(table, row, column, role=Qt.ItemDataRole.DisplayRole):
    return table.model().index(row, column).data(role)


def test_it_says_state_and_residual_in_words_and_numbers(table):
    assert [_text(table, row, STATE) for row in range(4)] == ["captured", "rejected", "rejected", "left out"]
    assert [_text(table, row, SIGMAS) for row in range(4)] == ["0.8 σ", "6.1 σ", "-", "-"]
    assert "bumped" in _text(table, 1, 0, Qt.ItemDataRole.ToolTipRole)
    assert "torque 6.1 sigma" in _text(table, 1, 0, Qt.ItemDataRole.ToolTipRole)
    assert table.height() >= 4 * 28


def test_keys_and_menu_leave_out_and_take_back(table, qtbot):
    table.selectRow(1)
    with qtbot.waitSignal(table.leave_out) as left:
        qtbot.keyClick(table, Qt.Key.Key_Delete)
    assert left.args == [(ROWS[1],)]
    out, back = table.menu().actions()
    assert (out.isEnabled(), back.isEnabled()) == (True, False)
    table.selectRow(3)
    out, back = table.menu().actions()
    assert (out.isEnabled(), back.isEnabled()) == (False, True)
    with qtbot.waitSignal(table.take_back) as taken:
        back.trigger()
    assert taken.args == [(ROWS[3],)]
    table.selectRow(2)  # nothing can be done about it
    assert table.selected() == ()


def test_the_selection_outlives_new_values(table):
    table.selectRow(1)
    table.show_rows(tuple(ROWS))
    assert table.selected() == (ROWS[1],)
    table.show_rows(ROWS[:2])
    assert table.selected() == ()


def test_a_verdict_has_word_and_reasons(qtbot):
    box = VerdictBox()
    qtbot.addWidget(box)
    box.show_verdict(REFUSE, ["Too few poses.", "Take more."])
    assert box.text == "Rejected: do not use: Too few poses.\nTake more."
    box.show_verdict(GOOD, ["Fine."], "So far")
    assert box.accessibleName() == "So far: Fine."


def test_the_curve_falls(qtbot):
    curve = Shrinking()
    qtbot.addWidget(curve)
    curve.resize(100, 44)
    empty = curve.grab().toImage()
    curve.show_values([0.01, 0.001, 0.0001], 0.0005)
    assert curve.grab().toImage() != empty
