"""Which results are stale, and what is said of why."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.session import Session, fold


@pytest.fixture
def session(tmp_path):
    with Session.create(tmp_path / "s", by="a") as session:
        yield session


def add(session, tmp_path, name, content, kind="poses", sensor="42"):
    (tmp_path / name).write_bytes(content)
    return session.add_input(tmp_path / name, kind, sensor=sensor).action.file.sha256


def result(session, kind, content, parameters=None, **inputs):
    record = session.add_result(kind, f"{kind}.out", {f"{kind}.out": content}, inputs, parameters or {})
    return record.action.files[f"{kind}.out"].sha256


@pytest.fixture
def bench(session, tmp_path):
    """Poses -> calibration, mesh -> probe, both -> report."""
    poses = add(session, tmp_path, "poses.csv", b"1")
    mesh = add(session, tmp_path, "m.stl", b"solid", kind="mesh")
    calibration = result(session, "calibration", b"c", {"noise_force": 0.1}, poses=poses)
    probe = result(session, "probe", b"p", mesh=mesh)
    result(session, "report", b"r", calibration=calibration, probe=probe)
    return session


def stale(session):
    return {kind: reasons for (kind, _), reasons in session.stale().items() if reasons}


def test_what_was_just_computed_holds(bench):
    assert stale(bench) == {}


def test_another_mesh(bench, tmp_path):
    add(bench, tmp_path, "other.stl", b"other", kind="mesh")
    found = stale(bench)
    assert set(found) == {"probe", "report"}
    assert "The mesh that it was computed from was replaced by other.stl on 20" in found["probe"][0]
    assert found["report"][0].startswith("It was computed from the probe probe.out, which is stale: The mesh")
    add(bench, tmp_path, "again.stl", b"solid", kind="mesh")
    assert stale(bench) == {}


def test_a_re_zeroed_sensor(bench, tmp_path):
    bench.rezeroed("other")
    assert stale(bench) == {}
    bench.rezeroed("42", "it was bumped")
    found = stale(bench)
    assert set(found) == {"calibration", "report"}
    assert "The sensor 42 was re-zeroed on" in found["calibration"][0]
    assert "(it was bumped), after the poses poses.csv was recorded." in found["calibration"][0]
    poses = add(bench, tmp_path, "poses.csv", b"2")
    calibration = result(bench, "calibration", b"c2", {"noise_force": 0.1}, poses=poses)
    assert set(stale(bench)) == {"report"}
    result(bench, "report", b"r2", calibration=calibration)
    assert stale(bench) == {}


def test_a_recording_of_an_unknown_sensor_may_be_of_this_one(session, tmp_path):
    poses = add(session, tmp_path, "poses.csv", b"1", sensor=None)
    result(session, "calibration", b"c", poses=poses)
    session.rezeroed("42")
    assert set(stale(session)) == {"calibration"}


def test_recalibration_with_another_outcome(bench):
    poses = bench.state.current_inputs["poses", "poses.csv"].file.sha256
    result(bench, "calibration", b"c", {"noise_force": 0.1}, poses=poses)
    assert stale(bench) == {}  # the same bytes
    result(bench, "calibration", b"new", {"noise_force": 0.2}, poses=poses)
    assert "calibration.out that it was computed from was computed anew" in stale(bench)["report"][0]


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


def test_a_long_chain_of_results_is_followed(session, tmp_path):
    last = add(session, tmp_path, "poses.csv", b"1")
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
                    session.change_mesh("m.stl", (str(n % 2).encode(),))
                case "set":
                    session.set_parameter("test.a", n)
                case "result":
                    result(session, "test", b"", {"a": n})
        state, records = session.state, session.records
    assert fold(records) == state
    with Session.open(folder, write=False) as again:
        assert again.state == state
        assert again.stale() == {slot: tuple(r) for slot, r in session.stale().items()}
