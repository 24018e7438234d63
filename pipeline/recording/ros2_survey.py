"""What is in a ROS 2 bag: its topics, and how its frames hang together; known before anything is imported."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactbench.pipeline.recording.ros2_poses import numbers
from contactbench.pipeline.recording.ros2_types import TF, WRENCH_STAMPED, decoder
from contactbench.pipeline.recording.stream import McapMessage, McapStream

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

_CDR = "cdr"  # how ROS 2 writes messages; those of ROS 1 look alike and are not
_MOST_PAIRS = 1000


@dataclass(frozen=True)
class Topic:
    """A topic of a bag, the type of its messages, how many there are, and how they are written."""

    name: str
    type: str
    count: int
    encoding: str = _CDR

    @property
    def static(self) -> bool:
        """Its transforms hold for good; robots with a namespace have their own."""
        return self.name.rpartition("/")[2] == "tf_static"

    @property
    def readable(self) -> bool:
        """Its messages are written as ROS 2 does."""
        return self.encoding == _CDR


@dataclass(frozen=True)
class Survey:
    """What is in a bag."""

    topics: tuple[Topic, ...]  # those that have messages
    begin: int  # time of the first message, ns
    pairs: frozenset[tuple[str, str]]  # parent and child of all transforms
    moving: frozenset[tuple[str, str]]  # topic and child of those transforms that change
    wrench_frames: Mapping[str, str]  # the frame that the first wrench of a topic names


def survey(path: Path) -> Survey:
    """
    Look through a bag once.

    Raises
    ------
    RecordingError
        It cannot be read, or is no MCAP file.
    """
    counts: Counter[tuple[str, str, str]] = Counter()
    begin, frames = 2**63 - 1, _Seen()
    stream = McapStream(path)
    try:
        for message in stream:
            if not isinstance(message, McapMessage):
                continue
            counts[message.channel.topic, ros2_type(message), message.channel.encoding] += 1
            begin = min(begin, message.log_time)
            frames.look(message)
    finally:
        stream.close()
    topics = tuple(Topic(name, kind, count, how) for (name, kind, how), count in sorted(counts.items()))
    return Survey(
        topics,
        begin if counts else 0,
        frozenset(frames.pairs),
        frozenset(frames.moving),
        frames.wrench_frames,
    )


def ros2_type(message: McapMessage) -> str:
    """Return the full name of a message's type, also where it is written without /msg/."""
    package, _, name = message.channel.schema_name.partition("/")
    return f"{package}/msg/{name.removeprefix('msg/')}" if name else package


class _Seen:
    def __init__(self) -> None:
        self._read_tf, self._read_wrench = decoder(TF), decoder(WRENCH_STAMPED)
        self._first: dict[tuple[str, str], tuple[object, ...]] = {}
        self.pairs: set[tuple[str, str]] = set()
        self.moving: set[tuple[str, str]] = set()
        self.wrench_frames: dict[str, str] = {}

    def look(self, message: McapMessage) -> None:
        kind, topic = ros2_type(message), message.channel.topic
        if message.channel.encoding != _CDR:
            return
        try:
            if kind == TF:
                for item in self._read_tf(message.data).transforms:
                    self._transform(topic, item)
            elif kind == WRENCH_STAMPED and topic not in self.wrench_frames:
                frame = self._read_wrench(message.data).header.frame_id
                self.wrench_frames[topic] = frame.lstrip("/")
        except ValueError:  # told when it is imported
            return

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
