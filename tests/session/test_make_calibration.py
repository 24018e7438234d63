import pytest
from workbench.gravity_bench import batches, record

from pipeline.calibration.files.pose_csv import read_poses
from pipeline.session import Session
from pipeline.session.errors import SessionError
from pipeline.session.recompute import compute


@pytest.fixture
def session(tmp_path):
    with Session.create(tmp_path / "s") as made:
        record(made, "gravity-1.mcap", batches())
        record(made, "gravity-2.mcap", batches(2))
        yield made


def _poses(session, inputs=None, name="poses.csv", **parameters):
    recording = session.state.current_inputs["recording", "gravity-1.mcap"].content
    compute(session, "captures", name, {"recording": recording, **(inputs or {})}, parameters)
    result = session.state.current_results["captures", name]
    return result, read_poses(session.folder / result.file.path).poses


def test_a_capture_in_which_a_moment_lies_is_left_out(session):
    _, whole = _poses(session)
    _, without = _poses(session, leave_out=[whole[2].time, -1e12])
    assert [pose.time for pose in without] == [pose.time for n, pose in enumerate(whole) if n != 2]
    assert [pose.name.partition(" at ")[0] for pose in without] == [f"pose {n}" for n in range(1, 6)]
    assert (without[2].force == whole[3].force).all()


def test_moments_that_are_none_and_too_few_poses_are_refused(session):
    _, whole = _poses(session)
    with pytest.raises(SessionError, match="leave_out"):
        _poses(session, leave_out=["soon"])
    with pytest.raises(SessionError, match="2 still poses, 4 left out"):
        _poses(session, leave_out=[pose.time for pose in whole[:4]])


def test_part_of_a_set_may_be_small_and_comes_first_in_the_whole(session):
    _, whole = _poses(session)
    second = session.state.current_inputs["recording", "gravity-2.mcap"].content
    with pytest.raises(SessionError, match="2 still poses, a calibration needs 3"):
        compute(session, "captures", "part.csv", {"recording": second}, {})
    compute(session, "captures", "part.csv", {"recording": second}, {"partial": True})
    part = session.state.current_results["captures", "part.csv"]
    result, both = _poses(session, {"earlier": part.content})
    assert len(both) == 8
    assert [pose.time is None for pose in both] == [True] * 2 + [False] * 6
    assert both[2].name.startswith("pose 3 at ")
    assert (both[2].force == whole[0].force).all()
    assert result.action.inputs["earlier"] == part.content
    compute(
        session,
        "captures",
        "part.csv",
        {"recording": second},
        {"partial": True, "leave_out": [4.0]},
    )
    assert any("part.csv" in reason for reason in session.stale()["captures", "poses.csv"])
