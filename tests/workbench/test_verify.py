"""A verification on a bench that goes by steps: from touches to the verdict of the recording, as without a window."""

import json

import pytest
from terminal import invoke
from workbench.touch_session import STEPWISE, press, touch_all

from contactbench.pipeline.errors import InputError, Message
from contactbench.pipeline.export_knobs import ExportKnobs
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.why import why_locked
from contactbench.pipeline.workbench.desk import Desk
from contactbench.pipeline.workbench.live import Live
from contactbench.pipeline.workbench.markers import Markers, keep, spread
from contactbench.pipeline.workbench.verify import VerifyWork, outcome_of, tool_key, tool_of


class Work:
    """A session at work, with its bench."""

    def __init__(self, folder, markers=2):
        self.desk, self.live = Desk(Session.open(folder, by="ada")), Live()
        self.live.open(STEPWISE, STEPWISE)
        self.live.pair.step(400)
        self.tool = tool_of(self.desk.folder, self.desk.state)
        self.markers = spread(self.tool.probe, markers, 1) if markers else Markers()
        self.desk.do(lambda session: keep(session, self.markers)).result()
        self.work = VerifyWork(self.desk, self.live)

    def start(self):
        self.work.start(self.tool, self.markers)
        return self.work

    def set(self, key, value):
        self.desk.do(lambda session: session.set_parameter(key, value)).result()


@pytest.fixture
def folder(calibrated, tmp_path):
    import shutil

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
