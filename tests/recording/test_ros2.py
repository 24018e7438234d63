"""Import of ROS 2 bags, written with the reference library."""

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap_ros2.writer import Writer
from recording.bag_cases import DEFINITIONS, STORED, messages, write_mcap
from recording.recording_cases import ABOUT, flange_samples, wrench_samples
from rosbags.highlevel import AnyReader
from scipy.spatial.transform import Rotation
from terminal import invoke

from contactbench.pipeline.devices.sample import Status
from contactbench.pipeline.recording import RecordingError, RecordingWriter, read_recording
from contactbench.pipeline.recording.ros2 import ImportChoice, import_ros2
from contactbench.pipeline.recording.ros2_poses import JOINT_STATE, POSE_STAMPED, TF, WRENCH_STAMPED
from contactbench.pipeline.robot import Robot

START = 1_700_000_000_000_000_000
STEP = 10_000_000


class Bag:
    """A bag of messages every 10 ms; the headers are half a second early."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self._stream = file.open("wb")
        self._writer = Writer(self._stream, chunk_size=2000)
        self._schemas: dict[str, Any] = {}

    def add(self, topic: str, kind: str, number: int, body: dict[str, Any]) -> None:
        if kind not in self._schemas:
            self._schemas[kind] = self._writer.register_msgdef(kind, DEFINITIONS[kind])
        self._writer.write_message(topic, self._schemas[kind], body, START + number * STEP)

    def wrench(self, number: int, topic: str = "/ft/wrench") -> None:
        force = {"x": number + 0.125, "y": -1.5, "z": 1 / 3}
        body = {"wrench": {"force": force, "torque": {"x": 0.1, "y": 0.2, "z": -0.0}}}
        self.add(topic, WRENCH_STAMPED, number, {"header": header(number), **body})

    def transforms(self, number: int, *items: tuple[str, str, Rotation, Any], topic: str = "/tf") -> None:
        self.add(topic, TF, number, {"transforms": [transform(number, *item) for item in items]})

    def close(self) -> Path:
        self._writer.finish()
        self._stream.close()
        return self.file


def header(number: int, frame: str = "sensor") -> dict[str, Any]:
    seconds, rest = divmod(START + number * STEP - 500_000_000, 10**9)
    return {"stamp": {"sec": seconds, "nanosec": rest}, "frame_id": frame}


def transform(number: int, parent: str, child: str, R: Rotation, p: Any) -> dict[str, Any]:
    return {
        "header": header(number, parent),
        "child_frame_id": child,
        "transform": {
            "translation": dict(zip("xyz", map(float, p), strict=True)),
            "rotation": dict(zip("xyzw", R.as_quat().tolist(), strict=True)),
        },
    }


@pytest.fixture
def bag(tmp_path: Path) -> Bag:
    bag = Bag(tmp_path / "bag.mcap")
    for number in range(50):
        bag.wrench(number)
    return bag


def turned(number: int) -> Rotation:
    return Rotation.from_rotvec([0.01 * number, 0.2, -0.1])


def test_wrenches_and_the_only_transform(bag: Bag, tmp_path: Path) -> None:
    for number in range(50):
        bag.transforms(number, ("base_link", "tool0", turned(number), [number, 0, 0.5]))
    done = import_ros2(bag.close(), tmp_path / "r.mcap")
    assert (done.wrenches, done.poses, done.warnings) == (50, 50, ())
    found = read_recording(tmp_path / "r.mcap")
    wrenches, poses = found.wrenches["/wrench"], found.flanges["/flange"]
    np.testing.assert_array_equal(wrenches.wrenches[7], [7.125, -1.5, 1 / 3, 0.1, 0.2, -0.0])
    np.testing.assert_allclose(wrenches.times, np.arange(50) * 0.01, atol=1e-12)
    np.testing.assert_allclose(wrenches.device_time, START / 1e9 - 0.5 + np.arange(50) * 0.01)
    np.testing.assert_allclose(poses.R_BE[9], turned(9).as_matrix(), atol=1e-12)
    np.testing.assert_array_equal(poses.p_BE_B[9], [9, 0, 0.5])
    assert found.info.started_ns == START
    assert [device.address for device in found.info.devices] == ["ros2:/ft/wrench", "ros2:/tf"]


def test_header_stamps(bag: Bag, tmp_path: Path) -> None:
    import_ros2(bag.close(), tmp_path / "r.mcap", ImportChoice(header_stamps=True))
    track = read_recording(tmp_path / "r.mcap").wrenches["/wrench"]
    np.testing.assert_allclose(track.times, np.arange(50) * 0.01 - 0.5, atol=1e-12)
    np.testing.assert_allclose(track.device_time, np.arange(50) * 0.01, atol=1e-12)


def test_a_chain_of_transforms_with_a_static_one(bag: Bag, tmp_path: Path) -> None:
    mount = Rotation.from_euler("x", 90, degrees=True)
    bag.transforms(0, ("link6", "flange", mount, [0, 0, 0.1]), topic="/tf_static")
    for number in range(20):
        bag.transforms(
            number,
            ("base", "link6", turned(number), [1, 2, 3]),
            ("map", "cart", Rotation.identity(), [0, 0, 0]),
        )
        bag.transforms(number, ("map", "cart", Rotation.identity(), [0, 0, 0]))
    file = bag.close()
    with pytest.raises(
        RecordingError, match=r"--base NAME --flange NAME. There are: base -> link6, link6 ->"
    ):
        import_ros2(file, tmp_path / "r.mcap")
    with pytest.raises(RecordingError, match="no frame tool0; there are: base, cart"):
        import_ros2(file, tmp_path / "r.mcap", ImportChoice(base="base", flange="tool0"))
    with pytest.raises(RecordingError, match="give both --base and --flange"):
        import_ros2(file, tmp_path / "r.mcap", ImportChoice(base="base"))
    assert not (tmp_path / "r.mcap").exists()
    done = import_ros2(file, tmp_path / "r.mcap", ImportChoice(base="/base", flange="flange"))
    assert done.poses == 20
    poses = read_recording(tmp_path / "r.mcap").flanges["/flange"]
    np.testing.assert_allclose(poses.R_BE[4], (turned(4) * mount).as_matrix(), atol=1e-12)
    np.testing.assert_allclose(poses.p_BE_B[4], turned(4).apply([0, 0, 0.1]) + [1, 2, 3], atol=1e-12)


def test_joints_with_a_robot(bag: Bag, tmp_path: Path) -> None:
    names = [f"elfin_joint{number}" for number in (3, 1, 2, 6, 5, 4)]
    for number in range(5):
        body = {"header": header(number), "name": names, "position": [1.1, 0.3, -0.4, 0.9, -0.7, 0.5]}
        bag.add("/joint_states", JOINT_STATE, number, body)
    file = bag.close()
    without = import_ros2(file, tmp_path / "without.mcap")
    assert "name their robot with --robot NAME" in without.warnings[0]
    assert without.poses == 0
    done = import_ros2(file, tmp_path / "r.mcap", ImportChoice(robot=Robot.named("elfin3")))
    assert (done.poses, done.pose_topic) == (5, "/joint_states")
    poses = read_recording(tmp_path / "r.mcap").flanges["/flange"]
    np.testing.assert_array_equal(poses.joints[0], [0.3, -0.4, 1.1, 0.5, -0.7, 0.9])
    np.testing.assert_allclose(poses.p_BE_B[0], [0.528910, 0.113500, 0.556217], atol=2e-5)
    with pytest.raises(RecordingError, match="name their robot"):
        import_ros2(file, tmp_path / "x.mcap", ImportChoice(pose_topic="/joint_states"))


def test_poses_and_messages_that_are_none(bag: Bag, tmp_path: Path) -> None:
    for number in range(6):
        orientation = {"w": 1.0} if number != 3 else {"w": 3.0}
        place = dict.fromkeys("xyz", float("nan")) if number == 4 else {"x": 1.0}  # NaN: orientations only
        body = {"header": header(number, "base"), "pose": {"position": place, "orientation": orientation}}
        bag.add("/pose", POSE_STAMPED, number, body)
    done = import_ros2(bag.close(), tmp_path / "r.mcap")
    assert done.poses == 5
    assert done.warnings == ("A message on '/pose' was left out (it is no pose).",)


def test_a_choice_that_is_not_clear_lists_the_topics(bag: Bag, tmp_path: Path) -> None:
    bag.wrench(0, "/other")
    file = bag.close()
    with pytest.raises(RecordingError, match=r"several topics: /ft/wrench .*, /other .*--wrench-topic NAME"):
        import_ros2(file, tmp_path / "r.mcap")
    with pytest.raises(RecordingError, match="/x is not one of: /ft/wrench"):
        import_ros2(file, tmp_path / "r.mcap", ImportChoice(wrench_topic="/x"))
    assert import_ros2(file, tmp_path / "r.mcap", ImportChoice(wrench_topic="/other")).wrenches == 1


def test_no_wrenches(tmp_path: Path) -> None:
    bag = Bag(tmp_path / "bag.mcap")
    bag.transforms(0, ("a", "b", Rotation.identity(), [0, 0, 0]))
    with pytest.raises(
        RecordingError, match=r"no topic of WrenchStamped messages; there are: /tf \(tf2_msgs"
    ):
        import_ros2(bag.close(), tmp_path / "r.mcap")


def test_an_existing_recording_stays(bag: Bag, tmp_path: Path) -> None:
    (tmp_path / "r.mcap").write_bytes(b"mine")
    with pytest.raises(RecordingError, match="choose another"):
        import_ros2(bag.close(), tmp_path / "r.mcap")
    assert (tmp_path / "r.mcap").read_bytes() == b"mine"


def test_mutated_bags_give_samples_or_a_sentence(bag: Bag, tmp_path: Path) -> None:
    for number in range(20):
        bag.transforms(number, ("base_link", "tool0", turned(number), [number, 0, 0.5]))
    data = bag.close().read_bytes()
    rng = np.random.default_rng(5)
    for number in range(150):
        changed = bytearray(data)
        for place in rng.integers(0, len(data), 3).tolist():
            changed[place] = int(rng.integers(256))
        (tmp_path / "m.mcap").write_bytes(changed[: rng.integers(len(data))] if number % 3 == 0 else changed)
        try:
            import_ros2(tmp_path / "m.mcap", tmp_path / f"{number}.mcap")
        except RecordingError:
            assert not (tmp_path / f"{number}.mcap").exists()


@pytest.mark.parametrize("kind", sorted(DEFINITIONS))
def test_hostile_messages_are_refused(kind: str) -> None:
    from contactbench.pipeline.recording.ros2_poses import decoder

    decode, rng = decoder(kind), np.random.default_rng(1)
    for size in range(200):
        data = b"\0\1\0\0" + rng.choice([b"\xff", b"\0", b"\x02"], size).tobytes()
        for body in (data, data[:size]):
            try:
                decode(body)
            except ValueError:
                continue


STILL = Rotation.identity()
CHAIN = ImportChoice(base="base", flange="flange")


def test_links_in_several_messages_make_no_mixtures(bag: Bag, tmp_path: Path) -> None:
    for number in range(12):
        R = Rotation.from_euler("z", 30 * number, degrees=True)
        bag.transforms(number, ("base", "arm", R, [0, 0, 0]))
        bag.transforms(number, ("arm", "flange", R.inv(), [0, 0, 0.1 * number]))
    done = import_ros2(bag.close(), tmp_path / "r.mcap", CHAIN)
    assert (done.poses, done.warnings) == (12, ())
    track = read_recording(tmp_path / "r.mcap").flanges["/flange"]
    np.testing.assert_allclose(track.R_BE, np.tile(np.eye(3), (12, 1, 1)), atol=1e-12)
    np.testing.assert_allclose(track.p_BE_B[:, 2], 0.1 * np.arange(12), atol=1e-12)
    np.testing.assert_allclose(track.times, 0.01 * np.arange(12), atol=1e-12)


def test_links_that_are_heard_of_different_moments_are_told(bag: Bag, tmp_path: Path) -> None:
    for number in range(0, 40, 2):
        bag.transforms(number, ("base", "arm", turned(number), [0, 0, 0]))
        bag.transforms(number + number % 20 // 10, ("arm", "flange", turned(number), [0, 0, 0]))
    done = import_ros2(bag.close(), tmp_path / "r.mcap", CHAIN)
    assert done.poses == 10
    assert "samples have no pose" in done.warnings[0]
    bag = Bag(tmp_path / "never.mcap")
    for number in range(10):
        bag.wrench(number)
        bag.transforms(2 * number, ("base", "arm", turned(number), [0, 0, 0]))
        bag.transforms(2 * number + 1, ("arm", "flange", turned(number), [0, 0, 0]))
    done = import_ros2(bag.close(), tmp_path / "n.mcap", CHAIN)
    assert done.poses == 0
    assert "the transforms to arm, flange never have the same time stamp" in done.warnings[0]


def test_a_link_that_never_changes_needs_no_time_stamp(bag: Bag, tmp_path: Path) -> None:
    bag.transforms(0, ("arm", "flange", STILL, [0, 0, 1]))
    for number in range(10):
        bag.transforms(number, ("base", "arm", turned(number), [0, 0, 0]))
    assert import_ros2(bag.close(), tmp_path / "r.mcap", CHAIN).poses == 10


def test_the_time_is_that_of_the_links_between_the_frames(bag: Bag, tmp_path: Path) -> None:
    for number in range(5):
        other = transform(number, "world", "camera", STILL, (0, 0, 1))
        other["header"]["stamp"]["sec"] -= 7
        flange = transform(number, "base", "flange", turned(number), (0, 0, number))
        bag.add("/tf", TF, number, {"transforms": [flange, other]})
    file = bag.close()
    import_ros2(file, tmp_path / "h.mcap", ImportChoice(base="base", flange="flange", header_stamps=True))
    track = read_recording(tmp_path / "h.mcap").flanges["/flange"]
    np.testing.assert_allclose(track.times, 0.01 * np.arange(5) - 0.5, atol=1e-12)
    import_ros2(file, tmp_path / "r.mcap", CHAIN)
    track = read_recording(tmp_path / "r.mcap").flanges["/flange"]
    np.testing.assert_allclose(track.device_time, START / 1e9 - 0.5 + 0.01 * np.arange(5))


@pytest.mark.parametrize("child", ["camera", "flange"])
def test_a_bad_transform_takes_away_its_own_frame_only(child: str, bag: Bag, tmp_path: Path) -> None:
    for number in range(5):
        bad = transform(number, "world", child, STILL, (0, 0, 1))
        bad["transform"]["rotation"]["w"] = 0.0 if child == "camera" or number == 3 else 1.0
        items = [transform(number, "base", "flange", turned(number), (0, 0, number))]
        bag.add("/tf", TF, number, {"transforms": [bad, *items] if child == "camera" else items})
        if child == "flange" and number == 3:
            bad["header"]["frame_id"] = "base"
            bag.add("/tf", TF, number, {"transforms": [bad]})
    done = import_ros2(bag.close(), tmp_path / "r.mcap", CHAIN)
    assert done.poses == 5
    told = ("A message on '/tf' was left out (the transform to flange is no pose).",)
    assert done.warnings == (told if child == "flange" else ())


@pytest.mark.parametrize(
    ("items", "wanted", "why"),
    [
        (
            ("base arm", "tool flange"),
            CHAIN,
            "flange hangs on tool, and no transform leads from base to tool.",
        ),
        (
            ("base flange",),
            ImportChoice(base="flange", flange="base"),
            "give --base and --flange the other way round",
        ),
    ],
)
def test_frames_that_give_no_pose_are_told(
    items: tuple[str, ...], wanted: ImportChoice, why: str, bag: Bag, tmp_path: Path
) -> None:
    for number in range(3):
        pairs = [item.split() for item in items]
        bag.transforms(number, *((parent, child, turned(number), (0, 0, 0)) for parent, child in pairs))
    done = import_ros2(bag.close(), tmp_path / "r.mcap", wanted)
    assert done.poses == 0
    assert "No message on /tf gives a pose of the flange" in done.warnings[0]
    assert why in done.warnings[0]


def test_static_transforms_of_a_namespace(bag: Bag, tmp_path: Path) -> None:
    bag.transforms(0, ("base", "mount", STILL, [0, 0, 1]), topic="/robot/tf_static")
    for number in range(5):
        bag.transforms(number, ("mount", "flange", turned(number), [0, 0, 1]), topic="/robot/tf")
    done = import_ros2(bag.close(), tmp_path / "r.mcap", CHAIN)
    assert (done.pose_topic, done.poses, done.warnings) == ("/robot/tf", 5, ())
    assert read_recording(tmp_path / "r.mcap").flanges["/flange"].p_BE_B[0, 2] == 2.0


def moving(bag: Bag, numbers: Any = range(50), back: int = 0) -> Path:
    """Add transforms of an arm; from half of the numbers on the clock is so many steps behind."""
    for number in numbers:
        later = number - back * (2 * number >= len(numbers))
        bag.wrench(later)
        bag.transforms(later, ("base", "tool0", turned(number), [number, 0, 0.5]))
    return bag.close()


@pytest.mark.parametrize("kind", STORED)
@pytest.mark.parametrize("back", [0, 20])
def test_a_bag_is_read_however_it_is_stored(kind: str, back: int, tmp_path: Path) -> None:
    mcap = moving(Bag(tmp_path / "plain.mcap"), range(100), back)
    done = import_ros2(STORED[kind](mcap), tmp_path / "r.mcap")
    assert (done.wrenches, done.poses) == (100, 100)
    found = read_recording(tmp_path / "r.mcap")
    wrenches, poses = found.wrenches["/wrench"], found.flanges["/flange"]
    # Where the clock was set back, the second half follows a second later, and pairs only with its own poses.
    moved = np.arange(100) * 0.01 + (0.99 if back else 0.0) * (np.arange(100) >= 50)
    np.testing.assert_allclose(wrenches.times, moved, atol=1e-9)
    np.testing.assert_allclose(poses.times, moved, atol=1e-9)
    np.testing.assert_allclose(poses.p_BE_B[:, 0], np.arange(100))
    assert len(done.warnings) == bool(back) + (kind[-5:] == "False")
    if back:
        assert "set back by 0.2 s at 0.49 s" in done.warnings[-1]
    if kind == "ros1-None-False":  # killed while it wrote: what is there is read
        bag = mcap.with_name("bag")
        bag.write_bytes(bag.read_bytes()[: 2 * bag.stat().st_size // 3])
        cut = import_ros2(bag, tmp_path / "cut.mcap")
        assert 50 < cut.wrenches < 70
        assert [words in "".join(cut.warnings) for words in ("was not closed", "half a")] == [True, True]


@pytest.mark.parametrize(
    ("jump", "held", "told"), [(40, 0, "jumped by +0.4 s"), (-40, 0, ""), (0, 40, ""), (0, 0, "")]
)
def test_a_clock_that_is_set_forward_is_told(jump: int, held: int, told: str, tmp_path: Path) -> None:
    """Against the headers; messages that were held up for as long are no jump."""
    bag = Bag(tmp_path / "bag.mcap")
    force = {"wrench": {"force": {"x": 1.0}}}
    for number in range(900):
        later = jump * (number >= 450) + max(0, held - (number - 450)) * (number >= 450)
        bag.add("/w", WRENCH_STAMPED, number + later, {"header": header(number), **force})
    done = import_ros2(bag.close(), tmp_path / "r.mcap", None)
    sentences = [each for each in done.warnings if "jumped" in each]
    assert len(sentences) == bool(told)
    assert told in "".join(sentences)


@pytest.mark.parametrize(
    ("name", "content", "why"),
    [
        ("b.zstd", b"\x28\xb5\x2f\xfd" + bytes(40), "no bag in it"),
        ("b.mcap.zstd", b"\x28\xb5\x2f\xfd" + b"\xff" * 40, "cannot be unpacked"),
        ("b.db3", b"SQLite format 3\0" + bytes(4000), "no message that can be read"),
        ("b.bag", b"#ROSBAG V2.0\n" + bytes(4000), "no message that can be read"),
        ("b.mcap", b"PK\3\4", "not an MCAP file"),
    ],
)
def test_what_is_no_bag_is_refused(name: str, content: bytes, why: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(RecordingError, match=why):
        import_ros2(tmp_path / name, tmp_path / "r.mcap")


def test_a_folder_without_its_description_is_not_joined(tmp_path: Path) -> None:
    folder = STORED["halves"](moving(Bag(tmp_path / "plain.mcap")))
    (folder / "metadata.yaml").unlink()
    with pytest.raises(RecordingError, match=r"choose a file in it: bag_9.mcap, bag_10.mcap"):
        import_ros2(folder, tmp_path / "r.mcap")
    (folder / "bag_10.mcap").unlink()
    assert import_ros2(folder, tmp_path / "r.mcap").wrenches == 25


def test_a_damaged_database_gives_what_precedes_the_damage(tmp_path: Path) -> None:
    (file,) = STORED["SQLITE3-None"](moving(Bag(tmp_path / "plain.mcap"), range(600))).glob("*.db3")
    data = file.read_bytes()
    middle = len(data) // 2
    file.write_bytes(data[:middle] + bytes(8192) + data[middle + 8192 :])
    done = import_ros2(file, tmp_path / "r.mcap")
    assert 0 < done.wrenches < 600
    assert "everything up to there was read" in done.warnings[0]


def test_a_static_transform_holds_before_it_was_recorded(bag: Bag, tmp_path: Path) -> None:
    for number in range(20):
        bag.transforms(number, ("base", "arm", turned(number), [0, 0, 0]))
    bag.transforms(10, ("arm", "flange", STILL, [0, 0, 1]), topic="/tf_static")
    bag.transforms(15, ("arm", "flange", STILL, [0, 0, 2]), topic="/tf_static")
    done = import_ros2(bag.close(), tmp_path / "r.mcap", CHAIN)
    heights = np.linalg.norm(read_recording(tmp_path / "r.mcap").flanges["/flange"].p_BE_B, axis=1)
    assert (done.poses, heights[0], done.warnings) == (20, 1.0, ())


@pytest.mark.parametrize("kind", [WRENCH_STAMPED, TF])
def test_xcdr2_is_refused_by_name(kind: str, bag: Bag, tmp_path: Path) -> None:
    file = moving(bag, range(10))
    every = [
        each._replace(data=b"\0\7" + each.data[2:]) if each.channel.schema_name == kind else each
        for each in messages(file)
    ]
    with pytest.raises(RecordingError, match="are written in XCDR2"):
        import_ros2(write_mcap(tmp_path / "second.mcap", every), tmp_path / "r.mcap")


def test_times_of_another_day_are_left_out_and_told(tmp_path: Path) -> None:
    bag = Bag(tmp_path / "bag.mcap")
    for number in range(300):
        bag.wrench(number if number != 40 else -START // STEP)
    done = import_ros2(bag.close(), tmp_path / "r.mcap")
    assert (done.wrenches, done.warnings[-1][:26]) == (299, "1 messages were left out: ")
    assert read_recording(tmp_path / "r.mcap").wrenches["/wrench"].times[-1] == pytest.approx(2.99)


@pytest.mark.parametrize(
    ("frame", "told"), [("base", True), ("world", True), ("tool0", False), ("sensor", False)]
)
def test_wrenches_along_the_axes_of_the_base_are_told(frame: str, told: bool, tmp_path: Path) -> None:
    bag = Bag(tmp_path / "bag.mcap")
    bag.transforms(0, ("world", "base", STILL, [0, 0, 1]), topic="/tf_static")
    for number in range(10):
        bag.add(
            "/w", WRENCH_STAMPED, number, {"header": header(number, frame), "wrench": {"force": {"x": 1.0}}}
        )
        bag.transforms(number, ("base", "tool0", turned(number), [0, 0, 0]))
    done = import_ros2(bag.close(), tmp_path / "r.mcap", ImportChoice(base="base", flange="tool0"))
    assert [f"in frame '{frame}'" in sentence for sentence in done.warnings] == [True] * told


@pytest.mark.parametrize(
    ("names", "angles", "poses", "told"),
    [
        ([f"elfin_joint{n}" for n in range(1, 7)], 6, 5, ""),
        ([f"left/elfin_axis_{n}a{n}b" for n in "uvwxyz"], 6, 0, "J6, the messages finger, left/elfin_axis_u"),
        ([f"elfin_joint{n}" for n in range(1, 7)], 0, 0, "but have no angles"),
    ],
)
def test_messages_of_other_joints_are_passed_over(
    names: list[str], angles: int, poses: int, told: str, bag: Bag, tmp_path: Path
) -> None:
    for number in range(5):
        gripper = {"header": header(number), "name": ["finger"], "position": [0.01] * bool(angles)}
        bag.add("/joint_states", JOINT_STATE, number, gripper)
        body = {
            "header": header(number),
            "name": names,
            "position": [0.3, -0.4, 1.1, 0.5, -0.7, 0.9][:angles],
        }
        bag.add("/joint_states", JOINT_STATE, number, body)
    done = import_ros2(bag.close(), tmp_path / "r.mcap", ImportChoice(robot=Robot.named("elfin3")))
    assert (done.poses, len(done.warnings)) == (poses, bool(told))
    assert told in "".join(done.warnings)


def test_the_frame_of_the_wrenches_is_kept_and_its_change_told(tmp_path: Path) -> None:
    bag = Bag(tmp_path / "b.mcap")
    force = {"wrench": {"force": {"x": 1.0}}}
    for number, frame in enumerate(("ft_sensor", "ft_sensor", "base_link", "base_link")):
        bag.add("/w", WRENCH_STAMPED, number, {"header": header(number, frame), **force})
    done = import_ros2(bag.close(), tmp_path / "r.mcap")
    assert any("several frames, 'ft_sensor' and 'base_link'" in sentence for sentence in done.warnings)
    assert (
        read_recording(tmp_path / "r.mcap").info.note == "imported from b.mcap; wrenches in frame ft_sensor"
    )


def test_a_bag_whose_name_is_no_text(bag: Bag, tmp_path: Path) -> None:
    odd = tmp_path / os.fsdecode(b"\xff.mcap")
    try:
        bag.close().rename(odd)
    except OSError:
        pytest.skip("this file system takes text only")
    assert import_ros2(odd, tmp_path / "r.mcap").wrenches == 50
    note = read_recording(tmp_path / "r.mcap").info.note
    assert note == "imported from \\udcff.mcap; wrenches in frame sensor"


def test_an_import_onto_a_full_disk_leaves_nothing(
    bag: Bag, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any) -> int:
        raise OSError(28, "No space left on device")

    file = bag.close()
    monkeypatch.setattr(os, "write", full)
    with pytest.raises(RecordingError, match="No space left"):
        import_ros2(file, tmp_path / "r.mcap")
    monkeypatch.undo()
    assert import_ros2(file, tmp_path / "r.mcap").wrenches == 50


def test_a_bag_that_is_written_opens_in_rosbags_and_comes_back_the_same(tmp_path: Path) -> None:
    source = tmp_path / "r.mcap"
    with RecordingWriter(source, ABOUT) as writer:
        for number, sample in enumerate(wrench_samples(40)):
            writer.wrench(replace(sample, status=Status.INVALID) if number == 5 else sample)
        for pose in flange_samples(20):
            writer.flange(pose)
    assert invoke("record", "convert", source, "--out", tmp_path / "bag").exit_code == 0
    given = read_recording(source)
    (wrenches,), (flange,) = given.wrenches.values(), given.flanges.values()
    kept = np.arange(40) != 5
    with AnyReader([tmp_path / "bag"]) as bag:
        found = [
            (connection.topic, bag.deserialize(raw, connection.msgtype))
            for connection, _, raw in bag.messages()
        ]
    told = [each.wrench.force.z for topic, each in found if topic in given.wrenches]
    assert told == wrenches.wrenches[kept, 2].tolist()
    stamps = [each.header.stamp.sec * 10**9 + each.header.stamp.nanosec for _, each in found]
    assert stamps == sorted(map(given.info.log_time, (*wrenches.times[kept], *flange.times)))
    import_ros2(tmp_path / "bag", tmp_path / "back.mcap")
    again = read_recording(tmp_path / "back.mcap")
    (back,), (turned,) = (again.wrenches.values(), again.flanges.values())
    assert np.array_equal(back.wrenches, wrenches.wrenches[kept])
    assert np.allclose(turned.R_BE, flange.R_BE, atol=1e-15)
    assert np.array_equal(turned.p_BE_B, flange.p_BE_B, equal_nan=True)
    twice = invoke("record", "convert", source, "--out", tmp_path / "bag")
    assert (twice.exit_code, "choose a new folder" in twice.stderr) == (2, True)
