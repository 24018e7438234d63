"""The ROS node in a process of its own, and what another process hears of it: real rclpy, on Fast DDS."""

from __future__ import annotations

import json
import signal
import subprocess
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import yaml
from config.runtime.bundles import example, example_bundle
from runtime.contacts import touch, touching
from runtime.runtime_recordings import ABOUT, CONTEXT, flange, wrench
from scipy.spatial.transform import Rotation
from terminal import command

from contactbench.pipeline.runtime import Engine
from contactbench.pipeline.runtime.contact_frame import contact_frame

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from runtime.ros_peer import Peer

ros_peer = pytest.importorskip("runtime.ros_peer", reason="needs ROS 2: `packaging/run ros`")
# rclpy calls what it, and what Python, deprecates.
pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning")

SILENT = "stale: silent"


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a bundle."""
    folder = tmp_path_factory.mktemp("ros") / "bundle"
    example_bundle(folder)
    return folder


@pytest.fixture
def peer() -> Iterator[Peer]:
    with ros_peer.Peer() as made:
        made.listen_to_all()
        yield made


def readings(R: np.ndarray, count: int) -> np.ndarray:
    """Return what the sensor reads of a probe that is free, then touched (count, 6)."""
    pushed = np.outer(np.arange(count) >= count // 4, touch()[2])
    noise = np.random.default_rng(7).normal(0, [0.02] * 3 + [5e-4] * 3, (count, 6))
    return example().gravity.predict(R) + pushed + noise


def posed(peer: Peer, kind: str) -> tuple[Any, np.ndarray]:
    """Publish where the flange is, once; returns the publisher and R_BE."""
    from geometry_msgs.msg import PoseStamped, TransformStamped
    from sensor_msgs.msg import JointState

    from contactbench.pipeline.robot import Robot

    q = np.array([0.1, -0.3, 0.9, 0.2, 0.7, -0.4])
    R, p = Robot.named("elfin3").flange_pose(q)
    told = {"pose": PoseStamped, "transform": TransformStamped, "joints": JointState}[kind]()
    told.header.frame_id, told.header.stamp = "base", peer.node.get_clock().now().to_msg()
    if kind == "joints":
        told.name, told.position = [f"j{n}" for n in range(1, 7)], q.tolist()
    else:
        place = told.pose if kind == "pose" else told.transform
        at, turned = (
            (place.position, place.orientation) if kind == "pose" else (place.translation, place.rotation)
        )
        at.x, at.y, at.z = p.tolist()
        quaternion = Rotation.from_matrix(R).as_quat()
        turned.x, turned.y, turned.z, turned.w = quaternion.tolist()
        R = Rotation.from_quat(quaternion).as_matrix()
    publisher = peer.node.create_publisher(type(told), "pose", ros_peer.LATCHED)
    publisher.publish(told)
    return publisher, R


@pytest.mark.parametrize("kind", ["pose", "transform", "joints"])
def test_it_says_what_the_engine_says_to_the_bit(bundle: Path, peer: Peer, kind: str) -> None:
    from builtin_interfaces.msg import Time

    keep, R = posed(peer, kind)  # before the node is there: it joins late
    with ros_peer.start(bundle, *ros_peer.STILL, f"pose_kind:={kind}", "robot:=elfin3", "sensor_frame:=ft"):
        peer.meet()
        peer.until(keep.get_subscription_count)
        engine = Engine(example(), hold=np.inf)
        engine.poses([flange(1.0, R)])
        begin = peer.node.get_clock().now().nanoseconds
        expected = []
        for index, reading in enumerate(readings(R, 400)):
            seconds, rest = divmod(begin + 1_000_000 * index, 10**9)
            stamp = Time(sec=seconds, nanosec=rest)
            peer.pushed(stamp, reading)
            expected.append((stamp, engine.locate(wrench(seconds + 1e-9 * rest, reading))))
        wrenches = [(stamp, answer) for stamp, answer in expected if answer.contact.wrench is not None]
        contacts = [(stamp, answer) for stamp, answer in expected if answer.contact.accepted]
        assert len(contacts) > 100
        peer.until(lambda: len(peer.heard["/contactbench/wrench"]) >= len(wrenches))
        peer.until(lambda: len(peer.heard["/contactbench/contact"]) >= len(contacts))
    for told, (stamp, answer) in zip(peer.heard["/contactbench/wrench"], wrenches, strict=True):
        assert (told.header.stamp, told.header.frame_id) == (stamp, "ft")
        assert [*_three(told.wrench.force), *_three(told.wrench.torque)] == answer.contact.wrench.tolist()
    for told, (stamp, answer) in zip(peer.heard["/contactbench/contact"], contacts, strict=True):
        contact = answer.contact
        assert (told.header.stamp, told.header.frame_id) == (stamp, "ft")
        assert _three(told.pose.pose.position) == contact.point.tolist()
        turned = told.pose.pose.orientation
        R_SC = Rotation.from_quat([turned.x, turned.y, turned.z, turned.w]).as_matrix()
        np.testing.assert_allclose(R_SC, contact_frame(contact.normal), atol=1e-12)
        covariance = told.pose.covariance.reshape(6, 6)  # x y z, then turns about x y z
        assert covariance[:3, :3].tolist() == contact.covariance.tolist()
        assert not covariance[:3, 3:].any()
        np.testing.assert_allclose(covariance[3:, 3:] @ contact.normal, np.pi**2 / 3 * contact.normal)
        assert np.linalg.matrix_rank(covariance[3:, 3:]) == 1
    # Only the newest reason is kept, so some may be passed over.
    assert {each.partition(":")[0] for each in peer.reasons} <= {"stale", *(a.reason for _, a in expected)}


def _three(values: Any) -> list[float]:
    return [values.x, values.y, values.z]


def test_who_joins_late_hears_the_present_reason_and_no_old_contact(bundle: Path, peer: Peer) -> None:
    from geometry_msgs.msg import PoseWithCovarianceStamped
    from std_msgs.msg import String
    from visualization_msgs.msg import Marker

    late: dict[str, list[Any]] = {"reason": [], "contact": []}
    keep = peer.held()
    with ros_peer.start(bundle, *ros_peer.STILL):
        peer.meet()
        peer.push_all(readings(np.eye(3), 400))
        peer.until(lambda: len(peer.heard["/contactbench/wrench"]) == 400 and peer.reasons[-1] == SILENT)
        assert len(peer.heard["/contactbench/contact"]) > 100
        marked = peer.heard["/contactbench/markers"]
        peer.until(lambda: [each.action for each in marked[-1].markers] == [Marker.DELETE] * 2)
        assert [each.action for each in marked[0].markers] == [Marker.ADD] * 2
        peer.listen("/contactbench/reason", String, ros_peer.LATCHED, late["reason"].append)
        contacts = peer.listen(
            "/contactbench/contact", PoseWithCovarianceStamped, take=late["contact"].append
        )
        peer.until(lambda: late["reason"] and contacts.get_publisher_count())
        assert late["reason"][0].data == SILENT
        heard = len(peer.heard["/contactbench/contact"])
        peer.push_all(readings(np.eye(3), 400))
        peer.until(lambda: len(peer.heard["/contactbench/wrench"]) == 800 and peer.reasons[-1] == SILENT)
        assert late["contact"] == peer.heard["/contactbench/contact"][heard:]
    assert keep


def test_quality_of_service_that_does_not_fit_is_told(bundle: Path, peer: Peer) -> None:
    from geometry_msgs.msg import PoseWithCovarianceStamped

    with ros_peer.start(bundle, *ros_peer.STILL) as process:
        peer.until(peer.wrenches.get_subscription_count)
        keep = (
            peer.held(10),
            peer.listen("/contactbench/contact", PoseWithCovarianceStamped, ros_peer.LATCHED),
        )
        for who in ("the publisher of pose", "a subscriber of contacts"):
            peer.until(
                lambda who=who: (
                    f"between this node and {who}: their QoS does not fit (DURABILITY)" in peer.trouble
                )
            )
        process.send_signal(signal.SIGINT)
        assert process.stderr is not None
        told = process.stderr.read()
    assert keep
    assert told.count("QoS does not fit") == 2
    assert process.returncode == 0


@pytest.mark.parametrize(
    ("stamped", "frame", "why"),
    [
        (False, "ft", "A wrench is not used: it has no time stamp."),
        (True, "other", "A wrench is not used: its frame is 'other', not 'ft' (parameter sensor_frame)."),
    ],
)
def test_a_wrench_that_cannot_be_used_is_told(
    bundle: Path, peer: Peer, stamped: bool, frame: str, why: str
) -> None:
    from builtin_interfaces.msg import Time

    keep = peer.held()
    with ros_peer.start(bundle, *ros_peer.STILL, "sensor_frame:=ft"):
        peer.meet()
        peer.pushed(peer.node.get_clock().now().to_msg() if stamped else Time(), np.zeros(6), frame)
        peer.until(lambda: why in peer.trouble)
        assert peer.heard["/diagnostics"][-1].status[0].level == b"\x02"
        assert not peer.heard["/contactbench/wrench"]
    assert keep


def test_a_manager_leads_it_through_its_states(bundle: Path, tmp_path: Path, peer: Peer) -> None:
    from rcl_interfaces.msg import Parameter
    from rcl_interfaces.srv import SetParameters

    def set_bundle(path: Path) -> None:
        told = Parameter(name="bundle")
        told.value.type, told.value.string_value = 4, str(path)
        assert peer.call(SetParameters, "set_parameters", parameters=[told]).results[0].successful

    keep = peer.held()
    with ros_peer.start(tmp_path / "none", *ros_peer.STILL, managed=True) as process:
        assert peer.state() == "unconfigured"
        assert not peer.change("configure")
        assert peer.state() == "unconfigured"
        set_bundle(bundle)
        assert peer.change("configure")
        assert peer.state() == "inactive"
        assert not peer.wrenches.get_subscription_count()
        for _ in range(2):
            assert not peer.heard["/contactbench/wrench"]
            assert peer.change("activate")
            assert peer.state() == "active"
            peer.meet()
            peer.push_all(readings(np.eye(3), 50))
            peer.until(lambda: len(peer.heard["/contactbench/wrench"]) == 50)
            assert peer.change("deactivate")
            peer.until(lambda: peer.reasons[-1:] == ["inactive"])
            peer.until(lambda: not peer.wrenches.get_subscription_count())
            for heard in peer.heard.values():
                heard.clear()
            assert peer.change("cleanup")
            assert peer.change("configure")
        assert peer.change("shutdown")
        assert process.wait(30) == 0
        assert process.stderr is not None
        assert "none: there is no such folder" in process.stderr.read()
    assert keep


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("-p", "pose_kind:=tf"), "parameter pose_kind: it is 'tf': give pose, transform, joints."),
        (("-p", "unverified:=3"), "ROS does not take that: Trying to set parameter 'unverified'"),
        (("-p", "x"), "ROS does not take that: failed to initialize rcl"),
    ],
)
def test_what_it_refuses(bundle: Path, arguments: tuple[str, ...], why: str) -> None:
    words = command("ros", bundle, "--", "--ros-args", *arguments)
    done = subprocess.run(words, check=False, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert f"error: {why}" in done.stderr


def test_ros_reads_the_parameters_of_a_bundle(bundle: Path) -> None:
    file = bundle / "ros2.yaml"
    (name, told), *_ = yaml.safe_load(file.read_text(encoding="utf-8")).items()
    options = {"automatically_declare_parameters_from_overrides": True}
    with ros_peer.Peer("--ros-args", "--params-file", str(file), name=name.strip("/"), **options) as peer:
        offset = peer.node.get_parameters_by_prefix("offset")
        wanted = told["ros__parameters"]["offset"]
        assert offset["force.x"].value == wanted["force"]["x"]
        assert offset["torque.z"].value == wanted["torque"]["z"]


def test_ros_hears_what_goes_out_by_dds(peer: Peer) -> None:
    pytest.importorskip("cyclonedds")
    from std_msgs.msg import String

    from contactbench.pipeline.runtime.dds_target import DdsTarget

    given = touching(5, free=3)
    contacts: list[dict[str, Any]] = []
    with ros_peer.Peer(name="other") as other:
        other.listen(
            "/contactbench/contact", String, take=lambda each: contacts.append(json.loads(each.data))
        )
        target = DdsTarget(str(ros_peer.DOMAIN), CONTEXT)
        peer.until(lambda: all(writer.get_matched_subscriptions() for writer in target._writers))
        assert target.write(given) == len(given)
        heard = peer.heard["/contactbench/wrench"]
        peer.until(lambda: other.spin() or (len(heard) == len(given) == len(contacts)))
        target.close()
    assert contacts == [json.loads(each.message(ABOUT.log_time(each.time))) for each in given]
    for told, answer in zip(heard, given, strict=True):
        stamp = told.header.stamp
        assert stamp.sec * 10**9 + stamp.nanosec == ABOUT.log_time(answer.time)
        assert told.header.frame_id == "sensor"
        assert answer.contact is not None
        assert answer.contact.wrench is not None
        assert [*_three(told.wrench.force), *_three(told.wrench.torque)] == answer.contact.wrench.tolist()
