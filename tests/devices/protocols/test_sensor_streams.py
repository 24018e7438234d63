"""Streams of a sensor: cut, spliced, damaged, repeated, run round, not finite."""

import math
import struct
import zlib
from collections.abc import Callable
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactbench.pipeline.devices.protocols import ProtocolError, SensorParser
from contactbench.pipeline.devices.protocols.bota import BotaParser
from contactbench.pipeline.devices.protocols.checksums import crc16_modbus, crc16_x25, sum8
from contactbench.pipeline.devices.protocols.kunwei import KunweiParser
from contactbench.pipeline.devices.protocols.rdt import ATI_TYPICAL, ONROBOT_SCALE, CountScale, RdtParser
from contactbench.pipeline.devices.protocols.robotiq import RobotiqParser
from contactbench.pipeline.devices.protocols.robotous import RobotousParser
from contactbench.pipeline.devices.protocols.sri import Layout, SriParser, Trailer
from contactbench.pipeline.devices.sample import Status, WrenchSample

SERIAL: dict[str, Callable[[], SensorParser]] = {
    "sri": SriParser,
    "bota": BotaParser,
    "robotiq": RobotiqParser,
    "kunwei": KunweiParser,
    "robotous": RobotousParser,
}
GOLDEN = {
    "sri": bytes.fromhex("AA55001B00010000803F000000C000006040CDCCCC3DCDCC4CBECDCC4C3D86"),
    "bota": bytes.fromhex("AA00000000803F000000C000006040CDCCCC3DCDCC4CBECDCC4C3D40E201000000FC41F2F6"),
    "robotiq": bytes.fromhex("204E640038FF5E01640038FF32006365"),
    "kunwei": bytes.fromhex("48AAB0751CC19B3FEDC0AE5CF040D4B52DBE5F55993E7C1AB0BB0D0A"),
    "robotous": bytes.fromhex("550B0032FF9C00AF00C8FE70006400000021AA"),
}
# No checksum covers these: an SRI packet's number, and the numbers of a Kunwei.
UNCOVERED = {"sri": range(4, 6), "kunwei": range(2, 26)}


def sri(number: int, force: float = 1.0, *rest: float) -> bytes:
    data = struct.pack("<6f", *(force, *rest, *(0.0,) * 6)[:6])
    return b"\xaa\x55\x00\x1b" + struct.pack(">H", number % 65536) + data + bytes([sum8(data)])


def bota(ticks: int, *, status: int = 0, temperature: float = 20.0, force: float = 1.0) -> bytes:
    body = struct.pack("<H6fIf", status, force, 0, 0, 0, 0, 0, ticks % 2**32, temperature)
    return b"\xaa" + body + struct.pack("<H", crc16_x25(body))


def rdt(number: int, *, status: int = 0, fx: int = 0) -> bytes:
    return struct.pack(">3I6i", number % 2**32, number % 2**32, status, fx, 0, 0, 0, 0, 0)


def numbers(parser: SensorParser, frames: list[bytes]) -> list[int | None]:
    return [sample.sequence for frame in frames for sample in parser.feed(frame, 0.0)]


@pytest.mark.parametrize("name", SERIAL)
def test_one_byte_at_a_time(name: str) -> None:
    parser = SERIAL[name]()
    frame = GOLDEN[name]
    for byte in frame[:-1]:
        assert parser.feed(bytes([byte]), 1.0) == []
    (sample,) = parser.feed(frame[-1:], 2.0)
    assert sample.time == 2.0


@pytest.mark.parametrize("name", SERIAL)
@given(pieces=st.lists(st.binary(max_size=80) | st.just(None), max_size=12), cut=st.integers(1, 50))
def test_garbage_costs_no_intact_frame(name: str, pieces: list[bytes | None], cut: int) -> None:
    """Whatever stands between frames, those behind it come out; the bytes add up."""
    parser, frame = SERIAL[name](), GOLDEN[name]
    # A tail of zeros completes whatever the garbage pretended to begin.
    stream = b"".join(frame if piece is None else piece for piece in pieces) + bytes(len(frame))
    for start in range(0, len(stream), cut):
        parser.feed(stream[start : start + cut], 0.0)
        assert parser.pending < len(frame)
    counters = parser.counters
    assert counters.frames >= sum(piece is None for piece in pieces)
    assert counters.frames * len(frame) + counters.skipped_bytes + parser.pending == len(stream)


@pytest.mark.parametrize("name", SERIAL)
def test_a_damaged_frame_costs_itself_alone(name: str) -> None:
    frame = GOLDEN[name]
    for at in (n for n in range(len(frame)) if n not in UNCOVERED.get(name, ())):
        parser = SERIAL[name]()
        broken = bytearray(frame)
        broken[at] ^= 0x41
        assert len(parser.feed(bytes(broken) + frame, 0.0)) == 1
        assert parser.counters.skipped_bytes == len(frame)


def test_cutting_the_stream_changes_nothing() -> None:
    stream = b"ACK+SMPF=200$OK\r\n" + b"".join(sri(n, float(n)) for n in range(20))
    whole = SriParser().feed(stream, 0.0)
    parser = SriParser()
    assert [s for n in range(0, len(stream), 7) for s in parser.feed(stream[n : n + 7], 0.0)] == whole
    assert [sample.sequence for sample in whole] == list(range(20))


def test_header_bytes_inside_numbers() -> None:
    inside = struct.unpack("<f", b"\xaa\x55\x00\x1b")[0]
    frames = [sri(n, inside, inside, inside, inside, inside, inside) for n in range(5)]
    # The first is cut in the middle of a number, so that a false header comes first.
    parser = SriParser()
    assert numbers(parser, [frames[0][6:], *frames[1:]]) == [1, 2, 3, 4]
    assert parser.counters.bad_checksums >= 1


def test_the_buffer_stays_small_when_much_comes_at_once() -> None:
    parser = BotaParser()
    parser.feed(b"\xaa" * 100_000, 0.0)
    assert parser.pending < 37
    assert parser.counters.bad_checksums == 100_000 - 36


@pytest.mark.parametrize("name", SERIAL)
def test_reset_forgets_half_a_frame(name: str) -> None:
    parser, frame = SERIAL[name](), GOLDEN[name]
    parser.feed(frame[:10], 0.0)
    parser.reset()
    assert parser.pending == 0
    assert parser.counters.skipped_bytes == 10
    assert parser.feed(frame[10:], 0.0) == []
    assert len(parser.feed(frame, 0.0)) == 1


# Numbers as they come, what they become, and what is counted.
COUNTED: dict[str, tuple[list[int], list[int], dict[str, int]]] = {
    "sri: a gap, the wrap and a duplicate": (
        [65534, 65535, 0, 0, 3], [65534, 65535, 65536, 65539],
        {"wraps": 1, "lost": 2, "duplicates": 1, "restarts": 0},
    ),
    "sri: a damaged number costs no count": (
        [10, 11, 40000, 13, 14], [10, 11, 12, 13, 14], {"lost": 0, "bad_numbers": 1, "restarts": 0},
    ),
    "sri: a restart goes on counting": (
        [50000, 50001, 0, 1, 2], [50000, 50001, 50002, 50003, 50004], {"lost": 0, "restarts": 1},
    ),
    "sri: a long gap is counted once it is sure": ([100, 1100, 1101], [100, 101, 1101], {"lost": 999}),
    "rdt: loss, overtaking and duplicates": (
        [2**32 - 1, 0, 3, 2, 3, 3, 4], [2**32 - 1, 2**32, 2**32 + 3, 2**32 + 4],
        {"lost": 2, "wraps": 1, "duplicates": 3},
    ),
    "rdt: a restart": ([9000, 9001, 1, 2], [9000, 9001, 9002, 9003], {"restarts": 1}),
}  # fmt: skip


@pytest.mark.parametrize("case", COUNTED)
def test_what_numbers_tell(case: str) -> None:
    told, expected, counted = COUNTED[case]
    parser, frame = (SriParser(), sri) if case.startswith("sri") else (RdtParser(ATI_TYPICAL), rdt)
    assert numbers(parser, [frame(number) for number in told]) == expected
    assert {name: getattr(parser.counters, name) for name in counted} == counted


@given(st.lists(st.integers(0, 65535), max_size=60))
def test_unwrapped_numbers_always_rise(raw: list[int]) -> None:
    parser = SriParser()
    found = [n for n in numbers(parser, [sri(n, float(i)) for i, n in enumerate(raw)]) if n is not None]
    assert all(a < b for a, b in pairwise(found))
    assert len(found) == len(raw)


def test_rdt_status_is_not_a_measurement() -> None:
    (sample,) = RdtParser(ATI_TYPICAL).feed(rdt(1, status=0x20000), 0.0)
    assert sample.status == Status.ERROR | Status.INVALID


@given(st.binary(max_size=80).filter(lambda data: len(data) != 36))
def test_rdt_datagrams_of_another_length_are_skipped(data: bytes) -> None:
    parser = RdtParser(ATI_TYPICAL)
    assert parser.feed(data, 0.0) == []
    assert parser.counters.skipped_bytes == len(data)


@pytest.mark.parametrize(
    ("bits", "status"),
    [
        (0, Status.OK),
        (1, Status.LATE),
        (2, Status.OVERRANGE),
        (4, Status.INVALID),
        (8, Status.RAW),
        (3, Status.LATE | Status.OVERRANGE),
        (0x8000, Status.ERROR),
    ],
)
def test_bota_status(bits: int, status: Status) -> None:
    (sample,) = BotaParser().feed(bota(0, status=bits), 0.0)
    assert sample.status == status


def test_bota_clock_runs_on_through_its_wrap() -> None:
    parser = BotaParser(rate_hz=100.0)
    times = [
        sample.device_time
        for n in range(4)
        for sample in parser.feed(bota(2**32 - 15_000 + n * 10_000), n * 0.01)
    ]
    start = (2**32 - 15_000) * 1e-6
    assert times == pytest.approx([start + n * 0.01 for n in range(4)], abs=1e-9)
    assert (parser.counters.wraps, parser.counters.restarts, parser.counters.lost) == (1, 0, 0)


def test_bota_clock_jump_is_noticed_and_bridged() -> None:
    parser = BotaParser(rate_hz=100.0)
    ticks = [5_000_000, 5_010_000, 20_000, 30_000, 90_030_000]
    times = [
        sample.device_time for n, tick in enumerate(ticks) for sample in parser.feed(bota(tick), n * 0.01)
    ]
    assert times == pytest.approx([5.0, 5.01, 5.02, 5.03, 5.04])
    assert (parser.counters.restarts, parser.counters.lost) == (2, 0)


def test_bota_lost_frames_by_the_clock() -> None:
    parser = BotaParser(rate_hz=100.0)
    for n in (0, 1, 5):
        parser.feed(bota(n * 10_000), n * 0.01)
    assert parser.counters.lost == 3
    parser.feed(bota(50_000), 0.06)
    assert parser.counters.duplicates == 1


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_not_finite_are_flagged(value: float) -> None:
    parser: SensorParser = SriParser()
    (sample,) = parser.feed(sri(1, value), 0.0)
    assert sample.status is Status.INVALID
    assert parser.counters.invalid == 1
    (sample,) = BotaParser().feed(bota(1, force=value), 0.0)
    assert sample.status is Status.INVALID
    (sample,) = BotaParser().feed(bota(1, temperature=value), 0.0)
    assert sample.status is Status.INVALID
    assert sample.temperature is None


@pytest.mark.parametrize("time", [math.nan, math.inf, -1e9, 1e300])
def test_any_arrival_time_is_survived(time: float) -> None:
    parser = BotaParser(rate_hz=100.0)
    for n in range(3):
        (sample,) = parser.feed(bota(n * 10_000), time * n)
        assert sample.device_time is not None
        assert math.isfinite(sample.device_time)


@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan, math.inf])
def test_senseless_settings_are_refused(bad: float) -> None:
    with pytest.raises(ProtocolError, match="counts per unit"):
        CountScale(bad, 1.0)
    with pytest.raises(ProtocolError, match="rate"):
        BotaParser(rate_hz=bad)
    with pytest.raises(ProtocolError, match="points per packet"):
        Layout(points=0)


# ---- captured and published frames decode exactly ------------------------------------------------


SRI_CAPTURE = bytes.fromhex("AA55001BC4C7016AF4C0EF7D33C04962C9C0A25CC6BDA6198FBDAFDA693E6E")
SRI_CAPTURE_2 = bytes.fromhex("AA55001BD1EB41A3A43ECAD1B43F360612BE6A6F833B240256BB00EA3C378B")
RDT = bytes.fromhex("000000010000000700000000000F4240FFE17B80003567E0000186A0FFFCF2C00000C350")

FORCE, TORQUE = (1.0, -2.0, 3.5), (0.1, -0.2, 0.05)


def single(value: float) -> float:
    """Return the nearest float32."""
    return float(struct.unpack("<f", struct.pack("<f", value))[0])


TORQUE_SINGLE = tuple(map(single, TORQUE))


def only(parser: SensorParser, frame: bytes) -> WrenchSample:
    (sample,) = parser.feed(frame, 12.5)
    assert sample.time == 12.5
    assert parser.counters.frames == 1
    assert parser.counters.skipped_bytes == parser.pending == 0
    return sample


def test_sri_captures() -> None:
    sample = only(SriParser(), SRI_CAPTURE)
    assert sample.sequence == 50375
    assert sample.force == pytest.approx((-7.637940, -2.804561, -6.293248), abs=5e-7)
    assert sample.torque == pytest.approx((-0.096856, -0.069873, 0.228373), abs=5e-7)
    assert only(SriParser(), SRI_CAPTURE_2).sequence == 0xD1EB


def test_sri_synthetic() -> None:
    sample = only(SriParser(), GOLDEN["sri"])
    assert (sample.force, sample.torque) == (FORCE, TORQUE_SINGLE)
    assert (sample.sequence, sample.status) == (1, Status.OK)


def test_sri_with_crc_and_several_points() -> None:
    points = [float(n) for n in range(12)]
    data = struct.pack("<12f", *points)
    frame = b"\xaa\x55" + struct.pack(">HH", 2 + 48 + 4, 7) + data + struct.pack("<I", zlib.crc32(data))
    first, second = SriParser(Layout(Trailer.CRC32, points=2)).feed(frame, 1.0)
    assert first.force + first.torque + second.force + second.torque == tuple(points)
    assert (first.sequence, second.sequence) == (14, 15)


def test_bota() -> None:
    sample = only(BotaParser(), GOLDEN["bota"])
    assert (sample.force, sample.torque) == (FORCE, TORQUE_SINGLE)
    assert (sample.temperature, sample.sequence, sample.status) == (31.5, None, Status.OK)
    assert sample.device_time == pytest.approx(0.123456, abs=1e-15)


def test_robotiq() -> None:
    sample = only(RobotiqParser(), GOLDEN["robotiq"])
    assert (sample.force, sample.torque) == (FORCE, TORQUE)
    assert (sample.sequence, sample.device_time) == (None, None)


def test_rdt_with_both_scales() -> None:
    sample = only(RdtParser(ATI_TYPICAL), RDT)
    assert (sample.force, sample.torque, sample.sequence) == (FORCE, TORQUE, 1)
    onrobot = only(RdtParser(ONROBOT_SCALE), RDT)
    assert onrobot.force == (100.0, -200.0, 350.0)
    assert onrobot.torque == (1.0, -2.0, 0.5)


def test_kunwei_frame_of_the_manual() -> None:
    sample = only(KunweiParser(), GOLDEN["kunwei"])
    kilograms = [value / 9.80665 for value in sample.force + sample.torque]
    # The manual leaves out the first sign; its bytes have it.
    assert kilograms == pytest.approx([-9.7787, -7.4140, 7.5113, -0.16964, 0.29948, -0.00537], abs=5e-5)


@pytest.mark.parametrize("number", ["0000C07F", "0000807F", "00401C46", "00401CC6"])
def test_a_kunwei_number_that_cannot_be_is_no_frame(number: str) -> None:
    """NaN, infinity, ten tonnes to either side."""
    parser = KunweiParser()
    assert parser.feed(b"\x48\xaa" + bytes.fromhex(number) + bytes(20) + b"\x0d\x0a", 0.0) == []
    assert parser.counters.bad_checksums == 1


def test_robotous_synthetic() -> None:
    sample = only(RobotousParser(), GOLDEN["robotous"])
    assert (sample.force, sample.torque, sample.status) == (FORCE, TORQUE, Status.OK)
    overloaded = bytes.fromhex("550B0032FF9C00AF00C8FE70006420000041AA")
    assert only(RobotousParser(), overloaded).status is Status.OVERRANGE
    assert only(RobotousParser(50.0, 1000.0), overloaded).torque == (0.2, -0.4, 0.1)


# ---- checksums against their published check values, and against bit-by-bit references -----------


_CHECK = b"123456789"


def reflected_crc(data: bytes, polynomial: int, start: int) -> int:
    crc = start
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (polynomial if crc & 1 else 0)
    return crc


def test_published_check_values() -> None:
    assert crc16_x25(_CHECK) == 0x906E
    assert crc16_modbus(_CHECK) == 0x4B37
    assert zlib.crc32(_CHECK) == 0xCBF43926
    assert sum8(_CHECK) == 0xDD


@given(st.binary(max_size=64))
def test_tables_agree_with_bit_by_bit_division(data: bytes) -> None:
    assert crc16_x25(data) == reflected_crc(data, 0x8408, 0xFFFF) ^ 0xFFFF
    assert crc16_modbus(data) == reflected_crc(data, 0xA001, 0xFFFF)
    assert sum8(data) == sum(data) % 256
