"""
A second participant, in a process of its own, with types of its own as ROS 2 has them: prints what it hears as JSON.

Started as ``python dds_listener.py DOMAIN COUNT [SECONDS]``: it says ``ready`` when both writers are found, and ends
after COUNT contacts.
"""

import json
import sys
import threading
import time
from dataclasses import asdict, dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import float64, int32, uint32
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

# What `ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST` makes of rmw_cyclonedds.
CONFIG = """<CycloneDDS><Domain><General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers><Peer Address="localhost"/></Peers></Discovery>
</Domain></CycloneDDS>"""


@dataclass
class Stamp(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Stamp
    frame_id: str


@dataclass
class Three(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):
    x: float64
    y: float64
    z: float64


@dataclass
class Wrench(IdlStruct, typename="geometry_msgs::msg::dds_::Wrench_"):
    force: Three
    torque: Three


@dataclass
class WrenchStamped(IdlStruct, typename="geometry_msgs::msg::dds_::WrenchStamped_"):
    header: Header
    wrench: Wrench


@dataclass
class String(IdlStruct, typename="std_msgs::msg::dds_::String_"):
    data: str


def main(domain: int, count: int, seconds: float = 60.0) -> None:
    own = Domain(domain, CONFIG)
    participant = DomainParticipant(domain)
    # rclpy's default: reliable, volatile, keep last; and rosbag's for sensors: best effort.
    reliable = Qos(
        Policy.Reliability.Reliable(duration(seconds=1)),
        Policy.History.KeepLast(1000),
        Policy.DataRepresentation(use_cdrv0_representation=True),
    )
    loose = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(1000))
    contacts = DataReader(participant, Topic(participant, "rt/contactbench/contact", String), qos=reliable)
    wrenches = DataReader(participant, Topic(participant, "rt/contactbench/wrench", WrenchStamped), qos=loose)
    end = time.monotonic() + seconds
    while not (contacts.get_matched_publications() and wrenches.get_matched_publications()):
        assert time.monotonic() < end, "no writers found"
        threading.Event().wait(0.005)
    say("ready")
    for heard, sample in enumerate(contacts.take_iter(timeout=duration(seconds=seconds)), 1):
        say(json.dumps({"contact": json.loads(sample.data), "at": time.time()}))
        if heard == count:
            break
    for sample in wrenches.take(N=1000):
        say(json.dumps({"wrench": asdict(sample)}))
    del contacts, wrenches, participant, own


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), *map(float, sys.argv[3:]))
