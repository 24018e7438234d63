"""From a recording of a sensor and a robot to poses, as from a table."""

import io
import json
from pathlib import Path

import numpy as np
import pytest
from calibration.streams import Recording, stream
from scipy.spatial.transform import Rotation
from terminal import invoke, said

from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.files.capture_file import (
    Captured,
    Delay,
    capture_poses,
    is_recording,
    read_any_poses,
)
from contactbench.pipeline.calibration.orientation import Convention, Kind
from contactbench.pipeline.contact.wrench_csv import WrenchFileError
from contactbench.pipeline.demo.tape import write_csv as write_table
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.recording import RecordingError, RecordingInfo, RecordingWriter
from contactbench.pipeline.recording.convert import write_csv

MOUNT = Rotation.from_euler("xyz", (10, -20, 70), degrees=True).as_matrix()  # R_ES
LATE = 0.0413
NOWHERE = np.full(3, np.nan)


@pytest.fixture(scope="module")
def taken() -> Recording:
    made = stream(5, poses=6, bumps=0.2, vertical=0.0)
    knock = made.dwells[2].start + 1.6  # while it is averaged: the pose is taken once more
    made.wrenches[(made.t > knock) & (made.t < knock + 0.3), 0] += 8
    return made


def write(file: Path, taken: Recording, *, late: float = 0.0, gap: tuple[float, float] = (0, 0)) -> Path:
    """Write it with a flange at about 50 Hz, heard `late` seconds before the wrench of the same moment."""
    step = round(taken.rate / 50)
    about = RecordingInfo(1_700_000_000_000_000_000, float(taken.t[0]))
    with RecordingWriter(file, about, chunk_seconds=1e9, sync_seconds=1e9) as writer:
        for row, (t, w) in enumerate(zip(taken.t.tolist(), taken.wrenches.tolist(), strict=True)):
            # One reading in a thousand is none, and says so.
            status = Status.INVALID if row % 1000 == 500 else Status.OK
            writer.wrench(WrenchSample(t, (w[0], w[1], w[2]), (w[3], w[4], w[5]), row, status))
            if row % step == 0 and not gap[0] < t < gap[1]:
                writer.flange(FlangeSample(t - late, taken.R_WS[row] @ MOUNT.T, NOWHERE))
    return file


def tables(folder: Path, taken: Recording, *, late: float = 0.0, clock: float = 0.0) -> tuple[Path, Path]:
    """Write the same as `write` into two tables, the robot's with angles about fixed axes in degrees."""
    wrenches = taken.wrenches.copy()
    wrenches[500::1000] = np.nan
    step = round(taken.rate / 50)
    angles = Rotation.from_matrix(taken.R_WS[::step] @ MOUNT.T).as_euler("xyz", degrees=True)
    sensor, robot = folder / "wrenches.csv", folder / "robot.csv"
    rows = np.column_stack([taken.t, wrenches]).tolist()
    cells = [["" if value != value else value for value in row] for row in rows]
    write_table(sensor, ("t", "fx", "fy", "fz", "mx", "my", "mz"), cells)
    write_table(
        robot, ("t", "rx", "ry", "rz"), np.column_stack([taken.t[::step] - late + clock, angles]).tolist()
    )
    return sensor, robot


EULER = Convention(Kind.EULER, "xyz")


@pytest.fixture(scope="module")
def file(taken: Recording, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("recording") / "a.mcap", taken)


def assert_same(found: Captured, expected: Captured, atol: float) -> None:
    assert found.rows == expected.rows
    assert len(found.poses) >= 5
    for one, other in zip(found.poses, expected.poses, strict=True):
        assert one.name == other.name
        np.testing.assert_array_equal([one.force, one.torque], [other.force, other.torque])
        np.testing.assert_allclose(one.R_WS, other.R_WS, rtol=0, atol=atol)
    assert "flagged as bad" in found.warnings[0]


def test_it_gives_bit_for_bit_what_the_converted_table_gives(file: Path, tmp_path: Path) -> None:
    write_csv(tmp_path / "a.csv", file)
    table = capture_poses(tmp_path / "a.csv", R_ES=MOUNT)
    assert_same(capture_poses(file, R_ES=MOUNT), table, 1e-15)


def test_the_poses_lead_to_the_load(file: Path, taken: Recording) -> None:
    off = calibrate(capture_poses(file, R_ES=MOUNT).poses).model.vector - taken.model.vector
    assert np.abs(off[:3]).max() < 0.05
    assert np.abs(off[6:9]).max() < 0.001


def test_a_delay_is_estimated_and_said(taken: Recording, tmp_path: Path) -> None:
    late = write(tmp_path / "late.mcap", taken, late=LATE)
    result = invoke(
        "calibrate",
        "captures",
        late,
        "--delay",
        "auto",
        "--mount",
        "10,-20,70",
        "--out",
        tmp_path / "p.csv",
        "--json",
    )
    assert result.exit_code == 0, result.stderr
    facts = json.loads(result.stdout)
    assert facts["delay_s"] == pytest.approx(LATE, abs=0.005)
    assert "ms later than the robot" in said(result)
    given = capture_poses(late, R_ES=MOUNT, delay=LATE)
    assert given.delay == LATE
    assert len(given.poses) == len(facts["poses"])


def test_no_pose_is_carried_over_a_gap(taken: Recording, tmp_path: Path) -> None:
    dwell = taken.dwells[2]
    gap = (dwell.start - 0.2, dwell.stop + 0.2)
    found = capture_poses(write(tmp_path / "gap.mcap", taken, gap=gap), R_ES=MOUNT)
    for capture in found.captures:
        assert capture.stop < gap[0] + 0.3 or capture.start > gap[1] - 0.3
    assert "no pose within 0.25 s" in " ".join(found.warnings)


def test_calibrate_takes_a_recording(file: Path, tmp_path: Path) -> None:
    out = tmp_path / "c.json"
    result = invoke("calibrate", "fit", file, "--mount", "10,-20,70", "--out", out, "--json")
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["poses"] >= 5
    assert "flagged as bad" in said(result)
    poses = tmp_path / "p.csv"
    assert invoke("calibrate", "captures", file, "--mount", "10,-20,70", "--out", poses).exit_code == 0
    assert invoke("calibrate", "fit", poses, "--out", tmp_path / "d.json").exit_code == 0
    one, other = (json.loads((tmp_path / name).read_bytes()) for name in ("c.json", "d.json"))
    assert one["mass_kg"] == pytest.approx(other["mass_kg"], rel=1e-9)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--euler", "xyz"), "leave out the convention"),
        (("--delay", "soon"), "seconds, or auto"),
        (("--delay", "99"), "at most 10"),
        (("--delay", "nan"), "finite number"),
    ],
)
def test_what_does_not_fit_is_said(file: Path, tmp_path: Path, options: tuple[str, ...], words: str) -> None:
    result = invoke("calibrate", "captures", file, *options, "--out", tmp_path / "p.csv")
    assert result.exit_code == 2
    assert words in said(result) + " " + str(result.exception)
    assert not (tmp_path / "p.csv").exists()


def test_a_delay_needs_a_recording() -> None:
    with pytest.raises(InputError, match="so a delay has no meaning: use a recording"):
        capture_poses(io.BytesIO(b"t\n"), delay=0.1)
    assert not is_recording(Path("none"))


# ---- two tables ----------------------------------------------------------------------------------


def test_two_tables_give_what_the_recording_gives(file: Path, taken: Recording, tmp_path: Path) -> None:
    sensor, robot = tables(tmp_path, taken)
    found = capture_poses(sensor, EULER, robot_poses=robot, R_ES=MOUNT)
    assert_same(found, capture_poses(file, R_ES=MOUNT), 1e-12)


@pytest.mark.parametrize("command", ["fit", "captures"])
def test_the_commands_join_two_tables(taken: Recording, tmp_path: Path, command: str) -> None:
    sensor, robot = tables(tmp_path, taken, late=LATE)
    options = ("--robot-poses", robot, "--euler", "xyz", "--mount", "10,-20,70", "--delay", "auto")
    result = invoke("calibrate", command, sensor, *options, "--out", tmp_path / "out", "--json")
    assert result.exit_code == 0, result.stderr
    facts = json.loads(result.stdout)
    assert "ms later than the robot" in said(result)
    assert "left out, " in said(result)
    if command == "fit":
        assert facts["mass_kg"] == pytest.approx(taken.model.mass, abs=0.01)
        assert f"{facts['poses']} still poses found" in facts["notes"][0]
    else:
        assert facts["delay_s"] == pytest.approx(LATE, abs=0.005)


def test_the_other_commands_join_two_tables(taken: Recording, tmp_path: Path) -> None:
    sensor, robot = tables(tmp_path, taken)
    options = ("--robot-poses", robot, "--euler", "xyz", "--mount", "10,-20,70")
    assert invoke("calibrate", "fit", sensor, *options, "--out", tmp_path / "c.json").exit_code == 0
    checked = invoke("calibrate", "check", "still", tmp_path / "c.json", sensor, *options, "--json")
    assert checked.exit_code == 0, checked.stderr
    assert "still poses found" in json.loads(checked.stdout)["notes"][0]
    assert "left out, " in said(checked)
    diagnosed = invoke("calibrate", "diagnose", sensor, *options, "--json")
    assert "still poses found" in json.loads(diagnosed.stdout)["notes"][0]
    assert "left out, " in said(diagnosed)


def test_a_doubtful_delay_is_told_and_not_applied(taken: Recording, tmp_path: Path) -> None:
    sensor, robot = tables(tmp_path, taken, late=-LATE)
    found = capture_poses(sensor, EULER, robot_poses=robot, R_ES=MOUNT, delay="auto")
    assert found.delay == 0.0
    assert "The delay is not applied" in " ".join(found.warnings)
    assert "--delay -0.04" in " ".join(found.warnings)
    forced = capture_poses(sensor, EULER, robot_poses=robot, R_ES=MOUNT, delay=-LATE)
    assert forced.delay == -LATE


def test_a_delay_brings_the_poses_to_their_wrenches(file: Path, taken: Recording, tmp_path: Path) -> None:
    sensor, robot = tables(tmp_path, taken, late=3.0)
    found = capture_poses(sensor, EULER, robot_poses=robot, R_ES=MOUNT, delay=3.0)
    expected = capture_poses(file, R_ES=MOUNT)
    assert len(found.poses) == len(expected.poses)
    for one, other in zip(found.poses, expected.poses, strict=True):
        np.testing.assert_allclose(one.R_WS, other.R_WS, rtol=0, atol=1e-6)
        np.testing.assert_allclose(one.force, other.force, rtol=0, atol=1e-9)


def test_tables_that_do_not_go_together(file: Path, taken: Recording, tmp_path: Path) -> None:
    sensor, robot = tables(tmp_path, taken, clock=1.7e9)
    with pytest.raises(
        RecordingError, match=r"wrenches\.csv: column t runs from .*, that of .*robot\.csv from 17"
    ):
        capture_poses(sensor, EULER, robot_poses=robot)
    with pytest.raises(InputError, match="leave out the convention and the robot's table"):
        capture_poses(file, robot_poses=robot)
    with pytest.raises(WrenchFileError, match=r"line 1: there is no orientation .*--robot-poses FILE"):
        capture_poses(sensor)
    with pytest.raises(WrenchFileError, match="pass --euler ORDER"):
        capture_poses(sensor, robot_poses=robot)


def test_wrong_rows_of_the_robot_are_named(taken: Recording, tmp_path: Path) -> None:
    sensor, robot = tables(tmp_path, taken)
    rows = robot.read_text(encoding="utf-8").splitlines()
    robot.write_text("\n".join([*rows[:5], rows[6], rows[5], *rows[7:]]) + "\n", encoding="utf-8")
    with pytest.raises(WrenchFileError, match=r"robot\.csv: line 7: column t runs backwards"):
        capture_poses(sensor, EULER, robot_poses=robot)
    (tmp_path / "q.csv").write_text("t,qw,qx,qy,qz\n0,1,0,0,0\n1,1,1,0,0\n", encoding="utf-8")
    with pytest.raises(WrenchFileError, match=r"q\.csv: line 3: the quaternion has length"):
        capture_poses(sensor, robot_poses=tmp_path / "q.csv")


def flat(file: Path, *, robot: bool, shift: float = 0.0) -> Path:
    with RecordingWriter(file, RecordingInfo(1_700_000_000_000_000_000, 0.0)) as writer:
        for row in range(400):
            writer.wrench(WrenchSample(row / 100, (0.0, 0.0, float(row % 2)), (0.0, 0.0, 0.0)))
            if robot:
                writer.flange(FlangeSample(row / 100 + shift, np.eye(3), NOWHERE))
    return file


@pytest.mark.parametrize(
    ("robot", "shift", "delay", "words"),
    [
        (False, 0.0, None, "1 sensors and 0 robots"),
        (True, 100.0, None, "no reading has a pose close enough"),
        (True, 0.0, "auto", "hardly turned"),
    ],
)
def test_recordings_that_show_nothing(
    tmp_path: Path, robot: bool, shift: float, delay: Delay, words: str
) -> None:
    with pytest.raises(RecordingError, match=words):
        capture_poses(flat(tmp_path / "a.mcap", robot=robot, shift=shift), delay=delay)


def test_a_damaged_recording_is_named(file: Path, tmp_path: Path) -> None:
    (tmp_path / "b.mcap").write_bytes(file.read_bytes()[:30])
    with pytest.raises(RecordingError, match=r"b\.mcap"):
        capture_poses(tmp_path / "b.mcap")
    with pytest.raises(InputError, match="leave out the convention"):
        read_any_poses(file, Convention())
