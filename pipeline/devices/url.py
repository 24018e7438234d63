"""Where samples come from, as a URL: ``sri+serial:///dev/ttyUSB0?baud=115200``, ``replay:///a.mcap?speed=4``."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from enum import StrEnum
from typing import Any
from urllib.parse import SplitResult, parse_qsl, quote, unquote, urlencode, urlsplit

from contactbench.pipeline.devices.driver import AddressError, Carrier, Driver
from contactbench.pipeline.devices.options import (
    name,
    number,
    numbers,
    read_baud,
    read_rate,
    whole,
    write_option,
)
from contactbench.pipeline.devices.protocols.registry import driver_of, drivers
from contactbench.pipeline.errors import InputError, arg, message
from contactbench.pipeline.reality import Reality


class Protocol(StrEnum):
    """What stands in for a device; devices themselves go by the schemes of their drivers."""

    REPLAY = "replay"
    STILL = "still"
    POSES = "poses"
    VIRTUAL = "virtual"


_SOCKETS = (Carrier.TCP, Carrier.UDP)
STEPWISE = 0.0
_BITS_PER_BYTE = 10  # 8N1
_UNIT = 0.02  # a quaternion written with two digits is this far from unit length
_MOST_DEGREES = 3600.0
_FASTEST_HZ = 1000.0  # of what has no hardware


def _reality(text: str) -> Reality:
    from contactbench.pipeline.reality import Reality  # only a bench needs it

    try:
        return Reality.parse(text)
    except InputError as error:
        raise ValueError(str(error).removeprefix("reality: ").rstrip(".")) from None


def _step(text: str) -> float:
    if text != "step":
        raise ValueError(message("give step, or leave the option out for real time"))
    return STEPWISE


def _pace(text: str) -> float:
    return STEPWISE if text == "step" else number(message("multiple of the recorded pace, or step"))(text)


def _option(read: Callable[[str], Any], default: Any = None, *, called: str = "") -> Any:
    """Return a field that an address has as an option, by its own name unless it is called otherwise."""
    return field(default=default, metadata={"read": read, "called": called})


_SPEEDS: dict[str, Callable[[str], float]] = {
    Protocol.VIRTUAL: _step,
    Protocol.POSES: number(message("multiple of the pace of the file")),
}


@dataclass(frozen=True)
class _Kind:
    """What one scheme allows."""

    protocol: str
    carrier: Carrier
    defaults: Mapping[str, Any]  # of its options; None: none
    driver: Driver | None = None  # None: no device
    wrenches: bool = False
    poses: bool = False

    @property
    def scheme(self) -> str:
        """How its addresses begin."""
        return self.protocol if self.driver is None else f"{self.protocol}+{self.carrier}"


def _kinds_of(driver: Driver) -> tuple[_Kind, ...]:
    own = {key: option.default for key, option in driver.options.items()}
    return tuple(
        _Kind(
            driver.scheme,
            way.carrier,
            {**({"baud": way.baud} if way.carrier is Carrier.SERIAL else {}), "rate": driver.rate, **own},
            driver,
        )
        for way in driver.ways
    )


@dataclass(frozen=True)
class BenchOptions:
    """What a virtual bench is made of; names are looked up by who opens it."""

    probe: str = _option(name, "t-shape")  # name of a bundled probe
    mesh: str | None = _option(name)  # file of a probe to take instead, in metres and S
    sensor: str = _option(name, "paper")  # name of a preset
    seed: int = _option(whole(0, 10**15, message("give a whole number of 0 or more")), 0)  # of the noise
    pose_rate: float = _option(number("Hz"), 50.0)  # poses a second
    script: str | None = _option(name)  # file of timed commands
    # what it adds to the ideal bench; None: nothing
    reality: Reality | None = _option(_reality)  # noqa: RUF009 - a field


@dataclass(frozen=True)
class DeviceAddress:
    """One device."""

    protocol: str  # scheme of its driver, or a Protocol
    carrier: Carrier
    host: str = ""  # name or IP address; empty where there is no socket
    port: int | None = None  # TCP or UDP port; None where there is no socket
    path: str = ""  # serial device, recording or file of poses; empty for sockets and typed poses
    baud: int | None = _option(read_baud)  # of a serial line, bit/s
    rate: float | None = _option(
        read_rate
    )  # samples per second to ask the device for; None: what the device is set to
    # of a replay: times the recorded pace; `STEPWISE` (0) gives a sample whenever it is asked for one.
    # Of a file of poses: times the pace of its time stamps. Of a virtual bench: `STEPWISE`, or None for
    # real time.
    speed: float | None = _option(_pace)
    topic: str | None = _option(name)  # of a replay that holds several devices of a kind: which one
    # of a typed pose: turns about the fixed x, then y, then z axis. As it was typed, like all that
    # follows: an address reads back to the last digit.
    rpy_degrees: tuple[float, ...] | None = _option(numbers(3, 3, _MOST_DEGREES), called="rpy")
    # of a typed pose: scalar first, of unit length within 2 %
    quaternion: tuple[float, ...] | None = _option(numbers(4, 4, 1 + _UNIT))
    # of a typed pose: joint angles of `robot`
    joints_degrees: tuple[float, ...] | None = _option(numbers(1, 64, _MOST_DEGREES), called="joints")
    # whose joints an address or a file of poses gives, as in contactbench.pipeline.robot
    robot: str | None = _option(name)
    options: Mapping[str, Any] = field(default_factory=dict, hash=False)  # of its driver, all of them
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
            raise AddressError(f"address {arg(text)!r}: {arg(error)}.") from error

    @classmethod
    def _parsed(cls, text: str) -> DeviceAddress:
        parts = _split(text)
        kind = _kind(parts.scheme)
        given = _given(parts.query, kind)
        host, port, path = _place(parts, kind)
        values = {**kind.defaults, **given}
        own: dict[str, Any] = {}
        if kind.driver is not None:
            with _own_failures(kind.driver):
                own = kind.driver.complete({key: values[key] for key in kind.driver.options})
        bench = None
        if kind.protocol == Protocol.VIRTUAL:
            bench = BenchOptions(**{key: value for key, value in given.items() if key in _BENCH})
        address = cls(
            kind.protocol, kind.carrier, host, port, path, options=own, bench=bench,
            **{_OPTIONS[key][0]: value for key, value in values.items() if key in _OPTIONS and key not in own},
        )  # fmt: skip
        _check_ceiling(address, kind)
        if kind.protocol == Protocol.STILL:
            _check_typed(address)
        if kind.protocol == Protocol.VIRTUAL:
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
        values = {key: getattr(self, own) for key, (own, _) in _OPTIONS.items()}
        if self.speed == STEPWISE:
            values["speed"] = "step"
        if self.bench is not None:
            values |= {key: getattr(self.bench, key) for key in _BENCH}
            if self.bench.mesh is not None:
                values["probe"] = None
        given = {key: write_option(value) for key, value in values.items() if value is not None}
        driver = self._driver
        if driver is not None:
            given |= _written(driver, self.options)
        query = urlencode(given, safe=",/:", quote_via=quote)
        scheme = self.protocol if driver is None else f"{self.protocol}+{self.carrier}"
        return f"{scheme}://{where}" + (f"?{query}" if query else "")

    @property
    def gives_wrenches(self) -> bool:
        """Whether it can be opened as a force/torque sensor."""
        driver = self._driver
        return _SOURCES[self.protocol].wrenches if driver is None else driver.gives_wrenches(self)

    @property
    def gives_poses(self) -> bool:
        """Whether it can be opened as a source of poses."""
        driver = self._driver
        return _SOURCES[self.protocol].poses if driver is None else driver.gives_poses(self)

    @property
    def _driver(self) -> Driver | None:
        return None if self.protocol in _SOURCES else driver_of(self.protocol)


# Option -> the field that it is, and its reader; in the order in which they are written.
_OPTIONS: dict[str, tuple[str, Callable[[str], Any]]] = {
    each.metadata["called"] or each.name: (each.name, each.metadata["read"])
    for each in fields(DeviceAddress)
    if "read" in each.metadata
}
_BENCH: dict[str, Callable[[str], Any]] = {each.name: each.metadata["read"] for each in fields(BenchOptions)}
_SOURCES = {
    kind.protocol: kind
    for kind in (
        _Kind(Protocol.REPLAY, Carrier.FILE, {"speed": 1.0, "topic": None}, wrenches=True, poses=True),
        _Kind(Protocol.POSES, Carrier.FILE, {"speed": 1.0, "robot": None}, poses=True),
        _Kind(
            Protocol.STILL,
            Carrier.TYPED,
            {"rate": 10.0, "rpy": None, "quaternion": None, "joints": None, "robot": None},
            poses=True,
        ),
        _Kind(
            Protocol.VIRTUAL,
            Carrier.SIMULATED,
            {"rate": 200.0, "speed": None, **dict.fromkeys(_BENCH)},
            wrenches=True,
            poses=True,
        ),
    )
}


def read_options(driver: Driver, key: str, text: str) -> Any:
    """
    Read one of a driver's own options.

    Raises
    ------
    ValueError
        There is no such option, or it cannot be that.
    """
    if key not in driver.options:
        known = ", ".join(driver.options) or "none"
        raise ValueError(message(f"unknown option {arg(key)!r}. Possible: {arg(known)}"))
    return _read(key, text, driver.options[key].read)


def options_query(driver: Driver, options: Mapping[str, Any]) -> str:
    """Return a driver's own options as the end of an address; empty: there are none."""
    query = urlencode(_written(driver, options), safe=",/:", quote_via=quote)
    return f"?{query}" if query else ""


def _written(driver: Driver, options: Mapping[str, Any]) -> dict[str, str]:
    return {
        key: option.write(options[key])
        for key, option in driver.options.items()
        if options.get(key) is not None
    }


# ---- the parts of an address: each raises ValueError that says what is wrong, and the remedy -----


def _split(text: str) -> SplitResult:
    # urlsplit drops tabs and line ends without a word, so they are looked for first.
    if any(not character.isprintable() for character in text):
        raise ValueError(message("it contains a control character: type it again"))
    try:
        parts = urlsplit(text)
    except ValueError as error:
        raise ValueError(message(f"host: {arg(error)}: write an IPv6 address as [::1]")) from error
    if parts.fragment or text.endswith("#"):
        raise ValueError(message("'#': write it as %23 if it belongs to the path"))
    return parts


def _kind(scheme: str) -> _Kind:
    if scheme in _SOURCES:
        return _SOURCES[scheme]
    driver = driver_of(scheme.partition("+")[0]) if "+" in scheme else None
    for kind in () if driver is None else _kinds_of(driver):
        if scheme == kind.scheme:
            return kind
    devices = [kind.scheme for each in drivers().values() for kind in _kinds_of(each)]
    known = ", ".join((*devices, *_SOURCES))
    raise ValueError(
        message(f"scheme {arg(scheme or 'missing')}: start it with one of {arg(known)}, then ://")
    )


def _given(query: str, kind: _Kind) -> dict[str, Any]:
    """Return the options of a query, each of which must be known."""
    found: dict[str, str] = {}
    try:
        # A plus is one, as in start=AT+RUN, and not a blank.
        pairs = parse_qsl(
            query.replace("+", "%2B"), keep_blank_values=True, strict_parsing=bool(query), errors="strict"
        )
    except ValueError as error:
        raise ValueError(message(f"options: {arg(error)}: write them as ?name=value&name=value")) from error
    for key, value in pairs:
        if key not in kind.defaults:
            raise ValueError(
                message(f"unknown option {arg(key)!r}. Possible: {arg(', '.join(kind.defaults))}")
            )
        if key in found:
            raise ValueError(message(f"option {arg(key)!r} appears twice: keep one"))
        found[key] = value
    with _own_failures(kind.driver):
        return {key: _read(key, value, _reader(key, kind)) for key, value in found.items()}


def _reader(key: str, kind: _Kind) -> Callable[[str], Any]:
    if kind.driver is not None and key in kind.driver.options:
        return kind.driver.options[key].read
    if key == "speed" and kind.protocol in _SPEEDS:
        return _SPEEDS[kind.protocol]
    return _BENCH[key] if key in _BENCH else _OPTIONS[key][1]


@contextmanager
def _own_failures(driver: Driver | None) -> Iterator[None]:
    """Turn whatever a plug-in raises into a ValueError that names it."""
    try:
        yield
    except ValueError:
        raise
    except Exception as error:
        title = "" if driver is None else driver.title
        raise ValueError(
            message(f"the driver of {arg(title)} failed: {arg(error)!r}: update its package")
        ) from error


def _read(key: str, value: str, read: Callable[[str], Any]) -> Any:
    try:
        return read(value)
    except ValueError as error:
        raise ValueError(message(f"{arg(key)} {arg(value[:80])!r}: {arg(error)}")) from error


def _place(parts: SplitResult, kind: _Kind) -> tuple[str, int | None, str]:
    """Return host, port and path."""
    carrier = kind.carrier
    if carrier in _SOCKETS:
        return *_socket(parts, None if kind.driver is None else kind.driver.way(carrier).port), ""
    if carrier in (Carrier.TYPED, Carrier.SIMULATED):
        host, what, begin = (
            ("", message("a typed pose has no host or path"), f"{parts.scheme}://?")
            if carrier is Carrier.TYPED
            else ("bench", message("the virtual bench has no host or path"), "virtual://bench")
        )
        if parts.netloc != host or parts.path not in ("", "/"):
            raise ValueError(
                message(f"{arg(parts.netloc + parts.path)!r}: {arg(what)}: begin with {arg(begin)}")
            )
        return host, None, ""
    return "", None, _path(parts, serial=carrier is Carrier.SERIAL)


def _socket(parts: SplitResult, usual: int | None) -> tuple[str, int]:
    """Return host and port; `usual` is the port where none is given."""
    if "@" in parts.netloc:
        raise ValueError(message("user name: devices do not use one: leave out the part before the @"))
    host = _zoned(parts.hostname or "")
    if not host or any(character in host.split("%")[0] for character in " %\\"):
        raise ValueError(message("host: give a name or an IP address after ://"))
    if parts.path not in ("", "/"):
        raise ValueError(message(f"path {arg(parts.path)!r}: a socket has no path: leave it out"))
    try:
        port = parts.port
    except ValueError:
        port = -1
    port = usual if port is None else port
    if port is None or not 1 <= port <= 65_535:
        raise ValueError(message(f"port: give a whole number from 1 to 65535, or none for {arg(usual)}"))
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
        raise ValueError(message(f"host {arg(parts.netloc)!r}: a path needs three slashes: :///path"))
    # A path of Windows has no leading slash of its own: /COM3, /C:/folder.
    drive = path[1:]
    if (drive.upper().startswith("COM") and drive[3:].isdigit()) or drive[1:3] in (":/", ":\\"):
        path = drive
    if path in ("", "/") or "\0" in path:
        file = "poses.csv" if parts.scheme == "poses" else "recording.mcap"
        what, example = (message("serial port"), "/dev/ttyUSB0") if serial else ("file", f"/folder/{file}")
        raise ValueError(message(f"path: give the {arg(what)} after three slashes: ://{arg(example)}"))
    return path


# ---- options that must fit each other -----------------------------------------------------------


def _check_bench(given: Mapping[str, Any]) -> None:
    if "probe" in given and "mesh" in given:
        raise ValueError(message("probe and mesh: give only one of them"))
    for key in ("rate", "pose_rate"):
        if given.get(key, 0.0) > _FASTEST_HZ:
            raise ValueError(message(f"{arg(key)}: the bench provides at most {arg(_FASTEST_HZ):g} Hz"))


def _check_typed(address: DeviceAddress) -> None:
    ways = (address.rpy_degrees, address.quaternion, address.joints_degrees)
    if sum(way is not None for way in ways) != 1:
        raise ValueError(
            message(
                "pose: give one of rpy=0,90,0 (degrees about the fixed x, y, z axes),"
                " quaternion=w,x,y,z or robot=elfin3&joints=... (degrees)"
            )
        )
    if (address.rate or 0) > _FASTEST_HZ:
        raise ValueError(message(f"rate: a fixed pose needs at most {arg(_FASTEST_HZ):g} Hz"))
    if (address.joints_degrees is None) != (address.robot is None):
        raise ValueError(message("robot: joints need their robot, and nothing else does"))
    if address.quaternion is not None and not abs(math.hypot(*address.quaternion) - 1) <= _UNIT:
        raise ValueError(message("quaternion: its length is not 1: check its four numbers w,x,y,z"))


def _check_ceiling(address: DeviceAddress, kind: _Kind) -> None:
    frame = 0 if kind.driver is None else kind.driver.way(kind.carrier).frame
    if not (address.baud and address.rate and frame):
        return
    ceiling = address.baud / (_BITS_PER_BYTE * frame)
    if address.rate > ceiling:
        raise ValueError(
            message(
                f"rate: {arg(address.rate):g} samples/s are too many for {arg(address.baud)} bit/s: choose at"
                f" most {arg(math.floor(ceiling))}, or a faster line if the device is set to one"
            )
        )
