"""Samples for recordings, and recordings of them."""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter

ABOUT = RecordingInfo(
    1_700_000_000_123_456_789,
    1000.0,
    (
        DeviceInfo("wrench", "/wrench", "sri+tcp://192.168.0.108:4008", "M8128", "SN 1", 200.0),
        DeviceInfo("flange", "/flange", "elfin+tcp://10.0.0.2"),
    ),
    note="bench 3, ü",
)


def wrench_samples(count: int, seed: int = 0) -> list[WrenchSample]:
    rows = np.random.default_rng(seed).normal(0, 30, (count, 6)).tolist()
    return [
        WrenchSample(
            1000 + number / 200,
            (row[0], row[1], row[2]),
            (row[3], row[4], row[5]),
            number,
            Status.LATE if number % 7 == 3 else Status.OK,
            number * 0.005 + 0.1,
            21.0 + number / 300,
        )
        for number, row in enumerate(rows)
    ]


def flange_samples(count: int, seed: int = 1) -> list[FlangeSample]:
    rng = np.random.default_rng(seed)
    matrices = Rotation.from_rotvec(np.cumsum(rng.normal(0, 0.02, (count, 3)), axis=0)).as_matrix()
    return [
        FlangeSample(1000 + number / 100, R, rng.normal(0, 1, 3), rng.normal(0, 1, 6), number / 100)
        for number, R in enumerate(matrices)
    ]


def record(file: Path, wrenches: int = 400, flanges: int = 200, about: RecordingInfo = ABOUT) -> Path:
    """Write a recording of several chunks, as it would have happened in real time."""
    moments = iter(np.arange(1e7) * 0.0034)
    with RecordingWriter(file, about, clock=lambda: float(next(moments))) as writer:
        writer.event("start", {"who": "A. B.", "n": 1}, 1000.0)
        samples = [*wrench_samples(wrenches), *flange_samples(flanges)]
        for sample in sorted(samples, key=lambda s: s.time):
            if isinstance(sample, WrenchSample):
                writer.wrench(sample)
            else:
                writer.flange(sample)
        writer.event("stop", {}, 1000 + wrenches / 200)
    return file
