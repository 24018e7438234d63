"""Universal Robots RTDE: big-endian packets, a recipe agreed on first."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.emulate.arms import UR5E_TABLE, flange_pose
from contactbench.pipeline.devices.emulate.models.model import WIRE_FAULTS, Model, Quirk
from contactbench.pipeline.devices.emulate.script import EmulatorError, Fault

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from contactbench.pipeline.devices.emulate.signals import Moment, Reading, Six

_VERSION, _OUTPUTS, _INPUTS, _START, _PAUSE, _CONTROLLER, _DATA = (b"V", b"O", b"I", b"S", b"P", b"v", b"U")
_SPOKEN = 2
_RECIPE = 1
_HIGHEST_HZ = 500.0
_TYPES = {
    "timestamp": ("DOUBLE", "d"),
    "actual_q": ("VECTOR6D", "6d"),
    "actual_qd": ("VECTOR6D", "6d"),
    "actual_TCP_pose": ("VECTOR6D", "6d"),
    "actual_TCP_force": ("VECTOR6D", "6d"),
    "ft_raw_wrench": ("VECTOR6D", "6d"),
    "tcp_offset": ("VECTOR6D", "6d"),
    "robot_mode": ("INT32", "i"),
    "safety_mode": ("INT32", "i"),
    "robot_status_bits": ("UINT32", "I"),
}
_STILL: dict[str, tuple[float, ...]] = {
    "actual_qd": (0.0,) * 6,
    "actual_TCP_force": (0.0,) * 6,
    "ft_raw_wrench": (0.0,) * 6,
    "robot_mode": (7,),
    "safety_mode": (1,),
    "robot_status_bits": (3,),
}
# Size and kind of a packet, and a recipe, as a float: 1e-306.
_TRAP = struct.unpack(">d", b"\x00\x3b\x55\x01\x00\x3b\x55\x01")[0]


def rtde_packet(kind: bytes, payload: bytes = b"") -> bytes:
    """Return one packet of a kind, a single letter."""
    return struct.pack(">H", 3 + len(payload)) + kind + payload


class UrModel(Model):
    """A UR5e; its signal is the joint angles in rad. It speaks version 2 of the protocol and no other.

    Parameters
    ----------
    rate : float or None
    quirks : iterable of Quirk
    tool : six floats
        The active tool frame in the flange frame, as the pendant shows it: m, then a rotation vector in rad.

    Raises
    ------
    EmulatorError
        Also when the tool is not six finite numbers.
    """

    name = "ur"
    own_rate = 125.0
    faults = WIRE_FAULTS | {Fault.HEADER, Fault.WRONG_RATE, Fault.CLOCK_JUMP}
    trap: ClassVar[Six | None] = (_TRAP,) * 6
    possible_quirks: ClassVar[frozenset[Quirk]] = frozenset({Quirk.OLDER})

    def __init__(
        self, rate: float | None = None, quirks: Iterable[Quirk | str] = (), *, tool: Six = (0.0,) * 6
    ) -> None:
        super().__init__(rate, quirks)
        if len(tool) != 6 or not all(map(math.isfinite, tool)):
            raise EmulatorError(f"tool {tool}: give six finite numbers, m and rad.")
        self._tool = tool
        self._R_ET = Rotation.from_rotvec(tool[3:]).as_matrix()
        self._agreed = False
        self._recipe: tuple[str, ...] = ()
        self._known = {name for name in _TYPES if name != "tcp_offset" or Quirk.OLDER not in self.quirks}

    def restart(self) -> None:
        """Come up again, without a recipe."""
        super().restart()
        self._agreed, self._recipe = False, ()

    def frame(self, reading: Reading, moment: Moment) -> bytes:
        """Return one data packet."""
        R_BE, p_BE_B = flange_pose(UR5E_TABLE, reading.values)
        position = p_BE_B + R_BE @ np.array(self._tool[:3])
        values = {
            "timestamp": (moment.clock,),
            "actual_q": reading.values,
            "actual_TCP_pose": (*position.tolist(), *_vector(R_BE @ self._R_ET)),
            "tcp_offset": self._tool,
            **_STILL,
        }
        fields = [struct.pack(">" + _TYPES[name][1], *values[name]) for name in self._recipe]
        return rtde_packet(_DATA, bytes([_RECIPE]) + b"".join(fields))

    def damaged(self, frame: bytes) -> bytes:
        """Return the packet with another recipe's number: the protocol has no checksum."""
        return frame[:3] + bytes([frame[3] ^ 0x5A]) + frame[4:]

    def _step(self) -> list[bytes]:
        if len(self._pending) < 3:
            return []
        size = int.from_bytes(self._pending[:2], "big")
        if size < 3:
            self._refuse(self._take(len(self._pending)))
            return []
        if len(self._pending) < size:
            return []
        packet = self._take(size)
        kind, payload = packet[2:3], packet[3:]
        if kind == _INPUTS and self._agreed:
            self._refuse(packet)  # nobody has to set anything here
            return [rtde_packet(kind, b"\0" + b",".join([b"NOT_FOUND"] * (payload.count(b",") + 1)))]
        answer = self._reply(kind, payload)
        if answer is None:
            self._refuse(packet)
            return []
        self._obey(packet)
        return [answer]

    def _reply(self, kind: bytes, payload: bytes) -> bytes | None:
        if kind == _VERSION and len(payload) == 2:
            self._agreed = int.from_bytes(payload, "big") == _SPOKEN
            return rtde_packet(kind, bytes([self._agreed]))
        if kind == _CONTROLLER and not payload:
            return rtde_packet(kind, struct.pack(">4I", 5, 11, 0, 0))
        return self._reply_agreed(kind, payload) if self._agreed else None

    def _reply_agreed(self, kind: bytes, payload: bytes) -> bytes | None:
        if kind == _OUTPUTS and len(payload) >= 8:
            return self._outputs(payload)
        if kind == _START and not payload:
            self.streaming = bool(self._recipe)
            return rtde_packet(kind, bytes([self.streaming]))
        if kind == _PAUSE and not payload:
            self.streaming = False
            return rtde_packet(kind, b"\1")
        return None

    def _outputs(self, payload: bytes) -> bytes:
        rate = struct.unpack(">d", payload[:8])[0]
        names = tuple(payload[8:].decode("ascii", "replace").split(","))
        types = ",".join(_TYPES[name][0] if name in self._known else "NOT_FOUND" for name in names)
        good = self._known.issuperset(names) and math.isfinite(rate) and 0 < rate <= _HIGHEST_HZ
        if good:
            self._recipe, self.rate = names, rate
        return rtde_packet(_OUTPUTS, bytes([_RECIPE if good else 0]) + types.encode("ascii"))


def _vector(R_BE: NDArray[np.float64]) -> list[float]:
    values: list[float] = Rotation.from_matrix(R_BE).as_rotvec().tolist()
    return values
