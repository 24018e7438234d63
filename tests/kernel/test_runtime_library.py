"""The C library: built, installed, found by another project, and the same bits as the Python runtime."""

import ctypes
import hashlib
import json
import math
import re
import shutil
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from config.runtime.bundles import example, example_bundle, of_version_1, of_version_2, of_version_3
from kernel.runtime_cases import columns, stream, with_faults, with_surprises
from native import BUILD, ROOT, cmake, installed, needs_cmake, run

from contactbench.pipeline import kernel
from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.config.runtime.canonical import encode_json
from contactbench.pipeline.config.runtime.values import kernel_arguments
from contactbench.pipeline.contact.facet_marks import facet_marks

pytestmark = needs_cmake


@pytest.fixture(scope="module")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return installed(tmp_path_factory.mktemp("installed"))


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, RuntimeConfig]:
    folder = tmp_path_factory.mktemp("bundles") / "bundle"
    return folder, example_bundle(folder, clamped=True)


class Error(ctypes.Structure):
    _fields_ = [("size", ctypes.c_uint32), ("code", ctypes.c_int32), ("message", ctypes.c_char * 512)]


class Zero(ctypes.Structure):
    _fields_ = [
        ("size", ctypes.c_uint32),
        ("state", ctypes.c_int32),
        ("age", ctypes.c_double),
        *((name, ctypes.c_double * 3) for name in ("force", "torque", "force_sigma", "torque_sigma")),
        ("shift", ctypes.c_double),
        ("shift_sigma", ctypes.c_double),
    ]


CONTACT = np.dtype(
    [(name, "<i4") for name in ("size", "reasons", "accepted", "faces", "vertices", "regions")]
    + [("candidates", "<i4"), ("healths", "<u4")]
    + [
        ("times", "<f8"),
        ("points", "<f8", 3),
        ("normals", "<f8", 3),
        ("torques", "<f8"),
        ("wrenches", "<f8", 6),
    ]
    + [("covariances", "<f8", (3, 3)), ("filtered_points", "<f8", 3)]
    + [(name, "<f8") for name in ("misfits", "left_overs", "arms", "confidences")]
    + [("runners_up", "<f8", 3), ("seconds", "<f8", 3), ("pose_age", "<f8"), ("latency", "<f8")]
    + [(name, "<i4") for name in ("on", "reserved")]
    + [(name, "<f8") for name in ("withins", "torsion_arms", "torsion_since")]
    + [(name, "<f8", 6) for name in ("raw", "taken")]
)


CONTACT_2_0 = 336  # bytes, of version 2.0: without what has come since


class Library:
    def __init__(self, prefix: Path) -> None:
        self.c = ctypes.CDLL(str(next(prefix.glob("lib*/libcontactbench_runtime.so"))))
        self.c.cb_open.restype = ctypes.c_void_p
        self.c.cb_reason_name.restype = ctypes.c_char_p
        self.c.cb_version.restype = ctypes.c_char_p
        pointer = ctypes.c_void_p
        self.c.cb_update.argtypes = [pointer, pointer, pointer, ctypes.c_double, pointer]
        self.c.cb_check_zero.argtypes = [pointer, pointer]
        self.c.cb_line.argtypes = [pointer, pointer, pointer, ctypes.c_uint32]
        for name in ("cb_reset", "cb_close"):
            getattr(self.c, name).argtypes = [pointer]

    def open(self, folder: Path) -> tuple[int | None, Error]:
        error = Error(size=ctypes.sizeof(Error))
        return self.c.cb_open(str(folder).encode(), ctypes.byref(error)), error


@pytest.fixture(scope="module")
def library(prefix: Path) -> Library:
    return Library(prefix)


def both_answers(library: Library, folder: Path, count: int) -> set[int]:
    """Compare the library with the Python runtime on a bundle, to the bit; return the reasons that there were."""
    config = RuntimeConfig.load(folder)
    readings, R, times = stream(config, count)
    with_surprises(config, readings)
    with_faults(readings, R, times)
    expected = columns(kernel.Runtime(**kernel_arguments(config)).update_batch(readings, R, times))
    handle, error = library.open(folder)
    assert handle, error.message
    rows = np.zeros(len(times), CONTACT)
    rows["size"] = CONTACT.itemsize
    w, r, out = readings.ctypes.data, R.ctypes.data, rows.ctypes.data
    codes = {
        library.c.cb_update(handle, w + 48 * i, r + 72 * i, float(times[i]), out + CONTACT.itemsize * i)
        for i in range(len(times))
    }
    library.c.cb_close(handle)
    assert codes == {0}
    for name, values in expected.items():
        assert rows[name].tobytes() == values.tobytes(), name
    marks, faces = facet_marks(config.probe).astype(int), rows["faces"]
    assert (rows["on"] == np.where(faces < 0, -1, marks[faces])).all()
    return set(rows["reasons"].tolist())


def test_same_bits_as_the_python_runtime(library: Library, bundle: tuple[Path, RuntimeConfig]) -> None:
    assert {0, 2, 3, 7, 8, 9, 10, 11, 12, 13} <= both_answers(library, bundle[0], 30_000)


@pytest.mark.parametrize("older", [of_version_1, of_version_2, of_version_3])
def test_a_bundle_of_an_older_version_gives_the_same_bits(
    library: Library, tmp_path: Path, older: Any
) -> None:
    for name, data in older(example().encoded()).items():
        (tmp_path / name).write_bytes(data)
    assert {0, 2, 3, 11, 12} <= both_answers(library, tmp_path, 40_000)
    model, info = RuntimeConfig.load(tmp_path).model, (ctypes.c_char * 944)()
    struct.pack_into("I", info, 0, 944)
    handle = ctypes.c_void_p(library.open(tmp_path)[0])
    assert library.c.cb_describe(handle, info) == 0
    assert struct.unpack_from("i", info, 4)[0] == model.verified == (older is of_version_3)
    assert info[432:].split(b"\0")[0].decode() == "".join(model.provenance.stale)


def test_null_and_wrong_sizes_are_refused(library: Library, bundle: tuple[Path, RuntimeConfig]) -> None:
    handle, _ = library.open(bundle[0])
    numbers, contact = np.zeros(9), np.zeros(1, CONTACT)
    w, out = numbers.ctypes.data, contact.ctypes.data
    assert library.c.cb_update(handle, w, w, 0.0, out) == 1  # its size is 0
    contact["size"] = CONTACT.itemsize
    assert library.c.cb_update(None, w, w, 0.0, out) == 1
    assert library.c.cb_update(handle, None, w, 0.0, out) == 1
    assert library.c.cb_update(handle, w, None, 0.0, out) == 1
    assert library.c.cb_update(handle, w, w, 0.0, None) == 1
    assert library.c.cb_update(handle, w, w, 0.0, out) == 0
    assert library.c.cb_reason_name(int(contact["reasons"][0])) == b"not_a_rotation"
    assert library.c.cb_reset(handle) == 0
    assert library.c.cb_reset(None) == 1
    assert library.c.cb_sensor_rotation(None, None, None) == 1
    assert library.c.cb_describe(None, None) == 1
    zero = Zero(size=ctypes.sizeof(Zero))
    assert library.c.cb_check_zero(handle, ctypes.byref(zero)) == 0
    assert (zero.state, math.isnan(zero.age), math.isnan(zero.force[0])) == (0, True, True)
    assert library.c.cb_check_zero(handle, ctypes.byref(Zero(size=ctypes.sizeof(Zero) - 8))) == 1
    text = ctypes.create_string_buffer(4096)
    length = library.c.cb_line(out, ctypes.byref(zero), text, 4096)
    assert json.loads(text.value)["reason"] == "not_a_rotation"
    assert len(text.value) == length
    assert library.c.cb_line(out, ctypes.byref(zero), text, length + 1) == length
    assert library.c.cb_line(out, ctypes.byref(zero), text, length) == 0
    assert library.c.cb_line(None, ctypes.byref(zero), text, 4096) == 0
    assert library.c.cb_line(out, None, text, 4096) == 0
    assert library.c.cb_line(out, ctypes.byref(zero), None, 4096) == 0
    assert library.c.cb_check_zero(None, ctypes.byref(zero)) == 1
    assert library.c.cb_check_zero(handle, None) == 1
    assert not library.c.cb_open(None, None)
    library.c.cb_close(handle)
    library.c.cb_close(None)
    assert library.c.cb_reason_name(-2) == library.c.cb_reason_name(16) == b"unknown"
    assert library.c.cb_reason_name(15) == b"uncertain"
    assert library.c.cb_reason_name(-1) == b"no_answer"
    assert library.c.cb_version() == b"2.6.0"


def test_a_contact_that_was_not_answered_is_no_contact(
    library: Library, bundle: tuple[Path, RuntimeConfig]
) -> None:
    handle, _ = library.open(bundle[0])
    numbers, contact = np.zeros(9), np.zeros(1, CONTACT)
    w, out = numbers.ctypes.data, contact.ctypes.data
    for size, arguments_ in (
        (0, (handle, w, w, 0.0, out)),
        (CONTACT.itemsize, (None, w, w, 0.0, out)),
        (CONTACT.itemsize, (handle, None, w, 0.0, out)),
        (CONTACT.itemsize, (handle, w, None, 0.0, out)),
    ):
        contact["size"], contact["reasons"], contact["accepted"] = size, 0, 1
        assert library.c.cb_update(*arguments_) == 1
        assert (contact["reasons"][0], contact["accepted"][0]) == (-1, 0)
    library.c.cb_close(handle)


def put(folder: Path, name: str, data: bytes, *, reseal: bool = True) -> None:
    """Write a file, and unless told otherwise make every hash fit again: only what it says is wrong then."""
    (folder / name).write_bytes(data)
    if not reseal:
        return
    config = folder / "contactbench.json"
    if name != config.name:
        content = json.loads(config.read_text(encoding="utf-8"))
        content["provenance"]["files"][name] = hashlib.sha256(data).hexdigest()
        config.write_bytes(encode_json(content))
    digest = hashlib.sha256(config.read_bytes()).hexdigest()
    (folder / "contactbench.sha256").write_text(f"{digest}  contactbench.json\n", encoding="ascii")


def edited(folder: Path, path: str, value: Any) -> None:
    config = folder / "contactbench.json"
    content = json.loads(config.read_text(encoding="utf-8"))
    *way, last = path.split(".")
    part = content
    for name in way:
        part = part[name]
    part[last] = value
    put(folder, config.name, encode_json(content))


EDITS = [
    ("version", 5, 5, "version"),
    ("version", 0, 5, "version"),
    ("version", 3, 4, "unknown"),
    ("version", 2, 4, "unknown"),
    ("version", 1, 4, "unknown"),
    ("touch.torsion_arm_m", 1.0, 6, "touch.torsion_arm_m"),
    ("touch.mesh_deviation_m", -1e-5, 6, "touch.mesh_deviation_m"),
    ("touch.mesh_curved", 1, 4, "touch.mesh_curved"),
    ("touch.model_error.force_N", [0.1, 0.1], 4, "touch.model_error.force_N"),
    ("touch.model_error.torque_Nm", [1.0, 1.0, 11.0], 6, "touch.model_error.torque_Nm[2]"),
    ("touch.model_error.measured", None, 4, "touch.model_error.measured"),
    ("gates.rival_odds", 0.5, 6, "gates.rival_odds"),
    ("gates.implausible_misfit", 100.0, 6, "gates.implausible_misfit"),
    ("gates.torque_ratio", 1.5, 4, "gates.torque_ratio"),
    ("gates.accept_by_region", 1, 4, "gates.accept_by_region"),
    ("controller.variant", "bold", 4, "controller.variant"),
    ("controller.force.mass_kg", 0, 6, "controller.force.mass_kg"),
    ("controller.angle.damping", [1.0], 4, "controller.angle.damping"),
    ("controller.angle.gain_per_s", [1.0, -1.0], 6, "controller.angle.gain_per_s[1]"),
    ("controller.touch.attempts", 1.5, 4, "controller.touch.attempts"),
    ("controller.watch.max_tilt_rad", 35.0, 6, "controller.watch.max_tilt_rad"),
    ("controller.lead.extra", 1, 4, "controller.lead.extra"),
    ("limits.max_force_N", 4.0, 6, "controller.desired_force_N"),
    ("schema", "other", 4, "schema"),
    ("units.force", "kN", 4, "units.force"),
    ("gravity.gravity_W_N", [0, 0, 9.0], 6, "points up"),
    ("gravity.gravity_W_N", [0, 0], 4, "gravity.gravity_W_N"),
    ("gravity.centre_of_mass_S_m", [4, -2, 90.0], 6, "centre_of_mass"),
    ("gravity.extra", 1, 4, "gravity.extra"),
    ("gates.recent_samples", 2.0, 4, "gates.recent_samples"),
    ("gates.friction_angle_rad", 75.0, 6, "friction_angle"),
    ("gates.region_only", 0, 4, "region_only"),
    ("noise.force_N", [0.1, 0.1, 0.1], 6, "noise.wrench_covariance"),
    ("filters.location.cutoff_Hz", 30.0, 6, "filters.location.sections"),
    ("filters.wrench.q", 0, 6, "filters.wrench.q"),
    ("frames.quaternion_ES", [1.0, 0.1, 0, 0], 6, "quaternion"),
    ("probe.file", "../probe.ply", 6, "probe.file"),
    ("probe.facets", 2_000_000, 8, "facets"),
    ("verification", None, 6, "verified"),
    ("verification.touches", 0, 6, "verification.touches"),
    ("verification.markers", 0, 6, "verification.markers"),
    ("verification.limit_max_m", 0.051, 6, "verification.limit_max_m"),
    ("verification.limit_mean_m", 1.0, 6, "verification.limit_mean_m"),
    ("verification.p95_error_m", 0.0012, 6, "verification.p95_error_m"),
    ("gates.saturation", [29.0, None, None, 1.0, 1.0, 1.0], 6, "gates.saturation[0]"),
    ("limits.max_force_N", 1001.0, 6, "limits.max_force_N"),
    ("limits.max_speed_mps", 250.0, 6, "limits.max_speed_mps"),
    ("sensor.rate_Hz", 940.0, 6, "filters.wrench.rate_Hz"),
    ("provenance.files", {"probe.ply": "0" * 64}, 7, "probe.ply"),
]


@pytest.mark.parametrize(("path", "value", "code", "says"), EDITS)
def test_a_config_that_cannot_be_true_is_refused(
    library: Library,
    bundle: tuple[Path, RuntimeConfig],
    tmp_path: Path,
    path: str,
    value: Any,
    code: int,
    says: str,
) -> None:
    folder = Path(shutil.copytree(bundle[0], tmp_path / "b"))
    edited(folder, path, value)
    handle, error = library.open(folder)
    assert not handle
    assert error.code == code, error.message
    assert says in error.message.decode()


BYTES = [
    ("contactbench.json", lambda d: d[:-10], True, 3),
    (
        "contactbench.json",
        lambda d: d.replace(b'"verified":true', b'"verified":true,"verified":true'),
        True,
        3,
    ),
    ("contactbench.json", lambda d: d.replace(b"t-shape", b"t-sh\xff"), True, 3),
    ("contactbench.json", lambda _: b"[" * 100_000, True, 3),
    ("contactbench.json", lambda d: d.replace(b"0.1", b"NaN", 1), True, 3),
    ("contactbench.json", lambda d: d.replace(b"0.1", b"1e999", 1), True, 3),
    ("contactbench.json", lambda d: d + b" ", False, 7),
    ("contactbench.json", lambda d: d + b"\n", True, 3),
    ("contactbench.json", lambda d: d.replace(b"200.0", b"2e2", 1), True, 3),
    ("contactbench.json", lambda d: d.replace(b":", b": ", 1), True, 3),
    ("ros2.yaml", lambda d: d + b"\n", False, 7),
    ("ft_calib.yaml", lambda d: d.replace(b"bias: [", b"bias: [1", 1), False, 7),
    ("planes.csv", lambda d: d[:-1], False, 7),
    ("probe.ply", lambda d: d + b"\n", True, 8),
    ("probe.ply", lambda d: d[:-1], True, 8),
    ("probe.ply", lambda d: d[:-1] + b"\xff", False, 7),
    ("probe.ply", lambda d: d.replace(b"element vertex ", b"element vertex 9999999", 1), True, 8),
    (
        "probe.ply",
        lambda d: d[: -24 * 5] + b"\x03" + struct.pack("<3i", 0, 1, 2**30) + d[-24 * 5 + 13 :],
        True,
        8,
    ),
    ("probe.ply", lambda d: d[:20], True, 8),
    ("stranger.txt", lambda _: b"", False, 2),
]


@pytest.mark.parametrize(("name", "change", "reseal", "code"), BYTES)
def test_damaged_files_are_refused(
    library: Library,
    bundle: tuple[Path, RuntimeConfig],
    tmp_path: Path,
    name: str,
    change: Any,
    reseal: bool,
    code: int,
) -> None:
    folder = Path(shutil.copytree(bundle[0], tmp_path / "b"))
    file = folder / name
    put(folder, name, change(file.read_bytes() if file.exists() else b""), reseal=reseal)
    handle, error = library.open(folder)
    assert not handle
    assert error.code == code, error.message
    assert error.message.decode().strip()


def test_missing_files_and_links_are_refused(
    library: Library, bundle: tuple[Path, RuntimeConfig], tmp_path: Path
) -> None:
    assert library.open(tmp_path / "nowhere")[1].code == 2
    assert b"unpack it" in library.open(bundle[0] / "probe.ply")[1].message
    folder = Path(shutil.copytree(bundle[0], tmp_path / "b"))
    (folder / "probe.ply").unlink()
    assert b"probe.ply: missing" in library.open(folder)[1].message
    (folder / "probe.ply").symlink_to(bundle[0] / "probe.ply")
    assert b"no plain file" in library.open(folder)[1].message


def samples_file(config: RuntimeConfig, path: Path, count: int) -> None:
    readings, R, times = stream(config, count)
    with_surprises(config, readings)
    with_faults(readings, R, times)
    path.write_bytes(np.column_stack([times, readings, R.reshape(-1, 9)]).tobytes())


def test_updates_allocate_nothing(prefix: Path, bundle: tuple[Path, RuntimeConfig], tmp_path: Path) -> None:
    assert prefix.exists()
    samples_file(bundle[1], tmp_path / "samples", 20_000)
    done = run(BUILD / "contactbench-no_allocation", bundle[0], tmp_path / "samples")
    assert done.returncode == 0, done.stdout + done.stderr
    counts = re.search(
        r", 0 in 20000 updates; of these (\d+) .* (\d+) implausible, (\d+) with two", done.stdout
    )
    assert counts is not None, done.stdout
    assert all(int(count) > 10 for count in counts.groups())


def test_the_example_prints_what_the_runtime_says(prefix: Path, bundle: tuple[Path, RuntimeConfig]) -> None:
    readings, R, times = stream(bundle[1], 1_000)
    lines = [
        " ".join(map(repr, [t, *w, *r.ravel().tolist()]))
        for t, w, r in zip(times.tolist(), readings.tolist(), R, strict=True)
    ]
    done = run(prefix / "bin/contactbench-locate", bundle[0], given="\n".join(lines))
    assert done.returncode == 0, done.stderr
    told = [json.loads(line) for line in done.stdout.splitlines()]
    batch = kernel.Runtime(**kernel_arguments(bundle[1])).update_batch(readings, R, times)
    assert len(told) == len(batch)
    for i, row in enumerate(told):
        assert row["time"] == times[i]
        assert row["force_S_N"] + row["torque_S_Nm"] == batch.wrenches[i].tolist()
        assert row["point_S_m"] == (None if np.isnan(batch.points[i, 0]) else batch.points[i].tolist())
        assert row["accepted"] is bool(batch.accepted[i])
        assert row["confidence"] == batch.confidences[i]
    as_json = json.dumps([*map(float, lines[0].split())])
    again = run(prefix / "bin/contactbench-locate", bundle[0], given=as_json)
    assert json.loads(again.stdout) == told[0]
    wrong = run(prefix / "bin/contactbench-locate", bundle[0], given=lines[0] + "\n1 2 3\n")
    assert wrong.returncode == 1
    assert "line 2" in wrong.stderr


def test_another_project_finds_it(prefix: Path, bundle: tuple[Path, RuntimeConfig], tmp_path: Path) -> None:
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.22)\nproject(consumer LANGUAGES C CXX)\n"
        "find_package(contactbench_runtime 2 REQUIRED)\nadd_executable(consumer main.c)\n"
        "target_link_libraries(consumer PRIVATE contactbench::contactbench_runtime)\n",
        encoding="ascii",
    )
    (tmp_path / "main.c").write_text(
        "#include <contactbench_runtime.h>\n#include <stdio.h>\n"
        "int main(int n, char** v) { cb_error e = CB_ERROR_INIT; cb_info i = {sizeof i};\n"
        "  cb_contact c = CB_CONTACT_INIT; cb_runtime* r = cb_open(v[n - 1], &e);\n"
        "  if (!r || c.size != sizeof c || c.reason != CB_NO_ANSWER || c.accepted) return 1;\n"
        '  cb_describe(r, &i); printf("%d %s\\n", i.facets, i.probe); cb_close(r); return 0; }\n',
        encoding="ascii",
    )
    cmake("-S", tmp_path, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    cmake("--build", tmp_path / "build")
    done = run(tmp_path / "build/consumer", bundle[0])
    assert done.stdout.split() == [str(bundle[1].model.probe.facets), bundle[1].model.probe.name]


@pytest.mark.skipif(shutil.which("pkg-config") is None, reason="no pkg-config")
def test_processes_that_are_not_like_ours_get_the_same_bits() -> None:
    """Rounding, traps, flushing, locales; C99 and C++11; without optimization; -ffast-math stops the build."""
    done = run(ROOT / "packaging/compilers", "g++", "--levels", "0", "--kinds", "static")
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert re.search(r"^g\+\+ -O0 static: [0-9a-f]{16}$", done.stdout, re.MULTILINE), done.stdout


def test_every_folder_of_a_folder_is_tried(
    prefix: Path, bundle: tuple[Path, RuntimeConfig], tmp_path: Path
) -> None:
    assert prefix.exists()
    shutil.copytree(bundle[0], tmp_path / "good")
    (tmp_path / "bad").mkdir()
    lines = run(BUILD / "contactbench-load_all", tmp_path).stdout.splitlines()
    assert lines[0].startswith("bad refused 2 contactbench.json: missing")
    assert lines[1] == "good loaded"


class Sample(ctypes.Structure):
    _fields_ = [
        ("size", ctypes.c_uint32),
        ("flags", ctypes.c_uint32),
        ("wrench", ctypes.c_double * 6),
        ("time", ctypes.c_double),
        ("arrival", ctypes.c_double),
    ]


def test_poses_and_samples_as_they_come_give_what_python_gives(
    library: Library, bundle: tuple[Path, RuntimeConfig]
) -> None:
    """10 Hz of poses, a hung sensor, flags, silence: the same contacts and health words, to the bit."""
    folder, config = bundle
    readings, R, times = stream(config, 4_000)
    readings[1000:1300] = readings[999]
    flags = np.zeros(len(times), dtype=int)
    flags[1500:1520], flags[1600:1620], flags[1700:1720] = 2, 8, 32
    live = kernel.Runtime(**kernel_arguments(config))
    handle, _ = library.open(folder)
    pointer = ctypes.c_void_p
    library.c.cb_pose.argtypes = [pointer, pointer, pointer, ctypes.c_double]
    library.c.cb_check.argtypes = [pointer, ctypes.c_double, pointer]
    library.c.cb_update_sample.argtypes = [pointer, pointer, pointer]
    row = np.zeros(1, CONTACT)
    row["size"] = CONTACT.itemsize
    assert library.c.cb_check(handle, 0.0, row.ctypes.data) == 0
    assert (row["reasons"][0], row["healths"][0]) == (8, 2)  # stale and silent: nothing ever came
    seen = set()
    for i, time in enumerate(times.tolist()):
        if i % 100 == 0 and not 2000 < i < 2500:
            p = np.array([0.1 * np.sin(time), 0.0, 0.2])
            used = library.c.cb_pose(handle, R[i].ctypes.data, p.ctypes.data, time)
            assert (used == 0) is live.pose(R[i], p, time)
        sample = Sample(ctypes.sizeof(Sample), int(flags[i]), tuple(readings[i]), time, time + 0.004)
        assert library.c.cb_update_sample(handle, ctypes.byref(sample), row.ctypes.data) == 0
        expected = live.locate(readings[i], time, time + 0.004, int(flags[i]))
        assert (row["reasons"][0], row["healths"][0]) == (expected.reason, expected.health)
        for name, value in (("points", expected.point), ("filtered_points", expected.filtered_point)):
            if value is not None:
                assert row[name][0].tobytes() == value.tobytes()
        for name, number in (("pose_age", expected.pose_age), ("latency", expected.latency)):
            assert row[name][0] == number or np.isnan([row[name][0], number]).all()
        assert not (row["healths"][0] and row["accepted"][0])
        seen.add(int(row["healths"][0]))
    assert seen == {0, 1, 4, 8, 16}
    assert library.c.cb_check(handle, times[-1] + 0.05, row.ctypes.data) == 0
    assert row["reasons"][0] == -1
    assert library.c.cb_check(handle, times[-1] + 0.2, row.ctypes.data) == 0
    assert (row["reasons"][0], row["healths"][0], row["accepted"][0]) == (8, 2, 0)
    mirror, short = np.diag([1.0, 1.0, -1.0]), Sample(ctypes.sizeof(Sample) - 8)
    assert library.c.cb_pose(handle, mirror.ctypes.data, None, 1e3) == 6
    assert library.c.cb_pose(None, mirror.ctypes.data, None, 1e3) == 1
    assert library.c.cb_update_sample(handle, ctypes.byref(short), row.ctypes.data) == 1
    assert row["reasons"][0] == -1
    library.c.cb_close(handle)


def test_structs_may_grow_and_a_caller_with_a_longer_one_keeps_its_end(
    library: Library, bundle: tuple[Path, RuntimeConfig]
) -> None:
    handle, _ = library.open(bundle[0])
    numbers, level = np.zeros(6), np.eye(3)
    longer = np.full(CONTACT.itemsize + 64, 0xA5, dtype=np.uint8)
    row = longer[: CONTACT.itemsize].view(CONTACT)
    row["size"] = len(longer)
    given = (handle, numbers.ctypes.data, level.ctypes.data, 0.0, longer.ctypes.data)
    assert library.c.cb_update(*given) == 0
    assert row["size"][0] == len(longer)
    assert row["times"][0] == 0.0
    assert (longer[CONTACT.itemsize :] == 0xA5).all()
    row["size"], longer[CONTACT_2_0:] = CONTACT_2_0, 0xA5
    assert library.c.cb_update(*given[:3], 1.0, given[4]) == 0
    assert row["times"][0] == 1.0
    assert (longer[CONTACT_2_0:] == 0xA5).all()
    row["size"] = CONTACT_2_0 - 1  # smaller than it ever was
    assert library.c.cb_update(*given) == 1
    library.c.cb_close(handle)


@pytest.mark.skipif(shutil.which("readelf") is None, reason="no readelf")
def test_nothing_but_the_interface_is_exported_and_it_is_bound_at_once(prefix: Path) -> None:
    file = next(prefix.glob("lib*/libcontactbench_runtime.so"))
    symbols = run("readelf", "--wide", "--dyn-syms", file).stdout.splitlines()
    exported = {line.split()[7] for line in symbols if len(line.split()) > 7 and line.split()[6].isdigit()}
    assert exported
    assert all(name.startswith("cb_") for name in exported)
    assert "NOW" in run("readelf", "--dynamic", file).stdout
