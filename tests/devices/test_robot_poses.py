"""Robots that say where their flange is, emulated on real sockets."""

from __future__ import annotations

import time

import numpy as np
import pytest
from devices.test_reconnecting_stream import Script
from devices.test_sensor import Heard, fault
from waiting import until

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.emulate import emulator, swinging
from contactbench.pipeline.devices.faults import Fault, FrameMoment, SensorReading, constant
from contactbench.pipeline.devices.protocols.arms import UR5E_TABLE, flange_pose
from contactbench.pipeline.devices.protocols.device_model import JOINTS, Quirk
from contactbench.pipeline.devices.protocols.elfin import ElfinModel, ElfinPoses
from contactbench.pipeline.devices.protocols.ur_pose import UrPoses
from contactbench.pipeline.devices.reconnecting_stream import poses_from
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.robot import Robot


@pytest.mark.parametrize("protocol", ["elfin", "ur"])
def test_a_robot_tells_its_joints_and_orientation(protocol):
    heard = Heard()
    with (
        emulator(protocol, signal=constant(JOINTS)) as device,
        poses_from(device.url, heard.take, heard.change) as stream,
    ):
        heard.until(lambda: len(heard.samples) > 20)
        assert stream.health.state is StreamState.STREAMING
    for sample in heard.samples:
        assert sample.joints == pytest.approx(JOINTS, abs=1e-5)
        assert pytest.approx(np.eye(3), abs=1e-9) == sample.R_BE @ sample.R_BE.T
        assert sample.time <= sample.arrival
    if protocol == "ur":
        clock = [sample.device_time - sample.time for sample in heard.samples]
        assert np.ptp(clock) < 2e-3  # within the first second, arrivals may still move the line
    assert device.refused == []  # it was asked, never moved
    if protocol == "elfin":
        R_BE, p_BE_B = Robot.named("elfin3").flange_pose(np.array(JOINTS))
        assert pytest.approx(R_BE, abs=1e-4) == heard.samples[-1].R_BE
        assert heard.samples[-1].p_BE_B == pytest.approx(p_BE_B, abs=1e-4)


@pytest.mark.parametrize("protocol", ["elfin", "ur"])
def test_a_lost_robot_is_asked_again(protocol):
    heard = Heard()
    script = fault(Fault.DISCONNECT, 0.4, 0.4)
    with (
        emulator(protocol, signal=swinging(protocol), script=script) as device,
        poses_from(device.url, heard.take, heard.change) as stream,
    ):
        heard.until(lambda: StreamState.LOST in heard.states())
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count + 10)
        assert stream.health.reconnected >= 1


def test_a_sensor_is_no_robot():
    with pytest.raises(AddressError, match="not a robot"):
        poses_from("sri+tcp://127.0.0.1", lambda _: None)


TOOL = (0.01, -0.02, 0.2, 0.0, 0.0, 1.5707963)


def test_a_turned_tool_of_a_ur_does_not_turn_its_flange():
    heard = Heard()
    with (
        emulator("ur", signal=constant(JOINTS), options={"tool": ",".join(map(str, TOOL))}) as device,
        poses_from(device.url, heard.take, heard.change) as stream,
    ):
        heard.until(lambda: len(heard.samples) > 5)
        assert not any("tool" in finding for finding in stream.health.findings)
    R_BE, p_BE_B = flange_pose(UR5E_TABLE, JOINTS)
    assert pytest.approx(R_BE, abs=1e-9) == heard.samples[-1].R_BE
    assert heard.samples[-1].p_BE_B == pytest.approx(p_BE_B, abs=1e-9)


@pytest.mark.parametrize("tool", [None, (0.0,) * 6])
def test_an_older_ur_does_not_tell_its_tool(tool):
    heard = Heard()
    with emulator("ur", signal=constant(JOINTS), quirks=[Quirk.OLDER]) as device:
        address = DeviceAddress.parse(device.url)
        with UrPoses(address, heard.take, heard.change, tool=tool) as stream:
            heard.until(lambda: len(heard.samples) > 70)
            told = any("the orientation is that of the tool" in each for each in stream.health.findings)
    assert told == (tool is None)


def _answer():
    return ElfinModel().frame(SensorReading(JOINTS), FrameMoment(0, 0.0, 0.0))


class Controller(Script):
    """Answers each question after a while."""

    def __init__(self, delay):
        super().__init__(self._say)
        self.delay, self.asked, self.most = delay, [], 0

    def write(self, data):
        super().write(data)
        self.asked.append(time.monotonic())
        self.most = max(self.most, len(self.asked))

    def open(self):
        super().open()
        self.asked.clear()

    def _say(self, _line, _now):
        if not self.asked or time.monotonic() - self.asked[0] < self.delay:
            return b""
        self.asked.pop(0)
        return _answer()


def test_a_pose_belongs_to_the_middle_between_question_and_answer():
    heard = Heard()
    line = Controller(0.03)
    looked, asked, rounds = [0.0], [], []
    write, read = line.write, line.read

    def heard_of(timeout):
        chunk = read(timeout)
        if chunk.data:
            rounds.append((asked[-1], chunk.time))
        looked.append(chunk.time)
        return chunk

    # It is asked at some moment between the last look and the writing.
    line.write = lambda data: (asked.append((looked[-1], time.monotonic())), write(data))
    line.read = heard_of
    with ElfinPoses(DeviceAddress.parse("elfin+tcp://h?rate=20"), heard.take, heard.change, line=line):
        heard.until(lambda: len(heard.samples) > 4)
    for sample in heard.samples:
        assert any((a + end) / 2 <= sample.time <= (b + end) / 2 for (a, b), end in rounds)


def test_answers_that_took_long_are_dropped_and_told():
    heard = Heard()
    line = Controller(0.12)
    with ElfinPoses(DeviceAddress.parse("elfin+tcp://h?rate=50"), heard.take, heard.change, line=line):
        heard.until(lambda: any("were dropped" in finding for finding in heard.findings()))
        asked = len(line.written)
        until(lambda: len(line.written) > asked + 3)
    assert heard.samples == []
    assert line.most == 1  # however slow it is, no second question waits
    assert not any("no frame in them" in finding for finding in heard.findings())


def test_a_question_without_an_answer_opens_the_line_again(monkeypatch):
    monkeypatch.setattr("contactbench.pipeline.devices.protocols.elfin._UNANSWERED_S", 0.3)
    heard = Heard()
    line = Controller(9.0)
    with ElfinPoses(DeviceAddress.parse("elfin+tcp://h?rate=50"), heard.take, heard.change, line=line):
        heard.until(lambda: any("no answer for" in finding for finding in heard.findings()))
        until(lambda: line.opened == 2)
    assert line.most == 1
