"""OpenIGTLink's server, heard by an independent client and by a plain socket."""

import socket
import struct
from collections.abc import Iterator
from contextlib import closing
from itertools import groupby

import numpy as np
import pytest
from runtime.contacts import touch, touching
from runtime.runtime_recordings import ABOUT, CONTEXT, REMOTE
from waiting import until

from contactbench.pipeline.devices.protocols import igtl
from contactbench.pipeline.devices.protocols.checksums import crc64_ecma
from contactbench.pipeline.runtime import Outlet, RunError
from contactbench.pipeline.runtime.contact_frame import contact_frame
from contactbench.pipeline.runtime.igtl_target import FRAME, STATUS, WRENCH, IgtlTarget


@pytest.fixture
def target() -> Iterator[IgtlTarget]:
    made = IgtlTarget("127.0.0.1:0", CONTEXT)
    yield made
    made.close()


def connected(target: IgtlTarget, room: int | None = None) -> socket.socket:
    client = socket.socket()
    if room is not None:
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, room)
    client.settimeout(10)
    client.connect(("127.0.0.1", target.port))
    target.flush()
    return client


def messages(data: bytes) -> list[tuple[str, str, int, bytes]]:
    """Return kind, device, Unix time in ns and body of messages that are whole, by the specification's table."""
    found = []
    while data:
        version, kind, device, seconds, fraction, size, crc = struct.unpack(">H12s20sIIQQ", data[:58])
        body, data = data[58 : 58 + size], data[58 + size :]
        assert version == 1
        assert len(body) == size
        assert crc64_ecma(body) == crc
        stamp = seconds * 10**9 + (fraction * 10**9 >> 32)
        found.append((kind.rstrip(b"\0").decode(), device.rstrip(b"\0").decode(), stamp, body))
    return found


def heard(client: socket.socket, target: IgtlTarget) -> bytes:
    """Return all that the target has sent, once it has closed."""
    target.close()
    data = b""
    while piece := client.recv(65_536):
        data += piece
    return data


class TestClients:
    def test_an_independent_client_gets_the_contact_frame(self) -> None:
        pyigtl = pytest.importorskip("pyigtl")
        target = IgtlTarget("127.0.0.1:0", CONTEXT)
        outlet = Outlet(target)
        client = pyigtl.OpenIGTLinkClient(port=target.port, start_now=False)
        outlet.start()
        client.start()
        given = touching(20)
        with closing(outlet):
            until(client.is_connected)
            outlet.put(given[-1])
            message = client.wait_for_message(FRAME, timeout=20)
            client.stop()
        assert message is not None
        contact = given[-1].contact
        assert contact is not None
        assert contact.point is not None
        point, normal, _ = touch()
        assert message.matrix[:3, 3] == pytest.approx(1e3 * contact.point, abs=1e-3)
        assert message.matrix[:3, 3] == pytest.approx(1e3 * point, abs=1.0)
        assert message.matrix[:3, 2] == pytest.approx(normal, abs=1e-6)
        assert message.matrix[:3, :3] == pytest.approx(contact_frame(normal), abs=1e-6)
        assert message.timestamp == pytest.approx(1e-9 * ABOUT.log_time(given[-1].time), abs=1e-6)

    def test_wrench_and_health_go_along(self, target: IgtlTarget) -> None:
        with connected(target) as client:
            given = touching(3, free=2)
            assert target.write(given) == 5
            got = messages(heard(client, target))
        wrenches = [each for each in got if each[:2] == ("SENSOR", WRENCH)]
        last = given[-1].contact
        assert last is not None
        assert last.wrench is not None
        count, _, unit = struct.unpack(">BBQ", wrenches[-1][3][:10])
        assert (count, unit) == (6, 0)
        assert struct.unpack(">6d", wrenches[-1][3][10:]) == tuple(last.wrench.tolist())
        assert abs(wrenches[-1][2] - ABOUT.log_time(last.time)) <= 1
        assert [each[:2] for each in got].count(("TRANSFORM", FRAME)) == 3
        said = [struct.unpack(">Hq20s", each[3][:30]) + (each[3][30:],) for each in got if each[1] == STATUS]
        heard_of = [(code, sub, name.rstrip(b"\0").decode(), text) for code, sub, name, text in said]
        reasons = [reason for reason, _ in groupby(given[2:], lambda answer: answer.reason)]
        assert heard_of == [
            (1, 0, "low_force", b"not accepted\0"),
            *((1, 0, reason, b"accepted\0") for reason in reasons),
        ]

    def test_a_new_client_hears_the_health_at_once(self, target: IgtlTarget) -> None:
        target.write(touching(1))
        with connected(target) as client:
            (said,) = messages(heard(client, target))
        assert said[:2] == ("STATUS", STATUS)

    def test_one_that_does_not_read_costs_the_others_nothing(self, target: IgtlTarget) -> None:
        given = touching(1) * 5_000  # a megabyte: more than what may wait, and what the system holds
        with connected(target, 4_096) as slow, connected(target) as quick:
            quick.setblocking(False)
            published, got = 0, 0
            for begin in range(0, len(given), 100):
                published += target.write(given[begin : begin + 100])
                try:
                    while piece := quick.recv(1 << 20):
                        got += len(piece)
                except BlockingIOError:
                    pass
            size = len(igtl.pack("SENSOR", WRENCH, 0, bytes(58))) + len(
                igtl.pack("TRANSFORM", FRAME, 0, bytes(48))
            )
            assert got > 0.95 * len(given) * size
            assert 0 < published < len(given)  # said as lost: one of them did not get them
            slow.close()
            target.flush()
            assert target.write(given[:10]) == 10

    def test_one_that_resets_its_connection_is_forgotten(self, target: IgtlTarget) -> None:
        client = connected(target)
        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        client.close()
        given = touching(1)
        assert [target.write(given) for _ in range(3)] == [1, 1, 1]
        with connected(target) as another:
            assert another.recv(58)[2:8] == b"STATUS"


class TestAddresses:
    @pytest.mark.parametrize("address", ["127.0.0.1", "127.0.0.1:x", ":1", "127.0.0.1:99999"])
    def test_no_address(self, address: str) -> None:
        with pytest.raises(RunError, match="--igtl"):
            IgtlTarget(address, CONTEXT)

    def test_others_listen_only_with_leave(self) -> None:
        with pytest.raises(RunError, match="--allow-remote"):
            IgtlTarget("0.0.0.0:0", CONTEXT)
        IgtlTarget("0.0.0.0:0", REMOTE).close()

    def test_one_in_use_is_said(self, target: IgtlTarget) -> None:
        with pytest.raises(RunError, match="choose another port"):
            IgtlTarget(f"127.0.0.1:{target.port}", CONTEXT)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (-0.95, 0.1, 0.2), (0.3, -0.5, 0.7)])
def test_the_contact_frame_is_right_handed_with_z_along_the_normal(normal: tuple[float, ...]) -> None:
    unit = np.array(normal) / np.linalg.norm(normal)
    R_SC = contact_frame(unit)
    assert pytest.approx(np.eye(3), abs=1e-12) == R_SC.T @ R_SC
    assert np.linalg.det(R_SC) == pytest.approx(1.0)
    assert R_SC[:, 2] == pytest.approx(unit)
    assert R_SC[0, 0] > 0.4 or abs(unit[0]) > 0.9
