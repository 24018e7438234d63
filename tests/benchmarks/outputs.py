"""How late contacts are at the programs that ``contactbench run`` sends them to, and what a reader that stops costs."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
from benchmarks.bundle_example import example_config
from benchmarks.outputs_client import RECEIVED_TYPE
from waiting import until

from contactbench.pipeline.devices.sample import FlangeSample, WrenchSample
from contactbench.pipeline.errors import InputError
from contactbench.pipeline.recording import RecordingInfo
from contactbench.pipeline.runtime import Engine, Outlet
from contactbench.pipeline.runtime.outlet import OutputContext
from contactbench.pipeline.runtime.outputs import open_outputs
from contactbench.pipeline.runtime.run import responsive
from contactbench.pipeline.study.report import Figure, StudyReport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from contactbench.pipeline.config.runtime import RuntimeConfig

OUTPUTS = ("udp", "igtl", "foxglove", "dds", "mqtt")
_PERIOD_S = 0.001
_LATE_MS, _PUT_MS, _BACK_S = 10.0, 1.0, 6.0
_FOXGLOVE_LATE_MS = 60.0  # its library waits for acknowledgements, which take up to 40 ms
_SETTLE_S = 0.5  # what comes first warms up both ends
_PORTS = {"udp": 47_811, "igtl": 47_812, "foxglove": 47_813, "mqtt": 47_814}
_DOMAIN = 87


def run(
    seconds: float = 20.0,
    outputs: Sequence[str] = OUTPUTS,
    *,
    progress: Callable[[str], None] = lambda _: None,
) -> StudyReport:
    """Measure each output."""
    unknown = ", ".join(set(outputs) - set(OUTPUTS))
    if not 1 <= seconds < 1e4 or unknown:
        raise InputError(
            f"give at least 1 second, and outputs of {', '.join(OUTPUTS)}{unknown and f', not {unknown}'}."
        )
    config = example_config(1_000)
    figures: list[Figure] = []
    with TemporaryDirectory(prefix="contactbench-") as name:
        for output in outputs:
            progress(f"{output}: 1 kHz for {seconds:g} s, then with a reader that stops and one that returns")
            figures += _figures(output, measure(output, config, Path(name), seconds))
    note = (
        "From the moment when a contact is handed to its output to its receipt in another process (MQTT: at the"
        " broker), over the loopback interface. While a reader is stopped, systems' buffers take contacts too; what is"
        " not published is counted by the output, what is published and never read is not. UDP, Foxglove's library and"
        " DDS drop what a reader does not take without saying so."
    )
    return StudyReport("Outputs", {"seconds": seconds, "outputs": list(outputs)}, tuple(figures), (note,))


@dataclass
class Measured:
    """What one output showed."""

    late: np.ndarray  # s, of every contact that was received
    sent: int  # while the reader read
    put: np.ndarray  # s that it took to hand over each contact, the reader stopped or not
    stopped: int = 0  # contacts handed over while the reader was stopped
    not_published: int = 0  # of them
    back: float = np.nan  # s from when a new reader begins to connect to its first contact
    times: list[float] = field(default_factory=list)


def measure(output: str, config: RuntimeConfig, folder: Path, seconds: float) -> Measured:
    """Run an output with a reader, then with one that stops, then with a new one."""
    about = RecordingInfo(time.time_ns(), time.monotonic(), ())
    address = str(_DOMAIN) if output == "dds" else f"127.0.0.1:{_PORTS[output]}"
    first, second = folder / f"{output}-1.bin", folder / f"{output}-2.bin"
    with reader(output, address, first, about) as reading:
        outlet = Outlet(
            open_outputs(
                {output: address + ("/bench" if output == "mqtt" else "")}, OutputContext(about, config.probe)
            )[output]
        )
        feed = _Feed(config, outlet)
        outlet.start()
        with responsive():
            until(lambda: feed.run(0.05) and first.stat().st_size)
            feed.run(_SETTLE_S)
            lost = outlet.lost
            sent, put = feed.run(seconds)
            feed.run(_SETTLE_S)
            rows = np.fromfile(first, RECEIVED_TYPE)
            reading.send_signal(signal.SIGSTOP)
            lost = outlet.lost
            held, put_then = feed.run(seconds)
            missing = outlet.lost - lost
            reading.kill()
            reading.wait()
            with reader(output, address, second, about):
                until(lambda: feed.run(0.05) and second.stat().st_size >= 2 * RECEIVED_TYPE.itemsize)
        outlet.close()
    stamps = np.array([about.log_time(moment) for moment, _ in sent])
    nearest = np.searchsorted(stamps, rows["stamp"] + 2_000) - 1  # a fraction of 2^-32 s may be rounded
    close = (nearest >= 0) & (np.abs(rows["stamp"] - stamps[nearest]) < 2_000)
    late = rows["time"][close] - np.array([moment for _, moment in sent])[nearest[close]]
    again = np.fromfile(second, RECEIVED_TYPE)["time"]
    return Measured(late, len(sent), np.array(put + put_then), len(held), missing, float(again[1] - again[0]))


class _Feed:
    """Locates a push at 1 kHz, and hands it over."""

    def __init__(self, config: RuntimeConfig, outlet: Outlet) -> None:
        probe = config.probe
        face = int(np.argmax(probe.region == 1))
        force = -8.0 * probe.normals[face]
        point = probe.vertices[probe.faces[face]].mean(axis=0)
        self._reading = config.gravity.predict(np.eye(3)) + np.concatenate([force, np.cross(point, force)])
        self._rng = np.random.default_rng(0)
        self._engine, self._outlet = Engine(config, hold=np.inf), outlet
        self._engine.poses([FlangeSample(time.monotonic(), np.eye(3), np.full(3, np.nan))])

    def run(self, seconds: float) -> tuple[list[tuple[float, float]], list[float]]:
        """Return time and moment of handing over, s, of each contact; and how long it took, s."""
        sent: list[tuple[float, float]] = []
        took: list[float] = []
        begun = due = time.monotonic()
        while due < begun + seconds:
            due += _PERIOD_S
            time.sleep(max(0.0, due - time.monotonic()))
            now = time.monotonic()
            a, b, c, d, e, f = (self._reading + self._rng.normal(0, [0.02] * 3 + [5e-4] * 3)).tolist()
            answer = self._engine.locate(WrenchSample(now, (a, b, c), (d, e, f)))
            before = time.monotonic()
            self._outlet.put(answer)
            took.append(time.monotonic() - before)
            sent.append((now, before))
        return sent, took


@contextmanager
def reader(output: str, address: str, notes: Path, about: RecordingInfo) -> Iterator[subprocess.Popen[bytes]]:
    """Start a process that reads an output and notes when each contact came; its first note is when it began."""
    module = "benchmarks.outputs_client"
    clock = [str(about.started_ns), repr(about.clock)]  # two looks need not agree to a microsecond
    words = [sys.executable, "-m", module, output, address, str(notes), *clock]
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])}
    process = subprocess.Popen(words, env=environment)
    try:
        until(lambda: process.poll() is not None or (notes.exists() and notes.stat().st_size))
        if process.poll() is not None:
            raise InputError(f"{output}: the process that reads ended at once: its error is above.")
        yield process
    finally:
        process.kill()
        process.wait()


def _figures(output: str, found: Measured) -> list[Figure]:
    late = 1e3 * found.late if len(found.late) else np.array([np.nan])
    most = _FOXGLOVE_LATE_MS if output == "foxglove" else _LATE_MS
    return [
        Figure(output, "contacts", found.sent, least=1),
        Figure(output, "contacts not received", found.sent - len(found.late), most=0),
        Figure(output, "put to receipt, median", float(np.median(late)), "ms"),
        Figure(output, "put to receipt, p99", float(np.percentile(late, 99)), "ms", most=most),
        Figure(output, "put to receipt, longest", float(late.max()), "ms"),
        Figure(output, "handing over, p99", 1e3 * float(np.percentile(found.put, 99)), "ms", most=_PUT_MS),
        Figure(output, "reader stopped: contacts", found.stopped),
        Figure(output, "reader stopped: not published", found.not_published),
        Figure(output, "new reader: first contact after", found.back, "s", most=_BACK_S),
    ]
