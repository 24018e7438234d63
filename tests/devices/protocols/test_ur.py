"""RTDE: the conversation, refusals, packets cut and merged, and flange poses."""

import math
import struct
import threading
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.emulate import emulator
from contactbench.pipeline.devices.faults import Fault, Script, constant
from contactbench.pipeline.devices.protocols.device_model import Quirk
from contactbench.pipeline.devices.protocols.ur_pose import UrStage, UrStream
from contactbench.pipeline.devices.protocols.ur_rtde import (
    OutputRecipe,
    Packet,
    PacketKind,
    PacketReader,
    ProtocolError,
    RtdeError,
    check_accepted,
    outputs_request,
    packet,
    start_request,
    version_request,
)
from contactbench.pipeline.devices.protocols.ur_wrench import UrWrenchParser
from contactbench.pipeline.devices.reconnecting_stream import SensorStream
from contactbench.pipeline.devices.sample import WrenchSample
from contactbench.pipeline.devices.stream import Health, StreamState

JOINTS = (0.1, -1.2, 1.3, -0.4, 0.5, 0.6)
POSE = (0.4, -0.1, 0.3, 0.2, -1.1, 0.7)
TYPES = b"DOUBLE,VECTOR6D,VECTOR6D"
NAMES = ("timestamp", "actual_q", "actual_TCP_pose")


def data(*, recipe: int = 1, clock: float = 7.5, pose: tuple[float, ...] = POSE) -> bytes:
    return packet(PacketKind.DATA, struct.pack(">B13d", recipe, clock, *JOINTS, *pose))


def running(tool: tuple[float, ...] | None = None) -> UrStream:
    stream = UrStream(125.0, tool)
    assert stream.start() == version_request()
    stream.feed(packet(PacketKind.VERSION, b"\x01"), 0.0)
    assert stream.take_output() == outputs_request(125.0, (*NAMES, "tcp_offset"))
    stream.feed(packet(PacketKind.OUTPUTS, b"\x00" + TYPES + b",NOT_FOUND"), 0.0)  # an older controller
    assert stream.take_output() == outputs_request(125.0, NAMES)
    stream.feed(packet(PacketKind.OUTPUTS, b"\x01" + TYPES), 0.0)
    assert stream.take_output() == start_request()
    stream.feed(packet(PacketKind.START, b"\x01"), 0.0)
    assert stream.take_output() == b""
    assert stream.stage is UrStage.STREAMING
    return stream


def test_published_packets() -> None:
    assert version_request() == bytes.fromhex("0005560002")
    names = ("timestamp", "actual_q", "actual_TCP_pose", "ft_raw_wrench")
    request = outputs_request(125.0, names)
    assert len(request) == 59
    assert request.startswith(bytes.fromhex("003B4F405F40000000000074696D"))
    assert request.endswith(b"ch")


def test_a_stream_byte_by_byte_and_merged() -> None:
    stream = running()
    samples = [sample for byte in data() for sample in stream.feed(bytes([byte]), 2.0)]
    samples += stream.feed(data() + packet(PacketKind.TEXT, b"hello") + data(), 3.0)
    assert [sample.time for sample in samples] == [2.0, 3.0, 3.0]
    assert samples[0].device_time == 7.5
    assert samples[0].joints == pytest.approx(JOINTS)
    assert np.allclose(samples[0].R_BE, Rotation.from_rotvec(POSE[3:]).as_matrix())
    assert np.isnan(samples[0].p_BE_B).all()


def test_the_tool_frame_is_taken_off() -> None:
    tool = (0.01, 0.02, 0.15, 0.0, 0.3, -0.2)
    R_BE, p_BE_B = Rotation.from_rotvec([0.5, 0.2, -1.0]), np.array([0.3, 0.2, 0.5])
    pose = (*(p_BE_B + R_BE.apply(tool[:3])), *(R_BE * Rotation.from_rotvec(tool[3:])).as_rotvec())
    (sample,) = running(tool).feed(data(pose=pose), 0.0)
    assert np.allclose(sample.R_BE, R_BE.as_matrix())
    assert sample.p_BE_B == pytest.approx(p_BE_B)
    (sample,) = running((0.0,) * 6).feed(data(), 0.0)
    assert sample.p_BE_B == pytest.approx(POSE[:3])


@pytest.mark.parametrize(
    ("reply", "message"),
    [
        (packet(PacketKind.VERSION, b"\x00"), "refused the version"),
        (packet(PacketKind.START, b"\x01"), "a start packet of 1 bytes"),
        (packet(PacketKind.VERSION), "a version packet of 0 bytes"),
    ],
)
def test_a_refused_version(reply: bytes, message: str) -> None:
    stream = UrStream(125.0)
    stream.start()
    with pytest.raises(RtdeError, match=message):
        stream.feed(reply, 0.0)


@pytest.mark.parametrize(
    ("types", "message"),
    [
        (b"\x01DOUBLE,NOT_FOUND,VECTOR6D", "actual_q is 'NOT_FOUND'"),
        (b"\x01DOUBLE,VECTOR6D,IN_USE", "actual_TCP_pose is 'IN_USE'"),
        (b"\x01DOUBLE", "asked for 3 variables, received 1"),
        (b"\x01\xff,\xff,\xff", "timestamp is"),
        (b"", "0 bytes"),
    ],
)
def test_refused_variables(types: bytes, message: str) -> None:
    names = ("timestamp", "actual_q", "actual_TCP_pose")
    with pytest.raises(RtdeError, match=message):
        OutputRecipe.agreed(Packet(PacketKind.OUTPUTS, types), names)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (data(recipe=2), "recipe 2 instead of 1"),
        (data()[:-1].replace(b"\x00\x6c", b"\x00\x6b", 1), "of 104 bytes instead of 105"),
        (data(clock=math.nan), "not finite"),
        (data(pose=(1e200,) * 6), "is not a pose"),
        (packet(PacketKind.START, b"\x01"), "a start packet of 1 bytes instead"),
    ],
)
def test_data_that_were_not_agreed(wrong: bytes, message: str) -> None:
    with pytest.raises(RtdeError, match=message):
        running().feed(wrong, 0.0)


def test_variables_of_another_type_are_refused() -> None:
    stream = UrStream(125.0)
    stream.start()
    outputs = packet(PacketKind.OUTPUTS, b"\x01DOUBLE,DOUBLE,DOUBLE,DOUBLE")
    stream.feed(packet(PacketKind.VERSION, b"\x01") + outputs, 0.0)
    stream.feed(packet(PacketKind.START, b"\x01"), 0.0)
    with pytest.raises(RtdeError, match="six joints and a pose"):
        stream.feed(packet(PacketKind.DATA, struct.pack(">B4d", 1, 0, 0, 0, 0)), 0.0)


def test_the_controllers_own_tool_gives_the_flange_whatever_was_typed() -> None:
    tool = (0.01, -0.02, 0.2, 0.0, 0.0, math.pi / 2)
    stream = UrStream(125.0, (0.0,) * 6)
    stream.start()
    stream.feed(
        packet(PacketKind.VERSION, b"\x01") + packet(PacketKind.OUTPUTS, b"\x01" + TYPES + b",VECTOR6D"), 0.0
    )
    stream.feed(packet(PacketKind.START, b"\x01"), 0.0)
    (sample,) = stream.feed(packet(PacketKind.DATA, struct.pack(">B19d", 1, 7.5, *JOINTS, *POSE, *tool)), 0.0)
    R_BT, R_ET = Rotation.from_rotvec(POSE[3:]), Rotation.from_rotvec(tool[3:])
    assert pytest.approx((R_BT * R_ET.inv()).as_matrix()) == sample.R_BE
    assert sample.R_BE @ np.array(tool[:3]) + sample.p_BE_B == pytest.approx(POSE[:3])
    assert stream.knows_flange
    stream.start()
    assert stream.take_output() == b""


def test_a_tool_that_is_neither_told_nor_typed_is_not_known() -> None:
    assert not running().knows_flange
    assert running((0.0,) * 6).knows_flange


def test_the_conversation_begins_anew() -> None:
    stream = running()
    stream.feed(data()[:20], 0.0)
    stream.start()
    assert (stream.stage, stream.pending, stream.skipped_bytes) == (UrStage.VERSION, 0, 20)


def test_every_type_is_read() -> None:
    types = ("DOUBLE", "VECTOR6D", "VECTOR3D", "VECTOR6INT32", "UINT64", "UINT32", "INT32", "UINT8", "BOOL")
    recipe = OutputRecipe(9, types, types)
    payload = struct.pack(">Bd6d3d6iQIiB?", 9, *range(1, 17), 2**40, 3, -4, 5, True)
    values = recipe.values(Packet(PacketKind.DATA, payload))
    assert values["VECTOR3D"] == (8.0, 9.0, 10.0)
    assert values["VECTOR6INT32"] == (11, 12, 13, 14, 15, 16)
    assert (values["UINT64"], values["INT32"], values["BOOL"]) == ((2**40,), (-4,), (True,))


@pytest.mark.parametrize("names", [(), ("a,b",), ("é",), ("a b",), ("x" * 5000,)])
def test_names_that_no_packet_can_carry(names: tuple[str, ...]) -> None:
    with pytest.raises(ProtocolError, match=r"plain names|too many"):
        outputs_request(125.0, names)


def test_a_pause_is_accepted() -> None:
    check_accepted(Packet(PacketKind.PAUSE, b"\x01"), PacketKind.PAUSE)


@given(st.lists(st.binary(max_size=200), max_size=20))
def test_any_bytes_are_cut_or_skipped(pieces: list[bytes]) -> None:
    reader = PacketReader()
    found = [found for piece in pieces for found in reader.feed(piece)]
    assert reader.packets == len(found)
    in_packets = sum(3 + len(one.payload) for one in found)
    assert in_packets + reader.skipped_bytes + reader.pending == sum(map(len, pieces))
    assert reader.pending < 4096


# ---- the sensor in the flange --------------------------------------------------------------------

WRENCH = (1.0, -2.0, 3.5, 0.1, -0.2, 0.05)
AGREED = packet(PacketKind.OUTPUTS, b"\x01DOUBLE,VECTOR6D")


def wrench(clock: float, values: tuple[float, ...] = WRENCH, recipe: int = 1) -> bytes:
    return packet(PacketKind.DATA, struct.pack(">B7d", recipe, clock, *values))


def test_a_raw_wrench_byte_by_byte() -> None:
    parser = UrWrenchParser()
    stream = packet(PacketKind.VERSION, b"\x01") + AGREED + packet(PacketKind.TEXT, b"hello") + wrench(7.5)
    (sample,) = [sample for byte in stream for sample in parser.feed(bytes([byte]), 2.0)]
    assert (sample.force, sample.torque) == (WRENCH[:3], WRENCH[3:])
    assert (sample.time, sample.device_time) == (2.0, 7.5)


def test_wrenches_that_are_old_or_no_data_are_dropped_and_counted() -> None:
    parser = UrWrenchParser()
    assert parser.feed(wrench(1.0), 0.0) == []  # nothing is agreed yet
    parser.feed(AGREED, 0.0)
    absurd = wrench(1.0, (1e9, *WRENCH[1:])) + wrench(1.0, (math.nan, *WRENCH[1:])) + wrench(1.0, recipe=2)
    assert parser.feed(absurd, 0.0) == []
    assert len(parser.feed(wrench(1.0) + wrench(1.0) + wrench(1.008), 0.0)) == 2
    counters = parser.counters
    assert (counters.frames, counters.duplicates, counters.bad_checksums) == (3, 1, 4)
    parser.reset()
    assert parser.feed(wrench(2.0), 0.0) == []


def test_a_controller_without_the_wrench_says_so() -> None:
    with pytest.raises(RtdeError, match="ft_raw_wrench is 'NOT_FOUND'"):
        UrWrenchParser().feed(packet(PacketKind.OUTPUTS, b"\x00DOUBLE,NOT_FOUND"), 0.0)


@given(st.lists(st.binary(max_size=80) | st.sampled_from([AGREED, wrench(1.0), b"\x00\x3cU"]), max_size=20))
def test_any_bytes_make_no_wrench_but_a_sound_one(pieces: list[bytes]) -> None:
    parser = UrWrenchParser()
    for piece in pieces:
        try:
            samples = parser.feed(piece, 0.0)
        except RtdeError:
            parser.reset()
            continue
        for sample in samples:
            assert max(map(abs, sample.force + sample.torque)) <= 1e5


@pytest.mark.parametrize("fault", [None, Fault.SPLIT, Fault.RECONNECT, Fault.STALL])
def test_an_emulated_ur_streams_its_raw_wrench(fault: Fault | None) -> None:
    heard: list[WrenchSample] = []
    enough = threading.Event()

    def take(samples: Sequence[WrenchSample]) -> None:
        heard.extend(samples)
        if len(heard) > 60:
            enough.set()

    script = None if fault is None else Script([(0.1, fault, 0.2)])
    device = emulator("ur", signal=constant(WRENCH), script=script)
    with device, SensorStream(device.url, take):
        assert enough.wait(20)
    assert {sample.force + sample.torque for sample in heard} == {WRENCH}
    assert device.refused == []


def test_an_older_ur_has_no_raw_wrench() -> None:
    lost: list[str] = []
    told = threading.Event()

    def change(health: Health) -> None:
        if health.state is StreamState.LOST:
            lost.extend(health.findings)
            told.set()

    with emulator("ur", quirks=[Quirk.OLDER]) as device, SensorStream(device.url, lambda _: None, change):
        assert told.wait(20)
    assert "ft_raw_wrench is 'NOT_FOUND'" in lost[0]
