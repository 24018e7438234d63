import pytest
from workbench.changes import observed

from contactbench.pipeline.session import Session
from contactbench.pipeline.workbench.undo_history import SessionChange, change_between, value_in


@pytest.fixture
def session(tmp_path):
    with Session.create(tmp_path / "session") as found:
        yield found


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
