"""Bags for tests: messages by the reference library, and the same messages stored in every other way."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING, Any

import zstandard
from mcap.writer import Writer
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from contactbench.pipeline.recording.ros2_poses import JOINT_STATE, POSE_STAMPED, TF, WRENCH_STAMPED
from contactbench.pipeline.recording.stream import McapMessage, McapStream

if TYPE_CHECKING:
    from pathlib import Path

_ROS1, _ROS2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
_ROS1.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", TF))
DEFINITIONS = {
    kind: _ROS2.generate_msgdef(kind, ros_version=2)[0]
    for kind in (WRENCH_STAMPED, TF, POSE_STAMPED, JOINT_STATE)
}


def messages(mcap: Path) -> list[McapMessage]:
    stream = McapStream(mcap)
    with closing(stream):
        return [each for each in stream if isinstance(each, McapMessage)]


def _sqlite(mcap: Path, out: Path) -> Path:
    with closing(sqlite3.connect(out)) as database:
        database.execute(
            "CREATE TABLE topics (id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT)"
        )
        database.execute(
            "CREATE TABLE messages (id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)"
        )
        database.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
        numbers: dict[str, int] = {}
        for each in messages(mcap):
            topic = each.channel.topic
            if topic not in numbers:
                numbers[topic] = len(numbers) + 1
                database.execute(
                    "INSERT INTO topics VALUES (?, ?, ?, 'cdr')",
                    (numbers[topic], topic, each.channel.schema_name),
                )
            row = numbers[topic], each.log_time, each.data
            database.execute("INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)", row)
        database.commit()
    return out


def _ros1(mcap: Path, out: Path) -> Path:
    with Ros1Writer(out) as writer:
        connections: dict[str, Any] = {}
        for each in messages(mcap):
            topic, kind = each.channel.topic, each.channel.schema_name
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=_ROS1)
            data = _ROS2.cdr_to_ros1(each.data, kind)
            writer.write(connections[topic], each.log_time, data)
    return out


def _packed(file: Path) -> Path:
    out = file.with_name(f"{file.name}.zstd")
    out.write_bytes(zstandard.compress(file.read_bytes()))
    return out


def write_mcap(out: Path, every: list[McapMessage]) -> Path:
    with out.open("wb") as stream:
        writer = Writer(stream)
        writer.start("ros2")
        channels: dict[str, int] = {}
        for each in every:
            topic, kind = each.channel.topic, each.channel.schema_name
            if topic not in channels:
                schema = writer.register_schema(kind, "ros2msg", DEFINITIONS[kind].encode())
                channels[topic] = writer.register_channel(topic, each.channel.encoding, schema)
            writer.add_message(channels[topic], each.log_time, each.data, each.log_time)
        writer.finish()
    return out


def _packed_messages(mcap: Path, out: Path) -> Path:
    return write_mcap(out, [each._replace(data=zstandard.compress(each.data)) for each in messages(mcap)])


def _folder(mcap: Path, out: Path) -> Path:
    """Two files whose names sort wrongly as text, and what rosbag2 writes beside them."""
    out.mkdir()
    (out / "metadata.yaml").write_text("rosbag2_bagfile_information: {}\n")
    every = messages(mcap)
    write_mcap(out / "bag_9.mcap", every[: len(every) // 2])
    write_mcap(out / "bag_10.mcap", every[len(every) // 2 :])
    return out


STORED = {
    "mcap": lambda mcap, _: mcap,
    "mcap.zstd": lambda mcap, _: _packed(mcap),
    "messages": lambda mcap, folder: _packed_messages(mcap, folder / "messages.mcap"),
    "sqlite": lambda mcap, folder: _sqlite(mcap, folder / "bag.db3"),
    "sqlite.zstd": lambda mcap, folder: _packed(_sqlite(mcap, folder / "bag.db3")),
    "folder": lambda mcap, folder: _folder(mcap, folder / "bag"),
    "ros1": lambda mcap, folder: _ros1(mcap, folder / "bag.bag"),
}
