"""Robots that say where their flange is, emulated on real sockets."""

from __future__ import annotations

import numpy as np
import pytest
from devices.drive.test_stream import Heard, fault

from pipeline.devices.drive import State, poses_from
from pipeline.devices.emulate import JOINTS, Fault, constant, emulator, swinging
from pipeline.devices.url import AddressError
from pipeline.robot import Robot


@pytest.mark.parametrize("protocol", ["elfin", "ur"])
def test_a_robot_tells_its_joints_and_orientation(protocol):
    heard = Heard()
    with (
        emulator(protocol, signal=constant(JOINTS)) as device,
        poses_from(device.url, heard.take, heard.change) as stream,
    ):
        heard.until(lambda: len(heard.samples) > 20)
        assert stream.health.state is State.STREAMING
    for sample in heard.samples:
        assert sample.joints == pytest.approx(JOINTS, abs=1e-5)
        assert pytest.approx(np.eye(3), abs=1e-9) == sample.R_BE @ sample.R_BE.T
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
        heard.until(lambda: State.LOST in heard.states())
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count + 10)
        assert stream.health.reconnected >= 1


def test_a_sensor_is_no_robot():
    with pytest.raises(AddressError, match="no robot"):
        poses_from("sri+tcp://127.0.0.1", lambda _: None)
