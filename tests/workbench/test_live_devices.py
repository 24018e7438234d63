from pathlib import Path

import numpy as np
import pytest

from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.session import Session
from contactbench.pipeline.workbench import live_trial as devices
from contactbench.pipeline.workbench.live_trial import Devices


def test_addresses_read_back():
    assert DeviceAddress.parse(devices.virtual_address("linear")).bench.probe == "linear"
    assert DeviceAddress.parse(devices.serial_address("bota", "/dev/ttyUSB3")).path == "/dev/ttyUSB3"
    for name in ("/data/a b.mcap", "/data/50%?#ä.mcap"):
        assert DeviceAddress.parse(devices.replay_address(Path(name))).path == name
        assert DeviceAddress.parse(devices.poses_address(Path(name))).path == name
    assert DeviceAddress.parse(devices.still_address(0, 90, -45.5)).rpy_degrees == (0, 90, -45.5)


@pytest.mark.parametrize(
    ("address", "poses", "words"),
    [
        ("", False, "Give the address"),
        ("elfin+tcp://1.2.3.4", False, "not a force/torque sensor"),
        ("sri+tcp://1.2.3.4", True, "gives no poses"),
        ("sri://1.2.3.4", False, "scheme"),
        ("sri+tcp:/127.0.0.1", False, "://"),
        ("sri+tcp://127.0.0.1:99999", False, "port"),
    ],
)
def test_a_wrong_address_is_told_in_words(address, poses, words):
    assert words in devices.problem_of(address, poses=poses)


def test_right_addresses_have_no_problem():
    assert not devices.problem_of("sri+tcp://1.2.3.4")
    assert not devices.problem_of(" ur+tcp://1.2.3.4 ", poses=True)
    assert devices.gives_poses("virtual://bench")
    assert not devices.gives_poses("sri+tcp://1.2.3.4")
    assert not devices.gives_poses("nonsense")


def test_devices_are_what_the_session_says(tmp_path):
    chosen = Devices("sri+tcp://1.2.3.4", "ur+tcp://1.2.3.5", (0.0, 0.0, 90.0), "SN 1", "DKD-7", "2031-01-31")
    with Session.create(tmp_path / "session") as session:
        assert Devices.of(session.state) == Devices()
        for key, value in chosen.settings.items():
            session.set_parameter(key, value)
        assert Devices.of(session.state) == chosen
        session.set_parameter("devices.mount", "askew")
        assert Devices.of(session.state).mount == (0, 0, 0)
    assert np.allclose(chosen.R_ES @ [1, 0, 0], [0, 1, 0])
    assert Devices().R_ES is None


@pytest.mark.parametrize(
    ("due", "right"), [("", True), ("2027-03-31", True), ("2027-02-30", False), ("soon", False)]
)
def test_a_certificate_is_valid_until_a_date(due, right):
    problem = devices.due_problem(due)
    assert (not problem) is right
    assert right or (repr(due) in problem and "2027-03-31" in problem)
