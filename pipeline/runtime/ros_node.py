"""The runtime as a lifecycle node of ROS 2: raw wrenches and poses in; contacts, markers and diagnostics out."""

import math
import os
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import (
    Point,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    TransformStamped,
    Vector3,
    WrenchStamped,
)
from numpy.typing import NDArray
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.exceptions import ParameterException
from rclpy.experimental import EventsExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_policy_name_from_kind
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.signals import SignalHandlerOptions
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import JointState
from std_msgs.msg import Header, String
from visualization_msgs.msg import Marker, MarkerArray

from contactbench.pipeline.config.runtime import RuntimeConfig
from contactbench.pipeline.console import ended_by_signals
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.errors import InputError, RunError, arg
from contactbench.pipeline.recording.ros2_poses import joint_pose, pose
from contactbench.pipeline.robot import Robot
from contactbench.pipeline.runtime.contact_frame import contact_frame
from contactbench.pipeline.runtime.lines import Answer, health_names
from contactbench.pipeline.runtime.run import (
    Run,
    check_runnable,
    motion_warning,
    rate_warning,
    responsive,
    sensor_name,
    zero_words,
)

_SECOND = 1_000  # messages: what waits while a computer is busy is late, not lost
_THROTTLE_S = 5.0
_SAMPLES = QoSProfile(depth=_SECOND, reliability=ReliabilityPolicy.BEST_EFFORT)
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_LOOK_S, _DIAGNOSE_S, _MARK_S = 0.1, 1.0, 1 / 30
_TURN = math.pi**2 / 3  # rad²: nobody knows how the contact is turned about its normal
_BALL_M, _ARROW_M = 0.006, 0.05
_KINDS = {"pose": PoseStamped, "transform": TransformStamped, "joints": JointState}
_PUBLISHED = (
    ("~/wrench", WrenchStamped, _SECOND),
    ("~/contact", PoseWithCovarianceStamped, _SECOND),
    ("~/reason", String, _LATCHED),
    ("~/markers", MarkerArray, 1),
    ("/diagnostics", DiagnosticArray, 10),
)
_USUAL = {
    "wrench_topic": "wrench",
    "pose_topic": "pose",
    "pose_kind": "pose",
    "robot": "",
    "static_pose": False,
    **dict.fromkeys(("sensor_frame", "world_frame", "flange_frame"), ""),
}
"""Parameters, and what they are where nobody gives them; an empty frame is that of the first message."""


class ContactNode(LifecycleNode):
    """
    What ``contactbench run`` does, for wrenches and poses that ROS has.

    Configured it has read its bundle and found its topics; active it locates. A sample has the time and the frame of
    its message, and so has what is said of it.

    Parameters
    ----------
    bundle : str
        The parameter of this name, where ROS gives none.
    unverified : bool
        As `bundle`.

    Attributes
    ----------
    refused : InputError or None
        Why it could not be configured.
    over : bool
        Whether it was shut down.
    """

    def __init__(self, bundle: str, *, unverified: bool = False) -> None:
        super().__init__("contactbench")
        usual = {"bundle": bundle, "unverified": unverified, **_USUAL}
        self.declare_parameters("", list(usual.items()))
        self.refused: InputError | None = None
        self.over = False
        self._config: RuntimeConfig
        self._robot: Robot | None = None
        self._run: Run | None = None
        self._out: dict[str, Any] = {}
        self._in: list[Any] = []
        self._header = Header()
        self.create_timer(_LOOK_S, self._look)

    # ---- transitions ---------------------------------------------------------------------------

    def on_configure(self, state: Any) -> Any:
        """Read the bundle, and find the topics; where it fails, the log says why."""
        try:
            self._open()
        except InputError as error:
            self.refused = error
            self.get_logger().error(str(error))
            self._close()
            return TransitionCallbackReturn.FAILURE
        return super().on_configure(state)

    def on_activate(self, state: Any) -> Any:
        """Begin; nothing is known of what was before."""
        done = super().on_activate(state)
        self._reason, self._counted = "", 0
        self._troubles: dict[str, str] = {}
        self._marked = -math.inf
        self._diagnosed = self._now()
        frames = {name: self._value(f"{name}_frame") for name in ("sensor", "world", "flange")}
        self._frames = {name: frame for name, frame in frames.items() if frame}
        hold = math.inf if self._value("static_pose") else None
        self._run = Run(self._config, hold=hold, clock=self._now, on_answer=self._tell)
        self._listen()  # only now: a pose that is published once must not come before
        return done

    def on_deactivate(self, state: Any) -> Any:
        """Say that no contact comes any more."""
        self._end()
        return super().on_deactivate(state)

    def on_cleanup(self, state: Any) -> Any:
        """Let go of the bundle and the topics."""
        self._end()
        self._close()
        return super().on_cleanup(state)

    on_error = on_cleanup

    def on_shutdown(self, state: Any) -> Any:
        """Let go of everything."""
        self.over = True
        return self.on_cleanup(state)

    def _open(self) -> None:
        if (kind := self._value("pose_kind")) not in _KINDS:
            raise RunError(f"parameter pose_kind: it is {arg(kind)!r}: give {arg(', '.join(_KINDS))}.")
        self._config = RuntimeConfig.load(Path(self._value("bundle")))
        check_runnable(self._config, unverified=self._value("unverified"))
        self._robot = Robot.named(self._value("robot")) if kind == "joints" else None
        told = PublisherEventCallbacks(incompatible_qos=self._mismatch("a subscriber of contacts"))
        for topic, message, qos in _PUBLISHED:
            self._out[topic] = self.create_lifecycle_publisher(message, topic, qos, event_callbacks=told)

    def _listen(self) -> None:
        lasting = _LATCHED if self._value("static_pose") else _SAMPLES
        for what, message, take, qos in (
            ("wrench", WrenchStamped, self._take_wrench, _SAMPLES),
            ("pose", _KINDS[self._value("pose_kind")], self._take_pose, lasting),
        ):
            topic = self._value(f"{what}_topic")
            missed = SubscriptionEventCallbacks(incompatible_qos=self._mismatch(f"the publisher of {topic}"))
            self._in.append(
                self.create_subscription(
                    message,
                    topic,
                    partial(self._take, what, take),
                    qos,
                    event_callbacks=missed,
                    qos_overriding_options=QoSOverridingOptions.with_default_policies(),
                )
            )

    def _close(self) -> None:
        for publisher in self._out.values():
            self.destroy_lifecycle_publisher(publisher)
        self._out.clear()

    def _end(self) -> None:
        for subscription in self._in:
            self.destroy_subscription(subscription)
        self._in.clear()
        if self._run is not None:
            self._run = None
            self._say("inactive")
            self._mark(None)

    # ---- what comes ----------------------------------------------------------------------------

    def _take(self, what: str, take: Callable[[Run, float, Any], None], message: Any) -> None:
        if self._run is None:
            return
        try:
            take(self._run, _seconds(message.header.stamp), message)
        except ValueError as error:
            self._troubles[what] = words = f"A {what} is not used: {error}."
            self.get_logger().warning(words, throttle_duration_sec=_THROTTLE_S)

    def _take_wrench(self, run: Run, time: float, message: Any) -> None:
        self._check("sensor", message.header.frame_id)
        self._header = message.header
        force, torque = message.wrench.force, message.wrench.torque
        sample = WrenchSample(
            time, (force.x, force.y, force.z), (torque.x, torque.y, torque.z), arrival=self._now()
        )
        run.wrenches([sample])

    def _take_pose(self, run: Run, time: float, message: Any) -> None:
        joints = None
        if self._robot is not None:
            if (found := joint_pose(message, self._robot)) is None:
                return  # of a gripper, or speeds alone
            (R, p), joints = found
        else:
            self._check("world", message.header.frame_id)
            if isinstance(message, TransformStamped):
                self._check("flange", message.child_frame_id)
                R, p = pose(message.transform.translation, message.transform.rotation)
            else:
                R, p = pose(message.pose.position, message.pose.orientation)
        run.poses([FlangeSample(time, R, p, joints)])

    def _check(self, what: str, frame: str) -> None:
        if frame != (wanted := self._frames.setdefault(what, frame)):
            raise ValueError(f"its frame is {frame!r}, not {wanted!r} (parameter {what}_frame)")

    # ---- what goes out -------------------------------------------------------------------------

    def _tell(self, _: WrenchSample | None, answer: Answer) -> None:
        contact = answer.contact
        if contact is None:
            return
        if contact.wrench is not None:
            told = WrenchStamped(header=self._header)
            told.wrench.force, told.wrench.torque = (
                _xyz(Vector3, contact.wrench[:3]),
                _xyz(Vector3, contact.wrench[3:]),
            )
            self._out["~/wrench"].publish(told)
        point, normal, covariance = contact.point, contact.normal, contact.covariance
        place = None
        if contact.accepted and point is not None and normal is not None and covariance is not None:
            place = point, normal
            self._out["~/contact"].publish(contact_pose(self._header, point, normal, covariance))
        self._say(": ".join(filter(None, (answer.reason, ", ".join(health_names(answer.health))))))
        self._mark(place)

    def _say(self, reason: str) -> None:
        if reason != self._reason:
            self._reason = reason
            self._out["~/reason"].publish(String(data=reason))

    def _mark(self, place: tuple[NDArray[np.float64], NDArray[np.float64]] | None) -> None:
        """Show a point with its normal, or none: at once where that changes, else at the rate of a screen."""
        now = self._now() if place is not None else -math.inf
        if (place is None and self._marked < 0) or 0 <= now - self._marked < _MARK_S:
            return
        self._marked = now
        ball, arrow = (
            Marker(header=self._header, ns="contact", id=kind, type=kind, action=Marker.DELETE)
            for kind in (Marker.SPHERE, Marker.ARROW)
        )
        if place is not None:
            point, normal = place
            for marker in (ball, arrow):
                marker.action, marker.lifetime.sec = Marker.ADD, 1  # should the node die
                marker.color.r, marker.color.g, marker.color.a = 1.0, 0.5, 1.0
                marker.pose.orientation.w = 1.0
            ball.pose.position = _xyz(Point, point)
            ball.scale.x = ball.scale.y = ball.scale.z = arrow.scale.y = _BALL_M
            arrow.scale.x = 0.3 * _BALL_M
            # The way that the tissue presses.
            arrow.points = [_xyz(Point, point + _ARROW_M * normal), _xyz(Point, point)]
        self._out["~/markers"].publish(MarkerArray(markers=[ball, arrow]))

    def _look(self) -> None:
        if (run := self._run) is None:
            return
        now = self._now()
        if (answer := run.heartbeat(now)) is not None:
            self._header = Header(stamp=self.get_clock().now().to_msg(), frame_id=self._header.frame_id)
            self._tell(None, answer)
        if now - self._diagnosed >= _DIAGNOSE_S:
            self._diagnose(run, now)

    def _diagnose(self, run: Run, now: float) -> None:
        config, zero = self._config, run.zero
        count, self._counted = run.reasons.total() - self._counted, run.reasons.total()
        rate, self._diagnosed = count / (now - self._diagnosed), now
        wrong = list(self._troubles.values())
        if not count:
            wrong.append("No wrench comes: check its topic, its type and who publishes it.")
        warnings = [
            rate_warning(config, rate or None),
            motion_warning(config, run.positions),
            zero_words(zero) if zero is not None and zero.state in ("off", "doubtful") else None,
        ]
        words = [*wrong, *filter(None, warnings)]
        facts: dict[str, object] = {
            "reason": self._reason,
            "wrenches per second": f"{rate:.0f}",
            **run.reasons,
            **run.unhealthy,
            "poses": {None: "none", True: "with positions", False: "without positions"}[run.positions],
            "zero": "unknown" if zero is None else zero.state,
            "median latency, s": run.latencies.quantile(0.5),
            "the bundle's sensor": sensor_name(config.model.sensor.model, config.model.sensor.serial),
        }
        status = DiagnosticStatus(
            level=DiagnosticStatus.ERROR
            if wrong
            else DiagnosticStatus.WARN
            if words
            else DiagnosticStatus.OK,
            name=f"{self.get_name()}: contact",
            message=" ".join(words) or "Contacts are located.",
            hardware_id=self._header.frame_id,
            values=[KeyValue(key=key, value=str(value)) for key, value in facts.items()],
        )
        header = Header(stamp=self.get_clock().now().to_msg())
        self._out["/diagnostics"].publish(DiagnosticArray(header=header, status=[status]))
        self._troubles = {
            what: told for what, told in self._troubles.items() if what not in ("wrench", "pose")
        }

    def _mismatch(self, who: str) -> Callable[[Any], None]:
        def tell(event: Any) -> None:
            policy = qos_policy_name_from_kind(event.last_policy_kind)
            words = f"Nothing passes between this node and {who}: their QoS does not fit ({policy})."
            self._troubles = {**self._troubles, who: words}
            self.get_logger().warning(words)

        return tell

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _now(self) -> float:
        return 1e-9 * float(self.get_clock().now().nanoseconds)


def contact_pose(
    header: Any, point: NDArray[np.float64], normal: NDArray[np.float64], covariance: NDArray[np.float64]
) -> Any:
    """
    Return a contact as ``PoseWithCovarianceStamped``: z along the outward normal.

    Nothing is known of how it is turned about that normal: the variance is that of any angle. The normal itself is
    that of the surface there, and has none.
    """
    told = PoseWithCovarianceStamped(header=header)
    told.pose.pose.position = _xyz(Point, point)
    x, y, z, w = Rotation.from_matrix(contact_frame(normal)).as_quat().tolist()
    told.pose.pose.orientation = Quaternion(x=x, y=y, z=z, w=w)
    rotation = _TURN * np.outer(normal, normal)
    told.pose.covariance = np.block([[covariance, np.zeros((3, 3))], [np.zeros((3, 3)), rotation]]).ravel()
    return told


def _seconds(stamp: Any) -> float:
    if stamp.sec < 0 or stamp.sec == stamp.nanosec == 0:
        raise ValueError("it has no time stamp")
    return float(stamp.sec + 1e-9 * stamp.nanosec)


def _xyz(kind: Any, values: NDArray[np.float64]) -> Any:
    x, y, z = values.tolist()
    return kind(x=x, y=y, z=z)


def serve(
    bundle: str,
    arguments: Sequence[str],
    *,
    unverified: bool = False,
    managed: bool = False,
    remote: bool = False,
) -> None:
    """
    Run the node until a signal or a manager ends it.

    Parameters
    ----------
    bundle : str
        Empty: the parameter says which.
    arguments : sequence of str
        For ROS, from ``--ros-args`` on.
    unverified : bool
    managed : bool
        It waits for whoever configures and activates it; else it does so itself.
    remote : bool
        Whether ROS may reach other machines, as its own settings say; else only this one.

    Raises
    ------
    InputError
        ROS does not take the arguments, or the node refuses its bundle or a parameter.
    """
    if not remote:
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
        os.environ.pop("ROS_STATIC_PEERS", None)
    with ended_by_signals() as ended, responsive():
        try:
            rclpy.init(args=["contactbench", *arguments], signal_handler_options=SignalHandlerOptions.NO)
            node = ContactNode(bundle, unverified=unverified)
        except (RuntimeError, ValueError, ParameterException) as error:
            rclpy.try_shutdown()
            raise RunError(f"ROS does not take that: {arg(error)}.") from error
        executor = EventsExecutor()
        executor.add_node(node)
        try:
            if not managed and node.trigger_configure() == TransitionCallbackReturn.SUCCESS:
                node.trigger_activate()
            while not (ended.asked or node.over or (node.refused and not managed)):
                executor.spin_once(timeout_sec=_LOOK_S)
        finally:
            if not node.over:
                node.trigger_shutdown()
            executor.shutdown()
            node.destroy_node()
            rclpy.try_shutdown()
    if node.refused is not None and not managed:
        raise node.refused
