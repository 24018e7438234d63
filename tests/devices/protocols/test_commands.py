"""The only commands ever built are those that start and stop a stream, or ask where a robot is."""

import ast
import math
import re
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest

import contactbench.pipeline.devices.protocols as protocols
from contactbench.pipeline.devices.protocols import (
    Command,
    ProtocolError,
    bota,
    elfin,
    rdt,
    robotiq,
    sri,
    ur_rtde,
)
from contactbench.pipeline.devices.protocols.ur_pose import UrStream
from contactbench.pipeline.devices.protocols.ur_rtde import PacketKind, packet

_ALLOWED = (
    rb"AT\+GSD(=STOP)?\r\n",
    rb"AT\+SMP[FR]=\d{1,4}\r\n",
    rb"AT\+DCKMD=(SUM|CRC32)\r\n",
    rb"C",
    rb"c,0,1,0,[0-4]",
    rb"f,\d{2,3},0,0,1",
    rb"R",
    rb"\x09\x10\x01\x9a\x00\x01\x02\x02\x00\xcd\xca",
    rb"\xff{50}",
    rb"\x12\x34\x00[\x00\x02]\x00\x00\x00\x00",
    rb"\x12\x34\x00\x82\x00\x00[\x00-\x03].",
    rb"(ReadActPos|ReadPcsActualPos|ReadActACS|ReadRobotState),0,;",
    rb"\x00\x05V\x00\x02",
    rb"\x00.O.{8}timestamp,actual_q,actual_TCP_pose(,tcp_offset)?",
    rb"\x00\x03[SP]",
)
_FORBIDDEN = re.compile(
    "ADJZF|DCPM|EIP|UARTCFG|AMPZ|0x0042|GrpStop|FreeDriver|Override|WayPoint|MoveL|SetPayload|SetTCP"
)


def every_command() -> Iterator[bytes]:
    commands: list[Command] = []
    for rate in (1, 200, 371):
        for trailer in sri.Trailer:
            for older in (False, True):
                commands += sri.start_commands(rate, trailer=trailer, older_firmware=older)
    for rate in (100, 200, 512.3, 1000):
        commands += bota.start_commands(rate)
    commands += [*robotiq.start_commands(), *robotiq.stop_commands(), *sri.stop_commands()]
    for profile in rdt.Profile:
        for rate in (4, 100, 999.9):
            commands += rdt.start_commands(rate, profile=profile)
    commands += [*bota.stop_commands(), *rdt.stop_commands()]
    yield from (command.data for command in commands)
    yield elfin.REQUEST
    yield from ur_conversation()


def ur_conversation() -> Iterator[bytes]:
    stream = UrStream(125.0)
    yield stream.start()
    for kind, answer in (
        (PacketKind.VERSION, b"\x01"),
        (PacketKind.OUTPUTS, b"\x07DOUBLE,VECTOR6D,VECTOR6D,VECTOR6D"),
        (PacketKind.START, b"\x01"),
    ):
        stream.feed(packet(kind, answer), 0.0)
        if output := stream.take_output():
            yield output
    yield ur_rtde.pause_request()


def test_only_allowed_commands_are_built() -> None:
    for data in every_command():
        assert any(re.fullmatch(pattern, data, re.DOTALL) for pattern in _ALLOWED), data
        assert not _FORBIDDEN.search(data.decode("latin-1"))


def test_no_source_names_a_forbidden_command() -> None:
    for file in Path(protocols.__file__).parent.glob("*.py"):
        source = file.read_text("utf-8")
        for item in ast.parse(source).body:
            if isinstance(item, ast.ClassDef) and item.name.endswith(
                "Model"
            ):  # an emulated device refuses them
                source = source.replace(str(ast.get_source_segment(source, item)), "")
        assert not _FORBIDDEN.search(source), file.name


def test_published_requests() -> None:
    assert rdt.start_commands(1000)[0].data == bytes.fromhex("1234000200000000")
    assert rdt.stop_commands()[0].data == bytes.fromhex("1234000000000000")
    assert robotiq.start_commands()[-1] == Command(
        bytes.fromhex("0910019A000102 0200CDCA"), bytes.fromhex("0910019A00012152")
    )
    assert [command.data for command in bota.start_commands(100)] == [
        b"C",
        b"c,0,1,0,4",
        b"f,512,0,0,1",
        b"R",
    ]
    assert [command.data for command in sri.start_commands(200)][1] == b"AT+SMPF=200\r\n"
    period = rdt.start_commands(100, profile=rdt.Profile.ONROBOT)[0].data
    assert period == struct.pack(">HHI", 0x1234, 0x82, 10)


def test_a_stream_is_stopped_before_it_is_set_up() -> None:
    assert sri.start_commands(200)[:1] == sri.stop_commands()
    assert bota.start_commands(200)[:1] == bota.stop_commands()
    assert robotiq.start_commands()[:1] == robotiq.stop_commands()


def test_a_rate_that_the_line_cannot_carry_is_refused() -> None:
    sri.start_commands(370, baud=115200)
    with pytest.raises(ProtocolError, match=r"372 Hz is too fast .* carries 371 frames"):
        sri.start_commands(372, baud=115200)
    with pytest.raises(ProtocolError, match="is too fast"):
        bota.start_commands(1000, baud=115200)
    with pytest.raises(ProtocolError, match="choose one of 9600"):
        bota.start_commands(200, baud=921600)
    with pytest.raises(ProtocolError, match="baud rate must be above 0"):
        sri.start_commands(200, baud=0)


@pytest.mark.parametrize("rate", [0.0, -1.0, math.nan, math.inf, 1e9])
def test_senseless_rates_are_refused(rate: float) -> None:
    for start in (sri.start_commands, bota.start_commands, robotiq.start_commands, rdt.start_commands):
        with pytest.raises(ProtocolError, match="rate must be between"):
            start(rate)
    with pytest.raises(ProtocolError, match="rate must be between"):
        UrStream(rate)
