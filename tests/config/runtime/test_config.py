"""A bundle loads as what was written, has one spelling, and is refused when anything about it is not true."""

import dataclasses
import hashlib
import io
import itertools
import json
import threading
import time
import zipfile
from datetime import UTC, datetime

import numpy as np
import pytest
from benchmarks import bundle_example
from benchmarks.bundle_mutations import seal
from config.runtime.bundles import example, example_bundle
from scipy.spatial.transform import Rotation

from contactbench.pipeline.calibration import Level, Verdict
from contactbench.pipeline.config.runtime import (
    ConfigError,
    Filters,
    RuntimeConfig,
    UnverifiedError,
    build_config,
)
from contactbench.pipeline.config.runtime.canonical import decode_json, encode_json
from contactbench.pipeline.config.runtime.config import checksum
from contactbench.pipeline.config.runtime.differ import differences
from contactbench.pipeline.config.runtime.pack import KNOWN, read_bundle
from contactbench.pipeline.config.runtime.swap import write_folder
from contactbench.pipeline.contact import Gates, TouchModel, WrenchNoise
from contactbench.pipeline.filtering import LowPass
from contactbench.pipeline.mesh import Probe
from contactbench.pipeline.mesh.regions.region import Region, RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile


def edited(clamped=False, **changes):
    """Return the example's files with parts of the JSON replaced, sealed again: path with __ -> value."""
    files = example(clamped=clamped).encoded()
    content = json.loads(files["contactbench.json"])
    for path, value in changes.items():
        *above, last = path.split("__")
        part = content
        for name in above:
            part = part[int(name)] if isinstance(part, list) else part[name]
        part[int(last) if isinstance(part, list) else last] = value
    return seal({**files, "contactbench.json": json.dumps(content).encode()})


def test_the_zero_its_drift_and_the_checks_are_written_down():
    model = example(clamped=True).model
    assert model.zero.model_dump() == {
        "measured": "2026-01-01T12:00:00Z",
        "drift": {
            "force_Nps": [1e-5, -2e-5, 3e-5],
            "torque_Nmps": [1e-7, 0.0, -2e-7],
            "force_sigma_Nps": pytest.approx([1e-6, 2e-6, 3e-6]),
            "torque_sigma_Nmps": pytest.approx([1e-8, 0.0, 2e-8]),
        },
    }
    assert 0 < model.noise.orientation_rad < 0.01
    assert model.checks.known_weight.outcome == model.checks.known_touch.outcome == "passed"
    plain = example().model
    assert plain.zero.model_dump() == {"measured": None, "drift": None}
    assert plain.checks.model_dump() == {"known_weight": None, "known_touch": None}


@pytest.mark.parametrize("name", ["bundle", "bundle.zip"])
def test_what_is_loaded_is_what_was_written(tmp_path, name):
    config = example_bundle(tmp_path / "made" / name)
    loaded = RuntimeConfig.load(tmp_path / "made" / name)
    assert loaded.model == config.model
    assert loaded.files == config.files
    assert (loaded.probe.vertices == config.probe.vertices).all()
    assert (loaded.probe.region == config.probe.region).all()
    assert (loaded.gravity.vector == config.gravity.vector).all()
    loaded.write(tmp_path / "again" / name)
    for file in ("bundle/planes.csv", "bundle/contactbench.json") if name == "bundle" else ("bundle.zip",):
        assert (tmp_path / "again" / file).read_bytes() == (tmp_path / "made" / file).read_bytes()
    assert [file.name for file in (tmp_path / "made").iterdir()] == [name]


def test_the_hash_file_is_what_sha256sum_takes():
    files = example().encoded()
    digest, name = files["contactbench.sha256"].decode().split()
    assert digest == hashlib.sha256(files[name]).hexdigest()
    listed = json.loads(files[name])["provenance"]["files"].keys()
    assert listed | {name, "contactbench.sha256"} == files.keys()


def test_json_has_one_spelling():
    data = example().encoded()["contactbench.json"]
    content = json.loads(data)
    assert data == encode_json(dict(reversed(content.items())))
    assert data.endswith(b"}\n")
    assert encode_json({"b": 0.1 + 0.2, "a": "ä"}) == '{"a":"ä","b":0.30000000000000004}\n'.encode()
    with pytest.raises(ConfigError):
        encode_json({"a": float("nan")})


def test_noise_of_a_wrench_is_what_the_filter_leaves_and_the_calibration_adds():
    config = example()
    covariance = np.array(config.model.noise.wrench_covariance)
    g, C = config.gravity, config.gravity.covariance
    share = g.wrench_covariance(Rotation.random(4_000, np.random.default_rng(0)).as_matrix()).mean(axis=0)
    part = config.model.filters.wrench
    q, r = part.q * part.tuned_rate_Hz / part.rate_Hz, part.r * part.rate_Hz / part.tuned_rate_Hz
    predicted = q / 2 + np.sqrt(q * q / 4 + q * r)
    gain = predicted / (predicted + r)
    left = np.array([0.05] * 3 + [0.002] * 3) ** 2 * gain / (2 - gain)
    deviations = np.sqrt(np.diag(covariance))
    assert (np.abs(covariance - np.diag(left) - share) < 0.05 * np.outer(deviations, deviations)).all()
    # Of the force: turned evenly over all axes, gravity's covariance with the bias is gone.
    assert np.trace(covariance[:3, :3]) == pytest.approx(
        3 * left[0] + np.trace(C[:3, :3]) + np.trace(C[3:6, 3:6]), rel=1e-9
    )


def test_planes_come_in_the_order_of_priority():
    config = example(clamped=True)
    rows = config.files["planes.csv"].decode().split()[1:]
    table = np.array([[float(cell) for cell in row.split(",")] for row in rows])
    index, region = table[:, 0].astype(int), table[:, 5]
    assert sorted(index) == list(range(len(config.probe.faces)))
    counts = [int((config.probe.region == rank).sum()) for rank in (1, 0, 2)]
    assert min(counts) > 0
    assert region.tolist() == [1] * counts[0] + [0] * counts[1] + [2] * counts[2]  # 2: the clamp hides it
    corners = table[:, 6:].reshape(-1, 3, 3)
    assert (corners == config.probe.vertices[config.probe.faces[index]]).all()
    heights = np.einsum("ij,ikj->ik", table[:, 1:4], corners)
    assert np.abs(heights + table[:, 4:5]).max() < 1e-15 * 10


# ---- refused -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"version": 5}, "newer contactbench"),
        ({"version": 3}, "version 3 cannot be migrated"),
        ({"version": 2}, "version 2 cannot be migrated"),
        ({"version": 1}, "version 1 cannot be migrated"),
        ({"version": 0}, "no version 0"),
        ({"schema": "x"}, "schema is 'x'"),
        ({"frames__quaternion_ES": [1.0, 1.0, 0.0, 0.0]}, "frames.quaternion_ES has the length"),
        ({"gravity__gravity_W_N": [0.0, 0.0, -6200.0]}, "check whether it was given in grams"),
        ({"gravity__gravity_W_N": [0.0, 0.0, -0.062]}, "check whether forces were in kN"),
        ({"gravity__gravity_W_N": [0.0, 0.0, 6.2]}, "points up"),
        ({"gravity__centre_of_mass_S_m": [0.0, 0.0, 90.0]}, "check whether they were mm"),
        ({"gravity__torque_bias_Nm": [0.0, 250.0, 0.0]}, "N\\*mm"),
        ({"gravity__covariance__0__11": 1.0}, "gravity.covariance is not symmetric"),
        ({"gravity__covariance__0__0": 1e-320}, "gravity.covariance has a correlation beyond 1"),
        ({"gravity__gravity_W_N": [0.0, 0.0, -6.0]}, "noise.wrench_covariance"),
        ({"filters__wrench__tuned_rate_Hz": 1e-300, "filters__wrench__q": 1e-300}, "noise.wrench_covariance"),
        ({"filters__location__cutoff_Hz": 1e-300}, "too slow"),
        ({"noise__force_N": [0.0, 1.0, 1.0]}, "noise.force_N"),
        ({"noise__torque_Nm": [2.0, 2.0, 2.0]}, "noise.wrench_covariance"),
        ({"filters__location__cutoff_Hz": 600.0}, "below half of 1000 Hz"),
        ({"filters__location__cutoff_Hz": 21.0}, "filters.location.sections"),
        ({"filters__wrench__q": 0.0}, "filters.wrench.q is 0.0"),
        ({"gates__friction_angle_rad": 75.0}, "gates.friction_angle_rad is 75.0"),
        ({"gates__saturation": [1.0] * 5}, "gates.saturation"),
        ({"gates__rival_odds": 0.5}, "gates.rival_odds is 0.5"),
        ({"gates__first_odds": 2e9}, "gates.first_odds"),
        ({"gates__implausible_misfit": 100.0}, "gates.implausible_misfit is 100.0"),
        ({"gates__torque_ratio": 1.5}, "gates.torque_ratio"),
        ({"touch__torsion_arm_m": 1.0}, "touch.torsion_arm_m is 1.0"),
        ({"touch__mesh_deviation_m": -1e-5}, "touch.mesh_deviation_m"),
        ({"touch__model_error__force_N": [0.1, 0.1, 101.0]}, "touch.model_error.force_N.2 is 101.0"),
        ({"touch__model_error__torque_Nm": [0.1, 0.1]}, "touch.model_error.torque_Nm"),
        ({"regions__0__odds": 0.0}, "regions.0.odds is 0.0"),
        ({"regions__0__odds": 0.5}, "regions.0.odds is 0.5, but its untouchable is false"),
        ({"regions__0__untouchable": True}, "regions.0.odds is 1000, but its untouchable is true"),
        (
            {"regions__0__untouchable": True, "regions__0__odds": 0.001},
            r"regions lists \[1\] as untouchable, the mesh lists \[\]",
        ),
        ({"probe__facets": 1000}, "probe.facets is 1000, but the mesh has 1002"),
        ({"probe__bounds_S_m__0": [-40.0, -25.0, 0.0]}, "probe.bounds_S_m"),
        ({"probe__file": "../probe.ply"}, "probe.file is '../probe.ply'"),
        ({"regions": []}, "a facet has the region 1"),
        ({"regions__0__facets": 3}, "regions.0.facets is 3"),
        ({"planes__count": 5}, "planes.count"),
        ({"verification__passed": False}, "verified is true"),
        ({"verification__max_error_m": 0.0021}, "exceeds its limit"),
        ({"verification__touches": 0}, "verification.touches is 0"),
        ({"verification__markers": 0}, "verification.markers is 0"),
        ({"verification__limit_max_m": 0.051}, "verification.limit_max_m is 0.051, more than 0.05 m"),
        ({"verification__limit_mean_m": 1.0}, "verification.limit_mean_m is 1"),
        ({"verification__p95_error_m": 0.0012}, "verification.p95_error_m is more than"),
        ({"verification__max_error_m": 0.0003}, "verification.mean_error_m is more than"),
        (
            {"gates__saturation": [None, 29.0, None, 1.0, 1.0, 1.0]},
            "gates.saturation.1 is 29: the sensor cannot",
        ),
        ({"limits__max_force_N": 1001.0}, "limits.max_force_N is 1001, more than 1000"),
        ({"limits__max_torque_Nm": 3e3}, "limits.max_torque_Nm is 3000"),
        ({"limits__max_speed_mps": 250.0}, "limits.max_speed_mps is 250"),
        ({"limits__max_turn_radps": 180.0}, "limits.max_turn_radps is 180"),
        ({"sensor__rate_Hz": 940.0}, "filters.wrench.rate_Hz is 1000, but .* which is 940"),
        ({"provenance__stale": ["zeroed"]}, "provenance.stale says: zeroed"),
        ({"units__force": "kN"}, "units.force is 'kN'"),
        ({"limits__max_force_N": 10**400}, "limits.max_force_N"),
        ({"limits__max_force_N": 4.0}, "controller.desired_force_N is 5, not below limits.max_force_N"),
        ({"controller__variant": "bold"}, "controller.variant is 'bold'"),
        ({"controller__angle__damping": [1.0]}, "controller.angle.damping"),
        ({"controller__angle__gain_per_s__1": 0.0}, "controller.angle.gain_per_s.1 is 0.0"),
        ({"controller__watch__max_tilt_rad": 35.0}, "controller.watch.max_tilt_rad is 35.0"),
        ({"controller__touch__attempts": 1.5}, "controller.touch.attempts is 1.5"),
        ({"controller__lead__extra": 1}, "controller.lead.extra"),
        ({"sensor__extra": 1}, "sensor.extra"),
    ],
)
def test_what_cannot_be_true_is_refused_and_named(changes, words):
    with pytest.raises(ConfigError, match=words):
        RuntimeConfig.from_files(edited(**changes))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"frames__world": "W, z up"}, "frames.world is 'W, z up'"),
        ({"world__down_W": [0.0, 0.0, 1.0]}, "points up .* against world.down_W"),
        ({"world__down_W": [0.0, -1.0, 0.0]}, "gravity_W_N is more than 60 degrees from world.down_W"),
        ({"world__down_W": [0.0, 0.0, -1.0001]}, "world.down_W has the length 1.0001"),
        ({"world__down_W": None}, "world.down_W"),
        ({"noise__orientation_rad": 2.9}, "noise.orientation_rad is 2.9"),
        ({"zero__measured": "today"}, "zero.measured is 'today'"),
        ({"zero__drift__force_sigma_Nps__0": -1e-6}, "zero.drift.force_sigma_Nps.0"),
        ({"zero__drift__torque_Nmps": None}, "zero.drift.torque_Nmps"),
        ({"checks__known_weight__outcome": "failed"}, "verified is true, but checks.known_weight failed"),
        ({"checks__known_touch__outcome": "failed"}, "verified is true, but checks.known_touch failed"),
        ({"checks__known_touch__outcome": True}, "checks.known_touch.outcome"),
        ({"checks__known_touch__located_S_m": None}, "known_touch.outcome is 'passed', but nothing was"),
        ({"checks__known_touch__error_m": None}, "checks.known_touch.outcome is 'passed', but nothing was"),
        ({"checks__known_weight__mass_kg": 0.0}, "checks.known_weight.mass_kg is 0.0"),
        ({"checks__known_weight__created": "2026-01-01"}, "checks.known_weight.created"),
    ],
)
def test_what_cannot_be_true_of_down_zero_and_checks_is_refused(changes, words):
    assert RuntimeConfig.from_files(edited(clamped=True)).model.verified
    with pytest.raises(ConfigError, match=words):
        RuntimeConfig.from_files(edited(clamped=True, **changes))


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b'{"schema":"contactbench.r","schema":"contactbench.r"}\n', "byte 26 differs .* duplicate"),
        (b'{"b":1,"a":1}\n', "byte 2 differs"),
        (b'{"a": 1}\n', "byte 5 differs"),
        (b'{"a":1}', "byte 7 differs"),
        (b'{"a":1}\n\n', "byte 8 differs"),
        (b'{"a":1}\r\n', "byte 7 differs"),
        (b'{"a":1e0}\n', "byte 6 differs"),
        (b'{"a":-0}\n', "byte 5 differs"),
        (b'{"a":1e-400}\n', "byte 5 differs"),
        (b'{"a":"\\u0041"}\n', "byte 6 differs"),
        (b'{"a":1e400}\n', "not valid JSON"),
        (b'{"a":"\\ud800"}\n', "not valid JSON"),
        (b'{"a":01}\n', "not valid JSON"),
        (b'\xef\xbb\xbf{"a":1}\n', "JSON"),
        (b'{"a":NaN}', "not valid JSON"),
        (b"[" * 100_000, "not valid JSON"),
        (b"[1]\n", "not a JSON object"),
        (b"\xff", "not valid JSON"),
        (b'{"a":' + b"9" * 10_000 + b"}", "JSON"),
    ],
)
def test_text_that_is_no_json_object_is_refused(data, words):
    with pytest.raises(ConfigError, match=words):
        decode_json(data, "contactbench.json")


def test_a_changed_file_is_refused_by_its_hash():
    files = example().encoded()
    for name, data in files.items():
        with pytest.raises(ConfigError, match=f"{name}.*(hash|changed)|contactbench.json was changed"):
            RuntimeConfig.from_files({**files, name: data[:-1] + b" "})


def test_forces_that_the_sensor_just_measures_and_a_rate_that_is_nearly_it_are_taken():
    changes = {"gates__saturation": [30.0, 30.0, 30.0, None, None, None], "sensor__rate_Hz": 960.0}
    assert RuntimeConfig.from_files(edited(**changes)).model.verified


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data + b"\n",
        lambda data: data.replace(b"comment metres\n", b"comment metres\ncomment x\n", 1),
        lambda data: data.replace(b"element face ", b"element face 0", 1),
        lambda data: data[:-1] + bytes([data[-1] ^ 1]),  # a colour
    ],
)
def test_a_mesh_that_is_not_as_contactbench_writes_it_is_refused(change):
    files = example().encoded()
    with pytest.raises(
        ConfigError, match=r"probe.ply: byte \d+ differs from what contactbench writes for this mesh"
    ):
        RuntimeConfig.from_files(seal({**files, "probe.ply": change(files["probe.ply"])}))


def test_a_tool_that_weighs_nothing_for_sure_is_no_error_in_the_program():
    changes = {"gravity__gravity_W_N": [0.0] * 3, "gravity__covariance": [[0.0] * 12] * 12}
    with pytest.raises(ConfigError, match=r"noise\.wrench_covariance"):
        RuntimeConfig.from_files(edited(**changes))


def test_many_keys_take_linear_time():
    keys = "".join(f'"{number:06d}":0,' for number in range(80_000))
    data = ("{" + keys + '"079999":0}\n').encode()
    begin = time.process_time()
    with pytest.raises(ConfigError, match="byte"):
        decode_json(data, "c")
    assert time.process_time() - begin < 2


def test_strangers_links_and_missing_files_in_a_folder(tmp_path):
    folder = tmp_path / "b"
    example_bundle(folder)
    (folder / "notes.txt").write_text("x", encoding="utf-8")
    with pytest.raises(ConfigError, match=r"notes.txt"):
        RuntimeConfig.load(folder)
    with pytest.raises(ConfigError, match=r"notes.txt"):
        example_bundle(folder)  # it would be lost
    (folder / "notes.txt").unlink()
    (folder / "ros2.yaml").unlink()
    with pytest.raises(ConfigError, match=r"ros2\.yaml is missing"):
        RuntimeConfig.load(folder)
    (folder / "ros2.yaml").symlink_to(folder / "planes.csv")
    with pytest.raises(ConfigError, match=r"ros2\.yaml is a link"):
        RuntimeConfig.load(folder)
    with pytest.raises(ConfigError, match="no such folder or zip file"):
        RuntimeConfig.load(tmp_path / "none")
    (tmp_path / "file").write_text("x", encoding="utf-8")
    with pytest.raises(ConfigError, match="choose another folder"):
        example_bundle(tmp_path / "file")


def test_a_zip_of_another_program_is_taken_and_a_hostile_one_is_not(tmp_path):
    files = example().encoded()

    def packed(change):
        with zipfile.ZipFile(tmp_path / "b.zip", "w", zipfile.ZIP_DEFLATED) as out:
            for name, data in files.items():
                change(out, name, data)
        return tmp_path / "b.zip"

    assert RuntimeConfig.load(packed(lambda out, *each: out.writestr(*each))).model == example().model
    with pytest.raises(ConfigError, match="does not belong"):
        RuntimeConfig.load(packed(lambda out, name, data: out.writestr("../" + name, data)))
    with pytest.raises(ConfigError, match="expands more than 200 times"):
        RuntimeConfig.load(packed(lambda out, name, _: out.writestr(name, bytes(10**6))))
    with pytest.warns(UserWarning, match="Duplicate"), pytest.raises(ConfigError, match="appears twice"):
        RuntimeConfig.load(packed(lambda out, *each: (out.writestr(*each), out.writestr(*each))))


# ---- made --------------------------------------------------------------------------------------


def test_an_unverified_config_is_marked_and_says_why(tmp_path):
    config = example_bundle(tmp_path / "b", verified=False)
    assert not config.model.verified
    assert RuntimeConfig.load(tmp_path / "b").model.provenance.stale == config.model.provenance.stale != []


@pytest.fixture
def rebuild(monkeypatch):
    """Build the example with other arguments: a function of (calibration, probe file, named) that changes them."""

    def run(change):
        def build(calibration, probe_file, **named):
            arguments = change(calibration, probe_file, named)
            return build_config(*arguments, **{**named, "unverified": False})

        monkeypatch.setattr(bundle_example, "build_config", build)
        return bundle_example.example_config(300)

    return run


def test_reasons_refuse_an_export(rebuild):
    def change(calibration, probe_file, named):
        named["stale"] = ["The sensor was zeroed."]
        named["verification"] = named["verification"].model_copy(update={"passed": False})
        refused = Verdict(Level.REFUSE, ("Too few poses.",))
        opened = Probe.from_arrays(
            probe_file.probe.vertices, probe_file.probe.faces[1:], probe_file.probe.region[1:]
        )
        regions = RegionSet.from_labels(opened.region, probe_file.regions.regions)
        return dataclasses.replace(calibration, verdict=refused), ProbeFile(opened, regions, "P")

    with pytest.raises(UnverifiedError) as caught:
        rebuild(change)
    whole = " ".join(caught.value.reasons)
    assert len(caught.value.reasons) == 5
    for words in (
        "was zeroed",
        "was refused: Too few",
        "frame is P",
        "open or inside out",
        "verification failed",
    ):
        assert words in whole


def test_a_check_that_failed_refuses_an_export_and_one_that_cannot_tell_does_not(rebuild):
    done = example(clamped=True).model.checks
    for kind, words in (
        ("known_weight", "The known weight of 1 kg was measured as 1.002 kg"),
        ("known_touch", "The known touch was located 0.5 mm off"),
    ):
        for outcome in ("failed", "undecided"):
            part = getattr(done, kind).model_copy(update={"outcome": outcome})
            checks = done.model_copy(update={kind: part})

            def change(calibration, probe_file, named, checks=checks):
                named["checks"] = checks
                return calibration, probe_file

            if outcome == "undecided":
                assert rebuild(change).model.checks == checks
                continue
            with pytest.raises(UnverifiedError, match=words) as caught:
                rebuild(change)
            assert len(caught.value.reasons) == 1


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("zeroed", datetime(2026, 1, 1, tzinfo=UTC).replace(tzinfo=None), "zeroed has no time zone"),
        ("created", datetime(2026, 1, 1, tzinfo=UTC).replace(tzinfo=None), "no time zone"),
        ("noise", WrenchNoise(0.05, 0.002, np.eye(6)), "noise.extra"),
        ("filters", Filters(None, LowPass(20.0, 1000.0, 9)), "order is 9"),
        ("mount", (1.0, 1.0, 0.0, 0.0), "quaternion_ES has the length"),
        ("gates", Gates(max_age=float("inf")), "gates.max_age_s is inf"),
        ("operator", "\ud800", "provenance.operator"),
        ("model", TouchModel(torsion_arm=1.0), "touch.torsion_arm_m is 1.0"),
        ("model", TouchModel(model_error=WrenchNoise(0.1, 0.001, np.eye(6))), "touch.model_error.*extra"),
    ],
)
def test_nonsense_is_not_built(rebuild, name, value, words):
    def change(calibration, probe_file, named):
        named[name] = value
        return calibration, probe_file

    with pytest.raises(ConfigError, match=words):
        rebuild(change)


def test_the_model_of_a_touch_is_written_down():
    assert example(clamped=True).model.touch.model_dump() == {
        "torsion_arm_m": 0.002,
        "model_error": {
            "force_N": [0.04, 0.05, 0.06],
            "torque_Nm": [0.001, 0.0012, 0.0009],
            "measured": True,
        },
        "mesh_deviation_m": 5e-5,
        "mesh_curved": True,
        "torsion": "learned",
    }
    usual = example().model.touch
    assert usual.model_error.model_dump() == {
        "force_N": [0.05] * 3,
        "torque_Nm": [0.001] * 3,
        "measured": False,
    }
    assert usual.torsion_arm_m == 0.001


def test_odds_of_regions_are_those_that_the_solver_takes(rebuild):
    gates = Gates(region_odds=300.0, untouchable_odds=50.0)

    def change(calibration, probe_file, named):
        probe = probe_file.probe
        labels = np.arange(len(probe.faces)) % 6
        regions = [Region(f"r{rank}", "#123456", untouchable=rank in (1, 3)) for rank in range(1, 6)]
        named["gates"] = gates
        return calibration, ProbeFile(probe, RegionSet.from_labels(labels, regions), "S")

    config = rebuild(change)
    assert [each.odds for each in config.model.regions] == [0.02, 300.0, 0.02, 30.0, 10.0]
    assert config.probe.untouchable == (1, 3)
    assert RuntimeConfig.from_files(config.encoded()).probe.untouchable == (1, 3)
    odds = np.array([1.0, *(each.odds for each in config.model.regions)])
    expected = gates.bonus(config.probe.region, config.probe.untouchable)
    assert np.allclose(2 * np.log(odds)[config.probe.region], expected, rtol=1e-14, atol=0)


def test_without_filters_the_noise_is_that_of_a_reading(rebuild):
    def change(calibration, probe_file, named):
        named["filters"] = Filters(None)
        return calibration, probe_file

    assert np.diag(rebuild(change).model.noise.wrench_covariance)[0] > 0.05**2


def test_differences_are_named_with_what_they_mean():
    one, other = example(), example(2_000, verified=False)
    assert differences(one, one).same
    found = differences(one, other)
    assert found.mesh is not None
    assert found.mesh["facets"] == [1002, 2002]
    assert 0.1 < found.mesh["hausdorff_mm"] < 3
    fields = {each.field: each for each in found.fields}
    assert (fields["verified"].one, fields["verified"].other) == (True, False)
    assert fields["probe.facets"].meaning == "another surface"
    assert found.files == ("planes.csv", "probe.ply", "self_test.csv")
    assert io.StringIO(json.dumps(found.to_json())).read()


def test_the_checksum_names_the_file():
    assert checksum(b"") == hashlib.sha256(b"").hexdigest().encode() + b"  contactbench.json\n"


# ---- what a loader asks for --------------------------------------------------------------------


def test_every_unit_frame_and_kind_is_needed():
    whole = example().model.to_json()
    for part, name in (
        (whole["units"], "force"),
        (whole["frames"], "world"),
        (whole["filters"]["wrench"], "kind"),
        (whole, "version"),
    ):
        value = part.pop(name)
        with pytest.raises(ConfigError, match=name):
            decode_json(encode_json(whole), "c")
        part[name] = value
    assert decode_json(encode_json(whole), "c")[0] == example().model


def test_a_config_larger_than_a_mebibyte_is_refused():
    files = dict(example().encoded())
    files["contactbench.json"] += b" " * 2**20
    with pytest.raises(ConfigError, match="more than 1 MiB"):
        RuntimeConfig.from_files(files)


def test_a_bundle_that_is_replaced_while_it_is_read_is_one_of_the_two(tmp_path):
    one, other = example().encoded(), example(2_000).encoded()
    place = tmp_path / "b"
    write_folder(place, one, KNOWN)
    stop = threading.Event()

    def write():
        for turn in itertools.cycle((other, one)):
            if stop.is_set():
                return
            write_folder(place, turn, KNOWN)

    writer = threading.Thread(target=write)
    writer.start()
    try:
        for _ in range(150):
            assert read_bundle(place) in (one, other)
    finally:
        stop.set()
        writer.join()
