import re
from dataclasses import fields

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QSlider, QWidget

from contactbench.widgets import theme
from contactbench.widgets.theme import colours, contrast, dress, is_dark, style_sheet, use_theme

_WRITTEN = ("text", "muted", "accent", "good", "warning", "bad", "stale")


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("ground", ["panel", "background"])
@pytest.mark.parametrize("written", _WRITTEN)
def test_what_is_written_can_be_read(dark, ground, written):
    c = colours(dark)
    assert contrast(getattr(c, written), getattr(c, ground)) >= 4.5


@pytest.mark.parametrize("dark", [False, True])
def test_on_the_accent_too_and_lines_can_be_told(dark):
    c = colours(dark)
    assert contrast(c.panel, c.accent) >= 4.5
    assert all(contrast(colour, c.panel) >= 2.0 for colour in c.series)
    assert len(set(c.series)) == 6


def test_contrast_is_that_of_wcag():
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)


@pytest.mark.parametrize("dark", [False, True])
def test_the_style_sheet_uses_colours_of_the_theme_only(dark):
    sheet = style_sheet(dark)
    known = {getattr(colours(dark), field.name) for field in fields(colours(dark)) if field.name != "series"}
    assert set(re.findall(r"#[0-9a-f]{6}", sheet)) <= known
    assert "{" + "{" not in sheet
    for picture in re.findall(r"url\((.*?)\)", sheet):
        assert theme.Path(picture).is_file()


def test_a_window_is_dressed_as_the_theme_in_use_says(qtbot):
    before, window, other = QWidget(), QWidget(), QWidget()
    for each in (before, window, other):
        qtbot.addWidget(each)
    dress(before)
    assert not before.styleSheet(), "no theme was chosen"
    use_theme("dark")
    dress(window)
    assert is_dark()
    assert before.styleSheet() == window.styleSheet() == style_sheet(True)
    use_theme("light")
    assert not is_dark()
    assert before.styleSheet() == window.styleSheet() == style_sheet(False)
    assert not other.styleSheet()


def test_what_a_dressed_window_is_given_looks_like_it(qtbot):
    window, label = QWidget(), QLabel("words")
    qtbot.addWidget(window)
    use_theme("light")
    dress(window)
    label.setProperty("role", "title")
    label.setParent(window)
    label.ensurePolished()
    assert label.font().pointSizeF() == pytest.approx(15)


@pytest.mark.parametrize("dark", [False, True])
def test_a_slider_shows_the_focus(qtbot, dark):
    use_theme("dark" if dark else "light")
    window = QWidget()
    qtbot.addWidget(window)
    dress(window)
    slider, other = QSlider(Qt.Orientation.Horizontal, window), QSlider(window)
    with qtbot.waitActive(window):
        window.show()
        window.activateWindow()
    pictures = []
    for each in (other, slider):
        each.setFocus(Qt.FocusReason.TabFocusReason)
        pictures.append(slider.grab().toImage())
    assert slider.hasFocus()
    assert pictures[0] != pictures[1]
