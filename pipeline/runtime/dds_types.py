"""
The ROS 2 messages that go out by DDS, as ROS names and orders them.

No ``from __future__ import annotations`` here: the IDL classes are made from the annotations themselves.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float64, int32, sequence, uint32

if TYPE_CHECKING:
    Texts = list[str]
    Nine = list[float]
else:
    Texts = sequence[str]
    Nine = array[float64, 9]


@dataclass
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    """``builtin_interfaces/msg/Time``."""

    sec: int32
    nanosec: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    """``std_msgs/msg/Header``."""

    stamp: Time
    frame_id: str


@dataclass
class Point(IdlStruct, typename="geometry_msgs::msg::dds_::Point_"):
    """``geometry_msgs/msg/Point``."""

    x: float64
    y: float64
    z: float64


@dataclass
class Vector3(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):
    """``geometry_msgs/msg/Vector3``."""

    x: float64
    y: float64
    z: float64


@dataclass
class Wrench(IdlStruct, typename="geometry_msgs::msg::dds_::Wrench_"):
    """``geometry_msgs/msg/Wrench``."""

    force: Vector3
    torque: Vector3


@dataclass
class WrenchStamped(IdlStruct, typename="geometry_msgs::msg::dds_::WrenchStamped_"):
    """``geometry_msgs/msg/WrenchStamped``."""

    header: Header
    wrench: Wrench


@dataclass
class Contact(IdlStruct, typename="contactbench_msgs::msg::dds_::Contact_"):
    """``contactbench_msgs/msg/Contact``; NaN where there is no contact."""

    header: Header
    accepted: bool
    reason: str
    health: Texts
    point: Point
    normal: Vector3
    wrench: Wrench
    covariance: Nine
    confidence: float64
    region: uint32
    latency: float64
