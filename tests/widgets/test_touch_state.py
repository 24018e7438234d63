"""The state of a touch and its error, as a person sees and hears of them."""

import math

import pytest

from contactbench.widgets.theme import colours, palette
from contactbench.widgets.touch_state import ErrorView, TouchState


@pytest.fixture
def state(qtbot):
    made = TouchState()
    qtbot.addWidget(made)
    made.setPalette(palette(False))
    made.resize(340, 160)
    return made


def has(widget, colour, box):
    """Whether a colour is drawn in a part (x, y, width, height) of a widget."""
    image = widget.grab(widget.rect()).toImage()
    ratio = image.devicePixelRatio()
    left, top, width, height = (round(ratio * each) for each in box)
    return any(
        image.pixelColor(x, y).name() == colour
        for x in range(left, min(left + width, image.width()))
        for y in range(top, min(top + height, image.height()))
    )


def test_each_state_has_a_word_of_its_own(state):
    words = set()
    for name in ("idle", "armed", "touching", "settled", "accepted", "rejected"):
        state.show_state(name, "because")
        words.add(state.word)
        assert state.word in state.accessibleName()
        assert "because" in state.accessibleName()
        assert not state.grab().isNull()
    assert len(words) == 6


def test_how_sure_the_contact_is_stands_below_and_a_doubt_has_a_sign(state):
    below = (0, 170, 340, 74)
    state.resize(state.sizeHint())
    empty = state.grab().toImage()
    state.show_contact("Confidence 98 %")
    assert "Confidence 98 %" in state.accessibleName()
    assert state.grab().toImage() != empty
    theme = colours(False)
    assert has(state, theme.good, below)
    state.show_contact("Two touches detected; both are shown.", False)
    assert has(state, theme.warning, below)
    assert not has(state, theme.good, below)
    state.show_contact("")
    assert state.grab().toImage() == empty


def test_the_gauge_rises_with_the_force_and_tells_whether_it_is_in_the_window(state):
    gauge = (270, 10, 60, 110)
    theme = colours(False)
    state.show_state("touching", "", 5.0, (8.0, 10.0))
    assert has(state, theme.accent, gauge)
    assert not has(state, theme.good, gauge)
    state.show_state("touching", "", 9.0, (8.0, 10.0))
    assert has(state, theme.good, gauge)
    state.show_state("touching", "", math.nan, (8.0, 10.0))
    assert not has(state, theme.good, gauge)


def test_the_error_is_a_number_with_its_scatter(qtbot):
    view = ErrorView()
    qtbot.addWidget(view)
    assert view.number == "–"
    view.show_errors(0.734, None)
    assert view.number == "0.73 mm"
    view.show_errors(0.734, 0.123, (0.6, 0.8), (0.5, -0.2, 0.1), 2.0, "of accepted touches")
    assert view.number == "0.73 ± 0.12 mm"
    assert "0.73 ± 0.12 mm" in view.accessibleName()
    assert not view.grab().isNull()


def test_an_error_points_where_it_is(qtbot):
    view = ErrorView()
    qtbot.addWidget(view)
    view.resize(340, 156)
    accent = colours(False).accent
    right, left = (294, 30, 30, 34), (256, 30, 30, 34)
    view.show_errors(1.0, None, (), (1.5, 0.0, 0.0), 2.0)
    assert has(view, accent, right)
    assert not has(view, accent, left)
    view.show_errors(1.0, None, (), (-1.5, 0.0, 0.0), 2.0)
    assert has(view, accent, left)
