"""record and ports, against an emulated sensor."""

import dataclasses
import itertools
import json
import os
import signal
import subprocess
import threading

import numpy as np
import pytest
from benchmarks.faults import resting
from recording.recording_cases import record
from terminal import command, invoke, said
from waiting import be_slow

from contactbench.pipeline.commands.record import Changes, wait
from contactbench.pipeline.console import Ended
from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.faults import Fault, FaultEvent, Script, sine
from contactbench.pipeline.devices.protocols import Counters
from contactbench.pipeline.devices.stream import Health, StreamState
from contactbench.pipeline.recording import (
    Event,
    RecordingError,
    RecordingReader,
    RecordingWriter,
    read_recording,
)
from contactbench.pipeline.recording.recorder import Recorder


def moving():
    return sine((0.5, 0.4, 0.3, 0.02, 0.03, 0.01), 3.0, (1.0, -2.0, 3.5, 0.1, -0.2, 0.05))


def test_what_a_sensor_sends_is_in_the_file(tmp_path):
    out = tmp_path / "a.mcap"
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device:
        result = invoke(
            "record", "start", device.url, "--out", out, "--seconds", 1, "--note", "bench 3", "--json"
        )
    assert result.exit_code == 0, result.stderr
    facts = json.loads(result.stdout)
    recording = read_recording(out)
    track = recording.wrenches["/wrench"]
    assert facts["sensor"]["samples"] == len(track.times) > 100
    assert facts["sensor"]["lost"] == facts["sensor"]["bad_checksums"] == 0
    assert recording.complete
    assert recording.info.note == "bench 3"
    assert (np.diff(track.sequence) == 1).all()
    sent = {entry.frame[6:30] for entry in device.intact()}
    given = {row.astype("<f4").tobytes() for row in track.wrenches}
    assert given <= sent


def test_samples_that_the_sensor_flags_are_counted_at_the_end(tmp_path):
    with emulator("line", "tcp", options={"fields": "fx,fy,fz,mx,my,mz,status"}) as device:
        result = invoke(
            "record", "start", f"{device.url}&ok=1", "--out", tmp_path / "a.mcap", "--seconds", 0.5, "--json"
        )
    facts = json.loads(result.stdout)
    assert facts["unusable"] == facts["sensor"]["samples"] > 0
    assert f"{facts['unusable']} of the sensor's samples are flagged as unusable" in result.output


def test_a_robot_beside_the_sensor(tmp_path):
    out = tmp_path / "a.mcap"
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device, emulator("elfin") as arm:
        result = invoke(
            "record", "start", device.url, "--pose", arm.url, "--out", out, "--seconds", 1, "--json"
        )
    assert result.exit_code == 0, result.stderr
    track = read_recording(out).flanges["/flange"]
    assert json.loads(result.stdout)["robot"]["samples"] == len(track.times) > 10
    assert track.joints.shape == (len(track.times), 6)
    assert invoke("record", "delay", out).exit_code in (1, 2)  # it stood still, or too short
    converted = invoke("record", "convert", out, "--out", tmp_path / "a.csv")
    assert converted.exit_code == 0, converted.stderr
    assert (tmp_path / "a.csv").read_text(encoding="utf-8").startswith("t,fx,fy,fz,mx,my,mz,qw,qx,qy,qz")


def test_a_gap_stays_a_gap_and_is_kept_as_an_event(tmp_path):
    out = tmp_path / "a.mcap"
    script = Script([FaultEvent(0.3, Fault.STALL, 0.4)])
    with emulator("sri", "serial", rate=200.0, signal=moving(), script=script) as device:
        result = invoke("record", "start", device.url, "--out", out, "--seconds", 1.2)
    assert result.exit_code == 0, result.stderr
    recording = read_recording(out)
    assert np.diff(recording.wrenches["/wrench"].times).max() > 0.3
    states = [event.fields["state"] for event in recording.events]
    assert "silent" in states
    assert states[-1] in ("streaming", "closed")


def test_a_device_that_comes_and_goes_is_counted_and_not_repeated(tmp_path):
    out = tmp_path / "a.mcap"
    script = Script([FaultEvent(0.3 + 0.6 * gap, Fault.STALL, 0.4) for gap in range(4)])
    with emulator("sri", "serial", rate=200.0, signal=moving(), script=script) as device:
        result = invoke("record", "start", device.url, "--out", out, "--seconds", 2.8)
    assert result.exit_code == 0, result.stderr
    states = [event.fields["state"] for event in read_recording(out).events]
    assert states.count("silent") > 2  # the recording has every one
    lines = [line for line in result.output.splitlines() if line.startswith("sensor: ")]
    assert sum(line.startswith("sensor: silent:") for line in lines) == 1
    assert sum(" again: " in line and " times in " in line for line in lines) == 1


def test_a_sensor_that_is_not_there(tmp_path):
    result = invoke(
        "record", "start", "sri+serial:///dev/no-such-port", "--out", tmp_path / "a.mcap", "--seconds", 0.3
    )
    assert result.exit_code == 1
    assert "cannot be opened" in said(result)
    assert "Wrote" not in result.output
    assert list(tmp_path.iterdir()) == []  # the next try may have the name


def test_a_slow_disk_does_not_hold_the_device_up(tmp_path, monkeypatch):
    flush = RecordingWriter.flush
    threads = set()

    def slow(self):
        threads.add(threading.current_thread().name)
        be_slow(0.2)
        flush(self)

    monkeypatch.setattr(RecordingWriter, "flush", slow)
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device:
        result = invoke(
            "record", "start", device.url, "--out", tmp_path / "a.mcap", "--seconds", 1.5, "--json"
        )
    facts = json.loads(result.stdout)["sensor"]
    assert threads == {"recorder"}
    assert 0 <= facts["lateness_p99_s"] <= facts["lateness_max_s"] < 0.15
    times = read_recording(tmp_path / "a.mcap").wrenches["/wrench"].times
    assert (np.diff(times) > 0).mean() > 0.9  # none waited for the disk


def test_a_stream_that_fails_is_told_and_what_came_is_kept(tmp_path, monkeypatch):
    taken = Recorder.samples

    def failing(self, samples):
        taken(self, samples)
        raise ValueError("of the recorder")

    monkeypatch.setattr(Recorder, "samples", failing)
    out = tmp_path / "a.mcap"
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device:
        result = invoke("record", "start", device.url, "--out", out, "--seconds", 30)
    assert result.exit_code == 1
    assert "of the recorder" in said(result)
    assert read_recording(out).complete


def test_a_closed_standard_error_does_not_end_a_recording(tmp_path):
    out = tmp_path / "a.mcap"
    read, write = os.pipe()
    os.close(read)
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device:
        words = command("record", "start", device.url, "--out", out, "--seconds", 1)
        subprocess.run(words, stderr=write, check=False, timeout=30)
    os.close(write)
    track = read_recording(out)
    assert track.complete
    assert len(track.wrenches["/wrench"].times) > 100


def test_a_rezero_is_told_at_the_end(tmp_path):
    script = Script([FaultEvent(0.6, Fault.REZERO, 9.0)])
    device = emulator("sri", "tcp", rate=200.0, signal=lambda time: resting(time), script=script)
    with device:
        result = invoke(
            "record", "start", device.url, "--out", tmp_path / "a.mcap", "--seconds", 1.3, "--json"
        )
    assert "re-zeroed" in json.loads(result.stdout)["suspicions"][0]
    assert "re-zeroed" in said(result)


@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_signals_end_a_recording_well_however_often_they_come(tmp_path, number):
    out = tmp_path / "a.mcap"
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device:
        words = command("record", "start", device.url, "--out", out)
        with subprocess.Popen(words, stderr=subprocess.PIPE, text=True) as process:
            line = process.stderr.readline()
            while "streaming" not in line:
                assert line
                line = process.stderr.readline()
            for _ in range(3):
                process.send_signal(getattr(signal, number))
            rest = process.stderr.read()
    assert process.returncode == 0, rest
    assert "Traceback" not in rest
    assert read_recording(out).complete


def samples_of(file):
    with RecordingReader(file) as reader:
        return [(topic, sample) for topic, sample in reader if not isinstance(sample, Event)]


def fields_of(sample):
    """Return all that a sample holds, to the bit."""
    values = [getattr(sample, field.name) for field in dataclasses.fields(sample)]
    return [value.tobytes() if isinstance(value, np.ndarray) else value for value in values]


def test_a_replay_is_recorded_to_the_bit(tmp_path):
    first, again = record(tmp_path / "a.mcap"), tmp_path / "b.mcap"
    address = f"replay://{first}?speed=step"
    result = invoke("record", "start", address, "--pose", address, "--out", again, "--json")
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["sensor"]["samples"] == 400
    one, two = samples_of(first), samples_of(again)
    assert len(two) == 600
    for (topic, sample), (other_topic, other) in zip(one, two, strict=True):
        assert (topic, fields_of(sample)) == (other_topic, fields_of(other))
    old, new = read_recording(first).info, read_recording(again).info
    assert (new.started_ns, new.clock) == (old.started_ns, old.clock)
    assert [device.serial for device in new.devices] == ["SN 1", ""]
    assert new.devices[0].address == address
    assert read_recording(again).complete


def test_a_replay_at_a_pace_ends_the_command_and_gives_the_same(tmp_path):
    first, again = record(tmp_path / "a.mcap", 100, 0), tmp_path / "b.mcap"
    result = invoke("record", "start", f"replay://{first}?speed=10", "--out", again)
    assert result.exit_code == 0, result.stderr
    assert [fields_of(s) for _, s in samples_of(again)] == [fields_of(s) for _, s in samples_of(first)]
    states = [event.fields["state"] for event in read_recording(again).events if event.name == "stream"]
    assert (states[0], states[-1]) == ("streaming", "closed")


def test_a_replay_can_be_cut(tmp_path):
    first, again = record(tmp_path / "a.mcap"), tmp_path / "b.mcap"
    result = invoke("record", "start", f"replay://{first}", "--out", again, "--seconds", 0.3)
    assert result.exit_code == 0, result.stderr
    assert 0 < len(samples_of(again)) < 400


def test_a_replay_beside_a_typed_pose(tmp_path):
    first, again = record(tmp_path / "a.mcap", 400, 0), tmp_path / "b.mcap"
    result = invoke(
        "record", "start", f"replay://{first}?speed=step", "--pose", "still://?rpy=0,90,0", "--out", again
    )
    assert result.exit_code == 0, result.stderr
    flanges = read_recording(again).flanges["/flange"]
    assert flanges.times == pytest.approx(1000 + np.arange(20) / 10)


def test_a_sensor_beside_poses_from_a_file(tmp_path):
    out, poses = tmp_path / "a.mcap", tmp_path / "poses.csv"
    poses.write_text("t,qw,qx,qy,qz\n" + "".join(f"{t / 100},1,0,0,0\n" for t in range(40)), encoding="utf-8")
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device:
        result = invoke(
            "record", "start", device.url, "--pose", f"poses://{poses}", "--out", out, "--seconds", 30
        )
    assert result.exit_code == 0, result.stderr
    recording = read_recording(out)  # the end of the poses ended it
    assert len(recording.flanges["/flange"].times) == 40
    wrench = recording.wrenches["/wrench"]
    assert abs(wrench.times[0] - recording.flanges["/flange"].times[0]) < 5.0  # on one clock


def test_a_replay_that_breaks_off_is_kept_and_told(tmp_path, monkeypatch):
    first, again = record(tmp_path / "a.mcap"), tmp_path / "b.mcap"
    inner = RecordingReader.__iter__

    def failing(self):
        yield from itertools.islice(inner(self), 100)
        raise RecordingError("a.mcap: the disk cannot be read: copy the file.")

    monkeypatch.setattr(RecordingReader, "__iter__", failing)
    result = invoke("record", "start", f"replay://{first}?speed=step", "--out", again)
    monkeypatch.undo()
    assert result.exit_code == 1
    assert "copy the file" in said(result)
    assert 0 < len(samples_of(again)) < 100


@pytest.mark.parametrize(
    ("sensor", "pose", "part"),
    [
        ("replay://{0}/none.mcap", None, "no such file"),
        ("replay://{0}/text.mcap", None, "not an MCAP file"),
        ("replay://{0}/poses.mcap?speed=step", None, "no wrenches"),
        ("replay://{0}/wrenches.mcap", "replay://{0}/wrenches.mcap", "no poses"),
        ("replay://{0}/wrenches.mcap", "poses://{0}/none.csv", "no such file"),
        ("replay://{0}/wrenches.mcap", "ur+tcp://127.0.0.1", "different clocks"),
        ("sri+tcp://127.0.0.1", "replay://{0}/poses.mcap", "different clocks"),
        ("sri+tcp://127.0.0.1", "still://", "rpy"),
        ("sri+tcp://127.0.0.1", "still://?robot=hal&joints=1", "hal"),
        ("still://?rpy=0,0,0", None, "not a force/torque sensor"),
    ],
)
def test_sources_that_do_not_give_it_leave_no_file(tmp_path, sensor, pose, part):
    (tmp_path / "text.mcap").write_text("t,fx\n", encoding="utf-8")
    record(tmp_path / "wrenches.mcap", 10, 0)
    record(tmp_path / "poses.mcap", 0, 10)
    before = sorted(tmp_path.iterdir())
    arguments = ["record", "start", sensor.format(tmp_path), "--out", tmp_path / "out.mcap"]
    result = invoke(*arguments, *(["--pose", pose.format(tmp_path)] if pose else []))
    assert result.exit_code == 2
    assert part in said(result)
    assert sorted(tmp_path.iterdir()) == before


def test_a_replay_is_not_recorded_over_itself(tmp_path):
    file = record(tmp_path / "a.mcap")
    before = file.read_bytes()
    assert invoke("record", "start", f"replay://{file}?speed=step", "--out", file).exit_code == 2
    assert file.read_bytes() == before


@pytest.mark.parametrize(
    "arguments",
    [
        ("record", "elfin+tcp://127.0.0.1", "--out", "a.mcap"),
        ("record", "nonsense", "--out", "a.mcap"),
        ("record", "sri+tcp://127.0.0.1", "--out", "a.mcap", "--seconds", "0"),
        ("record", "sri+serial:///dev/x?rate=5000", "--out", "a.mcap"),
    ],
)
def test_wrong_input_ends_with_2(tmp_path, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    assert invoke(*arguments).exit_code == 2
    assert list(tmp_path.iterdir()) == []


def test_ports_are_listed():
    result = invoke("record", "ports", "--json")
    assert result.exit_code == 0
    assert isinstance(json.loads(result.stdout)["ports"], list)


# ---- changes of devices ----------------------------------------------------------------------------


class Device:
    """Tells changes of one device at times of a clock that is set by hand."""

    def __init__(self, name: str = "sensor") -> None:
        self.name, self.now = name, 0.0
        self.changes = Changes(lambda: self.now)

    def is_now(
        self, state: StreamState, *findings: str, suspicions: tuple[str, ...] = (), after: float = 0.0
    ) -> None:
        self.now += after
        health = Health(state, findings, 0, None, None, Counters(), 0, suspicions)
        self.changes.tell(self.name, health)


def test_what_is_new_is_said_at_once(capsys: pytest.CaptureFixture[str]) -> None:
    device = Device()
    device.is_now(StreamState.CONNECTING)
    device.is_now(StreamState.STREAMING)
    device.is_now(StreamState.SILENT, "No sample for 0.4 s.")
    device.is_now(StreamState.SILENT, "No sample for 0.9 s.", suspicions=("It was re-zeroed.",))
    assert capsys.readouterr().err.splitlines() == [
        "sensor: connecting",
        "sensor: streaming",
        "sensor: silent: No sample for 0.4 s.",
        "sensor: silent: No sample for 0.9 s. It was re-zeroed.",
    ]
    device.changes.end()
    assert capsys.readouterr().err == ""


def test_repeats_are_counted_and_the_line_ends_with_how_it_is_now(capsys: pytest.CaptureFixture[str]) -> None:
    device = Device()
    for _ in range(38):
        device.is_now(StreamState.SILENT, f"No sample for {device.now} s.", after=0.0625)
        device.is_now(StreamState.STREAMING, after=0.0625)
    lines = capsys.readouterr().err.splitlines()
    assert lines == ["sensor: silent: No sample for 0.0 s.", "sensor: streaming"]
    device.changes.tick()
    assert capsys.readouterr().err == ""  # not yet
    device.now += 1.0
    device.changes.end()
    assert capsys.readouterr().err.splitlines() == ["sensor: silent, then streaming again: 37 times in 6 s"]
    device.changes.end()
    assert capsys.readouterr().err == ""


def test_ten_minutes_of_coming_and_going_are_a_line_every_five_seconds(
    capsys: pytest.CaptureFixture[str],
) -> None:
    device = Device()
    for _ in range(1200):
        device.is_now(StreamState.SILENT, f"No sample for {device.now} s.", after=0.25)
        device.is_now(StreamState.STREAMING, after=0.25)
    device.changes.end()
    lines = capsys.readouterr().err.splitlines()
    assert 100 < len(lines) <= 600 / 5 + 3
    counted = [line for line in lines if " times in 5 s" in line]
    assert len(counted) == len(lines) - 3
    assert all("streaming" in line and "silent" in line for line in counted)


def test_what_waits_is_said_without_another_change(capsys: pytest.CaptureFixture[str]) -> None:
    device = Device()
    for state in (StreamState.STREAMING, StreamState.SILENT, StreamState.STREAMING, StreamState.SILENT):
        device.is_now(state, *(["It has no power."] if state is StreamState.SILENT else []))
    capsys.readouterr()
    device.now = 4.9
    device.changes.tick()
    assert capsys.readouterr().err == ""
    device.now = 5.0
    device.changes.tick()
    assert capsys.readouterr().err == "sensor: streaming, then silent again: once in 5 s: It has no power.\n"


def test_a_repeat_after_a_quiet_time_is_news(capsys: pytest.CaptureFixture[str]) -> None:
    device = Device()
    device.is_now(StreamState.STREAMING)
    device.is_now(StreamState.LOST, "The line is open.")
    device.is_now(StreamState.STREAMING, after=60.0)
    device.is_now(StreamState.LOST, "The line is open.", after=3600.0)
    assert capsys.readouterr().err.splitlines() == 2 * [
        "sensor: streaming",
        "sensor: lost: The line is open.",
    ]


def test_what_waits_comes_before_what_is_new(capsys: pytest.CaptureFixture[str]) -> None:
    device = Device()
    for state in (StreamState.STREAMING, StreamState.SILENT, StreamState.STREAMING, StreamState.CLOSED):
        device.is_now(state)
    assert capsys.readouterr().err.splitlines()[2:] == ["sensor: streaming", "sensor: closed"]


def test_devices_are_counted_apart(capsys: pytest.CaptureFixture[str]) -> None:
    device = Device()
    device.is_now(StreamState.STREAMING)
    device.name = "robot"
    device.is_now(StreamState.STREAMING)
    assert capsys.readouterr().err.splitlines() == ["sensor: streaming", "robot: streaming"]


def test_words_that_differ_each_time_do_not_flood_either(capsys: pytest.CaptureFixture[str]) -> None:
    device = Device()
    for number in range(1000):
        device.is_now(StreamState.LOST, "x" * number)
    assert len(capsys.readouterr().err.splitlines()) <= 50


def test_a_closed_terminal_is_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **_more: object) -> None:
        raise BrokenPipeError

    monkeypatch.setattr("contactbench.pipeline.commands.record.say", broken)
    Device().is_now(StreamState.STREAMING)


def test_lines_that_wait_are_looked_at_while_it_records() -> None:
    class Source:
        """A source that goes by steps, and is finished after three."""

        streams, stepwise, steps = (), True, 0

        @property
        def finished(self) -> bool:
            return self.steps == 3

        def step(self, _count: int) -> None:
            self.steps += 1

    class Looks:
        count = 0

        def tick(self) -> None:
            self.count += 1

    looks = Looks()
    wait(Source(), None, Ended(), threading.Event(), looks)
    assert looks.count == 3


def test_lines_that_wait_at_the_end_are_said(tmp_path, monkeypatch):
    ends = []
    monkeypatch.setattr(Changes, "end", lambda _changes: ends.append(threading.active_count()))
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device:
        before = threading.active_count()
        result = invoke("record", "start", device.url, "--out", tmp_path / "a.mcap", "--seconds", 0.3)
        assert result.exit_code == 0, result.stderr
    assert len(ends) == 1
    assert ends[0] <= before  # after the streams


def test_devices_are_listed_with_their_options():
    result = invoke("record", "devices", "--json")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert found["left_out"] == []
    rdt = next(each for each in found["devices"] if each["scheme"] == "rdt")
    assert rdt["carriers"] == ["udp"]
    assert rdt["options"].keys() == {"profile", "cpf", "cpt"}
    assert "profile: Maker of the box" in invoke("record", "devices").output
