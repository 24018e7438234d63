import json

import numpy as np
import pytest
from calibration.streams import stream
from scipy.spatial.transform import Rotation
from terminal import invoke
from weighing_files import weighed, write_euler
from workbench.gravity_bench import batches, record

from contactbench.pipeline.calibration.files.pose_csv import read_poses
from contactbench.pipeline.demo.tape import write_csv
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.session import Session
from contactbench.pipeline.session.journal import SessionError
from contactbench.pipeline.session.recompute import calibration, captures, compute


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


def _tables(folder):
    made = stream(5, poses=6, vertical=0.0)
    angles = Rotation.from_matrix(made.R_WS[::4]).as_euler("xyz", degrees=True)
    sensor, robot = folder / "wrenches.csv", folder / "robot.csv"
    write_csv(
        sensor, ("t", "fx", "fy", "fz", "mx", "my", "mz"), np.column_stack([made.t, made.wrenches]).tolist()
    )
    write_csv(robot, ("t", "rx", "ry", "rz"), np.column_stack([made.t[::4] - 0.03, angles]).tolist())
    return sensor, robot


def test_two_tables_are_joined_as_by_the_command(tmp_path):
    sensor, robot = _tables(tmp_path)
    given = {"name": "poses.csv", "euler": "xyz", "delay": 0.03}
    told: list[str] = []
    made = captures({"recording": sensor, "robot_poses": robot}, given, None, tell=told.append)
    assert len(told) == 1
    assert "no pose within 0.25 s." in told[0]
    options = ["--robot-poses", str(robot), "--euler", "xyz", "--delay", "0.03", "--out"]
    written = tmp_path / "command.csv"
    assert invoke("calibrate", "captures", sensor, *options, written).exit_code == 0
    assert made == {"poses.csv": written.read_bytes()}


def test_a_recording_is_no_table_of_poses(tmp_path):
    sensor, _ = _tables(tmp_path)
    with pytest.raises(SessionError, match=r"wrenches\.csv is a recording, .* --kind recording"):
        calibration({"poses": sensor}, {"name": "c.json"}, None)


def test_orientation_noise_and_down_are_those_of_the_command(tmp_path):
    file = write_euler(tmp_path / "poses.csv", weighed())
    created = "2026-01-02T03:04:05Z"
    given = {"name": "c.json", "euler": "xyz", "orientation_noise": 0.2, "down": [0.0, 0.0, -2.0]}
    made = json.loads(calibration({"poses": file}, given, created)["c.json"])
    options = ["--orientation-noise", "tracker", "--down", "0,0,-1", "--euler", "xyz", "--out"]
    out = tmp_path / "c.json"
    assert invoke("calibrate", "fit", file, *options, out).exit_code == 0
    assert {**made, "created": ""} == {**json.loads(out.read_bytes()), "created": ""}
    with pytest.raises(InputError, match="down_W"):
        calibration({"poses": file}, {**given, "down": [0, 0, 0]}, created)
    with pytest.raises(InputError, match="orientation"):
        calibration({"poses": file}, {**given, "orientation_noise": -1}, created)


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
    compute(session, "captures", "part.csv", {"recording": second}, {"partial": True, "leave_out": [4.0]})
    assert any("part.csv" in reason for reason in session.stale()["captures", "poses.csv"])
