"""Results from recordings, probes with companions, and alignments: computed in a session, and once more."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation
from terminal import invoke, said
from weighing_files import TRUTH, planned, weighed, write_euler

from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.recording import RecordingInfo, RecordingWriter
from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.archive import export_archive, import_archive
from contactbench.pipeline.session.check import check
from contactbench.pipeline.session.companions import companions_of
from contactbench.pipeline.session.recompute import newest_inputs
from contactbench.pipeline.session.state import fold

HOLD, MOVE, RATE = 3.0, 1.0, 100
SIMPLE = ("--set", "facets=40", "--set", "engine=fast-simplification", "--set", "alpha=6")


def done(*arguments):
    result = invoke("session", *arguments, "--json")
    assert result.exit_code == 0, result.stderr + str(result.exception)
    return json.loads(result.stdout)


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """A robot that goes through five poses, and stays in each."""
    file = tmp_path_factory.mktemp("recording") / "a.mcap"
    stops = Rotation.from_matrix(planned(5))
    rng = np.random.default_rng(3)
    t = 0.0
    with RecordingWriter(file, RecordingInfo(1_700_000_000_000_000_000, 0.0)) as writer:
        for number in range(len(stops)):
            for row in range(round((HOLD + MOVE) * RATE)):
                moved = max(row / RATE - HOLD, 0) / MOVE
                after = stops[min(number + 1, len(stops) - 1)]
                R = (
                    stops[number] * Rotation.from_rotvec(moved * (stops[number].inv() * after).as_rotvec())
                ).as_matrix()
                force = R.T @ TRUTH.gravity_W
                torque = np.cross(TRUTH.centre_of_mass_S, force) + TRUTH.torque_bias
                w = np.concatenate((force + TRUTH.force_bias, torque)) + rng.normal(0, 0.01, 6) / [
                    1,
                    1,
                    1,
                    50,
                    50,
                    50,
                ]
                writer.wrench(WrenchSample(t, tuple(w[:3].tolist()), tuple(w[3:].tolist())))
                writer.flange(FlangeSample(t, R, np.zeros(3)))
                t += 1 / RATE
    return file


def test_from_a_recording_to_a_calibration_that_is_the_same_again(folder, recording, tmp_path):
    done("add", folder, recording, "--kind", "recording", "--serial", "42")
    done("compute", folder, "captures", "poses.csv", "--set", "delay=0")
    done("compute", folder, "calibration", "c.json")
    with Session.open(folder, write=False) as session:
        captures, calibration = session.state.results
        assert calibration.action.inputs == {"poses": captures.content}
        made = folder / captures.file.path
        assert json.loads((folder / calibration.file.path).read_bytes())["mass_kg"] == pytest.approx(
            0.62, abs=0.03
        )
    assert invoke("calibrate", "captures", recording, "--out", tmp_path / "p.csv").exit_code == 0
    assert made.read_bytes() == (tmp_path / "p.csv").read_bytes()
    assert done("replay", folder)["same"] == 2
    stale = done("rezero", folder, "--serial", "42", "--reason", "new cable")["stale"]
    assert stale == ["calibration c.json", "captures poses.csv"]
    assert "re-zeroed" in done("compute", folder, "calibration", "d.json")["stale"][0]


def test_the_newest_poses_are_taken_or_the_named_ones(folder, recording, tmp_path):
    done("add", folder, recording, "--kind", "recording")
    done("compute", folder, "captures", "poses.csv")
    typed = write_euler(tmp_path / "typed.csv", weighed())
    done("add", folder, typed, "--kind", "poses")
    with Session.open(folder, write=False) as session:
        state = session.state
    raw, computed = state.current_inputs["poses", "typed.csv"], state.results[0]
    assert newest_inputs(state, "calibration") == {"poses": raw.content}
    assert newest_inputs(state, "calibration", {"poses": "poses.csv"}) == {"poses": computed.content}
    for kind, chosen, words in (
        ("calibration", {"poses": "none.csv"}, "no poses called none.csv"),
        ("calibration", {"mesh": "a.ply"}, "is computed from poses"),
        ("photo", {}, "choose one of captures"),
        ("probe", {}, "session has no mesh"),
    ):
        with pytest.raises(SessionError, match=words):
            newest_inputs(state, kind, chosen)
    done("compute", folder, "calibration", "c.json", "--input", "poses=poses.csv")
    assert invoke("session", "compute", folder, "calibration", "c.json", "--input", "poses").exit_code == 2


def test_too_few_poses_are_refused_with_the_reason(folder, tmp_path):
    with RecordingWriter(tmp_path / "a.mcap", RecordingInfo(1, 0.0)) as writer:
        for row in range(300):
            writer.wrench(WrenchSample(row / 100, (1.0, 2.0, row % 3 / 100), (0.1, 0.0, row % 2 / 1000)))
            writer.flange(FlangeSample(row / 100, np.eye(3), np.zeros(3)))
    done("add", folder, tmp_path / "a.mcap", "--kind", "recording")
    result = invoke("session", "compute", folder, "captures", "poses.csv")
    assert result.exit_code == 2
    assert "hold more poses" in said(result)


# ---- probes ------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def ball(tmp_path_factory) -> Path:
    """A probe as ``probe prepare`` writes it: PLY, and JSON beside it."""
    folder = tmp_path_factory.mktemp("ball")
    (folder / "ball.stl").write_bytes(trimesh.creation.icosphere(1, 30.0).export(file_type="stl"))
    out = folder / "ball.ply"
    options = ("--facets", 60, "--alpha", 6, "--engine", "fast-simplification", "--units", "mm")
    assert invoke("probe", "prepare", folder / "ball.stl", *options, "--out", out).exit_code == 0
    return out


def test_a_probe_brings_its_json_file(folder, ball, tmp_path):
    added = done("add", folder, ball, "--kind", "mesh")
    assert list(added["companions"]) == ["ball.json"]
    stored = folder / added["companions"]["ball.json"]
    assert stored.read_bytes() == ball.with_suffix(".json").read_bytes()
    done("compute", folder, "probe", "p.ply", *SIMPLE)
    assert done("replay", folder)["same"] == 1
    with Session.open(folder, write=False) as session:
        made = session.state.results[0].action.files["p.json"]
    steps = [each["step"] for each in json.loads((folder / made.path).read_bytes())["history"]]
    assert steps.count("simplify") == 2  # the history goes on
    export_archive(folder, tmp_path / "s.zip")
    import_archive(tmp_path / "s.zip", tmp_path / "back")
    assert done("replay", tmp_path / "back")["same"] == 1
    stored.unlink()
    assert "is missing" in check(folder).problems[0]


def test_another_json_file_beside_the_same_surface_makes_it_stale(folder, ball, tmp_path):
    done("add", folder, ball, "--kind", "mesh")
    done("compute", folder, "probe", "p.ply", *SIMPLE)
    again = tmp_path / "ball.ply"
    again.write_bytes(ball.read_bytes())
    document = json.loads(ball.with_suffix(".json").read_bytes())
    again.with_suffix(".json").write_text(json.dumps({**document, "note": "other"}), encoding="utf-8")
    assert done("add", folder, again, "--kind", "mesh")["stale"] == ["probe p.ply"]
    assert done("add", folder, ball, "--kind", "mesh")["stale"] == []
    assert done("replay", folder)["same"] == 1
    with Session.open(folder, write=False) as session:
        assert not any(session.stale().values())


def test_companions_are_given_or_found(ball, tmp_path):
    assert companions_of(ball) == {"ball.json": ball.with_suffix(".json")}
    assert companions_of(ball, [ball.with_suffix(".stl")]).keys() == {"ball.json", "ball.stl"}
    (tmp_path / "a.ply").write_bytes(b"")
    assert companions_of(tmp_path / "a.ply") == {}
    (tmp_path / "a.json").write_bytes(b"[")  # another program's
    assert companions_of(tmp_path / "a.ply") == {}
    with pytest.raises(SessionError, match="the same name"):
        companions_of(ball, [ball])


def test_an_alignment_is_an_input_of_a_probe(folder, ball, tmp_path):
    saved = tmp_path / "where.json"
    options = ("--place", "0,0,40,0,0,90", "--out", tmp_path / "aligned.ply", "--save", saved)
    assert invoke("probe", "align", ball, *options).exit_code == 0
    done("add", folder, ball.with_suffix(".stl"), "--kind", "mesh")
    done("add", folder, saved, "--kind", "alignment")
    done("compute", folder, "probe", "p.ply", "--set", "units=mm", *SIMPLE)
    assert done("replay", folder)["same"] == 1
    with Session.open(folder, write=False) as session:
        action = session.state.results[0].action
    assert set(action.inputs) == {"mesh", "alignment"}
    assert json.loads((folder / action.files["p.json"].path).read_bytes())["mesh"]["frame"] == "S"
    mount = ("--set", "mount=[0,0,40,0,0,90]")
    result = invoke("session", "compute", folder, "probe", "q.ply", "--set", "units=mm", *SIMPLE, *mount)
    assert "contradict" in said(result)
    done("compute", folder, "probe", "q.ply", "--set", "units=mm", *SIMPLE, *mount, "--input", "alignment=")
    saved.write_bytes(saved.read_bytes() + b"\n")
    assert done("add", folder, saved, "--kind", "alignment")["stale"] == ["probe p.ply"]


# ---- version 1 ---------------------------------------------------------------------------------


def test_a_session_of_version_1_goes_on(folder, tmp_path):
    from contactbench.pipeline.session import journal

    poses = write_euler(tmp_path / "poses.csv", weighed())
    done("add", folder, poses, "--kind", "poses")
    done("compute", folder, "calibration", "c.json", "--set", "euler=xyz")
    found = journal.scan((folder / "journal").read_bytes())
    payloads = [json.loads(frame.payload) for frame in found.frames]
    payloads[0]["action"]["version"] = 1
    for name in ("companions", "about"):
        del payloads[1]["action"][name]
    (folder / "journal").write_bytes(journal.encode_all(map(journal.canonical, payloads)))
    assert done("replay", folder)["same"] == 1
    with Session.open(folder) as session:
        assert "migrated from version 1 to 2" in session.notes[0]
        assert session.state.inputs[0].content == session.state.inputs[0].file.sha256
        assert not any(session.stale().values())
        assert session.state == fold(session.records)
    assert (folder / "journal.v1").exists()
    assert check(folder).sound
    assert done("replay", folder)["same"] == 1
