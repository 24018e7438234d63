"""Contacts to an MQTT broker that comes, goes, and stops reading."""

from __future__ import annotations

import json
import socket
from contextlib import closing
from typing import TYPE_CHECKING

import pytest
from runtime.contacts import touching
from runtime.mqtt_broker import Broker
from runtime.runtime_recordings import CONTEXT
from waiting import until

from contactbench.pipeline.runtime import Outlet, RunError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from contactbench.pipeline.runtime.mqtt_target import MqttTarget

pytest.importorskip("paho")


@pytest.fixture
def broker() -> Iterator[Broker]:
    with closing(Broker()) as made:
        yield made


def target_at(port: int) -> MqttTarget:
    from contactbench.pipeline.runtime.mqtt_target import MqttTarget

    return MqttTarget(f"127.0.0.1:{port}/bench/one", CONTEXT)


def test_contacts_go_out_and_health_stays(broker: Broker) -> None:
    given = touching(3, free=2)
    with closing(target_at(broker.port)) as target:
        until(target._fresh.is_set)
        opened = target._client.socket()
        assert opened is not None
        assert opened.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)  # else a contact waits for 40 ms
        assert target.write(given) == 5
        until(lambda: len(broker.of("bench/one/contact")) == 5)
    for told, answer in zip(broker.of("bench/one/contact"), given, strict=True):
        assert (told.retained, told.quality) == (False, 0)
        assert told.payload == answer.message(CONTEXT.about.log_time(answer.time))
    until(lambda: len(broker.of("bench/one/health")) == 2)
    first, last = broker.of("bench/one/health")
    assert json.loads(first.payload) == {"state": "online", "health": [], "time": given[0].time}
    assert json.loads(last.payload) == {"state": "offline"}
    assert first.retained
    assert last.retained


def test_a_broker_that_comes_back_gets_contacts_again() -> None:
    first = Broker()
    with closing(target_at(first.port)) as target:
        until(target._fresh.is_set)
        given = touching(1)
        assert target.write(given) == 1
        until(lambda: first.of("bench/one/contact"))
        first.close()
        until(lambda: not target._client.is_connected())
        assert target.write(given) == 0  # lost, and said so
        with closing(Broker(first.port)) as second:
            until(lambda: target.write(given))
            until(lambda: second.of("bench/one/contact"))
            assert [json.loads(each.payload)["state"] for each in second.of("bench/one/health")] == ["online"]


def test_one_that_stops_reading_fills_no_memory(broker: Broker) -> None:
    with closing(target_at(broker.port)) as target:
        until(target._fresh.is_set)
        given = touching(1)
        assert target.write(given) == 1
        broker.deaf.set()
        assert sum(target.write(given) for _ in range(20_000)) < 20_000
        assert target._sent - target._gone <= 1_001
        broker.deaf.clear()


@pytest.mark.parametrize(
    ("hello", "says"),
    [
        (b"\x20\x02\x00\x05", "refused the connection (Not authorized)"),
        (b"\x20\x02\x00\x03", "refused the connection (Server unavailable)"),
        (b"\x20\x02\x00\x63", "refused the connection (Unspecified error)"),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", "no MQTT broker answers there"),
        (b"\x20\x01\x00", "no MQTT broker answers there"),
    ],
)
def test_a_broker_that_will_not_is_told(hello: bytes, says: str) -> None:
    with closing(Broker(hello=hello)) as broker:
        target = target_at(broker.port)
        outlet = Outlet(target)
        outlet.start()
        until(lambda: says in outlet.trouble)
        until(lambda: broker.will is not None)  # the client has gone
        assert not target._fresh.is_set()
        outlet.put(*touching(1))
        outlet.close()
    assert (outlet.published, outlet.lost) == (0, 1)
    assert outlet.failed.is_set()
    assert says in str(outlet.error)


def test_why_nothing_goes_out_is_told_until_it_does() -> None:
    with closing(Broker()) as broker:
        port = broker.port
    with closing(target_at(port)) as target:
        assert "has not answered yet" in target.trouble or "nothing accepts" in target.trouble
        until(lambda: "nothing accepts a connection there" in target.trouble)
        with closing(Broker(port)):
            until(target._fresh.is_set)
            assert target.trouble == ""
        until(lambda: target.trouble != "")
        assert "broke" in target.trouble or "nothing accepts" in target.trouble


def test_the_end_is_quick_without_a_broker() -> None:
    with closing(Broker()) as broker:
        port = broker.port
    target = target_at(port)
    assert target.write(touching(1)) == 0
    target.close()


@pytest.mark.parametrize(
    ("address", "says"),
    [
        ("127.0.0.1:1883", "topic"),
        ("127.0.0.1:1883/", "topic"),
        ("127.0.0.1:1883/a/#", "topic"),
        ("127.0.0.1:1883/a\0b", "topic"),
        ("127.0.0.1/bench", "give a host and a port"),
        ("127.0.0.1:0/bench", "give a host and a port"),
        ("192.0.2.1:1883/bench", "--allow-remote"),
    ],
)
def test_addresses(address: str, says: str) -> None:
    from contactbench.pipeline.runtime.mqtt_target import MqttTarget

    with pytest.raises(RunError, match=says):
        MqttTarget(address, CONTEXT)
