"""Recordings that were cut off, changed, or made to do harm."""

import json
import os
import struct
import zlib
from dataclasses import replace
from pathlib import Path

import lz4.frame
import numpy as np
import pytest
import zstandard
from mcap.stream_reader import StreamReader
from recording.recording_cases import ABOUT, record, wrench_samples
from scipy.spatial.transform import Rotation
from weighing_files import columns

from contactbench.pipeline.contact.wrench_csv import WrenchReader
from contactbench.pipeline.devices.pose_source import LONGEST_GAP_S
from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.recording import (
    DeviceInfo,
    RecordingError,
    RecordingInfo,
    RecordingReader,
    RecordingWriter,
    read_recording,
)
from contactbench.pipeline.recording.bags import Bag
from contactbench.pipeline.recording.contents import read_contents
from contactbench.pipeline.recording.convert import poses_at, write_csv, write_npz
from contactbench.pipeline.recording.wire import MAGIC, MESSAGE_HEAD, PREFIX, Opcode, mapping, text
from contactbench.pipeline.recording.wire import record as wire_record


def samples(file: Path) -> tuple[list[str], list[str], bool]:
    """Return what a file holds as text, its warnings, and whether it is whole."""
    with RecordingReader(file) as reader:
        found = [repr((topic, sample)) for topic, sample in reader]
        return found, reader.warnings, reader.complete


def after_topic(sample: str) -> str:
    return sample.partition(", ")[2]


def bounds(data: bytes) -> list[tuple[int, int, int]]:
    """Return opcode, begin and end of every record."""
    found, at = [], len(MAGIC)
    while at < len(data) - len(MAGIC):
        opcode, length = PREFIX.unpack_from(data, at)
        found.append((opcode, at, at + PREFIX.size + length))
        at = found[-1][2]
    return found


def messages_before(data: bytes) -> dict[int, int]:
    """Return how many messages are in whole chunks up to the end of each chunk."""
    counts, total = {}, 0
    chunks = iter([end for opcode, _, end in bounds(data) if opcode == Opcode.CHUNK])
    from io import BytesIO

    for item in StreamReader(BytesIO(data), emit_chunks=True).records:
        if type(item).__name__ == "Chunk":
            unpacked = zstandard.decompress(item.data)  # type: ignore[attr-defined]
            at = 0
            while at < len(unpacked):
                total += 1
                at += PREFIX.size + PREFIX.unpack_from(unpacked, at)[1]
            counts[next(chunks)] = total
    return counts


def test_a_file_that_is_cut_anywhere_gives_its_whole_chunks(tmp_path: Path) -> None:
    file = record(tmp_path / "r.mcap", 100, 50)
    data = file.read_bytes()
    everything, warnings, complete = samples(file)
    assert (warnings, complete) == ([], True)
    counts = messages_before(data)
    first_chunk = next(begin for opcode, begin, _ in bounds(data) if opcode == Opcode.CHUNK)
    about = next(end for opcode, _, end in bounds(data) if opcode == Opcode.METADATA)
    ends = [end for _, _, end in bounds(data)]
    cuts = {*ends, *(end - 1 for end in ends), *(end + 3 for end in ends)}
    cuts |= set(np.random.default_rng(0).integers(0, len(data), 20).tolist())
    for cut in sorted(cut for cut in cuts if cut < len(data)):
        part = tmp_path / "part.mcap"
        part.write_bytes(data[:cut])
        if cut < about:
            with pytest.raises(RecordingError):
                samples(part)
            continue
        found, warnings, complete = samples(part)
        expected = max((count for end, count in counts.items() if end <= cut), default=0)
        assert found == everything[:expected]
        assert not complete
        assert "cut off" in warnings[0]
    assert about < first_chunk


def test_a_damaged_chunk_is_left_out_and_the_rest_is_given(tmp_path: Path) -> None:
    file = record(tmp_path / "r.mcap", 200, 100)
    data = bytearray(file.read_bytes())
    everything = samples(file)[0]
    chunks = [(begin, end) for opcode, begin, end in bounds(bytes(data)) if opcode == Opcode.CHUNK]
    counts = list(messages_before(bytes(data)).values())
    data[chunks[1][1] - 20] ^= 0x40
    file.write_bytes(data)
    found, warnings, complete = samples(file)
    assert found == everything[: counts[0]] + everything[counts[1] :]
    assert complete
    assert f"The data at byte {chunks[1][0]:,} are damaged and were left out" in warnings[0]
    assert "was changed after it was written" in warnings[-1]


def test_mutated_files_give_samples_or_a_sentence(tmp_path: Path) -> None:
    file = record(tmp_path / "r.mcap", 40, 20)
    data = file.read_bytes()
    everything = set(map(after_topic, samples(file)[0]))
    starts = [begin for _, begin, _ in bounds(data)]
    rng = np.random.default_rng(3)
    mutant = tmp_path / "m.mcap"
    refused = 0
    for number in range(150):
        changed = bytearray(data)
        for _ in range(rng.integers(1, 4)):
            # Half of them in the heads of records, where lengths are.
            near = rng.choice(starts) + rng.integers(0, 40) if number % 2 else rng.integers(len(data))
            place = int(min(near, len(data) - 1))
            match rng.integers(4):
                case 0:
                    changed[place : place + 8] = b"\xff" * len(changed[place : place + 8])
                case 1:
                    changed[place : place + 1] = bytes(rng.integers(0, 256, 1, dtype=np.uint8))
                case 2:
                    del changed[place : place + int(rng.integers(1, 30))]
                case _:
                    changed[place:place] = bytes(
                        rng.integers(0, 256, int(rng.integers(1, 30)), dtype=np.uint8)
                    )
        mutant.write_bytes(changed)
        try:
            found, warnings, _ = samples(mutant)
        except RecordingError:
            refused += 1
            continue
        # A checksum guards every sample; the name of its topic is guarded by that of the whole file only.
        assert {after_topic(sample) for sample in found} <= everything
        assert len(found) == len(everything) or warnings
        if number % 5 == 0:
            read_recording(mutant)
    assert 2 < refused < 100


# ---- made to do harm ---------------------------------------------------------------------------


def crafted(tmp_path: Path, *records: bytes, start: bool = True) -> Path:
    """Write a file of these records after what a recording begins with."""
    whole = record(tmp_path / "whole.mcap", 1, 0).read_bytes()
    (tmp_path / "whole.mcap").unlink()
    head = next(begin for opcode, begin, _ in bounds(whole) if opcode == Opcode.CHUNK)
    file = tmp_path / "crafted.mcap"
    file.write_bytes((whole[:head] if start else MAGIC) + b"".join(records))
    return file


def chunk(data: bytes, *, compression: str = "", size: int | None = None, crc: int | None = None) -> bytes:
    size = len(data) if size is None else size
    head = struct.pack("<QQQI", 0, 0, size, zlib.crc32(data) if crc is None else crc)
    return wire_record(Opcode.CHUNK, head + text(compression) + struct.pack("<Q", len(data)) + data)


def message(body: object, channel: int = 1) -> bytes:
    data = body if isinstance(body, bytes) else json.dumps(body).encode()
    return wire_record(Opcode.MESSAGE, MESSAGE_HEAD.pack(channel, 0, 0, 0) + data)


FORCE = {"force": {"x": 1, "y": 2, "z": 3}, "torque": {"x": 1, "y": 2, "z": 3}, "status": 0, "time": 1.0}
POSE = {"time": 1.0, "R": [1, 0, 0, 0, 1, 0, 0, 0, 1], "translation": {}}


def test_the_crafted_messages_are_fine_unless_changed(tmp_path: Path) -> None:
    file = crafted(tmp_path, chunk(message(FORCE) + message(POSE, 2)), message(FORCE))
    assert len(samples(file)[0]) == 3
    packed = lz4.frame.compress(message(FORCE))
    plain = message(FORCE)
    file = crafted(tmp_path, chunk(packed, compression="lz4", size=len(plain), crc=zlib.crc32(plain)))
    assert len(samples(file)[0]) == 1


@pytest.mark.parametrize(
    ("body", "channel"),
    [
        (b"", 1),
        (b"{", 1),
        (b"\xff\xfe", 1),
        (b"[" * 60_000, 1),
        (b'{"time":' * 8_000, 1),
        (b'{"time":' + b"9" * 10_000 + b"}", 1),
        ([], 1),
        ({}, 1),
        ({**FORCE, "time": None}, 1),
        ({**FORCE, "time": "now"}, 1),
        ({**FORCE, "time": True}, 1),
        ({**FORCE, "time": 10**400}, 1),
        ({**FORCE, "time": 1.7e308}, 1),
        ({**FORCE, "time": -1e16}, 1),
        ({**FORCE, "more": "x" * 2**16}, 1),
        ({**POSE, "more": [0] * 2**15}, 2),
        ({"time": 1, "event": "a", "fields": {"b": "x" * 2**21}}, 3),
        ({**FORCE, "force": [1, 2, 3]}, 1),
        ({**FORCE, "force": {"x": "1"}}, 1),
        ({**FORCE, "status": -1}, 1),
        ({**FORCE, "status": 2**40}, 1),
        ({**FORCE, "status": 1.5}, 1),
        ({**FORCE, "sequence": 2**63}, 1),
        ({**FORCE, "sequence": None}, 1),
        ({**POSE, "R": [1] * 9}, 2),
        ({**POSE, "R": [1e300] * 9}, 2),
        ({**POSE, "R": [[1]] * 9}, 2),
        ({**POSE, "R": [1, 0]}, 2),
        ({**POSE, "R": [1, 0, 0, 0, 1, 0, 0, 0, -1]}, 2),
        ({**POSE, "joints": [0] * 65}, 2),
        ({**POSE, "joints": "a"}, 2),
        ({**POSE, "arrival": 1e300}, 2),
        ({**FORCE, "arrival": None}, 1),
        ({**FORCE, "arrival": "now"}, 1),
        ({"time": 1, "event": 3, "fields": {}}, 3),
        ({"time": 1, "event": "a", "fields": []}, 3),
        (FORCE, 77),
    ],
)
def test_messages_that_are_none_are_left_out(body: object, channel: int, tmp_path: Path) -> None:
    file = crafted(tmp_path, message(FORCE), message(body, channel), message(FORCE))
    found, warnings, _ = samples(file)
    assert len(found) == 2
    assert "left out" in warnings[0]


@pytest.mark.parametrize(
    "bad",
    [
        chunk(b"abc", compression="zstd", size=2**40),
        chunk(b"abc", compression="zstd"),
        chunk(b"abc", compression="lz4"),
        chunk(b"abc", compression="brotli"),
        chunk(zstandard.compress(bytes(10**8)), compression="zstd", size=1000),
        chunk(zstandard.compress(bytes(1000)), compression="zstd", size=2**28),
        chunk(lz4.frame.compress(bytes(10**8)), compression="lz4", size=1000),
        chunk(b"\x05"),
        chunk(PREFIX.pack(Opcode.MESSAGE, 2**63) + b"abc"),
        chunk(PREFIX.pack(Opcode.MESSAGE, 3) + b"abc"),
        chunk(message(FORCE), crc=1),
        wire_record(Opcode.CHUNK, b""),
        wire_record(Opcode.SCHEMA, b"\x01"),
        wire_record(Opcode.CHANNEL, struct.pack("<HHI", 9, 1, 2**32 - 1)),
        wire_record(Opcode.METADATA, text("contactbench.device") + struct.pack("<I", 2**32 - 1)),
        wire_record(Opcode.METADATA, text("\n") + mapping({"a": "b"})[:-1]),
    ],
)
def test_records_that_lie_are_left_out(bad: bytes, tmp_path: Path) -> None:
    found, warnings, _ = samples(crafted(tmp_path, message(FORCE), bad, message(FORCE)))
    assert len(found) == 2
    assert "damaged and were left out" in warnings[0]


def test_many_faults_are_not_all_told(tmp_path: Path) -> None:
    _, warnings, _ = samples(crafted(tmp_path, *[message(b"")] * 1000))
    assert len(warnings) == 21
    assert warnings[-1] == "More of it is damaged in the same way."


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "not an MCAP file"),
        (b"t,fx,fy,fz\n", "not an MCAP file"),
        (MAGIC, "not a recording of contactbench. The file is cut off"),
        (MAGIC + wire_record(Opcode.DATA_END, bytes(4)) + MAGIC, "import-ros2"),
        (
            MAGIC
            + wire_record(
                Opcode.METADATA,
                text("contactbench.recording") + mapping({"format": "3", "tool": "contactbench 9"}),
            ),
            r"newer program \(contactbench 9\): update",
        ),
        (
            MAGIC + wire_record(Opcode.METADATA, text("contactbench.recording") + mapping({"format": "1"})),
            "description in the file is damaged",
        ),
    ],
)
def test_other_files_are_refused_with_a_sentence(content: bytes, message: str, tmp_path: Path) -> None:
    (tmp_path / "f").write_bytes(content)
    with pytest.raises(RecordingError, match=message):
        read_recording(tmp_path / "f")


def test_files_that_cannot_be_opened(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="there is no such file"):
        read_recording(tmp_path / "none.mcap")
    with pytest.raises(RecordingError, match="this is a folder"):
        read_recording(tmp_path)
    with pytest.raises(RecordingError, match="cannot be opened"):
        read_recording(Path("a\0b"))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes with names")
def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.mcap")
    for reader in (read_recording, Bag):
        with pytest.raises(RecordingError, match="this is a pipe or a device"):
            reader(tmp_path / "pipe.mcap")


def test_events_that_would_fill_the_memory_are_left_out(tmp_path: Path) -> None:
    body = b'{"time":0,"event":"x","fields":{"a":[' + b",".join([b"[]"] * 300_000) + b"]}}"
    ordinary = message({"time": 2, "event": "after", "fields": {}}, 3)
    whole = zlib.crc32(plain := message(body, 3) * 16 + ordinary)
    packed = lz4.frame.compress(plain)
    file = crafted(tmp_path, chunk(packed, compression="lz4", size=len(plain), crc=whole), message(FORCE))
    found = read_recording(file)
    assert 1 <= len(found.events) < 6
    assert len(found.wrenches["/wrench"].times) == 1
    assert "more events than fit into memory" in found.warnings[0]
    with RecordingReader(file) as reader:  # who takes them one by one gets them all
        assert sum(1 for _ in reader) == 18


def test_half_a_character_is_replaced(tmp_path: Path) -> None:
    file = crafted(tmp_path, message({"time": 1, "event": "a\ud800", "fields": {"b": "\udfff"}}, 3))
    assert read_recording(file).events[0].name == "a?"
    write_npz(tmp_path / "r.npz", file)
    with np.load(tmp_path / "r.npz", allow_pickle=False) as stored:
        assert json.loads(stored["events"].tobytes())[0]["fields"] == {"b": "?"}


# ---- recordings as CSV and NPZ -------------------------------------------------------------------


def test_wrenches_are_read_by_the_rest_of_the_program_bit_for_bit(tmp_path: Path) -> None:
    found = read_recording(record(tmp_path / "r.mcap", 300, 0))
    assert write_csv(tmp_path / "r.csv", tmp_path / "r.mcap").left_out == ()
    with (tmp_path / "r.csv").open("rb") as stream:
        blocks = list(WrenchReader(stream, "r.csv", timed=True))
    track = found.wrenches["/wrench"]
    np.testing.assert_array_equal(np.vstack([rows.wrenches for rows in blocks]), track.wrenches)
    np.testing.assert_array_equal(np.concatenate([rows.t for rows in blocks]), track.times)
    cells = columns(tmp_path / "r.csv")
    assert list(cells) == ["t", "fx", "fy", "fz", "mx", "my", "mz", "status", "sequence", "temperature"]
    assert cells["sequence"][:3] == ["0", "1", "2"]


def test_poses_stand_beside_the_wrenches(tmp_path: Path) -> None:
    about = replace(ABOUT, devices=())
    axis, speed = np.array([0.6, 0.0, 0.8]), 0.7
    with RecordingWriter(tmp_path / "r.mcap", about) as writer:
        for number in range(101):
            moment = number / 100
            R = Rotation.from_rotvec(axis * speed * moment).as_matrix()
            if not 40 < number < 70:
                writer.flange(FlangeSample(1000 + moment, R, np.array([moment, 0.0, 1.0])))
        for sample in wrench_samples(240):
            writer.wrench(sample)
    (said,) = write_csv(tmp_path / "r.csv", tmp_path / "r.mcap").left_out
    cells = columns(tmp_path / "r.csv")
    t = np.array(cells["t"], float) - 1000
    assert said == f"{240 - len(t)} readings left out: no pose within {LONGEST_GAP_S} s."
    assert ((t <= 0.4) | (t >= 0.7)).all()
    assert t.max() == 1.0
    assert len(t) == 81 + 61
    quaternions = np.array([cells[name] for name in ("qx", "qy", "qz", "qw")], float).T
    np.testing.assert_allclose(
        Rotation.from_quat(quaternions).as_rotvec(), axis * speed * t[:, None], atol=1e-9
    )
    np.testing.assert_allclose(np.array(cells["px"], float), t, atol=1e-9)


@pytest.mark.parametrize("by", [-0.4, 600.0, 1e8])
@pytest.mark.parametrize("both", [True, False])
def test_nothing_is_paired_where_the_clock_was_set(tmp_path: Path, by: float, both: bool) -> None:
    """The wrenches tell how far the flange has turned; the truth is where each reading was taken."""
    with RecordingWriter(tmp_path / "r.mcap", replace(ABOUT, devices=())) as writer:
        for number in range(600):
            moment = 1000 + number / 100
            R = Rotation.from_rotvec([0.0, 0.0, 0.005 * number]).as_matrix()
            late = by if number >= 300 else 0.0
            writer.flange(FlangeSample(moment + late * both, R, np.zeros(3)))
            writer.wrench(WrenchSample(moment + late, (0.005 * number, 0.0, 0.0), (0.0, 0.0, 0.0)))
    set_apart = not both and by != 600.0
    told = {
        -0.4: "set back by 0.4 s at 1002.99 s",
        600.0: "for 600 s after 1002.99 s",
        1e8: "forward by 100,000,000 s",
    }
    done, found = write_csv(tmp_path / "r.csv", tmp_path / "r.mcap"), read_contents(tmp_path / "r.mcap")
    assert told[by] in done.warnings[0]
    assert found.warnings == done.warnings
    assert found.topics[0]["seconds"] == pytest.approx(606.0 if by == 600.0 else 7.0, abs=0.05)
    assert len(done.warnings) == 1 + set_apart
    cells = {name: np.array(cells, float) for name, cells in columns(tmp_path / "r.csv").items()}
    assert len(cells["fx"]) == (600 if both or set_apart else 300)
    assert ("qz" in cells) is not set_apart
    if not set_apart:
        np.testing.assert_allclose(2 * np.arcsin(cells["qz"]), cells["fx"], atol=1e-6)
        return
    with pytest.raises(RecordingError, match="Not every topic shows that the clock was set"):
        read_recording(tmp_path / "r.mcap")


def test_readings_that_are_no_measurements_are_left_out(tmp_path: Path) -> None:
    good = wrench_samples(6)
    states = [Status.OK, Status.LATE, Status.OVERRANGE, Status.INVALID, Status.RAW, Status.ERROR]
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        for sample, status in zip(good, states, strict=True):
            writer.wrench(replace(sample, status=status))
        writer.wrench(WrenchSample(1001.0, (np.nan, 0.0, 0.0), (0.0, 0.0, 0.0)))
    (said,) = write_csv(tmp_path / "r.csv", tmp_path / "r.mcap").left_out
    assert said.startswith("5 readings left out")
    cells = columns(tmp_path / "r.csv")
    assert cells["status"] == ["0", "8"]
    assert "sequence" not in cells


def test_the_poses_alone(tmp_path: Path) -> None:
    found = read_recording(record(tmp_path / "r.mcap", 1, 20))
    write_csv(tmp_path / "r.csv", tmp_path / "r.mcap", "/flange")
    cells = columns(tmp_path / "r.csv")
    names = ["t", "qw", "qx", "qy", "qz", "px", "py", "pz", "j1", "j2", "j3", "j4", "j5", "j6"]
    assert list(cells) == names
    track = found.flanges["/flange"]
    np.testing.assert_array_equal(np.array(cells["px"], float), track.p_BE_B[:, 0])
    np.testing.assert_allclose(np.radians(np.array(cells["j6"], float)), track.joints[:, 5], rtol=1e-12)


def test_npz_has_everything_and_needs_no_pickle(tmp_path: Path) -> None:
    found = read_recording(record(tmp_path / "r.mcap"))
    write_npz(tmp_path / "r.npz", tmp_path / "r.mcap")
    with np.load(tmp_path / "r.npz", allow_pickle=False) as stored:
        for number, track in enumerate((*found.wrenches.values(), *found.flanges.values())):
            for name, values in vars(track).items():
                np.testing.assert_array_equal(stored[f"{number}/{name}"], values, strict=True)
        told = {name: json.loads(stored[name].tobytes()) for name in ("topics", "about", "events")}
    assert told["topics"] == [*found.wrenches, *found.flanges]
    assert told["about"]["devices"][0]["serial"] == "SN 1"
    assert told["events"][0] == {"time": 1000.0, "name": "start", "fields": {"who": "A. B.", "n": 1}}
    write_npz(tmp_path / "one.npz", tmp_path / "r.mcap", "/flange")
    with np.load(tmp_path / "one.npz", allow_pickle=False) as stored:
        assert json.loads(stored["topics"].tobytes()) == ["/flange"]


def test_topics_that_are_not_clear(tmp_path: Path) -> None:
    about = RecordingInfo(0, 0.0, (DeviceInfo("wrench", "/a", "x"), DeviceInfo("wrench", "/b", "y")))
    with RecordingWriter(tmp_path / "r.mcap", about) as writer:
        writer.wrench(WrenchSample(1.0, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0)), "/a")
        writer.wrench(WrenchSample(1.0, (9.0, 2.0, 3.0), (0.0, 0.0, 0.0)), "/b")
    file = tmp_path / "r.mcap"
    with pytest.raises(RecordingError, match=r"several topics of that kind: /a, /b\. Choose one: --topic"):
        write_csv(tmp_path / "r.csv", file)
    with pytest.raises(RecordingError, match="no samples on /c; it has: /a, /b"):
        write_csv(tmp_path / "r.csv", file, "/c")
    write_csv(tmp_path / "r.csv", file, "/b")
    assert columns(tmp_path / "r.csv")["fx"] == ["9.0"]


def test_nothing_to_write_leaves_what_is_there(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        writer.wrench(replace(wrench_samples(1)[0], status=Status.INVALID))
    file = tmp_path / "r.mcap"
    (tmp_path / "r.csv").write_text("mine", encoding="utf-8")
    with pytest.raises(RecordingError, match="no reading of /wrench is usable"):
        write_csv(tmp_path / "r.csv", file)
    assert (tmp_path / "r.csv").read_text(encoding="utf-8") == "mine"
    with pytest.raises(RecordingError, match="cannot be written"):
        write_npz(tmp_path / "missing" / "r.npz", file)
    with RecordingWriter(tmp_path / "e.mcap", ABOUT):
        pass
    with pytest.raises(RecordingError, match="contains no samples"):
        write_csv(tmp_path / "r.csv", tmp_path / "e.mcap")


def test_a_single_pose_or_a_repeated_moment_makes_no_pose_up(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        for _ in range(3):
            writer.flange(FlangeSample(1000.0, np.eye(3), np.zeros(3)))
    track = read_recording(tmp_path / "r.mcap").flanges["/flange"]
    poses, there = poses_at(track, np.array([1000.0, 1001.0]))
    assert there.tolist() == [True, False]
    assert np.isnan(poses[1]).all()


def test_counts_keep_all_their_digits(tmp_path: Path) -> None:
    counts = [2**63 - 1, 2**53 + 1, 0]
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        for sample, count in zip(wrench_samples(3), counts, strict=True):
            writer.wrench(replace(sample, sequence=count))
    write_csv(tmp_path / "r.csv", tmp_path / "r.mcap")
    assert [int(cell) for cell in columns(tmp_path / "r.csv")["sequence"]] == counts


def test_unknown_positions_are_empty_cells(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        for number in range(2):
            writer.flange(FlangeSample(1000.0 + number, np.eye(3), np.array([np.nan, 0.5, np.nan])))
    write_csv(tmp_path / "r.csv", tmp_path / "r.mcap")
    cells = columns(tmp_path / "r.csv")
    assert (cells["px"], cells["py"], cells["qw"]) == (["", ""], ["0.5", "0.5"], ["1.0", "1.0"])
