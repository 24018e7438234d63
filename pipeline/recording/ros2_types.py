"""The ROS 2 messages that are imported, and how to read them without ROS.

The definitions are the standard ones; those that a bag carries are not looked at. A hostile definition could
ask for any amount of memory; a message that does not fit the standard one is left out.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory

from contactbench.pipeline.errors import arg, message

if TYPE_CHECKING:
    from collections.abc import Callable

WRENCH_STAMPED = "geometry_msgs/msg/WrenchStamped"
TF, POSE_STAMPED = "tf2_msgs/msg/TFMessage", "geometry_msgs/msg/PoseStamped"
JOINT_STATE = "sensor_msgs/msg/JointState"

_HEADER = """
===
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
===
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
_VECTOR = """
===
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
"""
_WRENCH_PART = """
===
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3 force
geometry_msgs/Vector3 torque
"""
_QUATERNION = """
===
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"""
DEFINITIONS = {
    WRENCH_STAMPED: "std_msgs/Header header\ngeometry_msgs/Wrench wrench" + _HEADER + _WRENCH_PART + _VECTOR,
    TF: "geometry_msgs/TransformStamped[] transforms\n===\nMSG: geometry_msgs/TransformStamped\n"
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n===\n"
    "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation"
    + _HEADER
    + _VECTOR
    + _QUATERNION,
    POSE_STAMPED: "std_msgs/Header header\ngeometry_msgs/Pose pose\n===\nMSG: geometry_msgs/Pose\n"
    "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n===\nMSG: geometry_msgs/Point\n"
    "float64 x\nfloat64 y\nfloat64 z" + _HEADER + _QUATERNION,
    JOINT_STATE: "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
    "float64[] effort" + _HEADER,
}


def decoder(name: str) -> Callable[[bytes], Any]:
    """
    Return what turns the bytes of a message into an object with its fields.

    It raises ValueError for bytes that are no such message.
    """
    decode = DecoderFactory().decoder_for("cdr", Schema(1, DEFINITIONS[name].encode(), "ros2msg", name))
    if decode is None:
        raise ValueError(message(f"{arg(name)} has no definition"))
    plain = decode

    def careful(data: bytes) -> Any:
        try:
            return plain(data)
        except (struct.error, IndexError, UnicodeDecodeError, OverflowError) as error:
            raise ValueError(message(f"no {arg(name)}: {arg(error)}")) from error

    return careful
