"""A verification on a bench that goes by steps: from touches to the verdict of the recording, as without a window."""

import json
import shutil

import numpy as np
import pytest
from terminal import invoke
from workbench.touch_session import STEPWISE, face_markers, press, side, surface, touch_all, weighed

from contactbench.pipeline.errors import InputError, Message
from contactbench.pipeline.export_knobs import ExportKnobs
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.why import why_locked
from contactbench.pipeline.verification import MarkerError, load_markers
from contactbench.pipeline.verification.known_check import TOUCH, WEIGHT, CheckOutcome
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.live import Live
from contactbench.pipeline.workbench.markers import Markers, grid, imported, keep, kept, on_surface, spread
from contactbench.pipeline.workbench.verify import (
    FILES,
    KnownChecks,
    PressReading,
    StillReading,
    VerifyWork,
    known_outcome,
    outcome_of,
    tool_key,
    tool_of,
)


class Work:
    """A session at work, with its bench."""

    def __init__(self, folder, markers=2):
        self.desk, self.live = Desk(Session.open(folder, by="ada")), Live()
        self.live.open(STEPWISE, STEPWISE)
        self.live.pair.step(400)
        self.tool = tool_of(self.desk.folder, self.desk.state)
        self.markers = face_markers(markers) if markers else Markers()
        self.desk.do(lambda session: keep(session, self.markers)).result()
        self.work = VerifyWork(self.desk, self.live)

    def start(self):
        self.work.start(self.tool, self.markers)
        return self.work

    def set(self, key, value):
        self.desk.do(lambda session: session.set_parameter(key, value)).result()


@pytest.fixture
def folder(calibrated, tmp_path):
    return shutil.copytree(calibrated, tmp_path / "s")


@pytest.fixture
def bench(folder):
    made = Work(folder)
    yield made
    made.work.abandon()
    made.live.close()
    made.desk.close()


def test_the_recording_is_judged_and_anybody_gets_the_same_bytes(bench, folder):
    work = bench.start()
    assert work.going_on
    touch_all(bench.live, work)
    seen = work.touches.view()
    outcome = work.finish()
    assert not work.going_on
    assert (outcome.passed, outcome.touches, len(outcome.found.per_marker)) == (True, 2, 2)
    assert outcome.mean_mm == pytest.approx(seen.mean_mm, abs=0.05)
    assert (outcome.differs, outcome.stale) == ("", "")
    assert outcome.report.read_bytes().startswith(b"<!DOCTYPE html")
    state = bench.desk.state
    assert ("recording", "verify-1.mcap") in state.current_inputs
    bench.live.close()
    bench.desk.close()
    made = state.current_results["verification", "verification.json"]
    done = invoke("session", "compute", folder, "verification", "verification.json")
    assert done.exit_code == 0, done.stderr
    with Session.open(folder, write=False) as session:
        assert session.state.current_results["verification", "verification.json"].outcome == made.outcome


def test_contacts_are_asked_for_as_near_as_the_bundle_will(bench):
    assert bench.tool.sigma_max == ExportKnobs().sigma_max == 0.002
    bench.set("config.sigma_max", 0.0)
    assert tool_of(bench.desk.folder, bench.desk.state).sigma_max == 0.0


def test_what_is_limited_later_makes_it_stale(bench):
    work = bench.start()
    touch_all(bench.live, work)
    work.finish()
    bench.set("verification.max_limit_mm", 0.5)
    outcome = outcome_of(bench.desk.folder, bench.desk.state, bench.desk.stale)
    assert "max_limit_mm" in outcome.stale
    assert isinstance(outcome.stale, Message)


def test_limits_and_order_are_those_of_the_session(bench):
    bench.set("verification.mean_limit_mm", 0.001)
    names = list(reversed(bench.markers.names))
    bench.set("verification.order", names)
    work = bench.start()
    assert work.touches.view().next_one == 1
    touch_all(bench.live, work)
    outcome = work.finish()
    assert not outcome.passed
    assert outcome.found.limits.mean_m == pytest.approx(1e-6)
    assert "mean" in outcome.found.verdict.reasons[0]
    file = bench.desk.state.current_results["verification", "verification.json"].file
    content = json.loads((bench.desk.folder / file.path).read_bytes())
    assert content["settings"]["protocol"]["order"] == names


def test_a_marker_that_is_left_out_is_missing(bench):
    work = bench.start()
    assert work.touches.skip() == "M1"
    touch_all(bench.live, work)
    outcome = work.finish()
    assert not outcome.passed
    assert "M1" in " ".join(outcome.found.verdict.reasons)


def test_a_marker_that_is_left_out_for_a_reason_is_not_missing(bench):
    work = bench.start()
    assert work.touches.skip("nothing reaches it") == "M1"
    touch_all(bench.live, work)
    outcome = work.finish()
    assert "M1" not in " ".join(outcome.found.verdict.reasons)
    assert any("M1 (nothing reaches it)" in note for note in outcome.found.verdict.notes)
    state = bench.desk.state
    made = state.current_results["verification", "verification.json"]
    assert made.action.parameters["left_out"] == {"M1": "nothing reaches it"}
    report = state.current_results["report", "report.html"].file.path
    assert "nothing reaches it" in (bench.desk.folder / report).read_text(encoding="utf-8")


def test_a_verification_that_is_thrown_away_leaves_a_note_only(bench):
    work = bench.start()
    press(bench.live, work.touches.markers[0].point_S)
    work.discard()
    state = bench.desk.state
    assert not work.going_on
    assert ("recording", "verify-1.mcap") not in state.current_inputs
    assert ("verification", "verification.json") not in state.current_results


def test_a_session_that_is_closed_keeps_touches_and_forgets_nothing_else(bench):
    work = bench.start()
    press(bench.live, work.touches.markers[0].point_S)
    work.abandon()
    bench.desk.do(lambda _: None).result()
    assert ("recording", "verify-1.mcap") in bench.desk.state.current_inputs


def test_nothing_that_was_touched_is_said_and_kept(bench):
    work = bench.start()
    bench.live.pair.step(250)
    with pytest.raises(InputError, match="contains no touch"):
        work.finish()
    assert ("recording", "verify-1.mcap") in bench.desk.state.current_inputs
    assert not work.going_on
    bench.start()
    assert work.going_on


def test_what_is_missing_is_said_before_anything_begins(bench, tmp_path):
    bench.live.close()
    with pytest.raises(InputError, match="No sensor is open"):
        bench.start()
    with Session.create(tmp_path / "empty") as session:
        assert tool_key(session.state) is None
        assert "Gravity" in why_locked(session.state)
        assert "calibrate" in why_locked(session.state, "calibration")
        with pytest.raises(InputError, match="prepare the probe"):
            tool_of(session.folder, session.state)
        assert outcome_of(session.folder, session.state, {}) is None


def test_without_markers_or_with_one_off_the_probe_nothing_begins(folder):
    bench = Work(folder, markers=0)
    try:
        with pytest.raises(InputError, match="no markers"):
            bench.start()
        bench.markers = Markers().added((0.5, 0.0, 0.0))
        with pytest.raises(InputError, match="off the probe"):
            bench.start()
        assert not bench.work.going_on
    finally:
        bench.live.close()
        bench.desk.close()


# ---- A known weight and a known point on the virtual bench, kept in the session ------------------


KG = 9.80665


@pytest.fixture
def checked(folder):
    checked = Desk(Session.open(folder, by="ada"))
    yield checked
    checked.close()


@pytest.fixture
def stepped():
    stepped = Live()
    stepped.open(STEPWISE, STEPWISE)
    stepped.pair.step(400)
    yield stepped
    stepped.close()


def read(work, stepped, steps=40):
    """Take a still reading, and keep it."""
    work.start(StillReading())
    for _ in range(steps):
        stepped.pair.step(100)
        if work.reading.done:
            return work.keep()
    raise AssertionError(work.reading.sentence)


def weigh(work, stepped, hung=1.0, given=1.0):
    unloaded = read(work, stepped)
    R_SW = stepped.reading().R_WS.T
    stepped.pair.bench.bump((R_SW @ [0, 0, -KG * hung]).tolist(), 60.0)
    stepped.pair.step(500)
    loaded = read(work, stepped)
    return work.compute(WEIGHT, {"unloaded": unloaded, "loaded": loaded}, {"mass": given})


def test_a_kilogram_on_the_virtual_bench(checked, stepped):
    found = weigh(KnownChecks(checked, stepped), stepped)
    assert found.outcome is CheckOutcome.PASSED, found.sentence
    assert found.parameters == {"mass": 1.0}
    assert found == known_outcome(checked.folder, checked.state, checked.stale, WEIGHT)
    recorded = [each.name for each in checked.state.inputs if each.kind == "recording"]
    assert recorded == ["weight-1.mcap", "weight-2.mcap"]
    content = json.loads(
        (checked.folder / checked.state.current_results[WEIGHT, FILES[WEIGHT]].file.path).read_bytes()
    )
    assert content["mass_kg"] == 1.0
    assert (
        content["calibration_sha256"]
        == checked.state.current_results["calibration", "calibration.json"].file.sha256
    )


def test_a_weight_that_is_another_fails(checked, stepped):
    found = weigh(KnownChecks(checked, stepped), stepped, hung=0.9)
    assert found.outcome is CheckOutcome.FAILED
    assert "too little" in found.sentence


def test_a_point_on_the_side(checked, stepped):
    work = KnownChecks(checked, stepped)
    reading = PressReading(weighed().model)
    work.start(reading)
    assert "Press the point" in reading.sentence
    press(stepped, side(), force=9.0, seconds=1.2)
    assert reading.done
    name = work.keep()
    assert name == "point-1.mcap"
    found = work.compute(TOUCH, {"touch": name}, {"point": (1e3 * side()).tolist()})
    assert found.outcome is CheckOutcome.PASSED, found.sentence


def test_a_short_press_does_not_count(checked, stepped):
    work = KnownChecks(checked, stepped)
    reading = PressReading(weighed().model)
    work.start(reading)
    press(stepped, side(), seconds=0.4)
    assert not reading.done
    assert "Press the point" in reading.sentence
    work.discard()
    assert work.reading is None
    assert not [each for each in checked.state.inputs if each.kind == "recording"]


def test_a_report_is_made_anew(sessions, tmp_path):
    folder = shutil.copytree(sessions / "verified", tmp_path / "s")
    checked, stepped = Desk(Session.open(folder, by="ada")), Live()
    try:
        stepped.open(STEPWISE, STEPWISE)
        stepped.pair.step(400)
        before = checked.state.current_results["report", "report.html"].number
        weigh(KnownChecks(checked, stepped), stepped)
        made = checked.state.current_results["report", "report.html"]
        assert made.number > before
        assert not any(checked.stale.values())
        page = (checked.folder / made.file.path).read_text("utf-8")
        assert "Neither was checked" not in page
        assert "for a weight of 1\u00a0kg" in page
    finally:
        stepped.close()
        checked.close()


def test_without_devices_nothing_begins(checked):
    stepped = Live()
    with pytest.raises(InputError, match="No sensor is open"):
        KnownChecks(checked, stepped).start(StillReading())


def test_without_poses_nothing_begins(checked):
    stepped = Live()
    stepped.open(STEPWISE, None)
    try:
        with pytest.raises(InputError, match="orientation"):
            KnownChecks(checked, stepped).start(StillReading())
    finally:
        stepped.close()


def test_no_check_yet(checked):
    assert known_outcome(checked.folder, checked.state, checked.stale, WEIGHT) is None
    assert KnownChecks(checked, Live()).keep() == ""


# ---- the markers of a session --------------------------------------------------------------------


FIRST, SECOND = (0.0, 0.0, 0.15), (0.01, 0.0, 0.15)


def two():
    return Markers().added(FIRST).added(SECOND)


def test_an_edit_gives_new_markers_and_leaves_the_old_ones():
    markers = two()
    assert markers.names == ("M1", "M2")
    assert markers.renamed("M1", "tip").names == ("tip", "M2")
    assert markers.without(["M1"]).names == ("M2",)
    assert markers.without(["M1"]).added(FIRST).names == ("M2", "M3")
    moved = markers.moved("M2", (0.02, 0.0, 0.15))
    assert moved.all[1].point_S.tolist() == [0.02, 0.0, 0.15]
    assert markers.all[1].point_S.tolist() == list(SECOND)
    assert moved != markers
    assert markers == two()


@pytest.mark.parametrize("name", ["M2", "", " x", "a\nb"])
def test_a_name_that_does_not_do_is_refused(name):
    with pytest.raises(MarkerError):
        two().renamed("M1", name)


def test_a_name_that_is_taken_is_refused_when_one_is_added():
    with pytest.raises(MarkerError, match="twice"):
        two().added(FIRST, "M1")


def test_a_session_keeps_them_and_none_of_them(tmp_path):
    with Session.create(tmp_path / "s") as session:
        assert kept(session.folder, session.state) == Markers()
        keep(session, two())
        assert kept(session.folder, session.state) == two()
        keep(session, Markers())
        assert kept(session.folder, session.state) == Markers()
        with pytest.raises(MarkerError, match="no markers"):
            kept(session.folder, session.state).as_set()


def test_a_table_that_was_saved_is_the_same_when_it_is_imported(tmp_path):
    file = tmp_path / "m.csv"
    file.write_bytes(two().to_bytes())
    assert imported(file) == two()
    with pytest.raises(InputError):
        imported(tmp_path / "none.csv")


def test_what_is_spread_is_what_a_file_of_it_holds(tmp_path):
    made = spread(surface(), 5, 1)
    (tmp_path / "m.csv").write_bytes(made.to_bytes())
    points = load_markers(tmp_path / "m.csv").points
    assert np.array_equal(points, [each.point_S for each in made.all])
    assert len(grid(surface(), 0.01, 1)) >= 3
    with pytest.raises(InputError, match="region 7"):
        spread(surface(), 5, 7)


def test_markers_beside_the_surface_are_moved_onto_it():
    off = Markers().added(np.array(spread(surface(), 1, 1).all[0].point_S) + [0, 0, 0.002])
    moved, farthest = on_surface(off, surface())
    assert 0.0005 < farthest <= 0.0021
    assert on_surface(moved, surface())[1] < 1e-6
