"""``contactbench run`` and the C++ example: the same lines, byte for byte."""

import json
from collections import Counter
from dataclasses import replace
from pathlib import Path

import native
import numpy as np
import pytest
from config.runtime import bundles
from config.runtime.bundles import example_bundle
from runtime.runtime_recordings import BEGIN, flange, input_lines, record, samples, wrench
from scipy.spatial.transform import Rotation
from terminal import invoke

from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.config.runtime.self_test import with_self_test

pytestmark = native.needs_cmake


def run(*command: object, given: str = "") -> str:
    done = native.run(*command, given=given)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


@pytest.fixture(scope="module")
def example() -> Path:
    return native.built() / "contactbench-locate"


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, RuntimeConfig]:
    folder = tmp_path_factory.mktemp("bundles") / "bundle"
    return folder, example_bundle(folder)


def test_a_recording_gives_the_same_bytes(
    example: Path, bundle: tuple[Path, RuntimeConfig], tmp_path: Path
) -> None:
    folder, config = bundle
    mixed = samples(config, 2_000)
    file = record(tmp_path / "r.mcap", mixed)
    address = f"replay://{file}?speed=step"
    told = tmp_path / "told.jsonl"
    arguments = ["run", str(folder), "--source", address, "--pose", address, "--out", str(told)]
    assert invoke(*arguments).exit_code == 0
    out = told.read_text(encoding="utf-8").splitlines()
    expected = run(example, folder, given="\n".join(input_lines(mixed))).splitlines()
    assert len(out) == 2_000
    assert out == expected
    assert all('"reason":"stale"' in line and '"health":["no_pose"]' in line for line in out[:10])
    text = "".join(expected)
    for reason in ("ok", "low_force", "not_finite", "saturated"):
        assert f'"reason":"{reason}"' in text


def test_what_a_contact_lies_on_is_told_alike(example: Path, tmp_path: Path) -> None:
    clamped = bundles.example(clamped=True)
    invented = np.arange(len(clamped.probe.faces)) % 3 == 0
    (tmp_path / "bundle").mkdir()
    for name, data in bundles.with_invented(clamped, invented).items():
        (tmp_path / "bundle" / name).write_bytes(data)
    marks = np.where(invented, "invented", "measured").astype(object)
    marks[clamped.probe.region == 2] = "untouchable"
    mixed, rng, level = samples(clamped, 4_000), np.random.default_rng(6), np.eye(3)
    for i, facet in enumerate(np.repeat(np.flatnonzero(clamped.probe.region == 2)[::40], 200)):
        t = BEGIN + 10 + 0.001 * i  # later than a gap: the last contact is not followed
        force = -8.0 * clamped.probe.normals[facet] * (i % 200 > 50)
        touch = [*force, *np.cross(clamped.probe.vertices[clamped.probe.faces[facet]].mean(axis=0), force)]
        mixed.append(flange(t, level))
        mixed.append(wrench(t, clamped.gravity.predict(level) + touch + rng.normal(0, 0.001, 6)))
    file, told = record(tmp_path / "r.mcap", mixed), tmp_path / "told.jsonl"
    address = f"replay://{file}?speed=step"
    arguments = ["run", str(tmp_path / "bundle"), "--source", address, "--pose", address, "--out", str(told)]
    done = invoke(*arguments)
    assert done.exit_code == 0, done.stderr
    lines = told.read_text(encoding="utf-8").splitlines()
    assert lines == run(example, tmp_path / "bundle", given="\n".join(input_lines(mixed))).splitlines()
    rows = [json.loads(line) for line in lines]
    assert [row["on"] for row in rows] == [None if row["face"] < 0 else marks[row["face"]] for row in rows]
    counts = Counter(row["on"] for row in rows if row["on"])
    assert set(counts) == {"measured", "invented", "untouchable"}
    said = " ".join(done.output.split()).replace(",", "")
    total = sum(counts.values())
    assert f"{counts['invented']} of {total} contacts are on invented facets" in said
    assert f"{counts['untouchable']} of {total} contacts are on untouchable regions" in said


def test_the_zero_is_told_alike(example: Path, bundle: tuple[Path, RuntimeConfig], tmp_path: Path) -> None:
    folder, config = bundle
    mixed, rng = [], np.random.default_rng(3)
    for i in range(9_000):
        t = BEGIN + 0.001 * i
        # Three attitudes, three seconds each, and a zero that is off by 0.5 N.
        R = Rotation.from_euler("xyz", [180, 12 * (i // 3_000 - 1), 15 * (i // 3_000 % 2)], degrees=True)
        if i % 10 == 0:
            mixed.append(flange(t, R.as_matrix()))
        reading = config.gravity.predict(R.as_matrix()) + [0.5, 0, 0, 0, 0, 0]
        mixed.append(wrench(t, reading + rng.normal(0, [0.02] * 3 + [0.001] * 3)))
    file, told = record(tmp_path / "r.mcap", mixed), tmp_path / "told.jsonl"
    address = f"replay://{file}?speed=step"
    arguments = ["run", str(folder), "--source", address, "--pose", address, "--out", str(told)]
    done = invoke(*arguments)
    assert done.exit_code == 0, done.stderr
    out = told.read_text(encoding="utf-8").splitlines()
    assert out == run(example, folder, given="\n".join(input_lines(mixed))).splitlines()
    zeros = [json.loads(line)["zero"] for line in out]
    states = [zero["state"] for zero in zeros]
    assert list(dict.fromkeys(states)) == ["unknown", "doubtful", "off"]
    assert 450 < states.index("doubtful") < 700
    assert 6_400 < states.index("off") < 7_000
    assert zeros[-1]["force_S_N"] == pytest.approx([0.5, 0, 0], abs=0.05)
    assert zeros[-1]["age_s"] < 0.6
    assert zeros[-1]["shift_m"] > 10 * zeros[-1]["shift_sigma_m"] > 0
    said = " ".join(done.output.split())
    assert "The sensor's zero is off by 0.5 ± " in said
    assert "Recalibrate before you trust a contact." in said
    assert "zero: last seen 0 s before the end." in said


def test_a_zero_that_follows_is_told_alike(example: Path, tmp_path: Path) -> None:
    plain = bundles.example()
    content = plain.model.to_json()
    content["zero"]["follow"] = True
    config = with_self_test(replace(plain, model=type(plain.model).model_validate(content)))
    config.write(tmp_path / "bundle")
    assert RuntimeConfig.load(tmp_path / "bundle").model.zero.follow
    rng, R, mixed = np.random.default_rng(3), Rotation.from_euler("x", 180, degrees=True).as_matrix(), []
    off = np.array([0.1, 0.05, -0.1, 0.003, 0, 0.001])
    finger = np.where(np.arange(4_000) < 2_500, 0.0, 0.4)  # rests from then on
    for i, force in enumerate(finger):
        if i % 10 == 0:
            mixed.append(flange(BEGIN + 0.001 * i, R))
        reading = config.gravity.predict(R) + off + [0, force, 0, 0, 0, 0]
        mixed.append(wrench(BEGIN + 0.001 * i, reading + rng.normal(0, [0.02] * 3 + [0.001] * 3)))
    file, told = record(tmp_path / "r.mcap", mixed), tmp_path / "told.jsonl"
    address = f"replay://{file}?speed=step"
    arguments = ["run", str(tmp_path / "bundle"), "--source", address, "--pose", address]
    done = invoke(*arguments, "--out", str(told))
    assert done.exit_code == 0, done.stderr
    out = told.read_text(encoding="utf-8").splitlines()
    assert out == run(example, tmp_path / "bundle", given="\n".join(input_lines(mixed))).splitlines()
    zeros = [json.loads(line)["zero"] for line in out]
    assert list(dict.fromkeys(zero["follows"] for zero in zeros)) == ["waiting", "following", "stopped"]
    assert zeros[2_400]["taken_S"] == pytest.approx(off, abs=0.02)
    assert zeros[2_400]["seen_s"] < 0.3
    assert max(zeros[2_400]["taken_sigma_S"]) < 0.02
    assert zeros[-1]["raw_S"] == pytest.approx(
        config.gravity.predict(R) + off + [0, 0.4, 0, 0, 0, 0], abs=0.1
    )
    assert "Zero has stopped following at 0.15 ± " in " ".join(done.output.split())
