"""Robots that say where their flange is, emulated on real sockets."""

import struct
import time
from contextlib import ExitStack

import numpy as np
import pytest
from devices.test_reconnecting_stream import Script
from devices.test_reconnecting_stream import Script as Line
from devices.test_watch import Heard, fault, listen, moving
from scipy.spatial.transform import Rotation
from waiting import until

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.emulate import emulator, swinging
from contactbench.pipeline.devices.faults import Fault, FrameMoment, SensorReading, constant
from contactbench.pipeline.devices.protocols import igtl, rdt
from contactbench.pipeline.devices.protocols.arms import UR5E_TABLE, flange_pose
from contactbench.pipeline.devices.protocols.device_model import JOINTS, Quirk
from contactbench.pipeline.devices.protocols.elfin import ElfinModel, ElfinPoses
from contactbench.pipeline.devices.protocols.igtl import IgtlError
from contactbench.pipeline.devices.protocols.igtl_pose import BODY, BodyStream, IgtlModel
from contactbench.pipeline.devices.protocols.rdt import ScaleError, rdt_record
from contactbench.pipeline.devices.protocols.registry import driver_for
from contactbench.pipeline.devices.protocols.ur_pose import UrPoses
from contactbench.pipeline.devices.readings import Readings
from contactbench.pipeline.devices.reconnecting_stream import ParsedPoses, SensorStream, poses_from
from contactbench.pipeline.devices.sample import Status
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.robot import Robot


@pytest.mark.parametrize("protocol", ["elfin", pytest.param("ur", marks=pytest.mark.alone)])
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
        return ElfinModel().frame(SensorReading(JOINTS), FrameMoment(0, 0.0, 0.0))


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


# ---- A tracker over OpenIGTLink, emulated on a real socket ---------------------------------------


R_TB = Rotation.from_rotvec(IgtlModel.rest[3:]).as_matrix()
P_TB_T = np.array(IgtlModel.rest[:3])


def line(name: str, stamp: int, p: np.ndarray = P_TB_T) -> bytes:
    return igtl.pack(igtl.TRANSFORM, name, stamp, igtl.transform(R_TB, p))


@pytest.mark.parametrize("options", ["", f"?device={BODY}", f"?device={BODY}&rate=100"])
def test_a_body_stands_in_for_the_flange(options: str) -> None:
    heard = Heard()
    with emulator("igtl", signal=constant(IgtlModel.rest)) as device:
        with poses_from(device.url + options, heard.take, heard.change) as stream:
            heard.until(lambda: len(heard.samples) > 20)
            assert stream.health.state is StreamState.STREAMING
            assert stream.health.counters.bad_checksums == stream.health.counters.skipped_bytes == 0
        until(lambda: len(device.commands) == (2 if "rate" in options else 0))  # the last one is on its way
    for sample in heard.samples:
        assert pytest.approx(R_TB, abs=1e-6) == sample.R_BE
        assert pytest.approx(P_TB_T, abs=1e-6) == sample.p_BE_B
        assert sample.time <= sample.arrival
    clock = [sample.device_time - sample.time for sample in heard.samples]
    assert np.ptp(clock) < 5e-3  # the server's clock counts, not the arrivals
    assert device.refused == []


@pytest.mark.parametrize("kind", [Fault.SPLIT, Fault.MERGED, Fault.GARBAGE, Fault.BAD_CHECKSUM, Fault.STALL])
def test_only_damaged_messages_are_lost(kind: Fault) -> None:
    heard = Heard()
    with (
        emulator("igtl", rate=100.0, signal=swinging("igtl"), script=fault(kind, 0.2, 0.3)) as device,
        poses_from(device.url, heard.take, heard.change),
    ):
        heard.until(lambda: len(heard.samples) > 80)
        got = list(heard.samples)
        sent = {
            round(1.7e9 + each.moment.clock, 4): each.reading.values
            for each in list(device.log)
            if each.intact
        }
    for sample in got:
        wanted = sent[round(sample.device_time, 4)]
        assert sample.p_BE_B == pytest.approx(wanted[:3], abs=1e-6)
        assert Rotation.from_matrix(sample.R_BE).as_rotvec() == pytest.approx(wanted[3:], abs=1e-5)


def test_a_lost_tracker_is_connected_again() -> None:
    heard = Heard()
    with (
        emulator("igtl", signal=swinging("igtl"), script=fault(Fault.DISCONNECT, 0.4, 0.4)) as device,
        poses_from(device.url, heard.take, heard.change) as stream,
    ):
        heard.until(lambda: StreamState.LOST in heard.states())
        count = len(heard.samples)
        heard.until(lambda: len(heard.samples) > count + 10)
        assert stream.health.reconnected >= 1


def test_an_independent_server_is_understood() -> None:
    pyigtl = pytest.importorskip("pyigtl")
    server = pyigtl.OpenIGTLinkServer(port=0)
    heard, matrix = Heard(), np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = R_TB, 1e3 * P_TB_T
    address = f"igtl+tcp://127.0.0.1:{server.server_address[1]}?device=Tool"
    with ExitStack() as stack:
        stack.callback(server.stop)
        stack.enter_context(poses_from(address, heard.take))
        for name, mm in (("Other", np.zeros(3)), ("Tool", 1e3 * P_TB_T)):
            matrix[:3, 3] = mm
            server.send_message(
                pyigtl.TransformMessage(matrix.copy(), device_name=name, timestamp=time.time())
            )
        heard.until(lambda: heard.samples)
        assert heard.samples[0].p_BE_B == pytest.approx(P_TB_T, abs=1e-6)
        assert pytest.approx(R_TB, abs=1e-6) == heard.samples[0].R_BE


def test_several_bodies_need_a_choice() -> None:
    bodies = BodyStream()
    assert len(bodies.feed(line("A", 10**9) + line("A", 2 * 10**9), 1.0)) == 2
    with pytest.raises(IgtlError, match=r"several bodies \(A, B\): add \?device=NAME"):
        bodies.feed(line("B", 3 * 10**9), 1.0)
    assert len(BodyStream("B").feed(line("A", 10**9) + line("B", 10**9), 1.0)) == 1


def test_a_measurement_that_is_sent_again_is_no_new_one() -> None:
    bodies = BodyStream()
    found = bodies.feed(line(BODY, 10**9) * 3 + line(BODY, 2 * 10**9) + line(BODY, 0) * 2, 1.0)
    assert [sample.device_time for sample in found] == [1.0, 2.0, None, None]
    assert bodies.counters.duplicates == 2


def test_a_body_that_is_not_there_is_said() -> None:
    heard, stamps = Heard(), iter(range(1, 10**6))
    talk = Line(lambda *_: line("A", next(stamps) * 10**9))
    where = DeviceAddress.parse("igtl+tcp://h?device=B")
    with ParsedPoses(where, BodyStream("B"), heard.take, heard.change, line=talk):
        until(lambda: any("sends no body 'B', only A" in each for each in heard.findings()))
    assert heard.samples == []


def test_a_pose_that_is_none_is_said_and_dropped() -> None:
    bodies = BodyStream()
    assert bodies.feed(igtl.pack(igtl.TRANSFORM, BODY, 1, bytes(48)), 1.0) == []
    assert "orientation is no rotation" in bodies.troubles()["pose"]
    assert bodies.counters.bad_checksums == 1
    assert len(bodies.feed(line(BODY, 10**9), 1.0)) == 1
    assert bodies.troubles() == {}


@pytest.mark.parametrize(
    ("metadata", "seen"),
    [
        ({"TransformStatus": "OK", "TransformValid": "1"}, True),
        ({"Other": "OUT_OF_VIEW"}, True),
        ({"TransformStatus": "OUT_OF_VIEW"}, False),
        ({"Other": "x", "TransformStatus": "MISSING"}, False),
        ({"TransformValid": "False"}, False),
    ],
)
def test_a_transform_that_the_tracker_marks_as_unseen_is_dropped_counted_and_told(
    metadata: dict[str, str], seen: bool
) -> None:
    pyigtl = pytest.importorskip("pyigtl")
    message = pyigtl.TransformMessage(np.eye(4), timestamp=5.0, device_name=BODY)
    message.header_version, message.metadata = 2, metadata
    bodies = BodyStream()
    assert len(bodies.feed(message.pack(), 1.0)) == seen
    assert bodies.counters.bad_checksums == (not seen)
    assert ("does not see the body" in bodies.troubles().get("pose", "")) == (not seen)


# ---- how devices are started ---------------------------------------------------------------------


def test_an_older_box_is_asked_for_its_rate_in_its_own_words():
    heard = Heard()
    began = time.monotonic()
    device = emulator("sri", "tcp", rate=50.0, signal=moving(), quirks=[Quirk.OLDER])
    with device, listen(device, heard) as stream:
        heard.until(lambda: len(heard.samples) > 120)
        assert heard.samples[0].time - began < 0.9  # a refusal is not waited for
        assert stream.health.rate == pytest.approx(200.0, rel=0.1)
        assert stream.health.findings == ()
    assert device.refused == [b"AT+SMPF=200\r\n"]
    assert b"AT+SMPR=200\r\n" in device.commands


@pytest.mark.parametrize("quirk", [Quirk.CRC32_ONLY, Quirk.CRC32_SILENTLY])
def test_a_box_that_keeps_its_checksum_is_understood_and_told(quirk):
    heard = Heard()
    device = emulator("sri", "tcp", rate=200.0, signal=moving(), quirks=[quirk])
    with device, listen(device, heard) as stream:
        heard.until(lambda: len(heard.samples) > 50)
        findings = " ".join(stream.health.findings)
        assert "did not accept" in findings
        assert "DCKMD=SUM" in findings
        assert stream.health.counters.bad_checksums == 0


def test_a_setting_that_is_refused_in_every_way_is_told():
    def says(line, _now):
        asked, line.written = line.written, []
        return b"".join(b"ERROR\r\n" for data in asked if b"SMP" in data or b"DCK" in data)

    heard = Heard()
    line = Script(says)
    line.write = lambda data: line.written.append(data)
    with SensorStream("sri+tcp://h", heard.take, heard.change, line=line):
        heard.until(lambda: any("'AT+SMPR=200' (it refused it)" in finding for finding in heard.findings()))


@pytest.mark.parametrize("kind", ["robotiq", "sri"])
def test_a_device_is_left_alone_after_a_stop(kind):
    written = []

    class Timed(Script):
        def write(self, data):
            written.append((time.monotonic(), data))

    heard = Heard()
    line = Timed(lambda _line, _now: b"")
    address = f"{kind}+serial:///dev/x"
    with SensorStream(address, heard.take, heard.change, line=line):
        until(lambda: len(written) >= 2)
    assert written[1][0] - written[0][0] > 0.05


def test_onrobot_is_told_a_rate_only_when_one_is_asked_for():
    start = driver_for(DeviceAddress.parse("rdt+udp://h?profile=onrobot")).start
    assert [command.data.hex() for command in start] == ["1234000200000000"]
    asked = driver_for(DeviceAddress.parse("rdt+udp://h?profile=onrobot&rate=300"))
    assert [command.data.hex() for command in asked.start] == ["1234008200000003", "1234000200000000"]
    assert asked.rate == pytest.approx(1000 / 3)  # what the box makes of it: no false finding


def test_an_ati_sensor_is_asked_for_its_counts_where_the_address_has_none(monkeypatch):
    monkeypatch.setattr(rdt, "scale_for", lambda _: rdt.CountScale(4.0, 8.0))
    record = rdt_record((1.0, 2.0, 3.0, 4.0, 5.0, 6.0), rdt.CountScale(4.0, 8.0))
    heard = Heard()
    made = driver_for(DeviceAddress.parse("rdt+udp://h"))
    assert made.parser.scale == rdt.ATI_TYPICAL  # nothing is asked before the stream begins
    line = Script(lambda _line, _now: b"")
    line.says = lambda line, _now: record if line.written and line.written.pop() else b""
    with SensorStream("rdt+udp://h", heard.take, heard.change, line=line):
        heard.until(lambda: heard.samples)
    assert heard.samples[0].force == (1.0, 2.0, 3.0)
    assert heard.samples[0].torque == (4.0, 5.0, 6.0)


def test_counts_that_are_assumed_are_told_as_long_as_they_are(monkeypatch):
    def fail(_):
        raise ScaleError("no page.")

    monkeypatch.setattr(rdt, "scale_for", fail)
    heard = Heard()
    numbers = iter(range(1, 10**6))

    def says(_line, now):
        return rdt_record((1.0, 2.0, now, 0.1, 0.2, 0.3), rdt.ATI_TYPICAL, sequence=next(numbers))

    with SensorStream("rdt+udp://h", heard.take, heard.change, line=Script(says)) as stream:
        heard.until(lambda: len(heard.samples) > 50)
        assert any("1e+06 per N" in finding for finding in stream.health.findings)


def test_too_much_load_is_not_called_a_broken_sensor():
    parser = rdt.RdtParser(rdt.ATI_TYPICAL)
    (sample,) = parser.feed(rdt_record((1.0,) * 6, rdt.ATI_TYPICAL, status=0x8000_0002), 0.0)
    assert Status.ERROR in sample.status
    readings = Readings(driver_for(DeviceAddress.parse("rdt+udp://h?cpf=1&cpt=1")).limits)
    readings.see(sample)
    (finding,) = readings.findings().values()
    assert "remove the load" in finding


def test_a_count_that_begins_again_soon_costs_two_samples():
    parser = rdt.RdtParser(rdt.ATI_TYPICAL)
    given = 0
    for number, raw in enumerate([*range(1, 15), *range(1, 40)]):
        record = struct.pack(">3I6i", raw, 1000 + number, 0, *[number] * 6)
        given += len(parser.feed(record, 0.01 * number))
    assert given == 53 - 2
    assert parser.counters.restarts == 1


def test_datagrams_that_were_overtaken_in_order_are_no_restart():
    parser = rdt.RdtParser(rdt.ATI_TYPICAL)
    for raw in (1, 2, 3, 8, 4, 5, 6, 7, 9, 10):
        parser.feed(struct.pack(">3I6i", raw, raw, 0, *[raw] * 6), 0.01 * raw)
    assert parser.counters.restarts == 0
    assert parser.counters.duplicates == 4
