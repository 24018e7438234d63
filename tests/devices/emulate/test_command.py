from __future__ import annotations

import json
import signal
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from pipeline.commands.emulate import emulate_app
from pipeline.devices.emulate import EmulatorError
from pipeline.devices.transport import line_to
from pipeline.devices.url import DeviceAddress

runner = CliRunner()


def test_the_first_line_is_the_address():
    ended = runner.invoke(emulate_app, ["sri", "--pty", "--seconds", "0.05", "--fault", "stall@2+0.5"])
    assert ended.exit_code == 0
    assert DeviceAddress.parse(ended.stdout.splitlines()[0]).baud == 115_200
    ended = runner.invoke(emulate_app, ["rdt", "--port", "0", "--seconds", "0.05", "--json"])
    assert DeviceAddress.parse(json.loads(ended.stdout)["url"]).profile == "ati"
    assert "0 commands refused" in ended.stderr


@pytest.mark.parametrize("options", [["--pty", "--port", "1"], ["--seconds", "0"]])
def test_contradictions_are_refused(options: list[str]):
    assert runner.invoke(emulate_app, ["sri", *options]).exit_code == 2


def test_wrong_devices_and_faults_are_refused():
    for arguments in (["other"], ["bota", "--port", "0"], ["sri", "--fault", "rest@1"]):
        assert isinstance(runner.invoke(emulate_app, arguments).exception, EmulatorError)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_runs_until_it_is_ended(number: signal.Signals):
    command = [sys.executable, "-m", "pipeline.commands.emulate", "elfin"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        line = line_to(DeviceAddress.parse(process.stdout.readline().decode().strip()))
        line.open()
        line.write(b"ReadActPos,0,;")
        assert line.read(10.0).data.startswith(b"ReadActPos,OK,")
        line.close()
        process.send_signal(number)
        assert process.wait(20) == 0
