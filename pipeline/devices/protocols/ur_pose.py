"""A UR's stream from the first request to flange samples, as a state machine without a line."""

import math
import struct
from collections.abc import Iterable, Mapping, Sequence
from enum import Enum
from typing import Any, ClassVar

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.clock import SampleClock
from contactbench.pipeline.devices.driver import Carrier, Driver, Way
from contactbench.pipeline.devices.faults import EmulatorError, Fault, FrameMoment, SensorReading, Six
from contactbench.pipeline.devices.options import Option, numbers
from contactbench.pipeline.devices.protocols import ur_rtde
from contactbench.pipeline.devices.protocols.arms import UR5E_TABLE, flange_pose
from contactbench.pipeline.devices.protocols.commands import check_rate
from contactbench.pipeline.devices.protocols.device_model import JOINTS as AT_REST
from contactbench.pipeline.devices.protocols.device_model import WIRE_FAULTS, Model, Quirk
from contactbench.pipeline.devices.protocols.parser import Counters, ProtocolError, SensorDriver
from contactbench.pipeline.devices.protocols.ur_rtde import (
    OutputRecipe,
    Packet,
    PacketKind,
    PacketReader,
    RtdeError,
)
from contactbench.pipeline.devices.protocols.ur_wrench import wrench_driver
from contactbench.pipeline.devices.reconnecting_stream import ReconnectingStream
from contactbench.pipeline.devices.sample import FlangeSample
from contactbench.pipeline.devices.stream import OnChange, OnFlanges
from contactbench.pipeline.devices.transport import Line, line_to
from contactbench.pipeline.devices.url import DeviceAddress
from contactbench.pipeline.devices.watch import Watch
from contactbench.pipeline.errors import arg, message

CLOCK, JOINTS, POSE, TOOL = "timestamp", "actual_q", "actual_TCP_pose", "tcp_offset"
_ABSURD = 1e3  # m or rad
_USUAL_RATE_HZ = 50.0
_MOST_TOOL = 10.0  # m or rad
VARIABLES = (CLOCK, JOINTS, POSE)
# The pose is that of the tool frame which is active on the pendant; older controllers do not tell which.
_WITH_TOOL = (*VARIABLES, TOOL)


class UrStage(Enum):
    """How far the conversation is."""

    VERSION = 1
    OUTPUTS = 2
    START = 3
    STREAMING = 4


class UrStream:
    """
    The conversation with one controller.

    Send what `start` returns; hand every byte that comes to `feed`; send what `take_output` returns after.

    Parameters
    ----------
    rate_hz : float
        1 to 500 Hz.
    tool : 6 floats, optional
        The active tool frame in the flange frame, as the pendant shows it: m, then a rotation vector in
        rad. Zeros say that it is the flange. It is for older controllers: newer ones tell it with every pose.
        Where it is not known the tool is taken to be parallel to the flange, and positions are NaN: the
        controller gives the tool's, not the flange's.

    Raises
    ------
    ProtocolError
        The rate is not one that the controller can have, or `tool` is not six finite numbers.
    """

    def __init__(self, rate_hz: float, tool: Sequence[float] | None = None) -> None:
        self._rate = check_rate("UR", rate_hz, ur_rtde.LOWEST_RATE, ur_rtde.HIGHEST_RATE)
        self._tool = None if tool is None else tuple(tool)
        if self._tool is not None and (len(self._tool) != 6 or not np.isfinite(self._tool).all()):
            raise RtdeError(f"UR: a tool frame has six finite numbers, not {arg(tool)!r}.")
        self._reader = PacketReader()
        self._recipe: OutputRecipe | None = None
        self._variables: tuple[str, ...] = _WITH_TOOL
        self._output = b""
        self.stage = UrStage.VERSION  # How far the conversation is

    @property
    def knows_flange(self) -> bool:
        """Whether the flange follows from the poses; False, once it streams: they are the tool's."""
        return self._tool is not None or TOOL in self._variables

    @property
    def skipped_bytes(self) -> int:
        """Bytes that belonged to no packet."""
        return self._reader.skipped_bytes

    @property
    def pending(self) -> int:
        """Bytes that wait for the rest of their packet."""
        return self._reader.pending

    def start(self) -> bytes:
        """Begin anew, also after the line was lost: return the first request."""
        self._reader.reset()
        self._recipe, self._variables = None, _WITH_TOOL
        self._output = b""
        self.stage = UrStage.VERSION
        return ur_rtde.version_request()

    def take_output(self) -> bytes:
        """Return what is to be sent now, once."""
        output, self._output = self._output, b""
        return output

    def feed(self, data: bytes, time: float) -> list[FlangeSample]:
        """
        Take bytes as they arrive, cut anywhere.

        Parameters
        ----------
        data : bytes
            From the controller.
        time : float
            When the last of them arrived, seconds of the host's monotonic clock.

        Returns
        -------
        list of FlangeSample
            Oldest first; none until the stream runs.

        Raises
        ------
        RtdeError
            The controller refused a request, or sent what was not agreed: `start` again.
        """
        samples: list[FlangeSample] = []
        for packet in self._reader.feed(data):
            # The controller may send texts at any time.
            if packet.kind is PacketKind.TEXT:
                continue
            if self.stage is UrStage.STREAMING and self._recipe is not None:
                values = self._recipe.values(packet)
                samples.append(flange_sample(values, time, values.get(TOOL, self._tool)))
            else:
                self._converse(packet)
        return samples

    def _converse(self, packet: Packet) -> None:
        if self.stage is UrStage.VERSION:
            ur_rtde.check_accepted(packet, PacketKind.VERSION)
            self._output += ur_rtde.outputs_request(self._rate, self._variables)
            self.stage = UrStage.OUTPUTS
        elif self.stage is UrStage.OUTPUTS and self._tool_is_unknown(packet):
            self._variables = VARIABLES
            self._output += ur_rtde.outputs_request(self._rate, self._variables)
        elif self.stage is UrStage.OUTPUTS:
            self._recipe = OutputRecipe.agreed(packet, self._variables)
            self._output += ur_rtde.start_request()
            self.stage = UrStage.START
        else:
            ur_rtde.check_accepted(packet, PacketKind.START)
            self.stage = UrStage.STREAMING

    def _tool_is_unknown(self, packet: Packet) -> bool:
        """Tell whether an older controller knows all that was asked for but the tool frame."""
        if packet.kind is not PacketKind.OUTPUTS or TOOL not in self._variables:
            return False
        types = packet.payload[1:].split(b",")
        return (
            len(types) == len(self._variables)
            and types[-1] == b"NOT_FOUND"
            and b"NOT_FOUND" not in types[:-1]
        )


def flange_sample(
    values: Mapping[str, Sequence[float]], time: float, tool: Sequence[float] | None = None
) -> FlangeSample:
    """
    Make a sample from one data packet's values; `tool` as for `UrStream`.

    Raises
    ------
    RtdeError
        Joints, pose or clock are missing or of the wrong width.
    """
    wanted = {CLOCK: 1, JOINTS: 6, POSE: 6}
    if any(len(values.get(name, ())) != width for name, width in wanted.items()):
        raise RtdeError("UR: data must hold a clock, six joints and a pose of six: reconnect.")
    pose = np.asarray(values[POSE], dtype=np.float64)
    if not (np.abs(pose) < _ABSURD).all():
        raise RtdeError(f"UR: {arg(tuple(pose))!r} is not a pose: reconnect.")
    R_BE, p_BE_B = Rotation.from_rotvec(pose[3:]), np.full(3, np.nan)
    if tool is not None and (len(tool) != 6 or not (np.abs(tool) < _ABSURD).all()):
        raise RtdeError(f"UR: {arg(tuple(tool))!r} is not a tool frame: reconnect.")
    if tool is not None:
        R_BE = R_BE * Rotation.from_rotvec(tool[3:]).inv()
        p_BE_B = pose[:3] - R_BE.apply(tool[:3])
    joints = np.asarray(values[JOINTS], dtype=np.float64)
    return FlangeSample(time, R_BE.as_matrix(), p_BE_B, joints, float(values[CLOCK][0]))


class UrPoses(ReconnectingStream[FlangeSample]):
    """
    A UR robot's flange, over RTDE.

    Parameters
    ----------
    address : DeviceAddress
    on_samples, on_change
        As for `ReconnectingStream`.
    tool : 6 floats, optional
        See `UrStream`.
    """

    def __init__(
        self,
        address: DeviceAddress,
        on_samples: OnFlanges,
        on_change: OnChange = None,
        *,
        tool: Sequence[float] | None = None,
        line: Line | None = None,
    ) -> None:
        rate = address.rate or _USUAL_RATE_HZ
        self._talk = UrStream(rate, tool)
        self._clock = SampleClock(rate)
        self._refused = 0
        super().__init__(address, line or line_to(address), Watch(rate), on_samples, on_change)

    def _begin(self) -> None:
        self._line.write(self._talk.start())

    def _feed(self, data: bytes, arrived: float) -> list[FlangeSample]:
        try:
            samples = self._talk.feed(data, arrived)
        except ProtocolError:
            self._refused += 1
            raise
        if output := self._talk.take_output():
            self._line.write(output)
        return self._clock.stamp(samples)

    def _reset(self) -> None:
        self._clock.forget()

    def _troubles(self) -> dict[str, str]:
        if self._talk.stage is not UrStage.STREAMING or self._talk.knows_flange:
            return {}
        return {
            "tool": message(
                "The controller does not report the tool set on the pendant, so the orientation is"
                " that of the tool frame. Add ?tool=x,y,z,rx,ry,rz (m, rad) to the address, as set on"
                " the pendant."
            )
        }

    def _end(self) -> None:
        if self._talk.stage is UrStage.STREAMING:
            self._line.write(ur_rtde.pause_request())

    def _counters(self) -> Counters:
        return Counters(
            frames=self._watch.samples, bad_checksums=self._refused, skipped_bytes=self._talk.skipped_bytes
        )


# ---- emulated: a UR5e's controller ---------------------------------------------------------------

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
_NEWER = {"tcp_offset", "ft_raw_wrench"}
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

    For a host that asks for the raw wrench and for no joints, the signal is that wrench, N and N·m.

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
    rest: ClassVar[Six] = AT_REST
    swing: ClassVar[Six] = (0.2,) * 6
    swing_hz = 0.2
    own_rate = 125.0
    faults = WIRE_FAULTS | {Fault.HEADER, Fault.WRONG_RATE, Fault.CLOCK_JUMP}
    trap: ClassVar[Six | None] = (_TRAP,) * 6
    possible_quirks: ClassVar[frozenset[Quirk]] = frozenset({Quirk.OLDER})

    def __init__(
        self, rate: float | None = None, quirks: Iterable[Quirk | str] = (), *, tool: Six = (0.0,) * 6
    ) -> None:
        super().__init__(rate, quirks)
        if len(tool) != 6 or not all(map(math.isfinite, tool)):
            raise EmulatorError(f"tool {arg(tool)}: give six finite numbers, m and rad.")
        self._tool = tool
        self._R_ET = Rotation.from_rotvec(tool[3:]).as_matrix()
        self._agreed = False
        self._recipe: tuple[str, ...] = ()
        self._known = set(_TYPES) - (_NEWER if Quirk.OLDER in self.quirks else set())

    def restart(self) -> None:
        """Come up again, without a recipe."""
        super().restart()
        self._agreed, self._recipe = False, ()

    def frame(self, reading: SensorReading, moment: FrameMoment) -> bytes:
        """Return one data packet."""
        R_BE, p_BE_B = flange_pose(UR5E_TABLE, reading.values)
        position = p_BE_B + R_BE @ np.array(self._tool[:3])
        wrench = {} if "actual_q" in self._recipe else {"ft_raw_wrench": reading.values}
        turned = Rotation.from_matrix(R_BE @ self._R_ET).as_rotvec()
        values = {
            "timestamp": (moment.clock,),
            "actual_q": reading.values,
            "actual_TCP_pose": (*position.tolist(), *turned.tolist()),
            "tcp_offset": self._tool,
            **_STILL,
            **wrench,
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


class UrDriver(Driver):
    """A UR's controller."""

    scheme, title = "ur", "Universal Robots"
    ways = (Way(Carrier.TCP, port=ur_rtde.PORT),)
    rate = 125.0
    options: ClassVar[Mapping[str, Option]] = {
        "tool": Option(
            "Tool frame as on the pendant, x,y,z,rx,ry,rz in m and rad, for controllers that do not report it.",
            numbers(6, 6, _MOST_TOOL),
        )
    }
    emulated = UrModel

    def sensor(self, address: DeviceAddress) -> SensorDriver:
        """As `Driver`: the sensor in the flange, where the robot has one."""
        return wrench_driver(address.rate or 125.0)

    def poses(
        self, address: DeviceAddress, on_samples: OnFlanges, on_change: OnChange = None
    ) -> ReconnectingStream[FlangeSample]:
        """As `Driver`."""
        return UrPoses(address, on_samples, on_change, tool=address.options["tool"])

    def emulate(
        self, rate: float | None, quirks: Iterable[Quirk | str], options: Mapping[str, Any]
    ) -> tuple[Model, Mapping[str, Any]]:
        """As `Driver`; a tool is not in the address: the controller reports it, unless it is an older one."""
        return UrModel(rate, quirks, tool=options.get("tool", (0.0,) * 6)), {}
