"""Recordings made inside a session: kept when they end, adopted when their process dies."""

import json
import os
import signal
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation
from terminal import command, invoke, said
from waiting import until
from weighing_files import TRUTH, planned, weighed, write_euler

from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.faults import Fault, FaultEvent, Script, sine
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.recording import RecordingInfo, RecordingWriter, read_recording
from contactbench.pipeline.recording.recorder import Recorder
from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.adoption import LiveRecording
from contactbench.pipeline.session.archive import export_archive, import_archive
from contactbench.pipeline.session.check import check, repair
from contactbench.pipeline.session.recompute import companions_of, newest_inputs
from contactbench.pipeline.session.state import fold

ROOT = Path(__file__).parents[2]


def moving():
    return sine((0.5, 0.4, 0.3, 0.02, 0.03, 0.01), 3.0, (1.0, -2.0, 3.5, 0.1, -0.2, 0.05))


def samples(count, begin=0.0, level=0.0, status=Status.OK, seed=0):
    rows = level + np.random.default_rng(seed).normal(0, 0.02, (count, 6))
    return [
        WrenchSample(begin + n / 200, tuple(row[:3]), tuple(row[3:]), n, status)
        for n, row in enumerate(rows.tolist())
    ]


def recorded(folder, name="a.mcap"):
    return folder / "raw" / f"unfinished-{name}"


# ---- the command -------------------------------------------------------------------------------


def test_a_sensor_and_a_robot_become_an_input_with_counters(folder):
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device, emulator("elfin") as arm:
        options = ("--pose", arm.url, "--seconds", 1, "--serial", "SN 7", "--note", "first", "--json")
        result = invoke("session", "record", folder, "--source", device.url, *options)
    assert result.exit_code == 0, result.stderr
    facts = json.loads(result.stdout)
    with Session.open(folder, write=False) as session:
        [stored] = session.state.inputs
        record = session.records[-1]
    assert (stored.kind, stored.name, stored.sensor) == ("recording", facts["name"], "SN 7")
    assert record.entry.tool.startswith("contactbench ")
    assert record.entry.sensor == "SN 7"
    recording = read_recording(folder / stored.file.path)
    assert recording.complete
    assert recording.info.note == "first"
    assert recording.info.devices[0].serial == "SN 7"
    assert stored.about["streams"]["sensor"]["samples"] == len(recording.wrenches["/wrench"].times) > 100
    assert stored.about["streams"]["robot"]["samples"] == len(recording.flanges["/flange"].times) > 10
    assert check(folder).notes == ()
    assert check(folder).sound


def test_a_sensor_that_says_nothing_leaves_nothing_but_words(folder):
    result = invoke("session", "record", folder, "--source", "sri+serial:///dev/none", "--seconds", 0.3)
    assert result.exit_code == 1
    with Session.open(folder, write=False) as session:
        assert session.state.inputs == ()
        assert "without a sample" in session.state.notes[-1].text
    assert list((folder / "raw").iterdir()) == []


def test_a_rezero_and_a_stall_in_the_stream_become_events(folder):
    script = Script([FaultEvent(0.6, Fault.REZERO), FaultEvent(1.2, Fault.STALL, 0.4)])
    steady = sine((0.01,) * 6, 3.0, (5.0, -2.0, 13.5, 0.4, -0.2, 0.05))
    with emulator("sri", "tcp", rate=200.0, signal=steady, script=script) as device:
        result = invoke(
            "session", "record", folder, "--source", device.url, "--seconds", 2, "--name", "a.mcap", "--json"
        )
    assert result.exit_code == 0, result.stderr
    assert len(json.loads(result.stdout)["suspicions"]) == 1
    with Session.open(folder, write=False) as session:
        [stored] = session.state.inputs
    events = read_recording(folder / stored.file.path).events
    assert [each.name for each in events].count("suspicion") == 1
    assert "silent" in [each.fields["state"] for each in events if each.name == "stream"]


def test_a_recording_can_be_replayed_into_a_session(folder, tmp_path):
    with RecordingWriter(tmp_path / "a.mcap", RecordingInfo(1_700_000_000_000_000_000, 0.0)) as writer:
        for sample in samples(400):
            writer.wrench(sample)
    address = f"replay://{tmp_path / 'a.mcap'}?speed=step"
    result = invoke("session", "record", folder, "--source", address)
    assert result.exit_code == 0, result.stderr
    with Session.open(folder, write=False) as session:
        [stored] = session.state.inputs
    assert len(read_recording(folder / stored.file.path).wrenches["/wrench"].times) == 400


@pytest.mark.parametrize(
    "arguments",
    [
        ("--source", "nonsense"),
        ("--source", "elfin+tcp://127.0.0.1"),
        ("--source", "sri+tcp://127.0.0.1", "--seconds", "0"),
        ("--source", "sri+tcp://127.0.0.1", "--seconds", "1", "--name", "../a.mcap"),
    ],
)
def test_wrong_input_ends_with_2_and_leaves_nothing(folder, arguments):
    assert invoke("session", "record", folder, *arguments).exit_code == 2
    assert list((folder / "raw").iterdir()) == []
    assert len(Session.open(folder, write=False).records) == 1


def test_words_and_a_rezero_are_in_the_journal(folder, tmp_path):
    (tmp_path / "p.csv").write_bytes(b"x")
    with Session.open(folder) as session:
        sha256 = session.add_input(tmp_path / "p.csv", "poses", sensor="42").action.file.sha256
        session.add_result("report", "r.txt", {"r.txt": b""}, {"poses": sha256}, {})
    assert invoke("session", "note", folder, "new cable").exit_code == 0
    result = invoke("session", "rezero", folder, "--serial", "42", "--reason", "new cable", "--json")
    assert json.loads(result.stdout)["stale"] == ["report r.txt"]
    with Session.open(folder, write=False) as session:
        assert session.state.notes[-1].text == "new cable"
        assert session.records[-1].entry.sensor == "42"
        assert session.records[-1].entry.by


# ---- the recorder ------------------------------------------------------------------------------


def test_a_status_becomes_an_event_and_flicker_does_not_fill_the_file(tmp_path):
    flicker = [samples(1, n / 1000, status=Status(n % 2))[0] for n in range(1000)]
    with RecordingWriter(tmp_path / "a.mcap", RecordingInfo.now()) as writer, Recorder(writer) as recorder:
        recorder.samples(flicker)
    events = [each for each in read_recording(tmp_path / "a.mcap").events if each.name == "status"]
    assert 1 <= len(events) <= 11
    assert events[0].fields == {"device": "sensor", "before": 0, "now": 1}


def test_samples_are_on_the_disk_though_no_more_come(tmp_path):
    writer = RecordingWriter(tmp_path / "a.mcap", RecordingInfo.now(), chunk_seconds=1e6, sync_seconds=1e6)
    with writer, Recorder(writer, flush_seconds=0.01) as recorder:
        recorder.samples(samples(10))
        until(lambda: read_recording(tmp_path / "a.mcap").wrenches)
        assert len(read_recording(tmp_path / "a.mcap").wrenches["/wrench"].times) == 10


def test_a_sample_that_cannot_be_recorded_is_counted_and_a_full_disk_ends_it(tmp_path):
    with RecordingWriter(tmp_path / "a.mcap", RecordingInfo.now()) as writer:
        with Recorder(writer) as recorder:
            recorder.samples(samples(1, begin=float("nan")))
            recorder.samples(samples(3))
        assert (recorder.skipped, recorder.error) == (1, None)
        with Recorder(writer) as recorder, pytest.MonkeyPatch.context() as patch:
            patch.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError(28, "full")))
            recorder.samples(samples(3))
            assert recorder.failed.wait(10)
            recorder.samples(samples(3))
        assert "full" in str(recorder.error)
    assert len(read_recording(tmp_path / "a.mcap").wrenches["/wrench"].times) >= 3


# ---- what dies in the middle -------------------------------------------------------------------


@pytest.mark.skipif(os.name == "nt", reason="kill is TerminateProcess there, the same by another name")
def test_a_killed_recording_is_adopted_by_repair(folder):
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device:
        words = command("session", "record", folder, "--source", device.url)
        words += ["--serial", "SN 7", "--name", "a.mcap"]
        with subprocess.Popen(words, cwd=ROOT, stderr=subprocess.DEVNULL) as child:
            file = recorded(folder)
            until(lambda: file.exists() and file.stat().st_size > 20_000)
            child.send_signal(signal.SIGKILL)
            child.wait(60)
    assert check(folder).sound
    assert "session repair" in " ".join(check(folder).notes)
    with Session.open(folder) as session:
        assert "ended abruptly" in session.notes[-1]
    raw = recorded(folder).read_bytes()
    [words] = repair(folder).adopted
    assert "ended abruptly at 2" in words
    with Session.open(folder) as session:
        [stored] = session.state.inputs
        assert session.notes == ()
        assert session.state.notes[-1].text == words
    assert (stored.kind, stored.name, stored.sensor) == ("recording", "a.mcap", "SN 7")
    assert (folder / stored.file.path).read_bytes() == raw
    found = read_recording(folder / stored.file.path)
    assert stored.about["wrenches"] == len(found.wrenches["/wrench"].times) > 0
    assert not found.complete
    assert check(folder).sound
    assert check(folder).notes == ()
    assert repair(folder).adopted == ()


@pytest.mark.parametrize("moment", ["link", "append", "unlink"])
def test_a_crash_while_it_is_kept_loses_nothing(folder, monkeypatch, moment):
    def die(*_arguments, **_named):
        raise KeyboardInterrupt

    with Session.open(folder, by="ada") as session:
        live = LiveRecording(session, RecordingInfo.now(), sensor="42", name="a.mcap")
        with live:
            live.recorder.samples(samples(300))
        owner, call = {"link": (os, "link"), "append": (Session, "_append"), "unlink": (Path, "unlink")}[
            moment
        ]
        with monkeypatch.context() as patch:
            patch.setattr(owner, call, die)
            with pytest.raises(KeyboardInterrupt):
                live.keep({})
    repair(folder)
    with Session.open(folder) as session:
        [stored] = session.state.inputs
    assert len(read_recording(folder / stored.file.path).wrenches["/wrench"].times) == 300
    assert check(folder).sound
    assert not recorded(folder).exists()


def test_what_is_left_without_samples_or_unreadable(folder):
    (recorded(folder, "empty.mcap")).write_bytes(b"")
    (recorded(folder, "foreign.mcap")).write_bytes(b"no recording" * 20)
    RecordingWriter(recorded(folder, "begun.mcap"), RecordingInfo.now()).flush()
    said = " ".join(repair(folder).adopted)
    for words in ("never started", "cannot be read and is kept", "before its first sample"):
        assert words in said
    with Session.open(folder) as session:
        assert [(each.kind, each.name) for each in session.state.inputs] == [("unreadable", "foreign.mcap")]
        assert session.notes == ()


def test_a_recording_needs_a_session_that_is_open_for_writing(folder):
    with Session.open(folder, write=False) as session, pytest.raises(SessionError, match="read-only"):
        LiveRecording(session, RecordingInfo.now())
    assert list((folder / "raw").iterdir()) == []


# ---- results from recordings, probes with companions ---------------------------------------------


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
    done("add", folder, write_euler(tmp_path / "typed.csv", weighed()), "--kind", "poses")
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

    done("add", folder, write_euler(tmp_path / "poses.csv", weighed()), "--kind", "poses")
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
