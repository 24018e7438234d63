"""TCP and UDP lines."""

from __future__ import annotations

import socket
import time

from pipeline.devices.transport.line import Chunk, LineLost, LineUnavailable

_CONNECT_S = 3.0
_WRITE_S = 1.0
_TCP_READ = 65_536
_DATAGRAM = 65_535  # none can be larger, so none is cut
_NOTHING = (TimeoutError, BlockingIOError)


class _SocketLine:
    """What TCP and UDP share."""

    def __init__(self, host: str, port: int) -> None:
        self.name = f"{host}:{port}"
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

    def _receive(self, timeout: float, size: int) -> bytes | None:
        opened = self._opened()
        try:
            opened.settimeout(timeout)
            return opened.recv(size)
        except _NOTHING:
            return None
        except OSError as error:
            raise self._lost(str(error)) from error

    def _opened(self) -> socket.socket:
        if self._socket is None:
            raise LineLost(f"{self.name}: the line is not open: open it first.")
        return self._socket

    def _lost(self, why: str) -> LineLost:
        self.close()
        return LineLost(
            f"{self.name}: the line is lost ({why}): check cable and device; it can be opened again then."
        )

    def _unavailable(self, error: Exception) -> LineUnavailable:
        return LineUnavailable(
            f"{self.name}: no connection ({error}): check that the device is on, on this network, and not in use."
        )


class TcpLine(_SocketLine):
    """A TCP connection to a device.

    Parameters
    ----------
    host : str
    port : int
    """

    datagrams = False

    def open(self) -> None:
        """Connect within 3 s; see `Line.open`."""
        self.close()
        try:
            opened = socket.create_connection(self._where, timeout=_CONNECT_S)
        except (OSError, UnicodeError) as error:  # UnicodeError: a host that no name server can know
            raise self._unavailable(error) from error
        # Requests are small and each waits for its answer: never hold one back to fill a packet.
        opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket = opened

    def read(self, timeout: float) -> Chunk:
        """Return what is there; see `Line.read`."""
        data = self._receive(timeout, _TCP_READ)
        arrived = time.monotonic()
        if data == b"":
            raise self._lost("the device closed the connection")
        return Chunk(data or b"", arrived)


class UdpLine(_SocketLine):
    """Datagrams to and from one device; what others send is not seen.

    UDP has no connection: `open` succeeds without a device, and a device that goes away is only noticed by
    the silence, or when something is written to a host that refuses it.

    Parameters
    ----------
    host : str
    port : int
    """

    datagrams = True

    def open(self) -> None:
        """Bind a socket and point it at the device; see `Line.open`."""
        self.close()
        try:
            found = socket.getaddrinfo(*self._where, type=socket.SOCK_DGRAM)
            family, kind, protocol, _, where = found[0]
            opened = socket.socket(family, kind, protocol)
        except (OSError, UnicodeError) as error:
            raise self._unavailable(error) from error
        try:
            opened.connect(where)
        except OSError as error:
            opened.close()
            raise self._unavailable(error) from error
        self._socket = opened

    def read(self, timeout: float) -> Chunk:
        """Return one datagram; see `Line.read`."""
        data = self._receive(timeout, _DATAGRAM)
        return Chunk(data or b"", time.monotonic())
