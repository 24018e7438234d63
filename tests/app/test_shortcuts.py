import pytest

from contactbench.app.dialogs import CheatSheet, keys_of
from contactbench.pipeline.steps import Step

from .conftest import shown


@pytest.fixture
def window(make_window, qtbot, tmp_path):
    window = make_window()
    shown(qtbot, window, lambda: window.sessions.new(tmp_path / "s"))
    for step in Step:
        window.show_step(step)
    return window


def test_every_key_of_every_page_is_listed(window):
    keys = {each.keys: each.words for each in keys_of(window)}
    assert keys["F1"] == "This page"
    assert keys["Ctrl+Z"] == "Undo"
    assert "Capture this pose" in keys["Space"]
    assert {"Ctrl+1", "Ctrl+6", "[", "]", "M", "Esc", "Alt+Up", "Ctrl+C"} <= keys.keys()
    assert all(keys.values())


def test_a_key_does_one_thing(window):
    """Of those that hold everywhere: two with one key, and Qt would do neither."""
    keys = [key for action in window.actions() for key in action.shortcuts()]
    assert len(keys) == len(set(keys))


def test_the_sheet_also_has_what_no_action_stands_for(window, qtbot):
    sheet = CheatSheet(window)
    qtbot.addWidget(sheet)
    words = [sheet.table.item(row, 1).text() for row in range(sheet.table.rowCount())]
    assert "Rotate the view" in words
    assert "Leave out the selected poses; remove the selected markers" in words
    assert len(words) == len(set(words))
