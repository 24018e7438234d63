"""Test vectors in a bundle: made at the export, replayed by Python and C, and worth something."""

import ctypes
import json
import re
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.bundle_mutations import seal
from config.runtime.bundles import example, of_version_2, of_version_3
from native import built
from terminal import invoke

from contactbench.pipeline.config.runtime import ConfigError, RuntimeConfig
from contactbench.pipeline.config.runtime.self_test import replay, with_self_test

FILE, CONFIG = "self_test.csv", "contactbench.json"
OK, SELF_TEST = 0, 11


@pytest.fixture(scope="module")
def files() -> dict[str, bytes]:
    return example(300, clamped=True).encoded()


def table(files: dict[str, bytes]) -> list[list[str]]:
    return [line.split(",") for line in files[FILE].decode().splitlines()]


def samples(files: dict[str, bytes]) -> list[dict[str, str]]:
    rows = table(files)
    return [dict(zip(rows[1], row, strict=True)) for row in rows[2:] if row[0] == "sample"]


def with_file(files: dict[str, bytes], data: bytes) -> dict[str, bytes]:
    return seal({**files, FILE: data})


def with_cell(
    files: dict[str, bytes], column: str, wanted: Callable[[dict[str, str]], bool], value: str
) -> Any:
    """Return a bundle with one cell changed in the first sample that is `wanted`, and its line."""
    rows = table(files)
    for number, row in enumerate(rows):
        if row[0] == "sample" and number > 1 and wanted(dict(zip(rows[1], row, strict=True))):
            row[rows[1].index(column)] = value
            return with_file(files, ("\n".join(map(",".join, rows)) + "\n").encode()), number + 1
    raise AssertionError(column)


def with_field(files: dict[str, bytes], path: str, value: object) -> dict[str, bytes]:
    content = json.loads(files[CONFIG])
    part = content
    *outer, last = path.split(".")
    for name in outer:
        part = part[name]
    assert part[last] != value
    part[last] = value
    return seal({**files, CONFIG: json.dumps(content).encode()})


# Each is a bundle that loads.
FIELDS = {
    "gates.min_force_N": 0.45,
    "gates.friction_angle_rad": 0.8,
    "gates.implausible_misfit": 9.0,
    "gates.rival_odds": 60.0,
    "gates.first_odds": 2.0,
    "gates.follow_odds": 10.0,
    "gates.ambiguity_distance_m": 0.012,
    "gates.follow_distance_m": 0.001,
    "gates.recent_samples": 4,
    "gates.max_age_s": 0.02,
    "gates.region_only": True,
    "gates.accept_by_region": False,
    "touch.torsion_arm_m": 0.0021,
    "touch.mesh_deviation_m": 6e-5,
    "touch.mesh_curved": False,
    "streams.pose_ahead_s": 0.05,
    "streams.pose_gap_s": 0.01,
    "streams.frozen_probability": 1e-3,
    "streams.motion": None,
    "filters.location": None,
    "frames.quaternion_ES": [0.5, 0.5, 0.5, 0.5],
}


def test_the_export_makes_them(files: dict[str, bytes]) -> None:
    assert json.loads(files[CONFIG])["self_test"] == {"file": FILE, "samples": 300}
    assert FILE in json.loads(files[CONFIG])["provenance"]["files"]
    assert len(files[FILE]) < 150_000
    rows = samples(files)
    assert len(rows) == 300
    told = Counter(row["reason"] for row in rows)
    assert {
        "ok", "vertex", "ambiguous", "low_force", "tangential", "saturated", "stale", "not_finite", "by_region",
        "implausible", "two_touches", "unhealthy",
    } <= set(told), told  # fmt: skip
    assert {"0", "1", "4", "8", "16"} <= {row["health"] for row in rows}
    assert 100 < sum(row["accepted"] == "1" for row in rows) < 250
    ages = [float(row["pose_age_s"]) for row in rows if row["pose_age_s"]]
    assert min(ages) >= 0
    assert max(ages) > 0.15  # too old
    assert with_self_test(example(300, clamped=True)).encoded() == files


def test_they_are_replayed(files: dict[str, bytes]) -> None:
    assert replay(RuntimeConfig.from_files(files), "bundle") == 300


def test_any_other_answer_is_refused(files: dict[str, bytes]) -> None:
    for column in table(files)[1][10:]:
        found = next(row for row in samples(files) if row[column] and row["reason"] != "stale")
        told = found[column]
        if column in ("reason", "accepted", "health"):
            value = {"reason": "tangential", "accepted": "7", "health": "3"}[column]
        else:
            value = repr(float(told) + 1e-8 * max(1.0, abs(float(told))))
        mutant, line = with_cell(files, column, lambda row, found=found: row == found, value)
        with pytest.raises(
            ConfigError, match=rf"^bundle: {FILE}: line {line}: {column} is {value}, but this runtime"
        ):
            replay(RuntimeConfig.from_files(mutant), "bundle")
        if column != "reason":  # something where there is nothing, and the other way round
            with pytest.raises(ConfigError, match=f"line {line}: {column} is empty, but this runtime says"):
                replay(
                    RuntimeConfig.from_files(
                        with_cell(files, column, lambda row, found=found: row == found, "")[0]
                    ),
                    "bundle",
                )


def test_rounding_is_not_refused(files: dict[str, bytes]) -> None:
    found = next(row for row in samples(files) if row["point_x_m"])
    value = repr(float(found["point_x_m"]) + 5e-10)
    mutant, _ = with_cell(files, "point_x_m", lambda row: row == found, value)
    assert replay(RuntimeConfig.from_files(mutant), "bundle") == 300


@pytest.fixture(scope="module")
def refusals(files: dict[str, bytes]) -> dict[str, str]:
    """What Python says of a bundle in which one field was edited, by the field."""
    found = {}
    for path, value in FIELDS.items():
        config = RuntimeConfig.from_files(with_field(files, path, value))
        with pytest.raises(ConfigError) as refused:
            replay(config, "bundle")
        found[path] = str(refused.value)
    return found


def test_a_bundle_that_was_edited_is_refused(refusals: dict[str, str]) -> None:
    for path, said in refusals.items():
        assert re.match(rf"bundle: {FILE}: line \d+: .* but this runtime says", said), path
        assert re.search(r": \d+ of 300 answers differ, and contacts moved by up to \d\S* mm", said), path


def test_it_is_said_how_far_contacts_moved(files: dict[str, bytes]) -> None:
    found = next(row for row in samples(files) if row["point_x_m"])
    value = repr(float(found["point_x_m"]) + 0.002)
    mutant, _ = with_cell(files, "point_x_m", lambda row: row == found, value)
    with pytest.raises(ConfigError, match="1 of 300 answers differ, and contacts moved by up to 2 mm"):
        replay(RuntimeConfig.from_files(mutant), "bundle")


def damaged(files: dict[str, bytes]) -> Iterator[tuple[str, dict[str, bytes]]]:
    data = files[FILE]
    lines = data.split(b"\n")
    yield "the first two lines", with_file(files, data.replace(b"pose,time_s", b"pose,time", 1))
    yield "the first two lines", with_file(files, b"\n")
    yield "larger than 4 MiB", with_file(files, data + b"x" * 2**22)
    yield "no end", with_file(files, data[:-1])
    yield "neither a pose nor a sample", with_file(files, b"\n".join([*lines[:2], b"", *lines[2:]]))
    yield "neither a pose nor a sample", with_file(files, data.replace(b"\nsample,1", b"\nsample,1,1", 1))
    yield "neither a pose nor a sample", with_file(files, data.replace(b"\npose,1", b"\nPose,1", 1))
    wrong = [*b"nan 1e400 01.0 1_0.0 1.00 +1.0 0x1p3 1".split(), b" 1.0", b"1.0\r", b"\xc2\xb2"]
    for number in wrong:
        yield (
            "line 3|not ASCII",
            with_file(files, b"\n".join([*lines[:2], b"pose," + number + b",0.0" * 12, *lines[2:]])),
        )
    for flags in (b"256", b"-1", b"1.0", b"00", b"", b"9" * 400):
        row = lines[2].split(b",")
        yield (
            "line 3",
            with_file(files, b"\n".join([*lines[:2], b",".join([*row[:3], flags, *row[4:]]), *lines[3:]])),
        )
    last = max(number for number, line in enumerate(lines) if line.startswith(b"sample"))
    yield "samples", with_file(files, b"\n".join([*lines[:last], *lines[last + 1 :]]))
    yield "samples|line", with_file(files, data + lines[last] + b"\n")


def test_a_file_that_is_no_self_test_is_refused(files: dict[str, bytes]) -> None:
    for told, mutant in damaged(files):
        with pytest.raises(ConfigError, match=told) as refused:
            replay(RuntimeConfig.from_files(mutant), "bundle")
        assert FILE in str(refused.value)


@pytest.mark.parametrize(
    "value", [None, {"file": "probe.ply", "samples": 300}, {"file": "x.csv", "samples": 300}]
)
def test_config_and_files_must_agree(files: dict[str, bytes], value: object) -> None:
    with pytest.raises(ConfigError, match=r"self_test\.file"):
        RuntimeConfig.from_files(with_field(files, "self_test", value))


def test_the_command_says_it(files: dict[str, bytes], tmp_path: Path) -> None:
    def check(content: dict[str, bytes], *options: str) -> Any:
        folder = tmp_path / str(len(list(tmp_path.iterdir())))
        folder.mkdir()
        for name, data in content.items():
            (folder / name).write_bytes(data)
        return invoke("bundle", "check", folder, *options)

    good = check(files, "--json")
    assert good.exit_code == 0
    assert json.loads(good.stdout)["replayed"] == 300
    assert "Test vectors: 300 samples" in good.output
    edited = check(with_field(files, "gates.min_force_N", 0.45))
    assert edited.exit_code == 2
    assert f"{FILE}: line" in edited.output.replace("\n", "")
    old = check(of_version_2(example(300).encoded()), "--json")
    assert json.loads(old.stdout)["replayed"] is None
    assert "No test vectors" in old.output


# ---- the C library -----------------------------------------------------------------------------


class Error(ctypes.Structure):
    _fields_ = (("size", ctypes.c_uint32), ("code", ctypes.c_int32), ("message", ctypes.c_char * 512))


@pytest.fixture(scope="module")
def selftest(tmp_path_factory: pytest.TempPathFactory) -> Callable[[dict[str, bytes]], tuple[int, str]]:
    library = ctypes.CDLL(str(built() / "libcontactbench_runtime.so"))

    def call(content: dict[str, bytes]) -> tuple[int, str]:
        folder = tmp_path_factory.mktemp("bundle")
        for name, data in content.items():
            (folder / name).write_bytes(data)
        error = Error(ctypes.sizeof(Error))
        code = library.cb_selftest(str(folder).encode(), ctypes.byref(error))
        assert code == error.code
        return code, error.message.decode()

    return call


def test_c_replays_them(
    files: dict[str, bytes], refusals: dict[str, str], selftest: Callable[[dict[str, bytes]], tuple[int, str]]
) -> None:
    assert selftest(files) == (OK, "")
    for path, value in FIELDS.items():
        code, message = selftest(with_field(files, path, value))
        assert code == SELF_TEST, (path, message)
        # The same line and cell; Python's number may end otherwise.
        assert message.split(" is ")[0] in refusals[path], (message, refusals[path])


def random_downs(count: int) -> list[tuple[float, ...]]:
    rng = np.random.default_rng(3)
    some = [(0, 0, 1), (0, 1, 0), (-1, 0, 0), (0.05, 0, 1), (0.2, 0, -1), *rng.normal(size=(count, 3))]
    return [tuple((np.array(down) / np.linalg.norm(down)).tolist()) for down in some]


@pytest.mark.parametrize("down", random_downs(1), ids=lambda down: ",".join(f"{each:.2f}" for each in down))
def test_a_robot_that_does_not_stand_is_as_good_as_one_that_does(
    down: tuple[float, float, float], selftest: Callable[[dict[str, bytes]], tuple[int, str]]
) -> None:
    content = example(300, clamped=True, down_W=down).encoded()
    found = RuntimeConfig.from_files(content)
    assert found.model.verified
    assert found.model.world.down_W == pytest.approx(down, abs=1e-15)
    assert replay(found, "bundle") == 300
    assert selftest(content) == (OK, "")
    # With the sign of the sensor turned over, neither loader takes it.
    over = with_field(content, "world.down_W", [-each for each in found.model.world.down_W])
    with pytest.raises(ConfigError, match="points up"):
        RuntimeConfig.from_files(over)
    code, message = selftest(over)
    assert (code, "points up" in message) == (6, True), message


def test_c_reads_version_3(
    files: dict[str, bytes], selftest: Callable[[dict[str, bytes]], tuple[int, str]]
) -> None:
    old = of_version_3(files)
    assert selftest(old) == (OK, "")
    assert replay(RuntimeConfig.from_files(old), "bundle") == 300
    tilted = [5.8, 0.0, -2.1]  # 70 degrees from down
    assert "more than 60 degrees" in selftest(with_field(files, "gravity.gravity_W_N", tilted))[1]
    assert "noise.wrench_covariance" in selftest(with_field(old, "gravity.gravity_W_N", tilted))[1]


def test_c_refuses_what_python_refuses(
    files: dict[str, bytes], selftest: Callable[[dict[str, bytes]], tuple[int, str]]
) -> None:
    for _, mutant in damaged(files):
        code, message = selftest(mutant)
        assert code == SELF_TEST, message
        assert message.startswith(FILE)
    assert selftest(of_version_2(example(300).encoded()))[0] == SELF_TEST
    assert selftest(with_field(files, "self_test", None))[0] == 6
    assert selftest(with_field(files, "self_test", {"file": "probe.ply", "samples": 300}))[0] == 6
