"""A known weight and a known point on the virtual bench, kept in the session."""

import json

import numpy as np
import pytest
from workbench.touch_session import STEPWISE, make_session, press, surface, verify, weighed

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.kernel import SurfaceIndex
from contactbench.pipeline.session import Session
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT, CheckOutcome
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.known_checks import (
    FILES,
    KnownChecks,
    PressReading,
    StillReading,
    known_outcome,
)
from contactbench.pipeline.workbench.live import Live

KG = 9.80665


@pytest.fixture
def desk(tmp_path):
    desk = Desk(Session.open(make_session(tmp_path / "s", tmp_path), by="ada"))
    yield desk
    desk.close()


@pytest.fixture
def live():
    live = Live()
    live.open(STEPWISE, STEPWISE)
    live.pair.step(400)
    yield live
    live.close()


def read(work, live, steps=40):
    """Take a still reading, and keep it."""
    work.start(StillReading())
    for _ in range(steps):
        live.pair.step(100)
        if work.reading.done:
            return work.keep()
    raise AssertionError(work.reading.sentence)


def weigh(work, live, hung=1.0, given=1.0):
    unloaded = read(work, live)
    R_SW = live.reading().R_WS.T
    live.pair.bench.bump((R_SW @ [0, 0, -KG * hung]).tolist(), 60.0)
    live.pair.step(500)
    loaded = read(work, live)
    return work.compute(WEIGHT, {"unloaded": unloaded, "loaded": loaded}, {"mass": given})


def side():
    _, _, feet = SurfaceIndex(surface().vertices, surface().faces).closest(
        np.array([[0.04, 0.0, surface().vertices[:, 2].max() - 0.03]])
    )
    return feet[0]


def test_a_kilogram_on_the_virtual_bench(desk, live):
    found = weigh(KnownChecks(desk, live), live)
    assert found.outcome is CheckOutcome.PASSED, found.sentence
    assert found.parameters == {"mass": 1.0}
    assert found == known_outcome(desk.folder, desk.state, desk.stale, WEIGHT)
    recorded = [each.name for each in desk.state.inputs if each.kind == "recording"]
    assert recorded == ["weight-1.mcap", "weight-2.mcap"]
    content = json.loads(
        (desk.folder / desk.state.current_results[WEIGHT, FILES[WEIGHT]].file.path).read_bytes()
    )
    assert content["mass_kg"] == 1.0
    assert (
        content["calibration_sha256"]
        == desk.state.current_results["calibration", "calibration.json"].file.sha256
    )


def test_a_weight_that_is_another_fails(desk, live):
    found = weigh(KnownChecks(desk, live), live, hung=0.9)
    assert found.outcome is CheckOutcome.FAILED
    assert "too little" in found.sentence


def test_a_point_on_the_side(desk, live):
    work = KnownChecks(desk, live)
    reading = PressReading(weighed().model)
    work.start(reading)
    assert "Press the point" in reading.sentence
    press(live, side(), force=9.0, seconds=1.2)
    assert reading.done
    name = work.keep()
    assert name == "point-1.mcap"
    found = work.compute(TOUCH, {"touch": name}, {"point": (1e3 * side()).tolist()})
    assert found.outcome is CheckOutcome.PASSED, found.sentence


def test_a_short_press_does_not_count(desk, live):
    work = KnownChecks(desk, live)
    reading = PressReading(weighed().model)
    work.start(reading)
    press(live, side(), seconds=0.4)
    assert not reading.done
    assert "Press the point" in reading.sentence
    work.discard()
    assert work.reading is None
    assert not [each for each in desk.state.inputs if each.kind == "recording"]


def test_a_report_is_made_anew(tmp_path):
    folder = verify(make_session(tmp_path / "s", tmp_path))
    desk, live = Desk(Session.open(folder, by="ada")), Live()
    try:
        live.open(STEPWISE, STEPWISE)
        live.pair.step(400)
        before = desk.state.current_results["report", "report.html"].number
        weigh(KnownChecks(desk, live), live)
        made = desk.state.current_results["report", "report.html"]
        assert made.number > before
        assert not any(desk.stale.values())
        page = (desk.folder / made.file.path).read_text("utf-8")
        assert "Neither was checked" not in page
        assert "for a weight of 1\u00a0kg" in page
    finally:
        live.close()
        desk.close()


def test_without_devices_nothing_begins(desk):
    live = Live()
    with pytest.raises(InputError, match="No sensor is open"):
        KnownChecks(desk, live).start(StillReading())


def test_without_poses_nothing_begins(desk):
    live = Live()
    live.open(STEPWISE, None)
    try:
        with pytest.raises(InputError, match="orientation"):
            KnownChecks(desk, live).start(StillReading())
    finally:
        live.close()


def test_no_check_yet(desk):
    assert known_outcome(desk.folder, desk.state, desk.stale, WEIGHT) is None
    assert KnownChecks(desk, Live()).keep() == ""
