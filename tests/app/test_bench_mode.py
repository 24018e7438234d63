import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication, QLineEdit

from contactbench.pipeline.steps import Step
from contactbench.widgets.controls import push_button
from contactbench.widgets.glance import Glance

from .conftest import beats, shown


@pytest.fixture
def window(qtbot, make_window, plain_pages, tmp_path):  # noqa: ARG001 - plain pages, for what they do
    made = make_window()
    shown(qtbot, made, lambda: made.sessions.new(tmp_path / "s"))
    page, made.pressed = made.pages.current, []
    page.bar.offer("Capture pose 4 of 6", lambda: made.pressed.append("first"))
    page.bar.offer_second("Finish", lambda: made.pressed.append("second"))
    return made


def test_the_window_is_the_scene_one_glance_and_one_button_and_afterwards_as_before(qtbot, window):
    docks, layout = window.docks.all, window.docks.layout_text()
    window.menus.bench_mode.trigger()
    view = window.bench_mode.view
    beats(qtbot, window)
    assert view.isVisible()
    assert window.isFullScreen()
    assert not any(each.isVisible() for each in (*docks, window.menuBar(), window.header))
    assert view.primary.text() == "Capture pose 4 of 6"
    assert view.primary.height() >= 100, "for gloves, and to be read from two metres"
    window.show_step(Step.PROBE)
    beats(qtbot, window)
    assert not window.docks.page_dock.isVisible()
    assert view.primary.text() != "Capture pose 4 of 6"
    assert view.accessibleName().startswith("Step 3 of 6: Probe")
    window.bench.page_wanted.emit()
    assert not window.bench_mode.on
    assert all(each.isVisible() for each in (*docks, window.menuBar(), window.header))
    assert not window.isFullScreen()
    assert window.docks.layout_text() == layout


def test_three_keys_are_enough(window):
    def key(which, **more):
        QApplication.sendEvent(
            window, QKeyEvent(QEvent.Type.KeyPress, which, Qt.KeyboardModifier.NoModifier, **more)
        )

    key(Qt.Key.Key_Backspace)
    assert not window.pressed, "outside of bench mode it is for what is typed"
    window.bench_mode.set_on(True)
    for which in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Backspace):
        key(which)
    key(Qt.Key.Key_Return, autorep=True)  # a foot switch that is held
    assert window.pressed == ["first", "first", "second"]
    key(Qt.Key.Key_PageDown)
    assert window.pages.step is Step.GRAVITY
    for _ in range(2):
        key(Qt.Key.Key_PageUp)
    assert window.pages.step is Step.DEVICES
    key(Qt.Key.Key_Escape)
    assert not window.bench_mode.on


def test_enter_does_what_is_next_but_in_a_field_ends_what_is_typed(qtbot, window):
    field, other = QLineEdit(), push_button("Other", lambda: window.pressed.append("other"))
    for each in (field, other):
        window.pages.current.layout().addWidget(each)
    window.activateWindow()
    qtbot.waitUntil(window.isActiveWindow, timeout=10_000)
    field.setFocus()
    qtbot.keyClick(field, Qt.Key.Key_Return)
    assert window.pressed == []
    qtbot.keyClick(window, Qt.Key.Key_Return)
    qtbot.mouseClick(other, Qt.MouseButton.LeftButton)
    qtbot.keyClick(window, Qt.Key.Key_Return)
    assert window.pressed == ["first", "other", "first"], "a click leaves Enter to the page's action"
    other.setFocus(Qt.FocusReason.TabFocusReason)
    qtbot.keyClick(other, Qt.Key.Key_Return)
    assert window.pressed[-1] == "other"


def test_what_is_seen_is_said(qtbot, window):
    window.bench_mode.set_on(True)
    view = window.bench_mode.view
    told = Glance("hold still", "Press harder.", "0.031 mm", "error at M3", "warning", 6.0, (5.0, 8.0))
    page = window.pages.current
    page.glance = lambda _status: told
    beats(qtbot, window)
    assert view.accessibleName().endswith("0.031 mm. error at M3. hold still. Press harder.")
