import io
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from terminal import invoke

from contactbench.pipeline.calibration import GravityModel, PoseSample
from contactbench.pipeline.calibration.files.pose_csv import (
    POSE_LIMIT,
    PoseFileError,
    PoseTable,
    read_poses,
    write_poses,
)
from contactbench.pipeline.calibration.orientation import Convention, Kind, convention_of, rotations
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.settings import PosesSettings

WRENCH = "fx,fy,fz,mx,my,mz"
QUATERNION = f"qw,qx,qy,qz,{WRENCH}"
ANGLES = f"rx,ry,rz,{WRENCH}"
JOINTS = f"j1,j2,j3,j4,j5,j6,{WRENCH}"
READ = "1,2,-5,0.1,0.2,0.3"
GOOD = f"1,0,0,0,{READ}"
EULER = Convention(Kind.EULER, "xyz")
ELFIN = Convention(Kind.JOINTS, robot="elfin3")


def read(header: str, *rows: str, convention: Convention | None = None, **options: Any) -> PoseTable:
    text = "".join(line + "\n" for line in (header, *rows))
    return read_poses(io.BytesIO(text.encode("utf-8", "surrogateescape")), convention, **options)


def random_poses(count: int, seed: int = 0) -> list[PoseSample]:
    rng = np.random.default_rng(seed)
    model = GravityModel([0, 0, -6], [1, 2, 3], [0.01, 0, 0.06], [0.1, 0.2, 0.3])
    R_WS = Rotation.random(count, rng=rng).as_matrix()
    wrenches = model.predict(R_WS) + rng.normal(0, 0.01, (count, 6))
    return [PoseSample(R, wrench[:3], wrench[3:]) for R, wrench in zip(R_WS, wrenches, strict=True)]


def same(found: PoseSample, pose: PoseSample) -> None:
    # A quaternion is written: to it and back is a few roundings.
    np.testing.assert_allclose(found.R_WS, pose.R_WS, rtol=0, atol=1e-14)
    for field in ("force", "torque", "force_sd", "torque_sd"):
        np.testing.assert_array_equal(getattr(found, field), getattr(pose, field))
    for field in ("count", "temperature", "time"):
        assert getattr(found, field) == getattr(pose, field)
    assert found.name == pose.name.strip()


# ---- what is read --------------------------------------------------------------------------------


def test_everything_that_a_row_may_hold():
    table = read(
        f"note,name,temperature,count,t,sfx,sfy,sfz,smx,smy,smz,{QUATERNION}",
        f'x,"up, ""free""",21.5,200,0.25,.1,.2,.3,.01,.02,.03,0.5,0.5,0.5,-0.5,{READ}',
        f"x,plain ,,,,,,,,,,1,0,0,0,{READ}",
    )
    first, second = table.poses
    assert (first.name, first.temperature, first.count, first.time) == ('up, "free"', 21.5, 200, 0.25)
    assert (first.force.tolist(), first.torque.tolist()) == ([1, 2, -5], [0.1, 0.2, 0.3])
    assert first.force_sd is not None
    assert first.torque_sd is not None
    assert (first.force_sd.tolist(), first.torque_sd.tolist()) == ([0.1, 0.2, 0.3], [0.01, 0.02, 0.03])
    np.testing.assert_allclose(first.R_WS, [[0, 1, 0], [0, 0, -1], [-1, 0, 0]], atol=1e-15)
    assert (second.name, second.temperature, second.count, second.time) == ("plain", None, 1, None)
    assert second.force_sd is second.torque_sd is table.joints is None
    assert table.raw.tolist() == [[0.5, 0.5, 0.5, -0.5], [1, 0, 0, 0]]
    assert table.lines.tolist() == [2, 3]
    assert table.convention == Convention()


@pytest.mark.parametrize("order", ["xyz", "ZYX", "zxz"])
def test_angles_follow_the_convention(order):
    table = read(ANGLES, f"10,20,130,{READ}", convention=Convention(Kind.EULER, order, inverse=True))
    expected = Rotation.from_euler(order, [10, 20, 130], degrees=True).as_matrix().T
    np.testing.assert_allclose(table.poses[0].R_WS, expected, atol=1e-15)
    assert table.raw.tolist() == [[10, 20, 130]]


@pytest.mark.parametrize("degrees", [True, False])
def test_joints_go_through_the_robot_and_the_mount(degrees):
    q = np.array([0.1, 0.2, 0.3, -0.4, 0.5, -0.6])
    cells = ",".join(map(repr, (np.degrees(q) if degrees else q).tolist()))
    R_ES = Rotation.from_euler("xyz", [0.1, 0.2, 0.3]).as_matrix()
    convention = Convention(Kind.JOINTS, degrees=degrees, robot="elfin3")
    table = read(JOINTS, f"{cells},{READ}", convention=convention, R_ES=R_ES)
    R_WE = Robot.named("elfin3").flange_pose(q)[0]
    np.testing.assert_allclose(table.poses[0].R_WS, R_WE @ R_ES, atol=1e-14)
    assert table.joints is not None
    np.testing.assert_allclose(table.joints, [q], atol=1e-15)
    plain = read(JOINTS, f"{cells},{READ}", convention=convention)
    np.testing.assert_allclose(plain.poses[0].R_WS, R_WE, atol=1e-14)


def test_the_convention_chooses_among_columns():
    header, row = f"qw,qx,qy,qz,{ANGLES}", f"1,0,0,0,90,0,0,{READ}"
    assert read(header, row, convention=EULER).poses[0].R_WS[2, 1] == pytest.approx(1)
    assert read(header, row, convention=Convention()).poses[0].R_WS[2, 1] == 0


def test_rows_that_are_not_complete_are_left_out_and_told():
    bad = [
        "1,0,0,0,1,,1,0,0,0",
        "1,0,0,0,1,nan,1,0,0,0",
        "1,0,0,0,n/a,2,1,0,0,0",
        "1,0,0,0,1",
        "1,0,0,inf,1,2,3,0,0,0",
    ]
    found = read(QUATERNION, GOOD, *bad, GOOD.replace("1,0,0,0", "0,1,0,0", 1))
    assert found.lines.tolist() == [2, 8]
    told = " ".join(found.warnings)
    for words in ("3 rows left out: column fy is empty or no number, first in line 3",
                  "1 rows left out: column fx is empty or no number, first in line 5",
                  "1 rows left out: column qz is empty or no number, first in line 7"):  # fmt: skip
        assert words in told


# ---- what is refused -----------------------------------------------------------------------------

SDS = "sfx,sfy,sfz"
REFUSED: dict[str, tuple[str, list[str], Convention | None, str]] = {
    "angles": (
        ANGLES,
        [f"1,2,3,{READ}"],
        None,
        "line 1: columns rx, ry, rz alone do not define the orientation: pass --euler ORDER",
    ),
    "joints": (JOINTS, [f"1,2,3,4,5,6,{READ}"], None, "pass --robot NAME .* j1 to j6 (known: elfin3)."),
    "several": (
        f"qw,qx,qy,qz,{ANGLES}",
        [f"1,0,0,0,1,2,3,{READ}"],
        None,
        "orientations are given as quaternions and as angles: choose one. .* or rename these columns to use qw",
    ),
    "two-kinds": (
        f"j1,j2,j3,j4,j5,j6,{ANGLES}",
        ["1,2,3,4,5,6,1,2,3," + READ],
        None,
        "as angles and as joints: choose one. Pass --euler ORDER .* or --robot NAME .*elfin3).$",
    ),
    "no-orientation": (WRENCH, [READ], None, "columns qw, qx, qy, qz missing; found: fx.* qw,qx,qy,qz,fx"),
    "other-convention": (QUATERNION, [GOOD], EULER, "columns rx, ry, rz missing; .* Name the columns rx,ry"),
    "no-torque": ("qw,qx,qy,qz,fx,fy,fz", ["1,0,0,0,1,2,3"], None, "columns mx, my, mz missing"),
    "one-sd": (
        f"{QUATERNION},sfx,sfz",
        [GOOD + ",1,1"],
        None,
        "line 1: column sfy missing: give sfx, sfy, sfz, or",
    ),
    "half-sd": (
        f"{QUATERNION},{SDS}",
        [f"{GOOD},1,1,1", f"{GOOD},1,,1"],
        None,
        "line 3: column sfy is empty",
    ),
    "negative-sd": (f"{QUATERNION},{SDS}", [f"{GOOD},1,-1,1"], None, "column sfy holds -1, but a standard"),
    "count": (f"{QUATERNION},count", [f"{GOOD},1", f"{GOOD},0"], None, "line 3: column count holds 0, but"),
    "part-count": (
        f"{QUATERNION},count",
        [f"{GOOD},1.5"],
        None,
        "count holds 1.5, but a number of samples, whole",
    ),
    "infinite-t": (f"{QUATERNION},t", [f"{GOOD},inf"], None, "column t holds inf, but a time in s"),
    "hot": (f"{QUATERNION},temperature", [f"{GOOD},-inf"], None, "temperature holds -inf, .* °C lies"),
    "huge": (
        QUATERNION,
        [GOOD, "1,0,0,0,1,2,1e6,0,0,0"],
        None,
        "line 3: column fz holds 1e+06, but a force in N",
    ),
    "empty": (
        QUATERNION,
        ["1,0,0,0,1,,1,0,0,0", "1,0,0,0,1,nan,1,0,0,0"],
        None,
        "line 2: column fy is empty or no number, and no row is complete",
    ),
    "length": (
        QUATERNION,
        [GOOD, "", f"1,1,0,0,{READ}"],
        None,
        "line 4: the quaternion has length 1.414, not 1",
    ),
    "matrix": (
        f"r11,r12,r13,r21,r22,r23,r31,r32,r33,{WRENCH}",
        [f"1,0,0,0,1,0,0,0,1,{READ}", f"1,0,0,0,3,0,0,0,1,{READ}"],
        None,
        "line 3: r11 to r33 are no rotation",
    ),
    "limit": (
        JOINTS,
        [f"0,0,0,0,0,0,{READ}", f"0,0,0,0,170,0,{READ}"],
        ELFIN,
        "line 3: joint J5 is at .* limits",
    ),
    "duplicate": (f"{QUATERNION},fx", [GOOD + ",1"], None, "column fx occurs 2 times"),
    "name": (
        f"name,{QUATERNION}",
        ["x" * 300 + "," + GOOD],
        None,
        "column name has 300 bytes, .* hold a name",
    ),
    "no-rows": (QUATERNION, [], None, "there is a header but no row below it"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case):
    header, rows, convention, message = REFUSED[case]
    pattern = message.replace("(", r"\(").replace(").", r"\).").replace("+", r"\+")
    with pytest.raises(PoseFileError, match=pattern) as caught:
        read(header, *rows, convention=convention)
    assert str(caught.value).startswith("standard input: ")
    assert len(str(caught.value).splitlines()) == 1


def test_refused_without_a_line(tmp_path):
    with pytest.raises(PoseFileError, match=r"nowhere\.csv: there is no such file: check the path"):
        read_poses(tmp_path / "nowhere.csv")
    with pytest.raises(InputError, match="no robot named 'hal'; known: elfin3"):
        read(JOINTS, f"0,0,0,0,0,0,{READ}", convention=Convention(Kind.JOINTS, robot="hal"))
    for mount in (np.eye(2), 2 * np.eye(3), -np.eye(3), np.full((3, 3), np.nan)):
        with pytest.raises(InputError, match=r"R_ES must be a \(3, 3\) rotation"):
            read(QUATERNION, GOOD, R_ES=mount)


def test_a_recording_is_no_list_of_poses():
    with pytest.raises(PoseFileError, match=r"more than 200 rows of poses: choose the right file"):
        read(QUATERNION, *[GOOD] * (POSE_LIMIT + 1))


def test_samples_are_no_poses():
    rows = [f"{0.005 * number},{GOOD}" for number in range(60)]
    with pytest.raises(
        PoseFileError, match=r"a recording \(60 rows, 5 ms apart\), .* contactbench calibrate captures"
    ):
        read(f"t,{QUATERNION}", *rows)
    assert len(read(f"t,{QUATERNION}", *[f"0,{GOOD}"] * 60).poses) == 60  # a column of zeros is no time


# ---- doubts --------------------------------------------------------------------------------------


def warnings_of(*rows: str, header: str = QUATERNION, convention: Convention | None = None) -> str:
    return " ".join(read(header, *rows, convention=convention).warnings)


def test_good_poses_raise_no_doubt(tmp_path):
    write_poses(tmp_path / "poses.csv", random_poses(8))
    assert read_poses(tmp_path / "poses.csv").warnings == ()
    assert warnings_of(GOOD) == ""


def test_torques_in_newton_millimetres():
    poses = [PoseSample(p.R_WS, p.force, 1e3 * p.torque) for p in random_poses(6)]
    rows = [
        ",".join(
            map(repr, [*Rotation.from_matrix(p.R_WS).as_quat()[[3, 0, 1, 2]].tolist(), *p.force.tolist()])
        )
        + ","
        + ",".join(map(repr, p.torque.tolist()))
        for p in poses
    ]
    assert "if the torques are in N·mm, divide them by 1000" in warnings_of(*rows)


def test_a_large_bias_is_no_wrong_unit():
    assert warnings_of("1,0,0,0,1,2,-5,30,40,50", "0,1,0,0,1,-2,5,30.2,40.1,50") == ""


def test_equal_orientations_and_repeated_rows():
    other = f"0.99999999,0.0001,0,0,{READ.replace('-5', '-5.1')}"
    assert "the same orientation to within half a degree. Turn the wrist" in warnings_of(GOOD, other)
    turned = f"0,1,0,0,{READ}"
    found = warnings_of(GOOD, turned, "", GOOD, turned)
    assert "repeat an earlier row exactly: 2; the first is line 5, which repeats line 2." in found
    assert "orientation" not in found


def timed(times, names=None):
    """Return what is said of poses at these times, each in another orientation and with another reading."""
    rows = []
    for number, pose in enumerate(random_poses(len(times))):
        quaternion = Rotation.from_matrix(pose.R_WS).as_quat()[[3, 0, 1, 2]].tolist()
        cells = [*quaternion, *pose.force.tolist(), *pose.torque.tolist()]
        name = f"pose {number}" if names is None else names[number]
        rows.append(f"{times[number]},{name}," + ",".join(map(repr, cells)))
    return warnings_of(*rows, header=f"t,name,{QUATERNION}")


@pytest.mark.parametrize(
    ("times", "names", "doubt"),
    [
        ([0, 20, 40, 60, 80], None, ""),
        ([80, 60, 40, 20, 0], None, ""),
        (["", 20, 40, "", 80], None, ""),
        (
            [0, 60, 40, 20, 80],
            None,
            "times in column t do not increase at lines 3, 5: if two rows are swapped",
        ),
        (
            [20, 40, 60, 80, 0],
            None,
            "times in column t do not increase at lines 2, 3, 4, 5, 6: if rows were moved",
        ),
        ([0, 0.01, 0.02, 0.03, 0.04], None, "poses are 10 ms apart, but a pose takes a second: write t in s"),
        (
            [0, 20, 40, 60, 80],
            ["p1", "p3", "p2", "p4", "p5"],
            "numbers in column name do not increase at lines 3, 4",
        ),
        ([0, 20, 40, 60, 80], ["up", "left 2", "left 1", "down", "right"], ""),
    ],
)
def test_rows_out_of_order(times, names, doubt):
    found = timed(times, names)
    assert doubt in found
    assert bool(doubt) == bool(found)


def test_a_copied_reading():
    found = warnings_of(f"0,1,0,0,{READ}", GOOD, f"0,0,1,0,{READ.replace('-5', '-4')}")
    assert "Lines 2 and 3 have exactly the same reading although the sensor was turned" in found
    assert "same reading" not in warnings_of(GOOD, GOOD, f"0,0,1,0,{READ.replace('-5', '-4')}")


@pytest.mark.parametrize(
    ("degrees", "cells", "doubt"),
    [
        (True, ["1.5,0,-3", "0.5,2,1"], "No angle is larger than 3°: if they are in rad, pass --radians"),
        (
            False,
            ["90,0,-180", "0,45,1"],
            "Angles reach 180 rad, more than two turns: if they are in degrees, leave out --radians",
        ),
        (True, ["15,0,-3", "0.5,2,1"], ""),
        (False, ["1.5,0,-3", "0.5,2,1"], ""),
    ],
)
def test_angles_in_the_other_unit(degrees, cells, doubt):
    rows = [f"{cell},{READ.replace('1', str(number))}" for number, cell in enumerate(cells, 1)]
    found = warnings_of(*rows, header=ANGLES, convention=Convention(Kind.EULER, degrees=degrees))
    assert doubt in found
    assert bool(doubt) == bool(found)


# ---- there and back ------------------------------------------------------------------------------

size = st.floats(-1e5, 1e5)
three = st.tuples(size, size, size).map(np.array)
deviation = st.floats(0, 1e5)
deviations = st.none() | st.tuples(deviation, deviation, deviation).map(np.array)
number = st.none() | st.floats(-1e9, 1e9)
part = st.floats(-1, 1)
rotation = (
    st.tuples(part, part, part, part)
    .filter(lambda q: math.hypot(*q) > 1e-3)
    .map(lambda q: Rotation.from_quat(q).as_matrix())
)
names = st.text(st.characters(exclude_characters="\0\r\n", exclude_categories=["Cs"]), max_size=60)
samples = st.builds(
    PoseSample, rotation, three, three, st.integers(1, 2**53), deviations, deviations, number, number, names
)


@settings(max_examples=50, deadline=None)
@given(poses=st.lists(samples, min_size=1, max_size=4))
def test_written_poses_come_back(poses, tmp_path_factory):
    file = tmp_path_factory.mktemp("poses") / "poses.csv"
    write_poses(file, poses)
    for found, pose in zip(read_poses(file).poses, poses, strict=True):
        same(found, pose)


def test_columns_that_no_pose_fills_are_left_out(tmp_path):
    file = tmp_path / "poses.csv"
    write_poses(file, random_poses(3))
    assert file.read_text(encoding="utf-8").splitlines()[0] == f"{QUATERNION},count"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("name", ["two\nlines", "a\rb", "a\0b", "x" * 257, "half \ud800"])
def test_names_that_do_not_fit_into_a_line(tmp_path, name):
    pose = random_poses(1)[0]
    with pytest.raises(InputError, match="its name must be one line of text of at most 256 bytes") as caught:
        write_poses(tmp_path / "poses.csv", [PoseSample(pose.R_WS, pose.force, pose.torque, name=name)])
    assert str(caught.value).isprintable()
    assert list(tmp_path.iterdir()) == []


def test_where_poses_cannot_be_written(tmp_path):
    with pytest.raises(InputError, match=r"there are no poses to write: capture some first"):
        write_poses(tmp_path / "poses.csv", [])
    with pytest.raises(InputError, match=r"the poses cannot be written .*: choose a folder that exists"):
        write_poses(tmp_path / "nowhere" / "poses.csv", random_poses(1))
    with pytest.raises(InputError, match="the poses cannot be written"):
        write_poses(Path("a\0b"), random_poses(1))


@pytest.mark.parametrize(
    ("names", "order", "ask"),
    [
        ("q1,q2,q3,q4", "xyzw", r"--components wxyz if q1 is the scalar, --components xyzw"),
        ("q0,q1,q2,q3", "wxyz", r"--components wxyz if q1 is the scalar, --components xyzw"),
        ("qx,qy,qz,qw", None, ""),
        (
            "R_x_x,R_x_y,R_x_z,R_y_x,R_y_y,R_y_z,R_z_x,R_z_y,R_z_z",
            "rows",
            "--components rows if rxy is in row x",
        ),
        ("xx,xy,xz,yx,yy,yz,zx,zy,zz", "columns", "--components columns if it is component y of axis x"),
        ("r11,r21,r31,r12,r22,r32,r13,r23,r33", None, ""),
        ("r00,r10,r20,r01,r11,r21,r02,r12,r22", None, ""),
    ],
)
def test_an_order_that_names_leave_open_is_asked_for(
    names: str, order: Any, ask: str, tmp_path: Path
) -> None:
    turns = Rotation.random(5, rng=np.random.default_rng(3))
    R = turns.as_matrix()
    by_columns = R.transpose(0, 2, 1).reshape(5, 9)
    cells = {
        "q1,q2,q3,q4": turns.as_quat(), "q0,q1,q2,q3": turns.as_quat(scalar_first=True), "qx,qy,qz,qw": turns.as_quat(),
    }.get(names, R.reshape(5, 9) if order == "rows" else by_columns)  # fmt: skip
    rows = [",".join([*map(repr, row), READ]) for row in cells.tolist()]
    file = tmp_path / "a.csv"
    file.write_text("\n".join([f"{names},{WRENCH}", *rows]) + "\n", encoding="utf-8")
    if order is not None:
        with pytest.raises(PoseFileError, match=ask):
            read_poses(file)
    found = read_poses(file, convention_of(PosesSettings(components=order)))
    np.testing.assert_allclose([pose.R_WS for pose in found.poses], R, atol=1e-9)
    assert found.convention == Convention()
    back = read_poses(file, convention_of(PosesSettings(components=order, inverse=True))) if order else found
    np.testing.assert_allclose(
        rotations(back.raw, back.convention), [pose.R_WS for pose in back.poses], atol=1e-9
    )


def test_columns_shows_how_a_table_would_be_read(tmp_path: Path) -> None:
    file = tmp_path / "lab.csv"
    rows = "".join(f"{20 * n};1,5;2;3;100;0;0\n" for n in range(100))
    file.write_text(f"made in a lab\nt;Fx [N];Fy [N];Fz [N];Tx [Nmm];Ty;Tz\n{rows}", encoding="cp1252")
    result = invoke("calibrate", "columns", file, "--json")
    found = json.loads(result.stdout)
    assert (result.exit_code, found["header"], found["scales"]) == (1, 2, {"mx": 0.001})
    assert "looks like ms, not s: name the column t_ms" in found["fault"]
    assert "Tx [Nmm]: mx, times 0.001" in result.output
    file.write_text(f"t_ms;Fx [N];Fy [N];Fz [N];Tx [Nmm];Ty;Tz\n{rows}", encoding="cp1252")
    assert invoke("calibrate", "columns", file).exit_code == 0
