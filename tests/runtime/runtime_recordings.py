"""Recordings for the runtime's tests: a probe that slides and lifts, and the robot that turns it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from config.runtime.bundles import example
from kernel.runtime_cases import stream

from contactbench.pipeline.devices.sample import FlangeSample, Status, WrenchSample
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter
from contactbench.pipeline.runtime.outlet import OutputContext

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from contactbench.pipeline.config.runtime import RuntimeConfig

BEGIN = 1_000.0
ABOUT = RecordingInfo(
    1_700_000_000_000_000_000,
    BEGIN,
    (
        DeviceInfo("wrench", "/wrench", "sri+tcp://10.0.0.1", "virtual", "V-0001", 1000.0),
        DeviceInfo("flange", "/flange", "elfin+tcp://10.0.0.2", rate=100.0),
    ),
)
CONTEXT = OutputContext(ABOUT, example().probe)
REMOTE = replace(CONTEXT, remote=True)


def wrench(time: float, reading: Any, status: Status = Status.OK) -> WrenchSample:
    fx, fy, fz, mx, my, mz = (float(x) for x in reading)
    return WrenchSample(time, (fx, fy, fz), (mx, my, mz), status=status)


def flange(time: float, R: NDArray[Any]) -> FlangeSample:
    return FlangeSample(time, R, np.full(3, np.nan))


def samples(
    config: RuntimeConfig, count: int, *, every: int = 10, gap: slice = slice(0)
) -> list[WrenchSample | FlangeSample]:
    """Return wrenches at 1 kHz and a pose for every tenth, but for those in a gap; with NaN and saturation."""
    readings, R, times = stream(config, count)
    readings[11::97, 2] = np.nan
    readings[23::109, 1] = 500.0
    quiet = set(range(count)[gap])
    mixed: list[WrenchSample | FlangeSample] = []
    for i, t in enumerate((BEGIN + times).tolist()):
        mixed.append(wrench(t, readings[i]))
        if i % every == every - 1 and i not in quiet:
            mixed.append(flange(t, R[i]))
    return mixed


def record(path: Path, mixed: list[WrenchSample | FlangeSample], about: RecordingInfo = ABOUT) -> Path:
    with RecordingWriter(path, about) as writer:
        for sample in mixed:
            if isinstance(sample, WrenchSample):
                writer.wrench(sample)
            else:
                writer.flange(sample)
    return path


def input_lines(mixed: list[WrenchSample | FlangeSample]) -> list[str]:
    """Return what the C++ example is given: poses and samples as they came."""
    lines = []
    for sample in mixed:
        if isinstance(sample, FlangeSample):
            words = ["pose", sample.time, *sample.R_BE.ravel().tolist(), *sample.p_BE_B.tolist()]
        else:
            arrival = sample.time if sample.arrival is None else sample.arrival
            words = ["sample", sample.time, arrival, int(sample.status), *sample.force, *sample.torque]
        lines.append(" ".join(map(str, words)))
    return lines
