"""
OpenIGTLink messages: packed, and found in a stream of bytes.

Header and bodies are those of the protocol's versions 1 and 2 (openigtlink.org, protocol specification), which all
programs understand; of version 3 the longer header and the metadata are skipped. Numbers are big-endian, lengths mm.
"""

import re
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.protocols.checksums import crc64_ecma
from contactbench.pipeline.devices.protocols.parser import Counters, ProtocolError
from contactbench.pipeline.devices.protocols.scanner import Pieces
from contactbench.pipeline.errors import arg

TRANSFORM, POSITION, QTDATA, TDATA = "TRANSFORM", "POSITION", "QTDATA", "TDATA"
START_QTDATA, STOP_QTDATA, ANSWER_QTDATA = "STT_QTDATA", "STP_QTDATA", "RTS_QTDATA"
LONGEST_NAME = 20
"""Bytes of a device's name."""

_HEADER = struct.Struct(">H12s20sIIQQ")
_EXTENDED = struct.Struct(">HHII")
_ENTRY = struct.Struct(">HHI")  # of metadata: bytes of the key, encoding, bytes of the value
_MATRIX, _QUATERNION = struct.Struct(">12f"), struct.Struct(">7f")
_BODY_HEAD = struct.Struct(">20sBB")  # of one body in a list: name, kind of instrument
_POSES = {TRANSFORM: _MATRIX, POSITION: _QUATERNION, TDATA: _MATRIX, QTDATA: _QUATERNION}
_LISTS = (TDATA, QTDATA)
_MOST_BODIES = 64
_MOST_METADATA = 4096  # bytes of a version 3 message beside its content
_LONGEST_OTHER = 2**30  # of a message that is only skipped: a volume of 512^3 voxels has a quarter of that
_BEGIN = re.compile(rb"\x00[\x01\x02](?:[A-Z][A-Z0-9_]{0,11}\x00|[A-Z][A-Z0-9_]{11})")
_BEGIN_BYTES = 14
_NAME = re.compile(r"[A-Z][A-Z0-9_]*")
_MM = 1e-3
_FARTHEST_M = 100.0
_SEEN = ("OK", "UNKNOWN", "")  # of what PLUS calls the status of a transform
_LONGEST_STATUS = 40
_UNIT = 0.02  # a rotation or quaternion of single precision is much nearer to one than this


class IgtlError(ProtocolError):
    """What an OpenIGTLink server sends, and cannot be used; or a message that cannot be."""


@dataclass(frozen=True, slots=True)
class Message:
    """One message."""

    kind: str  # such as TRANSFORM
    device: str
    time: float | None  # the sender's clock, s; None: it has none
    content: bytes  # of the body, without what version 3 adds
    metadata: Mapping[str, str] = field(default_factory=dict)  # what version 3 adds


@dataclass(frozen=True, eq=False, slots=True)
class BodyPose:
    """Where a tracked body is in the tracker's frame T."""

    body: str
    R_TB: NDArray[np.float64]  # (3, 3)
    p_TB_T: NDArray[np.float64]  # (3,) m


# ---- packed ------------------------------------------------------------------------------------


def pack(kind: str, device: str, stamp_ns: int, content: bytes) -> bytes:
    """
    Return one message of version 1.

    Parameters
    ----------
    kind, device : str
        At most 12 and 20 bytes.
    stamp_ns : int
        Unix time, ns.
    content : bytes

    Raises
    ------
    IgtlError
        A name is too long or not ASCII, or the time does not fit.
    """
    try:
        names = kind.encode("ascii"), device.encode("ascii")
        seconds, rest = divmod(stamp_ns, 1_000_000_000)
        if len(names[0]) > 12 or len(names[1]) > LONGEST_NAME:
            raise IgtlError(
                f"OpenIGTLink: the name {arg(device)!r} is too long: {arg(LONGEST_NAME)} letters at most."
            )
        head = _HEADER.pack(
            1, *names, seconds, (rest << 32) // 1_000_000_000, len(content), crc64_ecma(content)
        )
    except (UnicodeError, struct.error) as error:
        raise IgtlError(
            f"OpenIGTLink: {arg(kind)} of {arg(device)!r} cannot be written ({arg(error)}): use ASCII names."
        ) from error
    return head + content


def transform(R: NDArray[np.float64], p: NDArray[np.float64]) -> bytes:
    """Return the content of a TRANSFORM: R (3, 3) column by column, and p (3,) m, which becomes mm."""
    return _MATRIX.pack(*R.T.ravel().tolist(), *(p / _MM).tolist())


def quaternion_pose(R: NDArray[np.float64], p: NDArray[np.float64]) -> bytes:
    """Return the content of a POSITION: p (3,) m, which becomes mm, and R (3, 3) as a quaternion x, y, z, w."""
    return _QUATERNION.pack(*(p / _MM).tolist(), *Rotation.from_matrix(R).as_quat().tolist())


def listed(body: str, pose: bytes) -> bytes:
    """Return one body of a QTDATA or TDATA: a tracked tool with six degrees of freedom, and its pose."""
    return _BODY_HEAD.pack(body.encode("ascii"), 2, 0) + pose


def sensor(values: Sequence[float], unit: int = 0) -> bytes:
    """Return the content of a SENSOR: at most 255 values; `unit` as the protocol packs it, 0: none."""
    return struct.pack(f">BBQ{len(values)}d", len(values), 0, unit, *values)


def status(code: int, subcode: int, name: str, text: str) -> bytes:
    """Return the content of a STATUS: the protocol's code (1: well), one of ours, a short name, a text."""
    return struct.pack(">Hq20s", code, subcode, name.encode("ascii")) + text.encode("ascii") + b"\0"


def start_qtdata(rate: float) -> bytes:
    """Return the request for all bodies' poses, `rate` a second (at most one a millisecond)."""
    return pack(START_QTDATA, "", 0, struct.pack(">i32x", max(1, round(1e3 / rate))))


# ---- found -------------------------------------------------------------------------------------


class MessageReader(Pieces):
    """
    Finds poses' messages in bytes that are cut anywhere; all other messages are skipped unread.

    Where no message begins, or a checksum is wrong, it moves on by a byte, as `FrameScanner` does. It never holds
    more than one message of a few kB, whatever length one announces.
    """

    def __init__(self) -> None:
        super().__init__()
        self._unread = 0  # bytes of a message that is skipped
        self._frames = self._bad_checksums = 0

    @property
    def counters(self) -> Counters:
        """What was seen so far; messages that are skipped unread count as neither frames nor skipped bytes."""
        return Counters(
            frames=self._frames, bad_checksums=self._bad_checksums, skipped_bytes=self.skipped_bytes
        )

    def reset(self) -> None:
        """Forget half a message: the line was lost, or nothing useful came for long."""
        super().reset()
        self._unread = 0

    def feed(self, data: bytes) -> list[Message]:
        """Take bytes; return the messages that end in them, oldest first."""
        self._buffer += data
        found: list[Message] = []
        position = 0
        while True:
            ignored = min(self._unread, len(self._buffer) - position)
            self._unread -= ignored
            position += ignored
            begin = self._next_begin(position)
            self.skipped_bytes += begin - position
            position = begin
            if position + _HEADER.size > len(self._buffer):
                break
            step = self._look(position, found)
            if step == 0:
                break
            position += step
        del self._buffer[:position]
        return found

    def _next_begin(self, position: int) -> int:
        """Return where a message begins, or may begin once more bytes are there."""
        match = _BEGIN.search(self._buffer, position)
        return match.start() if match else max(position, len(self._buffer) - _BEGIN_BYTES + 1)

    def _look(self, position: int, found: list[Message]) -> int:
        """Take the message at a place; return by how much to move on, 0: it is not whole yet."""
        version, kind_field, device_field, seconds, fraction, size, crc = _HEADER.unpack_from(
            self._buffer, position
        )
        kind, device = _text(kind_field), _text(device_field)
        if not _NAME.fullmatch(kind) or kind_field.rstrip(b"\0") != kind.encode() or size > _LONGEST_OTHER:
            return self._move_on()
        if kind not in _POSES:
            self._unread = size
            return _HEADER.size
        if not _fits(kind, version, size):
            return self._move_on()
        end = position + _HEADER.size + size
        if end > len(self._buffer):
            return 0
        body = bytes(self._buffer[position + _HEADER.size : end])
        parts = _parts(version, body) if crc64_ecma(body) == crc else None
        if parts is None:
            self._bad_checksums += 1
            return self._move_on()
        self._frames += 1
        time = seconds + fraction / 2**32 if seconds or fraction else None
        found.append(Message(kind, device, time, *parts))
        return _HEADER.size + int(size)

    def _move_on(self) -> int:
        self.skipped_bytes += 1
        return 1


def first_message(data: bytes) -> tuple[str, int] | None:
    """Return kind and length in bytes of the message that data begins with; None: it is not whole."""
    if len(data) < _HEADER.size:
        return None
    _, kind, _, _, _, size, _ = _HEADER.unpack_from(data)
    whole = _HEADER.size + size
    return (_text(kind), whole) if whole <= len(data) else None


def _text(field: bytes) -> str:
    return field.partition(b"\0")[0].decode("ascii", "replace")


def _fits(kind: str, version: int, size: int) -> bool:
    """Tell whether a message can have so many bytes: a damaged length must not keep the next ones waiting."""
    pose = _POSES[kind].size
    if kind in _LISTS:
        pose = (pose + _BODY_HEAD.size) * _MOST_BODIES
    return size <= pose + (_MOST_METADATA if version > 1 else 0)


def _parts(version: int, body: bytes) -> tuple[bytes, Mapping[str, str]] | None:
    """Return content and metadata of a body; None: its parts are longer than the whole."""
    if version == 1:
        return body, {}
    if len(body) < _EXTENDED.size:
        return None
    head, metadata_head, metadata, _ = _EXTENDED.unpack_from(body)
    end = len(body) - metadata_head - metadata
    if not _EXTENDED.size <= head <= end:
        return None
    return body[head:end], _metadata(body[end : end + metadata_head], body[end + metadata_head :])


def _metadata(index: bytes, texts: bytes) -> Mapping[str, str]:
    """Return keys and values; of an index that does not fit, those that do."""
    found, at = {}, 0
    for begin in range(2, len(index) - _ENTRY.size + 1, _ENTRY.size):
        key, _, value = _ENTRY.unpack_from(index, begin)
        if at + key + value > len(texts):
            break
        found[texts[at : at + key].decode("ascii", "replace")] = texts[at + key : at + key + value].decode(
            "utf-8", "replace"
        )
        at += key + value
    return found


# ---- read --------------------------------------------------------------------------------------


def poses_of(packet: Message) -> list[BodyPose]:
    """
    Return the poses in a TRANSFORM, POSITION, QTDATA or TDATA.

    Raises
    ------
    IgtlError
        Its length is wrong, a number is not finite or absurd, a rotation is none, or the sender says that the body
        was not seen.
    """
    status = packet.metadata.get("TransformStatus", "OK")
    if status not in _SEEN or packet.metadata.get("TransformValid", "1").lower() in ("0", "false"):
        raise IgtlError(
            f"{arg(packet.kind)} of {arg(packet.device)!r}: the tracker does not see the body"
            f" ({arg(status[:_LONGEST_STATUS])}): bring it in sight."
        )
    form = _POSES[packet.kind]
    if packet.kind not in _LISTS:
        if len(packet.content) != form.size:
            raise IgtlError(
                f"{arg(packet.kind)} of {arg(packet.device)!r} has {arg(len(packet.content))} bytes instead"
                f" of {arg(form.size)}: a pose needs position and orientation."
            )
        return [_pose(packet.kind, packet.device, form.unpack(packet.content))]
    step = _BODY_HEAD.size + form.size
    if len(packet.content) % step:
        raise IgtlError(
            f"{arg(packet.kind)} has {arg(len(packet.content))} bytes: each body takes {arg(step)}."
        )
    return [
        _pose(
            packet.kind,
            _text(packet.content[begin : begin + LONGEST_NAME]),
            form.unpack_from(packet.content, begin + _BODY_HEAD.size),
        )
        for begin in range(0, len(packet.content), step)
    ]


def _pose(kind: str, body: str, numbers: tuple[float, ...]) -> BodyPose:
    values = np.array(numbers)
    if not np.isfinite(values).all():
        raise IgtlError(f"{arg(kind)} of {arg(body)!r}: a number is not finite: check the tracker.")
    if _POSES[kind] is _MATRIX:
        R, p = values[:9].reshape(3, 3).T, values[9:] * _MM
        good = bool(np.abs(R @ R.T - np.eye(3)).max() <= _UNIT and np.linalg.det(R) > 0)
        R_TB = Rotation.from_matrix(R).as_matrix() if good else R
    else:
        p = values[:3] * _MM
        good = bool(abs(np.linalg.norm(values[3:]) - 1) <= _UNIT)
        R_TB = Rotation.from_quat(values[3:]).as_matrix() if good else np.eye(3)
    if not good:
        raise IgtlError(
            f"{arg(kind)} of {arg(body)!r}: its orientation is no rotation: bring the body in sight."
        )
    if not (np.abs(p) <= _FARTHEST_M).all():
        raise IgtlError(
            f"{arg(kind)} of {arg(body)!r}: it is more than {arg(_FARTHEST_M):g} m away: check that the"
            " tracker sends mm."
        )
    return BodyPose(body, R_TB, p)
