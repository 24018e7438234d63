"""Captured and published frames decode exactly."""

from __future__ import annotations

import struct
import zlib

import pytest

from contactbench.pipeline.devices.protocols import SensorParser
from contactbench.pipeline.devices.protocols.bota import BotaParser
from contactbench.pipeline.devices.protocols.kunwei import KunweiParser
from contactbench.pipeline.devices.protocols.rdt import ATI_TYPICAL, ONROBOT_SCALE, RdtParser
from contactbench.pipeline.devices.protocols.robotiq import RobotiqParser
from contactbench.pipeline.devices.protocols.robotous import RobotousParser
from contactbench.pipeline.devices.protocols.sri import Layout, SriParser, Trailer
from contactbench.pipeline.devices.sample import Status, WrenchSample

SRI_CAPTURE = bytes.fromhex(
    "AA55001BC4C7016AF4C0EF7D33C04962C9C0A25CC6BDA6198FBDAFDA693E6E",
)
SRI_CAPTURE_2 = bytes.fromhex("AA55001BD1EB41A3A43ECAD1B43F360612BE6A6F833B240256BB00EA3C378B")
SRI_SYNTHETIC = bytes.fromhex("AA55001B00010000803F000000C000006040CDCCCC3DCDCC4CBECDCC4C3D86")
BOTA = bytes.fromhex(
    "AA00000000803F000000C000006040CDCCCC3DCDCC4CBECDCC4C3D40E201000000FC41F2F6",
)
ROBOTIQ = bytes.fromhex("204E640038FF5E01640038FF32006365")
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
    sample = only(SriParser(), SRI_SYNTHETIC)
    assert (sample.force, sample.torque) == (FORCE, TORQUE_SINGLE)
    assert (sample.sequence, sample.status) == (1, Status.OK)


def test_sri_with_crc_and_several_points() -> None:
    points = [float(n) for n in range(12)]
    data = struct.pack("<12f", *points)
    frame = b"\xaa\x55" + struct.pack(">HH", 2 + 48 + 4, 7) + data + struct.pack("<I", zlib.crc32(data))
    parser = SriParser(Layout(Trailer.CRC32, points=2))
    first, second = parser.feed(frame, 1.0)
    assert first.force + first.torque + second.force + second.torque == tuple(points)
    assert (first.sequence, second.sequence) == (14, 15)


def test_bota() -> None:
    sample = only(BotaParser(), BOTA)
    assert (sample.force, sample.torque) == (FORCE, TORQUE_SINGLE)
    assert (sample.temperature, sample.sequence, sample.status) == (31.5, None, Status.OK)
    assert sample.device_time == pytest.approx(0.123456, abs=1e-15)


def test_robotiq() -> None:
    sample = only(RobotiqParser(), ROBOTIQ)
    assert (sample.force, sample.torque) == (FORCE, TORQUE)
    assert (sample.sequence, sample.device_time) == (None, None)


def test_rdt_with_both_scales() -> None:
    sample = only(RdtParser(ATI_TYPICAL), RDT)
    assert (sample.force, sample.torque, sample.sequence) == (FORCE, TORQUE, 1)
    onrobot = only(RdtParser(ONROBOT_SCALE), RDT)
    assert onrobot.force == (100.0, -200.0, 350.0)
    assert onrobot.torque == (1.0, -2.0, 0.5)


def test_kunwei_frame_of_the_manual() -> None:
    frame = bytes.fromhex("48AAB0751CC19B3FEDC0AE5CF040D4B52DBE5F55993E7C1AB0BB0D0A")
    sample = only(KunweiParser(), frame)
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
    sample = only(RobotousParser(), bytes.fromhex("550B0032FF9C00AF00C8FE70006400000021AA"))
    assert (sample.force, sample.torque, sample.status) == (FORCE, TORQUE, Status.OK)
    overloaded = bytes.fromhex("550B0032FF9C00AF00C8FE70006420000041AA")
    assert only(RobotousParser(), overloaded).status is Status.OVERRANGE
    thousand = only(RobotousParser(50.0, 1000.0), overloaded)
    assert thousand.torque == (0.2, -0.4, 0.1)
