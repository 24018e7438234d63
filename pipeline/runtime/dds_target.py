"""Contacts for ROS 2 without ROS: two topics by DDS."""

from collections.abc import Sequence
from typing import Any

from cyclonedds.core import DDSException, Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from contactbench.pipeline.errors import RunError, arg, message
from contactbench.pipeline.runtime import dds_types as ros
from contactbench.pipeline.runtime.lines import Answer
from contactbench.pipeline.runtime.outlet import FRESH_S, OutletTarget, OutputContext

WRENCH, CONTACT = "rt/contactbench/wrench", "rt/contactbench/contact"
"""Topics; ROS calls them /contactbench/wrench and /contactbench/contact."""

_FRAME = "sensor"
_MOST_DOMAIN = 232  # beyond, the ports do not fit
_DEPTH = 10
# The loopback interface cannot multicast everywhere, so participants are looked for port by port.
_LOOPBACK = """
<CycloneDDS><Domain><General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>
"""


class DdsTarget(OutletTarget):
    """
    Wrenches as ``geometry_msgs/msg/WrenchStamped``, contacts as JSON in a ``std_msgs/msg/String``.

    They are named and encoded as in ROS 2; the JSON is `Answer.message`. Both are reliable, volatile and keep the last
    ten: what ROS offers by default, which fits reliable and best-effort subscribers. A subscriber that stops makes the
    writer wait for at most a millisecond, in the output's own thread.

    Parameters
    ----------
    domain : str
        A whole number, ROS_DOMAIN_ID.
    context : OutputContext
        With `remote`, DDS uses all interfaces, as CYCLONEDDS_URI says; else the loopback interface.

    Raises
    ------
    RunError
        It is no domain, or DDS does not start.
    """

    fresh = FRESH_S

    def __init__(self, domain: str, context: OutputContext) -> None:
        if not (domain.isascii() and domain.isdigit() and len(domain) <= 3 and int(domain) <= _MOST_DOMAIN):
            raise RunError(
                f"--dds {arg(domain)}: give the ROS domain, a whole number from 0 to {arg(_MOST_DOMAIN)}."
            )
        self.name, self._about = message(f"DDS domain {arg(domain)}"), context.about
        qos = Qos(
            Policy.Reliability.Reliable(max_blocking_time=duration(milliseconds=1)),
            Policy.Durability.Volatile,
            Policy.History.KeepLast(_DEPTH),
            Policy.DataRepresentation(use_cdrv0_representation=True),
        )
        try:
            self._domain = None if context.remote else Domain(int(domain), _LOOPBACK)
            self._participant: Any = DomainParticipant(int(domain))
            self._writers: Any = [
                DataWriter(self._participant, Topic(self._participant, name, kind, qos=qos), qos=qos)
                for name, kind in ((WRENCH, ros.WrenchStamped), (CONTACT, ros.String))
            ]
        except DDSException as error:
            raise RunError(
                f"--dds {arg(domain)}: DDS did not start ({arg(error.msg)}): check the network."
            ) from error

    def write(self, answers: Sequence[Answer]) -> int:
        """As `OutletTarget`."""
        written = 0
        for answer in answers:
            try:
                self._publish(answer, self._about.log_time(answer.time))
            except (ValueError, DDSException):  # its time is no time, or a subscriber holds up the writer
                continue
            written += 1
        return written

    def close(self) -> None:
        """As `OutletTarget`."""
        # Each is deleted with its last reference, and a writer refers to its topic and to the participant.
        self._writers = self._participant = self._domain = None

    def _publish(self, answer: Answer, stamp: int) -> None:
        contact = answer.contact
        if contact is None:
            return
        seconds, rest = divmod(stamp, 1_000_000_000)
        header = ros.Header(ros.Time(seconds, rest), _FRAME)
        to_wrench, to_contact = self._writers
        if contact.wrench is not None:
            fx, fy, fz, mx, my, mz = contact.wrench.tolist()
            wrench = ros.Wrench(ros.Vector3(fx, fy, fz), ros.Vector3(mx, my, mz))
            to_wrench.write(ros.WrenchStamped(header, wrench))
        to_contact.write(ros.String(answer.message(stamp).decode("ascii")))
