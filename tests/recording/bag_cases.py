"""Bags for tests: messages by the reference library, and the same messages stored in every other way."""

from collections.abc import Callable
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

from mcap.writer import Writer
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from contactbench.pipeline.recording.ros2_poses import JOINT_STATE, POSE_STAMPED, TF, WRENCH_STAMPED
from contactbench.pipeline.recording.stream import McapMessage, McapStream

_ROS1, _ROS2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_HUMBLE)
_ROS1.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", TF))
DEFINITIONS = {
    kind: _ROS2.generate_msgdef(kind, ros_version=2)[0]
    for kind in (WRENCH_STAMPED, TF, POSE_STAMPED, JOINT_STATE)
}


def messages(mcap: Path) -> list[McapMessage]:
    with closing(McapStream(mcap)) as stream:
        return [each for each in stream if isinstance(each, McapMessage)]


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


def _written(
    writer: Any, store: Any, convert: Callable[[bytes, str], bytes], mcap: Path, mode: Any = None
) -> Path:
    if mode is not None:
        writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        connections: dict[str, Any] = {}
        for each in messages(mcap):
            topic, kind = each.channel.topic, each.channel.schema_name
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(connections[topic], each.log_time, convert(each.data, kind))
    return mcap.with_name("bag")


def _ros1(packed: str | None, indexed: bool, mcap: Path) -> Path:
    writer, bag = Ros1Writer(mcap.with_name("bag")), mcap.with_name("bag")
    if packed is not None:
        writer.set_compression(Ros1Writer.CompressionFormat[packed])
    _written(writer, _ROS1, _ROS2.cdr_to_ros1, mcap)
    if not indexed:  # as a recorder leaves it that was killed
        data = bag.read_bytes()
        place = data.index(b"index_pos=") + 10
        index = int.from_bytes(data[place : place + 8], "little")
        bag.write_bytes(data[:place] + bytes(8) + data[place + 8 : index])
    return bag


def _ros2(storage: StoragePlugin, mode: CompressionMode | None, mcap: Path) -> Path:
    writer = Ros2Writer(mcap.with_name("bag"), version=9, storage_plugin=storage)
    return _written(writer, _ROS2, lambda data, _: data, mcap, mode)


def _halves(mcap: Path) -> Path:
    """Two files whose names sort wrongly as text."""
    folder = mcap.with_name("bag")
    folder.mkdir()
    (folder / "metadata.yaml").write_text("rosbag2_bagfile_information: {}\n")
    every = messages(mcap)
    write_mcap(folder / "bag_9.mcap", every[: len(every) // 2])
    write_mcap(folder / "bag_10.mcap", every[len(every) // 2 :])
    return folder


STORED: dict[str, Callable[[Path], Path]] = (
    {"halves": _halves}
    | {
        f"ros1-{packed}-{indexed}": partial(_ros1, packed, indexed)
        for packed, indexed in ((None, True), ("BZ2", True), ("LZ4", False), (None, False))
    }
    | {
        f"{storage.name}-{mode}": partial(_ros2, storage, mode)
        for storage in StoragePlugin
        for mode in (None, CompressionMode.FILE, CompressionMode.MESSAGE)
    }
)
