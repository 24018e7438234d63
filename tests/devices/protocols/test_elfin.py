"""Elfin's answers: cut and merged, refused, not numbers; and which half of a position is joints."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.protocols.elfin import (
    ElfinError,
    FieldOrder,
    Reply,
    ReplyKind,
    ReplyReader,
    flange_sample,
    read_position,
    resolve_order,
)
from contactbench.pipeline.robot import Robot

Q = (0.3, -0.4, 1.1, 0.5, -0.7, 0.9)
P_MM = (528.910, 113.500, 556.217)
R = np.array(
    [[0.113915, -0.612884, 0.781919], [0.993402, 0.080768, -0.081418], [-0.013254, 0.786034, 0.618041]]
)
ANSWER = b"ReadActPos,OK,1,2,3,4,5,6,10,20,30,40,50,60,;"
VALUES = ("1", "2", "3", "4", "5", "6", "10", "20", "30", "40", "50", "60")


def position(
    order: FieldOrder, tool: tuple[float, float, float] = (0.0, 0.0, 0.0), turn: Rotation | None = None
) -> list[float]:
    """Return the published pose as the controller would print it, with a tool frame (m) on the flange."""
    R_BT = Rotation.from_matrix(R) * (turn or Rotation.identity())
    pose = [*(np.array(P_MM) + 1e3 * R @ tool), *R_BT.as_euler("xyz", degrees=True)]
    joints = list(np.degrees(Q))
    halves = joints + pose if order is FieldOrder.JOINTS_FIRST else pose + joints
    return [float(number) for number in np.round(halves, 4)]


def read(answer: bytes) -> tuple[float, ...]:
    (reply,) = ReplyReader().feed(answer)
    return read_position(reply)


def test_answers_byte_by_byte_and_merged() -> None:
    reader = ReplyReader()
    single = [reply for byte in ANSWER for reply in reader.feed(bytes([byte]))]
    assert single == [Reply("ReadActPos", ReplyKind.OK, VALUES)]
    assert reader.feed(ANSWER + b"GrpX,Fail,20011,;" + ANSWER) == [
        *single,
        Reply("GrpX", ReplyKind.FAIL, ("20011",)),
        *single,
    ]
    assert reader.pending == 0


def test_the_longer_answer_of_newer_software() -> None:
    longer = ANSWER[:-1] + b",".join(b"%d" % n for n in range(12)) + b",;"
    assert read(longer) == read(ANSWER) == (1, 2, 3, 4, 5, 6, 10, 20, 30, 40, 50, 60)
    assert read(b"ReadActPos,OK," + b" -1.5e-3,.5,+2.,0," * 3 + b";") == (-0.0015, 0.5, 2.0, 0.0) * 3


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (b"ReadActPos,Fail,20011,;", "error code 20011"),
        (b"ReadActPos,Fail,;", "error code none"),
        (b"errorcmd,ReadActPos,;", "does not know ReadActPos"),
        (b"ReadRobotState,OK,0,;", "received 'ReadRobotState'"),
        (b"ReadActPos,OK,1,2,;", "2 values instead of 12"),
        (b"ReadActPos,OK,1,2,3,4,5,nan,1,2,3,4,5,6,;", "'nan' is not a finite number"),
        (b"ReadActPos,OK,1,2,3,4,5,inf,1,2,3,4,5,6,;", "'inf' is not a finite number"),
        (b"ReadActPos,OK,1,2,3,4,5,1e999,1,2,3,4,5,6,;", "'1e999' is not a finite number"),
        (b"ReadActPos,OK,1,2,3,4,5,1_0,1,2,3,4,5,6,;", "'1_0' is not a finite number"),
        (b"ReadActPos,OK,1,2,3,4,5,x,1,2,3,4,5,6,;", "'x' is not a finite number"),
    ],
)
def test_answers_that_cannot_be_used(answer: bytes, message: str) -> None:
    with pytest.raises(ElfinError, match=message):
        read(answer)


def test_what_is_no_answer_is_counted_and_bounded() -> None:
    reader = ReplyReader()
    assert reader.feed(b"hello;\xff\xfe;;") == []
    assert (reader.malformed, reader.skipped_bytes) == (3, 10)
    for _ in range(50):
        reader.feed(b"x" * 1000)
        assert reader.pending <= 2048
    assert reader.feed(b";" + ANSWER)[0].command == "ReadActPos"
    assert (reader.malformed, reader.skipped_bytes) == (4, 10 + 50_001)


@given(st.lists(st.binary(max_size=60), max_size=20))
def test_any_bytes_between_answers(pieces: list[bytes]) -> None:
    reader = ReplyReader()
    for piece in pieces:
        reader.feed(piece)
    assert len(reader.feed(b";" + ANSWER)) >= 1


@pytest.mark.parametrize("order", FieldOrder)
@pytest.mark.parametrize("tool", [(0.0, 0.0, 0.0), (0.0, 0.01, 0.18)])
def test_the_order_follows_from_the_kinematics(
    elfin: Robot, order: FieldOrder, tool: tuple[float, float, float]
) -> None:
    fit = resolve_order(position(order, tool), elfin)
    assert fit.order is order
    assert fit.tool == pytest.approx(tool, abs=1e-5)
    assert fit.rotation_deg < 0.001


@pytest.mark.parametrize("order", FieldOrder)
def test_the_order_is_found_almost_everywhere(elfin: Robot, order: FieldOrder) -> None:
    rng = np.random.default_rng(4)
    for _ in range(40):
        joints = rng.uniform(elfin.lower, elfin.upper)
        R_BE, p_BE_B = elfin.flange_pose(joints)
        pose = [*(p_BE_B * 1e3), *Rotation.from_matrix(R_BE).as_euler("xyz", degrees=True)]
        degrees = list(np.degrees(joints))
        halves = degrees + pose if order is FieldOrder.JOINTS_FIRST else pose + degrees
        assert resolve_order(halves, elfin).order is order


def test_a_turned_tool_frame_is_refused(elfin: Robot) -> None:
    turned = position(FieldOrder.JOINTS_FIRST, turn=Rotation.from_euler("z", 30, degrees=True))
    with pytest.raises(ElfinError, match=r"30\.0° and 0 mm \(joints_first\).*tool frame without rotation"):
        resolve_order(turned, elfin)


def test_flange_from_joints(elfin: Robot) -> None:
    numbers = position(FieldOrder.POSE_FIRST, tool=(0.0, 0.0, 0.2))
    sample = flange_sample(numbers, FieldOrder.POSE_FIRST, 3.0, elfin)
    assert sample.time == 3.0
    assert sample.joints == pytest.approx(Q, abs=1e-6)
    assert sample.p_BE_B == pytest.approx(np.array(P_MM) * 1e-3, abs=2e-6)
    assert np.allclose(sample.R_BE, R, atol=2e-6)


@pytest.mark.parametrize("bad", [[0.0] * 11, [0.0] * 11 + [float("nan")], [1e300] * 12])
def test_numbers_that_are_no_position(elfin: Robot, bad: list[float]) -> None:
    with pytest.raises(ElfinError, match="six angles and a pose"):
        flange_sample(bad, FieldOrder.JOINTS_FIRST, 0.0, elfin)
