"""A broker that takes clients one after the other and notes what they publish, as MQTT 3.1.1 is specified."""

import socket
import struct
import threading
from contextlib import suppress
from typing import NamedTuple


class Published(NamedTuple):
    topic: str
    payload: bytes
    retained: bool
    quality: int


class Broker:
    """Listens on the loopback interface until it is closed; at `port`, or any free one. Says `hello` to clients."""

    def __init__(self, port: int = 0, hello: bytes = b"\x20\x02\x00\x00") -> None:
        self._hello = hello  # CONNACK
        self._listener = socket.create_server(("127.0.0.1", port))
        self.port: int = self._listener.getsockname()[1]
        self.heard: list[Published] = []
        self.will: Published | None = None
        self.connections = 0
        self.deaf = threading.Event()  # set: it takes no more bytes
        self._client: socket.socket | None = None
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def close(self) -> None:
        for opened in (self._listener, self._client):
            if opened is not None:
                with suppress(OSError):
                    opened.shutdown(socket.SHUT_RDWR)
                opened.close()
        self._thread.join()

    def of(self, topic: str) -> list[Published]:
        return [each for each in list(self.heard) if each.topic == topic]

    def _serve(self) -> None:
        try:
            while True:
                self._client, _ = self._listener.accept()
                self.connections += 1
                with self._client:
                    self._talk(self._client)
        except OSError:
            return  # it was closed

    def _talk(self, client: socket.socket) -> None:
        try:
            while not self.deaf.is_set():
                head = self._read(client, 1)[0]
                body = self._read(client, self._length(client))
                if head >> 4 == 1:  # CONNECT
                    self._take_will(body)
                    client.sendall(self._hello)
                elif head >> 4 == 3:  # PUBLISH
                    size = struct.unpack(">H", body[:2])[0]
                    topic, payload = body[2 : 2 + size].decode(), body[2 + size :]
                    self.heard.append(Published(topic, payload, bool(head & 1), head >> 1 & 3))
                elif head >> 4 == 12:  # PINGREQ
                    client.sendall(b"\xd0\x00")
                elif head >> 4 == 14:  # DISCONNECT
                    self.will = None
                    return
            self._wait_while_deaf(client)
        except (EOFError, OSError):
            if self.will is not None:
                self.heard.append(self.will)

    def _wait_while_deaf(self, client: socket.socket) -> None:
        while self.deaf.is_set():
            threading.Event().wait(0.01)
        client.close()

    def _take_will(self, body: bytes) -> None:
        flags, rest, fields = body[7], body[10:], []
        while rest:
            size = struct.unpack(">H", rest[:2])[0]
            fields.append(rest[2 : 2 + size])
            rest = rest[2 + size :]
        self.will = Published(fields[1].decode(), fields[2], bool(flags & 0x20), 0) if flags & 4 else None

    def _length(self, client: socket.socket) -> int:
        size, shift = 0, 0
        while True:
            byte = self._read(client, 1)[0]
            size |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return size

    @staticmethod
    def _read(client: socket.socket, count: int) -> bytes:
        data = b""
        while len(data) < count:
            piece = client.recv(count - len(data))
            if not piece:
                raise EOFError
            data += piece
        return data
