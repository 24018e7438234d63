"""Foxglove's server, heard by an independent WebSocket client."""

from __future__ import annotations

import json
import struct
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import pytest
from config.runtime.bundles import example
from runtime.contacts import touching
from runtime.runtime_recordings import ABOUT, CONTEXT
from waiting import until

from contactbench.pipeline.runtime import RunError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    from contactbench.pipeline.runtime.foxglove_target import FoxgloveTarget

pytest.importorskip("foxglove")
connect = pytest.importorskip("websockets.sync.client").connect


@pytest.fixture
def target() -> Iterator[FoxgloveTarget]:
    from contactbench.pipeline.runtime.foxglove_target import FoxgloveTarget

    made = FoxgloveTarget("127.0.0.1:0", CONTEXT)
    yield made
    made.close()


class Listener:
    """A client that subscribes to every topic."""

    def __init__(self, port: int) -> None:
        where, spoken = f"ws://127.0.0.1:{port}", ["foxglove.sdk.v1"]
        self._connection = connect(where, subprotocols=spoken, max_size=None, close_timeout=0.1)

    def __exit__(self, *raised: object) -> None:
        self._connection.__exit__(*raised)

    def __enter__(self) -> Self:
        self.socket = self._connection.__enter__()
        self.channels: dict[int, dict[str, Any]] = {}
        while len(self.channels) < 4:
            told = json.loads(self.socket.recv(timeout=10))
            if told["op"] == "advertise":
                self.channels |= {channel["id"]: channel for channel in told["channels"]}
        wanted = [{"id": each, "channelId": each} for each in self.channels]
        self.socket.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))
        return self

    def next(self, patience: float = 10.0) -> tuple[str, int, bytes]:
        """Return topic, time in ns and payload of the next message."""
        while isinstance(data := self.socket.recv(timeout=patience), str):
            pass
        opcode, channel, stamp = struct.unpack("<BIQ", data[:13])
        assert opcode == 1
        return self.channels[channel]["topic"], stamp, data[13:]

    def until(self, topic: str, holds: bytes = b"") -> bytes:
        """Return the next message of a topic that holds something."""
        while True:
            found, _, payload = self.next()
            if found == topic and holds in payload:
                return payload


@pytest.fixture
def client(target: FoxgloveTarget) -> Iterator[Listener]:
    with Listener(target.port) as listener:
        # The first topic's subscription is news already: what is written now would not go to those after it.
        topics = (target._contact, target._wrench, target._scene, target._health)
        until(lambda: all(each.has_sinks() for each in topics))
        assert target._subscribed.news.wait(20)
        yield listener


def test_contact_wrench_picture_and_health_arrive(target: FoxgloveTarget, client: Listener) -> None:
    given = touching(2, free=1)
    target.write(given)
    last = given[-1]
    assert last.contact is not None
    assert last.contact.wrench is not None
    assert last.contact.point is not None
    got: dict[str, list[tuple[int, bytes]]] = {}
    most = {"/contact": 3, "/wrench": 3, "/scene": 2, "/health": 1}
    while any(len(got.get(topic, ())) < count for topic, count in most.items()):
        topic, stamp, payload = client.next()
        got.setdefault(topic, []).append((stamp, payload))
    stamp, contact = got["/contact"][-1]
    assert stamp == ABOUT.log_time(last.time)
    assert contact == last.message(stamp)
    wrench = json.loads(got["/wrench"][-1][1])
    assert [*wrench["force"].values(), *wrench["torque"].values()] == last.contact.wrench.tolist()
    schemas = {each["topic"]: each["schemaName"] for each in client.channels.values()}
    assert schemas == {
        "/contact": "contactbench.Contact",
        "/wrench": "contactbench.Wrench",
        "/scene": "foxglove.SceneUpdate",
        "/health": "foxglove.Log",
    }
    probe = example().probe
    surface = next(payload for _, payload in got["/scene"] if b"probe" in payload)
    # Protobuf leaves out zeros.
    assert all(struct.pack("<d", x) in surface for x in probe.vertices.ravel().tolist() if x)
    first = given[1].contact
    assert first is not None
    assert first.point is not None
    arrow = next(payload for _, payload in got["/scene"] if b"contact" in payload)
    assert all(struct.pack("<d", x) in arrow for x in first.point.tolist() if x)  # the ellipsoid's middle
    assert b"low_force: not accepted" in got["/health"][0][1]


def test_a_contact_that_is_over_leaves_the_picture(target: FoxgloveTarget, client: Listener) -> None:
    free, touched = touching(1, free=1)
    target.write([touched])
    client.until("/scene", b"contact")
    target.write([free])
    assert len(client.until("/scene", b"contact")) < 40  # nothing but its name


def test_whoever_comes_later_gets_the_probe_too(target: FoxgloveTarget) -> None:
    def heard() -> bool:
        target.flush()  # again and again, as `run` does: one topic's subscription is news before that of the others
        with suppress(TimeoutError):
            topic, _, payload = client.next(0.05)
            return topic == "/scene" and b"probe" in payload
        return False

    for _ in range(2):
        with Listener(target.port) as client:
            until(heard)


def test_one_that_does_not_read_costs_nothing(target: FoxgloveTarget) -> None:
    given = touching(1) * 3_000
    with Listener(target.port), Listener(target.port) as quick:
        assert target._subscribed.news.wait(20)
        assert target.write(given) == len(given)
        assert json.loads(quick.until("/contact"))["accepted"]


def test_addresses(target: FoxgloveTarget) -> None:
    from contactbench.pipeline.runtime.foxglove_target import FoxgloveTarget

    for address, says in (
        ("127.0.0.1", "give a host and a port"),
        ("0.0.0.0:0", "--allow-remote"),
        (f"127.0.0.1:{target.port}", "choose another port"),
    ):
        with pytest.raises(RunError, match=says):
            FoxgloveTarget(address, CONTEXT)
