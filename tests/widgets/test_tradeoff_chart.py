import pytest
from PySide6.QtCore import QPoint, Qt

from contactbench.pipeline.workbench.probe import Trade, TradePoint
from contactbench.widgets.theme import dress, use_theme
from contactbench.widgets.tradeoff_chart import TradeoffChart

TRADE = Trade(
    tuple(
        TradePoint(facets, error, 0.5 + facets / 1e4, facets / 20, facets == 2000)
        for facets, error in ((250, 0.6), (500, 0.33), (1000, 0.22), (2000, 0.12), (5000, 0.04), (12562, 0.0))
    ),
    0.21,
    "Take 2,000 facets.",
)


@pytest.fixture
def chart(seen):
    chart = TradeoffChart()
    chart.show_trade(TRADE, 2000)
    return seen(chart, 330, 300)


def test_a_click_on_a_point_chooses_it(qtbot, chart):
    said = []
    chart.chosen.connect(said.append)
    viewport = chart._plot.viewport()
    for facets in (500, 5000):
        at = viewport.mapFrom(chart, chart.where(facets).toPoint()) + QPoint(4, -3)
        qtbot.mouseClick(viewport, Qt.MouseButton.LeftButton, pos=at)
        qtbot.waitUntil(lambda facets=facets: said[-1:] == [facets])
    assert chart.facets == 5000
    assert "5,000 facets" in chart.accessibleDescription()


def test_a_click_beside_every_point_chooses_nothing(qtbot, chart):
    viewport = chart._plot.viewport()
    far = viewport.mapFrom(chart, chart.where(12562).toPoint()) + QPoint(-90, 5)
    with qtbot.assertNotEmitted(chart.chosen, wait=100):
        qtbot.mouseClick(viewport, Qt.MouseButton.LeftButton, pos=far)


def test_the_arrow_keys_choose_too(qtbot, chart):
    said = []
    chart.chosen.connect(said.append)
    for key in (Qt.Key.Key_Left, Qt.Key.Key_Left, Qt.Key.Key_Right, *[Qt.Key.Key_Right] * 5):
        qtbot.keyClick(chart, key)
    assert said == [1000, 500, 1000, 2000, 5000, 12562]  # and stops at the end


def test_from_a_number_between_the_points_keys_go_to_the_next_one(qtbot, chart):
    chart.choose(1100)
    with qtbot.waitSignal(chart.chosen) as found:
        qtbot.keyClick(chart, Qt.Key.Key_Right)
    assert found.args == [2000]


def test_it_fits_into_the_panel_in_both_themes_and_shows_each_quantity(qtbot, chart):
    dress(chart)
    for theme in ("dark", "light"):
        use_theme(theme)
        for across in range(chart.across.count()):
            chart.across.setCurrentIndex(across)
            assert chart.minimumSizeHint().width() <= 320
            qtbot.waitUntil(
                lambda: all(
                    chart._plot.geometry().contains(chart.where(point.facets).toPoint())
                    for point in TRADE.points
                )
            )
    chart.show_trade(None)
    assert chart.accessibleDescription() == ""
