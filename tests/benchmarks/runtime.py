"""What ``contactbench run`` costs: how late a contact is, and whether it holds still for an hour."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.bundle_example import example_config
from benchmarks.live.reader import GIVEN_TYPE, SENT_TYPE, read_back
from benchmarks.live.trial import Comparison, Sleeper, busy_process, compare, sensor_process
from scipy.spatial.transform import Rotation

from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.recording import DeviceInfo, RecordingInfo, RecordingWriter
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from contactbench.pipeline.config.runtime import RuntimeConfig

_LATE_MS = 1.0
_GROWTH = 0.01
_MARGIN_S = 60.0  # processes start and stop in much less
_GRACE_S = 0.25  # what is sent just before the end may be left on the line
_POSE_EVERY = 10
_BEGIN = 1_000.0


def run(
    seconds: float = 60.0,
    minutes: float = 60.0,
    *,
    facets: int = 20_000,
    seed: int = 0,
    sensors: int = 4,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure the Python runtime: one sensor, several in one process, and a replay."""
    if not seconds >= 1 or not minutes > 0 or sensors < 2:
        raise InputError("give at least 1 second, a number of minutes above 0, and at least 2 sensors.")
    config = example_config(facets)
    figures: list[Figure] = []
    with TemporaryDirectory(prefix="contactbench-") as name:
        folder = Path(name)
        config.write(folder / "bundle")
        for busy in (False, True):
            progress(f"a sensor at 1 kHz for {seconds:g} s" + (", beside a busy core" if busy else ""))
            subject = "1 kHz, one core busy" if busy else "1 kHz"
            (one,) = latency(folder, seconds, busy=busy)
            figures += _latency_figures(one, subject)
        progress(f"{sensors} sensors at 1 kHz for {seconds:g} s, in one process")
        for number, each in enumerate(latency(folder, seconds, sensors), 1):
            # What several sensors cost one another in lateness depends on the cores that there are: not judged.
            figures += _latency_figures(each, f"{sensors} sensors at 1 kHz, number {number}", judged=False)
        progress(f"replaying {minutes:g} minutes at 1 kHz")
        count = round(60_000 * minutes)
        tape = folder / "tape.mcap"
        write_tape(tape, config, count, seed)
        figures += _soak_figures(_child(folder, "replay", str(tape)), count)
    settings = {"seconds": seconds, "minutes": minutes, "facets": facets, "seed": seed, "sensors": sensors}
    note = (
        "From a frame's first byte given to the line to its contact in the reading process, lines written to a file"
        " and datagrams sent meanwhile. How late the machine itself wakes an idle process is a floor for that."
    )
    return StudyReport("Runtime", settings, tuple(figures), (note,))


# ---- how late a contact is ---------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Latency:
    """What one run showed."""

    pair: Comparison  # Frames sent beside contacts given
    # Time of the processor that the reading process used for one sample of one sensor, s, all of its threads together
    processor: float
    # 99th percentile of how much later than it asked for an idle process was woken meanwhile, s
    machine: float
    lost: int  # Contacts that were not published


def latency(folder: Path, seconds: float, sensors: int = 1, *, busy: bool = False) -> list[Latency]:
    """Run a bundle on emulated SRI sensors at 1 kHz, all in one process."""
    sent = [folder / f"sent-{number}.bin" for number in range(sensors)]
    with ExitStack() as stack:
        urls = [stack.enter_context(sensor_process(file, 1000.0)) for file in sent]
        if busy:
            stack.enter_context(busy_process(seconds + _MARGIN_S))
        sleeper = stack.enter_context(Sleeper())
        said = _child(folder, "live", f"{seconds:g}", *urls)
        machine = sleeper.late
    until = float(said["ended"]) - _GRACE_S
    pairs = [
        compare(read_back(file, SENT_TYPE), read_back(folder / f"given-{number}.bin", GIVEN_TYPE), until)
        for number, file in enumerate(sent)
    ]
    return [Latency(pair, said["processor"], machine, int(said["lost"])) for pair in pairs]


def _latency_figures(measured: Latency, subject: str, *, judged: bool = True) -> list[Figure]:
    pair = measured.pair
    late = 1e3 * pair.latency
    return [
        Figure(subject, "frames sent", pair.sent, least=1),
        Figure(subject, "frames without a contact", pair.lost, most=0),
        Figure(subject, "samples changed, or given twice", pair.changed, most=0),
        Figure(subject, "contacts not published", measured.lost, most=0),
        Figure(subject, "bytes to contact, median", float(np.median(late)), "ms"),
        Figure(
            subject,
            "bytes to contact, p99",
            float(np.percentile(late, 99)),
            "ms",
            most=_LATE_MS if judged else None,
        ),
        Figure(subject, "bytes to contact, p99.9", float(np.percentile(late, 99.9)), "ms"),
        Figure(subject, "bytes to contact, longest", float(late.max()), "ms"),
        Figure(subject, "an idle process is woken late, p99", 1e3 * measured.machine, "ms"),
        Figure(subject, "processor for one sample", 1e6 * measured.processor, "µs"),
        Figure(subject, "such sensors that one core carries", 1e-3 / measured.processor),
    ]


def _child(folder: Path, *arguments: str) -> dict[str, float]:
    command = [sys.executable, "-m", "benchmarks.runtime_child", str(folder), *arguments]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        said: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    except (subprocess.SubprocessError, IndexError, ValueError) as error:
        raise InputError(f"the process that runs the bundle failed ({error}): its error is above.") from error
    return said


# ---- an hour -----------------------------------------------------------------------------------


def write_tape(path: Path, config: RuntimeConfig, count: int, seed: int = 0) -> None:
    """Record samples at 1 kHz, with poses at 100 Hz: touches that come and go while the robot turns."""
    rng = np.random.default_rng(seed)
    corners = config.probe.vertices[config.probe.faces]
    devices = (
        DeviceInfo("wrench", "/wrench", "simulated", "virtual", "V-0001", 1000.0),
        DeviceInfo("flange", "/flange", "simulated", rate=100.0),
    )
    about = RecordingInfo(1_700_000_000_000_000_000, _BEGIN, devices)
    # Brought to the disk seldom: there is nothing to lose.
    with RecordingWriter(path, about, chunk_seconds=1.0, sync_seconds=3_600.0) as writer:
        for begin in range(0, count, 1_000):
            numbers = np.arange(begin, min(begin + 1_000, count), dtype=np.float64)
            times: NDArray[np.float64] = _BEGIN + 1e-3 * numbers
            R, readings = _second(times, corners, config, rng)
            for i, (time, row) in enumerate(zip(times.tolist(), readings.tolist(), strict=True)):
                if i % _POSE_EVERY == 0:
                    writer.flange(FlangeSample(time, R[i], np.full(3, np.nan)))
                writer.wrench(WrenchSample(time, (row[0], row[1], row[2]), (row[3], row[4], row[5])))


def _second(
    times: NDArray[np.float64], corners: NDArray[np.float64], config: RuntimeConfig, rng: np.random.Generator
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    turns = 0.3 * np.column_stack([np.sin(0.7 * times), np.cos(0.5 * times), np.sin(0.3 * times)])
    R = Rotation.from_rotvec(turns).as_matrix()
    a, b, c = corners[rng.integers(len(corners))]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal)
    force = -np.maximum(8.0 * np.sin(2 * math.pi * times), 0.0)[:, None] * normal
    wrench = np.concatenate([force, np.cross((a + b + c) / 3, force)], axis=1) + config.gravity.predict(R)
    return R, wrench + rng.normal(0, [0.05] * 3 + [0.002] * 3, wrench.shape)


def _soak_figures(said: dict[str, float], count: int) -> list[Figure]:
    early, end = said["resident_early"], said["resident_end"]
    subject = "replay"
    return [
        Figure(subject, "samples", count),
        Figure(subject, "located", said["located"], least=count, most=count),
        Figure(subject, "contacts not published", said["lost"], most=0),
        Figure(subject, "speed", said["located"] / said["seconds"] / 1e3, "kHz"),
        Figure(subject, "memory after a tenth", early / 1e6, "MB"),
        Figure(
            subject, "memory at most after that, more by", said["resident_most"] / early - 1, most=_GROWTH
        ),
        Figure(subject, "memory at the end, more by", end / early - 1, most=_GROWTH),
    ]
