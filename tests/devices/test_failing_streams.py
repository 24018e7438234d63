"""Streams that end for good, and lines that look well and are not."""

from __future__ import annotations

import sys
import threading
import time

import numpy as np
import pytest
from devices.test_reconnecting_stream import Script, frames, sri
from devices.test_sensor import Heard
from waiting import until

from contactbench.pipeline.devices import reconnecting_stream
from contactbench.pipeline.devices.protocols.elfin import ElfinPoses
from contactbench.pipeline.devices.reconnecting_stream import SensorStream
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.transport import LineLost, LineUnavailable
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.errors import InputError


def raising(*_):
    raise ValueError("of the listener")


def test_what_a_listener_raises_ends_the_stream_and_stops_the_device():
    heard = Heard()
    line = Script(frames(9.0))
    with SensorStream("sri+tcp://h?rate=100", raising, heard.change, line=line) as stream:
        heard.until(lambda: heard.changes and heard.changes[-1][1].failure is not None)
        health = stream.health
        assert health.state is StreamState.LOST
        assert "of the listener" in health.failure
        assert health.findings == (health.failure,)
        assert isinstance(stream.failure, ValueError)
        until(lambda: line.written.count(b"AT+GSD=STOP\r\n") == 2)  # before the start, and at the end
    assert stream.health.state is StreamState.LOST


def test_a_listener_of_changes_that_raises_ends_it_too():
    line = Script(frames(9.0))
    with SensorStream("sri+tcp://h?rate=100", lambda _: None, raising, line=line) as stream:
        until(lambda: stream.failure is not None)
    assert stream.health.state is StreamState.LOST
    assert not any(thread.name == str(stream.address) for thread in threading.enumerate())


def test_a_listener_that_wants_to_exit_does_not_end_the_thread_in_silence():
    line = Script(frames(9.0))
    with SensorStream("sri+tcp://h?rate=100", lambda _: sys.exit(1), line=line) as stream:
        until(lambda: stream.failure is not None)
        until(lambda: stream.health.state is StreamState.LOST)


def test_a_stream_that_is_stopped_has_not_failed():
    heard = Heard()
    with sri(Script(frames(9.0)), heard) as stream:
        heard.until(lambda: len(heard.samples) > 5)
    assert stream.failure is None
    assert heard.changes[-1][1].failure is None


def test_kinematics_that_are_missing_are_refused_at_once(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(InputError, match="MuJoCo"):
        ElfinPoses(DeviceAddress.parse("elfin+tcp://h"), raising, line=Script(frames(0.0)))


@pytest.mark.parametrize(("address", "again"), [("sri+tcp://h?rate=100", True), ("bota+serial:///x", False)])
def test_a_connection_that_is_dead_is_opened_again(monkeypatch, address, again):
    monkeypatch.setattr(reconnecting_stream, "_DEAD_S", 0.3)
    monkeypatch.setattr("contactbench.pipeline.devices.reconnecting_stream._REPLY_S", 0.05)
    heard = Heard()
    line = Script(lambda _line, _now: b"")
    line.write = lambda _: None
    with SensorStream(address, heard.take, heard.change, line=line):
        if again:
            heard.until(lambda: any("nothing received" in finding for finding in heard.findings()))
            until(lambda: line.opened == 2)
        else:  # a serial line is there as long as its plug is
            heard.until(lambda: StreamState.SILENT in heard.states())
            until(lambda: time.monotonic() > line.opened_at[0] + 0.5)
            assert line.opened == 1


def test_a_device_that_takes_connections_and_gives_nothing_is_tried_less_and_less_often():
    def says(_line, now):
        if now > 0.01:
            raise LineLost("closed by the device")
        return b""

    heard = Heard()
    line = Script(says)
    line.write = lambda _: None
    with SensorStream("rdt+udp://h?cpf=1&cpt=1", heard.take, heard.change, line=line) as stream:
        until(lambda: line.opened == 4)
        assert (np.diff(line.opened_at) > (0.1, 0.2, 0.5)).all()
        assert stream.health.reconnected == 0  # no attempt is a reconnection


def test_only_samples_after_a_loss_are_a_reconnection():
    given = frames(1e9)

    def says(line, now):
        if line.opened == 1 and now > 0.3:
            raise LineLost("unplugged")
        return given(line, now)

    class Absent(Script):
        def open(self):
            super().open()
            if self.opened == 2:
                raise LineUnavailable("not there yet")

    heard = Heard()
    with sri(Absent(says), heard) as stream:
        heard.until(lambda: StreamState.LOST in heard.states())
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count)
        assert stream.health.reconnected == 1
