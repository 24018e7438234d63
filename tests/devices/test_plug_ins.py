"""Drivers that come with an installed package: a folder with the metadata of one on the path of modules."""

import importlib
import json
import sys
import threading

import pytest
from terminal import invoke

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.faults import EmulatorError
from contactbench.pipeline.devices.protocols import registry
from contactbench.pipeline.devices.transport.ports import guess_device
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.streams import open_sensor
from contactbench.pipeline.workbench.live_trial import serial_sensors

# Big-endian counts of a hundredth of a newton or newton metre behind a header; it streams without being asked to.
MODULE = """
import struct

from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.options import Option, number
from contactbench.pipeline.devices.protocols.device_model import SENSOR_FAULTS, Model
from contactbench.pipeline.devices.protocols.parser import FrameParser, SensorDriver
from contactbench.pipeline.devices.protocols.scanner import FrameScanner
from contactbench.pipeline.devices.sample import WrenchSample

FRAME = struct.Struct(">2s6hB")


class TinyParser(FrameParser):
    repeats = True

    def __init__(self, counts):
        super().__init__(FrameScanner(b"TY", FRAME.size, lambda frame: sum(frame[:-1]) % 256 == frame[-1]))
        self.counts = counts

    def _read(self, frame, time):
        _, *values, _ = FRAME.unpack(frame)
        numbers = [value / self.counts for value in values]
        return [WrenchSample(time, tuple(numbers[:3]), tuple(numbers[3:]))]


class TinyModel(Model):
    name = "tiny"
    own_rate = 100.0

    def __init__(self, rate=None, quirks=()):
        super().__init__(rate, quirks)
        self.streaming = True

    def restart(self):
        super().restart()
        self.streaming = True

    def frame(self, reading, moment):
        body = struct.pack(">2s6h", b"TY", *(round(100 * value) for value in reading.values))
        return body + bytes([sum(body) % 256])

    def _step(self):
        return []


class TinyDriver(Driver):
    scheme, title = "tiny", "Tiny works"
    ways = (Way(Carrier.TCP, port=7), Way(Carrier.SERIAL, baud=115_200, frame=FRAME.size))
    rate = 100.0
    options = {"counts": Option("Counts per N and per N·m.", number("counts"), 100.0)}
    emulated = TinyModel
    usb_words = ("tiny works",)

    def sensor(self, address):
        return SensorDriver(TinyParser(address.options["counts"]), (), (), address.rate)
"""
LIARS = """
class Nothing:
    pass


from contactbench.pipeline.devices.options import Option
from tiny_driver import TinyDriver


class Silent(TinyDriver):
    scheme = "silent"
    sensor = __import__("contactbench.pipeline.devices.driver", fromlist=["Driver"]).Driver.sensor


class NoPort(TinyDriver):
    scheme = "noport"
    ways = (__import__("contactbench.pipeline.devices.driver", fromlist=["Way"]).Way("tcp"),)


class Failing(TinyDriver):
    scheme = "failing"

    options = {"odd": Option("Odd.", lambda text: {}[text])}

    def sensor(self, address):
        raise KeyError("counts")

    def emulate(self, rate, quirks, options):
        raise KeyError("model")
"""


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """Install packages: name to modules and entry points."""
    monkeypatch.syspath_prepend(str(tmp_path))

    def install(package, entries, **modules):
        for name, text in modules.items():
            (tmp_path / f"{name}.py").write_text(text, encoding="utf-8")
        folder = tmp_path / f"{package.replace('-', '_')}-1.0.dist-info"
        folder.mkdir()
        (folder / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
        lines = "\n".join(f"{scheme} = {place}" for scheme, place in entries)
        (folder / "entry_points.txt").write_text(f"[{registry.GROUP}]\n{lines}\n")
        importlib.invalidate_caches()
        registry._plug_ins.cache_clear()

    yield install
    for name in ("tiny_driver", "loud_driver", "liars", "broken", "leaves"):
        sys.modules.pop(name, None)
    monkeypatch.undo()
    registry._plug_ins.cache_clear()


@pytest.fixture
def tiny(installed):
    installed("tiny-works", [("tiny", "tiny_driver:TinyDriver")], tiny_driver=MODULE)


@pytest.mark.usefixtures("tiny")
def test_a_plug_in_is_a_sensor_like_any_other():
    address = DeviceAddress.parse("tiny+tcp://h?counts=50")
    assert (address.port, address.rate, address.options) == (7, 100.0, {"counts": 50.0})
    assert address.gives_wrenches
    assert not address.gives_poses
    assert DeviceAddress.parse(str(address)) == address
    assert guess_device("Tiny Works F/T") == "tiny"
    assert serial_sensors()["tiny"] == "Tiny works"
    with pytest.raises(AddressError, match="counts 'x': give a positive number of counts"):
        DeviceAddress.parse("tiny+tcp://h?counts=x")
    with pytest.raises(AddressError, match="at most 768"):
        DeviceAddress.parse("tiny+serial:///dev/x?rate=800")


@pytest.mark.usefixtures("tiny")
def test_a_plug_in_streams_from_its_emulator():
    heard, enough = [], threading.Event()

    def take(samples):
        heard.extend(samples)
        if len(heard) >= 5:
            enough.set()

    with emulator("tiny", options={"counts": "100"}) as device:
        assert device.url.endswith("?counts=100")
        with open_sensor(device.url, take):
            assert enough.wait(10)
    assert heard[0].force == (1.0, -2.0, 3.5)
    assert heard[0].torque == (0.1, -0.2, 0.05)


@pytest.mark.usefixtures("tiny")
def test_a_plug_in_is_emulated_by_the_command_with_faults():
    words = ["bench", "emulate", "tiny", "--seconds", "0.05", "--fault", "bad-checksum@0+1", "--json"]
    ended = invoke(*words)
    assert ended.exit_code == 0
    assert json.loads(ended.stdout)["url"].startswith("tiny+tcp://127.0.0.1:")


def test_what_a_plug_in_prints_when_imported_is_not_on_stdout(installed, capsys):
    installed("tiny-works", [("tiny", "loud_driver:TinyDriver")], loud_driver=f"{MODULE}\nprint('hello')\n")
    assert "tiny" in registry.drivers()
    said = capsys.readouterr()
    assert (said.out, said.err) == ("", "hello\n")


def test_a_plug_in_that_cannot_be_used_is_named_and_left_out(installed):
    installed("tiny-works", [("tiny", "tiny_driver:TinyDriver")], tiny_driver=MODULE)
    installed(
        "liar-works",
        [
            ("sri", "tiny_driver:TinyDriver"),
            ("broken", "broken:Driver"),
            ("leaves", "leaves:Driver"),
            ("nothing", "liars:Nothing"),
            ("missing", "liars:Missing"),
            ("other", "tiny_driver:TinyDriver"),
            ("silent", "liars:Silent"),
            ("noport", "liars:NoPort"),
            ("failing", "liars:Failing"),
        ],
        liars=LIARS,
        broken="1 / 0",
        leaves="raise SystemExit(3)",
    )
    why = {each.scheme: each.why for each in registry.left_out()}
    reasons = {
        "sri": "contactbench has a driver of that scheme itself",
        "broken": "cannot be imported: ZeroDivisionError",
        "leaves": "cannot be imported: SystemExit",
        "nothing": "not a subclass of",
        "missing": "cannot be imported: AttributeError",
        "other": "named otherwise than its scheme 'tiny'",
        "silent": "neither sensor nor poses",
        "noport": "its tcp way has no port",
    }
    assert why.keys() == reasons.keys()
    for scheme, reason in reasons.items():
        assert reason in why[scheme]
        assert "liar-works" in why[scheme]
    assert DeviceAddress.parse("sri+tcp://h").port == 4008
    assert DeviceAddress.parse("tiny+tcp://h").port == 7
    with pytest.raises(AddressError, match=r"the plug-in broken .* of liar-works is left out"):
        DeviceAddress.parse("broken+tcp://h")
    with pytest.raises(AddressError, match=r"start it with one of .*tiny"):
        DeviceAddress.parse("unheard+tcp://h")
    with pytest.raises(registry.ProtocolError, match="the driver of Tiny works failed: KeyError"):
        registry.driver_for(DeviceAddress.parse("failing+tcp://h"))
    with pytest.raises(AddressError, match="the driver of Tiny works failed: KeyError"):
        DeviceAddress.parse("failing+tcp://h?odd=x")
    with pytest.raises(EmulatorError, match="the driver of Tiny works failed: KeyError"):
        emulator("failing")


def test_two_plug_ins_of_one_scheme_are_both_left_out(installed):
    installed("tiny-works", [("tiny", "tiny_driver:TinyDriver")], tiny_driver=MODULE)
    installed("tiny-again", [("tiny", "tiny_driver:TinyDriver")])
    assert [each.scheme for each in registry.left_out()] == ["tiny", "tiny"]
    with pytest.raises(AddressError, match="another plug-in has the same scheme"):
        DeviceAddress.parse("tiny+tcp://h")
