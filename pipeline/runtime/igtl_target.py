"""Contacts as OpenIGTLink messages, for 3D Slicer and other programs that connect."""

import os
import socket
from collections.abc import Sequence

import numpy as np

from contactbench.pipeline.devices.protocols import igtl
from contactbench.pipeline.errors import RunError, arg, join, message
from contactbench.pipeline.runtime.contact_frame import contact_frame
from contactbench.pipeline.runtime.lines import Answer, health_names
from contactbench.pipeline.runtime.outlet import FRESH_S, OutletTarget, OutputContext, resolve

FRAME, WRENCH, STATUS = "Contact", "ContactWrench", "ContactStatus"
"""Device names of the messages TRANSFORM, SENSOR and STATUS."""

_STATUS_S = 1.0
_MOST_CLIENTS = 16
_MOST_PENDING = 2**18  # bytes for one client, a second at 1 kHz: what is older is of no use
_SEND_BUFFER = 2**16
_READ = 65_536
_WELL, _UNKNOWN, _TIMED_OUT, _NOT_READY, _HARDWARE = 1, 2, 7, 13, 18  # the protocol's status codes
_CODES = {"silent": _TIMED_OUT, "frozen": _HARDWARE, "flagged": _HARDWARE, "no_pose": _NOT_READY}


class IgtlTarget(OutletTarget):
    """
    A server of OpenIGTLink, protocol version 2, for several clients.

    An accepted contact is a TRANSFORM: the contact frame C in S (`contact_frame`), mm. Every sample with a wrench is a
    SENSOR: force (N) and torque (N·m) of the tissue on the probe, compensated, about the sensor's origin, in S. A
    STATUS says the reason and the health when they change, once a second, and to each new client.

    A client that does not read loses messages: its waiting ones are bounded. It delays nobody else.

    Parameters
    ----------
    address : str
        HOST:PORT to listen on.
    context : OutputContext

    Raises
    ------
    RunError
        It is no address, one that other machines reach without leave, or in use.
    """

    fresh = FRESH_S

    def __init__(self, address: str, context: OutputContext) -> None:
        place = resolve("--igtl", address, socket.SOCK_STREAM, remote=context.remote, listens=True)
        self._about = context.about
        self._listener = socket.socket(place.family, socket.SOCK_STREAM)
        try:
            if os.name != "nt":  # there it would let two programs listen
                self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self._listener.bind(place.address)
            self._listener.listen()
        except OSError as error:
            self._listener.close()
            raise RunError(
                f"--igtl {arg(address)}: nobody can listen there ({arg(error)}): choose another port."
            ) from error
        self._listener.setblocking(False)
        self.port: int = self._listener.getsockname()[1]
        self.name = f"OpenIGTLink {place.host}:{self.port}"
        self._clients: list[_Client] = []
        self._status = b""
        self._said: tuple[str, bool, int] | None = None
        self._said_at = -np.inf

    def write(self, answers: Sequence[Answer]) -> int:
        """As `OutletTarget`: a contact that a client could not take is not published; without clients all are."""
        self._accept()
        missed = 0
        for answer in answers:
            try:
                data = self._messages(answer)
            except ValueError:  # its time is no time
                missed += 1
                continue
            missed += sum(not client.offer(data) for client in self._clients) > 0
        self._push()
        return len(answers) - missed

    def flush(self) -> None:
        """As `OutletTarget`: take new clients, and bring out what waits for the others."""
        self._accept()
        self._push()

    def close(self) -> None:
        """As `OutletTarget`."""
        self._push()
        for client in self._clients:
            client.close()
        self._listener.close()

    def _accept(self) -> None:
        while True:
            try:
                opened, _ = self._listener.accept()
            except OSError:  # nobody, or somebody who has left already
                return
            if len(self._clients) >= _MOST_CLIENTS:
                opened.close()
                continue
            client = _Client(opened)
            client.offer(self._status)
            self._clients.append(client)

    def _push(self) -> None:
        gone = [client for client in self._clients if not client.push()]
        for client in gone:
            client.close()
            self._clients.remove(client)

    def _messages(self, answer: Answer) -> bytes:
        contact = answer.contact
        if contact is None:
            return b""
        stamp = self._about.log_time(answer.time)
        data = b""
        if contact.accepted and contact.point is not None and contact.normal is not None:
            frame = igtl.transform(contact_frame(contact.normal), contact.point)
            data += igtl.pack(igtl.TRANSFORM, FRAME, stamp, frame)
        if contact.wrench is not None:
            data += igtl.pack("SENSOR", WRENCH, stamp, igtl.sensor(contact.wrench.tolist()))
        says = answer.reason, contact.accepted, answer.health
        if says != self._said or not 0 <= answer.time - self._said_at < _STATUS_S:
            self._said, self._said_at = says, answer.time
            self._status = igtl.pack("STATUS", STATUS, stamp, _status(*says))
            data += self._status
        return data


def _status(reason: str, accepted: bool, health: int) -> bytes:
    names = health_names(health)
    code = next((_CODES.get(name, _UNKNOWN) for name in names), _WELL)
    text = join(" ", ("accepted" if accepted else message("not accepted"), *names))
    return igtl.status(code, health, reason[: igtl.LONGEST_NAME], text)


class _Client:
    """One connection, with what waits for it."""

    def __init__(self, opened: socket.socket) -> None:
        opened.setblocking(False)
        opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER)
        self._socket, self._pending = opened, bytearray()

    def offer(self, data: bytes) -> bool:
        """Take whole messages to send; False: too much waits already."""
        if len(self._pending) + len(data) > _MOST_PENDING:
            return False
        self._pending += data
        return True

    def push(self) -> bool:
        """Send what the system takes, and read what nobody needs; False: it has gone."""
        try:
            while self._pending:
                del self._pending[: self._socket.send(self._pending)]
        except BlockingIOError:
            pass
        except OSError:
            return False
        try:
            return self._socket.recv(_READ) != b""
        except BlockingIOError:
            return True
        except OSError:
            return False

    def close(self) -> None:
        """End it."""
        self._socket.close()
