"""Where an output goes or listens on the network: a host and a port, on this machine unless allowed otherwise."""

import ipaddress
import socket
from typing import Any, NamedTuple

from contactbench.pipeline.errors import RunError, arg


class Place(NamedTuple):
    """A resolved address."""

    family: socket.AddressFamily
    address: Any  # as `socket.bind` and `socket.connect` take it

    @property
    def host(self) -> str:
        """IP address."""
        return str(self.address[0])

    @property
    def port(self) -> int:
        """TCP or UDP port."""
        return int(self.address[1])


def resolve(option: str, text: str, kind: socket.SocketKind, *, remote: bool, listens: bool = False) -> Place:
    """
    Return what HOST:PORT stands for.

    Parameters
    ----------
    option : str
        What gave it, such as ``--udp``, for messages.
    text : str
    kind : socket.SocketKind
    remote : bool
        Whether it may be, or be reached from, another machine: nothing is encrypted or signed.
    listens : bool
        It is an address to listen on: port 0 is any free one.

    Raises
    ------
    RunError
        It is no address, or on another machine without leave.
    """
    host, _, port = text.rpartition(":")
    lowest = 0 if listens else 1
    if not host or not (
        port.isascii() and port.isdigit() and len(port) <= 5 and lowest <= int(port) < 65_536
    ):
        raise RunError(f"{arg(option)} {arg(text)}: give a host and a port, such as 127.0.0.1:9000.")
    try:
        family, _, _, _, place = socket.getaddrinfo(host.strip("[]"), int(port), type=kind)[0]
        near = ipaddress.ip_address(str(place[0]).partition("%")[0]).is_loopback
    except (OSError, UnicodeError, ValueError) as error:
        raise RunError(
            f"{arg(option)} {arg(text)}: there is no such host ({arg(error)}): write its IP address, such as 127.0.0.1."
        ) from error
    if not near and not remote and listens:
        raise RunError(
            f"{arg(option)} {arg(text)}: other machines could connect there, and contacts are neither"
            " encrypted nor signed: listen on 127.0.0.1, or allow other machines (--allow-remote)."
        )
    if not near and not remote:
        raise RunError(
            f"{arg(option)} {arg(text)}: this is another machine, and contacts are neither encrypted nor"
            " signed: send to 127.0.0.1, or allow other machines (--allow-remote)."
        )
    return Place(family, place)
