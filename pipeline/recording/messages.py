"""Samples as JSON messages, and back."""

from __future__ import annotations

import json
import math
import re
import time
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, get_args

import numpy as np

from contactbench import __version__
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.errors import arg, message

MOST_JOINTS = 64
LONGEST_MESSAGE = 2**21  # an event of 1 MiB: its fields are in it twice
_LONGEST_SAMPLE = 2**16  # a wrench or a pose takes less than a tenth of it
_LARGEST = 2**63 - 1  # what arrays of integers hold
_INFO_LEVEL = 2  # of foxglove.Log
_ORTHOGONAL = 1e-6

# A wrench as `wrench_message` writes it. Whatever differs, if only by a space, is read as JSON.
_COUNT = rb"(0|[1-9]\d{0,8})"
_MOMENT = rb"(-?(?:0|[1-9]\d{0,11})\.\d+)"
_FLOAT = rb"-?(?:0|[1-9]\d{0,17})(?:\.\d+(?:[eE][-+]?\d+)?|[eE][-+]?\d+)"
_XYZ = rb'{"x":%b,"y":%b,"z":%b}' % (3 * (rb"(?:(" + _FLOAT + rb")|null)",))
_PLAIN_WRENCH = re.compile(
    rb'{"timestamp":{"sec":(?:0|[1-9]\d{0,17}),"nsec":(?:0|[1-9]\d{0,8})},"frame_id":"sensor","time":%b,'
    % _MOMENT
    + rb'"force":%b,"torque":%b,"status":%b' % (_XYZ, _XYZ, _COUNT)
    + rb'(?:,"sequence":(0|[1-9]\d{0,17}))?(?:,"device_time":(%b))?(?:,"temperature":(%b))?(?:,"arrival":%b)?}'
    % (_FLOAT, _FLOAT, _MOMENT)
)

_encode = json.JSONEncoder(allow_nan=False, separators=(",", ":"), ensure_ascii=False).encode
_decode = json.JSONDecoder().decode


WrenchCells = tuple[bytes | None, ...]


class MessageError(ValueError):
    """A sample that cannot be stored, or a message that is none."""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened during a recording."""

    time: float  # as for a sample, s
    name: str
    fields: Mapping[str, Any] = field(default_factory=dict)  # what goes with it; as JSON has it


# ---- writing -----------------------------------------------------------------------------------


def wrench_message(sample: WrenchSample, stamp_ns: int) -> bytes:
    """
    Return a wrench as JSON.

    Raises
    ------
    MessageError
        Its sequence number or status cannot be stored.
    """
    # A bag has millions of them: written so, they take a third of the time that a JSON encoder takes.
    seconds, rest = divmod(stamp_ns, 10**9)
    more = "" if sample.sequence is None else f',"sequence":{_whole(int(sample.sequence))}'
    for name in ("device_time", "temperature", "arrival"):
        value = getattr(sample, name)
        if value is not None and math.isfinite(value):
            more += f',"{name}":{float(value)!r}'
    F, M = (
        ",".join(
            f'"{axis}":{x!r}' if math.isfinite(x) else f'"{axis}":null'
            for axis, x in zip("xyz", map(float, vector), strict=True)
        )
        for vector in (sample.force, sample.torque)
    )
    text = (
        f'{{"timestamp":{{"sec":{seconds},"nsec":{rest}}},"frame_id":"sensor","time":{float(sample.time)!r},'
        f'"force":{{{F}}},"torque":{{{M}}},"status":{_whole(int(sample.status))}{more}}}'
    )
    return text.encode()


def flange_message(sample: FlangeSample, stamp_ns: int) -> bytes:
    """
    Return a pose as JSON.

    Raises
    ------
    MessageError
        It is no pose.
    """
    R_BE, p = np.asarray(sample.R_BE, dtype=np.float64), np.asarray(sample.p_BE_B, dtype=np.float64)
    if p.shape != (3,):
        raise MessageError(message("the position of the flange needs three numbers"))
    if R_BE.shape != (3, 3):
        raise MessageError(message("the orientation of the flange is no rotation"))
    _check_rotation(R := R_BE.ravel().tolist())
    body: dict[str, Any] = {
        "timestamp": _stamp(stamp_ns),
        "parent_frame_id": "base",
        "child_frame_id": "flange",
        "translation": _named("xyz", p.tolist()),
        "rotation": _named("xyzw", _quaternion(R)),
        "time": float(sample.time),
        "R": R,
    }
    if sample.joints is not None:
        joints = np.asarray(sample.joints, dtype=np.float64)
        if joints.ndim != 1 or len(joints) > MOST_JOINTS:
            raise MessageError(message(f"joints need a list of at most {arg(MOST_JOINTS)} angles"))
        body["joints"] = [_or_null(angle) for angle in joints.tolist()]
    _optional(body, device_time=sample.device_time, arrival=sample.arrival)
    return _encode(body).encode()


def event_message(event: Event, stamp_ns: int) -> bytes:
    """
    Return an event as JSON.

    Raises
    ------
    MessageError
        Its fields cannot be written as JSON.
    """
    try:
        fields = _encode(dict(event.fields))
        body = {
            "timestamp": _stamp(stamp_ns),
            "level": _INFO_LEVEL,
            "message": f"{event.name} {fields}" if event.fields else event.name,
            "name": "contactbench",
            "file": "",
            "line": 0,
            "time": float(event.time),
            "event": event.name,
            "fields": event.fields,
        }
        return _encode(body).encode()
    except (TypeError, ValueError, RecursionError) as error:
        raise MessageError(
            message(f"the fields of the event {arg(event.name)!r} cannot be stored ({arg(error)})")
        ) from error


def _stamp(nanoseconds: int) -> dict[str, int]:
    seconds, rest = divmod(nanoseconds, 10**9)
    return {"sec": seconds, "nsec": rest}


def _or_null(value: float) -> float | None:
    # JSON has neither NaN nor infinity; both mean that there is no number.
    number = float(value)
    return number if math.isfinite(number) else None


def _named(names: str, values: Any) -> dict[str, float | None]:
    return {name: _or_null(value) for name, value in zip(names, values, strict=True)}


def _optional(body: dict[str, Any], **values: float | None) -> None:
    for name, value in values.items():
        if value is not None and math.isfinite(value):
            body[name] = float(value)


def _whole(value: int) -> int:
    if not 0 <= value <= _LARGEST:
        raise MessageError(message(f"{arg(value)} is no count"))
    return value


def _check_rotation(R: list[float]) -> None:
    # Poses come by the hundred thousand, and NumPy takes several times as long for nine numbers. Written so that NaN
    # fails, too.
    a, b, c, d, e, f, g, h, i = R
    lengths = (a * a + d * d + g * g - 1, b * b + e * e + h * h - 1, c * c + f * f + i * i - 1)
    angles = (a * b + d * e + g * h, a * c + d * f + g * i, b * c + e * f + h * i)
    if not all(abs(off) < _ORTHOGONAL for off in (*lengths, *angles)):
        raise MessageError(message("the orientation of the flange is no rotation"))
    if a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g) < 0:  # all but 1 or -1
        raise MessageError(message("the orientation of the flange is a reflection"))


def _quaternion(R: list[float]) -> list[float]:
    """Return x, y, z, w with w >= 0 by Shepperd's method: divided by the largest of the four."""
    xx, xy, xz, yx, yy, yz, zx, zy, zz = R
    products = (
        (1 + xx - yy - zz, xy + yx, xz + zx, zy - yz),
        (xy + yx, 1 - xx + yy - zz, yz + zy, xz - zx),
        (xz + zx, yz + zy, 1 - xx - yy + zz, yx - xy),
        (zy - yz, xz - zx, yx - xy, 1 + xx + yy + zz),
    )
    row = products[max(range(4), key=lambda index: products[index][index])]
    size = math.copysign(math.hypot(*row), row[3])
    return [value / size for value in row]


# ---- reading -----------------------------------------------------------------------------------


def read_wrench(data: bytes) -> WrenchSample:
    """
    Return the wrench of a message.

    Raises
    ------
    MessageError
        It is none.
    """
    body = _body(data)
    return WrenchSample(
        _time(body),
        _triple(body.get("force")),
        _triple(body.get("torque")),
        _count(body["sequence"]) if "sequence" in body else None,
        Status(_count(body.get("status"), 2**31)),
        _given(body, "device_time"),
        _given(body, "temperature"),
        _time(body, "arrival") if "arrival" in body else None,
    )


def wrench_cells(data: bytes) -> WrenchCells | None:
    """
    Return the numbers of a wrench as they stand in a message: to be read together with those of others.

    Returns
    -------
    tuple of bytes or None
        t, Fx Fy Fz Mx My Mz, status, sequence, device time, temperature and arrival; None: it has no such number. None
        for all: the message is not written as contactbench writes it.
    """
    found = _PLAIN_WRENCH.fullmatch(data) if len(data) <= _LONGEST_SAMPLE else None
    return None if found is None else found.groups()


def cells_of(sample: WrenchSample) -> WrenchCells:
    """Return the numbers of a wrench as text, see `wrench_cells`: for one whose message was not written so."""

    def cell(value: float | None) -> bytes | None:
        return None if value is None else repr(float(value)).encode()

    return (
        *map(cell, (sample.time, *sample.force, *sample.torque)),
        b"%d" % sample.status,
        None if sample.sequence is None else b"%d" % sample.sequence,
        *map(cell, (sample.device_time, sample.temperature, sample.arrival)),
    )


def read_flange(data: bytes) -> FlangeSample:
    """
    Return the pose of a message.

    Raises
    ------
    MessageError
        It is none.
    """
    body = _body(data)
    _check_rotation(R := _numbers(body.get("R"), 9))
    joints = None
    if "joints" in body:
        listed = body["joints"]
        if not isinstance(listed, list) or len(listed) > MOST_JOINTS:
            raise MessageError(message("joints are no list of angles"))
        joints = np.array(_numbers(listed, len(listed)))
    return FlangeSample(
        _time(body),
        np.array(R).reshape(3, 3),
        np.array(_triple(body.get("translation"))),
        joints,
        _given(body, "device_time"),
        _time(body, "arrival") if "arrival" in body else None,
    )


def read_event(data: bytes) -> Event:
    """
    Return the event of a message.

    Raises
    ------
    MessageError
        It is none.
    """
    body = _body(data, LONGEST_MESSAGE)
    name, fields = body.get("event"), body.get("fields")
    if not isinstance(name, str) or not isinstance(fields, dict):
        raise MessageError(message("no event"))
    # JSON can spell half a character, which no file or terminal takes.
    return Event(_time(body), name.encode("utf-8", "replace").decode(), fields)


def event_room(data: bytes) -> int:
    """
    Return about how many bytes the event of a message takes in memory, at most.

    A list in a list takes 64 bytes where its text takes 3, and packed text next to none.
    """
    return len(data) + 64 * sum(data.count(mark) for mark in (b"[", b"{", b","))


def _body(data: bytes, longest: int = _LONGEST_SAMPLE) -> dict[str, Any]:
    if len(data) > longest:  # before it is parsed: that takes twenty times as much
        raise MessageError(f"{len(data):,} bytes")
    try:
        body = _decode(data.decode())
    except (ValueError, RecursionError) as error:
        raise MessageError(message(f"no JSON ({arg(error)})")) from error
    if not isinstance(body, dict):
        raise MessageError(message("no JSON object"))
    return body


def _number(value: Any) -> float:
    if type(value) is float:  # nearly always, and there are millions
        return value
    if value is None:
        return math.nan
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise MessageError(message("text where a number belongs"))
    try:
        return float(value)
    except OverflowError:
        raise MessageError(message("a number that is too large")) from None


def _time(body: dict[str, Any], name: str = "time") -> float:
    time = _number(body.get(name))
    if not abs(time) <= LATEST:
        raise MessageError(f"no {name}")
    return time


def _given(body: dict[str, Any], name: str) -> float | None:
    return _number(body[name]) if name in body else None


def _triple(value: Any) -> tuple[float, float, float]:
    if not isinstance(value, dict):
        raise MessageError("no x, y, z")
    return _number(value.get("x")), _number(value.get("y")), _number(value.get("z"))


def _numbers(value: Any, count: int) -> list[float]:
    if not isinstance(value, list) or len(value) != count:
        raise MessageError(message(f"no list of {arg(count)} numbers"))
    return [_number(item) for item in value]


def _count(value: Any, largest: int = _LARGEST) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= largest:
        raise MessageError(message("no count"))
    return value


# ---- what a recording says about itself: its clock, the devices, who wrote it --------------------


WRENCH_TOPIC, FLANGE_TOPIC, EVENT_TOPIC = "/wrench", "/flange", "/events"

ABOUT_RECORD = "contactbench.recording"
DEVICE_RECORD = "contactbench.device"
FORMAT = 2
ARRIVALS_ONLY = 1  # until this one, `time` of a device was the arrival

_CENTURIES = 1e10  # s; what 64 bits of nanoseconds hold
LATEST = 1e15  # s; on any clock: differences and sums of such times stay finite

DeviceKind = Literal["wrench", "flange"]


@dataclass(frozen=True, slots=True)
class DeviceInfo:
    """Where a topic's samples come from."""

    kind: DeviceKind
    topic: str  # where its samples are in the recording
    address: str  # as it was opened, an URL
    # model, serial: empty where unknown
    model: str = ""
    serial: str = ""
    rate: float | None = None  # nominal, Hz


@dataclass(frozen=True, slots=True)
class RecordingInfo:
    """What a recording says about itself."""

    started_ns: int  # Unix time of the start, ns
    clock: float  # the samples' clock at that moment, s: it ties their times to the calendar
    devices: tuple[DeviceInfo, ...] = ()
    tool: str = f"contactbench {__version__}"  # who wrote it
    note: str = ""

    @classmethod
    def now(cls, devices: Iterable[DeviceInfo] = (), note: str = "") -> RecordingInfo:
        """Return the description of a recording that starts now, on the host's monotonic clock."""
        return cls(time.time_ns(), time.monotonic(), tuple(devices), note=note)

    def topics(self, kind: DeviceKind) -> tuple[str, ...]:
        """Return the topics of one kind of samples; the usual one where no device names another."""
        named = tuple(dict.fromkeys(device.topic for device in self.devices if device.kind == kind))
        return named or ((WRENCH_TOPIC,) if kind == "wrench" else (FLANGE_TOPIC,))

    def log_time(self, moment: float) -> int:
        """
        Return the Unix time of a moment of the samples' clock, ns.

        Raises
        ------
        ValueError
            It is before 1970 or after 2200, or not a time.
        """
        since = moment - self.clock
        near = abs(since) < _CENTURIES and abs(moment) <= LATEST
        nanoseconds = self.started_ns + round(since * 1e9) if near else -1
        if not 0 <= nanoseconds < 2**63:
            raise ValueError(
                message(f"{arg(moment)} s on the samples' clock is no time near the start of the recording")
            )
        return nanoseconds


def about_record(info: RecordingInfo) -> dict[str, str]:
    """Return the metadata record that describes a recording."""
    return {
        "format": str(FORMAT),
        "tool": info.tool,
        "started_ns": str(info.started_ns),
        "clock": repr(float(info.clock)),
        "note": info.note,
    }


def device_record(device: DeviceInfo) -> dict[str, str]:
    """Return the metadata record that describes a device."""
    return asdict(device) | {"rate": "" if device.rate is None else repr(float(device.rate))}


def read_about(values: Mapping[str, str]) -> RecordingInfo:
    """
    Return what a metadata record says.

    Raises
    ------
    KeyError, ValueError
        It is damaged.
    """
    started, clock = int(values["started_ns"]), float(values["clock"])
    if not 0 <= started < 2**63 or not abs(clock) <= LATEST:
        raise ValueError(message("the start is no time"))
    return RecordingInfo(started, clock, (), values["tool"], values["note"])


def read_device(values: Mapping[str, str]) -> DeviceInfo:
    """
    Return what a metadata record says.

    Raises
    ------
    KeyError, ValueError
        It is damaged.
    """
    kinds: dict[str, DeviceKind] = {known: known for known in get_args(DeviceKind)}
    if values["kind"] not in kinds:
        raise ValueError(message(f"no kind of device: {arg(values['kind'])!r}"))
    rate = float(values["rate"]) if values["rate"] else None
    if rate is not None and not 0 < rate < math.inf:
        raise ValueError(message(f"no rate: {arg(rate)}"))
    return DeviceInfo(
        kinds[values["kind"]], values["topic"], values["address"], values["model"], values["serial"], rate
    )
