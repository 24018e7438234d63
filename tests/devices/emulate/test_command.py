import json
import signal
import subprocess
from functools import partial
from pathlib import Path

import pytest
import terminal

from contactbench.pipeline.devices.transport import line_to
from contactbench.pipeline.devices.url import DeviceAddress

invoke = partial(terminal.invoke, "bench", "emulate")


def test_the_first_line_is_the_address():
    ended = invoke("sri", "--pty", "--seconds", 0.05, "--fault", "stall@2+0.5")
    assert ended.exit_code == 0
    assert DeviceAddress.parse(ended.stdout.splitlines()[0]).baud == 115_200
    ended = invoke("rdt", "--port", 0, "--seconds", 0.05, "--json")
    assert DeviceAddress.parse(json.loads(ended.stdout)["url"]).options["profile"] == "ati"
    assert "0 commands refused" in ended.stderr


@pytest.mark.parametrize("options", [["--pty", "--port", "1"], ["--seconds", "0"]])
def test_contradictions_are_refused(options: list[str]):
    assert invoke("sri", *options).exit_code == 2


def test_wrong_devices_and_faults_are_refused():
    for arguments in (["other"], ["bota", "--port", "0"], ["sri", "--fault", "rest@1"]):
        assert "error:" in invoke(*arguments).stderr


def test_wrong_tools_are_refused():
    assert invoke("ur", "--option", "tool=0,0,0").exit_code == 2
    assert "error:" in invoke("sri", "--option", "tool=0,0,0,0,0,0").stderr
    arguments = ["ur", "--option", "tool=0,0,0.1,0,0,1", "--quirk", "older", "--seconds", "0.05"]
    assert invoke(*arguments).exit_code == 0


COMMAND = terminal.command("bench", "emulate")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_runs_until_it_is_ended(number: signal.Signals):
    with subprocess.Popen([*COMMAND, "elfin"], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        line = line_to(DeviceAddress.parse(process.stdout.readline().decode().strip()))
        line.open()
        line.write(b"ReadActPos,0,;")
        assert line.read(10.0).data.startswith(b"ReadActPos,OK,")
        line.close()
        process.send_signal(number)
        assert process.wait(20) == 0


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="this system has no such signal")
def test_a_closed_terminal_leaves_nothing_behind():
    heard = signal.signal(
        signal.SIGHUP, signal.SIG_DFL
    )  # tests under nohup would have it ignored, as is right
    try:
        process = subprocess.Popen([*COMMAND, "sri", "--pty"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    finally:
        signal.signal(signal.SIGHUP, heard)
    with process:
        assert process.stdout is not None
        link = Path(process.stdout.readline().decode().strip().removeprefix("sri+serial://"))
        assert link.is_symlink()
        for _ in range(3):  # the first one counts, and the others disturb nothing
            process.send_signal(signal.SIGHUP)
        assert process.wait(20) == 0
        assert process.stderr is not None
        assert b"Traceback" not in process.stderr.read()
    assert not link.parent.exists()
