"""Samples of the virtual bench in still poses, without waiting for them."""

import time
from functools import cache

import numpy as np
from weighing_files import planned

from contactbench.pipeline.recording.messages import FLANGE_TOPIC, WRENCH_TOPIC, DeviceInfo, RecordingInfo
from contactbench.pipeline.session.adoption import LiveRecording
from contactbench.pipeline.simulation.virtual.bench import VirtualBench
from contactbench.pipeline.workbench.live import LiveBlock

STILL_S = 4.5  # of which the wrist turns for the first


@cache
def batches(count=6, bumped=None):
    """Return what comes of a bench that goes through planned poses; one of them is pushed meanwhile."""
    if count < 6:  # the first of all
        return batches()[: count * round(STILL_S / 0.5)]
    bench, found = VirtualBench(), []
    for number, R in enumerate(planned(6)):
        bench.turn_to(R, seconds=1.5)
        if number == bumped:
            found.append(bench.advance(2.0))
            bench.bump([3.0, 0.0, 0.0], seconds=10.0)
            found += [bench.advance(0.5) for _ in range(10)]
        found += [bench.advance(0.5) for _ in range(int(STILL_S / 0.5))]
    bench.close()
    return tuple(found)


def block(batch, turn=None):
    """Return wrenches as the window gets them; `turn`: the flange as S, times this."""
    R = np.array([truth.R_WS for truth in batch.truths])
    return LiveBlock(
        np.array([sample.time for sample in batch.wrenches]),
        np.array([[*sample.force, *sample.torque] for sample in batch.wrenches]),
        R if turn is None else R @ turn,
        np.array([sample.status != 0 for sample in batch.wrenches]),
    )


def record(session, name, some, *, abruptly=False):
    """Put batches into a session as a recording."""
    devices = (
        DeviceInfo("wrench", WRENCH_TOPIC, "virtual://bench", rate=200.0),
        DeviceInfo("flange", FLANGE_TOPIC, "virtual://bench", rate=50.0),
    )
    with LiveRecording(session, RecordingInfo(time.time_ns(), 0.0, devices), name=name, patient=True) as tape:
        for batch in some:
            tape.recorder.samples(batch.wrenches)
            tape.recorder.poses(batch.flanges)
    return None if abruptly else tape.keep({})
