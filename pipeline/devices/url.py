"""Where samples come from, as a URL: ``sri+serial:///dev/ttyUSB0?baud=115200``, ``replay:///a.mcap?speed=4``."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qsl, quote, unquote, urlencode, urlsplit

from contactbench.pipeline.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from urllib.parse import SplitResult

    from contactbench.pipeline.reality import Reality


class AddressError(InputError):
    """An address that names no device; the message names the part and the remedy."""


class Protocol(StrEnum):
    """What a device speaks, or what stands in for one."""

    SRI = "sri"
    BOTA = "bota"
    ROBOTIQ = "robotiq"
    RDT = "rdt"
    ELFIN = "elfin"
    UR = "ur"
    REPLAY = "replay"
    STILL = "still"
    POSES = "poses"
    VIRTUAL = "virtual"


class Carrier(StrEnum):
    """What carries the bytes."""

    SERIAL = "serial"
    TCP = "tcp"
    UDP = "udp"
    FILE = "file"
    TYPED = "typed"
    SIMULATED = "simulated"


_SOCKETS = (Carrier.TCP, Carrier.UDP)
_BARE = (Carrier.FILE, Carrier.TYPED, Carrier.SIMULATED)  # their scheme names no carrier
# Counts per N and per N·m. An ATI box may have others: its own configuration page says.
PROFILES = {"ati": (1e6, 1e6), "onrobot": (1e4, 1e5)}
STEPWISE = 0.0
_BITS_PER_BYTE = 10  # 8N1
_UNIT = 0.02  # a quaternion written with two digits is this far from unit length
_MOST_DEGREES, _MOST_TOOL = 3600.0, 10.0  # m or rad
_FASTEST_HZ = 1000.0  # of what has no hardware


# ---- options: how each is read. A reader raises ValueError that says what to give instead -------


def _number(unit: str) -> Callable[[str], float]:
    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not 1e-3 <= value <= 1e9:
            raise ValueError(f"give a positive number of {unit}")
        return value

    return read


def _numbers(fewest: int, most: int, largest: float) -> Callable[[str], tuple[float, ...]]:
    def read(text: str) -> tuple[float, ...]:
        try:
            values = tuple(map(float, text.split(",")[: most + 1]))
        except ValueError:
            values = ()
        if not fewest <= len(values) <= most or not all(abs(value) <= largest for value in values):
            many = str(fewest) if fewest == most else f"{fewest} to {most}"
            raise ValueError(f"give {many} numbers separated by commas, none beyond {largest:g}")
        return values

    return read


def _whole(fewest: int, most: int, remedy: str) -> Callable[[str], int]:
    def read(text: str) -> int:
        # isdigit alone lets superscripts through.
        if not (text.isascii() and text.isdigit() and len(text) <= 15 and fewest <= int(text) <= most):
            raise ValueError(remedy)
        return int(text)

    return read


def _name(text: str) -> str:
    if not text.strip() or not text.isprintable():
        raise ValueError("give its name, or leave the option out")
    return text


def _profile(text: str) -> str:
    if text not in PROFILES:
        raise ValueError(f"choose one of {', '.join(PROFILES)}")
    return text


def _reality(text: str) -> Reality:
    from contactbench.pipeline.reality import Reality  # only a bench needs it

    try:
        return Reality.parse(text)
    except InputError as error:
        raise ValueError(str(error).removeprefix("reality: ").rstrip(".")) from None


def _step(text: str) -> float:
    if text != "step":
        raise ValueError("give step, or leave the option out for real time")
    return STEPWISE


def _pace(text: str) -> float:
    return STEPWISE if text == "step" else _number("multiple of the recorded pace, or step")(text)


# Option -> the field that it is, and its reader; in the order in which they are written.
_OPTIONS: dict[str, tuple[str, Callable[[str], Any]]] = {
    "baud": ("baud", _whole(50, 12_000_000, "give a whole number of bit/s such as 115200")),
    "profile": ("profile", _profile),
    "rate": ("rate", _number("Hz")),
    "cpf": ("counts_per_newton", _number("counts per N")),
    "cpt": ("counts_per_newton_metre", _number("counts per N·m")),
    "speed": ("speed", _pace),
    "topic": ("topic", _name),
    "rpy": ("rpy_degrees", _numbers(3, 3, _MOST_DEGREES)),
    "quaternion": ("quaternion", _numbers(4, 4, 1 + _UNIT)),
    "joints": ("joints_degrees", _numbers(1, 64, _MOST_DEGREES)),
    "robot": ("robot", _name),
    "tool": ("tool", _numbers(6, 6, _MOST_TOOL)),
}
_BENCH: dict[str, Callable[[str], Any]] = {
    "probe": _name,
    "mesh": _name,
    "sensor": _name,
    "seed": _whole(0, 10**15, "give a whole number of 0 or more"),
    "pose_rate": _number("Hz"),
    "script": _name,
    "reality": _reality,
}
_SPEEDS: dict[Protocol, Callable[[str], float]] = {
    Protocol.VIRTUAL: _step,
    Protocol.POSES: _number("multiple of the pace of the file"),
}


@dataclass(frozen=True)
class _Kind:
    """What one scheme gives and allows."""

    wrenches: bool = False
    poses: bool = False
    port: int | None = None
    frame: int = 0
    options: Mapping[str, Any] = field(default_factory=dict)  # with their defaults; None: none


_KINDS = {
    (Protocol.SRI, Carrier.SERIAL): _Kind(wrenches=True, frame=31, options={"baud": 115_200, "rate": 200.0}),
    (Protocol.SRI, Carrier.TCP): _Kind(wrenches=True, port=4008, options={"rate": 200.0}),
    (Protocol.BOTA, Carrier.SERIAL): _Kind(wrenches=True, frame=37, options={"baud": 460_800, "rate": 200.0}),
    (Protocol.ROBOTIQ, Carrier.SERIAL): _Kind(
        wrenches=True, frame=16, options={"baud": 19_200, "rate": 100.0}
    ),
    (Protocol.RDT, Carrier.UDP): _Kind(
        wrenches=True, port=49_152, options={"profile": "ati", "rate": None, "cpf": None, "cpt": None}
    ),
    (Protocol.ELFIN, Carrier.TCP): _Kind(poses=True, port=10_003, options={"rate": 50.0}),
    (Protocol.UR, Carrier.TCP): _Kind(poses=True, port=30_004, options={"rate": 125.0, "tool": None}),
    (Protocol.REPLAY, Carrier.FILE): _Kind(wrenches=True, poses=True, options={"speed": 1.0, "topic": None}),
    (Protocol.POSES, Carrier.FILE): _Kind(poses=True, options={"speed": 1.0, "robot": None}),
    (Protocol.STILL, Carrier.TYPED): _Kind(
        poses=True, options={"rate": 10.0, "rpy": None, "quaternion": None, "joints": None, "robot": None}
    ),
    (Protocol.VIRTUAL, Carrier.SIMULATED): _Kind(
        wrenches=True, poses=True, options={"rate": 200.0, "speed": None, **dict.fromkeys(_BENCH)}
    ),
}


@dataclass(frozen=True)
class BenchOptions:
    """What a virtual bench is made of; names are looked up by who opens it."""

    probe: str = "t-shape"  # name of a bundled probe
    mesh: str | None = None  # file of a probe to take instead, in metres and S
    sensor: str = "paper"  # name of a preset
    seed: int = 0  # of the noise
    pose_rate: float = 50.0  # poses a second
    script: str | None = None  # file of timed commands
    reality: Reality | None = None  # what it adds to the ideal bench; None: nothing


@dataclass(frozen=True)
class DeviceAddress:
    """One device."""

    protocol: Protocol
    carrier: Carrier
    host: str = ""  # name or IP address; empty where there is no socket
    port: int | None = None  # TCP or UDP port; None where there is no socket
    path: str = ""  # serial device, recording or file of poses; empty for sockets and typed poses
    baud: int | None = None  # of a serial line, bit/s
    rate: float | None = None  # samples per second to ask the device for; None: what the device is set to
    profile: str | None = None  # of RDT: "ati" or "onrobot"
    # counts_per_newton, counts_per_newton_metre: of RDT: the profile's, unless the address gives others
    counts_per_newton: float | None = None
    counts_per_newton_metre: float | None = None
    # of a replay: times the recorded pace; `STEPWISE` (0) gives a sample whenever it is asked for one.
    # Of a file of poses: times the pace of its time stamps. Of a virtual bench: `STEPWISE`, or None for
    # real time.
    speed: float | None = None
    topic: str | None = None  # of a replay that holds several devices of a kind: which one
    # of a typed pose: turns about the fixed x, then y, then z axis. As it was typed, like all that
    # follows: an address reads back to the last digit.
    rpy_degrees: tuple[float, ...] | None = None
    quaternion: tuple[float, ...] | None = None  # of a typed pose: scalar first, of unit length within 2 %
    joints_degrees: tuple[float, ...] | None = None  # of a typed pose: joint angles of `robot`
    # whose joints an address or a file of poses gives, as in contactbench.pipeline.robot
    robot: str | None = None
    # of a UR robot: the tool of its pendant as it is typed there, x, y, z in m and a rotation vector in
    # rad
    tool: tuple[float, ...] | None = None
    bench: BenchOptions | None = None  # what a virtual bench is made of

    @classmethod
    def parse(cls, text: str) -> DeviceAddress:
        """Read an address and fill in the protocol's defaults.

        Raises
        ------
        AddressError
            A part is missing, unknown or impossible.

        Examples
        --------
        >>> DeviceAddress.parse("sri+tcp://192.168.0.108").port
        4008
        """
        try:
            return cls._parsed(text)
        except ValueError as error:
            raise AddressError(f"address {text!r}: {error}.") from error

    @classmethod
    def _parsed(cls, text: str) -> DeviceAddress:
        parts = _split(text)
        protocol, carrier = _scheme(parts.scheme)
        kind = _KINDS[protocol, carrier]
        given = _given(parts.query, protocol, tuple(kind.options))
        host, port, path = _place(parts, carrier, kind)
        values = {name: value for name, value in {**kind.options, **given}.items() if name in _OPTIONS}
        if values.get("profile") == "onrobot":  # an ATI sensor has counts of its own, and tells them
            usual = zip(("cpf", "cpt"), PROFILES["onrobot"], strict=True)
            values |= {name: scale if values[name] is None else values[name] for name, scale in usual}
        bench = None
        if protocol is Protocol.VIRTUAL:
            bench = BenchOptions(**{name: value for name, value in given.items() if name in _BENCH})
        address = cls(
            protocol, carrier, host, port, path, bench=bench,
            **{_OPTIONS[name][0]: value for name, value in values.items()},
        )  # fmt: skip
        _check_ceiling(address, kind)
        if protocol is Protocol.STILL:
            _check_typed(address)
        if protocol is Protocol.VIRTUAL:
            _check_bench(given)
        return address

    def __str__(self) -> str:
        """Return the address with every default written out; `parse` reads it back."""
        if self.carrier in _SOCKETS:
            host = f"[{self.host.replace('%', '%25')}]" if ":" in self.host else self.host
            where = f"{host}:{self.port}"
        elif self.carrier in (Carrier.TYPED, Carrier.SIMULATED):
            where = self.host
        else:
            where = quote(self.path if self.path.startswith("/") else f"/{self.path}")
        values = {name: getattr(self, own) for name, (own, _) in _OPTIONS.items()}
        if self.speed == STEPWISE:
            values["speed"] = "step"
        if self.bench is not None:
            values |= {name: getattr(self.bench, name) for name in _BENCH}
            if self.bench.mesh is not None:
                values["probe"] = None
        given = {name: _short(value) for name, value in values.items() if value is not None}
        query = urlencode(given, safe=",/")
        return f"{_scheme_name(self.protocol, self.carrier)}://{where}" + (f"?{query}" if query else "")

    @property
    def gives_wrenches(self) -> bool:
        """Whether it can be opened as a force/torque sensor."""
        return _KINDS[self.protocol, self.carrier].wrenches

    @property
    def gives_poses(self) -> bool:
        """Whether it can be opened as a source of poses."""
        return _KINDS[self.protocol, self.carrier].poses


def carriers_of(protocol: Protocol) -> tuple[Carrier, ...]:
    """Return what can carry a protocol, the usual one first."""
    return tuple(carrier for known, carrier in _KINDS if known is protocol)


def _short(value: object) -> str:
    if isinstance(value, tuple):
        return ",".join(map(_short, value))
    return str(int(value)) if isinstance(value, float) and value.is_integer() else str(value)


# ---- the parts of an address: each raises ValueError that says what is wrong, and the remedy -----


def _split(text: str) -> SplitResult:
    # urlsplit drops tabs and line ends without a word, so they are looked for first.
    if any(not character.isprintable() for character in text):
        raise ValueError("it contains a control character: type it again")
    try:
        parts = urlsplit(text)
    except ValueError as error:
        raise ValueError(f"host: {error}: write an IPv6 address as [::1]") from error
    if parts.fragment or text.endswith("#"):
        raise ValueError("'#': write it as %23 if it belongs to the path")
    return parts


def _scheme(scheme: str) -> tuple[Protocol, Carrier]:
    for protocol, carrier in _KINDS:
        if scheme == _scheme_name(protocol, carrier):
            return protocol, carrier
    known = ", ".join(_scheme_name(*kind) for kind in _KINDS)
    raise ValueError(f"scheme {scheme or 'missing'}: start it with one of {known}, then ://")


def _scheme_name(protocol: Protocol, carrier: Carrier) -> str:
    return protocol.value if carrier in _BARE else f"{protocol}+{carrier}"


def _given(query: str, protocol: Protocol, known: tuple[str, ...]) -> dict[str, Any]:
    """Return the options of a query, each of which must be known."""
    found: dict[str, str] = {}
    try:
        pairs = parse_qsl(query, keep_blank_values=True, strict_parsing=bool(query), errors="strict")
    except ValueError as error:
        raise ValueError(f"options: {error}: write them as ?name=value&name=value") from error
    for name, value in pairs:
        if name not in known:
            raise ValueError(f"unknown option {name!r}. Possible: {', '.join(known)}")
        if name in found:
            raise ValueError(f"option {name!r} appears twice: keep one")
        found[name] = value
    return {name: _read(name, value, protocol) for name, value in found.items()}


def _read(name: str, value: str, protocol: Protocol) -> Any:
    read = _BENCH[name] if name in _BENCH else _OPTIONS[name][1]
    if name == "speed":
        read = _SPEEDS.get(protocol, read)
    try:
        return read(value)
    except ValueError as error:
        raise ValueError(f"{name} {value[:80]!r}: {error}") from error


def _place(parts: SplitResult, carrier: Carrier, kind: _Kind) -> tuple[str, int | None, str]:
    """Return host, port and path."""
    if carrier in _SOCKETS:
        return *_socket(parts, kind.port), ""
    if carrier in (Carrier.TYPED, Carrier.SIMULATED):
        host, what, begin = (
            ("", "a typed pose has no host or path", f"{parts.scheme}://?")
            if carrier is Carrier.TYPED
            else ("bench", "the virtual bench has no host or path", "virtual://bench")
        )
        if parts.netloc != host or parts.path not in ("", "/"):
            raise ValueError(f"{parts.netloc + parts.path!r}: {what}: begin with {begin}")
        return host, None, ""
    return "", None, _path(parts, serial=carrier is Carrier.SERIAL)


def _socket(parts: SplitResult, usual: int | None) -> tuple[str, int]:
    """Return host and port; `usual` is the port where none is given."""
    if "@" in parts.netloc:
        raise ValueError("user name: devices do not use one: leave out the part before the @")
    host = _zoned(parts.hostname or "")
    if not host or any(character in host.split("%")[0] for character in " %\\"):
        raise ValueError("host: give a name or an IP address after ://")
    if parts.path not in ("", "/"):
        raise ValueError(f"path {parts.path!r}: a socket has no path: leave it out")
    try:
        port = parts.port
    except ValueError:
        port = -1
    port = usual if port is None else port
    if port is None or not 1 <= port <= 65_535:
        raise ValueError(f"port: give a whole number from 1 to 65535, or none for {usual}")
    return host, port


def _zoned(host: str) -> str:
    """Return a host with its IPv6 zone, which a URL writes as %25eth0 and a person as %eth0, written as %eth0."""
    address, percent, zone = host.partition("%")
    zone = zone.removeprefix("25")
    # Only an IPv6 address has one, and it names an interface of this machine.
    if percent and ":" in address and zone and all(c.isalnum() or c in "-_.~" for c in zone):
        return f"{address}%{zone}"
    return "" if percent else host


def _path(parts: SplitResult, *, serial: bool) -> str:
    """Return the path of a serial port or a file."""
    path = unquote(parts.path, errors="surrogateescape")
    if serial and parts.netloc and path in ("", "/"):
        return parts.netloc  # COM3 as in sri+serial://COM3
    if parts.netloc:
        raise ValueError(f"host {parts.netloc!r}: a path needs three slashes: :///path")
    # A path of Windows has no leading slash of its own: /COM3, /C:/folder.
    drive = path[1:]
    if (drive.upper().startswith("COM") and drive[3:].isdigit()) or drive[1:3] in (":/", ":\\"):
        path = drive
    if path in ("", "/") or "\0" in path:
        file = "poses.csv" if parts.scheme == "poses" else "recording.mcap"
        what, example = ("serial port", "/dev/ttyUSB0") if serial else ("file", f"/folder/{file}")
        raise ValueError(f"path: give the {what} after three slashes: ://{example}")
    return path


# ---- options that must fit each other -----------------------------------------------------------


def _check_bench(given: Mapping[str, Any]) -> None:
    if "probe" in given and "mesh" in given:
        raise ValueError("probe and mesh: give only one of them")
    for name in ("rate", "pose_rate"):
        if given.get(name, 0.0) > _FASTEST_HZ:
            raise ValueError(f"{name}: the bench provides at most {_FASTEST_HZ:g} Hz")


def _check_typed(address: DeviceAddress) -> None:
    ways = (address.rpy_degrees, address.quaternion, address.joints_degrees)
    if sum(way is not None for way in ways) != 1:
        raise ValueError(
            "pose: give one of rpy=0,90,0 (degrees about the fixed x, y, z axes),"
            " quaternion=w,x,y,z or robot=elfin3&joints=... (degrees)"
        )
    if (address.rate or 0) > _FASTEST_HZ:
        raise ValueError(f"rate: a fixed pose needs at most {_FASTEST_HZ:g} Hz")
    if (address.joints_degrees is None) != (address.robot is None):
        raise ValueError("robot: joints need their robot, and nothing else does")
    if address.quaternion is not None and not abs(math.hypot(*address.quaternion) - 1) <= _UNIT:
        raise ValueError("quaternion: its length is not 1: check its four numbers w,x,y,z")


def _check_ceiling(address: DeviceAddress, kind: _Kind) -> None:
    if not (address.baud and address.rate and kind.frame):
        return
    ceiling = address.baud / (_BITS_PER_BYTE * kind.frame)
    if address.rate > ceiling:
        raise ValueError(
            f"rate: {address.rate:g} samples/s are too many for {address.baud} bit/s: choose at"
            f" most {math.floor(ceiling)}, or a faster line if the device is set to one"
        )
