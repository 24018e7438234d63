"""Commands: what is obeyed, what is refused, in any pieces."""

from __future__ import annotations

import struct

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pipeline.devices.emulate import JOINTS, SYNTHETIC, EmulatorError, Moment, Reading
from pipeline.devices.emulate.models import (
    BotaModel,
    ElfinModel,
    Model,
    RdtModel,
    RobotiqModel,
    SriModel,
    UrModel,
    rtde_packet,
)

NOW = Reading(SYNTHETIC), Moment(0, 0.0)
ROBOTIQ_START = bytes.fromhex("0910019A0001020200CDCA")
UR_OUTPUTS = struct.pack(">d", 125.0) + b"timestamp,actual_q,actual_TCP_pose,ft_raw_wrench"


def model(kind: type[Model]) -> Model:
    made = kind()
    made.answer = lambda: NOW
    return made


@pytest.mark.parametrize(
    ("kind", "commands", "answer"),
    [
        (
            SriModel,
            [b"AT+GSD=STOP\r\n", b"AT+SMPF=500\r\n", b"AT+DCKMD=SUM\r\n", b"AT+GSD\r\n"],
            b"ACK+GSD=STOP$OK",
        ),
        (
            BotaModel,
            [b"C", b"c,0,1,0,4", b"f,256,0,0,1", b"R"],
            b"r,0,C,0\r\nr,0,c,0\r\nr,0,f,0\r\nr,0,R,0\r\n",
        ),
        (RobotiqModel, [b"\xff" * 50, ROBOTIQ_START], bytes.fromhex("0910019A00012152")),
        (
            UrModel,
            [rtde_packet(b"V", b"\0\2"), rtde_packet(b"O", UR_OUTPUTS), rtde_packet(b"S")],
            b"DOUBLE,VECTOR6D,VECTOR6D,VECTOR6D",
        ),
    ],
)
def test_start_commands_are_obeyed_whole_and_byte_by_byte(
    kind: type[Model], commands: list[bytes], answer: bytes
):
    whole = model(kind)
    answers = b"".join(reply for command in commands for reply in whole.feed(command))
    assert answer in answers
    assert whole.streaming
    assert whole.refused == []
    assert b"".join(whole.commands) == b"".join(commands)
    if kind is RobotiqModel:  # its stop is a long run of bytes, obeyed as soon as it is long enough
        return
    pieces = model(kind)
    assert answers == b"".join(reply for byte in b"".join(commands) for reply in pieces.feed(bytes([byte])))
    assert pieces.streaming
    whole.restart()
    assert not whole.streaming


@pytest.mark.parametrize(
    ("kind", "command"),
    [
        (SriModel, b"AT+ADJZF=1;1;1;1;1;1\r\n"),
        (SriModel, b"AT+DCPM=(1)\r\n"),
        (SriModel, b"AT+EIP=10.0.0.1\r\n"),
        (SriModel, b"AT+UARTCFG=921600,8,1,0\r\n"),
        (SriModel, b"hello\r\n"),
        (BotaModel, b"R"),
        (BotaModel, b"Cc,0,1,0,2"),
        (BotaModel, b"Cc,0,1,1,4"),
        (BotaModel, b"Z"),
        (RobotiqModel, bytes.fromhex("0910019A0001020100")),
        (RobotiqModel, bytes.fromhex("0910019A0001020200CDCB")),
        (RdtModel, bytes.fromhex("1234004200000000")),
        (RdtModel, bytes.fromhex("1234008200000004")),
        (RdtModel, b"\x12\x34"),
        (ElfinModel, b"GrpStop,0,;"),
        (ElfinModel, b"SetPayload,0,1,0,0,0,;"),
        (ElfinModel, b"ReadActPos,0;"),
        (UrModel, rtde_packet(b"I", UR_OUTPUTS)),
    ],
)
def test_what_must_not_be_sent_is_refused_and_kept(kind: type[Model], command: bytes):
    device = model(kind)
    if kind is RobotiqModel and len(command) == 9:
        from pipeline.devices.emulate.checksums import crc16_modbus

        command += crc16_modbus(command).to_bytes(2, "little")
    device.feed(command)
    assert device.refused
    assert not device.streaming


def test_sri_answers_queries_and_gives_single_frames():
    device = model(SriModel)
    assert device.feed(b"AT+SMPF=?\r\n") == [b"ACK+SMPF=200$OK\r\n"]
    assert device.feed(b"AT+DCKMD=CRC32\r\nAT+SGDM=(A01,A02,A03,A04,A05,A06);E;1;(WMA:1)\r\n")
    (frame,) = device.feed(b"AT+GOD\r\n")
    assert (len(frame), frame[:4]) == (34, b"\xaa\x55\x00\x1e")


def test_sri_may_answer_its_start():
    device = SriModel()
    assert device.feed(b"AT+GSD=\r\n") == []
    assert device.feed(b"AT+GSD=STOP\r\n") == [b"ACK+GSD=STOP$OK\r\n"]
    device.acknowledges_start = True
    assert device.feed(b"AT+GSD\r\n") == [b"ACK+GSD=OK\r\n"]
    assert device.streaming


def test_rdt_gives_as_many_records_as_were_asked_for():
    device = RdtModel(profile="onrobot")
    device.feed(bytes.fromhex("1234008200000004"))
    device.feed(bytes.fromhex("1234000200000002"))
    assert device.rate == 250
    device.frame(*NOW)
    assert device.streaming
    assert struct.unpack(">3I6i", device.frame(*NOW))[3:6] == (10_000, -20_000, 35_000)
    assert not device.streaming
    with pytest.raises(EmulatorError, match="profile"):
        RdtModel(profile="other")


def test_elfin_answers_in_both_lengths():
    for newer, count in ((True, 24), (False, 12)):
        device = ElfinModel(newer=newer)
        device.answer = lambda: (Reading(JOINTS), Moment(0, 0.0))
        (answer,) = device.feed(b"ReadActPos,0,;")
        name, verdict, *numbers, end = answer.decode().split(",")
        assert (name, verdict, len(numbers), end) == ("ReadActPos", "OK", count, ";")
        assert float(numbers[6]) == pytest.approx(528.910, abs=1e-3)
    assert device.feed(b"ReadRobotState,0,;ReadMoveState,0,;")[1] == b"ReadMoveState,OK,0,;"
    assert device.damaged(answer) == b"ReadActPos,Fail,20011,;"


def test_ur_refuses_unknown_variables():
    device = UrModel()
    (answer,) = device.feed(rtde_packet(b"O", struct.pack(">d", 125.0) + b"timestamp,other"))
    assert answer == rtde_packet(b"O", b"\0DOUBLE,NOT_FOUND")
    assert device.feed(rtde_packet(b"S")) == [rtde_packet(b"S", b"\0")]


@pytest.mark.parametrize("kind", [SriModel, BotaModel, RobotiqModel, RdtModel, ElfinModel, UrModel])
@settings(max_examples=60)
@given(chunks=st.lists(st.binary(max_size=80), max_size=12))
def test_any_bytes_are_taken(kind: type[Model], chunks: list[bytes]):
    device = model(kind)
    for chunk in chunks:
        device.feed(chunk)
    device.feed(bytes(10_000))
    assert len(device._pending) <= 4096  # the bound is the point


def test_a_rate_must_be_possible():
    with pytest.raises(EmulatorError, match="rate"):
        SriModel(0.0)
