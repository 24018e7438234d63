"""The command, and as a program with real pipes and signals."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
from collections import Counter
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import pytest
from config.runtime.bundles import example, example_bundle
from mcap.reader import make_reader
from runtime.runtime_recordings import BEGIN, record, samples
from terminal import invoke
from waiting import until

from contactbench.pipeline.commands import run as command_of_run
from contactbench.pipeline.commands.run import PatchLines
from contactbench.pipeline.contact.patch import Bed, PatchReader
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo
from contactbench.pipeline.runtime.run import fit_words, load_words, rate_that_fits, rate_warning

if TYPE_CHECKING:
    from pathlib import Path

    from click.testing import Result

COUNT = 1_500
BENCH = ("--source", "virtual://bench", "--pose", "virtual://bench")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with bundles and a recording in which poses are missing for 0.3 s."""
    folder = tmp_path_factory.mktemp("run")
    example_bundle(folder / "bundle")
    example_bundle(folder / "unverified.zip", verified=False)
    record(folder / "r.mcap", samples(example(), COUNT, gap=slice(600, 900)))
    return folder


def command(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "contactbench.pipeline.cli", "run", *map(str, arguments)]


def run(*arguments: object) -> Result:
    """Run it in this process, which has imported everything: only --out, --mcap and --udp can be looked at."""
    return invoke("run", *arguments)


def replay(folder: Path, speed: str = "step") -> tuple[str, ...]:
    address = f"replay://{folder / 'r.mcap'}?speed={speed}"
    return ("--source", address, "--pose", address)


def test_all_outputs_say_the_same(folder: Path, tmp_path: Path) -> None:
    import jsonschema  # takes its time

    out, mcap = tmp_path / "c.jsonl", tmp_path / "c.mcap"
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8_000_000)
        listener.bind(("127.0.0.1", 0))
        listener.settimeout(0.2)
        place = f"127.0.0.1:{listener.getsockname()[1]}"
        done = run(folder / "bundle", *replay(folder, "4"), "--out", out, "--mcap", mcap, "--udp", place)
        first = json.loads(listener.recv(4096))
    assert done.exit_code == 1, done.stderr  # more than 5 % of the samples have no pose
    assert "{" not in done.stdout
    rows = [json.loads(line) for line in out.read_text(encoding="utf-8").splitlines()]
    assert len(rows) == COUNT
    assert first == rows[0]
    with mcap.open("rb") as file:
        messages = list(make_reader(file).iter_messages())
    kept = [json.loads(message.data) for _, _, message in messages]
    schema = json.loads(messages[0][0].data)
    types = re.findall(r'"type": (\S+?)[,}]', messages[0][0].data.decode())
    assert set(types) <= {
        f'"{kind}"' for kind in ("boolean", "integer", "number", "string", "object", "array")
    }
    jsonschema.validate(kept, {"type": "array", "items": schema | {"additionalProperties": False}})
    assert [(row["time"], row["reason"]) for row in kept] == [(row["time"], row["reason"]) for row in rows]
    # Poses come every 10 ms and are carried on for 150: of 300 ms without, 150 are stale.
    stale = [i for i, row in enumerate(rows) if row["reason"] == "stale"]
    assert stale[:9] == list(range(9))
    assert 140 <= len(stale) - 9 <= 165
    assert [i for i, row in enumerate(rows) if row["health"] == ["no_pose"]] == stale
    assert f"unhealthy: no_pose {len(stale)}." in done.output
    assert "of the samples could not be used" in done.output
    middle = 1e3 * np.median([row["latency_s"] for row in rows])
    (told,) = re.findall("latency: median ([0-9.]+) ms", done.output)
    assert float(told) == pytest.approx(middle, rel=0.03)
    assert middle > 1  # a replay has no other latency than the filter's
    assert f"located: {COUNT:,} samples" in done.output
    assert f"{out}: {COUNT:,} contacts published, 0 not." in done.output.replace("\n", "")
    assert "sensor: streaming" in done.output
    assert "robot: closed" in done.output


def test_json_is_one_object_with_the_counts(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "c.jsonl"
    done = run(folder / "bundle", *replay(folder), "--out", out, "--igtl", "127.0.0.1:0", "--json")
    assert done.exit_code == 1  # poses are missing
    facts = json.loads(done.stdout)
    reasons = [json.loads(line)["reason"] for line in out.read_text(encoding="utf-8").splitlines()]
    assert facts["reasons"] == Counter(reasons)
    assert (facts["samples"], facts["good"]) == (COUNT, False)
    assert 0 <= facts["latency_s"]["median"] <= facts["latency_s"]["p99"]
    assert [each["device"] for each in facts["streams"]] == ["sensor", "robot"]
    assert [(each["published"], each["lost"], each["error"]) for each in facts["outputs"]] == [
        (COUNT, 0, None)
    ] * 2
    assert "error" not in facts


@pytest.mark.parametrize("output", [(), ("--out", "-"), ("--udp", "127.0.0.1:9", "--out", "-")])
def test_json_and_contacts_cannot_both_use_standard_output(folder: Path, output: tuple[str, ...]) -> None:
    done = run(folder / "bundle", *replay(folder), *output, "--json")
    assert done.exit_code == 2
    assert "both use standard output" in json.loads(done.stdout)["error"]


def test_an_output_that_published_nothing_has_failed(folder: Path, tmp_path: Path) -> None:
    pytest.importorskip("paho")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))  # nobody listens
        place = f"127.0.0.1:{free.getsockname()[1]}/bench"
        arguments = (*replay(folder), "--out", tmp_path / "c", "--mqtt", place)
        done = run(folder / "bundle", *arguments, "--json")
    assert done.exit_code == 2
    facts = json.loads(done.stdout)
    assert facts["error"].startswith(f"MQTT {place}: ")
    assert facts["error"] == facts["outputs"][0]["error"]
    assert [(each["published"], each["lost"]) for each in facts["outputs"]] == [(0, COUNT), (COUNT, 0)]
    assert f"error: MQTT {place}: " in done.output


def test_a_patch_is_said_beside_contacts_that_stay_as_they_are(folder: Path, tmp_path: Path) -> None:
    address = replay(folder)
    assert run(folder / "bundle", *address, "--out", tmp_path / "plain").exit_code == 1
    done = run(folder / "bundle", *address, "--patch", "flat", "--out", tmp_path / "soft")
    assert done.exit_code == 1
    assert (tmp_path / "soft").read_bytes() == (tmp_path / "plain").read_bytes()
    refused = run(folder / "bundle", *address, "--patch", "round")
    assert refused.exit_code == 2
    assert "patch 'round': give flat" in refused.output


def test_a_line_a_second_says_that_the_point_is_a_centre_of_pressure(monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    monkeypatch.setattr(command_of_run, "say", lambda text, _: said.append(text))
    probe = example().probe
    point = np.array([0.0, 0.0, probe.vertices[:, 2].max()])
    lines = PatchLines(PatchReader(probe, Bed()))
    for step in range(25):
        contact = SimpleNamespace(
            time=step / 10, wrench=np.array([0, 0, -7.0, 0, 0, 0]), accepted=True, point=point,
            covariance=1e-8 * np.eye(3),
        )  # fmt: skip
        lines.take(cast("Any", None), cast("Any", SimpleNamespace(contact=contact)))
        lines.say_new()
        lines.say_new()  # nothing came meanwhile
    assert [each.partition(" s: ")[0] for each in said] == ["0.0", "1.0", "2.0"]
    assert all(" s: The point is the centre of pressure of a patch" in each for each in said)


def test_the_pace_of_a_replay_changes_nothing(folder: Path, tmp_path: Path) -> None:
    for speed in ("50", "step"):
        assert run(folder / "bundle", *replay(folder, speed), "--out", tmp_path / speed).exit_code == 1
    stepped = (tmp_path / "step").read_bytes()
    assert len(stepped.splitlines()) == COUNT
    assert (tmp_path / "50").read_bytes() == stepped


def test_an_unverified_bundle_is_refused_unless_asked_for(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "c.jsonl"
    refused = run(folder / "unverified.zip", *BENCH, "--seconds", "0.2", "--out", out)
    assert refused.exit_code == 2
    assert "--unverified" in refused.output
    assert not out.exists()
    done = run(folder / "unverified.zip", *BENCH, "--seconds", "0.3", "--unverified", "--out", out)
    assert done.exit_code == 0, done.stderr
    assert "NOT VERIFIED" in done.output
    assert len(out.read_text(encoding="utf-8").splitlines()) > 10


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--udp", "192.0.2.1:9000"), "--allow-remote"),
        (("--igtl", "0.0.0.0:18944"), "--allow-remote"),
        (("--mqtt", "127.0.0.1:1883"), "give a topic"),
        (("--dds", "1000"), "ROS domain"),
        (("--out", "/nowhere/at/all"), "/nowhere/at/all"),
        (("--seconds", "-1"), "--seconds"),
    ],
)
def test_what_cannot_be_is_refused_before_it_begins(
    folder: Path, arguments: tuple[str, ...], says: str
) -> None:
    done = run(folder / "bundle", *BENCH, *arguments)
    assert done.exit_code == 2
    assert says in done.output
    assert done.stdout == ""


@pytest.mark.parametrize(
    ("option", "address", "package"),
    [
        ("--foxglove", "127.0.0.1:0", "foxglove"),
        ("--dds", "1", "cyclonedds"),
        ("--mqtt", "127.0.0.1:1883/a", "paho"),
    ],
)
def test_a_missing_package_names_its_extra(
    folder: Path, monkeypatch: pytest.MonkeyPatch, option: str, address: str, package: str
) -> None:
    for name in [
        name for name in sys.modules if name.startswith((package, "contactbench.pipeline.runtime."))
    ]:
        if name.startswith(package) or name.endswith("_target"):
            monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, package, None)
    done = run(folder / "bundle", *BENCH, option, address)
    assert done.exit_code == 2
    assert f"{option} needs {package}, which is not installed: pip install 'contactbench[live]'" in " ".join(
        done.output.split()
    )


def test_help_needs_none_of_the_packages() -> None:
    code = (
        "import sys; from contactbench.pipeline.cli import app\n"
        "try: app(['run', '--help'])\n"
        "except SystemExit: pass\n"
        "sys.exit(bool({'foxglove', 'cyclonedds', 'paho', 'contactbench.pipeline.devices.protocols.igtl'}"
        " & {*sys.modules}))"
    )
    assert (
        subprocess.run([sys.executable, "-c", code], stdout=subprocess.DEVNULL, check=False).returncode == 0
    )


def test_contacts_are_served_while_it_runs(folder: Path) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        place = free.getsockname()
    arguments = (*BENCH, "--igtl", f"{place[0]}:{place[1]}", "--seconds", "2")
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    with subprocess.Popen(command(folder / "bundle", *arguments), **pipes) as process:
        client = until(lambda: connected(place))
        with client:
            data = b""
            while piece := client.recv(65_536):
                data += piece
        said = process.stdout.read().decode()
        assert process.wait(20) == ("could not be used" in said), said
    assert data.count(b"SENSOR\0\0\0\0\0\0ContactWrench") > 50
    assert b"STATUS\0\0\0\0\0\0ContactStatus" in data
    assert f"OpenIGTLink 127.0.0.1:{place[1]}:" in said
    assert re.search(r"processor: \d+% of a core at \d+ samples per second", " ".join(said.split()))


@pytest.mark.parametrize(
    ("rate", "load", "says"),
    [
        (None, 1.0, "None"),
        (960.0, 1.0, "None"),
        (600.0, 0.4, "The sensor sends 600 "),
        (600.0, 0.9, "Only 600 of 1000 samples per second are handled, and this program uses 90%"),
        (1_500.0, 0.9, "The sensor sends 1500 "),
    ],
)
def test_what_is_too_slow_is_named(rate: float | None, load: float, says: str) -> None:
    assert str(rate_warning(example(), rate, load)).startswith(says)


def test_how_many_contacts_would_fit() -> None:
    assert "about 2,500 would fit" in str(load_words(1_000.0, 0.4))
    assert load_words(None, 0.4) is load_words(1_000.0, 0.0) is None


def connected(place: tuple[str, int]) -> socket.socket | None:
    try:
        return socket.create_connection(place, timeout=20)
    except ConnectionRefusedError:
        return None


def test_no_bundle(tmp_path: Path) -> None:
    done = run(tmp_path / "none", *BENCH)
    assert done.exit_code == 2
    assert "none" in done.output


def test_another_sensor_and_another_rate_are_said(folder: Path, tmp_path: Path) -> None:
    about = RecordingInfo(
        1_700_000_000_000_000_000, BEGIN, (DeviceInfo("wrench", "/wrench", "sri+tcp://h", "M9", "S2"),)
    )
    file = record(tmp_path / "o.mcap", samples(example(), 600)[::2], about)
    address = f"replay://{file}?speed=step"
    out = tmp_path / "c.jsonl"
    streams = ("--source", address, "--pose", "still://?rpy=0,0,0")
    refused = run(folder / "bundle", *streams, "--out", out)
    assert refused.exit_code == 2
    assert "--other-sensor" in refused.output
    assert not out.exists()
    done = run(folder / "bundle", *streams, "--out", out, "--other-sensor")
    assert done.exit_code == 0, done.stderr
    assert "serial number is S2, but the bundle is for V-0001" in done.output
    assert "model is M9, but the bundle is for virtual" in done.output
    assert "the bundle is for 1000" in done.output
    assert "because the poses have no positions: 1 kg at 1 m/s² adds 1 N" in " ".join(done.output.split())
    reasons = {json.loads(line)["reason"] for line in out.read_text(encoding="utf-8").splitlines()}
    assert "stale" not in reasons  # a pose that was typed never gets old


@pytest.mark.skipif(os.name == "nt", reason="signals")
@pytest.mark.parametrize("kind", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_well(folder: Path, tmp_path: Path, kind: signal.Signals) -> None:
    with subprocess.Popen(
        command(folder / "bundle", *BENCH, "--out", "-", "--mcap", tmp_path / "c.mcap"),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        lines = [process.stdout.readline() for _ in range(50)]
        process.send_signal(kind)
        # Not communicate(): it does not see what readline() has read ahead.
        rest, said = process.stdout.read(), process.stderr.read()
    assert process.returncode == ("could not be used" in said), (
        said
    )  # on a busy machine samples may come too late
    count = len(lines) + len(rest.splitlines())
    told = [json.loads(line) for line in (*lines, *rest.splitlines())]
    located = sum(row["health"] != ["silent"] for row in told)
    assert all(row["latency_s"] is not None for row in told if row["health"] != ["silent"])
    with (tmp_path / "c.mcap").open("rb") as file:
        assert len(list(make_reader(file).iter_messages())) == count
    assert f"located: {located:,} samples" in said


@pytest.mark.skipif(os.name == "nt", reason="pipes")
def test_a_reader_that_goes_away_ends_it_quietly(folder: Path) -> None:
    with subprocess.Popen(
        command(folder / "bundle", *BENCH), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        process.stdout.readline()
        process.stdout.close()
        said = process.stderr.read()
        # On a busy machine samples may come too late: then it is 1, and said.
        assert process.wait(20) == ("could not be used" in said), said
    assert "Traceback" not in said
    assert "standard output" in said


@pytest.mark.skipif(os.name == "nt", reason="pipes")
def test_a_reader_that_stops_reading_delays_no_sample(folder: Path) -> None:
    # A pipe holds 64 KiB, some eighty contacts: a run that waited for it would locate no more than those.
    with subprocess.Popen(
        command(folder / "bundle", *BENCH, "--seconds", "1.5"), stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stderr is not None
        said = process.stderr.read().decode()
        assert process.wait(20) == 2, said
    assert "nanobind" not in said
    assert "no output was accepted" in said
    assert int(said.split("located: ")[1].split()[0].replace(",", "")) >= 250
    assert "standard output" in said


def test_a_run_says_before_it_begins_what_fits() -> None:
    config = example()
    few, many = (rate_that_fits(config, names) for names in ((), ("igtl", "dds", "mqtt")))
    assert 10 < many < 0.8 * few < 1e6
    rate = config.model.sensor.rate_Hz
    assert fit_words(config, 1.01 * rate)[1] is False
    words, slow = fit_words(config, 0.99 * rate)
    assert slow
    assert f"{0.99 * rate:,.0f} contacts per second fit" in words
    assert "use fewer outputs" in words
