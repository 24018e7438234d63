"""record and ports, against an emulated sensor."""

from __future__ import annotations

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from pipeline import cli
from pipeline.devices.emulate import Fault, FaultEvent, Script, emulator, sine
from pipeline.recording import read_recording


def invoke(*arguments):
    return CliRunner().invoke(cli.app, [str(argument) for argument in arguments])


def moving():
    return sine((0.5, 0.4, 0.3, 0.02, 0.03, 0.01), 3.0, (1.0, -2.0, 3.5, 0.1, -0.2, 0.05))


def test_what_a_sensor_sends_is_in_the_file(tmp_path):
    out = tmp_path / "a.mcap"
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device:
        result = invoke("record", device.url, "--out", out, "--seconds", 1, "--note", "bench 3", "--json")
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


def test_a_robot_beside_the_sensor(tmp_path):
    out = tmp_path / "a.mcap"
    with emulator("sri", "tcp", rate=200.0, signal=moving()) as device, emulator("elfin") as arm:
        result = invoke("record", device.url, "--pose", arm.url, "--out", out, "--seconds", 1, "--json")
    assert result.exit_code == 0, result.stderr
    recording = read_recording(out)
    track = recording.flanges["/flange"]
    assert json.loads(result.stdout)["robot"]["samples"] == len(track.times) > 10
    assert track.joints.shape == (len(track.times), 6)
    assert invoke("recording", "delay", out).exit_code in (1, 2)  # it stood still, or too short
    converted = invoke("recording", "convert", out, "--out", tmp_path / "a.csv")
    assert converted.exit_code == 0, converted.stderr
    assert (tmp_path / "a.csv").read_text().startswith("t,fx,fy,fz,mx,my,mz,qw,qx,qy,qz")


def test_a_gap_stays_a_gap_and_is_kept_as_an_event(tmp_path):
    out = tmp_path / "a.mcap"
    script = Script([FaultEvent(0.3, Fault.STALL, 0.4)])
    with emulator("sri", "serial", rate=200.0, signal=moving(), script=script) as device:
        result = invoke("record", device.url, "--out", out, "--seconds", 1.2)
    assert result.exit_code == 0, result.stderr
    recording = read_recording(out)
    assert np.diff(recording.wrenches["/wrench"].times).max() > 0.3
    states = [event.fields["state"] for event in recording.events]
    assert "silent" in states
    assert states[-1] in ("streaming", "closed")


def test_a_sensor_that_is_not_there(tmp_path):
    result = invoke(
        "record", "sri+serial:///dev/no-such-port", "--out", tmp_path / "a.mcap", "--seconds", 0.3
    )
    assert result.exit_code == 1
    assert "cannot be opened" in " ".join(result.stderr.split())


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
    result = invoke("ports", "--json")
    assert result.exit_code == 0
    assert isinstance(json.loads(result.stdout)["ports"], list)


@pytest.mark.parametrize("command", ["record", "ports"])
def test_help_has_an_example(command):
    assert f"Example: contactbench {command}" in " ".join(invoke(command, "--help").stdout.split())
