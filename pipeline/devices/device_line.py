"""The device's end of a line: a pseudo-terminal, a listening TCP socket, a bound UDP socket."""

import os
import select
import socket
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Protocol

from contactbench.pipeline.devices.faults import EmulatorError
from contactbench.pipeline.errors import arg

_LOOPBACK = "127.0.0.1"
_READ = 65_536


class DeviceLine(Protocol):
    """The device's end. One thread uses it.

    Attributes
    ----------
    where : str
        What follows ``://`` in the address.
    datagrams : bool
    fresh : bool
        Whether somebody new has connected since the last `receive`.
    """

    where: str
    datagrams: bool
    fresh: bool

    def receive(self, timeout: float) -> bytes:
        """Return what the host sent (of UDP one datagram), waiting at most that many seconds."""

    def send(self, data: bytes) -> bool:
        """Send; False where nobody is there, or nobody reads and the line is full: it is lost then."""

    def hang_up(self) -> None:
        """Break the line: the host sees it go."""

    def restore(self) -> None:
        """Bring it back, at the same address."""

    def close(self) -> None:
        """End it."""


class PtyLine:
    """A pseudo-terminal behind a symbolic link, which stays when the terminal is replaced by a new one."""

    datagrams = False
    fresh = False

    def __init__(self, name: str) -> None:
        if os.name == "nt":
            raise EmulatorError("--pty: this system has no pseudo-terminals. Use --port.")
        self._folder = tempfile.TemporaryDirectory(prefix="contactbench-")
        self._link = Path(self._folder.name) / name
        self.where = str(self._link)
        self._ends: tuple[int, int] | None = None
        self._rest = b""
        self.restore()

    def receive(self, timeout: float) -> bytes:
        """Return what the host wrote."""
        master = self._master()
        self._flush(master)
        ready, _, _ = select.select([master], [], [], timeout)
        return os.read(master, _READ) if ready else b""

    def send(self, data: bytes) -> bool:
        """Write, or lose all of it while the host does not read: part of a frame is kept for later."""
        master = self._master()
        self._flush(master)
        if self._rest:
            return False
        self._rest = data
        self._flush(master)
        if self._rest == data and data:
            self._rest = b""
            return False
        return True

    def hang_up(self) -> None:
        """Close the terminal."""
        ends, self._ends = self._ends, None
        self._rest = b""
        for end in ends or ():
            os.close(end)
        self._link.unlink(missing_ok=True)

    def restore(self) -> None:
        """Make a new terminal under the same name."""
        import tty

        self.hang_up()
        self._ends = os.openpty()
        # The slave stays open here: without any, reads of the master fail and settings are forgotten.
        tty.setraw(self._ends[1])
        os.set_blocking(self._ends[0], False)
        self._link.symlink_to(os.ttyname(self._ends[1]))

    def close(self) -> None:
        """End it, and take the link away."""
        self.hang_up()
        self._folder.cleanup()

    def _master(self) -> int:
        if self._ends is None:
            raise EmulatorError(f"{arg(self.where)}: the line is broken. Restore it first.")
        return self._ends[0]

    def _flush(self, master: int) -> None:
        while self._rest:
            try:
                self._rest = self._rest[os.write(master, self._rest) :]
            except BlockingIOError:
                return


class TcpServerLine:
    """A listening socket on the loopback interface; one host at a time, a new one replaces the old."""

    datagrams = False

    def __init__(self, port: int = 0) -> None:
        self._listener: socket.socket | None = None
        self._host: socket.socket | None = None
        self._port = port
        self._rest = b""
        self.fresh = False
        self.restore()
        self.where = f"{_LOOPBACK}:{self._port}"

    def receive(self, timeout: float) -> bytes:
        """Return what the host sent; take a new connection first."""
        sockets = [opened for opened in (self._listener, self._host) if opened is not None]
        ready, _, _ = select.select(sockets, [], [], timeout)
        if self._listener in ready and self._listener is not None:
            self._accept(self._listener)
            return b""
        if not ready or self._host is None:
            return b""
        try:
            data = self._host.recv(_READ)
        except OSError:
            data = b""
        if not data:
            self._drop()
        return data

    def send(self, data: bytes) -> bool:
        """Send; see `DeviceLine.send`."""
        self._flush()
        if self._host is None or self._rest:
            return False
        self._rest = data
        self._flush()
        if self._host is None or (self._rest == data and data):
            self._rest = b""
            return False
        return True

    def hang_up(self) -> None:
        """Close the connection, and refuse new ones."""
        self._drop()
        if self._listener is not None:
            self._listener.close()
            self._listener = None

    def restore(self) -> None:
        """Listen again at the same port."""
        self.hang_up()
        listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        try:
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.bind((_LOOPBACK, self._port))
            listener.listen()
            listener.setblocking(False)
        except (OSError, OverflowError) as error:
            listener.close()
            raise _taken(self._port, error) from error
        self._listener, self._port = listener, listener.getsockname()[1]

    def close(self) -> None:
        """End it."""
        self.hang_up()

    def _accept(self, listener: socket.socket) -> None:
        with suppress(OSError):  # the host may be gone again
            host, _ = listener.accept()
            self._drop()
            host.setblocking(False)
            host.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._host, self.fresh = host, True

    def _flush(self) -> None:
        while self._rest and self._host is not None:
            try:
                self._rest = self._rest[self._host.send(self._rest) :]
            except BlockingIOError:
                return
            except OSError:
                self._drop()

    def _drop(self) -> None:
        host, self._host = self._host, None
        self._rest = b""
        if host is not None:
            host.close()


class UdpServerLine:
    """A bound socket on the loopback interface; it sends to whoever spoke last."""

    datagrams = True
    fresh = False

    def __init__(self, port: int = 0) -> None:
        self._socket: socket.socket | None = None
        self._host: tuple[str, int] | None = None
        self._port = port
        self.restore()
        self.where = f"{_LOOPBACK}:{self._port}"

    def receive(self, timeout: float) -> bytes:
        """Return one datagram."""
        if self._socket is None:
            return b""
        ready, _, _ = select.select([self._socket], [], [], timeout)
        if not ready:
            return b""
        try:
            data, self._host = self._socket.recvfrom(_READ)
        except OSError:  # the host refused what was sent to it before
            return b""
        return data

    def send(self, data: bytes) -> bool:
        """Send one datagram; see `DeviceLine.send`."""
        if self._socket is None or self._host is None:
            return False
        try:
            self._socket.sendto(data, self._host)
        except OSError:
            return False
        return True

    def hang_up(self) -> None:
        """Close the socket."""
        if self._socket is not None:
            self._socket.close()
        self._socket, self._host = None, None

    def restore(self) -> None:
        """Bind again to the same port."""
        self.hang_up()
        opened = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            opened.bind((_LOOPBACK, self._port))
        except (OSError, OverflowError) as error:
            opened.close()
            raise _taken(self._port, error) from error
        opened.setblocking(False)
        self._socket, self._port = opened, opened.getsockname()[1]

    def close(self) -> None:
        """End it."""
        self.hang_up()


def _taken(port: int, error: Exception) -> EmulatorError:
    return EmulatorError(
        f"port {arg(port)} cannot be used ({arg(error)}): choose another, or 0 for any free port."
    )
