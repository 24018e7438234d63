"""Writing a recording and reading it back."""

import math
import os
import threading
from dataclasses import replace
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from recording.recording_cases import ABOUT, flange_samples, record, wrench_samples

from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.recording import (
    DeviceInfo,
    Event,
    RecordingError,
    RecordingInfo,
    RecordingReader,
    RecordingWriter,
    SampleError,
    read_recording,
    reader,
)
from contactbench.pipeline.recording.messages import cells_of, read_wrench, wrench_cells, wrench_message
from contactbench.pipeline.recording.reader import wrench_track

NUMBERS = st.floats(width=64, allow_infinity=False)
TIMES = st.floats(-1e6, 1e6)
TRIPLES = st.tuples(NUMBERS, NUMBERS, NUMBERS)


def test_a_recording_comes_back_bit_for_bit(tmp_path: Path) -> None:
    found = read_recording(record(tmp_path / "r.mcap"))
    assert found.complete
    assert found.warnings == ()
    assert found.info == ABOUT
    assert list(found.wrenches["/wrench"].samples()) == wrench_samples(400)
    track, given_poses = found.flanges["/flange"], flange_samples(200)
    np.testing.assert_array_equal(track.R_BE, [pose.R_BE for pose in given_poses])
    np.testing.assert_array_equal(track.p_BE_B, [pose.p_BE_B for pose in given_poses])
    np.testing.assert_array_equal(track.joints, [pose.joints for pose in given_poses])
    np.testing.assert_array_equal(track.times, [pose.time for pose in given_poses])
    assert found.events == (Event(1000.0, "start", {"who": "A. B.", "n": 1}), Event(1002.0, "stop", {}))


@settings(max_examples=25, deadline=None)
@given(
    samples=st.lists(
        st.builds(
            WrenchSample,
            TIMES,
            TRIPLES,
            TRIPLES,
            st.none() | st.integers(0, 2**63 - 1),
            st.integers(0, 63).map(Status),
            st.none() | st.floats(allow_nan=False, allow_infinity=False),
            st.none() | st.floats(allow_nan=False, allow_infinity=False),
            st.none() | st.floats(-1e15, 1e15),
        ),
        max_size=8,
    )
)
def test_any_wrench_comes_back(samples: list[WrenchSample], tmp_path_factory: Any) -> None:
    file = tmp_path_factory.mktemp("r") / "r.mcap"
    samples = [replace(sample, time=samples[0].time) for sample in samples]  # no clock is set
    with RecordingWriter(file, ABOUT) as writer:
        for sample in samples:
            writer.wrench(sample)
    with RecordingReader(file) as reader:
        found = [sample for _, sample in reader]
    assert list(map(repr, found)) == list(map(repr, samples))  # repr: NaN equals NaN, -0.0 is not 0.0
    tracks = read_recording(file).wrenches.values()
    assert [repr(s) for track in tracks for s in track.samples()] == list(map(repr, samples))


def test_arrivals_are_stored_beside_times(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        writer.wrench(WrenchSample(1000.0, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0), arrival=1000.25))
        writer.flange(FlangeSample(1000.0, np.eye(3), np.zeros(3), arrival=1000.5))
        writer.flange(FlangeSample(1000.1, np.eye(3), np.zeros(3)))
    found = read_recording(tmp_path / "r.mcap")
    assert found.wrenches["/wrench"].arrivals.tolist() == [1000.25]
    np.testing.assert_array_equal(found.flanges["/flange"].arrivals, [1000.5, np.nan])
    assert found.flanges["/flange"].times.tolist() == [1000.0, 1000.1]


@pytest.mark.parametrize(("address", "timed"), [("sri+serial:///dev/a", True), ("virtual://bench", False)])
def test_arrivals_of_an_older_recording_become_times(
    address: str, timed: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("contactbench.pipeline.recording.messages.FORMAT", 1)
    devices = (
        DeviceInfo("wrench", "/wrench", address, rate=200.0),
        DeviceInfo("flange", "/flange", "ur+tcp://10.0.0.2", rate=125.0),
        DeviceInfo("flange", "/other", "elfin+tcp://10.0.0.3", rate=50.0),
    )
    truth = 1000 + np.arange(1000) / 200
    arrivals = np.ceil(truth / 0.016) * 0.016
    with RecordingWriter(tmp_path / "r.mcap", RecordingInfo(10**18, 1000.0, devices)) as writer:
        for number, arrival in enumerate(arrivals.tolist()):
            writer.wrench(WrenchSample(arrival, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0), number))
            if arrivals[number] != arrivals[min(number + 1, 999)]:  # a batch of poses after one of wrenches
                for shift in (0.008, 0.0):
                    pose = FlangeSample(arrival, np.eye(3), np.zeros(3), device_time=arrival - shift)
                    writer.flange(pose, "/flange")
                writer.flange(FlangeSample(arrival, np.eye(3), np.zeros(3)), "/other")
    found = read_recording(tmp_path / "r.mcap")
    wrenches = found.wrenches["/wrench"]
    if timed:
        assert (np.diff(wrenches.times) > 0).all()
        assert np.abs(wrenches.times - truth)[200:].max() < 1.1e-3
        np.testing.assert_array_equal(wrenches.arrivals, arrivals)
    else:
        np.testing.assert_array_equal(wrenches.times, arrivals)
        assert np.isnan(wrenches.arrivals).all()
    poses = found.flanges["/flange"]
    assert poses.times == pytest.approx(poses.device_time, abs=1e-4)
    assert np.isnan(found.flanges["/other"].arrivals).all()


def test_the_reference_library_reads_it_and_agrees(tmp_path: Path) -> None:
    file = record(tmp_path / "r.mcap")
    with file.open("rb") as stream:
        assert len(list(StreamReader(stream, validate_crcs=True).records)) > 600
    with file.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        assert summary.statistics.message_count == 602
        assert summary.statistics.chunk_count == len(summary.chunk_indexes) > 5
        assert summary.statistics.metadata_count == 3
        assert next(item.name for item in reader.iter_metadata()) == "contactbench.recording"
        by_topic = [len(list(reader.iter_messages(topic))) for topic in ("/wrench", "/flange", "/events")]
        assert by_topic == [400, 200, 2]
        times = [message.log_time for _, _, message in reader.iter_messages()]
        assert times == sorted(times)
        assert times[0] == ABOUT.started_ns


def test_messages_fit_their_schemas(tmp_path: Path) -> None:
    import json

    with record(tmp_path / "r.mcap").open("rb") as stream:
        for schema, channel, message in make_reader(stream).iter_messages():
            assert schema is not None
            assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
            described = json.loads(schema.data)["properties"]
            assert set(json.loads(message.data)) <= set(described)


def test_the_rotation_for_viewers_is_the_one_that_was_given(tmp_path: Path) -> None:
    import json

    from scipy.spatial.transform import Rotation

    with record(tmp_path / "r.mcap").open("rb") as stream:
        bodies = [json.loads(m.data)["rotation"] for _, _, m in make_reader(stream).iter_messages("/flange")]
    quaternions = [[body[name] for name in "xyzw"] for body in bodies]
    expected = [pose.R_BE for pose in flange_samples(200)]
    np.testing.assert_allclose(Rotation.from_quat(quaternions).as_matrix(), expected, atol=1e-12)


def test_three_sensors_have_a_topic_each(tmp_path: Path) -> None:
    devices = tuple(DeviceInfo("wrench", f"/s{n}/wrench", f"rdt+udp://10.0.0.{n}") for n in range(3))
    about = RecordingInfo.now(devices)
    sample = WrenchSample(about.clock, (1.0, 2.0, 3.0), (0.1, 0.2, 0.3))
    with RecordingWriter(tmp_path / "r.mcap", about) as writer:
        for number, device in enumerate(devices):
            for _ in range(number + 1):
                writer.wrench(sample, device.topic)
        with pytest.raises(
            RecordingError, match="is not a topic for wrench samples; there are: /s0/wrench, /s1"
        ):
            writer.wrench(sample, "/wrench")
    found = read_recording(tmp_path / "r.mcap")
    assert {topic: len(track.times) for topic, track in found.wrenches.items()} == {
        "/s0/wrench": 1,
        "/s1/wrench": 2,
        "/s2/wrench": 3,
    }
    assert found.info == about


def test_what_is_unknown_stays_unknown(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        writer.flange(FlangeSample(1000.0, np.eye(3), np.full(3, np.nan)))
        writer.flange(FlangeSample(1000.1, np.eye(3), np.zeros(3), np.array([1.0, 2.0])))
        writer.wrench(WrenchSample(1000.0, (math.inf, 0.0, -math.inf), (0.0, math.nan, 0.0)))
    found = read_recording(tmp_path / "r.mcap")
    poses, wrenches = found.flanges["/flange"], found.wrenches["/wrench"]
    np.testing.assert_array_equal(poses.p_BE_B, [[np.nan] * 3, [0.0] * 3])
    np.testing.assert_array_equal(poses.joints, [[np.nan, np.nan], [1.0, 2.0]])
    np.testing.assert_array_equal(wrenches.wrenches, [[np.nan, 0, np.nan, 0, np.nan, 0]])
    assert not wrenches.usable.any()


@pytest.mark.parametrize(
    ("sample", "message"),
    [
        (FlangeSample(1000.0, np.ones((3, 3)), np.zeros(3)), "no rotation"),
        (FlangeSample(1000.0, np.full((3, 3), np.nan), np.zeros(3)), "no rotation"),
        (FlangeSample(1000.0, np.eye(2), np.zeros(3)), "no rotation"),
        (FlangeSample(1000.0, -np.eye(3), np.zeros(3)), "reflection"),
        (FlangeSample(1000.0, np.eye(3), np.zeros(2)), "three numbers"),
        (FlangeSample(1000.0, np.eye(3), np.zeros(3), np.zeros(65)), "at most 64"),
        (FlangeSample(math.nan, np.eye(3), np.zeros(3)), "no time near the start"),
        (FlangeSample(1e300, np.eye(3), np.zeros(3)), "no time near the start"),
        (FlangeSample(-2e9, np.eye(3), np.zeros(3)), "no time near the start"),
    ],
)
def test_samples_that_are_none_are_refused_and_the_recording_goes_on(
    sample: FlangeSample, message: str, tmp_path: Path
) -> None:
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer:
        with pytest.raises(RecordingError, match=message):
            writer.flange(sample)
        writer.wrench(wrench_samples(1)[0])
    assert list(read_recording(tmp_path / "r.mcap").wrenches["/wrench"].samples()) == wrench_samples(1)


@pytest.mark.parametrize("fields", [{"a": math.nan}, {"a": object()}, {"a": "x" * 3_000_000}])
def test_events_that_are_no_json_are_refused(fields: dict[str, Any], tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "r.mcap", ABOUT) as writer, pytest.raises(RecordingError):
        writer.event("odd", fields, 1000.0)


def test_a_recording_is_never_written_over(tmp_path: Path) -> None:
    file = record(tmp_path / "r.mcap", 5, 5)
    before = file.read_bytes()
    with pytest.raises(RecordingError, match="this file already exists"):
        RecordingWriter(file, ABOUT)
    assert file.read_bytes() == before
    with pytest.raises(RecordingError, match="cannot be started"):
        RecordingWriter(tmp_path / "missing" / "r.mcap", ABOUT)


def test_two_kinds_of_samples_cannot_share_a_topic(tmp_path: Path) -> None:
    about = RecordingInfo(0, 0.0, (DeviceInfo("wrench", "/flange", "x"),))
    with pytest.raises(RecordingError, match="two kinds of samples"):
        RecordingWriter(tmp_path / "r.mcap", about)
    assert not (tmp_path / "r.mcap").exists()


def test_after_closing_nothing_is_taken(tmp_path: Path) -> None:
    writer = RecordingWriter(tmp_path / "r.mcap", ABOUT)
    writer.close()
    writer.close()
    with pytest.raises(RecordingError, match="closed"):
        writer.wrench(wrench_samples(1)[0])
    assert read_recording(tmp_path / "r.mcap").complete


def test_a_crash_loses_at_most_a_fifth_of_a_second(tmp_path: Path) -> None:
    now = 0.0
    writer = RecordingWriter(tmp_path / "r.mcap", ABOUT, clock=lambda: now)
    for number, sample in enumerate(wrench_samples(300)):
        now = number / 200
        writer.wrench(sample)
        if number % 10 == 0:
            with RecordingReader(tmp_path / "r.mcap") as reader:  # as if the process had died here
                kept = sum(1 for _ in reader)
            assert kept >= number - 40
    writer.flush()
    found = read_recording(tmp_path / "r.mcap")
    assert list(found.wrenches["/wrench"].samples()) == wrench_samples(300)
    assert not found.complete
    assert "cut off" in found.warnings[0]
    writer.close()


def broken(_: object) -> None:
    raise OSError(5, "Input/output error")


@pytest.mark.parametrize("call", ["write", "fsync"])
def test_a_full_disk_stops_the_recording_and_keeps_what_is_there(
    call: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = RecordingWriter(tmp_path / "r.mcap", ABOUT)
    samples = wrench_samples(20)
    for sample in samples[:10]:
        writer.wrench(sample)
    writer.flush()
    real_write = os.write

    def half_then_full(file: int, data: Any) -> int:
        if len(data) < 100:
            raise OSError(28, "No space left on device")
        return real_write(file, bytes(data[: len(data) // 2]))

    monkeypatch.setattr(os, call, half_then_full if call == "write" else broken)
    for sample in samples[10:]:
        writer.wrench(sample)
    with pytest.raises(RecordingError, match="its content stays readable"):
        writer.flush()
    monkeypatch.undo()
    with pytest.raises(RecordingError, match="closed"):
        writer.wrench(samples[0])
    writer.close()
    found = list(read_recording(tmp_path / "r.mcap").wrenches["/wrench"].samples())
    assert found == samples[: 10 if call == "write" else 20]


def test_threads_share_a_writer(tmp_path: Path) -> None:
    samples, poses = wrench_samples(300), flange_samples(300)
    with RecordingWriter(tmp_path / "r.mcap", ABOUT, chunk_seconds=0.0) as writer:
        threads = [
            threading.Thread(target=lambda: [writer.wrench(sample) for sample in samples]),
            threading.Thread(target=lambda: [writer.flange(pose) for pose in poses]),
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    found = read_recording(tmp_path / "r.mcap")
    assert list(found.wrenches["/wrench"].samples()) == samples
    np.testing.assert_array_equal(found.flanges["/flange"].times, [pose.time for pose in poses])


@settings(deadline=None)
@given(st.lists(st.floats(-4, 4), min_size=3, max_size=3), st.sampled_from([1.0, 0.0, 1e-9]))
def test_quaternions_for_viewers(vector: list[float], scale: float) -> None:
    import json

    from scipy.spatial.transform import Rotation

    from contactbench.pipeline.recording.messages import flange_message

    half_turn = Rotation.from_rotvec([0.0, math.pi, 0.0])
    rotation = Rotation.from_rotvec(np.array(vector) * scale)
    for R in (rotation.as_matrix(), (rotation * half_turn).as_matrix()):
        body = json.loads(flange_message(FlangeSample(0.0, R, np.zeros(3)), 0))["rotation"]
        quaternion = [body[name] for name in "xyzw"]
        assert body["w"] >= 0
        assert np.linalg.norm(quaternion) == pytest.approx(1, abs=1e-12)
        np.testing.assert_allclose(Rotation.from_quat(quaternion).as_matrix(), R, atol=1e-12)


@pytest.mark.parametrize("fails", [1, 2, 5])
def test_a_disk_that_is_full_at_the_start_leaves_no_file_that_bars_the_name(
    fails: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real_write, calls = os.write, 0

    def full(file: int, data: Any) -> int:
        nonlocal calls
        calls += 1
        if calls >= fails:
            raise OSError(28, "No space left on device")
        return real_write(file, data)

    monkeypatch.setattr(os, "write", full)
    with pytest.raises(RecordingError, match="No space left"):
        RecordingWriter(tmp_path / "r.mcap", ABOUT)
    monkeypatch.undo()
    assert not (tmp_path / "r.mcap").exists()
    RecordingWriter(tmp_path / "r.mcap", ABOUT).close()


def test_a_folder_that_cannot_be_synced_leaves_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("contactbench.pipeline.recording.chunk_file.sync_folder", broken)
    with pytest.raises(RecordingError, match="choose another disk"):
        RecordingWriter(tmp_path / "r.mcap", ABOUT)
    assert not (tmp_path / "r.mcap").exists()


def test_a_note_that_is_no_text_is_kept_as_an_escape(tmp_path: Path) -> None:
    about = RecordingInfo(10**18, 0.0, note="from " + os.fsdecode(b"\xff.mcap"))
    RecordingWriter(tmp_path / "r.mcap", about).close()
    assert read_recording(tmp_path / "r.mcap").info.note == "from \\udcff.mcap"


def test_times_that_arrays_cannot_subtract_are_refused(tmp_path: Path) -> None:
    writer = RecordingWriter(tmp_path / "r.mcap", RecordingInfo(10**18, 1.7e308))
    with pytest.raises(SampleError, match="no time near the start"):
        writer.wrench(WrenchSample(1.7e308, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
    writer.close()


@pytest.mark.parametrize(
    "sample",
    [
        WrenchSample(1000.0, (1.0, -2.5, 3e-7), (0.1, -0.0, 1e300)),
        WrenchSample(1000.5, (math.nan, math.inf, 1.0), (1.0, 2.0, 3.0), 0, Status.LATE, 0.0, -21.5, 1000.25),
        WrenchSample(1001.0, (0.1, 0.2, 0.3), (0.4, 0.5, 0.6), 2**63 - 1, Status(2**20), None, None, 1001.5),
        WrenchSample(-1e14, (1.5, 2.5, 3.5), (4.5, 5.5, 6.5), None, Status.OK, 5e-324, None, -1e-9),
    ],
)
def test_cells_of_a_wrench_are_the_wrench(sample):
    data = wrench_message(sample, 1_700_000_000_000_000_123)
    (given,) = wrench_track([cells_of(read_wrench(data))]).samples()
    assert repr(given) == repr(read_wrench(data))
    cells = wrench_cells(data)
    if cells is None:  # a moment or a count that is beyond what is usual is read as JSON
        assert abs(sample.time) > 1e12 or (sample.sequence or 0) > 10**18
        return
    (other,) = wrench_track([cells]).samples()
    assert repr(other) == repr(given)  # as text: -0.0 is not 0.0, and NaN is NaN


PLAIN = wrench_message(WrenchSample(1000.0, (1.0, -2.5, 3.0), (0.5, 1.5, 2.5), 7), 5)


@pytest.mark.parametrize(
    ("was", "now"),
    [
        (b"1000.0", b"01000.0"),
        (b"1000.0", b"1000"),
        (b"1000.0", b"1e400"),
        (b"1000.0", b"null"),
        (b"-2.5", b"-0"),
        (b"-2.5", b"NaN"),
        (b"-2.5", b"+2.5"),
        (b"-2.5", b'"2.5"'),
        (b"-2.5", b"-2."),
        (b"-2.5", b"-2_0.5"),
        (b'"y"', b'"x"'),
        (b'"sequence":7', b'"sequence":-7'),
        (b'"sequence":7', b'"sequence":7,"more":1'),
        (b"{", b" {"),
    ],
)
def test_what_is_not_written_as_contactbench_does_is_read_as_json(was, now):
    data = PLAIN.replace(was, now, 1)
    assert wrench_cells(PLAIN) is not None
    assert data != PLAIN
    assert wrench_cells(data) is None


def test_samples_stay_in_order_whether_they_are_read_as_json_or_not(tmp_path, monkeypatch):
    samples = wrench_samples(9)
    record(tmp_path / "r.mcap", 9, 0)
    read, turns = reader.wrench_cells, cycle((True, False))
    monkeypatch.setattr(reader, "wrench_cells", lambda data: read(data) if next(turns) else None)
    (track,) = read_recording(tmp_path / "r.mcap").wrenches.values()
    assert list(track.samples()) == samples
