"""TCP and UDP lines."""

from __future__ import annotations

import errno
import math
import os
import select
import socket
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from contactbench.pipeline.errors import InputError, arg, message

_Taken = TypeVar("_Taken")
_CONNECT_S = 3.0
_LOOK_S = 0.05  # how soon an interruption is noticed
_UNDER_WAY = (errno.EINPROGRESS, errno.EWOULDBLOCK, errno.EALREADY)
# A peer that vanished is noticed after seconds, not after the quarter of an hour that systems allow by themselves.
# Not every system has all of them.
_KEEPING = (("TCP_KEEPIDLE", 1), ("TCP_KEEPINTVL", 1), ("TCP_KEEPCNT", 3), ("TCP_USER_TIMEOUT", 3000))
_WRITE_S = 1.0
_TCP_READ = 65_536
_FAITHFUL_S = 1.0  # so long silent, a sender that we listen to may be followed by another one
_SHOWN_S = 2.0  # how long after its last datagram another sender is told
_DATAGRAM = 65_535  # none can be larger, so none is cut
_ROOM = 4 << 20  # bytes for datagrams while this computer is busy: seconds of the fastest sensor
_DROPS = 40  # Linux's SO_RXQ_OVFL: how many datagrams the full buffer has dropped, with each that is read after them
_NOTHING = (TimeoutError, BlockingIOError)


class _SocketLine:
    """What TCP and UDP share."""

    def __init__(self, host: str, port: int) -> None:
        self.name = f"[{host}]:{port}" if ":" in host else f"{host}:{port}"
        self._where = (host, port)
        self._socket: socket.socket | None = None

    def write(self, data: bytes) -> None:
        """Send all of `data`; see `Line.write`."""
        opened = self._opened()
        try:
            opened.settimeout(_WRITE_S)
            opened.sendall(data)
        except OSError as error:
            raise self._lost(str(error)) from error

    def close(self) -> None:
        """Close the socket."""
        opened, self._socket = self._socket, None
        if opened is not None:
            opened.close()

    def _addresses(self, kind: socket.SocketKind) -> list[Any]:
        """Return what the name stands for, IPv4 first: few devices have IPv6, and localhost is both."""
        try:
            found = socket.getaddrinfo(*self._where, type=kind)
        except (OSError, UnicodeError) as error:  # UnicodeError: a host that no name server can know
            raise self._unavailable(error) from error
        return sorted(found, key=lambda each: each[0] != socket.AF_INET)

    def _receive(self, timeout: float, take: Callable[[socket.socket], _Taken]) -> _Taken | None:
        """Return what `take` finds within `timeout` s; None: nothing came."""
        opened = self._opened()
        try:
            opened.settimeout(timeout)
            return take(opened)
        except _NOTHING:
            return None
        except OSError as error:
            raise self._lost(str(error)) from error

    def _opened(self) -> socket.socket:
        if self._socket is None:
            raise LineLost(f"{arg(self.name)}: the line is not open: open it first.")
        return self._socket

    def _lost(self, why: str) -> LineLost:
        self.close()
        return LineLost(
            f"{arg(self.name)}: connection lost ({arg(why)}): check cable and device, then reconnect."
        )

    def _unavailable(self, error: Exception) -> LineUnavailable:
        return LineUnavailable(
            f"{arg(self.name)}: no connection ({arg(error)}): check that the device is on, in this network,"
            " and not in use."
        )


class TcpLine(_SocketLine):
    """A TCP connection to a device.

    Parameters
    ----------
    host : str
    port : int
    """

    datagrams = False

    def __init__(self, host: str, port: int) -> None:
        super().__init__(host, port)
        self._interrupted = threading.Event()

    def open(self) -> None:
        """Connect within 3 s; see `Line.open`."""
        self.close()
        refused: OSError = OSError(message("the name has no address"))
        for found in self._addresses(socket.SOCK_STREAM):
            try:
                self._socket = self._connected(found)
            except OSError as error:
                refused = error
            else:
                return
        raise self._unavailable(refused) from refused

    def interrupt(self) -> None:
        """End a connecting that is under way, from another thread, for good: the line is not needed any more."""
        self._interrupted.set()

    def _connected(self, found: Any) -> socket.socket:
        family, kind, protocol, _, where = found
        opened = socket.socket(family, kind, protocol)
        try:
            opened.setblocking(False)
            self._finish_connecting(opened, opened.connect_ex(where))
            # Requests are small and each waits for its answer: never hold one back to fill a packet.
            opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
            for name, value in _KEEPING:
                if hasattr(socket, name):
                    opened.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)
        except OSError:
            opened.close()
            raise
        return opened

    def _finish_connecting(self, opened: socket.socket, state: int) -> None:
        deadline = time.monotonic() + _CONNECT_S
        while state in _UNDER_WAY:
            if self._interrupted.is_set():
                raise OSError(message("it was interrupted"))
            if time.monotonic() > deadline:
                raise TimeoutError(message("timed out"))
            _, ready, failed = select.select([], [opened], [opened], _LOOK_S)
            if ready or failed:
                state = opened.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
        if state:
            raise OSError(state, os.strerror(state))

    def read(self, timeout: float) -> Chunk:
        """Return what is there; see `Line.read`."""
        data = self._receive(timeout, lambda opened: opened.recv(_TCP_READ))
        arrived = time.monotonic()
        if data == b"":
            raise self._lost(message("the device closed the connection"))
        return Chunk(data or b"", arrived)


class UdpLine(_SocketLine):
    """Datagrams to and from one device; what others send is not seen.

    UDP has no connection: `open` succeeds without a device, and a device that goes away is only noticed by
    the silence, or when something is written to a host that refuses it.

    Parameters
    ----------
    host : str
    port : int
    listen : int or None
        Port of this computer that the device sends to by itself, from any port of its own; None: it answers to where
        it was asked from. The first sender of that host is listened to until it is silent for a second.

    Attributes
    ----------
    foreign : int
        Datagrams of other senders, left out.
    dropped : int
        Datagrams that this computer has dropped, because nothing read them in time; as far as the system counts them.
    """

    datagrams = True

    def __init__(self, host: str, port: int, listen: int | None = None) -> None:
        super().__init__(host, port)
        self._listen = listen
        self._peer: Any = None
        self._turn = -1
        self._drops = 0  # of this socket
        self._sender: Any = None  # whom we listen to
        self._other: Any = None  # who was left out last
        self._heard_at = self._other_at = self._dropped_at = -math.inf
        self.foreign = self.dropped = 0

    def open(self) -> None:
        """Bind a socket and point it at the device, each time at the next of its addresses; see `Line.open`."""
        self.close()
        found = self._addresses(socket.SOCK_DGRAM)
        self._turn += 1
        family, kind, protocol, _, where = found[self._turn % len(found)]
        try:
            opened = socket.socket(family, kind, protocol)
        except OSError as error:
            raise self._unavailable(error) from error
        try:
            # As much as the system allows; it says nothing where that is less.
            opened.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _ROOM)
            if sys.platform == "linux":
                opened.setsockopt(socket.SOL_SOCKET, _DROPS, 1)
            if self._listen is None:
                opened.connect(where)
            else:
                opened.bind(("", self._listen))
        except OSError as error:
            opened.close()
            raise self._unavailable(error) from error
        self._socket, self._peer, self._sender, self._drops = opened, where, None, 0
        self._heard_at = -math.inf

    def troubles(self) -> dict[str, str]:
        """Return whether another sender is left out now, or this computer has dropped datagrams, by kind."""
        now, found = time.monotonic(), {}
        if now - self._dropped_at < _SHOWN_S:
            found["overrun"] = message(
                f"This computer dropped datagrams of the sensor, {arg(self.dropped)} so far: it was too busy to read"
                " them. Close other programs, or allow larger receive buffers (Linux: sysctl net.core.rmem_max)."
            )
        if now - self._other_at < _SHOWN_S and self._sender is not None:
            found["foreign"] = message(
                f"Datagrams left out: {arg(self.foreign)}, the last one from {arg(self._other[0])}, port"
                f" {arg(self._other[1])}. Only port {arg(self._sender[1])} of {arg(self._sender[0])} is"
                " listened to: stop the other sender, or give each a port of this computer."
            )
        return found

    def write(self, data: bytes) -> None:
        """Send all of `data`; see `Line.write`."""
        if self._listen is None:
            super().write(data)
            return
        try:
            self._opened().sendto(data, self._peer)
        except OSError as error:
            raise self._lost(str(error)) from error

    def read(self, timeout: float) -> Chunk:
        """Return one datagram; see `Line.read`."""
        found, now = self._receive(timeout, _datagram), time.monotonic()
        if found is None:
            return Chunk(b"", now)
        data, drops, sender = found
        if drops > self._drops:
            self.dropped += drops - self._drops
            self._drops, self._dropped_at = drops, now
        return Chunk(data if self._listen is None or self._is_its(sender, now) else b"", now)

    def _is_its(self, sender: Any, now: float) -> bool:
        if sender[0] != self._peer[0] or (sender != self._sender and now - self._heard_at < _FAITHFUL_S):
            self.foreign += 1
            self._other, self._other_at = sender, now
            return False
        self._sender, self._heard_at = sender, now
        return True


def _datagram(opened: socket.socket) -> tuple[bytes, int, Any]:
    """Return a datagram, how many the system says that it has dropped (0: it says nothing), and the sender."""
    if not hasattr(opened, "recvmsg"):
        data, sender = opened.recvfrom(_DATAGRAM)
        return data, 0, sender
    data, notes, _, sender = opened.recvmsg(_DATAGRAM, socket.CMSG_SPACE(4))
    drops = [note for *kind, note in notes if kind == [socket.SOL_SOCKET, _DROPS]]
    return data, int.from_bytes(drops[0], sys.byteorder) if drops else 0, sender


# ---- what every line to a device can do: open, read with a time limit, write, close --------------


class LineError(InputError):
    """A line to a device cannot be used; the message names the line and the remedy."""


class LineUnavailable(LineError):  # noqa: N818 - it is said as a state, as in the status shown to people
    """A line could not be opened; trying again later may work."""


class LineLost(LineError):  # noqa: N818
    """A line that was open is gone: unplugged, closed by the other side, or never opened."""


@dataclass(frozen=True, slots=True)
class Chunk:
    """Bytes, and when the last of them arrived."""

    data: bytes  # empty when nothing came within the time limit
    time: float  # seconds of the host's monotonic clock, taken right after the read


class Line(Protocol):
    """A line to a device. One thread uses it; after `LineLost` it can be opened again.

    Attributes
    ----------
    name : str
        Of the line, for messages.
    datagrams : bool
        Whether each chunk is one whole datagram.
    """

    @property
    def name(self) -> str: ...  # noqa: D102

    @property
    def datagrams(self) -> bool: ...  # noqa: D102

    def open(self) -> None:
        """Open it; an open one is closed first.

        Raises
        ------
        LineUnavailable
            It is not there, busy, or not allowed.
        """

    def read(self, timeout: float) -> Chunk:
        """Return what is there, waiting at most `timeout` seconds (0: not at all) for the first byte.

        Raises
        ------
        LineLost
        """

    def write(self, data: bytes) -> None:
        """Send all of `data`.

        Raises
        ------
        LineLost
            Also when the other side takes nothing for a second.
        """

    def close(self) -> None:
        """Close it; a closed one stays closed. Raises nothing."""
