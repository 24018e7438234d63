"""The place of an address: what stands between its scheme and its question mark."""

from __future__ import annotations

from typing import TYPE_CHECKING
from urllib.parse import unquote, urlsplit

from contactbench.pipeline.devices.url_options import AddressError

if TYPE_CHECKING:
    from urllib.parse import SplitResult


def split_address(text: str) -> SplitResult:
    """
    Return the parts of an address.

    Raises
    ------
    AddressError
        It is none.
    """
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


def socket_of(parts: SplitResult, usual: int | None, text: str) -> tuple[str, int]:
    """
    Return host and port of a socket; `usual` is the port where none is given.

    Raises
    ------
    AddressError
        It is none.
    """
    if "@" in parts.netloc:
        raise AddressError(
            f"address {text!r}: user name: devices ask for none: leave out what is before the @."
        )
    host = _zoned(parts.hostname or "")
    if not host or any(character in host.split("%")[0] for character in " %\\"):
        raise AddressError(f"address {text!r}: host: give a name or an IP address after ://.")
    if parts.path not in ("", "/"):
        raise AddressError(f"address {text!r}: path {parts.path!r}: a socket has none: leave it out.")
    try:
        port = parts.port
    except ValueError:
        port = -1
    port = usual if port is None else port
    if port is None or not 1 <= port <= 65_535:
        raise AddressError(
            f"address {text!r}: port: give a whole number from 1 to 65535, or none for {usual}."
        )
    return host, port


def _zoned(host: str) -> str:
    """Return a host with its IPv6 zone, which a URL writes as %25eth0 and a person as %eth0, written as %eth0."""
    address, percent, zone = host.partition("%")
    zone = zone.removeprefix("25")
    # Only an IPv6 address has one, and it names an interface of this machine.
    if percent and ":" in address and zone and all(c.isalnum() or c in "-_.~" for c in zone):
        return f"{address}%{zone}"
    return "" if percent else host


def check_nowhere(parts: SplitResult, text: str) -> None:
    """
    Refuse a place where there is none.

    Raises
    ------
    AddressError
        It is none.
    """
    if parts.netloc or parts.path not in ("", "/"):
        raise AddressError(
            f"address {text!r}: {parts.netloc + parts.path!r}: a typed pose is nowhere: begin with {parts.scheme}://?."
        )


def bench_host(parts: SplitResult, text: str) -> str:
    """
    Return the name of the virtual bench.

    Raises
    ------
    AddressError
        It is none.
    """
    if parts.netloc != "bench" or parts.path not in ("", "/"):
        raise AddressError(
            f"address {text!r}: {parts.netloc + parts.path!r}: there is one virtual bench: begin with virtual://bench."
        )
    return parts.netloc


def path_of(parts: SplitResult, text: str, *, serial: bool) -> str:
    """
    Return the path of a serial port or a file.

    Raises
    ------
    AddressError
        It is none.
    """
    path = unquote(parts.path, errors="surrogateescape")
    if serial and parts.netloc and path in ("", "/"):
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
        file = "poses.csv" if parts.scheme == "poses" else "recording.mcap"
        example = "/dev/ttyUSB0" if serial else f"/folder/{file}"
        what = "serial port" if serial else "file"
        raise AddressError(f"address {text!r}: path: name the {what} after three slashes: ://{example}.")
    return path
