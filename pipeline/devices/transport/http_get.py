"""One small page from a device's own web server, by a plain GET."""

import io
import re
import socket
import time
from dataclasses import dataclass
from http.client import HTTPException, HTTPResponse
from typing import cast

from contactbench.pipeline.devices.transport.sockets import LineError
from contactbench.pipeline.errors import arg, message

TIMEOUT_S = 2.0
MOST_BYTES = 65_536
_MOST_HEAD = 16_384
_READ = 4096
_OK = 200
_REDIRECTS = range(300, 400)
_LENGTH = re.compile(rb"(?i)\r\ncontent-length:[ \t]*(\d{1,9})[ \t]*(?:\r|$)")


class PageError(LineError):
    """A page that could not be had from a device; the message names the page and the remedy."""


def http_get(host: str, path: str, port: int = 80, *, timeout: float = TIMEOUT_S) -> bytes:
    """
    Return a page. Nothing is followed, kept or sent beside the request.

    Parameters
    ----------
    host : str
        Name or IP address.
    path : str
        Begins with a slash.
    port : int
    timeout : float
        For connection, request and answer together, s; a look-up of the name takes what the system allows.

    Returns
    -------
    bytes
        At most `MOST_BYTES`.

    Raises
    ------
    PageError
        There is no connection, no answer in time, another answer than the page, or too long a page.
    """
    page = _Page(host, path, port)
    deadline = time.monotonic() + timeout
    try:
        with socket.create_connection((host, port), timeout=timeout) as opened:
            opened.settimeout(_left(deadline))
            opened.sendall(page.request())
            data = _receive(opened, deadline)
    except TimeoutError as error:
        raise page.error(
            message(f"no complete answer within {arg(timeout):g} s"),
            message("check cable, address and power"),
        ) from error
    except (OSError, UnicodeError) as error:  # UnicodeError: a host that no name server can know
        raise page.error(
            message(f"no connection ({arg(error)})"),
            message("check that the device is on, and on this network"),
        ) from error
    return page.body(data)


@dataclass(frozen=True)
class _Page:
    host: str
    path: str
    port: int

    def __post_init__(self) -> None:
        # A line end would add a header, or another request.
        if not (self.path.startswith("/") and f"{self.host}{self.path}".isascii()) or any(
            character.isspace() or not character.isprintable() for character in self.host + self.path
        ):
            raise self.error(
                message("not the address of a page"), message("give a host, and a path that begins with /")
            )
        if not 1 <= self.port <= 65_535:
            raise self.error(message("not a port"), message("give a whole number from 1 to 65535"))

    def error(self, what: str, remedy: str) -> PageError:
        where = f"http://{self.host}:{self.port}{self.path}"
        return PageError(f"{arg(where)!r}: {arg(what)}: {arg(remedy)}.")

    def request(self) -> bytes:
        name = f"[{self.host}]" if ":" in self.host else self.host
        host = name if self.port == 80 else f"{name}:{self.port}"
        # 1.0: the page comes in one piece, and the connection ends with it.
        lines = (
            f"GET {self.path} HTTP/1.0",
            f"Host: {host}",
            "Accept-Encoding: identity",
            "Connection: close",
        )
        return "".join(f"{line}\r\n" for line in (*lines, "")).encode("ascii")

    def body(self, data: bytes) -> bytes:
        """Return what an answer holds."""
        try:
            answer = HTTPResponse(cast("socket.socket", _Received(data)))
            answer.begin()
            body = answer.read(MOST_BYTES + 1)
            missing = answer.length
        except (HTTPException, ValueError, OSError) as error:
            raise self.error(
                message(f"the answer is not HTTP ({arg(error)!r})"), message("check the address")
            ) from error
        if answer.status in _REDIRECTS:
            raise self.error(
                message(f"the device points elsewhere ({arg(answer.status)})"), message("check the address")
            )
        if answer.status != _OK:
            raise self.error(
                message(f"the device answers {arg(answer.status)}"),
                message("check address and kind of the device"),
            )
        if len(body) > MOST_BYTES:
            raise self.error(
                message(f"the answer is longer than {arg(MOST_BYTES)} bytes"), message("check the address")
            )
        if missing:
            raise self.error(message(f"{arg(missing)} bytes of the answer are missing"), message("try again"))
        return body


class _Received:
    """What `HTTPResponse` needs of a socket: the bytes, all there already."""

    def __init__(self, data: bytes) -> None:
        self._data = data

    def makefile(self, _mode: str) -> io.BytesIO:
        return io.BytesIO(self._data)


def _receive(opened: socket.socket, deadline: float) -> bytes:
    """Return what comes until the page is whole or too long; a slow trickle does not extend the deadline."""
    data = b""
    while len(data) <= MOST_BYTES + _MOST_HEAD and not _whole(data):
        opened.settimeout(_left(deadline))
        piece = opened.recv(_READ)
        if not piece:
            break
        data += piece
    return data


def _whole(data: bytes) -> bool:
    """Tell whether all of a page of known length is there: some devices never close the connection."""
    head, end, body = data.partition(b"\r\n\r\n")
    length = _LENGTH.search(head) if end else None
    return length is not None and len(body) >= int(length[1])


def _left(deadline: float) -> float:
    left = deadline - time.monotonic()
    if left <= 0:
        raise TimeoutError
    return left
