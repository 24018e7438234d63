from __future__ import annotations

import numpy as np
import pytest

from contactbench.pipeline.devices.faults import SYNTHETIC
from contactbench.pipeline.devices.protocols.arms import ELFIN3_TABLE, flange_pose
from contactbench.pipeline.devices.protocols.bota import bota_frame
from contactbench.pipeline.devices.protocols.checksums import crc16_modbus, crc16_x25
from contactbench.pipeline.devices.protocols.rdt import ATI_TYPICAL, rdt_record
from contactbench.pipeline.devices.protocols.robotiq import robotiq_frame
from contactbench.pipeline.devices.protocols.sri import sri_frame
from contactbench.pipeline.devices.protocols.ur_pose import rtde_packet


def test_checksums_have_their_published_check_values():
    assert crc16_modbus(b"123456789") == 0x4B37
    assert crc16_x25(b"123456789") == 0x906E


def test_frames_are_those_of_the_devices():
    assert sri_frame(SYNTHETIC, 1) == bytes.fromhex(
        "AA55001B00010000803F000000C000006040CDCCCC3DCDCC4CBECDCC4C3D86"
    )
    vendor = (-7.637940, -2.804561, -6.293248, -0.096856, -0.069873, 0.228373)
    example = bytes.fromhex("AA55001BC4C7016AF4C0EF7D33C04962C9C0A25CC6BDA6198FBDAFDA693E6E")
    made = sri_frame(vendor, 50_375)
    assert made[:6] == example[:6]
    assert np.allclose(np.frombuffer(made[6:30], "<f4"), np.frombuffer(example[6:30], "<f4"), atol=1e-6)
    assert bota_frame(SYNTHETIC, microseconds=123_456, temperature=31.5) == bytes.fromhex(
        "AA00000000803F000000C000006040CDCCCC3DCDCC4CBECDCC4C3D40E201000000FC41F2F6"
    )
    assert robotiq_frame(SYNTHETIC) == bytes.fromhex("204E640038FF5E01640038FF32006365")
    assert rdt_record(SYNTHETIC, ATI_TYPICAL, sequence=1, ft_sequence=7) == bytes.fromhex(
        "000000010000000700000000000F4240FFE17B80003567E0000186A0FFFCF2C00000C350"
    )
    assert rtde_packet(b"V", b"\0\2") == bytes.fromhex("0005560002")


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
