import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QColor, QIcon

from contactbench.pipeline.steps import StepState
from contactbench.widgets.theme import NAMES, colours, icon, state_icon, use_theme


def pixels(drawn, size=64, mode=QIcon.Mode.Normal):
    image = drawn.pixmap(QSize(size, size), mode).toImage()
    return [image.pixelColor(x, y) for x in range(image.width()) for y in range(image.height())]


@pytest.mark.parametrize("name", NAMES)
def test_every_icon_shows_something(qapp, name):  # noqa: ARG001
    share = sum(colour.alpha() > 128 for colour in pixels(icon(name))) / 64**2
    assert 0.01 < share < 0.6


def test_states_differ_in_shape_not_only_in_colour(qapp):  # noqa: ARG001
    shapes = {tuple(colour.alpha() > 128 for colour in pixels(state_icon(state))) for state in StepState}
    assert len(shapes) == len(StepState)


def test_an_icon_follows_the_theme(qapp):  # noqa: ARG001
    drawn = icon("add")
    for choice in ("dark", "light"):
        use_theme(choice)
        wanted = QColor(colours(choice == "dark").text)
        middle = drawn.pixmap(64, 64).toImage().pixelColor(32, 32)
        assert abs(middle.lightness() - wanted.lightness()) < 8


def test_large_ones_are_sharp(qapp):  # noqa: ARG001
    blurred = [colour.alpha() for colour in pixels(icon("stop"), 256) if 0 < colour.alpha() < 255]
    assert len(blurred) < 0.05 * 256**2


def test_an_unknown_name_is_refused():
    with pytest.raises(KeyError, match="no icon is called nonsense"):
        icon("nonsense")
