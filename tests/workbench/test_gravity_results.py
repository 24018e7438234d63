import os
import sys

import pytest
from workbench.gravity_bench import batches, block, record

from contactbench.pipeline.calibration import assumptions
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.adoption import adopt_unfinished
from contactbench.pipeline.session.journal import SessionError
from contactbench.pipeline.session.recompute import compute
from contactbench.pipeline.workbench import gravity_fit
from contactbench.pipeline.workbench.gravity import GravityWork
from contactbench.pipeline.workbench.gravity_fit import (
    PoseState,
    change,
    finish,
    gravity_settings,
    interrupted,
    next_name,
    outcome_of,
    take_up,
)


@pytest.fixture
def session(tmp_path):
    with Session.create(tmp_path / "s") as made:
        yield made


def test_the_session_computes_what_was_shown_live(session):
    run = GravityWork(gravity_settings(session.state))
    for batch in batches():
        run.feed(block(batch))
    run.wait()
    live = run.view().solved.calibration
    record(session, "gravity-1.mcap", batches())
    run.finish()
    outcome = finish(session, "gravity-1.mcap", run.left_out)
    run.close()
    assert len(live.poses) == len(outcome.calibration.poses)
    assert outcome.calibration.contact_error == pytest.approx(live.contact_error, rel=0.02)
    assert len(outcome.rows) == 6
    assert outcome.recording == "gravity-1.mcap"
    assert next_name(session.state, session.folder) == "gravity-2.mcap"
    assert next_name(session.state, session.folder, check=True) == "gravity-check-1.mcap"


def _note_written(event, arguments):
    if event == "open" and WRITTEN is not None and (arguments[2] or 0) & (os.O_WRONLY | os.O_RDWR):
        WRITTEN.append(os.path.realpath(arguments[0]))


WRITTEN = None
sys.addaudithook(_note_written)


def test_finishing_and_changing_solve_once_and_copy_no_input(session, monkeypatch):
    global WRITTEN
    run, solved = GravityWork(gravity_settings(session.state)), []
    for batch in batches():
        run.feed(block(batch))
    run.wait()
    record(session, "gravity-1.mcap", batches())
    for module in (assumptions, gravity_fit):
        solve = module.calibrate
        monkeypatch.setattr(module, "calibrate", lambda *a, do=solve, **k: solved.append(1) or do(*a, **k))
    WRITTEN = []
    try:
        run.finish()
        outcome = finish(session, "gravity-1.mcap", run.left_out)
        run.wait()
        assert len(solved) == 1
        change(session, [outcome.rows[1].time])
        assert len(solved) == 2
        folder = os.path.realpath(session.folder)
        places = {os.path.relpath(each, folder) for each in WRITTEN if not each.startswith("/dev/")}
    finally:
        WRITTEN = None
        run.close()
    assert {each for each in places if not each.startswith(f"results{os.sep}.stored.")} <= {"journal"}
    assert len(places) >= 4  # poses and calibration, twice


def test_left_out_poses_are_left_out_and_taken_back(session):
    record(session, "gravity-1.mcap", batches())
    whole = finish(session, "gravity-1.mcap")
    first = session.state.current_results["captures", "poses.csv"].outcome
    without = change(session, [whole.rows[1].time])
    assert len(without.calibration.poses) == 5
    assert without.rows[-1].state is PoseState.LEFT_OUT
    assert without.rows[-1].time == whole.rows[1].time
    assert len(change(session, []).calibration.poses) == 6
    assert session.state.current_results["captures", "poses.csv"].outcome == first
    assert outcome_of(session.folder, session.state).rows[-1].state is PoseState.TAKEN


def test_a_headless_computation_gives_the_same_bytes(session):
    record(session, "gravity-1.mcap", batches())
    whole = finish(session, "gravity-1.mcap")
    change(session, [whole.rows[0].time])
    mine = session.state.current_results["captures", "poses.csv"].outcome
    given = session.state.current_inputs["recording", "gravity-1.mcap"].content
    compute(session, "captures", "poses.csv", {"recording": given}, {"leave_out": [whole.rows[0].time]})
    assert session.state.current_results["captures", "poses.csv"].outcome == mine


def test_an_interrupted_run_is_gone_on_from(session):
    record(session, "gravity-1.mcap", batches(2), abruptly=True)
    adopt_unfinished(session)
    left = interrupted(session.state)
    assert left.name == "gravity-1.mcap"
    name, poses = take_up(session, left.name)
    assert len(poses) == 2
    assert interrupted(session.state) is None
    run = GravityWork(gravity_settings(session.state), earlier=poses)
    rest = batches()[2 * 9 :]
    for batch in rest:
        run.feed(block(batch))
    run.wait()
    assert run.view().count == 6
    assert [row.earlier for row in run.view().rows] == [True] * 2 + [False] * 4
    run.close()
    record(session, "gravity-2.mcap", rest)
    outcome = finish(session, "gravity-2.mcap", earlier=name)
    assert len(outcome.calibration.poses) == 6
    assert [row.changeable for row in outcome.rows] == [False] * 2 + [True] * 4
    assert change(session, [outcome.rows[-1].time]).rows[0].earlier


def test_too_few_poses_are_refused_in_words(session):
    record(session, "gravity-1.mcap", batches(2))
    with pytest.raises(SessionError, match="2 still poses, a calibration needs 3"):
        finish(session, "gravity-1.mcap")
    with pytest.raises(SessionError, match="no recording with this name"):
        finish(session, "gravity-7.mcap")
    with pytest.raises(SessionError, match="record some first"):
        change(session, [])
    assert outcome_of(session.folder, session.state) is None
