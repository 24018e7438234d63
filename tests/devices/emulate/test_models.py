"""Commands: what is obeyed, what is refused, in any pieces."""

import contextlib
import math
import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.emulate import possible_faults
from contactbench.pipeline.devices.faults import (
    SYNTHETIC,
    EmulatorError,
    Fault,
    FaultEvent,
    FrameMoment,
    Mangler,
    Script,
    SensorReading,
    Truth,
    constant,
    recorded,
    sine,
)
from contactbench.pipeline.devices.protocols.arms import ELFIN3_TABLE, flange_pose
from contactbench.pipeline.devices.protocols.bota import BotaModel
from contactbench.pipeline.devices.protocols.checksums import crc16_modbus
from contactbench.pipeline.devices.protocols.device_model import JOINTS, Model, Quirk
from contactbench.pipeline.devices.protocols.elfin import ElfinModel
from contactbench.pipeline.devices.protocols.kunwei import KunweiModel
from contactbench.pipeline.devices.protocols.rdt import RdtModel
from contactbench.pipeline.devices.protocols.robotiq import RobotiqModel
from contactbench.pipeline.devices.protocols.robotous import RobotousModel
from contactbench.pipeline.devices.protocols.sri import SriModel, sri_frame
from contactbench.pipeline.devices.protocols.ur_pose import UrModel, rtde_packet

NOW = SensorReading(SYNTHETIC), FrameMoment(0, 0.0)
ROBOTIQ_START = bytes.fromhex("0910019A0001020200CDCA")
UR_OUTPUTS = struct.pack(">d", 125.0) + b"timestamp,actual_q,actual_TCP_pose,ft_raw_wrench"


KINDS = [SriModel, BotaModel, RobotiqModel, RdtModel, KunweiModel, RobotousModel, ElfinModel, UrModel]
AGREED = rtde_packet(b"V", b"\0\2")


def model(kind: type[Model], *quirks: Quirk) -> Model:
    made = kind(None, quirks=quirks)
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
        (KunweiModel, [bytes.fromhex("48AA0D0A")], b""),
        (RobotousModel, [bytes.fromhex("550B000000000000000BAA")], b""),
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
    assert not whole.refused
    assert b"".join(whole.commands) == b"".join(commands)
    pieces = model(kind)
    ends = [pieces.feed(bytes([byte])) for command in commands for byte in command]
    assert answers == b"".join(reply for replies in ends for reply in replies)
    assert pieces.streaming
    assert not pieces.refused
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
        (KunweiModel, bytes.fromhex("47AA0D0A")),
        (RobotousModel, bytes.fromhex("55110100000000000012AA")),
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
    if kind is UrModel:
        device.feed(AGREED)
    if kind is RobotiqModel and len(command) == 9:
        command += crc16_modbus(command).to_bytes(2, "little")
    device.feed(command)
    assert device.refused
    assert not device.streaming


def test_sri_answers_queries_and_gives_single_frames():
    device = model(SriModel)
    assert device.feed(b"AT+SMPF=?\r\n") == [b"ACK+SMPF=200$OK\r\n"]
    assert device.feed(b"AT+DCKMD=CRC32\r\n")
    assert device.feed(b"AT+SGDM=(A01,A02,A03,A04,A05,A06);E;1;(WMA:1)\r\n")
    (frame,) = device.feed(b"AT+GOD\r\n")
    assert (len(frame), frame[:4]) == (34, b"\xaa\x55\x00\x1e")


def test_sri_may_answer_its_start():
    device = SriModel()
    assert device.feed(b"AT+GSD=\r\n") == []
    assert device.feed(b"AT+GSD=STOP\r\n") == [b"ACK+GSD=STOP$OK\r\n"]
    device = SriModel(None, [Quirk.ANSWERS_START])
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
    for quirks, count in (([], 24), ([Quirk.OLDER], 12)):
        device = ElfinModel(None, quirks)
        device.answer = lambda: (SensorReading(JOINTS), FrameMoment(0, 0.0))
        (answer,) = device.feed(b"ReadActPos,0,;")
        name, verdict, *numbers, end = answer.decode().split(",")
        assert (name, verdict, len(numbers), end) == ("ReadActPos", "OK", count, ";")
        assert float(numbers[6]) == pytest.approx(528.910, abs=1e-3)
    assert device.feed(b"ReadRobotState,0,;ReadMoveState,0,;")[1] == b"ReadMoveState,OK,0,;"
    assert device.damaged(answer) == b"ReadActPos,Fail,20011,;"


def test_ur_refuses_unknown_variables():
    device = UrModel()
    device.feed(AGREED)
    (answer,) = device.feed(rtde_packet(b"O", struct.pack(">d", 125.0) + b"timestamp,other"))
    assert answer == rtde_packet(b"O", b"\0DOUBLE,NOT_FOUND")
    assert device.feed(rtde_packet(b"S")) == [rtde_packet(b"S", b"\0")]


def test_ur_speaks_one_version_and_lets_nothing_be_set():
    device = UrModel()
    outputs = rtde_packet(b"O", UR_OUTPUTS)
    assert device.feed(rtde_packet(b"V", b"\0\1")) == [rtde_packet(b"V", b"\0")]
    assert device.feed(outputs) == []
    assert device.feed(AGREED) == [rtde_packet(b"V", b"\1")]
    assert device.feed(outputs) != []
    (answer,) = device.feed(rtde_packet(b"I", b"speed_slider_mask,speed_slider_fraction"))
    assert answer == rtde_packet(b"I", b"\0NOT_FOUND,NOT_FOUND")
    assert len(device.refused) == 2
    device.restart()
    assert device.feed(outputs) == []


TOOL = (0.1, -0.02, 0.3, 0.4, 1.2, -0.5)


def test_ur_gives_the_pose_of_its_tool_and_says_where_that_is():
    names = b"actual_TCP_pose,tcp_offset"

    def fields(tool: tuple[float, float, float, float, float, float]) -> np.ndarray:
        device = UrModel(tool=tool)
        device.feed(AGREED)
        device.feed(rtde_packet(b"O", struct.pack(">d", 125.0) + names))
        return np.array(struct.unpack(">12d", device.frame(SensorReading(JOINTS), FrameMoment(0, 0.0))[4:]))

    flange, tool = fields((0.0,) * 6), fields(TOOL)
    assert np.allclose(flange[6:], 0.0)
    assert np.allclose(tool[6:], TOOL)
    R_BE, R_BT = (Rotation.from_rotvec(row[3:6]) for row in (flange, tool))
    assert np.allclose((R_BE.inv() * R_BT).as_rotvec(), TOOL[3:])
    assert np.allclose(R_BE.inv().apply(tool[:3] - flange[:3]), TOOL[:3])
    with pytest.raises(EmulatorError, match="tool"):
        UrModel(tool=(math.nan,) * 6)
    older = UrModel(None, [Quirk.OLDER])
    older.feed(AGREED)
    (answer,) = older.feed(rtde_packet(b"O", struct.pack(">d", 125.0) + names))
    assert answer == rtde_packet(b"O", b"\0VECTOR6D,NOT_FOUND")


def test_an_older_sri_box_knows_the_rate_by_its_other_name():
    newer, older = SriModel(), SriModel(None, [Quirk.OLDER])
    assert newer.feed(b"AT+SMPF=500\r\n") == [b"ACK+SMPF=500$OK\r\n"]
    assert older.feed(b"AT+SMPR=500\r\n") == [b"ACK+SMPR=500$OK\r\n"]
    assert (newer.rate, older.rate) == (500, 500)
    for box, name in ((newer, b"SMPR"), (older, b"SMPF")):
        assert box.feed(b"AT+" + name + b"=100\r\n") == [b"ACK+" + name + b"=ERROR$ERROR\r\n"]
        assert box.rate == 500


@pytest.mark.parametrize(
    ("quirk", "answer"),
    [(Quirk.CRC32_ONLY, b"ACK+DCKMD=ERROR$ERROR\r\n"), (Quirk.CRC32_SILENTLY, b"ACK+DCKMD=SUM$OK\r\n")],
)
def test_an_sri_box_may_know_no_sums(quirk: Quirk, answer: bytes):
    box = SriModel(None, [quirk])
    assert box.feed(b"AT+DCKMD=SUM\r\n") == [answer]
    assert box.frame(*NOW)[2:4] == b"\x00\x1e"
    assert box.feed(b"AT+DCKMD=?\r\n") == [b"ACK+DCKMD=CRC32$OK\r\n"]


def test_an_sri_box_takes_one_command_at_a_time():
    both = b"AT+GSD=STOP\r\nAT+SMPF=500\r\n"
    box = model(SriModel)
    assert box.feed(both) == [b"ACK+GSD=STOP$OK\r\n"]
    assert list(box.refused) == [b"AT+SMPF=500\r\n"]
    assert len(model(SriModel, Quirk.FORGIVING).feed(both)) == 2


@pytest.mark.parametrize(("silence", "taken"), [(0.0, False), (0.0015, False), (0.0019, True)])
def test_a_robotiq_request_needs_silence_before_it(silence: float, taken: bool):
    device = model(RobotiqModel)
    for stop in (b"\xff" * 30, b"\xff" * 5, b"\xff" * 5):
        device.feed(stop, 0.0)
    assert bool(device.feed(ROBOTIQ_START, silence)) == device.streaming == taken
    assert list(device.refused) == ([] if taken else [b"\xff" * 10 + ROBOTIQ_START])


def test_a_robotiq_request_in_one_piece_with_the_stop_is_a_part_of_it():
    at_once = b"\xff" * 50 + ROBOTIQ_START
    device = model(RobotiqModel)
    assert device.feed(at_once) == []
    assert list(device.refused) == [ROBOTIQ_START]
    assert device.feed(ROBOTIQ_START) != []
    assert model(RobotiqModel, Quirk.FORGIVING).feed(at_once) != []


@pytest.mark.parametrize("kind", KINDS)
def test_quirks_of_other_devices_are_refused(kind: type[Model]):
    for quirk in Quirk:
        if quirk not in kind.possible_quirks:
            with pytest.raises(EmulatorError, match="not available for"):
                kind(None, quirks=[quirk])
    with pytest.raises(EmulatorError, match="'other'"):
        kind(None, quirks=["other"])


def test_what_it_was_told_is_kept_within_bounds():
    device = model(ElfinModel)
    for _ in range(1500):
        device.feed(b"ReadActPos,0,;GrpStop,0,;")
    assert (device.obeyed_count, device.refused_count) == (1500, 1500)
    assert len(device.commands) == len(device.refused) == 1000


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=60)
@given(chunks=st.lists(st.tuples(st.binary(max_size=80), st.floats(0, 0.01)), max_size=12))
def test_any_bytes_are_taken(kind: type[Model], chunks: list[tuple[bytes, float]]):
    device = model(kind)
    for chunk, silence in chunks:
        device.feed(chunk, silence)
    device.feed(bytes(10_000))
    assert len(device._pending) <= 4096  # the bound is the point


def test_a_rate_must_be_possible():
    with pytest.raises(EmulatorError, match="rate"):
        SriModel(0.0)


# ----  --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("joints", "position"),
    [
        ((0, 0, np.pi / 2, 0, np.pi / 2, 0), (0.324, 0, 0.3035)),
        ((0.3, -0.4, 1.1, 0.5, -0.7, 0.9), (0.528910, 0.113500, 0.556217)),
        ((0, np.pi / 6, 0, 0, 0, 0), (-0.3725, 0, 0.837689)),
        ((0, 0, np.pi / 6, 0, 0, 0), (0.2395, 0, 0.873326)),
        ((0, 0, 0, 0, np.pi / 6, 0), (0.0775, 0, 0.916734)),
    ],
)
def test_the_elfin_stands_where_it_should(joints: tuple[float, ...], position: tuple[float, ...]):
    R_BE, p_BE_B = flange_pose(ELFIN3_TABLE, joints)
    assert np.allclose(p_BE_B, position, atol=1e-6)
    assert np.allclose(R_BE @ R_BE.T, np.eye(3))


# ----  --------------------------------------------------------------------------------------------


def test_events_are_read():
    assert FaultEvent.parse("stall@2+0.5") == FaultEvent(2.0, Fault.STALL, 0.5)
    assert FaultEvent.parse("wrong-rate@1+2x0.5") == FaultEvent(1.0, Fault.WRONG_RATE, 2.0, 0.5)
    assert FaultEvent.parse("clock-jump@0x-3").amount == -3
    assert FaultEvent.parse("drift@0+5").amount == 10


@pytest.mark.parametrize(
    "text", ["", "stall", "stall@", "rest@1+1", "stall@1+0", "stall@1.2.3", "wrong-rate@1+1x0"]
)
def test_wrong_events_are_refused(text: str):
    with pytest.raises(EmulatorError, match="fault"):
        FaultEvent.parse(text)


@given(st.text(max_size=30))
def test_any_text_is_an_event_or_an_error(text: str):
    with contextlib.suppress(EmulatorError):
        FaultEvent.parse(text)


def test_a_script_finds_what_goes_on():
    script = Script([(2.0, Fault.STALL, 0.5), FaultEvent(1.0, Fault.SPLIT, 2.0)])
    assert [event.fault for event in script.events] == [Fault.SPLIT, Fault.STALL]
    assert [event.fault for event in script.active(2.0)] == [Fault.SPLIT, Fault.STALL]
    assert not script.active(2.5, Fault.STALL)
    with pytest.raises(EmulatorError, match="not available for rdt"):
        Script([(0, Fault.HEADER, 1)]).check(possible_faults("rdt"), "rdt")


def test_signals():
    assert constant(SYNTHETIC)(3.0) == SYNTHETIC
    assert sine((1.0,) * 6, 0.5)(0.5)[0] == pytest.approx(1.0)
    steps = recorded([10.0, 11.0, 12.0], [[k] * 6 for k in (1.0, 2.0, 3.0)])
    assert [steps(t)[0] for t in (0.0, 1.5, 2.9, 3.0, -0.5)] == [1, 2, 3, 1, 3]
    with pytest.raises(EmulatorError, match="increasing"):
        recorded([0.0, 0.0], [[1.0] * 6] * 2)
    with pytest.raises(EmulatorError, match="six"):
        recorded([0.0, 1.0], [[1.0] * 5] * 2)


def truth(*events: FaultEvent) -> Truth:
    return Truth(lambda t: (t,) * 6, Script(events), SriModel.trap, SriModel.full_scale)


def test_faults_of_value():
    assert truth(FaultEvent(1, Fault.STUCK)).reading(1.7).values[0] == pytest.approx(1.0)
    assert truth(FaultEvent(1, Fault.REZERO)).reading(5.0).values[0] == pytest.approx(4.0)
    assert truth(FaultEvent(1, Fault.SATURATION)).reading(1.5).saturated
    assert not truth(FaultEvent(1, Fault.SATURATION)).reading(2.5).saturated
    warm = truth(FaultEvent(1, Fault.DRIFT, 2.0)).reading(2.0)
    assert warm.temperature == pytest.approx(30.0)
    assert warm.values[0] == pytest.approx(2.25)
    jumped = truth(FaultEvent(1, Fault.CLOCK_JUMP, 1, 7.0)).moment(3.0, 4)
    assert (jumped.number, jumped.clock, jumped.jump) == (4, 10.0, 7.0)
    assert truth(FaultEvent(1, Fault.WRONG_RATE, 1, 0.5)).rate_factor(1.5) == 0.5
    trap = truth(FaultEvent(1, Fault.HEADER)).reading(1.0).values
    assert b"\xaa\x55\x00\x1b" * 6 in sri_frame(trap, 0)
    assert all(map(math.isfinite, trap))


def mangler(fault: Fault, *, seed: int = 0, datagrams: bool = False) -> Mangler:
    model = RdtModel() if datagrams else SriModel()
    return Mangler(model, Script([(0.0, fault, 1.0)]), seed, datagrams=datagrams)


FRAME = sri_frame(SYNTHETIC, 5)


def test_faults_of_the_line():
    split = mangler(Fault.SPLIT).mangle(FRAME, 0.0, 0)
    assert len(split.pieces) > 1
    assert b"".join(split.pieces) == FRAME
    assert split.intact
    assert not mangler(Fault.SPLIT, datagrams=True).mangle(FRAME, 0.0, 0).intact

    merged = mangler(Fault.MERGED)
    assert [merged.mangle(FRAME, 0.0, k).pieces for k in range(3)] == [(), (), (FRAME * 3,)]
    assert merged.mangle(FRAME, 0.5, 3).pieces == ()
    assert merged.mangle(FRAME, 1.5, 4).pieces == (FRAME, FRAME)

    garbage, frame = mangler(Fault.GARBAGE).mangle(FRAME, 0.0, 0).pieces
    assert garbage
    assert frame == FRAME
    bad = mangler(Fault.BAD_CHECKSUM).mangle(FRAME, 0.0, 0)
    assert bad.pieces[0][:-1] == FRAME[:-1]
    assert not bad.intact
    stalled = mangler(Fault.STALL).mangle(FRAME, 0.0, 0)
    assert stalled.pieces == ()
    assert not stalled.intact

    broken = mangler(Fault.DISCONNECT)
    first, second = broken.mangle(FRAME, 0.0, 0), broken.mangle(FRAME, 0.1, 1)
    assert first.pieces == (FRAME[:15],)
    assert first.away is not None
    assert second.away is None
    assert mangler(Fault.RECONNECT).mangle(FRAME, 0.0, 0).pieces == ()


@pytest.mark.parametrize("fault", [Fault.SPLIT, Fault.GARBAGE])
def test_the_same_seed_gives_the_same_bytes(fault: Fault):
    def run(seed: int) -> list[tuple[bytes, ...]]:
        line = mangler(fault, seed=seed)
        return [line.mangle(FRAME, k / 100, k).pieces for k in range(50)]

    assert run(3) == run(3)
    assert run(3) != run(4)
