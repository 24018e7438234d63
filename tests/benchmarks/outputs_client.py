"""
A reader of one output, in a process of its own: notes the time stamp of each contact and when it came.

Started as ``python -m benchmarks.outputs_client OUTPUT ADDRESS FILE STARTED_NS CLOCK``: the last two are one moment as
Unix time and in the samples' clock, as the sender knows it. The first note, with time stamp 0, is when it began to
connect. It runs until it is killed.
"""

from __future__ import annotations

import json
import re
import socket
import struct
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contactbench.pipeline.recording import RecordingInfo

if TYPE_CHECKING:
    from collections.abc import Callable

    Note = Callable[[int], None]

RECEIVED_TYPE = np.dtype([("stamp", "<i8"), ("time", "<f8")])  # Unix time, ns; monotonic, s
_STAMP = re.compile(rb'"timestamp":\{"sec":(\d+),"nsec":(\d+)\}')
_TIME = re.compile(rb'"time":([0-9.e+-]+)')
_RETRY_S = 0.01


def _place(address: str) -> tuple[str, int]:
    host, _, port = address.rpartition(":")
    return host, int(port)


def _connected(address: str) -> socket.socket:
    while True:
        try:
            return socket.create_connection(_place(address))
        except ConnectionRefusedError:
            time.sleep(_RETRY_S)


def _stamp_in(payload: bytes) -> int:
    found = _STAMP.search(payload)
    return int(found[1]) * 10**9 + int(found[2]) if found else 0


def udp(address: str, note: Note, about: RecordingInfo) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(_place(address))
        note(0)
        while True:
            found = _TIME.search(listener.recv(65_536))
            if found:
                note(about.log_time(float(found[1])))  # a line has the samples' clock


def igtl(address: str, note: Note, _about: RecordingInfo) -> None:
    note(0)
    with _connected(address) as client:
        data = b""
        while piece := client.recv(65_536):
            data += piece
            while len(data) >= 58:
                _, kind, _, seconds, fraction, size, _ = struct.unpack(">H12s20sIIQQ", data[:58])
                if len(data) < 58 + size:
                    break
                data = data[58 + size :]
                if kind.startswith(b"SENSOR"):
                    note(seconds * 10**9 + (fraction * 10**9 >> 32))


def foxglove(address: str, note: Note, _about: RecordingInfo) -> None:
    from websockets.sync.client import connect

    note(0)
    _connected(address).close()
    spoken = ["foxglove.sdk.v1"]
    with connect(f"ws://{address}", subprotocols=spoken, max_size=None, compression=None) as client:
        contact = -1
        for data in client:
            if isinstance(data, str):
                for channel in json.loads(data).get("channels", ()):
                    if channel["topic"] == "/contact":
                        contact = channel["id"]
                        wanted = {"id": contact, "channelId": contact}
                        client.send(json.dumps({"op": "subscribe", "subscriptions": [wanted]}))
                continue
            code, channel, stamp = struct.unpack("<BIQ", data[:13])
            if code == 1 and channel == contact:
                note(stamp)


def dds(address: str, note: Note, _about: RecordingInfo) -> None:
    from cyclonedds.core import Policy, Qos
    from cyclonedds.domain import Domain, DomainParticipant
    from cyclonedds.sub import DataReader
    from cyclonedds.topic import Topic
    from cyclonedds.util import duration
    from runtime.dds_listener import CONFIG, String

    note(0)
    own = Domain(int(address), CONFIG)
    participant = DomainParticipant(int(address))
    qos = Qos(
        Policy.Reliability.Reliable(duration(seconds=1)),
        Policy.History.KeepLast(1000),
        Policy.DataRepresentation(use_cdrv0_representation=True),
    )
    contacts = DataReader(participant, Topic(participant, "rt/contactbench/contact", String), qos=qos)
    while True:
        for sample in contacts.take_iter(timeout=duration(seconds=1)):
            note(_stamp_in(sample.data.encode()))
    del own


def mqtt(address: str, note: Note, _about: RecordingInfo) -> None:
    from runtime.mqtt_broker import Broker, Published

    class Heard(list[Published]):
        def append(self, each: Published) -> None:
            if each.topic.endswith("/contact"):
                note(_stamp_in(each.payload))

    broker = Broker(_place(address)[1])
    broker.heard = Heard()
    note(0)
    while True:
        time.sleep(60)


def main(output: str, address: str, file: str, started_ns: str, clock: str) -> None:
    """Read until killed."""
    with Path(file).open("wb", buffering=0) as notes:
        {"udp": udp, "igtl": igtl, "foxglove": foxglove, "dds": dds, "mqtt": mqtt}[output](
            address,
            lambda stamp: notes.write(struct.pack("<qd", stamp, time.monotonic())) and None,
            RecordingInfo(int(started_ns), float(clock), ()),
        )


if __name__ == "__main__":
    main(*sys.argv[1:])
