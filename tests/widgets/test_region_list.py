"""The list of regions: what it shows, and what it asks for."""

from dataclasses import replace

import pytest
from PySide6.QtCore import QModelIndex, Qt
from PySide6.QtWidgets import QApplication, QLineEdit

from contactbench.pipeline.mesh.colours import PALETTE
from contactbench.pipeline.workbench.regions import RegionRow
from contactbench.widgets.region_list import AREA, FACETS, NAME, PRIORITY, ColourMenu, RegionListWidget

ROWS = (
    RegionRow("Lens", "#e69f00", 1200, 12.34e-4),
    RegionRow("Side", "#56b4e9", 0, 0.0),
    RegionRow("Neck", "#009e73", 7, 0.5e-4),
)


@pytest.fixture
def listed(seen):
    widget = seen(RegionListWidget(), 320, 300)
    widget.show_rows(ROWS, 1)
    return widget


def text(widget, row, column):
    return widget.rows.index(row, column).data()


def test_it_shows_priority_name_area_and_facets(listed):
    assert [text(listed, 0, column) for column in (PRIORITY, NAME, AREA, FACETS)] == [
        "1",
        "Lens",
        "12.34",
        "1,200",
    ]
    assert "mm²" in listed.rows.index(0, AREA).data(Qt.ItemDataRole.ToolTipRole)
    assert "Lens, priority 1" in listed.rows.index(0, NAME).data(Qt.ItemDataRole.AccessibleTextRole)
    patch = listed.rows.index(0, PRIORITY).data(Qt.ItemDataRole.DecorationRole).pixmap(20, 20).toImage()
    assert patch.pixelColor(patch.width() // 2, patch.height() // 2).name() == "#e69f00"


def test_the_choice_survives_other_areas_and_fewer_rows(listed):
    chosen = []
    listed.chosen.connect(chosen.append)
    listed.choose(3)
    assert chosen == [3]
    listed.show_rows((*ROWS[:2], RegionRow("Neck", "#009e73", 9, 1e-4)))
    assert listed.rank == 3
    assert chosen == [3]
    listed.show_rows(ROWS[:2])
    assert listed.rank == 2
    listed.show_rows(())
    assert listed.rank == 0
    assert chosen[-1] == 0
    assert not listed.remove_button.isEnabled()


def test_a_name_is_typed_in_its_place(listed, qtbot):
    with qtbot.waitSignal(listed.renamed) as asked:
        listed.view.edit(listed.rows.index(0, NAME))
        field = listed.view.findChild(QLineEdit)
        field.setText("Window")
        qtbot.keyClick(field, Qt.Key.Key_Return)
    assert asked.args == [1, "Window"]
    assert text(listed, 0, NAME) == "Lens", "whoever is asked decides"


@pytest.mark.parametrize(("dragged", "before", "to"), [(0, 2, 2), (0, 3, 3), (2, 0, 1), (2, 1, 2), (1, 0, 1)])
def test_dragging_asks_for_another_priority(listed, qtbot, dragged, before, to):
    data = listed.rows.mimeData([listed.rows.index(dragged, NAME)])
    with qtbot.waitSignal(listed.moved) as asked:
        # False, or the view would take the row away that was dragged
        assert not listed.rows.dropMimeData(data, Qt.DropAction.MoveAction, before, 0, QModelIndex())
    assert asked.args == [dragged + 1, to]


def test_dropping_where_it_was_asks_for_nothing(listed, qtbot):
    data = listed.rows.mimeData([listed.rows.index(1, NAME)])
    with qtbot.assertNotEmitted(listed.moved):
        listed.rows.dropMimeData(data, Qt.DropAction.MoveAction, 1, 0, QModelIndex())
        listed.rows.dropMimeData(data, Qt.DropAction.MoveAction, 2, 0, QModelIndex())


def test_buttons_and_keys_ask(listed, qtbot):
    with qtbot.waitSignal(listed.moved) as asked:
        qtbot.mouseClick(listed.down_button, Qt.MouseButton.LeftButton)
    assert asked.args == [1, 2]
    listed.choose(2)
    listed.activateWindow()
    listed.view.setFocus()
    qtbot.waitUntil(lambda: QApplication.focusWidget() is listed.view, timeout=10_000)
    with qtbot.waitSignal(listed.moved) as asked:
        qtbot.keyClick(listed.view, Qt.Key.Key_Up, Qt.KeyboardModifier.AltModifier)
    assert asked.args == [2, 1]
    with qtbot.waitSignal(listed.remove_asked) as asked:
        qtbot.mouseClick(listed.remove_button, Qt.MouseButton.LeftButton)
    assert asked.args == [2]
    with qtbot.waitSignal(listed.add_asked):
        qtbot.mouseClick(listed.add_button, Qt.MouseButton.LeftButton)
    listed.choose(1)
    assert not listed.up_button.isEnabled()


def test_what_nothing_can_touch_is_marked_in_words_and_crossed_out(listed, qtbot):
    assert not listed.untouchable.isChecked()
    with qtbot.waitSignal(listed.marked) as asked:
        listed.untouchable.toggle()  # as the accessibility bus does, which never clicks
    assert asked.args == [1, True]
    before = listed.rows.index(0, PRIORITY).data(Qt.ItemDataRole.DecorationRole).pixmap(20, 20).toImage()
    listed.show_rows((replace(ROWS[0], untouchable=True), *ROWS[1:]))
    assert listed.untouchable.isChecked()
    assert "untouchable" in text(listed, 0, NAME)
    assert "Lens" in text(listed, 0, NAME)
    assert listed.rows.index(0, NAME).data(Qt.ItemDataRole.EditRole) == "Lens"
    assert "untouchable" in listed.rows.index(0, NAME).data(Qt.ItemDataRole.AccessibleTextRole)
    patch = listed.rows.index(0, PRIORITY).data(Qt.ItemDataRole.DecorationRole).pixmap(20, 20).toImage()
    middle = patch.width() // 2
    assert patch.pixelColor(middle, middle).lightness() < before.pixelColor(middle, middle).lightness() - 60
    listed.choose(2)
    assert not listed.untouchable.isChecked()
    listed.show_rows(())
    assert not listed.untouchable.isEnabled()
    assert "1000 times" in listed.untouchable.toolTip()


def test_colours_that_everybody_can_tell_apart_come_first(listed, qtbot):
    qtbot.mouseClick(listed.colour_button, Qt.MouseButton.LeftButton)
    menu = listed.findChild(ColourMenu)
    actions = menu.actions()
    assert len(actions) == len(PALETTE) + 2
    assert actions[0].isChecked()
    assert "in use" in actions[1].text()
    with qtbot.waitSignal(listed.recoloured) as asked:
        actions[4].trigger()
    assert asked.args == [1, PALETTE[4]]
    menu.close()


def test_every_control_has_a_name(listed):
    for button in (listed.up_button, listed.down_button, listed.remove_button, listed.colour_button):
        assert button.accessibleName()
    assert listed.view.accessibleName()
