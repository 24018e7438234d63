"""A page from a small web server, and from servers that are not what they should be."""

from __future__ import annotations

import socket
import threading
from contextlib import contextmanager, suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from contactbench.pipeline.devices.transport import LineError
from contactbench.pipeline.devices.transport.http_get import MOST_BYTES, PageError, _Page, http_get

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
