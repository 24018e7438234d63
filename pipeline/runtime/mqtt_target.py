"""Contacts to an MQTT broker."""

import json
import socket
import threading
from collections.abc import Sequence
from typing import Any

from paho.mqtt.client import Client
from paho.mqtt.enums import CallbackAPIVersion, MQTTErrorCode
from paho.mqtt.reasoncodes import ReasonCode

from contactbench.pipeline.errors import RunError, arg, message
from contactbench.pipeline.runtime.lines import Answer, health_names
from contactbench.pipeline.runtime.outlet import FRESH_S, OutletTarget, OutputContext, resolve

_KEEP_ALIVE_S = 10
_RETRY_S = (1, 5)  # the shortest and longest wait before it connects again
_MOST_WAITING = 1_000  # messages: a second at 1 kHz
_LONGEST_TOPIC = 200


class MqttTarget(OutletTarget):
    """
    ``TOPIC/contact``: every contact as JSON. ``TOPIC/health``: what is wrong, retained, when it changes.

    All with quality of service 0: what is not delivered is not sent again. Without a connection contacts are lost and
    counted, and a new one is tried every few seconds. When the connection ends, the broker says ``offline`` as health.

    Parameters
    ----------
    address : str
        HOST:PORT/TOPIC; the topic may have levels.
    context : OutputContext

    Raises
    ------
    RunError
        It is no address, or on another machine without leave.
    """

    fresh = FRESH_S

    def __init__(self, address: str, context: OutputContext) -> None:
        where, _, topic = address.partition("/")
        place = resolve("--mqtt", where, socket.SOCK_STREAM, remote=context.remote)
        if not topic.isprintable() or not 0 < len(topic) <= _LONGEST_TOPIC or set(topic) & {"+", "#"}:
            raise RunError(
                f"--mqtt {arg(address)}: give a topic after the port, such as 127.0.0.1:1883/bench."
            )
        self.name, self._about = f"MQTT {address}", context.about
        self.trouble = message(f"{arg(self.name)}: the broker has not answered yet: check that it runs.")
        self._refused = False  # the last connection
        self._contact, self._health = f"{topic}/contact", f"{topic}/health"
        self._said: int | None = None
        self._fresh = threading.Event()  # it has connected
        self._sent = self._gone = 0  # messages given to the client; those that are out, counted in its thread
        self._client = Client(CallbackAPIVersion.VERSION2)
        self._client.on_connect = self._connected
        self._client.on_connect_fail = self._unreachable
        self._client.on_disconnect = self._disconnected
        self._client.on_publish = self._published
        self._client.on_socket_open = _send_at_once
        self._client.will_set(self._health, json.dumps({"state": "offline"}), retain=True)
        self._client.reconnect_delay_set(*_RETRY_S)
        self._client.connect_async(place.host, place.port, _KEEP_ALIVE_S)
        self._client.loop_start()

    def write(self, answers: Sequence[Answer]) -> int:
        """As `OutletTarget`: what does not go to the broker at once is not published."""
        return sum(map(self._publish, answers))

    def close(self) -> None:
        """As `OutletTarget`."""
        if self._client.is_connected():
            self._client.publish(self._health, json.dumps({"state": "offline"}), retain=True)
        self._client.disconnect()
        self._client.loop_stop()

    def _publish(self, answer: Answer) -> bool:
        if self._fresh.is_set():
            self._fresh.clear()
            self._sent, self._said = self._gone, None  # what waited for the last connection has gone with it
        if not self._client.is_connected() or self._sent - self._gone >= _MOST_WAITING:
            return False
        try:
            stamp = self._about.log_time(answer.time)
        except ValueError:  # its time is no time
            return False
        if answer.health != self._said:
            health = {"state": "online", "health": health_names(answer.health), "time": answer.time}
            if self._send(self._health, json.dumps(health).encode(), retain=True):
                self._said = answer.health
        return self._send(self._contact, answer.message(stamp))

    def _send(self, topic: str, payload: bytes, *, retain: bool = False) -> bool:
        self._sent += 1
        return self._client.publish(topic, payload, retain=retain).rc == MQTTErrorCode.MQTT_ERR_SUCCESS

    def _connected(self, _client: Client, _data: Any, _flags: Any, code: ReasonCode, _more: Any) -> None:
        self._refused = code.is_failure
        if code.is_failure:
            self.trouble = message(
                f"{arg(self.name)}: the broker refused the connection ({arg(code)}): check its settings."
                " Passwords are not supported."
            )
        else:
            self.trouble = ""
            self._fresh.set()

    def _unreachable(self, *_: Any) -> None:
        self.trouble = message(
            f"{arg(self.name)}: nothing accepts a connection there: start the broker, or check host and port."
        )

    def _disconnected(self, _client: Client, _data: Any, _flags: Any, code: ReasonCode, _more: Any) -> None:
        if not code.is_failure or self._refused:  # this side ended it, or the reason is known
            return
        if self.trouble:
            self.trouble = message(
                f"{arg(self.name)}: no MQTT broker answers there: the connection ended at once."
                " Check host and port."
            )
        else:
            self.trouble = message(
                f"{arg(self.name)}: the connection to the broker broke; it is tried again."
            )

    def _published(self, *_: Any) -> None:
        self._gone += 1


def _send_at_once(_client: Client, _data: Any, opened: Any) -> None:
    """Let no message wait for the broker's acknowledgement of the one before: that takes up to 40 ms."""
    opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
