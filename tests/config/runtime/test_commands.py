"""``contactbench bundle``: export from files and from a session, check, diff, schema; exit codes."""

import dataclasses
import hashlib
import json
import shutil
from datetime import UTC, datetime
from math import inf
from pathlib import Path

import numpy as np
import pytest
from config.runtime.bundles import example, example_bundle
from scipy.spatial.transform import Rotation
from terminal import said
from typer.testing import CliRunner
from weighing_files import spun, weighed

from contactbench import assets
from contactbench.pipeline import cli
from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.files.calibration_file import Mount, save_calibration
from contactbench.pipeline.calibration.payload import CAUTIONS
from contactbench.pipeline.config.runtime import ConfigError, RuntimeConfig
from contactbench.pipeline.config.runtime.canonical import json_schema
from contactbench.pipeline.config.runtime.checks import read_verification
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.gates import Gates
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile, save_probe_file
from contactbench.pipeline.session import Session
from contactbench.pipeline.settings import PayloadSettings
from contactbench.pipeline.workbench.export import payload_text

RATE = ("--rate", 1000)


def invoke(*arguments):
    return CliRunner().invoke(cli.app, ["bundle", *map(str, arguments)])


def sha256(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()


def verification(folder, *, passed=True, mean=0.4, model_error=None, **settings):
    file = folder / "verification.json"
    content = {
        "schema": "contactbench.verification",
        "version": 1,
        "overall": {"touches": 40, "mean_mm": mean, "sd_mm": 0.2, "p95_mm": 0.8, "max_mm": 1.2},
        "per_marker": [{}] * 10,
        "ratio": 1.1,
        "times": {"count": 40, "median_s": 1e-6, "p99_s": 2e-6},
        "verdict": {"passed": passed, "reasons": [] if passed else ["The mean error is too large."]},
        "diagnosis": {"text": "Noise explains most of the error."},
        "limits": {"mean_m": 0.001, "max_m": 0.002, "p99_s": 0.001},
        "settings": settings,
        "model_error": model_error,
        "sources": {
            role: sha256(folder / name)
            for role, name in (("calibration", "calibration.json"), ("probe", "probe.ply"))
        },
    }
    file.write_text(json.dumps(content), encoding="utf-8")
    return file


def known_weight(folder, outcome="passed", **changes):
    file = folder / "weight.json"
    content = {
        "schema": "contactbench.known_weight",
        "version": 1,
        "mass_kg": 1.0,
        "mass_sigma_kg": 0.001,
        "certificate": "W-17",
        "measured_kg": 1.002,
        "measured_sigma_kg": 0.004,
        "direction_error_deg": 0.2,
        "outcome": outcome,
        "passed": outcome == "passed",
        "sentence": f"The check says {outcome}.",
        "created": "2026-01-01T13:00:00+01:00",
        "calibration_sha256": sha256(folder / "calibration.json"),
        "sources": {},
    }
    file.write_text(json.dumps(content | changes), encoding="utf-8")
    return file


def known_touch(folder, outcome="passed", **changes):
    file = folder / "touch.json"
    content = {
        "schema": "contactbench.known_touch",
        "version": 1,
        "point_S_m": [0.0, 0.01, 0.1],
        "located_S_m": [0.0, 0.011, 0.1],
        "error_m": 0.001,
        "sigma_m": 0.002,
        "outcome": outcome,
        "passed": outcome == "passed",
        "sentence": f"The check says {outcome}.",
        "created": None,
        "calibration_sha256": sha256(folder / "calibration.json"),
        "probe_sha256": sha256(folder / "probe.ply"),
        "sources": {},
    }
    file.write_text(json.dumps(content | changes), encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Make a folder with a calibration, a probe and a verification, once."""
    folder = tmp_path_factory.mktemp("made")
    save_calibration(calibrate(weighed().poses), folder / "calibration.json")
    vertices, faces = assets.make("convex", 300)
    region = assets.contact_region("convex", vertices, faces)
    probe = Probe.from_arrays(vertices, faces, region, name="convex")
    save_probe_file(ProbeFile(probe, RegionSet.from_labels(probe.region), "S"), folder / "probe.ply")
    verification(folder)
    return folder


@pytest.fixture
def bench(made, tmp_path, monkeypatch):
    """Give a copy of that folder."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    return shutil.copytree(made, tmp_path / "bench")


def files_of(bench):
    return (
        "--calibration", bench / "calibration.json", "--probe", bench / "probe.ply",
        "--verification", bench / "verification.json", *RATE,
    )  # fmt: skip


def refused_export(bench):
    """Return why the session is not exported."""
    refused = invoke("export", bench / "s", *RATE, "--out", bench / "b")
    assert refused.exit_code == 1
    return said(refused)


def test_export_check_and_the_same_bytes_again(bench):
    options = ("--model", "M8128", "--serial", "42", "--rate", 500, "--cutoff", 20, "--operator", "Ada",
               "--saturation", "400,400,400,20,20,20", "--region-only")  # fmt: skip
    made = invoke("export", *files_of(bench), *options, "--out", bench / "b.zip", "--json")
    assert made.exit_code == 0, made.stderr
    assert json.loads(made.stdout)["verified"]
    config = RuntimeConfig.load(bench / "b.zip")
    assert config.model.sensor.model_dump() == {"model": "M8128", "serial": "42", "rate_Hz": 500.0}
    assert config.model.gates.region_only
    assert config.model.gates.saturation == [400.0, 400.0, 400.0, 20.0, 20.0, 20.0]
    assert config.model.provenance.operator == "Ada"
    assert config.model.provenance.created == "2023-11-14T22:13:20Z"
    assert {each.role: each.sha256 for each in config.model.provenance.sources} == {
        "calibration": sha256(bench / "calibration.json"),
        "probe": sha256(bench / "probe.ply"),
        "verification": sha256(bench / "verification.json"),
    }
    assert config.model.verification.max_error_m == pytest.approx(0.0012)
    before = (bench / "b.zip").read_bytes()
    assert invoke("export", *files_of(bench), *options, "--out", bench / "b.zip").exit_code == 0
    assert (bench / "b.zip").read_bytes() == before
    checked = invoke("check", bench / "b.zip", "--json")
    assert checked.exit_code == 0
    assert json.loads(checked.stdout)["probe"]["facets"] == len(config.probe.faces)
    assert "verified on 10 markers: 0.40 mm mean" in checked.output


def test_checks_reach_the_bundle_and_a_missing_one_is_said(bench):
    bare = invoke("export", *files_of(bench), "--out", bench / "b")
    assert bare.exit_code == 0
    assert "Neither a known weight nor a known touch was checked" in said(bare)
    assert "Neither a known weight" in said(invoke("check", bench / "b"))
    options = ("--known-weight", known_weight(bench), "--known-touch", known_touch(bench))
    made = invoke("export", *files_of(bench), *options, "--out", bench / "b", "--json")
    assert made.exit_code == 0, made.stderr
    assert "Neither" not in said(made)
    model = RuntimeConfig.load(bench / "b").model
    assert json.loads(made.stdout)["checks"] == model.checks.model_dump()
    assert model.checks.known_weight.model_dump() == {
        "mass_kg": 1.0, "mass_sigma_kg": 0.001, "certificate": "W-17", "measured_kg": 1.002,
        "measured_sigma_kg": 0.004, "outcome": "passed", "created": "2026-01-01T12:00:00Z",
    }  # fmt: skip
    assert model.checks.known_touch.error_m == 0.001
    roles = {each.role: each.sha256 for each in model.provenance.sources}
    assert roles["known_weight"] == sha256(bench / "weight.json")
    assert "Neither" not in said(invoke("check", bench / "b"))
    assert invoke("export", *files_of(bench), *options[2:], "--out", bench / "b").exit_code == 0
    assert RuntimeConfig.load(bench / "b").model.checks.known_weight is None
    wavering = known_weight(bench, "undecided")
    made = invoke("export", *files_of(bench), "--known-weight", wavering, "--out", bench / "b")
    assert made.exit_code == 0
    assert "was inconclusive" in said(made)


@pytest.mark.parametrize(
    ("write", "changes", "reason"),
    [
        (known_weight, {"outcome": "failed"}, "known weight of 1 kg was measured as 1.002 kg"),
        (known_touch, {"outcome": "failed"}, "known touch was located 1 mm off"),
        (
            known_touch,
            {"outcome": "failed", "located_S_m": None, "error_m": None},
            "known touch was not located",
        ),
        (
            known_weight,
            {"calibration_sha256": "0" * 64},
            "The known weight was checked with another calibration",
        ),
        (known_touch, {"probe_sha256": "0" * 64}, "known touch was checked with another probe"),
    ],
)
def test_a_check_that_failed_or_is_of_others_refuses_the_export(bench, write, changes, reason):
    option = f"--{write.__name__.replace('_', '-')}"
    given = (*files_of(bench), option, write(bench, **changes), "--out", bench / "b")
    refused = invoke("export", *given)
    assert refused.exit_code == 1
    assert reason in said(refused)
    assert not (bench / "b").exists()
    assert invoke("export", *given, "--unverified").exit_code == 0
    model = RuntimeConfig.load(bench / "b").model
    assert not model.verified
    assert len(model.provenance.stale) == 1
    assert reason in said(invoke("check", bench / "b"))


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"schema": "contactbench.known_touch"}, "not a contactbench.known_weight of version 1"),
        ({"version": 2}, "not a contactbench.known_weight of version 1"),
        ({"mass_kg": 0.0}, "mass_kg is 0.0"),
        ({"created": "today"}, "lacks a figure"),
        ({"created": "2026-01-01T13:00:00"}, "no time zone"),
        ({"outcome": "good"}, "outcome is 'good'"),
    ],
)
def test_what_is_no_check_is_wrong_input(bench, changes, reason):
    file = known_weight(bench, **changes)
    refused = invoke("export", *files_of(bench), "--known-weight", file, "--out", bench / "b")
    assert refused.exit_code == 2
    assert reason in said(refused)
    assert "weight.json" in said(refused).replace(" ", "")
    file.write_text("{", encoding="utf-8")
    assert invoke("export", *files_of(bench), "--known-weight", file, "--out", bench / "b").exit_code == 2


def test_a_session_gives_its_checks_unless_they_are_of_another_calibration(bench):
    with Session.create(bench / "s", by="ada") as session:
        fill(session, bench)
        known = {kind: each.content for (kind, _), each in session.state.current_results.items()}
        known.pop("verification")
        weight, touch = known_weight(bench).read_bytes(), known_touch(bench).read_bytes()
        session.add_result(
            "known_weight", "w.json", {"w.json": weight}, {"calibration": known["calibration"]}, {}
        )
        session.add_result("known_touch", "t.json", {"t.json": touch}, known, {})
    assert invoke("export", bench / "s", *RATE, "--out", bench / "b").exit_code == 0
    model = RuntimeConfig.load(bench / "b").model
    assert model.checks.known_weight.created == "2026-01-01T12:00:00Z"
    assert model.checks.known_touch.created[:4] >= "2023"  # when it was kept, as its file does not tell
    assert {"known_weight", "known_touch"} < {each.role for each in model.provenance.sources}

    with Session.open(bench / "s", by="ada") as session:
        failed = known_weight(bench, "failed").read_bytes()
        session.add_result(
            "known_weight", "w.json", {"w.json": failed}, {"calibration": known["calibration"]}, {"again": 1}
        )
    assert "known weight of 1 kg was measured" in refused_export(bench)
    with Session.open(bench / "s", by="ada") as session:
        session.mark("known_weight", "w.json", "rejected", "the wrong weight")
    assert invoke("export", bench / "s", *RATE, "--out", bench / "b").exit_code == 0
    assert RuntimeConfig.load(bench / "b").model.checks.known_weight is None

    with Session.open(bench / "s", by="ada") as session:
        save_calibration(calibrate(weighed(seed=6).poses), bench / "calibration.json")
        data = (bench / "calibration.json").read_bytes()
        session.add_result("calibration", "d.json", {"d.json": data}, {}, {})
    assert invoke("export", bench / "s", *RATE, "--unverified", "--out", bench / "b").exit_code == 0
    assert RuntimeConfig.load(bench / "b").model.checks.known_touch is None


@pytest.mark.parametrize(
    ("down", "lines"),
    [((0.0, 0.0, 1.0), []), ((0.0, -1.0, 0.0), ["ros2.yaml holds only the broadcaster's offset"])],
)
def test_ceiling_and_wall_are_exported_checked_and_told(bench, down, lines):
    turn, _ = Rotation.align_vectors([down], [[0, 0, -1]])
    poses = [dataclasses.replace(pose, R_WS=turn.as_matrix() @ pose.R_WS) for pose in weighed().poses]
    save_calibration(calibrate(poses, down_W=down), bench / "calibration.json")
    verification(bench)
    made = invoke("export", *files_of(bench), "--out", bench / "b", "--json")
    assert made.exit_code == 0, made.stderr
    assert json.loads(made.stdout)["world"]["down_W"] == pytest.approx(list(down), abs=1e-12)
    checked = invoke("check", bench / "b")
    assert checked.exit_code == 0, checked.stderr
    for result in (made, checked):
        assert all(line in said(result) for line in lines)
        assert ("ros2.yaml" in result.stderr) == bool(lines)


def test_the_zero_is_as_old_as_the_last_pose_where_a_clock_says_so(bench):
    created = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)
    poses = list(weighed().poses)

    def measured(first):
        timed = [
            dataclasses.replace(pose, time=None if first is None else first + 10.0 * i)
            for i, pose in enumerate(poses)
        ]
        save_calibration(calibrate(timed), bench / "calibration.json", created=created)
        verification(bench)
        made = invoke("export", *files_of(bench), "--out", bench / "b")
        assert "The sensor's zero was measured on 202" in said(invoke("check", bench / "b"))
        assert made.exit_code == 0, made.stderr
        return RuntimeConfig.load(bench / "b").model.zero.measured

    first = datetime(2026, 1, 1, 12, tzinfo=UTC).timestamp()
    end = datetime.fromtimestamp(first + 10 * (len(poses) - 1), UTC)
    assert measured(first) == end.strftime("%Y-%m-%dT%H:%M:%SZ")
    for unknown in (None, 0.0, 1e12):
        assert measured(unknown) == "2026-01-02T03:04:05Z"


def test_a_drift_is_told_by_the_hour(tmp_path):
    example_bundle(tmp_path / "b", 300, clamped=True)
    checked = invoke("check", tmp_path / "b", "--json")
    assert checked.exit_code == 0
    assert "drifted by up to 0.11 N and 0.72 mN·m per hour" in said(checked)
    assert json.loads(checked.stdout)["zero"]["measured"] == "2026-01-01T12:00:00Z"


def test_what_is_not_verified_is_refused_or_marked(bench):
    out = bench / "bundle"
    some = (*files_of(bench)[:4], *RATE)
    refused = invoke("export", *some, "--out", out, "--json")
    assert refused.exit_code == 1
    assert "Contacts have not been verified" in json.loads(refused.stdout)["reasons"][0]
    assert not out.exists()
    assert invoke("export", *some, "--out", out, "--unverified").exit_code == 0
    assert invoke("check", out).exit_code == 1
    verification(bench, passed=False)
    assert "mean error is too large" in invoke("export", *files_of(bench), "--out", out).stderr
    verification(bench)
    save_calibration(calibrate(weighed(seed=5).poses), bench / "calibration.json")
    other = invoke("export", *files_of(bench), "--out", out)
    assert other.exit_code == 1
    assert "another calibration" in other.output
    assert invoke("check", out).exit_code == 1  # the one before is still there


def test_a_probe_that_was_never_aligned_is_refused(bench):
    sidecar = bench / "probe.json"
    sidecar.write_text(sidecar.read_text(encoding="utf-8").replace('"S"', '"P"'), encoding="utf-8")
    result = invoke("export", *files_of(bench), "--out", bench / "b")
    assert result.exit_code == 1
    assert "frame is P" in result.output


def test_wrong_input_ends_with_2(bench, tmp_path):
    assert invoke("check", tmp_path / "none").exit_code == 2
    assert invoke("check", bench / "probe.ply").exit_code == 2
    assert invoke("export", "--out", bench / "b").exit_code == 2
    assert invoke("export", bench, *files_of(bench), "--out", bench / "b").exit_code == 2
    assert invoke("export", *files_of(bench), "--noise-force", 0.1, "--out", bench / "b").exit_code == 2
    assert invoke("export", *files_of(bench), "--max-force", 0, "--out", bench / "b").exit_code == 2
    assert invoke("export", *files_of(bench), "--out", bench).exit_code == 2  # a folder with other files
    assert (bench / "probe.ply").exists()
    example_bundle(bench / "b")
    (bench / "b" / "planes.csv").write_text("x", encoding="utf-8")
    damaged = invoke("check", bench / "b", "--json")
    assert damaged.exit_code == 2
    assert "planes.csv was changed: its hash does not match" in json.loads(damaged.stdout)["error"]


def test_diff_names_fields_and_surfaces(tmp_path):
    example_bundle(tmp_path / "a")
    example(2_000).write(tmp_path / "b.zip")
    same = invoke("diff", tmp_path / "a", tmp_path / "a", "--json")
    assert json.loads(same.stdout) == {"same": True, "fields": [], "files": [], "mesh": None}
    found = invoke("diff", tmp_path / "a", tmp_path / "b.zip", "--json")
    assert found.exit_code == 0
    assert "probe.facets" in found.output
    assert "mm apart" in found.output
    assert {each["field"] for each in json.loads(found.stdout)["fields"]} >= {"probe.facets", "planes.count"}


def test_the_schema_is_printed():
    assert invoke("schema").stdout.encode() == json_schema()


@pytest.mark.parametrize(
    ("data", "words"),
    [(b"x", "not valid JSON"), (b"{}", "not a contactbench.verification"),
     (b'{"schema":"contactbench.verification","version":1}', "no touch was accepted"),
     (b'{"schema":"contactbench.verification","version":1,"overall":{}}', "lacks a figure")],
)  # fmt: skip
def test_what_is_no_verification_is_refused(data, words):
    with pytest.raises(ConfigError, match=words):
        read_verification(data, "v.json")


# ---- what was verified -------------------------------------------------------------------------


def mounted(bench, degrees):
    """Calibrate as ``--mount`` does."""
    R_ES = Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()
    save_calibration(calibrate(weighed().poses), bench / "calibration.json", mount=Mount.of(R_ES.T))


def test_the_mount_of_a_calibration_is_exported(bench):
    mounted(bench, (0, 0, 90))
    verification(bench)
    made = invoke("export", *files_of(bench), "--out", bench / "b")
    assert made.exit_code == 0, made.stderr
    half = 0.5**0.5
    assert RuntimeConfig.load(bench / "b").model.frames.quaternion_ES == pytest.approx([half, 0, 0, half])


def test_a_robot_is_told_its_payload_in_the_mount_of_the_bundle(bench, tmp_path):
    mounted(bench, (0, 0, 90))
    verification(bench)
    invoke("export", *files_of(bench), "--out", bench / "b")
    asked = ("payload", bench / "b", "--robot", "ur", "--sensor-at", "0,0,40")
    made = invoke(*asked, "--json")
    assert made.exit_code == 0, made.stderr
    answer = json.loads(made.stdout)
    load = RuntimeConfig.load(bench / "b").gravity
    x, y, z = load.centre_of_mass_S
    assert answer["mass_kg"] == pytest.approx(load.mass)
    assert answer["centre_E_m"] == pytest.approx([-y, x, z + 0.04])
    assert "own body and its adapters are not in it" in made.output
    assert invoke(*asked).stdout == f"{answer['text']}\n"
    file = tmp_path / "payload.txt"
    with_body = invoke(*asked, "--sensor-body", "0.3,0,0,20", "--out", file)
    assert with_body.exit_code == 0
    assert "not in it" not in with_body.output
    assert file.read_text() != f"{answer['text']}\n"


@pytest.mark.parametrize("maker", ["ur", "abb"])
def test_a_payload_too_unsure_or_of_a_refused_calibration_is_not_printed(bench, monkeypatch, maker):
    mounted(bench, (0, 0, 90))
    verification(bench)
    invoke("export", *files_of(bench), "--out", bench / "b")
    out = bench / "p.txt"
    asked = ("payload", bench / "b", "--robot", maker, "--sensor-at", "0,0,40", "--sensor-body", "0.3,0,0,20")
    assert CAUTIONS[maker] in said(invoke(*asked))
    with monkeypatch.context() as patch:
        patch.setattr("contactbench.pipeline.calibration.payload._LARGEST_SHARE", 0.0)
        made = invoke(*asked, "--out", out)
        assert made.exit_code == 1
        assert "too unsure" in said(made)
        assert invoke(*asked).stdout == ""
    mount = Mount.of(np.eye(3))
    save_calibration(calibrate(spun().poses), bench / "calibration.json", mount=mount)
    assert invoke("export", *files_of(bench), "--unverified", "--out", bench / "b").exit_code == 0
    made = invoke(*asked, "--json", "--out", out)
    assert made.exit_code == 1
    assert "The calibration was refused" in json.loads(made.stdout)["error"]
    assert not out.exists()
    settings = PayloadSettings(robot=maker)
    with pytest.raises(InputError, match="The calibration is refused"):
        payload_text(RuntimeConfig.load(bench / "b"), settings)


def test_a_bundle_without_a_mount_asks_for_one(bench):
    verification(bench)
    invoke("export", *files_of(bench), "--out", bench / "b")
    made = invoke("payload", bench / "b", "--robot", "kuka", "--sensor-at", "0,0,40")
    assert made.exit_code == 2
    assert "--mount" in made.output


def test_another_mount_than_the_calibrations_is_a_reason_against(bench):
    mounted(bench, (0, 0, 90))
    for verified, options, words in (
        ((0, 0, 80), (), "verification was made with the mounting"),
        (None, (), "verification was made with the mounting"),  # orientations taken for the sensor's own
        ((0, 0, 90), ("--mount", "0,0,80"), "calibration was made with the mounting"),
    ):
        verification(bench, mount=verified)
        made = invoke("export", *files_of(bench), *options, "--out", bench / "b")
        assert made.exit_code == 1
        assert words in " ".join(made.output.split())
    verification(bench, mount=(0, 0, 90))
    assert invoke("export", *files_of(bench), "--mount", "0,0,90", "--out", bench / "b").exit_code == 0


def test_the_rate_is_the_verified_one_or_given(bench):
    without = files_of(bench)[:-2]
    unknown = invoke("export", *without, "--out", bench / "b")
    assert unknown.exit_code == 2
    assert "--rate" in unknown.stderr
    verification(bench, rate_Hz=500.0)
    assert invoke("export", *without, "--out", bench / "b").exit_code == 0
    model = RuntimeConfig.load(bench / "b").model
    assert (model.sensor.rate_Hz, model.filters.wrench.rate_Hz) == (500.0, 500.0)
    assert invoke("export", *without, "--rate", 510, "--out", bench / "b").exit_code == 0
    other = invoke("export", *files_of(bench), "--out", bench / "b")
    assert other.exit_code == 1
    assert "verified at 500 readings" in " ".join(other.output.split())


def test_a_verification_without_sources_counts_for_nothing(bench):
    file = bench / "verification.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    del content["sources"]
    file.write_text(json.dumps(content), encoding="utf-8")
    made = invoke("export", *files_of(bench), "--out", bench / "b")
    assert made.exit_code == 1
    assert "does not state its calibration" in " ".join(made.output.split())


def test_the_model_error_is_the_verified_one_or_the_default(bench):
    made = invoke("export", *files_of(bench), "--out", bench / "b")
    assert "model error is the default" in made.output
    assert RuntimeConfig.load(bench / "b").model.touch.model_error.model_dump() == {
        "force_N": [0.05] * 3,
        "torque_Nm": [0.001] * 3,
        "measured": False,
    }
    verification(bench, model_error={"force_N": 0.2, "torque_Nm": 0.003})
    made = invoke("export", *files_of(bench), "--out", bench / "b")
    assert "model error" not in made.output
    assert RuntimeConfig.load(bench / "b").model.touch.model_error.model_dump() == {
        "force_N": [0.2] * 3,
        "torque_Nm": [0.003] * 3,
        "measured": True,
    }
    for wrong in ({"force_N": 0.2}, {"force_N": -0.2, "torque_Nm": 0.003}, 3):
        verification(bench, model_error=wrong)
        refused = invoke("export", *files_of(bench), "--out", bench / "b")
        assert refused.exit_code == 2
        assert "the verification lacks a figure" in refused.output


def test_what_is_said_of_a_touch_reaches_the_bundle(bench):
    options = ("--torsion-arm-mm", 3, "--not-by-region")
    made = invoke("export", *files_of(bench), *options, "--out", bench / "b", "--json")
    assert made.exit_code == 0, made.stderr
    model = RuntimeConfig.load(bench / "b").model
    assert (model.touch.torsion_arm_m, model.gates.accept_by_region) == (0.003, False)
    assert json.loads(made.stdout)["touch"]["torsion_arm_m"] == 0.003
    assert invoke("export", *files_of(bench), "--out", bench / "b").exit_code == 0
    model = RuntimeConfig.load(bench / "b").model
    assert (model.touch.torsion_arm_m, model.gates.accept_by_region) == (0.001, True)
    long = invoke("export", *files_of(bench), "--torsion-arm-mm", 101, "--out", bench / "b")
    assert long.exit_code == 2
    assert "--torsion-arm-mm" in long.stderr


def test_the_deviation_of_the_mesh_is_that_of_its_simplifications(bench):
    sidecar = bench / "probe.json"
    document = json.loads(sidecar.read_text(encoding="utf-8"))
    steps = [{"step": "simplify", "result": {"deviation": {"rms_mm": rms}}} for rms in (0.03, 0.04)]
    sidecar.write_text(
        json.dumps(document | {"history": [steps[0], {"step": "align"}, steps[1]]}), encoding="utf-8"
    )
    assert invoke("export", *files_of(bench), "--out", bench / "b").exit_code == 0
    assert RuntimeConfig.load(bench / "b").model.touch.mesh_deviation_m == pytest.approx(5e-5, rel=1e-12)
    for wrong in ({"step": "simplify"}, {"step": "simplify", "result": {"deviation": {"rms_mm": -1}}}):
        sidecar.write_text(json.dumps(document | {"history": [steps[0], wrong]}), encoding="utf-8")
        refused = invoke("export", *files_of(bench), "--out", bench / "b")
        assert refused.exit_code == 2
        assert "step 2 of its history, simplify" in " ".join(refused.output.split())


def test_what_nobody_said_is_said(bench):
    made = invoke("export", *files_of(bench), "--out", bench / "b")
    for heard in (made.output, invoke("check", bench / "b").output):
        assert "NO SATURATION LIMITS" in heard
        assert "does not state its rate, mounting" in " ".join(heard.split())
    made = invoke("export", *files_of(bench), "--saturation", "9,9,9,1,1,1", "--out", bench / "b")
    assert "SATURATION" not in made.output


def test_settings_from_a_file_reach_everything(bench):
    whole = example().model.to_json()
    given = {name: whole[name] for name in ("controller", "limits", "gates", "filters")}
    del given["filters"]["location"]["sections"]
    (bench / "settings.json").write_text(json.dumps(given), encoding="utf-8")
    made = invoke("export", *files_of(bench), "--settings", bench / "settings.json", "--out", bench / "b")
    assert made.exit_code == 0, made.stderr
    found = RuntimeConfig.load(bench / "b").model.to_json()
    assert found["gates"].pop("friction_angle_rad") == pytest.approx(whole["gates"].pop("friction_angle_rad"))
    del found["filters"]["location"]["sections"]
    assert (
        found["gates"].pop("sigma_max_m") == 0.002
    )  # asked of every new bundle, unless the file says otherwise
    for name in given:
        assert found[name] == whole[name]


def test_gates_that_accept_more_than_the_verified_ones_are_not_verified(bench):
    strict = {"accept_by_region": False, "sigma_max": 0.001, "saturation": (99.0,) * 6, "region_only": True}
    told = json.loads(json.dumps(Gates(**strict).told()))
    for name, value in {
        "rival_odds": 50.0, "min_force": 0.1, "sigma_max": 0.0, "depth_distance": 0.0, "accept_by_region": True,
        "region_odds": 10.0, "friction_angle": 80.0, "saturation": (*(99.0,) * 5, inf), "region_only": False,
    }.items():  # fmt: skip
        (found,) = Gates(**{**strict, name: value}).more_than(told)
        assert found.startswith(f"{name.replace('_', ' ')} ")
    verification(bench, gates=told)
    same = [
        *files_of(bench),
        *["--saturation", "99,99,99,99,99,99", "--region-only", "--not-by-region", "--sigma-max", "1"],
    ]
    stricter = invoke("export", *same, "--min-force", 0.6, "--rival-odds", 200, "--out", bench / "a")
    assert stricter.exit_code == 0, stricter.stderr
    weak = invoke("export", *same, "--rival-odds", 50, "--out", bench / "b")
    assert weak.exit_code == 1
    assert "rival odds 50 (100)" in " ".join(weak.output.split())
    verification(bench, gates=told, assumed={"torsion_arm_m": 0.001})
    assert invoke("export", *same, "--scene", "dry", "--out", bench / "c").exit_code == 0
    hard = invoke("export", *same, "--scene", "bone", "--out", bench / "d")
    assert hard.exit_code == 1
    assert "0.5 mm of torsion over force, the verification 1 mm" in " ".join(hard.output.split())


def test_filters_and_noise_other_than_the_verified_ones_are_not_verified(bench):
    told = {
        "noise": [0.05] * 3 + [0.002] * 3, "protocol": {"samples": 50, "take_s": 0.25}, "rate_Hz": 1_000.0,
        "assumed": {"torsion_arm_m": 0.001, "model_error": [0.02] * 3 + [0.0005] * 3},
    }  # fmt: skip
    verification(bench, **told)
    assert invoke("export", *files_of(bench), "--cutoff", 10, "--out", bench / "a").exit_code == 0
    for options, words in {
        ("--no-filter",): "scatter 3.9 times", ("--paper-filter",): "lag by 70 ms", ("--cutoff", 2): "lag by 113 ms",
        ("--follow",): "lets the zero follow",
        ("--noise-force", 0.03, "--noise-torque", 0.002): "states 0.6 of the noise",
    }.items():  # fmt: skip
        found = invoke("export", *files_of(bench), *options, "--out", bench / "b")
        assert (found.exit_code, words in said(found)) == (1, True), said(found)
    # No filter matters beside this.
    verification(bench, **told, model_error={"force_N": 0.3, "torque_Nm": 0.02})
    assert invoke("export", *files_of(bench), "--no-filter", "--out", bench / "b").exit_code == 0
    for wrong in ([None] * 6, [-0.05] * 6):
        verification(bench, **{**told, "noise": wrong})
        refused = invoke("export", *files_of(bench), "--no-filter", "--out", bench / "c")
        assert (refused.exit_code, "lacks a figure" in said(refused)) == (2, True), said(refused)


@pytest.mark.parametrize(
    ("text", "words"),
    [("x", "not valid JSON"), ('{"gain":1}', "gain"), ('{"gates":{"rival_odds":0.5}}', "rival_odds"),
     ('{"limits":{}}', "limits.max_force_N"), ('{"gates":{"no":1}}', "no")],
)  # fmt: skip
def test_wrong_settings_are_refused(bench, text, words):
    (bench / "settings.json").write_text(text, encoding="utf-8")
    made = invoke("export", *files_of(bench), "--settings", bench / "settings.json", "--out", bench / "b")
    assert made.exit_code == 2
    assert words in made.output


# ---- sessions ----------------------------------------------------------------------------------


def fill(session, bench, poses_name="poses.csv"):
    """Add poses, a calibration of them, a probe, and a verification of both."""
    poses = bench / poses_name
    poses.write_text("poses\n", encoding="utf-8")
    session.add_input(poses, "poses", sensor="S-77")
    (raw,) = (each for each in session.state.current_inputs.values() if each.kind == "poses")
    read = {
        name: (bench / name).read_bytes()
        for name in ("calibration.json", "probe.ply", "probe.json", "verification.json")
    }
    session.add_result(
        "calibration", "c.json", {"c.json": read["calibration.json"]}, {"poses": raw.content}, {}
    )
    session.add_result("probe", "p.ply", {"p.ply": read["probe.ply"], "p.json": read["probe.json"]}, {}, {})
    known = {kind: each.content for (kind, _), each in session.state.current_results.items()}
    session.add_result("verification", "v.json", {"v.json": read["verification.json"]}, known, {})


def test_export_from_a_session(bench):
    with Session.create(bench / "s", by="ada") as session:
        fill(session, bench)
        identity = session.state.id
    made = invoke("export", bench / "s", *RATE, "--out", bench / "b")
    assert made.exit_code == 0, made.stderr
    model = RuntimeConfig.load(bench / "b").model
    assert (model.sensor.serial, model.provenance.session, model.provenance.operator) == (
        "S-77",
        identity,
        "ada",
    )
    assert {each.role for each in model.provenance.sources} == {"calibration", "probe", "verification"}

    with Session.open(bench / "s", by="ada") as session:
        session.rezeroed("S-77")
    stale = invoke("export", bench / "s", *RATE, "--out", bench / "b", "--json")
    assert stale.exit_code == 1
    assert any("calibration c.json" in reason for reason in json.loads(stale.stdout)["reasons"])
    assert RuntimeConfig.load(bench / "b").model.verified  # what was there is there


def test_a_verification_of_another_calibration_does_not_count(bench):
    with Session.create(bench / "s", by="ada") as session:
        fill(session, bench)
        save_calibration(calibrate(weighed(seed=6).poses), bench / "calibration.json")
        data = (bench / "calibration.json").read_bytes()
        session.add_result("calibration", "d.json", {"d.json": data}, {}, {})
    assert "another calibration than d.json" in refused_export(bench)


def test_a_report_of_another_verification_is_not_carried(bench):
    with Session.create(bench / "s", by="ada") as session:
        fill(session, bench)
        known = {kind: each.content for (kind, _), each in session.state.current_results.items()}
        about = {"verification": known["verification"]}
        session.add_result("report", "r.html", {"r.html": b"<p>first</p>"}, about, {})
    assert invoke("export", bench / "s", *RATE, "--out", bench / "b").exit_code == 0
    with Session.open(bench / "s", by="ada") as session:
        known.pop("verification")
        files = {"w.json": (bench / "verification.json").read_bytes()}
        session.add_result("verification", "w.json", files, known, {"seed": 1})
        session.add_result("verification", "x.json", {"x.json": files["w.json"] + b" "}, known, {})
    assert "report r.html belongs to another verification" in refused_export(bench)


def test_a_session_knows_with_which_mount_it_verified(bench):
    mounted(bench, (0, 0, 90))
    verification(bench)
    with Session.create(bench / "s", by="ada") as session:
        fill(session, bench)
        known = {kind: each.content for (kind, _), each in session.state.current_results.items()}
        known.pop("verification")
        files = {"w.json": (bench / "verification.json").read_bytes()}
        session.add_result("verification", "w.json", files, known, {"mount": [0, 0, 80]})
    assert "mounting" in refused_export(bench)


def test_a_session_without_a_probe_is_wrong_input(bench):
    Session.create(bench / "s").close()
    result = invoke("export", bench / "s", *RATE, "--out", bench / "b")
    assert result.exit_code == 2
    assert "there is no calibration" in result.output
    assert not Path(bench / "b").exists()


def test_a_probe_and_a_calibration_that_were_brought_in_serve_as_those_made_there(bench):
    with Session.create(bench / "s", by="ada") as session:
        session.add_input(bench / "calibration.json", "calibration", sensor="S-77")
        session.add_input(bench / "probe.ply", "probe", companions={"probe.json": bench / "probe.json"})
        known = {each.kind: each.content for each in session.state.current_inputs.values()}
        files = {"v.json": (bench / "verification.json").read_bytes()}
        session.add_result("verification", "v.json", files, known, {})
    made = invoke("export", bench / "s", *RATE, "--out", bench / "b")
    assert made.exit_code == 0, made.stderr
    assert RuntimeConfig.load(bench / "b").model.verified
    with Session.open(bench / "s", by="ada") as session:
        save_calibration(calibrate(weighed(seed=6).poses), bench / "calibration.json")
        session.add_input(bench / "calibration.json", "calibration", sensor="S-77")
    assert "calibration" in refused_export(bench)
