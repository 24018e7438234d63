"""A recording given again."""

import itertools
import time

import numpy as np
import pytest

from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.recording import DeviceInfo, RecordingError, RecordingInfo, RecordingWriter
from contactbench.pipeline.recording.reader import RecordingReader
from contactbench.pipeline.recording.replay import Replay, find_topic


@pytest.fixture
def recording(tmp_path):
    file = tmp_path / "a.mcap"
    devices = (
        DeviceInfo("wrench", "/wrench", "sri+tcp://x:1"),
        DeviceInfo("flange", "/flange", "ur+tcp://x:1"),
    )
    with RecordingWriter(file, RecordingInfo.now(devices)) as writer:
        for i in range(100):
            writer.wrench(WrenchSample(10 + i / 200, (float(i), 0.0, 0.0), (0.0, 0.0, 0.0), i))
            if i % 4 == 0:
                writer.flange(FlangeSample(10 + i / 200, np.eye(3), np.zeros(3)))
    return file


def test_everything_comes_again_in_order_with_its_own_times(recording):
    wrenches, flanges = [], []
    with Replay(recording, wrenches.extend, flanges.extend, speed=float("inf")) as replay:
        assert replay.start().done.wait(10)
    assert [sample.sequence for sample in wrenches] == list(range(100))
    assert [sample.time for sample in wrenches] == pytest.approx([10 + i / 200 for i in range(100)])
    assert len(flanges) == 25


def test_at_its_own_pace(recording):
    given = []
    begun = time.monotonic()
    with Replay(recording, given.extend, speed=2.0) as replay:
        assert replay.start().done.wait(10)
    assert time.monotonic() - begun >= 0.99 * 99 / 200 / 2  # never sooner than it was
    assert len(given) == 100


def test_step_by_step(recording):
    given, poses = [], []
    with Replay(recording, given.extend, poses.extend) as replay:
        assert replay.step() == 1
        assert len(given) + len(poses) == 1
        assert replay.step(9) == 9
        assert replay.step(1000) == 115
        assert replay.step() == 0
    assert len(given) == 100


def test_it_can_be_stopped(recording):
    given = []
    replay = Replay(recording, given.extend, speed=0.01).start()
    replay.stop()
    assert not replay.done.is_set()
    assert len(given) < 100


def test_the_order_of_both_kinds_is_kept_within_a_slice(recording):
    given = []
    with Replay(recording, given.extend, given.extend, speed=1e6) as replay:
        assert replay.start().done.wait(10)
    with RecordingReader(recording) as reader:
        recorded = [(type(sample), sample.time) for _, sample in reader]
    assert [(type(sample), sample.time) for sample in given] == recorded


def test_a_kind_that_nobody_wants_is_no_step(recording):
    poses = []
    with Replay(recording, on_flanges=poses.extend) as replay:
        assert replay.step(1000) == 25
        assert replay.done.is_set()
    assert len(poses) == 25


def test_poses_beside_take_the_place_of_recorded_ones(recording):
    given = []

    def beside(start):
        return (FlangeSample(start + k / 10, np.eye(3), np.zeros(3)) for k in itertools.count())

    with Replay(recording, given.extend, given.extend, beside=beside) as replay:
        assert replay.step(1000) == 105
    times = [sample.time for sample in given]
    assert times == sorted(times)
    poses = [sample.time for sample in given if isinstance(sample, FlangeSample)]
    assert poses == pytest.approx([10, 10.1, 10.2, 10.3, 10.4])


def test_the_end_is_told_once_before_it_is_done(recording):
    told = []
    replay = Replay(recording, lambda _: None, on_end=lambda: told.append(replay.done.is_set()))
    replay.step(1000)
    replay.step()
    replay.stop()
    assert told == [False]
    assert replay.step() == 0


def test_an_error_in_the_middle_ends_it(recording, monkeypatch):
    inner = RecordingReader.__iter__

    def failing(self):
        yield from itertools.islice(inner(self), 10)
        raise RecordingError("a.mcap: it cannot be read")

    monkeypatch.setattr(RecordingReader, "__iter__", failing)
    with Replay(recording, lambda _: None, lambda _: None) as replay:
        assert replay.step(1000) == 10
        assert replay.done.is_set()
        assert isinstance(replay.error, RecordingError)


def test_topics_are_found(recording):
    assert find_topic(recording, "wrench") == "/wrench"
    assert find_topic(recording, "flange", "/flange") == "/flange"
    with pytest.raises(RecordingError, match="no poses on /wrench"):
        find_topic(recording, "flange", "/wrench")


def test_nonsense_is_refused(recording, tmp_path):
    with pytest.raises(ValueError, match="above 0"):
        Replay(recording, speed=0.0)
    with pytest.raises(RecordingError):
        Replay(tmp_path / "none.mcap")
