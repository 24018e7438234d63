"""The other side of the ROS node, on real ROS 2: it publishes wrenches and poses, and hears what the node says."""

from __future__ import annotations

import os
import signal
import subprocess
from collections import defaultdict
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import rclpy
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, WrenchStamped
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.experimental import EventsExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Header, String
from terminal import command
from visualization_msgs.msg import MarkerArray
from waiting import until

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from typing import Self

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
PLENTY = 10_000
# A pose that is published once; readings that are not lost.
STILL = ("static_pose:=true", "qos_overrides./wrench.subscription.reliability:=reliable")
DOMAIN = 100 + os.getpid() % 100  # two runs on one machine must not hear each other


class Peer:
    """A node of ROS in this process, beside `ContactNode` in another; used in a ``with`` statement."""

    def __init__(self, *arguments: str, name: str = "peer", **options: Any) -> None:
        os.environ |= {"ROS_DOMAIN_ID": str(DOMAIN), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
        self._context = rclpy.Context()
        rclpy.init(args=[name, *arguments], context=self._context, domain_id=DOMAIN)
        self.node = rclpy.create_node(name, context=self._context, **options)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self.node)
        self.heard: defaultdict[str, list[Any]] = defaultdict(list)
        self.wrenches = self.node.create_publisher(WrenchStamped, "wrench", PLENTY)
        self.listen("/diagnostics", DiagnosticArray)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.try_shutdown()

    def listen(
        self, topic: str, kind: type, qos: Any = PLENTY, take: Callable[[Any], None] | None = None
    ) -> Any:
        """Hear a topic into `heard`, or into `take`; returns the subscription."""
        return self.node.create_subscription(kind, topic, take or self.heard[topic].append, qos)

    def listen_to_all(self) -> None:
        """Hear all that the node says."""
        for topic, kind in (("wrench", WrenchStamped), ("contact", PoseWithCovarianceStamped)):
            self.listen(f"/contactbench/{topic}", kind)
        self.listen("/contactbench/reason", String, LATCHED)
        self.listen("/contactbench/markers", MarkerArray)

    @property
    def reasons(self) -> list[str]:
        """The reasons so far."""
        return [each.data for each in self.heard["/contactbench/reason"]]

    def until(self, holds: Callable[[], Any]) -> Any:
        """Let ROS work until that is true; returns it."""
        return until(lambda: self.spin() or holds())

    def spin(self, seconds: float = 0.01) -> None:
        """Let ROS work until something happens."""
        self._executor.spin_once(timeout_sec=seconds)

    def call(self, kind: type, service: str, **fields: Any) -> Any:
        """Call a service of the node; returns its answer."""
        client = self.node.create_client(kind, f"/contactbench/{service}")
        self.until(client.service_is_ready)
        request = kind.Request()  # type: ignore[attr-defined]
        for name, value in fields.items():
            setattr(request, name, value)
        future = client.call_async(request)
        self.until(future.done)
        self.node.destroy_client(client)
        return future.result()

    def change(self, label: str) -> bool:
        """Ask for a transition; returns whether it succeeded."""
        request = ChangeState.Request()
        request.transition.label = label
        return bool(self.call(ChangeState, "change_state", transition=request.transition).success)

    def state(self) -> str:
        """Return the node's state."""
        return str(self.call(GetState, "get_state").current_state.label)

    def fact(self, name: str) -> str:
        """Return what the newest diagnostics say of it; empty: there are none."""
        last = self.heard["/diagnostics"][-1:]
        return next((each.value for told in last for each in told.status[0].values if each.key == name), "")

    @property
    def trouble(self) -> str:
        """What the newest diagnostics say is wrong."""
        return "".join(told.status[0].message for told in self.heard["/diagnostics"][-1:])

    def meet(self) -> None:
        """Wait until the node knows a pose, and hears the wrenches."""
        self.until(self.wrenches.get_subscription_count)
        self.until(lambda: self.fact("poses").startswith("with"))

    def pushed(self, stamp: Any, reading: Sequence[float], frame: str = "ft") -> None:
        """Publish a reading Fx, Fy, Fz, Mx, My, Mz."""
        told = WrenchStamped(header=Header(stamp=stamp, frame_id=frame))
        force, torque = told.wrench.force, told.wrench.torque
        force.x, force.y, force.z, torque.x, torque.y, torque.z = map(float, reading)
        self.wrenches.publish(told)

    def push_all(self, given: Any) -> None:
        """Publish readings (n, 6), 1 ms from one to the next, the last one of now."""
        end = self.node.get_clock().now().nanoseconds
        for behind, reading in zip(range(len(given) - 1, -1, -1), given, strict=True):
            seconds, rest = divmod(end - 1_000_000 * behind, 10**9)
            self.pushed(Time(sec=seconds, nanosec=rest), reading)

    def held(self, qos: Any = LATCHED, frame: str = "base") -> Any:
        """Publish, once, a flange that is turned in no way; returns the publisher, with which the pose goes."""
        publisher = self.node.create_publisher(PoseStamped, "pose", qos)
        told = PoseStamped(header=Header(stamp=self.node.get_clock().now().to_msg(), frame_id=frame))
        told.pose.orientation.w = 1.0
        publisher.publish(told)
        return publisher


@contextmanager
def start(bundle: object, *parameters: str, managed: bool = False) -> Iterator[subprocess.Popen[str]]:
    """Run the node in a process of its own, with parameters ``name:=value``, and end it by a signal."""
    given = [word for each in parameters for word in ("-p", each)]
    words = command("ros", bundle, *["--managed"][:managed], "--", "--ros-args", *given)
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.send_signal(signal.SIGINT)
            process.wait(30)
