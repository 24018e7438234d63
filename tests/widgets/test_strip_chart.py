import numpy as np
import pytest
from driving.hand import turn_wheel
from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import QApplication, QLabel, QVBoxLayout, QWidget

from contactbench.widgets.strip_chart import ChartHistory, StripChart
from contactbench.widgets.strip_chart_pane import Curves, Pane, decimate, nearest, steady_range
from contactbench.widgets.theme import dress, use_theme


def history(count=2000, rate=200.0, start=50.0, bias=0.0):
    times = start + np.arange(count) / rate
    raw = np.tile([1.0, -2.0, 3.0, 0.1, -0.2, 0.3], (count, 1)) + bias
    return ChartHistory(times, raw, np.full((count, 6), np.nan))


@pytest.fixture
def chart(seen):
    return seen(StripChart(), 1200, 320)


def wheel(pane, steps):
    view = pane._plot.viewport()
    turn_wheel(view, view.rect().center(), steps)


# ---- fewer points --------------------------------------------------------------------------------


def test_decimating_keeps_every_peak():
    times = np.arange(60_000) / 1000
    values = np.zeros((60_000, 3))
    values[31_234, 1], values[7, 2] = 9.0, -4.0
    drawn, points = decimate(times, values, 0.0, 60.0, 500)
    assert len(drawn) == len(points) <= 2 * 500 + 4
    assert points[:, 1].max() == 9.0
    assert points[:, 2].min() == -4.0
    assert drawn[np.argmax(points[:, 1])] == pytest.approx(31.234, abs=0.13)


def test_decimating_leaves_few_points_alone_and_a_gap_open():
    times, values = np.arange(100.0), np.arange(100.0)[:, None]
    drawn, points = decimate(times, values, 10.0, 20.0, 50)
    assert drawn[0] <= 10 <= 20 <= drawn[-1] <= 21
    assert (drawn == points[:, 0]).all()
    values = np.full((10_000, 1), np.nan)
    values[:5000] = 1.0
    _, points = decimate(np.arange(10_000.0), values, 0.0, 10_000.0, 100)
    assert np.isnan(points[-1, 0])
    assert points[0, 0] == 1.0


def test_decimating_one_missing_sample_hides_nothing():
    values = np.ones((10_000, 1))
    values[::10] = np.nan
    _, points = decimate(np.arange(10_000.0), values, 0.0, 10_000.0, 100)
    assert np.isfinite(points).all()


def test_nearest_and_nothing():
    assert nearest(np.array([0.0, 1.0, 2.0]), 1.4) == 1
    assert nearest(np.array([0.0, 1.0, 2.0]), 99.0) == 2
    assert nearest(np.empty(0), 0.0) is None


def test_the_axis_changes_seldom():
    shown = steady_range(np.array([0.0, 1.0]), 0.5, None)
    assert steady_range(np.array([0.1, 0.9]), 0.5, shown) == shown
    assert steady_range(np.array([0.0, 50.0]), 0.5, shown)[1] > 50
    assert steady_range(np.array([0.0, 0.001]), 0.5, (-100, 100))[1] < 1
    assert steady_range(np.array([np.nan]), 0.5, shown) == shown


# ---- the charts ----------------------------------------------------------------------------------


def test_the_newest_values_are_written_with_their_unit(chart):
    chart.refresh(history())
    assert chart.panes[0].read_out == "Force: Fx 1.00  Fy -2.00  Fz 3.00 N"
    assert chart.panes[1].read_out == "Torque: Mx 0.100  My -0.200  Mz 0.300 N·m"
    assert chart.panes[2].read_out.endswith("|F| 3.74 N")
    assert chart.panes[3].read_out == "Contact point: x –  y –  z – mm"


def test_compensated_is_shown_once_there_is_a_calibration_unless_somebody_chose(chart):
    data = history()
    chart.refresh(data)
    assert chart.kind.currentText() == "Raw"
    calibrated = ChartHistory(data.times, data.raw, data.raw - 1.0)
    chart.refresh(calibrated)
    assert chart.kind.currentText() == "Compensated"
    assert "Fx 0.00" in chart.panes[0].read_out
    chart.kind.setCurrentIndex(0)
    chart.kind.activated.emit(0)
    chart.refresh(calibrated)
    assert "Fx 1.00" in chart.panes[0].read_out


def test_contacts_are_in_millimetres(chart):
    data = history()
    chart.refresh(
        ChartHistory(
            data.times,
            data.raw,
            data.compensated,
            data.times[-2:],
            np.array([[0.01, 0, 0], [0.02, -0.03, 0.1]]),
        )
    )
    assert chart.panes[3].read_out == "Contact point: x 20.0  y -30.0  z 100.0 mm"


def test_pause_holds_the_picture_until_back_to_live(chart, qtbot):
    chart.refresh(history())
    qtbot.mouseClick(chart.pause_button, Qt.MouseButton.LeftButton)
    assert chart.held
    assert chart.live_button.isVisible()
    chart.refresh(history(bias=5.0))
    assert "Fx 1.00" in chart.panes[0].read_out
    qtbot.mouseClick(chart.live_button, Qt.MouseButton.LeftButton)
    chart.refresh(history(bias=5.0))
    assert not chart.held
    assert not chart.pause_button.isChecked()
    assert "Fx 6.00" in chart.panes[0].read_out


def test_pause_can_be_used_by_the_accessibility_bus_which_toggles_and_never_clicks(chart):
    chart.refresh(history())
    chart.pause_button.toggle()
    assert chart.held
    chart.pause_button.toggle()
    assert not chart.held


def test_the_wheel_zooms_all_panes_and_holds(chart):
    chart.refresh(history())
    before = chart.panes[0]._view.viewRange()[0]
    wheel(chart.panes[0], 3)
    zoomed = chart.panes[0]._view.viewRange()[0]
    assert chart.held
    assert zoomed[1] - zoomed[0] < 0.9 * (before[1] - before[0])
    assert chart.panes[1]._view.viewRange()[0] == pytest.approx(zoomed)
    chart.back_to_live()
    chart.refresh(history())
    assert chart.panes[0]._view.viewRange()[0] == pytest.approx(before)


def test_the_cursor_reads_values_at_its_time(chart):
    data = history()
    data.raw[:, 0] = data.times - data.times[-1]
    chart.refresh(data)
    chart.panes[1].pointed.emit(-4.0)
    assert chart.panes[0].read_out == "Force: Fx -4.00  Fy -2.00  Fz 3.00 N, -4.00 s"
    chart.panes[1].pointed.emit(None)
    assert "Fx 0.00" in chart.panes[0].read_out


def test_there_are_as_many_panes_as_there_is_room(chart, qtbot):
    def shown():
        return [pane.isVisible() for pane in chart.panes]

    assert shown() == [True] * 4
    chart.resize(450, 165)
    qtbot.waitUntil(lambda: shown() == [True, True, False, False])
    chart._toggles[3].trigger()
    assert shown() == [True, True, False, True]
    chart.resize(1200, 320)
    assert shown() == [True, True, False, True]  # what was chosen stays


def test_nothing_at_all_can_be_shown(chart):
    chart.refresh(ChartHistory(np.empty(0), np.empty((0, 6)), np.empty((0, 6))))
    assert "Fx –" in chart.panes[0].read_out
    chart.follow(None)
    chart.tick()


def test_lines_differ_without_their_colours(chart):
    strokes = {line.opts["pen"].style() for line in chart.panes[0]._lines}
    assert len(strokes) == 3


def test_all_panes_are_painted_in_one_go(qtbot, chart):
    """Each flush of a window with a 3D view puts all of it together anew: four a tick are a window that hangs."""
    chart.refresh(history())
    QApplication.processEvents()  # the first takes more
    flushes, asked = Updates(), 0
    chart.installEventFilter(flushes)

    def flushed(wanted):
        nonlocal asked
        asked += 1
        chart.refresh(history(bias=0.01 * asked))
        QApplication.processEvents()
        return flushes.count > wanted

    for tick in range(6):  # again for a flush that the display took together with an uncovered window
        qtbot.waitUntil(lambda tick=tick: flushed(tick), timeout=60_000)
    chart.removeEventFilter(flushes)
    assert 6 <= flushes.count <= asked + 2


class Updates(QObject):
    """Counts how often a window is put on the screen."""

    count = 0

    def eventFilter(self, _watched, event):
        self.count += event.type() == QEvent.Type.UpdateRequest
        return False


def test_the_unit_has_the_room_that_the_font_of_its_window_needs(qtbot):
    use_theme("light")
    window, pane = QWidget(), Pane(Curves("Force", ("force", "target"), "N", 2, 1.0))
    qtbot.addWidget(window)
    dress(window)
    window.show()
    pane.show_data(np.arange(2.0) - 1.0, np.zeros((2, 2)), -1.0, 0.0)
    QVBoxLayout(window).addWidget(pane)
    unit = next(each for each in pane.findChildren(QLabel) if each.text() == "N")
    qtbot.waitUntil(unit.isVisible)
    assert unit.width() >= unit.sizeHint().width()
