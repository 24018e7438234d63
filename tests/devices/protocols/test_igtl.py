"""OpenIGTLink: the bytes of the reference implementation's own tests, and bytes that nobody meant."""

import math
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.protocols import igtl
from contactbench.pipeline.devices.protocols.checksums import crc64_ecma
from contactbench.pipeline.devices.protocols.igtl import IgtlError, Message, MessageReader, poses_of

NOW = 1_700_000_000_250_000_000
R_TB = Rotation.from_euler("xyz", [20, -30, 40], degrees=True).as_matrix()
P_TB_T = np.array([0.1, -0.2, 0.9])
BODY = igtl.transform(R_TB, P_TB_T)
LINE = igtl.pack(igtl.TRANSFORM, "Probe", NOW, BODY)


def version_3(kind: str, content: bytes, *, lengths: tuple[int, int, int] = (12, 4, 6)) -> bytes:
    body = struct.pack(">HHII", *lengths, 7) + content + b"\0\1\0\3" + b"key:on"
    return struct.pack(">H12s20sIIQQ", 2, kind.encode(), b"Probe", 1, 0, len(body), crc64_ecma(body)) + body


def test_the_checksum_has_its_published_check_value() -> None:
    assert crc64_ecma(b"123456789") == 0x6C40DF5F0B497347


def test_contents_have_the_checksums_of_the_reference_implementation() -> None:
    status = igtl.status(15, 10, "ACTUATOR_DISABLED", "Actuator A is disabled.")
    assert crc64_ecma(status) == 0x98EE43EED8E431CF
    rows = [
        (-0.954892, 0.196632, -0.222525),
        (-0.196632, 0.142857, 0.970014),
        (0.222525, 0.970014, -0.0977491),
    ]
    R, p = np.array(rows).T, np.array([46.0531, 19.4709, 46.0531]) * 1e-3
    made = struct.unpack(">12f", igtl.transform(R, p))
    known = "BF7473CD3E4959E6BE63DD98BE4959E63E12491B3F7852D63E63DD983F7852D6BDC830AE42383660419BC46742383660"
    assert crc64_ecma(bytes.fromhex(known)) == 0xF6DD2B8EB4DF6DD2
    assert made == pytest.approx(struct.unpack(">12f", bytes.fromhex(known)), rel=1e-5)
    values = (123456.78, 12345.678, 1234.5678, 123.45678, 12.345678, 1.2345678)
    assert crc64_ecma(igtl.sensor(values, 0x00443E0000000000)) == 0x637B8008662020E7


def test_an_independent_program_reads_what_is_packed_and_packs_what_is_read() -> None:
    pyigtl = pytest.importorskip("pyigtl")
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = R_TB, 1e3 * P_TB_T
    for version in (1, 2):
        theirs = pyigtl.TransformMessage(matrix, timestamp=1_700_000_000.25, device_name="Probe")
        theirs.header_version = version
        theirs.metadata = {"Status": "OK"} if version == 2 else {}
        (message,) = MessageReader().feed(theirs.pack())
        assert (message.kind, message.device) == (igtl.TRANSFORM, "Probe")
        assert message.time == pytest.approx(1_700_000_000.25, abs=1e-6)
        (pose,) = poses_of(message)
        assert pytest.approx(R_TB, abs=1e-6) == pose.R_TB
        assert pose.p_TB_T == pytest.approx(P_TB_T, abs=1e-6)


@pytest.mark.parametrize(
    ("kind", "content"),
    [
        (igtl.TRANSFORM, BODY),
        (igtl.POSITION, igtl.quaternion_pose(R_TB, P_TB_T)),
        (igtl.TDATA, igtl.listed("Probe", BODY)),
        (igtl.QTDATA, igtl.listed("Other", igtl.quaternion_pose(np.eye(3), np.zeros(3))) * 2
         + igtl.listed("Probe", igtl.quaternion_pose(R_TB, P_TB_T))),
    ],
)  # fmt: skip
def test_every_kind_gives_the_same_pose_however_it_is_cut(kind: str, content: bytes) -> None:
    data = igtl.pack("IMAGE", "Scan", 0, bytes(5_000)) + igtl.pack(kind, "Probe", NOW, content)
    data += version_3(kind, content) + igtl.pack("STATUS", "Probe", NOW, igtl.status(1, 0, "", ""))
    for step in (1, 7, 61, len(data)):
        reader = MessageReader()
        found = [m for begin in range(0, len(data), step) for m in reader.feed(data[begin : begin + step])]
        assert [message.time for message in found] == [NOW * 1e-9, 1.0]
        for message in found:
            pose = poses_of(message)[-1]
            assert pose.body == "Probe"
            assert pytest.approx(R_TB, abs=1e-6) == pose.R_TB
            assert pose.p_TB_T == pytest.approx(P_TB_T, abs=1e-6)
        assert (reader.counters.frames, reader.counters.skipped_bytes, reader.pending) == (2, 0, 0)


@pytest.mark.parametrize("at", [*range(0, 14, 3), *range(42, 106, 5)])
def test_a_damaged_message_costs_only_itself(at: int) -> None:
    damaged = bytearray(LINE)
    damaged[at] ^= 0x5A
    reader = MessageReader()
    assert len(reader.feed(LINE + bytes(damaged) + LINE * 3)) == 4
    assert reader.counters.skipped_bytes == len(LINE)


@pytest.mark.parametrize("size", [49, 4_096, 2**31, 2**40, 2**64 - 1])
def test_an_announced_length_keeps_nothing_waiting(size: int) -> None:
    head = struct.pack(">H12s20sIIQQ", 1, b"TRANSFORM", b"Probe", 0, 0, size, 0)
    reader = MessageReader()
    assert len(reader.feed(head + LINE * 2)) == 2
    other = struct.pack(">H12s20sIIQQ", 1, b"IMAGE", b"Probe", 0, 0, 2**30, 0)
    for _ in range(100):
        reader.feed(other + bytes(65_536))
    assert reader.pending < 200
    reader.reset()
    assert len(reader.feed(LINE)) == 1


@pytest.mark.parametrize("lengths", [(12, 60_000, 0), (12, 0, 2**32 - 1), (0, 4, 6), (65_535, 0, 0)])
def test_parts_of_version_3_that_are_longer_than_the_whole(lengths: tuple[int, int, int]) -> None:
    assert len(MessageReader().feed(version_3(igtl.TRANSFORM, BODY, lengths=lengths) + LINE)) == 1


@given(st.lists(st.one_of(st.binary(max_size=80), st.sampled_from([LINE, LINE[:58], LINE[:20], b"\0\1"]))))
def test_any_bytes_are_taken_and_accounted_for(pieces: list[bytes]) -> None:
    reader, found = MessageReader(), 0
    for piece in pieces:
        for message in reader.feed(piece):
            found += 1
            poses_of(message)
    counters = reader.counters
    assert counters.frames == found
    assert counters.skipped_bytes + found * len(LINE) + reader.pending == sum(map(len, pieces))


def numbers(**changed: float) -> bytes:
    values = [*R_TB.T.ravel(), *(1e3 * P_TB_T)]
    for name, value in changed.items():
        values[int(name[1:])] = value
    return struct.pack(">12f", *values)


@pytest.mark.parametrize(
    ("kind", "content", "says"),
    [
        (igtl.TRANSFORM, numbers(_3=math.nan), "not finite"),
        (igtl.TRANSFORM, numbers(_11=math.inf), "not finite"),
        (igtl.TRANSFORM, numbers(_0=3e38), "no rotation"),
        (igtl.TRANSFORM, bytes(48), "no rotation"),
        (igtl.TRANSFORM, struct.pack(">12f", 1, 0, 0, 0, 1, 0, 0, 0, -1, 0, 0, 0), "no rotation"),
        (igtl.TRANSFORM, numbers(_9=2e5), "100 m"),
        (igtl.TRANSFORM, bytes(47), "47 bytes"),
        (igtl.POSITION, bytes(28), "no rotation"),
        (igtl.POSITION, bytes(12), "needs position and orientation"),
        (igtl.QTDATA, bytes(51), "51 bytes"),
        (igtl.QTDATA, bytes(50), "no rotation"),
    ],
)
def test_what_is_no_pose_is_refused(kind: str, content: bytes, says: str) -> None:
    with pytest.raises(IgtlError, match=says):
        poses_of(Message(kind, "Probe", None, content))


@pytest.mark.parametrize(("device", "stamp"), [("a" * 21, 0), ("Sonde ü", 0), ("a", -1), ("a", 2**63 * 10)])
def test_what_cannot_be_written_is_refused(device: str, stamp: int) -> None:
    with pytest.raises(IgtlError):
        igtl.pack(igtl.TRANSFORM, device, stamp, BODY)
