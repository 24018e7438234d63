"""Where samples come from, as a URL: ``sri+serial:///dev/ttyUSB0?baud=115200``, ``replay:///a.mcap?speed=4``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from urllib.parse import quote, urlencode

from contactbench.pipeline.devices.url_options import (
    BENCH_OPTIONS,
    AddressError,
    BenchOptions,
    bench_options,
    name_option,
    number_option,
    numbers_option,
    read_options,
)
from contactbench.pipeline.devices.url_place import (
    bench_host,
    check_nowhere,
    path_of,
    socket_of,
    split_address,
)

__all__ = ["PROFILES", "STEPWISE", "AddressError", "BenchOptions", "Carrier", "DeviceAddress", "Protocol"]


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


@dataclass(frozen=True)
class _Kind:
    """What one scheme allows, and its defaults."""

    baud: int | None = None
    port: int | None = None
    rate: float | None = None
    frame: int = 0
    options: tuple[str, ...] = ()
    wrenches: bool = False
    poses: bool = False


_KINDS = {
    (Protocol.SRI, Carrier.SERIAL): _Kind(
        wrenches=True, baud=115_200, rate=200.0, frame=31, options=("baud", "rate")
    ),
    (Protocol.SRI, Carrier.TCP): _Kind(wrenches=True, port=4008, rate=200.0, options=("rate",)),
    (Protocol.BOTA, Carrier.SERIAL): _Kind(
        wrenches=True, baud=460_800, rate=200.0, frame=37, options=("baud", "rate")
    ),
    (Protocol.ROBOTIQ, Carrier.SERIAL): _Kind(
        wrenches=True, baud=19_200, rate=100.0, frame=16, options=("baud",)
    ),
    (Protocol.RDT, Carrier.UDP): _Kind(wrenches=True, port=49_152, options=("profile", "rate", "cpf", "cpt")),
    (Protocol.ELFIN, Carrier.TCP): _Kind(poses=True, port=10_003, rate=50.0, options=("rate",)),
    (Protocol.UR, Carrier.TCP): _Kind(poses=True, port=30_004, rate=125.0, options=("rate", "tool")),
    (Protocol.REPLAY, Carrier.FILE): _Kind(wrenches=True, poses=True, options=("speed", "topic")),
    (Protocol.POSES, Carrier.FILE): _Kind(poses=True, options=("speed", "robot")),
    (Protocol.STILL, Carrier.TYPED): _Kind(
        poses=True, rate=10.0, options=("rate", "rpy", "quaternion", "joints", "robot")
    ),
    (Protocol.VIRTUAL, Carrier.SIMULATED): _Kind(
        wrenches=True, poses=True, rate=200.0, options=BENCH_OPTIONS
    ),
}
_SOCKETS = (Carrier.TCP, Carrier.UDP)
_BARE = (Carrier.FILE, Carrier.TYPED, Carrier.SIMULATED)  # their scheme names no carrier
# Counts per N and per N·m. An ATI box may have others: its own configuration page says.
PROFILES = {"ati": (1e6, 1e6), "onrobot": (1e4, 1e5)}
STEPWISE = 0.0
_BITS_PER_BYTE = 10  # 8N1
_UNIT = 0.02  # a quaternion written with two digits is this far from unit length
_MOST_JOINTS = 64
_MOST_DEGREES = 3600.0
_MOST_TOOL = 10.0  # m or rad
_FASTEST_STILL_HZ = 1000.0


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
        parts = split_address(text)
        protocol, carrier = _scheme(parts.scheme, text)
        kind = _KINDS[protocol, carrier]
        options = read_options(parts.query, kind.options, text)
        host, port, path = "", None, ""
        if carrier in _SOCKETS:
            host, port = socket_of(parts, kind.port, text)
        elif carrier is Carrier.TYPED:
            check_nowhere(parts, text)
        elif carrier is Carrier.SIMULATED:
            host = bench_host(parts, text)
        else:
            path = path_of(parts, text, serial=carrier is Carrier.SERIAL)
        profile = _profile(options, text) if protocol is Protocol.RDT else None
        # An ATI sensor has counts of its own, and tells them.
        scale = PROFILES[profile] if profile == "onrobot" else (None, None)
        address = cls(
            protocol=protocol,
            carrier=carrier,
            host=host,
            port=port,
            path=path,
            baud=_baud(options, kind, text),
            rate=number_option(options, "rate", kind.rate, "Hz", text),
            profile=profile,
            counts_per_newton=number_option(options, "cpf", scale[0], "counts per N", text),
            counts_per_newton_metre=number_option(options, "cpt", scale[1], "counts per N·m", text),
            speed=_speed(protocol, options, text) if "speed" in kind.options else None,
            topic=name_option(options, "topic", text),
            rpy_degrees=numbers_option(options, "rpy", (3, 3), _MOST_DEGREES, text),
            quaternion=numbers_option(options, "quaternion", (4, 4), 1 + _UNIT, text),
            joints_degrees=numbers_option(options, "joints", (1, _MOST_JOINTS), _MOST_DEGREES, text),
            robot=name_option(options, "robot", text),
            tool=numbers_option(options, "tool", (6, 6), _MOST_TOOL, text),
            bench=bench_options(options, text) if protocol is Protocol.VIRTUAL else None,
        )
        _check_ceiling(address, kind, text)
        if protocol is Protocol.STILL:
            _check_typed(address, text)
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
        values = {
            "baud": self.baud,
            "profile": self.profile,
            "rate": self.rate,
            "cpf": self.counts_per_newton,
            "cpt": self.counts_per_newton_metre,
            "speed": "step" if self.speed == STEPWISE else self.speed,
            "topic": self.topic,
            "rpy": self.rpy_degrees,
            "quaternion": self.quaternion,
            "joints": self.joints_degrees,
            "robot": self.robot,
            "tool": self.tool,
            **({} if self.bench is None else self.bench.values()),
        }
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


def _scheme(scheme: str, text: str) -> tuple[Protocol, Carrier]:
    for protocol, carrier in _KINDS:
        if scheme == _scheme_name(protocol, carrier):
            return protocol, carrier
    known = ", ".join(_scheme_name(*kind) for kind in _KINDS)
    raise AddressError(
        f"address {text!r}: scheme {scheme or 'missing'}: start it with one of {known}, then ://."
    )


def _scheme_name(protocol: Protocol, carrier: Carrier) -> str:
    return protocol.value if carrier in _BARE else f"{protocol}+{carrier}"


def _profile(options: dict[str, str], text: str) -> str:
    name = options.get("profile", "ati")
    if name not in PROFILES:
        raise AddressError(f"address {text!r}: profile {name!r}: choose one of {', '.join(PROFILES)}.")
    return name


def _baud(options: dict[str, str], kind: _Kind, text: str) -> int | None:
    value = options.get("baud")
    if value is None:
        return kind.baud
    # isdigit alone lets superscripts through.
    if not (value.isascii() and value.isdigit() and len(value) <= 8 and 50 <= int(value) <= 12_000_000):
        raise AddressError(
            f"address {text!r}: baud {value!r}: give a whole number of bit/s such as {kind.baud}."
        )
    return int(value)


def _speed(protocol: Protocol, options: dict[str, str], text: str) -> float | None:
    if protocol is Protocol.VIRTUAL:
        if options.get("speed", "step") != "step":
            raise AddressError(
                f"address {text!r}: speed {options['speed']!r}: give step, or leave it out for real time."
            )
        return STEPWISE if "speed" in options else None
    if protocol is not Protocol.REPLAY:
        return number_option(options, "speed", 1.0, "times the pace of the file", text)
    if options.get("speed") == "step":
        return STEPWISE
    return number_option(options, "speed", 1.0, "times the recorded pace, or step", text)


def _check_typed(address: DeviceAddress, text: str) -> None:
    ways = (address.rpy_degrees, address.quaternion, address.joints_degrees)
    if sum(way is not None for way in ways) != 1:
        raise AddressError(
            f"address {text!r}: pose: give one of rpy=0,90,0 (degrees about the fixed x, y, z axes),"
            " quaternion=w,x,y,z or robot=elfin3&joints=... (degrees)."
        )
    if (address.rate or 0) > _FASTEST_STILL_HZ:
        raise AddressError(
            f"address {text!r}: rate: a pose that stays needs at most {_FASTEST_STILL_HZ:g} Hz."
        )
    if (address.joints_degrees is None) != (address.robot is None):
        raise AddressError(
            f"address {text!r}: robot: joints need the robot that they are of, and nothing else does."
        )
    if address.quaternion is not None and not abs(math.hypot(*address.quaternion) - 1) <= _UNIT:
        raise AddressError(
            f"address {text!r}: quaternion: its length is not 1: check its four numbers w,x,y,z."
        )


def _check_ceiling(address: DeviceAddress, kind: _Kind, text: str) -> None:
    if not (address.baud and address.rate and kind.frame):
        return
    ceiling = address.baud / (_BITS_PER_BYTE * kind.frame)
    if address.rate > ceiling:
        raise AddressError(
            f"address {text!r}: rate: {address.rate:g} samples/s do not fit through {address.baud} bit/s: ask for at"
            f" most {math.floor(ceiling)}, or a faster line if the device is set to one."
        )
