"""From a recording as it comes, with hum, rounding, spikes, gaps and knocks, to a calibration."""

import io
import json
import time
from pathlib import Path

import numpy as np
import pytest
from calibration.streams import WHITE, Recording, find_captures, stream
from scipy.spatial.transform import Rotation
from terminal import invoke, said

from contactbench.pipeline.calibration import Level, calibrate
from contactbench.pipeline.calibration.files.capture_file import (
    Captured,
    Capturing,
    capture_poses,
    in_order,
    read_any_poses,
)
from contactbench.pipeline.calibration.files.pose_csv import PoseFileError
from contactbench.pipeline.contact.wrench_csv import WrenchFileError
from contactbench.pipeline.demo.tape import write_csv
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.recording.clock_steps import ClockSteps
from contactbench.pipeline.tables import TableReader, Wording

COLUMNS = ("t", "fx", "fy", "fz", "mx", "my", "mz", "qw", "qx", "qy", "qz")


@pytest.fixture(scope="module")
def recording() -> Recording:
    made = stream(5, poses=8, hum=0.3, quantised=True, spikes=0.001, missing=0.05, bumps=0.2, vertical=0.0)
    knock = made.dwells[2].start + 1.6  # while it is averaged: the pose is taken once more
    made.wrenches[(made.t > knock) & (made.t < knock + 0.3), 0] += 8
    return made


@pytest.fixture(scope="module")
def file(recording: Recording, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("recording") / "recording.csv"
    write_csv(out, COLUMNS, whole(recording).tolist())
    return out


@pytest.fixture(scope="module")
def found(file: Path) -> Captured:
    return capture_poses(file)


def test_the_poses_lead_to_the_load(recording: Recording, found: Captured) -> None:
    assert len(found.poses) >= 7
    assert found.rows == len(recording.t)
    calibration = calibrate(found.poses)
    assert calibration.verdict.level == Level.GOOD
    off = calibration.model.vector - recording.model.vector
    off[3:6] -= recording.drift.mean(axis=0)[:3]  # what drifts is the bias
    off[9:] -= recording.drift.mean(axis=0)[3:]
    assert np.abs(off[:3]).max() < 0.03
    assert np.abs(off[6:9]).max() < 0.0005


def test_a_file_gives_what_the_arrays_give(recording: Recording, found: Captured) -> None:
    from_arrays = find_captures(recording.t, recording.wrenches, R_WS=recording.R_WS)
    assert len(found.captures) == len(from_arrays.captures)
    for one, other in zip(found.captures, from_arrays.captures, strict=True):
        assert (one.start_index, one.stop_index) == (other.start_index, other.stop_index)
        np.testing.assert_allclose(one.mean, other.mean, rtol=0, atol=1e-12)


def test_the_command_writes_poses_that_calibrate_reads(file: Path, found: Captured, tmp_path: Path) -> None:
    poses, out = tmp_path / "poses.csv", tmp_path / "c.json"
    result = invoke("calibrate", "captures", file, "--out", poses, "--json")
    assert result.exit_code == 0
    assert len(json.loads(result.stdout)["poses"]) == len(found.poses)
    assert invoke("calibrate", "fit", poses, "--out", out).exit_code == 0
    again = invoke("calibrate", "captures", file, "--out", tmp_path / "again.csv", "--calibration", out)
    assert again.exit_code == 0


def test_a_recording_that_never_stands_still(file: Path, tmp_path: Path) -> None:
    rows = file.read_text(encoding="utf-8").splitlines()
    short = tmp_path / "short.csv"
    short.write_text("\n".join(rows[:120]) + "\n", encoding="utf-8")
    result = invoke("calibrate", "captures", short, "--out", tmp_path / "p.csv")
    assert result.exit_code == 1
    assert not (tmp_path / "p.csv").exists()


def test_calibrate_captures_by_itself(recording: Recording, file: Path, tmp_path: Path) -> None:
    found = capture_poses(file)
    result = invoke("calibrate", "fit", file, "--out", tmp_path / "c.json", "--json")
    assert result.exit_code == 0, result.stderr
    facts = json.loads(result.stdout)
    assert facts["poses"] == len(found.poses)
    assert facts["mass_kg"] == pytest.approx(recording.model.mass, abs=0.01)
    note = f"is a recording: {len(found.poses)} still poses found in {found.rows:,} readings."
    assert facts["notes"][0].endswith(note)
    assert [sentence.startswith("left out, 15.4 to 16.1 s: ") for sentence in found.left_out] == [True]
    for sentence in found.left_out:
        assert sentence in " ".join(facts["warnings"])
        assert sentence in said(result)


@pytest.mark.parametrize(("dwell", "bumps"), [(2.0, 0.5), (1.2, 0.0)])
@pytest.mark.parametrize("seed", [1, 2])
def test_every_stop_is_captured_or_told(seed: int, dwell: float, bumps: float) -> None:
    made = stream(seed, dwell=dwell, bumps=bumps, vertical=0.0)
    work = Capturing()
    for begin in range(0, len(made.t), 999):
        rows = slice(begin, begin + 999)
        work.update(made.t[rows], made.wrenches[rows], made.R_WS[rows])
    found = work.finish()
    told = [(each.start, each.stop) for each in (*found.captures, *found.rejected)]
    for each in made.dwells:
        assert any(start < each.stop and stop > each.start for start, stop in told), each.start
    starts = [each.start for each in found.rejected]
    assert starts == sorted(starts)
    for each in found.rejected:
        assert made.t[each.start_index] == pytest.approx(each.start)
        assert made.t[each.stop_index - 1] == pytest.approx(each.stop)
    if dwell == 1.2:
        assert "s; 1.5 s after settling are needed" in " ".join(found.left_out)


def test_a_stop_at_which_nothing_comes_to_rest_is_told(recording: Recording) -> None:
    dwell = recording.dwells[1]
    shaken = recording.wrenches.copy()
    rows = (recording.t > dwell.start - 0.5) & (recording.t < dwell.stop + 0.5)
    shaken[rows, 1] += 5 * np.sin(40 * recording.t[rows])
    work = Capturing()
    work.update(recording.t, shaken, recording.R_WS)
    told = [sentence for sentence in work.finish().left_out if "did not settle: vibration" in sentence]
    assert [float(sentence.split()[2]) for sentence in told] == [pytest.approx(dwell.start, abs=0.3)]


def whole(recording: Recording) -> np.ndarray:
    quaternions = np.roll(Rotation.from_matrix(recording.R_WS).as_quat(), 1, axis=1)
    return np.column_stack([recording.t, recording.wrenches, quaternions])


def rows_of(recording: Recording, count: int) -> np.ndarray:
    """Rows in which the robot never stands: its motions only, one after the other."""
    moving = np.ones(len(recording.t), dtype=bool)
    for dwell in recording.dwells:
        moving &= (recording.t < dwell.start + 0.2) | (recording.t > dwell.stop)
    chosen = np.resize(np.flatnonzero(moving), count)
    quaternions = np.roll(Rotation.from_matrix(recording.R_WS[chosen]).as_quat(), 1, axis=1)
    return np.column_stack([np.arange(count) / recording.rate, recording.wrenches[chosen], quaternions])


@pytest.mark.parametrize("command", ["fit", "diagnose"])
@pytest.mark.parametrize("count", [800, 9000])
def test_moving_rows_are_no_poses(recording: Recording, tmp_path: Path, count: int, command: str) -> None:
    moving = tmp_path / "moving.csv"
    write_csv(moving, COLUMNS, rows_of(recording, count).tolist())
    options = ("--out", tmp_path / "c.json") if command == "fit" else ()
    begin = time.process_time()
    result = invoke("calibrate", command, moving, *options)
    assert time.process_time() - begin < 5
    assert result.exit_code == 2
    assert "contains no still pose" in str(result.exception) + result.output
    assert not (tmp_path / "c.json").exists()


@pytest.mark.parametrize("count", [800, 9000])
def test_rows_without_times_are_refused(recording: Recording, tmp_path: Path, count: int) -> None:
    rows = rows_of(recording, count)
    write_csv(tmp_path / "a.csv", COLUMNS[1:], rows[:, 1:].tolist())
    with pytest.raises(
        PoseFileError, match=r"more than 200 rows, .* as column t: contactbench calibrate fit"
    ):
        read_any_poses(tmp_path / "a.csv")
    rows[:, 0] *= recording.rate
    write_csv(tmp_path / "b.csv", COLUMNS, rows.tolist())
    with pytest.raises(PoseFileError, match=r"in steps of 1, which looks like ms, not s: name the col"):
        read_any_poses(tmp_path / "b.csv")


def test_a_table_of_poses_has_no_delay(recording: Recording, tmp_path: Path) -> None:
    rows = rows_of(recording, 20)
    rows[:, 0] *= 20 * recording.rate
    write_csv(tmp_path / "poses.csv", COLUMNS, rows.tolist())
    assert read_any_poses(tmp_path / "poses.csv").notes == ()
    with pytest.raises(InputError, match="a table of still poses has no delay"):
        read_any_poses(tmp_path / "poses.csv", delay="auto")


@pytest.mark.parametrize("block_bytes", [4, 2**20])
@pytest.mark.parametrize(
    ("times", "given", "told"),
    [
        (
            (0.1, 0.2, 0.2, 0.3, 0.4, 0.3, 0.5),
            [0.1, 0.2, 0.2, 0.3, 0.4, 1.4, 1.6],
            "set back by 0.2 s at 0.40 s",
        ),
        ((0.1, 0.2, 0.3, "", 0.4), [0.1, 0.2, 0.3, 0.4], "1 rows left out: column t is empty"),
        (
            (0.1, 0.2, "ERR", "", 0.4),
            [0.1, 0.2, 0.4],
            "2 rows left out: column t is empty or no number, first in line 4",
        ),
        ((0.1, 0.2, 0.3, 0.4, 0.39, 0.5), None, r"line 6: column t runs backwards, from 0.4 to 0.39 s"),
        ((0.1, *(0.2, 0.1) * 10, 0.3), None, r"line \d+: column t runs backwards, from 0.2 to 0.1 s"),
    ],
)
def test_a_clock_that_is_set_back_is_seen_between_blocks(
    block_bytes: int, times: tuple[float | str, ...], given: list[float] | None, told: str
) -> None:
    text = "t,x\n" + "".join(f"{time},1\n" for time in times)
    wording = Wording("t", error=WrenchFileError)
    reader = TableReader(io.BytesIO(text.encode()), "a.csv", wording, block_bytes=block_bytes)
    reader.select(("t",), leave_out=("t",))
    steps = ClockSteps()
    rows = in_order(reader, steps, "t")
    if given is None:
        with pytest.raises(WrenchFileError, match=told):
            list(rows)
        return
    assert np.concatenate([each.numbers[:, 0] for each in rows]).tolist() == pytest.approx(given)
    assert told in " ".join((*steps.told(), *reader.left_out()))


@pytest.mark.parametrize("apart", [False, True])
def test_readings_and_poses_are_not_paired_across_a_step(
    recording: Recording, tmp_path: Path, apart: bool
) -> None:
    """The clock is set back by 4 s in the middle of the third dwell: the truth is the recording itself."""
    rows = whole(recording)
    rows[rows[:, 0] > recording.dwells[2].start + 2.0, 0] -= 4.0
    write_csv(tmp_path / "a.csv", COLUMNS, rows.tolist())
    robot = None
    if apart:
        robot = tmp_path / "robot.csv"
        write_csv(robot, (COLUMNS[0], *COLUMNS[7:]), rows[::4, [0, 7, 8, 9, 10]].tolist())
    found = capture_poses(tmp_path / "a.csv", robot_poses=robot)
    assert "The clock was set back by 4 s" in found.warnings[0]
    for pose in found.poses:
        off = [np.linalg.norm(pose.force - dwell.wrench[:3]) for dwell in recording.dwells
               if np.abs(pose.R_WS - dwell.R_WS).max() < 1e-3]  # fmt: skip
        assert min(off, default=1.0) < 0.1
    assert len(found.poses) >= len(recording.dwells) - 2


@pytest.mark.parametrize(
    ("unit", "scale", "zero"),
    [
        ("ms", 1e3, 0.0),
        ("us", 1e6, 0.0),
        ("ns", 1e9, 1.76e18),
        ("100ns", 1e7, 1.34e17),
        ("d", 1 / 86_400, 740_682.1),
        ("d", 1 / 86_400, 46_354.1),
    ],
)
def test_times_in_another_unit_are_asked_back_and_then_read(
    recording: Recording, found: Captured, tmp_path: Path, unit: str, scale: float, zero: float
) -> None:
    rows = whole(recording).astype(object)
    rows[:, 0] = [f"{zero + scale * time:.11f}" for time in rows[:, 0]]
    write_csv(tmp_path / "a.csv", COLUMNS, rows.tolist())
    for read in (read_any_poses, capture_poses):
        with pytest.raises(InputError, match=rf"looks like {unit}, not s: name the column t_{unit}"):
            read(tmp_path / "a.csv")
    write_csv(tmp_path / "b.csv", (f"t_{unit}", *COLUMNS[1:]), rows.tolist())
    again = capture_poses(tmp_path / "b.csv")
    assert len(again.poses) == len(found.poses) > 3
    np.testing.assert_allclose(
        [pose.force for pose in again.poses], [pose.force for pose in found.poses], atol=0.02
    )


def test_times_in_minutes_are_told_by_their_span(recording: Recording, tmp_path: Path) -> None:
    rows = whole(recording)
    rows[:, 0] /= 60
    write_csv(tmp_path / "a.csv", COLUMNS, rows.tolist())
    found = capture_poses(tmp_path / "a.csv")
    assert not found.poses
    assert "too short for a still pose" in found.warnings[-1]
    assert "name the column t_min" in found.warnings[-1]


def test_a_table_merged_by_time_is_read_as_two(recording: Recording, tmp_path: Path) -> None:
    rows = whole(recording).astype(object)
    poses, readings = rows[::4].copy(), rows.copy()
    poses[:, 0] += 1e-4
    poses[:, 1:7], readings[:, 7:] = "", ""
    merged = sorted([*poses.tolist(), *readings.tolist()], key=lambda row: row[0])
    write_csv(tmp_path / "merged.csv", COLUMNS, merged)
    write_csv(tmp_path / "whole.csv", COLUMNS, rows.tolist())
    found, true = capture_poses(tmp_path / "merged.csv"), capture_poses(tmp_path / "whole.csv")
    assert len(found.poses) == len(true.poses) > 3
    assert any("rows left out: column qw is empty" in sentence for sentence in found.warnings)


def test_wrong_rows_are_named(file: Path) -> None:
    rows = file.read_text(encoding="utf-8").splitlines()
    rows[7] = rows[7].rsplit(",", 1)[0] + ",7.0"
    with pytest.raises(WrenchFileError, match=r"line 8: the quaternion has length"):
        capture_poses(io.BytesIO("\n".join(rows).encode() + b"\n"))
    rows[7] = rows[6]
    before = float(rows[7].split(",")[0])
    rows[8] = rows[8].replace(rows[8].split(",")[0], f"{before - 0.01}", 1)
    with pytest.raises(WrenchFileError, match=r"line 9: column t runs backwards, from "):
        capture_poses(io.BytesIO("\n".join(rows).encode() + b"\n"))


@pytest.mark.parametrize("rate", [5.0, 10.0])
def test_a_dwell_too_short_for_a_slow_stream_is_told_what_it_needs(rate):
    times = np.arange(0.0, 40.0, 1 / rate)
    R = Rotation.from_rotvec(0.4 * (times // 2.5)[:, None] * [1.0, 0.3, 0.0]).as_matrix()
    wrenches = np.tile([3.0, -4, -3, 0.1, 0.3, -0.2], (len(times), 1)) + WHITE * np.random.default_rng(
        1
    ).normal(size=(len(times), 6))
    wrenches[:, 0] += 9 * (times // 2.5 % 2)
    work = Capturing()
    work.update(times, wrenches, R)
    found = work.finish()
    assert not found.captures
    assert {each.reason.split("; ")[1] for each in found.rejected} == {
        f"{30 / rate:.1f} s after settling are needed"
    }
