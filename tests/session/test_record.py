"""Recordings made inside a session: kept when they end, adopted when their process dies."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from terminal import invoke
from waiting import until

from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.faults import Fault, FaultEvent, Script, sine
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.recording import RecordingInfo, RecordingWriter, read_recording
from contactbench.pipeline.recording.recorder import Recorder
from contactbench.pipeline.session import Session, SessionError
from contactbench.pipeline.session.adoption import LiveRecording
from contactbench.pipeline.session.check import check, repair

ROOT = Path(__file__).parents[2]


def moving():
    return sine((0.5, 0.4, 0.3, 0.02, 0.03, 0.01), 3.0, (1.0, -2.0, 3.5, 0.1, -0.2, 0.05))


def samples(count, begin=0.0, level=0.0, status=Status.OK, seed=0):
    rng = np.random.default_rng(seed)
    rows = level + rng.normal(0, 0.02, (count, 6))
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
    code = "import sys; from contactbench.pipeline.cli import main; main()"
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device:
        command = [sys.executable, "-c", code, "session", "record", str(folder), "--source", device.url]
        with subprocess.Popen(
            [*command, "--serial", "SN 7", "--name", "a.mcap"], cwd=ROOT, stderr=subprocess.DEVNULL
        ) as child:
            until(lambda: _has_samples(recorded(folder)))
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


def _has_samples(file):
    return file.exists() and file.stat().st_size > 20_000


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
