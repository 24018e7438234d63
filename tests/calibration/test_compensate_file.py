import io
import math
import os
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import GravityModel, Level, PoseSample, Verdict, calibrate
from contactbench.pipeline.calibration.files.compensate_file import HEADER, CompensateSummary, compensate_file
from contactbench.pipeline.calibration.orientation import Convention, Kind
from contactbench.pipeline.contact import ContactSolver
from contactbench.pipeline.contact.contact_csv import REASONS
from contactbench.pipeline.contact.stream import WrenchFileError, locate_file
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.mesh import load_probe
from contactbench.pipeline.robot import Robot

CHANNELS = "fx,fy,fz,mx,my,mz"
QUATERNION = f"t,{CHANNELS},qw,qx,qy,qz"
JOINTS = f"t,{CHANNELS},j1,j2,j3,j4,j5,j6"
GOOD = "0.10,1,2,-5,0.1,0.2,0.3,1,0,0,0"
ELFIN = Convention(Kind.JOINTS, robot="elfin3")
ROWS = 300


def spread(seed: int) -> np.ndarray:
    root = np.random.default_rng(seed).normal(size=(12, 12)) * np.repeat([0.02, 0.02, 0.001, 0.001], 3)
    return root @ root.T


MODEL = GravityModel([0.1, -0.2, -6], [1, 2, 3], [0.01, 0, 0.06], [0.1, 0.2, 0.3], spread(1))


@pytest.fixture(scope="module")
def readings() -> np.ndarray:
    return np.random.default_rng(3).normal(size=(ROWS, 6)) * np.repeat([8.0, 0.4], 3)


@pytest.fixture(scope="module")
def turns() -> Rotation:
    return Rotation.random(ROWS, rng=np.random.default_rng(4))


@pytest.fixture
def write(tmp_path: Path) -> Callable[..., Path]:
    def write(header: str, *rows: str, name: str = "raw.csv") -> Path:
        path = tmp_path / name
        path.write_text("".join(line + "\n" for line in (header, *rows)), encoding="utf-8")
        return path

    return write


def lines_of(readings: np.ndarray, orientations: np.ndarray) -> list[str]:
    rows = np.hstack([readings, orientations]).tolist()
    return [f"{0.005 * i:.3f}," + ",".join(map(repr, row)) for i, row in enumerate(rows)]


def quaternions(turns: Rotation) -> np.ndarray:
    return turns.as_quat()[:, [3, 0, 1, 2]]


def compensated(source: Path, convention: Convention | None = None, **options: Any) -> bytes:
    out = source.with_name("wrenches.csv")
    compensate_file(MODEL, source, out, convention, **options)
    return out.read_bytes()


def cells(data: bytes) -> list[list[str]]:
    return [line.split(",") for line in data.decode().splitlines()[1:]]


def numbers(data: bytes) -> np.ndarray:
    return np.array([[float(cell) if cell else math.nan for cell in row[1:]] for row in cells(data)])


def expected(R_WS: np.ndarray, readings: np.ndarray) -> np.ndarray:
    """Eq. 1, one reading at a time."""
    rows = []
    for R, reading in zip(R_WS, readings, strict=True):
        weight = R.T @ MODEL.gravity_W
        torque = np.cross(MODEL.centre_of_mass_S, weight)
        rows.append(reading - [*(weight + MODEL.force_bias), *(torque + MODEL.torque_bias)])
    return np.array(rows)


# ---- the numbers ---------------------------------------------------------------------------------


def test_bias_and_weight_are_gone(readings, turns, write):
    data = compensated(write(QUATERNION, *lines_of(readings, quaternions(turns))))
    assert data.startswith(HEADER)
    np.testing.assert_allclose(numbers(data), expected(turns.as_matrix(), readings), rtol=0, atol=1e-13)
    assert [row[0] for row in cells(data)] == [f"{0.005 * i:.3f}" for i in range(ROWS)]
    assert all(cell == repr(float(cell)) for row in cells(data) for cell in row[1:])


@pytest.mark.parametrize("inverse", [False, True])
def test_angles_of_the_flange(readings, turns, write, inverse):
    R_ES = Rotation.from_euler("xyz", [0.3, -0.2, 1.0]).as_matrix()
    convention = Convention(Kind.EULER, "ZYX", inverse=inverse)
    source = write(f"t,{CHANNELS},rx,ry,rz", *lines_of(readings, turns.as_euler("ZYX", degrees=True)))
    R_WE = (turns.inv() if inverse else turns).as_matrix()
    found = numbers(compensated(source, convention, R_ES=R_ES))
    np.testing.assert_allclose(found, expected(R_WE @ R_ES, readings), rtol=0, atol=1e-12)


@pytest.mark.parametrize("inverse", [False, True])
@pytest.mark.parametrize("degrees", [False, True])
def test_joints_of_a_robot(readings, write, degrees, inverse):
    q = np.random.default_rng(5).uniform(-2, 2, (ROWS, 6))
    R_ES = Rotation.from_euler("xyz", [0.3, -0.2, 1.0]).as_matrix()
    source = write(JOINTS, *lines_of(readings, np.degrees(q) if degrees else q))
    convention = replace(ELFIN, degrees=degrees, inverse=inverse)
    R_WE = Robot.named("elfin3").flange_rotations(q)
    R_WE = R_WE.transpose(0, 2, 1) if inverse else R_WE
    for mount, R_WS in ((None, R_WE), (R_ES, R_WE @ R_ES)):
        found = numbers(compensated(source, convention, R_ES=mount))
        np.testing.assert_allclose(found, expected(R_WS, readings), rtol=0, atol=1e-12)


def test_locate_reads_the_output(turns, write, tmp_path):
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=40.0)
    mesh.apply_translation([5.0, 0.0, 120.0])
    mesh.export(tmp_path / "ball.stl")
    solver = ContactSolver(load_probe(tmp_path / "ball.stl", "mm"))
    outward = turns.as_matrix()[:, 0]
    push = -8.0 * outward
    torque = np.cross([0.005, 0, 0.12] + 0.04 * outward, push)
    touches = np.hstack([push, torque])
    raw = touches + MODEL.predict(turns.as_matrix())
    source = write(QUATERNION, *lines_of(raw, quaternions(turns)))
    compensate_file(MODEL, source, tmp_path / "wrenches.csv")
    out = io.BytesIO()
    summary = locate_file(solver, tmp_path / "wrenches.csv", out, track=True)
    assert summary.rows == ROWS
    np.testing.assert_allclose(numbers((tmp_path / "wrenches.csv").read_bytes()), touches, atol=1e-12)
    reasons = [row[6] for row in cells(out.getvalue())]
    assert reasons == [REASONS[reason] for reason in solver.locate_batch(touches).reasons]
    assert "ok" in reasons


# ---- what a file may look like -------------------------------------------------------------------


@pytest.mark.parametrize("block_bytes", [1, 700, 10_000])
def test_blocks_leave_no_seam(readings, turns, write, block_bytes):
    lines = lines_of(readings, quaternions(turns))
    lines[100] = '"0,5"' + lines[100][lines[100].index(",") :]
    lines.insert(50, "")
    source = write(QUATERNION, *lines)
    whole = compensated(source)
    assert compensated(source, block_bytes=block_bytes) == whole
    assert whole.count(b"\n") == ROWS + 1
    assert whole.splitlines()[101].startswith(b'"0,5",')
    out = io.BytesIO()
    compensate_file(MODEL, io.BytesIO(source.read_bytes()), out, block_bytes=block_bytes)
    assert out.getvalue() == whole


def test_other_columns_are_ignored(readings, turns, write):
    plain = lines_of(readings, quaternions(turns))
    data = compensated(write(QUATERNION, *plain))
    mixed = [",".join(["x", *row[7:], "", row[0], *row[1:7]]) for row in (line.split(",") for line in plain)]
    assert compensated(write(f"note,qw,qx,qy,qz,gap,t,{CHANNELS}", *mixed)) == data


@pytest.mark.parametrize("t", ["", "1e3", "007", "2024-05-01T12:00:00Z", " 1 ", "µ"])
def test_t_is_copied_as_it_stands(write, t):
    assert cells(compensated(write(QUATERNION, t + GOOD[4:])))[0][0] == t


def test_progress_ends_with_every_byte_read(write):
    source = write(QUATERNION, *[GOOD] * 50)
    seen: list[tuple[int, int]] = []
    compensate_file(
        MODEL, source, io.BytesIO(), block_bytes=100, progress=lambda done, total: seen.append((done, total))
    )
    size = source.stat().st_size
    assert seen[-1] == (size, size)
    assert seen == sorted(seen)


def test_memory_does_not_grow_with_the_file(readings, turns, write):
    source = write(QUATERNION, *lines_of(readings, quaternions(turns)) * 50)
    tracemalloc.start()
    try:
        compensate_file(MODEL, source, source.with_name("wrenches.csv"), block_bytes=2**16)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 2 * 2**20 < source.stat().st_size


# ---- the summary ---------------------------------------------------------------------------------


def summary_of(source: Path, calibration: Any = MODEL, **options: Any) -> CompensateSummary:
    return compensate_file(calibration, source, io.BytesIO(), **options)


@pytest.mark.parametrize("block_bytes", [1000, 10_000, 4 * 2**20])
def test_summary(readings, turns, write, block_bytes):
    source = write(QUATERNION, *lines_of(readings, quaternions(turns)))
    summary = summary_of(source, block_bytes=block_bytes)
    forces = expected(turns.as_matrix(), readings)[:, :3]
    C = MODEL.wrench_covariance(turns.as_matrix())
    assert summary.rows == ROWS
    assert summary.largest_force_N == pytest.approx(np.linalg.norm(forces, axis=1).max(), rel=1e-12)
    for sigma, part in ((summary.sigma_force_N, slice(0, 3)), (summary.sigma_torque_Nm, slice(3, 6))):
        worst = max(np.linalg.norm(c, 2) for c in C[:, part, part])
        assert sigma == pytest.approx(math.sqrt(worst), rel=1e-9)
    assert summary.warnings == ()
    assert summary.rows_per_second > 0
    assert summary.facts()["sigma_torque_Nm"] == summary.sigma_torque_Nm


def test_the_uncertainty_of_a_long_file_does_not_depend_on_blocks(write):
    turns = Rotation.from_rotvec(np.outer(np.linspace(0, 6, 3000), [0.5, 0.3, 0.1]))
    source = write(QUATERNION, *lines_of(np.zeros((3000, 6)), quaternions(turns)))
    small, large = (summary_of(source, block_bytes=size) for size in (5000, 2**20))
    assert small.sigma_force_N == pytest.approx(large.sigma_force_N, rel=1e-12)
    assert small.sigma_torque_Nm == pytest.approx(large.sigma_torque_Nm, rel=1e-12)
    C = MODEL.wrench_covariance(turns.as_matrix())
    worst = math.sqrt(max(np.linalg.norm(c, 2) for c in C[:, :3, :3]))
    assert large.sigma_force_N == pytest.approx(worst, rel=0.03)


def test_a_refused_calibration_makes_a_warning(write):
    turns = Rotation.random(8, rng=np.random.default_rng(0)).as_matrix()
    noise = np.random.default_rng(1).normal(size=(8, 6)) * np.repeat([0.02, 0.0005], 3)
    wrenches = MODEL.predict(turns) + noise
    calibration = calibrate([PoseSample(R, w[:3], w[3:]) for R, w in zip(turns, wrenches, strict=True)])
    source = write(QUATERNION, GOOD)
    assert calibration.verdict.level is Level.GOOD
    assert summary_of(source, calibration).warnings == ()
    refused = replace(calibration, verdict=Verdict(Level.REFUSE, ("Gravity comes out pointing up.",)))
    assert summary_of(source, refused).warnings == (
        "The calibration was refused, so do not trust these wrenches. Gravity comes out pointing up.",
    )


# ---- what is refused -----------------------------------------------------------------------------

HEAD = GOOD.rsplit(",", 4)[0]
REFUSED: dict[str, tuple[str, list[str], Convention | None, str]] = {
    "missing": (
        f"t,{CHANNELS}",
        [HEAD],
        None,
        "line 1: columns qw, qx, qy, qz missing; .* Name the columns t,fx",
    ),
    "no-time": (QUATERNION[2:], [GOOD], None, "line 1: column t missing"),
    "angles": (f"t,{CHANNELS},rx,ry,rz", [HEAD + ",1,2,3"], None, "pass --euler ORDER"),
    "nan": (
        QUATERNION,
        [GOOD, GOOD.replace("-5", "nan")],
        None,
        "line 3: column fz holds nan: .* --allow-nan",
    ),
    "no-orientation": (QUATERNION, [GOOD[:-1]], None, "line 2: column qz is empty: remove the row, or use"),
    "length": (
        QUATERNION,
        [*[GOOD] * 40, HEAD + ",0,0,0,0"],
        None,
        "line 42: the quaternion has length 0, not 1",
    ),
    "limit": (
        JOINTS,
        [HEAD + ",0,0,0,0,0,0", HEAD + ",0,0,0,0,0,185"],
        ELFIN,
        "line 3: joint J6 is at 3.2.* outside",
    ),
    "first": (
        QUATERNION,
        [GOOD, HEAD + ",2,0,0,0", "1,2,3"],
        None,
        "line 3: the quaternion has length 2, not 1",
    ),
    "no-rows": (QUATERNION, [], None, "there is a header but no row below it"),
}


@pytest.mark.parametrize("block_bytes", [16, 4 * 2**20])
@pytest.mark.parametrize("case", [case for case in REFUSED if case != "first"])
def test_refused(write, case, block_bytes, tmp_path):
    header, rows, convention, message = REFUSED[case]
    source = write(header, *rows)
    with pytest.raises(WrenchFileError, match=message) as caught:
        compensated(source, convention, block_bytes=block_bytes)
    assert str(caught.value).startswith(f"{source}: ")
    assert list(tmp_path.iterdir()) == [source]


def test_what_is_wrong_first_in_the_file_is_named(write):
    header, rows, _, message = REFUSED["first"]
    with pytest.raises(WrenchFileError, match=message):
        compensated(write(header, *rows), block_bytes=32)


def test_arguments_that_are_no_use(write, tmp_path):
    source = write(JOINTS, HEAD + ",0,0,0,0,0,0")
    with pytest.raises(InputError, match="no robot named 'hal'"):
        compensated(source, Convention(Kind.JOINTS, robot="hal"))
    with pytest.raises(InputError, match="R_ES must be a"):
        compensated(source, ELFIN, R_ES=np.ones((3, 3)))
    with pytest.raises(WrenchFileError, match="there is no such file"):
        compensated(tmp_path / "nowhere.csv")
    assert list(tmp_path.iterdir()) == [source]


def test_an_encoder_may_be_a_hair_past_its_limit(write):
    limit = math.degrees(3.14)
    assert cells(compensated(write(JOINTS, f"{HEAD},0,0,0,0,0,{limit + 0.5}"), ELFIN))
    with pytest.raises(WrenchFileError, match="joint J6"):
        compensated(write(JOINTS, f"{HEAD},0,0,0,0,0,{limit + 1.5}"), ELFIN)


@pytest.mark.parametrize("convention", [None, ELFIN])
def test_allow_nan(write, convention):
    header, good = (QUATERNION, "1,0,0,0") if convention is None else (JOINTS, "0,0,0,0,0,0")
    lost = good.replace("0", "", 1)
    source = write(
        header,
        f"{HEAD},{good}",
        f"1,1,,-5,0.1,0.2,0.3,{good}",
        f"2,1,2,-inf,0.1,0.2,0.3,{good}",
        f"{HEAD},{lost}",
    )
    found = cells(compensated(source, convention, allow_nan=True))
    assert found[1][2] == ""
    assert [cell != "" for cell in found[1]] == [True, True, False, True, True, True, True]
    assert found[2][3] == "-inf"
    assert found[3] == ["0.10", *[""] * 6]
    assert compensated(source, convention, allow_nan=True, block_bytes=10) == compensated(
        source, convention, allow_nan=True
    )
    summary = summary_of(source, convention=convention, allow_nan=True)
    assert summary.not_finite == 3
    assert summary.largest_force_N == pytest.approx(np.linalg.norm([float(cell) for cell in found[0][1:4]]))
    assert summary.warnings == (
        "3 of 4 rows have empty or infinite cells; they were passed through (--allow-nan).",
    )


def test_the_largest_numbers_there_are(write):
    source = write(QUATERNION, "0,1.7e308,1.7e308,0,-1.7e308,0,0,1,0,0,0")
    assert math.isfinite(summary_of(source).largest_force_N)


def test_output_must_not_be_the_input(write, tmp_path):
    source = write(QUATERNION, GOOD)
    link = tmp_path / "link.csv"
    link.symlink_to(source)
    for out in (source, tmp_path / "." / source.name, link):
        with pytest.raises(
            WrenchFileError, match="the output would overwrite the input: choose another name"
        ):
            compensate_file(MODEL, source, out)
    assert source.read_text(encoding="utf-8") == f"{QUATERNION}\n{GOOD}\n"


# ---- all or nothing ------------------------------------------------------------------------------


def test_a_bad_row_late_in_the_file_leaves_the_old_output(write, tmp_path):
    old = write("old", name="wrenches.csv")
    source = write(QUATERNION, *[GOOD] * 5000, "1,2,3")
    with pytest.raises(WrenchFileError, match="line 5002"):
        compensated(source, block_bytes=1000)
    assert old.read_text(encoding="utf-8") == "old\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["raw.csv", "wrenches.csv"]


@pytest.mark.parametrize("fault", [KeyboardInterrupt, OSError(28, "No space left on device")])
def test_an_interruption_leaves_the_old_output(write, tmp_path, monkeypatch, fault):
    old = write("old", name="wrenches.csv")

    def fail(_: int) -> None:
        raise fault

    monkeypatch.setattr(os, "fsync", fail)
    expected_error = WrenchFileError if isinstance(fault, OSError) else KeyboardInterrupt
    with pytest.raises(
        expected_error, match="the wrenches cannot be written" if isinstance(fault, OSError) else None
    ):
        compensated(write(QUATERNION, GOOD))
    assert old.read_text(encoding="utf-8") == "old\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["raw.csv", "wrenches.csv"]


def test_an_interruption_between_blocks(write, tmp_path):
    def stop(done: int, _: int) -> None:
        if done > 2000:
            raise KeyboardInterrupt

    source = write(QUATERNION, *[GOOD] * 1000)
    with pytest.raises(KeyboardInterrupt):
        compensated(source, block_bytes=500, progress=stop)
    assert list(tmp_path.iterdir()) == [source]
