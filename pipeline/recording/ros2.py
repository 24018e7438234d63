"""Import of bags of ROS 2 and ROS 1; ROS itself is not needed."""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import SpooledTemporaryFile
from typing import IO, Any

from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.errors import InputError, RecordingError, SampleError, arg, join, message
from contactbench.pipeline.files import Progress, unheard
from contactbench.pipeline.recording.bags import Bag
from contactbench.pipeline.recording.clock_steps import ClockSteps
from contactbench.pipeline.recording.messages import FLANGE_TOPIC, WRENCH_TOPIC, DeviceInfo, RecordingInfo
from contactbench.pipeline.recording.recorder import RecordingWriter
from contactbench.pipeline.recording.ros2_poses import (
    CDR,
    JOINT_STATE,
    POSE_STAMPED,
    ROS1,
    TF,
    WRENCH_STAMPED,
    XCDR2,
    TransformTree,
    decoder,
    encoding_of,
    joint_pose,
    numbers,
    pose,
    stamp_of,
)
from contactbench.pipeline.recording.stream import Channel, McapMessage, Warnings
from contactbench.pipeline.robot import Robot

_POSE_TYPES = (TF, POSE_STAMPED, JOINT_STATE)
_LONGEST_NAME = 80
_MOST_JOINTS = 64
_FEW = 2  # moments at the ends of a bag may be cut in half


@dataclass(frozen=True)
class ImportChoice:
    """What to import; what is left out is chosen where there is one of a kind."""

    wrench_topic: str | None = None
    pose_topic: str | None = None
    robot: Robot | None = None  # makes poses of joints
    # Frames of transforms; both or none.
    base: str | None = None
    flange: str | None = None
    header_stamps: bool = False  # times are those in the messages' headers, not when they were received


@dataclass(frozen=True)
class Imported:
    """What was imported: the topics, how many samples, and what should make one doubt."""

    wrench_topic: str
    pose_topic: str | None
    wrenches: int
    poses: int
    warnings: tuple[str, ...]


def import_ros2(
    bag: Path, out: Path, wanted: ImportChoice | None = None, progress: Progress = unheard
) -> Imported:
    """
    Make a recording of a bag's wrenches (WrenchStamped) and flange poses (TF, PoseStamped or JointState).

    The samples' time is when the bag got them, s after its first message, and the time in their headers
    becomes the device's time; the other way round with `header_stamps`.

    Parameters
    ----------
    bag : path
        As for `Bag`.
    out : path
        Must not exist.
    wanted : ImportChoice, optional
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
    wanted = wanted or ImportChoice()
    warnings, said = Warnings(), list[str]()
    with Bag(bag) as source, SpooledTemporaryFile(_IN_MEMORY) as room:
        kept = _Kept(room)
        found = _survey(source, kept, warnings, progress)
        wrench = _choose_wrench(bag, found.topics, wanted)
        where = _choose_pose(bag, found.topics, wanted, said)
        frames = _frames(bag, found, where, wanted) if where is not None and where.type == TF else None
        frame = found.wrench_frames.get(wrench.name, "")
        writer = RecordingWriter(out, _about(bag, found.begin, wrench, where, frame), sync_seconds=60.0)
        try:
            task = _Import(writer, found, wanted, wrench, where, frames)
            with writer:
                for raw in kept:
                    task.take(raw, warnings.add)
        except BaseException:
            out.unlink(missing_ok=True)  # half an import helps nobody: the bag is still there
            raise
    return Imported(
        wrench.name,
        None if where is None else where.name,
        task.wrenches,
        task.poses,
        (*said, *warnings, *task.doubts()),
    )


def _about(bag: Path, begin: int, wrench: Topic, where: Topic | None, frame: str) -> RecordingInfo:
    devices = [DeviceInfo("wrench", WRENCH_TOPIC, f"ros2:{wrench.name}")]
    if where is not None:
        devices.append(DeviceInfo("flange", FLANGE_TOPIC, f"ros2:{where.name}"))
    said = message(f"; wrenches in frame {arg(frame[:_LONGEST_NAME])}") if frame else ""
    return RecordingInfo(
        begin, 0.0, tuple(devices), note=message(f"imported from {arg(bag.name)}{arg(said)}")
    )


class _Import:
    def __init__(
        self,
        writer: RecordingWriter,
        found: Survey,
        wanted: ImportChoice,
        wrench: Topic,
        where: Topic | None,
        frames: TransformTree | None,
    ) -> None:
        self._writer, self._found, self._wanted, self._frames = writer, found, wanted, frames
        self._wrench, self._where = wrench, where
        taken = [wrench] if where is None else [wrench, where]
        if frames is not None:
            taken += [topic for topic in found.topics if topic.static and topic.type == TF and topic.readable]
        self._taken = {topic.name: (topic, decoder(topic.type, topic.encoding)) for topic in taken}
        self._frame, self._other_frame = found.wrench_frames.get(wrench.name, ""), ""
        self._base = frozenset[str]() if frames is None else frames.fixed
        # Of messages that gave no pose: their names, and whether with angles.
        self._joints: dict[str, bool] = {}
        self._steps = ClockSteps()
        self.wrenches = self.poses = 0

    def take(self, raw: McapMessage, warn: Callable[[str], None]) -> None:
        name = raw.channel.topic
        if name not in self._taken:
            return
        topic, decode = self._taken[name]
        if ros2_type(raw) != topic.type or encoding_of(raw) != topic.encoding or self._found.absurd(raw):
            return
        try:
            body = decode(raw.data)
            if topic is self._wrench:
                self._take_wrench(raw, body)
            elif self._frames is not None:
                self._take_transforms(raw, body, self._frames, static=topic.static)
            else:
                self._take_pose(raw, body)
        except ValueError as error:
            if isinstance(error, InputError) and not isinstance(error, SampleError):
                raise
            warn(message(f"A message on {arg(name[:_LONGEST_NAME])!r} was left out ({arg(error)})."))

    def doubts(self) -> Iterator[str]:
        """Say what the whole of it should make one doubt."""
        yield from self._steps.told()
        if self._found.strays:
            yield message(
                f"{arg(self._found.strays)} messages were left out: their times are more than a day from all others."
            )
        if self._frame in self._base:
            yield message(
                f"The wrenches on {arg(self._wrench.name)} are in frame {arg(self._frame)!r}, along the axes of the"
                " robot's base. contactbench needs them along the sensor's: record the sensor's own topic."
            )
        if self._other_frame:
            yield message(
                f"The wrenches on {arg(self._wrench.name)} are in several frames, {arg(self._frame)!r} and"
                f" {arg(self._other_frame)!r}: check that they come from one sensor."
            )
        if self._where is not None and not self.poses:
            why = self._no_joints() if self._frames is None else f" {self._frames.obstacle()}"
            yield message(
                f"No message on {arg(self._where.name)} gives a pose of the"
                f" flange{arg(':' if why else '.')}{arg(why)}"
            )
        elif self._frames is not None and self._frames.missed > _FEW + self.poses / 100:
            yield message(
                f"{arg(self._frames.missed):,} samples have no pose: not all transforms between the"
                " frames have their time stamp."
            )

    def _no_joints(self) -> str:
        """Say which joints there are beside those of the robot; nothing where none is known."""
        if self._wanted.robot is None or not self._joints:
            return ""
        wanted = join(", ", [joint.name for joint in self._wanted.robot.description.joints])
        there = join(", ", self._joints)
        if not any(self._joints.values()):
            return message(f" its messages name the joints {arg(there)}, but have no angles.")
        return message(f" the robot has the joints {arg(wanted)}, the messages {arg(there)}.")

    def _take_wrench(self, raw: McapMessage, body: Any) -> None:
        force, torque = body.wrench.force, body.wrench.torque
        time, other = self._times(raw, stamp_of(body.header))
        if (frame := body.header.frame_id.lstrip("/")) != self._frame:
            self._other_frame = self._other_frame or frame[:_LONGEST_NAME] or "none"
        both = (force.x, force.y, force.z), (torque.x, torque.y, torque.z)
        self._writer.wrench(WrenchSample(time, *both, device_time=other))
        if other is not None:
            self._steps.beside(time, other)
        self.wrenches += 1

    def _take_transforms(self, raw: McapMessage, body: Any, frames: TransformTree, *, static: bool) -> None:
        bad = frames.update(body, raw.log_time, static=static)
        stamp = None if static else frames.due()
        found = None if stamp is None else frames.pose()
        if stamp is not None and found is not None:
            time, other = self._times(raw, stamp)
            self._writer.flange(FlangeSample(time, *found, None, other))
            self.poses += 1
        if bad:
            raise ValueError(message(f"the transform to {arg(bad[0][:_LONGEST_NAME])} is no pose"))

    def _take_pose(self, raw: McapMessage, body: Any) -> None:
        joints = None
        if self._where is not None and self._where.type == JOINT_STATE and self._wanted.robot is not None:
            by_joints = joint_pose(body, self._wanted.robot)
            if by_joints is None:
                if len(self._joints) < _MOST_JOINTS:
                    self._joints.update(dict.fromkeys(body.name[:_MOST_JOINTS], len(body.position) > 0))
                return
            found, joints = by_joints
        else:
            self._base = frozenset((body.header.frame_id.lstrip("/"),))
            found = pose(body.pose.position, body.pose.orientation)
        time, other = self._times(raw, stamp_of(body.header))
        self._writer.flange(FlangeSample(time, *found, joints, other))
        self.poses += 1

    def _times(self, raw: McapMessage, stamp_ns: int) -> tuple[float, float | None]:
        received = (raw.log_time - self._found.begin) / 1e9
        if self._wanted.header_stamps:
            if stamp_ns == 0:
                raise ValueError(message("its header has no time: import without --header-stamps"))
            stamped = (stamp_ns - self._found.begin) / 1e9
            return self._steps.at(raw.channel.topic, stamped), received
        return self._steps.at(raw.channel.topic, received), stamp_ns / 1e9 if stamp_ns else None


def _choose_wrench(bag: Path, topics: tuple[Topic, ...], wanted: ImportChoice) -> Topic:
    wrench = _choose(bag, topics, (WRENCH_STAMPED,), wanted.wrench_topic, "--wrench-topic")
    if wrench is not None:
        return wrench
    listed = ", ".join(f"{topic.name} ({topic.type})" for topic in topics) or message("no messages")
    raise RecordingError(
        f"{arg(bag)}: there is no topic of WrenchStamped messages; there are: {arg(listed)}."
    )


def _choose(
    bag: Path, topics: tuple[Topic, ...], types: tuple[str, ...], name: str | None, option: str
) -> Topic | None:
    there = [topic for topic in topics if topic.type in types and topic.readable and not topic.static]
    for topic in topics:
        if topic.type in types and topic.encoding == XCDR2 and name in (None, topic.name):
            raise RecordingError(
                f"{arg(bag)}: the messages on {arg(topic.name)} are written in XCDR2, which contactbench does not"
                " read: record with a middleware that writes XCDR1, the default of ROS 2."
            )
    listed = ", ".join(f"{topic.name} ({topic.type}, {topic.count:,})" for topic in there)
    if name is not None:
        for topic in there:
            if topic.name == name:
                return topic
        listed = listed or message("no such topics are there")
        raise RecordingError(f"{arg(bag)}: {arg(option)}: {arg(name)} is not one of: {arg(listed)}.")
    if len(there) > 1:
        raise RecordingError(
            f"{arg(bag)}: there are several topics: {arg(listed)}. Choose one: {arg(option)} NAME."
        )
    return there[0] if there else None


def _choose_pose(
    bag: Path, topics: tuple[Topic, ...], wanted: ImportChoice, warnings: list[str]
) -> Topic | None:
    types: tuple[str, ...] = _POSE_TYPES if wanted.robot is None else (JOINT_STATE,)
    if wanted.pose_topic is None and wanted.robot is None:
        types = (TF, POSE_STAMPED)
    chosen = _choose(bag, topics, types, wanted.pose_topic, "--pose-topic")
    if chosen is not None and chosen.type == JOINT_STATE and wanted.robot is None:
        raise RecordingError(
            f"{arg(bag)}: {arg(chosen.name)} has joints: name their robot with --robot NAME."
        )
    if chosen is None:
        joints = any(topic.type == JOINT_STATE for topic in topics)
        remedy = message(" It has joints: name their robot with --robot NAME.") if joints else ""
        warnings.append(message(f"The bag contains no poses of the flange.{arg(remedy)}"))
    return chosen


def _frames(bag: Path, found: Survey, where: Topic, wanted: ImportChoice) -> TransformTree:
    pairs = found.pairs
    moving = frozenset(child for topic, child in found.moving if topic == where.name)
    if (wanted.base is None) != (wanted.flange is None):
        raise RecordingError(f"{arg(bag)}: give both --base and --flange, the two frames of the pose.")
    if wanted.base is not None and wanted.flange is not None:
        base, flange = wanted.base.lstrip("/"), wanted.flange.lstrip("/")
        known = {name for pair in pairs for name in pair}
        for name in (base, flange):
            if name not in known:
                raise RecordingError(
                    f"{arg(bag)}: there is no frame {arg(name)}; there are: {arg(_some(known))}."
                )
        return _seeded(TransformTree(base, flange, moving), found)
    if len(pairs) != 1:
        names = _some({f"{parent} -> {child}" for parent, child in pairs})
        raise RecordingError(
            f"{arg(bag)}: name the two frames of the flange's pose: --base NAME --flange NAME. There are: {arg(names)}."
        )
    return _seeded(TransformTree(*next(iter(pairs)), moving), found)


def _seeded(frames: TransformTree, found: Survey) -> TransformTree:
    for body in reversed(found.static):  # the first holds before it was recorded, too
        frames.update(body, 0, static=True)
    return frames


def _some(names: set[str]) -> str:
    shown = sorted(names)[:40]
    return join(", ", shown) + (", ..." if len(names) > len(shown) else "")


# ---- what is in a bag ------------------------------------------------------------------------------


_MOST_PAIRS = 1000
_DAY_NS = 86_400 * 10**9
_HEAD, _IN_MEMORY = struct.Struct("<IQI"), 2**26  # before a message that is kept; bytes
_STRAYS = 0.01  # share of the messages that may be days away from the others


@dataclass(frozen=True)
class Topic:
    """A topic of a bag, the type of its messages, how many there are, and how they are written."""

    name: str
    type: str
    count: int
    encoding: str = CDR

    @property
    def static(self) -> bool:
        """Its transforms hold for good; robots with a namespace have their own."""
        return self.name.rpartition("/")[2] == "tf_static"

    @property
    def readable(self) -> bool:
        """Its messages are written in a way that is known."""
        return self.encoding in (CDR, ROS1)


@dataclass
class Survey:
    """What is in a bag, as far as it was looked through."""

    topics: tuple[Topic, ...] = ()  # those that have messages
    begin: int = 0  # time of the first message, ns
    pairs: set[tuple[str, str]] = field(default_factory=set)  # parent and child of all transforms
    # moving: topic and child of those transforms that change
    moving: set[tuple[str, str]] = field(default_factory=set)
    # wrench_frames: the frame that the first wrench of a topic names
    wrench_frames: dict[str, str] = field(default_factory=dict)
    static: list[Any] = field(default_factory=list)  # the static transforms, decoded
    days: frozenset[int] = frozenset()  # since 1970, on which the messages are
    strays: int = 0  # messages on other days: no clock of this bag
    _first: dict[tuple[str, str], tuple[object, ...]] = field(default_factory=dict)

    def absurd(self, raw: McapMessage) -> bool:
        """Tell whether a message has a time that is no time of this bag."""
        return raw.log_time // _DAY_NS not in self.days

    def look(self, message: McapMessage, kind: str) -> None:
        """Take in the frames that a message of this kind names."""
        topic = message.channel.topic
        wrench = kind == WRENCH_STAMPED and topic not in self.wrench_frames
        if not (kind == TF or wrench) or (encoding := encoding_of(message)) not in (CDR, ROS1):
            return
        try:
            body = decoder(kind, encoding)(message.data)
        except ValueError:  # told when it is imported
            return
        if wrench:
            self.wrench_frames[topic] = body.header.frame_id.lstrip("/")
            return
        for item in body.transforms:
            self._transform(topic, item)
        if Topic(topic, kind, 1).static and len(self.static) < _MOST_PAIRS:
            self.static.append(body)

    def _transform(self, topic: str, item: Any) -> None:
        parent, child = item.header.frame_id.lstrip("/"), item.child_frame_id.lstrip("/")
        if len(self.pairs) < _MOST_PAIRS:
            self.pairs.add((parent, child))
        key = topic, child
        if key in self.moving or (key not in self._first and len(self._first) >= _MOST_PAIRS):
            return
        try:
            there = parent, *numbers(item.transform.translation, item.transform.rotation)
        except ValueError:
            return
        if self._first.setdefault(key, there) != there:
            self.moving.add(key)


class _Kept:
    """The messages that may be imported, on disk where they are many: so a bag is gone through once."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file, self._channels = file, dict[Channel, int]()

    def add(self, raw: McapMessage) -> None:
        number = self._channels.setdefault(raw.channel, len(self._channels))
        self._file.write(_HEAD.pack(number, raw.log_time, len(raw.data)) + raw.data)

    def __iter__(self) -> Iterator[McapMessage]:
        self._file.seek(0)
        channels = list(self._channels)
        while head := self._file.read(_HEAD.size):
            number, time, size = _HEAD.unpack(head)
            yield McapMessage(channels[number], time, self._file.read(size))


def _survey(bag: Bag, kept: _Kept, warnings: Warnings, progress: Progress) -> Survey:
    """Look through a bag, and keep what may be imported."""
    counts: Counter[tuple[str, str, str]] = Counter()
    days: Counter[int] = Counter()
    first: dict[int, int] = {}  # time of each day
    found = Survey()
    for each in bag.messages(warnings, progress):
        kind = ros2_type(each)
        counts[each.channel.topic, kind, encoding_of(each)] += 1
        if kind in (WRENCH_STAMPED, *_POSE_TYPES):
            kept.add(each)
            found.look(each, kind)
        day = each.log_time // _DAY_NS
        days[day] += 1
        first[day] = min(first.get(day, each.log_time), each.log_time)
    if warnings and not counts:
        raise RecordingError(f"{arg(bag.path)}: it has no message that can be read. {arg(warnings[0])}")
    found.topics = tuple(Topic(name, kind, count, how) for (name, kind, how), count in sorted(counts.items()))
    usual = {day for day, count in days.items() if count > _STRAYS * days.total()}
    found.days = frozenset(day for day in days if {day - 1, day, day + 1} & usual)
    found.begin = min((first[day] for day in found.days), default=0)
    found.strays = sum(count for day, count in days.items() if day not in found.days)
    return found


_OLD_TF = "tf/msg/tfMessage"  # of ROS 1 before tf2, and the same


def ros2_type(message: McapMessage) -> str:
    """Return the full name of a message's type, also where it is written without /msg/."""
    package, _, name = message.channel.schema_name.partition("/")
    full = f"{package}/msg/{name.removeprefix('msg/')}" if name else package
    return TF if full == _OLD_TF else full
