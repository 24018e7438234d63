"""
Universal Robots' real-time data exchange (RTDE), TCP port 30004, protocol version 2.

A packet is its own size (uint16, big endian, with itself), a kind (one letter), a payload. Only outputs
are subscribed to; nothing is ever written to the robot's inputs.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from enum import IntEnum

from contactbench.pipeline.devices.protocols.commands import check_rate
from contactbench.pipeline.devices.protocols.parser import ProtocolError
from contactbench.pipeline.devices.protocols.scanner import Pieces
from contactbench.pipeline.errors import arg, message

PORT = 30004
_VERSION = 2
_HEADER = struct.Struct(">HB")
# Texts of the controller are shorter; what claims more is not the beginning of a packet.
_LONGEST_PACKET = 4096
LOWEST_RATE, HIGHEST_RATE = 1.0, 500.0


class RtdeError(ProtocolError):
    """A refusal by the controller, or a packet that does not hold what was agreed."""


class PacketKind(IntEnum):
    """Kinds of packets that are sent or understood."""

    VERSION = ord("V")
    OUTPUTS = ord("O")
    START = ord("S")
    PAUSE = ord("P")
    DATA = ord("U")
    TEXT = ord("M")


_KINDS = frozenset(PacketKind)

_FORMATS = {
    "DOUBLE": "d",
    "VECTOR6D": "6d",
    "VECTOR3D": "3d",
    "VECTOR6INT32": "6i",
    "VECTOR6UINT32": "6I",
    "UINT64": "Q",
    "UINT32": "I",
    "INT32": "i",
    "UINT8": "B",
    "BOOL": "?",
}


@dataclass(frozen=True, slots=True)
class Packet:
    """One packet: its kind and what follows the header."""

    kind: PacketKind
    payload: bytes


def packet(kind: PacketKind, payload: bytes = b"") -> bytes:
    """Return the bytes of a packet."""
    return _HEADER.pack(_HEADER.size + len(payload), kind) + payload


def version_request() -> bytes:
    """Ask for protocol version 2."""
    return packet(PacketKind.VERSION, struct.pack(">H", _VERSION))


def outputs_request(rate_hz: float, names: tuple[str, ...]) -> bytes:
    """
    Ask for variables, at a rate.

    Raises
    ------
    ProtocolError
        The rate is not one that the controller can have, or a name is no name.
    """
    check_rate("UR", rate_hz, LOWEST_RATE, HIGHEST_RATE)
    if not names or not all(name.isascii() and name.isidentifier() for name in names):
        raise RtdeError(f"UR: variables need plain names, not {arg(names)!r}.")
    payload = struct.pack(">d", rate_hz) + ",".join(names).encode("ascii")
    if _HEADER.size + len(payload) > _LONGEST_PACKET:
        raise RtdeError(f"UR: {arg(len(names))} variables are too many for one packet: ask for fewer.")
    return packet(PacketKind.OUTPUTS, payload)


def start_request() -> bytes:
    """Ask for the stream to begin."""
    return packet(PacketKind.START)


def pause_request() -> bytes:
    """Ask for the stream to end."""
    return packet(PacketKind.PAUSE)


def check_accepted(reply: Packet, kind: PacketKind) -> None:
    """
    Refuse an answer to a version, start or pause request that does not accept it.

    Raises
    ------
    RtdeError
        It is another kind of packet, or says no.
    """
    if reply.kind is not kind or len(reply.payload) != 1:
        raise RtdeError(f"UR: asked for {arg(kind.name.lower())}, received {arg(_shown(reply))}. Reconnect.")
    if reply.payload != b"\x01":
        raise RtdeError(
            f"UR: the controller refused the {arg(kind.name.lower())} request. Its software may be"
            " older than 3.10 or 5.4, or another RTDE client may hold the same variables."
        )


@dataclass(frozen=True)
class OutputRecipe:
    """What the data packets hold."""

    number: int  # the controller's name for it, the first byte of every data packet
    # One of each per variable.
    names: tuple[str, ...]
    types: tuple[str, ...]

    @classmethod
    def agreed(cls, reply: Packet, names: tuple[str, ...]) -> OutputRecipe:
        """
        Read the answer to `outputs_request`.

        Raises
        ------
        RtdeError
            A variable is not there or is in use, the types are unknown, or it is another answer.
        """
        if reply.kind is not PacketKind.OUTPUTS or len(reply.payload) < 1:
            raise RtdeError(f"UR: asked for variables, received {arg(_shown(reply))}. Reconnect.")
        types = tuple(reply.payload[1:].decode("ascii", "replace").split(","))
        if len(types) != len(names):
            raise RtdeError(
                f"UR: asked for {arg(len(names))} variables, received {arg(len(types))}. Reconnect."
            )
        for name, kind in zip(names, types, strict=True):
            if kind not in _FORMATS:
                raise RtdeError(
                    f"UR: the variable {arg(name)} is {arg(kind[:40])!r}: the controller's software is too"
                    " old, or another client holds it."
                )
        return cls(reply.payload[0], names, types)

    @property
    def payload_bytes(self) -> int:
        """Length of a data packet's payload."""
        return self._layout.size

    def values(self, data: Packet) -> dict[str, tuple[float, ...]]:
        """
        Read a data packet.

        Returns
        -------
        dict
            Name to numbers, one or as many as the vector has.

        Raises
        ------
        RtdeError
            The packet is of another kind, recipe or length, or a number is not finite.
        """
        if data.kind is not PacketKind.DATA or len(data.payload) != self.payload_bytes:
            raise RtdeError(
                f"UR: received {arg(_shown(data))} instead of {arg(self.payload_bytes)} bytes of data. Reconnect."
            )
        number, *flat = self._layout.unpack(data.payload)
        if number != self.number:
            raise RtdeError(
                f"UR: received data of recipe {arg(number)} instead of {arg(self.number)}. Reconnect."
            )
        if not all(map(math.isfinite, flat)):
            raise RtdeError("UR: a value is not finite: the robot may not be powered.")
        fields: dict[str, tuple[float, ...]] = {}
        start = 0
        for name, kind in zip(self.names, self.types, strict=True):
            width = int(_FORMATS[kind][:-1] or 1)
            fields[name] = tuple(flat[start : start + width])
            start += width
        return fields

    @property
    def _layout(self) -> struct.Struct:
        return struct.Struct(">B" + "".join(_FORMATS[kind] for kind in self.types))


class PacketReader(Pieces):
    """
    Cuts a stream into packets; where none can begin, bytes are skipped and counted.

    Attributes
    ----------
    packets : int
    skipped_bytes : int
    """

    def __init__(self) -> None:
        super().__init__()
        self.packets = 0

    def feed(self, data: bytes) -> list[Packet]:
        """Take bytes as they arrive, cut anywhere; return the packets that end in them, oldest first."""
        found: list[Packet] = []
        for start in range(0, len(data), _LONGEST_PACKET):
            self._buffer += data[start : start + _LONGEST_PACKET]
            self._cut(found)
        return found

    def _cut(self, found: list[Packet]) -> None:
        buffer, position = self._buffer, 0
        while position + _HEADER.size <= len(buffer):
            size, kind = _HEADER.unpack_from(buffer, position)
            if not _HEADER.size <= size <= _LONGEST_PACKET or kind not in _KINDS:
                self.skipped_bytes += 1
                position += 1
            elif position + size > len(buffer):
                break
            else:
                found.append(
                    Packet(PacketKind(kind), bytes(buffer[position + _HEADER.size : position + size]))
                )
                self.packets += 1
                position += size
        del buffer[:position]


def _shown(reply: Packet) -> str:
    return message(f"a {arg(reply.kind.name.lower())} packet of {arg(len(reply.payload))} bytes")
