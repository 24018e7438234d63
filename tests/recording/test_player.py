"""Recordings opened as sensor, as poses, and as both."""

import dataclasses
import threading

import numpy as np
import pytest
from hypothesis import given as drawn
from hypothesis import settings
from hypothesis import strategies as st
from recording.recording_cases import flange_samples, record, wrench_samples

from contactbench.pipeline.devices.driver import AddressError
from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.devices.stream import StreamState
from contactbench.pipeline.recording import DeviceInfo, RecordingError, RecordingInfo, RecordingWriter
from contactbench.pipeline.streams import open_pair, open_poses, open_sensor


@pytest.fixture
def recording(tmp_path):
    return record(tmp_path / "a.mcap")


def of_one_stream(file, write, samples):
    with RecordingWriter(file, RecordingInfo(10**18, 1000.0)) as writer:
        for sample in samples:
            write(writer, sample)
    return file


@pytest.fixture
def wrenches_only(tmp_path):
    return of_one_stream(tmp_path / "w.mcap", RecordingWriter.wrench, wrench_samples(100))


@pytest.fixture
def poses_only(tmp_path):
    return of_one_stream(tmp_path / "p.mcap", RecordingWriter.flange, flange_samples(100))


def same_pose(one: FlangeSample, two: FlangeSample) -> bool:
    return (
        (one.time, one.device_time) == (two.time, two.device_time)
        and np.array_equal(one.R_BE, two.R_BE)
        and np.array_equal(one.p_BE_B, two.p_BE_B)
        and np.array_equal(one.joints, two.joints)
    )


def test_a_sensor(recording):
    given, told = [], []
    with open_sensor(f"replay://{recording}?speed=1e6", given.extend, told.append) as stream:
        assert stream.done.wait(10)
        assert stream.health.state is StreamState.CLOSED
        assert stream.health.findings == ()
    assert given == wrench_samples(400)
    assert told[0].state is StreamState.STREAMING
    assert told[-1].state is StreamState.CLOSED
    assert told[-1].samples == 400
    assert told[-1].rate == pytest.approx(200)
    assert str(stream.address) == f"replay://{recording}?speed=1000000"


def test_poses(recording):
    given = []
    with open_poses(f"replay://{recording}?speed=1e6", given.extend) as stream:
        assert stream.done.wait(10)
    assert all(map(same_pose, given, flange_samples(200)))
    assert len(given) == 200


def test_both_share_one_clock_and_keep_their_order(recording):
    given = []
    address = f"replay://{recording}?speed=1e6"
    threads = set()

    def take(samples):
        threads.add(threading.get_ident())
        given.extend(samples)

    with open_pair(address, address, take, take) as pair:
        assert all(stream.done.wait(10) for stream in pair.streams)
        assert pair.finished
    assert [type(sample) for sample in given] == [
        type(sample)
        for sample in sorted([*wrench_samples(400), *flange_samples(200)], key=lambda sample: sample.time)
    ]
    assert len(threads) == 1
    assert {stream.health.samples for stream in pair.streams} == {400, 200}


def test_one_stream_alone_does_not_begin_for_both(recording):
    given = []
    address = f"replay://{recording}?speed=1e6"
    pair = open_pair(address, address, given.extend, given.extend)
    pair.sensor.start()
    assert not pair.sensor.done.wait(0.05)
    assert not given
    pair.poses.start()
    assert pair.sensor.done.wait(10)
    assert len(given) == 600
    pair.stop()


def test_step_by_step(recording):
    given = []
    address = f"replay://{recording}?speed=step"
    with open_pair(address, address, given.extend, given.extend) as pair:
        assert pair.stepwise
        assert pair.now() == 1000.0
        assert pair.step(3) == 3
        assert len(given) == 3
        assert pair.now() == given[-1].time
        assert pair.sensor.health.state is StreamState.STREAMING
        assert not pair.finished
        assert pair.step(10_000) == 597
        assert pair.finished
        assert pair.step() == 0
    assert pair.sensor.health.state is StreamState.CLOSED


def test_steps_of_a_sensor_alone_are_its_samples(recording):
    given = []
    with open_sensor(f"replay://{recording}?speed=step", given.extend) as stream:
        assert stream.step(7) == 7
    assert given == wrench_samples(400)[:7]


def test_a_replay_at_its_pace_has_no_steps(recording):
    stream = open_sensor(f"replay://{recording}?speed=0.01", lambda _: None)
    with stream, pytest.raises(RuntimeError, match="speed=step"):
        stream.step()
    assert not stream.done.is_set()
    assert stream.health.state is StreamState.CLOSED


def test_a_stopped_stream_is_quiet_while_the_other_goes_on(recording):
    wrenches, flanges = [], []
    address = f"replay://{recording}?speed=step"
    with open_pair(address, address, wrenches.extend, flanges.extend) as pair:
        pair.step(30)
        pair.poses.stop()
        seen = len(flanges)
        pair.step(30)
    assert len(flanges) == seen
    assert len(wrenches) > 30


def test_it_can_be_stopped_by_who_gets_the_samples(recording):
    stopped = threading.Event()

    def take(_):
        stream.stop()
        stopped.set()

    stream = open_sensor(f"replay://{recording}?speed=1e6", take)
    stream.start()
    assert stopped.wait(10)
    stream.stop()


def test_whoever_gets_the_samples_may_stop_a_stepwise_replay(recording):
    given = []

    def take(samples):
        given.extend(samples)
        if len(given) == 5:
            stream.stop()

    stream = open_sensor(f"replay://{recording}?speed=step", take)
    with stream:
        assert stream.step(100) == 5
        assert stream.step() == 0
    assert len(given) == 5
    assert stream.health.state is StreamState.CLOSED
    assert not stream.done.is_set()


def test_a_still_pose_beside_a_recording_is_on_its_clock(recording):
    given = []
    with open_pair(
        f"replay://{recording}?speed=step", "still://?rpy=0,0,90&rate=50", given.extend, given.extend
    ) as pair:
        pair.step(10_000)
        assert pair.finished
    poses = [sample for sample in given if isinstance(sample, FlangeSample)]
    assert [sample for sample in given if isinstance(sample, WrenchSample)] == wrench_samples(400)
    assert [pose.time for pose in poses] == [1000.0 + k / 50 for k in range(100)]
    assert pytest.approx(np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])) == poses[0].R_BE
    assert [sample.time for sample in given] == sorted(sample.time for sample in given)


@pytest.mark.parametrize(("by", "told"), [(1e9, "forward by 1,000,000,000 s"), (-0.4, "back by 0.4 s")])
def test_a_replay_goes_on_where_the_clock_was_set(tmp_path, by, told):
    """An endless track of poses would fill a gap of years."""
    file = tmp_path / "jump.mcap"
    samples = wrench_samples(200)
    samples[100:] = [dataclasses.replace(sample, time=sample.time + by) for sample in samples[100:]]
    with RecordingWriter(file, RecordingInfo(10**18, 1000.0)) as writer:
        for sample in samples:
            writer.wrench(sample)
    given, poses = [], []
    with open_pair(f"replay://{file}?speed=step", "still://?rpy=0,0,0", given.extend, poses.extend) as pair:
        pair.step(1000)
        assert pair.finished
        assert told in pair.sensor.health.findings[0]
    steps = np.diff([sample.time for sample in given])
    assert (steps[99], np.delete(steps, 99)) == (pytest.approx(1.0), pytest.approx(0.005, abs=1e-6))
    assert [pose.time for pose in poses] == pytest.approx(np.arange(1000, given[-1].time, 0.1))


@settings(max_examples=40, deadline=None)
@drawn(
    st.lists(st.tuples(st.floats(0, 1, exclude_max=True), st.integers(1, 255)), max_size=4),
    st.floats(0.02, 1),
)
def test_a_damaged_file_gives_what_was_recorded_or_an_error(tmp_path_factory, flips, kept):
    file = record(tmp_path_factory.mktemp("r") / "a.mcap", 60, 30)
    data = bytearray(file.read_bytes())
    for place, flip in flips:
        data[int(place * len(data))] ^= flip
    file.write_bytes(data[: int(kept * len(data))])
    wrenches, flanges = [], []
    address = f"replay://{file}?speed=step"
    try:
        pair = open_pair(address, address, wrenches.extend, flanges.extend)
    except RecordingError:
        return
    with pair:
        pair.step(1000)
        assert pair.finished
    recorded = wrench_samples(60)
    assert all(sample in recorded for sample in wrenches)


def test_what_was_recorded_of_the_devices_is_known(recording):
    address = f"replay://{recording}?speed=step"
    pair = open_pair(address, address, lambda _: None, lambda _: None)
    about = pair.about("again")
    pair.stop()
    assert (about.started_ns, about.clock, about.note) == (1_700_000_000_123_456_789, 1000.0, "again")
    sensor, robot = about.devices
    assert (sensor.model, sensor.serial, sensor.rate, sensor.address) == ("M8128", "SN 1", 200.0, address)
    assert robot.kind == "flange"


def test_what_a_recording_does_not_hold_is_refused(wrenches_only, poses_only):
    with pytest.raises(RecordingError, match="no wrenches on /wrench"):
        open_sensor(f"replay://{poses_only}", lambda _: None)
    with pytest.raises(RecordingError, match="no poses on /flange"):
        open_poses(f"replay://{wrenches_only}", lambda _: None)
    with pytest.raises(RecordingError, match="no poses"):
        open_pair(f"replay://{wrenches_only}", f"replay://{wrenches_only}", lambda _: None, lambda _: None)


def test_what_is_no_recording_is_refused(tmp_path):
    with pytest.raises(RecordingError, match="no such file"):
        open_sensor(f"replay://{tmp_path}/none.mcap", lambda _: None)
    (tmp_path / "x.mcap").write_bytes(b"t,fx\n")
    with pytest.raises(RecordingError, match="not an MCAP file"):
        open_poses(f"replay://{tmp_path}/x.mcap", lambda _: None)
    with pytest.raises(RecordingError, match="folder"):
        open_poses(f"replay://{tmp_path}", lambda _: None)


def test_of_several_sensors_one_is_chosen(tmp_path):
    file = tmp_path / "three.mcap"
    devices = tuple(DeviceInfo("wrench", f"/wrench{i}", "sri+tcp://x:1") for i in range(3))
    with RecordingWriter(file, RecordingInfo(10**18, 1000.0, devices)) as writer:
        for number, sample in enumerate(wrench_samples(30)):
            writer.wrench(sample, f"/wrench{number % 3}")
    with pytest.raises(RecordingError, match="topic="):
        open_sensor(f"replay://{file}", lambda _: None)
    with pytest.raises(RecordingError, match="no wrenches on /other"):
        open_sensor(f"replay://{file}?topic=/other", lambda _: None)
    given = []
    with open_sensor(f"replay://{file}?topic=/wrench1&speed=step", given.extend) as stream:
        stream.step(100)
    assert given == wrench_samples(30)[1::3]


@pytest.mark.parametrize(
    ("sensor", "poses"),
    [
        ("sri+tcp://127.0.0.1", "replay://{0}"),
        ("replay://{0}", "ur+tcp://127.0.0.1"),
        ("replay://{0}", "replay:///other.mcap"),
        ("replay://{0}?speed=2", "replay://{0}?speed=4"),
        ("still://?rpy=0,0,0", "replay://{0}"),
        ("elfin+tcp://127.0.0.1", None),
        ("replay://{0}", "sri+tcp://127.0.0.1"),
    ],
)
def test_two_clocks_and_wrong_kinds_are_refused(recording, sensor, poses):
    with pytest.raises(AddressError):
        open_pair(sensor.format(recording), poses and poses.format(recording), lambda _: None, lambda _: None)


def test_a_damaged_recording_says_so(recording):
    data = recording.read_bytes()
    recording.write_bytes(data[: len(data) * 2 // 3])
    given = []
    with open_sensor(f"replay://{recording}?speed=1e6", given.extend) as stream:
        assert stream.done.wait(10)
    assert 0 < len(given) < 400
    assert given == wrench_samples(400)[: len(given)]
    assert stream.health.state is StreamState.CLOSED
    assert stream.health.findings


def test_a_file_that_cannot_be_read_on_is_lost(recording, monkeypatch):
    from contactbench.pipeline.recording.reader import RecordingReader

    inner = RecordingReader.__iter__

    def failing(self):
        for number, item in enumerate(inner(self)):
            if number == 50:
                raise RecordingError(f"{recording}: the file cannot be read (input/output error): copy it.")
            yield item

    monkeypatch.setattr(RecordingReader, "__iter__", failing)
    told = []
    with open_sensor(f"replay://{recording}?speed=1e6", lambda _: None, told.append) as stream:
        assert stream.done.wait(10)
        assert stream.health.state is StreamState.LOST
    assert told[-1].findings == (f"{recording}: the file cannot be read (input/output error): copy it.",)
    assert 0 < told[-1].samples < 50
