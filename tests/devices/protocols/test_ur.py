"""RTDE: the conversation, refusals, packets cut and merged, and flange poses."""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

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
