"""The window with its real pages."""

from PySide6.QtCore import Qt

from contactbench.pipeline.steps import Step

from .conftest import beats, close, shown


def test_every_page_is_visited_on_the_virtual_bench_without_a_complaint(qtbot, make_window):
    window = make_window()
    start = window.start.virtual_button
    shown(qtbot, window, lambda: qtbot.mouseClick(start, Qt.MouseButton.LeftButton))
    qtbot.waitUntil(lambda: window.bench.connected, timeout=60_000)
    for step in Step:
        qtbot.mouseClick(window.steps.row(step), Qt.MouseButton.LeftButton)
        assert window.pages.step is step
        assert window.pages.current.step is step
        beats(qtbot, window)
    assert [text for text in window.messages.texts() if "went wrong" in text] == []
    close(qtbot, window)
    assert "error" not in window.messages.weights()
