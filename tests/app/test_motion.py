"""The window of the closed loop: it takes a bundle, runs it, shows it, stops it."""

import shutil
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.bundle_example import example_config
from shiboken6 import isValid

from contactbench.app.motion import MotionWindow
from contactbench.pipeline.session import Session
from contactbench.pipeline.workbench.desk import Desk
from contactbench.widgets.theme import dress, use_theme

LONG_MS = 60_000


@pytest.fixture(scope="module")
def bundle(tmp_path_factory):
    file = tmp_path_factory.mktemp("bundle") / "runtime.zip"
    example_config(300, rate=200.0, verified=False).write(file)
    return file


@pytest.fixture
def window(qtbot):
    made = MotionWindow(lambda: None)
    dress(made)
    made.resize(1100, 700)
    made.show()
    qtbot.waitExposed(made)
    yield made
    made.close()
    made.deleteLater()


def use(qtbot, window, bundle):
    window.use_bundle(bundle)
    qtbot.waitUntil(window.controls.start.isEnabled, timeout=LONG_MS)


def test_a_bundle_runs_is_seen_and_goes_back(qtbot, window, bundle):
    controls, scene = window.controls, window.picture.scene
    assert not controls.start.isEnabled()
    use(qtbot, window, bundle)
    assert "Not verified" in controls.bundle.text()
    assert "5 N" in controls.bundle.text()
    before = scene.picture()
    controls.robot.setCurrentIndex(controls.robot.findData("virtual://platform"))
    controls.start.click()
    assert controls.stop.isEnabled()
    assert not controls.start.isEnabled()
    qtbot.waitUntil(lambda: controls.state.text() == "In contact", timeout=LONG_MS)
    qtbot.waitUntil(lambda: window.run.newest.force_N > 2.0, timeout=LONG_MS)
    qtbot.waitUntil(lambda: "in contact" in controls.happened.text(), timeout=LONG_MS)
    assert controls.force.text().endswith("N")
    # Phantom and arrow come.
    qtbot.waitUntil(lambda: np.abs(scene.picture().astype(int) - before).max() > 50, timeout=LONG_MS)
    assert "target 5.00" in window.picture.force.read_out
    controls.stop.click()
    qtbot.waitUntil(lambda: not window.run.running and controls.start.isEnabled(), timeout=LONG_MS)
    assert controls.state.text() == "Ended"
    assert controls.force.text() == "–"
    # How far it came before it was stopped depends on the machine.
    tracked = "Tracking" in controls.happened.text()
    assert ("never started tracking" in controls.bar.words) is not tracked
    use_theme("dark")  # while something is shown
    use_theme("light")


def test_wrong_bundles_are_said_in_words(qtbot, window, tmp_path):
    window.use_bundle(tmp_path / "nowhere")
    qtbot.waitUntil(lambda: "no such folder" in window.controls.bar.words, timeout=LONG_MS)
    assert not window.controls.start.isEnabled()
    window.controls.of_session.click()
    assert "No session is open" in window.controls.bar.words
    window.begin()  # of no effect
    assert window.run is None


def test_the_session_that_is_open_is_what_is_run(qtbot, sessions, tmp_path):
    desk = Desk(Session.open(shutil.copytree(sessions / "verified", tmp_path / "bench 1"), by="ada"))
    made = MotionWindow(lambda: SimpleNamespace(desk=desk))
    made.show()
    try:
        made.use_session()
        assert not made.controls.start.isEnabled()
        qtbot.waitUntil(made.controls.start.isEnabled, timeout=LONG_MS)
        assert made.controls.bundle.text().startswith("bench 1: ")
        assert "no gains" in made.controls.bundle.text()
        assert "no rotation is assumed" in made.controls.bundle.text()
        made.begin()  # and so it can be run
        qtbot.waitUntil(lambda: made.run.newest is not None or not made.run.running, timeout=LONG_MS)
        assert made.run.failure == ""
    finally:
        made.close()
        made.deleteLater()
        desk.close()


def test_the_menu_opens_it_and_the_main_window_closes_it(qtbot, make_window):
    main = make_window()
    motion = main.menus.show_motion()
    qtbot.waitExposed(motion)
    assert "virtual bench" in motion.windowTitle()
    main.close()
    qtbot.waitUntil(lambda: not isValid(motion) or not motion.isVisible(), timeout=LONG_MS)


def test_closing_ends_what_runs(qtbot, window, bundle):
    use(qtbot, window, bundle)
    window.begin()
    run = window.run
    window.close()
    assert not run.running
    window.stop()  # of no effect, no error


def test_only_what_moves_has_a_size_and_a_period(window):
    controls = window.controls
    sizes = {}
    for index in range(controls.motion.count()):
        controls.motion.setCurrentIndex(index)
        sizes[controls.motion.currentData()] = (controls.size_of.suffix(), controls.period.isEnabled())
    assert sizes == {
        "in-plane": ("°", True),
        "out-of-plane": ("°", True),
        "vertical": (" mm", True),
        "none": ("°", False),
    }
    controls.motion.setCurrentIndex(controls.motion.findData("vertical"))
    controls.period.setCurrentIndex(controls.period.findData(5.0))
    chosen = controls.choice()
    assert (chosen.motion, chosen.period, chosen.size, chosen.variant) == ("vertical", 5.0, 10.0, None)
