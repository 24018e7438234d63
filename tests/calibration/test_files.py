import copy
import hashlib
import json
import re
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from contactbench import __version__
from contactbench.pipeline.calibration import (
    Calibration,
    ContactTask,
    GravityModel,
    Level,
    PoseNoise,
    PoseSample,
    calibrate,
)
from contactbench.pipeline.calibration.files import calibration_file as files_module
from contactbench.pipeline.calibration.files.calibration_file import (
    CalibrationFileError,
    Mount,
    SourceFile,
    creation_time,
    load_calibration,
    load_record,
    save_calibration,
)
from contactbench.pipeline.errors import InputError

WHEN = datetime(2026, 3, 1, 12, 30, 15, 999, tzinfo=timezone(timedelta(hours=2)))


def poses(kind: str = "many", seed: int = 0) -> list[PoseSample]:
    rng = np.random.default_rng(seed)
    count = 3 if kind == "few" else 10
    R_WS = Rotation.random(count, rng=rng).as_matrix()
    if kind == "yaw":
        R_WS = Rotation.from_rotvec(np.outer(np.linspace(0, 2, count), [0, 0, 1])).as_matrix()
    weight = [0, 0, -1e-9] if kind == "weightless" else [0.1, -0.2, -6]
    model = GravityModel(weight, [1, 2, 3], [0.01, 0, 0.06], [0.1, 0.2, 0.3])
    wrenches = model.predict(R_WS) + rng.normal(size=(count, 6)) * np.repeat([0.05, 0.0014], 3)
    if kind == "many":
        wrenches[3, 1] += 4
    return [
        PoseSample(
            R,
            wrench[:3],
            wrench[3:],
            count=200 + index,
            force_sd=[0.1, 0.2, 0.3] if index % 2 else None,
            torque_sd=[0.01, 0.02, 0.03] if index % 2 else None,
            temperature=20.5 + index if index % 3 else None,
            time=0.1 * index if index % 3 else None,
            name=f'pose "{index}", Prüfstand ☃' if index else "",
        )
        for index, (R, wrench) in enumerate(zip(R_WS, wrenches, strict=True))
    ]


TASK = ContactTask([0.01, 0.02, 0.12], [0.1, 0.2, 0.7], 12.0, 0.5, 0.4)
CASES: dict[str, dict[str, Any]] = {
    "many": {},
    "few": {"task": TASK},
    "yaw": {},
    "weightless": {"noise": PoseNoise(0.05, 0.0014)},
    "known": {"noise": PoseNoise(np.array([0.01, 0.02, 0.03]), 0.001), "task": TASK},
}


@pytest.fixture(scope="module", params=CASES)
def calibration(request) -> Calibration:
    return calibrate(poses(request.param), **CASES[request.param])


@pytest.fixture(scope="module")
def good() -> Calibration:
    return calibrate(poses())


def same(found: Any, expected: Any, where: str = "calibration") -> None:
    """Compare every field, to the last bit."""
    if is_dataclass(expected):
        assert type(found) is type(expected), where
        for field in fields(expected):
            same(getattr(found, field.name), getattr(expected, field.name), f"{where}.{field.name}")
    elif isinstance(expected, tuple):
        assert len(found) == len(expected), where
        for index, (one, other) in enumerate(zip(found, expected, strict=True)):
            same(one, other, f"{where}[{index}]")
    elif isinstance(expected, np.ndarray):
        assert (found.shape, found.dtype) == (expected.shape, expected.dtype), where
        np.testing.assert_array_equal(found, expected, where)
    else:
        assert found == expected, where


def saved(calibration: Calibration, folder: Path, **options: Any) -> Path:
    file = folder / "calibration.json"
    save_calibration(calibration, file, **options)
    return file


# ---- there and back ------------------------------------------------------------------------------


def test_every_field_comes_back(calibration, tmp_path):
    found = load_calibration(saved(calibration, tmp_path))
    same(found, calibration)
    assert found.ellipsoid() == calibration.ellipsoid()
    assert found.sigmas == calibration.sigmas


def test_the_cases_differ():
    results = {name: calibrate(poses(name), **options) for name, options in CASES.items()}
    assert results["many"].rejected
    assert results["many"].verdict.level is not Level.REFUSE
    assert results["yaw"].verdict.level is Level.REFUSE
    assert np.isinf(results["yaw"].condition)
    assert not results["weightless"].observability.weighs
    assert np.isfinite(results["known"].noise.freedom).all()  # given, and doubted
    assert not results["known"].plausible


def test_a_file_of_version_1_still_loads(tmp_path):
    """What version 1 widened by the scatter beside its noise, version 2 has in the noise."""
    doubted = calibrate(poses("known"), **CASES["known"])
    content = json.loads(saved(doubted, tmp_path).read_text(encoding="utf-8"))
    for field in ("noise_factor", "causes", "drift", "model_error_m", "down_W"):
        del content[field]
    del content["noise"]["orientation_rad"]
    for pose in content["poses"]:
        del pose["offset_force_N"], pose["offset_torque_Nm"]
    file = tmp_path / "old.json"
    file.write_text(json.dumps({**content, "version": 1, "scatter": 4.0}), encoding="utf-8")
    old = load_calibration(file)
    assert old.noise_factor == (2.0, 2.0)
    assert np.allclose(old.noise.sigmas, 2 * doubted.noise.sigmas)
    assert old.down_W.tolist() == [0, 0, -1]
    assert not old.offsets.any()
    assert load_calibration(saved(old, tmp_path)).model.vector.tolist() == doubted.model.vector.tolist()


def test_saving_again_gives_the_same_bytes(calibration, tmp_path):
    file = saved(calibration, tmp_path, created=WHEN, source=SourceFile("poses.csv", "0" * 64))
    data = file.read_bytes()
    record = load_record(file)
    assert (
        saved(record.calibration, tmp_path, created=record.created, source=record.source).read_bytes() == data
    )
    assert list(tmp_path.iterdir()) == [file]


def test_what_the_file_says(good, tmp_path):
    source = tmp_path / "poses.csv"
    source.write_bytes(b"some poses")
    file = saved(good, tmp_path, created=WHEN, source=source)
    text = file.read_text(encoding="utf-8")
    assert text.endswith("\n}\n")
    assert text.startswith('{\n  "schema": "contactbench.calibration",\n  "version": 2,\n')
    assert "Prüfstand ☃" in text
    content = json.loads(text)
    assert content["created"] == "2026-03-01T10:30:15Z"
    assert content["source"] == {"name": "poses.csv", "sha256": hashlib.sha256(b"some poses").hexdigest()}
    assert content["tool"] == f"contactbench {__version__}"
    assert content["mass_kg"] == good.mass
    assert content["gravity_W_N"] == good.gravity_W.tolist()
    assert content["parameters"][0] == "gravity_W_x"
    assert np.shape(content["covariance"]) == (12, 12)
    assert content["rejected"][0]["index"] == 3
    assert content["mount"] is None
    assert str(tmp_path) not in text
    record = load_record(file)
    assert record.created == WHEN.replace(microsecond=0)
    assert record.source == SourceFile.of(source)
    assert record.tool == f"contactbench {__version__}"
    assert record.mount is None


def test_infinite_becomes_null(tmp_path):
    content = json.loads(saved(calibrate(poses("yaw")), tmp_path).read_text(encoding="utf-8"))
    assert content["observability"]["condition"] is None
    assert content["observability"]["force_condition"] is None
    known = calibrate(poses(), PoseNoise(0.05, 0.002))
    assert json.loads(saved(known, tmp_path).read_text(encoding="utf-8"))["noise"]["force_freedom"] is None


def test_the_mount_comes_back(good, tmp_path):
    turn = Rotation.from_euler("xyz", [0.1, 0.2, 0.3])
    mount = Mount(turn.as_quat()[[3, 0, 1, 2]], np.diag([1e-4, 2e-4, 3e-4]))
    record = load_record(saved(good, tmp_path, mount=mount))
    assert record.mount is not None
    same(record.mount, mount)
    np.testing.assert_allclose(record.mount.R_SE, turn.as_matrix(), atol=1e-15)
    with pytest.raises(CalibrationFileError, match=r"mount\.quaternion_SE is not of length 1"):
        saved(good, tmp_path, mount=Mount(np.array([1.0, 1, 0, 0]), np.eye(3)))
    with pytest.raises(CalibrationFileError, match=r"mount\.covariance_rad2: the matrix is not positive"):
        saved(good, tmp_path, mount=Mount(np.array([1.0, 0, 0, 0]), -np.eye(3)))


def test_creation_time(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    assert creation_time() == datetime(1970, 1, 2, tzinfo=UTC)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    with pytest.raises(InputError, match="SOURCE_DATE_EPOCH is 'yesterday': set it to whole seconds"):
        creation_time()
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "9" * 30)
    with pytest.raises(InputError, match="SOURCE_DATE_EPOCH"):
        creation_time()
    monkeypatch.delenv("SOURCE_DATE_EPOCH")
    assert abs(datetime.now(UTC) - creation_time()) < timedelta(minutes=1)


# ---- what cannot be saved ------------------------------------------------------------------------


def test_what_cannot_be_saved(good, tmp_path):
    file = tmp_path / "calibration.json"
    file.write_text("old", encoding="utf-8")
    first = good.poses[0]
    named = PoseSample(first.R_WS, first.force, first.torque, name="half \ud800")
    for wrong, message in (
        (replace(good, contact_error=float("nan")), "this calibration cannot be written"),
        (replace(good, contact_error=-1.0), "contact_error_m is too small: use the file"),
        (replace(good, poses=(named, *good.poses[1:])), "this calibration cannot be written"),
        (replace(good, poses=good.poses[::-1]), r"poses\[\d\]: the residual is not the reading minus"),
    ):
        with pytest.raises(CalibrationFileError, match=message):
            save_calibration(wrong, file)
    with pytest.raises(CalibrationFileError, match="created has no time zone"):
        save_calibration(good, file, created=datetime(2026, 1, 1))
    with pytest.raises(CalibrationFileError, match=r"nowhere\.csv: the file cannot be read"):
        save_calibration(good, file, source=tmp_path / "nowhere.csv")
    assert file.read_text(encoding="utf-8") == "old"
    with pytest.raises(CalibrationFileError, match=r"the calibration cannot be written .*: choose a folder"):
        save_calibration(good, tmp_path / "nowhere" / "calibration.json")
    assert list(tmp_path.iterdir()) == [file]


# ---- what is refused -----------------------------------------------------------------------------


@pytest.fixture
def content(good, tmp_path) -> dict[str, Any]:
    return json.loads(saved(good, tmp_path).read_text(encoding="utf-8"))  # type: ignore[no-any-return]


def refusal(content: Any, folder: Path) -> str:
    file = folder / "changed.json"
    file.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    with pytest.raises(CalibrationFileError) as caught:
        load_calibration(file)
    message = str(caught.value)
    assert message.startswith(f"{file}: ")
    assert len(message.splitlines()) == 1
    return message.removeprefix(f"{file}: ")


def put(content: dict[str, Any], path: str, value: Any) -> dict[str, Any]:
    """Return a copy in which the field at `path`, such as poses[0].force_N[1], is `value`; None deletes it."""
    content = copy.deepcopy(content)
    *way, last = [int(step) if step.isdigit() else step for step in re.findall(r"\w+", path)]
    place: Any = content
    for step in way:
        place = place[step]
    place[last] = value
    return content


NOT = "should be a valid"
WRONG = {
    "null-mass": ("mass_kg", None, f"mass_kg {NOT} number: use the file as contactbench wrote it"),
    "text": ("poses[2].force_N[1]", "1.0", f"poses[2].force_N[1] {NOT} number"),
    "bool": ("scatter", True, f"scatter {NOT} number"),
    "number-for-bool": ("plausible", 1, f"plausible {NOT} boolean"),
    "part": ("poses[1].count", 1.5, f"poses[1].count {NOT} integer"),
    "short": ("gravity_W_N", [0.0, 0.0], "gravity_W_N list should have at least 3 items"),
    "long": ("covariance[11]", [0.0] * 13, "covariance[11] list should have at most 12 items"),
    "object": ("task", [], "task should be an object"),
    "level": ("verdict.level", "great", "verdict.level should be 'good', 'usable' or 'refuse'"),
    "nan": ("noise.force_N[0]", float("nan"), "noise.force_N[0] is not a finite number"),
    "inf": ("task.force_N", float("-inf"), "task.force_N is not a finite number"),
    "huge": ("poses[0].torque_Nm[2]", 1e200, "poses[0].torque_Nm[2] is too large"),
    "extra": ("poses[4].colour", "red", "poses[4].colour is not a known field"),
    "mass": ("mass_kg", 0.5, "mass_kg is 0.5, but gravity_W_N over 9.80665 m/s² is 0.6"),
    "gravity": ("gravity_W_N", [0.0, 0.0, -6.0], "mass_kg is 0.6"),
    "bias": ("force_bias_N[0]", 0.0, "poses[0]: the residual is not the reading minus the prediction"),
    "reading": ("poses[7].torque_Nm[1]", 0.0, "poses[7]: the residual is not"),
    "asymmetric": ("covariance[0][1]", 1.0, "covariance: the matrix is not symmetric"),
    "indefinite": ("covariance[5][5]", -1.0, "covariance: the matrix is not"),
    "no-rotation": (
        "poses[1].R_WS[0]",
        [0.0, 0.0, 0.0],
        'poses[1]: pose "1", Prüfstand ☃: R_WS is not a rotation',
    ),
    "noise": ("noise.torque_Nm", [0.1, 0.2], "noise: PoseNoise.torque: give one or three finite numbers"),
    "no-noise": (
        "noise.torque_Nm",
        [0.0],
        "noise: PoseNoise.torque: give one or three finite numbers above 0",
    ),
    "task": (
        "task.normal_S",
        [0.0, 0.0, 0.0],
        "task: ContactTask.normal: give three numbers that are not all 0",
    ),
    "parameters": ("parameters[3]", "bias", "parameters does not fit the other fields"),
    "rank": ("observability.rank", 11, "observability.rank does not fit the other fields"),
    "condition": ("observability.condition", None, "observability.condition does not fit the other fields"),
    "rejected": ("rejected[0].index", 10, "rejected does not fit the other fields"),
    "sha": ("source", {"name": "a", "sha256": "12"}, "source.sha256 string should match pattern"),
    "created": ("created", "2026-02-31T00:00:00Z", "created is not a time (day is out of range"),
    "zone": ("created", "2026-02-01T00:00:00+01:00", "created string should match pattern"),
    "poses": ("poses", [], "poses list should have at least 3 items"),
    "schema": (
        "schema",
        "contactbench.session",
        "the schema is 'contactbench.session'; expected 'contactbench.calib",
    ),
    "no-schema": (
        "schema",
        1,
        "the schema is missing; expected 'contactbench.calibration': choose a calibration file",
    ),
    "newer": ("version", 3, "written by a newer contactbench (version above 2): update contact"),
    "older": ("version", 0, "version should be 2"),
    "version": ("version", "2", "version should be 2"),
}


@pytest.mark.parametrize("case", WRONG)
def test_refused(content, tmp_path, case):
    path, value, message = WRONG[case]
    assert refusal(put(content, path, value), tmp_path).startswith(message)


def keys(place: Any, path: str = "") -> Iterator[str]:
    if isinstance(place, dict):
        for key, value in place.items():
            yield from (f"{path}.{key}", *keys(value, f"{path}.{key}"))
    elif isinstance(place, list) and place:
        yield from keys(place[0], f"{path}[0]")


def test_no_field_may_be_missing(content, tmp_path):
    content["mount"] = {"quaternion_SE": [1, 0, 0, 0], "covariance_rad2": np.eye(3).tolist()}
    content["source"] = {"name": "a", "sha256": "0" * 64}
    paths = [path[1:] for path in keys(content)]
    assert len(paths) > 60
    for path in set(paths) - {"mount", "schema"}:
        changed = copy.deepcopy(content)
        *way, last = [int(step) if step.isdigit() else step for step in re.findall(r"\w+", path)]
        place: Any = changed
        for step in way:
            place = place[step]
        del place[last]
        assert refusal(changed, tmp_path).startswith(f"{path} is missing: use the file as")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not valid JSON (EOF"),
        ("{", "not valid JSON"),
        ("[" * 100_000, "not valid JSON (recursion limit exceeded"),
        ("t,fx,fy\n1,2,3\n", "not valid JSON"),
        ("[]", "the schema is missing"),
        ("null", "the schema is missing"),
        ('{"schema": "contactbench.calibration", "version": 1' + "0" * 4000 + "}", "written by a newer"),
        ('{"schema": "contactbench.calibration", "version": 1}', "tool is missing"),
    ],
    ids=["empty", "cut", "deep", "csv", "list", "null", "far-future", "nearly-empty"],
)
def test_what_is_no_calibration(tmp_path, text, message):
    assert refusal(text, tmp_path).startswith(message)


def test_files_that_cannot_be_read(tmp_path, monkeypatch, good):
    with pytest.raises(CalibrationFileError, match=r"nowhere\.json: there is no such file: check the path"):
        load_calibration(tmp_path / "nowhere.json")
    with pytest.raises(CalibrationFileError, match=r"the file cannot be read .*: check the path"):
        load_calibration(tmp_path)
    with pytest.raises(CalibrationFileError, match="the file cannot be read"):
        load_calibration(Path("a\0b"))
    (tmp_path / "binary.json").write_bytes(bytes(range(256)))
    with pytest.raises(CalibrationFileError, match="not valid JSON"):
        load_calibration(tmp_path / "binary.json")
    file = saved(good, tmp_path)
    monkeypatch.setattr(files_module, "SIZE_LIMIT", 2**20 - 1)
    file.write_bytes(file.read_bytes() + b" " * 2**20)
    with pytest.raises(CalibrationFileError, match="larger than 0 MiB: choose a calibration file"):
        load_calibration(file)


# ---- anything at all -----------------------------------------------------------------------------


def load_or_refuse(data: bytes, file: Path) -> bool:
    """Load changed bytes: refused, or a calibration that is whole, finite, and can be saved again."""
    file.write_bytes(data)
    try:
        found = load_calibration(file)
    except CalibrationFileError:
        return False
    assert np.isfinite(found.model.vector).all()
    assert np.isfinite(found.residuals).all()
    assert np.linalg.eigvalsh(found.covariance)[0] > -1e-6 * np.trace(found.covariance)
    save_calibration(found, file)
    same(load_calibration(file), found)
    return True


@pytest.mark.parametrize("seed", range(2))
def test_flipped_bits(good, tmp_path, seed):
    file = saved(good, tmp_path, created=WHEN)
    data, chance = file.read_bytes(), np.random.default_rng(seed)
    loaded = 0
    for _ in range(40):
        changed = bytearray(data)
        for _ in range(chance.choice([1, 1, 1, 3, 20])):
            changed[chance.integers(len(data))] ^= 1 << int(chance.integers(8))
        loaded += load_or_refuse(bytes(changed), file)
    assert loaded < 27


VALUES: list[Any] = [
    *(None, True, False, 0, -1, 1, 0.5, -0.0, "", "good", "\ud800", [], {}, [[]], [None], {"": {}}),
    *(1e308, -1e308, 1e99, -1e99, 5e-324, 2**63, -(2**70), 10**400, float("nan"), float("inf"), [1e99] * 3),
]


def places(place: Any) -> Iterator[tuple[Any, Any]]:
    """Yield (container, key) of everything inside."""
    inside = place.items() if isinstance(place, dict) else enumerate(place) if isinstance(place, list) else ()
    for key, value in inside:
        yield place, key
        yield from places(value)


def pick(chance: np.random.Generator, values: list[Any]) -> Any:
    return values[chance.integers(len(values))]


@pytest.mark.parametrize("seed", range(2))
def test_swapped_values(content, tmp_path, seed):
    chance = np.random.default_rng(seed)
    for _ in range(40):
        changed = copy.deepcopy(content)
        for _ in range(chance.choice([1, 1, 2, 5])):
            place, key = pick(chance, list(places(changed)))
            what = chance.integers(4)
            if what == 0:
                del place[key]
            elif what == 1:
                other, name = pick(chance, list(places(changed)))
                place[key] = copy.deepcopy(other[name])
            else:
                place[key] = pick(chance, VALUES)
        load_or_refuse(json.dumps(changed).encode(), tmp_path / "changed.json")


@pytest.mark.parametrize("value", VALUES, ids=[repr(value)[:20] for value in VALUES])
def test_every_field_with_a_strange_value(content, tmp_path, value):
    for path in {path[1:] for path in keys(content)}:
        load_or_refuse(json.dumps(put(content, path, value)).encode(), tmp_path / "changed.json")


@pytest.fixture(scope="module")
def data(good, tmp_path_factory) -> bytes:
    return saved(good, tmp_path_factory.mktemp("good")).read_bytes()


@settings(max_examples=60, deadline=None)
@given(start=st.integers(0, 40_000), stop=st.integers(0, 40_000), middle=st.binary(max_size=30))
def test_cut_and_pasted(tmp_path_factory, data, start, stop, middle):
    file = tmp_path_factory.getbasetemp() / "pasted.json"
    load_or_refuse(data[:start] + middle + data[stop:], file)
