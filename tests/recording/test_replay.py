"""A recording given again."""

from __future__ import annotations

import time

import numpy as np
import pytest

from pipeline.devices.sample import FlangeSample, WrenchSample
from pipeline.recording import DeviceInfo, RecordingError, RecordingInfo, RecordingWriter
from pipeline.recording.replay import Replay


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


def test_nonsense_is_refused(recording, tmp_path):
    with pytest.raises(ValueError, match="above 0"):
        Replay(recording, speed=0.0)
    with pytest.raises(RecordingError):
        Replay(tmp_path / "none.mcap")
