"""Emulators on real lines, read through the transports and decoded by the parsers."""

import contextlib
import time
from collections.abc import Callable

import numpy as np
import pytest
from waiting import JumpingClock, until

from contactbench.pipeline.devices.emulate import Emulator, emulated, emulator, possible_faults, swinging
from contactbench.pipeline.devices.faults import SYNTHETIC, EmulatorError, Fault, Script, Six, constant
from contactbench.pipeline.devices.protocols import bota, elfin, rdt, robotiq, sri, ur_pose
from contactbench.pipeline.devices.protocols.commands import Command
from contactbench.pipeline.devices.protocols.parser import SensorParser
from contactbench.pipeline.devices.sample import Status, WrenchSample
from contactbench.pipeline.devices.transport import Line, LineError, LineLost, line_to
from contactbench.pipeline.devices.url import DeviceAddress

SENSORS = ("sri", "bota", "robotiq", "rdt")
RATE = 400.0
PATIENCE_S = 10.0
PAUSE_S = 0.05

START: dict[str, Callable[[], tuple[Command, ...]]] = {
    "sri": lambda: sri.start_commands(RATE),
    "bota": lambda: bota.start_commands(RATE),
    "robotiq": robotiq.start_commands,
    "rdt": lambda: rdt.start_commands(RATE),
}
PARSER: dict[str, Callable[[], SensorParser]] = {
    "sri": sri.SriParser,
    "bota": bota.BotaParser,
    "robotiq": robotiq.RobotiqParser,
    "rdt": lambda: rdt.RdtParser(rdt.ATI_TYPICAL),
}


class Host:
    """The other end: opens, starts and decodes."""

    def __init__(self, device: Emulator, protocol: str) -> None:
        self.device = device
        self.protocol = protocol
        self.line: Line = line_to(DeviceAddress.parse(device.url))
        self.parser = PARSER[protocol]()
        self.samples: list[WrenchSample] = []
        self.start()

    def start(self) -> None:
        self.line.open()
        commands = START[self.protocol]()
        for command in commands:
            self.line.write(command.data)
            if command.reply is not None:
                self._await(command.reply)
            elif command is not commands[-1]:
                self._settle()

    def read_until(self, done: Callable[[], bool]) -> list[WrenchSample]:
        end = time.monotonic() + PATIENCE_S
        while not done():
            assert time.monotonic() < end, "it never came"
            chunk = self.line.read(0.05)
            self.samples += self.parser.feed(chunk.data, chunk.time)
        return self.samples

    def _settle(self) -> None:
        """Read until nothing more comes, as after a stop: its answer, and the end of the stream."""
        while self.line.read(PAUSE_S).data:
            pass

    def _await(self, reply: bytes) -> None:
        end, seen = time.monotonic() + PATIENCE_S, b""
        while reply not in seen:
            assert time.monotonic() < end, f"no {reply!r} in {seen!r}"
            chunk = self.line.read(0.05)
            seen += chunk.data
        self.samples += self.parser.feed(seen.partition(reply)[2], chunk.time)  # frames may follow at once


def device_for(protocol: str, script: Script | None = None, carrier: str | None = None) -> Emulator:
    rate = 100.0 * (4 if protocol != "robotiq" else 2)
    return emulator(protocol, carrier, rate=rate, script=script, signal=swinging(protocol))


def truths(device: Emulator) -> np.ndarray:
    return np.array([sent.reading.values for sent in device.intact()])


def values(samples: list[WrenchSample]) -> np.ndarray:
    return np.array([(*sample.force, *sample.torque) for sample in samples])


# The damage is over after 0.12 s, and frames that follow are read until twenty of them are there.
WIRE = [Fault.SPLIT, Fault.MERGED, Fault.GARBAGE, Fault.BAD_CHECKSUM, Fault.STALL, Fault.HEADER]


@pytest.mark.parametrize("fault", WIRE)
@pytest.mark.parametrize("protocol", SENSORS)
def test_only_damaged_frames_are_lost(protocol: str, fault: Fault):
    if fault not in possible_faults(protocol):
        pytest.skip(f"{protocol} does not have it")
    with device_for(protocol, Script([(0.04, fault, 0.08)])) as device:
        host = Host(device, protocol)
        host.read_until(lambda: sum(sent.time > 0.13 and sent.intact for sent in list(device.log)) >= 20)
        count = len(device.intact())
        host.read_until(lambda: len(host.samples) >= count)
        samples = values(host.samples)
        sent = truths(device)[: len(samples)]
        host.line.close()
    assert np.allclose(samples, sent, atol=6e-3, rtol=1e-6)
    assert host.parser.counters.frames == len(samples)
    if fault is Fault.HEADER:
        assert any(entry.reading.values == device.model.trap for entry in device.log)
    else:
        assert {entry.fault for entry in device.log} == {None, fault}


def come_back(host: Host) -> None:
    """Start again until samples come; a start that was sent while the line broke is lost without a word."""
    enough = len(host.samples) + 10

    def came() -> bool:
        host.parser.reset()
        with contextlib.suppress(LineError):
            host.start()
            silent = time.monotonic() + 0.3
            host.read_until(lambda: len(host.samples) >= enough or time.monotonic() > silent)
        return len(host.samples) >= enough

    until(came)


@pytest.mark.parametrize("fault", [Fault.DISCONNECT, Fault.RECONNECT])
@pytest.mark.parametrize("protocol", SENSORS)
def test_a_line_breaks_and_comes_back(protocol: str, fault: Fault):
    with device_for(protocol, Script([(0.05, fault, 0.1)])) as device:
        host = Host(device, protocol)
        if protocol == "rdt":  # UDP tells nobody: the silence does
            host.read_until(lambda: list(device.log)[-1:] != [] and device.log[-1].fault is fault)
        else:
            with pytest.raises(LineLost):
                host.read_until(lambda: False)
        come_back(host)
        host.line.close()
    assert device.refused == []


def test_the_clock_and_the_limits_are_seen():
    script = Script([(0.03, Fault.CLOCK_JUMP, 0.1, 5.0), (0.06, Fault.SATURATION, 10.0)])
    with device_for("bota", script) as device:
        host = Host(device, "bota")
        host.read_until(lambda: any(sample.status is not Status.OK for sample in host.samples))
        host.line.close()
    assert Status.OVERRANGE in host.samples[-1].status
    assert host.samples[0].temperature == 25.0
    clocks = [sent.moment.clock for sent in device.log]
    assert 5.0 < np.diff(clocks).max() < 5.1


def test_elfin_answers_and_fails_by_script():
    with emulator(
        "elfin", script=Script([(0.0, Fault.SPLIT, 0.1), (0.1, Fault.BAD_CHECKSUM, 30.0)])
    ) as device:
        line = line_to(DeviceAddress.parse(device.url))
        line.open()
        reader, replies = elfin.ReplyReader(), []
        end = time.monotonic() + PATIENCE_S
        while not any(reply.kind is not elfin.ReplyKind.OK for reply in replies):
            assert time.monotonic() < end
            line.write(elfin.REQUEST)
            known = len(replies)
            while len(replies) == known:
                assert time.monotonic() < end
                replies += reader.feed(line.read(0.05).data)
        line.close()
    assert replies[0].kind is elfin.ReplyKind.OK
    assert elfin.read_position(replies[0])[0] == pytest.approx(np.degrees(0.3), abs=1e-5)


def test_ur_agrees_and_streams():
    with emulator("ur") as device:
        line, stream = line_to(DeviceAddress.parse(device.url)), ur_pose.UrStream(125.0)
        line.open()
        line.write(stream.start())
        poses, end = [], time.monotonic() + PATIENCE_S
        while len(poses) < 10:
            assert time.monotonic() < end
            chunk = line.read(0.05)
            poses += stream.feed(chunk.data, chunk.time)
            answer = stream.take_output()
            if answer:
                line.write(answer)
        line.close()
    assert device.refused == []
    assert np.allclose(poses[0].joints, device.log[0].reading.values)
    assert np.allclose(np.diff([pose.device_time for pose in poses]), 1 / 125)


def test_a_host_that_does_not_read_stops_nothing():
    with emulator("sri", rate=20_000.0) as device:
        line = line_to(DeviceAddress.parse(device.url))
        line.open()
        line.write(b"AT+GSD\r\n")
        until(lambda: device.counts["bytes nobody took"])
        line.close()
    assert any(not sent.intact for sent in device.log)


def test_what_cannot_be_made_is_refused():
    with pytest.raises(EmulatorError, match=r"Known: .*sri"):
        emulator("other")
    with pytest.raises(EmulatorError, match="use serial"):
        emulator("bota", "tcp")
    with pytest.raises(EmulatorError, match="not available for"):
        emulator("elfin", script=Script([(0, Fault.DRIFT, 1)]))
    with emulator("ur") as device, pytest.raises(EmulatorError, match="choose another"):
        emulator("ur", port=int(device.url.rpartition(":")[2]))
    with pytest.raises(EmulatorError, match="unknown option 'tool'"):
        emulator("elfin", options={"tool": "0,0,0,0,0,0"})
    with pytest.raises(EmulatorError, match="Choose from: none"):
        emulator("bota", quirks=["older"])
    assert len(emulated()) == 10


def opened(device: Emulator) -> Line:
    line = line_to(DeviceAddress.parse(device.url))
    line.open()
    return line


def test_robotiq_refuses_a_request_that_does_not_wait():
    stop, start = (command.data for command in robotiq.start_commands())
    with emulator("robotiq") as device:
        line = opened(device)
        line.write(stop + start)
        until(lambda: bool(device.refused))
        refused = time.monotonic()
        until(lambda: time.monotonic() > refused + PAUSE_S)
        line.write(start)
        until(lambda: device.model.streaming)
        line.close()
    assert device.refused == [start]


def test_it_listens_though_it_cannot_keep_up():
    with emulator("sri", "tcp", rate=100_000.0, log=0) as device:
        line = opened(device)
        line.write(b"AT+GSD\r\n")
        until(lambda: device.counts["intact"] + device.counts["not intact"] > 1000)
        line.write(b"AT+GSD=STOP\r\n")
        until(lambda: not device.model.streaming)
        line.close()
    assert not device.log


def test_what_was_due_while_it_slept_is_skipped(monkeypatch: pytest.MonkeyPatch):
    clock = JumpingClock()
    monkeypatch.setattr("contactbench.pipeline.devices.emulate.time", clock)

    def signal(at: float) -> Six:
        if at > 0.02 and not clock.ahead:
            clock.ahead = 1.2  # as after a suspended process wakes up
        return SYNTHETIC

    with emulator("sri", "tcp", rate=200.0, signal=signal) as device:
        line = opened(device)
        line.write(b"AT+GSD\r\n")
        until(lambda: device.counts["skipped"] > 0)
        count = device.counts["intact"]
        until(lambda: device.counts["intact"] >= count + 5)
        line.close()
    assert device.counts["skipped"] == pytest.approx(240, abs=60)
    assert count < 100  # not the flood of what was missed
    log = list(device.log)
    assert log[-1].moment.number - log[-1].count == device.counts["skipped"]


def test_what_it_measures_may_be_changed_while_it_runs():
    with device_for("sri", carrier="tcp") as device:
        host = Host(device, "sri")
        host.read_until(lambda: len(host.samples) >= 5)
        device.measure(constant((7.0, 0.0, 0.0, 0.0, 0.0, 0.0)))
        host.read_until(lambda: host.samples[-1].force == (7.0, 0.0, 0.0))
        host.line.close()
    assert host.parser.counters.lost == 0


def test_a_failure_of_the_signal_is_not_silent():
    device = emulator("sri", "tcp", signal=lambda _: SYNTHETIC[:3])
    device.start()
    line = line_to(DeviceAddress.parse(device.url))
    line.open()
    line.write(b"AT+GSD\r\n")
    until(lambda: device.failure is not None)
    line.close()
    with pytest.raises(EmulatorError, match="it failed"):
        device.close()
