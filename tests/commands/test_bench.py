"""bench run and bench serve, as a user calls them."""

import csv
import json
import signal
import subprocess
from functools import partial

import numpy as np
import terminal
from terminal import said

from contactbench.pipeline.recording import read_recording

SCRIPT = """# turn, touch, re-zero
{"at": 0.1, "do": "turn_to", "rpy": [0, 30, 0], "seconds": 0.2}
{"after": 0.1, "do": "touch", "marker": 3, "force": 9, "seconds": 0.4}
{"after": 0.1, "do": "rezero"}
{"after": 0.2, "do": "end"}
"""


invoke = partial(terminal.invoke, "bench")


def test_a_run_is_recorded_with_its_truth_and_the_same_bytes_again(tmp_path):
    script = tmp_path / "a.jsonl"
    script.write_text(SCRIPT, encoding="utf-8")
    for name in ("a", "b"):
        files = ["--out", tmp_path / f"{name}.mcap", "--truth", tmp_path / f"{name}.csv"]
        result = invoke("run", script, *files, "--seed", 3, "--json")
        assert result.exit_code == 0, result.stderr
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "b.mcap").read_bytes()
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    facts = json.loads(result.stdout)
    recording = read_recording(tmp_path / "a.mcap")
    track = recording.wrenches["/wrench"]
    assert facts["wrenches"] == len(track.times)
    assert facts["flanges"] == len(recording.flanges["/flange"].times)
    # A re-zero behind the user's back is in the truth only.
    told = [event.fields["do"] for event in recording.events if event.name == "bench"]
    assert told == ["turn_to", "touch", "end"]
    rows = list(csv.DictReader((tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()))
    assert len(rows) == len(track.times)
    commands = [c["do"] for row in rows if row["command"] for c in json.loads(row["command"])]
    assert commands == ["turn_to", "touch", "rezero"]  # nothing is measured after the end
    pressed = [float(row["contact_fz_N"]) for row in rows if row["contacts"] != "0"]
    np.testing.assert_allclose(pressed[-10:], -9.0, atol=0.01)


def test_what_the_script_is_called_changes_no_byte(tmp_path):
    for name in ("a", "elsewhere/b"):
        script = tmp_path / f"{name}.jsonl"
        script.parent.mkdir(exist_ok=True)
        script.write_text('{"at": 0.05, "do": "end"}\n', encoding="utf-8")
        assert invoke("run", script, "--out", tmp_path / f"{name}.mcap").exit_code == 0
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "elsewhere/b.mcap").read_bytes()
    (device, *_) = read_recording(tmp_path / "a.mcap").info.devices
    assert "probe=t-shape" in device.address
    assert str(tmp_path) not in device.address


def test_no_file_that_is_there_is_written_over(tmp_path):
    script, taken = tmp_path / "a.jsonl", tmp_path / "notes.csv"
    script.write_text(SCRIPT, encoding="utf-8")
    taken.write_text("mine", encoding="utf-8")
    out = tmp_path / "a.mcap"
    for truth, message in (
        (script, "this file exists"),
        (taken, "this file exists"),
        (out, "need different files"),
        (tmp_path / "no/t.csv", "there is no folder"),
    ):
        result = invoke("run", script, "--out", out, "--truth", truth)
        assert result.exit_code == 2
        assert message in said(result)
    assert (script.read_text(encoding="utf-8"), taken.read_text(encoding="utf-8")) == (SCRIPT, "mine")
    assert sorted(tmp_path.iterdir()) == [script, taken]


def test_a_script_that_fails_midway_leaves_nothing_that_looks_complete(tmp_path):
    script = tmp_path / "a.jsonl"
    script.write_text('{"at": 0.3, "do": "touch", "marker": 99}\n', encoding="utf-8")
    result = invoke("run", script, "--out", tmp_path / "a.mcap", "--truth", tmp_path / "a.csv")
    assert result.exit_code == 2
    assert "line 1: touch: there is no marker 99" in said(result)
    assert list(tmp_path.iterdir()) == [script]


def test_a_touch_that_slides_off_is_said_and_recorded(tmp_path):
    script = tmp_path / "a.jsonl"
    script.write_text(
        '{"at": 0.1, "do": "touch", "marker": 3, "tilt": 80, "seconds": 1.5}\n', encoding="utf-8"
    )
    result = invoke("run", script, "--out", tmp_path / "a.mcap", "--json")
    assert "touch at 0.10 s pressed nothing" in said(result)
    assert json.loads(result.stdout)["slipped"] == [0.1]
    (event,) = [event for event in read_recording(tmp_path / "a.mcap").events if event.name == "slipped"]
    assert (event.fields["touched_at"], event.fields["marker"]) == (0.1, 3)


def test_a_bad_script_ends_with_its_line(tmp_path):
    script = tmp_path / "a.jsonl"
    script.write_text('{"at": 1, "do": "dance"}\n', encoding="utf-8")
    result = invoke("run", script, "--out", tmp_path / "a.mcap")
    assert result.exit_code == 2
    assert "line 1: do 'dance': choose one of turn_to" in said(result)
    assert not (tmp_path / "a.mcap").exists()


def test_serve_says_its_addresses_obeys_and_ends():
    command = terminal.command("bench", "serve", "--probe", "linear")
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        urls = json.loads(process.stdout.readline())
        assert urls["sensor"].startswith("sri+tcp://127.0.0.1:")
        assert urls["robot"].startswith("elfin+tcp://127.0.0.1:")
        for line in ('{"do": "turn_to", "rpy": [0, 30, 0]}', '{"do": "touch"}', "nonsense"):
            process.stdin.write(line + "\n")
            process.stdin.flush()
        answers = [json.loads(process.stdout.readline()) for _ in range(3)]
        assert answers[0]["until"] - answers[0]["at"] > 0.4
        assert "either marker" in answers[1]["error"]
        assert "not valid JSON" in answers[2]["error"]
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=20)
        assert process.returncode == 0, errors


def test_a_bench_that_is_not_ideal_is_recorded_with_what_it_was(tmp_path):
    script = tmp_path / "a.jsonl"
    script.write_text(SCRIPT, encoding="utf-8")
    for name, mix in (("ideal", "ideal"), ("plain", None), ("real", "typical,cable=2")):
        more = [] if mix is None else ["--reality", mix]
        assert invoke("run", script, "--out", tmp_path / f"{name}.mcap", *more).exit_code == 0
    assert (tmp_path / "ideal.mcap").read_bytes() == (tmp_path / "plain.mcap").read_bytes()
    assert (tmp_path / "real.mcap").read_bytes() != (tmp_path / "plain.mcap").read_bytes()
    (device, *_) = read_recording(tmp_path / "real.mcap").info.devices
    assert "reality=typical,cable%3D2" in device.address


def test_the_table_of_reality_has_every_effect_and_every_mix():
    shown = invoke("reality")
    assert shown.exit_code == 0
    assert all(word in shown.stdout for word in ("cable", "pose_latency", "typical", "harsh", "mrad/N·m"))
    told = json.loads(invoke("reality", "cable=2", "--json").stdout)
    assert told["cable=2"]["cable"] == 2
    assert told["ideal"]["scale"] == 1
    assert invoke("reality", "cable=-2").exit_code == 2
