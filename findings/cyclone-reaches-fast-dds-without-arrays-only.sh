#!/usr/bin/env bash
# Cyclone DDS for Python reaches rclpy on Fast DDS only with messages that hold no array and no sequence.
#
# ROS 2's message types can be declared for Cyclone DDS as ROS names and orders them, and a program without ROS then
# publishes to nodes that run on Fast DDS, the default. It works for geometry_msgs/WrenchStamped. Messages that hold a
# fixed array (float64[9] of sensor_msgs/Imu, float64[36] of geometry_msgs/PoseWithCovarianceStamped) or a sequence
# (sensor_msgs/JointState) are never matched, declared just as rightly: nothing arrives, neither side raises, and ROS
# counts the publisher all the same. Cyclone DDS logs that the type object of the array or the sequence, which Fast DDS
# sends with its announcement, is invalid, and drops the reader. Whoever looks for a wrong quality of service looks in
# vain: put what has arrays into a std_msgs/String, or publish it from a node of ROS.
#
# Seen with cyclonedds 11.0.1, and ros-rclpy 9.1.2 on ros-fastdds 3.2.3 from PyPI (Linux, x86-64), on Python 3.11.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check "cyclonedds==11.0.1" "ros-rclpy==9.1.2" \
  "ros-rmw-fastrtps-cpp==9.3.3" "ros-fastdds==3.2.3" "ros-sensor-msgs==5.5.1" "ros-geometry-msgs==5.5.1"
cat >"$folder/listen.py" <<'PY'
import sys
import time

import rclpy
from geometry_msgs.msg import PoseWithCovarianceStamped, WrenchStamped
from sensor_msgs.msg import Imu, JointState

rclpy.init(domain_id=int(sys.argv[1]))
node = rclpy.create_node("listener")
kinds = (WrenchStamped, Imu, PoseWithCovarianceStamped, JointState)
kept = [node.create_subscription(kind, kind.__name__, print, 10) for kind in kinds]
end, counted = time.monotonic() + 60, []
while time.monotonic() < end and len(counted) < len(kinds):
    rclpy.spin_once(node, timeout_sec=0.1)
    counted = [kind.__name__ for kind in kinds if node.count_publishers(kind.__name__)]
print("ROS counts publishers of", *counted, flush=True)
while True:
    rclpy.spin_once(node, timeout_sec=0.1)
PY
cat >"$folder/publish.py" <<'PY'
import sys
import time
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float64, int32, sequence, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic


@dataclass
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Time
    frame_id: str


@dataclass
class Point(IdlStruct, typename="geometry_msgs::msg::dds_::Point_"):
    x: float64
    y: float64
    z: float64


@dataclass
class Vector3(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):
    x: float64
    y: float64
    z: float64


@dataclass
class Quaternion(IdlStruct, typename="geometry_msgs::msg::dds_::Quaternion_"):
    x: float64
    y: float64
    z: float64
    w: float64


@dataclass
class Pose(IdlStruct, typename="geometry_msgs::msg::dds_::Pose_"):
    position: Point
    orientation: Quaternion


@dataclass
class PoseWithCovariance(IdlStruct, typename="geometry_msgs::msg::dds_::PoseWithCovariance_"):
    pose: Pose
    covariance: array[float64, 36]


@dataclass
class PoseWithCovarianceStamped(IdlStruct, typename="geometry_msgs::msg::dds_::PoseWithCovarianceStamped_"):
    header: Header
    pose: PoseWithCovariance


@dataclass
class Wrench(IdlStruct, typename="geometry_msgs::msg::dds_::Wrench_"):
    force: Vector3
    torque: Vector3


@dataclass
class WrenchStamped(IdlStruct, typename="geometry_msgs::msg::dds_::WrenchStamped_"):
    header: Header
    wrench: Wrench


@dataclass
class Imu(IdlStruct, typename="sensor_msgs::msg::dds_::Imu_"):
    header: Header
    orientation: Quaternion
    orientation_covariance: array[float64, 9]
    angular_velocity: Vector3
    angular_velocity_covariance: array[float64, 9]
    linear_acceleration: Vector3
    linear_acceleration_covariance: array[float64, 9]


@dataclass
class JointState(IdlStruct, typename="sensor_msgs::msg::dds_::JointState_"):
    header: Header
    name: sequence[str]
    position: sequence[float64]
    velocity: sequence[float64]
    effort: sequence[float64]


qos = Qos(Policy.Reliability.Reliable(1_000_000), Policy.DataRepresentation(use_cdrv0_representation=True))
participant = DomainParticipant(int(sys.argv[1]))
writers = {
    kind.__name__: DataWriter(participant, Topic(participant, f"rt/{kind.__name__}", kind, qos=qos), qos=qos)
    for kind in (WrenchStamped, Imu, PoseWithCovarianceStamped, JointState)
}
end = time.monotonic() + 60
while time.monotonic() < end and not writers["WrenchStamped"].get_matched_subscriptions():
    time.sleep(0.1)
time.sleep(8)  # the others were announced at the same time
print(*(f"{name} {len(writer.get_matched_subscriptions())}" for name, writer in writers.items()))
PY
domain=$((100 + $$ % 100))
"$folder/venv/bin/python" "$folder/listen.py" "$domain" >"$folder/counted" 2>/dev/null &
listener=$!
trap 'kill "$listener" 2>/dev/null; rm -rf "$folder"' EXIT
read=$("$folder/venv/bin/python" "$folder/publish.py" "$domain" 2>"$folder/log")
counted=$(cat "$folder/counted")
echo "Cyclone DDS is matched: $read"; echo "$counted"
grep -c "invalid type object" "$folder/log" || true
[[ $read == "WrenchStamped 1 Imu 0 PoseWithCovarianceStamped 0 JointState 0" &&
  $counted == "ROS counts publishers of WrenchStamped Imu PoseWithCovarianceStamped JointState" ]] ||
  { echo "CHANGED: other messages are matched now"; exit 1; }
