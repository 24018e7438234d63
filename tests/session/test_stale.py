"""Which results are stale, and what is said of why."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from contactbench.pipeline.commands.session import session_app
from contactbench.pipeline.session import Session, fold


@pytest.fixture
def session(tmp_path):
    with Session.create(tmp_path / "s", by="a") as session:
        yield session


def add(session, name, content, kind="poses", sensor="42"):
    return session.add_input(content, kind, name=name, sensor=sensor).action.file.sha256


def result(session, kind, content, parameters=None, **inputs):
    record = session.add_result(kind, f"{kind}.out", {f"{kind}.out": content}, inputs, parameters or {})
    return record.action.files[f"{kind}.out"].sha256


@pytest.fixture
def bench(session):
    """Poses -> calibration, mesh -> probe, both -> report."""
    poses = add(session, "poses.csv", b"1")
    mesh = add(session, "m.stl", b"solid", kind="mesh")
    calibration = result(session, "calibration", b"c", {"noise_force": 0.1}, poses=poses)
    probe = result(session, "probe", b"p", mesh=mesh)
    result(session, "report", b"r", calibration=calibration, probe=probe)
    return session


def stale(session):
    return {kind: reasons for (kind, _), reasons in session.stale().items() if reasons}


def test_what_was_just_computed_holds(bench):
    assert stale(bench) == {}


def test_another_mesh(bench):
    add(bench, "other.stl", b"other", kind="mesh")
    found = stale(bench)
    assert set(found) == {"probe", "report"}
    assert re.search(
        r"The mesh it was computed from was replaced by other\.stl on \d{4}-\d\d-\d\d \d\d:\d\d UTC\.",
        found["probe"][0],
    )
    assert found["report"][0].startswith("It was computed from the probe probe.out, which is stale: The mesh")
    add(bench, "again.stl", b"solid", kind="mesh")
    assert stale(bench) == {}


def test_a_re_zeroed_sensor(bench):
    bench.rezeroed("other")
    assert stale(bench) == {}
    bench.rezeroed("42", "it was bumped")
    found = stale(bench)
    assert set(found) == {"calibration", "report"}
    assert "The sensor 42 was re-zeroed on" in found["calibration"][0]
    assert "(it was bumped), after the poses poses.csv was recorded." in found["calibration"][0]
    poses = add(bench, "poses.csv", b"2")
    calibration = result(bench, "calibration", b"c2", {"noise_force": 0.1}, poses=poses)
    assert set(stale(bench)) == {"report"}
    result(bench, "report", b"r2", calibration=calibration)
    assert stale(bench) == {}


def test_a_recording_of_an_unknown_sensor_may_be_of_this_one(session):
    result(session, "calibration", b"c", poses=add(session, "poses.csv", b"1", sensor=None))
    session.rezeroed("42")
    assert set(stale(session)) == {"calibration"}


def test_recalibration_with_another_outcome(bench):
    poses = bench.state.current_inputs["poses", "poses.csv"].file.sha256
    result(bench, "calibration", b"c", {"noise_force": 0.1}, poses=poses)
    assert stale(bench) == {}  # the same bytes
    result(bench, "calibration", b"new", {"noise_force": 0.2}, poses=poses)
    assert "calibration.out it was computed from was recomputed" in stale(bench)["report"][0]


def test_a_parameter(bench):
    bench.set_parameter("calibration.noise_force", 0.1)
    assert stale(bench) == {}
    bench.set_parameter("calibration.noise_force", 0.3)
    assert "The parameter calibration.noise_force was set to 0.3" in stale(bench)["calibration"][0]
    assert "computed with 0.1" in stale(bench)["calibration"][0]
    bench.set_parameter("calibration.noise_force", 0.1)
    assert stale(bench) == {}


def test_marks(bench):
    bench.mark("probe", "probe.out", "stale", "wrong housing")
    assert stale(bench)["probe"] == ("It was marked as stale: wrong housing.",)
    assert "report" in stale(bench)
    bench.mark("probe", "probe.out", "accepted")
    assert stale(bench) == {}


def test_a_recording_stays_as_old_as_it_is(bench):
    bench.rezeroed("42")
    for name, kind, sensor in (
        ("poses.csv", "poses", "42"),
        ("poses.csv", "poses", "43"),
        ("poses.csv", "poses", None),
        ("other.csv", "poses", "42"),
        ("copy.csv", "backup", "42"),
    ):
        add(bench, name, b"1", kind, sensor)
        assert set(stale(bench)) == {"calibration", "report"}, (name, kind, sensor)


def test_a_sensor_that_is_named_later_counts(session):
    result(session, "calibration", b"c", poses=add(session, "poses.csv", b"1", sensor=None))
    session.rezeroed("42")
    add(session, "poses.csv", b"1", sensor="43")
    assert stale(session) == {}


def test_a_recording_that_was_made_before_a_rezero_and_added_after_it(session):
    session.rezeroed("42")
    for name, started, holds in (
        ("a", "2026-01-01T00:00:00+00:00", False),
        ("b", "2199-01-01T00:00:00Z", True),
    ):
        about = {"started": started}
        record = session.add_input(name.encode(), "recording", name=name, sensor="42", about=about)
        result(session, name, b"c", recording=record.action.file.sha256)
        assert (name not in stale(session)) is holds


def test_the_same_content_under_another_name_hides_no_replacement(bench):
    add(bench, "copy.csv", b"1", "backup")
    add(bench, "poses.csv", b"2")
    assert "The poses poses.csv it was computed from was replaced" in stale(bench)["calibration"][0]


def test_a_replaced_backup_harms_nothing(session):
    poses = add(session, "poses.csv", b"1")
    add(session, "copy.csv", b"1", "backup")
    result(session, "calibration", b"c", poses=poses)
    add(session, "copy.csv", b"2", "backup")
    assert stale(session) == {}


@pytest.mark.parametrize("by_content", [True, False])
def test_all_files_of_a_result_count(session, by_content):
    session.add_result("probe", "p.ply", {"p.ply": b"1", "p.json": b"regions"}, {}, {})
    [made] = session.state.results
    session.add_result(
        "contact", "k", {"k": b"k"}, {"probe": made.content if by_content else made.file.sha256}, {}
    )
    session.add_result("probe", "p.ply", {"p.ply": b"1", "p.json": b"others"}, {}, {})
    assert "probe p.ply it was computed from was recomputed" in stale(session)["contact"][0]
    session.add_result("probe", "p.ply", {"p.ply": b"1", "p.json": b"regions"}, {}, {})
    assert stale(session) == {}


def test_another_result_of_the_same_bytes_hides_no_change(session):
    first = result(session, "calibration", b"1")
    session.add_result("contact", "k", {"k": b"k"}, {"calibration": first}, {})
    session.add_result("calibration", "d.json", {"d.json": b"1"}, {}, {})
    result(session, "calibration", b"2")
    assert set(stale(session)) == {"contact"}


def test_what_rests_on_a_rejected_result_does_not_hold(bench):
    bench.mark("probe", "probe.out", "rejected", "wrong tip")
    assert stale(bench)["probe"] == ("It was rejected: wrong tip.",)
    assert "which is stale: It was rejected: wrong tip." in stale(bench)["report"][0]
    shown = CliRunner().invoke(session_app, ["info", str(bench.folder)])
    assert "probe probe.out: REJECTED" in shown.output
    bench.mark("probe", "probe.out", "accepted")
    assert stale(bench) == {}


def test_a_setting_that_is_the_default_changes_nothing(session):
    session.add_result("calibration", "c.json", {"c.json": b"1"}, {}, {})
    session.set_parameter("calibration.contact_force", 10)
    session.set_parameter("calibration.tip", [0, 0, 100.0])
    assert stale(session) == {}
    session.set_parameter("calibration.contact_force", 8)
    assert set(stale(session)) == {"calibration"}


def test_results_that_follow_from_one_another_in_a_circle_end(session):
    first = result(session, "a", b"a")
    second = result(session, "b", b"b", a=first)
    session.add_result("a", "a.out", {"a.out": b"a"}, {"b": second}, {"again": 1})
    assert stale(session) == {}
    session.mark("a", "a.out", "stale", "so it is")
    assert set(stale(session)) == {"a", "b"}


def test_a_long_chain_of_results_is_followed(session):
    last = add(session, "poses.csv", b"1")
    for n in range(300):
        record = session.add_result("test", f"r{n}", {f"r{n}": str(n).encode()}, {"before": last}, {})
        last = record.action.files[f"r{n}"].sha256
    session.rezeroed("42")
    assert len(stale(session)) == 1
    assert all(session.stale().values())


@settings(max_examples=15, deadline=None, derandomize=True)
@given(st.lists(st.sampled_from(["note", "zero", "mesh", "result", "set"]), max_size=12))
def test_the_state_is_a_fold(tmp_path_factory, steps):
    folder = tmp_path_factory.mktemp("fold") / "s"
    with Session.create(folder, by="a") as session:
        for n, step in enumerate(steps):
            match step:
                case "note":
                    session.note(str(n))
                case "zero":
                    session.rezeroed("42")
                case "mesh":
                    session.add_input(str(n % 2).encode(), "mesh", name="m.stl")
                case "set":
                    session.set_parameter("test.a", n)
                case "result":
                    result(session, "test", b"", {"a": n})
        state, records = session.state, session.records
    assert fold(records) == state
    with Session.open(folder, write=False) as again:
        assert again.state == state
        assert again.stale() == {slot: tuple(r) for slot, r in session.stale().items()}
