"""Flange poses out of ROS messages: from transforms, poses, or joints.

The messages that are imported, and how to read them without ROS.

The definitions are the standard ones; those that a bag carries are not looked at. A hostile definition could
ask for any amount of memory; a message that does not fit the standard one is left out.
"""

import math
import re
import struct
from collections.abc import Callable, Collection
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from contactbench.pipeline.errors import arg, message
from contactbench.pipeline.recording.stream import McapMessage
from contactbench.pipeline.robot import Robot

Pose = tuple["NDArray[np.float64]", "NDArray[np.float64]"]

# When a transform held: its time stamp, or, where it has none, when it was received; ns.
_Moment = tuple[int, int]
_NEVER: _Moment = (-(2**63), 0)

_MOST_FRAMES = 1000
_UNIT = 1e-3  # how far from 1 the norm of a quaternion may be


class TransformTree:
    """
    The latest transforms between frames, and the pose of one in another.

    The links of a robot may come in several messages. A pose is due only when all links that move have been heard of
    one moment: links of different moments make a pose in which the robot never was.

    Parameters
    ----------
    base, flange : str
        Names of the frames, without a leading slash.
    moving : collection of str
        Children of the transforms that change; any other transform holds for good.

    Attributes
    ----------
    missed : int
        Moments of which not all links were heard.
    """

    def __init__(self, base: str, flange: str, moving: Collection[str] = ()) -> None:
        self._base, self._flange, self._moving = base, flange, moving
        self._parents: dict[str, tuple[str, Pose]] = {}
        self._moments: dict[str, _Moment] = {}
        self._newest: _Moment | None = None
        self._given: _Moment | None = None
        self.missed = 0

    def update(self, body: Any, received: int, *, static: bool = False) -> list[str]:
        """
        Take in a TFMessage that was received at a time in ns.

        Returns
        -------
        list of str
            The frames between base and flange whose transforms are none: they keep their last one.
        """
        bad = []
        for item in body.transforms:
            parent, child = item.header.frame_id.lstrip("/"), item.child_frame_id.lstrip("/")
            if child not in self._parents and len(self._parents) >= _MOST_FRAMES:
                continue
            try:
                self._parents[child] = parent, pose(item.transform.translation, item.transform.rotation)
            except ValueError:
                bad.append(child)
                continue
            if not static:
                stamp = stamp_of(item.header)
                # Without a time of its own, what came in one message is of one moment.
                self._moments[child] = stamp, 0 if stamp else received
        chain = self._chain()
        return [frame for frame in bad if frame in chain or frame == self._flange]

    def due(self) -> int | None:
        """Return the time stamp of a pose that was not given yet, ns, 0 without one; None if there is no such pose."""
        chain = self._chain()
        if not self._connected(chain):
            return None
        moments = self._clocks(chain)
        if not moments:
            return None
        newest = max(moments)
        if newest != self._newest:
            self.missed += self._newest != self._given
            self._newest = newest
        if newest == self._given or (self._moves(chain) and set(moments) != {newest}):
            return None
        self._given = newest
        return newest[0]

    def pose(self) -> Pose | None:
        """Return R_BE and p_BE_B; None while the frames are not connected."""
        chain = self._chain()
        if not self._connected(chain):
            return None
        R, p = np.eye(3), np.zeros(3)
        for frame in chain:
            R_parent, p_parent = self._parents[frame][1]
            R, p = R_parent @ R, p_parent + R_parent @ p
        return R, p

    @property
    def fixed(self) -> set[str]:
        """The base, and the frames that it hangs on: none of them moves with the flange."""
        chain, frame = {self._base}, self._base
        while (link := self._parents.get(frame)) is not None and link[0] not in chain:
            frame = link[0]
            chain.add(frame)
        return chain

    def obstacle(self) -> str:
        """Say why no pose was due so far."""
        chain, upside_down = self._chain(), self._chain(self._flange, self._base)
        if upside_down and self._parents[upside_down[-1]][0] == self._flange:
            return message(
                f"{arg(self._base)} hangs on {arg(self._flange)}: give --base and --flange the other way round."
            )
        if not chain:
            return message(f"no transform gives the position of {arg(self._flange)}.")
        top = self._parents[chain[-1]][0]
        if top != self._base:
            return message(
                f"{arg(self._flange)} hangs on {arg(top)}, and no transform leads from {arg(self._base)} to {arg(top)}."
            )
        if not self._clocks(chain):
            return message(f"everything between {arg(self._base)} and {arg(self._flange)} is static.")
        listed = ", ".join(frame for frame in reversed(chain) if frame in self._moving)
        return message(f"the transforms to {arg(listed)} never have the same time stamp.")

    def _moves(self, chain: list[str]) -> bool:
        return any(frame in self._moving for frame in chain)

    def _clocks(self, chain: list[str]) -> list[_Moment]:
        """Return of which moments the links are that move; where none does, those that are not static."""
        if self._moves(chain):
            return [self._moments.get(frame, _NEVER) for frame in chain if frame in self._moving]
        return [self._moments[frame] for frame in chain if frame in self._moments]

    def _connected(self, chain: list[str]) -> bool:
        return bool(chain) and self._parents[chain[-1]][0] == self._base

    def _chain(self, top: str | None = None, bottom: str | None = None) -> list[str]:
        """Return the frames from the bottom (the flange) to the one below the top (the base), or as far as it goes."""
        chain: list[str] = []
        top, frame = top or self._base, bottom or self._flange
        while frame != top and frame in self._parents and len(chain) < _MOST_FRAMES:
            chain.append(frame)
            frame = self._parents[frame][0]
        return chain


def stamp_of(header: Any) -> int:
    """Return the time in the header of a message, ns; 0: it has none."""
    stamp: int = header.stamp.sec * 10**9 + header.stamp.nanosec
    return stamp


def numbers(position: Any, orientation: Any) -> tuple[float, ...]:
    """
    Return x, y, z, and x, y, z, w of a position and a quaternion with such fields.

    Raises
    ------
    ValueError
        The quaternion is none, or the position is infinite or known in part only.
    """
    p = position.x, position.y, position.z
    quaternion = orientation.x, orientation.y, orientation.z, orientation.w
    length = math.hypot(*(min(max(value, -2.0), 2.0) for value in quaternion))
    known = all(map(math.isfinite, p)) or all(map(math.isnan, p))  # NaN: of a source of orientations only
    if not (known and all(map(math.isfinite, quaternion)) and abs(length - 1) < _UNIT):
        raise ValueError(message("it is no pose"))
    return *p, *quaternion


def pose(position: Any, orientation: Any) -> Pose:
    """
    Return R and p of a position and a quaternion with fields x, y, z (w).

    Raises
    ------
    ValueError
        The quaternion is none, or the position is infinite or known in part only.
    """
    values = np.array(numbers(position, orientation))
    return Rotation.from_quat(values[3:]).as_matrix(), values[:3]


def joint_pose(body: Any, robot: Robot) -> tuple[Pose, NDArray[np.float64]] | None:
    """
    Return the flange's pose by the joints of a JointState, and these joints in the robot's order.

    None: the message has other joints, such as a gripper's, or no angles.

    Joints are found by the robot's names for them; failing that, by the numbers at the end of their names.

    Raises
    ------
    ValueError
        They are not finite.
    """
    wanted = [joint.name for joint in robot.description.joints]
    angles = dict(zip(body.name, body.position, strict=False))
    if not set(wanted) <= set(angles):
        numbered = {_last_number(name): angle for name, angle in angles.items()}
        numbers = list(range(1, len(wanted) + 1))
        if len(angles) != len(wanted) or sorted(numbered) != numbers:
            return None
        angles = {name: numbered[number] for name, number in zip(wanted, numbers, strict=True)}
    q = np.array([angles[name] for name in wanted])
    if not np.isfinite(q).all():
        raise ValueError(message("a joint angle is not finite"))
    return robot.flange_pose(q), q


def _last_number(name: str) -> int:
    found = re.search(r"(\d{1,4})\D*$", name[-64:])
    return int(found[1]) if found else -1


# ---- the messages that are imported, and how to read them without ROS -----------------------------


WRENCH_STAMPED = "geometry_msgs/msg/WrenchStamped"
TF, POSE_STAMPED = "tf2_msgs/msg/TFMessage", "geometry_msgs/msg/PoseStamped"
JOINT_STATE = "sensor_msgs/msg/JointState"

CDR, ROS1, XCDR2 = "cdr", "ros1", "XCDR2"
_FIRST_OF_XCDR2 = 6  # of the kinds that the second byte of a message names


def encoding_of(raw: McapMessage) -> str:
    """Return how a message is written; what is called CDR may be XCDR2, which aligns numbers in another way."""
    second = raw.channel.encoding == CDR and len(raw.data) > 1 and raw.data[1] >= _FIRST_OF_XCDR2
    return XCDR2 if second else raw.channel.encoding


@cache
def decoder(name: str, encoding: str = CDR) -> Callable[[bytes], Any]:
    """
    Return what turns the bytes of a message into an object with its fields.

    It raises ValueError for bytes that are no such message.
    """
    from rosbags.serde import SerdeError
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if encoding == ROS1 else Stores.ROS2_HUMBLE)
    if TF not in store.fielddefs:  # as in the store of ROS 1
        store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", TF))
    plain = store.deserialize_ros1 if encoding == ROS1 else store.deserialize_cdr

    def careful(data: bytes) -> Any:
        try:
            return plain(data, name)
        except (SerdeError, AssertionError, LookupError, OverflowError, ValueError, struct.error) as error:
            raise ValueError(message(f"no {arg(name)}: {arg(error)}")) from error

    return careful
