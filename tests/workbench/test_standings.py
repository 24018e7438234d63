import json

import pytest
from workbench.changes import observed

from contactbench.pipeline.session import Session
from contactbench.pipeline.session.why import read_facts, results_of, statuses
from contactbench.pipeline.steps import Step, StepState
from contactbench.pipeline.workbench.undo_history import SessionChange, change_between, value_in


@pytest.fixture
def session(tmp_path):
    with Session.create(tmp_path / "session") as found:
        yield found


def look(session, *, connected=True, running=(), failed=None, facts=None):
    facts = facts or read_facts(session.folder, session.state)
    return statuses(session.state, session.stale(), set(running), connected, failed or {}, facts)


def states(session, **given):
    return [status.state.value for status in look(session, **given).values()]


def add(session, kind, content, name=None):
    names = {"calibration": "calibration.json", "probe": "probe.ply", "verification": "verification.json"}
    name = name or names[kind]
    session.add_result(kind, name, {name: json.dumps(content).encode()}, {}, {})


GOOD = {"verdict": {"level": "good", "reasons": ["All is well."]}}
PASSED = {"verdict": {"passed": True, "reasons": []}, "overall": {"mean_mm": 0.4, "max_mm": 0.9}}


def test_a_new_session_begins_with_the_devices(session):
    assert states(session) == ["ready", "locked", "ready", "locked", "locked", "locked"]
    assert "Choose the devices first" in look(session)[Step.GRAVITY].sentence


def test_devices_unlock_gravity_and_say_whether_they_are_connected(session):
    session.set_parameter("devices.sensor", "sri+tcp://192.168.0.108?rate=200")
    found = look(session, connected=False)
    assert found[Step.DEVICES].state is StepState.DONE
    assert "sri+tcp://192.168.0.108." in found[Step.DEVICES].sentence
    assert "Not connected" in found[Step.DEVICES].sentence
    assert found[Step.GRAVITY].state is StepState.READY
    assert "orientation" in look(session)[Step.DEVICES].sentence  # there is no source of poses


def test_the_way_to_a_bundle(session):
    session.set_parameter("devices.sensor", "virtual://bench")
    session.set_parameter("devices.poses", "virtual://bench")
    add(session, "calibration", GOOD)
    assert states(session) == ["done", "done", "ready", "locked", "locked", "locked"]
    assert look(session)[Step.VERIFY].sentence == "Prepare the probe first."
    add(session, "probe", {})
    assert states(session) == ["done", "done", "done", "ready", "ready", "locked"]
    add(session, "verification", PASSED)
    assert states(session) == ["done", "done", "done", "ready", "done", "ready"]
    assert "0.40 mm on average" in look(session)[Step.VERIFY].sentence
    session.set_parameter("export.results", dict(results_of(session.state)))
    assert states(session) == ["done", "done", "done", "ready", "done", "done"]


def test_a_refused_calibration_failed_and_locks_what_rests_on_it(session):
    session.set_parameter("devices.sensor", "virtual://bench")
    add(session, "calibration", {"verdict": {"level": "refuse", "reasons": ["The poses are all alike."]}})
    add(session, "probe", {})
    found = look(session)
    assert found[Step.GRAVITY].state is StepState.FAILED
    assert "The poses are all alike." in found[Step.GRAVITY].sentence
    assert found[Step.VERIFY].state is StepState.LOCKED


def test_what_was_computed_anew_makes_an_export_stale(session):
    for kind, content in (("calibration", GOOD), ("probe", {}), ("verification", PASSED)):
        add(session, kind, content)
    session.set_parameter("export.results", dict(results_of(session.state)))
    add(session, "calibration", {**GOOD, "another": 1})
    found = look(session)
    assert found[Step.EXPORT].state is StepState.STALE
    assert "export again" in found[Step.EXPORT].sentence


def test_stale_says_why_and_what_to_do(session):
    add(session, "calibration", GOOD)
    session.mark("calibration", "calibration.json", "stale", "the tool was changed")
    found = look(session)[Step.GRAVITY]
    assert found.state is StepState.STALE
    assert "the tool was changed" in found.sentence
    assert found.sentence.endswith("Calibrate again.")


def test_what_was_undone_is_to_be_done_again(session):
    session.set_parameter("devices.sensor", "virtual://bench")
    add(session, "calibration", GOOD)
    session.mark("calibration", "calibration.json", "rejected", "undone")
    assert look(session)[Step.GRAVITY].state is StepState.READY


def test_a_verification_that_did_not_pass_failed(session):
    for kind, content in (("calibration", GOOD), ("probe", {})):
        add(session, kind, content)
    add(session, "verification", {"verdict": {"passed": False, "reasons": ["The mean error is 3 mm."]}})
    found = look(session)[Step.VERIFY]
    assert found.state is StepState.FAILED
    assert "The mean error is 3 mm." in found.sentence


def test_running_and_failed_are_shown(session):
    session.set_parameter("devices.sensor", "virtual://bench")
    found = look(session, running=[Step.GRAVITY], failed={Step.PROBE: "The mesh is empty: choose another."})
    assert found[Step.GRAVITY].state is StepState.RUNNING
    assert found[Step.PROBE].state is StepState.FAILED
    assert found[Step.PROBE].sentence == "The mesh is empty: choose another."


def test_every_step_has_a_sentence(session):
    for status in look(session, running=list(Step)).values():
        assert status.sentence.endswith(".")


def test_files_that_cannot_be_read_are_left_out(session):
    add(session, "calibration", GOOD)
    found = session.state.current_results["calibration", "calibration.json"]
    (session.folder / found.file.path).write_bytes(b"{")
    assert read_facts(session.folder, session.state) == {"calibration": {}}
    assert look(session)[Step.GRAVITY].state is StepState.DONE


# ----  --------------------------------------------------------------------------------------------


def values(session):
    return {key: setting.value for key, setting in session.state.settings.items()}


def test_a_setting_goes_back_and_forth(session):
    session.set_parameter("devices.sensor", "virtual://bench")
    _, change = observed(lambda s: s.set_parameter("devices.sensor", "still"))(session)
    change.undo(session)
    assert values(session)["devices.sensor"] == "virtual://bench"
    change.redo(session)
    assert values(session)["devices.sensor"] == "still"


@pytest.mark.parametrize(
    ("key", "value", "meant"),
    [("calibration.inverse", True, False), ("verification.windows", [[7.0, 9.0]], [[8.0, 10.0]])],
)
def test_a_setting_that_was_not_there_becomes_what_is_meant_without_it(session, key, value, meant):
    assert value_in(session.state, key) == meant
    assert value_in(session.state, "devices.sensor") is None
    _, change = observed(lambda s: s.set_parameter(key, value))(session)
    change.undo(session)
    assert values(session)[key] == meant


def test_setting_the_same_value_is_nothing_to_undo(session):
    session.set_parameter("devices.sensor", "a")
    _, change = observed(lambda s: s.set_parameter("devices.sensor", "a"))(session)
    assert change == SessionChange({}, {}, {})


def test_a_result_goes_back_to_the_one_before(session):
    def add(content):
        return lambda s: s.add_result("captures", "poses.csv", {"poses.csv": content}, {}, {"a": 1})

    add(b"first")(session)
    first = session.state.current_results["captures", "poses.csv"]
    _, change = observed(add(b"second"))(session)
    second = session.state.current_results["captures", "poses.csv"]
    change.undo(session)
    back = session.state.current_results["captures", "poses.csv"]
    assert back.content == first.content
    assert back.number > second.number
    change.redo(session)
    assert session.state.current_results["captures", "poses.csv"].content == second.content


def test_the_first_result_is_marked_as_undone_and_comes_back(session):
    _, change = observed(lambda s: s.add_result("captures", "poses.csv", {"poses.csv": b"x"}, {}, {}))(
        session
    )
    change.undo(session)
    mark = session.state.current_results["captures", "poses.csv"].mark
    assert (mark.mark, mark.reason) == ("rejected", "undone")
    change.redo(session)
    assert session.state.current_results["captures", "poses.csv"].mark is None


def test_a_mark_is_undone_and_done_again(session):
    session.add_result("captures", "poses.csv", {"poses.csv": b"x"}, {}, {})
    _, change = observed(lambda s: s.mark("captures", "poses.csv", "accepted", "well done"))(session)
    change.undo(session)
    assert session.state.current_results["captures", "poses.csv"].mark is None
    change.redo(session)
    assert session.state.current_results["captures", "poses.csv"].mark.reason == "well done"


def test_an_input_goes_back_with_what_is_beside_it(session):
    beside, about = {"beside.json": b"{}"}, {"rows": 3}
    session.add_input(b"one", "markers", name="markers.csv", companions=beside, about=about)
    _, change = observed(lambda s: s.add_input(b"two", "markers", name="markers.csv"))(session)
    change.undo(session)
    back = session.state.current_inputs["markers", "markers.csv"]
    assert (session.folder / back.file.path).read_bytes() == b"one"
    assert set(back.companions) == {"beside.json"}
    assert back.about == {"rows": 3}
    change.redo(session)
    assert session.state.current_inputs["markers", "markers.csv"].file.size == 3
    assert not session.state.current_inputs["markers", "markers.csv"].companions


def test_the_first_input_stays_and_the_journal_says_why(session):
    _, change = observed(lambda s: s.add_input(b"x", "markers", name="markers.csv"))(session)
    change.undo(session)
    assert ("markers", "markers.csv") in session.state.current_inputs
    assert "Undone" in session.state.notes[-1].text


def test_a_mesh_goes_back(session):
    session.add_input(b"a", "mesh", name="a.stl")
    before = session.state
    session.add_input(b"b", "mesh", name="b.stl")
    change_between(before, session.state).undo(session)
    assert session.state.mesh.name == "a.stl"
