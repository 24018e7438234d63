"""Streams against emulated sensors on real lines: what arrives, what is noticed, and what comes back."""

from __future__ import annotations

import threading
import time

import pytest

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.faults import Fault, FaultEvent, Script, sine
from contactbench.pipeline.devices.protocols.registry import driver_for
from contactbench.pipeline.devices.reconnecting_stream import SensorStream
from contactbench.pipeline.devices.sample import Status
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.url import DeviceAddress

DEVICES = [("sri", "serial"), ("sri", "tcp"), ("bota", "serial"), ("robotiq", "serial"), ("rdt", "udp")]
PATIENCE_S = 5.0


class Heard:
    """What a stream gave, and when its health changed."""

    def __init__(self):
        self.samples = []
        self.changes = []
        self._news = threading.Condition()

    def take(self, samples):
        with self._news:
            self.samples += samples
            self._news.notify_all()

    def change(self, health):
        with self._news:
            self.changes.append((time.monotonic(), health))
            self._news.notify_all()

    def until(self, what):
        with self._news:
            assert self._news.wait_for(what, PATIENCE_S), (
                len(self.samples),
                [h for _, h in self.changes][-3:],
            )

    def states(self):
        return [health.state for _, health in self.changes]

    def findings(self):
        return [finding for _, health in self.changes for finding in health.findings]


def moving():
    return sine((0.5, 0.4, 0.3, 0.02, 0.03, 0.01), 3.0, (1.0, -2.0, 3.5, 0.1, -0.2, 0.05))


def listen(device, heard):
    return SensorStream(device.url, heard.take, heard.change)


def fault(kind, start, duration=0.4, size=None):
    return Script(
        [FaultEvent(start, kind, duration, size) if size is not None else FaultEvent(start, kind, duration)]
    )


@pytest.mark.parametrize(("protocol", "carrier"), DEVICES)
def test_every_sample_was_sent_and_in_order(protocol, carrier):
    heard = Heard()
    with emulator(protocol, carrier, rate=100.0, signal=moving()) as device, listen(device, heard) as stream:
        heard.until(lambda: len(heard.samples) >= 60)
        health = stream.health
    assert health.state is StreamState.STREAMING
    assert health.counters.lost == health.counters.bad_checksums == 0
    assert heard.states()[0] is StreamState.CONNECTING
    assert heard.states()[-1] is StreamState.CLOSED
    times = [sample.time for sample in heard.samples]
    assert times == sorted(set(times))
    assert all(sample.arrival is not None and sample.time <= sample.arrival for sample in heard.samples)
    assert not any(Status.CLOCK in sample.status for sample in heard.samples)
    assert device.refused == []  # nothing but what it takes to stream was sent
    sent = iter([entry.reading.values for entry in device.intact()])
    for sample in heard.samples:  # each one was sent, in this order: none is made up
        given = (*sample.force, *sample.torque)
        assert any(given == pytest.approx(values, abs=0.006) for values in sent)


@pytest.mark.parametrize(("protocol", "carrier"), DEVICES)
def test_a_silence_is_noticed_and_ends_by_itself(protocol, carrier):
    heard = Heard()
    script = fault(Fault.STALL, 0.5, 0.6)
    with (
        emulator(protocol, carrier, rate=100.0, signal=moving(), script=script) as device,
        listen(device, heard),
    ):
        heard.until(lambda: StreamState.SILENT in heard.states())
        silent, health = next(
            (when, health) for when, health in heard.changes if health.state is StreamState.SILENT
        )
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count + 10)
    before = [sample.time for sample in heard.samples if sample.time <= silent]
    assert 0.1 < silent - before[-1] < 0.25
    assert "no sample for" in health.findings[0]
    assert heard.states()[-2] is StreamState.STREAMING


@pytest.mark.parametrize(("protocol", "carrier"), [pair for pair in DEVICES if pair != ("rdt", "udp")])
def test_a_lost_line_is_opened_again(protocol, carrier):
    heard = Heard()
    script = fault(Fault.DISCONNECT, 0.5, 0.5)
    with (
        emulator(protocol, carrier, rate=100.0, signal=moving(), script=script) as device,
        listen(device, heard) as stream,
    ):
        heard.until(lambda: StreamState.LOST in heard.states())
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count + 10)
        assert stream.health.reconnected >= 1
    assert Status.CLOCK in heard.samples[count].status
    assert "connection lost" in " ".join(heard.findings())


def test_readings_that_stay_the_same_are_noticed():
    heard = Heard()
    script = fault(Fault.STUCK, 0.3, 2.0)
    with emulator("sri", "tcp", rate=200.0, signal=moving(), script=script) as device, listen(device, heard):
        heard.until(lambda: any("No channel has changed" in finding for finding in heard.findings()))


def test_a_wrong_rate_is_noticed():
    heard = Heard()
    script = fault(Fault.WRONG_RATE, 0.0, 30.0)
    with emulator("sri", "tcp", rate=200.0, signal=moving(), script=script) as device, listen(device, heard):
        heard.until(lambda: any("Hz instead of 200 Hz" in finding for finding in heard.findings()))


def test_damage_costs_the_damaged_frames_only():
    heard = Heard()
    script = fault(Fault.GARBAGE, 0.2, 0.3)
    with (
        emulator("sri", "serial", rate=200.0, signal=moving(), script=script) as device,
        listen(device, heard) as stream,
    ):
        heard.until(lambda: len(heard.samples) > 200)
        counters = stream.health.counters
    assert counters.skipped_bytes > 0
    assert counters.lost == 0


def test_a_device_that_is_not_there_is_a_sentence_and_is_waited_for():
    heard = Heard()
    with SensorStream("sri+serial:///dev/no-such-port", heard.take, heard.change) as stream:
        heard.until(lambda: StreamState.LOST in heard.states())
        assert "cannot be opened" in " ".join(heard.findings())
        assert not stream.health.well
    assert heard.samples == []
    assert heard.states()[-1] is StreamState.CLOSED


def test_a_robot_is_no_force_sensor():
    with pytest.raises(AddressError, match="not a force/torque sensor"):
        driver_for(DeviceAddress.parse("elfin+tcp://127.0.0.1"))
