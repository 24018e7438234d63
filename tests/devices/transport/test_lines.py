"""Real pseudo-terminals and loopback sockets."""

import contextlib
import errno
import os
import socket
import sys
import threading
import time
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from waiting import until

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.transport import (
    Line,
    LineError,
    LineLost,
    LineUnavailable,
    SerialLine,
    TcpLine,
    UdpLine,
    guess_device,
    line_to,
    list_ports,
)
from contactbench.pipeline.devices.transport.http_get import MOST_BYTES, PageError, _Page, http_get
from contactbench.pipeline.devices.url import DeviceAddress


@dataclass
class Pair:
    line: Line
    send: Callable[[bytes], object]
    receive: Callable[[], bytes]
    hang_up: Callable[[], object]


@pytest.fixture
def serial() -> Iterator[Pair]:
    master, slave = os.openpty()
    tty.setraw(slave)
    line = SerialLine(os.ttyname(slave), 115_200)
    opened = [master, slave]

    def hang_up() -> None:
        while opened:
            os.close(opened.pop())

    yield Pair(line, lambda data: os.write(master, data), lambda: os.read(master, 100), hang_up)
    line.close()
    hang_up()


@pytest.fixture
def tcp() -> Iterator[Pair]:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        line = TcpLine("127.0.0.1", listener.getsockname()[1])
        hosts: list[socket.socket] = []

        def host() -> socket.socket:
            if not hosts:
                hosts.append(listener.accept()[0])
            return hosts[0]

        yield Pair(line, lambda data: host().sendall(data), lambda: host().recv(100), lambda: host().close())
        line.close()
        for opened in hosts:
            opened.close()


@pytest.fixture
def pair(request: pytest.FixtureRequest) -> Pair:
    made: Pair = request.getfixturevalue(request.param)
    return made


def repeat(call: Callable[[], object]) -> None:
    """Call until it raises; what a line says when it breaks may come a little later."""
    until(lambda: bool(call()) and False, 5.0)


both = pytest.mark.parametrize("pair", ["serial", "tcp"], indirect=True)


@both
def test_bytes_go_both_ways(pair: Pair):
    pair.line.open()
    before = time.monotonic()
    pair.send(b"frame")
    chunk = pair.line.read(1.0)
    assert chunk.data == b"frame"
    assert before <= chunk.time <= time.monotonic()
    pair.line.write(b"command")
    assert pair.receive() == b"command"


@both
def test_a_silent_line_gives_nothing_in_time(pair: Pair):
    pair.line.open()
    for timeout in (0.0, 0.02):
        before = time.monotonic()
        assert pair.line.read(timeout).data == b""
        assert timeout - 0.005 <= time.monotonic() - before < 5


@both
def test_a_line_that_is_hung_up_is_lost(pair: Pair):
    pair.line.open()
    pair.send(b"half")
    assert pair.line.read(1.0).data == b"half"
    pair.hang_up()
    with pytest.raises(LineLost, match="lost"):
        repeat(lambda: pair.line.read(0.1))
    with pytest.raises(LineLost, match="not open"):
        pair.line.write(b"x")
    pair.line.close()


@both
def test_a_lost_line_is_noticed_by_writing(pair: Pair):
    pair.line.open()
    pair.send(b"x")
    pair.hang_up()
    with pytest.raises(LineLost):
        repeat(lambda: pair.line.write(b"command"))


@both
def test_an_open_line_can_be_opened_again(pair: Pair):
    pair.line.open()
    pair.line.open()
    pair.line.close()
    pair.line.close()
    with pytest.raises(LineLost, match="open it first"):
        pair.line.read(0.0)


def test_a_serial_line_is_for_one_only(serial: Pair):
    serial.line.open()
    other = SerialLine(serial.line.name, 115_200)
    with pytest.raises(LineUnavailable, match="another program is using it"):
        other.open()


def test_lines_that_are_not_there(tmp_path):
    with pytest.raises(LineUnavailable, match="plug in the device"):
        SerialLine(str(tmp_path / "none"), 115_200).open()
    (tmp_path / "file").touch()
    with pytest.raises(LineUnavailable, match="cannot be opened"):
        SerialLine(str(tmp_path / "file"), 115_200).open()
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    with pytest.raises(LineUnavailable, match="check that the device is on"):
        TcpLine("127.0.0.1", port).open()
    for kind in (TcpLine, UdpLine):
        with pytest.raises(LineUnavailable):
            kind("a" * 70 + ".invalid", port).open()


def test_a_datagram_is_one_chunk():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as device:
        device.bind(("127.0.0.1", 0))
        line = UdpLine("127.0.0.1", device.getsockname()[1])
        line.open()
        line.write(b"start")
        data, host = device.recvfrom(100)
        assert data == b"start"
        device.sendto(b"one", host)
        device.sendto(b"two", host)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            stranger.sendto(b"false", host)
        assert [line.read(0.5).data for _ in range(3)] == [b"one", b"two", b""]
    with pytest.raises(LineLost):  # now nobody is there, and the host says so
        repeat(lambda: line.write(b"start"))
    line.close()


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux counts them")
def test_what_this_computer_drops_is_counted_and_no_fault_of_the_device(monkeypatch):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        where = free.getsockname()
    line = UdpLine("127.0.0.1", 5, where[1])
    line.open()
    most = int(Path("/proc/sys/net/core/rmem_max").read_text(encoding="ascii"))
    assert line._socket.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF) == 2 * min(4 << 20, most)
    monkeypatch.setattr("contactbench.pipeline.devices.transport.sockets._ROOM", 2048)
    line.open()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as device:
        for _ in range(2):
            for number in range(50):
                device.sendto(bytes([number]), where)
            read = len(list(iter(lambda: line.read(0.0).data, b"")))
            assert 0 < read < 50
        device.sendto(b"x", where)
        assert line.read(5.0).data == b"x"
    assert line.dropped == 2 * (50 - read)
    assert f"dropped datagrams of the sensor, {line.dropped} so far" in line.troubles()["overrun"]
    line.close()


def test_only_the_first_sender_is_listened_to_until_it_is_silent(monkeypatch):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        where = free.getsockname()
    now = [100.0]
    monkeypatch.setattr("contactbench.pipeline.devices.transport.sockets.time.monotonic", lambda: now[0])
    line = UdpLine("127.0.0.1", 5, where[1])
    line.open()
    with (
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as first,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as second,
    ):
        first.sendto(b"1", where)
        assert line.read(5.0).data == b"1"
        second.sendto(b"2", where)
        assert line.read(5.0).data == b""
        assert line.foreign == 1
        assert (
            f"port {second.getsockname()[1]}. Only port {first.getsockname()[1]}"
            in line.troubles()["foreign"]
        )
        now[0] += 0.9
        first.sendto(b"1", where)
        assert line.read(5.0).data == b"1"
        now[0] += 1.1
        second.sendto(b"2", where)
        assert line.read(5.0).data == b"2"
        assert line.troubles() == {}
        line.open()
        first.sendto(b"1", where)
        assert line.read(5.0).data == b"1"
    line.close()


def test_an_address_leads_to_its_line():
    serial = line_to(DeviceAddress.parse("sri+serial:///dev/ttyUSB9?baud=9600&rate=10"))
    assert isinstance(serial, SerialLine)
    assert serial.name == "/dev/ttyUSB9"
    assert isinstance(line_to(DeviceAddress.parse("ur+tcp://h")), TcpLine)
    udp = line_to(DeviceAddress.parse("rdt+udp://h"))
    assert udp.datagrams
    assert udp.name == "h:49152"
    with pytest.raises(AddressError, match="no line"):
        line_to(DeviceAddress.parse("replay:///a.mcap"))


def test_ports_are_guessed_from_what_they_say(monkeypatch):
    assert guess_device("Bota Systems SensONE") == "bota"
    assert guess_device("ROBOTIQ FT300 Sensor") == "robotiq"
    assert guess_device("Sunrise Instruments M8128") == "sri"
    assert guess_device("FT232R USB UART") is None

    class Found:
        def __init__(self, device: str, description: str, product: str | None) -> None:
            self.device, self.description, self.product = device, description, product
            self.manufacturer, self.serial_number = None, "A1"

    monkeypatch.setattr(
        "serial.tools.list_ports.comports",
        lambda: [Found("/dev/ttyS0", "n/a", None), Found("/dev/ttyUSB1", "USB-RS485", "Robotiq FT300")],
    )
    first, second = list_ports()
    assert (first.path, first.guess, first.url) == (
        "/dev/ttyUSB1",
        "robotiq",
        "robotiq+serial:///dev/ttyUSB1",
    )
    assert (second.description, second.url) == ("no description", None)


def _both(host, port, *_, **kinds):
    if host != "twofold":
        raise OSError("no such host")
    type_ = kinds["type"]
    protocol = 6 if type_ == socket.SOCK_STREAM else 17
    return [
        (socket.AF_INET6, type_, protocol, "", ("::1", port, 0, 0)),
        (socket.AF_INET, type_, protocol, "", ("127.0.0.1", port)),
    ]


def test_a_name_with_two_addresses_is_tried_at_ipv4_first(monkeypatch):
    monkeypatch.setattr(socket, "getaddrinfo", _both)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        tcp = TcpLine("twofold", listener.getsockname()[1])
        tcp.open()
        tcp.close()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as device:
        device.bind(("127.0.0.1", 0))
        device.settimeout(1.0)
        udp = UdpLine("twofold", device.getsockname()[1])
        udp.open()
        udp.write(b"start")
        assert device.recv(100) == b"start"
        udp.open()  # the first one may be silent: the other one has its turn
        with contextlib.suppress(LineLost):
            udp.write(b"start")
        udp.open()
        udp.write(b"again")
        assert device.recv(100) == b"again"
        udp.close()


def test_a_name_of_ipv6_is_bracketed():
    assert TcpLine("fe80::1%eth0", 4008).name == "[fe80::1%eth0]:4008"
    assert UdpLine("box", 5).name == "box:5"


def test_a_pending_connection_can_be_interrupted(monkeypatch):
    def pending(*_):
        return errno.EINPROGRESS

    class Never(socket.socket):
        connect_ex = pending

    monkeypatch.setattr(socket, "socket", Never)
    asked = threading.Event()
    monkeypatch.setattr("select.select", lambda *_: (asked.set(), [], [])[1:] + ([],))
    line = TcpLine("127.0.0.1", 9)
    ended = []

    def connect():
        with pytest.raises(LineUnavailable, match="interrupted"):
            line.open()
        ended.append(True)

    thread = threading.Thread(target=connect)
    thread.start()
    assert asked.wait(10)
    assert not ended
    line.interrupt()
    thread.join(1.0)
    assert ended


def test_a_peer_that_vanishes_is_looked_after():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        line = TcpLine("127.0.0.1", listener.getsockname()[1])
        line.open()
        opened = line._socket
        assert opened.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE) == 1
        if hasattr(socket, "TCP_USER_TIMEOUT"):
            assert opened.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT) == 3000
        line.close()


# ---- A page from a small web server, and from servers that are not what they should be -----------


PAGE = b"<netft/>"


@contextmanager
def serving(*pieces, pause=0.0, close=True):
    """Answer one request with these bytes; gives the port and what was asked."""
    asked = []
    done = threading.Event()

    def answer():
        host, _ = listener.accept()
        with host:
            asked.append(host.recv(65_536))
            for piece in pieces:
                with suppress(OSError):  # it went away, as it may
                    host.sendall(piece)
                if done.wait(pause):
                    break
            if not close:
                done.wait(10)

    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = threading.Thread(target=answer, daemon=True)
        thread.start()
        try:
            yield listener.getsockname()[1], asked
        finally:
            done.set()
            thread.join()


def ok(body, *headers):
    return b"\r\n".join([b"HTTP/1.1 200 OK", *headers, b"", body])


def test_one_get_and_nothing_else():
    with serving(ok(PAGE)) as (port, asked):
        assert http_get("127.0.0.1", "/netftapi2.xml", port) == PAGE
    request = asked[0].decode()
    assert request.startswith("GET /netftapi2.xml HTTP/1.0\r\n")
    assert f"\r\nHost: 127.0.0.1:{port}\r\n" in request
    assert request.endswith("\r\n\r\n")
    assert len(asked) == 1


@pytest.mark.parametrize(
    "answer",
    [
        ok(PAGE, b"Content-Length: 8"),
        ok(PAGE, b"content-length:8", b"Server: x"),
        ok(b"3\r\n<ne\r\n5\r\ntft/>\r\n0\r\n\r\n", b"Transfer-Encoding: chunked"),
        b"HTTP/1.0 200\r\n\r\n" + PAGE,
    ],
)
def test_answers_of_different_servers(answer):
    with serving(answer) as (port, _):
        assert http_get("127.0.0.1", "/", port) == PAGE


def test_a_server_that_sends_bytes_one_by_one():
    with serving(*(bytes([byte]) for byte in ok(PAGE)), pause=0.001) as (port, _):
        assert http_get("127.0.0.1", "/", port) == PAGE


def test_a_server_that_does_not_close_is_not_waited_for():
    with serving(ok(PAGE, b"Content-Length: 8"), close=False) as (port, _):
        assert http_get("127.0.0.1", "/", port, timeout=5.0) == PAGE


def test_the_longest_page():
    with serving(ok(b"x" * MOST_BYTES)) as (port, _):
        assert len(http_get("127.0.0.1", "/", port)) == MOST_BYTES


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (b"HTTP/1.1 302 Found\r\nLocation: http://127.0.0.1:1/\r\n\r\n", "points elsewhere"),
        (b"HTTP/1.1 404 Not Found\r\n\r\n", "answers 404"),
        (b"HTTP/1.1 204 No Content\r\n\r\n", "answers 204"),
        (b"SSH-2.0-OpenSSH_9\r\n", "not HTTP"),
        (b"", "not HTTP"),
        (b"HTTP/1.1 200 OK\r\n" + b"A: b\r\n" * 200 + b"\r\n", "not HTTP"),
        (ok(b"x" * (MOST_BYTES + 1)), "longer than"),
        (ok(b"x" * 10_000_000, b"Content-Length: 10000000"), "longer than"),
        (ok(PAGE, b"Content-Length: 9"), "1 bytes of the answer are missing"),
        (ok(b"zz\r\n", b"Transfer-Encoding: chunked"), "not HTTP"),
    ],
)
def test_what_is_no_page_is_refused(answer, words):
    with serving(answer) as (port, _), pytest.raises(PageError, match=words):
        http_get("127.0.0.1", "/", port)


@pytest.mark.parametrize("trickle", [(), tuple(b"x" for _ in range(200))])
def test_a_slow_answer_ends_at_the_deadline(trickle):
    with (
        serving(b"HTTP/1.1 200 OK\r\n\r\n", *trickle, pause=0.05, close=False) as (port, _),
        pytest.raises(PageError, match=r"no complete answer within 0\.3 s"),
    ):
        http_get("127.0.0.1", "/", port, timeout=0.3)


def test_nobody_there():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    with pytest.raises(PageError, match="no connection") as caught:
        http_get("127.0.0.1", "/", port)
    assert isinstance(caught.value, LineError)


@pytest.mark.parametrize(
    ("host", "path", "port"),
    [
        ("a\r\nX: y", "/", 80),
        ("a", "/ HTTP/1.0\r\n\r\nPOST /", 80),
        ("a", "no-slash", 80),
        ("ä", "/", 80),
        ("a", "/", 0),
        ("a", "/", 70_000),
        ("", "/", 80),
        ("." * 300, "/", 80),
    ],
)
def test_impossible_addresses(host, path, port):
    with pytest.raises(PageError):
        http_get(host, path, port)


def test_ipv6_hosts_are_written_in_brackets():
    assert b"\r\nHost: [::1]\r\n" in _Page("::1", "/", 80).request()


@settings(max_examples=80, deadline=None)
@given(
    st.binary(max_size=300),
    st.sampled_from(
        [
            b"",
            b"HTTP/1.1 200 OK\r\n",
            ok(b""),
            ok(b"", b"Transfer-Encoding: chunked"),
            b"HTTP/1.1 100 C\r\n\r\n",
        ]
    ),
)
def test_any_answer_is_a_page_or_its_own_error(data, head):
    with suppress(PageError):
        assert len(_Page("host", "/", 80).body(head + data)) <= MOST_BYTES
