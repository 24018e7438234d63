"""Where a device is and how to speak to it, as a URL: ``sri+serial:///dev/ttyUSB0?baud=115200``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING
from urllib.parse import parse_qsl, quote, unquote, urlencode, urlsplit

from pipeline.errors import InputError

if TYPE_CHECKING:
    from urllib.parse import SplitResult


class AddressError(InputError):
    """An address that names no device; the message names the part and the remedy."""


class Protocol(StrEnum):
    """What a device speaks."""

    SRI = "sri"
    BOTA = "bota"
    ROBOTIQ = "robotiq"
    RDT = "rdt"
    ELFIN = "elfin"
    UR = "ur"
    REPLAY = "replay"


class Carrier(StrEnum):
    """What carries the bytes."""

    SERIAL = "serial"
    TCP = "tcp"
    UDP = "udp"
    FILE = "file"


@dataclass(frozen=True)
class _Kind:
    """What one scheme allows, and its defaults."""

    baud: int | None = None
    port: int | None = None
    rate: float | None = None
    frame: int = 0
    options: tuple[str, ...] = ()


_KINDS = {
    (Protocol.SRI, Carrier.SERIAL): _Kind(baud=115_200, rate=200.0, frame=31, options=("baud", "rate")),
    (Protocol.SRI, Carrier.TCP): _Kind(port=4008, rate=200.0, options=("rate",)),
    (Protocol.BOTA, Carrier.SERIAL): _Kind(baud=460_800, rate=200.0, frame=37, options=("baud", "rate")),
    (Protocol.ROBOTIQ, Carrier.SERIAL): _Kind(baud=19_200, rate=100.0, frame=16, options=("baud",)),
    (Protocol.RDT, Carrier.UDP): _Kind(port=49_152, options=("profile", "rate", "cpf", "cpt")),
    (Protocol.ELFIN, Carrier.TCP): _Kind(port=10_003, rate=50.0, options=("rate",)),
    (Protocol.UR, Carrier.TCP): _Kind(port=30_004, rate=125.0, options=("rate",)),
    (Protocol.REPLAY, Carrier.FILE): _Kind(options=("speed",)),
}
# Counts per N and per N·m. An ATI box may have others: its own configuration page says.
PROFILES = {"ati": (1e6, 1e6), "onrobot": (1e4, 1e5)}
STEPWISE = 0.0
_BITS_PER_BYTE = 10  # 8N1


@dataclass(frozen=True)
class DeviceAddress:
    """One device.

    Attributes
    ----------
    protocol : Protocol
    carrier : Carrier
    host : str
        Name or IP address; empty for serial lines and files.
    port : int or None
        TCP or UDP port; None for serial lines and files.
    path : str
        Serial device or recording; empty for sockets.
    baud : int or None
        Of a serial line, bit/s.
    rate : float or None
        Samples per second to ask the device for; None: what the device is set to.
    profile : str or None
        Of RDT: "ati" or "onrobot".
    counts_per_newton, counts_per_newton_metre : float or None
        Of RDT: the profile's, unless the address gives others.
    speed : float or None
        Of a replay: times the recorded pace; `STEPWISE` (0) gives a sample whenever it is asked for one.
    """

    protocol: Protocol
    carrier: Carrier
    host: str = ""
    port: int | None = None
    path: str = ""
    baud: int | None = None
    rate: float | None = None
    profile: str | None = None
    counts_per_newton: float | None = None
    counts_per_newton_metre: float | None = None
    speed: float | None = None

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
        parts = _split(text)
        protocol, carrier = _scheme(parts.scheme, text)
        kind = _KINDS[protocol, carrier]
        options = _options(parts.query, kind, text)
        host, port, path = "", None, ""
        if carrier in (Carrier.TCP, Carrier.UDP):
            host, port = _socket(parts, kind, text)
        else:
            path = _path(parts, carrier, text)
        profile = _profile(options, text) if protocol is Protocol.RDT else None
        scale = PROFILES[profile] if profile else (None, None)
        address = cls(
            protocol=protocol,
            carrier=carrier,
            host=host,
            port=port,
            path=path,
            baud=_baud(options, kind, text),
            rate=_positive(options, "rate", kind.rate, "Hz", text),
            profile=profile,
            counts_per_newton=_positive(options, "cpf", scale[0], "counts per N", text),
            counts_per_newton_metre=_positive(options, "cpt", scale[1], "counts per N·m", text),
            speed=_speed(options, text) if protocol is Protocol.REPLAY else None,
        )
        _check_ceiling(address, kind, text)
        return address

    def __str__(self) -> str:
        """Return the address with every default written out; `parse` reads it back."""
        scheme = self.protocol if self.carrier is Carrier.FILE else f"{self.protocol}+{self.carrier}"
        if self.carrier in (Carrier.TCP, Carrier.UDP):
            host = f"[{self.host}]" if ":" in self.host else self.host
            where = f"{host}:{self.port}"
        else:
            where = quote(self.path if self.path.startswith("/") else f"/{self.path}")
        values = {
            "baud": self.baud,
            "profile": self.profile,
            "rate": self.rate,
            "cpf": self.counts_per_newton,
            "cpt": self.counts_per_newton_metre,
            "speed": "step" if self.speed == STEPWISE else self.speed,
        }
        query = urlencode({name: _short(value) for name, value in values.items() if value is not None})
        return f"{scheme}://{where}" + (f"?{query}" if query else "")

    @property
    def gives_poses(self) -> bool:
        """Whether it is a robot and not a force/torque sensor."""
        return self.protocol in (Protocol.ELFIN, Protocol.UR)


def _short(value: object) -> str:
    return str(int(value)) if isinstance(value, float) and value.is_integer() else str(value)


def _split(text: str) -> SplitResult:
    # urlsplit drops tabs and line ends without a word, so they are looked for first.
    if any(not character.isprintable() for character in text):
        raise AddressError(f"address {text!r}: it holds a control character: type it again.")
    try:
        parts = urlsplit(text)
    except ValueError as error:
        raise AddressError(f"address {text!r}: host: {error}: write an IPv6 address as [::1].") from error
    if parts.fragment or text.endswith("#"):
        raise AddressError(f"address {text!r}: '#': write it as %23 where it belongs to the path.")
    return parts


def _scheme(scheme: str, text: str) -> tuple[Protocol, Carrier]:
    for protocol, carrier in _KINDS:
        if scheme == (protocol.value if carrier is Carrier.FILE else f"{protocol}+{carrier}"):
            return protocol, carrier
    known = ", ".join(str(p) if c is Carrier.FILE else f"{p}+{c}" for p, c in _KINDS)
    raise AddressError(
        f"address {text!r}: scheme {scheme or 'missing'}: start it with one of {known}, then ://."
    )


def _options(query: str, kind: _Kind, text: str) -> dict[str, str]:
    found: dict[str, str] = {}
    try:
        pairs = parse_qsl(query, keep_blank_values=True, strict_parsing=bool(query), errors="strict")
    except ValueError as error:
        raise AddressError(
            f"address {text!r}: options: {error}: write them as ?name=value&name=value."
        ) from error
    for name, value in pairs:
        if name not in kind.options:
            allowed = ", ".join(kind.options)
            raise AddressError(f"address {text!r}: option {name!r} is unknown here: it can have {allowed}.")
        if name in found:
            raise AddressError(f"address {text!r}: option {name!r} is there twice: keep one.")
        found[name] = value
    return found


def _socket(parts: SplitResult, kind: _Kind, text: str) -> tuple[str, int]:
    if "@" in parts.netloc:
        raise AddressError(
            f"address {text!r}: user name: devices ask for none: leave out what is before the @."
        )
    if not parts.hostname or any(character in parts.hostname for character in " %\\"):
        raise AddressError(f"address {text!r}: host: give a name or an IP address after ://.")
    if parts.path not in ("", "/"):
        raise AddressError(f"address {text!r}: path {parts.path!r}: a socket has none: leave it out.")
    try:
        port = parts.port
    except ValueError:
        port = -1
    port = kind.port if port is None else port
    if port is None or not 1 <= port <= 65_535:
        raise AddressError(
            f"address {text!r}: port: give a whole number from 1 to 65535, or none for {kind.port}."
        )
    return parts.hostname, port


def _path(parts: SplitResult, carrier: Carrier, text: str) -> str:
    path = unquote(parts.path, errors="surrogateescape")
    if carrier is Carrier.SERIAL and parts.netloc and path in ("", "/"):
        return parts.netloc  # COM3 as in sri+serial://COM3
    if parts.netloc:
        raise AddressError(
            f"address {text!r}: host {parts.netloc!r}: a path follows three slashes: :///path."
        )
    # A path of Windows has no leading slash of its own: /COM3, /C:/folder.
    drive = path[1:]
    if (drive.upper().startswith("COM") and drive[3:].isdigit()) or drive[1:3] in (":/", ":\\"):
        path = drive
    if path in ("", "/") or "\0" in path:
        example = "/dev/ttyUSB0" if carrier is Carrier.SERIAL else "/folder/recording.mcap"
        raise AddressError(f"address {text!r}: path: name the {carrier} after three slashes: ://{example}.")
    return path


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


def _positive(
    options: dict[str, str], name: str, default: float | None, unit: str, text: str
) -> float | None:
    if name not in options:
        return default
    try:
        value = float(options[name])
    except ValueError:
        value = math.nan
    if not 1e-3 <= value <= 1e9:
        raise AddressError(f"address {text!r}: {name} {options[name]!r}: give a positive number of {unit}.")
    return value


def _speed(options: dict[str, str], text: str) -> float | None:
    if options.get("speed") == "step":
        return STEPWISE
    return _positive(options, "speed", 1.0, "times the recorded pace, or step", text)


def _check_ceiling(address: DeviceAddress, kind: _Kind, text: str) -> None:
    if not (address.baud and address.rate and kind.frame):
        return
    ceiling = address.baud / (_BITS_PER_BYTE * kind.frame)
    if address.rate > ceiling:
        raise AddressError(
            f"address {text!r}: rate: {address.rate:g} samples/s do not fit through {address.baud} bit/s: ask for at"
            f" most {math.floor(ceiling)}, or a faster line if the device is set to one."
        )
