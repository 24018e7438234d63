"""A UR's stream from the first request to flange samples, as a state machine without a line."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.protocols import ur_rtde
from contactbench.pipeline.devices.protocols.commands import check_rate
from contactbench.pipeline.devices.protocols.ur_rtde import Kind, Packet, PacketReader, Recipe, RtdeError
from contactbench.pipeline.devices.sample import FlangeSample

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

CLOCK, JOINTS, POSE, TOOL = "timestamp", "actual_q", "actual_TCP_pose", "tcp_offset"
_ABSURD = 1e3  # m or rad
VARIABLES = (CLOCK, JOINTS, POSE)
# The pose is that of the tool frame which is active on the pendant; older controllers do not tell which.
_WITH_TOOL = (*VARIABLES, TOOL)


class Stage(Enum):
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
            raise RtdeError(f"UR: a tool frame has six finite numbers, not {tool!r}.")
        self._reader = PacketReader()
        self._recipe: Recipe | None = None
        self._variables: tuple[str, ...] = _WITH_TOOL
        self._output = b""
        self._stage = Stage.VERSION

    @property
    def stage(self) -> Stage:
        """How far the conversation is."""
        return self._stage

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
        self._stage = Stage.VERSION
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
            if packet.kind is Kind.TEXT:
                continue
            if self._stage is Stage.STREAMING and self._recipe is not None:
                values = self._recipe.values(packet)
                samples.append(flange_sample(values, time, values.get(TOOL, self._tool)))
            else:
                self._converse(packet)
        return samples

    def _converse(self, packet: Packet) -> None:
        if self._stage is Stage.VERSION:
            ur_rtde.check_accepted(packet, Kind.VERSION)
            self._output += ur_rtde.outputs_request(self._rate, self._variables)
            self._stage = Stage.OUTPUTS
        elif self._stage is Stage.OUTPUTS and self._tool_is_unknown(packet):
            self._variables = VARIABLES
            self._output += ur_rtde.outputs_request(self._rate, self._variables)
        elif self._stage is Stage.OUTPUTS:
            self._recipe = Recipe.agreed(packet, self._variables)
            self._output += ur_rtde.start_request()
            self._stage = Stage.START
        else:
            ur_rtde.check_accepted(packet, Kind.START)
            self._stage = Stage.STREAMING

    def _tool_is_unknown(self, packet: Packet) -> bool:
        """Tell whether an older controller knows all that was asked for but the tool frame."""
        if packet.kind is not Kind.OUTPUTS or TOOL not in self._variables:
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
        raise RtdeError(f"UR: {tuple(pose)!r} is not a pose: reconnect.")
    R_BE, p_BE_B = Rotation.from_rotvec(pose[3:]), np.full(3, np.nan)
    if tool is not None and (len(tool) != 6 or not (np.abs(tool) < _ABSURD).all()):
        raise RtdeError(f"UR: {tuple(tool)!r} is not a tool frame: reconnect.")
    if tool is not None:
        R_BE = R_BE * Rotation.from_rotvec(tool[3:]).inv()
        p_BE_B = pose[:3] - R_BE.apply(tool[:3])
    joints = np.asarray(values[JOINTS], dtype=np.float64)
    return FlangeSample(time, R_BE.as_matrix(), p_BE_B, joints, float(values[CLOCK][0]))
