"""Import of ROS 2 bags in MCAP format; ROS itself is not needed."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pipeline.devices.sample import FlangeSample, WrenchSample
from pipeline.errors import InputError
from pipeline.recording.errors import RecordingError, SampleError
from pipeline.recording.info import FLANGE_TOPIC, WRENCH_TOPIC, DeviceInfo, RecordingInfo
from pipeline.recording.ros2_poses import Frames, joint_pose, pose
from pipeline.recording.ros2_types import DEFINITIONS, JOINT_STATE, POSE_STAMPED, TF, WRENCH_STAMPED, decoder
from pipeline.recording.stream import McapStream, Message
from pipeline.recording.writer import RecordingWriter

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from pipeline.robot import Robot

_POSE_TYPES = (TF, POSE_STAMPED, JOINT_STATE)
_STATIC = "/tf_static"
_MOST_PAIRS = 1000


@dataclass(frozen=True)
class Topic:
    """A topic of a bag, the type of its messages, and how many there are."""

    name: str
    type: str
    count: int


@dataclass(frozen=True)
class Wanted:
    """
    What to import; what is left out is chosen where there is one of a kind.

    Attributes
    ----------
    wrench_topic, pose_topic : str or None
    robot : Robot or None
        Makes poses of joints.
    base, flange : str or None
        Frames of transforms; both or none.
    header_stamps : bool
        Times are those in the messages' headers, not when they were received.
    """

    wrench_topic: str | None = None
    pose_topic: str | None = None
    robot: Robot | None = None
    base: str | None = None
    flange: str | None = None
    header_stamps: bool = False


@dataclass(frozen=True)
class Imported:
    """What was imported: the topics, how many samples, and what should make one doubt."""

    wrench_topic: str
    pose_topic: str | None
    wrenches: int
    poses: int
    warnings: tuple[str, ...]


def list_topics(path: Path) -> tuple[Topic, ...]:
    """
    Return the topics of any MCAP file that have messages.

    Raises
    ------
    RecordingError
        It cannot be read, or is no MCAP file.
    """
    return _survey(McapStream(path))[0]


def import_ros2(
    bag: Path, out: Path, wanted: Wanted | None = None, progress: Callable[[int, int], None] | None = None
) -> Imported:
    """
    Make a recording of a bag's wrenches (WrenchStamped) and flange poses (TF, PoseStamped or JointState).

    The samples' time is when the bag got them, s after its first message, and the time in their headers
    becomes the device's time; the other way round with `header_stamps`.

    Parameters
    ----------
    bag : path
        An MCAP file.
    out : path
        Must not exist.
    wanted : Wanted, optional
    progress : callable, optional
        Gets the bytes read so far, and those in the file.

    Raises
    ------
    RecordingError
        The bag cannot be read, has no wrenches, or leaves open which topics or frames are meant: the message
        lists them. Or the recording cannot be written.
    InputError
        The robot's kinematics cannot be loaded.
    """
    wanted = wanted or Wanted()
    topics, begin, pairs = _survey(McapStream(bag))
    wrench = _choose(bag, topics, (WRENCH_STAMPED,), wanted.wrench_topic, "--wrench-topic")
    if wrench is None:
        listed = ", ".join(f"{topic.name} ({topic.type})" for topic in topics)
        raise RecordingError(
            f"{bag}: there is no topic of WrenchStamped messages; there are: {listed or 'no messages'}."
        )
    warnings: list[str] = []
    where = _choose_pose(bag, topics, wanted, warnings)
    frames = _frames(bag, pairs, wanted) if where is not None and where.type == TF else None
    devices = [DeviceInfo("wrench", WRENCH_TOPIC, f"ros2:{wrench.name}")]
    if where is not None:
        devices.append(DeviceInfo("flange", FLANGE_TOPIC, f"ros2:{where.name}"))
    about = RecordingInfo(begin, 0.0, tuple(devices), note=f"imported from {bag.name}")
    stream = McapStream(bag, progress)
    try:
        writer = RecordingWriter(out, about, sync_seconds=60.0)
        try:
            task = _Import(writer, begin, wanted, wrench, where, frames)
            with writer:
                _run(task, stream)
        except BaseException:
            out.unlink(missing_ok=True)  # half an import helps nobody: the bag is still there
            raise
    finally:
        stream.close()
    return Imported(
        wrench.name,
        None if where is None else where.name,
        task.wrenches,
        task.poses,
        (*warnings, *stream.warnings),
    )


def _run(task: _Import, stream: McapStream) -> None:
    for message in stream:
        if isinstance(message, Message):
            task.take(message, stream.warn)


class _Import:
    def __init__(
        self,
        writer: RecordingWriter,
        begin: int,
        wanted: Wanted,
        wrench: Topic,
        where: Topic | None,
        frames: Frames | None,
    ) -> None:
        self._writer, self._begin, self._wanted, self._frames = writer, begin, wanted, frames
        self._decoders: dict[str, Callable[[bytes], Any]] = {wrench.name: decoder(WRENCH_STAMPED)}
        self._wrench, self._where = wrench, where
        if where is not None:
            self._decoders[where.name] = decoder(where.type)
            if where.type == TF:
                self._decoders[_STATIC] = decoder(TF)
        self.wrenches = self.poses = 0

    def take(self, message: Message, warn: Callable[[str], None]) -> None:
        topic = message.channel.topic
        if topic not in self._decoders or ros2_type(message) not in DEFINITIONS:
            return
        try:
            body = self._decoders[topic](message.data)
            if topic == self._wrench.name:
                self._take_wrench(message, body)
            else:
                self._take_pose(message, body)
        except ValueError as error:
            if isinstance(error, InputError) and not isinstance(error, SampleError):
                raise
            warn(f"A message on {topic[:80]!r} is left out ({error}).")

    def _take_wrench(self, message: Message, body: Any) -> None:
        force, torque = body.wrench.force, body.wrench.torque
        time, other = self._times(message, body.header)
        sample = WrenchSample(
            time, (force.x, force.y, force.z), (torque.x, torque.y, torque.z), device_time=other
        )
        self._writer.wrench(sample)
        self.wrenches += 1

    def _take_pose(self, message: Message, body: Any) -> None:
        joints = None
        if self._frames is not None:
            if not self._frames.update(body) or message.channel.topic == _STATIC:
                return
            found = self._frames.pose()
            if found is None:
                return
            time, other = self._times(message, body.transforms[-1].header)
        else:
            time, other = self._times(message, body.header)
            if self._where is not None and self._where.type == JOINT_STATE and self._wanted.robot is not None:
                found, joints = joint_pose(body, self._wanted.robot)
            else:
                found = pose(body.pose.position, body.pose.orientation)
        self._writer.flange(FlangeSample(time, *found, joints, other))
        self.poses += 1

    def _times(self, message: Message, header: Any) -> tuple[float, float | None]:
        received = (message.log_time - self._begin) / 1e9
        stamp_ns = header.stamp.sec * 10**9 + header.stamp.nanosec
        if self._wanted.header_stamps:
            if stamp_ns == 0:
                raise ValueError("its header has no time: import without --header-stamps")
            return (stamp_ns - self._begin) / 1e9, received
        return received, stamp_ns / 1e9 if stamp_ns else None


def ros2_type(message: Message) -> str:
    """Return the full name of a message's type, also where it is written without /msg/."""
    package, _, name = message.channel.schema_name.partition("/")
    return f"{package}/msg/{name.removeprefix('msg/')}" if name else package


def _survey(stream: McapStream) -> tuple[tuple[Topic, ...], int, frozenset[tuple[str, str]]]:
    """Return the topics, the first log time, and which frames transforms are between."""
    counts: Counter[tuple[str, str]] = Counter()
    begin, read_tf = 2**63 - 1, decoder(TF)
    pairs: set[tuple[str, str]] = set()
    try:
        for message in stream:
            if not isinstance(message, Message):
                continue
            kind = ros2_type(message)
            counts[message.channel.topic, kind] += 1
            begin = min(begin, message.log_time)
            if kind == TF and message.channel.encoding == "cdr" and len(pairs) < _MOST_PAIRS:
                pairs |= _pairs(read_tf, message.data)
    finally:
        stream.close()
    topics = tuple(Topic(name, kind, count) for (name, kind), count in sorted(counts.items()))
    return topics, begin if counts else 0, frozenset(pairs)


def _pairs(read_tf: Callable[[bytes], Any], data: bytes) -> set[tuple[str, str]]:
    try:
        items = read_tf(data).transforms
    except ValueError:  # told when it is imported
        return set()
    return {(item.header.frame_id.lstrip("/"), item.child_frame_id.lstrip("/")) for item in items}


def _choose(
    bag: Path, topics: tuple[Topic, ...], types: tuple[str, ...], name: str | None, option: str
) -> Topic | None:
    there = [topic for topic in topics if topic.type in types and topic.name != _STATIC]
    listed = ", ".join(f"{topic.name} ({topic.type}, {topic.count:,})" for topic in there)
    if name is not None:
        for topic in there:
            if topic.name == name:
                return topic
        raise RecordingError(f"{bag}: {option}: {name} is none of: {listed or 'no such topics are there'}.")
    if len(there) > 1:
        raise RecordingError(f"{bag}: there are several topics: {listed}. Choose one: {option} NAME.")
    return there[0] if there else None


def _choose_pose(bag: Path, topics: tuple[Topic, ...], wanted: Wanted, warnings: list[str]) -> Topic | None:
    types: tuple[str, ...] = _POSE_TYPES if wanted.robot is None else (JOINT_STATE,)
    if wanted.pose_topic is None and wanted.robot is None:
        types = (TF, POSE_STAMPED)
    chosen = _choose(bag, topics, types, wanted.pose_topic, "--pose-topic")
    if chosen is not None and chosen.type == JOINT_STATE and wanted.robot is None:
        raise RecordingError(f"{bag}: {chosen.name} has joints: say of which robot, --robot NAME.")
    if chosen is None:
        joints = any(topic.type == JOINT_STATE for topic in topics)
        remedy = " Joints are there: say of which robot, --robot NAME." if joints else ""
        warnings.append(f"There are no poses of the flange in the bag.{remedy}")
    return chosen


def _frames(bag: Path, pairs: frozenset[tuple[str, str]], wanted: Wanted) -> Frames:
    if (wanted.base is None) != (wanted.flange is None):
        raise RecordingError(f"{bag}: --base and --flange go together: between which frames.")
    if wanted.base is not None and wanted.flange is not None:
        base, flange = wanted.base.lstrip("/"), wanted.flange.lstrip("/")
        known = {name for pair in pairs for name in pair}
        for name in (base, flange):
            if name not in known:
                raise RecordingError(f"{bag}: there is no frame {name}; there are: {_some(known)}.")
        return Frames(base, flange)
    if len(pairs) != 1:
        names = _some({f"{parent} -> {child}" for parent, child in pairs})
        raise RecordingError(
            f"{bag}: say between which frames the flange's pose is: --base NAME --flange NAME. There are: {names}."
        )
    return Frames(*next(iter(pairs)))


def _some(names: set[str]) -> str:
    shown = sorted(names)[:40]
    return ", ".join(shown) + (", ..." if len(names) > len(shown) else "")
