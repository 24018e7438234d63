"""A known weight on the gravity page and a known point on the Verify page, by clicks on the virtual bench."""

import shutil

import pytest
from workbench.touch_session import STEPWISE, side, surface

from contactbench.app.bench import Weight
from contactbench.app.pages.gravity import GravityPage
from contactbench.app.pages.known_check import PointPanel
from contactbench.pipeline.session import Session
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT, CheckOutcome
from contactbench.pipeline.workbench.verify import FILES, tool_of

from .page_window import PageWindow


class Window(PageWindow):
    """On a bench whose clock goes when it is told."""

    def open(self):
        self.bench.live.open(STEPWISE, STEPWISE)
        self.bench.live.pair.step(400)

    def results(self):
        return self.desk.state.current_results


def opened(folder, place):
    return Session.open(shutil.copytree(folder, place), by="ada")


@pytest.fixture
def gravity(qtbot, calibrated, tmp_path):
    made = Window(qtbot, opened(calibrated, tmp_path / "s"), GravityPage)
    made.enter()
    made.until(made.page.weight.isVisible, steps=0)
    yield made
    made.close()


@pytest.fixture
def point(qtbot, calibrated, tmp_path):
    made = Window(qtbot, opened(calibrated, tmp_path / "s"), PointPanel)
    yield made
    made.page.close_panel()
    made.bench.close()


def test_three_clicks_weigh_a_kilogram(gravity):
    w, page = gravity, gravity.page
    panel = page.weight
    w.open()
    assert not panel.second.isEnabled()
    assert not panel.verdict.isVisible()
    panel.certificate.setText("DKD-7")
    w.click(panel.first)
    assert "Remove everything" in panel.hint.text()
    assert not page.primary.isEnabled()  # no captures beside it
    w.until(panel.second.isEnabled)
    assert "Hang the weight on the tool" in panel.hint.text()
    w.click(panel.second)
    w.until(lambda: panel.outcome is not None and not panel.busy)
    assert panel.outcome.outcome is CheckOutcome.PASSED, panel.outcome.sentence
    assert panel.verdict.isVisible()
    assert panel.verdict.text.startswith("Passed: The sensor reads")
    assert page.primary.isEnabled()
    assert w.told[-1].weight is Weight.GOOD
    made = w.results()[WEIGHT, FILES[WEIGHT]]
    assert made.action.parameters == {"mass": 1.0, "mass_sigma": 0.0005, "certificate": "DKD-7"}


def test_a_wrong_mass_fails_and_what_was_typed_stays(gravity):
    w, panel = gravity, gravity.page.weight
    w.open()
    w.click(panel.first)
    w.until(panel.second.isEnabled)
    panel.mass.setValue(0.8)
    w.click(panel.second)
    w.bench.live.pair.bench.bump((w.bench.live.reading().R_WS.T @ [0, 0, -9.80665]).tolist(), 60.0)
    w.until(lambda: panel.outcome is not None and not panel.busy)
    assert panel.outcome.outcome is CheckOutcome.FAILED
    assert panel.verdict.text.startswith("Failed: ")
    assert panel.mass.value() == 0.8
    assert w.told[-1].weight is Weight.ERROR


def test_a_reading_can_be_cancelled(gravity):
    w, panel = gravity, gravity.page.weight
    w.open()
    w.click(panel.first)
    w.until(panel.cancel.isVisible, steps=0)
    w.click(panel.cancel)
    w.until(lambda: not panel.busy, steps=0)
    assert not [each for each in w.bench.desk.state.inputs if each.kind == "recording"]
    assert not panel.second.isEnabled()
    assert panel.first.isEnabled()


def test_without_a_sensor_it_is_said(gravity):
    w, panel = gravity, gravity.page.weight
    w.click(panel.first)
    w.until(lambda: not panel.busy, steps=0)
    assert "No sensor is open" in panel.hint.text()
    assert panel.first.isEnabled()


def test_a_new_calibration_makes_the_check_stale(gravity):
    w, panel = gravity, gravity.page.weight
    w.open()
    w.click(panel.first)
    w.until(panel.second.isEnabled)
    w.click(panel.second)
    w.until(lambda: panel.outcome is not None and not panel.busy)
    done = w.bench.desk.do(
        lambda session: session.mark("calibration", "calibration.json", "stale", "The tool was changed.")
    )
    done.result()
    w.until(lambda: bool(panel.outcome.stale), steps=0)
    assert panel.verdict.text.startswith("Outdated: check again")


def test_a_press_on_a_marker_is_located(point):
    w, panel = point, point.page
    assert not panel.start.isEnabled()
    assert "Place a marker" in panel.start.toolTip()
    tool = tool_of(w.bench.desk.folder, w.bench.desk.state)
    panel.show_markers([("axis", [0.0, 0.0, surface().vertices[:, 2].max()]), ("side", side())], tool.model)
    assert panel.point.currentText() == "side"
    w.open()
    w.click(panel.start)
    w.until(lambda: panel.outcome is not None and not panel.busy, poll=panel.poll)
    assert panel.outcome.outcome is CheckOutcome.PASSED, panel.outcome.sentence
    assert w.results()[TOUCH, FILES[TOUCH]].action.parameters["point"] == pytest.approx(
        [1e3 * v for v in side()]
    )
    assert panel.verdict.text.startswith("Passed: The press was located")
