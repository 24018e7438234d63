"""A stream on a line that the test writes: what is told, and when."""

from __future__ import annotations

import threading
import time

import pytest
from benchmarks.fault_lines import resting
from devices.test_sensor import Heard
from waiting import be_slow, until

from contactbench.pipeline.devices.protocols.elfin import ElfinPoses
from contactbench.pipeline.devices.protocols.sri import sri_frame
from contactbench.pipeline.devices.reconnecting_stream import SensorStream
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.transport import Chunk, LineLost
from contactbench.pipeline.devices.url import DeviceAddress


class Script:
    """A line whose other end is a function of the time since it was opened."""

    datagrams = False
    name = "script"

    def __init__(self, says):
        self.says = says
        self.written, self.opened_at = [], []
        self.reads = 0
        self._pending = b""
        self._wait = threading.Event()

    @property
    def opened(self):
        return len(self.opened_at)

    def open(self):
        self.opened_at.append(time.monotonic())

    def read(self, timeout):
        self.reads += 1
        data, self._pending = self._pending + self.says(self, time.monotonic() - self.opened_at[-1]), b""
        if not data:
            self._wait.wait(timeout)
        return Chunk(data, time.monotonic())

    def write(self, data):
        self.written.append(data)
        if b"=" in data and b"STOP" not in data:  # an SRI's settings are answered
            self._pending += data.strip().replace(b"AT", b"ACK", 1) + b"$OK\r\n"

    def close(self):
        """Nothing is open."""


def frames(until, rezero=1e9):
    """Say an SRI's frames at 100 Hz, up to a time."""
    given = [0]

    def says(_, now):
        out = b""
        while given[0] < 100 * min(now, until):
            values = resting(given[0] / 100) if given[0] / 100 < rezero else (0.0, 0.0, 0.0, 0.0, 0.0, 0.001)
            values = values[:5] + (values[5] + 1e-4 * (given[0] % 7),)
            out += sri_frame(values, given[0])
            given[0] += 1
        return out

    return says


def sri(line, heard):
    return SensorStream("sri+tcp://h?rate=100", heard.take, heard.change, line=line)


def test_it_never_says_streaming_while_no_sample_comes():
    heard = Heard()
    line = Script(frames(0.4))
    with sri(line, heard) as stream:
        heard.until(lambda: StreamState.STREAMING in heard.states())

        def silent():
            if time.monotonic() - heard.samples[-1].time > 0.2:
                assert stream.health.state is not StreamState.STREAMING
            return StreamState.SILENT in heard.states()

        until(silent)
        told = next(when for when, health in heard.changes if health.state is StreamState.SILENT)
        assert told - heard.samples[-1].time < 0.2
        count, reads = len(heard.changes), line.reads
        until(lambda: line.reads > reads + 5)
        assert len(heard.changes) == count  # a silence that goes on is no news


def test_a_suspicion_stays_until_it_is_acknowledged():
    heard = Heard()
    with sri(Script(frames(9.0, rezero=0.6)), heard) as stream:
        heard.until(lambda: any(health.suspicions for _, health in heard.changes))
        assert not stream.health.well
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count + 10)
        assert "re-zeroed" in stream.health.suspicions[0]
        stream.acknowledge()
        assert stream.health.suspicions == ()
        heard.until(lambda: not heard.changes[-1][1].suspicions)


def test_damage_is_told_while_nothing_else_arrives():
    def says(line, now):
        line.count = getattr(line, "count", 0) + 1
        return b"\x00" * 10 if now < 5 else b""

    heard = Heard()
    with sri(Script(says), heard):
        heard.until(lambda: any("no frame in them" in finding for finding in heard.findings()))
    assert heard.samples == []


def test_another_reason_why_a_line_is_lost_is_told():
    reasons = iter(["first", "second", "third"])

    def says(_line, _now):
        raise LineLost(next(reasons, "last"))

    heard = Heard()
    with sri(Script(says), heard):
        heard.until(lambda: "second" in heard.findings())
    assert heard.findings()[0] == "first"


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (b"ReadActPos,Fail,20011,;", "error code 20011"),
        (b"errorcmd,x,;", "does not know"),
        (b"nonsense;" * 9, "no frame in them"),
    ],
)
def test_an_answer_that_refuses_is_a_finding_and_the_line_stays(answer, words):
    def says(line, _now):
        asked, line.written = line.written, []
        return answer * len(asked)

    heard = Heard()
    line = Script(says)
    address = DeviceAddress.parse("elfin+tcp://h?rate=50")
    with ElfinPoses(address, heard.take, heard.change, line=line) as stream:
        heard.until(lambda: any(words in finding for finding in heard.findings()))
        heard.until(lambda: stream.health.state is StreamState.SILENT)
        assert stream.health.counters.bad_checksums > 0
    assert line.opened == 1
    assert heard.samples == []


def test_what_is_told_is_the_state_that_was_reached_also_after_a_slow_listener():
    heard = Heard()

    def slow(samples):
        if not heard.samples:
            be_slow(0.3)
        heard.take(samples)

    line = Script(frames(9.0))
    with SensorStream("sri+tcp://h?rate=100", slow, heard.change, line=line) as stream:
        heard.until(lambda: len(heard.samples) > 50 and stream.health.well)
        assert heard.changes[-1][1].well
